"""The feedback: gentler while it helps, never at the price of the torque, always an end."""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from made_check import made_check

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import verdict
from camwright.pipeline.checks.check import Check
from camwright.pipeline.run import restated
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.smoothing_feedback import Next, Stop, best_attempt, next_smoother
from camwright.pipeline.smoothing.smoothing_forecast import Attempt, keeps_torque, score

Model = Callable[[float], tuple[Check, ...]]
BOUND = 6


def check(name: str, utilisation: float, lift: bool = True, **more) -> Check:
    return made_check(name, utilisation, 1.0, must_have=True, lift_can_help=lift, **more)


def torque(reduction: float) -> Check:
    return made_check("torque_reduction", reduction, 0.4, sense="at_least")


def drive(model: Model, max_trials: int = BOUND, forecast: Model | None = None, kind="gaussian"):
    """Run whole trials until the feedback ends; the attempts, the reasons, the end.

    Without a forecast of its own the model forecasts itself.
    """
    ahead = forecast or model
    smoother, attempts, whys = Smoother(kind), [], []
    while True:
        attempts.append(Attempt(smoother, model(smoother.strength)))
        step = next_smoother(
            attempts, max_trials, lambda wider: [ahead(each.strength) for each in wider]
        )
        if isinstance(step, Stop):
            return attempts, whys, step
        assert len(attempts) < max_trials
        whys.append(step)
        smoother = step.smoother


def never(smoothers: Sequence[Smoother]) -> list[tuple[Check, ...]]:
    """Forecast of smoothers that lead to no cam."""
    return [() for _ in smoothers]


def strengths(attempts) -> list[float]:
    return [attempt.smoother.strength for attempt in attempts]


def passes_at_once(_s: float):
    return torque(0.7), check("pressure_angle", 0.9)


def passes_at_half_again(s: float):
    return torque(0.9 - 0.25 * s), check("pressure_angle", 1.45 / s)


def cannot_pass(s: float):
    """As the published engine: torque lost beyond 2.1, angle met at 2, roller never."""
    return (
        torque(0.77 - 0.37 * (s - 1.0) / 1.1),
        check("pressure_angle", 1.4 / (1.0 + 0.4 * (s - 1.0))),
        check("roller_static", 2.9 - 0.12 * s),
        check("mesh", 0.3, lift=False),
    )


def test_passes_at_once():
    attempts, _, stop = drive(passes_at_once)
    assert len(attempts) == 1
    assert stop.binding == ()
    assert stop.best == 1
    assert "trial 1 passes" in stop.reason


def test_passes_after_some_trials_and_torque_is_kept():
    model = passes_at_half_again
    attempts, whys, stop = drive(model)
    assert stop.binding == ()
    assert verdict(attempts[-1].checks) == "pass"
    assert 2 <= len(attempts) <= 3
    assert "pressure_angle at 145 %" in whys[0].why


def test_the_gentlest_change_foreseen_to_pass_is_taken():
    attempts, _, _ = drive(passes_at_half_again)
    # 1.45 passes; a margin of half a percent and the fine sweep (1.2^(1/10)) lie above it.
    assert strengths(attempts) == [1.0, pytest.approx(1.45 * 1.005, rel=0.02)]
    # Half a percent of the limit is kept in hand, the prediction being what it is.
    assert attempts[-1].checks[1].utilisation <= 0.995 + 1e-12


def test_cannot_pass_ends_on_the_strongest_smoothing_that_keeps_the_torque():
    attempts, _, stop = drive(cannot_pass)
    assert stop.binding == ("roller_static",)
    assert len(attempts) <= 3
    assert stop.best == len(attempts)
    last = attempts[-1]
    assert keeps_torque(last.checks)
    # The torque is lost at 2.1; the stated tolerance is 2 %.
    assert 2.1 / 1.03 <= last.smoother.strength <= 2.1
    assert "no smoother that keeps torque_reduction passes" in stop.reason
    assert "roller_static at 278 % at trial 1, 265 % of its limit now" in stop.reason


def test_torque_lost_at_trial_one_ends_at_once():
    def model(s):
        return torque(0.39 / s), check("pressure_angle", 1.4 / s)

    attempts, _, stop = drive(model)
    assert len(attempts) == 1
    assert stop.binding == ("pressure_angle", "torque_reduction")
    assert "torque_reduction fails with the smoother of the case" in stop.reason


def test_torque_lost_at_trial_one_but_regained_is_found_by_the_predictor():
    def model(s):  # inertia eats the reduction of a sharp cam
        return torque(0.5 - (s - 2.0) ** 2 / 5.0), check("pressure_angle", 1.2 / s)

    attempts, whys, stop = drive(model)
    assert stop.binding == ()
    assert len(attempts) == 2
    assert "torque_reduction is lost" in whys[0].why


def test_what_the_lift_cannot_help_is_left_alone():
    def model(_s):
        return torque(0.7), check("closure", 2.0, lift=False)

    attempts, _, stop = drive(model)
    assert len(attempts) == 1
    assert stop.binding == ("closure",)
    assert "no gentler lift can help" in stop.reason
    assert "independent of the smoothing" in stop.reason


def test_a_missing_number_does_not_drive_the_lift_and_does_not_pass():
    def model(_s):
        missing = made_check("guide_pv_B", 2.0, None, lift_can_help=True)
        return torque(0.7), missing

    attempts, _, stop = drive(model)
    assert len(attempts) == 1
    assert verdict(attempts[-1].checks) == "incomplete"
    assert stop.binding == ("guide_pv_B",)
    assert stop.reason == (
        "no check of trial 1 fails, but data are missing; one check not evaluated, as an input is"
        " missing"
    )


def test_a_demand_that_is_not_proven_is_smoothed_until_it_is():
    def model(s):
        angle = made_check("pressure_angle", 1.2 / s, 1.0, lift_can_help=True, error_share=0.05)
        return torque(0.9 - 0.25 * s), angle

    attempts, _, stop = drive(model)
    assert stop.binding == ()
    # Five percent of error bar and half a percent of the limit.
    last = attempts[-1].smoother.strength
    assert 1.2 * 1.05 * 0.999 < last < 1.2 * 1.05 * 1.005 * 1.03
    _, _, stop = drive(lambda _s: (torque(0.7), made_check("mesh", 0.99, 1.0, error_share=0.02)))
    assert stop.reason.endswith(
        "mesh at 99 % of its limit now, independent of the smoothing, not proven"
    )


def test_the_stopping_criterion_names_what_certificate_and_corners_add():
    said = restated("trial 1 passes every must-have check", (), ("jump",))
    assert said == "trial 1 passes every must-have check; failing by the certificate: jump"
    assert restated("trial 1 fails", ("jump", "film"), ("film", "jump")) == "trial 1 fails"


def test_missing_data_of_the_torque_are_no_reason_to_smooth():
    def model(_s):
        return torque(np.nan), check("pressure_angle", 0.9)

    attempts, _, stop = drive(model)
    assert len(attempts) == 1
    assert stop.binding == ("torque_reduction",)
    assert stop.reason.startswith("no check of trial 1 fails, but data are missing")


def test_a_failed_check_is_worse_than_missing_data_and_those_than_a_pass():
    kept, missing = torque(0.7), [made_check(name, 2.0, None) for name in "abc"]
    passes = score([kept, check("pressure_angle", 0.9)])
    lacking = score([kept, check("pressure_angle", 0.9), *missing])
    failing = score([kept, check("pressure_angle", 1.01)])
    assert passes < lacking < failing < score([kept, check("pressure_angle", 1.02)])
    assert failing < score([kept, check("pressure_angle", 1.01), *missing])


def test_beside_a_missing_number_the_others_still_improve():
    def model(s):
        return *cannot_pass(s), made_check("guide_pv_B", 2.0, None, lift_can_help=True)

    attempts, _, stop = drive(model)
    assert stop.binding == ("guide_pv_B", "roller_static")
    assert 2.1 / 1.03 <= attempts[-1].smoother.strength <= 2.1


def test_nan_torque_reduction_is_not_kept():
    def model(_s):
        return torque(np.nan), check("pressure_angle", 1.4)

    attempts, _, stop = drive(model)
    assert len(attempts) == 1
    assert "torque_reduction" in stop.binding
    assert "torque_reduction is not evaluated with the smoother of the case" in stop.reason


def test_nan_later_ends_on_a_trial_that_is_known():
    def model(s):
        lost = s > 1.5
        return torque(np.nan if lost else 0.7), check("pressure_angle", np.nan if lost else 2.9 / s)

    attempts, _, stop = drive(model)
    assert keeps_torque(attempts[-1].checks)
    assert len(attempts) <= BOUND
    assert stop.binding == ("pressure_angle",)


def test_a_case_without_smoothing_cannot_be_gentler():
    attempts, _, stop = drive(cannot_pass, kind="none")
    assert len(attempts) == 1
    assert "has no smoother to widen" in stop.reason


def test_a_case_without_an_engine_has_no_torque_to_lose():
    def model(s):
        return (check("pressure_angle", 1.3 / s),)

    attempts, _, stop = drive(model)
    assert stop.binding == ()
    assert len(attempts) == 2


def test_a_wiggling_predictor_still_ends_on_the_best():
    def model(s):
        return (
            torque(0.8 - 0.15 * s),
            check("pressure_angle", 1.5 + 0.4 * np.cos(9.0 * s)),
        )

    attempts, _, stop = drive(model)
    assert best_attempt(attempts) == len(attempts) - 1
    assert stop.best == len(attempts)
    # 9 s = pi (2 n + 1), s >= 1: every minimum is 1.1 and n = 1 comes first.
    assert score(attempts[-1].checks)[2] == pytest.approx(1.1, rel=0.01)


def test_a_predictor_that_is_off_is_put_right_by_the_trials():
    def truth(s):
        return torque(0.9 - 0.25 * s), check("pressure_angle", 1.6 / s)

    def closed_form(s):  # a tenth too low, and a torque that is too rosy
        return torque(0.95 - 0.25 * s), check("pressure_angle", 1.44 / s)

    attempts, _, stop = drive(truth, forecast=closed_form)
    assert stop.binding == ()
    assert len(attempts) <= 4


def test_checks_without_a_forecast_stay_as_the_trial_has_them():
    def truth(s):
        return torque(0.9 - 0.25 * s), check("pressure_angle", 1.4 / s), check("fe_only", 1.3)

    def closed_form(s):
        return truth(s)[:2]

    attempts, _, stop = drive(truth, forecast=closed_form)
    assert stop.binding == ("fe_only",)
    assert keeps_torque(attempts[-1].checks)
    assert len(attempts) <= 3


def test_a_forecast_moves_the_tolerance_corner_too():
    """Judged at its corner, a third above the nominal cam that is forecast."""

    def truth(s):
        cornered = check("pressure_angle", 1.2 / s, corner="friction high", corner_demand=1.6 / s)
        return torque(0.9 - 0.2 * s), cornered

    def closed_form(s):
        return torque(0.9 - 0.2 * s), check("pressure_angle", 1.2 / s)

    attempts, _, stop = drive(truth, forecast=closed_form)
    assert stop.binding == ()
    assert attempts[-1].smoother.strength == pytest.approx(1.6, rel=0.02)
    assert len(attempts) == 2


def test_a_foreseen_pass_by_a_hair_is_not_trusted():
    def model(s):
        return torque(0.9 - 0.1 * s), check("pressure_angle", 1.4 if s < 1.3 else 0.9)

    def foreseen(s):
        return torque(0.9 - 0.1 * s), check(
            "pressure_angle", (1.4, 0.997, 0.9)[(s > 1.3) + (s > 2)]
        )

    attempts, _, stop = drive(model, forecast=foreseen)
    assert stop.binding == ()
    assert attempts[-1].smoother.strength >= 2.0


def test_a_small_step_is_worth_a_pass():
    def model(s):
        return torque(0.7), check("pressure_angle", 1.004 / s)

    attempts, _, stop = drive(model)
    assert stop.binding == ()
    assert strengths(attempts) == [1.0, pytest.approx(1.01, abs=0.01)]


def test_no_window_is_wider_than_one_crank_turn():
    def model(s):
        return (check("roller_static", 1.5 + 1.0 / s),)

    attempts, _, stop = drive(model)
    # 60 deg at strength 1.
    assert max(strengths(attempts)) == pytest.approx(6.0, rel=1e-9)
    assert "no smoother that keeps torque_reduction passes" in stop.reason


def test_a_first_trial_without_a_cam_leaves_the_word_to_the_prediction():
    def foreseen(s):
        if s < 1.5:
            return ()
        return torque(0.9 - 0.25 * s), check("undercut", 1.6 / s)

    def truth(s):
        if s < 1.5:  # no body, so nothing is known of its contact
            return torque(0.8), check("undercut", 9.0), check("contact_pressure", np.nan)
        return *foreseen(s), check("contact_pressure", 0.9)

    attempts, _, stop = drive(truth, forecast=foreseen)
    assert stop.binding == ()
    assert strengths(attempts) == [1.0, pytest.approx(1.61, rel=0.01)]


def test_strengths_without_a_cam_are_passed_over():
    def truth(s):
        return torque(0.9 - 0.25 * s), check("pressure_angle", 1.4 / s)

    def closed_form(s):
        if 1.3 < s < 1.6:
            return ()
        return truth(s)

    attempts, _, stop = drive(truth, forecast=closed_form)
    assert stop.binding == ()
    assert attempts[-1].smoother.strength >= 1.6


@pytest.mark.parametrize("bound", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("lost_at", [1.05, 1.3, 1.9, 2.1, 3.0])
def test_never_more_trials_than_allowed_and_the_last_is_the_best(bound, lost_at):
    def model(s):
        return torque(0.4 + 0.3 * (lost_at - s)), check("roller_static", 2.9 - 0.1 * s)

    attempts, _, stop = drive(model, bound)
    assert len(attempts) <= bound
    assert stop.best == len(attempts)
    assert score(attempts[-1].checks) == min(score(item.checks) for item in attempts)
    assert keeps_torque(attempts[-1].checks)


def test_bound_is_named():
    *_, stop = drive(cannot_pass, 1)
    assert "the maximum of 1 trials is reached" in stop.reason


def test_going_back_repeats_the_best_and_then_ends():
    worse = Attempt(Smoother("gaussian", strength=2.0), (torque(0.2), check("roller_static", 2.0)))
    better = Attempt(Smoother("gaussian"), (torque(0.41), check("roller_static", 2.9)))
    step = next_smoother([better, worse], 3, never)
    assert isinstance(step, Next)
    assert step.smoother == better.smoother
    assert "trial 1 is the best; it is repeated as the last one" in step.why
    end = next_smoother([better, worse, better], 3, never)
    assert isinstance(end, Stop)
    assert end.best == 3


def test_the_best_is_repeated_once_even_if_it_shows_a_new_flaw():
    # The last trial is looked at more closely: what it adds must not set off another round.
    first = (torque(0.41), check("roller_static", 2.9))
    better = Attempt(Smoother("gaussian"), first)
    worse = Attempt(Smoother("gaussian", strength=1.015), (torque(0.2), check("x", 2.0)))
    again = Attempt(Smoother("gaussian"), (*first, check("certificate", 1.2, lift=False)))
    end = next_smoother([better, worse, again], 6, never)
    assert isinstance(end, Stop)
    assert end.best == 3
    assert "certificate" in end.binding


def test_without_a_place_to_go_back_the_better_trial_is_named():
    worse = Attempt(Smoother("gaussian", strength=2.0), (torque(0.2), check("roller_static", 2.0)))
    better = Attempt(Smoother("gaussian"), (torque(0.41), check("roller_static", 2.9)))
    stop = next_smoother([better, worse], 2, never)
    assert isinstance(stop, Stop)
    assert stop.best == 1
    assert "trial 1 was better" in stop.reason


def test_infinite_utilisation_is_a_failure_like_any_other():
    def model(s):
        force = -0.1 if s < 1.5 else 0.3
        lost = made_check("contact_force_margin", force, 0.2, sense="at_least", lift_can_help=True)
        return torque(0.9 - 0.2 * s), lost

    attempts, whys, stop = drive(model)
    assert stop.binding == ()
    assert strengths(attempts) == [1.0, pytest.approx(1.51, rel=0.02)]
    assert "at > 999 % of its limit" in whys[0].why


@pytest.mark.parametrize("wrong", [{"attempts": []}, {"max_trials": 0}, {"max_trials": np.nan}])
def test_nonsense_is_refused(wrong):
    plain = {
        "attempts": [Attempt(Smoother(), cannot_pass(1.0))],
        "max_trials": BOUND,
        "forecast": never,
    }
    with pytest.raises(InputError):
        next_smoother(**(plain | wrong))
