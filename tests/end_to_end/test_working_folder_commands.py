"""The commands that README and tutorial do not run, in a folder of traps.

`test_docs` runs those of README and tutorial in one.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from trap_folder import Traps

from camwright.pipeline.commands.command_tree import TREE

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 60.0
"""After which a command is ended: its libraries are then imported, its processes started."""
COMMANDS = {
    "new table --kind table": 0,
    "new rig --kind eccentric": 0,
    "run rig.toml --out run --depth cycle --positions 36 --jobs 2": 0,
    "report run": 0,
    "design remedies rig.toml": 3,
    "contact deck run --angle 10 --out deck.inp": 0,
    "inspect run measured.csv --jobs 2": 0,
    "design crown rig.toml --out crown": 0,
    "design smoother table.toml --out compare": 0,
    "design parts {cases}/gx120.toml --out redesign --jobs 2": 0,
    "design machine table_torque.csv --speed 1500rpm --out design.toml": 0,
}


@pytest.mark.slow
def test_the_other_commands_import_none_of_the_folder(tmp_path: Path) -> None:
    traps = Traps.set_in(tmp_path / "here", tmp_path / "marks")
    program = str(Path(sys.executable).parent / "camwright")
    environment = os.environ | {"CAMWRIGHT_CACHE": str(tmp_path / "cache")}
    sprung, codes = {}, {}
    for line, expected in COMMANDS.items():
        words = line.format(cases=ROOT / "cases").split()
        if words[0] == "inspect":
            rows = (traps.folder / "run/trial_1/3_contour.csv").read_text().splitlines()[1:]
            points = [",".join(row.split(",")[3:5]) for row in rows]
            (traps.folder / "measured.csv").write_text("\n".join(["x_mm,y_mm", *points, ""]))
        with subprocess.Popen(
            [program, *words], cwd=traps.folder, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, env=environment,
        ) as running:  # fmt: skip
            try:
                # the commands after a run read it
                code = running.wait(timeout=None if words[0] == "run" else SECONDS)
            except subprocess.TimeoutExpired:
                running.terminate()
                code = running.wait(timeout=60)
        if code not in (expected, 128 + signal.SIGTERM):
            codes[line] = code
        sprung[line] = traps.sprung()
    assert {line: names for line, names in sprung.items() if names} == {}
    assert codes == {}


def test_every_command_is_run_in_a_folder_of_traps() -> None:
    names = ("tutorial.md", "tutorials/size.md", "tutorials/contact.md", "tutorials/sign.md")
    files = [ROOT / "README.md", *(ROOT / "docs" / name for name in names)]
    pages = [file.read_text(encoding="utf-8") for file in files]
    lines = [line for page in pages for line in re.findall(r"^camwright (.+)$", page, re.MULTILINE)]
    words = [line.split() for line in (*lines, *COMMANDS)]
    assert set(TREE) <= {" ".join(each[:count]) for each in words for count in (1, 2)}
