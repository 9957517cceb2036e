"""Processes of runs ended at drawn moments, and resumed to the files of an undisturbed run."""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 600.0
REPORT = "report"
"""Last stage of a run with a page: page, record, move to the final path."""

HOW = [(number, group) for number in (signal.SIGKILL, signal.SIGTERM) for group in (True, False)]


def started(folder: Path, out: str, *options: str) -> subprocess.Popen[str]:
    """A run in a group of processes of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "camwright.pipeline.cli", "run", "flat.toml", "--out", out,
         "--fields", "worst", "--resume", *options],
        cwd=folder, env=os.environ | {"CAMWRIGHT_CACHE": str(folder / "cache")},
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


def contents(run: Path) -> dict[str, object]:
    """Every file of a run without its times and the hashes of the two files that hold them."""
    files: dict[str, object] = {}
    for path in run.rglob("*"):
        if path.is_file():
            files[path.relative_to(run).as_posix()] = path.read_bytes()
    summary, record = (json.loads(files[name]) for name in ("run.json", "signoff.json"))
    del summary["timings_s"], summary["started"]
    for name in ("run.json", "8_report.html"):
        record["files"].pop(name, None)
    if "8_report.html" in files:
        page = files["8_report.html"]
        assert isinstance(page, bytes)
        files["8_report.html"] = re.sub(r"<bdi>[\d.e-]+\ss</bdi>", "", page.decode())
    return files | {"run.json": summary, "signoff.json": record}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A published case of a flat face, small."""
    text = (ROOT / "cases" / "papers" / "petrescu_c.toml").read_text(encoding="utf-8")
    text += "\n[solver]\npositions = 36\ncertificate_positions = 1\n"
    (tmp_path / "flat.toml").write_text(text, encoding="utf-8")
    return tmp_path


def stages_of(process: subprocess.Popen[str]) -> list[str]:
    _, errors = process.communicate(timeout=SECONDS)
    assert process.returncode == 0, errors
    return errors.splitlines()


def ended(process: subprocess.Popen[str], line: int, after: float, how: int) -> bool:
    """End a process `after` seconds after a line on its error stream; False if it was faster."""
    number, group = HOW[how]
    assert process.stderr is not None
    for _ in range(line):
        process.stderr.readline()
    time.sleep(after)
    workers = []
    if process.poll() is None:
        workers = psutil.Process(process.pid).children(recursive=True)
        (os.killpg if group else os.kill)(process.pid, number)
    errors = process.communicate(timeout=SECONDS)[1]
    assert not psutil.wait_procs(workers, timeout=30)[1], "processes are left"
    if process.returncode == 0:
        return False
    if number == signal.SIGKILL:
        assert process.returncode == -number
    else:  # whatever library has been used until then
        assert process.returncode == 128 + number, errors
        assert "interrupted; run the command again with --resume" in errors
    assert "Traceback" not in errors
    return True


def resumed(folder: Path, seed: int, kills: int, options: tuple[str, ...]) -> int:
    """Resume a run until it was ended `kills` times; returns how often in its last stage."""
    stages = stages_of(started(folder, "whole", *options))
    whole = contents(folder / "whole")
    draw = random.Random(seed)
    count = last = 0
    while count < kills:
        finishing = stages[-1] == REPORT and count % 3 == 2
        line = len(stages) if finishing else draw.randint(1, len(stages) - 1)
        if not ended(started(folder, "run", *options), line, draw.uniform(0, 0.7), count % 4):
            assert contents(folder / "run") == whole
            shutil.rmtree(folder / "run")
            continue
        count, last = count + 1, last + finishing
    stages_of(started(folder, "run", *options))
    assert contents(folder / "run") == whole
    left = sorted(entry.name for entry in folder.iterdir())
    assert left == ["cache", "flat.toml", "run", "whole"]
    return last


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "kills", "last", "options"),
    [
        (1, 20, 6, ("--depth", "cycle", "--jobs", "1")),
        (2, 4, 0, ("--jobs", "2", "--no-report")),
    ],
    ids=["report", "certificate"],
)
def test_runs_resume_from_seeded_kills(
    folder: Path, seed: int, kills: int, last: int, options: tuple[str, ...]
) -> None:
    """24 in all, of the group and of the parent alone, 6 of them in the stage of the report."""
    assert resumed(folder, seed, kills, options) == last
