"""Remedies: levers of the checks, their steps in a case, the line of a remedy."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base.levers import (
    BEARING,
    BUSH_A,
    BUSH_PIVOT,
    CAM_MATERIAL,
    Catalogued,
    Crowned,
    Drilled,
    Scaled,
)
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.case_values import quantity_of, value_of
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.lost_loads import LoadEnd
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.follower.follower_forces import LEAVES, LOCKS
from camwright.pipeline.search.change import PARTS, Change
from camwright.pipeline.search.judge import Depth, Judge
from camwright.pipeline.search.remedies.lever_steps import Workbench, without_exponent
from camwright.pipeline.search.remedies.remedy import WIDTH, Remedy
from camwright.pipeline.search.remedies.remedy_search import (
    LEVELS,
    _greatest_line_load,
    needed_first,
)

GX120 = Path(__file__).parents[2] / "cases" / "gx120.toml"


@pytest.fixture(scope="module")
def case() -> Case:
    return read_case(GX120)


@pytest.fixture(scope="module")
def bench(case: Case) -> Workbench:
    return Workbench(case, case.folder)


def test_every_lever_belongs_to_a_must_have_check_of_the_design() -> None:
    for name, one in DECLARED.items():
        assert not one.levers or (one.must_have and not one.evidence), name
        assert len(set(one.levers)) == len(one.levers), name


def test_every_scaled_key_is_a_number_of_the_case_file() -> None:
    for one in DECLARED.values():
        for lever in one.levers:
            if not isinstance(lever, Scaled):
                continue
            assert 1.0 < lever.most <= math.exp(LEVELS[-1]) * (1.0 + 1e-9), lever
            for key in (*lever.keys, *lever.along):
                assert quantity_of(key.replace("*", "0").replace("{cam}", "s355")), key


@pytest.mark.parametrize(
    ("key", "direction", "size", "text"),
    [
        ("cam.prime_radius", 1, math.log(1.23456), "61.8 mm"),  # 61.728 mm upwards
        ("follower.mass", -1, math.log(1.5), "116 g"),  # 116.67 g downwards
        ("spring.preload", 1, math.log(2.0), "484 N"),  # exact: round-off adds no digit
        ("mechanism.compensation", -1, math.log(3.0), "0.333"),
    ],
)
def test_a_scaled_value_has_three_digits_away_from_that_of_the_case(
    bench: Workbench, key: str, direction: Any, size: float, text: str
) -> None:
    step = bench.scaled(Scaled((key,), direction), size)
    assert step.change == Change(((key, text),))
    assert step.size >= size * (1.0 - 1e-8)
    changed = value_of(step.change.applied(bench.case, bench.folder), key)
    assert changed / value_of(bench.case, key) == pytest.approx(
        math.exp(direction * step.size), rel=1e-12
    )


def test_the_fast_way_makes_the_same_case(bench: Workbench) -> None:
    step = bench.scaled(Scaled(("cam.width", "roller.width", "roller.pin.span"), 1), 0.3)
    # the case has no pin
    assert [key for key, _ in step.change.values] == ["cam.width", "roller.width"]
    judge = Judge(bench.case, engine_torques(bench.case), bench.folder)
    quick, read = (judge.judged(step.change, Depth(), quick=each) for each in (True, False))
    assert quick.solved.case.to_toml() == read.solved.case.to_toml()
    records = [[one.as_record() for one in each.checks.values()] for each in (quick, read)]
    assert records[0] == records[1]


def test_a_greater_roller_keeps_the_base_circle(bench: Workbench) -> None:
    lever = Scaled(("roller.radius",), 1, along=("cam.prime_radius",))
    changed = bench.scaled(lever, math.log(1.5)).change.applied(bench.case, bench.folder)
    assert changed.roller.radius == pytest.approx(12e-3, rel=1e-12)
    assert changed.base_circle == pytest.approx(bench.case.base_circle, rel=1e-12)


def test_the_preload_of_every_load_case_changes(case: Case) -> None:
    two = with_values(case, {"load_case[0].preload": "121 N"})
    step = Workbench(two, None).scaled(Scaled(("spring.preload", "load_case[*].preload"), 1), 0.5)
    assert {key for key, _ in step.change.values} == {"spring.preload", "load_case[0].preload"}


def test_smoothers_act_by_their_own_key(bench: Workbench, case: Case) -> None:
    spacing = Scaled(("smoothing.spacing",), 1, smoothers=("moving_average",))
    width = Scaled(("smoothing.width",), 1, smoothers=("gaussian",))
    assert bench.acts(spacing) and not bench.acts(width)
    other = Workbench(with_values(case, {"smoothing.kind": "gaussian"}), None)
    assert other.acts(width) and not other.acts(spacing)
    assert not bench.acts(Scaled(("camshaft.diameter",), 1))  # the case has no camshaft


def test_better_bearings_come_by_their_dimensions_first(bench: Workbench) -> None:
    lever = Catalogued(BEARING, "C0", inverse=True)
    steps = bench.cards(lever)
    assert [dict(step.change.values)[BEARING] for step in steps[:2]] == [
        "maker_2_625",
        "track_roller_24x7",
    ]
    assert all(a.size <= b.size for a, b in pairwise(steps))
    assert steps[0].figure == "C0 670 N"
    changed = steps[1].change.applied(bench.case, bench.folder)
    assert (changed.roller.bearing.C0, changed.roller.radius) == (1300.0, 12e-3)
    assert changed.base_circle == pytest.approx(bench.case.base_circle, rel=1e-12)


def test_a_bush_and_a_material_come_from_their_cards(bench: Workbench) -> None:
    bushes = bench.cards(Catalogued(BUSH_A, "pressure_limit"))
    assert [dict(step.change.values)[BUSH_A] for step in bushes] == [
        "pom", "bronze", "wrapped_bronze", "ptfe_lined",
    ]  # fmt: skip
    changed = bushes[-1].change.applied(bench.case, bench.folder)
    assert changed.guides.a.pressure_limit == 56e6
    assert changed.guides.b == bench.case.guides.b
    assert changed.guides.a.length == bench.case.guides.a.length
    materials = bench.cards(Catalogued(CAM_MATERIAL, "yield_strength"))
    steel = next(s for s in materials if dict(s.change.values)[CAM_MATERIAL] == "through_hardened")
    assert steel.figure == "yield strength 650 MPa"
    assert steel.change.applied(bench.case, bench.folder).cam.material.yield_strength == 650e6


def test_a_lower_friction_is_the_better_one(bench: Workbench) -> None:
    steps = bench.cards(Catalogued("guides.b", "friction_max", less=True))
    assert [dict(step.change.values)["guides.b"] for step in steps] == [
        "bronze", "wrapped_bronze", "pa66_regularly_greased", "sintered_bronze",
    ]  # fmt: skip


def test_the_bush_of_a_pivot_comes_from_the_same_cards(bench: Workbench) -> None:
    """A bush acts where the case has it: in guides, or in the pivot of an arm without needles."""
    arm = Workbench(read_case(GX120.parent / "gx120-arm.toml"), None)
    lever, guide = Catalogued(BUSH_PIVOT, "pressure_limit"), Catalogued(BUSH_A, "pressure_limit")
    assert arm.acts(lever) and not arm.acts(guide)
    assert bench.acts(guide) and not bench.acts(lever)
    assert arm.cards(lever) == []  # none bears more than its own
    bushes = arm.cards(Catalogued(BUSH_PIVOT, "friction_max", less=True))
    assert [dict(step.change.values)[BUSH_PIVOT] for step in bushes] == [
        "bronze", "wrapped_bronze", "pa66_regularly_greased", "sintered_bronze",
    ]  # fmt: skip
    pivots = [each.follower.pivot for each in (bushes[0].change.applied(arm.case, None), arm.case)]
    changed, before = (None if each is None else each.bush for each in pivots)
    assert changed is not None and before is not None
    assert (changed.friction_max, changed.length) == (0.15, before.length)
    for name in ("pivot_pressure", "pivot_speed", "pivot_jam_index"):
        keys = {each.key for each in DECLARED[name].levers if isinstance(each, Catalogued)}
        assert keys == {BUSH_PIVOT}, name


def test_a_counter_hole_is_drilled_once(bench: Workbench) -> None:
    assert bench.acts(Drilled())
    drilled = bench.drilled(Drilled()).change.applied(bench.case, bench.folder)
    assert drilled.cam.counter_hole is not None
    assert not Workbench(drilled, None).acts(Drilled())


@pytest.mark.parametrize(
    ("file", "key"), [("gx120", "roller.crown"), ("gx120-flat-face", "follower.face.crown")]
)
def test_a_straight_follower_is_crowned_for_its_line_load(file: str, key: str) -> None:
    case = read_case(GX120.with_name(f"{file}.toml"))
    first, again = Crowned(first=True), Crowned(first=False)
    bench = Workbench(case, None, line_load=120.04e3)
    loads = [dict(step.change.values)[f"{key}.line_load"] for step in bench.crowns(first)]
    assert loads == ["60.1 N/mm", "121 N/mm"]
    assert bench.acts(first) and not bench.acts(again)
    assert not Workbench(case, None).acts(first)
    crowned = bench.crowns(first)[1].change.applied(case, None)
    assert crowned.facing.crown is not None
    assert (crowned.facing.crown.kind, crowned.facing.crown.line_load) == ("johns_gohar", 121e3)


def test_a_crown_is_made_lighter_and_heavier(case: Case) -> None:
    key = "roller.crown.radius"
    crowned = with_values(case, {"roller.crown.kind": "circular", key: "500 mm"})
    bench = Workbench(crowned, None, line_load=120e3)
    for lever in (Crowned(first=True), Crowned(first=False)):
        steps = bench.crowns(lever)
        assert [str(step.change) for step in steps] == [f"{key}: 250 mm", f"{key}: 1000 mm"]
        assert {step.size for step in steps} == {math.log(2.0)}
    standard = with_values(case, {"roller.crown.kind": "iso16281"})
    assert not Workbench(standard, None, line_load=120e3).acts(Crowned(first=True))


@pytest.mark.parametrize(("radius", "undercut"), [("8 mm", False), ("20 mm", True)])
def test_an_undercut_contour_has_no_line_load(case: Case, radius: str, undercut: bool) -> None:
    changed = with_values(case, {"roller.radius": radius, "cam.prime_radius": "34 mm"})
    base = Judge(changed, engine_torques(changed)).judged(Change(), Depth(undercut=True))
    known = np.concatenate(
        [cycle.contact.line_load for cycle in base.solved.cycles if cycle.end is None]
    )
    assert np.isnan(known).all() == undercut
    assert _greatest_line_load(base) == (None if undercut else known.max())


def test_a_value_that_does_not_fit_is_refused(bench: Workbench) -> None:
    with pytest.raises(InputError, match=r"guides\.spacing"):
        Change((("guides.spacing", "15 mm"),)).replaced(bench.case)


def test_the_line_of_a_remedy_keeps_the_width() -> None:
    change = Change((("cam.width", "26 mm"), ("roller.width", "26 mm")))
    effects = ("fails cam_radius", "x" * 60, "adds 40 g")
    text = Remedy("contact_pressure", change, effects=effects).text
    assert text == "cam.width: 26 mm, roller.width: 26 mm; fails cam_radius; adds 40 g"
    assert len(text) <= WIDTH
    card = Remedy(
        "roller_static", Change(((BEARING, "6203"),)), "C0 4.75 kN", ("least C0 4.56 kN",)
    )
    assert card.text == "roller.bearing: 6203 (C0 4.75 kN); least C0 4.56 kN"


def test_without_a_remedy_the_line_says_so() -> None:
    assert Remedy("jump", Change(), cures=False).text == "no single change cures it"
    closest = Remedy(
        "jump", Change((("follower.mass", "90 g"),)), effects=("still 200 % used",), cures=False
    )
    assert (
        closest.text == "no single change cures it; closest: follower.mass: 90 g; still 200 % used"
    )


def test_where_the_follower_locks_the_remedy_says_so() -> None:
    leaves, locks = LoadEnd("over-speed", 2.0, LEAVES), LoadEnd("start", 1.0, LOCKS)
    assert needed_first(leaves.words) == ("first keep the follower on the cam",)
    assert needed_first(locks.words) == ("first keep the follower from locking",)
    both = needed_first(f"the follower {locks.words}, {leaves.words}")
    assert both == (*needed_first(leaves.words), *needed_first(locks.words))


def test_numbers_are_printed_without_an_exponent() -> None:
    assert without_exponent(2901.9, "rpm") == "27710 rpm"
    assert without_exponent(0.7085, "", 3) == "0.709"
    assert PARTS == (BEARING, CAM_MATERIAL, BUSH_A, "guides.b", BUSH_PIVOT)


def test_a_number_of_a_material_reaches_the_bodies_that_name_it() -> None:
    """A quick judgement reads such a case anew: in place no body would see the number."""
    case = read_case(GX120)
    depth = f"materials.{case.cam.material.name}.case_depth"
    changed = Judge(case, {}).case(Change(((depth, "2 mm"),)), quick=True)
    assert changed.cam.material.case_depth == pytest.approx(2e-3)
