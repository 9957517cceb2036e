"""Writing a run folder: whole or not at all, and resumable after an interruption.

A run grows in ``.DIR.partial`` beside its final place and is renamed when it is complete.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import io
import json
import os
import platform
import re
import shutil
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

import camwright
from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError, ResultError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.files import file_hashes, json_text, npz_bytes, read_json, write_atomic
from camwright.pipeline.base.tables import Values, table
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import load_case_file
from camwright.pipeline.results import run_reader, signoff

_STATE, _CHUNKS, _LOCK = ".state.json", ".chunks", ".lock"
_OURS = re.compile(
    r"case\.toml|(run|signoff|corners)\.json|inputs|fields|figures|exports|workshop|inspection|trial_\d+"
    r"|scene\.html|\d+_\w+\.(csv|html|json|pdf)"
)
_LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "meshio", "pyvista", "vtk", "matplotlib")


def versions() -> dict[str, str]:
    """What computed the numbers: project, its source text, Python, the libraries."""
    found = {"camwright": _version("camwright"), "source": _source_sha256()}
    found["python"] = platform.python_version()
    return found | {name: _version(name) for name in _LIBRARIES}


class RunFolder:
    """The folder of a run while it grows; a context manager.

    Left before `finish` by Ctrl-C, by a kill or by what nobody expected, it keeps what there is
    for ``resume``. An error of ours takes it away.

    Parameters
    ----------
    out : Path      where the run is to lie in the end
    case : Case     as it is computed, positions included
    resume : bool   go on with what an interrupted run left

    Raises
    ------
    ResultError
        If `out` holds anything but a run of this case, if another process writes to it, or if
        what an interrupted run left is of another input or of other versions.
    """

    def __init__(self, out: Path, case: Case, *, resume: bool = False) -> None:
        self.out = _absolute(out)
        self.path = self.out.with_name(f".{self.out.name}.partial")
        self.case = case
        self.versions = versions()
        self.resumed = False
        self._created: list[Path] = []
        self._lock: io.TextIOWrapper | None = None
        _refuse_strangers(self.out, case)
        self._open(resume)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        # What is told to the user would end so again; what nobody expected need not, and the
        # solved part of a trial is worth keeping for then.
        ours = kind is not None and issubclass(kind, CamError)
        bare = not any((self.path / _CHUNKS).rglob("*.npz"))
        if ours or (bare and kind is not None and issubclass(kind, Exception)):
            self.discard()
        self._unlock()

    # --- the files, in the order of the road

    def write_torque(self, values: Values) -> None:
        """``1_torque.csv``."""
        self._write_table("1_torque.csv", values)

    def write_speed(self, values: Values) -> None:
        """``1_speed.csv``."""
        self._write_table("1_speed.csv", values)

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
        """Where ``4_mesh.msh`` belongs; its folder is there."""
        return self._file(f"trial_{trial}/4_mesh.msh")

    def write_cycle(self, trial: int, values: Values) -> None:
        """``5_cycle.csv``, all load cases."""
        self._write_table(f"trial_{trial}/5_cycle.csv", values)

    def write_pressure(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_pressure.npz``: contact pressure at every position of every load case."""
        write_atomic(self._file(f"trial_{trial}/5_pressure.npz"), npz_bytes(arrays))

    def write_guides(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_guides.npz``: pressure along the guides at every position, and round the bores."""
        write_atomic(self._file(f"trial_{trial}/5_guides.npz"), npz_bytes(arrays))

    def write_envelope(self, trial: int, arrays: Mapping[str, ArrayLike]) -> None:
        """``5_envelope.npz``: greatest stresses of a turn in a band under the contour."""
        write_atomic(self._file(f"trial_{trial}/5_envelope.npz"), npz_bytes(arrays))

    def write_checks(self, trial: int, records: Iterable[Mapping[str, Any]]) -> None:
        """``6_checks.json``"""
        text = json_text([dict(record) for record in records])
        write_atomic(self._file(f"trial_{trial}/6_checks.json"), text + "\n")

    def write_trial(self, trial: int, record: Mapping[str, Any]) -> None:
        """``trial.json``: smoother, what was changed and why, certificate, mesh quality."""
        text = json_text(dict(record))
        write_atomic(self._file(f"trial_{trial}/trial.json"), text + "\n")

    def write_corners(self, record: Mapping[str, Any]) -> None:
        """``corners.json``: demands at every corner of the tolerances."""
        write_atomic(self._file("corners.json"), json_text(dict(record)) + "\n")

    @property
    def fields(self) -> Path:
        return self._file("fields/x").parent

    @property
    def figures(self) -> Path:
        return self._file("figures/x").parent

    def write_summary(self, summary: Mapping[str, Any]) -> dict[str, Any]:
        """``run.json``, completed by schema, case, hashes and versions; may be written again.

        Parameters
        ----------
        summary : Mapping   ``timings_s, trials, verdict, binding, headline`` and what else there is
        """
        missing = [name for name in run_reader.HEADLINE if name not in summary["headline"]]
        if missing:
            raise ResultError(f"headline lacks {', '.join(missing)}")
        whole = {
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

    def finish(self, summary: Mapping[str, Any]) -> dict[str, Any]:
        """Write the summary, sign the whole and move the folder to its final place."""
        shutil.rmtree(self.path / _CHUNKS, ignore_errors=True)
        whole = self.write_summary(summary)
        (self.path / _STATE).unlink(missing_ok=True)
        signoff.write(self.path)
        old = self.out.with_name(f".{self.out.name}.old")
        try:
            shutil.rmtree(old, ignore_errors=True)
            if self.out.exists():
                self.out.rename(old)
            try:
                self.path.rename(self.out)
            except OSError:
                if old.exists():
                    old.rename(self.out)
                raise
        except OSError as error:
            raise ResultError(f"{self.out}: {error.strerror or error}") from None
        shutil.rmtree(old, ignore_errors=True)
        self._unlock()
        (self.out / _LOCK).unlink(missing_ok=True)
        return whole

    def discard(self) -> None:
        """Take away what there is of the unfinished run, and the folders made for it."""
        if self._lock is not None:
            shutil.rmtree(self.path, ignore_errors=True)
            self._unlock()
        for folder in self._created:
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()

    # --- pieces of the cycle, kept as they are done

    def contact_store(self, trial: int) -> ContactFiles:
        """Pieces of the contact of a trial."""
        return ContactFiles(self.path / _CHUNKS / f"trial_{trial}")

    # --- opening

    def _open(self, resume: bool) -> None:
        self._created = _make_parents(self.out)
        try:
            if self.path.is_symlink() or self.path.exists():
                self._take_over(resume)
            self.path.mkdir(exist_ok=True)
            self._take_lock()
            if not self.resumed:
                self._begin()
        except OSError as error:
            self.discard()
            raise ResultError(f"{self.out}: {error.strerror or error}") from None
        except ResultError:
            if self._lock is not None and not resume:
                self.discard()
            self._unlock()
            raise

    def _take_over(self, resume: bool) -> None:
        """Go on with an interrupted run, or clear it away."""
        state = self.path / _STATE
        if self.path.is_symlink() or not self.path.is_dir():
            raise ResultError(f"{self.path}: in the way, and not the start of a run")
        if not state.is_file() and any(entry.name != _LOCK for entry in self.path.iterdir()):
            raise ResultError(f"{self.path}: in the way, and not the start of a run")
        self._take_lock()
        if resume and state.is_file():
            differ = _differing(read_json(state), self._identity())
            if differ:
                raise ResultError(
                    f"{self.path}: cannot be resumed: {differ} differ; run without --resume"
                )
            self.resumed = True
            return
        for entry in self.path.iterdir():
            if entry.name != _LOCK:
                shutil.rmtree(entry) if entry.is_dir() else entry.unlink()

    def _begin(self) -> None:
        write_atomic(self.path / _STATE, json.dumps(self._identity(), indent=2) + "\n")
        write_atomic(self.path / "case.toml", self.case.to_toml())
        for name, content in self.case.included.items():
            write_atomic(self.path / name, content)

    def _identity(self) -> dict[str, Any]:
        return {"input": self.case.sha256, "versions": self.versions}

    def _take_lock(self) -> None:
        """Hold the folder for this process; the system lets go when the process ends."""
        if self._lock is not None:
            return
        try:
            import fcntl
        except ImportError:  # Windows has no such lock
            return
        lock = (self.path / _LOCK).open("w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            raise ResultError(f"{self.out}: another run is writing to it") from None
        self._lock = lock

    def _unlock(self) -> None:
        if self._lock is not None:
            self._lock.close()
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
    """Pieces of a trial's contact as files: the store of a run that may be interrupted."""

    folder: Path

    def save(self, load_case: str, index: int, arrays: Mapping[str, Array], key: str) -> None:
        """Keep a piece; `key` is the hash of all that decides it."""
        named = {f"a_{name}": a for name, a in arrays.items()} | {"key": np.array(key)}
        write_atomic(self.folder / load_case / f"{index:06d}.npz", npz_bytes(named))

    def load(self, load_case: str, key: str) -> dict[int, dict[str, Array]]:
        """Pieces by index; those of another key are left out."""
        pieces: dict[int, dict[str, Array]] = {}
        for file in sorted((self.folder / load_case).glob("*.npz")):
            try:
                with np.load(file, allow_pickle=False) as stored:
                    if str(stored["key"]) == key:
                        names = [name for name in stored.files if name.startswith("a_")]
                        pieces[int(file.stem)] = {n[2:]: readonly(stored[n]) for n in names}
            except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
                continue  # torn by a crash of the machine: computed anew
        return pieces


def _differing(found: Any, wanted: Mapping[str, Any]) -> str:
    """What an interrupted run was made of that is not so now, in words; empty when all is."""
    found = found if isinstance(found, dict) else {}
    if found.get("input") != wanted["input"]:
        return "its input"
    then, now = found.get("versions"), wanted["versions"]
    then = then if isinstance(then, dict) else {}
    names = [name for name in {**then, **now} if then.get(name) != now.get(name)]
    return f"its versions ({', '.join(names)})" if names else ""


def drawn_cam(run: Path) -> tuple[Case, Contour]:
    """The case of a run and the contour of its last trial."""
    found = run_reader.load_run(run)
    case = load_case_file(run / "case.toml")
    values = 1e-3 * found.final.lift["lift_mm"]
    return case, case.contour(Lift(uniform_turn(values.size), values))


@contextmanager
def set_aside(out: Path, case: Case) -> Iterator[None]:
    """Make room for another run of a case of the same name; put the old one back on failure.

    A run of a case of another name, or a folder that is no run, is left where it is: opening
    the `RunFolder` then refuses it.
    """
    out = _absolute(out)
    aside = out.with_name(f".{out.name}.replaced")
    if aside.exists() and not out.exists():
        aside.rename(out)  # left by a process that was killed
    moved = _holds_only_a_run(out) and run_reader.read_summary(out)["case"] == case.name
    if moved:
        shutil.rmtree(aside, ignore_errors=True)
        out.rename(aside)
    try:
        yield
    finally:
        if moved and not out.exists():
            aside.rename(out)
        shutil.rmtree(aside, ignore_errors=True)


def _holds_only_a_run(out: Path) -> bool:
    if not (out / "run.json").is_file():
        return False
    return all(_OURS.fullmatch(entry.name) for entry in out.iterdir())


def _refuse_strangers(out: Path, case: Case) -> None:
    """A folder is written over only where it holds nothing but a run of the same input."""
    if not os.path.lexists(out):
        return
    if not out.is_dir():
        raise ResultError(f"{out}: is not a folder")
    entries = sorted(entry.name for entry in out.iterdir())
    if not entries:
        return
    strange = [name for name in entries if not _OURS.fullmatch(name)]
    if strange or "run.json" not in entries:
        name = (strange or entries)[0]
        raise ResultError(f"{out}: holds {name}, which is not of a run; choose another folder")
    summary = run_reader.read_summary(out)
    if summary["input_sha256"] != case.sha256:
        other = summary["case"]
        what = "another input" if other == case.name else f"another case, {other}"
        raise ResultError(f"{out}: holds the run of {what}; choose another folder or remove it")


def _absolute(out: Path) -> Path:
    try:
        resolved = out.resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise ResultError(f"{out}: {error}") from None
    if not resolved.name:
        raise ResultError(f"{out}: is not a folder to write a run to")
    return resolved


def _make_parents(out: Path) -> list[Path]:
    """Make the folders above `out`; gives those that were not there, innermost first."""
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
    """Hash of the project's own modules: a changed line is another version."""
    root = Path(camwright.__file__).parent
    digest = hashlib.sha256()
    for package in ("geometry", "meshes", "pipeline", "reports"):
        for file in sorted((root / package).rglob("*.py")):
            digest.update(f"\0{file.relative_to(root).as_posix()}\0".encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
