"""A keyway without a case, and the area of a meshed body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.meshes.body_mesh import BodyMesh


@dataclass(frozen=True)
class Keyway:
    """Width, depth beyond the bore radius and fillet, m; angle, rad."""

    width: float
    depth: float
    angle: float = 0.0
    fillet: float = 0.0


def mesh_area(mesh: BodyMesh) -> float:
    """Area within the curved boundary, m^2.

    The Jacobian determinant is quadratic, so that the mean over the three edge middles is exact.
    """
    jacobians = (mesh.jacobian(*at) for at in ((0.5, 0.0), (0.5, 0.5), (0.0, 0.5)))
    return float(sum(np.linalg.det(j).sum() for j in jacobians) / 6.0)
