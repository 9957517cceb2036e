"""The view of a turn, its patch and its pressures for a synthetic run, from closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import report_fixture
from scipy.spatial import Delaunay

from camwright.meshes.body_mesh import BodyMesh, roller_mesh
from camwright.meshes.element_size import Sizing
from camwright.meshes.mesh_files import write_pvd, write_vtu

FRAMES = 6
KNOTS = np.linspace(-1.2, 1.2, 25)


def add_turn(folder: Path, positions: int, load_case: str = "idle") -> Path:
    """Write what a film needs into a run folder of `report_fixture`, at `FRAMES` angles."""
    t = report_fixture.turn(positions)
    g = report_fixture.shape(t)
    cycle = report_fixture.cycle_columns(t, g)
    shown = np.arange(0, positions, positions // FRAMES)
    angle = np.degrees(t["theta"])[shown]
    half_width = 1e-3 * cycle["half_width_hertz_mm"]
    _write_view(folder / "fields" / "turn.npz", load_case, shown, angle, g)
    entries = []
    for k, degrees in zip(shown, angle, strict=True):
        name = f"patch_{k}.vtu"
        _write_patch(folder / "fields" / name, g, int(k), half_width[k], degrees)
        entries.append((degrees, name))
    write_pvd(folder / "fields" / "patch_cycle.pvd", entries)
    np.savez(
        folder / "trial_2" / "5_pressure.npz",
        load_case=np.array([load_case] * positions), cam_angle_deg=np.degrees(t["theta"]),
        xi_mm=1e3 * half_width[:, None] * KNOTS,
        pressure_MPa=cycle["p0_fe_MPa"][:, None] * np.sqrt(np.maximum(1 - KNOTS**2, 0.0)),
    )  # fmt: skip
    return folder


def _write_view(path: Path, load_case: str, shown, angle, g) -> None:
    outer = 1e3 * g["contour"]
    inner = 1e3 * report_fixture.BORE * outer / np.hypot(*outer)
    share = np.linspace(0.0, 1.0, 7) ** 2
    cam = outer[:, :, None] + (inner - outer)[:, :, None] * share
    roller = roller_mesh(
        report_fixture.ROLLER, report_fixture.HUB, 0.5 * np.pi, Sizing(far_size=2e-3)
    )
    normal = g["normal"][:, shown]
    under = outer[:, shown]
    near = np.hypot(*(cam[:, None] - under[:, :, None, None]))
    facing = np.arctan2(-normal[1], -normal[0]) - 0.5 * np.pi
    np.savez(
        path, load_case=np.array(load_case), position=shown, cam_angle_deg=angle,
        cam_mm=cam, cam_MPa=(300.0 / (1.0 + near)).astype(np.float16),
        follower_mm=1e3 * roller.points, follower_triangles=roller.triangles,
        follower_origin_mm=1e3 * g["pitch"][:, shown].T, follower_turn_deg=np.degrees(facing),
        follower_MPa=np.tile(50.0 + 1e3 * roller.points[1], (shown.size, 1)).astype(np.float16),
    )  # fmt: skip


def _write_patch(path: Path, g, k: int, half_width: float, degrees: float) -> None:
    polar = [(r, a) for r in np.linspace(0, 1.6, 9) for a in np.linspace(-np.pi, 0, 17)]
    places = np.unique([(r * np.cos(a), r * np.sin(a)) for r, a in polar], axis=0)
    corners = Delaunay(places).simplices
    a, b, c = (places[corners[:, i]] for i in range(3))
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    corners[twice < 0] = corners[twice < 0][:, [0, 2, 1]]
    corners = corners[np.abs(twice) > 1e-9]
    pairs = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, inverse = np.unique(pairs, axis=0, return_inverse=True)
    used, renumbered = np.unique(corners, return_inverse=True)
    whole = np.concatenate([places[used], places[edges].mean(axis=1)])
    triangles = np.hstack([renumbered.reshape(-1, 3), used.size + inverse.reshape(-1, 3)])
    normal, point = g["normal"][:, k], g["contour"][:, k]
    tangent = np.array([normal[1], -normal[0]])
    points = point[:, None] + half_width * (
        np.outer(tangent, whole[:, 0]) + np.outer(normal, whole[:, 1])
    )
    notes = {
        "cam_angle_deg": degrees, "half_width_hertz_mm": 1e3 * half_width,
        "contact_x_mm": 1e3 * point[0], "contact_y_mm": 1e3 * point[1],
        "normal_x": normal[0], "normal_y": normal[1],
    }  # fmt: skip
    mises = 600.0 * np.exp(-np.hypot(whole[:, 0], whole[:, 1] + 0.7))
    mesh = BodyMesh(points, triangles.T, {})
    write_vtu(path, {"cam": mesh}, {"cam": {"von_mises_MPa": mises}}, notes)
