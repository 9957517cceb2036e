"""The constrained synthesis against an independent nonlinear program, solved by IPOPT."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from oracle_limits import LIMITS
from oracle_model import DEGREE, RESERVE, periodic_basis
from oracle_numbers import with_number
from scipy.optimize import brentq
from synthesis_oracle import Oracle
from synthesis_problems import (
    MEASURED,
    OF_ROLLER,
    constrained,
    described,
    measured,
    nominal,
    of_duty,
    rated,
    requiring,
    signed,
    thinned,
    variant,
    with_corrections,
)
from synthesis_ratings import named
from synthesis_scenarios import changed

from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.shadow_prices import prices

AGREE = 1e-3  # of ripple and objective; local optima of both are solved to 1e-6
AGREE_PRICE = 1e-2  # of multipliers: the search stops at 2e-6 of the merit
AGREE_VIOLATION = 1e-2
STEPS_MAX = 40
ACTIVE = 5e-3  # multiplier of an active limit
BINDS = 1e-4  # multiplier of a limit that binds
SMOOTH = 2.5e-3  # of the jerk's weight in the signed case, with which its ripple is least
FREED = {
    "rate": {"rate": (120e3, 260e3)},
    "rate and preload": {"rate": (120e3, 260e3), "preload": (600.0, 1600.0)},
    "base radius": {"prime_radius": (0.050, 0.066)},
}
FEASIBLE_VARIANTS, INFEASIBLE_VARIANTS = (1, 2, 4, 8), (5, 6, 10, 11)


def small(seed):
    """Seeded variant of the signed machine, its load cases without corners, on fewer angles."""
    return variant(thinned(nominal(signed()), 48, 360), seed)


def judged(problem):
    """Product's design; its ripple with the weighted jerk; its excess over the limits by check."""
    design = synthesise(problem)
    state = Search(problem).state(design.coefficients, design.variables)
    excess = {name: max(0.0, use - 1.0 + RESERVE) for name, use in state.utilisation.items()}
    return design, state.ripple + state.jerk, excess


def missed(problem, optimum):
    """Product's design, and what it or the oracle misses of the same optimum."""
    design, objective, _ = judged(problem)
    holds = {
        "oracle within all limits": optimum.feasible and optimum.constraint_violation <= 1e-8,
        "within all limits": design.feasible,
        "converged": design.converged and design.steps <= STEPS_MAX,
        "ripple": design.ripple == pytest.approx(optimum.ripple, rel=AGREE),
        "objective": objective == pytest.approx(optimum.objective, rel=AGREE),
    }
    return design, [name for name, value in holds.items() if not value]


def of_both_guides(multipliers):
    """Both guides limit the sliding speed alike; how they share the multiplier is open."""
    merged = dict(multipliers)
    merged["guide_speed"] = merged.pop("guide_speed_A", 0.0) + merged.pop("guide_speed_B", 0.0)
    return merged


def active_multipliers(design):
    merged = of_both_guides(design.multipliers)
    return {name: value for name, value in merged.items() if value > ACTIVE}


def approximately(values, share):
    return {name: pytest.approx(value, rel=share) for name, value in values.items()}


def multipliers_of(optimum, names):
    """Multipliers of the oracle, to 1 %."""
    merged = of_both_guides(optimum.multipliers)
    return approximately({name: merged[name] for name in names}, AGREE_PRICE)


def test_each_constraint_has_a_function_and_a_source():
    assert all(each.source for each in LIMITS)
    assert len({each.check for each in LIMITS}) == len(LIMITS)
    assert {each.check for each in LIMITS} == {each.check for each in OF_ROLLER}


def test_splines_of_scipy_close_and_differentiate():
    """Partition of unity; a derivative against a central difference of step 1e-5: 1e-8."""
    theta = np.linspace(0.0, 2.0 * np.pi, 50)
    np.testing.assert_allclose(periodic_basis(theta, 24).sum(axis=1), 1.0, rtol=1e-12)
    for order in range(3):
        ahead, behind = (periodic_basis(theta + step, 24, order) for step in (1e-5, -1e-5))
        exact = periodic_basis(theta, 24, order + 1)
        np.testing.assert_allclose((ahead - behind) / 2e-5, exact, atol=1e-7 * np.abs(exact).max())


def jamming_on_the_rise(utilisations):
    """Utilisations with the jam index of the return at zero; the product has it negative."""
    return {
        name: max(use, 0.0) if name.startswith("jam_index") else use
        for name, use in utilisations.items()
    }


def at_a_random_cam(problem, seed, free):
    """Objective and utilisations of the product and of the oracle at one random cam."""
    oracle = Oracle(problem)
    energy, _ = oracle.random_start(seed)
    # the oracle counts knots from the first of the spline, the product from its last
    state = Search(problem).state(np.roll(energy, -DEGREE), problem.variables)
    own = jamming_on_the_rise(state.utilisation)
    expected = {
        name: pytest.approx(use, rel=1e-8, abs=1e-10)
        for name, use in jamming_on_the_rise(oracle.utilisation(energy, free)).items()
    }
    ripple, jerk = oracle.objective(energy, free)
    own |= {"ripple": state.ripple, "jerk": state.jerk}
    expected |= {
        "ripple": pytest.approx(ripple, rel=1e-9),
        "jerk": pytest.approx(jerk, rel=1e-6),  # of its scale: a fit of the torque
    }
    return own, expected


@pytest.mark.parametrize(("seed", "phase"), [(1, 0.0), (2, 0.07)])
def test_utilisations_are_those_of_the_formulas(seed, phase):
    """At any smooth cam, within its limits or not; 1e-8: round-off of both, to the third power."""
    problem = thinned(measured("v10"), 24, 120)
    variables = replace(problem.variables, preload=500.0, phase=phase)
    problem = replace(problem, variables=variables, freed={"phase": (-0.1, 0.1)})
    own, expected = at_a_random_cam(problem, seed, {"phase": phase})
    assert own == expected


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_utilisations_of_every_part_are_those_of_the_formulas(seed):
    """As above, of every constraint; without, then with corrections and surge."""
    problem = thinned(described(signed()), 24, 120)
    problem = replace(problem, ratings=rated(problem.ratings, gas_slope=0.03, outer_undercut=0.7))
    if seed > 1:
        problem = with_corrections(problem, seed)
    own, expected = at_a_random_cam(problem, seed, {})
    assert own == expected
    assert set(own) == {each.check for each in LIMITS} | {"torque_reduction", "ripple", "jerk"}


@pytest.mark.parametrize("of_a_duty", [False, True])
def test_small_problem_ends_at_the_optimum_of_the_nonlinear_program(of_a_duty):
    """With a duty both load cases spend the life of the roller, which binds."""
    problem = thinned(measured("v10"), 24, 240)
    if of_a_duty:
        problem = of_duty(problem, idle=0.6, overspeed=0.4)
        least = 0.25 * named(problem.ratings).life_force_cubed
        problem = with_number(problem, "life_force_cubed", least)
    optimum = Oracle(problem).solved()
    design, unmet = missed(problem, optimum)
    assert unmet == []
    active = active_multipliers(design)
    assert active
    assert active == multipliers_of(optimum, active)
    assert ("roller_life" in active) == of_a_duty


@pytest.mark.slow
@pytest.mark.parametrize("name", MEASURED)
def test_nonlinear_program_ends_at_one_optimum_from_a_random_start(name):
    """The measured least ripple, of five digits, as from the exact energy below."""
    oracle = Oracle(measured(name))
    optimum = oracle.solved(*oracle.random_start(1))
    assert optimum.status == "Solve_Succeeded"
    assert optimum.constraint_violation <= 1e-8
    assert optimum.ripple == pytest.approx(MEASURED[name]["ripple"], rel=AGREE)


@pytest.mark.slow
@pytest.mark.parametrize("name", MEASURED)
def test_measured_machine_converges_to_the_optimum_with_its_prices(name):
    problem = measured(name)
    optimum = Oracle(problem).solved()
    design, unmet = missed(problem, optimum)
    assert unmet == []
    assert design.ripple == pytest.approx(MEASURED[name]["ripple"], rel=AGREE)
    active = active_multipliers(design)
    assert active
    assert active == multipliers_of(optimum, active)
    own = active_prices(design, problem)  # without negligible ones
    assert own
    assert own == prices_of(problem, optimum, own)


def active_prices(design, problem):
    active = active_multipliers(design)
    records = prices(design, problem)
    return {
        each["limit"]: each["ripple_per_unit_Nm"] for each in records if each["limit"] in active
    }


def prices_of(problem, optimum, names):
    """Decrease of the ripple, N m, per unit of the drawing, by the Lagrange function of IPOPT."""
    ratings = problem.ratings
    before = max(float(np.std(item.torque)) for item in problem.scenarios if item.weight > 0)
    spent = {name: -slope * before for name, slope in optimum.slopes.items()}
    cubed = 3.0 * named(ratings).life_force_cubed / named(ratings).dynamic_rating
    expected = {
        "pressure_angle": spent["pressure_angle"] * np.pi / 180,  # deg
        "curvature_ratio": spent["curvature_ratio"],
        "jump_speed": spent["jump_speed"] * np.pi / 30,  # rpm
        "roller_static": spent["normal_force"] / named(ratings).force_safety,  # N of the rating
        "roller_speed": spent["roller_spin"] * np.pi / 30,
        "roller_life": spent["life_force_cubed"] * cubed,  # N of the rating
        "guide_pv_A": spent["guide_pv_a"] * 1e6,  # MPa m/s
        "spring_travel": spent["travel"] * 1e-3,  # mm
        "guide_wear_A": spent.get("guide_wear_pv_a", np.nan) * 1e6,
    }
    return approximately({name: expected[name] for name in names}, AGREE_PRICE)


@pytest.mark.slow
@pytest.mark.parametrize("name", MEASURED)
def test_measured_case_with_every_check_ends_at_the_optimum(name):
    problem = constrained(f"tests/data/{name}.toml")
    assert not problem.left_out
    optimum = Oracle(problem).solved()
    design, unmet = missed(problem, optimum)
    assert unmet == []
    active = active_multipliers(design)
    assert active
    assert active == multipliers_of(optimum, active)


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.0, SMOOTH])
def test_signed_machine_ends_at_the_optimum_with_its_prices(share):
    """At the reduction required, the jerk is least; with little weight on it, the ripple is.

    Seed 1: from the exact energy the program ends in a local optimum 0.6 % above.
    """
    problem = signed()
    assert not problem.left_out
    problem = replace(problem, jerk_weight=share * problem.jerk_weight)
    oracle = Oracle(problem)
    optimum = oracle.solved(*oracle.random_start(1))
    design, unmet = missed(problem, optimum)
    assert unmet == []
    active = active_multipliers(design)
    assert active
    assert active == multipliers_of(optimum, active)
    own = active_prices(design, problem)  # without negligible ones
    assert own
    assert own == prices_of(problem, optimum, own)


@pytest.mark.slow
@pytest.mark.parametrize("name", FREED)
def test_signed_machine_with_free_variables_ends_at_the_optimum(name):
    problem = signed()
    problem = replace(problem, freed=FREED[name], jerk_weight=SMOOTH * problem.jerk_weight)
    oracle = Oracle(problem)
    # with a free base radius the exact energy and seed 2 end in local optima 0.5 and 4 % above
    start = oracle.random_start(1) if name == "base radius" else ()
    optimum = oracle.solved(*start)
    design, unmet = missed(problem, optimum)
    assert unmet == []
    active = active_multipliers(design)
    assert active
    assert active == multipliers_of(optimum, active)


@pytest.mark.slow
@pytest.mark.parametrize("seed", FEASIBLE_VARIANTS)
def test_variant_ends_at_the_optimum(seed):
    problem = small(seed)
    oracle = Oracle(problem)
    # from the exact energy variant 4 ends in a local optimum 0.1 % above
    _, unmet = missed(problem, oracle.solved(*oracle.random_start(1)))
    assert unmet == []


EXCESS = {
    "bearing_lubrication": 3e-3, "concave_radius": 0.6, "contact_force_margin": 0.3,
    "contact_at_overspeed": 0.3, "contact_over_speed": 0.3, "elastic_contact": 0.3, "jump": 0.3,
    "jump_speed": 0.3,
}  # fmt: skip
"""Excess of the optimum over a limit that is tightened, where it is not `USUAL`."""
USUAL = 0.1
LOST = 400.0  # N, of an elastic stem or by the surge
LESSENED = {"elastic_contact": "elastic", "contact_over_speed": "swept_surge"}
FIXED = "guide_gap"  # at maximum lift it is that of the case, whatever the lift


@cache
def easily_bound(points=240, **shares):
    """Signed machine at its load cases, with all parts, on few angles, and its least ripple.

    With a curvature ratio at which its cam is hollow. shares: duty of its load cases.
    """
    problem = thinned(described(nominal(signed())), 24, points)
    problem = replace(problem, ratings=rated(problem.ratings, gas_slope=0.03, curvature_ratio=1.5))
    problem = of_duty(problem, **shares) if shares else problem
    problem = replace(
        problem,
        scenarios=requiring(problem.scenarios, 0.2),
        jerk_weight=2.5e-5 * problem.jerk_weight,
    )
    return problem, Oracle(problem).solved()


def isolated(problem, name):
    """The problem without what hides a limit behind another."""
    scenarios = problem.scenarios
    if name == "jam_index":
        scenarios = tuple(changed(item, friction_worst=None) for item in scenarios)
    if field := LESSENED.get(name):  # at the over-speed two others keep the same margin
        lessened = tuple(
            replace(item.correction, **{field: getattr(item.correction, field) - LOST})
            for item in scenarios
        )
        scenarios = tuple(
            replace(item, correction=each) for item, each in zip(scenarios, lessened, strict=True)
        )
    return replace(problem, scenarios=scenarios)


def tightened(limit, *about, **shares):
    """Problem with a limit that its optimum without it exceeds; the rest as of `easily_bound`."""
    problem, optimum = easily_bound(*about, **shares)
    problem = isolated(problem, limit.check)
    oracle, number = Oracle(problem), limit.needs.split()[0]
    value = oracle.numbers[number]

    def excess(log_factor):
        changed = oracle.numbers | {number: value * np.exp(log_factor)}
        use = oracle.utilisation(optimum.coefficients, optimum.free, changed)[limit.check]
        return use - 1.0 - EXCESS.get(limit.check, USUAL)

    assert excess(0.0) < 0.0
    steps = np.arange(1, 70) * 0.1
    factor = next(
        brentq(excess, side * (step - 0.1), side * step)
        for step in steps
        for side in (1, -1)
        if excess(side * step) > 0.0
    )
    return with_number(problem, number, value * np.exp(factor))


TIGHTENED = [
    pytest.param(limit, id=limit.check, marks=[pytest.mark.whole] if k % 3 else [])
    for k, limit in enumerate(each for each in LIMITS if each.check != FIXED)
]
"""Limits to be tightened: `make verify` tries every third, `make bench` the others."""


@pytest.mark.slow
@pytest.mark.parametrize("limit", TIGHTENED)
def test_a_tightened_limit_binds_at_the_optimum(limit):
    problem = tightened(limit)
    optimum = Oracle(problem).solved()
    design, unmet = missed(problem, optimum)
    assert unmet == []
    assert optimum.multipliers[limit.check] > BINDS
    assert design.utilisation[limit.check] == pytest.approx(1.0 - RESERVE, abs=2e-3)


DUTY = {"idle": 0.6, "governed": 0.4}
LIVES = [each for each in LIMITS if each.of == "life"]


@pytest.mark.slow
@pytest.mark.parametrize("limit", LIVES, ids=lambda limit: limit.check)
def test_life_by_the_duty_binds_at_the_optimum_with_its_price(limit):
    """Damage of both load cases in the sum, which neither alone reaches.

    The oracle keeps the pressure angle at the points alone, which takes 3 % off a price at 240.
    """
    problem = tightened(limit, 360, **DUTY)
    optimum = Oracle(problem).solved()
    design, unmet = missed(problem, optimum)
    assert unmet == []
    assert design.utilisation[limit.check] == pytest.approx(1.0 - RESERVE, abs=1e-5)
    active = active_multipliers(design)
    assert limit.check in active
    assert active == multipliers_of(optimum, active)
    for name, share in DUTY.items():
        alone = Search(of_duty(problem, **{name: share}))
        use = alone.state(design.coefficients, design.variables).utilisation[limit.check]
        assert use < 0.995, name


def violations(problem):
    """Excess of the limits over 1 less the reserve, the greatest of each: product's, oracle's."""
    oracle = Oracle(problem)
    near = oracle.solved()
    least = oracle.least_violation(near.coefficients, near.free)
    design, _, excess = judged(problem)
    assert design.converged
    assert design.steps <= STEPS_MAX
    assert not least.feasible
    assert not design.feasible
    return excess, least.violation


@pytest.mark.slow
@pytest.mark.parametrize("seed", INFEASIBLE_VARIANTS)
def test_variant_without_a_cam_ends_at_the_least_violation(seed):
    own, least = violations(small(seed))
    assert sum(least.values()) > 1e-3
    assert sum(own.values()) == pytest.approx(sum(least.values()), rel=AGREE_VIOLATION)


@pytest.mark.slow
def test_two_violated_limits_are_weighed_alike():
    """A life of the roller that no cam reaches, not even one without a lift, against the ripple."""
    problem = small(1)
    cubed = 0.02 * named(problem.ratings).life_force_cubed
    ratings = rated(problem.ratings, life_force_cubed=cubed)
    own, least = violations(replace(problem, ratings=ratings))
    assert sum(own.values()) == pytest.approx(sum(least.values()), rel=AGREE_VIOLATION)
    assert min(least[name] for name in ("roller_life", "torque_reduction")) > 0.1


NUMBERS = {
    "v08": ("pressure_angle", "jump_speed", "life_force_cubed", "roller_radius", "gear_ratio",
            "rate", "preload", "prime_radius", "mass_factor", "friction_factor", "spacing_factor",
            "overhang_factor"),
    "v10": ("jump_speed", "normal_force", "roller_spin", "guide_pv_a", "guide_area_a",
            "roller_radius", "rate", "preload", "prime_radius", "mass_factor", "friction_factor"),
}  # fmt: skip
STEP = 2e-4  # of the number


@pytest.mark.slow
@pytest.mark.parametrize("name", MEASURED)
def test_multipliers_are_differences_of_optima(name):
    """Slopes of the optimum by limits and machine, against central differences of new solutions.

    Within 1 %: the set of active angles changes within a step.
    """
    problem = thinned(measured(name), 36, 240)
    optimum = Oracle(problem).solved()
    values = Oracle(problem).numbers
    for number in NUMBERS[name]:
        ahead, behind = (
            Oracle(problem, **{number: values[number] * (1.0 + step)}).solved(after=optimum)
            for step in (STEP, -STEP)
        )
        difference = (ahead.objective - behind.objective) / (2.0 * STEP)
        slope = optimum.slopes[number] * values[number]
        assert abs(slope) > 1e-3, number
        assert slope == pytest.approx(difference, rel=AGREE_PRICE), number
