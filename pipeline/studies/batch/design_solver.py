"""Solution of designs: singly at their depth, or thousands screened as arrays; run files."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from camwright.geometry.errors import CamError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.files import files_in, json_text, read_json, write_atomic
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import governing_id, screen
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.judge import Judge
from camwright.pipeline.studies.batch.case_template import Template, UnpackedTemplates
from camwright.pipeline.studies.batch.dataset import (
    GOVERNING,
    HEADLINE,
    MESH,
    SCREEN,
    VERDICT,
)
from camwright.pipeline.studies.batch.design_rows import (
    CLOCK,
    Cell,
    Files,
    Row,
    encoded,
    lost,
    out_of_memory,
)
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted

if TYPE_CHECKING:
    from camwright.pipeline.run import CaseRun

UNEXPECTED = "unexpected {kind}: {text}"

_SCREENED_AT_ONCE = 125  # screened designs: their arrays bound the memory of a process


def row_of(trial: Trial) -> Row:
    """Row of the dataset for a solved design: text or number by column name; None where unknown.

    Screen (whether a must-have check fails), verdict, id of the governing check, headline figures,
    mesh quality, and of each check demand, limit, utilisation, status and error of the demand.
    Units are those of the column names and, of demand, limit and error, of the check; the demand
    of a check of which only a bound is known is None.
    """
    from camwright.pipeline.results.run_records import headline

    row: Row = {
        SCREEN.name: screen(trial.checks),
        VERDICT.name: trial.verdict,
        GOVERNING.name: governing_id(trial.checks),
    }
    row |= {HEADLINE + key: _cell(value) for key, value in headline(trial.solution).items()}
    if trial.mesh is not None:
        row |= {MESH + key: float(v) for key, v in asdict(trial.mesh.quality).items()}
    for one in trial.checks:
        unit = one.unit
        row |= {
            f"{one.id}.demand": _number(None if one.is_bound else one.worst, unit),
            f"{one.id}.limit": _number(one.limit, unit),
            f"{one.id}.utilisation": _number(one.utilisation),
            f"{one.id}.status": one.status,
            f"{one.id}.error": _number(one.error, unit),
        }
    return row


def _number(value: float | None, unit: str = "") -> float | None:
    if value is None or not math.isfinite(value):
        return None
    return float(f"{in_unit(value, unit):.15g}")


@dataclass
class DesignSolver:
    """Solver of designs of the templates of a study; one per process.

    Parameters
    ----------
    templates : sequence   base cases
    settings : Settings    of the study
    """

    templates: Sequence[Template]
    settings: Settings
    _cases: UnpackedTemplates = field(init=False)
    _bases: dict[str, tuple[Case, Lift]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._cases = UnpackedTemplates(self.templates)

    def screened(self, task: Task) -> dict[str, Any]:
        """Columns (n,) of the dataset for the n designs of a task, screened by closed forms as
        arrays; see `screen_designs`.
        """
        from camwright.pipeline.screening.design_screening import screen_designs

        case = self._cases[task.case]
        # a case that is itself the design
        values = task.values or {"spring.preload": np.array([case.spring.preload])}
        count = len(next(iter(values.values())))
        pieces = [
            screen_designs(
                case,
                {
                    name: column[start : start + _SCREENED_AT_ONCE]
                    for name, column in values.items()
                },
                positions=self._positions(case),
            )
            for start in range(0, count, _SCREENED_AT_ONCE)
        ]
        names = dict.fromkeys(name for piece in pieces for name in piece)
        return {name: np.concatenate([piece[name] for piece in pieces]) for name in names}

    def _positions(self, case: Case) -> int:
        return self.settings.positions or case.solver.positions

    def solved(self, task: Task, row: int) -> Row:
        """Row of the dataset, value by name of column, of the design in a row of a task; an error
        of any kind gives a row with its message.

        Parameters
        ----------
        task : Task   designs of one case at one depth
        row : int     index of the design in it
        """
        try:
            return self._solved(task, row)
        except CamError as error:
            return lost(str(error))
        except MemoryError:
            return out_of_memory(self.settings)
        except Exception as error:  # noqa: BLE001 - a row must come of every design
            text = " ".join(str(error).split())[:200]
            return lost(UNEXPECTED.format(kind=type(error).__name__, text=text))

    def _solved(self, task: Task, row: int) -> Row:
        """As `solved`; a refusal is raised as CamError."""
        if task.tier is Tier.SCREENING:
            columns = self.screened(task.alone(row))
            return {name: _cell(values[0]) for name, values in columns.items()}
        return row_of(self._trial(self.design(task, row), task.tier))

    def _trial(self, judge: Judge, tier: Tier) -> Trial:
        """Trial of the design of a judge at a depth."""
        return judge.run(Change(), tier, corners=self.settings.corners).trial

    def design(self, task: Task, row: int) -> Judge:
        """Judge of the design in a row of a task; with the lift of the base case, if all designs
        have its cam.

        Parameters
        ----------
        task : Task   designs of one case
        row : int     index of the design in it

        Raises
        ------
        CamError
            If the values are refused, or the base case has no cam.
        """
        case, lift = self._cases[task.case], None
        if self.settings.cam == "base":
            case, lift = self._base(task.case)
        if task.values:
            case = with_values(case, task.value_of(row))
        if task.tier is not Tier.CERTIFIED and self.settings.positions is not None:
            case = case.with_positions(self.settings.positions)
        if case.smoothing.kind != "constrained":  # else a wider smoother would be another design
            solver = case.solver.model_copy(update={"max_trials": 1})
            case = case.model_copy(update={"solver": solver})
        return Judge(case, engine_torques(case), lift=lift)

    def _base(self, name: str) -> tuple[Case, Lift]:
        """Base case of a name with the spring and prime radius of its synthesis, and its lift; made
        once.
        """
        from camwright.pipeline.iteration import synthesize

        if name not in self._bases:
            made = synthesize(self._cases[name])
            self._bases[name] = made.case, made.contour.pitch.lift
        return self._bases[name]

    def encoded(
        self, task: Task, columns: Mapping[str, Sequence[Any]], walls: Sequence[float]
    ) -> tuple[bytes, bytes]:
        """Rows and clock figures of a task as Parquet files; see `design_rows.encoded`."""
        return encoded(task, columns, walls, self.settings.outputs)

    def solved_and_run(
        self, task: Task, row: int, wanted: Wanted, send: Callable[[Row | Files], object]
    ) -> None:
        """Send the row of the dataset for a design, then its run files, made from one solution.

        The files lack the page, see `presented`.

        Parameters
        ----------
        task : Task       designs of one case
        row : int         index of the design in it
        wanted : Wanted   designs that may be kept; of others no files are made
        send : callable   receives the row, then the files; none where there is no run
        """
        cells: Row = {}
        files: Files = {}
        try:
            with self._begun(task, row) as (run, trial):
                cells = row_of(trial)
                send(cells)
                if wanted.takes(screen(trial.checks), cells):
                    files = _finished(run)
        except Exception:  # noqa: BLE001 - a refusal is a row; a run that fails is made again alone
            if not cells:
                send(self.solved(task, row))
        send(files)

    def run_folder(self, task: Task, row: int) -> Files:
        """Run files of a design by relative name; clock figures as `CLOCK`.

        Raises
        ------
        CamError
            If the design is refused.
        """
        with self._begun(task, row) as (run, _):
            files = _finished(run)
        return self.presented(files)

    def presented(self, files: Files) -> Files:
        """Run files, by name, with page, pictures and sign-off record added, which are made from
        the others.
        """
        from camwright.pipeline.results import signoff
        from camwright.reports.sections import report

        with tempfile.TemporaryDirectory(prefix="camwright-run-") as name:
            path = Path(name) / "run"
            for each, content in files.items():
                if each != CLOCK:
                    write_atomic(path / each, content)
            report(path)
            signoff.write(path)
            made = {each: file.read_bytes() for each, file in files_in(path)}
        return made | {each: files[each] for each in files if each == CLOCK}

    @contextmanager
    def _begun(self, task: Task, row: int) -> Iterator[tuple[CaseRun, Trial]]:
        """Context manager: run of one design in a folder that is deleted afterwards, and its
        checked trial.

        Below CERTIFIED none of its files is written yet.

        Parameters
        ----------
        task : Task   designs of one case at one depth
        row : int     index of the design in it
        """
        from camwright.pipeline.run import CaseRun

        judge = replace(self.design(task, row), lift=None)
        solved: Trial | None = None
        if task.tier is Tier.PREVIEW:  # as its row, so that it is solved once
            solved = self._trial(judge, task.tier)
        with (
            tempfile.TemporaryDirectory(prefix="camwright-run-") as name,
            CaseRun(judge.base, Path(name) / "run", depth=task.tier, jobs=1) as run,
        ):
            trial = run.solve(solved)
            if task.tier is Tier.CERTIFIED:
                run.write()
                trial = run.certify()
            yield run, trial


def _finished(run: CaseRun) -> Files:
    """Files by relative name of a run that is solved, without its page; clock figures apart, as
    `CLOCK`.
    """
    from camwright.pipeline.results import signoff

    if run.depth < Tier.CERTIFIED:
        run.write()
    run.finish()
    clock = _without_clock(run.out)
    signoff.write(run.out)  # has the hash of run.json
    return {each: file.read_bytes() for each, file in files_in(run.out)} | {CLOCK: clock}


def _without_clock(folder: Path) -> bytes:
    """Take the clock figures out of ``run.json``; they are returned as JSON."""
    summary = read_json(folder / "run.json")
    clock, summary["timings_s"], summary["started"] = summary["timings_s"], {}, None
    write_atomic(folder / "run.json", json_text(summary) + "\n")
    return f"{json_text(clock)}\n".encode()


def _cell(value: Any) -> Cell:
    plain = value.item() if isinstance(value, np.generic) else value
    return plain if isinstance(plain, (str, float)) or plain is None else float(plain)
