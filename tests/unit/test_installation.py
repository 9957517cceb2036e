"""Checkout, source archive and wheel are the same program, on a file system without links, too."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from distribution import FOLDERS, ROOT, build

from camwright.pipeline.results.run_folder import versions

USED = """
import json, sys
from importlib.util import find_spec

import camwright
from camwright.pipeline.base.worker_processes import pool
from camwright.pipeline.results.run_folder import versions

with pool(1) as workers:
    of_worker = workers.submit(versions).result()
print(json.dumps({
    "path": [*camwright.__path__],
    "source": [versions()["source"], of_worker["source"]],
    "at_the_top": [name for name in sys.argv[1:] if find_spec(name)],
}))
"""


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An unpacked source archive."""
    folder = tmp_path_factory.mktemp("archive")
    with tarfile.open(build("sdist", ROOT, folder / "built")) as packed:
        assert not any(each.issym() or each.islnk() for each in packed)
        safe = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}  # from Python 3.11.4
        packed.extractall(folder, **safe)
    (unpacked,) = folder.glob("camwright-*")
    return unpacked


@pytest.fixture(scope="module")
def wheel(archive: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the unpacked wheel that is built from the archive."""
    folder = tmp_path_factory.mktemp("wheel")
    with zipfile.ZipFile(build("wheel", archive, folder / "built")) as packed:
        packed.extractall(folder / "site")
    return folder / "site"


def content(folder: Path) -> dict[str, bytes]:
    return {
        file.relative_to(folder).as_posix(): file.read_bytes()
        for file in folder.rglob("*")
        if file.is_file() and "__pycache__" not in file.parts
    }


def program(checkout: Path) -> dict[str, bytes]:
    """Files of the package, by their path in it."""
    packages = {
        f"{name}/{path}": text
        for name in FOLDERS
        for path, text in content(checkout / name).items()
    }
    return content(checkout / "src" / "camwright") | packages


def test_archive_and_wheel_have_every_file_of_the_package(archive: Path, wheel: Path) -> None:
    assert program(archive) == program(ROOT)
    assert content(wheel / "camwright") == program(ROOT)


@pytest.mark.parametrize("form", ["archive", "wheel"])
def test_a_form_of_the_program_runs(
    form: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """It imports itself alone, in its workers, too, and nothing of it by another name."""
    place: Path = request.getfixturevalue(form)
    home = place / "src" if form == "archive" else place
    environment = os.environ | {"PYTHONPATH": str(home)}
    environment["CAMWRIGHT_CACHE"] = str(tmp_path / "cache")

    def run_python(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-P", *arguments], cwd=tmp_path, env=environment, check=False,
            capture_output=True, text=True,
        )  # fmt: skip

    used = json.loads(run_python("-c", USED, *FOLDERS).stdout)
    own = [str(home / "camwright"), *([str(place)] if form == "archive" else [])]
    assert used == {"path": own, "source": [versions()["source"]] * 2, "at_the_top": []}
    check = run_python("-m", "camwright", "check", str(ROOT / "cases" / "gx120.toml"), "--json")
    assert (check.returncode, json.loads(check.stdout)["screen"]) == (1, "fail"), check.stderr


@pytest.mark.parametrize("links", [True, False])
def test_a_type_checker_sees_every_file(
    links: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = ROOT / "scripts" / "typing_tree.py"
    specification = importlib.util.spec_from_file_location("typing_tree", script)
    assert specification is not None and specification.loader is not None
    typing_tree = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(typing_tree)

    def refused(*_: object) -> None:
        raise OSError("no links here")

    if not links:
        monkeypatch.setattr(Path, "symlink_to", refused)
    tree = tmp_path / "camwright"
    (tree / "removed").mkdir(parents=True)
    typing_tree.lay_out(tree)
    assert any(each.is_symlink() for each in tree.iterdir()) is links
    seen = {name: text for each in tree.iterdir() if each.is_dir()
            for name, text in content(each.resolve()).items()}  # fmt: skip
    assert seen == {name: text for each in FOLDERS for name, text in content(ROOT / each).items()}
    assert {each.name for each in tree.iterdir()} == {
        *FOLDERS, *(name for name in program(ROOT) if "/" not in name),
    }  # fmt: skip
