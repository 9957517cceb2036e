"""Figures of the forces on the follower, and of the parts around the cam."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.reports.figures import Curve, Figure, LimitLine, Panel
from camwright.reports.sheet_turn import Turn, angle_figure, curves_of


def _forces(turn: Turn) -> Figure | None:
    curves = curves_of(
        turn, ("spring_force_N", "spring"), ("inertia_force_N", "inertia"),
        ("tangential_force_N", "side force"), ("friction_A_N", "friction A"),
        ("friction_B_N", "friction B"), ("viscous_force_N", "viscous drag"),
    )  # fmt: skip
    return angle_figure(
        turn, "forces", "Force components on the follower",
        "Along the stem, but for the side force, which the guides carry.",
        Panel("force", "N", curves, height=1.25),
    )  # fmt: skip


def _normal_force(turn: Turn) -> Figure | None:
    limits: tuple[LimitLine, ...] = ()
    rating, safety = turn.length("roller", "bearing", "C0", unit="N"), turn.bound("roller_static")
    if rating and safety:
        limits = (LimitLine(rating / safety, "roller static rating allows"),)
    curves = curves_of(
        turn, ("normal_force_N", "normal force"), ("axial_force_N", "axial force"),
        ("normal_force_statics_N", "normal force, guides as points"), dashed=(2,),
    )  # fmt: skip
    shares = (
        ("normal_force_by_length_N", "by length of the guides"),
        ("normal_force_by_clearance_N", "by clearance"),
    )
    return angle_figure(
        turn, "normal-force", "Normal force",
        "Between roller and cam, with its component along the stem, friction of the guides "
        "included; and what their length, then their clearance changes in it. Contact is lost "
        "where the normal force reaches zero.",
        Panel("force", "N", curves, (LimitLine(0.0, "contact lost at"), *limits)),
        Panel("change", "N", curves_of(turn, *shares), height=0.6),
    )  # fmt: skip


def _guides(turn: Turn) -> Figure | None:
    pairs = (
        ("reaction_A_N", "A, finite elements"), ("reaction_A_statics_N", "A, statics"),
        ("reaction_B_N", "B, finite elements"), ("reaction_B_statics_N", "B, statics"),
    )  # fmt: skip
    shares = (
        ("reaction_by_length_N", "by length, of A and B alike"),
        ("reaction_by_clearance_N", "by clearance"),
    )  # fmt: skip
    rubbing = (("rubbing_load_A_N", "A, both sides"), ("rubbing_load_B_N", "B, both sides"))
    return angle_figure(
        turn, "guides", "Guide reactions",
        "The follower as a beam on elastic one-sided guides of finite length, against two point "
        "supports; what length alone and then clearance add to these; and the pushes of both "
        "sides of a bore, which rub.",
        Panel("reaction", "N", curves_of(turn, *pairs, dashed=(1, 3)), height=1.25),
        Panel("difference", "N", curves_of(turn, *shares), height=0.7),
        Panel("rubbing load", "N", curves_of(turn, *rubbing), height=0.7),
    )  # fmt: skip


def _jamming(turn: Turn) -> Figure | None:
    limits = turn.limit("limit", "", "jam_index")
    indices = (
        ("jam_index", "finite guides"), ("jam_index_statics", "point supports"),
        ("jam_index_friction_max", "greatest friction, way out"),
    )  # fmt: skip
    return angle_figure(
        turn, "jamming", "Jam index",
        "Share of the axial force that guide friction takes; at 1 the follower locks. On the way "
        "back it locks nothing.",
        Panel("jam index", "", curves_of(turn, *indices, dashed=(1,)), limits, height=0.8),
    )  # fmt: skip


def _speed(turn: Turn) -> Figure | None:
    velocity = turn.columns.get("velocity_m_per_s")
    if velocity is None:
        return None
    curves: list[Curve] = []
    limits: list[LimitLine] = []
    for name, colour in (("A", "blue"), ("B", "vermillion")):
        length = turn.length("guides", name.lower(), "length")
        diameter = turn.length("guides", name.lower(), "diameter")
        load = turn.columns.get(f"rubbing_load_{name}_N", turn.columns.get(f"reaction_{name}_N"))
        if length and diameter and load is not None:
            pv = np.abs(load * velocity) / (length * diameter)
            curves.append(Curve(f"guide {name}", pv, colour))
            limits += turn.limit(f"mean PV limit {name}", "MPa m/s", f"bush_pv_{name}")
    return angle_figure(
        turn, "speed", "Follower velocity and guide PV",
        "PV is the guide pressure on its projected area times the sliding speed.",
        Panel("velocity", "m/s", curves_of(turn, ("velocity_m_per_s", "")), height=0.8),
        Panel("PV", "MPa m/s", tuple(curves), tuple(dict.fromkeys(limits)), height=0.9),
    )  # fmt: skip


def _roller(turn: Turn) -> Figure | None:
    friction = turn.case.get("roller", {}).get("friction")
    limits = (
        (LimitLine(float(friction), "friction there is"),)
        if isinstance(friction, (int, float))
        else ()
    )
    return angle_figure(
        turn, "roller", "Roller: speed, grip and slip",
        "Speed and acceleration of a roller that does not slip, the friction its turning asks of "
        "the contact, the creepage it takes and the speed at which it slips where it has too "
        "little.",
        Panel("speed", "rpm", curves_of(turn, ("roller_speed_rpm", "")), height=0.7),
        Panel("acceleration", "rad/s²", curves_of(turn, ("roller_acceleration_rad_per_s2", "")),
              height=0.7),
        Panel("friction needed", "", curves_of(turn, ("traction_demand", "")), limits, height=0.7),
        Panel("creepage", "", curves_of(turn, ("creepage", "")), height=0.6),
        Panel("slip", "m/s", curves_of(turn, ("slip_m_per_s", "")), height=0.6),
    )  # fmt: skip


def _film(turn: Turn) -> Figure | None:
    limits = turn.limit("limit", "", "film_ratio")
    thickness = (("film_thickness_um", "least, smooth"), ("mixed_film_um", "least, rough"))
    return angle_figure(
        turn, "film", "Oil film",
        "Least thickness of the film between cam and follower, and that over both roughnesses.",
        Panel("film", "um", curves_of(turn, *thickness)),
        Panel("film ratio", "", curves_of(turn, ("lambda_ratio", "")), limits, height=0.7),
    )  # fmt: skip


def _bushes(turn: Turn) -> Figure | None:
    peaks = (("bush_peak_A_MPa", "guide A"), ("bush_peak_B_MPa", "guide B"))
    heats = (("friction_heat_A_W", "guide A"), ("friction_heat_B_W", "guide B"))
    limits = turn.limit("limit A", "MPa", "bush_peak_A") + turn.limit(
        "limit B", "MPa", "bush_peak_B"
    )
    return angle_figure(
        turn, "bushes", "Edges and heat of the guides",
        "Peak pressure of the stem in its bore, with clearance, where it leans hardest; heat of "
        "the pushes of both sides of the bore.",
        Panel("peak pressure", "MPa", curves_of(turn, *peaks), limits, height=0.9),
        Panel("heat", "W", curves_of(turn, *heats), height=0.8),
    )  # fmt: skip


def _elastic(turn: Turn) -> Figure | None:
    forces = (
        ("elastic_contact_force_N", "elastic stem, no friction"),
        ("normal_force_friction_min_N", "least over friction"),
        ("normal_force_friction_max_N", "greatest over friction"),
    )
    return angle_figure(
        turn, "elastic", "Contact force: elastic stem, bounds of friction",
        "What an elastic stem, on the speed that the cam really has, and the least and greatest "
        "friction make of the contact force.",
        Panel("contact force", "N", curves_of(turn, *forces)),
        Panel("shortening", "um", curves_of(turn, ("elastic_deflection_um", "")), height=0.7),
        Panel("cam speed", "rad/s", curves_of(turn, ("cam_speed_rad_per_s", "")), height=0.6),
    )  # fmt: skip


def _parts(turn: Turn) -> Figure | None:
    stresses = (
        ("spring_stress_MPa", "spring wire, shear"), ("pin_stress_MPa", "roller pin, bending"),
        ("ring_stress_amplitude_MPa", "outer ring, amplitude"),
        ("key_pressure_MPa", "key, pressure"), ("bore_pressure_MPa", "bore, pressure"),
    )  # fmt: skip
    bearings = (("shaft_bearing_1_N", "bearing 1"), ("shaft_bearing_2_N", "bearing 2"))
    return angle_figure(
        turn, "parts", "Spring, pin, ring, key and shaft",
        "Stresses of the parts around the cam as far as the case describes them.",
        Panel("stress", "MPa", curves_of(turn, *stresses)),
        Panel("spring's surge", "N", curves_of(turn, ("spring_surge_force_N", "")), height=0.6),
        Panel("camshaft bearing", "N", curves_of(turn, *bearings), height=0.8),
    )  # fmt: skip


PART_FIGURES: tuple[Callable[[Turn], Figure | None], ...] = (
    _forces, _normal_force, _guides, _jamming, _speed, _bushes, _elastic, _roller, _film, _parts,
)  # fmt: skip
