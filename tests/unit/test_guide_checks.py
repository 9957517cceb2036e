"""PV limits by lubrication, and how hot the bushes get."""

from types import SimpleNamespace

import fake_trial as fake
import pytest

from pipeline.checks import guides


def evidence(**changes):
    plain = fake.case().guides.a
    guide = fake.changed(plain, **({"pv_limit": None, "lubrication": None} | changes))
    machine = SimpleNamespace(a=guide, b=plain, spacing=0.08)
    return fake.evidence(case=fake.case(guides=machine))


@pytest.mark.parametrize(
    ("state", "limit"),
    [("dry", 0.083), ("greased_once", 0.17), ("regularly_greased", 0.33), ("flooded", 0.83)],
)
def test_nylon_is_limited_by_its_lubrication(state, limit):
    check = guides.bush_pv_a(evidence(material="nylon", lubrication=state))
    assert check.limit == pytest.approx(limit, rel=1e-12)
    assert state.replace("_", " ") in check.source


def test_a_limit_given_goes_before_the_graded_one():
    check = guides.bush_pv_a(evidence(material="nylon", lubrication="dry", pv_limit=0.5e6))
    assert check.limit == pytest.approx(0.5)
    assert "graded" not in check.source


def test_the_limits_of_nylon_are_not_those_of_another_bush():
    check = guides.bush_pv_a(evidence(material="bronze", lubrication="flooded"))
    assert check.limit is None
    assert check.status == "not_evaluated"
    assert "nylon" not in check.note


@pytest.mark.parametrize(
    ("scale", "says"),
    [(0.9, "nylon carries it dry"), (1.1, "nylon carries it greased once"),
     (11.0, "nylon carries it in no lubrication")],
)  # fmt: skip
def test_least_lubrication_that_carries_the_pv(scale, says):
    """The load that makes 0.083 MPa m/s, taken times 0.9, 1.1 and 11; 0.83 is the last limit."""
    given = evidence(material="nylon", lubrication="dry")
    demand = guides.bush_pv_a(given).demand
    cycle = given.cycles[0]
    load = cycle.guides.rubbing_load_a * scale * 0.083 / demand
    loaded = fake.cycle(guides=fake.changed(cycle.guides, rubbing_load_a=load))
    check = guides.bush_pv_a(fake.evidence(case=given.case, cycles=(loaded,)))
    assert check.demand == pytest.approx(0.083 * scale, rel=1e-9)
    assert says in check.note
