"""One check, the verdict over many, and their order."""

import json
import math

import made_trial
import numpy as np
import pytest
from made_check import made_check
from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import ROUNDING, binding, in_order, verdict
from camwright.pipeline.case.scope_section import Scope
from camwright.pipeline.checks.check import BOUNDLESS, Check, Demand, Waived
from camwright.pipeline.checks.check import check as declare
from camwright.pipeline.checks.part_data import data_key
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.results.check_records import verdict_line


def at_most(demand, limit=2.0, **more) -> Check:
    return made_check("x", demand, limit, unit="MPa", **more)


def at_least(demand, limit=2.0, **more) -> Check:
    return made_check("x", demand, limit, sense="at_least", **more)


@pytest.mark.parametrize(
    ("check", "status", "utilisation"),
    [
        (at_most(2.0 * 0.99), "pass", 0.99),
        (at_most(2.0), "pass", 1.0),
        (at_most(2.0 * 1.01), "fail", 1.01),
        (at_least(2.0 / 0.99), "pass", 0.99),
        (at_least(2.0), "pass", 1.0),
        (at_least(2.0 / 1.01), "fail", 1.01),
        (at_least(0.0), "fail", math.inf),
        (at_least(-1.0), "fail", math.inf),
        (at_most(math.inf), "fail", math.inf),
        (at_most(0.0, 0.0), "pass", 0.0),
        (at_most(1.0, 0.0), "fail", math.inf),
    ],
)
def test_status_and_utilisation(check, status, utilisation):
    assert check.status == status
    assert check.utilisation == pytest.approx(utilisation)


@pytest.mark.parametrize("sense", ["at_most", "at_least"])
@pytest.mark.parametrize(
    ("demand", "limit"),
    [(None, 1.0), (1.0, None), (np.nan, 1.0), (1.0, np.nan), (None, None), (1.0, np.inf)],
)
def test_a_missing_number_never_passes(sense, demand, limit):
    check = made_check("x", demand, limit, sense=sense)
    assert check.status == "not_evaluated"
    assert check.utilisation is None
    assert verdict([check]) == "incomplete"
    assert verdict([check, at_most(1.0)]) == "incomplete"
    assert verdict([check, at_most(3.0)]) == "fail"
    assert binding([check]) == ("x",)


def test_a_part_is_judged_missing_or_left_out_by_the_scope():
    """The key of the cam: described, not described, not described and not covered."""

    @declare(title="pressure on {follower} key", method="none: made up", part="key")
    def key(_):
        return Demand(1.0, 2.0)

    bare = made_trial.changed(made_trial.case().cam, keyway=None)
    scope = Scope(not_covered=("key", "gear"), reason="press fit")
    described = key(made_trial.solution())
    assert described is not None
    assert described.status == "pass"
    for without in (made_trial.case(cam=bare), made_trial.case(cam=bare, scope=scope)):
        assert key(made_trial.solution(case=without)) is None
    missing = data_key(made_trial.solution(case=made_trial.case(cam=bare)))
    assert missing is not None
    assert (missing.status, missing.must_have) == ("not_evaluated", True)
    assert missing.as_record()["missing"] == ["cam.keyway", "cam.key"]
    assert missing.note == (
        "missing: cam.keyway, cam.key; no key is described; describe it or leave it out in [scope]"
    )
    assert verdict([described, missing]) == "incomplete"
    assert data_key(made_trial.solution(case=made_trial.case(cam=bare, scope=scope))) is None


def test_a_scope_needs_its_reason_and_knows_its_parts():
    assert Scope().statement == ""
    said = "Not covered by this sign-off: key, driving gear: as drawn"
    assert Scope(not_covered=("gear", "key"), reason=" as\n drawn ").statement == said
    for wrong in ({"not_covered": ("key",)}, {"not_covered": ("cam",), "reason": "x"}):
        with pytest.raises((InputError, ValidationError), match=r"reason|not_covered"):
            Scope(**wrong)


def test_numpy_numbers_are_numbers():
    check = at_most(np.float64(1.0))
    assert check.status == "pass"
    assert isinstance(check.as_record()["demand"], float)


def waived(up_to):
    return Waived("A. Engineer, 2025-01-02: proven in service", up_to)


def test_a_waiver_is_printed_and_lets_the_verdict_pass():
    check = made_check("x", 3e6, 2e6, unit="MPa", waiver=waived(3.5e6))
    assert check.status == "waived"
    assert verdict([check]) == "pass"
    assert binding([check]) == ()
    record = check.as_record()
    assert "proven in service" in record["waiver"]
    assert record["waived_up_to"] == 3.5


@pytest.mark.parametrize(
    ("demand", "corner", "share", "up_to", "status"),
    [
        (3.0, None, None, 3.0, "waived"),
        (3.0, None, None, 3.0 * 0.999, "fail"),
        (3.0, 3.2, None, 3.2, "waived"),
        (3.0, 3.2, None, 3.1, "fail"),
        (3.0, None, 0.1, 3.3001, "waived"),
        (3.0, None, 0.1, 3.29, "fail"),
        (3.0, 3.2, 0.1, 3.53, "waived"),
        (3.0, 3.2, 0.1, 3.51, "fail"),
        (1.9, None, 0.1, 2.1, "waived"),  # not proven
        (1.9, None, 0.1, 2.08, "fail"),
        (np.inf, None, None, 1e300, "fail"),
    ],
)
def test_a_waiver_covers_a_failed_demand_up_to_its_value(demand, corner, share, up_to, status):
    """The worst demand with its error bar, on both senses: d <= 2 up to w is -d >= -2 up to -w."""
    more = {"error_share": share, "corner": "mass high" if corner else ""}
    check = at_most(demand, waiver=waived(up_to), corner_demand=corner, **more)
    assert check.status == status
    mirrored = None if corner is None else -corner
    least = at_least(-demand, -2.0, waiver=waived(-up_to), corner_demand=mirrored, **more)
    assert least.status == status


@pytest.mark.parametrize(
    ("demand", "limit"), [(None, 2.0), (np.nan, 2.0), (3.0, None), (3.0, np.nan), (3.0, np.inf)]
)
def test_a_waiver_never_covers_missing_data(demand, limit):
    check = at_most(demand, limit, waiver=waived(1e9))
    assert check.status == "not_evaluated"
    assert verdict([check]) == "incomplete"


def test_a_waiver_not_needed_stays_a_pass():
    assert at_most(1.0, waiver=waived(3.0)).status == "pass"


@pytest.mark.parametrize("sense", ["at_most", "at_least"])
@pytest.mark.parametrize(
    ("demand", "share", "status"),
    [
        (1.02 / 1.04, 0.03, "fail"),
        (0.99, 0.0099, "pass"),
        (0.99, 0.0102, "fail"),
        (1.0, ROUNDING, "pass"),
        (1.0, 1e-6, "fail"),
        (1.0, None, "pass"),
        (1.01, 0.0, "fail"),
        (1.01, 0.5, "fail"),
    ],
)
def test_an_error_bar_across_the_limit_is_no_proof(sense, demand, share, status):
    """Demand over its limit of 1; a least value of -1 is its mirror image."""
    sign = 1.0 if sense == "at_most" else -1.0
    check = made_check("x", sign * demand, sign, sense=sense, error_share=share)
    assert check.status == status
    assert check.not_proven == (status == "fail" and demand <= 1.0)
    assert check.as_record()["not_proven"] == check.not_proven
    assert verdict([check]) == status


@pytest.mark.parametrize("sense", ["at_most", "at_least"])
@pytest.mark.parametrize(
    ("corner", "status"),
    [(0.99, "pass"), (1.01, "fail"), (0.2, "pass"), (np.inf, "fail"), (np.nan, "not_evaluated")],
)
def test_the_worst_corner_is_judged(sense, corner, status):
    sign = 1.0 if sense == "at_most" else -1.0
    check = made_check(
        "x", 0.9 * sign, sign, sense=sense, corner="spring rate low", corner_demand=sign * corner
    )
    assert check.status == status
    if status == "pass" and sense == "at_most":
        assert check.utilisation == pytest.approx(max(0.9, corner))
    assert check.as_record()["demand"] == 0.9 * sign


def test_an_optional_check_does_not_decide():
    failed, missing = at_most(3.0, must_have=False), at_most(None, must_have=False)
    assert verdict([failed, missing, at_most(1.0)]) == "pass"
    assert binding([failed, missing]) == ()


def test_no_checks_no_pass():
    assert verdict([]) == "fail"


def test_order_not_evaluated_first_then_worst():
    checks = [
        made_check("mild", 0.5, 1.0),
        made_check("bad", 3.0, 1.0),
        made_check("never", 0.0, 1.0, sense="at_least"),
        made_check("optional_unknown", None, 1.0, must_have=False),
        made_check("unknown", None, 1.0),
        made_check("over", 1.01, 1.0),
    ]
    names = [check.id for check in in_order(checks)]
    assert names == ["unknown", "optional_unknown", "never", "bad", "over", "mild"]
    assert binding(in_order(checks)) == ("unknown", "never", "bad", "over")


def test_order_does_not_depend_on_the_input_order():
    checks = [made_check(name, 1.0, 1.0) for name in "cab"]
    assert [check.id for check in in_order(checks)] == ["a", "b", "c"]


def test_record_has_the_contract_s_keys():
    record = at_most(1.0, load_case="idle", cam_angle=0.2, source="s", method="m").as_record()
    first = "id title demand limit unit utilisation status load_case cam_angle_deg source method"
    assert list(record)[:11] == first.split()
    assert record["utilisation"] == 0.5


@pytest.mark.parametrize(
    ("unit", "si", "written"),
    [("MPa", 2e6, 2.0), ("deg", 0.5 * math.pi, 90.0), ("%", 0.03, 3.0), ("h", 7200.0, 2.0),
     ("rpm", math.pi, 30.0), ("degC", 56.85, 56.85), ("-", 0.5, 0.5), ("crossings", 3.0, 3.0)],
)  # fmt: skip
def test_record_is_in_the_unit_of_the_check(unit, si, written):
    """Demand, limit, error and corner; the utilisation is that of the corner in SI."""
    check = made_check(
        "x", si, 2.0 * si, unit=unit, cam_angle=math.pi / 3.0, error_share=0.01,
        corner="mass high", corner_demand=1.5 * si,
    )  # fmt: skip
    record = check.as_record()
    assert record["demand"] == pytest.approx(written, rel=1e-12)
    assert record["limit"] == pytest.approx(2.0 * written, rel=1e-12)
    assert record["error"] == pytest.approx(0.01 * written, rel=1e-12)
    assert record["corner_demand"] == pytest.approx(1.5 * written, rel=1e-12)
    assert record["cam_angle_deg"] == pytest.approx(60.0, rel=1e-12)
    assert record["utilisation"] == pytest.approx(check.utilisation, rel=1e-14)
    assert check.utilisation == pytest.approx(max(si, 1.5 * si) / (2.0 * si) if si > 0 else 0.5)


@pytest.mark.parametrize(
    "check",
    [at_most(np.nan), at_most(np.inf), at_least(0.0), at_most(1.0, np.inf), at_most(None)],
)
def test_record_is_valid_json(check):
    record = check.as_record()
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert record["utilisation"] is None
    assert record["status"] in ("fail", "not_evaluated")


@pytest.mark.parametrize(
    ("stated", "written"),
    [(0.0025, {"g": 2.5}), (math.inf, {"g": BOUNDLESS / 1e-3}), (math.nan, {})],
)
def test_record_has_the_stated_numbers_in_the_units_of_their_symbols(stated, written):
    demand = Demand(0.0, 1e-6, stated={"g": stated})
    made = DECLARED["second_contact"].judged(made_trial.solution().machine, demand)
    assert made.as_record()["stated"] == pytest.approx(written)


def test_a_check_prints_as_a_line():
    line = "peak: 3 MPa, must be <= 2 MPa: fail"
    assert str(made_check("x", 3e6, 2e6, unit="MPa", title="peak")) == line
    assert str(at_most(None)).endswith("unknown, must be <= 2e-06 MPa: not_evaluated")


@pytest.mark.parametrize(
    ("checks", "line"),
    [
        ([at_most(1.0)], "PASS"),
        ([], "FAIL: no check decides"),
        ([at_most(3.0, must_have=False)], "FAIL: no check decides"),
        ([at_most(1.0, unconfirmed=("materials.a.E",))], "PASS, 1 value to be confirmed"),
        (
            [
                at_most(3.0, waiver=Waived("A. Engineer", 4.0), unconfirmed=("a", "b")),
                at_most(1.0, unconfirmed=("b", "c")),
                at_most(1.0, unconfirmed=("d",), must_have=False),
            ],
            "PASS, 1 waived, 3 values to be confirmed",
        ),
        (
            [at_most(3.0), at_most(3.0), at_most(None), at_most(1.99, error_share=0.05)],
            "FAIL: 2 checks beyond their limit, 1 check not proven, 1 check without data",
        ),
        ([at_most(math.nan), at_most(1.0)], "INCOMPLETE: 1 check without data"),
        (
            [
                at_most(1.0, relaxed=("limits.a = 2, default 1", "limits.b = 3, default 1")),
                at_most(1.0, relaxed=("limits.a = 2, default 1",), unconfirmed=("c",)),
                at_most(1.0, relaxed=("limits.d = 2, default 1",), must_have=False),
            ],
            "PASS, 2 limits relaxed, 1 value to be confirmed",
        ),
        (
            [at_most(3.0, relaxed=("limits.a = 2, default 1",))],
            "FAIL: 1 limit relaxed, 1 check beyond its limit",
        ),
    ],
)
def test_the_verdict_in_one_line_from_checks_and_from_records(checks, line):
    assert verdict_line([one.as_record() for one in checks]) == line


def test_a_record_of_an_earlier_release_has_no_values_to_be_confirmed():
    record = at_most(1.0, unconfirmed=("materials.a.E",)).as_record()
    del record["to_be_confirmed"]
    assert verdict_line([record]) == "PASS"


def test_evidence_is_what_no_change_of_the_design_moves():
    evidence = {each.id for each in DECLARED.values() if each.evidence}
    verifies_solution = {
        *("contact_torque", "contact_work", "friction_balance", "contact_equilibrium"),
        *("contact_complementarity", "guide_equilibrium_force", "guide_equilibrium_moment"),
        *("hertz_difference", "synthesis_converged", "certificate_spread", "certificate_gci"),
        *("mesh_angle", "mesh_jacobian", "mesh_edges", "mesh_p0", "mesh_half_width"),
        *("mesh_von_mises", "mesh_tau_max", "mesh_reaction", "benchmark_nafems"),
        *("benchmark_hertz", "tolerance_corners", "held_distance"),
        "landing_balance",
        *("excluded_zone", "subsurface_depth"),
    }
    verifies_input = {"closure", "endurance_rules", "waivers_without_effect"}
    assert evidence == verifies_solution | verifies_input
