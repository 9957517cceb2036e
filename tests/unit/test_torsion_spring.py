"""Torsion spring on a translating follower: force, energy, lift from energy, case, stress."""

from functools import cache

import numpy as np
import pytest
import scipy
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.follower.spring import Spring, spring_energy, stored_lift
from camwright.pipeline.follower.spring_kinds import TorsionSpring, rise
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.smoothing.allowables import travel_limits
from camwright.pipeline.smoothing.cam_state import lift_jet
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.required_lift import required_lift, required_torque
from camwright.pipeline.smoothing.smoothers import Smoother

TABLE = """
kind = "torsion"

[spring.torsion]
moment = "30 N m"
angular_rate = "40 N m/rad"
arm = "70 mm"
arm_angle = "-20 deg"
wire_diameter = "9 mm"
mean_diameter = "72 mm"
tensile_strength = "1500 MPa"
stress_range = "600 MPa"
source = "made up"
"""


@cache
def case():
    text = small_machine("torsion").replace('rate = "24.2 kN/m"\n', "")
    old = 'preload = "400 N"                    # at the smallest cam radius\n'
    assert old in text
    return parse_case(text.replace(old, TABLE))


def torsion(angle=-20.0):
    return TorsionSpring(moment=30.0, angular_rate=40.0, arm=0.07, arm_angle=np.radians(angle))


def spring_of(shape):
    return Spring(kind="torsion", torsion=shape, rate=shape.rate, preload=shape.preload)


@pytest.mark.parametrize("angle", [-20.0, 0.0, 35.0])
def test_work_of_the_moment_is_that_of_the_force(angle):
    """Force from the moment by virtual work: M d(beta) = F ds, by differences of the angle."""
    shape = torsion(angle)
    spring, lift, h = spring_of(shape), np.array([0.0, 0.004, 0.02]), 1e-6
    turned = shape.angle(lift)
    per_lift = (shape.angle(lift + h) - shape.angle(lift - h)) / (2.0 * h)
    assert spring.force(lift) == pytest.approx((30.0 + 40.0 * turned) * per_lift, rel=1e-8)
    for s, angle_there in zip(lift, turned, strict=True):
        held = 30.0 * angle_there + 20.0 * angle_there**2
        assert spring.energy(float(s)) == pytest.approx(held, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("angle", [-20.0, 0.0, 35.0])
def test_derivatives_of_the_rise(angle):
    shape, lift, step = torsion(angle), np.array([0.003, 0.02]), 1e-30
    law, by_complex = rise(shape, lift), rise(shape, lift + 1j * step)
    assert np.imag(by_complex.work) / step == pytest.approx(law.travel, rel=1e-11)
    assert np.imag(by_complex.travel) / step == pytest.approx(law.slope, rel=1e-11)
    assert np.imag(by_complex.slope) / step == pytest.approx(law.travel_d2, rel=1e-11)
    assert law.slope[0] > 0.0


def test_lift_stores_its_energy():
    shape = torsion()
    lift = np.linspace(0.0, shape.reach + 0.01, 41)
    energy = spring_energy(shape.preload, shape.rate, lift, shape)
    again = stored_lift(energy, shape.rate, shape.preload, shape)
    np.testing.assert_allclose(again, lift, rtol=1e-11, atol=1e-14)


def test_case_delivers_the_torque_with_exact_derivatives():
    torque = engine_torques(case())["idle"]
    smoother = Smoother.from_case(case().smoothing, case().period)
    lift = required_lift(case(), torque, smoother)
    wanted = case().mechanism.gear_ratio * required_torque(case(), torque, smoother)
    theta = uniform_turn(wanted.size)
    delivered = case().spring.force(lift(theta)) * lift(theta, 1)
    assert delivered == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())
    variables = problem_of(case(), engine_torques(case())).variables
    energy = np.array([5.0]), np.array([2.0]), np.array([-1.0]), np.array([3.0])
    by_complex = lift_jet((energy[0] + 1e-30j, *energy[1:]), variables)
    up, down = (lift_jet((energy[0] + side, *energy[1:]), variables) for side in (1e-4, -1e-4))
    for name in by_complex._fields:
        slope = (getattr(up, name) - getattr(down, name)) / 2e-4
        assert np.imag(getattr(by_complex, name)) / 1e-30 == pytest.approx(slope, rel=1e-6), name


def test_stress_of_the_wire():
    """torsion_stress and torsion_fatigue by the moment of the arm at the solved lift."""
    trial = preview_case(case(), corners=False)
    checks = {each.id: each for each in trial.checks}
    assert checks["friction_balance"].demand < 1e-6
    highest, shape = trial.lift.highest.value, case().spring.torsion
    turned = scipy.optimize.brentq(
        lambda b: 0.07 * (np.sin(shape.arm_angle + b) - np.sin(shape.arm_angle)) - highest, 0, 1.5
    )
    curved = (8.0 + 0.07) / (8.0 - 0.75) * 32.0 / (np.pi * 0.009**3)
    hard = 1.05 * (30.0 + 40.0 * turned)  # preload and rise of the force 5 % high
    assert checks["torsion_stress"].demand == pytest.approx(curved * hard, rel=1e-9)
    assert checks["torsion_stress"].limit == pytest.approx(0.54 * 1500e6)
    swing = curved * (hard - 1.05 * 30.0)
    assert checks["torsion_fatigue"].demand == pytest.approx(swing, rel=1e-9)
    assert checks["data_torsion_spring"].missing == ("spring.travel_max",)
    assert set(travel_limits(case())) <= {"torsion_stress", "torsion_fatigue"}


@pytest.mark.parametrize(
    ("arm", "height", "status"),
    [(70.0, None, "pass"), (47.0, None, "fail"), (53.0, None, "not_evaluated"),
     (53.0, 80.0, "pass"), (53.0, 30.0, "fail"), (70.0, 30.0, "pass")],
)  # fmt: skip
def test_the_coil_clears_stem_and_guides_over_the_turn(arm, height, status):
    """torsion_gap within 1 um: points of the coil's circle from the outlines of stem and guides."""
    stated = {"spring.torsion.arm": f"{arm} mm", "spring.torsion.moment": f"{0.6 * arm} N m"}
    stated |= {"guides.a.wall": "4 mm", "guides.b.wall": "4 mm"}
    stated |= {} if height is None else {"spring.seat_height": f"{height} mm"}
    of = with_values(case(), stated)
    checks = {each.id: each for each in preview_case(of, corners=False).checks}
    judged = checks["torsion_gap"]
    assert judged.status == status, judged
    if status == "not_evaluated":
        assert judged.missing == ("spring.seat_height",)
        return
    trial = preview_case(of, corners=False)
    top, angle = trial.lift.highest.value, of.spring.torsion.arm_angle
    turn = np.linspace(0.0, 2.0 * np.pi, 40_001)
    away = 1e-3 * arm * np.cos(angle) + 40.5e-3 * np.cos(turn)
    stem = float((away - 0.5 * of.follower.stem_diameter).min())
    middle, least = of.follower.overhang_at_max_lift, stem
    for guide in (of.guides.a, of.guides.b):
        half, outer = 0.5 * guide.length, 0.5 * guide.diameter + 4e-3
        heights = np.full(1, middle) if height is None else np.full(1, 1e-3 * height - top)
        heights = heights if height is None else heights - 1e-3 * arm * np.sin(angle)
        up = heights + 40.5e-3 * np.sin(turn)
        beyond = np.maximum(np.abs(up - middle) - half, 0.0)
        inside = np.maximum(away - outer, 0.0)
        apart = np.hypot(inside, beyond)
        overlap = (away < outer) & (np.abs(up - middle) < half)
        least = min(least, float(np.where(overlap, away - outer, apart).min()))
        middle += of.guides.spacing
    if status == "pass":
        assert judged.demand == pytest.approx(least, abs=1e-6)
    else:
        assert least < of.limits[ASSEMBLY_GAP]


def test_falling_force_is_refused():
    with pytest.raises(InputError, match="arm_angle"):
        TorsionSpring(moment=30.0, angular_rate=10.0, arm=0.07, arm_angle=np.radians(-40.0))


def test_screening_judges_the_bending_stress():
    columns = screen_designs(case(), {"follower.mass": np.array([0.25, 0.3])})
    checks = {each.id: each for each in preview_case(case(), corners=False).checks}
    for name in ("torsion_stress", "torsion_fatigue"):
        demand = in_unit(checks[name].demand, checks[name].unit)
        assert columns[f"{name}.demand"] == pytest.approx([demand] * 2, rel=1e-3), name
        assert set(columns[f"{name}.status"]) == {checks[name].status}
    assert "gas_pressure.status" not in columns
