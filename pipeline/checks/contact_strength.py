"""Checks of the contact pressure: endurance, yield, shakedown, of cam and follower.

An allowable pressure is the least over both bodies. A body without the datum leaves the check
without a limit, unless the limit of the other body is exceeded already.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import first_greatest, first_least
from camwright.pipeline.base import disk_cache, levers
from camwright.pipeline.base.material import Endurance, Material
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    AXIS_PARALLELISM,
    CAM_RUN_OUT,
    CONTACT_SAFETY,
    END_MEAN_LENGTH,
    ROLLER_CLEARANCE,
    SHAKEDOWN_SAFETY,
    TARGET_LIFE,
    YIELD_SAFETY,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import LASTING, NONE, STATED, Allowed, Demand, Kept, check
from camwright.pipeline.checks.demands import PRESSURE
from camwright.pipeline.checks.extremes import (
    Extreme,
    greatest,
    on_both_tracks,
    pressed_row,
    tracks_of,
)
from camwright.pipeline.checks.missing_keys import (
    lacking,
    lacking_along_line,
    lacking_of_card,
    no_friction,
    unset,
)
from camwright.pipeline.contact import hertz, rolling_envelope
from camwright.pipeline.contact.closed_form import in_full
from camwright.pipeline.contact.conforming_line import ANGLE_MAX
from camwright.pipeline.contact.rolling_envelope import smallest_sphere
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.length_history import factor_at_pressure
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.follower_kind import FollowerKind

PSI = 6894.757293168  # Pa
SHAKEDOWN = 4.0  # p0 / k, free rolling line contact
FIRST_YIELD = 1.79  # p0 / Y, von Mises, line contact, nu = 0.3
FACE_PASSES = 2.0  # of the contact over a point of a flat face in a cam turn, at most
_ALONG_THE_LINE = {"K": "length_factor", "r": STATED, "p0": "p0_fe [MPa]"}
_EQUIVALENT = {
    "p0": "p0_fe [MPa]",
    "lambda": STATED,
    "k": "[MPa]",
    "Y": f"{STATED} [MPa]",
    "S": f"limits.{SHAKEDOWN_SAFETY.id}",
}
_TRACTIONS = 17  # nodes of the traction coefficient from 0 to that of full sliding
_CONTOUR_STATIONS = 720  # of the mean path speed of a follower


class LoadCycles(NamedTuple):
    """Load cycles of the most loaded point of cam and follower in the target life."""

    cam: float
    follower: float

    def of(self, body: str) -> float:
        """Load cycles of the cam, or of the follower."""
        return self.cam if body == "cam" else self.follower


class LeastLimit(NamedTuple):
    """Smaller limit of cam and follower, with its body and material card.

    value, SI; None: of neither body. body and card are those of the least; missing: dotted keys
    that the case lacks.
    """

    value: float | None
    body: str
    card: Material
    missing: tuple[str, ...] = ()

    @property
    def source(self) -> str:
        """Name and source of the material card."""
        return f"{self.card.name}: {self.card.source}"


def least_of_bodies(
    bodies: Mapping[str, Material],
    limit: Callable[[str, Material], float | None],
    lacks: Callable[[str, Material], tuple[str, ...]] = lambda *_: (),
) -> LeastLimit:
    """Smaller limit of cam and follower.

    Parameters
    ----------
    limit : callable   body, card -> limit, SI; None: the card lacks a datum
    lacks : callable   body, card -> keys that the card lacks
    """
    limits = {body: limit(body, card) for body, card in bodies.items()}
    stated = {body: value for body, value in limits.items() if value is not None}
    missing = tuple(
        key for body in limits if body not in stated for key in lacks(body, bodies[body])
    )
    body = list(stated)[first_least(list(stated.values()))] if stated else "cam"
    return LeastLimit(stated.get(body), body, bodies[body], missing)


def endurance_of(machine: Machine, card: Material) -> Endurance:
    """Endurance pressure of a body in rolling, or with sliding under a flat face."""
    return card.endurance(sliding=machine.follower.slides)


def pressure_allowables(machine: Machine, cycles: LoadCycles) -> dict[str, float]:
    """Plane-strain pressures, Pa, allowed by the checks of ends, traction and life; estimates.

    The least over both bodies; checks without data are left out. A solved cam corrects those of the
    ends. Under traction it is that of full sliding, the greatest traction of a follower: a roller
    that transmits less has more, see `equivalent_pressure`.
    """
    limits, follower = machine.limits, machine.follower
    ends = estimated_length_factor(machine)
    shear = shear_yield(machine)
    endurance = _least_endurance(machine)
    allowed = {}
    if ends is not None:
        allowed[edge_pressure.id] = _scaled(endurance, 1.0 / ends)
    if follower.friction is not None:
        factor = float(shakedown_factors(follower.friction, least_poisson(machine))[1][-1])
        allowed[shakedown_traction.id] = _scaled(shear, factor)
        if ends is not None:
            allowed[edge_shakedown.id] = _scaled(shear, factor / ends)
    if limits[TARGET_LIFE] is not None and ends is not None:
        allowed[contact_pressure_at_life.id] = _scaled(_life_limit(machine, cycles), 1.0 / ends)
    return {name: each.value for name, each in allowed.items() if each.value is not None}


def _life_limit(machine: Machine, cycles: LoadCycles) -> LeastLimit:
    """Least endurance pressure of cam and follower at the target life."""
    return least_of_bodies(
        machine.bodies,
        lambda body, card: _life_pressure(machine, body, card, cycles),
        lambda body, card: _life_lacks(machine, body, card, cycles),
    )


def _least_endurance(machine: Machine) -> LeastLimit:
    return _scaled(
        _endurance(machine.bodies, machine.follower), 1.0, machine.limits[CONTACT_SAFETY]
    )


def _endurance(bodies: Mapping[str, Material], follower: FollowerKind) -> LeastLimit:
    """Least endurance pressure of the bodies, without safety, Pa."""
    key = "sliding_endurance_pressure" if follower.slides else "endurance_pressure"
    return least_of_bodies(
        bodies,
        lambda _, card: card.endurance(sliding=follower.slides).pressure,
        lambda _, card: lacking_of_card(card, key),
    )


def endurance_allowed(numbers: Numbers) -> Allowed:
    """Allowed contact pressure, Pa: the lower endurance pressure of cam and follower over the
    safety.
    """
    least = _endurance(numbers.known_case.bodies, numbers.known_case.facing)
    value = None if least.value is None else least.value / numbers.limit(CONTACT_SAFETY)
    return Allowed(value, least.missing, if_exceeded=bool(least.missing))


def _shakedown_allowed(numbers: Numbers) -> Allowed:
    """Allowed contact pressure, Pa, at the shakedown limit of the weaker body without traction."""
    yields = min(card.yield_strength for card in numbers.known_case.bodies.values())
    return Allowed(SHAKEDOWN * (yields / (math.sqrt(3.0) * numbers.limit(SHAKEDOWN_SAFETY))))


def _life_pressure(machine: Machine, body: str, card: Material, cycles: LoadCycles) -> float | None:
    """Allowed contact pressure of a body, Pa, at its load cycles in the target life: by its line of
    endurance or, without one, its endurance pressure up to the number of load cycles of that. None
    where neither is known.
    """
    count = cycles.of(body)
    row, safety = endurance_of(machine, card), machine.limits[CONTACT_SAFETY]
    if row.slope is not None and row.intercept is not None:
        return pressure_at_life(count, row.slope, row.intercept, machine.contact_modulus) / safety
    if row.pressure is None or not count <= card.endurance_cycles:
        return None
    return row.pressure / safety


def _life_lacks(machine: Machine, body: str, card: Material, cycles: LoadCycles) -> tuple[str, ...]:
    """Keys that the material of a body lacks for its endurance at the target life: the line of
    endurance, or up to `endurance_cycles` the endurance pressure.
    """
    row = endurance_of(machine, card)
    stated = any(each is not None for each in row[1:])
    slides = row.motion != "rolling" if stated else machine.follower.slides
    of_motion = "sliding_" if slides else ""
    if row.pressure is None and cycles.of(body) <= card.endurance_cycles:
        return lacking_of_card(card, f"{of_motion}endurance_pressure")
    line = (f"{of_motion}endurance_{name}" for name in ("slope", "intercept"))
    return lacking_of_card(card, *line)


def _scaled(limit: LeastLimit, factor: float, safety: float = 1.0) -> LeastLimit:
    """The limit, Pa, times a factor and over a safety; unchanged where it is not known."""
    value = limit.value
    return limit if value is None else limit._replace(value=factor * value / safety)


def shear_yield(machine: Machine) -> LeastLimit:
    """Shear yield strength Y/sqrt(3) over the shakedown safety, Pa, the lower of both bodies."""
    safety = math.sqrt(3.0) * machine.limits[SHAKEDOWN_SAFETY]
    return least_of_bodies(machine.bodies, lambda _, card: card.yield_strength / safety)


def least_poisson(machine: Machine) -> float:
    """Smaller Poisson ratio of both bodies, which has the lower shakedown limit in sliding."""
    return min(card.nu for card in machine.bodies.values())


def estimated_length_factor(machine: Machine) -> float | None:
    """Greatest pressure along the line of contact over that of plane strain on the base circle,
    untilted, estimated from the ends; None where the ends are not stated, or no strength is.

    At the greatest pressure that the endurance allows, or else the yield strength.
    """
    pressure = _least_endurance(machine).value or shear_yield(machine).value
    pairs = machine.finite_pairs
    if not pairs or pressure is None:
        return None
    return max(
        factor_at_pressure(pair, pressure, machine.limits[END_MEAN_LENGTH]) for pair in pairs
    )


def life_turns(machines: tuple[Machine, ...]) -> float:
    """Cam turns in the target life of a machine in these load cases: by their duty or, if one has
    none, at the fastest; 0 without a target life.
    """
    life = machines[0].limits[TARGET_LIFE] or 0.0
    speed = max(machine.cam_speed for machine in machines)
    if all(machine.duty is not None for machine in machines):
        speed = sum((machine.duty or 0.0) * machine.cam_speed for machine in machines)
    return life * speed / FULL_TURN


def load_cycles(machines: tuple[Machine, ...], contour: Contour) -> LoadCycles:
    """Load cycles in the target life: cam turns for the cam, passes for the follower."""
    turns, pitch = life_turns(machines), contour.pitch
    path, _ = pitch.speed_and_curvature(uniform_turn(_CONTOUR_STATIONS))
    return LoadCycles(turns, turns * passes(machines[0].follower, path))


def cycles_in_life(solution: Solution) -> LoadCycles:
    """`load_cycles`; those of rollers between two tracks by the mean speed of the fastest, which
    turns faster on an outer wall than on an inner one.
    """
    cycles = load_cycles(solution.machines, solution.contour)
    if solution.machine.follower.slides or not solution.machine.cam.pulls:
        return cycles
    running = [each for each in solution.cams.values() if each.speed > 0.0]
    turns = (float(np.max(one.mean / each.speed)) for each in running for one in each.rollers)
    return cycles._replace(follower=cycles.cam * max(turns, default=0.0))


def passes(follower: FollowerKind, path: Array | float) -> float:
    """Load cycles of the follower per cam turn, see `FollowerKind.turns`."""
    return FACE_PASSES if follower.slides else follower.turns(path)


def contact_p0(cam: LoadedCam) -> Array:
    """Contact pressure in the middle of the line, of preloaded discs the greater of both, Pa."""
    return on_both_tracks(cam, lambda each: each.p0)


def line_pressure(cam: LoadedCam, allowed: Value) -> Array:
    """Constraint sharpness + R_p / size <= 1, equivalent to p0 <= allowed.

    R_p is the relative radius at which the line contact has the allowed pressure. Pressure and
    undercut depend on the same undercut factor, 1 - sharpness. Of preloaded discs the greater.
    """

    def on_track(seen: LoadedCam) -> Array:
        return seen.motion.sharpness + seen.pressure_factor**2 * seen.flat_square / allowed**2

    return on_both_tracks(cam, on_track)


def _weighted_pressure(cam: LoadedCam, allowed: float) -> Array:
    """`line_pressure` with the weight of the checks that grow with the contact pressure."""
    return line_pressure(cam, allowed / cam.pressure_weight)


def _judged(
    worst: Extreme,
    limit: LeastLimit,
    *,
    missing: tuple[str, ...] = (),
    note: str = "",
    method: str = "",
) -> Demand:
    """Demand against the least limit; without one where a body lacks its own, unless exceeded."""
    exceeded = limit.value is not None and worst.value > limit.value
    return Demand(
        worst.value,
        None if limit.missing and not exceeded else limit.value,
        worst,
        (*limit.missing, *missing),
        note=note,
        figures=(limit.source,),
        method=method,
    )


_OTHER_DISC = "on the preloaded disc that bears less"


def with_its_track(
    demand: Demand,
    solution: Solution,
    measure: Callable[[Cycle], Array],
    symbols: Mapping[str, Callable[[Cycle], Array]],
) -> Demand:
    """Demand with the numbers of its formula where it is on the preloaded disc that bears less, of
    which the cycle has no columns; unchanged elsewhere.

    Parameters
    ----------
    measure : callable   cycle seen from a track -> values (n,), of which the demand is an extreme
    symbols : mapping    symbol of the formula -> its values (n,) likewise
    """
    if demand.at is None:
        return demand
    cycle, k, less = pressed_row(solution.cycles, demand.at, measure)
    if not less:
        return demand
    stated = {name: float(of(cycle)[k]) for name, of in symbols.items()}
    note = "; ".join(filter(None, (_OTHER_DISC, demand.note)))
    return replace(demand, note=note, stated={**demand.stated, **stated})


def middle_pressure(cycle: Cycle) -> Array:
    """Contact pressure in the middle of the line (n,), Pa."""
    return cycle.surface.p0


def signed_pressure(cycle: Cycle) -> Array:
    """Signed contact pressure (n,), Pa, see `Cycle.signed_pressure`."""
    return cycle.signed_pressure


def plane_pressure(cycle: Cycle) -> Array:
    """Contact pressure of plane strain (n,), Pa."""
    return cycle.contact.p0


def line_factor(cycle: Cycle) -> Array:
    """Signed pressure by half-spaces over that of plane strain (n,); NaN without the ends."""
    if cycle.length is None:
        return np.full(cycle.theta.size, np.nan)
    return cycle.length.factor / cycle.length.corrected_by


_ENDS = {"K": line_factor, "p0": plane_pressure}


def _pressure_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the material of its limit and, with a crowned line of contact, the pressure in
    its middle over plane strain; in a concave wall the conforming pressure beside that of Hertz.
    """
    figured = _with_endurance(demand, solution)
    return with_its_track(
        replace(figured, note=_of_the_line(solution)), solution, middle_pressure,
        {"p0": middle_pressure},
    )  # fmt: skip


def _of_the_line(solution: Solution) -> str:
    """Sentence on the middle of a crowned line, or else on conforming contacts."""
    if not solution.machine.is_crowned:
        return conforming_sentence(solution)
    lines = [each.length for each in tracks_of(solution.cycles)]
    most = max((float(each.centre.max()) for each in lines if each), default=np.nan)
    return f"in the middle of the crowned line, up to {most:.4g} times plane strain"


def conforming_sentence(solution: Solution) -> str:
    """Sentence on the conforming contacts of a preview: the greatest pressure among them, its error
    bar, half contact angle and pressure of Hertz, or where they are not known; "" without one.
    """
    solved = [each for each in tracks_of(solution.cycles) if each.contact.conforming.any()]
    lost = sum(int(each.contact.unsolved.sum()) for each in solved)
    if lost:
        widest = shown(ANGLE_MAX, "deg", 3)
        return f"not known at {lost} angles, where the half contact angle exceeds {widest}"
    if not solved:
        return ""
    pressures = [np.where(each.contact.conforming, each.contact.p0, 0.0) for each in solved]
    number = first_greatest([each.max() for each in pressures])
    cycle, k = solved[number], first_greatest(pressures[number])
    contact = cycle.contact
    loaded = contact.line_load[[k]], contact.relative_radius[[k]]
    _, line = in_full(cycle.pair, cycle.theta[[k]], *loaded)
    if line is None:
        return ""
    return (
        f"where the cam is concave up to {shown(float(line.p0[0]), 'MPa')} +-"
        f" {100.0 * float(line.error[0]):.2g} %, conforming contact over"
        f" {shown(2.0 * float(line.half_angle[0]), 'deg', 3)} at"
        f" {shown(float(cycle.theta[k]), 'deg')} in {cycle.load_case}; Hertz"
        f" {shown(float(line.p0_hertz[0]), 'MPa')}"
    )


def _with_endurance(demand: Demand, solution: Solution) -> Demand:
    """Demand with the material and the numbers of the endurance."""
    figures = (_least_endurance(solution.machine).source,)
    return replace(demand, figures=figures, stated=_stated_endurance(solution.machine))


def _stated_endurance(machine: Machine) -> dict[str, float]:
    """Least endurance pressure of cam and follower, without safety, Pa."""
    least = _endurance(machine.bodies, machine.follower).value
    return {} if least is None else {"p_E": least}


def _stated_yield(machine: Machine) -> dict[str, float]:
    """Least yield strength of cam and follower, Pa."""
    return {"Y": min(card.yield_strength for card in machine.bodies.values())}


def _shakedown_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the material and the yield strength of its limit, and a note on traction."""
    note = "without traction; sliding at the surface lowers the limit"
    if conforming := conforming_sentence(solution):
        note = f"{note}; {conforming}"
    figures, stated = (shear_yield(solution.machine).source,), _stated_yield(solution.machine)
    worded = replace(demand, note=note, figures=figures, stated=stated)
    return with_its_track(worded, solution, middle_pressure, {"p0": middle_pressure})


def _ends_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand of the pressure along the line with the keys that it lacks, the kind of pressure that
    governs, and the sources of the limit.
    """
    machine, worst = solution.machine, demand.at
    rows = END_MEAN_LENGTH, AXIS_PARALLELISM, CAM_RUN_OUT, ROLLER_CLEARANCE
    worded = replace(
        demand,
        missing=(*demand.missing, *lacking_along_line(machine)),
        note="" if worst is None else signed_sentence(solution, worst, signed_pressure),
        stated=_stated_endurance(machine)
        | ({} if worst is None else of_elements(solution, worst, signed_pressure)),
        figures=(
            _least_endurance(machine).source,
            *(f"limits.{row.id}: {machine.limits.source(row)}" for row in rows),
        ),
    )
    return with_its_track(worded, solution, signed_pressure, _ENDS)


def traction_coefficient(cycle: Cycle) -> Array:
    """Tangential over normal force (n,): face sliding fully, roller as rolling requires.

    At most the friction coefficient; 0 where unloaded, NaN where it is not known.
    """
    follower, demand = cycle.machine.follower, cycle.rolling.traction_demand
    if follower.friction is None or (demand is None and not follower.slides):
        return np.full(cycle.theta.size, np.nan)
    if demand is None:
        return np.full(cycle.theta.size, follower.friction)
    return np.minimum(np.where(np.isnan(demand), 0.0, demand), follower.friction)


def equivalent_pressure(cycle: Cycle) -> Array:
    """Free-rolling pressure (n,), Pa, of equal shakedown utilisation."""
    return cycle.surface.p0 * _traction_factor(cycle)


def _traction_factor(cycle: Cycle) -> Array:
    """Contact pressure equivalent in shakedown over contact pressure (n,); NaN where the traction
    is not known.
    """
    machine = cycle.machine
    coefficient = traction_coefficient(cycle)
    if machine.follower.friction is None or np.isnan(coefficient).any():
        return np.full(cycle.theta.size, np.nan)
    nodes, factors = shakedown_factors(machine.follower.friction, least_poisson(machine))
    return SHAKEDOWN * np.interp(coefficient, nodes, 1.0 / factors)


@lru_cache(maxsize=32)
def shakedown_factors(friction: float, poisson: float) -> tuple[Array, Array]:
    """Traction coefficients (k,) from 0 to `friction`, and the shakedown limit p0/k at each (k,),
    see `shakedown_factor`; cached on disk.
    """

    def compute() -> dict[str, Array]:
        nodes = np.linspace(0.0, friction, _TRACTIONS)
        return {
            "nodes": nodes,
            "factors": np.array([shakedown_factor(float(node), poisson) for node in nodes]),
        }

    modules = sys.modules[__name__], hertz, rolling_envelope
    arrays = disk_cache.kept("shakedown", (friction, poisson), compute, modules)
    return arrays["nodes"], arrays["factors"]


contact_pressure = check(
    CONTACT_SAFETY,
    id=PRESSURE,
    title="Peak contact pressure vs. endurance limit",
    unit="MPa",
    sense="at_most",
    method="greatest contact pressure over the turn, Hertz and finite elements, as by ESDU 93001;"
    " least endurance of cam and follower",
    lift_can_help=True,
    tier=Tier.SCREENING,
    error="contact",
    kept_as="contact pressure at the endurance limit",
    formula="p0 <= p_E / S; p0: greatest contact pressure over all load cases and angles, of"
    " preloaded discs on either, p_E:"
    " least endurance pressure of cam and follower, of rolling for a roller and of rolling with"
    " sliding for a flat face, S: limits.contact_safety",
    symbols={"p0": "p0_fe [MPa]", "p_E": f"{STATED} [MPa]"},
    reason="above the endurance pressure the track pits",
    values=(*given.CONTACT, *given.bodies("*endurance_pressure")),
    levers=(levers.RECROWNED, *levers.ENDURANCE),
    page="Contact",
    certified_by="p0",
).measured(
    "angles",
    allowed=endurance_allowed,
    remark=_pressure_in_words,
    deviation=0.001,
    bounded="crown",
    kept=Kept(_weighted_pressure, group=PRESSURE, unit="MPa"),
)(contact_p0)


@check(
    YIELD_SAFETY,
    id="first_yield",
    title="Maximum von Mises stress with traction vs. yield strength",
    unit="MPa",
    method="greatest von Mises stress over the turn, at and below the surface; traction of Carter"
    " for a roller, of full sliding for a face; least yield strength of cam and follower",
    must_have=False,
    lift_can_help=True,
    error="contact",
    formula="sigma_v <= Y / S; sigma_v: greatest von Mises stress with traction, stresses along the"
    " surface included, Y: least yield strength of cam and follower, S: limits.yield_safety",
    symbols={"sigma_v": "von_mises_with_traction [MPa]", "Y": f"{STATED} [MPa]"},
    reason="a contact above first yield may shake down, see shakedown_traction",
    values=(*given.CONTACT, *given.bodies("yield_strength")),
    page="Contact",
    certified_by="von_mises",
)
def first_yield(solution: Solution) -> Demand:
    """Maximum von Mises stress with traction, Pa; shakedown permits values above first yield."""
    machine = solution.machine
    safety = machine.limits[YIELD_SAFETY]
    limit = least_of_bodies(machine.bodies, lambda _, card: card.yield_strength / safety)
    onset = shown(FIRST_YIELD * limit.card.yield_strength, "MPa")
    note = f"first yield without traction at a contact pressure of {onset}"
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, _stress_with_traction))
    judged = _judged(worst, limit, missing=no_friction(machine), note=note)
    stated = replace(judged, stated=_stated_yield(machine))
    symbols = {"sigma_v": _stress_with_traction}
    return with_its_track(stated, solution, _stress_with_traction, symbols)


def _stress_with_traction(cycle: Cycle) -> Array:
    """Greatest von Mises stress below the contact with traction at each cam angle (n,), Pa; NaN
    where it is not known.
    """
    stress = cycle.rolling.von_mises
    return np.full(cycle.theta.size, np.nan) if stress is None else stress


shakedown = check(
    SHAKEDOWN_SAFETY,
    id="shakedown",
    title="Peak contact pressure vs. shakedown limit",
    unit="MPa",
    method="greatest contact pressure over the turn; 4.0 k, free rolling, k = Y/sqrt(3), least of"
    " cam and follower",
    lift_can_help=True,
    tier=Tier.SCREENING,
    error="contact",
    kept_as="shakedown pressure",
    formula="p0 <= 4 k / S; k = Y/sqrt(3): least shear yield strength of cam and follower, S:"
    " limits.shakedown_safety",
    symbols={"p0": "p0_fe [MPa]", "k": "[MPa]", "Y": f"{STATED} [MPa]"},
    reason="above the limit every passage adds plastic strain",
    values=(*given.CONTACT, *given.bodies("yield_strength")),
    levers=(levers.RECROWNED, *levers.YIELD),
    page="Contact",
    certified_by="p0",
).measured(
    "angles",
    allowed=_shakedown_allowed,
    remark=_shakedown_in_words,
    deviation=0.001,
    bounded="crown",
    kept=Kept(line_pressure, group=PRESSURE),
)(contact_p0)


def _signed(_: Solution, cycle: Cycle) -> Array:
    """Signed contact pressure of a cycle (n,), of preloaded discs the greater of both, Pa."""
    return on_both_tracks(cycle, signed_pressure)


def _signed_in_operation(_: Solution, cycle: Cycle) -> Array:
    """Signed contact pressure of a cycle (n,), Pa; zero without a share of the operating time."""
    return _signed(_, cycle) * float(cycle.machine.duty != 0.0)


def _signed_equivalent(_: Solution, cycle: Cycle) -> Array:
    """Signed contact pressure of a cycle that is equivalent in shakedown with traction (n,), Pa."""
    return on_both_tracks(cycle, signed_equivalent)


def signed_equivalent(cycle: Cycle) -> Array:
    """The same of one track (n,), Pa."""
    return cycle.signed_pressure * _traction_factor(cycle)


@check(
    TARGET_LIFE,
    id="contact_pressure_at_life",
    title="Peak contact pressure vs. endurance limit at target life",
    unit="MPa",
    method="greatest signed contact pressure of the load cases in operation, as of edge_pressure;"
    " one load cycle per turn of the cam and per turn of the roller, by the duty, without one all"
    " in the fastest load case; least of cam and follower",
    lift_can_help=True,
    error="ends",
    kept_as="contact pressure at the target life",
    formula="r K p0 <= sqrt(H E*/pi) / S; r, K, p0: as of edge_pressure, in operation,"
    " log10 H = (B - log10 n)/A with H in psi, n: load cycles of"
    " the body in limits.target_life; a body without A and B keeps its endurance pressure up to its"
    " endurance_cycles",
    symbols=_ALONG_THE_LINE,
    reason="the target life may need more load cycles than the endurance pressure",
    load_cases=LASTING,
    values=(
        *given.LENGTH,
        *given.bodies("*endurance_slope", "*endurance_intercept"),
        "limits.contact_safety",
    ),
    levers=(levers.CROWNED, levers.NARROWER, *levers.STIFFER_SHAFT, *levers.ENDURANCE),
    page="Contact",
    certified_by="p0",
    scales_with=(PRESSURE, 1.0),
    along=_signed_in_operation,
)
def contact_pressure_at_life(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against the endurance at the target life."""
    machine = solution.machine
    operating = [each for each in solution.cycles if each.machine.duty != 0.0]
    worst = greatest(operating, partial(_signed_in_operation, solution))
    lacks = lacking_along_line(machine)
    if machine.limits[TARGET_LIFE] is None:
        missing = unset(machine.limits, TARGET_LIFE)
        figures = tuple(f"{card.name}: {card.source}" for card in machine.bodies.values())
        return Demand(worst.value, None, worst, (*missing, *lacks), figures=figures)
    limit = _life_limit(machine, cycles_in_life(solution))
    note = signed_sentence(solution, worst, signed_pressure)
    judged = _judged(worst, limit, missing=lacks, note=note)
    stated = replace(judged, stated=of_elements(solution, worst, signed_pressure))
    return with_its_track(stated, solution, signed_pressure, _ENDS)


def of_elements(
    solution: Solution, worst: Extreme, measure: Callable[[Cycle], Array]
) -> dict[str, float]:
    """Ratio of finite elements to half-spaces in the greatest `measure` (n,) of a cycle."""
    cycle, k, _ = pressed_row(solution.cycles, worst, measure)
    return {"r": 1.0 if cycle.length is None else float(cycle.length.corrected_by[k])}


def signed_sentence(solution: Solution, worst: Extreme, measure: Callable[[Cycle], Array]) -> str:
    """Sentence on the kind of pressure along the line at the cam angle of the greatest `measure`
    (n,) of a cycle; "" where it is not known.
    """
    if worst.cam_angle is None:
        return ""
    cycle, k, _ = pressed_row(solution.cycles, worst, measure)
    return cycle.length.sentence(k) if cycle.length else ""


def pressure_at_life(cycles: float, slope: float, intercept: float, modulus: float) -> float:
    """Endurance pressure at a number of load cycles, Pa.

    Parameters
    ----------
    cycles : float             n, number of load cycles
    slope, intercept : float   A and B of log10 K = (B - log10 n)/A with K in psi
    modulus : float            E*, Pa

    References
    ----------
    Rothbart, Cam Design Handbook (2004), eq. 9.15; p0 = sqrt(K E*/pi).
    """
    factor = PSI * 10.0 ** ((intercept - math.log10(max(cycles, 1.0))) / slope)
    return math.sqrt(factor * modulus / math.pi)


_SIGNED = (
    "contact pressure of plane strain times the factor along the line of contact, at each angle"
    " without tilt and under the greatest moment: that of the tilt of camshaft, parallelism,"
    " run-out, guides and roller bearing as far as friction of the guides and axial offset hold it,"
    " or that of the tilt beyond the clearance of the guides, less what stem and camshaft yield; at"
    " a corner the mean over limits.end_mean_length, else the greatest pressure; half-spaces with"
    " mirrored ends, in a certified run times the ratio of finite elements to them at the certified"
    " angles"
)


@check(
    CONTACT_SAFETY,
    id="edge_pressure",
    title="Pressure along the line of contact of the {follower} vs. endurance limit",
    unit="MPa",
    sense="at_most",
    method=_SIGNED,
    lift_can_help=True,
    tier=Tier.SCREENING,
    error="ends",
    kept_as="edge pressure at the endurance limit",
    formula="r K p0 <= p_E / S; p0: contact pressure of plane strain, of preloaded discs on either,"
    " r: greatest ratio of finite"
    " elements to half-spaces at the certified angles, 1 without, K: signed pressure over p0 by"
    " half-spaces, at the tilt phi + t_p + t_r/(2 r_b) + c/b + g, or, forced, at phi + t_p +"
    " t_r/(2 r_b) - g; phi: slope of the camshaft at the cam, t_p: limits.axis_parallelism, t_r:"
    " limits.cam_run_out, r_b: base radius, c: limits.roller_clearance, b: width of the roller, g:"
    " tilt of the stem in its guides, p_E and S as of contact_pressure",
    symbols={
        **_ALONG_THE_LINE,
        "p_E": f"{STATED} [MPa]",
        "S": f"limits.{CONTACT_SAFETY.id}",
    },
    reason="a line contact fails at its ends first, and most where it is tilted",
    values=(*given.LENGTH, *given.bodies("*endurance_pressure"), "limits.contact_safety"),
    levers=(levers.CROWNED, levers.NARROWER, *levers.STIFFER_SHAFT, *levers.ENDURANCE),
    page="Contact",
    certified_by="p0",
    scales_with=(PRESSURE, 1.0),
    along=_signed,
).measured(
    "angles",
    allowed=endurance_allowed,
    remark=_ends_in_words,
    deviation=0.01,  # the friction of the guides, which holds a tilt, is interpolated
    bounded="line",
)
def edge_pressure(cam: LoadedCam) -> Array:
    """Contact pressure along the line, ends and tilt included, Pa."""
    return on_both_tracks(cam, lambda each: each.p0_signed)


@check(
    SHAKEDOWN_SAFETY,
    id="edge_shakedown",
    title="Pressure along the line of contact of the {follower} vs. shakedown limit",
    unit="MPa",
    method=_SIGNED + "; equivalent pressure as of shakedown_traction",
    lift_can_help=True,
    error="ends",
    kept_as="edge pressure at shakedown with sliding",
    formula="r K p_eq <= 4 k / S; r, K: as of edge_pressure, p_eq = 4 p0 / lambda: equivalent"
    " pressure of plane strain, see shakedown_traction, k = Y/sqrt(3), S, Y: as of shakedown",
    symbols={**_ALONG_THE_LINE, **_EQUIVALENT, "p_eq": "[MPa]"},
    reason="the ends yield first, and an end that does not shake down is rolled out",
    values=(
        *given.LENGTH,
        *given.TRACTION,
        *given.bodies("yield_strength"),
        "follower.face.friction",
    ),
    levers=(levers.CROWNED, levers.NARROWER, *levers.STIFFER_SHAFT, *levers.YIELD),
    page="Contact",
    certified_by="p0",
    scales_with=(PRESSURE, 1.0),
    along=_signed_equivalent,
)
def edge_shakedown(solution: Solution) -> Demand:
    """Contact pressure with ends, tilt and traction equivalent in shakedown, Pa."""
    machine = solution.machine
    worst = greatest(solution.cycles, partial(_signed_equivalent, solution))
    limit = _scaled(shear_yield(machine), SHAKEDOWN)
    missing = (*lacking_along_line(machine), *no_friction(machine))
    note = signed_sentence(solution, worst, signed_equivalent)
    judged = _judged(worst, limit, missing=missing, note=note)
    stated = _shakedown_stated(solution, worst, signed_equivalent)
    stated |= of_elements(solution, worst, signed_equivalent)
    return with_its_track(replace(judged, stated=stated), solution, signed_equivalent, _ENDS)


def _shakedown_stated(
    solution: Solution, worst: Extreme, measure: Callable[[Cycle], Array]
) -> dict[str, float]:
    """p0/k at shakedown where an equivalent pressure is greatest, and the yield strength, Pa."""
    cycle, k, _ = pressed_row(solution.cycles, worst, measure)
    least = SHAKEDOWN / float(_traction_factor(cycle)[k])
    return {"lambda": least} | _stated_yield(solution.machine)


@check(
    SHAKEDOWN_SAFETY,
    id="shakedown_traction",
    title="Peak contact pressure with traction vs. shakedown limit",
    unit="MPa",
    method="greatest contact pressure over the turn, as that of free rolling with the same use of"
    " the shakedown limit; traction of a roller min(mu, T/N), of a face full sliding",
    lift_can_help=True,
    error="contact",
    kept_as="shakedown pressure with sliding",
    formula="p_eq = 4 p0 / lambda <= 4 k / S; lambda: p0/k at shakedown under the traction"
    " coefficient of the angle, 1/max|tau_xz| below the surface, von Mises at the surface above a"
    " traction of about 0.3, k = Y/sqrt(3), S, Y: as of shakedown",
    symbols=_EQUIVALENT,
    reason="traction brings the plastic strain to the surface and lowers the limit",
    values=(
        *given.CONTACT,
        *given.bodies("yield_strength"),
        "roller.friction",
        "follower.face.friction",
    ),
    levers=(levers.RECROWNED, *levers.YIELD),
    page="Contact",
    certified_by="p0",
)
def shakedown_traction(solution: Solution) -> Demand:
    """Maximum equivalent contact pressure with traction, Pa, against shakedown."""
    machine = solution.machine
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, equivalent_pressure))
    limit = _scaled(shear_yield(machine), SHAKEDOWN)
    stated = _shakedown_stated(solution, worst, equivalent_pressure)
    judged = replace(_judged(worst, limit, missing=no_friction(machine)), stated=stated)
    return with_its_track(judged, solution, equivalent_pressure, {"p0": middle_pressure})


@check(
    title="Axial offset of the roller vs. half of the difference of widths",
    unit="mm",
    source=Source(
        "up to it the contact has the whole smaller width of cam and roller",
        confirmed=True,
    ),
    method="axial offset of the case; widths of cam and roller without ends",
    moved_by_tolerance=False,
    needs="roller",
    formula="e <= |w_c - w_r| / 2; e: roller.axial_offset, w_c: width of the cam, w_r: of the"
    " roller, both without ends",
    symbols={
        "e": "roller.axial_offset",
        **dict.fromkeys(("w_c", "w_r"), f"{STATED} [mm]"),
    },
    reason="beyond it the contact is shorter and beside the middle of both bodies",
    load_cases=NONE,
    values=("roller.axial_offset",),
    page="Roller",
)
def roller_overlap(solution: Solution) -> Demand:
    """Axial offset of the roller from the middle of the cam, m."""
    machine = solution.machine
    roller = machine.roller
    spare, offset = 0.5 * abs(machine.cam.line_width - roller.line_width), roller.axial_offset
    if offset is None:
        return Demand(None, spare, missing=lacking(roller.table, roller, "axial_offset"))
    overlap = shown(machine.contact_width, "mm")
    stated = {"w_c": machine.cam.line_width, "w_r": roller.line_width}
    return Demand(offset, spare, note=f"roller and cam overlap over {overlap}", stated=stated)


@lru_cache(maxsize=512)
def shakedown_factor(friction: float, poisson: float = 0.3) -> float:
    """Shakedown limit p0/k of a line contact with traction: 4 without traction.

    Residual stresses along and across the track depend on the depth alone. Below the surface they
    compensate all but the shear stress along it: the limit is 1/max|tau_xz|. At the surface the von
    Mises stress of a sliding contact varies through the passage, and the best residual stresses
    leave the radius of the smallest sphere round its path in the space of the deviator, centred at
    no shear stress: decisive above a traction of about 0.3, and 6 to 7 % below 1/mu.

    Parameters
    ----------
    friction : float   traction over pressure
    poisson : float    nu of the body

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 9.2; Melan's theorem.
    """
    rolling, rubbing = _shear_below()
    below = float(np.abs(rolling + friction * rubbing).max())
    far = np.geomspace(1.5, 100.0, 60)[1:]
    along = np.concatenate([-far[::-1], np.linspace(-1.5, 1.5, 601), far])
    xx, zz, xz = hertz.subsurface_stress(along, 0.0, friction)
    out_of_plane = (poisson - 0.5) * (xx + zz) / math.sqrt(3.0)
    path = np.stack([0.5 * (xx - zz), xz, out_of_plane])
    middle = 0.5 * (path.min(axis=1) + path.max(axis=1)) * np.array([1.0, 0.0, 1.0])
    if np.sqrt(((path - middle[:, None]) ** 2).sum(axis=0).max()) <= below:
        return 1.0 / below  # the smallest sphere is no larger than this one
    # The mirror image keeps the centre of the sphere at no shear stress.
    both = np.concatenate([path, path * np.array([[1.0], [-1.0], [1.0]])], axis=1)
    radius = float(smallest_sphere(both[:, None, :])[1][0])
    return 1.0 / max(below, radius)


@lru_cache(maxsize=1)
def _shear_below() -> tuple[Array, Array]:
    """Shear stress along the track below the surface over p0: of the pressure, and per traction."""
    x, depth = np.meshgrid(np.linspace(-1.5, 1.5, 601), np.linspace(0.0, 1.5, 301))
    rolling = hertz.subsurface_stress(x, depth, 0.0)[2]
    return rolling, hertz.subsurface_stress(x, depth, 1.0)[2] - rolling
