"""Loads on curved, meshed surfaces in the frame of a contact."""

import numpy as np
import pytest

from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import block_mesh, roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.contact.elasticity.pressure_distribution import PressureShapes
from camwright.pipeline.contact.elasticity.surface_integrals import (
    ContactFrame,
    knots_of,
    normal_loads,
)

UP = ContactFrame(np.zeros(2), np.array([0.0, 1.0]))


def block(phase=0.0):
    return block_mesh(
        4.0, 2.0, ElementSize(far_size=0.5, contact_size=0.1, contact_extent=1.0,
                         contact_point=np.zeros(2), phase=phase)
    )  # fmt: skip


def roller(angle=-0.5 * np.pi):
    return roller_mesh(
        3.0, 1.0, angle, ElementSize(far_size=1.0, contact_size=0.1, contact_extent=1.0)
    )


def test_frame_counts_to_the_right_and_up():
    frame = ContactFrame(np.array([1.0, 2.0]), np.array([0.0, 1.0]))
    np.testing.assert_allclose(frame.tangent, [1.0, 0.0])
    assert frame.along([1.5, 2.0]) == 0.5 and frame.above([1.5, 1.0]) == -1.0


def test_frame_turns_with_its_normal():
    angle = 0.7
    frame = ContactFrame(np.zeros(2), np.array([-np.sin(angle), np.cos(angle)]))
    np.testing.assert_allclose(frame.tangent, [np.cos(angle), np.sin(angle)], atol=1e-15)


def test_knots_are_the_ends_and_middles_of_the_facets_within_reach():
    knots = knots_of(block(), "top", UP, 0.42)
    np.testing.assert_allclose(knots, np.arange(-8, 9) * 0.05, atol=1e-12)


def test_knots_leave_the_far_side_of_a_roller_out():
    mesh = roller().transformed(0.0, (0.0, 3.0))
    knots = knots_of(mesh, "rim", UP, 0.8)
    assert knots.size == 33 and (np.diff(knots) > 0.04).all()


def test_too_few_knots_are_refused():
    with pytest.raises(ContactError, match="nodes of top"):
        knots_of(block(), "top", UP, 0.15)


@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_resultant_and_moment_of_the_nodal_forces_are_those_of_the_pressures(phase):
    # Knots of one surface, facets of another that do not match: exact all the same.
    shapes = PressureShapes(np.array([-0.61, -0.4, -0.123, 0.05, 0.3, 0.47]))
    for mesh, name in ((block(phase), "top"), (roller().transformed(0.0, (0.0, 3.0)), "rim")):
        forces = normal_loads(mesh, name, UP, shapes)
        xi, weights = shapes.quadrature()
        np.testing.assert_allclose(forces[0], 0.0, atol=0)
        np.testing.assert_allclose(forces[1].sum(axis=0), shapes.integrals, rtol=1e-13)
        moment = mesh.points[0] @ forces[1]
        np.testing.assert_allclose(moment, shapes.values(xi) @ (weights * xi), atol=1e-13)


def test_forces_turn_with_the_frame():
    angle = 1.1
    turned = ContactFrame(np.zeros(2), np.array([-np.sin(angle), np.cos(angle)]))
    shapes = PressureShapes(np.linspace(-0.5, 0.5, 8))
    straight = normal_loads(block(), "top", UP, shapes)
    tilted = normal_loads(block().transformed(angle, (0.0, 0.0)), "top", turned, shapes)
    back = np.tensordot([[np.cos(angle), np.sin(angle)]], tilted, axes=(1, 0))[0]
    np.testing.assert_allclose(back, 0.0, atol=1e-15)
    np.testing.assert_allclose(np.hypot(*tilted), np.abs(straight[1]), atol=1e-14)


def test_a_surface_that_ends_in_the_window_is_refused():
    with pytest.raises(ContactError, match="top ends inside"):
        normal_loads(block(), "top", UP, PressureShapes(np.linspace(0.0, 2.5, 9)))
