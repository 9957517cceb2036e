"""Evidence, prices and findings as rows: what is said, and what is left out."""

from __future__ import annotations

import pytest

from camwright.reports import report_tables, verification_tables
from camwright.reports.machine_words import words_of

CHECK = {
    "id": "x", "title": "Contact pressure", "demand": 1088.3, "limit": 650.0, "unit": "MPa",
    "utilisation": 1.67, "status": "fail", "load_case": "idle", "cam_angle_deg": 245.5,
    "source": "s", "method": "m", "sense": "at_most", "must_have": True, "waiver": None,
    "waived_up_to": None, "not_proven": False, "note": "", "error": None, "corner": "",
    "corner_demand": None, "evidence": False, "judged_at": "",
}  # fmt: skip


@pytest.mark.parametrize(
    ("error", "shown"),
    [(1.5, "±\u00a01.5"), (0.11, "±\u00a00.11"), (0.1, ""), (0.0, ""), (None, ""),
     (float("nan"), "")],
)  # fmt: skip
def test_an_error_bar_is_shown_where_it_shows_in_the_digits(error, shown) -> None:
    assert report_tables.check_rows([CHECK | {"error": error}])[0].error == shown


def test_the_error_bar_is_in_the_unit_of_the_demand() -> None:
    check = CHECK | {"unit": "Pa", "demand": 1.0883e9, "error": 1.5e6}
    row = report_tables.check_rows([check])[0]
    assert (row.demand, row.error) == ("1088\u00a0MPa", "±\u00a01.5")


def test_a_corner_that_changes_no_digit_is_none() -> None:
    same = CHECK | {"corner": "nominal", "corner_demand": 1088.31}
    more = CHECK | {"corner": "spring rate high", "corner_demand": 1109.0}
    unknown = CHECK | {"corner": "", "corner_demand": None}
    assert report_tables.worst_corner(same) is None
    assert report_tables.check_rows([more])[0].corner == "spring rate high: 1109\u00a0MPa"
    rows = verification_tables.corners([same, more, unknown, CHECK]).rows
    assert rows == [["Contact pressure", "spring rate high", "1088\u00a0MPa", "1109\u00a0MPa"]]


def test_a_price_is_the_ripple_that_goes_when_a_limit_gives_way() -> None:
    record = {
        "limit": "pressure_angle", "value": 30.0, "unit": "deg", "ripple_per_unit_Nm": 0.25,
        "ripple_per_percent_Nm": 0.03, "binds_at_deg": [[10.0, 12.5], [80.0, 80.0]],
    }  # fmt: skip
    bare = {"limit": "roller_life", "unit": "-", "ripple_per_unit_Nm": None, "binds_at_deg": []}
    table = verification_tables.prices([record, record | bare])
    assert table.rows[0] == [
        "pressure angle", "30\u00a0deg", "−0.25\u00a0N\u00a0m per deg", "−0.03\u00a0N\u00a0m",
        "10–12.5, 80 deg",
    ]  # fmt: skip
    assert table.rows[1][2:] == ["–", "−0.03\u00a0N\u00a0m", "–"]
    assert all(len(row) == len(table.head) for row in table.rows)
    assert verification_tables.prices(None).rows == []


def test_a_price_of_the_machine_is_the_change_by_more_of_a_number() -> None:
    record = {
        "words": "spring rate", "value": 180.0, "unit": "N/mm", "ripple_per_unit_Nm": -0.0083,
        "ripple_per_percent_Nm": -0.015,
    }  # fmt: skip
    friction = {"words": "friction of guide A", "value": 0.06, "unit": "-"}
    table = verification_tables.machine_prices(
        [record, friction | {"ripple_per_unit_Nm": 3.3, "ripple_per_percent_Nm": 0.002}]
    )
    assert table.rows[0] == [
        "spring rate", "180\u00a0N/mm", "0.0083\u00a0N\u00a0m per N/mm", "0.015\u00a0N\u00a0m",
    ]  # fmt: skip
    assert table.rows[1][2] == "−3.3\u00a0N\u00a0m per unit"
    phase = {"words": "phase", "value": 0.0, "unit": "deg", "ripple_per_unit_Nm": 0.0}
    (row,) = verification_tables.machine_prices([phase | {"ripple_per_percent_Nm": 0.0}]).rows
    assert row[1:] == ["0\u00a0deg", "0\u00a0N\u00a0m per deg", "0\u00a0N\u00a0m"]
    assert all(len(row) == len(table.head) for row in table.rows)
    assert verification_tables.machine_prices(None).rows == []


def test_inputs_that_contradict_each_other_are_told() -> None:
    record = {
        "load_case": "idle", "id": "inertia", "title": "inertia at the crank", "given": 0.0026,
        "implied": 0.0134, "unit": "kg m^2", "difference_percent": 415.0, "flagged": True,
        "how": "std of the torque's integral",
    }  # fmt: skip
    table, flagged = verification_tables.consistency([record])
    assert flagged
    assert table.rows[0][-1].endswith("(differs)")
    assert verification_tables.consistency([record | {"flagged": False}])[1] is False
    assert verification_tables.consistency(None) == (
        verification_tables.ReportTable(table.label, table.head, [], 3),
        False,
    )
    bounded = verification_tables.consistency([record | {"difference_percent": None}])[0]
    assert bounded.rows[0][-1] == "– (differs)"


def test_the_cranks_speed_is_told_by_load_case_and_state() -> None:
    state = {"std_rad_per_s": 3.59, "p2p_rad_per_s": 11.13, "fluctuation": 0.0708}
    idle = {"before": state, "after": state, "flywheel": {}}
    table = verification_tables.crank_speed(
        {"idle": idle, "stall": {"refused": "the crank stalls"}}, words_of({}, 2.0)
    )
    assert [row[:2] for row in table.rows] == [["idle", "engine alone"], ["idle", "with the cam"]]
    assert table.rows[0][-1] == "7.08\u00a0%"
    assert verification_tables.crank_speed(None, words_of({}, 2.0)).rows == []


def test_benchmarks_are_told_in_per_cent() -> None:
    record = {"nafems_p0": 0.00206, "hertz_half_width": -2.5e-4, "nafems_residual": 1e-13}
    assert [value for _, value in verification_tables.benchmarks(record)] == [
        "0.21\u00a0%",
        "−0.025\u00a0%",
    ]
    assert verification_tables.benchmarks(None) == []
