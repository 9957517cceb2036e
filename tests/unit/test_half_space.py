"""Half-space tier: Hertz sphere and ellipses, images without end, crowns of two long bodies."""

import numpy as np
import pytest
from half_spaces import half_space_factors

from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.contact.axial_shape import BodyEnd
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import half_space, length_contact
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    FiniteBody,
    FinitePair,
    LogarithmicCrown,
    Straight,
    johns_gohar,
)
from camwright.pipeline.contact.finite_length.half_space import (
    half_space_compliance,
    influence,
    mirror_factor,
)
from camwright.pipeline.contact.finite_length.length_tiers import (
    block_grid,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import (
    CellSizes,
    PressureCells,
    pressure_cells,
)

STEEL = Elastic(210e9, 0.3)
SHARP = BodyEnd()
CURVATURE = 1 / 8e-3 + 1 / 20e-3
LINE_LOAD = 200e3


def pair(length_1=np.inf, length_2=5e-3, end=SHARP, crown=None, curvature=CURVATURE):
    bodies = FiniteBody(STEEL, length_1, end, 8e-3), FiniteBody(STEEL, length_2, SHARP, 10e-3)
    return FinitePair(bodies, curvature, crown or Straight())


def endless(curvature, crown):
    """Half-spaces without ends under a crown of the gap."""
    body = FiniteBody(STEEL, np.inf, SHARP, 1.0)
    return FinitePair((body, body), curvature, crown)


def solved(finite, force=None, sizes=None, **load):
    """Contact and plane-strain p0."""
    force = LINE_LOAD * finite.contact_length if force is None else force
    half_width, p0 = plane_strain(finite, LINE_LOAD * finite.contact_length)
    cells = pressure_cells(finite, half_width, sizes or CellSizes())
    compliance = half_space_compliance(cells, finite.bodies)
    gap = cells.integrated_gap(finite)
    return length_contact.solve(cells, compliance, gap, force, **load), p0


def crown(load=LINE_LOAD):
    modulus = STEEL.plane_strain_modulus / 2
    half_width = np.sqrt(4 * load / (np.pi * modulus * CURVATURE))
    return johns_gohar(load, 5e-3, modulus, half_width)


def by_cells(pairs):
    """Rows of displaced and columns of loaded cells, from pairs along and across."""
    m, _, k, _ = pairs.shape
    return pairs.transpose(0, 2, 1, 3).reshape(m * k, m * k)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("shift", [0.0, 1.3, 9.0])
def test_influence_is_the_integral_of_one_over_r(shift, mirrored):
    cells = PressureCells(np.array([0.0, 0.1, 0.3, 0.4]), np.array([-0.5, -0.2, 0.2, 0.5]))
    matrix = by_cells(influence(cells, shift, mirrored=mirrored))
    nodes, weights = np.polynomial.legendre.leggauss(14)
    (x, y), half = cells.centres, [0.05, 0.1, 0.05]
    across, along = np.tile(half, 3), np.repeat([0.15, 0.2, 0.15], 3)
    for i, j in ((0, 8), (2, 6)):
        sources = (-1 if mirrored else 1) * (y[j] + along[j] * nodes) + shift
        apart = np.subtract.outer(y[i] + along[i] * nodes, sources)
        total = 0.0
        for side in (-1, 1):
            beside = np.subtract.outer(x[i] + across[i] * nodes, side * (x[j] + across[j] * nodes))
            r = np.hypot(beside[:, :, None, None], apart)
            total += np.einsum("abcd,a,b,c,d", 1 / r, *[weights] * 4)
        total *= across[i] * across[j] * along[i] * along[j]
        np.testing.assert_allclose(matrix[i, j], total, rtol=1e-7)
    if mirrored or shift == 0:
        np.testing.assert_allclose(matrix, matrix.T, rtol=1e-9)


# Johnson (1985), eqs. 4.26 to 4.32, from elliptic integrals: axial radius, p0, half-length.
ELLIPSES = [(20e-3, 1722.57e6, 0.3565e-3), (100e-3, 1168.34e6, 0.7222e-3)]


@pytest.mark.parametrize(("axial", "p0", "half_length"), ELLIPSES)
def test_ellipse_of_hertz(axial, p0, half_length):
    radius, force = 5.714e-3, 200.0
    half_width = 1.5 * force / (np.pi * half_length * p0)
    step = half_width / 16
    stretch = half_length / half_width
    x = step * np.arange(19)
    y = step * stretch * (np.arange(37) - 18)
    cells = PressureCells(x, y)
    finite = endless(1 / radius, CircularCrown(axial))
    compliance = half_space_compliance(cells, finite.bodies)
    contact = length_contact.solve(cells, compliance, cells.integrated_gap(finite), force)
    assert contact.greatest[0] == pytest.approx(p0, rel=2e-3)
    place = np.stack(cells.centres)
    pressure = contact.pressure.ravel()
    inside = pressure > 0.5 * p0
    columns = np.column_stack([np.ones(inside.sum()), *(place[:, inside] ** 2)])
    square, *_ = np.linalg.lstsq(columns, pressure[inside] ** 2, rcond=None)
    assert np.sqrt(square[0]) == pytest.approx(p0, rel=1e-3)
    assert abs(contact.force[0] / force - 1) < 1e-10


def test_sphere_of_hertz():
    radius, force = 10e-3, 100.0
    modulus = STEEL.plane_strain_modulus / 2
    half_width = np.cbrt(0.75 * force * radius / modulus)
    p0 = 1.5 * force / (np.pi * half_width**2)
    edges = half_width / 16 * np.arange(-18, 19)
    cells = PressureCells(edges[18:], edges)
    finite = endless(1 / radius, CircularCrown(radius))
    compliance = half_space_compliance(cells, finite.bodies)
    contact = length_contact.solve(cells, compliance, cells.integrated_gap(finite), force)
    assert contact.greatest[0] == pytest.approx(p0, rel=2e-3)
    np.testing.assert_allclose(
        contact.pressure[0], contact.pressure[0, ::-1], atol=1e-10 * contact.greatest[0]
    )


def test_images_without_end_are_plane_strain():
    length = 5e-3
    finite = endless(CURVATURE, Straight())
    half_width, p0 = 0.112299308e-3, 1133.7911e6
    step = half_width / 16
    cells = PressureCells(step * np.arange(19), length * np.linspace(-0.5, 0.5, 9))
    kernel = by_cells(sum(influence(cells, k * length, mirrored=False) for k in range(-100, 101)))
    compliance = 2 * kernel / (np.pi * STEEL.plane_strain_modulus)
    contact = length_contact.solve(
        cells, compliance, cells.integrated_gap(finite), LINE_LOAD * length
    )
    np.testing.assert_allclose(contact.centre, p0, rtol=2e-4)


def crowned(force=LINE_LOAD * 5e-3, **load):
    """Long bodies whose crown alone ends the contact at 5 mm; plane-strain p0 of the force."""
    shape = crown()
    finite = pair(length_2=5e-3, crown=shape)
    half_width, p0 = plane_strain(finite, force)
    cells = pressure_cells(finite, half_width, CellSizes(per_half_width=10.0, growth=1.3))
    compliance = half_space_compliance(cells, endless(CURVATURE, shape).bodies)
    gap = cells.integrated_gap(finite)
    return length_contact.solve(cells, compliance, gap, force, **load), p0


def test_johns_gohar_crown_of_long_bodies_spreads_its_load_evenly():
    contact, p0 = crowned()
    line = contact.centre_line[0] / p0
    assert contact.centre[0] / p0 == pytest.approx(1, abs=5e-3)
    assert np.ptp(line[np.abs(contact.cells.centres_along) < 0.4 * 5e-3]) < 1e-2


def test_half_the_design_load_raises_the_middle_and_overload_the_ends():
    low, p0 = crowned(0.5 * LINE_LOAD * 5e-3)
    assert low.centre[0] / p0 == pytest.approx(1.046, abs=5e-3)
    y = low.cells.centres_along
    assert abs(y[low.centre_line[0].argmax()]) < 0.5e-3
    high, _ = crowned(3.0 * LINE_LOAD * 5e-3)
    assert abs(y[high.centre_line[0].argmax()]) > 2e-3


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_moment_moves_the_peak_to_its_side(sign):
    contact, _ = crowned(moment=sign * 0.2)
    y = contact.cells.centres_along
    assert sign * y[contact.centre_line[0].argmax()] > 1e-3
    assert sign * contact.tilt[0] > 0
    assert contact.moment[0] == pytest.approx(sign * 0.2, rel=1e-10)
    assert abs(contact.force[0] / (LINE_LOAD * 5e-3) - 1) < 1e-10


def test_tilt_of_the_moment_gives_the_moment_of_the_tilt():
    by_moment, _ = solved(pair(5e-3), moment=0.3)
    by_tilt, _ = solved(pair(5e-3), tilt=by_moment.tilt)
    np.testing.assert_allclose(by_tilt.pressure, by_moment.pressure, atol=1e-6)
    assert by_tilt.moment[0] == pytest.approx(0.3, rel=1e-10)


# Finite elements of blocks 8 and 10 mm deep give 0.989, 1.017, 0.976, 1.059 in the middle, and
# over the last 0.1 mm 1.139, 0.823, and 1.596 on these cells (`test_length_anchors`).
@pytest.mark.parametrize(
    ("finite", "centre", "end", "tolerance"),
    [
        (pair(8e-3), 0.989, 1.139, 0.005),
        (pair(5e-3), 1.017, 0.823, 0.02),
        (pair(5e-3, end=BodyEnd("chamfer", 0.3e-3)), 0.976, 1.596, 0.005),
        (pair(5e-3, crown=crown()), 1.059, None, 0.0),
    ],
)
def test_mirrored_ends_have_the_pressure_of_finite_elements(finite, centre, end, tolerance):
    contact, p0 = solved(finite)
    assert contact.centre[0] / p0 == pytest.approx(centre, abs=0.005)
    if end is not None:
        np.testing.assert_allclose(contact.end_means(1e-4) / p0, end, rtol=tolerance)
    assert abs(contact.moment[0]) < 1e-10 * contact.force[0] * finite.contact_length


def test_a_cycle_is_its_contacts_one_by_one():
    finite = pair(8e-3)
    curvature = CURVATURE * np.array([1.0, 0.7, 1.3, 0.9])
    force, moment = np.array([1000.0, 300.0, 700.0, 40.0]), np.array([0.0, 0.1, -0.3, 0.01])
    together = half_space_factors(finite, curvature, force, moment)
    for k in range(4):
        alone = half_space_factors(finite, curvature[k], force[k], moment[k])
        np.testing.assert_allclose(together.all[k], alone.all[0], rtol=2e-2)
    with pytest.raises(InputError, match="force"):
        half_space_factors(finite, curvature, 0.0)


def test_mirror_factor_depends_on_the_ratio_of_the_distances_from_the_end():
    # Guilbault (2011) has 1.39 for all of them.
    np.testing.assert_allclose(mirror_factor(0.3, [0.0, 1.0]), [1.495, 1.840], atol=1e-3)
    step = 20e-6
    x, y = step * np.arange(4), step * np.arange(-6, 7)
    small, large = (
        half_space_compliance(PressureCells(scale * x, scale * y), bodies)
        for scale, bodies in ((1.0, scaled(1.0)), (3.0, scaled(3.0)))
    )
    np.testing.assert_allclose(large, 27.0 * small, rtol=1e-9)
    np.testing.assert_allclose(small, small.T, atol=1e-12 * small.max())


def test_far_images_have_the_moments_of_their_cells(monkeypatch):
    x, y = 20e-6 * np.arange(10), 1e-3 * np.linspace(-2.5, 2.5, 21)
    body = FiniteBody(STEEL, 5e-3, SHARP, 1.0)
    whole = half_space_compliance(PressureCells(x, y), (body, body))
    monkeypatch.setattr(half_space, "_FAR_IMAGE", np.inf)
    exact = half_space_compliance(PressureCells(x, y), (body, body))
    pressure = np.tile(np.sqrt(1 - (x[:-1] / x[-1]) ** 2), 20)
    assert not np.array_equal(whole, exact)
    np.testing.assert_allclose(whole @ pressure, exact @ pressure, rtol=3e-5)


def scaled(scale):
    body = FiniteBody(STEEL, scale * 240e-6, SHARP, 1.0)
    return body, body


def test_a_contact_beyond_its_cells_is_refused():
    finite = pair(5e-3)
    half_width, _ = plane_strain(finite, 100.0)
    cells = pressure_cells(finite, half_width, CellSizes())
    compliance = half_space_compliance(cells, finite.bodies)
    with pytest.raises(ContactError, match="wider than the window"):
        length_contact.solve(cells, compliance, cells.integrated_gap(finite), 1e5)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: BodyEnd("chamfer", -1e-3), "end.size"),
        (lambda: BodyEnd("radius", np.nan), "end.size"),
        (lambda: BodyEnd("sharp", 1e-3), "end.size"),
        (lambda: FiniteBody(STEEL, 1e-3, BodyEnd("radius", 0.5e-3), 1e-3), "end.size"),
        (lambda: FiniteBody(STEEL, np.nan, SHARP, 1e-3), "length"),
        (lambda: FiniteBody(STEEL, 1e-3, SHARP, 0.0), "depth"),
        (lambda: CircularCrown(np.inf), "crown.radius"),
        (lambda: CircularCrown(1e-3).drop(np.array([2e-3])), "crown.radius"),
        (lambda: LogarithmicCrown(0.0, 1.0), "crown.scale"),
        (lambda: LogarithmicCrown(1e-3, 1.0, share=1.1), "crown.share"),
        (lambda: LogarithmicCrown(1e-3, 1.0, straight=1.0), "crown.straight"),
        (lambda: pair(curvature=np.nan), "curvature"),
        (lambda: CellSizes(growth=0.5), "growth"),
        (lambda: CellSizes(at_end=np.nan), "at_end"),
    ],
)
def test_bad_geometry_is_named(make, field):
    with pytest.raises(InputError, match=field):
        make()


def test_a_very_long_body_has_few_elements_beyond_the_contact():
    finite = pair(1e6)
    cells = pressure_cells(finite, 0.1e-3, CellSizes())
    grid = block_grid(cells, finite.bodies[0])
    assert grid.y[-1] == pytest.approx(5e5)
    assert grid.y.size < 80
    assert grid.z[-1] == 8e-3
    with pytest.raises(InputError, match="depth"):
        block_grid(cells, FiniteBody(STEEL, 5e-3, SHARP, 0.2e-3))
