"""The folder a case lies in: nothing outside of it is read."""

from __future__ import annotations

from pathlib import Path

from geometry.errors import InputError


def inside(folder: Path, name: str, field: str) -> Path:
    """The file `name` under `folder`; refuses every way out of it, links too.

    Raises
    ------
    InputError
        If the name leaves the folder or cannot be one.
    """
    limit = "a relative path that stays in the case file's folder"
    path = Path(name)
    if path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name:
        raise InputError(field, name, limit)
    try:
        resolved = (folder / path).resolve()
    except (OSError, ValueError, RuntimeError):
        raise InputError(field, name, "a readable file") from None
    if not resolved.is_relative_to(folder.resolve()):
        raise InputError(field, name, limit)
    return resolved
