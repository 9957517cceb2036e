"""The recorded view of a turn, ``fields/turn.npz``: what the scene shows of the bodies."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError

FILE = Path("fields") / "turn.npz"
_NAMES = (
    *("position", "cam_angle_deg", "cam_mm", "follower_mm", "follower_origin_mm"),
    "follower_turn_deg",
)


@dataclass(frozen=True, eq=False)
class TurnView:
    """Outlines and positions of both bodies at f cam angles, of one load case.

    position (f,) rows of the load case's turn; angle (f,) deg; contour and bore (2, stations) mm
    in the cam's frame; follower (2, n) mm, points of its body in its own frame; origin (f, 2) mm
    and turn (f,) rad place that frame in the cam's.
    """

    load_case: str
    position: Any
    angle: Array
    contour: Array
    bore: Array
    follower: Array
    origin: Array
    turn: Array

    @property
    def is_roller(self) -> bool:
        """Whether the follower's body has a hole in its middle, as a roller has."""
        return bool(np.hypot(*self.follower).min() > 0.05 * np.hypot(*self.follower).max())

    @property
    def to_lab(self) -> Array:
        """Turn (f,), rad, from the cam's frame to one in which the follower moves along +y."""
        return 0.5 * np.pi - np.radians(self.angle)

    def lab_origin(self) -> Array:
        """Origin (2, f), mm, of the follower's frame where the follower moves along +y."""
        cosine, sine = np.cos(self.to_lab), np.sin(self.to_lab)
        x, y = self.origin.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y])

    def arc(self) -> Array:
        """Length of the contour, mm, from the first angle to each (f,), straight between points."""
        steps = np.hypot(*np.diff(self.contour, axis=1, append=self.contour[:, :1]))
        along = np.r_[0.0, np.cumsum(steps)]
        return np.interp(self.angle, np.linspace(0.0, 360.0, along.size), along)


def read_turn_view(folder: Path) -> TurnView:
    """The view of the run in a folder.

    Raises
    ------
    ResultError
        If the run has none, such as one of an earlier version, or it cannot be read.
    """
    path = folder / FILE
    if not path.is_file():
        raise ResultError(f"{path}: no such file; run the case again to have it")
    try:
        with np.load(path, allow_pickle=False) as entry:
            found = {name: entry[name] for name in (*_NAMES, "load_case")}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise ResultError(f"{path}: {error}") from None
    return TurnView(
        str(found["load_case"]), found["position"], found["cam_angle_deg"],
        found["cam_mm"][:, :, 0], found["cam_mm"][:, :, -1], found["follower_mm"],
        found["follower_origin_mm"], np.radians(found["follower_turn_deg"]),
    )  # fmt: skip
