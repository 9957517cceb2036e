"""The strip chart of the limits: which of them binds at which angle of the cam."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.figures import AngleFigure, Curve, Figure, LimitLine, Panel
from camwright.reports.report_tables import words

BINDS = 0.997  # share in use from which a limit binds: the synthesis keeps a little in hand
_SHOWN, _MOST = 0.5, 6  # share from which a limit is shown, and how many of them


def strip_figures(
    limits: Mapping[str, Array] | None, gear_ratio: float, *, strokes: bool
) -> tuple[Figure, ...]:
    """A strip for each limit that is used by half or more; none where nothing was recorded.

    Parameters
    ----------
    limits : mapping or None   columns of 2_limits.csv, the most used first
    strokes : bool             whether the strokes of an engine are named
    """
    if limits is None or "cam_angle_deg" not in limits:
        return ()
    uses = {name: use for name, use in limits.items() if name != "cam_angle_deg"}
    shown = [name for name, use in uses.items() if use.size and float(np.max(use)) >= _SHOWN]
    panels = tuple(_strip(name, uses[name]) for name in shown[:_MOST])
    if not panels:
        return ()
    return (
        AngleFigure(
            "limits", "Which limit binds where",
            "Share in use of each limit as the synthesis sees it, the most used first; thick where "
            "it binds and ripple is given up for it. A limit on a mean of the turn is level.",
            gear_ratio * limits["cam_angle_deg"], panels, gear_ratio, strokes,
        ),
    )  # fmt: skip


def _strip(name: str, use: Array) -> Panel:
    """Share in use from nothing to all, and again where it binds."""
    tight = np.where(use >= BINDS, use, np.nan)
    curves = (Curve("share in use", np.clip(use, 0.0, None), "blue"),
              Curve("binds", tight, "vermillion"))  # fmt: skip
    return Panel(words(name), "", curves, (LimitLine(1.0, ""),), height=0.62, span=(0.0, 1.3))
