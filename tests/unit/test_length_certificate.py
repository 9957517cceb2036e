"""Finite elements beside half-spaces at chosen angles, on coarse cells."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import brick_body, length_certificate, length_tiers
from camwright.pipeline.contact.finite_length.axial_drop import (
    BodyEnd,
    FiniteBody,
    FinitePair,
    Straight,
)
from camwright.pipeline.contact.finite_length.length_certificate import (
    LengthLoad,
    LengthPoint,
    begun_ends,
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
    pair = replace(PAIR, curvature=curvature)
    return LengthLoad("rated", theta, pair, force, moment, factor=1.25, centre=0.8)


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
    begun = begun_ends(loads, 1e-4, 2.0)
    certificate = begun.certificate(lambda k, total: steps.append((k, total)))
    assert begun.fresh == len(begun.blocks)
    patch.undo()
    return certificate, counts, steps


def test_bodies_are_condensed_once_for_all_angles(condensations):
    certificate, counts, steps = condensations
    assert len(counts) == 6  # two bodies, three meshes
    assert steps == [(k, 9) for k in range(1, 10)]
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


def test_the_half_spaces_are_corrected_to_the_finite_elements(condensations):
    certificate, _, _ = condensations
    (correction,), blocks = certificate.corrections, [p.finite_elements for p in certificate.points]
    signed = [tier.signed.values[-1] for tier in blocks]
    assert correction.signed == pytest.approx(max(signed) / 1.25, rel=1e-12)
    assert correction.signed_error == max(tier.signed.gci for tier in blocks) > 0
    assert correction.centre == pytest.approx(
        max(tier.factors.centre[0] for tier in blocks) / 0.8, rel=1e-12
    )
    for tier, value in zip(blocks, signed, strict=True):
        means, greatest = tier.factors.end_means[0].max(), tier.factors.greatest[0]
        assert value <= greatest
        assert value == greatest if not tier.at_corner else value >= (1 - 1e-12) * means
    assert replace(certificate, points=()).corrections == ()


def test_each_of_preloaded_discs_is_corrected_by_its_own_points(condensations):
    certificate, _, _ = condensations
    first, *others = certificate.points
    on_second = [replace(each, load=replace(each.load, second=True)) for each in others]
    one, other = replace(certificate, points=(first, *on_second)).corrections
    assert one.signed == first.ratio != max(each.ratio for each in others) == other.signed
    by = one.where(np.array([True, False]), other)
    assert by.signed.tolist() == [one.signed, other.signed]
    assert by.signed_error.tolist() == [one.signed_error, other.signed_error]


def test_blocks_in_the_disk_cache_are_not_condensed_again(tmp_path, monkeypatch):
    monkeypatch.setenv("CAMWRIGHT_CACHE", str(tmp_path))
    monkeypatch.delenv("CAMWRIGHT_NO_CACHE", raising=False)
    bodies = tuple(replace(body, length=1.1 * body.length) for body in PAIR.bodies)
    one = replace(load(0.0, 400.0, 0.0), pair=replace(PAIR, bodies=bodies))
    first = begun_ends([one], 1e-4, 2.0)
    kept = first.certificate().points[0].finite_elements.signed
    again = begun_ends([one], 1e-4, 2.0)
    assert (first.fresh, again.fresh) == (6, 0)
    entry = next(tmp_path.glob("block-*.npz"))
    entry.write_bytes(entry.read_bytes()[:-100])
    length_tiers.condensed_block_of.cache_clear()
    assert begun_ends([one], 1e-4, 2.0).certificate().points[0].finite_elements.signed == kept


def test_a_contact_much_narrower_has_its_own_cells():
    loads = [load(0.0, 400.0, 0.0), load(1.0, 40.0, 0.0)]
    points = begun_ends(loads, 1e-4, 2.0).certificate().points
    widths = [point.finite_elements.contact.cells.x[1] for point in points]
    half_widths = [plane_strain(PAIR, force)[0] for force in (400.0, 40.0)]
    np.testing.assert_allclose(widths, [on_ladder(each) / 2 for each in half_widths], rtol=1e-12)


def test_a_moment_near_the_end_has_its_blocks_condensed(monkeypatch):
    """0.25 of force times length takes wider cells, though narrow ones cover its contact."""
    monkeypatch.setattr(length_certificate, "_is_covered", lambda *_: True)
    points = begun_ends([load(1.0, 400.0, 0.2)], 1e-4, 2.0).certificate().points
    assert points[0].finite_elements.contact.moment[0] == pytest.approx(0.2, rel=1e-9)


def test_lengths_on_the_ladder_are_the_next_larger():
    lengths = np.geomspace(1e-5, 1e-2, 37)
    rungs = np.array([on_ladder(length) for length in lengths])
    assert ((rungs >= lengths) & (rungs < 1.1001 * lengths)).all()
    assert on_ladder(on_ladder(3.3e-5)) == on_ladder(3.3e-5)


def test_scatter_of_cells_too_wide_for_the_contact_is_not_that_of_the_blocks():
    # Coarse cells err by 7, 0.1 and 0.5 %; what the blocks add converges by the first order.
    cells, blocks = np.array([1.07, 0.999, 1.005]), 1.0 + 0.001 * np.array([2.25, 1.5, 1.0])
    values, halves = 0.98 * cells * blocks, 0.99 * np.append(cells, 1.0)
    plain, freed = (length_tiers._converged(values, each) for each in (None, halves))
    assert plain.gci > 0.2
    assert freed.values == plain.values
    assert freed.extrapolated == pytest.approx(0.98, rel=1e-4)
    error = abs(freed.values[-1] / 0.98 - 1.0)
    assert error < freed.gci < 0.01
    # An observed order is that of the blocks and stays.
    smooth = 0.98 * blocks
    assert length_tiers._converged(smooth, halves) == length_tiers._converged(smooth, None)


def test_a_line_that_its_tilt_lifts_in_the_middle_has_no_pressure_there():
    lifted = length_tiers._converged(np.zeros(3), np.zeros(4))
    assert (lifted.values, lifted.gci) == ((0.0, 0.0, 0.0), 0.0)
    point = LengthPoint(replace(load(0.0, 40.0, 0.3), centre=0.0), None, None)
    assert point.centre_ratio == 1.0
