"""No process of ours imports from the folder in which one stands, or from that of a script."""

from __future__ import annotations

import ast
import concurrent.futures.process  # noqa: F401 - before the folder of traps is on the path
import multiprocessing.synchronize  # noqa: F401
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from multiprocessing import resource_tracker
from pathlib import Path

import pytest
from small_machine import small_machine
from trap_folder import Traps, before_a_module

from camwright.geometry.errors import InputError
from camwright.pipeline.base import worker_processes
from camwright.pipeline.base.worker_processes import import_path, module_command, pool
from camwright.pipeline.results.field_output import VIEW
from camwright.pipeline.studies.batch.design_plan import study_versions
from camwright.pipeline.studies.batch.design_task import Settings
from camwright.pipeline.studies.batch.solver_process import SolverProcess

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("geometry", "meshes", "pipeline", "reports")
FILES = {
    ".".join(("camwright", *file.relative_to(ROOT).with_suffix("").parts)): file
    for folder in FOLDERS
    for file in sorted((ROOT / folder).rglob("*.py"))
    if "templates" not in file.parts
}


@pytest.fixture
def traps(tmp_path: Path) -> Traps:
    return Traps.set_in(tmp_path / "here", tmp_path / "marks")


def run(traps: Traps, *command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, cwd=traps.folder, capture_output=True, text=True, check=False, timeout=300
    )


def test_traps_are_sprung(traps: Traps) -> None:
    run(traps, sys.executable, "-c", "import struct")
    assert traps.sprung() == ["struct"]


def test_modules_run_as_processes_import_none_of_the_folder(traps: Traps) -> None:
    command = f"{module_command.__name__}(__name__"
    started = [name for name, file in FILES.items() if command in file.read_text()]
    assert len(started) >= 2
    for name in started:
        run(traps, *module_command(name))
        assert traps.sprung() == [], name


@pytest.mark.slow
def test_the_command_as_a_module_imports_none_of_the_folder(traps: Traps) -> None:
    for name in before_a_module():  # nothing of ours can prevent it
        (traps.folder / f"{name}.py").unlink(missing_ok=True)
    for flags in (("-m", "camwright"), ("-Bmcamwright",), ("-m", "camwright.pipeline.cli")):
        done = run(traps, sys.executable, *flags, "--version")
        assert (done.returncode, traps.sprung()) == (0, []), done.stderr
    (traps.folder / "case.toml").write_text(small_machine("small"))
    done = run(traps, sys.executable, "-m", "camwright", "check", "case.toml")
    assert (done.returncode in (1, 3), traps.sprung()) == (True, []), done.stderr


def test_a_module_of_a_user_keeps_its_folder(tmp_path: Path) -> None:
    (tmp_path / "camwright_tools").mkdir()
    (tmp_path / "camwright_tools" / "__init__.py").write_text("import camwright, beside\n")
    (tmp_path / "camwright_tools" / "__main__.py").write_text("import beside\nprint('run')\n")
    (tmp_path / "beside.py").write_text("")
    done = subprocess.run(
        [sys.executable, "-m", "camwright_tools"], cwd=tmp_path, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert done.stdout == "run\n", done.stderr


@pytest.fixture
def standing_in(traps: Traps, monkeypatch: pytest.MonkeyPatch) -> Iterator[Traps]:
    """The folder of traps as working folder and on the path, as in a notebook."""
    monkeypatch.chdir(traps.folder)
    monkeypatch.setattr(sys, "path", ["", str(traps.folder), *sys.path])
    yield traps


def test_workers_import_none_of_the_folder(standing_in: Traps) -> None:
    """The tracker of semaphores, a process of Python's pools, is started with them."""
    resource_tracker._resource_tracker._stop()
    with pool(1) as workers:
        workers.submit(worker_processes._imported, "camwright.pipeline.solver").result()
    assert standing_in.sprung() == []
    assert "PYTHONSAFEPATH" not in os.environ


def test_the_process_of_a_study_imports_none_of_the_folder(standing_in: Traps) -> None:
    settings = Settings({}, study_versions(), "own", 36, False, (), 60.0, 10**10)
    process = SolverProcess((), settings)
    try:
        process._started()
    finally:
        process.close()
    assert standing_in.sprung() == []


def test_the_view_of_a_run_imports_none_of_its_folder(traps: Traps) -> None:
    shutil.copy(ROOT / "pipeline" / "results" / "templates" / VIEW, traps.folder)
    done = run(traps, sys.executable, VIEW)
    assert traps.sprung() == []
    assert "stress.vtkhdf" in done.stderr  # the first that it needs of its folder, and not there


def test_the_path_of_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without working folder and that of the script; what is named on purpose stays."""
    here, script, library = (tmp_path / name for name in ("here", "script", "library"))
    here.mkdir()
    monkeypatch.chdir(here)
    monkeypatch.setattr(sys.modules["__main__"], "__file__", str(script / "run.py"), raising=False)
    home = worker_processes._HOME
    path = ["", str(here), str(script), str(library), home]
    monkeypatch.setattr(sys, "path", path)
    monkeypatch.delenv("PYTHONPATH", raising=False)
    assert import_path() == [str(library), home]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(("", ".")))
    assert import_path() == [str(here), str(library), home]
    monkeypatch.delenv("PYTHONPATH")
    monkeypatch.chdir(home)
    assert home in import_path()


def test_python_that_ignores_the_environment_needs_a_flag() -> None:
    """With -E the workers would ignore that they are not to import from the working folder."""
    script = "from camwright.pipeline.base.worker_processes import pool\nwith pool(1): print('on')"
    done = subprocess.run(
        [sys.executable, "-E", "-c", script], capture_output=True, text=True, check=False
    )
    assert f"{InputError.__name__}: python = -E, must be -E -P, or -I" in done.stderr
    done = subprocess.run(
        [sys.executable, "-EP", "-c", script], capture_output=True, text=True, check=False
    )
    assert done.stdout == "on\n", done.stderr


STARTS = {"run", "Popen", "call", "check_call", "check_output"}
"""Functions of `subprocess` that start a process."""
OTHERS = {
    ("os", "system"), ("os", "popen"), ("os", "fork"), ("os", "startfile"), ("sys", "executable"),
    ("multiprocessing", "Process"), ("multiprocessing", "Pool"), ("runpy", "run_path"),
}  # fmt: skip


def unsafe_starts(tree: ast.AST) -> Iterator[int]:
    """Lines that start a process by another command than that of `module_command`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            name = node.value.id, node.attr
            if name in OTHERS or (name[0] == "os" and name[1].startswith(("exec", "spawn"))):
                yield node.lineno
        if isinstance(node, ast.ImportFrom) and node.module in ("subprocess", "multiprocessing"):
            yield node.lineno
        if (
            isinstance(node, ast.Call)
            and ast.unparse(node.func).partition(".")[::2] in {("subprocess", s) for s in STARTS}
            and not (isinstance(node.args[0], ast.Call)
                     and ast.unparse(node.args[0].func) == module_command.__name__)
        ):  # fmt: skip
            yield node.lineno
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("ProcessPoolExecutor"):
            yield node.lineno


def test_all_processes_are_started_by_one_module() -> None:
    allowed = "camwright.pipeline.base.worker_processes"
    words = re.compile(r"subprocess|multiprocessing|ProcessPool|runpy|\b(os|sys)\.[efps]\w")
    texts = {name: file.read_text() for name, file in FILES.items() if name != allowed}
    lines = {
        name: [*unsafe_starts(ast.parse(text))]
        for name, text in texts.items()
        if words.search(text)
    }
    assert {name: each for name, each in lines.items() if each} == {}
    assert [*unsafe_starts(ast.parse(FILES[allowed].read_text()))] != []
