"""Demands on roller bearing, pin, fork and follower, recomputed another way from a solved case.

The cycle is solved by the product on the case of `tests/data/every_part.toml`; the recomputation
takes its forces, and nothing of the formulas of the checks.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pylife.strength.fatigue  # registers the Woehler curve of a Series
import pylife.stress.collective  # noqa: F401 - registers the load collective of a frame
import pytest
from pylife.strength.meanstress import fkm_goodman
from ring_beams import beam_ring_bending
from stated_loads import stated_loads

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.bearing_ring import ball_stiffness
from camwright.pipeline.follower.bearing_ring_elements import ring_bending
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.follower_stiffness import pin_compliance, shaft_compliance
from camwright.pipeline.follower.pin_strength import cheek_pressure, pin_moment, support_force

CASE = Path(__file__).parents[1] / "data" / "every_part.toml"
BY_ID = {declared.id: declared for declared in CHECKS}
BASE, RADIUS, STROKE = 0.05, 0.008, 0.01
HOUR = 3600.0


@cache
def case():
    return read_case(CASE)


def solved(own):
    theta = uniform_turn(72)
    lift = Lift(theta, 0.5 * STROKE * (1.0 - np.cos(theta)))
    contour = RollerContour(PitchCurve(lift, BASE), RADIUS)
    return stated_loads(own, contour, 72)


@cache
def run():
    return solved(case())


def with_roller(**values):
    own = case()
    roller = replace(own.roller, **values)
    machines = tuple(replace(each, follower=roller) for each in run().machines)
    return replace(run(), case=own.model_copy(update={"roller_given": roller}), machines=machines)


def with_bearing(**values):
    return with_roller(bearing=replace(case().roller.bearing, **values))


def demand(name, of=None):
    made = BY_ID[name](run() if of is None else of)
    return made.as_record()["demand"]


def force():
    return run().cycles[0].loads.normal_force


def surged():
    """Normal force with the surge of the spring, by which lives are counted, N."""
    return run().cycles[0].surged_force


def turns_per_step():
    """Turns of the roller about its pin around each position, from lengths of the pitch curve."""
    count = 72 * 200
    theta = (np.arange(count + 1) - 100) * 2.0 * np.pi / count
    pitch = BASE + 0.5 * STROKE * (1.0 - np.cos(theta))
    x, y = pitch * np.cos(theta), pitch * np.sin(theta)
    lengths = np.hypot(np.diff(x), np.diff(y)).reshape(72, 200).sum(axis=1)
    return lengths / (2.0 * np.pi * RADIUS) - 1.0 / 72.0


def cam_period():
    return 2.0 * np.pi / run().machine.cam_speed


def mean_rpm():
    return 60.0 * turns_per_step().sum() / cam_period()


# --- ratings and life ------------------------------------------------------------------------


def test_force_over_its_ratings():
    peak = force().max()
    assert demand("roller_static") == pytest.approx(600.0 / peak, rel=1e-12)
    assert demand("roller_load_share") == pytest.approx(peak / 1140.0, rel=1e-12)
    assert demand("roller_radial") == pytest.approx(peak, rel=1e-12)
    assert demand("roller_static_radial") == pytest.approx(peak, rel=1e-12)


def test_speed_from_lengths_of_the_pitch_curve():
    """Greatest speed from the longest step; the step has a mean over 5 deg."""
    fastest = 60.0 * turns_per_step().max() * 72 / cam_period()
    assert demand("roller_speed") == pytest.approx(fastest, rel=1e-3)


def test_basic_life_by_adding_damage():
    """Miner: the turns at each position over those it could endure."""
    damage = np.sum(turns_per_step() / (1e6 * (1140.0 / surged()) ** 3))
    assert demand("roller_life") == pytest.approx(cam_period() / damage / HOUR, rel=1e-4)


def test_basic_life_by_the_damage_of_pylife():
    """Its Woehler curve through C at a million turns, exponent 3, Miner without endurance."""
    curve = pd.Series({"k_1": 3.0, "ND": 1e6, "SD": 1140.0}).fatigue.miner_elementary()
    turns = pd.DataFrame({"range": 2.0 * surged(), "mean": 0.0, "cycles": turns_per_step()})
    damage = curve.damage(turns.load_collective).sum()
    assert demand("roller_life") == pytest.approx(cam_period() / damage / HOUR, rel=1e-4)


def a_iso(kappa, load):
    """ISO 281:2007, eqs 31-33, another transcription: by logarithms, for 0.4 < kappa <= 4."""
    power = 0.19087 if kappa < 1.0 else 0.071739
    root = np.exp(0.83 * np.log(2.5671 - 1.9987 * np.exp(-power * np.log(kappa))))
    return np.minimum(10.0 ** (-1.0 - 9.3 * np.log10(1.0 - root * load ** (1.0 / 3.0))), 50.0)


@pytest.mark.parametrize(("reliability", "table"), [(0.9, 1.0), (0.95, 0.64), (0.99, 0.25)])
def test_modified_life_by_adding_damage(reliability, table):
    """a1 of ISO 281:2007, table 12; e_C = 0.5 of normal cleanliness, P_u = 60 N."""
    kappa = 22.0 * np.sqrt(mean_rpm() * 10.5) / 4500.0
    endured = 1e6 * a_iso(kappa, 0.5 * 60.0 / surged()) * (1140.0 / surged()) ** 3
    life = cam_period() / np.sum(turns_per_step() / endured) / HOUR
    limits = case().limits.model_copy(update={"roller_reliability": reliability})
    stated = case().model_copy(update={"limits": limits})
    machines = tuple(replace(each, limits=limits) for each in run().machines)
    other = replace(run(), case=stated, machines=machines)
    assert demand("roller_modified_life", other) == pytest.approx(table * life, rel=8e-3)


def test_reliability_factors_of_the_standard():
    """ISO 281:2007, table 12: verify."""
    table = {90: 1.0, 95: 0.64, 96: 0.55, 97: 0.47, 98: 0.37, 99: 0.25, 99.5: 0.175, 99.9: 0.093}
    for percent, factor in table.items():
        assert bearing_life.reliability_factor(0.01 * percent) == pytest.approx(factor, abs=0.01)


def test_life_modification_is_continuous_and_bounded():
    """Branches of the standard meet at kappa 0.4 and 1; 0.1 in dirt, 50 at most, 4 as the end."""
    load = np.geomspace(1e-4, 5.0, 40)
    for joint in (0.4, 1.0):
        below, above = (bearing_life.life_modification(joint * k, load) for k in (1 - 1e-9, 1.0))
        np.testing.assert_allclose(below, above, rtol=5e-3)
    assert bearing_life.life_modification(0.1, 0.0) == pytest.approx(0.1)
    assert bearing_life.life_modification(4.0, 5.0) == pytest.approx(50.0)
    np.testing.assert_array_equal(
        bearing_life.life_modification(9.0, load), bearing_life.life_modification(4.0, load)
    )
    many = [bearing_life.life_modification(k, load) for k in np.geomspace(0.1, 4.0, 30)]
    assert (np.diff(many, axis=0) >= 0.0).all() and (np.diff(many, axis=1) >= 0.0).all()


def test_a_film_too_thin_for_the_standard_has_no_rated_life():
    thin = BY_ID["roller_modified_life"](with_bearing(viscosity=1e-6))
    assert thin.status == "not_evaluated"
    assert thin.blocks
    assert "below 0.1" in thin.note
    assert BY_ID["bearing_lubrication"](with_bearing(viscosity=1e-6)).status == "fail"


def test_dirt_shortens_the_life_to_a_tenth():
    basic, dirty = demand("roller_life"), with_bearing(contamination="severe_contamination")
    assert demand("roller_modified_life", dirty) == pytest.approx(0.1 * basic, rel=1e-4)


def test_viscosity_ratio_from_lengths_of_the_pitch_curve():
    rated = 4500.0 / np.sqrt(mean_rpm() * 10.5)
    assert mean_rpm() > 1000.0
    assert demand("bearing_lubrication") == pytest.approx(22.0 / rated, rel=1e-4)


# --- grease ----------------------------------------------------------------------------------


def test_grease_life_of_the_maker_and_by_estimate():
    """Estimate of a lightly loaded bearing at 60 degC, worked in powers of ten."""
    assert demand("grease_life") == pytest.approx(2000.0)
    light = with_bearing(grease_life=None, C=3000.0, temperature=333.15)
    factor = max(16.0 * mean_rpm(), 125e3)
    turns = turns_per_step()
    share = np.cbrt(np.sum(force() ** 3 * turns) / turns.sum()) / 3000.0
    assert 0.05 < share < 0.2
    life = 10.0**6.10 * 10.0 ** (-4.40e-6 * factor) * 10.0 ** (-2.50 * (share - 0.05))
    life *= 10.0 ** (-60.0 * (0.021 - 1.80e-8 * factor))
    assert demand("grease_life", light) == pytest.approx(life, rel=1e-3)


def test_grease_ages_with_heat_speed_and_load():
    def life(speed=1e4, load=0.1, temperature=350.0):
        return bearing_life.grease_life(speed, 0.02, load, temperature)

    assert 1e3 * HOUR < life() < 1e5 * HOUR
    assert (
        life(speed=2e4) < life() and life(load=0.15) < life() and life(temperature=370.0) < life()
    )
    # Warmer by 15 K: half, as makers have it, within a third.
    assert 0.4 < life(temperature=365.0) / life() < 0.7
    for beyond in (life(speed=2.6e4), life(load=0.21), life(temperature=394.0)):
        assert np.isnan(beyond)


def test_oil_has_no_grease_life_and_relubrication_its_own_limit():
    assert BY_ID["grease_life"](with_bearing(lubrication="oil")) is None
    again = with_bearing(lubrication="grease_relubricated", relubrication_interval=500.0 * HOUR)
    assert BY_ID["grease_life"](again).as_record()["limit"] == pytest.approx(500.0)


# --- pin, fork and ring ----------------------------------------------------------------------

SECTION = 32.0 / (np.pi * 5e-3**3)
"""Bending stress per moment of the pin, 1/m^3."""


def beam(span, width, overhung, count=40_000, ahead=0.0):
    """Bending moment and shear force over a pin per newton, by summation from one end; places.

    ahead: distance of the newton from the middle of the bearing, m, by a load linear along it.
    """
    x = (np.arange(count) + 0.5) / count * (2.0 * span if overhung else span)
    step, middle = x[1] - x[0], span if overhung else 0.5 * span
    within = np.abs(x - middle) < 0.5 * width
    load = np.where(within, 1.0, 0.0) / (np.sum(within) * step)
    load += np.where(within, ahead * (x - middle), 0.0) / (
        np.sum(within * (x - middle) ** 2) * step
    )
    if overhung:
        shear = 1.0 - np.cumsum(load) * step
        moment = -np.cumsum(shear[::-1])[::-1] * step
    else:
        shear = 0.5 - ahead / span - np.cumsum(load) * step
        moment = np.cumsum(shear) * step
    return x, moment, shear


def couple(of=None):
    """Moment of the contact about the middle of the roller, N m: what friction of the guides holds.

    The tilt is within their clearances, and the roller in the middle of the cam.
    """
    cycle = (run() if of is None else of).cycles[0]
    on_a, on_b = cycle.machine.friction.greatest
    loads = cycle.guides.rubbing_load_a, cycle.guides.rubbing_load_b
    return np.minimum(on_a * loads[0], on_b * loads[1]) * cycle.machine.guides.spacing


def bent(force, moments, overhung=False):
    """Greatest bending moment of the pin at each force, N m, and greatest shear force, N."""
    ahead = moments / force
    beams = [beam(16e-3, 10e-3, overhung, ahead=each) for each in ahead]
    bending = force * np.array([np.abs(moment).max() for _, moment, _ in beams])
    return bending, force * np.array([np.abs(shear).max() for _, _, shear in beams])


@pytest.mark.parametrize("mounting", ["straddled", "overhung"])
def test_pin_by_summation_along_it(mounting):
    """Stress at the extreme fibre, by the moment of a section in strips; 16 mm, 10 mm wide."""
    pin = replace(case().roller.pin, mounting=mounting)
    other = solved(case().model_copy(update={"roller_given": replace(case().roller, pin=pin)}))
    bending, across_pin = bent(force(), couple(), mounting == "overhung")
    y = (np.arange(4000) + 0.5) / 4000 * 5e-3 - 2.5e-3
    across, thick = 2.0 * np.sqrt(2.5e-3**2 - y**2), 5e-3 / 4000
    inertia = np.sum(y**2 * across) * thick
    stress = bending.max() * 2.5e-3 / inertia / 1e6
    assert demand("roller_pin", other) == pytest.approx(stress, rel=1e-3)
    # Zhuravskii: the first moment of half the section over its second moment and width.
    first = np.sum((y * across)[y > 0]) * thick
    sheared = across_pin.max() * first / (inertia * 5e-3) / 1e6
    assert demand("roller_pin_shear", other) == pytest.approx(sheared, rel=1e-3)
    # Virtual work: deflection at the middle of the bearing, bending and shear.
    x, moment, shear = beam(16e-3, 10e-3, mounting == "overhung")
    _, unit, cut = beam(16e-3, 1e-5, mounting == "overhung")
    if mounting == "overhung":  # the load is taken at the middle of the bearing
        moment, shear = unit, cut
    step, area = x[1] - x[0], np.sum(across) * thick
    shape = 6.0 * (1.0 + 0.3) / (7.0 + 6.0 * 0.3)  # Cowper
    rigidity = shape * 210e9 / (2.0 * 1.3) * area
    work = np.sum(moment * unit) / (210e9 * inertia) + np.sum(shear * cut) / rigidity
    assert pin_compliance(pin, 10e-3) == pytest.approx(work * step, rel=2e-3)


@pytest.mark.parametrize("ahead", [0.0, 0.5e-3, 2e-3, 4e-3, 9e-3])
@pytest.mark.parametrize("overhung", [False, True])
def test_a_pin_under_an_eccentric_force(overhung, ahead):
    """Beams by summation, of a load that the bearing takes on one side or on both."""
    bending, shear = bent(np.array([800.0]), np.array([800.0 * ahead]), overhung)
    held = pin_moment(800.0, 800.0 * ahead, 10e-3, 16e-3, overhung)
    assert held == pytest.approx(bending[0], rel=1e-3)
    support = support_force(800.0, 800.0 * ahead, 16e-3, overhung)
    if ahead <= 10e-3 / 6.0:  # beyond it the load within the bearing changes its sign
        assert support == pytest.approx(shear[0], rel=1e-3)
    else:
        assert support <= shear[0] * (1.0 + 1e-3)


def test_pin_fatigue_on_the_goodman_line():
    """The amplitude at each fibre grows until it meets the line; pressure angle by geometry."""
    theta = uniform_turn(72)
    slope = 0.5 * STROKE * np.sin(theta)
    angle = np.arctan2(slope, BASE + 0.5 * STROKE * (1.0 - np.cos(theta)))
    greatest = SECTION * bent(force(), couple())[0]
    reserve = []
    for fibre in np.linspace(-np.pi, np.pi, 1001):
        for sign in (1.0, -1.0):  # the fibres lie the same on both sides of the axis
            stress = greatest * np.cos(sign * angle - fibre)
            amplitude, mean = 0.5 * np.ptp(stress), max(0.5 * (stress.max() + stress.min()), 0.0)
            reserve.append((2000e6 - mean) / 2000e6 * 700e6 / amplitude)
    assert demand("roller_pin_fatigue") == pytest.approx(min(reserve), rel=1e-3)


def test_pin_fatigue_by_the_haigh_diagram_of_pylife():
    """Its mean stress correction along Goodman's line, M = 700/2000 on either side of R = 0.

    The amplitude of every fibre grows, at its mean, until its equivalent at R = -1 is the limit.
    """
    theta = uniform_turn(72)
    slope = 0.5 * STROKE * np.sin(theta)
    angle = np.arctan2(slope, BASE + 0.5 * STROKE * (1.0 - np.cos(theta)))
    around = np.linspace(-np.pi, np.pi, 1001)[:, None]
    stress = SECTION * bent(force(), couple())[0] * np.cos(angle - around)
    amplitude = 0.5 * np.ptp(stress, axis=1)
    mean = np.maximum(0.5 * (stress.max(axis=1) + stress.min(axis=1)), 0.0)
    low, high = np.zeros(amplitude.size), np.full(amplitude.size, 1e6)
    for _ in range(60):
        middle = 0.5 * (low + high)
        beyond = fkm_goodman(middle * amplitude, mean, 0.35, 0.35, -1.0) > 700e6
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    assert demand("roller_pin_fatigue") == pytest.approx(low.min(), rel=1e-3)


def test_a_turning_force_bends_the_pin_though_its_size_is_constant():
    """30 deg to and fro: a fibre at 45 to 90 deg sees more than the change in size, which is 0."""
    angle = np.radians(30.0) * np.sin(uniform_turn(72))
    turning = replace(
        run().cycles[0].loads,
        axial_force=500.0 * np.cos(angle),
        tangential_force=500.0 * np.sin(angle),
    )
    cycle = run().cycles[0]
    other = replace(cycle, turn=replace(cycle.turn, loads=turning))
    stress = SECTION * 500.0 * (16e-3 / 4.0 - 10e-3 / 8.0)
    # At 90 deg to the axis the stress swings between both signs of its sine.
    assert demand("roller_pin_fatigue", replace(run(), cycles=(other,))) <= (
        700e6 / (0.5 * stress) * (1.0 + 1e-9)
    )


def test_pressure_of_the_pin_in_its_seats():
    """Bore by the resultant of a uniform pressure, strip by strip around the half circle."""
    angle = (np.arange(2000) + 0.5) / 2000 * np.pi
    resultant = np.sum(np.sin(angle)) * np.pi / 2000 * 2.5e-3  # per metre of length
    x = (np.arange(4000) + 0.5) / 4000 * 10e-3 - 5e-3  # slices along the bearing
    tilted = couple() / np.mean(x**2) * 5e-3 + force()  # at its edge
    bore = tilted.max() / (resultant * 10e-3) / 1e6
    assert demand("roller_pin_pressure") == pytest.approx(bore, rel=1e-6)
    support = 0.5 * force() + couple() / 16e-3
    cheeks = support.max() / (resultant * 4e-3) / 1e6
    assert demand("cheek_pressure") == pytest.approx(cheeks, rel=1e-6)


def test_an_overhung_pin_tilts_in_its_cheek():
    """Linear pressure whose force and moment about the face hold the load, by least squares.

    A newton 9 mm off the face, and 2 mm more by its moment about the roller.
    """
    seat, lever, diameter = 12e-3, 9e-3, 5e-3
    x = (np.arange(3000) + 0.5) / 3000 * seat
    strip = diameter * seat / 3000
    system = np.array(
        [[strip * 3000, np.sum(x) * strip], [np.sum(x) * strip, np.sum(x**2) * strip]]
    )
    for ahead in (0.0, 2e-3):
        constant, slope = np.linalg.solve(system, [1.0, -(lever + ahead)])
        edge = max(abs(constant), abs(constant + slope * seat))
        held = cheek_pressure(1.0, ahead, diameter, seat, lever, True)
        assert held == pytest.approx(edge, rel=1e-4)


def test_ring_fatigue_by_beams():
    """Ring of curved beams on balls in place of the plane elements; Goodman by its line."""
    roller = case().roller
    ring = roller.ring(run().machine.contact_width, 242.0)
    bent = beam_ring_bending(ring.ring)
    amplitude = 0.5 * (bent.stress_max.max() - bent.stress_min.min()) * force().max()
    mean = max(0.5 * (bent.stress_max.max() + bent.stress_min.min()) * force().max(), 0.0)
    equivalent = amplitude * 2000e6 / (2000e6 - mean) / 1e6
    assert demand("roller_ring_fatigue") == pytest.approx(equivalent, rel=1e-2)


# --- follower --------------------------------------------------------------------------------


def test_moving_mass_by_revolving_and_counting():
    """Round parts by rings of their radius, the fork by counting cubes of a quarter millimetre."""

    def round_part(inside, outside, length):
        r = inside + (np.arange(5000) + 0.5) / 5000 * (outside - inside)
        return np.sum(2.0 * np.pi * r) * (outside - inside) / 5000 * length

    along, height, up = np.meshgrid(
        np.arange(-9.875, 10, 0.25), np.arange(-4.875, 5, 0.25), np.arange(0.125, 17, 0.25)
    )
    steel = (up > 12.0) | (np.abs(along) > 6.0)  # bridge beyond 12 mm, cheeks from 6 to 10 mm
    fork = np.count_nonzero(steel & (np.abs(height) < 5.0)) * 0.25**3
    wire = round_part(0.0, 3.0, np.pi * 40.0 * 10.2)
    volume = round_part(2.5, 8.0, 10.0) + round_part(0.0, 2.5, 20.0) + fork
    volume += round_part(0.0, 5.0, 140.0 - 17.0) + 0.2 * wire
    assert demand("follower_mass") == pytest.approx(7.85e-3 * volume, rel=1e-6)


def test_stated_mass_below_that_of_the_parts_fails():
    heavy = with_roller(mass=0.1)
    check = BY_ID["follower_mass"](heavy)
    assert check.status == "fail"
    assert check.blocks


def test_stiffness_of_the_train_in_series():
    """Bearing solved anew at the preload, pin and shaft by virtual work, stem and cheeks E A/l."""
    machine, roller = run().machine, case().roller
    ring = roller.ring(machine.contact_width, 242.0).ring
    balls = ball_stiffness(242.0, roller.bearing.ring.ball_diameter, 210e9, 0.3)
    bearing = ring_bending(replace(ring, ball_stiffness=balls)).compliance.mean()
    _, moment, shear = beam(16e-3, 10e-3, False)
    x, unit, cut = beam(16e-3, 1e-5, False)
    inertia, area = np.pi / 64.0 * 5e-3**4, np.pi / 4.0 * 5e-3**2
    rigidity = 6.0 * 1.3 / (7.0 + 1.8) * 210e9 / 2.6 * area
    step = x[1] - x[0]
    pin = step * (np.sum(moment * unit) / (210e9 * inertia) + np.sum(shear * cut) / rigidity)
    fork = 12e-3 / (210e9 * 2.0 * 4e-3 * 10e-3)
    stem = (110e-3 - 12e-3) / (210e9 * np.pi / 4.0 * 0.01**2)
    whole = bearing + pin + fork + stem + shaft_by_work(20e-3)
    assert machine.axial_stiffness == pytest.approx(1.0 / whole, rel=0.03)
    assert machine.axial_stiffness < 0.1 / stem  # the stem alone is ten times as stiff
    assert replace(machine, stiffness=5e7).axial_stiffness == 5e7


def shaft_by_work(place, spacing=60e-3, diameter=17e-3):
    """Deflection under a unit load by the work of moment and shear over the shaft."""
    low, high = min(place, 0.0), max(place, spacing)
    x = low + (np.arange(60_000) + 0.5) / 60_000 * (high - low)
    second = place / spacing
    moment = (1.0 - second) * np.maximum(x, 0.0) + second * np.maximum(x - spacing, 0.0)
    moment -= np.maximum(x - place, 0.0)
    shear = np.gradient(moment, x)
    inertia, area = np.pi / 64.0 * diameter**4, np.pi / 4.0 * diameter**2
    rigidity = 6.0 * 1.3 / (7.0 + 1.8) * 210e9 / 2.6 * area
    step = x[1] - x[0]
    return step * float(np.sum(moment**2) / (210e9 * inertia) + np.sum(shear**2) / rigidity)


@pytest.mark.parametrize("place", [20e-3, -15e-3, 78e-3])
def test_deflection_of_the_camshaft_at_the_cam(place):
    shaft = replace(case().camshaft, cam_position=place)
    assert shaft_compliance(shaft) == pytest.approx(shaft_by_work(place), rel=1e-3)
    assert shaft_compliance(replace(shaft, diameter=None)) is None
    assert isinstance(shaft, Camshaft)


# --- data ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("check", "field"),
    [
        ("roller_static", "C0"),
        ("roller_load_share", "C"),
        ("roller_life", "C"),
        ("roller_modified_life", "C"),
        ("roller_modified_life", "fatigue_load_limit"),
        ("roller_modified_life", "contamination"),
        ("roller_modified_life", "viscosity"),
        ("roller_speed", "speed_limit"),
        ("roller_radial", "radial_limit"),
        ("roller_static_radial", "static_radial_limit"),
        ("bearing_lubrication", "viscosity"),
        ("grease_life", "lubrication"),
        ("roller_ring_fatigue", "ring"),
    ],
)
def test_a_missing_datum_of_the_bearing_blocks(check, field):
    bare = BY_ID[check](with_bearing(**{field: None}))
    assert bare.status == "not_evaluated"
    assert bare.blocks
    assert bare.missing == (f"roller.bearing.{field}",)


@pytest.mark.parametrize("field", ["C", "temperature"])
def test_a_missing_datum_of_the_estimate_blocks(field):
    bare = BY_ID["grease_life"](with_bearing(grease_life=None, **{field: None}))
    assert bare.blocks and bare.missing == (f"roller.bearing.{field}",)


@pytest.mark.parametrize("part", ["pin", "fork"])
def test_a_pin_or_fork_not_described_blocks(part):
    bare = BY_ID[f"data_{part}"](with_roller(pin=None, fork=None))
    assert bare.status == "not_evaluated"
    assert bare.blocks


def test_the_card_of_a_625_has_its_fatigue_limit_and_no_rating_on_a_cam():
    table = dict(known_cards(None)["bearings"]["maker_1_625_2RS"])
    del table["provenance"]
    bearing = read_part(BearingCard, table, "cards.bearings.maker_1_625_2RS").bearing
    assert bearing.fatigue_load_limit == 16.0
    assert bearing.radial_limit is None and bearing.static_radial_limit is None


def test_static_safety_of_a_cam_roller_is_that_of_shocks():
    assert type(case().limits).model_fields["roller_static_safety"].default == 2.0
