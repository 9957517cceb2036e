"""Each remedy of the published GX120, put into its case, turns its check to pass.

The line of a remedy is read back as a user would read it, and the changed case is previewed anew
with every tolerance corner: none of the search is used but the way to put a part into a case.
"""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path

import pytest
from small_machine import small_machine

from camwright.pipeline.case.case_file import case_of, parse_case, read_case, with_values
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.remedies.remedy import WIDTH
from camwright.pipeline.search.remedies.remedy_search import (
    IN_A_RUN,
    Failure,
    failures_of,
    order_of,
    remedies,
    remedies_of,
    texts_of,
    with_remedies,
)

GX120 = Path(__file__).parents[2] / "cases" / "gx120.toml"
NONE = "no single change cures it"
CURED = (
    "contact_at_overspeed", "contact_force_margin", "elastic_contact", "guide_pressure_A",
    "guide_edge_pressure_A", "shakedown", "jam_index", "jam_index_friction_max", "jump",
    "jump_speed", "pressure_angle",
)  # fmt: skip


@pytest.fixture(scope="module")
def trial() -> Trial:
    return preview_case(read_case(GX120))


@pytest.fixture(scope="module")
def texts(trial: Trial) -> dict[str, str]:
    return {name: remedy.text for name, remedy in remedies_of(trial).items()}


def changes_in(text: str) -> dict[str, str]:
    """Changes of the line of a remedy: ``KEY: VALUE, KEY: VALUE (rating); ...``."""
    clause = text.split("; ")[0]
    return dict(re.findall(r"([a-z_][a-z_.0-9\[\]]*): ([^,(]*[^,( ])", clause))


def test_a_remedy_read_back_cures_its_check(trial: Trial) -> None:
    case = read_case(GX120)
    known = {one.check: one for one in failures_of(trial)}
    two = [known[name] for name in ("jump_speed", "pressure_angle")]
    cures = remedies(case, case.folder, None, two)
    assert list(cures) == ["jump_speed", "pressure_angle"]
    for name, remedy in cures.items():
        assert_cures(name, remedy.text)
    # the pressure angle follows tan(alpha) = s'/(d + s) at the same lift: d grows by as much
    angle = next(one for one in trial.checks if one.id == "pressure_angle")
    assert angle.cam_angle is not None
    lift, slope = (float(trial.lift(angle.cam_angle, k)) for k in (0, 1))
    least = abs(slope) / math.tan(math.radians(30.0)) - lift
    prime = float(changes_in(cures["pressure_angle"].text)["cam.prime_radius"].removesuffix(" mm"))
    # the worst angle moves a little towards the greater slope, and the line profile adds to it
    assert 1e3 * least < prime < 1.02 * 1e3 * least


def test_no_failure_costs_nothing_and_evidence_has_no_remedy(trial: Trial) -> None:
    assert remedies(trial.case, None, None, ()) == {}
    assert DECLARED["held_distance"].levers == ()
    assert remedies(trial.case, None, None, [Failure("held_distance", 2.0, ())]) == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", CURED)
def test_the_remedies_of_the_gx120_hold(texts: dict[str, str], name: str) -> None:
    assert_cures(name, texts[name])


@pytest.mark.slow
def test_further_remedies_of_the_gx120_hold(texts: dict[str, str]) -> None:
    others = [name for name, text in texts.items() if NONE not in text and name not in CURED]
    for name in others:
        assert_cures(name, texts[name])


@pytest.mark.slow
def test_a_crown_cures_the_pressure_at_the_ends() -> None:
    narrow = {"cam.width": "7 mm", "roller.width": "7 mm"}
    case = with_values(case_of(tomllib.loads(small_machine("narrow"))), narrow)
    failing = [one for one in failures_of(preview_case(case)) if one.check == "edge_pressure"]
    (remedy,) = remedies(case, None, None, failing).values()
    changes = changes_in(remedy.text)
    assert list(changes) == ["roller.crown.kind", "roller.crown.line_load"]
    crowned = preview_case(Change.of(changes).applied(case, None))
    status = {one.id: one.status for one in crowned.checks}
    assert (status["edge_pressure"], status["contact_pressure"]) == ("pass", "pass")


@pytest.mark.slow
def test_what_no_single_change_cures_is_told(trial: Trial, texts: dict[str, str]) -> None:
    failing = [one.id for one in trial.checks if one.must_have and one.status == "fail"]
    assert list(texts) == [one.check for one in failures_of(trial)]
    assert set(texts) == set(failing)
    assert max(map(len, texts.values())) <= WIDTH
    uncured = [name for name, text in texts.items() if text.startswith(NONE)]
    assert texts["roller_static"] == f"{NONE}; first keep the follower on the cam"
    assert set(uncured) == set(texts) - set(CURED) - {"guide_pv_A", "friction_power"}


@pytest.mark.slow
def test_two_workers_find_the_same_remedies(trial: Trial, texts: dict[str, str]) -> None:
    order = order_of(trial, GX120.parent)
    assert [each.check for each in order.failures] == list(texts)[: IN_A_RUN // 3]  # load cases
    whole = order._replace(failures=failures_of(trial), sought=tuple(texts))
    again = {name: text for part in whole.parts for name, text in texts_of(part).items()}
    assert len(whole.parts) == 2 and again == texts
    marked = {one.id: one.remedy for one in with_remedies(trial.checks, again)}
    assert {name: text for name, text in marked.items() if text} == texts


FEEBLE = {
    "wear": {"limits.target_life": "50000 h"},
    "pressure": {"follower.pivot.bush.pressure_limit": "9 MPa"},
    "section": {
        "follower.arm.depth": "14 mm", "follower.arm.bore": "10 mm", "follower.arm.hub": "20 mm",
    },
}  # fmt: skip
"""Values of the first case of an arm with which its pivot wears or is pressed too much, or its
section is too weak."""
STRENGTHENED = {
    "wear": {"pivot_wear": "follower.pivot.bush.length"},
    "pressure": {"pivot_pressure": "follower.pivot.bush.length"},
    "section": {"arm_fatigue_pivot": "follower.arm.depth", "arm_yield": "follower.arm.depth"},
}


@pytest.mark.parametrize("feeble", [
    "wear", *(pytest.param(each, marks=pytest.mark.slow) for each in ("pressure", "section")),
])  # fmt: skip
def test_the_remedies_of_pivot_and_arm_hold(feeble: str) -> None:
    """Each failing check of pivot and arm has the key that cures it, and is cured by its value."""
    first = parse_case(first_case("swing", "arm").text).with_positions(36)
    case = with_values(first, FEEBLE[feeble])
    failing = failures_of(preview_case(case, corners=False))
    cures = remedies(case, None, None, failing)
    keys = {name: next(iter(changes_in(each.text))) for name, each in cures.items()}
    assert keys == STRENGTHENED[feeble]
    for name, remedy in cures.items():
        changed = Change.of(changes_in(remedy.text)).applied(case, None)
        one = next(each for each in preview_case(changed, corners=False).checks if each.id == name)
        assert one.status == "pass", f"{remedy.text}: {one}"


def assert_cures(name: str, text: str) -> None:
    """The line of a remedy, applied to the case, turns its check to pass."""
    case = read_case(GX120)
    changed = Change.of(changes_in(text)).applied(case, case.folder)
    one = next(one for one in preview_case(changed).checks if one.id == name)
    assert one.status == "pass", f"{text}: {one}"
