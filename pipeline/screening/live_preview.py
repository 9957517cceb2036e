"""Live preview: the closed-form checks of a run as functions of a few numbers of its design.

Hundreds of designs about that of the run are screened; polynomials through their demands follow the
preview within an error that designs held out state, with the deviation of the screening from a
preview of the run's design. All of them keep the lift of the run.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import CamError
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.lift import Lift
from camwright.pipeline.base.files import json_text, read_json, write_atomic
from camwright.pipeline.base.quantities import In
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import in_order
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import quantity_of, value_of
from camwright.pipeline.case.lift_section import LiftPoints, LiftSegments
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.case.load_case_torque import has_torque
from camwright.pipeline.checks.demands import normal_force
from camwright.pipeline.checks.extremes import on_both_tracks
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.live_document import (
    LiveContact,
    LiveDocument,
    LiveFactor,
    LivePart,
    LiveQuantity,
    LiveSurface,
)
from camwright.pipeline.results.check_records import of_records
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.file_differences import SAME, record_differences
from camwright.pipeline.results.run_reader import LIVE, TrialRecord, read_run
from camwright.pipeline.screening.design_arrays import Designs, LiftOrigin, Screened, TorqueOfSpeed
from camwright.pipeline.screening.design_screening import (
    refusals_of,
    resampled,
    step_of,
    utilisations,
)
from camwright.pipeline.screening.response_surface import (
    Surface,
    SurfaceFit,
    powers,
    settings,
    terms,
)
from camwright.pipeline.screening.screened_cam import ScreenedCam
from camwright.pipeline.screening.screened_checks import SCREENED, torque_after
from camwright.pipeline.solver import solve

CANDIDATES = 26
"""Checks of the greatest utilisation that are fitted, so that a page has twelve of them."""
SETTINGS, HELD_OUT = 3.5, 120
"""Designs of a fit over the terms of its polynomials; further ones that state its error."""
POSITIONS = 180
"""Cam angles of the loads."""
WORST_ERROR = 0.1
"""Error of a check or its limit, as a share of demand or limit, beyond which it is left out."""
AWAY_FROM_RUN = 2.0
"""Greatest deviation of the screening from the preview over that at the design of the run."""
_SAMPLING_SEED = 7
_DESIGNS_A_BLOCK = 250  # designs solved at once
_RANGES = {"preload": 1.3, "rate": 1.3, "prime": 1.15, "roller": 1.2, "speed": 1.25, "stroke": 1.2,
           "fit": 1.3}  # fmt: skip
_SHRINK, _TRIES = 0.7, 8  # of the ranges, where a corner of them is refused
_LEAST_RANGE = 1.01  # greatest over least factor
_FAR = 1e9  # utilisation, of a demand without the sign of its limit
_NEVER = 0.7  # utilisation over the greatest, below which a load case governs nowhere
_POINTS_MOST = 40  # of a lift by points, whose keys are listed
# Of the key figures from those of the preview, as `tests/verification/test_live_preview.py` has it.
_DEVIATION = {"force": 0.02, "pressure": 0.002, "ripple": 0.01, "shape": 0.001}


class _Factor(NamedTuple):
    """Numbers of the design that change in proportion: keys with their values, SI; ranges."""

    kind: str
    name: str
    values: Mapping[str, float]
    low: float
    high: float

    @property
    def is_stroke(self) -> bool:
        return self.kind == "stroke"

    @property
    def is_speed(self) -> bool:
        return self.kind == "speed"

    def drawn_in(self, below: float, above: float) -> _Factor:
        """With shares of its range below and above the value of the run."""
        return self._replace(low=self.low**below, high=self.high**above)

    def of_less_speed(self) -> _Factor:
        """A narrower range, of the speed alone."""
        return self.drawn_in(_SHRINK, _SHRINK) if self.is_speed else self


def _factors(case: Case) -> Iterator[_Factor]:
    """Numbers of a case that a live preview changes, with their widest ranges."""
    keys: dict[str, tuple[str, Sequence[str]]] = {}
    if case.spring.shape is None and not case.spring.absent:
        keys["preload"] = "Spring preload", ("spring.preload",)
        keys["rate"] = "Spring rate", ("spring.rate",)
    keys["prime"] = "Prime radius", ("cam.prime_radius",)
    cam, rollers = case.cam, ["roller.radius"]
    if cam.conjugate is not None:
        rollers.append("cam.conjugate.roller_radius")
    keys["roller"] = "Roller radius", rollers
    if cam.pulls:
        fit = "clearance" if cam.clearance > 0.0 else "interference"
        keys["fit"] = fit.capitalize(), (f"cam.{cam.closure}.{fit}",)
    if case.lift is not None and case.lift.kind == "eccentric":
        del keys["prime"], keys["roller"]  # its lift is one with its radii
    running = [k for k, state in enumerate(case.load_cases) if state.speed > 0.0]
    speeds = tuple(f"load_case[{k}].speed" for k in running)
    if speeds:
        words = case.load_cases[running[0]].name if len(case.load_cases) > 1 else ""
        keys["speed"] = f"Speed{words and f', {words}'}", speeds
    if strokes := _stroke_keys(case):
        keys["stroke"] = "Stroke", strokes
    for kind, (name, changed) in keys.items():
        values = {key: value_of(case, key) for key in changed}
        if all(values.values()):  # neither left out nor zero
            yield _Factor(kind, name, values, 1.0 / _RANGES[kind], _RANGES[kind])


def _stroke_keys(case: Case) -> tuple[str, ...]:
    """Keys of a lift that scale it, those of zero left out; none of another kind of lift."""
    lift = case.lift
    if isinstance(lift, LiftSegments):
        return tuple(f"lift.segment[{k}].stroke" for k, s in enumerate(lift.segments) if s.stroke)
    if isinstance(lift, LiftPoints) and len(lift.points) <= _POINTS_MOST:
        return tuple(f"lift.point[{k}].lift" for k, p in enumerate(lift.points) if p.lift)
    return ()


@dataclass(frozen=True, eq=False)
class _Neighbours:
    """Designs about that of a run.

    Parameters
    ----------
    case : Case             with the cam of the run
    lift : array (N,)       of the run, m
    factors : tuple
    torques : mapping       engine torque by number of the load case; none bears on the contact
    """

    case: Case
    lift: Array
    factors: tuple[_Factor, ...]
    torques: Mapping[int, TorqueOfSpeed]

    def with_torques(self) -> _Neighbours:
        """With their engine torques, in the widest range of speeds at which all can be solved."""
        near = self
        for _ in range(_TRIES):
            try:
                return replace(near, torques=near._solved_torques())
            except CamError:
                near = replace(near, factors=tuple(each.of_less_speed() for each in near.factors))
        near = replace(near, factors=tuple(each for each in self.factors if not each.is_speed))
        return replace(near, torques=near._solved_torques())

    def _solved_torques(self) -> dict[int, TorqueOfSpeed]:
        """Engine torques by number of the load case, over the range of speeds that the preview can
        choose.
        """
        speed = next((each for each in self.factors if each.is_speed), None)
        torques = {}
        for k, state in enumerate(self.case.load_cases):
            if not (self.case.balances and has_torque(self.case, state)):
                continue
            stated = None if speed is None else speed.values.get(f"load_case[{k}].speed")
            wanted = None
            if speed is not None and stated is not None:
                wanted = stated * np.linspace(speed.low, speed.high, _DESIGNS_A_BLOCK)
            torques[k] = TorqueOfSpeed.of(self.case, k, wanted)
        return torques

    def multiples(self, places: Array) -> Array:
        """Factors (m, d) on the values of the run at places (m, d) in [-1, 1]."""
        low = np.log([each.low for each in self.factors])
        high = np.log([each.high for each in self.factors])
        return np.asarray(np.exp(0.5 * (low + high) + 0.5 * places * (high - low)))

    def at(self, multiples: Array) -> Designs:
        """Designs whose factors are those of the run times `multiples` (m, d), 1: the
        run itself.
        """
        values = self._values(multiples)
        stroke = [k for k, each in enumerate(self.factors) if each.is_stroke]
        scaled = multiples[:, stroke[0], None] if stroke else np.ones((1, 1))
        torques = {
            k: resampled(each.at(values.get(f"load_case[{k}].speed")), self.lift.size)
            for k, each in self.torques.items()
        }
        step = step_of(self.lift.size, POSITIONS)
        return Designs(
            case=self.case,
            columns={key: each[:, None] for key, each in values.items()},
            source=LiftOrigin(lift=scaled * self.lift),
            torques=torques,
            count=len(multiples),
            step=step,
            torque_step=self._torque_step(step),
            throughputs={
                k: each.throughput_at(values.get(f"load_case[{k}].speed"))
                for k, each in self.torques.items()
            },
        )

    def _torque_step(self, step: int) -> int:
        """Samples of the lift between those of the engine torque: at the positions of the case.

        A torque with peaks has the ripple of the angles at which it is sampled, as in a preview.
        """
        between, odd = divmod(self.lift.size, self.case.solver.positions)
        return 1 if odd or step % max(between, 1) else between

    def _values(self, multiples: Array) -> dict[str, Array]:
        """Values (m,) by key of the arrays, SI."""
        return {
            key: value * column
            for each, column in zip(self.factors, multiples.T, strict=True)
            if not each.is_stroke
            for key, value in each.values.items()
        }

    def solved(
        self, multiples: Array, start: int = 0
    ) -> Iterator[tuple[NDArray[np.intp], Designs]]:
        """Designs about the run that the case accepts, block by block: their row numbers, from
        `start`, in `multiples` (m, d), and the designs. Left out are those with undercut, that lock
        or that the case refuses.
        """
        count = len(multiples)
        for begin in range(0, count if count > _DESIGNS_A_BLOCK else 0, _DESIGNS_A_BLOCK):
            yield from self.solved(multiples[begin : begin + _DESIGNS_A_BLOCK], start + begin)
        if not 0 < count <= _DESIGNS_A_BLOCK:
            return
        try:
            designs = self.at(multiples)
            good = self._good(designs, multiples)
        except CamError:
            if count > 1:
                half = count // 2
                yield from self.solved(multiples[:half], start)
                yield from self.solved(multiples[half:], start + half)
            return
        if good.all():
            yield start + np.arange(count), designs
        elif good.any():
            yield start + np.flatnonzero(good), self.at(multiples[good])

    def _good(self, designs: Designs, multiples: Array) -> NDArray[np.bool_]:
        """Which designs (m,) of `multiples` (m, d) the case accepts, without undercut and without
        locking in any load case.
        """
        refused = refusals_of(designs, self._values(multiples))
        good = np.array([not words for words in refused]) & (designs.least_factor > 0.0)
        for cam in designs.cams:
            good &= ~(cam.ends.lost & ~cam.ends.leaves)
        return good

    def accepted(self, multiples: Array) -> NDArray[np.bool_]:
        """Whether designs (m,) are accepted, see `solved`."""
        good = np.zeros(len(multiples), dtype=bool)
        for rows, _ in self.solved(multiples):
            good[rows] = True
        return good


def _in_range(case: Case, lift: Array) -> _Neighbours:
    """Designs about that of a run, with their engine torques, in the widest ranges of the factors
    whose ends and corners are accepted; without factors where the design of the run or every range
    is refused.

    Parameters
    ----------
    lift : array (N,)   of the run, m
    """
    factors = list(_factors(case))
    steps = (0.25, 0.5, 0.75, 1.0)
    near = _Neighbours(case, lift, tuple(factors), {})
    trials: list[list[float]] = []
    for k, each in enumerate(factors):
        for end in (each.low, each.high):
            for share in steps:
                row = np.ones(len(factors))
                row[k] = end**share
                trials.append(list(row))
    good = near.accepted(np.array([*trials, [1.0] * len(factors)]))
    if not good[-1]:
        return replace(near, factors=())
    reached = np.minimum.accumulate(good[:-1].reshape(len(factors), 2, len(steps)), axis=2)
    shares = np.concatenate([[0.0], steps])[reached.sum(axis=2)]
    factors = [each.drawn_in(*ends) for each, ends in zip(factors, shares, strict=True)]
    factors = [each for each in factors if each.high > each.low * _LEAST_RANGE]
    for _ in range(_TRIES):
        near = replace(near, factors=tuple(factors))
        corners = np.array(list(itertools.product((-1.0, 1.0), repeat=len(factors))))
        if near.accepted(near.multiples(corners)).all():
            return near.with_torques()
        factors = [each.drawn_in(_SHRINK, _SHRINK) for each in factors]
    return replace(near, factors=())


class _Figures(NamedTuple):
    """Values of designs (m,) by load case, -1: of none or of several; limits (m,).

    loads: numbers of the load cases on whose loads the values rest, by load case as the values
    """

    parts: Mapping[int, Array]
    loads: Mapping[int, Sequence[int]]
    limit: Array | None


Measured = Callable[[Designs], _Figures | None]


def _check_figures(screened: Screened) -> Measured:
    """Function of designs for the demands of a check, SI, in each load case or, for one that joins
    them, over all (-1); its result is None where the screening does not know them all.
    """
    declared = DECLARED[screened.check]
    how = declared.measured
    of_turns = how is not None and how.reduce in ("angles", "forces", "mean")
    of_turns &= declared.id != TORQUE_REDUCTION.id  # of the load cases that require one

    def figures(designs: Designs) -> _Figures | None:
        """Demands and limit of the check; None where the screening has a bound of it alone, lacks a
        limit, or the limit differs between load cases.
        """
        if screened.is_bound(designs) or declared.is_bound(Tier.SCREENING):
            return None
        states = range(len(designs.cams)) if of_turns else (-1,)
        parts, limits = {}, []
        for state in states:
            part = designs if state < 0 else _in_load_case(designs, state)
            judged = screened.judged(part)
            if judged is None or judged[1] is None:
                return None
            shape = (designs.count,)
            demand, limit = (np.broadcast_to(np.asarray(each), shape) for each in judged)
            applies = np.broadcast_to(screened.applies(demand, designs), shape)
            if not (np.isfinite(limit).all() and applies.all()):
                return None
            parts[state] = demand
            limits.append(limit)
        if any(not np.array_equal(each, limits[0]) for each in limits):
            return None
        loads: dict[int, Sequence[int]] = {k: (k,) if declared.rests_on else () for k in parts}
        if declared.rests_on and not of_turns:
            loads[-1] = _judged_alone(screened, designs)
        return _Figures(parts, loads, limits[0])

    return figures


def _in_load_case(designs: Designs, number: int) -> Designs:
    return designs.in_load_cases([k == number for k in range(len(designs.cams))])


def _judged_alone(screened: Screened, designs: Designs) -> list[int]:
    """Numbers of the load cases that a check over several judges, such as those with a duty."""
    alone = [screened.judged(_in_load_case(designs, k)) for k in range(len(designs.cams))]
    return [k for k, each in enumerate(alone) if each and not np.isnan(each[0]).all()]


class _Headline(NamedTuple):
    """A key figure: values (m,) of designs in a load case, SI."""

    id: str
    title: str
    unit: str
    worst: Literal["greatest", "least"]
    deviation: str
    value: Callable[[Designs, ScreenedCam], Array | None]
    of_turns: bool = True
    rests: bool = True

    def figures(self, designs: Designs) -> _Figures | None:
        """Values of the key figure by load case (-1: of none); None where no load case has one."""
        cams = designs.cams if self.of_turns else designs.cams[:1]
        values = {k: self.value(designs, cam) for k, cam in enumerate(cams)}
        parts = {k if self.of_turns else -1: v for k, v in values.items() if v is not None}
        loads = {k: (k,) if self.rests else () for k in parts}
        return _Figures(parts, loads, None) if parts else None


def _ripple(designs: Designs, cam: ScreenedCam) -> Array | None:
    """Standard deviation of the torque in the first load case, as in the headline."""
    if cam is not designs.cams[0] or cam.state.torque is None:
        return None
    return np.asarray(torque_after(designs, cam).std(axis=-1))


HEADLINE = (
    _Headline("torque_ripple", "Torque ripple with the cam", "N m", "greatest", "ripple", _ripple),
    _Headline(
        "contact_force", "Maximum contact force", "N", "greatest", "force",
        lambda _, cam: sampled_greatest(normal_force(cam)),
    ),
    _Headline(
        "pressure_angle_max", "Maximum pressure angle", "deg", "greatest", "shape",
        lambda designs, _: sampled_greatest(np.abs(designs.whole.motion.pressure_angle)),
        of_turns=False, rests=False,
    ),
    _Headline(
        "pitch_curvature", "Minimum radius of the pitch curve", "mm", "least", "shape",
        lambda designs, _: designs.least_convex_radius, of_turns=False, rests=False,
    ),
    _Headline(
        "hertz_pressure", "Peak contact pressure after Hertz", "MPa", "greatest", "pressure",
        lambda _, cam: sampled_greatest(on_both_tracks(cam, lambda one: one.p0_line)),
    ),
)  # fmt: skip
"""Key figures of a live preview, in the order of the calculation."""


Key = TypeVar("Key", int, str)


@dataclass(eq=False)
class _Sample:
    """Values of every quantity (m,) at the settings of a fit, NaN where a design is refused."""

    count: int
    parts: dict[str, dict[int, Array]]
    lost: dict[int, NDArray[np.bool_]] = field(default_factory=dict)
    held: dict[int, Array] = field(default_factory=dict)
    loads: dict[str, dict[int, set[int]]] = field(default_factory=dict)
    limits: dict[str, Array] = field(default_factory=dict)
    unknown: set[str] = field(default_factory=set)
    states: Sequence[str] = ()
    follower: str = ""

    @classmethod
    def of(cls, near: _Neighbours, multiples: Array, measures: Mapping[str, Measured]) -> _Sample:
        """Sample at `multiples` (m, d) of the values of the run, solved block by block. measures :
        by name, see `_check_figures`; one that is None for some block is `unknown`.
        """
        sample = cls(len(multiples), {name: {} for name in measures})
        for rows, designs in near.solved(multiples):
            sample.states = sample.states or _state_names(designs)
            sample.follower = designs.machine.follower.word
            for k, cam in enumerate(designs.cams):
                sample._enter(sample.held, k, rows, sampled_least(cam.required))
                sample.lost.setdefault(k, np.zeros(sample.count, dtype=bool))[rows] = cam.ends.lost
            for name, measure in measures.items():
                figures = None if name in sample.unknown else measure(designs)
                if figures is None:
                    sample.unknown.add(name)
                    continue
                loads = sample.loads.setdefault(name, {})
                for state, values in figures.parts.items():
                    sample._enter(sample.parts[name], state, rows, values)
                    leaves = () if designs.case.cam.pulls else figures.loads[state]
                    loads.setdefault(state, set()).update(leaves)
                if figures.limit is not None:
                    sample._enter(sample.limits, name, rows, figures.limit)
        return sample

    def _enter(
        self, into: dict[Key, Array], key: Key, rows: NDArray[np.intp], values: Array
    ) -> None:
        into.setdefault(key, np.full(self.count, np.nan))[rows] = values

    @property
    def accepted(self) -> NDArray[np.bool_]:
        """Designs (m,) that the case accepts."""
        return ~np.isnan(self.held[0])

    def _kept(self, name: str, state: int) -> NDArray[np.bool_]:
        """Designs (m,) whose follower stays on the cam in the load cases of a value."""
        lost = [self.lost[k] for k in self.loads[name][state]]
        return self.accepted & ~np.any([np.zeros(self.count), *lost], axis=0)

    def valued(self, name: str, state: int) -> NDArray[np.bool_]:
        """Designs (m,) with a value in a load case."""
        return self._kept(name, state) & np.isfinite(self.parts[name][state])

    def is_partial(self, name: str) -> bool:
        """Whether a quantity has no value for a design whose follower stays on the cam."""
        return any((self._kept(name, k) & ~self.valued(name, k)).any() for k in self.parts[name])


def live_record(case: Case, lift: Array, checks: Sequence[str]) -> LiveDocument | None:
    """Response surfaces about the design of a run.

    Parameters
    ----------
    case : Case           with the spring and prime radius of the run
    lift : array (N,)     of its final trial at equal cam angles, m
    checks : sequence     ids of the checks, the most important first

    Returns
    -------
    LiveDocument   None where no design about that of the run can be solved, or a check of one
    """
    try:
        return _fitted(case, lift, checks)
    except CamError:
        return None


def _fitted(case: Case, lift: Array, checks: Sequence[str]) -> LiveDocument | None:
    """Document of response surfaces about the design of a run, fitted to screened designs; None
    where no range or no surface can be had.

    Parameters
    ----------
    lift : array (N,)          of the run, m
    checks : sequence of str   ids of the checks to be followed
    """
    near = _in_range(case, lift)
    if not near.factors:
        return None
    count = int(SETTINGS * len(powers(len(near.factors))))
    places = settings(count + HELD_OUT, len(near.factors), HELD_OUT, _SAMPLING_SEED)
    multiples = near.multiples(places)
    measures: dict[str, Measured] = {each.id: each.figures for each in HEADLINE}
    judged = [name for name in checks if name in SCREENED_BY_ID]
    measures |= {name: _check_figures(SCREENED_BY_ID[name]) for name in judged}
    sample = _Sample.of(near, multiples, measures)
    run = _RunDesign(
        _Sample.of(near, np.ones((1, len(near.factors))), measures), _demands(case, lift)
    )
    fit = SurfaceFit(places, HELD_OUT)
    held = {} if case.cam.pulls else sample.held  # a cam that pulls holds its follower
    contact = {k: fit.surface(values) for k, values in held.items()}
    if not sample.held or None in contact.values():  # the case refuses too many designs
        return None
    figures = (_key_figure(each, sample, fit) for each in HEADLINE)
    quantities = [each for each in figures if each is not None]
    left_out: dict[str, str] = {}
    for name in checks:
        check = _check(name, sample, fit, run)
        if isinstance(check, str):
            left_out[name] = check
        else:
            quantities.append(check)
    return {
        "case": case.name,
        "lift": "run" if case.lift is None else "case",
        "factors": [_factor_record(each) for each in near.factors],
        "powers": fit.exponents.tolist(),
        "states": list(sample.states),
        "contact": [
            LiveContact(state=k, surface=_surface_record(each, 1.0))
            for k, each in contact.items()
            if each is not None
        ],
        "quantities": quantities,
        "left_out": left_out,
        "settings": count,
        "held_out": HELD_OUT,
        "refused": int((~sample.accepted).sum()),
    }


SCREENED_BY_ID: Mapping[str, Screened] = {each.check: each for each in SCREENED}
_DEEPER = "the screening does not know it"
_BOUND = "the screening knows a bound of it alone"
_PARTIAL = "it has no value in a part of the ranges"
_UNEVEN = "it bends too much over the ranges"
_UNEVEN_LIMIT = "its limit bends too much over the ranges"


def greatest(final: TrialRecord) -> list[str]:
    """Ids of the required checks of the design of the greatest utilisation, in their order."""
    ordered = in_order(of_records(final.checks))
    ids = [
        each.id
        for each in ordered
        if each.must_have and not each.evidence and each.utilisation is not None
    ]
    return ids[:CANDIDATES]


def _key_figure(figure: _Headline, sample: _Sample, fit: SurfaceFit) -> LiveQuantity | None:
    """Surfaces of a key figure by load case; None where it lacks a value or a surface."""
    if figure.id in sample.unknown or sample.is_partial(figure.id):
        return None
    values = sample.parts[figure.id]
    rank = values if figure.worst == "greatest" else {k: -v for k, v in values.items()}
    deviation, limit = _DEVIATION[figure.deviation], np.zeros(sample.count)
    away = _Away(in_unit(1.0, figure.unit), deviation, limit)
    parts = _parts(figure.id, sample, fit, rank, away)
    if not parts:
        return None
    return {
        "id": figure.id, "title": figure.title, "unit": figure.unit, "worst": figure.worst,
        "parts": parts, "limit": None,
    }  # fmt: skip


def _demands(case: Case, lift: Array) -> dict[str, float | None]:
    """Demands of the preview of a design by the id of the check, SI."""
    contour = case.contour(Lift(uniform_turn(lift.size), lift))
    trial = solve(case, contour, tier=Tier.PREVIEW, corners=False)
    return {each.id: each.demand for each in trial.checks}


class _RunDesign(NamedTuple):
    """The design of the run as screened, and its demands in the preview by the id of the check."""

    screened: _Sample
    demands: Mapping[str, float | None]

    def deviation(self, name: str, *, at_most: bool) -> float:
        """Deviation of the screening of a check from its preview, at the run, over the greater of
        demand and limit; 0 where either lacks a demand.
        """
        demand, parts = self.demands.get(name), self.screened.parts[name]
        valued = [float(v[0]) for k, v in parts.items() if self.screened.valued(name, k)[0]]
        if demand is None or not valued:
            return 0.0
        worst, limit = (max if at_most else min)(valued), self.screened.limits[name][0]
        return float(abs(worst - demand) / max(abs(demand), abs(limit)))


def _check(name: str, sample: _Sample, fit: SurfaceFit, run: _RunDesign) -> LiveQuantity | str:
    """Surfaces of the demand and the limit of a check; else the reason in words why it is not
    followed.

    Parameters
    ----------
    name : str         id of the check
    sample : _Sample   values at the settings of the fit
    run : _RunDesign   design of the run, for the deviation of the screening
    """
    screened = SCREENED_BY_ID.get(name)
    if screened is None:
        return _DEEPER
    if name in sample.unknown or name not in sample.limits:
        return _BOUND
    if sample.is_partial(name):
        return _PARTIAL
    declared = DECLARED[name]
    at_most = declared.sense == "at_most"
    limit, demands = sample.limits[name], sample.parts[name]
    rank = {k: utilisations(v, limit, at_most=at_most) for k, v in demands.items()}
    scale = in_unit(1.0, declared.unit)
    bound = fit.surface(limit)
    if bound is None:
        return _BOUND
    deviation = max(screened.deviation, AWAY_FROM_RUN * run.deviation(name, at_most=at_most))
    away = _Away(scale, deviation, limit)
    parts = _parts(name, sample, fit, rank, away)
    if not parts:
        return _BOUND
    allowed = _surface_record(bound, scale)
    for part in parts:
        demand, valued = demands[part["state"]], sample.valued(name, part["state"])
        if part["surface"] is not None and away.beyond(part["surface"], demand, demand, valued):
            return _UNEVEN
        if away.beyond(allowed, limit, demand, valued):
            return _UNEVEN_LIMIT
    return {
        "id": name,
        "title": declared.title.format(follower=sample.follower),
        "unit": declared.unit or "-",
        "worst": "greatest" if at_most else "least",
        "parts": parts,
        "limit": allowed,
    }


class _Away(NamedTuple):
    """Unit of a quantity, and its deviation from the preview.

    scale: unit of the record over that of SI; deviation: of the screening from the preview, over
    the greater of value and limit; limit (m,), SI
    """

    scale: float
    deviation: float
    limit: Array

    def record(
        self, surface: Surface | None, values: Array, valued: NDArray[np.bool_]
    ) -> LiveSurface | None:
        """Record of a surface of values (m,), its error increased by the deviation of the screening
        from the preview; None without a surface or a finite error. `valued` (m,): designs with a
        value, to which the surface is fitted.
        """
        if surface is None:
            return None
        size = np.abs(values[valued])
        more = self.deviation * np.fmax(size, np.abs(self.limit[valued]))
        more = more / size if surface.share else more  # a share is of values above zero
        error = surface.error + float(more.max())
        if not np.isfinite(error):
            return None
        return _surface_record(surface.with_error(error), self.scale)

    def beyond(
        self, surface: LiveSurface, values: Array, demand: Array, valued: NDArray[np.bool_]
    ) -> bool:
        """Whether a surface errs by more than `WORST_ERROR` of the greater of demand and limit at a
        design with a value.

        Parameters
        ----------
        surface : LiveSurface   record of the surface of `values`
        values : array (m,)     demands or limits, SI
        demand : array (m,)     demands, SI
        valued : array (m,)     designs with a value
        """
        size = np.fmax(np.abs(demand), np.abs(self.limit))[valued]
        error = surface["error"]
        away = error * np.abs(values[valued]) if surface["share"] else error / self.scale
        return not float(np.nanmax(away / size)) <= WORST_ERROR


def _parts(
    name: str, sample: _Sample, fit: SurfaceFit, rank: Mapping[int, Array], away: _Away
) -> list[LivePart]:
    """Records of the surfaces of a quantity by load case, for those that govern, or nearly so, at
    one design of the sample at least.

    Parameters
    ----------
    name : str       of the quantity in the sample
    rank : mapping   by load case, the values (m,) by which they are compared at each design: the
        greatest governs; NaN never does
    away : _Away     unit, and deviation from the preview
    """
    valued = {k: sample.valued(name, k) for k in rank}
    ranked = {
        k: np.where(valued[k] & ~np.isnan(each), np.minimum(each, _FAR), -np.inf)
        for k, each in rank.items()
    }
    most = np.max(list(ranked.values()), axis=0)
    return [
        {
            "state": k,
            "loads": sorted(sample.loads[name][k]),
            "surface": away.record(fit.surface(values, valued[k]), values, valued[k]),
        }
        for k, values in sample.parts[name].items()
        if (np.isfinite(most) & (ranked[k] >= most - (1.0 - _NEVER) * np.abs(most))).any()
    ]


def _surface_record(surface: Surface, scale: float) -> LiveSurface:
    """A surface in a unit: of SI values times a scale."""
    scaled = surface.times(scale)
    return {
        "scale": scaled.scale,
        "coefficients": scaled.coefficients.tolist(),
        "error": scaled.error,
        "share": scaled.share,
    }


def _factor_record(factor: _Factor) -> LiveFactor:
    quantity = quantity_of(next(iter(factor.values)))
    unit = quantity.unit if isinstance(quantity, In) else ""
    return {
        "name": factor.name,
        "keys": {key: in_unit(value, unit) for key, value in factor.values.items()},
        "unit": unit,
        "low": factor.low,
        "high": factor.high,
    }


def _state_names(designs: Designs) -> list[str]:
    """Names of the load cases; standstill and over-speed at the preload of each follow."""
    stated = [each.name for each in designs.case.load_cases]
    names = list(stated)
    for state in designs.states[len(stated) :]:
        word = "over-speed" if float(state.speed[0, 0]) > 0.0 else "standstill"
        alike = (np.array_equal(each.preload, state.preload) for each in designs.states)
        first = stated[next(k for k, equal in enumerate(alike) if equal)]
        names.append(f"{word}, preload of {first}" if word in names else word)
    return names


def live_of(folder: Path) -> LiveDocument | None:
    """Response surfaces of a run, from its case, its lift and its greatest utilisations.

    Raises
    ------
    ResultError
        If the run cannot be read.
    """
    case, contour = drawn_cam(folder)
    return live_record(case, contour.pitch.lift.values, greatest(read_run(folder).final))


def write_live(folder: Path, record: LiveDocument | None) -> None:
    """Write ``8_live.json``; nothing without surfaces."""
    if record is not None:
        write_atomic(folder / LIVE, f"{json_text(record)}\n")


def _surfaces(record: Any) -> list[Surface]:
    """Every surface of a record: of the contact, of the quantities, of the limits."""
    parts = [*record["contact"], *(p for each in record["quantities"] for p in each["parts"])]
    stated = [each["surface"] for each in parts if each["surface"] is not None]
    stated += [each["limit"] for each in record["quantities"] if each["limit"] is not None]
    return [
        Surface(
            each["scale"],
            np.array(each["coefficients"], dtype=float),
            float(each["error"]),
            share=bool(each["share"]),
        )
        for each in stated
    ]


def _alike(one: Surface, other: Surface, at_places: Array) -> bool:
    """Whether two surfaces have the same values on their scale, of terms (m, p) at places."""
    if one.coefficients.shape != other.coefficients.shape:
        return False
    values = one.on_scale(at_places)
    away = np.abs(other.on_scale(at_places) - values).max()
    return bool(away <= SAME * np.abs(values).max())


def live_differences(folder: Path) -> Iterator[str]:
    """Differences of ``8_live.json`` of a run from one fitted again, in words.

    Which checks are followed is that of the file. Surfaces are compared by their values at three
    times as many settings of the ranges as they have terms: equal there, they are equal everywhere.

    Raises
    ------
    CamError
        If the run cannot be read.
    """
    stored: Any = read_json(folder / LIVE)
    case, contour = drawn_cam(folder)
    try:
        names = [each["id"] for each in stored["quantities"] if each["limit"] is not None]
        theirs, left_out = _surfaces(stored), list(stored["left_out"])
        if not all(isinstance(each, str) for each in (*names, *left_out)):
            raise TypeError
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        yield f"cannot be read ({type(error).__name__})"
        return
    again = live_record(case, contour.pitch.lift.values, [*names, *left_out])
    if again is None:
        yield "is none of the run"
        return
    yield from record_differences(stored, again, left_out=("coefficients",))
    exponents, ours = np.array(again["powers"]), _surfaces(again)
    count, axes = exponents.shape
    at_places = terms(settings(3 * count, axes, count, _SAMPLING_SEED), exponents)
    if len(ours) != len(theirs) or not all(
        _alike(one, other, at_places) for one, other in zip(ours, theirs, strict=True)
    ):
        yield "a surface differs"
