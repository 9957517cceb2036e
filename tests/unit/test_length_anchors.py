"""Axial pressure of steel bodies by finite elements at full resolution, minutes; run by `verify`.

Roller of radius 8 mm on a cam of radius 20 mm, blocks 8 and 10 mm deep, 200 N/mm. The numbers come
from a prototype of the same formulation on another program: quarter models of the same elements,
assembled and factorised whole.
"""

from functools import cache

import numpy as np
import pytest

from camwright.pipeline.contact.axial_shape import BodyEnd
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import (
    FiniteBody,
    FinitePair,
    Straight,
    johns_gohar,
)
from camwright.pipeline.contact.finite_length.half_space import half_space_compliance
from camwright.pipeline.contact.finite_length.length_tiers import (
    block_compliance,
    both_tiers,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes, pressure_cells

pytestmark = pytest.mark.slow

STEEL = Elastic(210e9, 0.3)
CURVATURE, LINE_LOAD = 1 / 8e-3 + 1 / 20e-3, 200e3
CROWN = johns_gohar(LINE_LOAD, 5e-3, STEEL.plane_strain_modulus / 2, 0.11229931e-3)
ENDS = {"overhang": (8e-3, 0.0), "flush": (5e-3, 0.0), "chamfer": (5e-3, 0.3e-3)}
FINE = CellSizes(at_end=10e-6, uniform=10)


def pair(ends, crown=None):
    length, chamfer = ENDS[ends]
    end = BodyEnd("chamfer", chamfer) if chamfer else BodyEnd()
    roller, cam = FiniteBody(STEEL, length, end, 8e-3), FiniteBody(STEEL, 5e-3, BodyEnd(), 10e-3)
    return FinitePair((roller, cam), CURVATURE, crown or Straight())


@cache
def condensed(ends, sizes):
    """Cells and compliance of the bodies, of any crown and load."""
    finite = pair(ends)
    half_width, _ = plane_strain(finite, LINE_LOAD * finite.contact_length)
    cells = pressure_cells(finite, half_width, sizes)
    return cells, block_compliance(cells, finite.bodies)[0]


def solved(ends, crown=None, tilt=0.0, sizes=None):
    """Contact by finite elements, the one by half-spaces at its moment, p0."""
    finite = pair(ends, crown)
    force = LINE_LOAD * finite.contact_length
    cells, compliance = condensed(ends, sizes or CellSizes())
    gap = cells.integrated_gap(finite)
    blocks = length_contact.solve(cells, compliance, gap, force, tilt=tilt)
    mirrored = half_space_compliance(cells, finite.bodies)
    halves = length_contact.solve(cells, mirrored, gap, force, moment=blocks.moment)
    return blocks, halves, plane_strain(finite, force)[1]


@pytest.mark.parametrize(
    ("ends", "centre", "end", "tolerance"),
    [
        ("overhang", 0.989, 1.139, 0.005),
        ("flush", 1.017, 0.823, 0.005),
        ("chamfer", 0.976, 1.58, 0.02),
    ],
)
def test_ends(ends, centre, end, tolerance):
    blocks, _, p0 = solved(ends)
    np.testing.assert_allclose(blocks.end_means(1e-4) / p0, end, atol=tolerance)
    assert blocks.centre[0] / p0 == pytest.approx(centre, abs=0.003)


def test_johns_gohar_crown_and_tilt():
    straight, _, p0 = solved("flush", CROWN)
    assert straight.centre[0] / p0 == pytest.approx(1.058, abs=0.003)
    tilted, _, p0 = solved("flush", CROWN, 1e-3)
    assert tilted.greatest[0] / p0 == pytest.approx(1.176, abs=0.01)
    flush, _, p0 = solved("flush", tilt=1e-3)
    assert flush.greatest[0] / p0 == pytest.approx(1.192, abs=0.01)


@pytest.mark.parametrize(
    ("ends", "crown", "tilt", "tolerance"),
    [
        ("overhang", None, 0.0, 0.005),
        ("flush", None, 0.0, 0.02),
        ("flush", None, 1e-3, 0.025),
        ("flush", CROWN, 0.0, 0.0),
        ("flush", CROWN, 1e-3, 0.025),
        ("chamfer", None, 0.0, 0.005),
    ],
)
def test_mirrored_ends_at_the_same_moment(ends, crown, tilt, tolerance):
    blocks, halves, p0 = solved(ends, crown, tilt)
    half_width, _ = plane_strain(pair(ends), LINE_LOAD * pair(ends).contact_length)
    inner = np.abs(blocks.cells.centres_along) <= pair(ends).contact_length / 2 - half_width
    apart = np.abs(halves.centre_line - blocks.centre_line)[0] / p0
    assert apart[inner].max() < 0.015
    if tilt:
        np.testing.assert_allclose(halves.greatest, blocks.greatest, rtol=tolerance)
    elif crown is None:
        np.testing.assert_allclose(halves.end_means(1e-4), blocks.end_means(1e-4), rtol=tolerance)


@pytest.mark.parametrize("poisson", [0.2, 0.45])
def test_mirrored_ends_of_other_materials(poisson):
    material = Elastic(100e9, poisson)
    bodies = tuple(FiniteBody(material, 5e-3, BodyEnd(), 8e-3) for _ in range(2))
    finite = FinitePair(bodies, CURVATURE, Straight())
    force = 0.5 * LINE_LOAD * finite.contact_length
    half_width, p0 = plane_strain(finite, force)
    cells = pressure_cells(finite, half_width, CellSizes().coarser(1.5))
    gap, inner = cells.integrated_gap(finite), np.abs(cells.centres_along) <= 2.5e-3 - half_width
    for moment in (0.0, 0.08 * force * finite.contact_length):
        blocks, halves = (
            length_contact.solve(cells, compliance, gap, force, moment=moment)
            for compliance in (
                block_compliance(cells, bodies)[0],
                half_space_compliance(cells, bodies),
            )
        )
        apart = np.abs(halves.centre_line - blocks.centre_line)[0] / p0
        assert apart[inner].max() < 0.02
        np.testing.assert_allclose(halves.greatest, blocks.greatest, rtol=0.025)


@pytest.mark.parametrize(
    ("ends", "tolerance"), [("overhang", 0.003), ("flush", 0.003), ("chamfer", 0.015)]
)
def test_the_mean_at_an_end_converges(ends, tolerance):
    coarse, fine = (solved(ends, sizes=sizes)[0].end_means(1e-4) for sizes in (None, FINE))
    np.testing.assert_allclose(fine, coarse, rtol=tolerance)


def test_both_tiers_agree_at_a_rounded_end():
    roller = FiniteBody(STEEL, 5e-3, BodyEnd("radius", 1e-3), 8e-3)
    cam = FiniteBody(STEEL, 5e-3, BodyEnd(), 10e-3)
    rounded = FinitePair((roller, cam), CURVATURE, Straight())
    halves, blocks = both_tiers(rounded, LINE_LOAD * rounded.contact_length)
    assert blocks.factors.greatest[0] > 1.5
    np.testing.assert_allclose(halves.factors.all, blocks.factors.all, rtol=0.01)


@pytest.mark.parametrize("tilt", [0.0, 1e-3])
def test_equilibrium_and_symmetry(tilt):
    blocks, _, _ = solved("overhang", tilt=tilt)
    mirrored, _, _ = solved("overhang", tilt=-tilt)
    cells = blocks.cells
    y = cells.centres[1]
    pressure = blocks.pressure.ravel()
    assert abs(2 * pressure @ cells.areas / 1000.0 - 1) < 1e-10
    lever = 2 * pressure @ (cells.areas * y)
    assert lever == pytest.approx(blocks.moment[0], abs=1e-10 * 1000.0 * 5e-3)
    np.testing.assert_allclose(
        mirrored.pressure[0, ::-1], blocks.pressure[0], atol=1e-10 * blocks.greatest[0]
    )
