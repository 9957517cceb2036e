"""Finite elements beside half-spaces at chosen angles, on coarse cells."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import brick_body
from camwright.pipeline.contact.finite_length.axial_drop import (
    BodyEnd,
    FiniteBody,
    FinitePair,
    Straight,
)
from camwright.pipeline.contact.finite_length.length_certificate import (
    LengthLoad,
    length_certificate,
)
from camwright.pipeline.contact.finite_length.length_tiers import (
    on_ladder,
    plane_strain,
)

STEEL = Elastic(210e9, 0.3)
PAIR = FinitePair(
    (FiniteBody(STEEL, 3e-3, BodyEnd(), 2e-3), FiniteBody(STEEL, 2e-3, BodyEnd(), 2e-3)),
    175.0,
    Straight(),
)


def load(theta, force, moment, curvature=175.0):
    return LengthLoad("rated", theta, replace(PAIR, curvature=curvature), force, moment)


@pytest.fixture(scope="module")
def condensations():
    counts = []
    compute = brick_body.condensed

    def counted(grid, poisson):
        counts.append(grid.unknowns)
        return compute(grid, poisson)

    patch = pytest.MonkeyPatch()
    patch.setenv("CAMWRIGHT_NO_CACHE", "1")
    patch.setattr(brick_body, "condensed", counted)
    steps = []
    loads = [load(0.5, 400.0, 0.0), load(1.0, 400.0, 0.08), load(2.0, 300.0, -0.05, 200.0)]
    certificate = length_certificate(loads, 1e-4, 2.0, lambda k, total: steps.append((k, total)))
    patch.undo()
    return certificate, counts, steps


def test_bodies_are_condensed_once_for_all_angles(condensations):
    certificate, counts, steps = condensations
    assert len(counts) == 4  # two bodies, two meshes
    assert steps == [(1, 3), (2, 3), (3, 3)]
    assert [point.load.theta for point in certificate.points] == [0.5, 1.0, 2.0]


def test_points_have_their_force_and_moment_at_both_tiers(condensations):
    certificate, _, _ = condensations
    for point in certificate.points:
        for tier in (point.half_space, point.finite_elements):
            assert tier.contact.force[0] == pytest.approx(point.load.force, rel=1e-10)
            moment = point.load.moment
            assert tier.contact.moment[0] == pytest.approx(moment, abs=1e-10 * 400.0 * 2e-3)
        half_space, blocks = point.half_space, point.finite_elements  # on two cells a half-width
        np.testing.assert_allclose(half_space.contact.centre, blocks.contact.centre, rtol=0.08)
        np.testing.assert_allclose(
            point.difference, half_space.factors.all[0] - blocks.factors.all[0], rtol=1e-12
        )
    first, tilted, back = (point.finite_elements.factors for point in certificate.points)
    np.testing.assert_allclose(first.end_means[0, 0], first.end_means[0, 1], rtol=1e-9)
    assert tilted.end_means[0, 1] > first.end_means[0, 1] > tilted.end_means[0, 0]
    assert back.end_means[0, 0] > back.end_means[0, 1]


def test_a_contact_much_narrower_has_its_own_cells():
    loads = [load(0.0, 400.0, 0.0), load(1.0, 40.0, 0.0)]
    points = length_certificate(loads, 1e-4, 2.0).points
    widths = [point.finite_elements.contact.cells.x[1] for point in points]
    half_widths = [plane_strain(PAIR, force)[0] for force in (400.0, 40.0)]
    np.testing.assert_allclose(widths, [on_ladder(each) / 2 for each in half_widths], rtol=1e-12)


def test_lengths_on_the_ladder_are_the_next_larger():
    lengths = np.geomspace(1e-5, 1e-2, 37)
    rungs = np.array([on_ladder(length) for length in lengths])
    assert ((rungs >= lengths) & (rungs < 1.1001 * lengths)).all()
    assert on_ladder(on_ladder(3.3e-5)) == on_ladder(3.3e-5)
