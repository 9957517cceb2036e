"""A plain installation: what needs an extra says so, and all else works without."""

from __future__ import annotations

import ast
import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from collections.abc import Callable
from importlib.machinery import ModuleSpec
from pathlib import Path

import numpy as np
import pytest
from distribution import FOLDERS, ROOT, build

from camwright.geometry.errors import ResultError
from camwright.pipeline.base import columns, extras
from camwright.pipeline.base.extras import EXTRAS

Command = Callable[..., tuple[int, str, str]]

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
OPTIONAL = {"cvxopt", "pypardiso"}
"""Libraries that make the program faster, and without which it does the same."""
REQUIRED_BY_THEM = {"vtkmodules", "PIL", "pydantic_core", "markupsafe"}
"""Modules of what pyvista, matplotlib, pydantic and jinja2 require."""
INSTALLED_AS = {
    "scikit-fem": "skfem",
    "scikit_fem": "skfem",
    "tomli-w": "tomli_w",
    "typing-extensions": "typing_extensions",
}


def modules_of(requirements: list[str]) -> set[str]:
    names = {re.split(r"[\[<>=~! ]", each)[0] for each in requirements}
    return {INSTALLED_AS.get(name, name) for name in names}


@pytest.fixture
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    """This process as after an installation without extras."""
    absent = {library for libraries in EXTRAS.values() for library in libraries} | OPTIONAL

    class Absent:
        def find_spec(self, name: str, path: object = None, _: object = None) -> ModuleSpec | None:
            if name.partition(".")[0] in absent:
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)
            return None

    found, version = importlib.util.find_spec, importlib.metadata.version

    def missing(name: str, *package: str) -> ModuleSpec | None:
        return None if name.partition(".")[0] in absent else found(name, *package)

    def version_of(name: str) -> str:
        if name in absent:
            raise importlib.metadata.PackageNotFoundError(name)
        return version(name)

    for name in [name for name in sys.modules if name.partition(".")[0] in absent]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "meta_path", [Absent(), *sys.meta_path])
    monkeypatch.setattr(extras, "find_spec", missing)
    monkeypatch.setattr(importlib.metadata, "version", version_of)


STUDY = (
    'study needs SALib, dask, distributed, pyarrow; install with: pip install "camwright[study]"'
)


def test_a_study_names_its_extra(
    plain: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    monkeypatch.chdir(ROOT)
    out = tmp_path / "out"
    for arguments in (
        ("run", "studies/roller.toml", "--out", out),
        ("run", "studies/roller.toml", "--out", out, "--resume"),
        ("run", "studies/roller.toml", "--out", out, "--scheduler", "127.0.0.1:8786"),
        ("run", "cases/gx120.toml", "--out", out),
        ("report", out),
    ):
        code, text, errors = command("study", *arguments)
        assert (code, text, errors.count("\n")) == (2, "", 1)
        assert STUDY in errors
        assert not out.exists()


def test_a_data_frame_names_its_extra(plain: None) -> None:
    with pytest.raises(ResultError, match=r'frame needs pandas; install .*camwright\[notebook\]"'):
        columns.data_frame({"a": np.zeros(2)})


def test_every_library_is_a_dependency_or_of_an_extra() -> None:
    """And each extra that the package needs is known by its libraries."""
    ours = {"camwright", "_typeshed", *sys.stdlib_module_names}  # the second of type checkers
    known = modules_of(PROJECT["dependencies"]) | REQUIRED_BY_THEM | OPTIONAL
    stated = PROJECT["optional-dependencies"]
    for extra, libraries in EXTRAS.items():
        assert modules_of(stated[extra]) == set(libraries)
    known |= {library for libraries in EXTRAS.values() for library in libraries}
    for file in (file for each in ("src", *FOLDERS) for file in (ROOT / each).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            names = (
                [alias.name for alias in node.names] if isinstance(node, ast.Import)
                else [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            )  # fmt: skip
            for name in names:
                assert name.partition(".")[0] in known | ours, (file, name)


def closure(requirements: list[str]) -> set[str]:
    """Distributions that requirements install, themselves included."""
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    names: set[str] = set()
    waiting = [Requirement(each) for each in requirements]
    while waiting:
        each = waiting.pop()
        name = canonicalize_name(each.name)
        wanted = [{"extra": extra} for extra in ("", *each.extras)]
        if name in names:
            continue
        names.add(name)
        for text in importlib.metadata.requires(name) or ():
            required = Requirement(text)
            if required.marker is None or any(required.marker.evaluate(one) for one in wanted):
                waiting.append(required)
    return names


@pytest.mark.slow
def test_a_plain_installation_of_the_wheel(tmp_path: Path) -> None:
    """The wheel in a fresh environment with its dependencies, and no other library of this one."""
    wheel = build("wheel", ROOT, tmp_path / "built")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    venv.create(tmp_path / "plain", symlinks=True, with_pip=False)
    (place,) = (tmp_path / "plain" / "lib").glob("python*/site-packages")
    subprocess.run([*pip, "install", "--no-deps", "--target", place, wheel], check=True)
    for name in closure(PROJECT["dependencies"]):
        for file in importlib.metadata.files(name) or ():
            top = file.parts[0]
            if top not in ("..", "__pycache__") and not (place / top).exists():
                (place / top).symlink_to(
                    Path(str(file.locate())).parents[len(file.parts) - 1] / top
                )
    run = [str(tmp_path / "plain" / "bin" / "python"), "-P", "-m", "camwright"]
    shutil.copytree(ROOT / "cases", tmp_path / "cases")
    shutil.copytree(ROOT / "studies", tmp_path / "studies")

    def said(*arguments: str) -> tuple[int, str]:
        environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        done = subprocess.run(
            [*run, *arguments], cwd=tmp_path, env=environment, capture_output=True, text=True,
            check=False,
        )  # fmt: skip
        return done.returncode, done.stderr

    code, errors = said("study", "run", "studies/roller.toml", "--out", "out")
    assert code == 2 and STUDY in errors
    assert said("new", "demo", "--kind", "eccentric")[0] == 0
    assert said("check", "demo.toml")[0] == 3
    code, errors = said("run", "demo.toml", "--out", "run", "--depth", "cycle", "--positions", "36")
    assert code == 0, errors
    assert said("report", "run")[0] == 0
