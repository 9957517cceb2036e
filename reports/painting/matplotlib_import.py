"""The first import of matplotlib, which reads a file of settings from the working folder."""

from __future__ import annotations

import sys
from contextlib import chdir, suppress
from pathlib import Path

TEMPLATES = Path(__file__).parents[1] / "templates"  # with an empty matplotlibrc


def import_matplotlib() -> None:
    """Import matplotlib for the first time, also where it cannot read a matplotlibrc.

    matplotlib reads that file when it is imported, first in the working folder, and fails if it is
    not text.
    """
    if "matplotlib" in sys.modules:
        return
    with chdir(TEMPLATES):
        import matplotlib as mpl
    with suppress(ValueError, OSError, RuntimeError):  # for other figures of this process
        mpl.rcParams.update(mpl.rc_params())
