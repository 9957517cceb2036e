"""Lay out the package for type checkers: `.typing/camwright`, by links to its sources.

A type checker looks for a package in one folder; here the packages lie at the top of the checkout.
`make setup` and `make lint` run this; mypy and an editor look into `.typing`. A file system without
links gets copies, made anew each time.
"""

from __future__ import annotations

import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("geometry", "meshes", "pipeline", "reports")


def lay_out(tree: Path) -> None:
    """Make the package in a folder, which is emptied first."""
    shutil.rmtree(tree, ignore_errors=True)
    tree.mkdir(parents=True)
    for source in (*(ROOT / name for name in PACKAGES), *(ROOT / "src" / "camwright").glob("*.*")):
        try:
            (tree / source.name).symlink_to(source)
        except OSError:
            (shutil.copytree if source.is_dir() else shutil.copy2)(source, tree / source.name)


if __name__ == "__main__":
    lay_out(ROOT / ".typing" / "camwright")
