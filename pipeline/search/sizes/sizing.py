"""Open keys of a case: smallest values within its limits, and their checks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, islice, repeat
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.display import Displayed
from camwright.geometry.errors import CamError, InputError
from camwright.geometry.figures import DrawnAxes, Figure, plotted
from camwright.pipeline.base.columns import data_frame
from camwright.pipeline.base.crossing import first_passing
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.base.verdict import Verdict, verdict, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import refused_as_written, unit_at, value_of
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.arm_assembly import arm_cam_gap, arm_gap
from camwright.pipeline.checks.cam_shape import (
    concave_radius,
    curvature_ratio,
    minimum_wall,
    pressure_angle,
    second_contact,
    self_intersection,
    spring_travel,
    undercut,
)
from camwright.pipeline.checks.check import Check, Declaration
from camwright.pipeline.checks.contact_strength import (
    contact_pressure,
    contact_pressure_at_life,
    edge_pressure,
    shakedown,
)
from camwright.pipeline.checks.flat_face_sliding import face_width, self_locking
from camwright.pipeline.checks.form_closure import outer_undercut
from camwright.pipeline.checks.jump_and_jamming import (
    contact_at_overspeed,
    contact_force_margin,
    contact_over_speed,
    elastic_contact,
    jam_index,
    jump,
    jump_speed,
)
from camwright.pipeline.checks.manufacture import cam_radius
from camwright.pipeline.checks.registry import TOLERANCED
from camwright.pipeline.checks.spring_strength import (
    spring_coil_gap,
    spring_rate,
    spring_solid,
    spring_surge,
)
from camwright.pipeline.checks.tolerance_corners import governed, outcomes, spring_corners
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.judge import NOT_RAISED, Depth, Judge, Judgement, failing
from camwright.pipeline.search.sizes.open_case import (
    DISTANCE,
    FACE,
    OFFSET,
    PLACES,
    PRELOAD,
    PRIME,
    RATE,
    ROLLER,
    SECOND_ROLLER,
    OpenCase,
    read_open_case,
)
from camwright.pipeline.search.sizes.shapes import (
    RollerShapes,
    Shape,
    Shapes,
    allowance,
    rounded_up,
    shapes_of,
    values_of,
)
from camwright.pipeline.search.sizes.size_chart import size_figure
from camwright.pipeline.search.sizes.spring_choice import (
    ChosenSpring,
    more_preload,
    spring_of,
    stiffer,
)

if TYPE_CHECKING:
    import pandas as pd

_GROWTH = (pressure_angle, curvature_ratio, undercut, concave_radius, minimum_wall,
           outer_undercut, contact_pressure, contact_pressure_at_life, edge_pressure, shakedown,
           jam_index)  # fmt: skip
"""Checks that a larger cam can pass."""
_HELD = (contact_force_margin, jump, jump_speed, contact_at_overspeed, contact_over_speed,
         elastic_contact)  # fmt: skip
"""Checks that a greater preload can pass."""
_WOUND = (spring_surge, spring_solid, spring_coil_gap)
"""Checks that the winding of a stiffer spring can pass."""
_SHAPE = (
    *_GROWTH,
    cam_radius,
    self_intersection,
    second_contact,
    self_locking,
    arm_gap,
    arm_cam_gap,
)
_SPRING = (*_HELD, *_WOUND, spring_travel, spring_rate)
JUDGED: Mapping[str, tuple[Declaration, ...]] = {
    PRIME: _SHAPE, OFFSET: _SHAPE, DISTANCE: _SHAPE, ROLLER: _SHAPE, FACE: (face_width,),
    **dict.fromkeys((*PLACES, SECOND_ROLLER), _SHAPE),
    RATE: _SPRING, PRELOAD: _SPRING,
}  # fmt: skip
"""Checks that an open key decides."""

_SCREENED = Depth(Tier.SCREENING, undercut=True)
_PREVIEWED = Depth(corners=None, undercut=True)
_FACE_HALF_WIDTHS = 1.25
"""Half-widths of the contact that a face has beside it: the tolerances press more than nominal."""
_SIZE_STEP, _SIZE_STEPS, _SIZE_HALVINGS = 1.1, 16, 12
"""Factor and number of the steps by which a cam grows: to 4.6 times the radius, 2e-5 of it left."""
_USE_MARGIN = 1.001
"""The ratio of preview and screening changes slightly with the radius."""
_STIFFER, _LARGER, _TRIES = 1.1, 1.01, 8
"""Factors of rate and of radius by which a failing preview is repeated; how often."""
_PROVEN, _FIRMER, _DOUBLINGS, _BRACKET = 1.005, 1.1, 5, 1.01
"""First factor of the preload or rate of a follower that is not held, for the error bars of a
closed form at its limit; the next one, its squares tried up to _FIRMER**(2**(_DOUBLINGS - 1)), 4.6;
ratio of passing to failing value at which the search ends."""


@dataclass(frozen=True, eq=False, repr=False)
class Sizing(Displayed):
    """Sizes of an open case, with the checks they decide.

    Parameters
    ----------
    opened : OpenCase
    text : str             of the complete case
    case : Case            complete
    shapes : Shapes        of the cam within its geometric limits
    exact : Shape          smallest one by geometry, before rounding
    shape : Shape          of the complete case
    spring : ChosenSpring    of the complete case
    values : mapping       SI number by open key
    sources : mapping      reason of each value
    checks : tuple         of the preview: those that the open keys decide
    others : tuple         ids of the further must-have checks that fail
    """

    opened: OpenCase
    text: str
    case: Case
    shapes: Shapes
    exact: Shape
    shape: Shape
    spring: ChosenSpring
    values: Mapping[str, float]
    sources: Mapping[str, str]
    checks: tuple[Check, ...]
    others: tuple[str, ...]

    @property
    def facts(self) -> Mapping[str, object]:
        """Case, verdict, and the sized values by key."""
        values = {key: shown(value, unit_at(key), 6) for key, value in self.values.items()}
        return {"case": self.case.name, "verdict": self.verdict} | values

    @cached_property
    def figure(self) -> Figure:
        """Pressure angle and curvature over the base radius, a panel each with its limits."""
        return size_figure(self.case, self.shapes, self.shape)

    def to_pandas(self) -> pd.DataFrame:
        """A row per open key: key, value, unit, source; see `Table.to_pandas`."""
        units = [unit_at(key) for key in self.values]
        return data_frame(
            {
                "key": list(self.values),
                "value": list(map(in_unit, self.values.values(), units)),
                "unit": units,
                "source": [self.sources[key] for key in self.values],
            }
        )

    def plot(self) -> DrawnAxes:
        """Figure of the sizes, a panel for each quantity with its limits."""
        return plotted(self.figure)

    @property
    def verdict(self) -> Verdict:
        """Verdict of the must-have checks that the open keys decide; pass without any."""
        return verdict(self.checks) if self.checks else "pass"

    @property
    def no_size(self) -> bool:
        """Whether checks fail that depend on the size, at every size tried."""
        small = any(each.status == "fail" and each.declaration in _GROWTH for each in self.checks)
        return small and self.opened.grows

    @property
    def greatest_tried(self) -> float:
        """Greatest prime or base radius tried, m."""
        return self.exact.prime_radius * _SIZE_STEP**_SIZE_STEPS


def size(
    path: str | Path,
    free: Collection[str] = (),
    *,
    least_radius: float = 0.0,
    progress: Progress = SILENT,
) -> Sizing:
    """Sizes of a case file that leaves keys open; see `sized`.

    Parameters
    ----------
    path : str or Path     case file without any of `cam.prime_radius`, `cam.offset`,
                           `roller.radius`, `follower.face.width`,
                           `follower.arm.centre_distance`, `spring.rate`, `spring.preload` and, of
                           a pair of discs, `cam.conjugate.distance`, `cam.conjugate.arm_angle`,
                           `cam.conjugate.roller_radius`
    free : collection      those of these keys whose values in the file are not kept
    least_radius : float   least convex radius of the contour, m
    """
    return sized(read_open_case(path, free), least_radius=least_radius, progress=progress)


def sized(opened: OpenCase, *, least_radius: float = 0.0, progress: Progress = SILENT) -> Sizing:
    """Sizes of an open case: smallest base radius, best offset, roller, face, spring.

    The geometry gives the smallest cam of pressure angle, curvature, tool and wall. It grows until
    the closed-form checks of contact pressure and jamming pass; the preload grows until contact
    holds with friction, surge and elastic stem, with all tolerances at their worst ends at once.
    The complete case is judged by a preview at its tolerance corners.

    Parameters
    ----------
    opened : OpenCase      case with its open keys
    least_radius : float   least convex radius of the contour, m, >= 0
    progress : Progress    told each stage

    Raises
    ------
    CamError
        If the case contradicts itself, or has no such cam.
    """
    with refused_as_written(opened.case):
        shapes = shapes_of(opened, least_radius)
        judge = Judge(opened.case, engine_torques(opened.case))
        return _SizeSearch(opened, shapes, judge, progress).sized()


class _Sized(NamedTuple):
    """Spring and shape with the text of the complete case, its judgement and checks."""

    spring: ChosenSpring
    shape: Shape
    text: str
    judgement: Judgement
    checks: tuple[Check, ...]


@dataclass(frozen=True, eq=False)
class _SizeSearch:
    opened: OpenCase
    shapes: Shapes
    judge: Judge
    progress: Progress

    def sized(self) -> Sizing:
        """Sizes of the open case: the smallest shape of the geometry, grown with the spring until
        the preview passes or no larger one helps.
        """
        self.progress.stage("geometry")
        exact = self.shapes.smallest()
        spring = self._spring(exact)
        best = self._judged(self._grown(exact, spring), spring)
        if self._rate_is_open and failing(best.checks, _WOUND):
            best = self._stiffened(exact, best)
        raised: dict[str, float] = {}
        for _ in range(_TRIES):
            # the preview adds tolerances, surge, elastic stem and guides to the screening
            screened = self._screened(best.shape, best.spring)
            small = failing(best.checks, _GROWTH) if self.opened.grows else ()
            if self._spring_is_open and (loose := failing(best.checks, _HELD)):
                firm = self._firm(exact, best.spring, _titles(loose), raised)
                if firm is None:
                    break
                best = firm
            elif small and not screened.failing(_GROWTH):
                raised |= _raised(small, screened)
                shape = self._grown(exact, best.spring, raised)
                if not shape.prime_radius > best.shape.prime_radius:
                    prime = _LARGER * best.shape.prime_radius
                    larger = self.shapes.enlarged(best.shape, prime, _titles(small))
                    shape, _ = self._fitted(larger, best.spring)
                best = self._judged(shape, best.spring)
            else:
                break
        ids = {one.id for gap in self.opened.gaps for one in JUDGED[gap]}
        made = [each for each in within_depth(best.checks) if each.must_have]
        return Sizing(
            opened=self.opened,
            text=best.text,
            case=best.judgement.solved.case,
            shapes=self.shapes,
            exact=exact,
            shape=best.shape,
            spring=best.spring,
            values=self._values(best.shape, best.spring),
            sources=self._sources(best.shape, best.spring),
            checks=tuple(each for each in made if each.id in ids and not _unlimited(each)),
            others=tuple(each.id for each in made if each.status == "fail" and each.id not in ids),
        )

    @property
    def _rate_is_open(self) -> bool:
        """Whether no winding sets the rate; a spring of a catalogue follows it."""
        return RATE in self.opened.gaps and self.opened.case.spring.design is None

    @property
    def _spring_is_open(self) -> bool:
        """Whether the preload, or the rate beside a stated one, may grow to hold the follower."""
        return PRELOAD in self.opened.gaps or self._rate_is_open

    def _spring(self, shape: Shape, stiff: ChosenSpring | None = None) -> ChosenSpring:
        return spring_of(self.opened.case, self.opened.gaps, self.shapes.parts(shape), stiff)

    def _stiffened(self, exact: Shape, first: _Sized) -> _Sized:
        """Complete case with the first of ever stiffer springs whose winding passes its checks;
        `first` where none of those tried does.

        Parameters
        ----------
        exact : Shape    smallest shape by geometry
        first : _Sized   complete case whose winding fails
        """
        reason, spring = _titles(failing(first.checks, _WOUND)), first.spring
        for _ in range(_TRIES):
            spring = self._spring(exact, stiffer(spring, _STIFFER, reason))
            shape = self._grown(exact, spring)
            try:
                stiff = self._judged(shape, spring)
            except InputError:  # the catalogue has no spring of this rate
                continue
            if not failing(stiff.checks, _WOUND):
                return stiff
        return first

    def _firm(
        self, exact: Shape, start: ChosenSpring, reason: str, raised: Mapping[str, float]
    ) -> _Sized | None:
        """Complete case with the weakest spring, within 1 %, whose preview holds the follower on
        the cam; None where none of those tried does.

        The preload grows where it is open; where the case states it, the rate.

        Parameters
        ----------
        exact : Shape          smallest shape by geometry
        start : ChosenSpring   that does not hold the follower
        reason : str           checks that fail, the reason of the new value
        raised : mapping       utilisation in the preview over that of the screening, by check
        """
        grown = more_preload if PRELOAD in self.opened.gaps else stiffer

        def holding(factor: float) -> _Sized | None:
            """Case complete with the spring grown by a factor, if its preview holds the follower;
            else None.
            """
            spring = grown(start, factor, reason)
            try:
                firm = self._judged(self._grown(exact, spring, raised), spring)
            except CamError:  # contradicts the case, or the catalogue has no such spring
                return None
            return None if failing(firm.checks, _HELD) else firm

        factors = (_PROVEN, *(_FIRMER ** (2**k) for k in range(_DOUBLINGS)))
        return first_passing(holding, 1.0, factors, near=_bracketed, middle=_geometric_mean)

    def _values(self, shape: Shape, spring: ChosenSpring) -> dict[str, float]:
        """Values of the open keys, SI, of a shape and a spring."""
        own = {RATE: spring.rate, PRELOAD: spring.preload}
        own |= values_of(shape, self.opened.gaps)
        return {key: own[key] for key in self.opened.gaps}

    def _sources(self, shape: Shape, spring: ChosenSpring) -> dict[str, str]:
        """Reason of the value of each open key, in words."""
        words = {
            PRIME: f"sized: {shape.governs}",
            OFFSET: f"sized: {shape.offset_governs}",
            DISTANCE: f"sized: {shape.offset_governs}",
            ROLLER: f"sized: {self._roller_by}",
            FACE: "sized: travel of the contact and its half-width",
            RATE: f"sized: {spring.rate_by}",
            PRELOAD: f"sized: {spring.preload_by}",
            **dict.fromkeys(PLACES, "sized: the second disc grows as the first one"),
            SECOND_ROLLER: "sized: as the first roller",
        }
        return {key: words[key] for key in self.opened.gaps}

    @property
    def _roller_by(self) -> str:
        ring = value_of(self.opened.case, "roller.bearing.ring")
        return "outer ring of its bearing" if ring else "least contact pressure within curvature"

    def _screened(self, shape: Shape, spring: ChosenSpring) -> Judgement:
        return self.judge.judged(Change.of(self._values(shape, spring)), _SCREENED, quick=True)

    def _fitted(self, shape: Shape, spring: ChosenSpring) -> tuple[Shape, Judgement]:
        """Shape with the dimensions that the case leaves open rounded up to those of a drawing, and
        its screening.

        The base radius grows by the profile tolerance first, so that the part as made keeps the
        limits. A roller or flat face follows from the contact of the solved cam: force and
        curvature of the pitch curve, travel and width of the contact.

        Parameters
        ----------
        shape : Shape           as the geometry requires
        spring : ChosenSpring   with which it is screened
        """
        gaps = self.opened.gaps
        if self.opened.grows:
            prime = shape.prime_radius
            if PRIME in gaps:
                prime = rounded_up(prime + allowance(self.opened.case))
            shape = self.shapes.with_radius(shape, prime)
        if FACE in gaps:
            shape = shape._replace(face_width=rounded_up(shape.face_width))
        screened = self._screened(shape, spring)
        if FACE in gaps:
            widest = max(
                float(np.max(np.abs(each.contour.pitch.slide(each.theta).on_face)
                             + _FACE_HALF_WIDTHS * each.contact.half_width))
                for each in screened.solved.cycles
            )  # fmt: skip
            shape = shape._replace(face_width=rounded_up(max(2.0 * widest, shape.face_width)))
            screened = self._screened(shape, spring)
        if ROLLER in gaps and isinstance(self.shapes, RollerShapes):
            pressed = [_pressed(each, gaps) for each in screened.solved.cycles]
            force, curvature = (np.stack(each) for each in zip(*pressed, strict=True))
            shape = self.shapes.best_roller(shape, force, curvature)
            screened = self._screened(shape, spring)
        return shape, screened

    def _grown(
        self, shape: Shape, spring: ChosenSpring, raised: Mapping[str, float] = NOT_RAISED
    ) -> Shape:
        """Smallest shape, in steps of the prime radius from a given one on, for which the checks
        that a larger cam can cure pass by the screening.

        The given shape with its dimensions rounded where they pass with it, the prime radius is not
        open, or no larger shape helps.

        Parameters
        ----------
        shape : Shape           the smallest one tried
        spring : ChosenSpring   with which it is screened
        raised : mapping        utilisation in the preview over that of the screening, by check
        """
        self.progress.stage("contact")
        least, screened = self._fitted(shape, spring)
        small = screened.failing(_GROWTH, raised)
        if not self.opened.grows or not small:
            return least

        def passing(prime: float) -> Shape | None:
            """Shape with a prime radius, m, if its checks pass; else None."""
            larger = self.shapes.enlarged(shape, prime, _titles(small))
            try:
                larger, screened = self._fitted(larger, spring)
            except CamError:
                return None
            return None if screened.failing(_GROWTH, raised) else larger

        low = shape.prime_radius
        primes = islice(accumulate(repeat(_SIZE_STEP, _SIZE_STEPS), mul, initial=low), 1, None)
        return first_passing(passing, low, primes, _SIZE_HALVINGS) or least

    def _judged(self, shape: Shape, spring: ChosenSpring) -> _Sized:
        """Case complete with a shape and a spring, judged by a preview."""
        self.progress.stage("preview")
        values = self._values(shape, spring)
        text = self.opened.with_sources(values, self._sources(shape, spring))
        judge = replace(self.judge, base=self.opened.sized(text))
        judgement = judge.judged(Change(), _PREVIEWED)
        checks = self._at_worst(judgement) if self._spring_is_open else judgement.every
        return _Sized(spring, shape, text, judgement, checks)

    def _at_worst(self, judgement: Judgement) -> tuple[Check, ...]:
        """Checks of a judged case; one on the spring that fails beyond its error bar at the worst
        ends of all tolerances together has its values there.

        All as judged where one on the spring fails already.
        """
        ones = [each for each in (*_HELD, *_WOUND) if each in TOLERANCED]
        nominal = [each for each in judgement.every if each.declaration in ones]
        if any(each.must_have and each.status == "fail" for each in nominal):
            return judgement.every
        solved = judgement.solved
        worst = outcomes(
            solved.case, solved.machines, solved.contour, spring_corners(solved.case), ones
        )
        judged = governed(nominal, (*judgement.tried, *worst))
        beyond = {one.id: one for one in judged if one.status == "fail" and not one.not_proven}
        return tuple(beyond.get(each.id, each) for each in judgement.every)


def _pressed(cycle: Cycle, gaps: Collection[str]) -> tuple[Array, Array]:
    """Normal force, N, and curvature of the pitch curve, 1/m, (n,) each, on the track that carries;
    without force where its roller is not open.
    """
    loads, pitch = cycle.loads, cycle.contour.pitch
    curvature = pitch.curvature(cycle.theta)
    if loads.second is None:
        return loads.normal_force, loads.wall * curvature
    track, first = loads.second.track(pitch), loads.wall > 0.0
    other = track.contour.pitch.curvature(cycle.theta + track.turn)
    counts = first | (SECOND_ROLLER in gaps)
    return np.where(counts, loads.normal_force, 0.0), np.where(first, curvature, other)


def _bracketed(low: float, high: float) -> bool:
    """Whether the search of a firm spring ends between two factors."""
    return high <= _BRACKET * low


def _geometric_mean(low: float, high: float) -> float:
    return float(np.sqrt(low * high))


def _raised(small: tuple[Check, ...], screened: Judgement) -> dict[str, float]:
    """Utilisation of checks in the preview over that of the screening, by id."""
    below = {each.id: each.utilisation for each in screened.every}
    return {
        each.id: _USE_MARGIN * each.utilisation / share
        for each in small
        if each.utilisation and (share := below.get(each.id))
    }


def _unlimited(check: Check) -> bool:
    """Whether a check is not evaluated because the case sets no such limit."""
    missing = check.missing if check.status == "not_evaluated" else ()
    return bool(missing) and all(key.startswith("limits.") for key in missing)


def _titles(checks: tuple[Check, ...]) -> str:
    return " and ".join(each.title for each in checks)
