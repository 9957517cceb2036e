"""A case by the torque of its machine: cycles of any length, lobes, textbook values."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from stored_cams import CONSTRAINED, SMOOTHED, STORED, lifts, utilisations

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.engine.crankshaft import energy_swing
from camwright.pipeline.iteration import trials_of
from camwright.pipeline.smoothing.multistart import explored
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem

CASES = Path(__file__).parents[2] / "cases"
GX120 = (CASES / "gx120.toml").read_text(encoding="utf-8")
MACHINE = GX120[GX120.index("[mechanism]") :]
PRESS = """[torque]
kind = "press"
eccentric_radius = "30 mm"
rod_length = "200 mm"
force = "4 kN"
working_travel = "8 mm"
ram_mass = "20 kg"
"""


def case_of(torque: str, ratio: str = "1.0", folder: Path | None = None, **edits: str) -> Case:
    """The machine of the GX120 with another torque, unsmoothed."""
    text = f'schema_version = 1\nname = "other"\n{torque}\n{MACHINE}'
    text = text.replace("gear_ratio = 2.0", f"gear_ratio = {ratio}")
    text = text.replace('kind = "moving_average"', 'kind = "none"')
    for old, new in edits.items():
        assert old in text
        text = text.replace(old, new)
    return parse_case(text, folder)


def harmonics(mean: float, *waves: tuple[float, float, float]) -> str:
    """A torque table of a mean and (order, cosine, sine), N m."""
    rows = ", ".join(
        f'{{ order = {k}, cosine = "{a} N m", sine = "{b} N m" }}' for k, a, b in waves
    )
    return f'[torque]\nkind = "harmonics"\nmean = "{mean} N m"\nharmonics = [{rows}]\n'


def left_by(case: Case) -> tuple[float, float]:
    """Ripple (std, N m) of the shaft torque without the cam and with its spring force alone."""
    torque = next(iter(engine_torques(case).values()))
    lift = cam_lift(case, engine_torques(case))
    theta = uniform_turn(torque.theta.size)
    on_cam = (case.spring.preload + case.spring.rate * lift(theta)) * lift(theta, 1)
    after = torque.without_mean().total - on_cam / case.mechanism.gear_ratio
    return torque.std, float(after.std())


# Khurmi, Theory of Machines, ex. 16.11 to 16.13; strokes with k = 200 N/mm and P = 2 kN from
# the energy swing in closed form: s = (sqrt(P^2 + 2 k E) - P) / k.
@pytest.mark.parametrize(
    ("torque", "swing", "stroke"),
    [
        (harmonics(20000, (2, -5700, 9500)), 11078.81, 322.999),
        (harmonics(0, (2, 0, 600), (1, 0, -500)), 1204.167, 100.189),
        (harmonics(5000, (3, 0, 1500)), 1000.000, 90.499),
    ],
)
def test_lift_of_a_textbook_torque(torque: str, swing: float, stroke: float) -> None:
    case = case_of(torque)
    spring = case.spring
    stiff = case.model_copy(
        update={"spring": type(spring)(rate=200e3, preload=2e3, travel_max=0.5)}
    )
    torques = engine_torques(stiff)
    whole = next(iter(torques.values()))
    assert np.ptp(energy_swing(whole.total, whole.span)) == pytest.approx(swing, rel=1e-4)
    # The spline of 720 samples finds the extremes between them: as many digits as are printed.
    assert 1e3 * cam_lift(stiff, torques).stroke == pytest.approx(stroke, abs=6e-4)


def test_one_press_leaves_one_ripple_however_it_is_stated(tmp_path: Path) -> None:
    """As 360 deg at ratio 1, at ratio 2, and twice over as a table of 720 deg at ratio 2."""
    once, twice = case_of(PRESS), case_of(PRESS, '"2:1"')
    assert (once.period.cycles, twice.period.cycles) == (1, 2)
    torque = next(iter(engine_torques(once).values()))
    rows = [f"{0.5 * k},{value!r}" for k, value in enumerate(np.tile(torque.total, 2).tolist())]
    (tmp_path / "press.csv").write_text("shaft_angle_deg,torque_Nm\n" + "\n".join(rows))
    table = '[torque]\nkind = "table"\ncycle = "720 deg"\nfile = "press.csv"\n'
    stated = case_of(table, "2.0", tmp_path)
    assert stated.period.cycles == 1
    before, after = zip(*(left_by(each) for each in (once, twice, stated)), strict=True)
    assert before[1:] == pytest.approx((before[0],) * 2, rel=1e-9)
    # 1e-9 of the torque: of the interpolation between its samples.
    np.testing.assert_allclose(after, after[0], rtol=0.0, atol=1e-9 * before[0])


@pytest.mark.parametrize("lobes", [2, 3, 5])
def test_lobes_repeat_to_round_off(lobes: int) -> None:
    case = case_of(PRESS, f"{lobes}.0")
    lift = cam_lift(case, engine_torques(case))
    theta = uniform_turn(720)[: 720 // lobes]
    turn = 2.0 * np.pi / lobes
    for k in range(1, lobes):
        np.testing.assert_allclose(
            lift(theta + k * turn), lift(theta), rtol=0.0, atol=1e-13 * lift.stroke * 720
        )


PUMP = (Path(__file__).parents[2] / "cases" / "machines" / "dosing-pump.toml").read_text("utf-8")


def synthesis(lobes: int) -> tuple[Problem, Design]:
    """Of the dosing pump without tolerance corners, on few splines."""
    text = PUMP.replace("gear_ratio = 1.0", f"gear_ratio = {lobes}.0")
    text = text.replace("corners = true ", "corners = false\ncoefficients = 48 ")
    text = text.replace("torque_reduction = 0.5", "torque_reduction = 0.05")
    case = parse_case(text)
    problem = problem_of(case, engine_torques(case))
    return problem, explored(problem, 1).design


@pytest.mark.parametrize("lobes", [2, 3, 7])
def test_synthesised_lobes_repeat_to_round_off(lobes: int) -> None:
    """The splines of a lobe are the unknowns; at 7 lobes 720 angles are not a whole number each."""
    problem, design = synthesis(lobes)
    assert (problem.lobes, problem.points % lobes, design.feasible) == (lobes, 0, True)
    lift = design.lift(240 * lobes)
    each = lift(uniform_turn(240 * lobes)).reshape(lobes, -1)
    np.testing.assert_allclose(each, each[[0] * lobes], rtol=0.0, atol=1e-13 * lift.stroke)


def test_lobes_of_one_spline_are_the_optimum_of_all() -> None:
    """Against a synthesis that leaves each lobe its own splines, started elsewhere."""
    problem, design = synthesis(2)
    free = replace(problem, lobes=1, coefficients=2 * problem.coefficients)
    assert explored(free, 1).design.ripple == pytest.approx(design.ripple, rel=1e-4)


def test_a_smoother_acts_on_the_cycle_at_any_number_of_lobes() -> None:
    smooth = {'kind = "none"': 'kind = "harmonic"\nharmonics = 8.0'}
    one, three = case_of(PRESS, "1.0", **smooth), case_of(PRESS, "3.0", **smooth)
    lifts = [cam_lift(case, engine_torques(case)) for case in (one, three)]
    theta = uniform_turn(90)
    # The transfer factor of each harmonic is the same; splines through as many samples a lobe.
    np.testing.assert_allclose(
        lifts[1](theta / 3.0), lifts[0](theta), rtol=0.0, atol=1e-9 * lifts[0].stroke
    )


def test_an_engine_and_a_load_share_a_shaft() -> None:
    """The cycle is that of the engine, in which the load repeats twice."""
    engine = GX120[GX120.index("[engine]") : GX120.index("[mechanism]")]
    engine = engine[: engine.index("[crankshaft]")] if "[crankshaft]" in engine else engine
    load = harmonics(0, (1, 0, 5.0)).replace(
        'kind = "harmonics"', 'kind = "harmonics"\nrole = "load"'
    )
    both, alone = case_of(engine + load, "2.0"), case_of(engine, "2.0")
    assert both.period == alone.period
    (sum_of,), (own,) = (tuple(engine_torques(case).values()) for case in (both, alone))
    theta = own.theta
    np.testing.assert_allclose(
        sum_of.resampled(720).total, own.total - 5.0 * np.sin(theta), rtol=0.0, atol=1e-9
    )


@pytest.mark.parametrize(
    ("torque", "ratio", "words"),
    [
        (PRESS, "1.5", "mechanism.gear_ratio = 3:2, must be 1 or 2: a cam turn holds a whole"),
        (PRESS, '"1:2"', "mechanism.gear_ratio = 1:2, must be 1 or 2: a cam turn"),
        (PRESS, '"0:2"', "mechanism.gear_ratio"),
        (PRESS, '"2"', "not in quotes"),
        (PRESS + 'marks = [{ angle = "400 deg", name = "up" }]', "1.0", "torque.marks.angle"),
        (PRESS + '[lift]\nkind = "eccentric"\neccentricity = "3 mm"', "1.0", "exactly one of"),
        (PRESS.replace('"press"', '"pressing"'), "1.0", "torque.kind = pressing, must be"),
        (PRESS.replace("kind", "kinds"), "1.0", "must be a table with kind"),
        (PRESS.replace('"8 mm"', '"80 mm"'), "1.0", "torque.working_travel = 80 mm, must be <= 60"),
    ],
)
def test_a_refusal_has_one_clear_line(torque: str, ratio: str, words: str) -> None:
    with pytest.raises(InputError) as refusal:
        case_of(torque, ratio)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_torque_needs_its_ratio() -> None:
    with pytest.raises(InputError, match=r"gear_ratio = missing, must be given with \[torque\]: 1"):
        parse_case(f'schema_version = 1\nname = "o"\n{PRESS}{MACHINE}'.replace("gear_ratio", "#"))


def test_too_few_positions_a_lobe_are_refused() -> None:
    with pytest.raises(InputError, match=r"solver.positions = 72, must be >= 108, 36 per cycle"):
        case_of(PRESS, "3.0", **{"positions = 720": "positions = 72"})


@pytest.mark.parametrize("name", [*SMOOTHED, *CONSTRAINED])
def test_four_stroke_cases_are_those_of_the_time_when_a_cycle_had_720_degrees(name):
    """Bitwise equal where they were stored; another processor may round differently."""
    stored = json.loads(STORED.read_text(encoding="utf-8"))[name]
    figures = lifts(name) if name in SMOOTHED else utilisations(name)
    assert figures.keys() == stored.keys()
    for key, value in figures.items():
        np.testing.assert_allclose(value, stored[key], rtol=1e-11, atol=1e-12, err_msg=key)


@pytest.mark.slow
def test_a_cam_that_keeps_its_limits_does_not_depend_on_the_margin():
    """Without a conflict, and without a failed check, the margin of the corrections has no use."""
    case = read_case(CASES / "gx120-redesign.toml").with_positions(72)
    case = with_values(case, {"smoothing.coefficients": 48, "smoothing.starts": 1})
    finals = [
        trials_of(own, engine_torques(own), tier=Tier.CYCLE).final
        for own in (with_values(case, {"smoothing.correction_margin": m}) for m in (0.0, 0.03))
    ]
    lifts_of = [final.contour.pitch.lift.values for final in finals]
    np.testing.assert_array_equal(*lifts_of)
    assert finals[0].checks == finals[1].checks
