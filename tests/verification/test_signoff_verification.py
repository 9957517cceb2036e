"""Tendencies of the checks at a fixed lift, and the verdict on the published machine.

By closed forms but where it is said; the same tendencies by finite elements are tests apart.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline import solver as road
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import load_case_file, parse_case
from camwright.pipeline.case.template import template
from camwright.pipeline.checks import all_checks, verdict
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.tolerance_corners import Corner, applied
from camwright.pipeline.contact.contact_pair import CycleBodies, pair_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle, closed_form_cycle, finished
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.preview import closed_form_checks
from camwright.pipeline.smoothing.smoothers import Smoother

GX120 = Path(__file__).parents[2] / "cases" / "gx120.toml"
POSITIONS = 180
CAM_CHECKS = ("contact_pressure", "edge_pressure", "shakedown", "first_yield")


@lru_cache(maxsize=1)
def case() -> Case:
    return parse_case(template("tendency"))


def cam() -> Contour:
    theta = uniform_turn(72)
    return RollerContour(PitchCurve(Lift(theta, 0.01 * (1.0 - np.cos(theta))), 0.05), 0.008)


def cycle(at: Case) -> Cycle:
    return closed_form_cycle(at, cam(), turn(at, cam(), None, at.load_cases[0].name, POSITIONS))


def wider(at: Case, factor: float) -> Case:
    roller = at.roller.model_copy(update={"width": factor * at.roller.width, "chamfer": 0.0})
    return at.model_copy(
        update={"roller_given": roller, "cam": at.cam.model_copy(update={"width": 1.0})}
    )


def tight(at: Case) -> Case:
    """The case with guides that have no play."""
    sides = {n: getattr(at.guides, n).model_copy(update={"clearance": 0.0}) for n in ("a", "b")}
    return at.model_copy(update={"guides": at.guides.model_copy(update=sides)})


def test_pressure_grows_as_the_root_of_the_load():
    """Spring and mass four times as strong: every force four times, the pressure twice.

    In guides without play, which answer in proportion to the load; 1e-10 is their round-off.
    """
    plain = cycle(tight(case()))
    heavy = cycle(applied(tight(case()), Corner("x", rate=4.0, preload=4.0, mass=4.0)))
    force = heavy.loads.normal_force / plain.loads.normal_force
    np.testing.assert_allclose(force, 4.0, rtol=1e-10)
    np.testing.assert_allclose(heavy.contact.p0, 2.0 * plain.contact.p0, rtol=1e-10)


def test_a_wider_roller_lowers_the_pressure():
    """As one over the root of the width both carry."""
    narrow, wide = cycle(wider(case(), 1.0)), cycle(wider(case(), 2.0))
    np.testing.assert_allclose(wide.contact.p0, narrow.contact.p0 / np.sqrt(2.0), rtol=1e-12)
    assert contact_pair(wider(case(), 2.0), cam()).width == pytest.approx(2 * case().roller.width)


def test_preload_raises_friction_loss_and_least_contact_force():
    found = [cycle(applied(case(), Corner("x", preload=p))).loads for p in (0.8, 1.0, 1.2)]
    losses = [loads.friction_loss for loads in found]
    least = [float(loads.normal_force.min()) for loads in found]
    assert np.all(np.diff(losses) > 0)
    assert np.all(np.diff(least) > 0)


def test_friction_raises_the_reactions_on_the_rise_and_lowers_them_on_the_return():
    smooth = cycle(applied(case(), Corner("x", friction_a=0.5, friction_b=0.5)))
    rough = cycle(applied(case(), Corner("x", friction_a=2.0, friction_b=2.0)))
    slope, moves = smooth.loads.lift_slope, np.abs(smooth.loads.tangential_force) > 1.0
    for name in ("statics_a", "statics_b"):
        more = np.abs(getattr(rough.guides, name)) - np.abs(getattr(smooth.guides, name))
        assert np.all(more[moves & (slope > 0)] > 0)
        assert np.all(more[moves & (slope < 0)] < 0)


@lru_cache(maxsize=2)
def published(hardened: bool) -> dict[str, Check]:
    """The first trial of the published machine, its cam of plate or case-hardened."""
    given = load_case_file(GX120).with_positions(180)
    if hardened:
        text = GX120.read_text(encoding="utf-8").replace(
            'material = "s355"', 'material = "hardened"'
        )
        card = '\n[materials.hardened]\ncard = "case_hardened"\n'
        given = parse_case(text + card).with_positions(180)
    return {check.id: check for check in closed_form_checks(given)}


def test_the_published_machine_fails_as_foreseen():
    """Bearing, pressure angle, bush PV and, of laser-cut plate, shakedown (first trial)."""
    found = published(False)
    for name in ("roller_static", "pressure_angle", "bush_pv_A", "shakedown"):
        assert found[name].status == "fail", name
    # Ranges of a synthetic trace of the same machine: order of magnitude, not the machine's own.
    assert 0.34 <= found["roller_static"].demand <= 0.48
    assert 900.0 <= found["contact_pressure"].demand <= 1130.0
    assert 3300.0 <= found["jump_speed"].demand <= 4500.0
    assert 43.0 <= found["pressure_angle"].demand <= 48.5


def test_a_hardened_cam_passes_its_own_checks_and_the_others_still_fail():
    soft, hard = published(False), published(True)
    assert "case_hardened" in known_cards(None)["materials"]
    for name in CAM_CHECKS:
        assert (soft[name].status, hard[name].status) == ("fail", "pass"), name
        assert hard[name].demand == pytest.approx(soft[name].demand)
    for name in ("roller_static", "pressure_angle", "bush_pv_A"):
        assert hard[name].status == "fail", name
    assert "verify" in hard["contact_pressure"].source


@lru_cache(maxsize=1)
def by_elements() -> tuple[Contour, tuple[Cycle, ...]]:
    """The published cam's first trial, solved by finite elements at few angles."""
    given = load_case_file(GX120)
    torques = road.engine_torques(given)
    lift = road.designed_lift(given, torques, Smoother.from_case(given.smoothing))
    contour = road.cam_contour(given, lift)
    turns = road.turns_of(given, contour, torques, 72)
    pair = contact_pair(given, contour)
    bodies = CycleBodies.meshed(pair)
    return contour, tuple(
        finished(
            given,
            contour,
            one,
            pair_history(pair, bodies, one.theta, one.loads.normal_force),
        )
        for one in turns
    )


@pytest.mark.parametrize("hardened", [False, True])
def test_published_machine_by_finite_elements(hardened: bool) -> None:
    """Plate or hardened: the elements are the same, and what the cam bears is not.

    Ranges of the published machine on a synthetic trace: order of magnitude, not its own.
    """
    text = GX120.read_text(encoding="utf-8")
    if hardened:
        text = text.replace('material = "s355"', 'material = "hardened"')
        text += '\n[materials.hardened]\ncard = "case_hardened"\n'
    contour, cycles = by_elements()
    found = {c.id: c for c in all_checks(TrialEvidence(parse_case(text), contour, cycles))}
    for name in CAM_CHECKS:
        assert found[name].status == ("pass" if hardened else "fail"), name
    for name in ("roller_static", "pressure_angle", "bush_pv_A"):
        assert found[name].status == "fail", name
    assert verdict(found.values()) == "fail"
    assert 0.34 <= found["roller_static"].demand <= 0.48
    assert 5.0 <= found["roller_life"].demand <= 16.0
    assert 900.0 <= found["contact_pressure"].demand <= 1130.0
    assert 43.0 <= found["pressure_angle"].demand <= 48.5
    assert 3300.0 <= found["jump_speed"].demand <= 4500.0
    (cycle,) = cycles
    assert 790.0 <= cycle.loads.normal_force.max() <= 1120.0
    assert 400.0 <= np.abs(cycle.guides.reaction_a).max() <= 960.0
    # The range is of |R v|; the check counts the pushes of both sides of the bore, and more.
    pv = np.mean(np.abs(cycle.guides.reaction_a * cycle.loads.velocity)) / (0.01 * 0.02)
    assert 0.6e6 <= pv <= 2.0e6
    assert found["bush_pv_A"].demand * 1e6 >= pv
    assert found["bush_pv_A"].utilisation >= 5.0


def states(overspeed: int) -> Case:
    text = GX120.read_text(encoding="utf-8")
    text += '\n[[load_case]]\nname = "start"\nspeed = "0 rpm"\n'
    text += f'\n[[load_case]]\nname = "overspeed"\nspeed = "{overspeed} rpm"\n'
    return parse_case(text).with_positions(90)


def test_load_cases_from_rest_to_overspeed_name_the_one_that_governs():
    """At rest nothing unloads the spring; fast, inertia adds to it in the hollow."""
    slow = {check.id: check for check in closed_form_checks(states(2000))}
    assert slow["contact_pressure"].load_case == "start"
    found = {check.id: check for check in closed_form_checks(states(3900))}
    assert found["contact_pressure"].load_case == "overspeed"
    assert found["jump"].load_case == "overspeed"
    assert found["bush_pv_A"].load_case == "overspeed"
    # 1.3 times 3900 rpm lies above the jump speed the plain cam has
    assert found["jump_speed"].status == "fail"
    assert found["torque_reduction"].load_case in ("idle", "overspeed")


def test_at_rest_only_spring_and_friction_act():
    given = next(s for s in states(2000).load_cases if s.name == "start")
    assert given.speed == 0.0
    loads = turn(states(2000), cam(), None, "start", POSITIONS).loads
    assert np.abs(loads.inertia_force).max() < 1e-6
    assert loads.normal_force.min() > 0
