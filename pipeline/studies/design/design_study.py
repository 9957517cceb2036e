"""Command `camwright design`: from a torque to a case file with all parts, and its front."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import floor
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import json_text, write_atomic
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.case.cards.card_filling import USER_FILE
from camwright.pipeline.case.cards.catalogue import SPRINGS_FILE
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.section import SAFE_NAME
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.studies.design.candidate_search import Candidate, candidates
from camwright.pipeline.studies.design.design_case import Machinery, case_text
from camwright.pipeline.studies.design.torque_task import DesignTask, task_of
from camwright.pipeline.studies.redesign.pareto_front import front, thinned
from camwright.pipeline.studies.redesign.point_store import SOLVED, Record, Task, solved

RECORD = "design.json"
PICTURE = "design.png"
_POINTS = 4  # of the front of the screening, solved in full
_NEAR = 0.5  # excess that a synthesis may remove
_OPTIMISTIC = 1.1  # ripple of a screened design over that allowed
_ALIKE = 0.02  # relative size within which the lesser ripple replaces
_GAIN = 0.03  # of the ripple, between points
_TRIED = 6  # points solved before a task is given up
_FEWER = 2  # points solved of a relaxed task
_REMOVED = (0.9, 0.7, 0.4)  # shares of the ripple to be removed that are tried
_SLOWER = (0.85, 0.7, 0.5)  # of the speeds
_SPARE = 1.005  # of the space of a design
_OURS = re.compile(
    rf"design\.(json|png)|point_\d+\.toml|{SOLVED}|.*\.csv|cards\.toml|springs\.toml"
)


@dataclass(frozen=True)
class Study:
    """A task with the folder of its points and the name of the torque table in it."""

    task: DesignTask
    folder: Path
    file: str
    version: str

    def text(self, design: Machinery, head: str = "") -> str:
        """Case file of a design of the task."""
        return case_text(design, "design", self.file, head)

    def solved(self, design: Machinery, tier: Any) -> Record:
        """Record of a design: cached or solved."""
        return solved(Task(self.text(design), "", self.folder, self.version, tier))


@dataclass(frozen=True)
class Solved:
    """A design with the record of its preview."""

    design: Machinery
    record: Record

    @property
    def passes(self) -> bool:
        return self.record.get("verdict") == "pass"

    @property
    def size(self) -> float:
        """From the far side of the cam to the top of the roller at maximum lift, m."""
        lift = 1e-3 * float(self.record["lift_max_mm"])
        radius = 1e-3 * float(self.record["cam_radius_mm"])
        return radius + self.design.prime_radius + lift + self.design.frame.radius

    @property
    def ripple(self) -> float:
        return float(self.record["ripple_left_Nm"])


def design_from_torque(
    torque: str | Path,
    out: str | Path,
    *,
    speed: str | float,
    speeds: str | tuple[str | float, str | float] | None = None,
    overspeed: str | float | None = None,
    cycle: str | float | None = None,
    ratio: str | float | None = None,
    space: str | float | None = None,
    life: str | float | None = None,
    ambient: str | float | None = None,
    remove: str | float | None = None,
    progress: Progress = SILENT,
) -> Record:
    """Case file of a torque table, as `camwright design`; options as of `task_of`.

    Parameters
    ----------
    torque : path   CSV: shaft angle and torque of one cycle
    out : path      case file to write; the points are in the folder ``NAME_design``

    Returns
    -------
    dict   contents of ``design.json``: ``chosen`` is None where no design passes

    Raises
    ------
    CamError
        If an option or the torque is refused.
    """
    task = task_of(
        torque, speed=speed, speeds=speeds, overspeed=overspeed, cycle=cycle, ratio=ratio,
        space=space, life=life, ambient=ambient, remove=remove,
    )  # fmt: skip
    return designed(task, Path(out), progress)


def points_folder(out: Path) -> Path:
    """Folder of the points, the record and the picture of a case file."""
    return out.with_name(f"{out.stem}_design")


def designed(task: DesignTask, out: Path, progress: Progress = SILENT) -> Record:
    """Case file of a task, the front of ripple and size, and what conflicts where there is none.

    Parameters
    ----------
    out : Path   case file; the points are in the folder of its name, ``CASE_design``

    Returns
    -------
    dict   contents of ``design.json``

    Raises
    ------
    CamError
        If the torque cannot be read, or the folder has other content.
    """
    if out.suffix != ".toml" or not SAFE_NAME.fullmatch(out.stem):
        raise InputError("--out", out.name, "a file NAME.toml of letters, digits, '_', '-' or '.'")
    folder = points_folder(out).absolute()
    file = _prepare(task, folder, out)
    study = Study(task, folder, file, versions()["source"])
    progress.stage("search rollers, springs and base circles")
    screened = candidates(task, folder, file, progress)
    progress.stage("solve the front")
    points = _solved_front(study, screened, _TRIED, progress)
    passing = _front([each for each in points if each.passes])
    document: Record = {
        "schema": 1,
        "torque": _demand_record(task),
        "assumed": sorted(task.assumed),
        "remove": task.remove,
        "space_mm": None if task.space is None else 1e3 * task.space,
        "screened": len(screened),
        "within_limits": sum(each.excess == 0.0 for each in screened),
        "cloud": [
            [round(1e3 * each.size, 2), round(each.ripple, 5), each.excess == 0.0]
            for each in _sampled(screened)
        ],
        "points": [],
        "chosen": None,
        "conflict": None,
    }
    if passing:
        best = _refined(study, passing[0])
        document["points"] = _write_points(study, passing)
        document["chosen"] = _row(best) | _drawing(study, best) | {"file": out.name}
        head = _summary(study, best, passing)
        write_atomic(out, case_text(best.design, out.stem, file, head))
    else:
        progress.stage("smallest relaxation")
        document["conflict"] = _conflict(study, screened, points, progress)
    write_atomic(folder / RECORD, json_text(document) + "\n")
    return document


def _prepare(task: DesignTask, folder: Path, out: Path) -> str:
    """Prepare both folders with the torque table and the user's cards; the name of the table."""
    if folder.exists():
        strangers = [] if not folder.is_dir() else [
            entry.name for entry in folder.iterdir() if not _OURS.fullmatch(entry.name)
        ]  # fmt: skip
        if not folder.is_dir() or strangers:
            raise ResultError(f"{folder}: holds something other than a design")
    name = task.file.name if task.file.suffix == ".csv" else f"{out.stem}_torque.csv"
    source = task.file.resolve().parent
    copies = {name: task.file}
    copies |= {each: source / each for each in (USER_FILE, SPRINGS_FILE)}
    for kept, path in copies.items():
        if not path.is_file():
            continue
        content = path.read_bytes()
        for place in (folder, out.absolute().parent):
            target = place / kept
            if not target.is_file() or target.read_bytes() != content:
                write_atomic(target, content)
    return name


def _promising(task: DesignTask, screened: Sequence[Candidate], most: int) -> list[Candidate]:
    """Designs of the front of the screening: within the limits, and near to them."""
    ripple = (1.0 - task.remove) * task.demand.ripple * _OPTIMISTIC
    chosen: list[Candidate] = []
    for excess in (0.0, _NEAR):
        good = [each for each in screened if each.excess <= excess and each.ripple <= ripple]
        figures = [(each.size, each.ripple) for each in good]
        places = front(figures, _ALIKE, _GAIN * task.demand.ripple)
        kept = [good[k] for k in thinned(places, figures, min(_POINTS, most))]
        chosen += [each for each in kept if each not in chosen]
    return sorted(chosen[:most], key=lambda each: (each.size, each.ripple))


def _rounded(candidate: Candidate) -> Machinery:
    """The design of a candidate with lift and preload as a drawing states them."""
    design = candidate.design
    spring = replace(design.spring, preload=float(f"{design.spring.preload:.3g}"))
    return replace(design, spring=spring, lift=2e-4 * np.ceil(design.lift / 2e-4))


def _solved_front(
    study: Study, screened: Sequence[Candidate], most: int, progress: Progress
) -> list[Solved]:
    chosen = _promising(study.task, screened, most)
    points = []
    for k, candidate in enumerate(chosen, start=1):
        own = _rounded(candidate)
        record = study.solved(own, "corners")
        if "why" not in record:
            points.append(Solved(own, record))
        progress.advance(k, len(chosen))
    return points


def _front(points: Sequence[Solved]) -> list[Solved]:
    figures = [(each.size, each.ripple) for each in points]
    return [points[k] for k in front(figures)]


def _refined(study: Study, point: Solved) -> Solved:
    """The point with the cam radius of its synthesis as room and counterweight."""
    own = replace(point.design, cam_radius=1e-3 * float(point.record["cam_radius_mm"]))
    record = study.solved(own, "corners")
    refined = Solved(own, record)
    return refined if refined.passes else point


def _sampled(screened: Sequence[Candidate], most: int = 400) -> list[Candidate]:
    """Evenly spaced candidates, for the picture."""
    step = max(1, len(screened) // most)
    return list(screened[::step])


def _demand_record(task: DesignTask) -> Record:
    demand = task.demand
    return {
        "file": task.file.name,
        "cycle_deg": float(np.degrees(demand.cycle)),
        "ratio": task.ratio,
        "speed_rpm": units.in_unit(task.speed, "rpm"),
        "overspeed_rpm": units.in_unit(task.overspeed, "rpm"),
        "ripple_Nm": demand.ripple,
        "energy_swing_J": demand.energy_swing,
        "peak_Nm": demand.peak,
        "values_Nm": [round(float(value), 6) for value in demand.torque[::4]],
    }


def _row(point: Solved) -> Record:
    design = point.design
    spring = design.spring.spring
    name = spring.name or (
        f"wound {1e3 * spring.wire_diameter:g} x {1e3 * spring.mean_diameter:.4g} mm, "
        f"{spring.coils:g} coils"
    )
    return {
        "size_mm": 1e3 * point.size,
        "removed": 1.0 - point.ripple / design.task.demand.ripple,
        "roller": design.frame.roller,
        "spring": name,
        "offset_mm": 1e3 * design.offset,
        "stem_mm": 1e3 * design.frame.stem,
        "bore_mm": 1e3 * design.frame.seat.bore,
        **point.record,
    }


def _drawing(study: Study, point: Solved) -> Record:
    """Contour, roller and torque left of a design, for its picture."""
    trial = preview_case(parse_case(study.text(point.design), study.folder), corners=False)
    after, contour = trial.cycles[0].turn.torque_after, trial.contour
    rest = np.zeros(0) if after is None else np.asarray(after)
    theta = uniform_turn(360)
    lowest = theta[int(np.argmin(contour.lift.values[:: contour.lift.values.size // 360]))]
    normal, surface = contour.normal(lowest), contour.points(lowest)
    centre = surface + normal * trial.case.roller.radius
    return {
        "contour_mm": [[round(1e3 * float(v), 4) for v in row] for row in contour.points(theta)],
        "roller_radius_mm": 1e3 * trial.case.roller.radius,
        "roller_centre_mm": [round(1e3 * float(v), 4) for v in centre],
        "torque_after_Nm": [round(float(v), 6) for v in rest - rest.mean()],
    }


def _write_points(study: Study, points: Sequence[Solved]) -> list[Record]:
    for old in study.folder.glob("point_*.toml"):
        old.unlink()
    rows = []
    for number, point in enumerate(points, start=1):
        name = f"point_{number:02d}"
        head = f"# Point {number} of {len(points)} of the front of ripple against size.\n"
        text = case_text(point.design, name, study.file, head)
        write_atomic(study.folder / f"{name}.toml", text)
        rows.append({"file": f"{name}.toml"} | _row(point))
    return rows


def _summary(study: Study, best: Solved, points: Sequence[Solved]) -> str:
    row, task = _row(best), study.task
    lines = [
        f"# Designed from {study.file}: {100 * row['removed']:.0f} % of the torque ripple removed"
        f" by closed forms,",
        f"# {best.ripple:.4g} of {task.demand.ripple:.4g} N m (std) left; "
        f"{row['size_mm']:.4g} mm from the cam's far side to the top of the roller.",
        "# The smallest point that passes. The front, size against ripple left:",
    ]
    lines += [f"#   {1e3 * each.size:7.1f} mm  {each.ripple:8.4g} N m" for each in points]
    return "\n".join(lines) + "\n"


def _conflict(
    study: Study, screened: Sequence[Candidate], points: Sequence[Solved], progress: Progress
) -> Record:
    """Limits in conflict, and the smallest relaxations whose design passes, smallest first."""
    relaxations: list[Record] = []
    options = list(_relaxed(study.task))
    for k, (name, changes) in enumerate(options, start=1):
        for change in changes:
            passing, relaxed = _passing(study, change), change
            if passing and name == "--space":
                relaxed = replace(change, space=_room_of(passing))
                passing = _passing(study, relaxed)
            if passing:
                relaxations.append(_relaxation(name, study.task, relaxed))
                break
        progress.advance(k, len(options))
    return {"limits": _limits(study.task, screened, points), "relaxations": relaxations}


def _passing(study: Study, task: DesignTask) -> list[Solved]:
    """Points of a relaxed task that pass."""
    screened = candidates(task, study.folder, study.file, SILENT)
    solved_points = _solved_front(replace(study, task=task), screened, _FEWER, SILENT)
    return [each for each in solved_points if each.passes]


def _room_of(points: Sequence[Solved]) -> float:
    """Space of the smallest point, m, rounded up."""
    smallest = min(points, key=lambda each: each.size)
    radius = 1e-3 * float(smallest.record["cam_radius_mm"])
    return float(1e-3 * np.ceil(1e3 * _SPARE * (radius + smallest.design.height)))


def _relaxation(name: str, task: DesignTask, relaxed: DesignTask) -> Record:
    """A change of an option of the command with which a design passes."""
    before, after, unit = {
        "--remove": (task.remove, relaxed.remove, "%"),
        "--space": (task.space or 0.0, relaxed.space or 0.0, "mm"),
        "--speed": (task.speed, relaxed.speed, "rpm"),
    }[name]
    record: Record = {
        "option": name,
        "from": units.shown(before, unit),
        "to": units.shown(after, unit),
    }
    if name == "--speed":
        record["overspeed"] = units.shown(relaxed.overspeed, "rpm")
    return record


def _limits(task: DesignTask, screened: Sequence[Candidate], points: Sequence[Solved]) -> list[str]:
    """What no design keeps together."""
    if points:
        near = min(points, key=lambda each: sum(
            float(s["utilisation"] or 99.0) for s in each.record["shortfalls"]
        ))  # fmt: skip
        names = [str(each["title"]) for each in near.record["shortfalls"]]
        return names or ["the limits of the synthesis at the ends of the tolerances"]
    if screened:
        counts = Counter(each.governing for each in screened if each.excess > 0.0)
        return [name for name, _ in counts.most_common(3)]
    return [
        f"energy of {units.shown((task.remove) * task.demand.energy_swing, 'J')} in one spring",
        f"surge frequency of 13 times the cam's at {units.shown(task.cam_speed, 'rpm')}",
        "ratings of the rollers of the catalogue",
    ]


def _relaxed(task: DesignTask) -> Iterator[tuple[str, list[DesignTask]]]:
    """Options of the command, each with relaxed tasks, the smallest change first."""
    removals = (floor(100.0 * task.remove * share) / 100.0 for share in _REMOVED)
    yield "--remove", [replace(task, remove=value) for value in removals if value > 0.0]
    if task.space is not None:
        yield "--space", [replace(task, space=None)]
    yield "--speed", [_slower(task, share) for share in _SLOWER]


def _slower(task: DesignTask, share: float) -> DesignTask:
    least, most = task.speeds
    return replace(
        task,
        speed=share * task.speed,
        speeds=(share * least, share * most),
        overspeed=share * task.overspeed,
    )
