"""Hand-check sheets: the formula of each check, evaluated once more on the numbers of a run."""

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pypdf
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base.tables import Table
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.checks.solution_verification import RESIDUALS
from camwright.pipeline.commands.report_command import report
from camwright.pipeline.commands.terminal import FAILED, PASSED
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.hand_check.hand_sheet import Sheet, SheetRun
from camwright.pipeline.hand_check.sheet_lines import STATED, sheet_lines
from camwright.pipeline.run import run_case
from camwright.reports import sections
from camwright.reports.documents import PDF
from camwright.reports.page import PAGE

CASES, DATA = Path(__file__).parents[2] / "cases", Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Closed forms of the smoothed GX120, whose spring, key, gear and guides are described."""
    case = read_case(CASES / "gx120-feedback.toml").with_positions(72)
    smoothing = case.smoothing.model_copy(update={"width": 2.5})
    solver = case.solver.model_copy(update={"max_trials": 1})
    case = case.model_copy(update={"smoothing": smoothing, "solver": solver})
    folder = tmp_path_factory.mktemp("sheet") / "run"
    run_case(case, folder, positions=72, depth=Tier.PREVIEW, jobs=1)
    return SheetRun(folder)


ONE_NUMBER = {
    "anti_rotation", "closure", "contact_complementarity", "contact_equilibrium",
    "contact_pressure", "dang_van", "first_yield", "guide_edge_pressure_A",
    "guide_edge_pressure_B", "guide_equilibrium_force", "guide_equilibrium_moment",
    "pressure_by_gear_limits", "roller_radial", "roller_static_radial", "self_intersection",
    "shaft_slope", "shakedown", "synthesis_converged", "tolerance_corners",
}  # fmt: skip
"""Checks whose demand is one number of a solver, a residual or a count."""


NOT_DECISIVE = {"second_contact", "spring_buckling", "spring_gap"}
"""Checks whose stated numbers are those of a gap or mode that does not govern."""


def evaluated(run):
    return [each for each in map(run.sheet, run.records) if each.steps]


def test_every_sheet_gives_the_demand_of_its_check(run):
    """All but those of load cases with a duty or another kind of a part, which are stated."""
    sheets = evaluated(run)
    assert [each.record["id"] for each in sheets if not each.agrees] == []
    known = {name for name, each in run.records.items() if each["demand"] is not None}
    bound = {name for name in known if DECLARED[name].symbols}
    assert {each.record["id"] for each in sheets} == bound
    assert len(bound) > 50


@pytest.mark.parametrize("name", ["pressure_angle", "jump", "guide_pv_A", "gear_bending"])
def test_a_changed_demand_is_found(run, name):
    record = run.records[name]
    changed = {**run.records, name: {**record, "demand": 1.01 * record["demand"]}}
    altered = SheetRun(run.run.path, run.run)
    altered.__dict__["records"] = MappingProxyType(changed)
    assert not altered.sheet(name).agrees
    assert "DISAGREES with the demand" in "\n".join(sheet_lines(altered.sheet(name)))
    assert altered.sheet("undercut").agrees


@pytest.mark.parametrize(
    ("entry", "words"),
    [("limit", "DISAGREES with the limit"), ("utilisation", "DISAGREES with the use")],
)
def test_a_changed_limit_or_use_is_found(run, entry, words):
    altered = with_record(run, "gear_bending", entry, lambda value: 1.01 * value)
    assert words in "\n".join(sheet_lines(altered.sheet("gear_bending")))


def with_record(run, name, entry, change):
    """The run with an entry of the record of a check changed."""
    record = run.records[name]
    altered = SheetRun(run.run.path, run.run)
    changed = {**run.records, name: {**record, entry: change(record[entry])}}
    altered.__dict__["records"] = MappingProxyType(changed)
    return altered


def unmoved(run, names):
    """Checks with numbers of a solver none of which, changed by 1 %, is found by the sheet."""
    found = {}
    for name in names:
        for symbol, value in run.records[name]["stated"].items():
            other = 1.01 * value if value else 1.0
            altered = with_record(
                run, name, "stated", lambda numbers, s=symbol, v=other: {**numbers, s: v}
            )
            found[name] = found.get(name, False) or not altered.sheet(name).agrees
    return [name for name, moved in found.items() if not moved]


def test_a_changed_number_of_a_solver_is_found(run):
    """A seeded sample; the slow tests change every one."""
    stated = {each.record["id"] for each in evaluated(run) if each.record["stated"]}
    known = sorted(stated - NOT_DECISIVE)
    sample = np.random.default_rng(3).choice(known, 12, replace=False)
    assert unmoved(run, map(str, sample)) == []


@pytest.mark.parametrize(
    ("column", "found"),
    [
        ("normal_force_N", {"roller_static", "roller_radial", "roller_life", "roller_pin"}),
        ("follower_velocity_m_per_s", {"guide_speed_A", "guide_pv_B", "guide_wear_A"}),
        ("cam_torque_Nm", {"gear_bending", "key_pressure", "cam_slip"}),
        ("torque_after_Nm", {"torque_reduction"}),
        ("p0_hertz_MPa", {"contact_pressure"}),
    ],
)
def test_a_changed_number_of_the_cycle_is_found(run, column, found):
    cycle = run.run.final.cycle
    numbers = MappingProxyType({**cycle.numbers, column: 1.001 * cycle.numbers[column]})
    final = replace(run.run.final, cycle=Table(numbers, cycle.rows_of))
    altered = SheetRun(run.run.path, replace(run.run, trials=(final,)))
    assert found <= {each.record["id"] for each in evaluated(altered) if not each.agrees}


def test_a_sheet_states_formula_symbols_steps_result_and_limit(run):
    text = "\n".join(sheet_lines(run.sheet("gear_bending")))
    assert text.startswith("gear_bending: ")
    for words in (
        DECLARED["gear_bending"].formula, "[5_cycle.csv, ", "20 mm  [camshaft.gear.width]",
        "|T + drag| / r = |", "0.154 - 0.912 / z = 0.154 - 0.912 / 40 = 0.1312", "agrees",
        "limit    <= 207.6 MPa = 0.7 s_F / S = 0.7 · 430 MPa / 1.45: Lewis",
        "430 MPa  [camshaft.gear",
        "MPa / 207.6 MPa = ",
    ):  # fmt: skip
        assert words in text


def test_a_result_of_a_solver_is_stated_and_not_passed_off_as_evaluated(run):
    assert run.sheet("contact_pressure").is_stated  # one number of the cycle
    slope = run.sheet("shaft_slope")
    assert slope.is_stated and len(slope.steps) == 1  # the number, against its limit
    text = "\n".join(sheet_lines(slope))
    assert STATED in text and "[stated, 6_checks.json, " in text
    assert not run.sheet("pressure_angle").is_stated
    with pytest.raises(InputError, match="--check"):
        run.sheet("no_such_check")


def test_a_formula_is_not_evaluated_for_a_case_of_which_it_does_not_hold(run):
    """A duty sums the lives of the load cases; a pin held at one end bends otherwise."""
    altered = SheetRun(run.run.path, run.run)
    altered.__dict__["machines"] = {
        name: replace(each, duty=0.25) for name, each in run.machines.items()
    }
    text = run.run.case_text
    assert text.count('mounting = "straddled"') == 1
    altered.case = parse_case(text.replace('mounting = "straddled"', 'mounting = "overhung"'))
    for name in ("roller_life", "guide_wear_A", "roller_pin", "roller_pin_shear"):
        assert run.sheet(name).steps and altered.sheet(name).is_stated, name
    assert altered.sheet("pressure_angle").steps


def test_the_governing_sheets_are_those_of_the_greatest_utilisations(run):
    records = [run.records[name] for name in run.governing()]
    uses = [each["utilisation"] for each in records]
    assert len(records) == 12 and uses == sorted(uses, reverse=True)
    assert all(each["must_have"] and not each["evidence"] for each in records)


@pytest.mark.slow
def test_the_page_has_every_sheet_and_the_pdf_the_governing_ones(run):
    folder = run.run.path
    sections.report(folder, sections.chosen(["page", "pdf"]))
    page = (folder / PAGE).read_text(encoding="utf-8")
    assert page.count('<details class="sheet"') == len(run.records)
    shown = page[page.index('id="hand-gear_bending"') :]
    shown = shown[: shown.index("</details>")]
    for words in (
        "<mfrac>",
        "<msub><mi>K</mi><mi>A</mi></msub>",
        "camshaft.gear.width",
        "<b>agrees",
    ):
        assert words in shown
    printed = pypdf.PdfReader(folder / PDF)
    text = " ".join("".join(each.extract_text() for each in printed.pages).split())
    text = text[text.index("The formula of each check, evaluated once more") :]
    for name in run.governing():
        assert run.records[name]["title"] in text
    assert run.records["roller_pin_shear"]["title"] not in text


def test_the_command_prints_the_sheets_and_fails_by_one_that_disagrees(run, capsys, monkeypatch):
    folder = run.run.path
    assert report(folder, check=["pressure_angle", "undercut"]) == PASSED
    shown = capsys.readouterr().out
    assert "pressure_angle: " in shown and "undercut: " in shown and "agrees" in shown
    with pytest.raises(InputError, match="--check"):
        report(folder, check=["no_such_check"])
    monkeypatch.setattr(Sheet, "agrees", False)
    assert report(folder, check=["undercut"]) == FAILED


@pytest.mark.slow
def test_the_sheets_of_the_redesigned_case_give_its_demands(tmp_path):
    """Each check has a formula that is evaluated, or is one number of a solver or a count."""
    run_case(read_case(CASES / "gx120-redesign.toml"), tmp_path / "run", positions=180)
    run = SheetRun(tmp_path / "run")
    sheets = evaluated(run)
    assert [each.record["id"] for each in sheets if not each.agrees] == []
    assert {each.record["id"] for each in sheets} == set(run.records)
    counts = {each.record["id"] for each in sheets if each.record["id"].startswith("data_")}
    assert {each.record["id"] for each in sheets if each.is_stated} - counts <= ONE_NUMBER
    assert sum(each.bound is not None for each in sheets) > 130
    assert set(unmoved(run, run.records)) <= {*RESIDUALS, *NOT_DECISIVE}
    for name, record in run.records.items():
        change = 0.01 * abs(record["limit"] or record["demand"] or 1.0)
        altered = with_record(run, name, "demand", lambda value, more=change: value + more)
        assert not altered.sheet(name).agrees, (name, record["demand"])


OVERHUNG = {"cheek_pressure", "fork_gap", "roller_pin", "roller_pin_shear"}
"""Checks whose formula holds for a pin held at both ends."""
BY_ARMS = {"pressure_angle", "roller_speed", "fork_gap"}
"""Checks whose formula holds on a straight path, or with one roller."""
ON_FACE = {"curvature_rate", "film_ratio", "gear_gap", "tool_gouge", "undercut"}
"""Checks whose formula needs a radius, depth or roughness of a roller, or a tool."""
HELD = {
    "data/stepped_groove": OVERHUNG, "motions/feeder-groove": OVERHUNG,
    "data/preloaded_feeder": OVERHUNG, "motions/placer-preloaded": BY_ARMS,
    "motions/transfer-conjugate": BY_ARMS, "motions/pump-yoke": ON_FACE,
}  # fmt: skip
"""Cams that hold their follower, and the checks whose formula does not hold for them."""


@pytest.mark.slow
@pytest.mark.parametrize("name", HELD)
def test_sheets_of_held_cams_give_the_demands_or_say_why_not(tmp_path, name):
    """Of preloaded discs and of two rollers in a groove, too; the keyway root has its numbers from
    finite elements.
    """
    folder, _, file = name.partition("/")
    case = read_case((DATA if folder == "data" else CASES / folder) / f"{file}.toml")
    run_case(case, tmp_path / "run", positions=72, depth=Tier.PREVIEW, jobs=1)
    run = SheetRun(tmp_path / "run")
    sheets = {each: run.sheet(each) for each, of in run.records.items() if of["demand"] is not None}
    assert [each for each, sheet in sheets.items() if not sheet.agrees] == []
    without = {each: sheet for each, sheet in sheets.items() if not sheet.steps}
    assert without.keys() - {"keyway_root"} == HELD[name]
    for sheet in without.values():
        assert sheet.reason and f"not evaluated: {sheet.reason}" in "\n".join(sheet_lines(sheet))
    assert not sheets["torque_reversals"].record["note"].endswith(" 0.0 N m/rad")
    film = sheets["film_ratio"].record
    assert film["error"] < 0.5 * film["demand"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stem", "arm", "pressed"])
def test_sheets_of_unequal_discs_are_of_the_disc_of_the_demand(tmp_path, name):
    """Radius, curvature or pressure of the second disc govern, and its roller turns faster."""
    files = {"stem": "conjugate_feeder", "arm": "conjugate_arm", "pressed": "preloaded_arm"}
    text = (DATA / f"{files[name]}.toml").read_text("utf-8")
    if name == "stem":
        text = text.replace('roller_radius = "23.5 mm"', 'roller_radius = "20 mm"')
        text = text.replace('distance = "154 mm"', 'distance = "170 mm"')
        text = text.replace('prime_radius = "68 mm"', 'prime_radius = "68 mm"\noffset = "4 mm"')
    run_case(parse_case(text), tmp_path / "run", positions=48, depth=Tier.PREVIEW, jobs=1)
    run = SheetRun(tmp_path / "run")
    sheets = [run.sheet(each) for each in run.records]
    assert [each.record["id"] for each in sheets if not each.agrees] == []
    if name == "stem":
        assert run.sheet("cam_radius").result > 1.2e3 * run.contour.radius_max().value
    else:
        if name == "pressed":
            pressed = {each.symbol: each for each in run.sheet("edge_pressure").quantities}
            assert pressed["p0"].value > 1.01 * 1e6 * run.run.final.cycle["p0_hertz_MPa"].max()
            assert pressed["K"].source.startswith("stated")
        quantities = run.sheet("curvature_ratio").quantities
        assert "roller.radius, of the second disc" in [each.source for each in quantities]
