"""PV limits by lubrication, and which lubrication carries a PV."""

import made_trial as made
import pytest
from trial_variants import cycle_with, with_guide

from camwright.pipeline.checks import guide_strength


def unlimited(**values):
    """Guide A without a PV limit of its own."""
    return with_guide("a", **({"pv_limit": None} | values))


@pytest.mark.parametrize(
    ("state", "limit"),
    [("dry", 0.083), ("greased_once", 0.17), ("regularly_greased", 0.33), ("flooded", 0.83)],
)
def test_nylon_is_limited_by_its_lubrication(state, limit):
    check = guide_strength.guide_pv_a(unlimited(lubrication=state))
    assert check.as_record()["limit"] == pytest.approx(limit, rel=1e-12)
    assert state.replace("_", " ") in check.source


def test_a_limit_of_the_guide_goes_before_the_graded_one():
    check = guide_strength.guide_pv_a(unlimited(lubrication="dry", pv_limit=0.5e6))
    assert check.limit == pytest.approx(0.5e6)
    assert "graded" not in check.source


def test_the_limits_of_nylon_are_not_those_of_another_bush():
    bronze = made.case().materials["bronze"]
    check = guide_strength.guide_pv_a(unlimited(material=bronze, lubrication="flooded"))
    assert check.limit is None
    assert check.status == "not_evaluated"
    assert "nylon" not in check.note


@pytest.mark.parametrize(
    ("scale", "says"),
    [(0.9, "permissible for nylon dry"), (1.1, "permissible for nylon greased once"),
     (11.0, "above all PV limits of nylon")],
)  # fmt: skip
def test_least_lubrication_that_carries_the_pv(scale, says):
    """The load that makes 0.083 MPa m/s, taken times 0.9, 1.1 and 11; 0.83 is the last limit."""
    plain = unlimited(lubrication="dry")
    factor = scale * 0.083e6 / guide_strength.guide_pv_a(plain).demand
    loaded = cycle_with("guides", rubbing_load_a=made.cycle().guides.rubbing_load_a * factor)
    check = guide_strength.guide_pv_a(made.changed_solution(plain, cycles=(loaded,)))
    assert check.demand == pytest.approx(0.083e6 * scale, rel=1e-9)
    assert says in check.note
