"""Outer ring by plane finite elements against its closed form and against beam elements."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from pipeline.follower.ring import Ring, flattening, ring_bending
from pipeline.follower.ring_elements import RingElements, ring_bending_by_elements

RING = Ring(7.5e-3, 1e-3, 5e-3, 210e9, 6, 1e8)
THIN = Ring(7.5e-3, 0.2e-3, 5e-3, 210e9, 6, 1e8 * 0.2**3)


def test_pinched_ring():
    """Moments F r/pi and F r (1/pi - 1/2), and the closing of a thin ring, stretch included."""
    n, r = 96, THIN.radius
    body = RingElements(THIN, n)
    push = -(body.radial[[0]] + body.radial[[n // 2]]).toarray()[0]
    held = body.along[[0, n // 4, n // 2]]  # ways that are zero by symmetry
    motion = splu(csc_matrix(body.stiffness + 1e6 * (held.T @ held))).solve(push)
    moment, way = body.moment @ motion, body.radial @ motion
    assert moment[0] / r == pytest.approx(1 / np.pi, rel=2e-3)
    assert moment[n // 4] / r == pytest.approx(1 / np.pi - 0.5, rel=2e-3)
    area = THIN.modulus * THIN.width * THIN.thickness
    closing = (np.pi / 4 - 2 / np.pi) * r**3 / THIN.bending_stiffness + np.pi / 4 * r / area
    assert -(way[0] + way[n // 2]) == pytest.approx(closing, rel=2e-3)


@pytest.mark.parametrize(
    ("ring", "share", "moment", "soft"),
    [(THIN, 5e-4, 5e-4, 4e-3), (RING, 7e-3, 7e-3, 0.1)],
    ids=["thin", "of a 625"],
)
def test_beams_agree_with_plane_elements(ring, share, moment, soft):
    """The thinner, the nearer; shear makes the ring of a 625 softer, its moments hardly care."""
    beam, plane = ring_bending(ring), ring_bending_by_elements(ring)
    np.testing.assert_allclose(plane.ball_load, beam.ball_load, atol=share)
    np.testing.assert_allclose(
        plane.moment_max, beam.moment_max, atol=moment * beam.moment_max.max()
    )
    assert plane.stress_range(ring, 1e3) == pytest.approx(beam.stress_range(ring, 1e3), rel=moment)
    np.testing.assert_allclose(plane.compliance, beam.compliance, atol=soft * beam.compliance.max())


def test_flattened_ring_lowers_the_contact_pressure():
    """On a flat face the loss of curvature is that of the ring's own moment over E I."""
    bending = ring_bending(RING)
    force = np.array([0.0, 500.0, 1000.0])
    found = flattening(RING, bending, force, np.full(3, 1 / 8e-3))
    lost = bending.moment_max.max() * 1000.0 / (210e9 * 5e-3 * 1e-3**3 / 12)
    assert found[0] == 0.0
    assert (np.diff(found) < 0.0).all()
    assert (1 + found[2]) ** 2 == pytest.approx(1 - lost * 8e-3, rel=1e-12)
    stiff = flattening(
        replace(RING, modulus=210e15),
        ring_bending(replace(RING, modulus=210e15)),
        force,
        np.full(3, 125.0),
    )
    assert np.abs(stiff).max() < 1e-6
