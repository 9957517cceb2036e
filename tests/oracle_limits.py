"""Limits of a synthesis on cam, contact and guides in closed form, one small function each.

CasADi expressions, written from textbooks and papers, apart from the product. A utilisation of at
most 1 keeps a limit.
"""

from __future__ import annotations

import casadi as ca
from oracle_part_limits import PART_LIMITS
from oracle_states import OracleLimit

_REVOLUTION_EXPONENT = 3  # ISO 281, ball bearings


def spring_travel(at):
    return at.lift / at.p.travel


def pressure_angle(at):
    angle = ca.atan(at.tangent) / at.p.pressure_angle
    return angle, -angle


def curvature_ratio(at):
    return at.sharpness * at.p.curvature_ratio


def undercut(at):
    return at.sharpness / (1 - at.p.undercut_factor)


def outer_undercut(at):
    return -at.sharpness / at.p.outer_undercut


def concave_radius(at):
    return -at.curvature * (at.p.hollow_radius - at.p.roller_radius)


def curvature_rate(at):
    rate = at.curvature_slope / (at.stretch * (1 - at.sharpness) ** 3) / at.p.curvature_rate
    return rate, -rate


def cam_radius(at):
    return at.contour_radius / at.p.cam_radius


def contact_pressure(at):
    bearable = ca.pi * at.p.contact_width * at.p.roller_radius * at.p.pressure**2
    ratio = at.fix.contact * at.fix.pressure_weight
    return at.sharpness + at.normal * at.p.contact_modulus * ratio**2 / bearable


def contact_force_margin(at):
    return 1 + at.p.contact_force_margin - at.normal / at.least_spring


def contact_at_overspeed(at):
    left = at.spring + at.mass * at.p.overspeed**2 * at.lift_d2
    return 1 + at.p.contact_force_margin - left / at.least_spring


def jump(at):
    return -at.inertia / at.spring / at.p.jump


def jump_speed(at):
    return -at.mass * at.p.jump_speed**2 * at.lift_d2 / at.spring


def jam_index(at):
    return at.jam * at.fix.jam_tilted / at.p.jam_index


def jam_index_friction_max(at):
    return at.jam_worst * at.fix.jam_tilted / at.p.jam_index


def roller_static(at):
    return at.normal * at.fix.force_weight / at.p.normal_force


def roller_speed(at):
    return at.spin / at.p.roller_spin


def roller_life(at):
    return at.surged**_REVOLUTION_EXPONENT * at.spin / at.p.life_force_cubed


def guide_pressure_a(at):
    pressure = at.side * at.at_a * at.fix.guide_a / at.p.guide_area_a / at.p.guide_pressure_a
    return pressure, -pressure


def guide_pressure_b(at):
    pressure = at.side * at.at_b * at.fix.guide_b / at.p.guide_area_b / at.p.guide_pressure_b
    return pressure, -pressure


def _rubbing_power(at):
    """|F_t v| of the stem: F_t and the lift velocity have the same sign under contact."""
    return at.side * at.velocity


def guide_pv_a(at):
    return _rubbing_power(at) * at.at_a * at.fix.worn_a / at.p.guide_area_a / at.p.guide_pv_a


def guide_pv_b(at):
    return _rubbing_power(at) * at.at_b * at.fix.worn_b / at.p.guide_area_b / at.p.guide_pv_b


ROTHBART = "Rothbart, Cam Design Handbook (2004), ch. 6"
CARDOSO = "Cardoso et al., Energies 18 (2025) 3256, eqs 11-14"
LIMITS: tuple[OracleLimit, ...] = (
    OracleLimit("spring_travel", "shape", "travel", spring_travel, "s <= s_max of the spring"),
    OracleLimit("pressure_angle", "shape", "pressure_angle", pressure_angle, ROTHBART),
    OracleLimit("curvature_ratio", "shape", "curvature_ratio", curvature_ratio,
                "Norton, Cam Design and Manufacturing Handbook: rho_p >= 1.5 to 3 r"),
    OracleLimit("undercut", "shape", "undercut_factor", undercut, ROTHBART + ": 1 - r kappa"),
    OracleLimit("outer_undercut", "shape", "outer_undercut", outer_undercut,
                ROTHBART + ": parallel curve outwards, 1 + r kappa"),
    OracleLimit("concave_radius", "shape", "hollow_radius", concave_radius,
                ROTHBART + ": |rho_p| + r >= tool radius in a hollow"),
    OracleLimit("curvature_rate", "shape", "curvature_rate", curvature_rate,
                "arc length of an offset curve: ds_c = (1 - r kappa) ds"),
    OracleLimit("cam_radius", "shape", "cam_radius", cam_radius, "offset of the pitch curve by r"),
    OracleLimit("contact_pressure", "loads", "pressure", contact_pressure,
                "Johnson, Contact Mechanics (1985), sec. 4.2(c), 1/R = 1/(r (1 - r kappa)), as "
                "r kappa + N/F_lim, F_lim = pi L r p^2/E*"),
    OracleLimit("contact_force_margin", "loads", "contact_force_margin", contact_force_margin,
                "Norton: least normal force over the least spring force"),
    OracleLimit("contact_at_overspeed", "loads", "overspeed contact_force_margin",
                contact_at_overspeed,
                "Norton: least spring less inertia force over the least spring force, no friction"),
    OracleLimit("jump", "loads", "jump", jump, "Norton: m w^2 |s''| <= F_s"),
    OracleLimit("jump_speed", "loads", "jump_speed", jump_speed,
                "Norton: w_jump^2 = min F_s/(-m s'')"),
    OracleLimit("jam_index", "loads", "jam_index", jam_index, CARDOSO + "; Rothbart eq. 6.8"),
    OracleLimit("jam_index_friction_max", "loads", "jam_index friction_worst_factor",
                jam_index_friction_max, CARDOSO + "; Rothbart eq. 6.8"),
    OracleLimit("roller_static", "loads", "normal_force", roller_static, "ISO 76: N <= C0/s0"),
    OracleLimit("roller_speed", "loads", "roller_spin", roller_speed,
                "Energy loss comparison between kinematically equivalent mechanisms (2024), "
                "eqs 35-37: n = w (|P'| - r)/r"),
    OracleLimit("roller_life", "life", "life_force_cubed", roller_life,
                "ISO 281: L10 = (C/P_m)^3, P_m^3 the mean of N^3 |n| over that of |n|; "
                "Palmgren and Miner", 3),
    OracleLimit("guide_pressure_A", "loads", "guide_pressure_a", guide_pressure_a, CARDOSO),
    OracleLimit("guide_pressure_B", "loads", "guide_pressure_b", guide_pressure_b, CARDOSO),
    OracleLimit("guide_pv_A", "mean", "guide_pv_a", guide_pv_a, CARDOSO + "; mean p v"),
    OracleLimit("guide_pv_B", "mean", "guide_pv_b", guide_pv_b, CARDOSO + "; mean p v"),
    *PART_LIMITS,
)  # fmt: skip
TORQUE_REDUCTION = "torque_reduction"
