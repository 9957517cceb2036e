"""Limits of a synthesis under a flat face, written from textbooks, apart from the product.

Functions of complex numbers: a complex step through them differentiates the whole chain from the
coefficients of the energy to a utilisation. Of the product's `Problem` plain numbers alone are
read. A utilisation of at most 1 keeps a limit.

References
----------
Norton, Cam Design and Manufacturing Handbook (2009), ch. 7 and 15: contact of a flat face at s'
beside the cam axis, radius of curvature r + s + s''. Johnson, Contact Mechanics (1985), eqs 4.43
and 4.45: a^2 = 4 P R/(pi E*), p0^2 = P E*/(pi R). Free body of a stem on two point supports that
carries mu F along the face and F at s' - e beside its axis.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from oracle_model import periodic_basis
from scipy.optimize import brentq
from synthesis_ratings import named
from synthesis_scenarios import figures

MEANS = {"guide_pv_A", "guide_pv_B", "guide_wear_A", "guide_wear_B", "guide_temperature_A",
         "guide_temperature_B"}  # fmt: skip
"""Limits on the mean of their terms over the turn."""


def size(value):
    """|value| of a real value, analytic beside it."""
    return np.where(np.real(value) < 0, -value, value)


def summit(coefficients):
    """Cam angle of the greatest energy, where its slope is zero."""
    fine = np.linspace(0, 2 * np.pi, 40 * coefficients.size, endpoint=False)
    top = fine[np.argmax(periodic_basis(fine, coefficients.size) @ coefficients)]
    return brentq(
        lambda angle: float((periodic_basis([angle], coefficients.size, 1) @ coefficients)[0]),
        top - fine[1], top + fine[1], xtol=1e-15,
    )  # fmt: skip


def lift_of(levels, rate, preload):
    """s, s', s'', s''' from E, E', E'', E''' by the derivatives of s(E), P s + k s^2/2 = E."""
    force = np.sqrt(preload**2 + 2 * rate * levels[0])
    by1, by2, by3 = 1 / force, -rate / force**3, 3 * rate**2 / force**5
    first, second, third = levels[1:]
    return (
        (force - preload) / rate,
        by1 * first,
        by2 * first**2 + by1 * second,
        by3 * first**3 + 3 * by2 * first * second + by1 * third,
    )


def cam_of(problem, lifts, highest, free, theta):
    """Cam of a lift and three derivatives at angles theta, and of its maximum lift."""
    s, s1, s2, s3 = lifts
    height = free["prime_radius"] + s
    return SimpleNamespace(
        s=s, s1=s1, s2=s2, s3=s3, highest=highest, height=height, radius=height + s2,
        arm=s1 - problem.ratings.offset, outside=np.sqrt(height**2 + s1**2), free=free, theta=theta,
    )  # fmt: skip


def cam_at(problem, coefficients, free, theta, place):
    """Cam of an energy at angles theta; place: angle of its maximum lift."""
    basis = [periodic_basis(theta, coefficients.size, k) for k in range(4)]
    lifts = lift_of([each @ coefficients for each in basis], free["rate"], free["preload"])
    top = (periodic_basis([place], coefficients.size) @ coefficients)[0]
    highest = lift_of([top, 0, 0, 0], free["rate"], free["preload"])[0]
    return cam_of(problem, lifts, highest, free, theta)


def follower_at(problem, cam, item, fix):
    """Forces on the follower of a scenario, N, with friction of guides and face."""
    mu = named(problem.ratings).face_friction
    item = figures(item)
    free, spacing = cam.free, item.guide_spacing
    reach = item.overhang + cam.highest - cam.s
    spring = free["preload"] * item.preload_factor + free["rate"] * item.rate_factor * cam.s
    inertia = item.mass * item.cam_speed**2 * cam.s2
    unrubbed = spring + inertia + item.viscous_damping * item.cam_speed * cam.s1
    # Moments about the face: A reach - B (reach + b) = (s' - e) F, forces: A - B = mu F.
    on_b = (mu * reach - cam.arm) / spacing
    on_a = mu + on_b
    apart = (mu * (reach + spacing) / spacing, mu * reach / spacing)
    whole = [each + size(cam.arm) / spacing for each in apart]

    def load(side, ratio):
        """Load of a guide over the axial force: finite elements correct that of both parts."""
        both = size((on_a, on_b)[side]) + (ratio - 1) * whole[side]
        return np.where(np.real(both) > 0, both, 0 * both)

    rising = np.sign(np.real(cam.s1))
    jam = item.friction_a * load(0, fix.rubbing_a) + item.friction_b * load(1, fix.rubbing_b)
    jam_worst = (item.worst_a * size(on_a) + item.worst_b * size(on_b)) * fix.jam
    share = 1 - rising * jam
    axial = unrubbed / share
    least = free["preload"] * item.preload_factor
    least = least + free["rate"] * item.rate_factor * fix.least_lift
    return SimpleNamespace(
        spring=spring, inertia=inertia, unrubbed=unrubbed, axial=axial, share=share, load=load,
        jam=np.where(rising > 0, jam, 0 * jam), least=least, velocity=item.cam_speed * cam.s1,
        jam_worst=np.where(rising > 0, jam_worst, 0 * jam_worst),
        axial_worst=unrubbed / (1 - rising * jam_worst),
        torque=axial * (cam.s1 + mu * cam.height),
    )  # fmt: skip


def utilisations(problem, cam, item):
    """Utilisations (n,) of every limit in a scenario, by check; of `MEANS` the terms."""
    p, free, fix = named(problem.ratings), cam.free, item.correction.at(cam.theta)
    limit, item = problem.ratings.bounds, figures(item)
    at = follower_at(problem, cam, item, fix)
    force, radius, arms = at.axial, cam.radius, size(cam.arm)
    line = force / p.contact_width
    loads = [force * at.load(k, fix_k) for k, fix_k in enumerate((fix.worn_a, fix.worn_b))]
    pushes = [force * at.load(k, fix_k) for k, fix_k in enumerate((fix.guide_a, fix.guide_b))]
    edges = [force * at.load(k, fix_k) for k, fix_k in enumerate((fix.edge_a, fix.edge_b))]
    hot = [
        mu * at.load(k, ratio) * at.axial_worst
        for k, (mu, ratio) in enumerate(
            zip((item.worst_a, item.worst_b), (fix.hot_a, fix.hot_b), strict=True)
        )
    ]

    def pressed(allowed):
        """-s''/(r + s) + R_p/(r + s): R >= R_p, with the pressure `allowed` at R_p."""
        needed = line * p.contact_modulus * fix.contact**2 / (np.pi * allowed**2)
        return (needed - cam.s2) / cam.height

    def kept(normal, base):
        """Shortfall of a contact force below its margin, over the least spring force."""
        return 1 + limit["contact_force_margin"] - normal / base

    # An undercut cam exceeds a limit of its own.
    convex = np.where(np.real(line * radius) > 0, line * radius, 0.0)
    half = np.sqrt(4 * convex / (np.pi * p.contact_modulus)) / fix.contact
    amplitude, length = p.wave_amplitude, p.wave_length
    waves = item.mass * amplitude * (2 * np.pi * item.cam_speed * radius / length) ** 2
    moving = item.mass - item.spring_mass
    rigid = at.spring + fix.swept_surge + moving * fix.swept_speed**2 * cam.s2
    rigid = rigid + item.viscous_damping * fix.swept_speed * cam.s1
    soft = at.spring + fix.elastic + moving * fix.elastic_speed**2 * cam.s2
    wall = free["prime_radius"] + fix.least_lift - p.keyway.held_radius
    stress = (
        p.keyway.by_torque * size(at.torque) + p.keyway.by_force * force * p.keyway.thick / wall
    )
    mouth = free["prime_radius"] + cam.highest + p.guide_mouth
    uses = {
        "spring_travel": cam.s / p.travel,
        "undercut": (1 - radius / cam.height) / (1 - limit["undercut_factor"]),
        "curvature_rate": size((cam.s1 + cam.s3) / radius**3) / limit["curvature_rate"],
        "cam_radius": cam.outside / limit["cam_radius"],
        "minimum_wall": limit["minimum_wall"] * p.held_radius / cam.outside,
        "contact_pressure": pressed(p.pressure / fix.pressure_weight),
        "face_pv": pressed(p.face_pv / (np.pi / 4 * item.cam_speed * cam.height)),
        "face_width": 2 * (arms + half) / p.face_width,
        "bore_pressure": force * fix.force_weight / p.normal_force,
        "contact_force_margin": kept(force, at.least),
        "contact_at_overspeed": kept(
            at.spring + item.mass * p.overspeed**2 * cam.s2, at.least
        ),
        "contact_over_speed": kept(rigid / at.share, at.least),
        "elastic_contact": kept(soft, at.least),
        "jump": -at.inertia / at.spring / limit["jump"],
        "jump_speed": -item.mass * p.jump_speed**2 * cam.s2 / at.spring,
        "jam_index": at.jam * fix.jam_tilted / limit["jam_index"],
        "jam_index_friction_max": at.jam_worst * fix.jam_tilted / limit["jam_index"],
        "profile_waviness": 1 + (waves / limit["waviness"] - force) / force,
        "key_pressure": size(at.torque) / p.cam_torque,
        "gear_bending": size(at.torque + p.shaft_drag) / p.tooth_torque,
        "keyway_root": stress * p.keyway.per_stress * limit["keyway_safety"],
        "gas_speed": size(cam.s1) / p.gas_slope,
        "guide_gap": 1 + (p.guide_gap - (mouth - cam.outside)) / (0.5 * p.face_width),
    }  # fmt: skip
    for k, side in enumerate("AB"):
        speed = size(at.velocity)
        uses |= {
            f"guide_speed_{side}": size(cam.s1) / p.guide_slope[k],
            f"guide_pressure_{side}": pushes[k] / p.guide_area[k] / p.guide_pressure[k],
            f"guide_edge_pressure_{side}": edges[k] / p.guide_length[k] / p.guide_edge_load[k],
            f"guide_pv_{side}": loads[k] * speed / p.guide_area[k] / p.guide_pv[k],
            f"guide_wear_{side}": loads[k] * speed / p.guide_area[k] / p.guide_wear_pv[k],
            f"guide_temperature_{side}": hot[k] * speed / p.guide_power[k],
        }
    return uses
