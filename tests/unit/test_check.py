"""One check, the verdict over many, and their order."""

import json
import math

import numpy as np
import pytest
from made_check import made_check

from camwright.pipeline.checks.check import Check, Waived, binding, in_order, verdict, verdict_line


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
    assert verdict([check]) == "fail"
    assert binding([check]) == ("x",)


def test_numpy_numbers_are_numbers():
    check = at_most(np.float64(1.0))
    assert check.status == "pass"
    assert isinstance(check.as_record()["demand"], float)


@pytest.mark.parametrize("demand", [3.0, None, np.nan, np.inf])
def test_a_waiver_is_printed_and_lets_the_verdict_pass(demand):
    check = at_most(demand, waiver="A. Engineer, 2025-01-02: proven in service")
    assert check.status == "waived"
    assert verdict([check]) == "pass"
    assert binding([check]) == ()
    assert "proven in service" in check.as_record()["waiver"]


def test_a_waiver_not_needed_stays_a_pass():
    assert at_most(1.0, waiver="A. Engineer").status == "pass"


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
    assert binding(checks) == ("unknown", "never", "bad", "over")


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
    """Demand, limit, error and corner; the utilisation is that of the SI values."""
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
    assert record["utilisation"] == check.utilisation == 0.5


@pytest.mark.parametrize(
    "check",
    [at_most(np.nan), at_most(np.inf), at_least(0.0), at_most(1.0, np.inf), at_most(None)],
)
def test_record_is_valid_json(check):
    record = check.as_record()
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert record["utilisation"] is None
    assert record["status"] in ("fail", "not_evaluated")


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
    ],
)
def test_the_verdict_in_one_line_from_checks_and_from_records(checks, line):
    assert verdict_line(checks) == line
    assert verdict_line([one.as_record() for one in checks]) == line


def test_a_record_of_an_earlier_release_has_no_values_to_be_confirmed():
    record = at_most(1.0, unconfirmed=("materials.a.E",)).as_record()
    del record["to_be_confirmed"]
    assert verdict_line([record]) == "PASS"
