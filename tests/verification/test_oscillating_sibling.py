"""An oscillating roller follower needs nothing but its own geometry to be a contour.

The follower is defined here, from Norton, Cam Design and Manufacturing Handbook (2009), ch. 7. Its
lift is the angle of the arm, rad.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from cam_parts import mesh_area

from camwright.geometry.arc_polyline import arc_polyline
from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import Contour, Frame, Undercut
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.extrema import Extremum, least
from camwright.geometry.follower_path import FollowerPath, reciprocal
from camwright.geometry.lift import Lift
from camwright.geometry.measured_contour import inspected
from camwright.meshes.body_mesh import cam_mesh
from camwright.meshes.element_size import ElementSize

PIVOT, ARM, ROLLER, START = 0.09, 0.08, 0.008, np.radians(35.0)


@dataclass(frozen=True, eq=False)
class OscillatingPath(FollowerPath):
    """Roller centre at c - l cos(psi) along u, towards the pivot, and l sin(psi) along v."""

    start: float = START

    @property
    def radius_base(self):
        return float(np.hypot(PIVOT - ARM * np.cos(self.start), ARM * np.sin(self.start)))

    @property
    def height_base(self):
        return float(PIVOT - ARM * np.cos(self.start))

    def with_lift(self, lift, height_base):
        return replace(self, lift=lift, start=float(np.arccos((PIVOT - height_base) / ARM)))

    def enlarged(self, growth):
        target = self.radius_base + growth
        cosine = (PIVOT**2 + ARM**2 - target**2) / (2.0 * PIVOT * ARM)
        return replace(self, start=float(np.arccos(cosine)))

    def _components(self, theta):
        """Velocity along u and v and its rates of change, m/rad^k, and the arm's angle."""
        s, s1, s2 = self.lift.derivatives(theta, 2)
        psi = self.start + s
        x, y = PIVOT - ARM * np.cos(psi), ARM * np.sin(psi)
        x1, y1 = y * s1, (PIVOT - x) * s1
        x2, y2 = y1 * s1 + y * s2, -x1 * s1 + (PIVOT - x) * s2
        return x1 - y, x + y1, x2 - y1, x1 + y2, psi

    def _position(self, theta):
        psi = self.start + self.lift(theta)
        return PIVOT - ARM * np.cos(psi), ARM * np.sin(psi)

    def _velocity(self, theta):
        return self._components(theta)[:2]

    def height(self, theta):
        return self._position(theta)[0]

    def tangent(self, theta):
        return self.velocity(theta) / self.speed_and_curvature(theta)[0]

    def normal(self, theta):
        x, y = self.tangent(theta)
        return np.stack([y, -x])

    def pressure_angle(self, theta):
        along, across, _, _, psi = self._components(theta)
        return np.arctan2(along, across) - np.arctan2(np.cos(psi), np.sin(psi))

    def push_arm(self, theta):
        return np.zeros(np.shape(theta))

    def speed_and_curvature(self, theta):
        a, b, a1, b1, _ = self._components(theta)
        speed = np.hypot(a, b)
        return speed, (a * (b1 + a) - b * (a1 - b)) / speed**3

    def radius_of_curvature(self, theta):
        return reciprocal(self.curvature(theta))


@dataclass(frozen=True, eq=False)
class OscillatingContour(Contour):
    """The path of the roller centre offset inwards by the roller radius."""

    rolls = True
    follower_curvature = 1.0 / ROLLER
    fitting_tool = ROLLER

    def follower_gap(self, xi):
        return ROLLER - np.sqrt(ROLLER**2 - xi**2)

    def local_frame(self, theta):
        normal = self.pitch.normal(theta)
        return Frame(self.pitch.points(theta) - ROLLER * normal, normal, self.pitch.tangent(theta))

    def motion(self, jet, friction=0.0):
        raise NotImplementedError  # needed for loads and synthesis alone

    def speed(self, theta):
        return self.pitch.speed_and_curvature(theta)[0] * self.factor(theta)

    def factor(self, theta):
        return 1.0 - ROLLER * self.pitch.curvature(theta)

    def undercut(self):
        value, theta = least(self.factor, self.lift.search_count)
        return Undercut(theta, value)

    def curvature(self, theta):
        return self.pitch.curvature(theta) / self.factor(theta)

    def curvature_slope(self, theta):
        step = 1e-4
        return (self.curvature(theta + step) - self.curvature(theta - step)) / (2.0 * step)

    def radius_of_curvature(self, theta):
        return self.pitch.radius_of_curvature(theta) - ROLLER

    def concave_radius_min(self):
        value, theta = self.pitch.curvature_min()
        return Extremum(np.inf if value >= 0 else ROLLER - 1.0 / value, theta)

    def standing(self, polygon, theta):
        raise NotImplementedError  # needed for the lift of a measured contour alone

    def _track(self, theta):
        frame = self.local_frame(theta)
        return frame.point, frame.tangent, self.speed(theta)

    def _gap(self, contact, other):
        away = self.points(other) - self.pitch.points(contact)
        return np.hypot(away[0], away[1]) - ROLLER


def swing(degrees):
    theta = uniform_turn(720)
    return Lift(theta, np.radians(0.5 * degrees) * (1.0 - np.cos(theta)))


CAM = OscillatingContour(OscillatingPath(swing(15.0)))
THETA = np.linspace(0.0, FULL_TURN, 97)


def test_an_arm_at_rest_leaves_a_circle():
    still = OscillatingContour(OscillatingPath(swing(0.0)))
    radius = still.pitch.radius_base - ROLLER
    assert still.area() == pytest.approx(np.pi * radius**2, rel=1e-12)
    np.testing.assert_allclose(still.curvature(THETA), 1.0 / radius, rtol=1e-12)


def test_the_roller_touches_the_contour_without_cutting_it():
    cam = CAM.polygon(20_000)
    for theta in THETA[::8]:
        away = np.hypot(*(cam - CAM.pitch.points(theta)[:, None]))
        assert away.min() == pytest.approx(ROLLER, abs=1e-8)  # sagitta of the polygon
    assert not CAM.undercut().present
    assert CAM.self_intersections() == ()
    assert CAM.second_contact().clearance > 0


def test_speed_and_curvature_are_derivatives_of_the_points():
    step = 1e-4
    slope = (CAM.points(THETA + step) - CAM.points(THETA - step)) / (2.0 * step)
    np.testing.assert_allclose(CAM.velocity(THETA), slope, rtol=1e-6, atol=1e-9)
    before, after = CAM.tangent(THETA - step), CAM.tangent(THETA + step)
    turned = np.arcsin(before[0] * after[1] - before[1] * after[0]) / (2.0 * step)
    np.testing.assert_allclose(CAM.curvature(THETA) * CAM.speed(THETA), turned, rtol=1e-6)


def test_tools_for_contours_take_it():
    xi = np.array([-1e-4, 0.0, 1e-4])
    bend = -0.5 * CAM.curvature(THETA)[:, None] * xi**2
    # the cubic term over the quadratic one, kappa' xi / (3 kappa), is 6.1e-5 at most
    np.testing.assert_allclose(CAM.surface_offset(THETA, xi), bend, rtol=1e-4, atol=1e-15)
    assert arc_polyline(CAM).area == pytest.approx(CAM.area(), rel=1e-6)
    np.testing.assert_allclose(
        cutter_path(CAM, ROLLER, THETA).centre, CAM.pitch.points(THETA), atol=1e-12
    )
    mesh = cam_mesh(CAM, 0.01, None, ElementSize(far_size=4e-3))
    assert mesh_area(mesh) == pytest.approx(CAM.area() - np.pi * 0.01**2, rel=1e-6)
    turned = np.array([[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]])
    assert inspected(CAM, turned @ CAM.polygon(360)).phase == pytest.approx(0.2, abs=1e-9)
