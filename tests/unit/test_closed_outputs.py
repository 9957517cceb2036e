"""Closed outputs: the work and the exit code are the same whether or not anyone reads."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from small_run import write_run

CAMWRIGHT = Path(sys.executable).parent / "camwright"
CLOSINGS = {
    "reader of the output": "{command} | true",
    "output": "{command} >&-",
    "reader of the errors": "{command} 2> >(true) >/dev/null",
    "errors": "{command} 2>&- >/dev/null",
    "output and errors": "{command} >&- 2>&-",
    "all": "{command} >&- 2>&- <&-",
}
OTHERS = ("output", "reader of the errors", "errors", "output and errors")


def code_of(line: str, folder: Path) -> int:
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", line], cwd=folder, capture_output=True, check=False
    ).returncode


@pytest.mark.parametrize(
    "closing",
    [
        "reader of the output",
        "all",
        *(pytest.param(name, marks=pytest.mark.slow) for name in OTHERS),
    ],
)
def test_the_exit_code_is_that_of_the_command(tmp_path: Path, closing: str) -> None:
    write_run(tmp_path / "passed", status="pass")
    for arguments, code in (("check passed --all", 0), ("check none", 2)):
        line = CLOSINGS[closing].format(command=f"{CAMWRIGHT} {arguments}")
        assert code_of(line, tmp_path) == code, line


def test_every_command_ends_as_if_its_output_was_read() -> None:
    """The help of every command into a pipe that nobody reads, in one process."""
    script = (
        "import os, sys\n"
        "from camwright.pipeline import cli\n"
        "codes = {}\n"
        "for name in cli.TREE:\n"
        "    reader, writer = os.pipe()\n"
        "    os.close(reader)\n"
        "    os.dup2(writer, 1)\n"
        "    sys.stdout, sys.argv = sys.__stdout__, ['camwright', *name.split(), '--help']\n"
        "    try:\n"
        "        cli.main()\n"
        "    except SystemExit as leaving:\n"
        "        codes[name] = leaving.code\n"
        "sys.stderr.write(repr(codes))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    codes = ast.literal_eval(done.stderr)
    assert codes == dict.fromkeys(codes, 0)
    assert len(codes) == 18


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no full device")
def test_an_output_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    """Long and short: written during the command, and as it ends."""
    for arguments in ("explain --schema run", "--version"):
        line = f"{CAMWRIGHT} {arguments} >/dev/full 2>errors"
        assert code_of(line, tmp_path) == 2
        words = "camwright: standard output: No space left on device\n"
        assert (tmp_path / "errors").read_text() == words
    assert code_of(f"{CAMWRIGHT} check none 2>/dev/full", tmp_path) == 2


def test_a_closed_output_is_no_file_of_the_command(tmp_path: Path) -> None:
    """The next file that is opened would have its number, and receive what is printed."""
    script = (
        "import os\n"
        "from camwright.pipeline.commands.output_streams import open_streams\n"
        "open_streams()\n"
        "with open('file', 'w') as file:\n"
        "    os.write(1, b'printed'); os.write(2, b'told')\n"
        "    os.system('echo printed')\n"
    )
    (tmp_path / "script.py").write_text(script)
    assert code_of(f"{sys.executable} script.py >&- 2>&- <&-", tmp_path) == 0
    assert (tmp_path / "file").read_bytes() == b""
