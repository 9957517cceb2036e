"""Checks where the follower leaves the cam or locks, or the crank stalls: what is judged."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from made_check import made_check

from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.machine import Corner
from camwright.pipeline.checks import lost_loads
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.lost_loads import load_ends
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.checks.tolerance_corners import NOMINAL, Outcome, governed
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.crank_speed import study_of
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.engine.crankshaft import StallError
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.check_records import RecordedCheck
from camwright.pipeline.results.field_output import hardest
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.results.verdict_summary import body_stresses
from camwright.pipeline.solver import solve

CASES = Path(__file__).parents[2] / "cases"
TEXT = (CASES / "gx120.toml").read_text(encoding="utf-8")
OVERSPEED = 'overspeed = "3960 rpm"'
POSITIONS = 72


@cache
def trial(*changes: tuple[str, str]) -> Trial:
    """The published cam, which the follower leaves at over-speed; the case with changes."""
    drawn, text = preview_case(parse_case(TEXT), corners=False).contour, TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    case: Case = parse_case(text)
    return solve(case, drawn, tier=Tier.PREVIEW, positions=POSITIONS, corners=False)


@cache
def drawn(machine: str) -> tuple[Case, Contour]:
    """A shipped case and its cam."""
    case = read_case(CASES / f"{machine}.toml")
    return case, preview_case(case, corners=False).contour


def checks(made: Trial) -> dict[str, Check]:
    return {one.id: one for one in made.checks}


def cycle(made: Trial, load_case: str) -> Cycle:
    return next(each for each in made.cycles if each.load_case == load_case)


def test_the_loads_of_a_load_case_end_where_the_contact_force_is_zero() -> None:
    (end,) = load_ends(trial().solution)
    over = cycle(trial(), "over-speed")
    force = over.loads.normal_force
    assert (end.load_case, end.why) == ("over-speed", "leaves the cam")
    first = int(np.flatnonzero(force <= 0.0)[0])
    assert force[first - 1] > 0.0
    assert over.theta[first - 1] < end.cam_angle <= over.theta[first]
    machine = over.machine
    there = follower_loads(
        over.contour.pitch, machine.system, machine.cam_speed, np.array([end.cam_angle])
    )
    assert abs(there.required_force[0]) < 1e-3 * there.spring_force[0]
    assert end.words == f"leaves the cam at {math.degrees(end.cam_angle):.4g} deg (over-speed)"
    assert cycle(trial(), "idle").end is None


def test_contact_jump_and_shape_are_judged_as_they_are() -> None:
    made = checks(trial())
    contact = made["contact_force_margin"]
    assert (contact.status, contact.demand, contact.load_case) == ("fail", 0.0, "over-speed")
    for name in ("jump", "jump_speed", "contact_at_overspeed", "pressure_angle", "undercut"):
        assert made[name].evaluated and not made[name].without


def test_loads_after_the_follower_has_left_the_cam_are_no_results() -> None:
    """What rests on them is that of the case without over-speed: fails by it, or says nothing."""
    made, slower = checks(trial()), checks(trial((OVERSPEED, "")))
    touched = [one for one in made.values() if one.without]
    assert {"guide_pv_A", "jam_index", "bore_pressure", "shakedown"} <= {one.id for one in touched}
    for one in touched:
        other = slower[one.id]
        if other.demand is None:
            assert one.demand is None, one.id
        else:
            assert one.demand == pytest.approx(other.demand, rel=1e-12, nan_ok=True), one.id
        assert one.status == ("fail" if other.status == "fail" else "not_evaluated")
    assert made["guide_pv_A"].status == "fail" and made["bore_pressure"].status == "not_evaluated"
    record = made["bore_pressure"].as_record()
    assert (record["demand"], record["utilisation"], record["load_case"]) == (None, None, "")
    (end,) = load_ends(trial().solution)
    assert str(record["note"]).startswith(f"the follower {end.words}")
    assert all(RecordedCheck(one.as_record()).status_by_numbers == one.status for one in touched)


def test_a_check_that_is_not_made_in_that_load_case_is_judged() -> None:
    reduction = checks(trial())["torque_reduction"]
    assert (reduction.status, reduction.without) == ("pass", "")


def test_the_line_of_contact_is_not_solved_where_the_loads_end() -> None:
    made = trial()
    solved = {each.load_case: "length" in each.results for each in made.cycles}
    (end,) = load_ends(made.solution)
    assert solved == {name: name != end.load_case for name in solved}


@pytest.mark.parametrize("duty", [None, 1.0])
@pytest.mark.parametrize("machine", ["gx120-redesign", "gx120-flat-face"])
def test_a_check_judges_the_load_cases_that_it_declares(machine: str, duty: float | None) -> None:
    """A check of known demand is made of one load case alone, but where its words leave it out."""
    case, contour = drawn(machine)
    first, *others = case.load_cases
    states = (first.model_copy(update={"duty": duty}), *(
        each.model_copy(update={"duty": None if duty is None else 0.0}) for each in others
    ))  # fmt: skip
    case = case.model_copy(update={"load_cases": states})
    solution = solve(case, contour, tier=Tier.PREVIEW, positions=POSITIONS, corners=False).solution
    apart = {cycle.load_case: lost_loads._in(solution, {cycle.load_case})
             for cycle in solution.cycles}  # fmt: skip
    tried = 0
    for declared in CHECKS:
        whole = declared(solution)
        if not declared.rests_on or whole is None or lost_loads._lacks_data(whole):
            continue
        for there in apart.values():
            one = declared(there)
            made = one is not None and not lost_loads._lacks_data(one)
            assert made == lost_loads._judges_lost(declared, there), declared.id
            tried += 1
    assert tried > 60


def test_a_follower_that_locks_is_judged_by_its_jam_alone() -> None:
    rough = trial(
        ("friction = 0.04", "friction = 0.6"), ("friction_max = 0.11", "friction_max = 0.7")
    )
    ends = {end.load_case: end for end in load_ends(rough.solution)}
    assert ends["idle"].why == "locks"
    made, idle = checks(rough), cycle(rough, "idle").loads
    at = int(np.argmin(np.abs(idle.theta - ends["idle"].cam_angle)))
    assert idle.jam_index[at] >= 1.0 > idle.jam_index[at - 1] and idle.lift_slope[at] > 0.0
    assert made["jam_index"].status == "fail" and float(made["jam_index"].demand or 0.0) >= 1.0
    for name in ("guide_pressure_A", "contact_pressure", "torque_reduction"):
        assert made[name].demand is None and made[name].status == "not_evaluated"


@pytest.mark.parametrize("friction", ["0.11", "0.98"])
def test_a_follower_that_locks_at_the_greatest_friction_has_no_steady_temperature(
    friction: str,
) -> None:
    """The friction that locks it is bounded, not found: 1e5 degC of it stood beside the jam."""
    made = trial(
        (OVERSPEED, ""),
        ('spacing = "80 mm"', 'spacing = "40 mm"\nambient_temperature = "60 degC"'),
        ("friction_max = 0.11 ", f'thermal_resistance = "3 K/W"\nfriction_max = {friction} '),
        ("friction_max = 0.25 ", f"friction_max = {max(0.25, float(friction))} "),
    )
    locks, judged = friction == "0.98", checks(made)
    worst = [each.parts.friction.greatest for each in made.cycles]
    assert any((each.jam_index >= 1.0).any() for each in worst) == locks
    warm = judged["guide_temperature_A"]
    assert (warm.status == "not_evaluated") == locks
    assert ("locks at the greatest friction (" in warm.note) == locks
    assert ("locks at the greatest friction (" in judged["guide_pressure_A"].note) == locks
    assert locks or 60.0 < float(warm.demand or 0.0) < 300.0
    most = made.cycles[0].parts.friction.normal_force_max
    assert np.isnan(most).any() == locks and np.nanmax(most) < 100.0 * np.nanmin(most[most > 0.0])


def test_loads_on_a_crank_that_stalls_are_no_results() -> None:
    light = trial(
        (OVERSPEED, ""),
        ('inertia = "0.0139 kg m^2"', 'inertia = "1e-4 kg m^2"'),
        ('mechanism_inertia = "0.0006 kg m^2"', 'mechanism_inertia = "1e-5 kg m^2"'),
    )
    (end,) = load_ends(light.solution)
    assert (end.load_case, end.why) == ("idle", "drives a crank that stalls")
    # the torque of compression takes the energy: before the firing top dead centre, 180 deg
    assert math.radians(150.0) < end.cam_angle < math.radians(185.0)
    made = checks(light)
    for name in ("guide_pressure_A", "contact_pressure", "jam_index"):
        assert made[name].without == f"the follower {end.words}"
        assert made[name].status != "pass" and made[name].load_case != "idle"
    assert made["pressure_angle"].evaluated
    with pytest.raises(
        StallError, match=r"the crank stalls at \d+\.?\d* deg of its cycle"
    ) as stall:
        study_of(light.cycles[0].machine, light.contour.pitch)
    assert stall.value.crank_angle == pytest.approx(2.0 * end.cam_angle)


def test_the_headline_has_the_loads_of_the_others() -> None:
    figures, slower = headline(trial().solution), headline(trial((OVERSPEED, "")).solution)
    for name in ("normal_force_max_N", "p0_max_MPa", "guide_reaction_A_max_N"):
        assert figures[name] == pytest.approx(slower[name], rel=1e-12)
    assert figures["normal_force_min_N"] == 0.0


@pytest.mark.parametrize(
    ("nominal", "there", "status"),
    [(0.5, 0.9, "not_evaluated"), (0.5, 1.1, "fail"), (1.2, 1.1, "fail")],
)
def test_loads_lost_at_a_corner_leave_the_other_corners(
    nominal: float, there: float, status: str
) -> None:
    one = made_check("load", nominal, 1.0)
    tried = [
        Outcome(NOMINAL, {"load": nominal}),
        Outcome(Corner("mass high"), {"load": there}, bounds=frozenset({"load"}), lost="the cam"),
        Outcome(Corner("rate low"), {}, bounds=frozenset({"load"}), lost="the cam"),
    ]
    (judged,) = governed([one], tried)
    assert judged.status == status
    assert judged.without == "at the tolerance corner mass high the cam"
    assert judged.as_record()["demand"] == (None if status == "not_evaluated" else nominal)
    (free,) = governed([replace(one)], tried[:1])
    assert free.without == ""


def test_the_headline_names_the_stress_of_each_body() -> None:
    """Half-planes of nu = 0.3: 0.558 p0 at 0.704 a, Johnson (1985) sec. 4.2(c), to its digits."""
    figures = headline(trial().solution)
    loaded = [each for each in trial().cycles if each.load_case != "over-speed"]
    worst = max(loaded, key=lambda each: float(each.contact.p0.max()))
    k = int(worst.contact.p0.argmax())
    for body in ("", "follower_"):
        stress, depth = figures[f"{body}von_mises_max_MPa"], figures[f"{body}von_mises_depth_mm"]
        assert stress == pytest.approx(0.558e-6 * worst.contact.p0[k], rel=2e-3)
        assert depth == pytest.approx(0.704e3 * worst.contact.half_width[k], rel=5e-3)
    parts = [each.parts for each in loaded]
    rings = [(one.ring_amplitude, one.ring_mean) for one in parts]
    sums = [a + np.abs(m) for a, m in rings if a is not None and m is not None]
    highest = max(float(each.max()) for each in sums)
    assert figures["ring_stress_max_MPa"] == pytest.approx(1e-6 * highest, rel=1e-12)
    words = body_stresses(figures)
    assert re.fullmatch(r"\d+\.?\d* MPa in the cam, 0\.\d+ mm below the surface", words[0])
    assert words[2] == f"{1e-6 * highest:.4g} MPa in the roller ring by bending"


def test_the_stress_field_is_of_a_load_case_with_its_loads() -> None:
    """Over-speed has the greatest pressure, of loads that are no results."""
    every = trial().cycles
    pressures = [float(each.contact.p0_hertz.max()) for each in every]
    assert every[int(np.argmax(pressures))].load_case == "over-speed"
    shown = hardest(every)
    assert every[shown].load_case != "over-speed"
    assert pressures[shown] == max(pressures[k] for k in range(len(every) - 1))
    assert every[-1].load_case == "over-speed"
    assert hardest(every[-1:]) == 0  # there is no other
