"""Limits of a synthesis on guides, roller bearing, key, gear and speed range in closed form.

As `oracle_limits`: CasADi expressions, written from standards and textbooks, apart from the
product. What finite elements, surge and heat of the last cam give are constants, `at.fix`.
"""

from __future__ import annotations

import casadi as ca
from oracle_states import OracleLimit

_RPM = ca.pi / 30
_KELVIN = 273.15
_MARGIN = 0.2  # of the least spring force, where no contact force margin is kept
_ELSEWHERE = -10.0  # utilisation in a scenario to which a limit does not apply
_AT_REST = 1.0  # rpm, below which a roller needs no film


def _sides(signed):
    return signed, -signed


def _where(applies, use):
    """The utilisation in the scenarios to which it applies; both are finite."""
    return applies * use + (1 - applies) * _ELSEWHERE


def minimum_wall(at):
    return at.p.minimum_wall * at.p.held_radius / at.contour_radius


def guide_speed_a(at):
    return _sides(at.slope / at.p.guide_slope_a)


def guide_speed_b(at):
    return _sides(at.slope / at.p.guide_slope_b)


def gas_speed(at):
    return _sides(at.slope / at.p.gas_slope)


def guide_gap(at):
    """Gap between mouth of guide A, which stands still, and the contour turning below it."""
    mouth = at.prime_radius + at.highest + at.p.guide_mouth
    missing = at.p.guide_gap - (mouth - at.contour_radius)
    return _where(at.scenario.swept * at.scenario.nominal, 1 + missing / at.p.roller_radius)


def guide_edge_pressure_a(at):
    return _sides(at.side * at.at_a * at.fix.edge_a / at.p.guide_length_a / at.p.guide_edge_load_a)


def guide_edge_pressure_b(at):
    return _sides(at.side * at.at_b * at.fix.edge_b / at.p.guide_length_b / at.p.guide_edge_load_b)


def _heat(at):
    """F_t s' w of the stem at the greatest friction, which itself raises the side force."""
    return at.unrubbed / (1 - at.jam_worst) * at.tangent * at.velocity


def guide_temperature_a(at):
    rubbing = at.p.friction_worst_factor * at.scenario.worst_a * at.at_a * at.fix.hot_a
    return rubbing * _heat(at) / at.p.guide_power_a


def guide_temperature_b(at):
    rubbing = at.p.friction_worst_factor * at.scenario.worst_b * at.at_b * at.fix.hot_b
    return rubbing * _heat(at) / at.p.guide_power_b


def guide_wear_a(at):
    worn = at.side * at.velocity * at.at_a * at.fix.worn_a / at.p.guide_area_a
    return worn / at.p.guide_wear_pv_a


def guide_wear_b(at):
    worn = at.side * at.velocity * at.at_b * at.fix.worn_b / at.p.guide_area_b
    return worn / at.p.guide_wear_pv_b


def _over_normal(at, needed):
    """Needed normal force over the present one, which keeps the contact force margin."""
    return 1 + (needed - at.normal) / ca.fmax(at.normal, _contact_kept(at))


def _contact_kept(at):
    margin = ca.if_else(at.p.contact_force_margin > 0, at.p.contact_force_margin, _MARGIN)
    return margin * at.least_spring


def traction_demand(at):
    """Moment J dn/dt + M_0 + mu_b N r_b of the roller over r, carried by mu N."""
    p, speed = at.p, at.scenario.cam_speed
    stretching = (at.rho * at.slope + at.slope * at.lift_d2) / at.stretch
    inertia = p.drag_inertia * speed**2 * stretching / p.roller_radius
    dragging = p.drag_torque + p.drag_bearing_friction * p.drag_pin_radius * ca.fmax(at.normal, 0)
    moment = inertia + ca.if_else(speed > 0, dragging, 0)
    return tuple(_over_normal(at, side / p.roller_radius / p.friction) for side in _sides(moment))


def profile_waviness(at):
    """Inertia m a (2 pi v / l)^2 on sine waves, v: speed of the contact along the contour."""
    speed = at.scenario.cam_speed * at.stretch * (1 - at.sharpness)
    frequency = 2 * ca.pi * speed / at.p.wave_length
    return _over_normal(at, at.mass * at.p.wave_amplitude * frequency**2 / at.p.waviness)


def contact_over_speed(at):
    speed = ca.if_else(at.fix.swept_speed > 0, at.fix.swept_speed, at.p.overspeed)
    carried = at.mass - at.scenario.spring_mass
    push = at.spring + at.fix.swept_surge + carried * speed**2 * at.lift_d2
    push += at.scenario.viscous_damping * speed * at.slope
    normal = push / at.share / at.cosine
    return _where(at.scenario.swept, 1 + at.p.contact_force_margin - normal / at.least_spring)


def elastic_contact(at):
    speed = ca.if_else(at.fix.elastic_speed > 0, at.fix.elastic_speed, at.p.overspeed)
    carried = at.mass - at.scenario.spring_mass
    left = at.spring + at.fix.elastic + carried * speed**2 * at.lift_d2
    return _where(at.scenario.swept, 1 + at.p.contact_force_margin - left / at.least_spring)


def key_pressure(at):
    return _sides(at.torque / at.p.cam_torque)


def gear_bending(at):
    return _sides((at.torque + at.p.shaft_drag) / at.p.tooth_torque)


def keyway_root(at):
    """Notch stress by the key, and by the contact force on the least wall over the keyway."""
    p = at.p
    wall = at.prime_radius + at.fix.least_lift - p.roller_radius - p.keyway_held_radius
    contact = p.keyway_by_force * at.normal * p.keyway_thick / ca.fmin(wall, p.keyway_thick)
    return tuple(
        (p.keyway_by_torque * side + contact) * p.keyway_per_stress * p.keyway_safety
        for side in _sides(at.torque)
    )


def _mean_speed(at):
    """Mean spin of the roller, rad/s: of the last cam, else on the prime circle."""
    on_circle = at.prime_radius / at.p.roller_radius - 1
    return at.scenario.cam_speed * ca.if_else(at.fix.rolling > 0, at.fix.rolling, on_circle)


def _turns(at):
    return _mean_speed(at) >= _AT_REST * _RPM


def _greased_load(at):
    """(P/C)^3 at the mean speed."""
    mean = ca.fmax(_mean_speed(at), _AT_REST * _RPM)
    return ca.fmax(at.normal, 0) ** 3 * at.spin / (at.p.grease_rating**3 * mean)


def grease_life(at):
    """(P/C)^3, log10 of the life over its target at P/C = 0.05, whether the roller turns."""
    p, mean = at.p, ca.fmax(_mean_speed(at), _AT_REST * _RPM)
    size = ca.fmax(mean / _RPM * 1e3 * p.grease_diameter, 125e3)
    warm = ca.fmax(p.grease_temperature - _KELVIN, 50)
    light = 6.10 - 4.40e-6 * size - (0.021 - 1.80e-8 * size) * warm
    applies = _turns(at) * (size <= 500e3)
    return _greased_load(at), light - ca.log10(p.grease_life / 3600), applies


def grease_damage(means, room):
    """log10 L = 6.10 - 4.40e-6 n D - 2.50 (P/C - 0.05) - (0.021 - 1.80e-8 n D) T.

    0.05 <= P/C <= 0.2, n D >= 125e3 mm/min, T >= 50 degC.
    """
    cubed, light, applies = means
    load = ca.fmax(cubed ** (1 / 3) / room, 0.05)
    return applies * 10 ** (2.50 * (load - 0.05) - light)


def grease_range(at):
    return at.scenario.in_operation * _turns(at) * _greased_load(at) / 0.2**3


def roller_modified_life(at):
    """1/L = sum of n/(a_ISO (C/P)^3), a_ISO = 0.1 (1 - (2.5671 - b/kappa^c)^0.83 x^(1/3))^-9.3.

    x: e_C P_u/P; kappa: viscosity over v1 = 45000 n^-0.83 D^-0.5 or 4500 n^-0.5 D^-0.5, mm2/s and
    mm; 0.1 <= kappa <= 4, a_ISO <= 50.
    """
    p, speed = at.p, ca.fmax(_mean_speed(at) / _RPM, _AT_REST)
    needed = ca.if_else(speed < 1000, 45000 * speed**-0.83, 4500 * speed**-0.5)
    kappa = p.modified_viscosity / (1e-6 * needed / ca.sqrt(1e3 * p.modified_circle))
    kappa = ca.fmin(ca.fmax(kappa, 0.1), 4)
    film = ca.if_else(
        kappa < 0.4, 2.2649 / kappa**0.054381,
        ca.if_else(kappa < 1, 1.9987 / kappa**0.19087, 1.9987 / kappa**0.071739),
    )  # fmt: skip
    force = ca.fmax(at.surged, 1)
    clean = (2.5671 - film) ** 0.83 * (p.modified_cleanliness_load / force) ** (1 / 3)
    factor = 0.1 * ca.fmax(1 - clean, 500 ** (-1 / 9.3)) ** -9.3
    used = (force / p.modified_rating) ** 3 / factor
    return _turns(at) * used * at.spin / p.modified_rate


def bearing_lubrication(at):
    return ca.if_else(_turns(at), at.spin / at.p.roller_spin_least, 100)


CARDOSO = "Cardoso et al., Energies 18 (2025) 3256, eqs 11-14"
SURGE = "Norton: least contact force, the spring without its own mass, which surges"
ISO_281 = "ISO 281:2007, 9.3"
PART_LIMITS: tuple[OracleLimit, ...] = (
    OracleLimit("minimum_wall", "shape", "minimum_wall held_radius", minimum_wall,
                "wall over bore and keyway"),
    OracleLimit("guide_speed_A", "shape", "guide_slope_a", guide_speed_a, "w |s'| <= v"),
    OracleLimit("guide_speed_B", "shape", "guide_slope_b", guide_speed_b, "w |s'| <= v"),
    OracleLimit("gas_speed", "shape", "gas_slope", gas_speed, "w |s'| <= v"),
    OracleLimit("guide_gap", "loads", "guide_gap", guide_gap, "clearance of follower and guide"),
    OracleLimit("guide_edge_pressure_A", "loads", "guide_edge_load_a", guide_edge_pressure_a,
                CARDOSO),
    OracleLimit("guide_edge_pressure_B", "loads", "guide_edge_load_b", guide_edge_pressure_b,
                CARDOSO),
    OracleLimit("guide_temperature_A", "mean", "guide_power_a friction_worst_factor",
                guide_temperature_a, CARDOSO + "; T = T_amb + Q R"),
    OracleLimit("guide_temperature_B", "mean", "guide_power_b friction_worst_factor",
                guide_temperature_b, CARDOSO + "; T = T_amb + Q R"),
    OracleLimit("guide_wear_A", "life", "guide_wear_pv_a", guide_wear_a, "Archard: k p v t"),
    OracleLimit("guide_wear_B", "life", "guide_wear_pv_b", guide_wear_b, "Archard: k p v t"),
    OracleLimit("traction_demand", "loads", "friction drag_inertia", traction_demand,
                "Rothbart eq. 10.7"),
    OracleLimit("profile_waviness", "loads", "waviness wave_amplitude", profile_waviness,
                "Rothbart sec. 10.4"),
    OracleLimit("contact_over_speed", "loads", "overspeed contact_force_margin",
                contact_over_speed, SURGE),
    OracleLimit("elastic_contact", "loads", "overspeed contact_force_margin", elastic_contact,
                SURGE),
    OracleLimit("key_pressure", "loads", "cam_torque", key_pressure, "DIN 6892; slip torque"),
    OracleLimit("gear_bending", "loads", "tooth_torque", gear_bending, "Lewis"),
    OracleLimit("keyway_root", "loads", "keyway_safety keyway_by_torque", keyway_root,
                "Goodman, Shigley sec. 6-12"),
    OracleLimit("grease_life", "life", "grease_rating", grease_life,
                "JTEKT, Ball and Roller Bearings, sec. 12", 3, grease_damage, grease_range),
    OracleLimit("roller_modified_life", "life", "modified_rate modified_rating",
                roller_modified_life, ISO_281, 3),
    OracleLimit("bearing_lubrication", "mean", "roller_spin_least", bearing_lubrication,
                ISO_281 + ".3: least mean speed of a viscosity ratio", -1),
)  # fmt: skip
