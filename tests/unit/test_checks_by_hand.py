"""Checks of overspeed, life, edges, space and manufacture by hand."""

import datetime as dt
from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
from trial_variants import cycle_with, with_case, with_cycle, with_limits, with_part

from camwright.pipeline.case.requirements_section import Waiver
from camwright.pipeline.checks import (
    contact_strength,
    guide_strength,
    jump_and_jamming,
    manufacture,
    roller_bearing,
    surface_durability,
)
from camwright.pipeline.checks.contact_strength import pressure_at_life, shakedown_factor
from camwright.pipeline.checks.registry import all_checks

RPM = 30.0 / np.pi
MODULUS = 210e9 / (2.0 * (1.0 - 0.3**2))


def test_jump_speed_by_hand():
    """F_s = P + k s against m w^2 s'': on 5 mm (1 - cos) the slowing half holds both extremes."""
    check = jump_and_jamming.jump_speed(made.solution())
    s, bend = 0.005 * (1.0 - np.cos(made.THETA)), 0.005 * np.cos(made.THETA)
    slows = bend < 0
    force = made.PRELOAD + made.RATE * s[slows]
    speed = 2.0 * np.sqrt(np.min(force / (-made.MASS * bend[slows])))
    # The spline of 72 samples has the second derivative of the cosine to 1e-4.
    record = check.as_record()
    assert record["demand"] == pytest.approx(RPM * speed, rel=1e-3)
    assert record["limit"] == pytest.approx(1.3 * RPM * 2.0 * made.CAM_SPEED)
    bare = jump_and_jamming.jump_speed(with_limits(overspeed=None))
    assert (bare.limit, bare.status) == (None, "not_evaluated")
    assert (bare.missing, bare.note) == (("limits.overspeed",), "missing: limits.overspeed")
    over = jump_and_jamming.jump_speed(with_limits(overspeed=400.0))
    assert over.as_record()["limit"] == pytest.approx(1.3 * RPM * 400.0)


def test_contact_at_overspeed_takes_more_than_the_load_case():
    slow = jump_and_jamming.contact_at_overspeed(made.solution())
    fast = jump_and_jamming.contact_at_overspeed(with_limits(overspeed=1600.0))
    s, bend = 0.005 * (1.0 - np.cos(made.THETA)), 0.005 * np.cos(made.THETA)
    force = made.PRELOAD + made.RATE * s + made.MASS * 800.0**2 * bend
    assert fast.demand == pytest.approx(force.min() / made.PRELOAD, rel=1e-3)
    assert fast.demand < slow.demand


def test_pressure_at_life_reproduces_the_table_at_1e8():
    """Rothbart's table 9.3 gives K = 13 000 psi and 1790 MPa for induction-hardened 4340."""
    pressure = pressure_at_life(1e8, 14.15, 66.22, MODULUS)
    assert pressure == pytest.approx(1790e6, rel=0.02)  # the table's K is rounded
    assert pressure_at_life(1e6, 14.15, 66.22, MODULUS) > pressure


def test_target_life_sets_the_cycles():
    check = contact_strength.contact_pressure_at_life(with_limits(target_life=1e4 * 3600.0))
    cycles = 1e4 * 3600.0 * made.CAM_SPEED / (2.0 * np.pi)
    assert check.limit == pytest.approx(pressure_at_life(cycles, 14.15, 66.22, MODULUS))
    assert check.must_have


def test_a_contact_without_ends_is_not_evaluated_at_them():
    for name in ("edge_pressure", "edge_shakedown", "case_depth", "contact_pressure_at_life"):
        declared = getattr(surface_durability if name == "case_depth" else contact_strength, name)
        case = made.case(roller=made.changed(made.case().roller, end=None))
        bare = made.solution(case=case)
        cycles = tuple(made.changed_cycle(cycle, length=None) for cycle in bare.cycles)
        check = declared(replace(bare, cycles=cycles))
        assert check.status == "not_evaluated", name
        assert "roller.end" in check.missing, name


def test_shakedown_factor_is_johnsons():
    """4 without friction (orthogonal shear p0/4); towards 1/mu where the surface decides."""
    assert shakedown_factor(0.0) == pytest.approx(4.0, rel=1e-4)
    assert 1.88 < shakedown_factor(0.5) < 2.0  # von Mises at the surface
    assert 2.5 < shakedown_factor(0.3) < shakedown_factor(0.1) < 4.0


def test_guide_gap_by_hand():
    """Fork of 17 mm, guide of 20 mm whose middle is 30 mm off: 3 mm stay."""
    gap = manufacture.guide_gap(made.solution()).as_record()
    assert gap["demand"] == pytest.approx(3.0, abs=1e-6)


def test_guide_length_by_hand():
    """80 mm apart, 20 mm long, 30 mm over at full lift and 40 mm at none."""
    assert guide_strength.guide_length(made.solution()).demand == pytest.approx(100.0 / 40.0)


def test_force_on_the_roller_by_hand():
    assert roller_bearing.roller_radial(made.solution()).demand == pytest.approx(400.0)


def test_waviness_by_hand():
    """m delta (2 pi v / lambda)^2 over the force on a ring: v = w (R - r), delta half of 4 um."""
    check = manufacture.profile_waviness(made.solution())
    assert check.source.startswith("10 to 20 %")
    flat = cycle_with("loads", normal_force=np.full(made.POSITIONS, 300.0))
    ring = made.solution(contour=made.contour(stroke=1e-9), cycles=(flat,))
    wave = made.MASS * 2e-6 * (2.0 * np.pi * 80.0 * 0.042 / 5e-3) ** 2 / 300.0
    assert manufacture.profile_waviness(ring).demand == pytest.approx(wave, rel=1e-5)


def test_phase_by_hand():
    """sin against half of it, 0.02 rad of cam off: the rest is the root of 1.25 - cos(0.02)."""
    check = manufacture.phase_tolerance(made.solution())
    assert check.demand == pytest.approx(1.0 - np.sqrt(1.25 - np.cos(0.02)), rel=1e-9)
    assert not check.must_have
    exact = with_part("tolerances", phase=0.0)
    assert manufacture.phase_tolerance(exact).status == "not_evaluated"
    undriven = with_cycle(torque_before=None, torque_after=None)
    assert manufacture.phase_tolerance(undriven) is None


def test_chord_error_by_hand():
    """One step in 720 of a ring of 42 mm: r (pi/360)^2 / 2 / 4."""
    ring = made.solution(contour=made.contour(stroke=1e-9))
    step = 42e3 * np.pi / 360.0  # um
    sag = manufacture.chord_error(ring).as_record()
    assert sag["demand"] == pytest.approx(step**2 / (8.0 * 42e3), rel=1e-4)


def test_a_waiver_of_no_check_fails_a_check_of_its_own():
    date = dt.date(2025, 1, 2)
    waiver = Waiver(check="jmup", up_to=1.0, name="A. Engineer", reason="proven", date=date)
    checks = {c.id: c for c in all_checks(with_case(waivers=(waiver,)))}
    assert checks["waivers_without_effect"].status == "fail"
    assert checks["waivers_without_effect"].note == "jmup"
    assert not checks["waivers_without_effect"].must_have
    assert "waivers_without_effect" not in {c.id for c in all_checks(made.solution())}
