"""Run folder while it is written."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import platform
import re
import shutil
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import IO, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.errors import CamError, ResultError
from camwright.pipeline.base.files import (
    Json,
    file_hashes,
    json_text,
    npz_bytes,
    read_json,
    read_npz,
    require_plain,
    shown_name,
    write_atomic,
)
from camwright.pipeline.base.tables import Values, table
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.folder_exchange import (
    CHUNKS,
    KEPT,
    OURS,
    STATE,
    absolute,
    exchange,
    is_complete,
    kept_by_nothing,
    lock_of,
    partial_of,
    settle,
    unlock,
    unrecorded,
)
from camwright.pipeline.results.workshop_files import WORKSHOP, stamp_solid

_TEMPORARY = re.compile(r"\.\w+\.tmp")
_LIBRARIES = (
    "numpy",
    "scipy",
    "scikit-fem",
    "gmsh",
    "meshio",
    "h5py",
    "pyvista",
    "vtk",
    "matplotlib",
)
_PACKAGES = ("geometry", "meshes", "pipeline", "reports")
_SOURCES = (".py", ".toml")


def versions() -> dict[str, str]:
    """Versions of the project, its source text, Python and the libraries."""
    ours = {"camwright": _version("camwright"), "source": _source_sha256()}
    ours["python"] = platform.python_version()
    return ours | {name: _version(name) for name in _LIBRARIES}


class RunFolder:
    """The folder of a run while it is written; a context manager.

    An interruption leaves the files for ``resume``, and so does a full disk or an unexpected
    exception once contact is solved. An error of the case deletes them: it would occur again.

    Parameters
    ----------
    out : Path      final path of the folder
    case : Case     as computed, positions included
    depth : Tier    of the run
    resume : bool   continue an interrupted run
    replace : bool  take the place of a run of an earlier version of the case as well, and of files
                    that were changed or that `inspect` or `deck` wrote

    Raises
    ------
    ResultError
        If `out` holds anything but a run of this case or a signed one, or a file of the user; if
        another process writes to it, or if the interrupted run has another input or other versions.
    """

    def __init__(
        self,
        out: Path,
        case: Case,
        *,
        depth: Tier = Tier.CERTIFIED,
        resume: bool = False,
        replace: bool = False,
    ) -> None:
        self.out = absolute(out)
        self.path = partial_of(self.out)
        self.case = case
        self.depth = depth
        self._replace = replace
        self.versions = versions()
        self.resumed = False
        self._created: list[Path] = []
        self._lock: IO[str] | None = None
        self._open(resume, replace)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if isinstance(error, Exception):
            again = isinstance(error, CamError) and not isinstance(error, ResultError)
            if again or not (is_complete(self.path) or self._holds_pieces()):
                self.discard()
            else:
                error.add_note(KEPT)
        self._unlock()

    def _holds_pieces(self) -> bool:
        return any((self.path / CHUNKS).rglob("*.npz"))

    # --- files, in the order of the calculation

    def write_torque(self, values: Values) -> None:
        """``1_torque.csv``."""
        self._write_table("1_torque.csv", values)

    def write_speed(self, values: Values) -> None:
        """``1_speed.csv``."""
        self._write_table("1_speed.csv", values)

    def write_spline(self, trial: int, values: Values) -> None:
        """``2_spline.csv``: knots and coefficients of the lift."""
        self._write_table(f"trial_{trial}/{run_reader.SPLINE_FILE}", values)

    def write_lift(self, trial: int, values: Values) -> None:
        """``2_lift.csv``."""
        self._write_table(f"trial_{trial}/2_lift.csv", values)

    def write_limits(self, trial: int, values: Values) -> None:
        """``2_limits.csv``."""
        self._write_table(f"trial_{trial}/{run_reader.LIMITS_FILE}", values)

    def write_contour(self, trial: int, values: Values) -> None:
        """``3_contour.csv``."""
        self._write_table(f"trial_{trial}/3_contour.csv", values)

    def mesh_path(self, trial: int) -> Path:
        """Path of ``4_mesh.msh``; its folder exists."""
        return self._file(f"trial_{trial}/4_mesh.msh")

    def write_cycle(self, trial: int, values: Values) -> None:
        """``5_cycle.csv``, all load cases."""
        self._write_table(f"trial_{trial}/5_cycle.csv", values)

    def write_pressure(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_pressure.npz``: contact pressure at every position of every load case."""
        write_atomic(self._file(f"trial_{trial}/5_pressure.npz"), npz_bytes(arrays))

    def write_speed_sweep(self, trial: int, values: Values) -> None:
        """``5_speed_sweep.csv``: extremes over the turn from standstill to over-speed."""
        self._write_table(f"trial_{trial}/5_speed_sweep.csv", values)

    def write_guides(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_guides.npz``: line load of the guides at every position, pressure in the bores."""
        write_atomic(self._file(f"trial_{trial}/5_guides.npz"), npz_bytes(arrays))

    def write_length(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_length.npz``: pressure along the line of contact at every position."""
        write_atomic(self._file(f"trial_{trial}/5_length.npz"), npz_bytes(arrays))

    def write_envelope(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_envelope.npz``: maximum stresses of a turn in a band under the contour."""
        write_atomic(self._file(f"trial_{trial}/5_envelope.npz"), npz_bytes(arrays))

    def write_checks(self, trial: int, records: Iterable[Mapping[str, object]]) -> None:
        """``6_checks.json``"""
        text = json_text([dict(record) for record in records])
        write_atomic(self._file(f"trial_{trial}/6_checks.json"), text + "\n")

    def write_trial(self, trial: int, record: Mapping[str, object]) -> None:
        """``trial.json``: smoothing, reason of the trial, mesh quality, certificate."""
        text = json_text(dict(record))
        write_atomic(self._file(f"trial_{trial}/trial.json"), text + "\n")

    def write_corners(self, record: Mapping[str, Json]) -> None:
        """``corners.json``: demands at every corner of the tolerances."""
        write_atomic(self._file("corners.json"), json_text(dict(record)) + "\n")

    @property
    def fields(self) -> Path:
        return self._file("fields/x").parent

    @property
    def figures(self) -> Path:
        return self._file("figures/x").parent

    def write_summary(self, summary: Mapping[str, Json]) -> dict[str, Json]:
        """``run.json``, completed by schema, case, hashes and versions; may be written again.

        Parameters
        ----------
        summary : Mapping   the other entries of `run_reader.Summary`, and further ones
        """
        headline = summary["headline"]
        known = headline if isinstance(headline, Mapping) else {}
        missing = [name for name in run_reader.HEADLINE if name not in known]
        if missing:
            raise ResultError(f"headline lacks {', '.join(missing)}")
        whole: dict[str, Json] = {
            "schema": run_reader.SCHEMA,
            "case": self.case.name,
            "input_sha256": self.case.sha256,
            "versions": self.versions,
            "platform": signoff.environment(),
            **summary,
            "files": file_hashes(self.path, run_reader.is_result),
        }
        write_atomic(self.path / "run.json", json_text(whole) + "\n")
        return whole

    def finish(self, summary: Mapping[str, Json]) -> None:
        """Write summary and sign-off record, and move the folder to its final path."""
        self.write_summary(summary)
        recorded = run_reader.read_summary(self.path)
        results = run_reader.results_sha256(recorded["files"])
        stamp_solid(self.path / WORKSHOP, recorded["input_sha256"], results)
        signoff.write(self.path)
        try:
            _refuse_strangers(self.out, self.case, replace=self._replace)
            (self.path / STATE).unlink()
            exchange(self.out)
        except OSError as error:
            raise ResultError(f"{self.out}: {error.strerror or error}") from None
        self._unlock()

    def discard(self) -> None:
        """Delete the unfinished run, and the folders created for it."""
        if self._lock is not None:
            with suppress(OSError):
                self._clear()
                (self.path / STATE).unlink(missing_ok=True)
                self.path.rmdir()
            self._unlock()
        self._remove_parents()

    def _clear(self, kept: str = "") -> None:
        """Delete the files but `kept` and the state, which marks the folder as that of a run."""
        for entry in list(self.path.iterdir()):
            if entry.name not in (STATE, kept):
                is_folder = entry.is_dir() and not entry.is_symlink()
                shutil.rmtree(entry) if is_folder else entry.unlink()

    def _remove_parents(self) -> None:
        for folder in self._created:
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()

    # --- pieces of the contact solution

    def contact_store(self, trial: int) -> ContactFiles:
        """Pieces of the contact of a trial."""
        return ContactFiles(self.path / CHUNKS / f"trial_{trial}")

    # --- opening

    def _open(self, resume: bool, replace: bool) -> None:
        self._created = _make_parents(self.out)
        opened = False
        try:
            self._lock = lock_of(self.out)
            settle(self.out)
            _refuse_strangers(self.out, self.case, replace=replace)
            self._take_over(resume)
            opened = True
            self._begin()
        except (OSError, ResultError) as error:
            refused = error
            if isinstance(error, OSError):
                refused = ResultError(f"{self.out}: {error.strerror or error}")
            if opened and self._holds_pieces():
                refused.add_note(KEPT)
            elif opened:
                self.discard()
            self._unlock()
            self._remove_parents()
            raise refused from None

    def _take_over(self, resume: bool) -> None:
        """Make the folder; continue an interrupted run, or delete it."""
        state = self.path / STATE
        if self.path.is_symlink() or (self.path.exists() and not self.path.is_dir()):
            raise ResultError(f"{self.path}: in the way, and not the start of a run")
        self.path.mkdir(exist_ok=True)
        names = [entry.name for entry in self.path.iterdir()]
        if not state.is_file() and not all(_TEMPORARY.fullmatch(name) for name in names):
            raise ResultError(f"{self.path}: in the way, and not the start of a run")
        if resume and state.is_file():
            differ = _differing(read_json(state), self._identity())
            if differ:
                raise ResultError(
                    f"{self.path}: cannot be resumed: {differ} differ; run without --resume"
                )
            require_plain(self.path)
            self.resumed = True
        # What an interrupted run wrote is written again, with the options of this one.
        self._clear(kept=CHUNKS if self.resumed else "")

    def _begin(self) -> None:
        write_atomic(self.path / STATE, json.dumps(self._identity(), indent=2) + "\n")
        write_atomic(self.path / "case.toml", self.case.to_toml())
        for name, content in self.case.included.items():
            write_atomic(self.path / name, content)

    def _identity(self) -> dict[str, Json]:
        return {
            "input": self.case.sha256,
            "depth": self.depth.word,
            "versions": self.versions,
        }

    def _unlock(self) -> None:
        if self._lock is not None:
            unlock(self.out, self._lock)
            self._lock = None

    def _file(self, name: str) -> Path:
        path = self.path / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultError(f"{path}: {error.strerror or error}") from None
        return path

    def _write_table(self, name: str, values: Values) -> None:
        write_atomic(self._file(name), table(values).to_csv())


@dataclass(frozen=True)
class ContactFiles:
    """Pieces of the contact of a trial as files, to resume an interrupted run."""

    folder: Path

    def save(self, load_case: str, index: int, arrays: Mapping[str, Array], key: str) -> None:
        """Store a piece; `key` is the hash of its inputs."""
        named = {f"a_{name}": a for name, a in arrays.items()} | {"key": np.array(key)}
        write_atomic(self.folder / load_case / f"{index:06d}.npz", npz_bytes(named))

    def load(self, load_case: str, key: str) -> dict[int, dict[str, Array]]:
        """Pieces of a key by index."""
        pieces: dict[int, dict[str, Array]] = {}
        for file in sorted((self.folder / load_case).glob("*.npz")):
            try:
                stored = read_npz(file)
                if str(stored["key"]) == key:
                    names = [name for name in stored if name.startswith("a_")]
                    pieces[int(file.stem)] = {n[2:]: readonly(stored[n]) for n in names}
            except (ResultError, ValueError, KeyError):
                continue  # damaged by a crash of the machine: solved again
        return pieces


def _differing(state: Json, now: Mapping[str, Json]) -> str:
    """Input, depth or versions of an interrupted run that differ, in words; empty if none does."""
    known = state if isinstance(state, Mapping) else {}
    for name in ("input", "depth"):
        if known.get(name) != now[name]:
            return f"its {name}"
    then, running = (
        each if isinstance(each, Mapping) else {}
        for each in (known.get("versions"), now["versions"])
    )
    names = [name for name in {**then, **running} if then.get(name) != running.get(name)]
    return f"its versions ({', '.join(names)})" if names else ""


def _refuse_strangers(out: Path, case: Case, *, replace: bool) -> None:
    """Refuse to overwrite anything but a run of the same input, or name if it is replaced."""
    if not os.path.lexists(out):
        return
    if not out.is_dir():
        raise ResultError(f"{out}: is not a folder")
    entries = sorted(entry.name for entry in out.iterdir())
    if not entries:
        return
    if signoff.SIGNATURES in entries:
        raise ResultError(f"{out}: holds a signed run; choose another folder or remove it")
    strange = [name for name in entries if not OURS.fullmatch(name)]
    if strange or "run.json" not in entries:
        name = (strange or entries)[0]
        raise ResultError(f"{out}: holds {name}, which is not of a run; choose another folder")
    require_plain(out)
    if not (replace and _name_of(out) == case.name):
        summary = run_reader.read_summary(out)
        if summary["input_sha256"] != case.sha256:
            other = summary["case"]
            what = "another input" if other == case.name else f"another case, {other}"
            raise ResultError(f"{out}: holds the run of {what}; choose another folder or remove it")
    _refuse_to_delete(out, replace=replace)


def _refuse_to_delete(out: Path, *, replace: bool) -> None:
    """Refuse to delete a run with files that no command wrote.

    Those that were changed, or that `inspect` or `deck` wrote, are deleted where it is replaced.
    """
    if not (out / signoff.NAME).is_file():
        reason = f"holds no {signoff.NAME}, which lists the files of a run"
        raise ResultError(f"{out}: {reason}; choose another folder or remove it")
    for name in unrecorded(out)[:1]:
        raise ResultError(f"{out}: holds {shown_name(name)}, which no run wrote; move it elsewhere")
    for name in kept_by_nothing(out)[: 0 if replace else 1]:
        reason = f"holds {shown_name(name)}, which was added to the run or changed since"
        raise ResultError(f"{out}: {reason}; --replace deletes it")


def _name_of(out: Path) -> Json:
    """Name of the case of a run, of another schema too."""
    summary = read_json(out / "run.json")
    return summary.get("case") if isinstance(summary, dict) else None


def _make_parents(out: Path) -> list[Path]:
    """Create the folders above `out`; returns the new ones, innermost first."""
    missing = [folder for folder in out.parents if not folder.exists()]
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResultError(f"{out.parent}: {error.strerror or error}") from None
    return missing


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "missing"


def _source_sha256() -> str:
    """SHA-256 of the modules and tables of the project, shortened."""
    digest = hashlib.sha256()
    for package in _PACKAGES:
        folder = Path(import_module(f"camwright.{package}").__path__[0])
        for file in sorted(folder.rglob("*")):
            if file.suffix not in _SOURCES:
                continue
            digest.update(f"\0{package}/{file.relative_to(folder).as_posix()}\0".encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
