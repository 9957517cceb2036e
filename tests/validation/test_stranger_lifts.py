"""Lifts as others write them: measured by a cam tester, or by points with dwells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.geometry.extrema import greatest
from camwright.geometry.measured_contour import inspected
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift, lift_origin
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.solver import solve
from camwright.pipeline.studies.cam_inspection import read_measured

STRANGERS = Path(__file__).parents[1] / "data" / "strangers"
MEASURED, POINTS = STRANGERS / "18-inspect-lift", STRANGERS / "19-points-dwell"


@pytest.mark.parametrize("name", ["case", "no_noise", "noise_2um"])
def test_a_measured_lift_has_undercut_and_jump_of_the_law_behind_it(name: str) -> None:
    """Cycloidal, 10 mm in 120 deg: 0.588, and 6635.38 rpm by the least quotient at 500 000 angles.

    At the 72 positions of the case it is 6648 rpm; the fit is within 0.5 % of the jump.
    """
    case = read_case(MEASURED / f"{name}.toml")
    contour = case.contour(given_lift(case))
    checks = {check.id: check for check in solve(case, contour, tier=Tier.SCREENING).checks}
    assert checks["undercut"].demand == pytest.approx(0.588, abs=5e-4)
    rpm = checks["jump_speed"].as_record()["demand"]
    assert rpm == pytest.approx(6635.38, rel=1e-5 if name == "case" else 5e-3)


def test_the_noise_of_a_table_below_zero_is_stated() -> None:
    case = read_case(MEASURED / "no_noise.toml")
    words = lift_origin(case)
    assert "falls below zero, without lift.noise: noise of " in words
    noise = float(words.partition("noise of ")[2].partition(" um")[0])
    assert noise == pytest.approx(2.0, rel=0.2)
    assert "below zero" not in lift_origin(read_case(MEASURED / "noise_2um.toml"))


def test_a_table_far_below_zero_is_refused_with_its_place(tmp_path: Path) -> None:
    rows = (MEASURED / "measured_lift.csv").read_text(encoding="utf-8").splitlines()
    rows[351] = "350,-0.5"
    (tmp_path / "measured_lift.csv").write_text("\n".join(rows), encoding="utf-8")
    for name in ("no_noise", "noise_2um"):
        text = (MEASURED / f"{name}.toml").read_text(encoding="utf-8")
        case = parse_case(text, tmp_path)
        with pytest.raises(
            InputError, match=r"lift\.values = -0\.5 mm at 350 deg, must be >= -0\.0"
        ):
            given_lift(case)


@pytest.mark.parametrize(
    ("name", "depth", "place", "points"),
    [
        ("a", "-0.6761 mm", "330 deg", "300 deg (0 mm) and 360 deg (0 mm)"),
        ("b", "-0.00349 mm", "355.8 deg", "345 deg (0 mm) and 360 deg (0 mm)"),
        ("c", "-0.6761 mm", "330 deg", "300 deg (0 mm) and 360 deg (0 mm)"),
    ],
)
def test_the_overshoot_of_a_spline_is_told_as_such(
    name: str, depth: str, place: str, points: str
) -> None:
    """Depth by scipy's periodic quintic spline: -0.6761 mm."""
    case = read_case(POINTS / f"{name}.toml")
    with pytest.raises(InputError) as error:
        given_lift(case)
    message = str(error.value)
    assert message.startswith(f"lift.point = a spline down to {depth}, must be >= 0 mm")
    assert f"overshoots at {place}, between the points at {points}" in message
    assert 'write dwells as segments (lift.kind = "segments", law = "dwell")' in message


def test_an_overshoot_above_zero_is_stated() -> None:
    text = (POINTS / "a.toml").read_text(encoding="utf-8").replace('lift = "', 'lift = "1')
    case = parse_case(text.replace('lift = "110', 'lift = "19'))  # 10 to 19 mm: nothing below zero
    high = greatest(given_lift(case).spline, 5760)
    assert high.value > 0.019
    assert "between equal points it overshoots by 0." in lift_origin(case)


def test_the_lift_of_a_cam_tester_is_inspected_as_a_contour_is() -> None:
    """Noise of 2 um about the drawing: no phase, no size, and its own scatter."""
    case = read_case(MEASURED / "case.toml")
    contour = case.contour(given_lift(case))
    points = read_measured(MEASURED / "measured_lift.csv", contour)
    assert points.shape == (2, 360)
    found = inspected(contour, points)
    assert abs(found.phase) < np.radians(2e-3)
    assert abs(found.size) < 3 * 2e-6 / np.sqrt(360)
    rms = float(np.sqrt(np.mean(found.deviation**2)))
    assert rms == pytest.approx(2e-6, rel=0.15)  # times the cosine of the pressure angle
    assert np.abs(found.deviation).max() > 0.5 * case.workshop_order.tolerance  # of +-4 um
