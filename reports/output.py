"""Files of a report: each there whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

FIGURES = "figures"
"""Folder of the pictures, in a run folder."""


def write_whole(path: Path, content: bytes) -> Path:
    """Write a file whole or not at all; folders it lies in are made."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=".", suffix=".tmp", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    finally:
        Path(temporary).unlink(missing_ok=True)
    return path
