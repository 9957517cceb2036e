"""Run folder being written."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import platform
import shutil
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, TypeAlias

from numpy.typing import ArrayLike

from camwright.geometry.errors import CamError, ResultError
from camwright.pipeline.base.files import (
    Json,
    file_hashes,
    json_text,
    npz_bytes,
    read_json,
    require_plain,
    shown_name,
    write_atomic,
)
from camwright.pipeline.base.owned_folder import ASIDE, OwnedFolder
from camwright.pipeline.base.store import PACKED, Store
from camwright.pipeline.base.tables import Values, table
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.folder_exchange import (
    CHUNKS,
    KEPT,
    STATE,
    absolute,
    exchange,
    is_complete,
    kept_by_nothing,
    owned,
    partial_of,
    settle,
    unrecorded,
)
from camwright.pipeline.results.workshop_files import WORKSHOP, stamp_solid

if TYPE_CHECKING:
    from camwright.pipeline.cycle.contact_store import ContactStore

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


Contents: TypeAlias = (
    Values | Mapping[str, ArrayLike] | Mapping[str, object] | Sequence[Mapping[str, object]]
)
"""What a file of a run is written of: SI values by column, arrays by name, a record or several."""


def _csv(values: Values) -> str:
    return table(values).to_csv()


def _json(record: Json) -> str:
    return f"{json_text(record)}\n"


FILES: Mapping[str, Callable[[Any], bytes | str]] = {
    "1_torque.csv": _csv,
    "1_speed.csv": _csv,
    "corners.json": _json,
    run_reader.SPLINE_FILE: _csv,
    "2_lift.csv": _csv,
    run_reader.LIMITS_FILE: _csv,
    "3_contour.csv": _csv,
    "5_cycle.csv": _csv,
    run_reader.SWEEP_FILE: _csv,
    "5_pressure.npz": npz_bytes,
    "5_guides.npz": npz_bytes,
    "5_pivot.npz": npz_bytes,
    "5_length.npz": npz_bytes,
    "5_envelope.npz": npz_bytes,
    "6_checks.json": _json,
    "trial.json": _json,
}
"""How tables, arrays and records of a run are written; the package lists their contents."""


def versions() -> dict[str, str]:
    """Versions of the project, its source hash, Python and the libraries."""
    ours = {"camwright": _version("camwright"), "source": _source_sha256()}
    ours["python"] = platform.python_version()
    return ours | {name: _version(name) for name in _LIBRARIES}


class RunFolder:
    """Run folder being written; a context manager.

    An interruption leaves the files for ``resume``, and so does a full disk or an unexpected
    exception once contact is solved. An error of the case deletes them: it would occur again.

    Parameters
    ----------
    out : Path      final path of the folder
    case : Case     as computed, positions included
    depth : Tier    of the run
    resume : bool   continue an interrupted run
    replace : bool  take the place of a run of an earlier version of the case as well, and of files
                    that were changed or that `inspect` or `contact deck` wrote

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
        """Lock the final path and begin or continue the temporary folder. For the parameters see
        the class.
        """
        self.out = absolute(out)
        self.path = partial_of(self.out)
        self.case = case
        self.depth = depth
        self._replace = replace
        self.versions = versions()
        self.resumed = False
        self._home = owned(self.out)
        self._open(resume)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Release the lock; after an error the files of the unfinished run are deleted, or kept for
        ``resume`` where contact is solved and the error is not one of the case.
        """
        if isinstance(error, Exception):
            again = isinstance(error, CamError) and not isinstance(error, ResultError)
            if again or not (is_complete(self.path) or self._holds_pieces()):
                self.discard()
            else:
                error.add_note(KEPT)
        self._home.release()

    def _holds_pieces(self) -> bool:
        return any((self.path / CHUNKS).rglob("*.npz"))

    # --- files, in the order of the calculation

    def write(self, name: str, values: Contents, trial: int | None = None) -> None:
        """Write a file of `FILES`.

        Parameters
        ----------
        values : Contents   as the form of the file takes them
        trial : int         number of the trial whose file it is; None: of the run

        Raises
        ------
        ResultError
            If the file cannot be written.
        """
        place = name if trial is None else f"trial_{trial}/{name}"
        write_atomic(self._file(place), FILES[name](values))

    def mesh_path(self, trial: int) -> Path:
        """Path of ``4_mesh.msh``, in a folder that exists."""
        return self._file(f"trial_{trial}/4_mesh.msh")

    @property
    def fields(self) -> Path:
        return self._file("fields/x").parent

    @property
    def figures(self) -> Path:
        return self._file("figures/x").parent

    def write_summary(self, summary: Mapping[str, object]) -> dict[str, object]:
        """``run.json``, completed by schema, case, hashes and versions; may be written again.
        Returns what is written.

        Parameters
        ----------
        summary : mapping   the other entries of `run_reader.Summary`, and further ones

        Raises
        ------
        ResultError
            If a key figure is missing.
        """
        headline = summary["headline"]
        known = headline if isinstance(headline, Mapping) else {}
        missing = [name for name in run_reader.HEADLINE if name not in known]
        if missing:
            raise ResultError(f"headline lacks {', '.join(missing)}")
        whole: dict[str, object] = {
            "schema": run_reader.SCHEMA,
            "case": self.case.name,
            "input_sha256": self.case.sha256,
            "versions": self.versions,
            "platform": signoff.environment(),
            **summary,
            "files": file_hashes(self.path, run_reader.is_result),
        }
        write_atomic(self.path / "run.json", _json(whole))
        return whole

    def finish(self, summary: Mapping[str, object]) -> None:
        """Write summary and sign-off record, and move the folder to its final path."""
        self.write_summary(summary)
        recorded = run_reader.read_summary(self.path)
        results = run_reader.results_sha256(recorded["files"])
        stamp_solid(self.path / WORKSHOP, recorded["input_sha256"], results)
        signoff.write(self.path)
        try:
            _refuse_other_runs(self._home, self.case, replace=self._replace)
            (self.path / STATE).unlink()
            exchange(self.out)
        except OSError as error:
            raise ResultError(f"{self.out}: {error.strerror or error}") from None
        self._home.release()

    def discard(self) -> None:
        """Delete the unfinished run, and the folders created for it."""
        if self._home.taken:
            with suppress(OSError):
                self._clear()
                (self.path / STATE).unlink(missing_ok=True)
                self.path.rmdir()
            self._home.release()

    def _clear(self, kept: str = "") -> None:
        """Delete the files of the folder, except `kept` and the state file, which marks the folder
        as that of a run.
        """
        for entry in list(self.path.iterdir()):
            if entry.name not in (STATE, kept):
                is_folder = entry.is_dir() and not entry.is_symlink()
                shutil.rmtree(entry) if is_folder else entry.unlink()

    # --- pieces of the contact solution

    def contact_store(self, trial: int) -> ContactStore:
        """Pieces of the contact of a trial."""
        return Store(self.path / CHUNKS / f"trial_{trial}", PACKED)

    # --- opening

    def _open(self, resume: bool) -> None:
        """Lock the final path, refuse it if it holds anything but a run that may be replaced, and
        begin or continue the temporary folder.
        """
        opened = False
        self._home.take()
        try:
            settle(self.out)
            _refuse_other_runs(self._home, self.case, replace=self._replace)
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
            self._home.release()
            raise refused from None

    def _take_over(self, resume: bool) -> None:
        """Make the temporary folder; with `resume` continue an interrupted run in it, else delete
        its files.
        """
        state = self.path / STATE
        if self.path.is_symlink() or (self.path.exists() and not self.path.is_dir()):
            raise ResultError(f"{self.path}: in the way, and not the start of a run")
        self.path.mkdir(exist_ok=True)
        names = [entry.name for entry in self.path.iterdir()]
        if not state.is_file() and not all(ASIDE.fullmatch(name) for name in names):
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
        """Write state file, case and the files that it includes."""
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

    def _file(self, name: str) -> Path:
        """Path of a file in the temporary folder, its parent folders made."""
        path = self.path / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultError(f"{path}: {error.strerror or error}") from None
        return path


def _differing(state: Json, now: Mapping[str, Json]) -> str:
    """First difference between the state of an interrupted run and that of this one (input, depth
    or versions), in words; "" without one.
    """
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


def _refuse_other_runs(home: OwnedFolder, case: Case, *, replace: bool) -> None:
    """Refuse to overwrite anything but a run of the same input.

    Parameters
    ----------
    home : OwnedFolder   final path
    case : Case          whose run is written
    replace : bool       accept a run of a case of the same name as well, and files added or changed

    Raises
    ------
    ResultError
        If the folder is signed, or holds another run or files of the user.
    """
    out = home.path
    if os.path.lexists(out / signoff.SIGNATURES):
        raise ResultError(f"{out}: holds a signed run; choose another folder or remove it")
    entries = home.entries()
    if not entries:
        return
    if "run.json" not in entries:
        raise home.stranger(entries[0])
    if not (replace and _name_of(out) == case.name):
        summary = run_reader.read_summary(out)
        if summary["input_sha256"] != case.sha256:
            other = summary["case"]
            what = "another input" if other == case.name else f"another case, {other}"
            raise ResultError(f"{out}: holds the run of {what}; choose another folder or remove it")
    _refuse_to_delete(out, replace=replace)


def _refuse_to_delete(out: Path, *, replace: bool) -> None:
    """Refuse to delete a run with files that no command wrote.

    Parameters
    ----------
    out : Path       folder of the run
    replace : bool   accept files that were changed since, or that `inspect` or `contact deck` wrote

    Raises
    ------
    ResultError
        Naming the file.
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


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "missing"


def _source_sha256() -> str:
    """First 16 hexadecimal digits of the SHA-256 over modules and data tables of the project."""
    digest = hashlib.sha256()
    for package in _PACKAGES:
        folder = Path(import_module(f"camwright.{package}").__path__[0])
        for file in sorted(folder.rglob("*")):
            if file.suffix not in _SOURCES:
                continue
            digest.update(f"\0{package}/{file.relative_to(folder).as_posix()}\0".encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
