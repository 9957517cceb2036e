"""Figures of forces and guides, and of roller, oil film, spring, pin, ring, key and shaft."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.reports.figures import Curve, Figure, LimitLine, LineFigure, Panel
from camwright.reports.sheet_turn import Turn, angle_figure, curves_of

_TRAVEL_POINTS = 31


def _forces(turn: Turn) -> Figure | None:
    curves = curves_of(
        turn, ("spring_force_N", "spring"), ("inertia_force_N", "inertia"),
        ("side_force_N", "side force"), ("guide_friction_A_N", "friction A"),
        ("guide_friction_B_N", "friction B"), ("viscous_force_N", "viscous drag"),
        ("applied_force_N", "applied"), dashed=(6,),
    )  # fmt: skip
    shown = "applied_force_N" in turn.columns
    applied = " Applied: weight and external force." if shown else ""
    return angle_figure(
        turn, "forces", "Force components on the follower",
        "Components along the stem; the side force is perpendicular to it and carried by the "
        f"guides.{applied}",
        Panel("force", "N", curves, height=1.25),
    )  # fmt: skip


def _spring_force(turn: Turn) -> Figure | None:
    """Of a spring that is not linear."""
    if turn.case.get("spring", {}).get("kind", "coil") == "coil":
        return None
    lift, first = np.unique(turn.columns["lift_mm"], return_index=True)
    at = np.linspace(lift[0], lift[-1], _TRAVEL_POINTS)
    force = np.interp(at, lift, turn.columns["spring_force_N"][first])
    return LineFigure(
        "spring-force", "Spring force over the travel",
        "Force of the spring at the lifts of the turn, without friction.",
        "lift", "mm", at, (Panel("force", "N", (Curve("", force, "blue"),)),),
    )  # fmt: skip


def _normal_force(turn: Turn) -> Figure | None:
    limits: tuple[LimitLine, ...] = ()
    rating, safety = turn.length("roller", "bearing", "C0", unit="N"), turn.bound("roller_static")
    if rating and safety:
        limits = (LimitLine(rating / safety, "static rating of the roller"),)
    curves = curves_of(
        turn, ("normal_force_N", "normal force"), ("axial_force_N", "axial force"),
        ("normal_force_statics_N", "normal force, point guides"), dashed=(2,),
    )  # fmt: skip
    shares = (
        ("normal_force_by_length_N", "guide length"),
        ("normal_force_by_clearance_N", "guide clearance"),
    )
    return angle_figure(
        turn, "normal-force", "Normal force",
        "Contact force between cam and follower and its component along the stem, guide friction "
        "included; change by the finite length and by the clearance of the guides. Contact is lost "
        "where the normal force reaches zero.",
        Panel("force", "N", curves, (LimitLine(0.0, "contact lost at"), *limits)),
        Panel("change", "N", curves_of(turn, *shares), height=0.6),
    )  # fmt: skip


def _guides(turn: Turn) -> Figure | None:
    pairs = (
        ("guide_reaction_A_N", "A, finite elements"), ("guide_reaction_A_statics_N", "A, statics"),
        ("guide_reaction_B_N", "B, finite elements"), ("guide_reaction_B_statics_N", "B, statics"),
    )  # fmt: skip
    shares = (
        ("guide_reaction_by_length_N", "guide length, equal in A and B"),
        ("guide_reaction_by_clearance_N", "guide clearance"),
    )  # fmt: skip
    sides = (("guide_normal_load_A_N", "A, both sides"), ("guide_normal_load_B_N", "B, both sides"))
    return angle_figure(
        turn, "guides", "Guide reactions",
        "Reactions of a beam in elastic unilateral guides of finite length and of two point "
        "supports; change by guide length and by clearance; sum of the forces on both sides of "
        "each bore, which cause friction.",
        Panel("reaction", "N", curves_of(turn, *pairs, dashed=(1, 3)), height=1.25),
        Panel("difference", "N", curves_of(turn, *shares), height=0.7),
        Panel("friction load", "N", curves_of(turn, *sides), height=0.7),
    )  # fmt: skip


def _jamming(turn: Turn) -> Figure | None:
    limits = turn.limit("limit", "", "jam_index")
    indices = (
        ("jam_index", "finite guides"), ("jam_index_statics", "point supports"),
        ("jam_index_friction_max", "maximum friction, rise"),
    )  # fmt: skip
    return angle_figure(
        turn, "jamming", "Jam index",
        "Guide friction over axial force; the follower jams at 1. In the return friction cannot "
        "jam it.",
        Panel("jam index", "", curves_of(turn, *indices, dashed=(1,)), limits, height=0.8),
    )  # fmt: skip


def _speed(turn: Turn) -> Figure | None:
    velocity = turn.columns["follower_velocity_m_per_s"]
    curves: list[Curve] = []
    limits: list[LimitLine] = []
    for name, colour in (("A", "blue"), ("B", "vermillion")):
        length = turn.length("guides", name.lower(), "length")
        diameter = turn.length("guides", name.lower(), "diameter")
        load = turn.columns[f"guide_normal_load_{name}_N"]
        if length and diameter:
            pv = np.abs(load * velocity) / (length * diameter)
            curves.append(Curve(f"guide {name}", pv, colour))
            limits += turn.limit(f"mean PV limit {name}", "MPa m/s", f"guide_pv_{name}")
    return angle_figure(
        turn, "speed", "Follower velocity and guide PV",
        "PV: guide force over projected area, times sliding speed.",
        Panel("velocity", "m/s", curves_of(turn, ("follower_velocity_m_per_s", "")), height=0.8),
        Panel("PV", "MPa m/s", tuple(curves), tuple(dict.fromkeys(limits)), height=0.9),
    )  # fmt: skip


def _roller(turn: Turn) -> Figure | None:
    friction = turn.case.get("roller", {}).get("friction")
    limits = (
        (LimitLine(float(friction), "coefficient of friction"),)
        if isinstance(friction, (int, float))
        else ()
    )
    return angle_figure(
        turn, "roller", "Roller: speed, traction and slip",
        "Speed and acceleration of a roller without slip, traction coefficient that its rotation "
        "requires, creepage, and slip speed where the available friction is too small.",
        Panel("speed", "rpm", curves_of(turn, ("roller_speed_rpm", "")), height=0.7),
        Panel("acceleration", "rad/s²", curves_of(turn, ("roller_acceleration_rad_per_s2", "")),
              height=0.7),
        Panel("traction", "", curves_of(turn, ("traction_demand", "")), limits, height=0.7),
        Panel("creepage", "", curves_of(turn, ("creepage", "")), height=0.6),
        Panel("slip", "m/s", curves_of(turn, ("slip_speed_m_per_s", "")), height=0.6),
    )  # fmt: skip


def _film(turn: Turn) -> Figure | None:
    limits = turn.limit("limit", "", "film_ratio")
    thickness = (
        ("film_thickness_um", "smooth surfaces"),
        ("film_thickness_mixed_um", "rough surfaces"),
    )
    return angle_figure(
        turn, "film", "Oil film",
        "Minimum film thickness between cam and follower, and its ratio to the combined roughness.",
        Panel("film thickness", "um", curves_of(turn, *thickness)),
        Panel("film thickness ratio", "", curves_of(turn, ("film_thickness_ratio", "")), limits,
              height=0.7),
    )  # fmt: skip


def _edge_pressure(turn: Turn) -> Figure | None:
    peaks = (("guide_edge_pressure_A_MPa", "guide A"), ("guide_edge_pressure_B_MPa", "guide B"))
    heats = (("guide_friction_power_A_W", "guide A"), ("guide_friction_power_B_W", "guide B"))
    limits = turn.limit("limit A", "MPa", "guide_edge_pressure_A") + turn.limit(
        "limit B", "MPa", "guide_edge_pressure_B"
    )
    return angle_figure(
        turn, "edge-pressure", "Edge pressure and friction heat of the guides",
        "Peak pressure between stem and bore with clearance; friction heat of the forces on both "
        "sides of the bore.",
        Panel("peak pressure", "MPa", curves_of(turn, *peaks), limits, height=0.9),
        Panel("friction heat", "W", curves_of(turn, *heats), height=0.8),
    )  # fmt: skip


def _elastic(turn: Turn) -> Figure | None:
    forces = (
        ("contact_force_elastic_stem_N", "elastic stem, no friction"),
        ("normal_force_friction_min_N", "minimum friction"),
        ("normal_force_friction_max_N", "maximum friction"),
    )
    return angle_figure(
        turn, "elastic", "Contact force: elastic stem, friction bounds",
        "Contact force with an elastic stem at the computed cam speed, and with minimum and "
        "maximum guide friction.",
        Panel("contact force", "N", curves_of(turn, *forces)),
        Panel("shortening", "um", curves_of(turn, ("stem_shortening_um", "")), height=0.7),
        Panel("cam speed", "rad/s", curves_of(turn, ("cam_speed_rad_per_s", "")), height=0.6),
    )  # fmt: skip


def _parts(turn: Turn) -> Figure | None:
    stresses = (
        ("spring_stress_MPa", "spring wire, shear"), ("pin_stress_MPa", "roller pin, bending"),
        ("ring_stress_amplitude_MPa", "outer ring, amplitude"),
        ("key_pressure_MPa", "key, pressure"), ("bore_pressure_MPa", "bore, pressure"),
    )  # fmt: skip
    bearings = (("shaft_bearing_load_1_N", "bearing 1"), ("shaft_bearing_load_2_N", "bearing 2"))
    return angle_figure(
        turn, "parts", "Spring, roller pin, outer ring, key and camshaft",
        "Stresses of the parts that the case describes.",
        Panel("stress", "MPa", curves_of(turn, *stresses)),
        Panel("spring surge", "N", curves_of(turn, ("spring_surge_force_N", "")), height=0.6),
        Panel("bearing load", "N", curves_of(turn, *bearings), height=0.8),
    )  # fmt: skip


PART_FIGURES: tuple[Callable[[Turn], Figure | None], ...] = (
    _forces, _spring_force, _normal_force, _guides, _jamming, _speed, _edge_pressure, _elastic,
    _roller, _film, _parts,
)  # fmt: skip
