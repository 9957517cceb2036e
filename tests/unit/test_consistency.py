"""Findings: what torque, speed, inertia and energy say of one another, flagged beyond 10 %."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.crankshaft import Inertia, crank_motion
from camwright.pipeline.engine.torque_consistency import (
    Implied,
    energy_finding,
    implied_inertia,
    inertia_finding,
    ratio_finding,
    work_finding,
)

THETA = np.arange(720) * (4.0 * np.pi / 720)
TORQUE = 10.0 * np.sin(THETA)  # integral -10 cos: std 10/sqrt(2) J, swing 20 J


def finding(given, implied):
    return Implied("x", "x", given, implied, "J", "")


@pytest.mark.parametrize(
    ("implied", "flagged"), [(1.099, False), (1.101, True), (0.901, False), (0.899, True)]
)
def test_ten_percent_is_the_flag(implied, flagged):
    assert finding(1.0, implied).flagged is flagged


def test_nothing_given_and_not_a_number_are_told():
    assert finding(0.0, 1.0).flagged
    assert finding(0.0, 1.0).as_record()["difference_percent"] is None
    assert not finding(0.0, 0.0).flagged
    assert finding(1.0, np.nan).flagged


def test_implied_inertia_of_a_known_wave():
    expected = 10.0 / np.sqrt(2.0) / (150.0 * 3.0)
    assert implied_inertia(TORQUE, 150.0, 3.0) == pytest.approx(expected, rel=1e-12)


def test_implied_inertia_is_that_of_the_motion():
    """In the limit of a small ripple; 0.1 % at a ripple of 2 %."""
    speed = crank_motion(TORQUE, Inertia.constant_only(0.0139), 151.0).statistics
    found = inertia_finding(0.0139, TORQUE, speed.mean, speed.std)
    assert abs(found.difference) < 1e-3
    assert inertia_finding(2.603e-3, TORQUE, speed.mean, speed.std).flagged


def test_ratio_is_two_for_a_cam_at_half_speed():
    assert not ratio_finding(TORQUE, 2.0 * TORQUE, 2.0).flagged
    literal = ratio_finding(TORQUE, TORQUE, 2.0)
    assert literal.flagged
    assert literal.difference == pytest.approx(-0.5)


def test_energy_and_work():
    assert energy_finding(TORQUE, 20.0).difference == pytest.approx(0.0, abs=1e-4)
    assert energy_finding(TORQUE, 17.0).flagged
    assert not work_finding(3.7, 3.69).flagged


def test_bad_speeds_are_refused():
    for speed, std in ((0.0, 1.0), (np.nan, 1.0), (150.0, 0.0), (150.0, np.inf)):
        with pytest.raises(InputError):
            implied_inertia(TORQUE, speed, std)


def test_the_line_on_the_screen_tells_both_values_and_the_flag():
    from camwright.pipeline.results.check_report import consistency_line

    line = consistency_line({"load_case": "idle"} | finding(2.0, 1.5).as_record())
    assert line == "consistency, idle: x: given 2, implied 1.5 J (-25.0 %); MORE THAN 10 % APART"
    bare = consistency_line({"load_case": "idle"} | finding(0.0, 1.0).as_record())
    assert "(beyond bounds); MORE" in bare
    calm = consistency_line({"load_case": "idle"} | finding(2.0, 2.1).as_record())
    assert calm.endswith("(+5.0 %)")
