"""With the corrections of a solved cycle the cam of a scenario is the solved cam, field by field.

Both evaluate the measures of the checks: what agrees here agrees in every check and constraint that
reads it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from clamped_case import read_clamped
from test_part_constraints_agree import random_cam

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.extremes import worst_measure
from camwright.pipeline.checks.guide_strength import GUIDES, hottest
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import BETWEEN
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.cycle.solved_cam import SolvedCam
from camwright.pipeline.smoothing.allowables import (
    corrected_ratings,
    ratings_of,
    softening,
    weights_of,
)
from camwright.pipeline.smoothing.cam_state import ScenarioCam, loaded
from camwright.pipeline.smoothing.constraints import LOADS
from camwright.pipeline.smoothing.fe_correction import corrections_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import DesignVariables

CASES = Path(__file__).parents[2] / "cases"
POSITIONS = 120
CORRECTED = 0.051
"""Least load of a point support over its greatest at which its correction says anything."""
GUIDED = 1.1e-6
"""The same of the push in a guide."""
LOADED = 0.1
"""Least measure over its greatest that is compared: it follows from such loads."""
FIELDS: dict[str, Callable[[LoadedCam], Array]] = {
    "lift": lambda cam: cam.jet.lift,
    "slope": lambda cam: cam.slope,
    "velocity": lambda cam: cam.velocity,
    "spin": lambda cam: cam.spin,
    "spring_force": lambda cam: cam.spring_force,
    "least_spring": lambda cam: np.atleast_1d(cam.least_spring),
    "closing": lambda cam: cam.closing,
    "inertia": lambda cam: cam.inertia,
    "inertia_at": lambda cam: cam.inertia_at(cam.numbers["cam.speed"]),
    "viscous": lambda cam: cam.viscous,
    "required": lambda cam: cam.required,
    "jam": lambda cam: cam.jam,
    "jam_worst": lambda cam: cam.jam_worst,
    "share": lambda cam: cam.share,
    "axial": lambda cam: cam.axial,
    "normal": lambda cam: cam.normal,
    "surged": lambda cam: np.maximum(cam.surged, 0.0),
    "torque": lambda cam: cam.torque,
    "rubbing_a": lambda cam: np.abs(cam.rubbing.a),
    "rubbing_b": lambda cam: np.abs(cam.rubbing.b),
    "bearing_a": lambda cam: np.abs(cam.bearing.a),
    "bearing_b": lambda cam: np.abs(cam.bearing.b),
    "heat_a": lambda cam: cam.heat.a,
    "heat_b": lambda cam: cam.heat.b,
    "p0": lambda cam: cam.p0,
    "contour_radius": lambda cam: cam.motion.contour_radius,
    "sharpness": lambda cam: cam.motion.sharpness,
    "side": lambda cam: cam.motion.side,
    "sliding": lambda cam: np.atleast_1d(cam.motion.sliding),
    "moment": lambda cam: cam.follower_moment,
}
OF_GUIDES = ("jam", "jam_worst", *(f"{name}_{side}" for name in ("rubbing", "bearing", "heat")
                                   for side in "ab"))  # fmt: skip
"""Fields that an arm does not have."""
WORDS = {"roller": "roller", "face": "face", "arm": "roller"}
"""Bodies in contact, by the follower of a case."""
MEASURES = {
    f"{one.id}, {follower}": (follower, one.measure)
    for one in CHECKS
    if one.measured is not None and one.measured.reduce not in ("case", "contour", "top")
    for follower, word in WORDS.items()
    if one.needs in ("", word) and not one.scales_with and one.closed_by in ("", "force", "plate")
    if not (one.part == "guides" and follower == "arm")
    if not (one.part == "pivot" and follower != "arm")
    if not one.id.startswith(("guide_pressure", "edge_pressure"))
}
"""Of a load case; the limit at the temperature of a guide is in the correction of its pressure,
and the ends of the contact and the moment of its tilt are in the bounds of theirs."""


def contour_of(case: Case) -> Contour:
    drawn = random_cam(read_case(CASES / "gx120-redesign.toml"), 0)
    if case.follower.arm is not None:
        return case.contour(drawn.lift)
    if case.follower.face is None:
        return drawn
    return FlatFaceContour(FacePath(drawn.lift, case.cam.prime_radius, case.cam.offset))


def pairs_of(solved: Solution) -> Iterator[tuple[SolvedCam, ScenarioCam]]:
    case, lift = solved.case, solved.contour.lift
    problem, theta = problem_of(case, engine_torques(case)), uniform_turn(POSITIONS)
    fix, jet = corrections_of(solved), lift.jet(theta, 3)
    variables = DesignVariables(case.spring.rate, case.spring.preload, case.cam.prime_radius)
    for cycle, scenario in zip(solved.cycles, problem.scenarios, strict=True):
        assert cycle.load_case == scenario.name
        own = replace(scenario, correction=fix[scenario.name].at(theta))
        cam = loaded(jet, lift.highest.value, variables, problem.ratings, own)
        yield solved.cams[cycle], cam


@pytest.fixture(scope="module")
def solved() -> dict[str, Solution]:
    cases = {"roller": "gx120-redesign", "face": "gx120-flat-face", "arm": "gx120-arm"}
    states = {}
    for follower, name in cases.items():
        case = read_clamped(CASES / f"{name}.toml")
        smoothing = case.smoothing.model_copy(update={"corners": False})
        case = case.model_copy(update={"smoothing": smoothing})
        states[follower] = solution(
            case, contour_of(case), Tier.PREVIEW, torques=engine_torques(case), positions=POSITIONS
        )
    return states


@pytest.fixture(scope="module")
def both(solved: dict[str, Solution]) -> dict[str, list[tuple[SolvedCam, ScenarioCam]]]:
    return {follower: list(pairs_of(each)) for follower, each in solved.items()}


@pytest.mark.parametrize("follower", WORDS)
@pytest.mark.parametrize("name", FIELDS)
def test_a_field_of_the_scenario_is_that_of_the_solved_cam(solved, both, name, follower) -> None:
    if name == "spin" and follower == "face":
        pytest.skip("a face does not roll")
    if name in OF_GUIDES and follower == "arm":
        pytest.skip("an arm has no guides")
    for known, scenario in both[follower]:
        expected, own = np.broadcast_arrays(FIELDS[name](known), FIELDS[name](scenario))
        compared = np.ones(expected.shape, dtype=bool)
        if name in ("jam_worst", "heat_a", "heat_b"):
            statics = known.cycle.parts.friction.greatest.jam_index_statics
            compared = statics > CORRECTED * statics.max()
        if name.startswith("bearing"):
            place = "ab".index(name[-1])
            guide = known.cycle.machine.guides.both[place][1]
            hot = hottest(solved[follower], GUIDES[place]).value
            own = own * softening(known.cycle.machine, guide, hot)[0]
            whole = np.abs(scenario.axial * scenario.reactions[place].whole)
            compared = whole > GUIDED * whole.max()
        assert np.any(expected != 0.0) or name in ("viscous", "sliding")
        off = np.abs(own - expected)[compared].max()
        assert off <= 1e-8 * np.abs(expected).max(), known.cycle.load_case


@pytest.mark.parametrize("name", MEASURES)
def test_a_measure_of_the_scenario_is_that_of_the_solved_cam(both, name) -> None:
    follower, measure = MEASURES[name]
    for known, scenario in both[follower]:
        expected, own = np.broadcast_arrays(measure(known), measure(scenario))
        counts = np.abs(expected) > LOADED * np.abs(expected).max()
        off = np.abs(own - expected)[counts].max(initial=0.0)  # zero at rest
        assert off <= 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("one", [
    pytest.param(one, id=one.id) for one in CHECKS
    if one.measured is not None and one.measured.reduce == "forces"
])  # fmt: skip
def test_a_measure_between_the_solved_angles_is_the_solved_one_at_them(solved, one) -> None:
    """It reads the forces alone: guides and contact between the solved angles are not known."""
    for state in solved.values():
        for cycle in state.cycles:
            between = one.measure(state.cams_between[cycle])[::BETWEEN]
            np.testing.assert_allclose(between, one.measure(state.cams[cycle]), rtol=1e-9)


def by_duty(state: Solution, shares: tuple[float, ...]) -> Solution:
    """The solution with a share of the operating time of each load case."""
    cycles = tuple(
        replace(each, turn=replace(each.turn, machine=replace(each.turn.machine, duty=share)))
        for each, share in zip(state.cycles, shares, strict=True)
    )
    return replace(state, cycles=cycles, machines=tuple(each.machine for each in cycles))


def power(cam: LoadedCam) -> Array:
    return magnitude(cam.normal * cam.velocity)


def test_a_measure_is_reduced_over_turn_and_load_cases_as_its_word_says(solved) -> None:
    shares = (0.3, 0.7, 0.0, 0.0)
    state = by_duty(solved["roller"], shares)
    turns = {each.load_case: np.abs(each.loads.normal_force * each.loads.velocity)
             for each in state.cycles}  # fmt: skip
    means = np.array([each.mean() for each in turns.values()])
    sampled = [each.max() for each in turns.values()]
    expected = {
        "angles": (2.0 * np.max(sampled), list(turns)[int(np.argmax(sampled))]),
        "mean": (2.0 * means.max(), list(turns)[int(np.argmax(means))]),
        "wear": (2.0 * np.dot(shares, means), list(turns)[int(np.argmax(shares * means))]),
        "life": (1.0 / np.dot(shares, 1.0 / (2.0 * means)), None),
    }
    for reduce, (value, load_case) in expected.items():
        worst = worst_measure(
            state, power, reduce, lambda each: 2.0 * each, at_least=False, order=2
        )
        assert worst.value == pytest.approx(value, rel=1e-12), reduce
        assert load_case in (None, worst.load_case), reduce
        assert 0.0 < worst.error_share < 0.1
    peak = worst_measure(state, power, "forces", float, at_least=False, order=2).value
    assert np.max(sampled) < peak < 1.01 * np.max(sampled)
    least = worst_measure(state, power, "mean", float, at_least=True, order=2)
    assert least.value == pytest.approx(means.min(), rel=1e-12)


@pytest.mark.parametrize("follower", WORDS)
@pytest.mark.parametrize("group", [demands.NORMAL_FORCE, demands.PRESSURE])
def test_a_weighted_limit_is_used_as_the_checks_along_the_turn(solved, both, group, follower):
    """Fatigue and edges of arm and contact, each at its own angles: the greatest of all checks."""
    state = solved[follower]
    # wide, so that the checks of the group, not the limit itself, make the weight
    wide = corrected_ratings(ratings_of(state.case), state).times(group, 1e4)
    along = [one for one in CHECKS if one.along and one.scales_with[:1] == (group,)]
    uses = {one.id: made.utilisation for one in along if (made := one(state)) is not None}
    if not uses:
        pytest.skip("no check of this follower is kept along the turn")
    weights = weights_of(state, wide)
    assert weights.by[group] == max(uses, key=uses.__getitem__)
    kept = next(each for each in LOADS if each.key == group and each.value(wide) is not None)
    names = {demands.NORMAL_FORCE: "force_weight", demands.PRESSURE: "pressure_weight"}
    most = 0.0
    for _, cam in both[follower]:
        values = {names[group]: weights.values[group][cam.scenario.name]}
        correction = replace(cam.scenario.correction, **values)
        weighted = replace(cam, scenario=replace(cam.scenario, correction=correction))
        use = kept.utilisation(weighted, wide.bounds[group])
        if group == demands.PRESSURE:  # sharpness + (1 - sharpness) u^2
            use = np.sqrt((use - cam.motion.sharpness) / (1.0 - cam.motion.sharpness))
        most = max(most, float(np.max(use)))
    assert most == pytest.approx(max(uses.values()), rel=1e-9)
