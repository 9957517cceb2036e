"""The recorded turn of a synthetic run, from closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import report_fixture

from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.element_size import ElementSize

FRAMES = 6


def add_turn(folder: Path, positions: int, load_case: str = "idle") -> Path:
    """Write ``fields/turn.npz`` into a run folder of `report_fixture`, at `FRAMES` angles."""
    t = report_fixture.turn(positions)
    g = report_fixture.shape(t)
    shown = np.arange(0, positions, positions // FRAMES)
    outer = 1e3 * g["contour"]
    inner = 1e3 * report_fixture.BORE * outer / np.hypot(*outer)
    roller = roller_mesh(
        report_fixture.ROLLER, report_fixture.HUB, 0.5 * np.pi, ElementSize(far_size=2e-3)
    )
    normal = g["normal"][:, shown]
    facing = np.arctan2(-normal[1], -normal[0]) - 0.5 * np.pi
    np.savez(
        folder / "fields" / "turn.npz", load_case=np.array(load_case), cycle_row=shown,
        cam_angle_deg=np.degrees(t["theta"])[shown],
        cam_outline_mm=np.stack([outer, inner], axis=-1),
        follower_nodes_mm=1e3 * roller.points, follower_origin_mm=1e3 * g["pitch"][:, shown].T,
        follower_rotation_deg=np.degrees(facing),
    )  # fmt: skip
    return folder
