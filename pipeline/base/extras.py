"""Optional dependencies of the package: its extras."""

from __future__ import annotations

from importlib.util import find_spec

from camwright.geometry.errors import ResultError

EXTRAS = {"notebook": ("pandas",), "study": ("SALib", "dask", "distributed", "pyarrow")}
"""Libraries by the extra that installs them, without which something is refused."""


def require_extra(extra: str, purpose: str) -> None:
    """Refuse a purpose whose optional libraries are not installed; none is imported.

    Raises
    ------
    ResultError
        Naming the missing libraries and the command that installs them.
    """
    missing = [library for library in EXTRAS[extra] if find_spec(library) is None]
    if missing:
        raise ResultError(
            f'{purpose} needs {", ".join(missing)}; install with: pip install "camwright[{extra}]"'
        )
