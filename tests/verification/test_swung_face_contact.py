"""Contact of faces and of a roller on an arm by finite elements: Hertz, meshes, certificate."""

import numpy as np
import pytest
from cam_parts import mesh_area

from camwright.geometry.arm_face import (
    ArmFaceContour,
    ArmFacePath,
    CurvedFaceContour,
    CurvedFacePath,
)
from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.meshes.body_mesh import face_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.contact.certificate import EDGES, certificate_point, mesh_figures
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody, RollerBody
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history

STEEL = Elastic(210e9, 0.3)
MODULUS = 0.5 * 210e9 / (1.0 - 0.3**2)
WIDTH, FORCE = 0.02, 1000.0
ROLLER = 0.012
BOWED = {"flat": 0.0, "curved": 1.0 / 0.025, "roller": 1.0 / ROLLER}  # 1/m


def pair(kind, sense=1.0):
    """A cam of 40 mm with a swing of 8 deg, under a face on a block 20 mm thick or a roller."""
    theta = uniform_turn(720)
    lift = Lift(theta, 0.08 * np.radians(4.0) * (1.0 - np.cos(theta)))
    arm, radius = Arm(0.09, 0.08, sense), None
    if kind == "roller":
        contour = ArmContour(ArmPath(lift, arm, float(arm.angle(0.04 + ROLLER))), ROLLER)
        return ContactPair(contour, WIDTH, 0.003, None, STEEL, RollerBody(ROLLER, 0.002, STEEL))
    if kind == "flat":
        start = float(arm.face_angle(0.04, 0.006))
        contour = ArmFaceContour(ArmFacePath(lift, arm, start, 0.006))
    else:
        radius = 0.025
        contour = CurvedFaceContour.of(CurvedFacePath(lift, arm, float(arm.angle(0.065)), radius))
    width = 0.045 if kind == "flat" else 0.03
    body = FaceBody(width, 0.02, width, STEEL, radius)
    return ContactPair(contour, WIDTH, 0.003, None, STEEL, body)


BOTH = pytest.mark.parametrize("kind", ["flat", "curved"])


@pytest.mark.parametrize(("kind", "sense"), [
    ("flat", 1.0), ("curved", 1.0), ("roller", 1.0), ("roller", -1.0),
])  # fmt: skip
def test_the_pressure_is_that_of_hertz(kind, sense):
    """Half-widths of a hundredth of the bodies: p0 = sqrt(P' E*/(pi R)) within 0.1 %."""
    one, theta = pair(kind, sense), np.array([0.0, 1.2, 4.0])
    force = np.full(3, FORCE)
    solved = two_scale_history(one, CycleBodies.meshed(one), theta, force)
    step = 1e-3
    a, b, c = (one.contour.points(theta + k * step) for k in (-1.0, 0.0, 1.0))
    u, v, w = b - a, c - b, c - a
    bend = 2.0 * (u[0] * v[1] - u[1] * v[0]) / (np.hypot(*u) * np.hypot(*v) * np.hypot(*w))
    radius = 1.0 / (bend + BOWED[kind])
    peak = np.sqrt(FORCE / WIDTH * MODULUS / (np.pi * radius))
    np.testing.assert_allclose(solved.p0, peak, rtol=1e-3)
    assert solved.residual_equilibrium.max() < 1e-9


@BOTH
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_meshed_face_touches_the_cam(kind, sense):
    """Its surface meets the contour at the contact, in the frame of the cam, and is not within."""
    one = pair(kind, sense)
    rim = one.contour.polygon(20_000)
    angle = np.arctan2(rim[1], rim[0])
    order = np.argsort(angle)
    for theta in (0.0, 1.2, 4.0):
        sizing = ElementSize.from_half_width(5e-5, far_size=4e-3)
        mesh = one.follower.mesh_at(one.contour, theta, sizing)
        top = mesh.points[:, mesh.boundary_nodes("top")]
        polar = np.arctan2(top[1], top[0])
        gap = np.hypot(*top) - np.interp(polar, angle[order], np.hypot(*rim)[order])
        assert gap.min() == pytest.approx(0.0, abs=1e-7)
        nearest = top[:, int(np.argmin(gap))]
        assert np.hypot(*(nearest - one.contour.points(theta))) < 2e-4
        assert mesh_area(mesh) > 0.0


def test_the_area_of_a_curved_block():
    """That of a rectangle less two corners between arc and tangent, by midpoints."""
    mesh = face_mesh(0.03, 0.02, 0.03, ElementSize(far_size=1e-3), 0.025)
    x = (np.arange(200_000) + 0.5) / 200_000 * 0.03 - 0.015
    area = 0.03 * 0.02 - 0.03 * float(np.mean(0.025 - np.sqrt(0.025**2 - x**2)))
    assert mesh_area(mesh) == pytest.approx(area, rel=1e-8)
    for width, thickness, field in ((0.06, 0.03, "width"), (0.03, 0.004, "thickness")):
        with pytest.raises(InputError, match=rf"follower\.face\.{field}"):
            face_mesh(width, thickness, 0.03, ElementSize(far_size=1e-3), 0.025)


@pytest.mark.slow
@BOTH
def test_certificate_and_cycle_agree(kind):
    """Both bodies in full: spread within 1 %."""
    one, theta, force = pair(kind), 1.2, np.array([FORCE])
    history = two_scale_history(one, CycleBodies.meshed(one), np.array([theta]), force)
    meshes = [mesh_figures(one, theta, FORCE, edges) for edges in EDGES]
    point = certificate_point(history, 0, theta, meshes)
    assert point.spread < 0.005
    assert point.gci < 0.005
