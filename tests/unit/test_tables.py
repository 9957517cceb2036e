"""Numbers to rows: digits, units, order of the checks, and the words of the verdict."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camwright.pipeline.base.verdict import governing_id
from camwright.pipeline.results.check_records import RecordedCheck, of_records
from camwright.reports import report_tables, scene_page, verification_tables
from camwright.reports.verdict_text import governing, governing_load_case, verdict


def check(name, status="pass", utilisation=0.5, **more):
    base = {
        "id": name, "title": name.title(), "demand": 1.0, "limit": 2.0, "unit": "MPa",
        "utilisation": utilisation, "status": status, "load_case": "idle", "cam_angle_deg": 12.5,
        "source": "", "method": "", "must_have": True, "sense": "at_most",
        "waiver": None, "waived_up_to": None, "not_proven": False, "note": "", "error": None,
        "corner": "", "corner_demand": None, "evidence": False, "judged_at": "",
    }  # fmt: skip
    return base | more


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (1234.567, "1235"),
        (0.123456, "0.1235"),
        (30.0, "30"),
        (32.99999999, "33.00"),
        (-4.5, "−4.5"),
        (0.0, "0"),
        (1.5e-9, "1.5×10⁻⁹"),
        (1e-9 * 1e3, "1×10⁻⁶"),
        (2.34567e8, "2.346×10⁸"),
        (999.96, "1000"),
        (math.inf, "∞"),
        (-math.inf, "−∞"),
        (math.nan, "–"),
        (None, "–"),
        (720, "720"),
        (True, "yes"),
        ("idle", "idle"),
    ],
)
def test_a_number_has_four_digits_and_a_true_minus(value, shown):
    assert report_tables.number(value) == shown


def test_si_values_are_shown_in_drawing_units():
    assert report_tables.quantity(1.05e9, "Pa") == "1050\xa0MPa"
    assert report_tables.quantity(math.radians(30), "rad") == "30\xa0deg"
    assert report_tables.quantity(0.5, "-") == "0.5"
    assert report_tables.quantity(None, "MPa") == "–"
    assert "MPa\xa0m/s" in report_tables.quantity(1.9, "MPa m/s")


def test_a_limit_is_only_drawn_in_a_unit_that_fits():
    assert report_tables.in_unit(820.0, "MPa", "MPa") == 820.0
    assert report_tables.in_unit(8.2e8, "Pa", "MPa") == pytest.approx(820.0, rel=1e-12)
    assert report_tables.in_unit(0.5, "-", "") == 0.5
    assert report_tables.in_unit(820.0, "N", "MPa") is None


def test_checks_come_unevaluated_first_then_by_utilisation():
    checks = [
        check("low", utilisation=0.1),
        check("high", "fail", 2.0),
        check("endless", "fail", None),
        check("missing", "not_evaluated", None, demand=None, limit=None),
        check("waived", "waived", 19.0),
    ]
    rows = report_tables.check_rows(checks)
    assert [row.id for row in rows] == ["missing", "endless", "waived", "high", "low"]
    assert [row.utilisation for row in rows] == ["–", "> 999 %", "> 999 %", "200 %", "10 %"]
    assert [row.bar for row in rows] == [None, 1.5, 1.5, 1.5, 0.1]
    assert rows[0].limit == "–"


@pytest.mark.parametrize(
    ("value", "shown"), [(1.0, "100 %"), (1.0004, "100.04 %"), (0.9996, "99.96 %"), (1.01, "101 %")]
)
def test_a_utilisation_is_never_rounded_across_its_limit(value, shown):
    assert report_tables.check_rows([check("near", utilisation=value)])[0].utilisation == shown


def test_the_sense_of_a_limit_is_printed():
    rows = report_tables.check_rows(
        [check("most"), check("least", sense="at_least", utilisation=0.4)]
    )
    assert [row.limit for row in rows] == ["≤\xa02\xa0MPa", "≥\xa02\xa0MPa"]


def test_a_pass_needs_the_word_and_every_required_check():
    good = [check("a"), check("b", "waived", 3.0), check("c", "fail", 2.0, must_have=False)]
    missing, failed = check("d", "not_evaluated", None), check("e", "fail", 1.1)
    cases = {
        ("pass", "pass"): good,
        ("fail", "fail"): good,
        ("incomplete", "incomplete"): good,
        ("pass", "fail"): [],
        ("pass", "incomplete"): [*good, missing],
        ("incomplete", "fail"): [*good, missing, failed],
    }
    for (recorded, outcome), checks in cases.items():
        said = verdict(recorded, checks, (), "")
        assert (said.outcome, said.word) == (outcome, outcome.upper())
        assert said.line.startswith(outcome.upper())


def test_the_page_lists_what_is_missing_not_proven_waived_and_to_be_confirmed():
    checks = [
        check("a", to_be_confirmed=["pa66 swelling", "<b> PV"]),
        check("b", "fail", 0.98, demand=1.95, error=0.06, not_proven=True),
        check("c", "not_evaluated", None, note="state camshaft.diameter"),
        check("d", "waived", 1.2, waiver="A. Engineer, 2025-01-02: proven", waived_up_to=2.5),
        check("e", to_be_confirmed=["pa66 swelling"]),
    ]
    said = verdict("fail", checks, ("b", "c"), "", "Not covered by this sign-off: key: none")
    assert said.line == (
        "FAIL: 1 check not proven, 1 check without data, 1 waived, 2 values to be confirmed"
    )
    assert said.brief == "FAIL"
    assert said.confirm == ("pa66 swelling", "<b> PV")
    assert said.scope == "Not covered by this sign-off: key: none"
    assert said.unproven == ("B: not proven: 1.950 ± 0.060 against 2",)
    assert said.missing == ("C: state camshaft.diameter",)
    assert said.waived == (
        "D: demand 1\xa0MPa, accepted up to 2.5\xa0MPa, A. Engineer, 2025-01-02: proven",
    )
    assert [label for label, _ in said.lists] == ["Binding", "Missing data", "Not proven", "Waived"]
    assert verdict("fail", checks, (), "no room; a").lists[-1] == (
        "Reasons to end the trials", ("no room", "a"),
    )  # fmt: skip
    assert said.worst == (("B: 1.95 MPa, limit ≤ 2 MPa (98 %), idle 12.5 deg", ""),)
    row = next(row for row in report_tables.check_rows(checks) if row.id == "b")
    assert row.status.words == "fail, not proven"
    assert ("not proven: 1.950 ± 0.060 against 2", True) in row.remarks


def test_a_line_of_the_terminal_is_printed_with_the_signs_of_print():
    line = "F/F0: -0.9, limit >= 0.2; follower.mass-1: 100 g; (-3 mm) p0 1176 -> 1428 MPa, 1e-3"
    assert report_tables.printed(line) == (
        "F/F0: \N{MINUS SIGN}0.9, limit ≥ 0.2; follower.mass-1: 100 g; (\N{MINUS SIGN}3 mm)"
        " p0 1176 → 1428 MPa, 1e-3"
    )


def test_the_sentence_counts_what_holds_fails_and_is_missing():
    checks = [
        check("a"), check("b", "fail", 2.0), check("c", "not_evaluated", None),
        check("d", "waived", 2.0), check("e", "not_evaluated", None, must_have=False),
    ]  # fmt: skip
    words = verdict("fail", checks, ("b", "c"), "no more room")
    assert words.sentence == (
        "1 of 4 required checks passes, 1 fails, 1 lacks data, 1 is waived."
        " Of 1 optional check: 1 lacks data."
    )
    assert (words.binding, words.missing) == (("B",), ("C: a number is missing",))
    assert words.stopped == ("no more room",)


def test_a_clause_that_only_lists_what_is_not_evaluated_is_not_said_twice():
    checks = [check("a", "fail", 2.0), check("b", "not_evaluated", None),
              check("c", "not_evaluated", None)]  # fmt: skip
    stopped = "A at 2 of its limit; not judged, as the case leaves a number out: B, C"
    assert verdict("fail", checks, ("a", "b", "c"), stopped).stopped == ("A at 2 of its limit",)
    assert len(verdict("fail", checks[:2], ("a", "b"), stopped).stopped) == 2


def test_the_governing_check_is_required_and_not_waived():
    checks = [
        check("optional", "fail", 9.0, must_have=False), check("waived", "waived", 8.0),
        check("worst", "fail", 2.0, load_case="rated"), check("fine"),
        check("mesh", "fail", 7.0, evidence=True), check("lacks", "not_evaluated", None),
    ]  # fmt: skip
    assert governing_id(of_records(checks)) == "worst"
    assert governing(checks).startswith("Worst, load case rated, cam angle 12.5")
    assert governing([]) == ""
    at_corner = check("c", "fail", 2.5, corner="mass high", corner_demand=5.0)
    assert "demand 1\xa0MPa, at the tolerance corner mass high: 5\xa0MPa, limit" in governing(
        [*checks, at_corner]
    )


def test_a_governing_check_that_is_the_worst_failure_is_described_once():
    failed, unproven = check("a", "fail", 2.0), check("b", "fail", 0.98, not_proven=True)
    assert verdict("fail", [failed, check("c")], ("a",), "").governing == ""
    beside = verdict("fail", [unproven, check("c", utilisation=0.99)], ("b",), "")
    assert beside.governing.startswith("C, load case idle")
    assert beside.worst[0][0].startswith("B: ")


def test_an_infinite_utilisation_governs_and_of_equal_ones_the_first_id():
    beyond = check("b", "fail", None, load_case="rated")
    assert governing_id(of_records([check("a", "fail", 50.0), beyond])) == "b"
    assert governing_id(of_records([beyond, check("c", "fail", None)])) == "b"
    assert governing_id(of_records([check("a", "not_evaluated", None)])) is None
    assert RecordedCheck(beyond).utilisation == math.inf


def test_the_sheet_draws_the_load_case_that_governs():
    checks = [check("a", "fail", 2.0, load_case="rated"), check("b")]
    assert governing_load_case(checks, ["idle", "rated"]) == "rated"
    assert governing_load_case([check("c", load_case="")], ["idle", "rated"]) == "idle"


def test_input_tables_keep_each_source_beside_its_value():
    case = {
        "name": "x",
        "spring": {"rate": "24.2 kN/m", "source": "paper"},
        "limits": {"jam_index": 0.5, "sources": {"jam_index": "Rothbart"}},
        "materials": {"s355": {"E": "210 GPa", "source": "EN 10025"}},
        "load_case": [{"name": "idle"}, {"name": "rated"}],
    }
    found = {table.title: table for table in report_tables.input_tables(case)}
    assert found["spring"].source == "paper"
    assert found["limits"].rows == (("jam index", "0.5", "Rothbart"),)
    assert found["materials › s355"].rows == (("E", "210 GPa", ""),)
    assert found["load case 2"].rows == (("name", "rated", ""),)
    assert found["general"].rows == (("name", "x", ""),)


def test_input_values_keep_their_digits():
    table = report_tables.input_tables({"solver": {"share": 0.6666666666666666}})[0]
    assert table.rows[0][1] == "0.666666666667"


def test_certificate_rows_follow_their_heads():
    figure = {"meshes": [1000.0, 1001.0, 1001.25], "extrapolated": 1001.5, "order": None,
              "gci_percent": 0.031, "cycle": 1002.0}  # fmt: skip
    point = {"p0_MPa": figure, "half_width_mm": figure, "cam_angle_deg": 30.0, "dofs": [10, 20, 40],
             "edges_across_half_width": [6.0, 9.0, 13.5], "p0_hertz_MPa": 999.0,
             "spread_percent": 0.7, "residual_equilibrium": 1e-13}  # fmt: skip
    table = verification_tables.certificate([point])
    (row,) = table.rows
    assert row == [
        "30", "6, 9, 13.5", "10, 20, 40", "1000, 1001, 1001.2", "1001.5", "scatter", "0.031",
        "999", "1002", "0.050", "1×10⁻¹³",
    ]  # fmt: skip
    assert len(row) == len(table.head)
    table = verification_tables.certified([point])
    (other,) = table.rows
    assert other[:2] == ["30", "half-width a, mm"]
    assert len(other) == len(table.head)


def test_a_point_without_figures_gives_dashes():
    table = verification_tables.certificate([{}])
    assert table.rows == [["–"] * len(table.head)]
    assert verification_tables.certified([{}]).rows == []


def test_a_record_shows_units_and_what_is_inside():
    record = {"min_angle_deg": 27.3, "nodes": 42531, "sha256": {"cam": "ab"}}
    assert report_tables.named_rows(record) == [
        ("min angle", "27.3\xa0deg"), ("nodes", "42531"), ("sha256, cam", "ab")
    ]  # fmt: skip


def test_an_angle_that_is_round_off_is_zero():
    assert report_tables.quantity(4e-12, "deg") == "0\xa0deg"
    assert report_tables.quantity(-4e-12, "deg") == "0\xa0deg"
    assert report_tables.quantity(2e-6, "deg") != "0\xa0deg"
    assert report_tables.quantity(4e-12, "m") != "0\xa0m"
    read = scene_page._shown(np.array([4e-12, -3e-12, np.nan]), "deg")
    assert read == [0.0, 0.0, 0.0]
    assert scene_page._shown(np.array([25.0, 1e-9, -3.0]), "deg") == [25.0, 0.0, -3.0]
    assert scene_page._shown(np.array([4e-12, 2e-12]), "N") == [4e-12, 2e-12]


def test_headlines_that_do_not_apply_are_left_out():
    headline = {"torque_std_before_Nm": None, "lift_max_mm": 33.0, "new_number": 2.5}
    assert report_tables.headline_rows(headline) == [
        ("Maximum lift", "33\xa0mm"), ("new number", "2.5")
    ]  # fmt: skip
    assert [tile.title for tile in report_tables.tiles(headline)] == ["Lift"]


def test_the_removed_ripple_is_a_share_of_the_ripple_before():
    tile = report_tables.tiles({"torque_std_before_Nm": 6.0, "torque_std_after_Nm": 3.0})[0]
    assert tile.value == "50\xa0%"


def test_inputs_show_a_value_without_the_noise_of_its_last_bits():
    case = {"smoothing": {"width": "59.99999999999999 deg", "points": 12, "note": "1.5 mm each"}}
    table = report_tables.input_tables(case)[0]
    assert [value for _, value, _ in table.rows] == ["60 deg", "12", "1.5 mm each"]
