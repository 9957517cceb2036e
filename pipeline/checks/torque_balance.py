"""Checks of ripple reduction and energy balance."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import first_least
from camwright.pipeline.base import levers
from camwright.pipeline.base.cooling import housing_area
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import (
    CONTACT_TORQUE,
    DRIVE_TORQUE,
    FRICTION_BALANCE,
    FRICTION_POWER,
    SPEED_REDUCTION,
    TORQUE_REDUCTION,
)
from camwright.pipeline.checks import demands
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import FIRED, RIPPLE, STATED, STEADY, Demand, check
from camwright.pipeline.checks.extremes import (
    Extreme,
    cam_of,
    cycle_of,
    fired,
    greatest,
    over_duty,
    row_of,
    steady,
    worst_case,
)
from camwright.pipeline.checks.missing_keys import unset
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.numbers import Numbers, disc_radius
from camwright.pipeline.cycle.solution import Solution

# rad: truncation and round-off of a chord along the tangent are below 1e-9.
_CHORD = 1e-5
NO_MEAN = 1e-6
"""Mean over the greatest torque of a machine below which it states no power."""


# A gentler lift lowers the reduction: lift_can_help stays False.
@check(
    TORQUE_REDUCTION,
    title="Torque ripple reduction",
    tier=Tier.SCREENING,
    formula="min over the load cases of 1 - (1 - c)/(1 - c_i) std(T_e - T_c)/std(T_e) >= c; T_e,"
    " T_c: torque of machine and cam about their means, c_i: load_case.torque_reduction, else"
    " limits.torque_reduction, c: the greatest c_i",
    symbols={
        "std(T_e)": "std(torque_before) [N m]",
        "std(T_e - T_c)": "std(torque_after) [N m]",
        "c": "torque.greatest_reduction",
        "c_i": "torque.required_reduction",
    },
    reason="It is the purpose of the cam.",
    method="1 - std of the torque with the cam, friction and inertia included, over that"
    " without it",
    load_cases=RIPPLE,
    values=given.LOADS,
    levers=levers.STRONGER,
    page="Torque",
)
def torque_reduction(solution: Solution) -> Demand | None:
    """Least relative reduction of the torque ripple by the cam over the load cases that require
    one; None where no load case with an engine torque does.
    """
    least = least_reduction(solution, _reduction)
    if least is None:
        return None
    worst, common = least
    free = [machine.load_case for machine in solution.machines if not machine.torque_reduction]
    notes = [f"not required in {', '.join(free)}"] if free else []
    required = next(m for m in solution.machines if m.load_case == worst.load_case).torque_reduction
    if required is not None and required != common:
        value = shown(float(demands.common_reduction(worst.value, common, required)), "", 3)
        notes.append(f"{value} in {worst.load_case}, where {shown(required, '')} is required")
    return Demand(worst.value, common, worst, note="; ".join(notes))


def least_reduction(
    solution: Solution, reduction: Callable[[Cycle], float]
) -> tuple[Extreme, float] | None:
    """Least torque ripple reduction, converted to the greatest requirement; that requirement.

    Of load cases with other requirements it is the `common_reduction`. None where no load case
    requires one.

    Parameters
    ----------
    reduction : callable   cycle with an engine torque -> reduction of its ripple
    """
    required = {
        machine.load_case: machine.torque_reduction
        for machine in solution.machines
        if machine.torque_reduction is not None
    }
    cycles = [
        cycle
        for cycle in solution.cycles
        if cycle.turn.torque_before is not None and cycle.load_case in required
    ]
    if not cycles:
        return None
    common = max(required[cycle.load_case] for cycle in cycles)

    def comparable(cycle: Cycle) -> float:
        requirement = required[cycle.load_case]
        return float(demands.common_reduction(reduction(cycle), requirement, common))

    return worst_case(cycles, comparable, at_least=True), common


drive_torque = check(
    DRIVE_TORQUE,
    id="drive_torque",
    title="Torque that drives the cam",
    unit="N m",
    formula="max |T_c| <= T; T_c: torque of the cam, friction and inertia included, T:"
    " limits.drive_torque",
    symbols={"T_c": "cam_torque"},
    reason="A drive of less torque stalls.",
    method="greatest magnitude of the cam torque",
    tier=Tier.SCREENING,
    lift_can_help=True,
    if_limited=True,
    values=given.LOADS,
    levers=levers.LOAD,
    page="Torque",
).measured(
    "angles",
    deviation=0.005,
)(demands.cam_torque)


@check(
    SPEED_REDUCTION,
    title="Speed ripple reduction",
    formula="min over the load cases of 1 - (1 - c)/(1 - c_i) std(w_c)/std(w_e) >= c; w_c, w_e:"
    " crank speed with and without the cam, c_i: load_case.speed_reduction, else"
    " limits.speed_reduction, c: the greatest c_i, both 0 where none is required",
    symbols={
        "std(w_c)": f"{STATED} [rad/s]",
        "std(w_e)": f"{STATED} [rad/s]",
        "c": STATED,
        "c_i": STATED,
    },
    reason="Decides where the case requires it.",
    method="1 - std of the speed with the cam over that of the machine alone,"
    " inertia of shaft and follower included",
    load_cases=RIPPLE,
    values=(*given.LOADS, "crankshaft.inertia", "crankshaft.mechanism_inertia"),
    levers=levers.STRONGER,
    page="Torque",
)
def speed_reduction(solution: Solution) -> Demand | None:
    """Least relative reduction of the crank speed ripple by the cam, over the load cases that
    require one or, where none does, over those whose ripple counts; None without a crankshaft or
    such a load case.
    """
    required = {
        machine.load_case: machine.speed_reduction
        for machine in solution.machines
        if machine.speed_reduction is not None
    }
    common = max(required.values(), default=None)
    # without a requirement the value is that of the load cases whose ripple counts
    counting = {each.load_case: 0.0 for each in solution.machines if each.ripple_weight > 0}
    judged = required or counting

    def share(load_case: str, speeds: tuple[float, float]) -> float:
        reduction = _reduced(*speeds)
        return float(demands.common_reduction(reduction, judged[load_case], common or 0.0))

    shares = {
        name: share(name, speeds) for name, speeds in solution.crank_speed.items() if name in judged
    }
    if not shares:
        return None
    worst = list(shares)[first_least(list(shares.values()))]
    value, halved = shares[worst], solution.crank_speed_halved.get(worst)
    # change with every second crank angle alone
    error = 0.0 if halved is None else _relative(share(worst, halved) - value, abs(value))
    without, with_cam = solution.crank_speed[worst]
    return Demand(
        value,
        common,
        Extreme(value, worst, None, error),
        () if common is not None else unset(solution.machine.limits, SPEED_REDUCTION),
        must_have=common is not None,
        stated={
            "std(w_c)": with_cam,
            "std(w_e)": without,
            "c": common or 0.0,
            "c_i": judged[worst],
        },
    )


def _reduced(before: float, after: float) -> float:
    return 1.0 - after / before if before > 0 else np.nan


def _reduction(cycle: Cycle) -> float:
    """Relative reduction of the torque ripple by the cam in a load case; NaN without an engine."""
    before, after = cycle.turn.torque_before, cycle.turn.torque_after
    if before is None or after is None:
        return np.nan
    return float(demands.ripple_reduction(before, after))


@check(
    CONTACT_TORQUE,
    title="Cam torque from the contact pressures vs. forces on the follower",
    method="moment of the solved pressures about the cam axis with their lever arms on the contour,"
    " against axial force times s' plus sliding torque, at every angle, over the greatest torque",
    evidence=True,
    tier=Tier.CYCLE,
    moved_by_tolerance=False,
    formula="|T_p - T| / T_max <= c; T_p: sum of r x f, r: points of the contour in the contact, f:"
    " solved pressure and face friction on them, T: F_a s' + T_s, F_a: axial force, s': slope of"
    " the lift, T_s: sliding torque of a face, T_max: greatest |T| over the turn, without one the"
    " greatest normal force times the greatest radius, c: limits.contact_torque",
    symbols=dict.fromkeys(("T_p", "T", "T_max"), f"{STATED} [N m]"),
    reason="Contact, contour and forces on the follower are solved apart: an error in one of them"
    " shows in no other balance.",
)
def contact_torque(solution: Solution) -> Demand:
    """Greatest difference of the cam torque by contact pressures from that by forces, over the
    greatest torque of the turn.
    """

    def share(cycle: Cycle) -> Array:
        torque = cycle.loads.cam_torque
        return np.abs(pressure_torque(cycle) - torque) / _greatest_torque(cycle)

    worst = greatest(solution.cycles, share)
    cycle, k = row_of(solution.cycles, worst)
    stated = {
        "T_p": float(pressure_torque(cycle)[k]),
        "T": float(cycle.loads.cam_torque[k]),
        "T_max": _greatest_torque(cycle),
    }
    return Demand(worst.value, solution.machine.limits[CONTACT_TORQUE], worst, stated=stated)


def _greatest_torque(cycle: Cycle) -> float:
    """Greatest magnitude of the cam torque, N m, or that to compare one of zero with."""
    return float(np.max(np.abs(cycle.loads.cam_torque))) or _force_moment(cycle)


@check(
    CONTACT_TORQUE,
    id="contact_work",
    title="Cam work from the contact pressures vs. friction heat",
    method="work of the pressures over the turn less that of spring, inertia, weight and external"
    " force, against the heat of guides and face, over the energy exchanged",
    evidence=True,
    tier=Tier.CYCLE,
    moved_by_tolerance=False,
    formula="|W - Q| / E <= c; W: integral of T_p - (F_c + F_i) s' over a turn, T_p: cam torque"
    " of the contact pressures, F_c: spring force, weight and external force, F_i: inertia force,"
    " s': slope of the lift, Q: friction heat of guides and face over a turn, E: half of the"
    " integral of |T|, T: cam torque, c: limits.contact_torque",
    symbols=dict.fromkeys("WQE", f"{STATED} [J]"),
    reason="Energy must not appear or vanish between the contact and the guides.",
)
def contact_work(solution: Solution) -> Demand:
    """Difference of the cam work by contact pressures and the friction heat over the work
    exchanged, of a turn.
    """

    def works(cycle: Cycle) -> tuple[float, float, float]:
        """Work of the pressures, heat, and work exchanged, J."""
        step = FULL_TURN / cycle.theta.size
        exchanged = 0.5 * step * float(np.sum(np.abs(cycle.loads.cam_torque)))
        exchanged = exchanged or FULL_TURN * _force_moment(cycle)
        return _friction_loss(cycle, pressure_torque(cycle)), _heat(cycle), exchanged

    def share(cycle: Cycle) -> float:
        work, heat, exchanged = works(cycle)
        return _relative(work - heat, exchanged)

    worst = worst_case(solution.cycles, share, integral=False)
    stated = dict(zip("WQE", works(cycle_of(solution.cycles, worst)), strict=True))
    return Demand(worst.value, solution.machine.limits[CONTACT_TORQUE], worst, stated=stated)


def pressure_torque(cycle: Cycle) -> Array:
    """Cam torque (n,) from contact pressures and the friction of a face, N m.

    The normal of the contour is that of its points. The pressure of a position acts along one
    normal: its change over the contact is of the order of half-width over radius. Of preloaded
    discs that of both contacts.
    """
    torque = _torque_of(cycle, cycle.pair, cycle.contact)
    if cycle.idle is None:
        return torque
    return torque + _torque_of(cycle, cycle.pair.other_track, cycle.idle)


def _torque_of(cycle: Cycle, carrying: ContactPair, contact: ContactHistory) -> Array:
    """Cam torque (n,), N m, of the contacts of a pair on the surface that carries at each angle."""
    theta = cycle.theta
    (x, y), (tx, ty) = np.empty((2, 2, theta.size))
    for pair, at in carrying.on_walls(theta):
        (x[at], y[at]), _ = pair.touched(theta[at])
        tx[at], ty[at] = _tangent_of_points(pair.contour, pair.angle(theta[at]))
    xi, width = contact.pressure_xi, carrying.width
    force = width * _integral(contact.pressure, xi)
    # xi runs clockwise, against the tangent of the contour
    couple = width * _integral(contact.pressure * xi, xi)
    # outward normal (t_y, -t_x); the follower travels counter-clockwise about the cam
    normal = (x * tx + y * ty) * force - couple
    return np.asarray(normal + cycle.machine.follower.side_friction * (x * ty - y * tx) * force)


def _tangent_of_points(contour: Contour, theta: Array) -> Array:
    """Unit tangents (2, n) by differences of points; with the material on their left."""
    ahead = contour.points(theta + _CHORD) - contour.points(theta - _CHORD)
    along = np.sign(np.sum(ahead * contour.tangent(theta), axis=0))
    return np.asarray(along * ahead / np.hypot(*ahead))


def _force_moment(cycle: Cycle) -> float:
    """Greatest contact force times the radius of the cam, N m: for a cam without torque."""
    return float(np.max(cycle.loads.normal_force)) * cycle.contour.radius_max().value


def _integral(values: Array, at: Array) -> Array:
    """Integral (n,) along each row by the trapezoidal rule."""
    return np.asarray(0.5 * np.sum((values[:, 1:] + values[:, :-1]) * np.diff(at, axis=1), axis=1))


@check(
    FRICTION_BALANCE,
    title="Friction work vs. heat in guides and face",
    formula="|W - Q| / max(Q, 1e-9 E) <= c; W: integral of T - (F_c + F_i) s' over a turn, T: cam"
    " torque, F_c: spring force, weight and external force, F_i: inertia force, s': slope of the"
    " lift, Q: friction heat of guides and face over a turn, E: energy of the spring at maximum"
    " lift, c: limits.friction_balance",
    symbols=dict.fromkeys("WQE", f"{STATED} [J]"),
    reason="Work that the guides do not dissipate would be an error of the forces.",
    method="cam work less work of spring, inertia, weight and external force, against friction"
    " force times sliding distance of guides and face, relative",
    evidence=True,
    moved_by_tolerance=False,
)
def friction_balance(solution: Solution) -> Demand:
    """Greatest difference, over the load cases, of the work that friction takes from the cam and
    the heat of guides, pivot and face, relative to this heat.
    """
    worst = worst_case(solution.cycles, _heat_mismatch, integral=False)
    allowed = solution.machine.limits[FRICTION_BALANCE]
    words = (*map(_loss, solution.cycles), *_applied_work(solution.cycles))
    cycle = cycle_of(solution.cycles, worst)
    stated = {
        "W": _friction_loss(cycle, cycle.loads.cam_torque),
        "Q": _heat(cycle),
        "E": _stored(cycle),
    }
    return Demand(worst.value, allowed, worst, note="; ".join(words), stated=stated)


@check(
    FRICTION_POWER,
    title="Friction power of the mechanism vs. mean power of the machine",
    formula="max over the load cases of P_f/P <= c; P_f: mean power of the friction in guides,"
    " contact and roller bearing, P: load_case.power, else mean torque that drives or loads the"
    " machine's shaft, the greater, times its speed, c: limits.friction_power",
    symbols=dict.fromkeys(("P_f", "P"), f"{STATED} [W]"),
    reason="A cam that turns a good part of the machine's power into heat is no gain, and its"
    " parts run hot.",
    method="work of the friction over the turn, at the mean friction coefficients, over that of the"
    " machine; load cases that are fired",
    lift_can_help=True,
    tier=Tier.SCREENING,
    load_cases=FIRED,
    values=(*given.LOADS, "load_case.power"),
    levers=levers.GENTLER,
    page="Torque",
)
def friction_power(solution: Solution) -> Demand | None:
    """Greatest mean friction power over the power of the machine; None without a fired load
    case.
    """
    states = {state.name: state for state in solution.case.load_cases}
    running = fired(solution)
    if not running:
        return None
    allowed = solution.machine.limits[FRICTION_POWER]
    powers = {cycle.load_case: _power(cycle, states[cycle.load_case].power) for cycle in running}
    if np.isnan(list(powers.values())).any():
        return Demand(None, allowed, missing=("load_case.power",))

    worst = worst_case(
        running, lambda cycle: _friction_power(solution, cycle) / powers[cycle.load_case]
    )
    words = []
    for cycle in running:
        name = cycle.load_case
        lost, power = (
            shown(each, "W", 3) for each in (_friction_power(solution, cycle), powers[name])
        )
        words.append(f"{name}: {lost} of {power}")
    lossy = _friction_power(solution, cycle_of(running, worst))
    stated = {"P_f": lossy, "P": powers[worst.load_case]}
    return Demand(worst.value, allowed, worst, note="; ".join(words), stated=stated)


_HEAT_ROUND_OFF = 1e-12  # of the heat: round-off of the works that cancel
_STATED = (
    "lubricant.temperature",
    "roller.bearing.temperature",
    "spring.design.temperature",
    "guides.ambient_temperature",
)


@check(
    id="mechanism_temperature",
    title="Temperature of the mechanism vs. that at which its parts are judged",
    unit="degC",
    source=Source(
        "balance of heat; temperatures stated for oil, bearing, wire and around the guides, of the"
        " cards of metals",
        confirmed=True,
    ),
    formula="T_amb + (P_f + Q)/G <= least temperature stated for oil, roller bearing and wire and"
    " around the guides, above which their own friction warms the bushes, and to which limit and"
    " full strength of the metals hold by their cards; P_f: mean power of the"
    " friction in guides, contact and roller bearing, sum of q_i P_i of the load cases by"
    " load_case.duty, else the greatest P_i, T_amb, Q, G: cooling.ambient_temperature, .heat,"
    " .conductance; without G that of the box around cam and follower in still air, 10 W/(m^2 K)",
    symbols={
        "T_amb": "cooling.ambient_temperature - 273.15 [degC]",
        "P_f": f"{STATED} [W]",
        "Q": "cooling.heat",
        "G": f"{STATED} [W/K]",
    },
    reason="Viscosity, grease, relaxation of the wire, strength and clearance of the bushes are"
    " those of the stated temperatures, endurance and strength of the steels those of their cards:"
    " a machine that runs hotter is not the one that is judged.",
    method="mean friction power over the load cases by their duty, without a duty the greatest,"
    " over-speed left out, at the mean friction coefficients; the shaft's own bearings and the gear"
    " count in cooling.heat",
    lift_can_help=True,
    tier=Tier.SCREENING,
    load_cases=STEADY,
    values=(*given.LOADS, "load_case.duty", "cooling.*"),
    levers=(levers.one("cooling.conductance"), *levers.GENTLER),
    page="Torque",
)
def mechanism_temperature(solution: Solution) -> Demand | None:
    """Steady temperature of the mechanism, degC, by its friction and cooling, against the least
    temperature for which a part is stated; None where no part has one.
    """
    cooling, stated = solution.machine.cooling, stated_temperatures(solution.numbers)
    if not stated:
        return None
    area = float(box_area(2.0 * solution.contour.radius_max().value, solution.numbers))
    running = steady(solution)
    # in degrees Celsius, of which the error bar is a share
    worst = over_duty(
        running,
        lambda cycle: float(celsius(cooling.temperature(_friction_power(solution, cycle), area))),
    )
    least = min(stated, key=stated.__getitem__)
    warm, allowed = worst.value, celsius(stated[least])
    words = [
        f"{each.load_case}: {shown(_friction_power(solution, each), 'W', 3)}" for each in running
    ]
    note = f"friction of {', of '.join(words)}; least stated: {least}"
    if cooling.conductance is None and warm > allowed:
        still = f"{warm:.3g} degC"
        note += f"; {still} in still air around the box of cam and follower"
        return Demand(None, allowed, note=note, missing=("cooling.conductance",))
    if cooling.conductance is None:
        note += "; no cooling is stated: still air on the box around cam and follower"
    loss = over_duty(running, lambda cycle: _friction_power(solution, cycle)).value
    stated = {"P_f": loss, "G": float(cooling.carried(area))}
    return Demand(warm, float(allowed), worst, note=note, stated=stated)


def stated_temperatures(numbers: Numbers) -> dict[str, float]:
    """Temperatures, K, for which values of parts are stated, by key or material."""
    case = numbers.known_case
    # warmer than around the guides, by their own friction
    bushes = {guide.material.name for _, guide in case.guides.both}
    named = {key: numbers.get(key) for key in _STATED} | {
        name: card.holds_to
        for name, card in case.materials.items()
        if card.is_metal and name not in bushes
    }
    return {key: float(value) for key, value in named.items() if value is not None}


def box_area(across: Value, numbers: Numbers) -> Value:
    """Outer area of the box around a cam and its follower, m^2.

    across : of the contour, m; of a groove that of its disc counts, of two discs the greater one.
    """
    disc = disc_radius(numbers)
    across = across if disc is None else 2.0 * disc
    height = across + float(numbers.get("follower.stem_length") or 0.0)
    return housing_area(across, height, numbers["cam.width"])


def _friction_power(solution: Solution, cycle: Cycle) -> float:
    """Mean friction power of guides, contact and roller bearing, and that of landings, W."""
    rolling = cycle.rolling.contact
    micro_slip = 0.0 if rolling is None else rolling.loss / FULL_TURN
    rubbed = float(np.mean(cam_of(solution, cycle).friction_work)) + micro_slip
    return rubbed * cycle.cam_speed + cycle.landing_power


def _power(cycle: Cycle, stated: float | None) -> float:
    """Mean power of the machine in a load case, W: stated, or that of the mean torque; NaN where
    this has no mean, and none is stated.
    """
    throughput, before = cycle.turn.throughput, cycle.turn.torque_before
    if stated is not None:
        return stated
    if throughput is None or before is None or throughput <= NO_MEAN * np.abs(before).max():
        return np.nan
    return throughput * cycle.cam_speed * cycle.machine.gear_ratio


def _applied_work(cycles: Sequence[Cycle]) -> tuple[str, ...]:
    """Note on the work of an external force over a turn; empty for a constant force."""
    if not cycles[0].machine.external.varies:
        return ()
    work = cycles[0].loads.applied_work
    way = "takes" if work >= 0.0 else "gives"
    return (f"the external force {way} {shown(abs(work), 'J', 3)} a cam turn",)


def _stored(cycle: Cycle) -> float:
    """Energy stored at maximum lift, J."""
    return cycle.machine.spring.energy(float(cycle.contour.pitch.lift.highest.value))


def _touching_slope(cycle: Cycle) -> Array:
    """Slope of the lift (n,), m/rad, 0 where cam and follower are separated."""
    return np.where(cycle.loads.normal_force > 0, cycle.loads.lift_slope, 0.0)


def _heat(cycle: Cycle) -> float:
    """Friction heat of a turn, J; of guides, from the pressures in their bores, or of a pivot."""
    loads, slope = cycle.loads, _touching_slope(cycle)
    dragged = np.abs(loads.viscous_force * slope) + loads.rubbed
    rubbed = (cycle.parts.heat_a + cycle.parts.heat_b) / cycle.cam_speed
    rubbed = rubbed + np.abs(loads.pivot_friction * slope)
    return FULL_TURN / len(slope) * float(np.sum(rubbed + dragged))


def _loss(cycle: Cycle) -> str:
    """Friction loss of a load case in words: power, and share of the energy stored in a spring."""
    heat, stored = _heat(cycle), _stored(cycle)
    sprung = stored > 0 and not cycle.machine.spring.absent
    share = f" or {heat / stored:.1%} of the stored energy" if sprung else ""
    return f"{cycle.load_case}: {shown(heat * cycle.cam_speed / FULL_TURN, 'W', 3)}{share}"


def _friction_loss(cycle: Cycle, torque: Array) -> float:
    """Work of a cam torque (n,) over a turn less that of closing and inertia force, J."""
    loads, slope = cycle.loads, _touching_slope(cycle)
    spent = torque - (loads.closing_force + loads.inertia_force) * slope
    return FULL_TURN / len(slope) * float(np.sum(spent))


def _heat_mismatch(cycle: Cycle) -> float:
    """Difference of friction work and friction heat of a turn over this heat, or over 1e-9 of the
    energy stored in the spring where that is larger; zero within round-off.
    """
    heat = _heat(cycle)
    loss = _friction_loss(cycle, cycle.loads.cam_torque)
    share = _relative(loss - heat, max(heat, 1e-9 * _stored(cycle)))
    return 0.0 if share < _HEAT_ROUND_OFF else share  # no load case is the worst by its round-off


def _relative(part: float, whole: float) -> float:
    """|part| / whole; 0 for a part of zero."""
    if np.isnan(part) or np.isnan(whole):
        return np.nan
    return 0.0 if part == 0.0 else float(np.divide(abs(part), whole)) if whole > 0 else np.inf
