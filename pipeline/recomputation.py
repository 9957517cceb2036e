"""Recomputation of a finished run from its case and the lift of its final trial.

Loads, contact, certificate, tolerance corners, checks, limits and files are computed again and
compared with the folder. Further cam angles, drawn at random, are solved with both bodies in full
and compared with the stored cycle.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.lift import Lift
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.files import Json, files_in, read_json
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.base.worker_processes import crew
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.error_bars import contact_error
from camwright.pipeline.checks.solution_verification import RESIDUALS, synthesis_converged
from camwright.pipeline.checks.tolerance_corners import corners_record
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.certificate_angles import Position, begun
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.preview import smoothing_record
from camwright.pipeline.records.run_summary import StatedVerdict
from camwright.pipeline.results import check_records, run_reader, signoff
from camwright.pipeline.results.check_records import AnyCheck
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.field_file import read_series
from camwright.pipeline.results.field_output import (
    ENDS,
    STRESS,
    Shown,
    write_end_field,
    write_fields,
)
from camwright.pipeline.results.file_differences import (
    SAME,
    FileClass,
    Kind,
    Origin,
    classes_of,
    file_differences,
    record_differences,
)
from camwright.pipeline.results.model_limits import limitations
from camwright.pipeline.results.run_folder import RunFolder, versions
from camwright.pipeline.results.run_reader import Run, TrialRecord, read_run, results_sha256
from camwright.pipeline.results.run_records import torque_columns, trial_record
from camwright.pipeline.results.trial import CONSTRAINED, SmoothingRecord, Trial, TrialPoint
from camwright.pipeline.results.trial_writer import write_trial_files
from camwright.pipeline.results.workshop_files import WORKSHOP, stamp_solid, write_workshop
from camwright.pipeline.run import judged_of, summary_of
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import solve
from camwright.pipeline.torque.torque import Torque

ANGLES = 8
"""Cam angles drawn, if none are stated."""
MOST_ANGLES = 360
LARGEST_SEED = 2**32 - 1
_BY_THE_SEARCH = ("prices", "machine_prices", "trial_points", "trials", "statement")
"""Entries of the summary that rest on the search for the lift, which is not repeated."""
_OF_THE_COMPUTER = ("platform", "started", "timings_s", "versions")
"""Entries of the summary that say where and when the run was solved."""
_OF_THE_TRIAL = ("why", "synthesis", "prices")
"""Entries of the record of the final trial that rest on the search for the lift."""
_LAST = (signoff.NAME, signoff.SIGNATURES)
_HASHES = "mesh.sha256"
_NEGLIGIBLE = 1e-3
_LOADED = 0.01  # of the greatest contact pressure, at a drawn angle
_ELSEWHERE = "rests on more than the run holds and cannot be made again; make it anew"
_LISTED = 5
"""Differences of a record that are listed."""
_OF_A_CHECK = ("demand", "corner_demand", "error", "utilisation", "margin", "stated")
"""Numbers of a check that have its error bar."""


@dataclass(frozen=True)
class Angle:
    """Redrawn cam angle of a load case, rad, and greatest relative difference from the run.

    figure : str     that differs most, of p0, half_width, tau_max and von_mises
    allowed : float  error bar of that figure
    """

    load_case: str
    theta: float
    figure: str
    difference: float
    allowed: float

    @property
    def words(self) -> str:
        """Text such as ``running, 123 deg: p0 differs by 0.02 %, error bar 0.4 %``."""
        return (
            f"{self.load_case}, {in_unit(self.theta, 'deg'):.4g} deg: {self.figure} differs by"
            f" {100 * self.difference:.2g} %, error bar {100 * self.allowed:.2g} %"
        )


@dataclass(frozen=True)
class Recomputation:
    """Comparison of a run with its recomputation.

    Parameters
    ----------
    checks : tuple        records of the checks, computed again
    judged : mapping      their verdict, see `check_records.judgement`
    differences : tuple   of the folder, one line each, with the file
    angles : tuple        drawn angles; empty below the certified depth
    unseen : tuple        files, folders and entries of records that do not follow from case and
                          lift, and were not compared; none of them is cut or run
    pages : mapping       pages, sheets and pictures by name, with the kind of their file; they are
                          not compared, see `page_differences`
    versions : tuple      of the run, where they are not those of this installation, in words
    """

    checks: tuple[AnyCheck, ...]
    judged: StatedVerdict
    differences: tuple[str, ...]
    angles: tuple[Angle, ...]
    unseen: tuple[str, ...]
    pages: Mapping[str, Kind]
    versions: tuple[str, ...]


def recompute(
    folder: Path,
    *,
    angles: int = ANGLES,
    seed: int = 0,
    jobs: int | None = None,
    progress: Progress = SILENT,
) -> Recomputation:
    """Solve a finished run again from its case and final lift, and compare the results.

    Taken from the folder: the case; the lift, where a synthesis chose it; whether that synthesis
    converged; reason and number of the trial. A check may differ by its error bar, as
    computed again. No entry of the disk cache is read, and whatever versions the run states, every
    file but the pages is compared: see `page_differences`.

    Parameters
    ----------
    angles : int      cam angles at which both bodies are solved in full
    seed : int        of their choice
    jobs : int        processes for the certificate; None: number of processors, at most 4

    Raises
    ------
    CamError
        If the run cannot be read, or the case not be solved.
    """
    if not 0 <= angles <= MOST_ANGLES:
        raise InputError("--angles", angles, f">= 0 and <= {MOST_ANGLES}")
    if not 0 <= seed <= LARGEST_SEED:
        raise InputError("--seed", seed, f">= 0 and <= {LARGEST_SEED}")
    with disk_cache.left_out():
        return _recomputed(read_run(folder), angles, seed, jobs, progress)


def copy_without(folder: Path, copy: Path, pages: Iterable[str]) -> None:
    """Copy a run without its pages and record, so that they can be drawn again."""
    shutil.copytree(folder, copy, symlinks=True)  # a link made since is not followed
    for name in (*pages, *_LAST):
        (copy / name).unlink(missing_ok=True)


def page_differences(folder: Path, drawn: Path, pages: Mapping[str, Kind]) -> dict[str, str]:
    """Differences between the pages of a run and those drawn again, by file name.

    Parameters
    ----------
    drawn : Path      copy of the run in which they are drawn again, see `copy_without`
    pages : mapping   of `Recomputation`
    """
    made = {name: kind for name, kind in pages.items() if (drawn / name).is_file()}
    differing = dict(file_differences(folder, drawn, made.items()))
    return differing | {n: "is none of the run's pages" for n in pages if n not in made}


def _recomputed(
    run: Run,
    angles: int,
    seed: int,
    jobs: int | None,
    progress: Progress,
) -> Recomputation:
    """Comparison of a run with its recomputation; angles : number of cam angles drawn at random by
    `seed`; jobs : worker processes, None: one per processor, at most 4.
    """
    case, contour = drawn_cam(run.path)
    torques = engine_torques(case)
    record = run.final.record
    trial = solve(
        case,
        contour,
        tier=Tier.of(run.summary["depth"], "depth"),
        torques=torques,
        synthesis_gain=_recorded_gain(run.final),
        jobs=jobs,
        progress=progress,
    )
    trial = replace(
        trial, number=run.summary["final_trial"], why=record["why"],
        smoothing=_smoothing(case, run.final), synthesis=record["synthesis"],
    )  # fmt: skip
    drawn = _drawn_angles(run, trial, angles, seed, jobs, progress)
    differences = [
        f"{_cycle_file(run)}: {each.words}" for each in drawn if not each.difference <= each.allowed
    ]
    differences += _lift_differences(run, case, torques, contour)
    checks = tuple(one.as_record() for one in trial.checks)
    differences += _check_differences(run.final, checks)
    progress.stage("files")
    files = _Files(run, trial)
    files.compare()
    return Recomputation(
        cast("tuple[AnyCheck, ...]", checks),
        check_records.judgement(checks, trial.depth.word),
        (*differences, *files.differences),
        drawn,
        tuple(dict.fromkeys(files.unseen)),
        files.pages,
        _other_versions(run),
    )


def _other_versions(run: Run) -> tuple[str, ...]:
    """Versions of a run that are not those here, such as ``numpy 2.5.0, here 2.4.6``."""
    own, stated = versions(), run.summary["versions"]
    names = {**own, **stated}
    return tuple(
        f"{name} {stated.get(name)}, here {own.get(name)}"
        for name in names
        if stated.get(name) != own.get(name)
    )


def _cycle_file(run: Run) -> str:
    return f"{run.final.path.name}/5_cycle.csv"


def _recorded_gain(final: TrialRecord) -> float | None:
    """Gain that another step of the synthesis foresees, as recorded; None without a synthesis."""
    name = synthesis_converged.id
    stated = [check["demand"] for check in final.checks if check["id"] == name]
    return _number(final, f"demand of {name}", stated[0]) if stated else None


def _smoothing(case: Case, final: TrialRecord) -> SmoothingRecord:
    """Smoothing of the final trial, by the case and the recorded strength."""
    if case.smoothing.kind == "constrained":
        return CONSTRAINED
    return smoothing_record(_smoother(case, final) if case.balances else None)


def _smoother(case: Case, final: TrialRecord) -> Smoother:
    """Smoother of the case, of the strength of the final trial."""
    smoother = Smoother.from_case(case.smoothing, case.period)
    strength = _number(final, "smoothing_strength", final.record["smoothing_strength"])
    return smoother if strength is None else smoother.stretched(strength)


def _number(final: TrialRecord, name: str, value: object) -> float | None:
    """A number of a record, or none; ResultError for anything else."""
    if value is None or (isinstance(value, int | float) and not isinstance(value, bool)):
        return None if value is None else float(value)
    raise ResultError(f"{final.path}: {name} must be a number")


def _lift_differences(
    run: Run, case: Case, torques: Mapping[str, Torque], contour: Contour
) -> Iterator[str]:
    """Lines on the difference of the stored lift from that which follows from the case; a synthesis
    chooses its lift freely.

    Spring and prime radius are within their ranges where they are free, else those of the case.
    """
    lift = contour.pitch.lift
    if case.smoothing.kind == "constrained":
        stated = _chosen(read_case(run.path / "case.toml"))
        for name, value in _chosen(case).items():
            free = name in case.smoothing.free
            bounds = getattr(case.smoothing, f"{name}_range") if free else 2 * (stated[name],)
            if not bounds[0] * (1.0 - SAME) <= value <= bounds[1] * (1.0 + SAME):
                what = f"within smoothing.{name}_range" if free else "that"
                yield f"{run.final.path.name}/trial.json: {name} is not {what} of the case"
        yield from _source_differences(run, lift, Lift(lift.theta, lift.values))
        return
    if not case.balances:
        expected = given_lift(case)
    else:
        expected = cam_lift(case, torques, _smoother(case, run.final))
    apart = float(np.max(np.abs(lift(lift.theta) - expected(lift.theta))))
    if not apart <= SAME * expected.highest.value:
        words = f"the lift differs by {in_unit(apart, 'um'):.3g} um from that of the case"
        yield f"{run.final.path.name}/{run_reader.SPLINE_FILE}: {words}"
    yield from _source_differences(run, lift, expected)


def _source_differences(run: Run, lift: Lift, expected: Lift) -> Iterator[str]:
    """Lines on differences of what is recorded of the source of the lift: closure and spacing."""
    file = f"{run.final.path.name}/trial.json"
    if not abs(lift.closure - expected.closure) <= SAME * lift.highest.value:
        stated, again = (shown(each.closure, "mm") for each in (lift, expected))
        yield f"{file}: closure_mm = {stated}, recomputed {again}"
    if not abs(lift.spacing - expected.spacing) <= SAME * FULL_TURN:
        stated, again = (shown(each.spacing, "deg") for each in (lift, expected))
        yield f"{file}: table_step_deg = {stated}, recomputed {again}"


def _chosen(case: Case) -> dict[str, float]:
    """Variables of a synthesis besides the lift, by their name in `smoothing.free`, SI."""
    return {
        "spring_rate": case.spring.rate,
        "preload": case.spring.preload,
        "prime_radius": case.cam.prime_radius,
    }


def _check_differences(final: TrialRecord, checks: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Lines on the recorded checks that differ from those computed again by more than their error
    bars, are missing or are none of the case.
    """
    file = f"{final.path.name}/6_checks.json"
    stored = {record["id"]: record for record in final.checks}
    again = {str(record["id"]): record for record in checks}
    if len(stored) < len(final.checks):
        yield f"{file}: a check stands twice"
    for name in {**again, **stored}:
        if name not in stored or name not in again:
            what = "is missing" if name not in stored else "is none of the case"
            yield f"{file}: {name} {what}"
            continue
        one, two = dict(stored[name]), dict(again[name])
        one.setdefault("stated", two.get("stated"))  # none in a record of an earlier version
        share = SAME
        if two["demand"] and two["error"]:
            share = max(share, abs(two["error"] / two["demand"]))
        if two["demand"] and two["limit"] and two["evidence"]:  # a small part of its limit
            share = max(share, SAME * abs(two["limit"] / two["demand"]))
        bars = [{key: each.pop(key, None) for key in _OF_A_CHECK} for each in (one, two)]
        if all(_is_round_off(each) for each in (stored[name], again[name])):
            bars = [{}, {}]
        for each in (one, two):
            each.pop("remedy", None)
        words = (
            *record_differences(cast("Json", one), cast("Json", two), SAME),
            *record_differences(cast("Json", bars[0]), cast("Json", bars[1]), share),
        )
        yield from (f"{file}: {name}: {each}" for each in words)


def _is_round_off(record: Mapping[str, Any]) -> bool:
    """Whether the demand of a recorded check is a matter of round-off, and differs on another
    computer.

    A residual within its limit, or evidence of less than a thousandth of its limit.
    """
    demand, limit = record["demand"], record["limit"]
    if not record["evidence"] or record["sense"] != "at_most" or demand is None or limit is None:
        return False
    return abs(demand) <= (limit if record["id"] in RESIDUALS else _NEGLIGIBLE * limit)


# --- drawn angles


def _drawn_angles(
    run: Run, trial: Trial, count: int, seed: int, jobs: int | None, progress: Progress
) -> tuple[Angle, ...]:
    """Stored cycle compared with both bodies in full, at `count` loaded positions over all load
    cases drawn at random; empty without a certificate.
    """
    worst = tuple(point for point in trial.certificate if not point.order_from)
    if not worst:
        return ()
    loaded = loaded_positions(trial.cycles)
    order = np.random.default_rng(seed).permutation(len(loaded))[:count]
    chosen = [loaded[k] for k in sorted(order)]
    progress.stage("drawn angles")
    with crew(jobs) as workers:
        points = begun(trial.cycles, chosen, workers, worst).points(progress.advance)
    return tuple(
        _angle(run, trial, at.case, at.index, point)
        for at, point in zip(chosen, points, strict=True)
    )


def loaded_positions(cycles: Sequence[Cycle]) -> list[Position]:
    """Positions at which a contact has more than `_LOADED` of the greatest pressure.

    A cam that pulls has hardly any force in its dwells and at standstill: no mesh resolves it.
    """
    pressures = [np.nan_to_num(cycle.contact.p0) for cycle in cycles]
    least = _LOADED * max((float(each.max()) for each in pressures), default=0.0)
    return [
        Position(number, int(k))
        for number, pressure in enumerate(pressures)
        for k in np.flatnonzero(pressure > least)
    ]


def _angle(run: Run, trial: Trial, number: int, k: int, point: CertificatePoint) -> Angle:
    """Figure of the stored cycle of load case `number` at position k that differs most from a
    certified point, measured by its error bar.
    """
    cycle = trial.cycles[number]
    table = run.final.cycle.of_load_case(cycle.load_case)
    columns = {
        "p0": ("p0_fe_MPa", "MPa"),
        "half_width": ("half_width_fe_mm", "mm"),
        "tau_max": ("tau_max_MPa", "MPa"),
        "von_mises": ("von_mises_MPa", "MPa"),
    }
    figures: list[Angle] = []
    for name, (convergence, _) in point.figures.items():
        header, unit = columns[name]
        values = table[header]
        stored = float(values[k]) if k < values.size else np.nan
        apart = abs(stored / in_unit(convergence.extrapolated, unit) - 1.0)
        allowed = (contact_error(trial.solution, name) or 0.0) + convergence.gci
        figures.append(Angle(cycle.load_case, point.theta, name, apart, allowed))
    return max(figures, key=lambda each: np.nan_to_num(each.difference / each.allowed, nan=np.inf))


# --- files


class _Files:
    """Differences of the files of a run, and what was not compared.

    Parameters
    ----------
    run : Run       as stored
    trial : Trial   its final trial, computed again
    """

    def __init__(self, run: Run, trial: Trial) -> None:
        """Sort the files of the run by the class that says how each is compared; unknown ones are
        noted.
        """
        self._run, self._trial = run, trial
        self._final = run.final.path.name
        self.differences: list[str] = []
        self.unseen: list[str] = []
        recorded = read_json(run.path / signoff.NAME).get("files", {})
        self._classes: dict[str, FileClass] = {}
        for name, _ in files_in(run.path):
            known = classes_of(name, run.final.number)
            if known:
                self._classes[name] = known[0]
            elif name in recorded:
                self.differences.append(f"{name}: is no file that a command writes")
            else:
                self.unseen.append(name)

    @property
    def pages(self) -> dict[str, Kind]:
        """Pages, sheets and pictures, by the kind of their file."""
        return {n: each.kind for n, each in self._classes.items() if each.origin is Origin.DRAWN}

    def compare(self) -> None:
        """Compare every file but the pages by its class, and the records by their entries."""
        with tempfile.TemporaryDirectory(prefix="camwright-") as home:
            self._compare_solved(Path(home) / "run")
        for name, each in self._classes.items():
            if each.origin is Origin.ELSEWHERE:
                self.differences.append(f"{name}: {_ELSEWHERE}")
            elif each.origin is Origin.SEARCH:
                own = name.startswith(f"{self._final}/")
                self.unseen.append(name if own else f"{name.partition('/')[0]}/")

    def _compare_solved(self, folder: Path) -> None:
        """Write the run again into a folder and compare the files that follow from case and
        lift.
        """
        run, trial = self._run, self._trial
        case = read_case(run.path / "case.toml")
        with RunFolder(folder, case, depth=trial.depth) as again:
            summary = _written(again, run, trial)
            made = [name for name, _ in files_in(again.path)]
            classes = {name: classes_of(name, trial.number)[0] for name in made}
            solved = {n: each.kind for n, each in classes.items() if each.origin is Origin.SOLVED}
            differing = file_differences(run.path, again.path, solved.items())
            self.differences += (f"{name}: {words}" for name, words in differing)
            again.discard()
        self.differences += (
            f"{name}: is none of the case"
            for name, each in self._classes.items()
            if each.origin is Origin.SOLVED and name not in solved
        )
        self._compare_trial_record()
        self._compare_summary(summary, case)
        self.differences += _recorded_limits(run)

    def _compare_trial_record(self) -> None:
        """Compare ``trial.json`` with that of the trial computed again; hashes of a mesh are not
        compared, since they depend on its last bits.
        """
        file, record = f"{self._final}/trial.json", self._run.final.record
        words = list(record_differences(cast("Json", record), trial_record(self._trial)))
        of_bits = [line for line in words if line.startswith(_HASHES)]
        self.differences += _few(file, [line for line in words if line not in of_bits])
        self.unseen += [f"{file}: {_HASHES}"] if of_bits else []
        stated = {key: value for key, value in record.items() if key in _OF_THE_TRIAL and value}
        self.unseen += (f"{file}: {key}" for key in stated)
        checks = self._run.final.checks
        if any(check.get("remedy") for check in checks):
            self.unseen.append(f"{self._final}/6_checks.json: remedy")
        if any(check["id"] == synthesis_converged.id for check in checks):
            self.unseen.append(f"{self._final}/6_checks.json: {synthesis_converged.id}")

    def _compare_summary(self, again: Mapping[str, object], case: Case) -> None:
        """Compare ``run.json`` with its contents computed again; its hashes are compared with the
        files by the sign-off record.
        """
        stored = dict[str, Any](self._run.summary)
        here: Mapping[str, Any] = {"platform": signoff.environment(), "versions": versions()}
        for key in (*_BY_THE_SEARCH, *_OF_THE_COMPUTER):
            value = stored.pop(key, None)
            if value is not None and value != here.get(key):
                self.unseen.append(f"run.json: {key}")
        expected = {
            key: value
            for key, value in again.items()
            if key not in _BY_THE_SEARCH and (key in stored or value is not None)
        }
        expected |= {"schema": run_reader.SCHEMA, "case": case.name}
        expected |= {key: stored[key] for key in ("input_sha256", "files")}
        words = record_differences(cast("Json", stored), cast("Json", expected))
        self.differences += _few("run.json", list(words))


def _few(file: str, lines: Sequence[str]) -> Iterator[str]:
    """Lines of the first differences of a record, and the number of the others."""
    yield from (f"{file}: {line}" for line in lines[:_LISTED])
    if len(lines) > _LISTED:
        yield f"{file}: {len(lines) - _LISTED} more entries differ"


def _written(again: RunFolder, run: Run, trial: Trial) -> Mapping[str, object]:
    """Write the files that follow from a trial into the folder `again` as a run does; returns the
    contents of ``run.json``.
    """
    if (torque := trial.solution.machine.torque) is not None:
        again.write("1_torque.csv", torque_columns(torque))
    write_trial_files(again, trial)
    if trial.corners:
        again.write("corners.json", corners_record(trial.case, trial.corners))
    summary = summary_of(again, trial, (TrialPoint.of(trial),))
    if trial.mesh is not None:
        shop = again.path / WORKSHOP
        write_workshop(shop, trial.case, trial.contour)
        stamp_solid(shop, run.summary["input_sha256"], results_sha256(run.summary["files"]))
    if trial.depth >= Tier.CYCLE:
        shown = _shown_fields(run.path, trial)
        write_fields(again.fields, trial, shown)
        if shown is not Shown.NONE:
            write_end_field(again.fields / ENDS, trial)
    return {**summary, **judged_of(trial, run.summary["statement"])}


def _shown_fields(folder: Path, trial: Trial) -> Shown:
    """Which cam angles the stored stress field shows, by their number: none, the worst, a default
    set or all.
    """
    file = folder / "fields" / STRESS
    if not file.is_file():
        return Shown.NONE
    try:
        count = len(read_series(file).times)
    except ResultError:
        return Shown.DEFAULT
    if count == trial.cycles[0].theta.size:
        return Shown.ALL
    return Shown.WORST if count == 1 else Shown.DEFAULT


def _recorded_limits(run: Run) -> Iterator[str]:
    """Lines on limits of the model in the record that are not those of this version."""
    recorded = read_json(run.path / signoff.NAME)
    for key, words in limitations().items():
        if recorded.get(key) != words:
            yield f"{signoff.NAME}: {key} are not those of this version"
