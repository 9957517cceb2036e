"""Solved designs: prime radius and preload by constrained synthesis, then rounded."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import ceil, inf
from pathlib import Path
from typing import NamedTuple, TypeVar

from camwright.geometry.errors import CamError, ResultError
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.key_strength import keyway_root
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.records.design_document import DesignOptions
from camwright.pipeline.records.judgement_record import (
    DraftJudgement,
    PreviewJudgement,
    RefusedJudgement,
    is_refused,
    is_whole,
)
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.front import front, thinned
from camwright.pipeline.search.judge import Judge, judgements, refusal
from camwright.pipeline.search.machine.candidate_search import (
    FAR,
    OPTIMISTIC,
    Candidate,
    candidates,
)
from camwright.pipeline.search.machine.design_case import (
    SYNTHESIS,
    Machinery,
    case_text,
    drawn_radius,
)
from camwright.pipeline.search.machine.torque_task import DesignTask
from camwright.pipeline.smoothing.constraints import check_of

R = TypeVar("R")
_FRONT_WITHIN = 5  # of the front of the screening within the limits
_FRONT_NEAR = 2  # of the front of those near to them
_ROLLERS = 3  # whose likeliest designs are tried
_CURABLE_EXCESS = 0.5  # excess that a synthesis may remove
_SAME_SIZE = 0.02  # relative size within which the lesser ripple replaces
_RIPPLE_GAIN = 0.03  # of the ripple, between points
_SHRUNK, _GROWN = 0.9, 1.1  # of the prime radius of the screening
_AT_MOST = 0.999  # of the greatest prime radius, above which it is that one
_CREDIT = 1.02  # of the gain of the best design by its offset, for that of another
_CURABLE = 1.2  # utilisation that a larger cam may cure
_SHORT = 1.05  # utilisation that a synthesis with corrections may cure
_DRAFTS_AT_ONCE = 2  # drafts solved at once where the first that passes is enough
_FREE_PRELOAD = (0.85, 1.1)  # of the preload of the screening: the spring has room for 1.05
_ROUND_OFF = 1e-7  # m, of a prime radius that is a drawn one already
RESERVE = 0.01  # of the ripple allowed, for the corrections by finite elements


@dataclass(frozen=True)
class PointStudy:
    """Design task with the folder of its solved points."""

    task: DesignTask
    folder: Path
    file: str
    version: str

    def text(self, design: Machinery, smoothing: str = SYNTHESIS) -> str:
        """Case file of a design of the task."""
        return case_text(design, "design", self.file, smoothing=smoothing)

    def solved(self, design: Machinery, smoothing: str = SYNTHESIS) -> Solved:
        """A design with its record, cached or solved, its checks judged at all tolerance ends."""
        record = self._judged(design, smoothing, lambda judge: judge.previewed(Change()))
        return Solved(design, record, smoothing)

    def at_nominal(self, design: Machinery) -> Solved:
        """A design with its record, its checks without the tolerance corners."""
        record = self._judged(
            design, SYNTHESIS, lambda judge: judge.previewed(Change(), corners=False)
        )
        return Solved(design, record)

    def drafted(self, design: Machinery, smoothing: str) -> Solved:
        """A design with the record of its synthesis on few cam angles, cached or solved."""
        record = self._judged(design, smoothing, lambda judge: judge.drafted(Change()))
        return Solved(design, record, smoothing)

    def passing(
        self, changes: DesignOptions, workers: Crew, order: Callable[[Candidate], float]
    ) -> Solved | None:
        """First draft that passes with some options of the task changed; see `passing_draft`."""
        relaxed = replace(self, task=self.task.relaxed(changes))
        screened = candidates(relaxed.task, relaxed.folder, relaxed.file, SILENT)
        return passing_draft(relaxed, screened, workers, order)

    def _judged(
        self, design: Machinery, smoothing: str, record: Callable[[Judge], R]
    ) -> R | RefusedJudgement:
        """Result of a function of the judge of a design's case; the refusal where the case is
        refused.

        Parameters
        ----------
        design : Machinery   whose text makes the case
        smoothing : str      lines of `[smoothing]`
        record : callable    judge of the case -> result
        """
        try:
            case = parse_case(self.text(design, smoothing), self.folder)
            torques = engine_torques(case)
        except CamError as error:
            return refusal(error)
        store = judgements(self.folder)
        return record(Judge(case, torques, store=store, version=self.version))


@dataclass(frozen=True)
class Solved:
    """Design with its preview or draft record."""

    design: Machinery
    record: PreviewJudgement | DraftJudgement | RefusedJudgement
    smoothing: str = field(default=SYNTHESIS, repr=False)

    @property
    def has_cam(self) -> bool:
        """Whether there is a cam to judge."""
        return not is_refused(self.record)

    @property
    def figures(self) -> PreviewJudgement | DraftJudgement:
        """The record of a cam.

        Raises
        ------
        ResultError
            If there is none.
        """
        if is_refused(self.record):
            raise ResultError(self.record["why"])
        return self.record

    @property
    def whole(self) -> PreviewJudgement:
        """The record of a preview.

        Raises
        ------
        ResultError
            If there is no cam, or a draft alone.
        """
        if not is_whole(self.figures):
            raise ResultError("a draft is not solved in full")
        return self.figures

    @property
    def passes(self) -> bool:
        """Whether all limits are kept, the ripple with a reserve for finite elements."""
        most = (1.0 - RESERVE) * self.design.task.ripple_allowed
        if not self.has_cam or (is_whole(self.record) and self.record["verdict"] != "pass"):
            return False
        return not self._shortfalls and self.ripple <= most

    def better_than(self, other: Solved) -> bool:
        """Whether this design passes where the other fails, or both pass and it leaves less ripple
        at a size not notably larger; where neither passes, whether its checks fail by less.
        """
        if not self.has_cam or not other.has_cam:
            return self.has_cam
        if not (self.passes and other.passes):
            return self.passes or (not other.passes and self.shortfall < other.shortfall)
        return self.ripple < other.ripple and self.size <= (1.0 + _SAME_SIZE) * other.size

    @property
    def size(self) -> float:
        """From the far side of the cam to the top of the roller at maximum lift, m."""
        record = self.figures
        lift, radius, prime = (
            1e-3 * length
            for length in (
                record["lift_max_mm"], record["cam_radius_mm"], record["prime_radius_mm"],
            )
        )  # fmt: skip
        return radius + prime + lift + self.design.frame.radius

    @property
    def ripple(self) -> float:
        """Torque ripple left, standard deviation, N m."""
        figures = self.figures
        if is_whole(figures):
            return figures["ripple_left_Nm"]
        return figures["ripple_left_share"] * self.design.task.demand.ripple

    @property
    def use(self) -> float:
        """Greatest utilisation of the checks that fail and of the allowed ripple, this with the
        reserve for finite elements; infinite without a cam.
        """
        if not self.has_cam:
            return inf
        ripple = self.ripple / ((1.0 - RESERVE) * self.design.task.ripple_allowed)
        return max([ripple, *self._uses])

    @property
    def failing(self) -> list[str]:
        """Titles of the checks that fail."""
        return [title for title, _ in self._shortfalls]

    @property
    def root_fails(self) -> bool:
        """Whether the keyway root fails by finite elements."""
        return is_whole(self.record) and keyway_root.id in self.record["failing"]

    @property
    def used_up(self) -> list[str]:
        """Titles of the checks whose limits the synthesis uses up, or exceeds if not feasible."""
        checks = dict.fromkeys(check_of(name) for name in self.figures["binding"])
        return [DECLARED[check].title for check in checks if check in DECLARED]

    @property
    def shortfall(self) -> float:
        """Sum of the utilisations of the checks that fail; 99 for an infinite one."""
        return sum(self._uses)

    @property
    def _uses(self) -> list[float]:
        return [used or 99.0 for _, used in self._shortfalls]

    @property
    def _shortfalls(self) -> list[tuple[str, float | None]]:
        """Title and utilisation of each check that fails, None where it is unknown; of a draft the
        worst one alone.
        """
        figures = self.figures
        if is_whole(figures):
            return [(each["title"], each["utilisation"]) for each in figures["shortfalls"]]
        check = check_of(figures["limit"])
        return [(DECLARED[check].title, figures["utilisation"])] if check else []


def promising(task: DesignTask, screened: Sequence[Candidate]) -> list[Candidate]:
    """Screened designs that may lie on the front, by increasing size.

    The front of those within the limits, the smallest ones near to them, and the likeliest of the
    likeliest rollers.
    """
    chosen = _screened_front(task, screened, 0.0, _FRONT_WITHIN)
    chosen += _screened_front(task, screened, _CURABLE_EXCESS, _FRONT_NEAR)
    left = list(screened)
    for _ in range(_ROLLERS):
        likely = likeliest(left)
        if likely is None:
            break
        chosen.append(likely)
        left = [each for each in left if each.design.frame.roller != likely.design.frame.roller]
    distinct = [each for k, each in enumerate(chosen) if each not in chosen[:k]]
    return sorted(distinct, key=lambda each: (each.size, each.ripple))


def _screened_front(
    task: DesignTask, screened: Sequence[Candidate], excess: float, most: int
) -> list[Candidate]:
    """At most `most` screened designs on the front of ripple and size.

    Parameters
    ----------
    task : DesignTask     ripple of the torque
    screened : sequence   all screened designs
    excess : float        greatest sum of the utilisations above 1; others are left out, and those
                          larger than `FAR` times the smallest
    most : int            number of designs
    """
    good = [each for each in screened if each.within(excess)]
    largest = FAR * min((each.size for each in good), default=0.0)
    good = [each for each in good if each.size <= largest]
    figures = [(each.size, each.ripple) for each in good]
    places = front(figures, _SAME_SIZE, _RIPPLE_GAIN * task.demand.ripple)
    return [good[k] for k in thinned(places, figures, most)]


def likeliest(screened: Sequence[Candidate]) -> Candidate | None:
    """Screened design with the most room to ripple and limits; None if all are hopeless."""
    best = min(screened, key=violation, default=None)
    return best if best is not None and violation(best) <= OPTIMISTIC + _CURABLE_EXCESS**2 else None


def violation(candidate: Candidate) -> float:
    """Ripple over that allowed plus weighted excess of the checks: estimate of infeasibility."""
    return (
        candidate.ripple / candidate.design.task.ripple_allowed + _CURABLE_EXCESS * candidate.excess
    )


def draft(study: PointStudy, candidate: Candidate) -> Solved:
    """Screened design with prime radius and preload of least ripple, by a synthesis on few cam
    angles.

    Both are free about the values of the screening. Where the limits conflict by little at the
    greatest prime radius and the space is not limited, a larger one is tried.
    """
    point = _free(study, candidate, 1.0)
    if study.task.space is not None or point.passes or not point.use <= _CURABLE:
        return point
    if point.figures["prime_radius_mm"] < _AT_MOST * 1e3 * point.design.prime_radius:
        return point
    larger = _free(study, candidate, _GROWN)
    return larger if larger.use < point.use else point


def _free(study: PointStudy, candidate: Candidate, growth: float) -> Solved:
    """Draft with the preload and, up to some growth, the prime radius free."""
    design = _rounded(candidate.design)
    return study.drafted(design, freed(design, growth))


def freed(design: Machinery, growth: float) -> str:
    """Lines of `[smoothing]` in a case file for a synthesis with initial energy, preload and prime
    radius as variables.

    Parameters
    ----------
    design : Machinery   about whose values both range
    growth : float       greatest prime radius over that of the design
    """
    high = growth * design.prime_radius
    low = max(design.frame.least_radius, _SHRUNK * design.prime_radius)
    radii = 1e3 * min(low, 0.999 * high), 1e3 * high
    forces = [share * design.spring.preload for share in _FREE_PRELOAD]
    return SYNTHESIS + (
        'free = ["initial_energy", "prime_radius", "preload"]\n'
        f'prime_radius_range = ["{radii[0]:.6g} mm", "{radii[1]:.6g} mm"]\n'
        f'preload_range = ["{forces[0]:.6g} N", "{forces[1]:.6g} N"]\n'
    )


def synthesised(study: PointStudy, point: Solved) -> Solved:
    """Draft solved in full by a preview, with prime radius and preload rounded as in a drawing.

    Where a check fails by little, the synthesis is first repeated in full, with the corrections for
    the guides, and its prime radius and preload are taken if they pass. Not where it is the keyway
    root that fails: under a fit the synthesis does not keep its limit.

    Parameters
    ----------
    study : PointStudy   which solves designs
    point : Solved       the draft
    """
    drawn = settled(study, point)
    if not drawn.has_cam or drawn.passes or drawn.use > _SHORT or drawn.root_fails:
        return drawn
    corrected = study.solved(point.design, point.smoothing)
    return settled(study, corrected) if corrected.has_cam and corrected.passes else drawn


def settled(study: PointStudy, point: Solved) -> Solved:
    """Design with the prime radius and preload of its synthesis, rounded as in a drawing, solved
    again by a preview.

    Room and counterweight are laid out for the cam radius of the synthesis.
    """
    record, design = point.figures, point.design
    prime = drawn_radius(1e-3 * record["prime_radius_mm"] - _ROUND_OFF, ceil)
    if study.task.space is not None:
        prime = min(prime, design.prime_radius)
    spring = replace(design.spring, preload=float(f"{record['preload_N']:.3g}"))
    return study.solved(
        replace(
            design,
            prime_radius=prime,
            spring=spring,
            cam_radius=1e-3 * record["cam_radius_mm"],
        )
    )


def _rounded(design: Machinery) -> Machinery:
    """The design with lift and preload as a drawing states them."""
    spring = replace(design.spring, preload=float(f"{design.spring.preload:.3g}"))
    return replace(design, spring=spring, lift=2e-4 * ceil(design.lift / 2e-4))


class Drafts(NamedTuple):
    """Drafts with a cam; `replaced`: drafts superseded by the same design with an offset."""

    points: list[Solved]
    replaced: list[Solved]


def drafts(study: PointStudy, screened: Sequence[Candidate], workers: Crew) -> Drafts:
    """Drafts of the screened designs that may lie on the front.

    Without an offset; where the best of them is better with one, all others that may pass with its
    gain as well.
    """
    chosen = promising(study.task, screened)
    return _with_offsets(study, chosen, _drafted(study, chosen, workers), workers)


def _with_offsets(
    study: PointStudy, chosen: Sequence[Candidate], points: list[Solved], workers: Crew
) -> Drafts:
    """All drafts with a cam; those near to passing are replaced by drafts with an offset of the
    follower, if an offset improves the best one.

    Parameters
    ----------
    study : PointStudy   which drafts designs
    chosen : sequence    screened designs
    points : list        their drafts, in the same order
    workers : Crew       processes that draft
    """
    near = [k for k, each in enumerate(points) if each.use <= _CURABLE]
    replaced: list[int] = []
    shifted: list[Solved] = []
    if near:
        first = min(near, key=lambda k: points[k].use)
        best = draft(study, chosen[first].with_offset)
        if best.better_than(points[first]):
            most = _CREDIT * max(points[first].use / best.use, 1.0)
            others = [k for k in near if k != first and points[k].use <= most]
            replaced = [first, *others]
            shifted = [best, *_drafted(study, [chosen[k].with_offset for k in others], workers)]
    kept = [each for k, each in enumerate(points) if k not in replaced]
    return Drafts([each for each in kept + shifted if each.has_cam], [points[k] for k in replaced])


def _drafted(study: PointStudy, chosen: Sequence[Candidate], workers: Crew) -> list[Solved]:
    waiting = [workers.submit(draft, study, each) for each in chosen]
    return [each.result() for each in waiting]


def solved_front(
    study: PointStudy, drafted: Drafts, workers: Crew, progress: Progress
) -> tuple[list[Solved], list[Solved]]:
    """Designs that pass when solved in full, on their front of ripple and size, and those that
    fail, the nearest to passing first.

    The drafts on the front are solved; where none of them passes, the other drafts that pass, those
    replaced at last.

    Parameters
    ----------
    study : PointStudy    which solves designs
    drafted : Drafts      drafts, and those replaced by one with an offset
    workers : Crew        processes that solve
    progress : Progress   told the designs
    """
    likely, last = ([each for each in points if each.passes] for points in drafted)
    passing: list[Solved] = []
    failing = [each for each in drafted.points if not each.passes]
    while (likely or last) and not passing:
        if not likely:
            likely, last = last, []
        batch = _front(likely)
        likely = [each for each in likely if each not in batch]
        waiting = [workers.submit(synthesised, study, each) for each in batch]
        for k, each in enumerate(waiting):
            progress.advance(k, len(batch))
            point = each.result()
            if point.has_cam:
                (passing if point.passes else failing).append(point)
        progress.advance(len(batch), len(batch))
    return _front(passing), sorted(failing, key=lambda each: each.use)


def passing_draft(
    study: PointStudy,
    screened: Sequence[Candidate],
    workers: Crew,
    order: Callable[[Candidate], float] = violation,
) -> Solved | None:
    """First draft that passes when solved in full; None if none does.

    Designs without an offset are drafted first: where one passes, none with an offset is.

    Parameters
    ----------
    study : PointStudy    which solves designs
    screened : sequence   screened designs, of which the promising are drafted
    workers : Crew        processes that draft
    order : callable      screened design -> number; the least is drafted first
    """
    chosen = sorted(promising(study.task, screened), key=order)
    plain: list[Solved] = []
    for start in range(0, len(chosen), _DRAFTS_AT_ONCE):
        batch = _drafted(study, chosen[start : start + _DRAFTS_AT_ONCE], workers)
        first = _passing(study, batch)
        if first is not None:
            return first
        plain += batch
    return _passing(study, _with_offsets(study, chosen, plain, workers).points)


def _passing(study: PointStudy, points: Sequence[Solved]) -> Solved | None:
    """First of the drafts, as a draft, that passes when solved in full; None without one."""
    for each in points:
        point = synthesised(study, each) if each.passes else each
        if point.has_cam and point.passes:
            return each
    return None


def _front(points: Sequence[Solved]) -> list[Solved]:
    figures = [(each.size, each.ripple) for each in points]
    return [points[k] for k in front(figures)]
