"""Designs solved in full: prime radius and preload by the constrained synthesis, then rounded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path

from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.studies.design.candidate_search import FAR, OPTIMISTIC, Candidate
from camwright.pipeline.studies.design.design_case import SYNTHESIS, Machinery, case_text
from camwright.pipeline.studies.design.torque_task import DesignTask
from camwright.pipeline.studies.redesign.pareto_front import front, thinned
from camwright.pipeline.studies.redesign.point_store import Record, Task, solved

_POINTS = 4  # of the front of the screening, solved in full
_NEAR = 0.5  # excess that a synthesis may remove
_ALIKE = 0.02  # relative size within which the lesser ripple replaces
_GAIN = 0.03  # of the ripple, between points
_SHRUNK, _GROWN = 0.9, 1.1  # of the prime radius of the screening
_FREE_PRELOAD = (0.85, 1.1)  # of the preload of the screening: the spring has room for 1.05
RESERVE = 0.01  # of the ripple allowed, for the corrections by finite elements


@dataclass(frozen=True)
class Study:
    """A task with the folder of its points and the name of the torque table in it."""

    task: DesignTask
    folder: Path
    file: str
    version: str

    def text(self, design: Machinery, smoothing: str = SYNTHESIS) -> str:
        """Case file of a design of the task."""
        return case_text(design, "design", self.file, smoothing=smoothing)

    def solved(self, design: Machinery, smoothing: str = SYNTHESIS) -> Solved:
        """A design with its record, cached or solved, its checks judged at all tolerance ends."""
        text = self.text(design, smoothing)
        return Solved(design, solved(Task(text, "", self.folder, self.version, "corners")))


@dataclass(frozen=True)
class Solved:
    """A design with the record of its preview."""

    design: Machinery
    record: Record

    @property
    def has_cam(self) -> bool:
        """Whether there is a cam to judge."""
        return "why" not in self.record

    @property
    def passes(self) -> bool:
        """Whether all limits are kept, the ripple with a reserve for the finite elements."""
        most = (1.0 - RESERVE) * self.design.task.ripple_allowed
        return self.record.get("verdict") == "pass" and self.ripple <= most

    def better_than(self, other: Solved) -> bool:
        """Whether it passes where the other does not, or leaves less ripple in the same size.

        Where neither passes, whether its checks fail by less.
        """
        if not self.has_cam or not other.has_cam:
            return self.has_cam
        if not (self.passes and other.passes):
            return self.passes or (not other.passes and self.shortfall < other.shortfall)
        return self.ripple < other.ripple and self.size <= (1.0 + _ALIKE) * other.size

    @property
    def size(self) -> float:
        """From the far side of the cam to the top of the roller at maximum lift, m."""
        lift, radius, prime = (
            1e-3 * float(self.record[key])
            for key in ("lift_max_mm", "cam_radius_mm", "prime_radius_mm")
        )
        return radius + prime + lift + self.design.frame.radius

    @property
    def ripple(self) -> float:
        return float(self.record["ripple_left_Nm"])

    @property
    def failing(self) -> list[str]:
        """Titles of the checks that fail."""
        return [str(each["title"]) for each in self.record["shortfalls"]]

    @property
    def shortfall(self) -> float:
        """Sum of the utilisations of the checks that fail; 99 for an infinite one."""
        return sum(float(each["utilisation"] or 99.0) for each in self.record["shortfalls"])


def promising(task: DesignTask, screened: Sequence[Candidate]) -> list[Candidate]:
    """Designs of the screening that may be on the front, by increasing size.

    The front of those within the limits and the smallest one near to them; where none is within,
    the front of those near to them and the likeliest.
    """
    within, near = (_screened_front(task, screened, excess, _POINTS - 1) for excess in (0.0, _NEAR))
    further = near[:1]
    if not within:
        likely = likeliest(task, screened)
        within, further = near, [] if likely is None else [likely]
    chosen = within + [each for each in further if each not in within]
    return sorted(chosen, key=lambda each: (each.size, each.ripple))


def _screened_front(
    task: DesignTask, screened: Sequence[Candidate], excess: float, most: int
) -> list[Candidate]:
    """Front of ripple and size of designs up to an excess, not far above the smallest one."""
    good = [each for each in screened if each.within(excess)]
    largest = FAR * min((each.size for each in good), default=0.0)
    good = [each for each in good if each.size <= largest]
    figures = [(each.size, each.ripple) for each in good]
    places = front(figures, _ALIKE, _GAIN * task.demand.ripple)
    return [good[k] for k in thinned(places, figures, most)]


def likeliest(task: DesignTask, screened: Sequence[Candidate]) -> Candidate | None:
    """The screened design with the most room to ripple and limits; None: each is hopeless."""

    def lack(each: Candidate) -> float:
        return each.ripple / task.ripple_allowed + _NEAR * each.excess

    best = min(screened, key=lack, default=None)
    return best if best is not None and lack(best) <= OPTIMISTIC + _NEAR**2 else None


def synthesised(study: Study, candidate: Candidate) -> Solved:
    """A screened design with the prime radius and preload of least ripple within all limits.

    Both are free about the values of the screening, and rounded where the design passes. The cam
    grows where it would not pass otherwise, unless the space is limited.
    """
    point = _rounded_point(study, free(study, candidate))
    if study.task.space is not None or not point.has_cam or point.passes:
        return point
    return _rounded_point(study, grown(study, candidate))


def _rounded_point(study: Study, point: Solved) -> Solved:
    """A point as drawings state it where it passes, else itself."""
    return settled(study, point) if point.has_cam and point.passes else point


def grown(study: Study, candidate: Candidate) -> Solved:
    """As `synthesised`, of a cam that may grow from the start, unless the space is limited."""
    return free(study, candidate, 1.0 if study.task.space is not None else _GROWN)


def free(study: Study, candidate: Candidate, growth: float = 1.0) -> Solved:
    """Synthesis with the preload and, up to some growth, the prime radius free."""
    design = _rounded(candidate.design)
    high = growth * design.prime_radius
    low = max(design.frame.least_radius, _SHRUNK * design.prime_radius)
    radii = 1e3 * min(low, 0.999 * high), 1e3 * high
    forces = [share * design.spring.preload for share in _FREE_PRELOAD]
    smoothing = SYNTHESIS + (
        'free = ["initial_energy", "prime_radius", "preload"]\n'
        f'prime_radius_range = ["{radii[0]:.6g} mm", "{radii[1]:.6g} mm"]\n'
        f'preload_range = ["{forces[0]:.6g} N", "{forces[1]:.6g} N"]\n'
    )
    return study.solved(design, smoothing)


def settled(study: Study, point: Solved) -> Solved:
    """The design of a synthesis with its prime radius and preload as a drawing states them.

    The cam radius of the synthesis is that of the room and of the counterweight.
    """
    record, design = point.record, point.design
    prime = 1e-4 * ceil(10.0 * float(record["prime_radius_mm"]) - 1e-3)
    if study.task.space is not None:
        prime = min(prime, design.prime_radius)
    spring = replace(design.spring, preload=float(f"{record['preload_N']:.3g}"))
    return study.solved(
        replace(
            design,
            prime_radius=prime,
            spring=spring,
            cam_radius=1e-3 * float(record["cam_radius_mm"]),
        )
    )


def _rounded(design: Machinery) -> Machinery:
    """The design with lift and preload as a drawing states them."""
    spring = replace(design.spring, preload=float(f"{design.spring.preload:.3g}"))
    return replace(design, spring=spring, lift=2e-4 * ceil(design.lift / 2e-4))


def solved_front(
    study: Study, screened: Sequence[Candidate], workers: Crew, progress: Progress
) -> tuple[list[Solved], list[Solved]]:
    """Designs of the front of the screening that pass, and those that do not.

    The likeliest one is solved without and with an offset, the others with the better choice.
    """
    chosen = promising(study.task, screened)
    first = likeliest(study.task, chosen)
    if first is None:
        return [], []
    progress.advance(0, len(chosen))
    both = [workers.submit(synthesised, study, each) for each in (first, first.with_offset)]
    straight, shifted = (each.result() for each in both)
    offset = shifted.better_than(straight)
    others = [each.with_offset if offset else each for each in chosen if each is not first]
    waiting = [workers.submit(synthesised, study, each) for each in others]
    points = [shifted if offset else straight]
    for k, each in enumerate(waiting, start=1):
        progress.advance(k, len(chosen))
        points.append(each.result())
    progress.advance(len(chosen), len(chosen))
    passing = [each for each in points if each.has_cam and each.passes]
    return _front(passing), [each for each in points if each.has_cam and not each.passes]


def _front(points: Sequence[Solved]) -> list[Solved]:
    figures = [(each.size, each.ripple) for each in points]
    return [points[k] for k in front(figures)]
