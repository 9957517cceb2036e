"""What a limit is made of, and a NaN in one of two load cases; each check in test_every_check."""

import made_trial as made
import numpy as np
import pytest
from check_tools import check
from trial_variants import (
    NAN,
    cycle_with,
    faced,
    hollow,
    on_arm,
    soft,
    with_certificate,
    with_cycle,
    with_limits,
    with_mesh,
)

from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.checks.registry import all_checks
from camwright.pipeline.cycle.solution import Solution


@pytest.mark.parametrize(
    ("name", "safety"),
    [
        ("contact_pressure", "contact_safety"),
        ("first_yield", "yield_safety"),
        ("shakedown", "shakedown_safety"),
        ("shakedown_traction", "shakedown_safety"),
        ("surface_fatigue", "fatigue_safety"),
        ("hardened_case", "case_safety"),
        ("bore_stress", "bore_safety"),
        ("gear_bending", "gear_bending_safety"),
        ("gear_contact", "gear_contact_safety"),
    ],
)
def test_a_safety_divides_the_limit(name, safety):
    plain = check(name, with_limits(**{safety: 1.0}))
    assert check(name, with_limits(**{safety: 1.25})).limit == pytest.approx(plain.limit / 1.25)


@pytest.mark.parametrize(
    ("name", "share"), [("roller_speed", "roller_speed_share"), ("chord_error", "chord_share")]
)
def test_a_share_is_of_the_whole(name, share):
    whole = check(name, with_limits(**{share: 1.0}))
    assert check(name, with_limits(**{share: 0.7})).limit == pytest.approx(0.7 * whole.limit)


def poisoned(part: str, field: str) -> Solution:
    """Two load cases; of the second one figure is not known."""
    plain = made.cycle(load_case="bad")
    bad = cycle_with(part, plain, **{field: NAN * getattr(getattr(plain, part), field)})
    return made.of_load_cases(made.cycle(), bad)


@pytest.mark.parametrize(
    ("name", "part", "field"),
    [
        ("contact_force_margin", "loads", "normal_force"),
        ("roller_static", "loads", "normal_force"),
        ("roller_radial", "loads", "normal_force"),
        ("profile_waviness", "loads", "normal_force"),
        ("jump", "loads", "inertia_force"),
        ("jam_index", "loads", "jam_index"),
        ("friction_balance", "loads", "cam_torque"),
        ("contact_pressure", "contact", "p0"),
        ("contact_pressure_at_life", "contact", "p0"),
        ("edge_pressure", "contact", "p0"),
        ("shakedown", "contact", "p0"),
        ("shakedown_traction", "contact", "p0"),
        ("hertz_difference", "contact", "p0"),
        ("first_yield", "rolling", "von_mises"),
        ("contact_equilibrium", "contact", "residual_equilibrium"),
        ("contact_complementarity", "contact", "residual_complementarity"),
        ("guide_pressure_A", "guides", "line_pressure_a"),
        ("guide_pv_A", "guides", "rubbing_load_a"),
        ("guide_pressure_B", "guides", "line_pressure_b"),
        ("guide_pv_B", "guides", "rubbing_load_b"),
        ("guide_equilibrium_force", "guides", "force_residual"),
        ("guide_equilibrium_moment", "guides", "moment_residual"),
    ],
)
def test_a_nan_in_one_load_case_is_a_missing_number(name, part, field):
    result = check(name, poisoned(part, field))
    assert result.status == "not_evaluated"
    assert result.load_case == "bad"


@pytest.mark.parametrize(
    ("name", "field"),
    [("jump_speed", "inertia_force"), ("contact_at_overspeed", "spring_force")],
)
def test_a_nan_in_one_load_case_leaves_the_overspeed_open(name, field):
    assert check(name, poisoned("loads", field)).status == "not_evaluated"


def test_a_nan_force_leaves_the_life_unknown():
    assert np.isnan(check("roller_life", poisoned("loads", "normal_force")).demand)


@pytest.mark.parametrize("field", ["torque_before", "torque_after"])
@pytest.mark.parametrize("name", ["torque_reduction", "phase_tolerance"])
def test_a_nan_torque_leaves_the_reduction_unknown(name, field):
    assert check(name, with_cycle(**{field: NAN})).status == "not_evaluated"


@pytest.mark.parametrize("figure", ["p0", "half_width", "tau_max", "von_mises"])
def test_a_nan_certificate_is_a_missing_number(figure):
    """Of whichever figure: the worst of four is not known without the fourth."""
    for name, values in (
        ("certificate_spread", {f"{figure}_cycle": np.nan}),
        ("certificate_gci", {figure: made.converged(np.nan)}),
    ):
        result = check(name, with_certificate(**values))
        assert result.status == "not_evaluated"
        assert result.must_have


def test_a_nan_mesh_is_a_missing_number():
    assert check("mesh_angle", with_mesh(min_angle_deg=np.nan)).status == "not_evaluated"


class Watched(dict):
    """Sources of a case that note the names they are looked up by."""

    def __init__(self):
        super().__init__()
        self.names = set()

    def get(self, name, default=None):
        self.names.add(name)
        return super().get(name, default)


def test_the_source_of_every_limit_is_looked_up_and_no_other():
    """But for the overspeed, of which a limit is made; `limits.sources` accepts no other name."""
    sources = Watched()
    of_return = with_limits(pressure_angle=0.3, return_pressure_angle=0.2)
    needles = made.arm_solution("needle_bearing")
    for solution in (
        made.solution(),
        hollow(),
        soft(),
        faced(),
        of_return,
        needles,
        on_arm(),
        made.in_groove(),
    ):
        open_ones = {"landing_speed": 1.0, "crossover_slip": 5.0, "worn_clearance": 1.0}
        stated = open_ones if solution.case.cam.pulls else {}
        limits = made.changed(solution.case.limits, sources=sources, **stated)
        case = made.changed(solution.case, limits=limits)
        all_checks(made.changed_solution(solution, case=case))
    assert sources.names == set(LIMITS) - {"overspeed"}
