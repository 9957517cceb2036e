"""A cam under the weight of its follower alone: tests/data/gravity_lift.toml."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from held_cams import assert_refused, ids_where_all_pass, running_in

from camwright.pipeline.base.external_force import STANDARD_GRAVITY
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.preview import preview_case

FILE = Path(__file__).parents[1] / "data" / "gravity_lift.toml"


@cache
def trial():
    return preview_case(read_case(FILE), corners=False)


def test_the_contact_bears_weight_and_inertia():
    """m (g + s'' w^2) on the rigid stem without friction of the guides, and in the dwells."""
    cycle, _ = running_in(trial())
    loads, lift = cycle.loads, cycle.contour.lift
    pressed = 8.0 * (STANDARD_GRAVITY + lift(loads.theta, 2) * cycle.cam_speed**2)
    assert loads.required_force == pytest.approx(pressed, abs=1e-6)
    assert (loads.normal_force > 0.0).all() and not loads.held
    still = np.abs(loads.lift_slope) == 0.0
    assert loads.axial_force[still] == pytest.approx(pressed[still], abs=1e-6)


def test_the_case_passes_by_check():
    made = ids_where_all_pass(trial())
    assert "contact_force" in " ".join(made) and "landing_speed" not in made


def test_a_cam_too_fast_for_the_weight_fails():
    """At 150 rpm the weight is less than the inertia: the follower leaves the cam."""
    text = FILE.read_text(encoding="utf-8").replace('"60 rpm"', '"150 rpm"')
    text = text.replace('overspeed = "70 rpm"', 'overspeed = "160 rpm"')
    checks = preview_case(parse_case(text), corners=False).checks
    assert {each.id for each in checks if each.status == "fail"} & {"jump", "contact_force_margin"}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('gravity_angle = "0 deg"', 'gravity_angle = "90 deg"', "follower.gravity_angle = 90 deg"),
        ('gravity_angle = "0 deg"\n', "", "follower.gravity_angle = missing, must be < 90 deg"),
        ("[mechanism]", '[spring]\nrate = "1 kN/m"\npreload = "5 N"\n\n[mechanism]',
         'spring = a table, must be left out with cam.closure = "gravity"'),
    ],
)  # fmt: skip
def test_refusals_of_the_case(old, new, message):
    assert_refused(FILE, old, new, message)
