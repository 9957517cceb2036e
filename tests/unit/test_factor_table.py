"""Table of axial pressures against contacts solved one by one, between its nodes."""

import time
from dataclasses import replace

import numpy as np
import pytest
from half_spaces import half_space_factors
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import (
    BodyEnd,
    CircularCrown,
    FiniteBody,
    FinitePair,
    Straight,
    TabulatedCrown,
    iso16281,
    johns_gohar,
)
from camwright.pipeline.contact.finite_length.contact_span import contact_cells
from camwright.pipeline.contact.finite_length.factor_table import GREATEST_MOMENT, factor_table
from camwright.pipeline.contact.finite_length.half_space import half_space_compliance
from camwright.pipeline.contact.finite_length.length_tiers import (
    MEAN_LENGTH,
    block_grid,
    cycle_sizes,
    meshes_of,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes, pressure_cells

STEEL = Elastic(210e9, 0.3)
CURVATURE, LENGTH = 175.0, 5e-3


def pair(length=LENGTH, end=None, crown=None):
    roller = FiniteBody(STEEL, length, end or BodyEnd(), 8e-3)
    cam = FiniteBody(STEEL, LENGTH, BodyEnd(), 10e-3)
    return FinitePair((roller, cam), CURVATURE, crown or Straight())


def loads(finite, count, seed, heaviest=0.2):
    """Curvatures, forces and moments of seeded contacts of 40 to 300 N/mm."""
    rng = np.random.default_rng(seed)
    length = finite.contact_length
    force = np.exp(rng.uniform(np.log(40e3), np.log(300e3), count)) * length
    curvature = rng.uniform(0.6, 1.4, count) * CURVATURE
    return curvature, force, rng.uniform(-heaviest, heaviest, count) * force * length


def one_by_one(finite, curvature, force, moment):
    triples = zip(curvature, force, moment, strict=True)
    return np.concatenate([half_space_factors(finite, *each).all for each in triples])


CROWN = johns_gohar(200e3, LENGTH, STEEL.plane_strain_modulus / 2, 0.1123e-3)


@pytest.mark.parametrize(
    "finite",
    [pair(8e-3), pair(), pair(end=BodyEnd("chamfer", 0.3e-3))],
    ids=["overhang", "flush", "chamfer"],
)
def test_sharp_and_chamfered_ends_between_the_nodes(finite):
    table = factor_table(finite, MEAN_LENGTH)
    contacts = loads(finite, 8, seed=1)
    direct = one_by_one(finite, *contacts)
    difference = np.abs(table.factors(*contacts).all - direct) / direct[:, 1:2]
    # The mean at the end that the moment unloads is not singular.
    loaded = np.where(contacts[2] < 0, difference[:, 2], difference[:, 3])
    assert difference[:, :2].max() < table.interpolation_error
    assert loaded.max() < table.interpolation_error


def finely(finite, curvature, force, moment):
    """Centre and greatest of one contact over plane strain, on cells finer by half."""
    here = replace(finite, curvature=curvature)
    cells = contact_cells(here, force, moment, cycle_sizes(finite).coarser(1 / 1.5))
    compliance = half_space_compliance(cells, finite.bodies)
    gap = cells.integrated_gap(here)
    contact = length_contact.solve(cells, compliance, gap, force, moment=moment)
    return np.array([contact.centre[0], contact.greatest[0]]) / plane_strain(here, force)[1]


MODULUS = STEEL.plane_strain_modulus / 2


@pytest.mark.parametrize(
    ("finite", "seed"),
    [
        (pair(crown=CROWN), 1),
        pytest.param(pair(crown=iso16281(16e-3, LENGTH)), 3, marks=pytest.mark.slow),
        pytest.param(pair(crown=CircularCrown(0.3)), 4, marks=pytest.mark.slow),
        pytest.param(pair(end=BodyEnd("radius", 0.3e-3)), 6, marks=pytest.mark.slow),
    ],
    ids=["johns-gohar", "iso", "circular", "rounded"],
)
def test_loaded_shapes_between_the_nodes(finite, seed):
    table = factor_table(finite, MEAN_LENGTH)
    rng = np.random.default_rng(seed)
    line_loads = np.array([37e3]) if seed == 1 else np.array([1e3, 12e3, 37e3, 48e3, 150e3])
    for force in line_loads * finite.contact_length:
        curvature = CURVATURE * rng.uniform(0.6, 1.4)
        couple = rng.uniform(-0.2, 0.2) * force * finite.contact_length
        level, tilted = (table.factors(curvature, force, each).all[0, :2] for each in (0.0, couple))
        finest = [finely(finite, curvature, force, each) for each in (0.0, couple)]
        error = table.interpolation_error
        np.testing.assert_allclose(level, finest[0], atol=error * finest[0][1])
        assert tilted[1] == pytest.approx(finest[1][1], rel=error)


def test_halved_cells_at_a_rounded_end():
    finite = pair(end=BodyEnd("radius", 0.3e-3))
    force = 40e3 * finite.contact_length
    half_width, p0 = plane_strain(finite, force)
    peaks = []
    for sizes in (CellSizes(window=4.0), CellSizes(window=4.0).coarser(0.5)):
        cells = pressure_cells(finite, half_width, sizes)
        contact = length_contact.solve(
            cells,
            half_space_compliance(cells, finite.bodies),
            [cells.integrated_gap(finite)] * 2,
            force,
            moment=[0.0, 0.15 * force * finite.contact_length],
        )
        peaks.append(contact.greatest / p0)
    np.testing.assert_allclose(*peaks, rtol=1e-2)
    # Cells of a sixth of the width of the peak and finer: 2.95 and 4.00.
    np.testing.assert_allclose(peaks[0], [2.95, 4.00], rtol=1e-2)


def ellipse(curvature, axial, force):
    """Peak pressure, Pa, of the elliptical contact of Hertz; curvatures 1/m, the axial the less."""

    def ratio_of(shape):
        m = 1.0 - shape**2
        return (ellipe(m) / shape**2 - ellipk(m)) / (ellipk(m) - ellipe(m))

    shape = brentq(lambda k: ratio_of(k) - curvature / axial, 1e-3, 0.999)
    m = 1.0 - shape**2
    half_length = np.cbrt(3 * force * (ellipk(m) - ellipe(m)) / (axial * np.pi * MODULUS * m))
    return 1.5 * force / (np.pi * half_length**2 * shape)


def test_light_loads_on_a_circular_crown_are_the_ellipse_of_hertz():
    finite = pair(crown=CircularCrown(0.3))
    table = factor_table(finite, MEAN_LENGTH)
    force = np.array([0.5, 2.0]) * 1e3 * LENGTH
    half_width = np.sqrt(4 * force / LENGTH / (np.pi * MODULUS * CURVATURE))
    p0 = 0.5 * MODULUS * CURVATURE * half_width
    expected = [ellipse(CURVATURE, 1 / 0.3, each) for each in force]
    np.testing.assert_allclose(table.factors(CURVATURE, force).greatest * p0, expected, rtol=5e-3)


def test_a_heavy_moment_near_the_end():
    finite = pair(8e-3)
    table = factor_table(finite, MEAN_LENGTH)
    force = np.array([800.0])
    moment = 0.37 * force * LENGTH
    direct = half_space_factors(finite, CURVATURE, force, moment)
    factors = table.factors(CURVATURE, force, moment)
    assert factors.greatest[0] == pytest.approx(direct.greatest[0], rel=6e-3)
    assert factors.end_means[0, 1] == pytest.approx(direct.end_means[0, 1], rel=6e-3)
    with pytest.raises(InputError, match="moment"):
        table.factors(CURVATURE, force, 1.01 * GREATEST_MOMENT * force * LENGTH)


def test_a_mirrored_moment_mirrors_the_pressure():
    table = factor_table(pair(8e-3), MEAN_LENGTH)
    edges, line = table.axial_pressure(CURVATURE, 700.0, [0.3, -0.3])
    np.testing.assert_allclose(line[0], line[1, ::-1], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(edges[0], -edges[1, ::-1], atol=1e-15)


def test_contacts_do_not_depend_on_how_many_are_interpolated():
    table = factor_table(pair(8e-3), MEAN_LENGTH)
    contacts = loads(table.pair, 3001, seed=4)
    _, together = table.axial_pressure(*contacts)  # by a sparse matrix
    parts = [table.axial_pressure(*(each[k::7] for each in contacts))[1] for k in range(7)]
    for k, part in enumerate(parts):
        np.testing.assert_array_equal(part, together[k::7])


@pytest.mark.slow
def test_a_crown_of_one_side_loads_the_other():
    y = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, 21)
    crown = TabulatedCrown(y, np.where(y > 0, 4e-6 * (y / y[-1]) ** 2, 0.0))
    finite = pair(crown=crown)
    table = factor_table(finite, MEAN_LENGTH)
    factors = table.factors(CURVATURE, 800.0, [-0.2, 0.0, 0.2])
    finest = [finely(finite, CURVATURE, 800.0, moment)[1] for moment in (-0.2, 0.0, 0.2)]
    np.testing.assert_allclose(factors.greatest, finest, rtol=table.interpolation_error)
    assert factors.end_means[1, 0] > factors.end_means[1, 1]


@pytest.mark.parametrize("share", [0.01, 0.1, 0.3])
def test_moment_of_a_tilt_has_that_tilt(share):
    finite = pair()
    table = factor_table(finite, MEAN_LENGTH)
    force = 600.0
    cells = pressure_cells(finite, plane_strain(finite, force)[0], cycle_sizes(finite))
    compliance = half_space_compliance(cells, finite.bodies)
    contact = length_contact.solve(
        cells, compliance, cells.integrated_gap(finite), force, moment=share * force * LENGTH
    )
    moment = table.moment_at_tilt(CURVATURE, force, [contact.tilt[0], -contact.tilt[0], 1.0])
    limit = GREATEST_MOMENT * force * LENGTH
    expected = [contact.moment[0], -contact.moment[0], limit]
    np.testing.assert_allclose(moment, expected, rtol=1e-2)


@pytest.mark.parametrize("radius", [0.1e-3, 0.3e-3, 1e-3])
def test_cells_at_rounded_ends_are_elements_of_both_blocks(radius):
    finite = pair(end=BodyEnd("radius", radius))
    for half_width in np.geomspace(0.05e-3, 0.4e-3, 7):
        for cells in meshes_of(finite, half_width, CellSizes()):
            for body in finite.bodies:
                assert block_grid(cells, body).cells == (cells.shape[1], cells.shape[0] // 2)


def test_ten_thousand_contacts_take_a_tenth_of_a_second():
    table = factor_table(pair(8e-3), MEAN_LENGTH)
    contacts = loads(table.pair, 10_000, seed=2)
    table.factors(*contacts)
    start = time.process_time()
    table.factors(*contacts)
    assert time.process_time() - start < 0.2


@pytest.mark.parametrize(
    "finite",
    [pair(8e-3), pytest.param(pair(crown=CROWN), marks=pytest.mark.slow)],
    ids=["overhang", "johns-gohar"],
)
def test_a_turn_with_tilt_takes_at_most_ten_seconds(finite, monkeypatch):
    monkeypatch.setenv("CAMWRIGHT_NO_CACHE", "1")
    theta = np.linspace(0.0, 2 * np.pi, 720)
    force = (30e3 + 90e3 * (1 + np.cos(theta))) * finite.contact_length
    curvature = CURVATURE * (1 + 0.3 * np.sin(theta))
    table, start = factor_table(finite, MEAN_LENGTH), time.process_time()
    moment = table.moment_at_tilt(curvature, force, 5e-4, 0.2 * force * finite.contact_length)
    tilted = table.factors(curvature, force, moment)
    assert time.process_time() - start < 10.0
    assert (tilted.greatest > table.factors(curvature, force).greatest).all()


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((0.0, 500.0, 0.0), "curvature"),
        ((CURVATURE, -1.0, 0.0), "force"),
        ((CURVATURE, 500.0, np.nan), "moment"),
    ],
)
def test_inputs_out_of_bounds_are_named(arguments, field):
    with pytest.raises(InputError, match=field):
        factor_table(pair(), MEAN_LENGTH).factors(*arguments)
    with pytest.raises(InputError, match="mean_length"):
        factor_table(pair(), 6e-3)
