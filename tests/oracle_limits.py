"""Limits of a synthesis in closed form, one small function each, as CasADi expressions.

Written from textbooks and papers, apart from the product. All SI; the follower translates on a line
through the cam axis (no offset), on a roller. A utilisation of at most 1 keeps a limit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca

NUMBERS = (
    # limits
    "travel", "pressure_angle", "curvature_ratio", "undercut_factor", "hollow_radius",
    "curvature_rate", "cam_radius", "pressure", "contact_force_margin", "overspeed", "jump",
    "jump_speed", "jam_index", "normal_force", "roller_spin", "life_force_cubed",
    "guide_pressure_a", "guide_pressure_b", "guide_pv_a", "guide_pv_b", "torque_reduction",
    # machine
    "roller_radius", "contact_width", "contact_modulus", "guide_area_a", "guide_area_b",
    "gear_ratio", "rate", "preload", "prime_radius",
    # machine, factors on the value of each scenario
    "mass_factor", "friction_factor", "friction_worst_factor", "spacing_factor", "overhang_factor",
)  # fmt: skip
"""Limits and machine numbers; the optimum is differentiated by each."""

SCENARIO = (
    "cam_speed", "mass", "guide_spacing", "overhang", "friction_a", "friction_b",
    "viscous_damping", "rate_factor", "preload_factor", "worst_a", "worst_b",
)  # fmt: skip
CORRECTION = ("contact", "guide_a", "guide_b", "rubbing_a", "rubbing_b", "jam")
FREE = ("rate", "preload", "prime_radius")
_REVOLUTION_EXPONENT = 3  # ISO 281, ball bearings


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
    bend = f2 * e1**2 + f1 * e2
    jerk = f3 * e1**3 + 3 * f2 * e1 * e2 + f1 * e3
    rho = prime + lift
    stretch = ca.sqrt(rho**2 + slope**2)
    a, b, c = ca.SX.sym("a"), ca.SX.sym("b"), ca.SX.sym("c")
    formula = (a**2 + 2 * b**2 - a * c) / (a**2 + b**2) ** 1.5
    change = [ca.gradient(formula, each) for each in (a, b, c)]
    curvature, *parts = ca.substitute([formula, *change], [a, b, c], [rho, slope, bend])
    bend_of_curvature = parts[0] * slope + parts[1] * bend + parts[2] * jerk
    cosine = rho / stretch
    return SimpleNamespace(
        p=p, lift=lift, slope=slope, bend=bend, jerk=jerk, rho=rho, stretch=stretch,
        tangent=slope / rho, curvature=curvature, curvature_slope=bend_of_curvature,
        sine=slope / stretch, cosine=cosine, rate=rate, preload=preload,
        sharpness=p.roller_radius * curvature,
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
    inertia = mass * scenario.cam_speed**2 * cam.bend
    viscous = scenario.viscous_damping * scenario.cam_speed * cam.slope
    rubbing = p.friction_factor * (
        scenario.friction_a * at_a * fix.rubbing_a + scenario.friction_b * at_b * fix.rubbing_b
    )
    worst = p.friction_worst_factor * (scenario.worst_a * at_a + scenario.worst_b * at_b) * fix.jam
    axial = (spring + inertia + viscous) / (1 - rubbing * cam.tangent)
    return SimpleNamespace(
        **vars(cam), scenario=scenario, fix=fix, at_a=at_a, at_b=at_b, spring=spring,
        inertia=inertia, axial=axial, normal=axial / cam.cosine, mass=mass,
        side=axial * cam.tangent, jam=rubbing * cam.tangent, jam_worst=worst * cam.tangent,
        preload_here=cam.preload * scenario.preload_factor,
        spin=scenario.cam_speed * (cam.stretch / p.roller_radius - 1),
        torque=axial * cam.slope,
    )  # fmt: skip


@dataclass(frozen=True)
class OracleLimit:
    """One limit: demand over limit, and where both come from.

    `of`: "shape" of the unloaded cam; "loads" of a scenario at each angle; "mean" of a scenario,
    the terms whose mean over the turn is the utilisation to the power `power`. `needs`: number
    without which the limit does not apply. Several expressions are the sides of an absolute value.
    """

    check: str
    of: str
    needs: str
    use: Callable[[SimpleNamespace], ca.SX | tuple[ca.SX, ...]]
    source: str
    power: int = 1


def spring_travel(at):
    return at.lift / at.p.travel


def pressure_angle(at):
    angle = ca.atan(at.tangent) / at.p.pressure_angle
    return angle, -angle


def curvature_ratio(at):
    return at.sharpness * at.p.curvature_ratio


def undercut(at):
    return at.sharpness / (1 - at.p.undercut_factor)


def concave_radius(at):
    return -at.curvature * (at.p.hollow_radius - at.p.roller_radius)


def curvature_rate(at):
    rate = at.curvature_slope / (at.stretch * (1 - at.sharpness) ** 3) / at.p.curvature_rate
    return rate, -rate


def cam_radius(at):
    inward = at.rho - at.p.roller_radius * at.cosine
    return ca.sqrt(inward**2 + (at.p.roller_radius * at.sine) ** 2) / at.p.cam_radius


def contact_pressure(at):
    bearable = ca.pi * at.p.contact_width * at.p.roller_radius * at.p.pressure**2
    return at.sharpness + at.normal * at.p.contact_modulus * at.fix.contact**2 / bearable


def contact_force_margin(at):
    return 1 + at.p.contact_force_margin - at.normal / at.preload_here


def contact_at_overspeed(at):
    left = at.spring + at.mass * at.p.overspeed**2 * at.bend
    return 1 + at.p.contact_force_margin - left / at.preload_here


def jump(at):
    return -at.inertia / at.spring / at.p.jump


def jump_speed(at):
    return -at.mass * at.p.jump_speed**2 * at.bend / at.spring


def jam_index(at):
    return at.jam / at.p.jam_index


def jam_index_friction_max(at):
    return at.jam_worst / at.p.jam_index


def roller_static(at):
    return at.normal / at.p.normal_force


def roller_speed(at):
    return at.spin / at.p.roller_spin


def roller_life(at):
    return at.normal**_REVOLUTION_EXPONENT * at.spin / at.p.life_force_cubed


def guide_pressure_a(at):
    pressure = at.side * at.at_a * at.fix.guide_a / at.p.guide_area_a / at.p.guide_pressure_a
    return pressure, -pressure


def guide_pressure_b(at):
    pressure = at.side * at.at_b * at.fix.guide_b / at.p.guide_area_b / at.p.guide_pressure_b
    return pressure, -pressure


def _rubbing_power(at):
    """|F_t v| of the stem: F_t and the lift velocity have the same sign under contact."""
    return at.side * at.scenario.cam_speed * at.slope


def guide_pv_a(at):
    return _rubbing_power(at) * at.at_a * at.fix.rubbing_a / at.p.guide_area_a / at.p.guide_pv_a


def guide_pv_b(at):
    return _rubbing_power(at) * at.at_b * at.fix.rubbing_b / at.p.guide_area_b / at.p.guide_pv_b


ROTHBART = "Rothbart, Cam Design Handbook (2004), ch. 6"
CARDOSO = "Cardoso et al., Energies 18 (2025) 3256, eqs 11-14"
LIMITS: tuple[OracleLimit, ...] = (
    OracleLimit("spring_travel", "shape", "travel", spring_travel, "s <= s_max of the spring"),
    OracleLimit("pressure_angle", "shape", "pressure_angle", pressure_angle, ROTHBART),
    OracleLimit("curvature_ratio", "shape", "curvature_ratio", curvature_ratio,
                "Norton, Cam Design and Manufacturing Handbook: rho_p >= 1.5 to 3 r"),
    OracleLimit("undercut", "shape", "undercut_factor", undercut, ROTHBART + ": 1 - r kappa"),
    OracleLimit("concave_radius", "shape", "hollow_radius", concave_radius,
                ROTHBART + ": |rho_p| + r >= tool radius in a hollow"),
    OracleLimit("curvature_rate", "shape", "curvature_rate", curvature_rate,
                "arc length of an offset curve: ds_c = (1 - r kappa) ds"),
    OracleLimit("cam_radius", "shape", "cam_radius", cam_radius, "offset of the pitch curve by r"),
    OracleLimit("contact_pressure", "loads", "pressure", contact_pressure,
                "Johnson, Contact Mechanics (1985), sec. 4.2(c), 1/R = 1/(r (1 - r kappa)), as "
                "r kappa + N/F_lim, F_lim = pi L r p^2/E*"),
    OracleLimit("contact_force_margin", "loads", "contact_force_margin", contact_force_margin,
                "Norton: least normal force over the preload"),
    OracleLimit("contact_at_overspeed", "loads", "overspeed", contact_at_overspeed,
                "Norton: least spring less inertia force over the preload, no friction"),
    OracleLimit("jump", "loads", "jump", jump, "Norton: m w^2 |s''| <= F_s"),
    OracleLimit("jump_speed", "loads", "jump_speed", jump_speed,
                "Norton: w_jump^2 = min F_s/(-m s'')"),
    OracleLimit("jam_index", "loads", "jam_index", jam_index, CARDOSO + "; Rothbart eq. 6.8"),
    OracleLimit("jam_index_friction_max", "loads", "jam_index", jam_index_friction_max,
                CARDOSO + "; Rothbart eq. 6.8"),
    OracleLimit("roller_static", "loads", "normal_force", roller_static, "ISO 76: N <= C0/s0"),
    OracleLimit("roller_speed", "loads", "roller_spin", roller_speed,
                "Energy loss comparison between kinematically equivalent mechanisms (2024), "
                "eqs 35-37: n = w (|P'| - r)/r"),
    OracleLimit("roller_life", "mean", "life_force_cubed", roller_life,
                "ISO 281: L10 = (C/P_m)^3, P_m^3 the mean of N^3 |n| over that of |n|", 3),
    OracleLimit("guide_pressure_A", "loads", "guide_pressure_a", guide_pressure_a, CARDOSO),
    OracleLimit("guide_pressure_B", "loads", "guide_pressure_b", guide_pressure_b, CARDOSO),
    OracleLimit("guide_pv_A", "mean", "guide_pv_a", guide_pv_a, CARDOSO + "; mean p v"),
    OracleLimit("guide_pv_B", "mean", "guide_pv_b", guide_pv_b, CARDOSO + "; mean p v"),
)  # fmt: skip
TORQUE_REDUCTION = "torque_reduction"
