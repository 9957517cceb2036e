"""Source archive and wheel, built without a network."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("geometry", "meshes", "pipeline", "reports")
"""Packages at the top of the checkout."""


def build(kind: str, source: Path, out: Path) -> Path:
    """Build a source archive ("sdist") or a wheel in an empty or new folder."""
    command = [sys.executable, "-m", "hatchling", "build", "--target", kind, "--directory", out]
    subprocess.run(command, cwd=source, check=True, capture_output=True)
    (built,) = out.iterdir()
    return built
