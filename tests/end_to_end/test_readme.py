"""What the README shows is what happens: every command and snippet of it is executed."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.renamed_keys import with_new_keys
from camwright.pipeline.case.template import template

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SECONDS = 540.0


def blocks(language: str) -> list[str]:
    found = re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    assert found, language
    return found


def commands(word: str) -> list[str]:
    lines = [line for block in blocks("bash") for line in block.splitlines()]
    assert all(line.split()[0] in ("make", "camwright", "export") for line in lines)
    return [line for line in lines if line.startswith(word)]


def shell(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=False,
        timeout=SECONDS,
    )


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """The `camwright` commands in the order of the README, in one folder."""
    folder = tmp_path_factory.mktemp("readme")
    return folder, {line: shell(line, folder) for line in commands("camwright")}


def test_commands_do_what_is_said(session: tuple[Path, dict[str, Any]]) -> None:
    folder, done = session
    for line, result in done.items():
        allowed = (0, 1) if line.startswith("camwright check") else (0,)
        assert result.returncode in allowed, f"{line}: {result.stderr}"
    assert (folder / "runs" / "demo" / "8_report.html").is_file()


def test_the_run_folder_holds_what_is_listed(session: tuple[Path, dict[str, Any]]) -> None:
    folder, _ = session
    listed = re.findall(r"^\| `([^`]+)` \|", README[README.index("## The run folder") :], re.M)
    assert len(listed) >= 12
    some_cases_only = {"trial_2/", "1_speed.csv", "corners.json", "trial_1/2_limits.csv"}
    for name in listed:
        assert (folder / "runs" / "demo" / name).exists() or name in some_cases_only, name


def test_python_snippet(session: tuple[Path, dict[str, Any]]) -> None:
    folder, _ = session
    (snippet,) = blocks("python")
    result = subprocess.run(
        [sys.executable, "-c", snippet], cwd=folder, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.split()[0] in ("pass", "fail")


def test_make_targets_exist() -> None:
    targets = [line.split()[1] for line in commands("make")]
    assert {"run", "test", "lint", "verify", "bench"} <= set(targets)
    for target in targets:
        result = shell(f"make --dry-run {target}", ROOT)
        assert result.returncode == 0, f"{target}: {result.stderr}"


@pytest.mark.parametrize("block", blocks("toml"))
def test_toml_snippets_fit_into_a_case(block: str) -> None:
    given = tomllib.loads(block)
    case = tomllib.loads(template("demo")) | given
    if "lift" in given:
        del case["engine"]
    if given.get("follower", {}).get("kind") == "flat":
        del case["roller"]
    assert with_new_keys(case) == case  # today's names: case_of reads those of version 0.1 too
    assert case_of(case)


def test_error_lines_are_the_real_ones(tmp_path: Path) -> None:
    (example,) = blocks("text")
    changes = (('rate = "24.2 kN/m"', 'rate = "-24.2 kN/m"'), ('radius = "16 mm"', 'radus = "1"'))
    for (old, new), line in zip(changes, example.splitlines(), strict=True):
        text = template("demo").replace(old, new)
        (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
        result = shell("camwright run bad.toml --out run", tmp_path)
        assert (result.returncode, result.stderr.rstrip()) == (2, line)
        assert not (tmp_path / "run").exists()
