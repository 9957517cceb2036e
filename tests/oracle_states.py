"""Cam and its loads at an angle in closed form, as CasADi expressions, for the oracle's limits.

Written from textbooks and papers, apart from the product. All SI; the follower translates on a line
through the cam axis (no offset), on a roller.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca


def lift_of(energy: ca.SX, rate: ca.SX, preload: ca.SX) -> ca.SX:
    """Root s of E = P s + k s^2/2."""
    return (ca.sqrt(preload**2 + 2 * rate * energy) - preload) / rate


def shape_at(energy: ca.SX, free: ca.SX, p: SimpleNamespace) -> SimpleNamespace:
    """Unloaded cam at an angle.

    Parameters
    ----------
    energy : SX (4,)   E, E', E'', E''', J/rad^k
    free : SX (3,)     k, P, r0

    References
    ----------
    Derivatives of the lift by the chain rule from s(E). Polar curve rho = r0 + s: curvature
    (rho^2 + 2 rho'^2 - rho rho'')/(rho^2 + rho'^2)^(3/2), tan alpha = rho'/rho. Rothbart, Cam
    Design Handbook (2004), ch. 6; contour: the point at r along the inward normal of the path.
    """
    rate, preload, prime = (free[k] for k in range(3))
    level = ca.SX.sym("level")
    by_energy = [lift_of(level, rate, preload)]
    for _ in range(3):
        by_energy.append(ca.gradient(by_energy[-1], level))
    f0, f1, f2, f3 = ca.substitute(by_energy, [level], [energy[0]])
    e1, e2, e3 = energy[1], energy[2], energy[3]
    lift, slope = f0, f1 * e1
    lift_d2 = f2 * e1**2 + f1 * e2
    jerk = f3 * e1**3 + 3 * f2 * e1 * e2 + f1 * e3
    rho = prime + lift
    stretch = ca.sqrt(rho**2 + slope**2)
    a, b, c = ca.SX.sym("a"), ca.SX.sym("b"), ca.SX.sym("c")
    formula = (a**2 + 2 * b**2 - a * c) / (a**2 + b**2) ** 1.5
    change = [ca.gradient(formula, each) for each in (a, b, c)]
    curvature, *parts = ca.substitute([formula, *change], [a, b, c], [rho, slope, lift_d2])
    bend_of_curvature = parts[0] * slope + parts[1] * lift_d2 + parts[2] * jerk
    cosine = rho / stretch
    inward, across = rho - p.roller_radius * cosine, p.roller_radius * slope / stretch
    return SimpleNamespace(
        p=p, lift=lift, slope=slope, lift_d2=lift_d2, jerk=jerk, rho=rho, stretch=stretch,
        tangent=slope / rho, curvature=curvature, curvature_slope=bend_of_curvature,
        cosine=cosine, rate=rate, preload=preload, prime_radius=prime,
        sharpness=p.roller_radius * curvature, contour_radius=ca.sqrt(inward**2 + across**2),
    )  # fmt: skip


def loads_at(
    cam: SimpleNamespace, highest: ca.SX, scenario: SimpleNamespace, fix: SimpleNamespace
) -> SimpleNamespace:
    """Loaded cam at an angle.

    The side force F_a tan(alpha) on the stem is taken by guides A and B, (a + b)/b and a/b of it;
    their friction opposes the motion, hence F_a = F/(1 - sign(s') (mu_A R_A + mu_B R_B)
    |tan(alpha)|). Without offset sign(s') |tan(alpha)| is tan(alpha). a: overhang, least at
    maximum lift.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256, eqs 11-14.
    """
    p = cam.p
    overhang = scenario.overhang * p.overhang_factor + highest - cam.lift
    spacing = scenario.guide_spacing * p.spacing_factor
    at_a, at_b = (overhang + spacing) / spacing, overhang / spacing
    mass = scenario.mass * p.mass_factor
    spring = cam.preload * scenario.preload_factor + cam.rate * scenario.rate_factor * cam.lift
    inertia = mass * scenario.cam_speed**2 * cam.lift_d2
    viscous = scenario.viscous_damping * scenario.cam_speed * cam.slope
    rubbing = p.friction_factor * (
        scenario.friction_a * at_a * fix.rubbing_a + scenario.friction_b * at_b * fix.rubbing_b
    )
    worst = p.friction_worst_factor * (scenario.worst_a * at_a + scenario.worst_b * at_b) * fix.jam
    unrubbed, share = spring + inertia + viscous, 1 - rubbing * cam.tangent
    axial = unrubbed / share
    least_spring = (
        cam.preload * scenario.preload_factor + cam.rate * scenario.rate_factor * fix.least_lift
    )
    return SimpleNamespace(
        **vars(cam), scenario=scenario, fix=fix, at_a=at_a, at_b=at_b, spring=spring,
        inertia=inertia, unrubbed=unrubbed, share=share, axial=axial, normal=axial / cam.cosine,
        mass=mass, side=axial * cam.tangent, jam=rubbing * cam.tangent,
        jam_worst=worst * cam.tangent, least_spring=least_spring, highest=highest,
        surged=ca.fmax(axial + fix.surge / share, 0) / cam.cosine,
        spin=scenario.cam_speed * (cam.stretch / p.roller_radius - 1),
        velocity=scenario.cam_speed * cam.slope, torque=axial * cam.slope,
    )  # fmt: skip


@dataclass(frozen=True)
class OracleLimit:
    """One limit: demand over limit, and where both come from.

    `of`: "shape" of the unloaded cam; "loads" of a scenario at each angle; "mean" of a scenario,
    the terms whose mean over the turn is the utilisation to the power `power`; "life" of the load
    cases of a machine: see `damage`. `needs`: numbers, by space, without which the limit does not
    apply. Several expressions are the sides of an absolute value, of a life several means.

    `damage`: means of a load case, room -> share of the life spent in the target by that load case
    alone, the limit times the room; None: the mean over the room to the power `power`. Shares add
    by the duty, to 1 at most. `beside`: a mean of each load case in operation, to the power
    `power`, that is limited too.
    """

    check: str
    of: str
    needs: str
    use: Callable[[SimpleNamespace], ca.SX | tuple[ca.SX, ...]]
    source: str
    power: int = 1
    damage: Callable[[list, ca.SX], ca.SX] | None = None
    beside: Callable[[SimpleNamespace], ca.SX] | None = None

    def spent(self, means: list, room: ca.SX) -> ca.SX:
        """Share of the life spent by a load case alone."""
        return means[0] / room**self.power if self.damage is None else self.damage(means, room)
