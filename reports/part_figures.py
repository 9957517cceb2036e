"""Figures of forces, guides, roller, oil film, spring, pin, ring, key and shaft."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import cycle

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.figures import SERIES, AxisMark, Curve, Figure, LimitLine, Panel, over
from camwright.reports.report_tables import Record, number
from camwright.reports.sheet_turn import SheetTurn, angle_figure, both_ways, curves_of, lowest

_TRAVEL_POINTS = 31
_DEAD_COILS = 2.0  # of squared and ground ends
_PROMINENCE = 0.1
_LOST = LimitLine(0.0, "contact lost at")


def _lost(turn: SheetTurn) -> tuple[LimitLine, ...]:
    """Line at which contact is lost; none of a cam that pulls, whose other track takes over."""
    return () if turn.walls is not None else (_LOST,)


def endurance(turn: SheetTurn) -> tuple[LimitLine, ...]:
    """Limit of the contact pressure."""
    return turn.limit("endurance", "MPa", "contact_pressure")


def _forces(turn: SheetTurn) -> Figure | None:
    """Figure of the force components on the follower over the turn, N."""
    spring = (("spring_force_N", "spring"),) if turn.sprung else ()
    curves = curves_of(
        turn, *spring, ("inertia_force_N", "inertia"),
        ("side_force_N", "side force"), ("guide_friction_A_N", "friction A"),
        ("guide_friction_B_N", "friction B"), ("viscous_force_N", "viscous drag"),
        ("applied_force_N", "applied"), dashed=(len(spring) + 5,),
    )  # fmt: skip
    shown = "applied_force_N" in turn.columns
    applied = " Applied: weight and external force." if shown else ""
    return angle_figure(
        turn, "forces", "Force components on the follower",
        "Components along the arc of the roller centre; the side force is along the arm."
        if turn.on_arm
        else "Components along the stem; the side force is perpendicular to it and carried by the "
        f"guides.{applied}",
        Panel("force", "N", curves, height=1.25),
    )  # fmt: skip


def _spring_force(turn: SheetTurn) -> Figure | None:
    """Figure of the spring force, N, over the travel in use, mm; of a coil spring with its force at
    solid length. None without travel.
    """
    spring = turn.case.get("spring", {})
    lift, first = np.unique(turn.columns["lift_mm"], return_index=True)
    if lift.size < 2 or not turn.sprung:
        return None
    force = turn.columns["spring_force_N"][first]
    at = np.linspace(lift[0], lift[-1], _TRAVEL_POINTS)
    used = np.interp(at, lift, force)
    limits: tuple[LimitLine, ...] = ()
    rate = (force[-1] - force[0]) / (lift[-1] - lift[0])
    free, wire = (turn.length("spring", "design", key) for key in ("free_length", "wire_diameter"))
    coils = spring.get("design", {}).get("coils")
    if free and wire and isinstance(coils, (int, float)) and spring.get("kind", "coil") == "coil":
        solid = wire * (coils + _DEAD_COILS)
        limits = (LimitLine(float(rate * (free - solid)), "all coils closed"),)
    return over(
        "spring-force", "Spring force over the travel",
        "Force of the spring at the lifts of the turn, without friction and surge.",
        "lift", "mm", (Panel("force", "N", (Curve(at, used),), limits, from_zero=True),),
    )  # fmt: skip


def _energy(turn: SheetTurn) -> Figure | None:
    """Figure of the energies, J: stored in spring and motion of the follower; work of the cam and
    friction of the guides since cam angle 0. None without the mass of the follower.
    """
    c = turn.columns
    mass = turn.length("follower", "mass", unit="kg")
    if mass is None:
        return None
    theta, lift = np.radians(c["cam_angle_deg"]), 1e-3 * c["lift_mm"]
    spring = _summed(c["spring_force_N"], lift)
    speed = c["follower_velocity_m_per_s"]
    guides = [c[name] for name in ("guide_friction_A_N", "guide_friction_B_N") if name in c]
    friction = np.sum([np.zeros_like(lift), *guides], axis=0)
    rubbing = _summed(np.abs(friction * speed) / c["cam_speed_rad_per_s"], theta)
    drag = _summed(np.abs(c["viscous_force_N"] * speed) / c["cam_speed_rad_per_s"], theta)
    rest = turn.case.get("follower", {}).get("face") is not None
    stored, moving = spring - spring[np.argmin(lift)], 0.5 * mass * speed**2
    put_in = _summed(c["cam_torque_Nm"], theta)
    kinetic = Curve(turn.crank, moving, "kinetic, of the follower", "green")
    held = Curve(turn.crank, stored, "spring, above zero lift")
    curves = (held, kinetic) if turn.sprung else (kinetic,)
    within = "stored in the spring and in the motion" if turn.sprung else "in the motion"
    work = (Curve(turn.crank, put_in, "work of the cam", "vermillion"),
            Curve(turn.crank, rubbing + drag, "guide friction", "muted"))  # fmt: skip
    heat = "" if turn.on_arm else " and heat of the guides"
    note = " The face rubs on the cam as well." if rest else ""
    return angle_figure(
        turn, "energy", "Energy flow over the cycle",
        f"Energy {within} of the follower; work that the cam has put into the follower{heat} since"
        f" cam angle 0.{note}",
        Panel("energy", "J", curves), Panel("since angle 0", "J", work), mark=False,
    )  # fmt: skip


def _summed(values: Array, over: Array) -> Array:
    """Integral (n,) of values (n,) over positions (n,) from the first one, by the
    trapezoidal rule.
    """
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(over)
    return np.concatenate([[0.0], np.cumsum(np.nan_to_num(steps))])


def _load_cases(turn: SheetTurn) -> Figure | None:
    """Figure of the load cases as bars side by side: greatest magnitudes over the turn of normal
    force, N, contact pressure, MPa, guide reactions, N, and cam torque, N m; None of a single load
    case.
    """
    if len(turn.others) < 2:
        return None
    names = tuple(name for each in turn.others for name in each.load_cases)
    x = np.arange(1.0, len(names) + 1.0)

    def largest(column: str) -> Array:
        return np.array([np.max(np.abs(np.nan_to_num(each[column]))) for each in turn.others])

    def bars(title: str, unit: str, *rows: tuple[str, str], limits: tuple[LimitLine, ...] = (),
             notes: tuple[str, ...] = ()) -> Panel:  # fmt: skip
        curves = tuple(
            Curve(x, largest(column), label, colour, "bar", notes=notes if not k else ())
            for k, ((column, label), colour) in enumerate(zip(rows, SERIES, strict=False))
        )
        return Panel(title, unit, curves, limits, height=0.75, from_zero=True)

    pressure = "p0_fe_MPa" if np.isfinite(turn.columns["p0_fe_MPa"]).any() else "p0_hertz_MPa"
    guides = (("guide_reaction_A_N", "guide A"), ("guide_reaction_B_N", "guide B"))
    ended = " Loads of a case in which the follower leaves the cam or locks do not occur."
    panels = (
        bars("normal force", "N", ("normal_force_N", ""), limits=_force_limits(turn), notes=names),
        bars("p0", "MPa", (pressure, ""), limits=endurance(turn)),
        *([] if turn.on_arm else [bars("guides", "N", *guides)]),
        bars("cam torque", "N m", ("cam_torque_Nm", "")),
    )
    return over(
        "load-cases", "Load cases side by side",
        f"Greatest values over the turn in each load case: {', '.join(names)}.{ended}",
        "load case", "", panels, counted=True,
    )  # fmt: skip


def _speed_sweep(turn: SheetTurn) -> Figure | None:
    """Figure of contact force and surge of the spring, N, over the speed of the machine's shaft,
    with resonances, at the first preload of the sweep; None without a sweep or with fewer than
    three speeds.
    """
    sweep = turn.sweep
    if sweep is None:
        return None
    rows = sweep["preload_N"] == sweep["preload_N"][0]
    speed, surge = sweep["crank_speed_rpm"][rows], sweep["surge_force_N"][rows]
    speed, first = np.unique(speed, return_index=True)
    if speed.size < 3:
        return None
    columns = (("contact_force_max_N", "greatest"), ("contact_force_min_N", "least"),
               ("elastic_force_min_N", "least, elastic stem"))  # fmt: skip
    forces = tuple(Curve(speed, sweep[name][rows][first], label, colour)
                   for (name, label), colour in zip(columns, SERIES, strict=False))  # fmt: skip
    surge = surge[first]
    marks = tuple(AxisMark(float(speed[k]), f"resonance {speed[k]:.0f} rpm") for k in _peaks(surge))
    panels = [Panel("contact force", "N", forces, _lost(turn))]
    if np.any(surge):
        panels.append(Panel("spring surge", "N", (Curve(speed, surge),), height=0.8))
    return over(
        "speed-sweep", "Speed sweep",
        f"Extremes over a turn at constant speeds of the {turn.words.shaft}, surge of the spring "
        "included; resonances of the spring with the harmonics of the lift.",
        f"{turn.words.shaft} speed", "rpm", panels, marks=marks,
    )  # fmt: skip


def _peaks(values: Array) -> list[int]:
    """Indices, ascending, of the at most three highest maxima of `values` (n,).

    A maximum counts if it rises by `_PROMINENCE` of the greatest value above the higher of the lows
    on its two sides, each between it and the next greater value.
    """
    inner = range(1, values.size - 1)
    highest = [k for k in inner if values[k] > values[k - 1] and values[k] >= values[k + 1]]

    def stands_out(k: int) -> float:
        left, right = values[:k], values[k + 1 :]
        higher = np.flatnonzero(left > values[k])
        low_left = left[higher[-1] + 1 if higher.size else 0 :].min()
        higher = np.flatnonzero(right > values[k])
        low_right = right[: higher[0] if higher.size else None].min()
        return float(values[k] - max(low_left, low_right))

    clear = [k for k in highest if stands_out(k) > _PROMINENCE * float(values.max())]
    return sorted(sorted(clear, key=lambda k: -values[k])[:3])


def _force_limits(turn: SheetTurn) -> tuple[LimitLine, ...]:
    """Greatest normal force that both the roller bearing and its outer ring carry."""
    return lowest(
        *turn.static_rating("static rating of the roller", "roller_static", "roller", "bearing",
                            "C0"),
        *turn.limit("dynamic limit of the outer ring", "N", "roller_radial"),
        *turn.limit("static limit of the outer ring", "N", "roller_static_radial"),
    )  # fmt: skip


def _normal_force(turn: SheetTurn) -> Figure | None:
    curves = curves_of(
        turn, ("normal_force_N", "normal force"), ("axial_force_N", "axial force"),
        ("normal_force_statics_N", "normal force, point guides"), dashed=(2,),
    )  # fmt: skip
    shares = (
        ("normal_force_by_length_N", "guide length"),
        ("normal_force_by_clearance_N", "guide clearance"),
    )
    ends = "Contact is lost where the normal force reaches zero."
    if turn.walls is not None:
        ends = "Where the normal force reaches zero the other track takes over."
    return angle_figure(
        turn, "normal-force", "Normal force",
        "Contact force between cam and follower and its component along the arc of the roller "
        f"centre. {ends}"
        if turn.on_arm
        else "Contact force between cam and follower and its component along the stem, guide "
        "friction included; change by the finite length and by the clearance of the guides. "
        f"{ends}",
        Panel("force", "N", curves, (*_lost(turn), *_force_limits(turn))),
        Panel("change", "N", curves_of(turn, *shares), height=0.6),
    )  # fmt: skip


def _guides(turn: SheetTurn) -> Figure | None:
    """Figure of the guide reactions, N: by elastic guides and by statics; their change by length
    and by clearance of the guides; sum of the forces on both sides of each bore.
    """
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


def _pivot(turn: SheetTurn) -> Figure | None:
    """Figure of the load of the pivot, N, greatest and mean pressure in its bush, MPa, and its
    friction as a force on the arc of the reference point, N, with limits; None without a load of a
    pivot.
    """
    load = turn.columns.get("pivot_load_N")
    if load is None:
        return None
    sizes = [turn.length("follower", "pivot", "bush", key) for key in ("length", "diameter")]
    by_slices = ("pivot_edge_pressure_foundation_MPa", "the same by a rigid pin in slices")
    names = ("pivot_edge_pressure_MPa", "greatest, at the edge"), by_slices
    pressures = [*curves_of(turn, *names, dashed=(1,))]
    if sizes[0] and sizes[1]:
        mean = load / (sizes[0] * sizes[1])
        pressures.append(Curve(turn.crank, mean, "mean", "green"))
    rating = turn.static_rating(
        "static rating", "pivot_static", "follower", "pivot", "needle_bearing", "C0"
    )
    limits = turn.limit("edge limit", "MPa", "pivot_edge_pressure") + turn.limit(
        "limit of the mean", "MPa", "pivot_pressure"
    )
    return angle_figure(
        turn, "pivot", "Load, pressure and friction of the pivot",
        "Reaction of the pivot to contact, spring, inertia and all that acts on the arm; pressure "
        "of its pin in the bush, at the edge with the couple of the contact, and mean over the "
        "projected area; its friction as a force on the arc of the reference point.",
        Panel("load", "N", curves_of(turn, ("pivot_load_N", "")), rating),
        Panel("pressure", "MPa", tuple(pressures), limits, height=0.9),
        Panel("friction", "N", curves_of(turn, ("pivot_friction_N", "")), height=0.6),
    )  # fmt: skip


def _jamming(turn: SheetTurn) -> Figure | None:
    """Figure of the jam index, guide friction over axial force, over the turn; None of an arm."""
    if turn.on_arm:  # it has no guides
        return None
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


def _speed(turn: SheetTurn) -> Figure | None:
    """Figure of the follower speed, m/s, and of mean pressure times speed in both guides, MPa m/s,
    with their limits.
    """
    velocity = turn.columns["follower_velocity_m_per_s"]
    curves: list[Curve] = []
    means: list[Curve] = []
    limits: list[LimitLine] = []
    fastest = lowest(*turn.limit("limit", "m/s", "guide_speed_A"),
                     *turn.limit("limit", "m/s", "guide_speed_B"))  # fmt: skip
    for name, colour in (("A", "blue"), ("B", "vermillion")):
        length = turn.length("guides", name.lower(), "length")
        diameter = turn.length("guides", name.lower(), "diameter")
        load = turn.columns.get(f"guide_normal_load_{name}_N")
        if length and diameter and load is not None:
            pv = np.abs(load * velocity) / (length * diameter)
            curves.append(Curve(turn.crank, pv, f"guide {name}", colour))
            means.append(replace(curves[-1], y=np.full_like(pv, pv.mean())))
            limits += turn.limit(f"limit {name}", "MPa m/s", f"guide_pv_{name}")
    return angle_figure(
        turn, "speed", "Follower velocity" if turn.on_arm else "Follower velocity and guide PV",
        "Of the roller centre along its arc."
        if turn.on_arm
        else "PV: guide force over projected area, times sliding speed; its limit is one of the "
        "mean over the turn.",
        Panel("velocity", "m/s", curves_of(turn, ("follower_velocity_m_per_s", "")),
              both_ways(fastest), height=0.8),
        Panel("PV", "MPa m/s", tuple(curves), height=0.9),
        Panel("mean PV", "MPa m/s", tuple(means), tuple(dict.fromkeys(limits)), height=0.7,
              from_zero=True),
    )  # fmt: skip


def _roller(turn: SheetTurn) -> Figure | None:
    creepage = [
        replace(
            each,
            y=1e6 * each.y,
            lower=None if each.lower is None else 1e6 * each.lower,
            upper=None if each.upper is None else 1e6 * each.upper,
        )
        for each in curves_of(turn, ("creepage", ""))
    ]
    limits = lowest(*turn.limit("limit with reserve", "", "traction_reserve"),
                    *turn.limit("coefficient of friction", "", "traction_demand"))  # fmt: skip
    return angle_figure(
        turn, "roller", "Roller: speed, traction and slip",
        "Speed and acceleration of a roller without slip, traction coefficient that its rotation "
        "requires, creepage, and slip speed where the available friction is too small.",
        Panel("speed", "rpm", curves_of(turn, ("roller_speed_rpm", "")),
              turn.limit("limit", "rpm", "roller_speed"), height=0.7),
        Panel("acceleration", "rad/s²", curves_of(turn, ("roller_acceleration_rad_per_s2", "")),
              height=0.7),
        Panel("traction", "", curves_of(turn, ("traction_demand", "")), limits, height=0.7),
        Panel("creepage", "um/m", tuple(creepage), height=0.6),
        Panel("slip", "m/s", curves_of(turn, ("slip_speed_m_per_s", "")), height=0.6),
    )  # fmt: skip


def _film(turn: SheetTurn) -> Figure | None:
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


def _edge_pressure(turn: SheetTurn) -> Figure | None:
    """Figure of the peak pressure between stem and bore, MPa, and of the friction heat of the
    guides, W, with limits.
    """
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


def _elastic(turn: SheetTurn) -> Figure | None:
    forces = (
        ("contact_force_elastic_stem_N", "elastic stem, no friction"),
        ("normal_force_friction_min_N", "minimum friction"),
        ("normal_force_friction_max_N", "maximum friction"),
    )
    return angle_figure(
        turn, "elastic", "Contact force: elastic stem, friction bounds",
        "Contact force with an elastic stem at the computed cam speed, and with minimum and "
        "maximum guide friction.",
        Panel("contact force", "N", curves_of(turn, *forces), _lost(turn)),
        Panel("shortening", "um", curves_of(turn, ("stem_shortening_um", "")), height=0.7),
        Panel("cam speed", "rad/s", curves_of(turn, ("cam_speed_rad_per_s", "")), height=0.6),
    )  # fmt: skip


def _parts(turn: SheetTurn) -> Figure | None:
    """Figure of the stresses in spring, pin, outer ring, key and bore, each on its own axes with
    its limit where a check has one of the same stress, and of the shaft bearing loads.
    """
    stresses = (
        ("spring_stress_MPa", "spring wire", ()),
        ("pin_stress_MPa", "roller pin", turn.limit("limit", "MPa", "roller_pin")),
        ("ring_stress_amplitude_MPa", "outer ring", ()),
        ("key_pressure_MPa", "key", turn.limit("limit", "MPa", "key_pressure")),
        ("bore_pressure_MPa", "bore", turn.limit("limit", "MPa", "bore_pressure")),
    )
    panels = [
        Panel(part, "MPa", curves_of(turn, (column, "")), limits, height=0.6)
        for column, part, limits in stresses
    ]
    rating = turn.static_rating(
        "static rating", "shaft_bearing_static", "camshaft", "bearing_static_rating"
    )
    bearings = (("shaft_bearing_load_1_N", "bearing 1"), ("shaft_bearing_load_2_N", "bearing 2"))
    return angle_figure(
        turn, "parts", "Spring, roller pin, outer ring, key and camshaft",
        "Of the parts that the case describes: shear stress of the spring wire, bending stress of "
        "the roller pin, stress amplitude of the outer ring, pressure on key and bore.",
        *panels,
        Panel("spring surge", "N", curves_of(turn, ("spring_surge_force_N", "")), height=0.6),
        Panel("bearing load", "N", curves_of(turn, *bearings), rating, height=0.8),
    )  # fmt: skip


def _relative(point: Record) -> tuple[str, float, float]:
    """Name, mean over strength and amplitude over endurance of a point."""
    mean, amplitude = point["mean_MPa"], point["amplitude_MPa"]
    return str(point["name"]), mean / point["strength_MPa"], amplitude / point["endurance_MPa"]


def _goodman(turn: SheetTurn, part: str) -> Figure | None:
    """Goodman diagram of a part: amplitude over endurance strength by mean stress over static
    strength; None where its fatigue is not recorded.
    """
    record = turn.fatigue.get(part)
    if record is None:
        return None
    required, points = float(record["required_safety"]), list(map(_relative, record["points"]))
    x = np.array(sorted({0.0, 1.0, 1.0 / required} | {mean for _, mean, _ in points}))
    curves = [
        Curve(x, 1.0 - x, "Goodman line", "fail"),
        Curve(x, np.clip(1.0 / required - x, 0.0, None), f"safety {required:.3g}", "muted"),
    ]
    for (label, mean, amplitude), colour in zip(points, cycle(SERIES), strict=False):
        curves.append(Curve(x, np.where(x == mean, amplitude, np.nan), label, colour, "spot"))
    first = record["points"][0]
    return over(
        f"goodman-{part}", f"Goodman diagram of the {part}",
        "Amplitude of the stress over the endurance strength, by mean stress over the static "
        "strength, where it is used most; safe below the grey line. Endurance of the "
        f"{first['name']} {number(first['endurance_MPa'])} MPa, strength "
        f"{number(first['strength_MPa'])} MPa.",
        "mean stress / strength", "",
        (Panel("amplitude / endurance", "", tuple(curves), height=1.3, from_zero=True),),
        dots=False,
    )  # fmt: skip


PART_FIGURES: tuple[Callable[[SheetTurn], Figure | None], ...] = (
    _forces, _spring_force, _energy, _load_cases, _speed_sweep, _normal_force, _guides, _pivot,
    _jamming, _speed, partial(_goodman, part="spring"), partial(_goodman, part="camshaft"),
    _edge_pressure, _elastic, _roller, _film, _parts,
)  # fmt: skip
