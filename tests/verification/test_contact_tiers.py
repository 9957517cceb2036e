"""Cycle tier against certificate tier over unlike materials, radii and loads.

Young's moduli up to 1000 to 1, Poisson ratios from 0 to 0.49, radii up to 10^4 to 1, loads over
six decades: within 0.5 %, or no answer of the cycle tier where the half-width is too large for
flat bodies; the certificate then answers alone.
"""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.two_scale import CycleBodies, patch_gap, two_scale_history

STEEL = Elastic(210e9, 0.3)
ROLLER, WIDTH = 0.01, 5e-3
THETA = 0.3


def round_cam(ratio, cam, roller):
    """A roller of 10 mm on a round cam `ratio` times as large, of walls as thick as its half."""
    radius = ratio * ROLLER
    contour = RollerContour(
        PitchCurve(Lift(uniform_turn(90), np.zeros(90)), radius + ROLLER), ROLLER
    )
    return ContactPair(
        contour, WIDTH, radius / 2, None, cam, RollerBody(ROLLER, ROLLER / 2, roller)
    )


def both_tiers(pair, line_load):
    force = line_load * WIDTH
    cycle = two_scale_history(pair, CycleBodies.meshed(pair), np.array([THETA]), np.array([force]))
    return cycle, solve_pair(pair, THETA, force).solution


@pytest.mark.parametrize(
    ("ratio", "cam", "roller", "line_load"),
    [
        pytest.param(1.0, STEEL, STEEL, 1e0, id="alike, 1 N/m"),
        pytest.param(1.0, STEEL, STEEL, 1e6, id="alike, 1 kN/mm"),
        pytest.param(1e2, STEEL, STEEL, 1e5, id="cam 100 times the roller"),
        pytest.param(1e4, STEEL, STEEL, 1e5, id="cam 10^4 times the roller"),
        pytest.param(1.0, Elastic(210e9, 0.0), Elastic(210e9, 0.49), 1e4, id="nu 0 on 0.49"),
        pytest.param(3.0, Elastic(7e9, 0.49), STEEL, 1e4, id="cam 30 times softer"),
        pytest.param(3.0, STEEL, Elastic(210e6, 0.49), 1e2, id="roller 1000 times softer"),
        pytest.param(1e2, Elastic(210e6, 0.0), STEEL, 1e3, id="cam 1000 times softer, large"),
    ],
)
def test_cycle_tier_is_within_half_a_per_cent_of_the_certificate(ratio, cam, roller, line_load):
    cycle, full = both_tiers(round_cam(ratio, cam, roller), line_load)
    for name in ("p0", "half_width", "tau_max", "von_mises"):
        found = float(getattr(cycle, name)[0])
        np.testing.assert_allclose(found, getattr(full, name), rtol=5e-3, err_msg=name)


def test_a_contact_too_wide_for_flat_bodies_is_left_to_the_certificate():
    pair = round_cam(1.0, STEEL, Elastic(210e6, 0.45))
    cycle, full = both_tiers(pair, 6e4)
    assert cycle.half_width_hertz[0] > 0.1 * cycle.relative_radius[0]
    assert np.isnan([cycle.p0[0], cycle.half_width[0], cycle.tau_max[0], cycle.von_mises[0]]).all()
    assert np.isfinite([full.p0, full.half_width, full.tau_max]).all()
    assert full.residual_equilibrium < 1e-8


@pytest.mark.parametrize("knots", [720, 24])
def test_gap_between_chebyshev_nodes_is_that_of_the_contour(knots):
    """Smooth, and across the jumps of the fifth derivative of a lift of few samples.

    To 1e-8 of the largest gap: the accuracy where the contour is evaluated at every point.
    """
    angles = uniform_turn(knots)
    lift = Lift(angles, 4e-3 * (1 - np.cos(2 * angles)))
    contour = RollerContour(PitchCurve(lift, 0.05), ROLLER)
    pair = ContactPair(contour, WIDTH, 8e-3, None, STEEL, RollerBody(ROLLER, ROLLER / 2, STEEL))
    theta = np.linspace(0.0, 2 * np.pi, 97)
    half_width = np.linspace(2e-5, 9e-4, theta.size)
    xi, _, _ = contact_patch(0.3).shapes.sampled
    exact = pair.gap(theta, half_width[:, None] * xi)
    gap = patch_gap(pair, theta, half_width, xi)
    np.testing.assert_allclose(gap - exact, 0.0, atol=1e-8 * exact.max(axis=1)[:, None].min())
