"""Exchange of a passing design's parts for smaller ones while it passes.

Each exchange is solved as the points of the front are; the last one is judged as they are, too:
preview at all tolerance corners.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.catalogue import better_roller, catalogue_of, undominated
from camwright.pipeline.case.cards.shaft_seats import Seat, seats
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.follower.spring import HelicalSpring
from camwright.pipeline.records.design_document import ExchangeRecord, ExchangesRecord
from camwright.pipeline.records.judgement_record import is_refused, is_whole
from camwright.pipeline.search.machine.design_case import Machinery, drawn_radius
from camwright.pipeline.search.machine.machine_frame import MODULES, STEMS
from camwright.pipeline.search.machine.synthesised_points import PointStudy, Solved
from camwright.pipeline.search.machine.wound_springs import of_catalogue

T = TypeVar("T")
_EXCHANGES_MAX = 24  # designs tried
_EQUAL_LENGTHS = 1e-6  # m, of equal sizes
_RIM = 0.8  # bores in the radius of the gear, at least


@dataclass(frozen=True)
class SortedParts:
    """Catalogue parts by increasing size."""

    seats: Sequence[Seat]
    rollers: Mapping[str, BearingCard]
    springs: Sequence[HelicalSpring]

    @classmethod
    def of(cls, study: PointStudy) -> SortedParts:
        """Parts of the shipped cards and of the user's beside the torque table."""
        parts = catalogue_of(study.folder)
        rollers = undominated(parts.rollers, better_roller)
        known = {name: card for name, card in rollers.items() if card.balls is not None}
        order = sorted(known, key=lambda name: (known[name].outer_diameter, known[name].C))
        springs = sorted(parts.springs.values(), key=lambda spring: spring.mass)
        return cls(seats(), {name: known[name] for name in order}, springs)


@dataclass(frozen=True)
class Exchange:
    """Design with one part exchanged for a smaller one, in words."""

    part: str
    was: str
    becomes: str
    design: Machinery


@dataclass(frozen=True)
class Exchanged:
    """Design after the exchanges, with the record of each.

    kept: exchanges with which it passes, in their order; failing: exchanges of the last design
    with why each fails; complete: whether every part of it was tried.
    """

    point: Solved
    kept: tuple[Exchange, ...] = ()
    failing: tuple[tuple[Exchange, str], ...] = ()
    complete: bool = True

    @property
    def sentence(self) -> str:
        """Result of the exchanges in words."""
        if not self.complete:
            return f"{_EXCHANGES_MAX} exchanges of parts tried: a design of smaller parts may pass"
        return "no part can be exchanged for the next smaller of its catalogue"

    def as_record(self) -> ExchangesRecord:
        """Record for JSON."""
        return {
            "kept": [_words(each) for each in self.kept],
            "failing": [{**_words(each), "why": why} for each, why in self.failing],
            "complete": self.complete,
            "claim": self.sentence,
        }


def exchanged(study: PointStudy, point: Solved, workers: Crew, progress: Progress) -> Exchanged:
    """Design with the smallest parts that single exchanges reach from a passing design.

    One part at a time becomes a smaller one of its catalogue: the shaft with key and bearings, the
    roller, the spring if it is of a catalogue, the stem with its bushes, the module of the gear.
    The stride along a catalogue doubles while exchanges pass; once one fails it halves with each,
    down to the next smaller part. A hub that becomes smaller is tried with the base circle less by
    as much, then with the same one; oil, fork and housing follow from the parts. An exchange that
    passes is kept; the search ends when the next smaller of every part of the same design has
    failed, or after `_EXCHANGES_MAX` designs.

    Most designs on the way are followed by a smaller one: only the last is judged at the tolerance
    corners. Where it fails there, the search is made again with each judged at them.

    Parameters
    ----------
    study : PointStudy    which solves designs
    point : Solved        the passing design
    workers : Crew        processes that solve
    progress : Progress   told the designs
    """
    smallest = _smallest(study, study.at_nominal, point, workers, progress)
    if not smallest.kept:
        return smallest
    last: Solved = workers.submit(study.solved, smallest.point.design).result()
    if last.has_cam and last.passes:
        return replace(smallest, point=last)
    return _smallest(study, study.solved, point, workers, progress)


def _smallest(
    study: PointStudy,
    judged: Callable[[Machinery], Solved],
    point: Solved,
    workers: Crew,
    progress: Progress,
) -> Exchanged:
    """Design with the smallest parts that single exchanges reach; see `exchanged`.

    Parameters
    ----------
    study : PointStudy    the task
    judged : callable     design -> solved design, to the depth at which it is to pass
    point : Solved        the passing design
    workers : Crew        processes that solve
    progress : Progress   told the designs
    """
    catalogues, kept = SortedParts.of(study), list[Exchange]()
    failing: dict[str, tuple[Exchange, str]] = {}
    failed = set[str]()
    begun: dict[str, PendingCall] = {}

    def solving(design: Machinery) -> PendingCall:
        text = study.text(design)
        if text not in begun:
            begun[text] = workers.submit(judged, design)
        return begun[text]

    place = unchanged = tried = 0
    stride, growth = 1, 2.0
    while unchanged < len(_EXCHANGES) and tried < _EXCHANGES_MAX:
        ways = list(_EXCHANGES[place](point.design, catalogues, stride))
        after = _EXCHANGES[(place + 1) % len(_EXCHANGES)](point.design, catalogues, 1)
        for each, then in zip(ways, [*ways[1:], next(after, None)], strict=False):
            progress.advance(tried, _EXCHANGES_MAX)
            tried += 1
            solution = solving(each.design)
            if unchanged and then is not None and then.part in failed:
                solving(then.design)  # likely to fail again: needed as the design is the same then
            solved: Solved = solution.result()
            if solved.has_cam and solved.passes and solved.size <= point.size + _EQUAL_LENGTHS:
                kept.append(each)
                point, failing, unchanged = solved, {}, 0
                stride = max(int(growth * stride), 1)
                break
            if stride == 1:
                failing[each.part] = each, why_not(solved)
                failed.add(each.part)
        else:
            if stride == 1 or not ways:
                unchanged += 1
                place = (place + 1) % len(_EXCHANGES)
                stride, growth = 1, 2.0
            else:
                stride, growth = stride // 2, 0.5
    progress.advance(_EXCHANGES_MAX, _EXCHANGES_MAX)
    complete = unchanged >= len(_EXCHANGES)
    return Exchanged(point, tuple(kept), tuple(failing.values()), complete)


def why_not(point: Solved) -> str:
    """Reason why a design does not pass, in words."""
    if is_refused(point.record):
        return point.record["why"]
    if point.failing:
        return "; ".join(point.failing)
    if not point.figures["feasible"]:
        return "; ".join(point.used_up) or "limits of the synthesis"
    lacking = point.record["open"] if is_whole(point.record) else []
    if lacking:
        return f"not known: {'; '.join(DECLARED[name].title for name in lacking)}"
    return "larger" if point.passes else "torque ripple"


def _words(each: Exchange) -> ExchangeRecord:
    return {"part": each.part, "from": each.was, "to": each.becomes}


def _shaft(design: Machinery, catalogues: SortedParts, stride: int) -> Iterator[Exchange]:
    """Exchanges of the shaft seat with key and bearings for one `stride` smaller in the catalogue:
    with the base circle reduced by as much as the hub, then with the same base circle; none where
    no smaller seat is left.
    """
    frame = design.frame
    lesser = [each for each in catalogues.seats if each.bore < frame.seat.bore]
    if not lesser:
        return
    seat = _down(lesser, stride)
    smaller = replace(frame, seat=seat)
    hub = frame.least_radius - smaller.least_radius
    words = _mm(frame.seat.bore), _mm(seat.bore)
    primes = drawn_radius(design.prime_radius - hub), design.prime_radius
    for prime in dict.fromkeys(primes):
        other = replace(design, frame=smaller, prime_radius=prime)
        yield Exchange("shaft with key and bearings", *words, _with_cam(design, other))


def _roller(design: Machinery, catalogues: SortedParts, stride: int) -> Iterator[Exchange]:
    """Exchange of the roller for one `stride` smaller in the catalogue, with the same base circle
    of the cam; none where no smaller one is left.
    """
    frame = design.frame
    order = list(catalogues.rollers)
    if frame.roller not in order or order[0] == frame.roller:
        return
    name = _down(order[: order.index(frame.roller)], stride)
    smaller = replace(frame, roller=name, card=catalogues.rollers[name])
    if smaller.stem > frame.stem:
        smaller = replace(smaller, stem_chosen=frame.stem)
    prime = max(design.prime_radius - frame.radius + smaller.radius, smaller.least_radius)
    other = replace(design, frame=smaller, prime_radius=drawn_radius(prime))
    yield Exchange("roller", frame.roller, name, other)


def _spring(design: Machinery, catalogues: SortedParts, stride: int) -> Iterator[Exchange]:
    """Exchanges of the catalogue spring for one `stride` lighter that stores the same energy over
    the same travel; none for a wound spring, or where no lighter one is left.
    """
    point = design.spring
    spring = point.spring
    if not spring.name:  # wound for its forces
        return
    lesser = [each for each in catalogues.springs if each.mass < spring.mass]
    if not lesser:
        return
    lighter = _down(lesser, stride)
    speed = design.task.cam_speed
    for other in of_catalogue([lighter], [point.energy], [point.travel], speed):
        drawn = replace(other.spring, temperature=spring.temperature, relaxation=spring.relaxation)
        yield Exchange(
            "spring",
            spring.name,
            lighter.name,
            replace(design, spring=replace(other, spring=drawn)),
        )


def _stem(design: Machinery, _: SortedParts, stride: int) -> Iterator[Exchange]:
    """Exchange of the stem and its bushes for a standard diameter `stride` smaller; none where no
    smaller one is left.
    """
    frame = design.frame
    lesser = [1e-3 * each for each in STEMS if 1e-3 * each < frame.stem - _EQUAL_LENGTHS]
    if lesser:
        size = _down(lesser, stride)
        other = replace(design, frame=replace(frame, stem_chosen=size))
        yield Exchange("stem with bushes", _mm(frame.stem), _mm(size), other)


def _module(design: Machinery, _: SortedParts, stride: int) -> Iterator[Exchange]:
    """Exchange of the module of the gear for a standard one `stride` smaller whose gear still has a
    rim about the shaft; none where no such one is left.
    """
    frame = design.frame
    rim = _RIM * frame.seat.bore
    modules = [1e-3 * each for each in MODULES if 0.5e-3 * each * frame.teeth[0] > rim]
    lesser = [each for each in modules if each < frame.module - _EQUAL_LENGTHS]
    if lesser:
        size = _down(lesser, stride)
        other = replace(design, frame=replace(frame, module=size))
        yield Exchange("module of the gear", _mm(frame.module), _mm(size), other)


def _down(lesser: Sequence[T], stride: int) -> T:
    """Part a stride below, of smaller parts by increasing size; the smallest if there are fewer."""
    return lesser[-min(stride, len(lesser))]


_EXCHANGES: tuple[Callable[[Machinery, SortedParts, int], Iterator[Exchange]], ...] = (
    _shaft, _roller, _spring, _stem, _module,
)  # fmt: skip
"""Designs with one part smaller by a stride, the part of the greatest gain first."""


def _with_cam(design: Machinery, other: Machinery) -> Machinery:
    """The other design, its cam smaller by as much as its prime radius."""
    less = design.prime_radius - other.prime_radius
    return replace(other, cam_radius=design.cam_radius - less)


def _mm(length: float) -> str:
    return f"{1e3 * length:g} mm"
