"""Command `camwright redesign`: Pareto front of cases over the catalogues."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import json_text, read_json, write_atomic
from camwright.pipeline.base.owned_folder import OwnedFolder
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.worker_processes import pool, workers_for
from camwright.pipeline.case.cards.catalogue import Catalogue, catalogue_of
from camwright.pipeline.case.cards.substitution import Choice, variant
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.records.redesign_document import (
    Against,
    ChoiceRecord,
    ConflictPoint,
    FrontPoint,
    PointRecord,
    RedesignDocument,
    RefusedPoint,
    RoughRecord,
    TriedPoint,
    TriedRefusal,
    is_refused,
)
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.search.front import front, thinned
from camwright.pipeline.search.parts.design_point import Rough
from camwright.pipeline.search.parts.exclusions import exclusions
from camwright.pipeline.search.parts.part_search import Branch, branches
from camwright.pipeline.search.parts.point_store import SOLVED, PointTask, solved
from camwright.pipeline.smoothing.problem_setup import problem_of

AGAINST: Mapping[Against, Literal["cam_radius_mm", "mass_g"]] = {
    "size": "cam_radius_mm",
    "mass": "mass_g",
}
RECORD = "redesign.json"
MOST_POINTS = 12  # of a front, solved in full
ALIKE = 1e-3  # relative size or ripple below which two points are equal
_BUSY = 64  # maximum number of processes
_OF_A_BRANCH = 16  # expected choices per branch
_OURS = re.compile(rf"redesign\.(json|html|png)|point_\d+\.toml|inputs|{SOLVED}")

Tried = tuple[Choice, RoughRecord | RefusedPoint]
Whole = tuple[Choice, PointRecord]
Solved = tuple[Choice, PointRecord | RefusedPoint]


@dataclass(frozen=True, eq=False)
class RedesignTask:
    """Case to redesign, with catalogue, output folder and source version."""

    case: Case
    folder: Path
    parts: Catalogue
    out: Path
    version: str

    def text(self, choice: Choice) -> str:
        """Resolved text of the case with the parts of a choice."""
        return variant(self.case, self.parts, choice, self.folder).to_toml()

    def task(self, text: str, tier: Literal["rough", "whole", "conflict"]) -> PointTask:
        return PointTask(text, self.case.to_toml(), self.out, self.version, tier)


def redesign(
    case_file: Path, out: Path, against: str, jobs: int | None, progress: Progress
) -> RedesignDocument:
    """Pareto front of ripple and size or mass over the catalogues, written to a folder.

    Parameters
    ----------
    out : Path      for ``redesign.json``, ``point_01.toml`` and so on, and ``solved/``
    against : str   of `AGAINST`
    jobs : int      processes; None: number of cores, at most 4

    Returns
    -------
    dict   the contents of ``redesign.json``

    Raises
    ------
    CamError
        If the case cannot be redesigned, or the folder has other content.
    """
    other = _against(against)
    case, folder = read_case(case_file), case_file.resolve().parent
    if not case.balances:
        raise InputError("engine", "missing", "specified: a redesign balances its torque")
    search = RedesignTask(case, folder, catalogue_of(folder), out.absolute(), versions()["source"])
    problem = problem_of(case, engine_torques(case))
    running, pruned = branches(case, search.parts, problem, by_mass=other == "mass")
    with OwnedFolder(search.out, _OURS, "redesign"):
        _begin(search)
        with pool(workers_for(jobs, _BUSY)) as workers:
            progress.stage("search the catalogue")
            tried = _searched(search, running, workers, progress)
            original, points = _solved_whole(search, _chosen(tried, other), workers, progress)
            kept, refused = _split(points, other)
            excluded = None
            if not kept:
                progress.stage("conflicting limits")
                excluded = exclusions(tried, refused, pruned, _conflict_of(search, workers))
        verdict = kept[0][1]["verdict"] if kept else "fail"
        document: RedesignDocument = {
            "schema": 1,
            "case": case.name,
            "input_sha256": case.sha256,
            "version": search.version,
            "against": other,
            "given": original,
            "points": _written(search, kept),
            "refused": [
                {**_named(choice), "why": _why(record, verdict)} for choice, record in refused
            ],
            "without_result": excluded,
            "pruned": [{"part": one.part, "why": one.why, "limit": one.limit} for one in pruned],
            "tried": [_tried_record(choice, record) for choice, record in tried],
        }
        write_atomic(search.out / RECORD, json_text(document) + "\n")
    return document


def _against(name: str) -> Against:
    """The second objective of a name; InputError for another."""
    for known in AGAINST:
        if known == name:
            return known
    raise InputError("--against", name, " or ".join(AGAINST))


def _begin(search: RedesignTask) -> None:
    """Copy the files that the case includes; the folder may hold a redesign of this case alone."""
    out, case = search.out, search.case
    record = out / RECORD
    held = read_json(record) if record.is_file() else {"case": case.name}
    if not isinstance(held, dict) or held.get("case") != case.name:
        raise ResultError(f"{out}: holds the redesign of another case")
    for name, content in case.included.items():
        write_atomic(out / name, content)


def _searched(
    search: RedesignTask,
    running: Mapping[str, Branch],
    workers: ProcessPoolExecutor,
    progress: Progress,
) -> list[Tried]:
    """All choices of the branches with their points of the synthesis alone, by choice."""
    tried: list[Tried] = []
    refusals: list[InputError] = []
    waiting: dict[Future[RoughRecord | RefusedPoint], tuple[Branch, Choice]] = {}
    expected = _OF_A_BRANCH * len(running)

    def ask(branch: Branch, answer: Rough | None) -> None:
        """Submit the next valid choice of a branch to the workers."""
        while True:
            try:
                choice = next(branch) if answer is None else branch.send(answer)
            except StopIteration:
                return
            try:
                task = search.task(search.text(choice), "rough")
            except InputError as error:
                refusals.append(error)
                tried.append((choice, {"feasible": False, "why": str(error)}))
                answer = Rough.impossible()
                continue
            waiting[workers.submit(solved, task)] = (branch, choice)
            return

    for branch in running.values():
        ask(branch, None)
    while waiting:
        completed, _ = wait(waiting, return_when=FIRST_COMPLETED)
        for future in completed:
            branch, choice = waiting.pop(future)
            record = future.result()
            tried.append((choice, record))
            progress.advance(len(tried), max(expected, len(tried) + len(waiting)))
            ask(branch, Rough.impossible() if is_refused(record) else Rough(**record))
    if refusals and len(refusals) == len(tried):
        raise refusals[0]  # no choice is valid: an error of the case
    return sorted(tried, key=lambda pair: str(pair[0]))


def _chosen(tried: Sequence[Tried], against: Against) -> list[Choice]:
    """Choices on the front of the points of the synthesis alone."""
    rough = [(choice, record) for choice, record in tried if not is_refused(record)]
    feasible = [(choice, record) for choice, record in rough if record["feasible"]]
    size: Literal["cam_radius", "mass"] = "cam_radius" if against == "size" else "mass"
    figures = [(record[size], record["ripple"]) for _, record in feasible]
    places = front(figures, ALIKE, ALIKE)  # the ripple is relative to that of the engine
    return [feasible[k][0] for k in thinned(places, figures, MOST_POINTS)]


def _solved_whole(
    search: RedesignTask, chosen: Sequence[Choice], workers: ProcessPoolExecutor, progress: Progress
) -> tuple[PointRecord | RefusedPoint, list[Solved]]:
    """Original case and choices by synthesis and preview, at their worst tolerance corners."""
    progress.stage(f"solve {len(chosen)} points of the front")
    texts = [search.case.to_toml(), *(search.text(choice) for choice in chosen)]
    futures = [workers.submit(solved, search.task(text, "whole")) for text in texts]
    records: list[PointRecord | RefusedPoint] = []
    for future in futures:
        records.append(future.result())
        progress.advance(len(records), len(futures))
    return records[0], list(zip(chosen, records[1:], strict=True))


def _conflict_of(
    search: RedesignTask, workers: ProcessPoolExecutor
) -> Callable[[Choice | None], ConflictPoint | RefusedPoint]:
    """Record of the infeasibility of a choice, of the case as it is for None."""

    def conflict(choice: Choice | None) -> ConflictPoint | RefusedPoint:
        text = search.case.to_toml() if choice is None else search.text(choice)
        found: ConflictPoint | RefusedPoint
        found = workers.submit(solved, search.task(text, "conflict")).result()
        return found

    return conflict


def _split(points: Sequence[Solved], against: Against) -> tuple[list[Whole], list[Solved]]:
    """Points of the front by increasing size, and the other points.

    No point fails; where one passes, those that lack data are not on the front.
    """
    whole = [(choice, record) for choice, record in points if not is_refused(record)]
    best = "pass" if any(record["verdict"] == "pass" for _, record in whole) else "incomplete"
    good = [(choice, record) for choice, record in whole if record["verdict"] == best]
    figures = [(record[AGAINST[against]], record["ripple_left_Nm"]) for _, record in good]
    least = min((record["ripple_before_Nm"] for _, record in good), default=0.0)
    kept = [good[k] for k in front(figures, ALIKE, ALIKE * least)]
    return kept, [pair for pair in points if pair not in kept]


def _why(record: PointRecord | RefusedPoint, front: str) -> str:
    """Reason why a solved point is not on a front of points of this verdict."""
    if is_refused(record):
        return record["why"]
    if not record["feasible"]:
        return "the synthesis on the fine turn ends outside the limits"
    if record["failing"]:
        return f"fails {', '.join(record['failing'])}"
    if record["open"] and front != "incomplete":
        return f"lacks data for {', '.join(record['open'])}"
    return "dominated by another point"


def _written(search: RedesignTask, kept: Sequence[Whole]) -> list[FrontPoint]:
    """Write the points as case files, replacing earlier ones; their records."""
    for old in search.out.glob("point_*.toml"):
        old.unlink()
    records: list[FrontPoint] = []
    for number, (choice, record) in enumerate(kept, start=1):
        name, text = f"point_{number:02d}.toml", search.text(choice)
        head = (
            f"# Point {number} of {len(kept)} of the redesign of {search.case.name}.\n"
            f"# {choice.words}.\n"
            f"# Preview: {record['ripple_left_Nm']:.4g} N m of torque ripple left (std), "
            f"cam radius {record['cam_radius_mm']:.4g} mm, {record['mass_g']:.4g} g.\n"
        )
        write_atomic(search.out / name, head + text)
        records.append({"file": name, **_named(choice), **record})
    return records


def _tried_record(choice: Choice, record: RoughRecord | RefusedPoint) -> TriedPoint | TriedRefusal:
    if is_refused(record):
        refused: TriedRefusal = {**_named(choice), **record}
        return refused
    point: TriedPoint = {**_named(choice), **record}
    return point


def _named(choice: Choice) -> ChoiceRecord:
    """Names of the parts of a choice, and the limit of the cam radius."""
    room = choice.cam_radius
    return {"roller": choice.roller, "spring": choice.spring, "bush": choice.bush,
            "room_mm": None if room is None else in_unit(room, "mm")}  # fmt: skip
