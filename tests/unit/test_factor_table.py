"""Table of axial pressures against contacts solved one by one, between its nodes."""

import time

import numpy as np
import pytest

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
from camwright.pipeline.contact.finite_length.factor_table import GREATEST_MOMENT, factor_table
from camwright.pipeline.contact.finite_length.half_space import half_space_compliance
from camwright.pipeline.contact.finite_length.length_tiers import (
    MEAN_LENGTH,
    cycle_sizes,
    half_space_factors,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import pressure_cells

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


@pytest.mark.parametrize(
    "crown",
    [
        CROWN,
        pytest.param(iso16281(16e-3, LENGTH), marks=pytest.mark.slow),
        pytest.param(CircularCrown(0.5), marks=pytest.mark.slow),
    ],
    ids=["log", "iso", "circular"],
)
def test_crowns_between_the_nodes(crown):
    finite = pair(crown=crown)
    table = factor_table(finite, MEAN_LENGTH)
    rng = np.random.default_rng(4)
    force = np.full(4, 130e3 * LENGTH)
    contacts = np.full(4, 1.1 * CURVATURE), force, rng.uniform(-0.2, 0.2, 4) * force * LENGTH
    direct = one_by_one(finite, *contacts)
    difference = np.abs(table.factors(*contacts).all - direct)[:, :2] / direct[:, 1:2]
    assert difference.max() < table.interpolation_error


@pytest.mark.slow
def test_a_rounded_end_between_the_nodes():
    finite = pair(end=BodyEnd("radius", 0.3e-3))
    table = factor_table(finite, MEAN_LENGTH)
    contacts = np.array([0.9 * CURVATURE]), np.array([150e3 * finite.contact_length]), np.zeros(1)
    direct = one_by_one(finite, *contacts)[0, :2]
    factors = table.factors(*contacts).all[0, :2]
    assert factors[0] == pytest.approx(direct[0], rel=2e-3)
    assert factors[1] == pytest.approx(direct[1], rel=table.interpolation_error)


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
    np.testing.assert_allclose(edges, -edges[::-1], atol=1e-15)


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
    direct = one_by_one(finite, [CURVATURE] * 3, [800.0] * 3, [-0.2, 0.0, 0.2])
    np.testing.assert_allclose(factors.greatest, direct[:, 1], rtol=2e-3)
    assert factors.end_means[1, 0] > factors.end_means[1, 1]


@pytest.mark.slow
def test_a_contact_too_light_for_its_cells_has_the_pressure_of_a_heavier_one():
    finite = pair(crown=CircularCrown(0.2))
    table = factor_table(finite, MEAN_LENGTH)
    forces = np.array([2.0, 8.0, 400.0])
    half_width = np.sqrt(4 * forces / LENGTH / (np.pi * finite.contact_modulus * CURVATURE))
    pressure = table.factors(CURVATURE, forces).greatest * half_width
    assert pressure[0] <= 1.001 * pressure[1]
    assert pressure[1] < pressure[2]
    # Hertz: p0 of the ellipse grows with the cube root of the force, and is exceeded by the bound.
    assert pressure[0] / pressure[2] > (2.0 / 400.0) ** (1 / 3)


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


def test_ten_thousand_contacts_take_a_tenth_of_a_second():
    table = factor_table(pair(8e-3), MEAN_LENGTH)
    contacts = loads(table.pair, 10_000, seed=2)
    table.factors(*contacts)
    start = time.process_time()
    table.factors(*contacts)
    assert time.process_time() - start < 0.2


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
