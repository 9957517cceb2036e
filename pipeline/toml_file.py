"""A small TOML file of the user's, read with care."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from geometry.errors import InputError


def read_toml(path: Path, field: str, most: int) -> dict[str, Any]:
    """The tables of a file of at most `most` bytes.

    Raises
    ------
    InputError
        Naming `field`, for a file that is larger, cannot be read, is nested too deeply or is no
        TOML in UTF-8.
    """
    try:
        if path.stat().st_size > most:
            raise InputError(field, "larger", f"at most {most // 1024} KiB")
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except RecursionError:
        raise InputError(field, "nested too deeply", "a few tables deep") from None
    except (OSError, ValueError) as error:  # UnicodeDecodeError and TOMLDecodeError alike
        reason = " ".join(str(error).split())
        raise InputError(field, reason, "a readable TOML file") from None
