"""Spring, jump and speed sweep of a solved machine against independent formulations.

The coils are a chain of linear finite elements, integrated in time by Newmark's method; buckling is
an eigenvalue problem of Haringx's column; the rest is recomputed from the geometry of the wire.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from stated_loads import stated_loads

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import jump_and_jamming, spring_strength
from camwright.pipeline.cycle.speed_sweep import speed_sweep
from camwright.pipeline.follower.spring import dynamic_stiffness, surge_force
from camwright.pipeline.preview import preview_case

SOFT_SPRING = Path(__file__).parents[1] / "data" / "soft_spring.toml"
RPM = np.pi / 30.0
ELEMENTS, STEPS, TURNS = 40, 480, 14
SIXTH = 2e-4  # m, amplitude of the sixth harmonic
WORST = 3440.0  # rpm: the first mode meets the sixth harmonic


def machine_case(**limits):
    """The soft spring at an over-speed of 3600 rpm; its temperature and relaxation assumed."""
    case = read_case(SOFT_SPRING)
    design = replace(case.spring.design, temperature=350.0, relaxation=0.01)
    spring = replace(case.spring, design=design, rate_tolerance=0.05, preload_tolerance=0.05)
    values = case.limits.model_copy(update={"overspeed": 3600.0 * RPM} | limits)
    return case.model_copy(update={"limits": values, "spring": spring})


def lift_of(theta, sixth=SIXTH):
    """20 mm with a sixth harmonic, as a smoothed torque leaves one."""
    return 0.01 * (1.0 - np.cos(theta)) + sixth * (1.0 - np.cos(6.0 * theta))


@pytest.fixture(scope="module")
def solved():
    theta = uniform_turn(720)
    case = machine_case()
    contour = case.contour(Lift(theta, lift_of(theta)))
    return stated_loads(case, contour, 360, coarse=True)


# --- the coils as a chain of elements -------------------------------------------------------


def wire(design, rate):
    """Mass of the active coils and rate of the chain."""
    length = np.pi * design.mean_diameter * design.coils
    return design.density * np.pi * design.wire_diameter**2 / 4.0 * length, rate


def chain(mass, rate):
    """Mass and stiffness matrices of the coils, both ends included; consistent masses."""
    M, K = (np.zeros((ELEMENTS + 1, ELEMENTS + 1)) for _ in range(2))
    for e in range(ELEMENTS):
        at = np.ix_([e, e + 1], [e, e + 1])
        M[at] += mass / ELEMENTS * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
        K[at] += rate * ELEMENTS * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return M, K


def modal_damping(M, K, ratio):
    """Viscous damping matrix that gives every mode the same damping ratio."""
    root = np.linalg.cholesky(M)
    inverse = np.linalg.inv(root)
    square, modes = np.linalg.eigh(inverse @ K @ inverse.T)
    spread = root @ modes
    return spread @ np.diag(2.0 * ratio * np.sqrt(np.maximum(square, 0.0))) @ spread.T


def integrated(M, C, K, load, step):
    """Displacement, velocity and acceleration (steps, dofs) over the last turn.

    Newmark's average acceleration under a periodic load (steps, dofs), from the static state.
    """
    x = np.linalg.solve(K, load[0])
    v = np.zeros_like(x)
    a = np.linalg.solve(M, load[0] - K @ x)
    effective = np.linalg.inv(K + 2.0 * C / step + 4.0 * M / step**2)
    history = []
    for k in range(TURNS * STEPS):
        at = load[(k + 1) % STEPS]
        right = at + M @ (4.0 * x / step**2 + 4.0 * v / step + a) + C @ (2.0 * x / step + v)
        new = effective @ right
        new_v = 2.0 * (new - x) / step - v
        a = 4.0 * (new - x) / step**2 - 4.0 * v / step - a
        x, v = new, new_v
        history.append((x, v, a))
    last = history[-STEPS:]
    return tuple(np.roll(np.array([each[i] for each in last]), 1, axis=0) for i in range(3))


@cache
def driven_coils(design, rate, cam_speed):
    """Force in the coils at moving and fixed end less the preload, N, over a turn."""
    M, K = chain(*wire(design, rate))
    theta, step = uniform_turn(STEPS), 2.0 * np.pi / cam_speed / STEPS
    s = lift_of(theta)
    acceleration = cam_speed**2 * (0.01 * np.cos(theta) + 36.0 * SIXTH * np.cos(6.0 * theta))
    inside = slice(1, ELEMENTS)
    m, k = M[inside, inside], K[inside, inside]
    c = modal_damping(m, k, design.damping)
    # relative to the coils that follow the moving end in proportion
    share = np.linspace(0.0, 1.0, ELEMENTS + 1)
    load = -np.outer(acceleration, (M @ share)[inside])
    u, _, a = integrated(m, c, k, load, step)
    reactions = []
    for end in (-1, 0):
        inertia = M[end, inside] @ a.T + (M @ share)[end] * acceleration
        elastic = K[end, inside] @ u.T + (K @ share)[end] * s
        reactions.append(elastic + inertia)
    return reactions[0], -reactions[1]


@pytest.mark.parametrize("rpm", [WORST, 3000.0, 1500.0])
def test_surge_is_that_of_coils_integrated_in_time(solved, rpm):
    design, rate = solved.machine.spring.design, solved.machine.spring.rate
    cam_speed = 0.5 * rpm * RPM
    moving, fixed = driven_coils(design, rate, cam_speed)
    s = lift_of(uniform_turn(STEPS))
    frequency = 0.5 * np.sqrt(rate / design.active_mass)
    surge = surge_force(s, cam_speed, rate, frequency, design.damping)
    swing = np.abs(moving - rate * s).max()
    np.testing.assert_allclose(surge, moving - rate * s, atol=0.02 * swing)
    drive = np.arange(STEPS // 2 + 1) * cam_speed
    stiffness = dynamic_stiffness(drive, rate, frequency, design.damping).fixed
    held = np.fft.irfft(stiffness * np.fft.rfft(s), STEPS)
    np.testing.assert_allclose(held, fixed - rate * s, atol=0.02 * swing)


def test_first_frequency_is_that_of_the_chain(solved):
    machine = solved.machine
    M, K = chain(*wire(machine.spring.design, machine.spring.design.rate))
    inside = slice(1, ELEMENTS)
    square = np.linalg.eigvals(np.linalg.solve(M[inside, inside], K[inside, inside])).real.min()
    cam = 3600.0 / 120.0
    check = spring_strength.spring_surge(solved)
    assert check.demand == pytest.approx(np.sqrt(square) / (2.0 * np.pi) / cam, rel=1e-3)
    assert not check.must_have  # the sweep decides, see below


def test_the_contact_is_lost_between_the_load_cases(solved):
    """At 1500 and 3600 rpm the contact holds; at 3440 rpm the coils swing against the follower."""
    assert jump_and_jamming.contact_force_margin(solved).status == "pass"
    assert jump_and_jamming.contact_at_overspeed(solved).status == "pass"
    check = jump_and_jamming.contact_over_speed(solved)
    assert check.must_have
    assert check.status == "fail"
    machine, loads = solved.machine, solved.cycles[-1].loads
    theta = uniform_turn(STEPS)
    # friction and slope of the flank as in a solved load case
    rigid = loads.spring_force + loads.inertia_force + loads.viscous_force
    gain = np.interp(theta, loads.theta, loads.normal_force / rigid, period=2.0 * np.pi)
    least = np.inf
    for rpm in (3437.0, 3440.0):
        cam_speed = 0.5 * rpm * RPM
        moving, _ = driven_coils(machine.spring.design, machine.spring.rate, cam_speed)
        bend = 0.01 * np.cos(theta) + 36.0 * SIXTH * np.cos(6.0 * theta)
        push = machine.spring.preload + moving + machine.mass_without_spring * cam_speed**2 * bend
        least = min(least, float((push * gain).min()))
    assert check.demand == pytest.approx(least / machine.spring.preload, abs=0.03)


def test_the_sweep_misses_no_resonance(solved):
    """Against a thousand speeds about the resonance."""
    machine, rubbing = solved.machine, solved.cycles[0].loads.rubbing
    dense = tuple(np.linspace(3300.0, 3600.0, 1000) * RPM)
    fine = speed_sweep(machine, solved.contour, rubbing, dense)
    (swept,) = solved.speed_sweeps
    for name, least in (
        ("contact_force_min", np.min), ("elastic_force_min", np.min), ("surge_force", np.max),
        ("contact_force_max", np.max), ("torque_max", np.max), ("torque_min", np.min),
    ):  # fmt: skip
        extreme = least(getattr(swept, name))
        # of the swing at resonance, several hundred newtons
        assert extreme == pytest.approx(least(getattr(fine, name)), rel=1e-3, abs=0.3), name


def test_elastic_contact_is_that_of_coils_mass_and_stem_in_time(solved):
    """The chain of the coils with the follower's mass at its end on the stem."""
    machine = solved.machine
    design, rate = machine.spring.design, machine.spring.rate
    M, K = (each[1:, 1:].copy() for each in chain(*wire(design, rate)))
    C = np.zeros_like(M)
    # the coils are damped between fixed ends, as their modes are
    C[:-1, :-1] = modal_damping(M[:-1, :-1], K[:-1, :-1], design.damping)
    stem = machine.axial_stiffness
    damping = machine.damping_ratio * 2.0 * np.sqrt(machine.mass_without_spring * (stem + rate))
    # relative to coils that follow the mass in proportion: their damping does not act on that
    follow = np.linspace(0.0, 1.0, ELEMENTS + 1)[1:]
    turn = np.eye(ELEMENTS)
    turn[:, -1] = follow
    M, K = (turn.T @ each @ turn for each in (M, K))
    M[-1, -1] += machine.mass_without_spring
    K[-1, -1] += stem
    C[-1, -1] += damping
    theta = uniform_turn(STEPS)
    least = np.inf
    for rpm in (3437.0, 3440.0):
        cam_speed = 0.5 * rpm * RPM
        s = lift_of(theta)
        slope = cam_speed * (0.01 * np.sin(theta) + 6.0 * SIXTH * np.sin(6.0 * theta))
        load = np.zeros((STEPS, ELEMENTS))
        load[:, -1] = stem * s + damping * slope - machine.spring.preload
        x, v, _ = integrated(M, C, K, load, 2.0 * np.pi / cam_speed / STEPS)
        force = stem * (s - x[:, -1]) + damping * (slope - v[:, -1])
        least = min(least, float(force.min()))
    check = jump_and_jamming.elastic_contact(solved)
    assert check.demand == pytest.approx(least / machine.spring.preload, abs=0.03)
    assert check.must_have


def test_the_follower_swings_on_its_stem_as_the_chain_with_its_mass(solved):
    """The mode in which the mass moves most; its coils add a share of their mass: 1 %."""
    machine = solved.machine
    M, K = (
        each[1:, 1:].copy() for each in chain(*wire(machine.spring.design, machine.spring.rate))
    )
    M[-1, -1] += machine.mass_without_spring
    K[-1, -1] += machine.axial_stiffness
    squares, modes = eigh(K, M)
    moved = np.abs(modes[-1]) * np.sqrt(M[-1, -1])
    frequency = float(np.sqrt(squares[np.argmax(moved)]))
    check = jump_and_jamming.rigid_follower(solved)
    fastest = max(each.cam_speed for each in solved.machines)
    assert check.demand == pytest.approx(frequency / fastest, rel=0.01)
    assert not check.must_have


def test_strength_and_fatigue_take_the_force_at_the_ends_of_the_coils(solved):
    """Preload and rate 5 % high; the rate's square root moves the resonance by 2.5 %."""
    machine = solved.machine
    design = machine.spring.design
    worst_stress, worst_use = 0.0, 0.0
    d, D = design.wire_diameter, design.mean_diameter
    C = D / d
    wahl = (4.0 * C - 1.0) / (4.0 * C - 4.0) + 0.615 / C
    tensile = 1974e6 * 6.0**-0.108
    rate = 1.05 * design.rate
    own = 60.0 / 6.0 * 2.0 * 0.5 * np.sqrt(rate / wire(design, rate)[0])
    for rpm in np.array([0.998, 1.0]) * own:
        for end in driven_coils(design, rate, 0.5 * rpm * RPM):
            force = 1.05 * machine.spring.preload + end
            # torsion of a round bar by the moment F D/2
            tau = wahl * 16.0 * 0.5 * D * force / (np.pi * d**3)
            amplitude, mean = 0.5 * np.ptp(tau), 0.5 * (tau.max() + tau.min())
            endurance = 398e6 / (1.0 - 534e6 / (0.67 * tensile))
            worst_stress = max(worst_stress, tau.max() / (0.56 * tensile))
            worst_use = max(worst_use, amplitude / endurance + mean / (0.67 * tensile))
    assert spring_strength.spring_stress(solved).demand == pytest.approx(worst_stress, rel=0.02)
    fatigue = spring_strength.spring_fatigue(solved)
    assert fatigue.demand == pytest.approx(1.0 / worst_use, rel=0.02)
    slow = 1.05 * (machine.spring.preload + design.rate * solved.contour.pitch.lift.stroke)
    assert worst_use > design.fatigue_use(1.05 * machine.spring.preload, slow)


def test_slow_coils_are_massless(solved):
    """phi cot phi - 1 -> -phi^2/3: the inertia of a third of the active mass."""
    design, rate = solved.machine.spring.design, solved.machine.spring.rate
    s, w = lift_of(uniform_turn(STEPS), sixth=0.0), 10.0
    frequency = 0.5 * np.sqrt(rate / design.active_mass)
    surge = surge_force(s, w, rate, frequency, 1e-6)
    third = design.active_mass / 3.0 * w**2 * 0.01 * np.cos(uniform_turn(STEPS))
    np.testing.assert_allclose(surge, third, atol=1e-3 * np.abs(third).max())


# --- statics of the spring ------------------------------------------------------------------


def haringx_deflection(design):
    """Least deflection with a clamped column of coils in neutral equilibrium, m.

    Rigidities of coils about the axis of the spring: bending by E and G of the wire, shear by
    bending of the wire; the shear force acts along the section. Linear elements of y and theta,
    one-point shear.
    """
    d, r, n = design.wire_diameter, 0.5 * design.mean_diameter, design.coils
    G, E = design.shear_modulus, 2.6 * design.shear_modulus
    inertia = np.pi * d**4 / 64.0
    count = 40

    def load_over_critical(deflection):
        length = design.free_length - deflection
        bending = 2.0 * E * G * inertia * length / (np.pi * n * r * (E + 2.0 * G))
        shear = E * inertia * length / (np.pi * n * r**3)
        h = length / count
        size = 2 * (count + 1)
        stiff, geometric = np.zeros((size, size)), np.zeros((size, size))
        for e in range(count):
            slope = np.array([-1.0 / h, 0.0, 1.0 / h, 0.0])  # y'
            tilt = np.array([0.0, 0.5, 0.0, 0.5])  # theta
            curve = np.array([0.0, -1.0 / h, 0.0, 1.0 / h])
            gamma = slope - tilt
            at = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
            stiff[at] += h * (bending * np.outer(curve, curve) + shear * np.outer(gamma, gamma))
            # shortening theta^2/2 + theta gamma
            cross = np.outer(tilt, gamma)
            geometric[at] += h * (np.outer(tilt, tilt) + cross + cross.T)
        free = np.arange(2, size - 2)
        stiff, geometric = stiff[np.ix_(free, free)], geometric[np.ix_(free, free)]
        inverse = eigh(geometric, stiff, eigvals_only=True)[-1]
        return design.rate * deflection * inverse - 1.0

    low, high = 1e-6 * design.free_length, 0.8 * design.free_length
    trial = np.linspace(low, high, 60)
    signs = np.array([load_over_critical(each) for each in trial])
    first = int(np.argmax(signs > 0.0))
    if not signs[first] > 0.0:
        return np.inf
    low, high = trial[first - 1], trial[first]
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if load_over_critical(middle) > 0.0 else (middle, high)
    return 0.5 * (low + high)


@pytest.mark.parametrize("slenderness", [5.5, 6.5, 8.0])
def test_buckling_is_that_of_haringxs_column(solved, slenderness):
    """Clamped ends; long springs of many coils, for which the wire is a column."""
    design = replace(
        solved.machine.spring.design,
        coils=20.0,
        free_length=slenderness * solved.machine.spring.design.mean_diameter,
        wire_diameter=4e-3,
    )
    assert design.buckling_deflection == pytest.approx(haringx_deflection(design), rel=1e-2)


def test_a_stout_spring_does_not_buckle(solved):
    design = solved.machine.spring.design
    assert haringx_deflection(design) == np.inf
    check = spring_strength.spring_buckling(solved)
    assert (check.demand, check.must_have) == (0.0, True)
    slender = replace(design, end_factor=1.0)
    spring = replace(solved.case.spring, design=slender)
    case = solved.case.model_copy(update={"spring": spring})
    one = spring_strength.spring_buckling(replace(solved, case=case, machines=machines(case)))
    # twice the length between clamped ends is a column of one length between hinges
    twice = replace(design, coils=2 * design.coils, free_length=2 * design.free_length)
    hinged = 0.5 * haringx_deflection(twice)
    deflection = 1.05 * 242.0 / design.rate + solved.contour.pitch.lift.stroke
    assert one.demand == pytest.approx(deflection / hinged, rel=0.015)


def test_gaps_and_solid_length_from_the_wire(solved):
    """Turn by turn: the gap of a coil is its pitch less the wire, less its share of deflection."""
    design = solved.machine.spring.design
    d, D, n = design.wire_diameter, design.mean_diameter, design.coils
    pitch = (design.free_length - 2.0 * d) / n
    # a coil yields 8 F D^3/(G d^4)
    coil = 8.0 * D**3 / (design.shear_modulus * d**4)
    gap = pitch - d - 1.05 * 242.0 * coil - 0.02 / n
    check = spring_strength.spring_coil_gap(solved)
    assert check.demand == pytest.approx(n * gap, rel=1e-6)
    assert check.limit == pytest.approx(1.5 * n * (0.0015 * (D / d) * D + 0.1 * d), rel=1e-12)
    clearance = spring_strength.spring_solid(solved).demand
    assert clearance == pytest.approx(gap / (pitch - d - gap), rel=1e-6)
    # tau = G d f / (pi D^2) of a coil that closes by f
    solid = spring_strength.spring_solid_stress(solved)
    closed = design.shear_modulus * d * (pitch - d) / (np.pi * D**2)
    assert solid.demand == pytest.approx(1.05 * closed, rel=1e-9)
    assert solid.limit == pytest.approx(0.56 * 1974e6 * 6.0**-0.108, rel=1e-9)


def test_rate_and_relaxation_from_the_wire(solved):
    design, spring = solved.machine.spring.design, solved.machine.spring
    # energy of torsion of the wire: k = 1 / (r^2 L / (G J))
    r, d = 0.5 * design.mean_diameter, design.wire_diameter
    length = 2.0 * np.pi * r * design.coils
    rate = design.shear_modulus * np.pi * d**4 / 32.0 / (r**2 * length)
    assert spring_strength.spring_rate(solved).demand == pytest.approx(
        abs(rate / spring.rate - 1.0), rel=1e-6
    )
    lost = 0.01 * (1.05 * 242.0 + 1.05 * rate * 0.02) / (1.05 * 242.0)
    assert spring_strength.spring_relaxation(solved).demand == pytest.approx(lost, rel=1e-6)


# --- rigid follower -------------------------------------------------------------------------


def test_margin_and_jump_from_motion_in_time(solved):
    """Acceleration by differences of the lift in time; friction from the reported guide loads."""
    margin, unloading, speeds, over = [], [], [], []
    for cycle in solved.cycles:
        machine, loads, w = cycle.machine, cycle.loads, cycle.cam_speed
        step = 1e-3
        s = lift_of(cycle.theta)
        rate = (lift_of(cycle.theta + step) - lift_of(cycle.theta - step)) / (2.0 * step)
        bend = (lift_of(cycle.theta + step) - 2.0 * s + lift_of(cycle.theta - step)) / step**2
        hold = machine.spring.preload + machine.spring.rate * s
        inertia = machine.mass * bend * w**2
        mu = machine.friction.nominal
        rub = mu[0] * cycle.guides.rubbing_load_a + mu[1] * cycle.guides.rubbing_load_b
        axial = hold + inertia + np.sign(np.where(np.abs(rate) > 1e-9, rate, 0.0)) * rub
        slant = np.arctan(rate / (machine.cam.prime_radius + s))
        margin.append(float(sampled_least(axial / np.cos(slant))) / machine.spring.preload)
        unloading.append(float(sampled_greatest(-inertia / hold)))
        speeds.append(w / np.sqrt(unloading[-1]))
        fast = machine.mass * bend * (0.5 * 3600.0 * RPM) ** 2
        over.append(float(sampled_least(hold + fast)) / machine.spring.preload)
        assert loads.lift == pytest.approx(s, abs=1e-9)
    found = {
        each.id: each(solved)
        for each in (
            jump_and_jamming.contact_force_margin, jump_and_jamming.jump,
            jump_and_jamming.jump_speed, jump_and_jamming.contact_at_overspeed,
        )
    }  # fmt: skip
    assert found["contact_force_margin"].demand == pytest.approx(min(margin), rel=1e-4)
    assert found["jump"].demand == pytest.approx(max(unloading), rel=1e-4)
    assert found["jump_speed"].demand == pytest.approx(2.0 * min(speeds), rel=1e-4)
    assert found["jump_speed"].limit == pytest.approx(1.3 * 3600.0 * RPM, rel=1e-12)
    assert found["contact_at_overspeed"].demand == pytest.approx(min(over), rel=1e-4)


def test_no_over_speed_is_made_of_the_fastest_load_case(solved):
    case = machine_case(overspeed=None)
    machines = tuple(replace(each, limits=case.limits) for each in solved.machines)
    bare = replace(solved, case=case, machines=machines)
    for declared in (jump_and_jamming.jump_speed, jump_and_jamming.contact_at_overspeed):
        check = declared(bare)
        assert check.status == "not_evaluated"
        assert check.blocks
        assert check.missing == ("limits.overspeed",)
    assert "without limits.overspeed" in jump_and_jamming.contact_over_speed(bare).note


@pytest.mark.slow
def test_the_roller_leaves_the_cam_below_over_speed():
    """Its sixth harmonic meets the first mode of the spring at 3440 rpm, with 1 % of damping."""
    trial = preview_case(read_case(SOFT_SPRING).with_positions(72))
    checks = {check.id: check for check in trial.checks}
    assert checks["contact_force_margin"].status == "pass"
    assert checks["contact_over_speed"].demand < 0.0
    design = trial.case.spring.design
    met = 0.5 * np.sqrt(design.rate / design.active_mass) / 6.0 * 2.0 * 60.0
    assert met == pytest.approx(3440.0, abs=2.0)
    assert f"at {met:.0f}"[:5] in checks["contact_over_speed"].note
