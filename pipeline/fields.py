"""Fields of a run for analysts: VTU files of the contact and of the cam over the turn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from geometry.arrays import Array
from meshes.files import write_pvd, write_vtu
from pipeline.contact import stress
from pipeline.contact.elastic_body import ElasticBody, StressRecovery
from pipeline.contact.pair import ContactPair, CycleBodies
from pipeline.contact.pair_certificate import SolvedPair
from pipeline.cycle import Cycle

_MILLIMETRE, _MEGAPASCAL = 1e-3, 1e6
UNITS = {"length": "mm", "stress": "MPa", "force": "N"}


def write_contact(path: Path, solved: SolvedPair, name: str) -> None:
    """Both bodies at one angle, as solved: displacement, stress, in the cam's frame.

    `name` is that of the follower's body in the file.
    """
    sides = zip(("cam", name), solved.sides, solved.solution.displacements, strict=True)
    # The follower was held still; what it has come nearer is its rigid motion.
    rigid = {"cam": np.zeros(2), name: -solved.solution.approach * solved.frame.normal}
    data = {
        body: _point_data(side.body, moved + rigid[body][:, None], _recovered(side.body, moved))
        for body, side, moved in sides
    }
    write_vtu(
        path,
        {"cam": solved.cam, name: solved.follower},
        data,
        {
            "cam_angle_deg": float(np.degrees(solved.theta)),
            "half_width_mm": solved.solution.half_width / _MILLIMETRE,
            "peak_pressure_MPa": solved.solution.p0 / _MEGAPASCAL,
            "contact_x_mm": float(solved.frame.origin[0]) / _MILLIMETRE,
            "contact_y_mm": float(solved.frame.origin[1]) / _MILLIMETRE,
            "normal_x": float(solved.frame.normal[0]),
            "normal_y": float(solved.frame.normal[1]),
        },
    )


def write_turn(
    folder: Path,
    pair: ContactPair,
    bodies: CycleBodies,
    cycle: Cycle,
    step_deg: float,
    tell: Callable[[int, int], None],
) -> Path:
    """The loaded cam every `step_deg` of the turn, as ``cam_cycle.pvd`` with its pieces.

    Under the follower the stress is that of the contact's ellipse in the half-plane, elsewhere
    the finite-element correction joins it; the mesh is that of the body, too coarse to show
    the contact itself.
    """
    stride = max(1, round(np.radians(step_deg) / (cycle.theta[1] - cycle.theta[0])))
    indices = np.arange(0, cycle.theta.size, stride)
    cam = bodies.cam
    entries = []
    for count, k in enumerate(indices):
        theta = cycle.theta[k : k + 1]
        load = float(cycle.contact.line_load[k])
        moved, stressed = cam.field(
            pair.contour.points(theta),
            pair.contour.normal(theta),
            load,
            float(cycle.contact.half_width[k]),
        )
        angle = float(np.degrees(theta[0]))
        name = f"cam_{round(1000 * angle):06d}.vtu"
        write_vtu(
            folder / name,
            cam.body.mesh,
            _point_data(cam.body, moved, stressed),
            {"cam_angle_deg": angle, "line_load_N_per_mm": load * _MILLIMETRE},
        )
        entries.append((angle, name))
        tell(count + 1, indices.size)
    index = folder / "cam_cycle.pvd"
    write_pvd(index, entries)
    return index


def _recovered(body: ElasticBody, displacement: Array) -> Array:
    recovery = StressRecovery(body, np.arange(body.mesh.triangles.shape[1]))
    nodal = np.zeros((3, body.mesh.points.shape[1]))
    nodal[:, recovery.nodes] = recovery(displacement[:, :, None])[:, :, 0]
    return nodal


def _point_data(body: ElasticBody, displacement: Array, nodal: Array) -> dict[str, Array]:
    shown = nodal / _MEGAPASCAL
    return {
        "displacement_mm": displacement / _MILLIMETRE,
        "von_mises_MPa": stress.von_mises(shown, body.poisson),
        "tau_max_MPa": stress.shear_in_plane(shown),
        "stress_xx_MPa": shown[0],
        "stress_yy_MPa": shown[1],
        "stress_xy_MPa": shown[2],
    }
