"""`camwright redesign`: from a case and the catalogues to a front of runnable cases."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import Json, json_text, read_json, write_atomic
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.base.worker_processes import pool, workers_for
from camwright.pipeline.case.cards.catalogue import Catalogue, catalogue_of
from camwright.pipeline.case.cards.substitution import Choice, variant
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.studies.redesign.design_point import Rough
from camwright.pipeline.studies.redesign.pareto_front import front, thinned
from camwright.pipeline.studies.redesign.part_search import Branch, branches
from camwright.pipeline.studies.redesign.point_store import SOLVED, Task, solved

AGAINST = {"size": "cam_radius_mm", "mass": "mass_g"}
RECORD = "redesign.json"
MOST_POINTS = 12  # of a front that are solved whole
ALIKE = 1e-3  # share of size or of the whole ripple below which two points are one
_BUSY = 64  # more processes than this have nothing to do
_OF_A_BRANCH = 16  # choices it asks for, about
_OURS = re.compile(rf"redesign\.(json|html|png)|point_\d+\.toml|inputs|{SOLVED}")

Record = dict[str, Any]
Tried = tuple[Choice, Record]


@dataclass(frozen=True, eq=False)
class Search:
    """A case to be redesigned: where it lies, what it may choose from, where points go."""

    case: Case
    folder: Path
    parts: Catalogue
    out: Path
    version: str

    def text(self, choice: Choice) -> str:
        """The case with the parts of a choice, resolved."""
        return variant(self.case, self.parts, choice, self.folder).to_toml()

    def task(self, text: str, tier: Literal["rough", "whole"]) -> Task:
        return Task(text, self.case.to_toml(), self.out, self.version, tier)


def redesign(
    case_file: Path, out: Path, against: str, jobs: int | None, progress: Progress
) -> Record:
    """The front of ripple against size or mass over the catalogues, written to a folder.

    Parameters
    ----------
    out : Path      for ``redesign.json``, ``point_01.toml`` and so on, and ``solved/``
    against : str   of `AGAINST`
    jobs : int      processes; None: the processors there are, at most 4

    Returns
    -------
    dict   the contents of ``redesign.json``

    Raises
    ------
    CamError
        If the case cannot be redesigned, or the folder holds something else.
    """
    if against not in AGAINST:
        raise InputError("--against", against, " or ".join(AGAINST))
    case, folder = read_case(case_file), case_file.resolve().parent
    if case.engine is None:
        raise InputError("engine", "missing", "given: a redesign balances its torque")
    search = Search(case, folder, catalogue_of(folder), out.absolute(), versions()["source"])
    problem = problem_of(case, engine_torques(case))
    running, pruned = branches(case, search.parts, problem, by_mass=against == "mass")
    _prepare(search)
    with pool(workers_for(jobs, _BUSY)) as workers:
        progress.stage("search through the catalogue")
        tried = _searched(search, running, workers, progress)
        given, points = _solved_whole(search, _chosen(tried, against), workers, progress)
    kept, refused = _split(points, against)
    document: dict[str, Json] = {
        "schema": 1,
        "case": case.name,
        "input_sha256": case.sha256,
        "version": search.version,
        "against": against,
        "given": given,
        "points": _written(search, kept),
        "refused": [_named(choice) | {"why": _why(record)} for choice, record in refused],
        "pruned": [asdict(one) for one in pruned],
        "tried": [_named(choice) | record for choice, record in tried],
    }
    write_atomic(search.out / RECORD, json_text(document) + "\n")
    return document


def _prepare(search: Search) -> None:
    """Room for a redesign of this case; refuses a folder that holds anything else."""
    out, case = search.out, search.case
    if out.exists():
        strangers = [] if not out.is_dir() else [
            entry.name for entry in out.iterdir() if not _OURS.fullmatch(entry.name)
        ]  # fmt: skip
        if not out.is_dir() or strangers:
            raise ResultError(f"{out}: holds something other than a redesign")
        record = out / RECORD
        held = read_json(record) if record.is_file() else {"case": case.name}
        if not isinstance(held, dict) or held.get("case") != case.name:
            raise ResultError(f"{out}: holds the redesign of another case")
    for name, content in case.included.items():
        write_atomic(out / name, content)


def _searched(
    search: Search, running: Mapping[str, Branch], workers: ProcessPoolExecutor, progress: Progress
) -> list[Tried]:
    """Every choice the branches asked for, with its rough point, in the order of the choices."""
    found: list[Tried] = []
    refusals: list[InputError] = []
    waiting: dict[Any, tuple[Branch, Choice]] = {}
    expected = _OF_A_BRANCH * len(running)

    def ask(branch: Branch, answer: Rough | None) -> None:
        """The branch's next choice that can be built goes to the workers."""
        while True:
            try:
                choice = next(branch) if answer is None else branch.send(answer)
            except StopIteration:
                return
            try:
                task = search.task(search.text(choice), "rough")
            except InputError as error:
                refusals.append(error)
                found.append((choice, {"feasible": False, "why": str(error)}))
                answer = Rough.impossible()
                continue
            waiting[workers.submit(solved, task)] = (branch, choice)
            return

    for branch in running.values():
        ask(branch, None)
    while waiting:
        done, _ = wait(waiting, return_when=FIRST_COMPLETED)
        for future in done:
            branch, choice = waiting.pop(future)
            record = future.result()
            found.append((choice, record))
            progress.advance(len(found), max(expected, len(found) + len(waiting)))
            ask(branch, Rough(**record) if "why" not in record else Rough.impossible())
    if refusals and len(refusals) == len(found):
        raise refusals[0]  # nothing fits: it is the case, not the parts
    return sorted(found, key=lambda pair: str(pair[0]))


def _chosen(tried: Sequence[Tried], against: str) -> list[Choice]:
    """Choices on the front of the rough points."""
    feasible = [(choice, record) for choice, record in tried if record["feasible"]]
    size = "cam_radius" if against == "size" else "mass"
    figures = [(record[size], record["ripple"]) for _, record in feasible]
    places = front(figures, ALIKE, ALIKE)  # the ripple is a share of that without a cam
    return [feasible[k][0] for k in thinned(places, figures, MOST_POINTS)]


def _solved_whole(
    search: Search, chosen: Sequence[Choice], workers: ProcessPoolExecutor, progress: Progress
) -> tuple[Record, list[Tried]]:
    """The case as given, and every choice, each by synthesis and closed forms in full."""
    progress.stage(f"{len(chosen)} points on the front, solved whole")
    texts = [search.case.to_toml(), *(search.text(choice) for choice in chosen)]
    futures = [workers.submit(solved, search.task(text, "whole")) for text in texts]
    records = []
    for future in futures:
        records.append(future.result())
        progress.advance(len(records), len(futures))
    return records[0], list(zip(chosen, records[1:], strict=True))


def _split(points: Sequence[Tried], against: str) -> tuple[list[Tried], list[Tried]]:
    """The front of what keeps every limit, smallest first, and the points that are not on it."""
    good = [pair for pair in points if pair[1]["feasible"] and not pair[1]["failing"]]
    figures = [(record[AGAINST[against]], record["ripple_left_Nm"]) for _, record in good]
    least = min((record["ripple_before_Nm"] for _, record in good), default=0.0)
    kept = [good[k] for k in front(figures, ALIKE, ALIKE * least)]
    return kept, [pair for pair in points if pair not in kept]


def _why(record: Record) -> str:
    """Why a point that was solved whole is not on the front."""
    if "why" in record:
        return str(record["why"])
    if not record["feasible"]:
        return "no cam keeps all limits on the fine turn"
    return f"fails {', '.join(record['failing'])}" if record["failing"] else "another is better"


def _written(search: Search, kept: Sequence[Tried]) -> list[Record]:
    """The points as case files, in place of those of an earlier search, and their records."""
    for old in search.out.glob("point_*.toml"):
        old.unlink()
    found = []
    for number, (choice, record) in enumerate(kept, start=1):
        name, text = f"point_{number:02d}.toml", search.text(choice)
        head = (
            f"# Point {number} of {len(kept)} of the redesign of {search.case.name}.\n"
            f"# {choice.words}.\n"
            f"# Foreseen: {record['ripple_left_Nm']:.4g} N m of torque ripple left (std), "
            f"cam radius {record['cam_radius_mm']:.4g} mm, {record['mass_g']:.4g} g.\n"
        )
        write_atomic(search.out / name, head + text)
        found.append({"file": name} | _named(choice) | record)
    return found


def _named(choice: Choice) -> Record:
    room = choice.cam_radius
    return {"roller": choice.roller, "spring": choice.spring, "bush": choice.bush,
            "room_mm": None if room is None else 1e3 * room}  # fmt: skip
