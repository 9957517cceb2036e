"""The helical spring against hand calculation, and the search of a catalogue."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.energy import spring_deflection
from camwright.geometry.errors import InputError
from camwright.pipeline.case.cards.spring_catalogue import (
    SpringDemand,
    SpringRoom,
    lightest,
    read_catalogue,
)
from camwright.pipeline.case.case_values import WIRE
from camwright.pipeline.follower import spring
from camwright.pipeline.follower.spring import (
    HelicalSpring,
    Spring,
    surge_force,
    surge_harmonics,
)
from camwright.pipeline.follower.wound_wire import WoundWire

SPRING = HelicalSpring(
    wire_diameter=5e-3,
    mean_diameter=30e-3,
    coils=9.0,
    free_length=0.11,
    shear_modulus=80e9,
    density=7850.0,
    strength_at_1mm=2000e6,
    strength_exponent=0.1,
)


def test_rate_mass_and_lengths():
    assert SPRING.rate == pytest.approx(80e9 * 5e-3**4 / (8 * 30e-3**3 * 9), rel=1e-14)
    assert SPRING.active_mass == pytest.approx(
        7850 * np.pi / 4 * 25e-6 * np.pi * 30e-3 * 9, rel=1e-14
    )
    assert SPRING.mass / SPRING.active_mass == pytest.approx(11 / 9)
    assert SPRING.solid_length == pytest.approx(55e-3)


def test_wahl_factor_and_stress():
    """C = 6: 23/20 + 0.1025 = 1.2525; 1000 N gives 1.2525 * 8 * 30 / (pi 0.125) MPa."""
    assert SPRING.wahl_factor == pytest.approx(1.2525, rel=1e-12)
    assert SPRING.stress(1000.0) == pytest.approx(
        1.2525 * 8 * 1000 * 0.03 / (np.pi * 1.25e-7), rel=1e-12
    )
    strength = 0.56 * 2000e6 * 5**-0.1
    assert SPRING.static_use(1000.0) == pytest.approx(float(SPRING.stress(1000.0)) / strength)


def test_fatigue_meets_zimmerlis_point():
    """At Zimmerli's own mean and amplitude the safety is 1; below it rises as 1/force."""
    points = {"plain": (241e6, 379e6), "peened": (398e6, 534e6)}
    for treatment, (amplitude, mean) in points.items():
        spring = replace(SPRING, treatment=treatment)
        per_newton = float(spring.stress(1.0))
        low, high = (mean - amplitude) / per_newton, (mean + amplitude) / per_newton
        assert spring.fatigue_use(low, high) == pytest.approx(1.0, rel=1e-12)
        assert spring.fatigue_use(low / 2, high / 2) == pytest.approx(0.5, rel=1e-12)
    assert SPRING.fatigue_use(0.0, 0.0) == 0.0
    steady = float(SPRING.stress(500.0)) / (0.67 * SPRING.tensile_strength)
    assert SPRING.fatigue_use(500.0, 500.0) == pytest.approx(steady)


def test_goes_solid_without_an_exception():
    room = SPRING.free_length - SPRING.solid_length
    preload = SPRING.rate * 0.01
    assert SPRING.solid_clearance(preload, room - 0.01) == pytest.approx(0.0, abs=1e-12)
    assert SPRING.solid_clearance(preload, 2 * room) < 0.0
    assert "goes solid" in SpringDemand(SPRING.rate, preload, 2 * room).shortfalls(SPRING)
    close = SpringDemand(SPRING.rate, preload, room - 0.01 - 0.99 * SPRING.minimum_gaps)
    assert "gap between coils" in close.shortfalls(SPRING)
    weak = replace(SPRING, strength_at_1mm=1000e6)
    assert "stress at solid length" in SpringDemand(SPRING.rate, preload, 0.01).shortfalls(weak)
    slender = replace(SPRING, end_factor=2.0)
    assert "buckling" in SpringDemand(SPRING.rate, preload, 0.03).shortfalls(slender)


WIRES = [replace(SPRING, **change) for change in (
    {}, {"wire_diameter": 3e-3}, {"free_length": 0.06}, {"free_length": 0.3}, {"coils": 14.0},
    {"strength_at_1mm": 700e6}, {"end_factor": 1.5}, {"mean_diameter": 45e-3},
)]  # fmt: skip


def demand_on(rate, preload, travel, **more):
    return SpringDemand(rate, preload, travel, cam_speed=30.0, rate_tolerance=0.3, **more)


@pytest.mark.parametrize("room", [SpringRoom(), SpringRoom(1.1, 0.95, 0.9, 1.3)])
def test_each_limit_of_many_springs_is_that_of_each(room):
    """One function a limit, of a spring of a catalogue and of the arrays of a design."""
    names = (*WIRE[:-1], "relaxation")
    values = {name: np.array([getattr(each, name) or np.nan for each in WIRES]) for name in names}
    values |= {"elastic_modulus": None, "relaxation": np.full(len(WIRES), 0.004)}
    many = WoundWire(**values, treatment="plain", temperature=350.0)
    kept = demand_on(SPRING.rate, np.full(len(WIRES), 300.0), 0.02, room=room).kept(many)
    one = demand_on(SPRING.rate, 300.0, 0.02, room=room)
    broken = set()
    for row, wire in enumerate(WIRES):
        own = replace(wire, relaxation=0.004, temperature=350.0)
        short = one.shortfalls(own)
        assert short == tuple(words for words, each in kept.items() if not each[row])
        broken |= {*short}
    assert len(broken) >= 6


LIMITS = [spring.STRESS, spring.FATIGUE, spring.SOLID, spring.COIL_GAP, spring.BUCKLING,
          spring.RELAXATION]  # fmt: skip


@pytest.mark.parametrize("limit", LIMITS, ids=lambda each: each.words)
def test_a_limit_has_a_derivative_and_no_pass_without_a_number(limit):
    wire = replace(SPRING, relaxation=0.004, temperature=350.0, free_length=0.2, end_factor=0.7)

    def at(travel):
        return limit.demand(wire, wire.at_work(300.0, travel, 0.05, 0.05))

    step = np.imag(at(np.array([0.02 + 1e-30j]))) / 1e-30
    quotient = (at(np.array([0.02 + 1e-6])) - at(np.array([0.02 - 1e-6]))) / 2e-6
    np.testing.assert_allclose(step, quotient, rtol=1e-6)
    work = wire.at_work(300.0, 0.01, 0.05, 0.05)
    assert limit.holds(wire, work, -1.0 if limit.at_least else 2.0)
    if limit.allowed is None:
        assert not limit.holds(wire, work, np.nan)
        with pytest.raises(InputError, match="no limit"):
            limit.holds(wire, work)
    if limit not in (spring.STRESS, spring.FATIGUE):  # a force that is not finite is refused
        assert not limit.holds(wire, work._replace(travel=np.nan, greatest=np.nan), 2.0)


def test_buckling_and_surge():
    """The limit of any deflection is 2.62 D over the end factor at E/G = 2.6; sqrt(k/m)/2."""
    stable = np.pi * np.sqrt((1 - 1 / 2.6) / (0.5 + 1 / 2.6)) * 0.03 / 0.5
    assert stable / 0.03 * 0.5 == pytest.approx(2.62, abs=0.005)
    assert replace(SPRING, free_length=0.999 * stable).buckling_deflection == np.inf
    assert replace(SPRING, free_length=1.001 * stable).buckling_deflection < np.inf
    assert SPRING.surge_frequency == pytest.approx(0.5 * np.sqrt(SPRING.rate / SPRING.active_mass))


def test_gaps_and_stress_at_solid_length_by_hand():
    """n = 9, D = 30, d = 5: S_a = 9 (0.27 + 0.5) mm, half as much again for a dynamic load."""
    assert SPRING.minimum_gaps == pytest.approx(1.5 * 9 * 0.77e-3, rel=1e-12)
    room = 0.11 - 0.055
    assert SPRING.gap_left(SPRING.rate * 0.01, 0.02) == pytest.approx(room - 0.03, rel=1e-12)
    # tau = G d s / (pi D^2 n), the same stress by the deflection
    stress = 80e9 * 5e-3 * room / (np.pi * 0.03**2 * 9)
    assert SPRING.solid_stress(SPRING.rate) == pytest.approx(stress, rel=1e-12)


def test_relaxation_is_unknown_without_its_data():
    warm = replace(SPRING, temperature=350.0, relaxation=0.03)
    assert warm.relaxed_preload(100.0, 400.0) == pytest.approx(0.12)
    for unknown in ({"temperature": None}, {"relaxation": None}):
        assert np.isnan(replace(warm, **unknown).relaxed_preload(100.0, 400.0))


def test_surge_resonates_where_a_harmonic_meets_a_mode():
    """The third harmonic drives the first mode: at resonance 1/zeta of the slow amplitude."""
    theta = 2 * np.pi * np.arange(128) / 128
    lift = 1e-3 * np.cos(3 * theta)
    frequency, damping = 300.0, 0.01
    at = 2 * np.pi * frequency / 3
    peak = np.ptp(surge_force(lift, at, 24e3, frequency, damping)) / 2
    assert peak == pytest.approx(24.0 / damping, rel=0.02)
    for off in (0.97, 1.03):
        assert np.ptp(surge_force(lift, off * at, 24e3, frequency, damping)) < peak
    highest, margin = surge_harmonics(lift, 2 * np.pi * frequency / at)
    assert (highest, margin) == (3, pytest.approx(1.0))


@pytest.mark.parametrize("share", [0.1, 0.7, 1.4, 2.6])
def test_surge_is_that_of_a_wave_in_the_coils(share):
    """k (phi cot(phi) - 1) of the wave equation at the moving end, the other held."""
    theta = 2 * np.pi * np.arange(64) / 64
    own, phi = 300.0, np.pi * share
    force = surge_force(1e-3 * np.cos(theta), 2 * np.pi * own * share, 24e3, own, damping=1e-7)
    exact = 24.0 * (phi / np.tan(phi) - 1.0) * np.cos(theta)
    np.testing.assert_allclose(force, exact, atol=1e-5 * np.abs(exact).max())


def test_surge_vanishes_slowly():
    theta = 2 * np.pi * np.arange(64) / 64
    lift = 1e-3 * np.cos(theta)
    slow, slower = (np.abs(surge_force(lift, w, 24e3, 300.0, 0.01)).max() for w in (10.0, 5.0))
    assert slow / slower == pytest.approx(4.0, rel=1e-3)
    assert not surge_force(lift, 0.0, 24e3, 300.0, 0.01).any()
    assert surge_harmonics(np.ones(16), 300.0)[1] == np.inf


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"wire_diameter": 0.0}, "wire_diameter"),
        ({"mean_diameter": 0.01}, "mean_diameter"),
        ({"coils": 1.0}, "coils"),
        ({"coils": float("nan")}, "coils"),
        ({"free_length": 0.05}, "free_length"),
        ({"end_factor": 0.0}, "end_factor"),
        ({"density": -1.0}, "density"),
        ({"shear_modulus": 0.0}, "shear_modulus"),
        ({"strength_at_1mm": float("inf")}, "strength_at_1mm"),
        ({"strength_exponent": 1.0}, "strength_exponent"),
    ],
)
def test_refusals(change, field):
    with pytest.raises(InputError, match=rf"spring\.design\.{field}"):
        replace(SPRING, **change)


def test_refuses_forces_out_of_order():
    with pytest.raises(InputError, match="force"):
        SPRING.fatigue_use(2.0, 1.0)


def test_tensile_strength_falls_with_the_wire_s_diameter():
    """R_m at 1 mm times (5 mm / 1 mm)^-0.1."""
    assert SPRING.tensile_strength == pytest.approx(2000e6 * 5**-0.1, rel=1e-14)
    assert replace(SPRING, strength_exponent=0.0).tensile_strength == 2000e6


def test_spring_of_the_follower_by_hand():
    """24 kN/m and 240 N: 480 N at 10 mm, and 3.6 J beyond the preload's."""
    spring = Spring(rate=24e3, preload=240.0)
    lift = np.array([0.0, 0.01])
    np.testing.assert_allclose(spring.force(lift), [240.0, 480.0], rtol=1e-14)
    np.testing.assert_array_equal(spring.stiffness(lift), [24e3, 24e3])
    assert spring.energy(0.01) == pytest.approx(3.6, rel=1e-14)
    stored = spring_deflection([0.0, 3.6], spring.rate, spring.preload)
    np.testing.assert_allclose(stored, lift, atol=1e-15)


def test_lightest_of_the_shipped_catalogue():
    """The published spring: 24.2 kN/m, 242 N; 25 mm of travel. The winner meets every demand."""
    catalogue = read_catalogue()
    demand = SpringDemand(24.2e3, 242.0, 25e-3, rate_tolerance=0.06)
    best, reasons = lightest(catalogue, demand)
    assert best is not None
    assert not demand.shortfalls(best)
    fit = [spring for spring in catalogue if spring.name not in reasons]
    assert len(fit) >= 2
    assert best.mass == min(spring.mass for spring in fit)
    assert any("fatigue" in reason for reason in reasons.values())
    none, why = lightest(catalogue, replace(demand, travel=0.5))
    assert none is None
    assert len(why) == len(catalogue)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("nonsense", "KEY = VALUE"),
        ("[wires.a]\nstrength_exponent = 0.1", "missing"),
        ("[[spring]]\nname = 'a'\ncolour = 'red'", "unknown key"),
        (
            "[[spring]]\nname='a'\nwire='b'\nwire_diameter='1 mm'\nmean_diameter='5 mm'\n"
            "coils=3\nfree_length='30 mm'",
            "one of",
        ),
    ],
)
def test_refuses_a_bad_catalogue(tmp_path, text, match):
    path = tmp_path / "springs.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=match):
        read_catalogue(path)
    with pytest.raises(InputError, match="catalogue"):
        read_catalogue(tmp_path / "absent.toml")
