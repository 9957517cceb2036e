"""The finite elements of two cylinders against Hertz, over all sizes and materials."""

import numpy as np
import pytest

from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.studies.two_cylinders import (
    TwoCylinders,
    closed_form,
    conforming,
    finite_elements,
)

STEEL = Elastic(210e9, 0.3)
FIGURES = ("p0", "half_width", "tau_max", "von_mises")


def off(pair):
    """Largest difference of a figure from Hertz, relative, and the error bar."""
    exact, found = closed_form(pair), finite_elements(pair)
    worst = max(abs(getattr(found.figures, n) / getattr(exact, n) - 1) for n in FIGURES)
    return worst, found.error_bar


@pytest.mark.parametrize("load", 1e5 * np.logspace(-6, 0, 4))
@pytest.mark.parametrize("ratio", [1.0, 1e4])
def test_any_size_and_load(load, ratio):
    """Six decades of load, radii from alike to 1 to 10 000; 0.1 %, and the bar covers it."""
    worst, bar = off(TwoCylinders(0.01, 0.01 * ratio, STEEL, STEEL, load))
    assert worst < 1e-3
    assert worst < bar < 5e-3


@pytest.mark.parametrize("ratio", [1.0, 1e3])
@pytest.mark.parametrize("poisson", [0.0, 0.25, 0.49])
def test_any_material(ratio, poisson):
    """E 1 to 1000, nu up to 0.49: no locking, p0 within 0.1 %."""
    pair = TwoCylinders(0.01, 0.02, Elastic(210e9, poisson), Elastic(210e9 / ratio, 0.3), 1e3)
    worst, bar = off(pair)
    assert abs(finite_elements(pair).figures.p0 / closed_form(pair).p0 - 1) < 1e-3
    assert worst < max(bar, 1e-3)


def test_hollow_flank():
    worst, bar = off(TwoCylinders(0.008, -0.02, STEEL, STEEL, 1e5))
    assert worst < 2e-3
    assert worst < bar


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_sliding(friction):
    worst, bar = off(TwoCylinders(0.01, np.inf, STEEL, STEEL, 1e5, friction))
    assert worst < 2e-3
    assert worst < bar


def test_nafems_case_one():
    """NAFEMS R0094 (Konter 2006), case 1: p0 3585.36 MPa by Hertz, 3592.5 MPa in full 2D."""
    pair = TwoCylinders(0.05, np.inf, STEEL, Elastic(70e9, 0.3), 35e6)
    assert closed_form(pair).p0 == pytest.approx(3585.36e6, rel=1e-5)
    found = finite_elements(pair)
    assert found.figures.p0 == pytest.approx(3592.5e6, rel=1e-3)
    assert found.figures.half_width == pytest.approx(6.21463e-3, rel=3e-3)
    assert abs(found.figures.p0 / 3592.5e6 - 1) < found.error_bar


@pytest.mark.parametrize(
    ("degrees", "clearance", "p0"), [(20, 19.535251, 1.852391), (60, 1.067202, 0.711721)]
)
def test_persson_table(degrees, clearance, p0):
    """Persson (1964) at two half contact angles: E' dR / Q and p0 R / Q."""
    R, load = 0.01, 1e6
    gap = clearance * load / STEEL.plane_strain_modulus
    found = conforming(TwoCylinders(R, -(R + gap), STEEL, STEEL, load))
    for angle, pressure in ((found.persson_angle, found.persson_p0), (found.angle, found.p0)):
        assert np.degrees(angle) == pytest.approx(degrees, abs=0.2)
        assert pressure * R / load == pytest.approx(p0, rel=5e-3)
