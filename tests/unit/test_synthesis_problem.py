"""From a case to the synthesis it asks for: load cases, corners, what is freed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthesis_scenarios import figures

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.constrained_synthesis import started
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import coarsened
from camwright.pipeline.smoothing.trust_region import descended

DATA = Path(__file__).parents[1] / "data"


def section(given, **changes):
    """A section of a case with other values."""
    return given.model_copy(update=changes)


@pytest.fixture(scope="module")
def case():
    return read_case(DATA / "soft_spring.toml")


@pytest.fixture(scope="module")
def torques(case):
    return engine_torques(case)


def test_every_load_case_is_a_scenario(case, torques):
    idle, over, still, most = problem_of(case, torques).scenarios
    assert (idle.name, over.name) == ("idle", "overspeed")
    assert (still.name, most.name) == ("standstill", "over-speed")
    assert (idle.weight, over.weight, still.weight, most.weight) == (1.0, 0.0, 0.0, 0.0)
    assert figures(over).cam_speed == pytest.approx(3600 * np.pi / 30 / 2)
    assert abs(idle.torque.mean()) < 1e-12 and idle.torque.size == 720


def test_weight_and_required_reduction_of_a_load_case_are_apart(case, torques):
    idle, over = case.load_cases
    problem = problem_of(case, torques)
    required = [item.torque_reduction for item in problem.scenarios]
    assert required == [0.5, None, None, None]
    assert problem.ceiling == pytest.approx(0.5, rel=2e-3)
    states = (
        section(idle, torque_reduction=0.0),
        section(over, ripple_weight=0.5, torque_reduction=0.1),
    )
    own = problem_of(section(case, load_cases=states), torques)
    weights = [(item.weight, item.torque_reduction) for item in own.scenarios]
    assert weights == [(1.0, None), (0.5, 0.1), (0.0, None), (0.0, None)]
    assert own.ceiling == own.ceiling_of(own.scenarios[1]) == pytest.approx(0.9, rel=2e-3)
    assert own.ceiling_of(own.scenarios[0]) is None
    left_out = replace(own, left_out=frozenset({"torque_reduction"}))
    assert left_out.ceiling_of(own.scenarios[1]) is None and left_out.ceiling is None


def test_damage_of_the_roller_adds_over_the_load_cases_of_the_duty(case, torques):
    idle, over = case.load_cases

    def used(*duty):
        """Cube of the utilisations of the rating life, and the scenarios that count in each."""
        shares = zip((idle, over), duty, strict=True)
        states = tuple(section(each, duty=share) for each, share in shares)
        problem = problem_of(section(case, load_cases=states), torques)
        search = Search(problem)
        state = search.state(search.exact, problem.variables)
        return state.means["roller_life"] ** 3, state.members["roller_life"].tolist()

    whole, each_alone = used(None, None)
    assert np.all(whole[:2] > 0.0)
    assert each_alone == np.eye(4, dtype=bool).tolist()
    both, together = used(0.3, 0.7)
    assert both == pytest.approx([0.3 * whole[0] + 0.7 * whole[1]], rel=1e-12)
    assert together == [[True, True, False, False]]
    one, without = used(1.0, 0.0)
    assert one == pytest.approx(whole[:1], rel=1e-12)
    assert without == [[True, False, False, False]]


def test_damage_adds_at_each_corner_by_itself(case, torques):
    idle, over = case.load_cases
    wide = section(
        case,
        load_cases=(section(idle, duty=0.5), section(over, duty=0.5)),
        spring=replace(case.spring, rate_tolerance=0.05, preload_tolerance=0.1),
        smoothing=section(case.smoothing, corners=True),
    )
    problem = problem_of(wide, torques)
    names = [item.name.partition(", ") for item in problem.scenarios]
    search = Search(problem)
    for members in search.state(search.exact, problem.variables).members["roller_life"]:
        (first, *_, corner), (second, *_, same) = (names[k] for k in np.flatnonzero(members))
        assert (first, second, same) == ("idle", "overspeed", corner)


def test_corners_are_all_of_spring_and_friction_and_each_of_mass_and_phase(case, torques):
    wide = section(
        case,
        spring=replace(case.spring, rate_tolerance=0.05, preload_tolerance=0.1),
        guides=replace(
            case.guides,
            a=replace(case.guides.a, friction=0.1, friction_min=0.05, friction_max=0.15),
            b=replace(case.guides.b, friction=0.1, friction_min=None, friction_max=None),
        ),
        tolerances=section(case.tolerances, friction=0.2, mass=0.1, phase=np.radians(4.0)),
        smoothing=section(case.smoothing, corners=True),
    )
    found = [item for item in problem_of(wide, torques).scenarios if item.name.startswith("idle")]
    nominal, corners = found[0], found[1:]
    assert len(corners) == 8 + 2 + 2
    assert {item.weight for item in corners} == {nominal.weight}
    ends = {(figures(item).friction_a, figures(item).friction_b) for item in corners[:8]}
    assert sorted(ends) == [(0.05, pytest.approx(0.08)), (0.15, pytest.approx(0.12))]
    assert {item.rate_factor for item in corners[:8]} == {0.95, 1.05}
    assert {item.preload_factor for item in corners[:8]} == {0.9, 1.1}
    shares = [figures(item).mass / figures(nominal).mass for item in corners[8:10]]
    assert shares == pytest.approx([0.9, 1.1])
    # 4 deg of crank are 2 deg of cam: 4 of 720 points
    late, early = corners[10:]
    np.testing.assert_allclose(late.torque, np.roll(nominal.torque, 4), atol=1e-9)
    np.testing.assert_allclose(early.torque, np.roll(nominal.torque, -4), atol=1e-9)


def test_preload_of_a_load_case_is_that_of_its_scenario(case, torques):
    idle, over = case.load_cases
    own = section(case, load_cases=(idle, section(over, preload=300.0)))
    problem = problem_of(own, torques)
    assert problem.scenarios[0].preload_factor == 1.0
    found = problem.scenarios[1].preload_factor * problem.variables.preload
    assert found == pytest.approx(300.0)


def test_preload_is_not_freed_where_a_load_case_has_its_own(case, torques):
    idle, over = case.load_cases
    own = section(
        case,
        load_cases=(idle, section(over, preload=300.0)),
        smoothing=section(case.smoothing, free=("preload",), preload_range=(200.0, 400.0)),
    )
    with pytest.raises(InputError, match=r"smoothing\.free = preload"):
        problem_of(own, torques)


def test_ripple_counts_at_the_ends_of_a_range_of_speed_and_load(case, torques):
    smoothing = section(case.smoothing, robust_weight=0.5, robust_speed=0.2, robust_load=0.1)
    plain = problem_of(case, torques).scenarios
    scenarios = problem_of(section(case, smoothing=smoothing), torques).scenarios
    assert [item.name for item in scenarios[: len(plain)]] == [item.name for item in plain]
    idle, ends = scenarios[0], scenarios[len(plain) :]
    speeds = [figures(item).cam_speed / figures(idle).cam_speed for item in ends]
    assert speeds == pytest.approx([0.8, 0.8, 1.2, 1.2])
    assert {(item.weight, item.torque_reduction) for item in ends} == {(0.5, None)}
    # more air, more gas torque; the inertia torque grows with the speed
    greatest = [np.ptp(item.torque) for item in ends]
    assert greatest[0] < greatest[1] and greatest[2] < greatest[3]
    assert ends[0].name == "idle, n x 0.8, load x 0.9"
    still = section(smoothing, robust_speed=0.0, robust_load=0.0)
    same = problem_of(section(case, smoothing=still), torques).scenarios[len(plain) :]
    for item in same:
        np.testing.assert_allclose(item.torque, idle.torque, rtol=0, atol=1e-9)
    over = section(case.limits, overspeed=1.1 * case.load_cases[0].speed)
    kept = section(case, smoothing=smoothing, limits=over, load_cases=case.load_cases[:1])
    fastest = problem_of(kept, torques).scenarios[-1]
    assert figures(fastest).cam_speed == pytest.approx(1.1 * figures(idle).cam_speed)


def test_load_of_a_measured_torque_scales_it(tmp_path):
    (tmp_path / "torque.csv").write_text(
        "crank_angle_deg,torque_Nm\n"
        + "".join(f"{k},{8.0 * np.sin(np.radians(k)):.9f}\n" for k in range(720))
    )
    text = (DATA / "soft_spring.toml").read_text()
    case = parse_case(
        text.replace('name = "idle"\n', 'name = "idle"\ntorque = "torque.csv"\n'), tmp_path
    )
    smoothing = section(case.smoothing, robust_weight=1.0, robust_load=0.25)
    measured = section(case, smoothing=smoothing, load_cases=case.load_cases[:1])
    torques = engine_torques(measured)
    scenarios = problem_of(measured, torques).scenarios
    ends = [item for item in scenarios if ", n x" in item.name]
    sizes = [np.ptp(item.torque) / np.ptp(scenarios[0].torque) for item in ends]
    assert sizes == pytest.approx([0.75, 1.25, 0.75, 1.25])


def test_what_is_freed_has_its_range(case, torques):
    smoothing = section(
        case.smoothing, free=("spring_rate", "phase"), spring_rate_range=(2e4, 3e4),
        phase_range=(-0.1, 0.2),
    )  # fmt: skip
    problem = problem_of(section(case, smoothing=smoothing), torques)
    assert problem.freed == {"rate": (2e4, 3e4), "phase": (-0.1, 0.2)}
    assert problem.energy == (0.0, 0.0)  # the initial energy is not among them


def test_a_lift_that_is_given_has_nothing_to_lower(case):
    with pytest.raises(InputError, match=r"smoothing\.kind"):
        problem_of(case, {})


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (
            "harmonic_orders = [0.75]",
            r"harmonic_orders = 0\.75, must be a multiple of 0\.5: whole waves",
        ),
        ("harmonic_weight = 1.0", r"harmonic_orders = missing, must be given"),
        ("harmonic_orders = [0.0]", r"harmonic_orders\[0\] = 0\.0, must be >= 0\.5 and <= 180"),
        ("loss_weight = -1", r"loss_weight = -1, must be >= 0"),
        ("robust_load = 1.0", r"robust_load = 1\.0, must be >= 0 and < 1"),
        ("robust_weight = nan", r"robust_weight = nan"),
    ],
)
def test_a_weight_that_cannot_be_is_refused(lines, words):
    text = (DATA / "soft_spring.toml").read_text()
    with pytest.raises(InputError, match=rf"smoothing\.{words}"):
        parse_case(text.replace("[smoothing]\n", f"[smoothing]\n{lines}\n"))


def test_an_objective_without_a_term_is_refused(case, torques):
    smoothing = section(case.smoothing, torque_weight=0.0, loss_weight=0.0)
    with pytest.raises(InputError, match=r"smoothing\.torque_weight = 0,"):
        problem_of(section(case, smoothing=smoothing), torques)


def test_a_search_ends_within_the_limits_where_four_steps_gain_little(case, torques):
    """One that converges is not ended; with no gain worth it the ripple is above the least."""
    every = problem_of(replaced(case, {"cam.offset": 4e-3}), torques)
    problem = replace(coarsened(every), left_out=frozenset({"torque_reduction"}))
    least, same, early = (
        descended(started(problem), 1.0, worth=worth) for worth in (0.0, 1e-3, 10.0)
    )
    assert same.state.ripple == least.state.ripple
    assert early.gain == 10.0
    assert early.state.violation < 1e-6
    assert least.state.ripple < early.state.ripple < 1.001 * least.state.ripple
