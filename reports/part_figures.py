"""Plots of the parts around the cam: bushes, stem, roller, film, spring, pin, ring, shaft."""

from __future__ import annotations

from collections.abc import Callable

from camwright.reports.figures import Figure, LimitLine, Panel
from camwright.reports.sheet_turn import Turn, angle_figure, curves_of


def part_figures(turn: Turn) -> tuple[Figure, ...]:
    """Every figure of the parts that the run has columns for, in reading order."""
    makers: tuple[Callable[[Turn], Figure | None], ...] = (
        _bushes, _elastic, _roller, _film, _parts,
    )  # fmt: skip
    made = (maker(turn) for maker in makers)
    return tuple(figure for figure in made if figure is not None)


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
