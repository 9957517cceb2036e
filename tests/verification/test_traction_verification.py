"""Tractions against closed forms, published figures and independent kernels."""

import numpy as np
import pytest
from carter_traction import rolling_traction
from scipy.optimize import brentq

from camwright.pipeline.contact import hertz
from camwright.pipeline.contact import traction as tangential
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.halfplane import settlement
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_in_plane, von_mises
from camwright.pipeline.contact.tangential_patch import tangential_patch

# Peak in-plane shear and von Mises stress over p0 under sliding (nu = 0.3), from the field of
# McEwen evaluated to 1e-9.
SLIDING = [
    (0.05, 0.30141, 0.55949),
    (0.10, 0.30483, 0.56545),
    (0.15, 0.31063, 0.57553),
    (0.20, 0.31899, 0.58999),
    (0.25, 0.33022, 0.60926),
    (0.30, 0.34488, 0.66663),
]


def test_carter_of_the_published_example():
    """Vollebregt, user guide of CONTACT, 2D Carter: G = 82 GPa, nu = 0.28, R = 500 mm, a = 1 mm."""
    E = 2 * 82e9 * 1.28
    modulus = hertz.contact_modulus(E, 0.28, E, 0.28)
    half_width, p0 = hertz.line_contact(178.90e3, 0.5, modulus)
    assert half_width == pytest.approx(1e-3, rel=1e-4)
    assert p0 == pytest.approx(113.89e6, rel=1e-4)
    assert tangential.stick_half_width(0.64) == pytest.approx(0.6, rel=1e-12)
    assert tangential.creepage(0.64, 0.3, half_width, 0.5) == pytest.approx(2.4e-4, rel=1e-3)


def test_bentall_johnson_of_the_published_example():
    """Same guide: Al and steel rollers of 50 mm, a = 0.1 mm, creepage 5.259e-4 without friction.

    Contact pressure by Hertz; the slip of free rolling changes sign where half of the load is
    enclosed (Bentall and Johnson 1967), at the root of (2/pi)(x sqrt(1 - x^2) + arcsin x) = 1/2.
    """
    shear, nu = np.array([23.0e9, 82.0e9]), np.array([0.31, 0.28])
    E = 2 * shear * (1 + nu)
    modulus = hertz.contact_modulus(E[0], nu[0], E[1], nu[1])
    half_width, p0 = hertz.line_contact(16.20e3, 0.025, modulus)
    assert half_width == pytest.approx(0.1e-3, rel=1e-3)
    half = brentq(lambda x: x * np.sqrt(1 - x**2) + np.arcsin(x) - np.pi / 4, 0.0, 1.0)
    stretch = (1 - 2 * nu) * (1 + nu) / E
    creepage = abs(stretch[0] - stretch[1]) * p0 * np.sqrt(1 - half**2)
    assert creepage == pytest.approx(5.259e-4, rel=1e-2)  # the guide prints its factor to 0.1 %


def static_traction(x, ratio):
    """Cattaneo (1938), Mindlin (1949): the stick zone of `stick_half_width` is in the middle."""
    stick = float(tangential.stick_half_width(ratio))
    inside = np.sqrt(np.maximum(1 - (x / stick) ** 2, 0.0))
    return np.sqrt(np.maximum(1 - x**2, 0.0)) - stick * inside


@pytest.mark.parametrize("ratio", [0.2, 0.64, 0.9])
@pytest.mark.parametrize("law", [rolling_traction, static_traction])
def test_stick_zones_stick(law, ratio):
    """Both surfaces stretch alike where they stick, by the half-plane's own kernel.

    Static: not at all; rolling: by the creepage. Knots at a 1/400 leave 1 % of the full slip's.
    """
    rolling = law is rolling_traction
    knots = np.linspace(-1, 1, 801)
    traction = law(knots[1:-1], ratio)
    assert np.trapezoid(traction, knots[1:-1]) == pytest.approx(ratio * np.pi / 2, rel=2e-3)
    stick = float(tangential.stick_half_width(ratio))
    x = (stick - 1 if rolling else 0.0) + 0.85 * stick * np.linspace(-1, 1, 41)
    # A tangential load moves the surface along as a normal one moves it down; two bodies.
    moved = 2 * traction @ settlement(x, knots)
    slope = np.diff(moved) / np.diff(x)
    # In units of mu p0 / E'; p0 / E' is a / (4 R) for like bodies, so creep is 4 (1 - stick).
    creep = 4 * (1 - stick) if rolling else 0.0
    assert np.abs(slope) == pytest.approx(np.full(40, creep), abs=0.02)


@pytest.mark.parametrize(("friction", "shear", "mises"), SLIDING)
def test_sliding_stress_of_the_template(friction, shear, mises):
    """0.2 % at sixteen edges to the half-width, as without friction."""
    normal, along = contact_patch(0.3), tangential_patch(0.3)
    assert np.array_equal(normal.points, along.points)
    pressure = np.sqrt(np.maximum(1 - normal.shapes.centres**2, 0))
    field = ((normal.stress + friction * along.stress) @ pressure)[:, :, None]
    found, _ = along.peaks(shear_in_plane(field))
    assert found[0] == pytest.approx(shear, rel=2e-3)
    found, place = along.peaks(von_mises(field, 0.3))
    assert found[0] == pytest.approx(mises, rel=2e-3)
    assert (place[1, 0] < 0.02) == (friction > 0.26283)


def test_sliding_field_of_the_template():
    normal, along = contact_patch(0.3), tangential_patch(0.3)
    pressure = np.sqrt(np.maximum(1 - normal.shapes.centres**2, 0))
    x, depth = along.points
    exact = hertz.subsurface_stress(x, depth, 1.0) - hertz.subsurface_stress(x, depth)
    inside = (np.hypot(x, depth) < 1.5) & (depth > 0.2)
    # The recovered stress of a quarter half-width of surface carries the kink of the edge.
    assert np.abs(along.stress @ pressure - exact)[:, inside].max() < 0.006


def test_full_traction_of_rolling_is_that_of_sliding():
    for friction, tau, mises in SLIDING:
        shear, equivalent = tangential.rolling_increase(0.3, friction, np.array([0.0, 1.0]))
        assert shear == pytest.approx([1.0, tau / hertz.SHEAR_MAX], rel=3e-5)
        assert equivalent == pytest.approx([1.0, mises / 0.557516], rel=3e-5)


@pytest.mark.parametrize("ratio", [0.19, 0.64, 0.91])
def test_traction_of_rolling_against_finite_elements(ratio):
    """The template under Carter's traction, 0.5 %: that of a smaller ellipse on its mesh."""
    normal, along, friction = contact_patch(0.3), tangential_patch(0.3), 0.2
    x = normal.shapes.centres
    pressure = np.sqrt(np.maximum(1 - x**2, 0.0))
    traction = np.where(np.abs(x) < 1, rolling_traction(x, ratio), 0.0)
    field = (normal.stress @ pressure + friction * along.stress @ traction)[:, :, None]
    shear, mises = tangential.rolling_increase(0.3, friction, np.array(ratio))
    assert shear * hertz.SHEAR_MAX == pytest.approx(
        along.peaks(shear_in_plane(field))[0][0], rel=5e-3
    )
    assert mises * 0.557516 == pytest.approx(along.peaks(von_mises(field, 0.3))[0][0], rel=5e-3)


def test_eccentric_cam_that_cannot_roll():
    """A pin that drags 3.5 N m on a roller of 17.5 mm under 93 N (slider-crank comparison, 2024).

    Rolling would take twice the normal force along the surface, so it slips at any likely
    friction; the loss is that of sliding, far below that of the drag at full spin.
    """
    count, friction = 360, 0.046
    speed, arm, radius = 37.22, 0.0625, 0.0175
    spin = np.full(count, arm * speed / radius)
    torque = 0.026 * float(spin[0])
    force, ones = np.full(count, 93.0), np.ones(count)
    found = tangential.rolling_contact(
        force, spin, 0.0 * spin, spin * radius, 1e-5 * ones, 0.012 * ones,
        drag=tangential.Drag(2.75e-4, friction, torque), radius=radius, period=2 * np.pi / speed,
    )  # fmt: skip
    assert torque == pytest.approx(3.46, rel=0.01)
    assert found.demand == pytest.approx(np.full(count, 197.5), rel=0.01)
    assert found.utilisation.min() > 40
    assert found.skidding.all()
    assert found.force == pytest.approx(friction * force)
