"""A folder in which every library has a file of its name that records its import."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

_TRAP = "open({place!r}, 'w').close()\nraise ImportError('imported from the folder of traps')\n"


@cache
def libraries() -> frozenset[str]:
    """Names of the modules that Python and what is installed here can import, but our own."""
    known = {*sys.stdlib_module_names, *packages_distributions()}
    known |= {name.partition(".")[0] for name in sys.modules}
    return frozenset(name for name in known - {"camwright", "__main__"} if name.isidentifier())


def before_a_module() -> set[str]:
    """Names that `python -m` imports before the module that it runs."""
    line = "import runpy, sys; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-P", "-c", line], capture_output=True, text=True, check=True
    )
    return {name.partition(".")[0] for name in done.stdout.split()}


@dataclass(frozen=True)
class Traps:
    """Files in `folder` that write a marker into `marks` when they are imported."""

    folder: Path
    marks: Path

    @classmethod
    def set_in(cls, folder: Path, marks: Path) -> Traps:
        folder.mkdir(exist_ok=True)
        marks.mkdir(exist_ok=True)
        for name in libraries():
            (folder / f"{name}.py").write_text(_TRAP.format(place=str(marks / name)))
        return cls(folder, marks)

    def sprung(self) -> list[str]:
        """Names imported from the folder since the last call."""
        marks = sorted(self.marks.iterdir())
        for mark in marks:
            mark.unlink()
        return [mark.name for mark in marks]

    def remove(self) -> None:
        for name in libraries():
            (self.folder / f"{name}.py").unlink()
