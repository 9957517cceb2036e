"""Command `design parts`: Pareto front of cases over the catalogues."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import json_text, read_json, write_atomic
from camwright.pipeline.base.owned_folder import OwnedFolder
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.worker_processes import pool, workers_for
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.substitution import Choice
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.records.judgement_record import (
    ConflictJudgement,
    DraftJudgement,
    PreviewJudgement,
    RefusedJudgement,
    is_refused,
)
from camwright.pipeline.records.redesign_document import (
    Against,
    ChoiceRecord,
    FrontPoint,
    RedesignDocument,
    TriedPoint,
    TriedRefusal,
)
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.front import front, thinned
from camwright.pipeline.search.judge import STORED, Judge, judgements
from camwright.pipeline.search.parts.exclusions import exclusions
from camwright.pipeline.search.parts.part_search import RollerSearch, Selection, Tried, selection
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.problem_setup import problem_of

AGAINST: Mapping[Against, Literal["cam_radius_mm", "mass_g"]] = {
    "size": "cam_radius_mm",
    "mass": "mass_g",
}
RECORD = "redesign.json"
MOST_POINTS = 12  # of a front, solved in full
_FURTHER_FRONTS = 5  # of what the first leaves, where all of its points fail in full
ALIKE = 1e-3  # relative size or ripple below which two points are equal
_BUSY = 64  # maximum number of processes
_OURS = re.compile(rf"redesign\.(json|html|png)|point_\d+\.toml|inputs|{STORED}")

Whole = tuple[Choice, PreviewJudgement]
Judged = tuple[Choice, PreviewJudgement | RefusedJudgement]


@dataclass(frozen=True, eq=False)
class RedesignTask:
    """A case to be redesigned: its folder, output folder and source version.

    Its functions judge in the process that calls them.
    """

    case: Case
    folder: Path
    out: Path
    version: str

    def text(self, choice: Choice) -> str:
        """Resolved text of the case with the parts of a choice."""
        return choice.applied(self.case, self.folder).to_toml()

    def judge(self) -> Judge:
        """Judge of the case; all choices share its torque."""
        torques, store = engine_torques(self.case), judgements(self.out)
        return Judge(self.case, torques, self.folder, store=store, version=self.version)

    def searched(
        self, roller: str, least: Mapping[str, float], bushes: Sequence[str]
    ) -> list[Tried]:
        """All choices of a roller with their judgements; see `RollerSearch`."""
        return RollerSearch(self.judge(), roller).searched(least, bushes)

    def whole(self, choice: Choice | None) -> PreviewJudgement | RefusedJudgement:
        """Judgement of a choice by preview, None: of the case, at its worst tolerance corners."""
        return self.judge().previewed(Change() if choice is None else choice)

    def conflict(self, choice: Choice | None) -> ConflictJudgement | RefusedJudgement:
        """Limits in conflict in the case of a choice of parts, and the relaxations that make it
        feasible; `choice` None: of the unchanged case.
        """
        judge = self.judge()

        def conflict(case: Case) -> ConflictJudgement:
            problem = problem_of(case, judge.torques)
            return {"feasible": False, **infeasibility(problem).as_record()}

        return judge.stored(Change() if choice is None else choice, "conflict", conflict)


def redesign(
    case_file: Path, out: Path, against: str, jobs: int | None, progress: Progress
) -> RedesignDocument:
    """Search the catalogues for parts of a case: Pareto front of ripple and size or mass, written
    to a folder as case files.

    Parameters
    ----------
    case_file : Path      case with an engine and a stem
    out : Path            for ``redesign.json``, ``point_01.toml`` and so on, and ``solved/``
    against : str         second objective, of `AGAINST`
    jobs : int            processes; None: number of cores, at most 4
    progress : Progress   told each stage

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
    search = RedesignTask(case, folder, out.absolute(), versions()["source"])
    problem = problem_of(case, engine_torques(case))
    parts = selection(case, catalogue_of(folder), problem, by_mass=other == "mass")
    with OwnedFolder(search.out, _OURS, "redesign"):
        _begin(search)
        with pool(workers_for(jobs, _BUSY)) as workers:
            progress.stage("search the catalogue")
            tried = _searched(search, parts, workers, progress)
            unchanged, judged = _fronts_judged(search, tried, other, workers, progress)
            kept, refused = _split(judged, other)
            excluded = None
            if not kept:
                progress.stage("conflicting limits")
                excluded = exclusions(
                    tried,
                    refused,
                    parts.pruned,
                    lambda choice: workers.submit(search.conflict, choice).result(),
                )
        verdict = kept[0][1]["verdict"] if kept else "fail"
        document: RedesignDocument = {
            "schema": 2,
            "case": case.name,
            "input_sha256": case.sha256,
            "version": search.version,
            "against": other,
            "given": unchanged,
            "points": _written(search, kept),
            "refused": [
                {**_named(choice), "why": _why(record, verdict)} for choice, record in refused
            ],
            "without_result": excluded,
            "pruned": list(parts.pruned),
            "as_given": list(parts.as_given),
            "tried": [_tried_record(choice, record) for choice, record in tried],
        }
        write_atomic(search.out / RECORD, json_text(document) + "\n")
    return document


def _against(name: str) -> Against:
    """The text as second objective of the front; InputError for any other."""
    for known in AGAINST:
        if known == name:
            return known
    raise InputError("--against", name, " or ".join(AGAINST))


def _begin(search: RedesignTask) -> None:
    """Copy the files that the case includes to the output folder.

    Raises
    ------
    ResultError
        If the folder has the redesign of another case.
    """
    out, case = search.out, search.case
    record = out / RECORD
    held = read_json(record) if record.is_file() else {"case": case.name}
    if not isinstance(held, dict) or held.get("case") != case.name:
        raise ResultError(f"{out}: holds the redesign of another case")
    for name, content in case.included.items():
        write_atomic(out / name, content)


def _searched(
    search: RedesignTask, parts: Selection, workers: ProcessPoolExecutor, progress: Progress
) -> list[Tried]:
    """Choices of parts of all rollers with their judgements by the synthesis alone, in the order of
    their names.

    Raises
    ------
    InputError
        If no choice makes a valid case.
    """
    waiting = [
        workers.submit(search.searched, roller, least, parts.bushes)
        for roller, least in parts.springs.items()
    ]
    tried: list[Tried] = []
    for k, each in enumerate(waiting):
        progress.advance(k, len(waiting))
        tried += each.result()
    if all(is_refused(record) for _, record in tried):
        _refuse_invalid(search, [choice for choice, _ in tried])
    return sorted(tried, key=lambda pair: str(pair[0]))


def _refuse_invalid(search: RedesignTask, choices: Sequence[Choice]) -> None:
    """Refuse a case of which no choice of parts is valid: it is an error of the case.

    Raises
    ------
    InputError
        That of the first choice.
    """
    errors: list[InputError] = []
    for choice in choices:
        try:
            search.text(choice)
        except InputError as error:
            errors.append(error)
        else:
            return
    if errors:
        raise errors[0]


def _chosen(tried: Sequence[Tried], against: Against) -> list[Choice]:
    """Feasible choices on the front of ripple and second objective, `against`, by the synthesis
    alone; at most `MOST_POINTS`.
    """
    rough = [(choice, record) for choice, record in tried if not is_refused(record)]
    feasible = [(choice, record) for choice, record in rough if record["feasible"]]
    figures = [(record[AGAINST[against]], record["ripple_left_share"]) for _, record in feasible]
    places = front(figures, ALIKE, ALIKE)  # the ripple is relative to that of the engine
    return [feasible[k][0] for k in thinned(places, figures, MOST_POINTS)]


def _fronts_judged(
    search: RedesignTask,
    tried: Sequence[Tried],
    against: Against,
    workers: ProcessPoolExecutor,
    progress: Progress,
) -> tuple[PreviewJudgement | RefusedJudgement, list[Judged]]:
    """Judgements in full of the unchanged case and of the front by the synthesis alone; where all
    its points fail, of the fronts behind it, too.
    """
    unchanged, judged = _judged_whole(search, _chosen(tried, against), workers, progress)
    for _ in range(_FURTHER_FRONTS):
        chosen = _chosen(_beyond(tried, judged), against)
        if not chosen or _split(judged, against)[0]:
            break
        judged += _judged_whole(search, chosen, workers, progress)[1]
    return unchanged, judged


def _beyond(tried: Sequence[Tried], judged: Sequence[Judged]) -> list[Tried]:
    """Choices tried by the synthesis alone that differ from those judged in full in more than the
    bush.

    Where all balance as much as required, the front is the smallest alone.
    """
    judged_already = {replace(choice, bush="") for choice, _ in judged}
    return [pair for pair in tried if replace(pair[0], bush="") not in judged_already]


def _judged_whole(
    search: RedesignTask, chosen: Sequence[Choice], workers: ProcessPoolExecutor, progress: Progress
) -> tuple[PreviewJudgement | RefusedJudgement, list[Judged]]:
    """Judgement of the unchanged case, and the chosen parts with theirs, by synthesis and preview
    at the worst tolerance corners.
    """
    progress.stage(f"solve {len(chosen)} points of the front")
    waiting = [workers.submit(search.whole, choice) for choice in (None, *chosen)]
    records: list[PreviewJudgement | RefusedJudgement] = []
    for each in waiting:
        records.append(each.result())
        progress.advance(len(records), len(waiting))
    return records[0], list(zip(chosen, records[1:], strict=True))


def _split(judged: Sequence[Judged], against: Against) -> tuple[list[Whole], list[Judged]]:
    """Judged choices on the front of ripple and second objective, by increasing size, then all
    others.

    The front has none that fails and, where one passes, none that lacks data.

    Parameters
    ----------
    judged : sequence   choices with their judgements
    against : str       second objective, key of `AGAINST`
    """
    whole = [(choice, record) for choice, record in judged if not is_refused(record)]
    best = "pass" if any(record["verdict"] == "pass" for _, record in whole) else "incomplete"
    good = [(choice, record) for choice, record in whole if record["verdict"] == best]
    figures = [(record[AGAINST[against]], record["ripple_left_Nm"]) for _, record in good]
    least = min((record["ripple_before_Nm"] for _, record in good), default=0.0)
    kept = [good[k] for k in front(figures, ALIKE, ALIKE * least)]
    return kept, [pair for pair in judged if pair not in kept]


def _why(record: PreviewJudgement | RefusedJudgement, front: str) -> str:
    """Reason why a judged choice is not on the front.

    Parameters
    ----------
    record : mapping   judgement, or refusal
    front : str        verdict of the points of the front
    """
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
    """Write a case file for each choice of the front, ``point_NN.toml``, in place of earlier ones;
    returns their records.
    """
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


def _tried_record(
    choice: Choice, record: DraftJudgement | RefusedJudgement
) -> TriedPoint | TriedRefusal:
    """Record of a choice with its judgement by the synthesis, or its refusal."""
    if is_refused(record):
        refused: TriedRefusal = {**_named(choice), **record}
        return refused
    return {**_named(choice), **record}


def _named(choice: Choice) -> ChoiceRecord:
    """Names of the parts of a choice, and the limit of the cam radius."""
    room = choice.cam_radius
    return {"roller": choice.roller, "spring": choice.spring, "bush": choice.bush,
            "room_mm": None if room is None else in_unit(room, "mm")}  # fmt: skip
