"""Pages of docs/tutorials/: every file, command and snippet in its order, each page by itself."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "tutorials"
PAGES = sorted(FOLDER.glob("*.md"))
QUICK = ("contact",)
"""Pages of a second; the others are executed by `make verify`."""
BEFORE = {
    "crown": ("camwright new demo",),
    "python": ("camwright new demo", "camwright run demo.toml --out runs/demo --positions 36"),
}
"""Commands of the first ten minutes on whose files a page rests."""
WRITES = {
    "crown": "demo_crown/crown.toml",
    "size": "feed_sized.png",
    "torque": "runs/mine/run.json",
}
"""A file that a page says it writes."""
SECONDS = 540.0
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]\d+)?")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Block(NamedTuple):
    """A block of a page, with the paragraph before it."""

    before: str
    language: str
    text: str


def blocks(text: str) -> Iterator[Block]:
    for match in BLOCK.finditer(text):
        before = text[: match.start()].rstrip("\n").rpartition("\n\n")[2]
        yield Block(before, match[1], match[2])


def run(command: list[str], folder: Path) -> str:
    """Output of a command that ends without an error, whatever its verdict."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    private = {"PATH": path, "XDG_CONFIG_HOME": str(folder / "config")}
    result = subprocess.run(
        command, cwd=folder, env={**os.environ, **private}, capture_output=True, text=True,
        check=False, timeout=SECONDS,
    )  # fmt: skip
    allowed = (0, 1, 3) if command[:2] == ["camwright", "check"] else (0,)
    assert result.returncode in allowed, f"{command}: {result.stderr}"
    return result.stdout


def assert_shown(lines: list[str], printed: str) -> None:
    """Each line stands in the output, but for its spaces and 1 % of its numbers."""
    whole = " ".join(printed.split())
    for line in lines:
        between = [re.escape(words) for words in NUMBER.split(line)]
        match = re.search(f"({NUMBER.pattern})".join(between), whole)
        assert match, f"{line!r} is not in: {whole}"
        stated = [float(each) for each in NUMBER.findall(line)]
        np.testing.assert_allclose([float(each) for each in match.groups()], stated, rtol=1e-2)


def executed(block: Block, folder: Path) -> None:
    file = re.search(r"[Ss]ave this as\s`([\w.]+)`", block.before)
    if file is not None:
        (folder / file[1]).write_text(block.text, encoding="utf-8")
    elif block.language == "bash":
        for line in block.text.splitlines():
            run(shlex.split(line), folder)
    elif block.language == "console":
        prompt, *lines = block.text.splitlines()
        assert_shown(lines, run(shlex.split(prompt.removeprefix("$ ")), folder))
    elif block.language == "python":
        assert run([sys.executable, "-c", block.text], folder).strip()


@pytest.mark.parametrize(
    "page",
    [pytest.param(page, id=page.stem, marks=() if page.stem in QUICK else pytest.mark.slow)
     for page in PAGES],
)  # fmt: skip
def test_a_tutorial_runs_from_an_empty_folder(page: Path, tmp_path: Path) -> None:
    for command in BEFORE.get(page.stem, ()):
        run(shlex.split(command), tmp_path)
    every = list(blocks(page.read_text(encoding="utf-8")))
    snippets = [each for each in every if each.language == "python"]
    if snippets:  # of a page one program, at its end
        every = [each for each in every if each.language != "python"]
        every.append(Block("", "python", "\n".join(each.text for each in snippets)))
    for block in every:
        executed(block, tmp_path)
    assert (tmp_path / WRITES.get(page.stem, "")).exists()
