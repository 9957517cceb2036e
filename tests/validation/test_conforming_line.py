"""Roller in a concave wall: Persson's closed form, complementarity, Hertz, finite elements.

The finite elements mesh a roller and a recess of their own radii; they share nothing with the
integral equation, its compliances or its gap.
"""

import numpy as np
import pytest
from roller_in_recess_elements import roller_in_recess, wall_axis_stress

from camwright.geometry.errors import InputError
from camwright.pipeline.contact import conforming_line as conforming
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.conforming_line import (
    CONFORMING_FROM,
    FINITE_STRAIN,
    collocated,
    concave_line,
    conforming_line,
)
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.pin_in_hole import (
    persson_clearance,
    persson_pressure,
    pin_in_hole,
)

STEEL, BRONZE, NYLON = Elastic(210e9, 0.3), Elastic(105e9, 0.33), Elastic(3e9, 0.4)
RADIUS, RECESS = 0.0100, 0.0101


def load_at(half_angle, roller, wall, radius=RADIUS, recess=RECESS):
    """Line load, N/m, under which a roller touches up to a half angle, rad."""
    mean = 0.5 / roller.plane_strain_modulus + 0.5 / wall.plane_strain_modulus
    return (recess - radius) / (mean * collocated(float(half_angle), roller, wall).clearance)


def test_persson_for_like_materials():
    """Closed form, 1 to 69 deg: 1e-7 on angle and peak, 1e-6 on the pressure to 0.95 of the edge.

    The error bar of the numbers, without that of finite strains, is not smaller.
    """
    angle = np.radians(np.linspace(1.0, 69.0, 137))
    load = STEEL.plane_strain_modulus * (RECESS - RADIUS) / persson_clearance(angle)
    line = conforming_line(load, RADIUS, np.full(angle.size, RECESS), STEEL, STEEL)
    middle = np.sqrt(RADIUS * RECESS)
    exact = persson_pressure(angle) * load / middle
    np.testing.assert_allclose(line.half_angle, angle, rtol=1e-7)
    np.testing.assert_allclose(line.p0, exact, rtol=1e-7)
    modulus = hertz.contact_modulus(210e9, 0.3, 210e9, 0.3)
    numerical = line.error - FINITE_STRAIN * line.p0 / modulus
    assert (np.abs(line.p0 / exact - 1.0) <= numerical).all()
    np.testing.assert_allclose(line.half_width, middle * np.sin(angle), rtol=1e-7)
    share = np.linspace(-0.95, 0.95, 9)
    at = middle * np.sin(angle[:, None] * share)
    shape = (
        persson_pressure(angle[:, None], angle[:, None] * share) / persson_pressure(angle)[:, None]
    )
    np.testing.assert_allclose(line.pressure(at), line.p0[:, None] * shape, rtol=1e-6)
    assert (line.pressure(middle * np.sin(1.01 * angle)[:, None]) == 0.0).all()


@pytest.mark.parametrize(
    ("roller", "wall"),
    [(STEEL, BRONZE), (NYLON, STEEL), (STEEL, NYLON), (Elastic(1e9, 0.0), STEEL)],
)
def test_unlike_materials_by_complementarity(roller, wall):
    """Hats and harmonics of the same gap: 1e-4 on the peak, 0.2 deg on the edge, 2 to 68 deg."""
    bodies = SolidBar(roller.modulus, roller.poisson), Bush(wall.modulus, wall.poisson)
    for angle in np.radians([2.0, 11.0, 37.0, 68.0]):
        load, middle = load_at(angle, roller, wall), np.sqrt(RADIUS * RECESS)
        line = conforming_line(np.array([load]), RADIUS, np.array([RECESS]), roller, wall)
        other = pin_in_hole(load, middle, RECESS - RADIUS, *bodies)
        assert line.half_angle[0] == pytest.approx(angle, rel=1e-6)
        assert line.p0[0] == pytest.approx(other.peak_pressure, rel=1e-4)
        assert line.half_angle[0] == pytest.approx(other.contact_angle, abs=np.radians(0.2))


def test_two_resolutions_bound_the_error():
    """Eight terms of the pressure against twelve and against twenty-four, extreme materials."""
    for angle in np.radians([3.0, 30.0, 65.0]):
        for pair in ((Elastic(1e9, 0.0), Elastic(1e14, 0.0)), (STEEL, BRONZE)):
            few, many, most = (collocated(angle, *pair, terms).ratio for terms in (8, 12, 24))
            assert abs(many / most - 1.0) < 0.5 * abs(few / many - 1.0) < 1e-4


def test_hertz_at_small_angles():
    """Under vanishing loads the ratio to Hertz tends to 1 in proportion to the width, for walls of
    any radius; of like materials with its square.
    """
    for recess in (1.01 * RADIUS, 1.5 * RADIUS, 40.0 * RADIUS):
        for wall, order in ((STEEL, 2.0), (BRONZE, 1.0)):
            load = load_at(np.radians(1.0), STEEL, wall, RADIUS, recess) * np.array([1e-8, 1e-4])
            line = conforming_line(load, RADIUS, np.full(2, recess), STEEL, wall)
            departure = np.abs(line.p0 / line.p0_hertz - 1.0)
            assert departure[0] < 1e-7
            assert departure[1] < (0.01 * np.radians(1.0)) ** order
            assert line.half_width == pytest.approx(line.half_width_hertz, rel=1e-3)
            share = hertz.SHEAR_MAX * line.p0_hertz
            assert line.tau_max == pytest.approx(share, rel=1e-3)


def test_the_named_limit_keeps_hertz_within_half_a_percent():
    """Any two materials: like and unlike, incompressible and not, one rigid; and it is needed.

    At so small an angle the half angle is the half-width of Hertz over the radius, to 1 %.
    """
    one = [Elastic(1e9, nu) for nu in (0.0, 0.2, 0.35, 0.49)]
    other = [Elastic(E, nu) for E in (1e9, 3e9, 1e14) for nu in (0.0, 0.3, 0.49)]
    pairs = [(a, b) for x in one for y in other for a, b in ((x, y), (y, x))]
    ratios = [collocated(CONFORMING_FROM, *pair).ratio for pair in pairs]
    assert 0.004 < max(abs(1.0 / each - 1.0) for each in ratios) < 0.005


def against_elements(degrees, roller, wall, clearance, knots=48):
    """Ratios of the kernel to the finite elements, peak and half-width, and its error bar."""
    angle, recess = np.radians(degrees), 1.0 + clearance
    load = load_at(angle, roller, wall, 1.0, recess)
    line = conforming_line(np.array([load]), 1.0, np.array([recess]), roller, wall)
    window = min(1.2 * angle * np.sqrt(recess), 1.5)
    solved = roller_in_recess(load, clearance, window, roller, wall, knots)
    return (
        float(line.p0[0]) / solved.peak,
        float(line.half_width[0]) / np.sin(solved.half_angle),
        float(line.error[0]),
    )


def test_a_seeded_contact_by_finite_elements(measured):
    """Required: 0.5 % on the peak; the edge lies between knots of 1/26 of the contact."""
    draw = np.random.default_rng(20261130)
    degrees = float(draw.uniform(5.0, 60.0))
    peak, width, error = against_elements(degrees, STEEL, BRONZE, 1e-4, knots=32)
    measured("Roller in a recess, finite elements: peak pressure", peak, 1.0, rtol=5e-3)
    assert abs(peak - 1.0) < 1e-3 + error
    assert width == pytest.approx(1.0, abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [5.0, 10.0, 20.0, 30.0, 45.0, 60.0])
@pytest.mark.parametrize(("roller", "wall"), [(STEEL, STEEL), (STEEL, BRONZE), (NYLON, STEEL)])
def test_the_whole_range_by_finite_elements(degrees, roller, wall, measured):
    """0.5 % on peak and half-width at half angles of 5 to 60 deg, close fit."""
    peak, width, _ = against_elements(degrees, roller, wall, 1e-4)
    measured("Roller in a recess, finite elements: peak pressure", peak, 1.0, rtol=5e-3)
    measured("Roller in a recess, finite elements: half-width", width, 1.0, rtol=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("degrees", "clearance"), [(5.0, 0.02), (5.0, 0.3), (20.0, 0.02), (20.0, 0.3), (60.0, 0.02)]
)
@pytest.mark.parametrize(("roller", "wall"), [(STEEL, STEEL), (NYLON, STEEL), (STEEL, NYLON)])
def test_the_error_bar_holds_for_wide_recesses(degrees, clearance, roller, wall):
    """Recesses wider by up to 0.3 radii under loads that close them: pressures to 5 % of E*."""
    peak, _, error = against_elements(degrees, roller, wall, clearance)
    assert abs(peak - 1.0) < error + 5e-4  # of the elements


def test_stress_below_the_wall_by_finite_elements():
    """Hole under the pressure of the contact, on its axis: 1 % of the peak pressure."""
    angle, depth = np.radians(25.0), np.array([0.0, 0.15, 0.3, 0.6, 1.0]) * np.sin(np.radians(25.0))
    contact = collocated(angle, STEEL, BRONZE)

    def pressure(phi):
        t = np.minimum(np.abs(phi) / angle, 1.0)
        even = np.cos(2.0 * np.arange(contact.terms.size) * np.arccos(t)[..., None])
        return np.sqrt(1.0 - t**2) * (even @ contact.terms)

    closed = conforming.axis_stress(contact, angle, BRONZE.poisson, depth)
    solved = wall_axis_stress(pressure, angle, BRONZE, depth)
    np.testing.assert_allclose(closed / contact.peak, solved / contact.peak, atol=0.01)


def test_a_wall_is_solved_in_full_from_the_limit_on():
    relative = np.array([0.5, 1.0, 2.0, 2.0, 50.0]) * RADIUS  # convex, plane, concave
    load, radius = np.array([1e6, 1e6, 1e4, 1e6, 1e6]), np.full(5, RADIUS)
    full, line = concave_line(load, relative, radius, STEEL, STEEL)
    assert full.tolist() == [False, False, False, True, True]
    wall = RADIUS * relative[3:] / (relative[3:] - RADIUS)
    direct = conforming_line(load[3:], RADIUS, wall, STEEL, STEEL)
    assert line.p0 == pytest.approx(direct.p0, rel=1e-12)
    assert line.half_width_hertz == pytest.approx(direct.half_width_hertz, rel=1e-12)
    nowhere, none = concave_line(0.0 * load, relative, radius, STEEL, STEEL)
    assert none is None and not nowhere.any()


def test_beyond_the_greatest_angle_the_contact_is_not_known():
    load = load_at(np.radians(69.9), STEEL, STEEL) * np.array([1.0, 1.1])
    line = conforming_line(load, RADIUS, np.full(2, RECESS), STEEL, STEEL)
    for name in ("half_angle", "half_width", "p0", "tau_max", "von_mises"):
        assert np.isnan(getattr(line, name)).tolist() == [False, True], name
    assert np.isfinite(line.p0_hertz).all()


@pytest.mark.parametrize(
    ("load", "radius", "wall", "name"),
    [(-1.0, 1.0, 2.0, "line_load"), (1.0, 2.0, 2.0, "roller_radius"), (1.0, 1.0, np.nan, "wall")],
)
def test_refusals(load, radius, wall, name):
    with pytest.raises(InputError, match=name):
        conforming_line(np.array([load]), radius, np.array([wall]), STEEL, STEEL)
