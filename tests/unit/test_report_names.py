"""Every column, headline and record key that the reports read by name is one that a run writes."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import report_fixture
from every_option import full_case

from camwright import reports
from camwright.pipeline.base.tables import Table, table
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.renamed_keys import renamed_names
from camwright.pipeline.case.template import first_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results import run_records
from camwright.pipeline.results.record_schemas import record_schema
from camwright.pipeline.results.run_reader import HEADLINE
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve
from camwright.reports import report_tables
from camwright.reports.analysis_sheet import groups
from camwright.reports.sheet_turn import SheetTurn

FOLDER = Path(reports.__file__).parent
CASES = Path(__file__).parents[2] / "cases"
MODULES = (
    *("analysis_sheet", "part_figures", "sheet_turn", "report_tables", "report_content"),
    *("report_data", "verification_tables", "verdict_text"),
)
WITH_UNIT = re.compile(
    r"[a-z]\w*_(mm|um|N|MPa|deg|Nm|W|J|rpm|percent|per_mm|per_s|per_rad[23]?|turn)"
)
BY_ELEMENTS = {"pivot_edge_pressure_foundation_MPa"}
"""Columns of a cycle by finite elements, which no preview has."""
PRICES = {"ripple_Nm", "ripple_per_unit_Nm", "ripple_per_percent_Nm", "binds_at_deg"}


class Recorder(dict[str, Any]):
    """Columns that note every name that is looked up."""

    def __init__(self, values: Any, names: set[str]) -> None:
        super().__init__(values)
        self.names = names

    def get(self, name: str, default: Any = None) -> Any:
        self.names.add(name)
        return super().get(name, default)

    def __getitem__(self, name: str) -> Any:
        self.names.add(name)
        return super().__getitem__(name)

    def __contains__(self, name: object) -> bool:
        self.names.add(str(name))
        return super().__contains__(name)


def keys_of(record: Any) -> Iterator[str]:
    """Keys of a record at every depth."""
    if isinstance(record, dict):
        yield from record
        for entry in record.values():
            yield from keys_of(entry)
    elif isinstance(record, list):
        for entry in record:
            yield from keys_of(entry)


def previewed(case: Any, contour: Any) -> Trial:
    return solve(case, contour, tier=Tier.PREVIEW, positions=36, corners=False)


@pytest.fixture(scope="module")
def rolls() -> Trial:
    case = full_case()
    hung = case.follower.model_copy(update={"gravity_angle": 0.0})
    case = case.model_copy(update={"follower": hung})
    return previewed(case, case.contour(cam_lift(case, engine_torques(case))))


@pytest.fixture(scope="module")
def slides() -> Trial:
    case = read_case(CASES / "papers" / "petrescu_c.toml")
    return previewed(case, case.contour(cam_lift(case, {})))


@pytest.fixture(scope="module")
def swings() -> Trial:
    case = parse_case(first_case("swing", "arm").text)
    return previewed(case, case.contour(cam_lift(case, {})))


@pytest.fixture(scope="module")
def grooved() -> Trial:
    case = read_case(CASES / "motions" / "feeder-groove.toml")
    return previewed(case, case.contour(cam_lift(case, {})))


@pytest.fixture(scope="module")
def paired() -> Trial:
    case = read_case(CASES / "motions" / "pump-yoke.toml")
    return previewed(case, case.contour(cam_lift(case, {})))


@pytest.fixture(scope="module")
def speed(rolls: Trial) -> tuple[dict[str, Any], Any]:
    return run_records.crank_speed_record(rolls, None)


@pytest.fixture(scope="module")
def columns(
    rolls: Trial,
    slides: Trial,
    swings: Trial,
    grooved: Trial,
    paired: Trial,
    speed: tuple[dict[str, Any], Any],
) -> set[str]:
    """Headers of all columns of a run, with the error bar of a measured torque."""
    torque = engine_torques(rolls.case)["idle"]
    barred = replace(torque, error_bar=torque.total)
    tables = [*run_records.torque_columns(barred), *speed[1]]
    for trial in (rolls, slides, swings, grooved, paired):
        tables += [c for columns in run_records.column_table(trial).values() for c in columns]
    return {column.header for column in tables}


@pytest.fixture(scope="module")
def records(rolls: Trial, slides: Trial, speed: tuple[dict[str, Any], Any]) -> set[str]:
    """Keys of headline, trial, crank speed, and a measured engine by the schema."""
    measurement = record_schema("run")["$defs"]["Measurement"]["properties"]
    made = [run_records.headline(rolls.solution), speed[0], measurement]
    made += [run_records.trial_record(trial) for trial in (rolls, slides)]
    return {key for record in made for key in keys_of(record)}


def test_headlines_of_the_page_are_those_of_the_run(rolls: Trial, records: set[str]) -> None:
    headline = run_records.headline(rolls.solution)
    assert set(HEADLINE) <= set(headline)
    assert set(report_tables.HEADLINES) == set(headline)


def test_columns_of_the_report_fixture_are_those_of_a_run(columns: set[str]) -> None:
    t = report_fixture.turn(36)
    assert set(report_fixture.cycle_columns(t, report_fixture.shape(t))) - columns == set()


def looked_up(trial: Trial, speed: Any) -> set[str]:
    """Names that the figures of a run look up in its tables."""
    names: set[str] = set()

    def noted(values: Any) -> Table:
        return Table(Recorder(table(values).numbers, names))

    torques, case = engine_torques(trial.case), tomllib.loads(trial.case.to_toml())
    cycle = noted(run_records.cycle_columns(trial.cycles[:1]))
    turn = SheetTurn(
        cycle,
        (cycle,),
        noted(run_records.lift_columns(trial.case, trial.lift)),
        noted(run_records.contour_columns(trial.case, trial.contour)),
        noted(run_records.torque_columns(torques["idle"])) if torques else None,
        [check.as_record() for check in trial.checks],
        case,
        run_records.trial_record(trial)["balance"],
        speed=noted(speed) if speed is not None else None,
    )
    assert groups(turn)
    return names


def test_columns_of_the_figures_are_those_of_the_run(
    rolls: Trial,
    slides: Trial,
    swings: Trial,
    speed: tuple[dict[str, Any], Any],
    columns: set[str],
) -> None:
    names = looked_up(rolls, speed[1]) | looked_up(slides, None) | looked_up(swings, None)
    assert len(names) > 60
    assert names - columns - BY_ELEMENTS == set()


@pytest.mark.parametrize("module", MODULES)
def test_names_with_a_unit_are_those_of_the_run(
    module: str, columns: set[str], records: set[str]
) -> None:
    """Texts of the modules of the page that end like a column or a key with a unit."""
    tree = ast.parse((FOLDER / f"{module}.py").read_text(encoding="utf-8"))
    texts = {
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }
    certificate = {"p0_MPa", "half_width_mm", "p0_hertz_MPa", "spread_percent", "gci_percent"}
    ends = {"plane_strain_p0_MPa", "force_N", "moment_Nmm", "mean_length_mm", "signed_gci_percent"}
    below = {"von_mises_depth_mm", "shear_depth_mm"}
    known = columns | records | BY_ELEMENTS | PRICES | certificate | ends | below
    assert {text for text in texts if WITH_UNIT.fullmatch(text)} - known == set()


def test_a_renamed_name_is_written_under_its_new_name_alone(
    columns: set[str], records: set[str]
) -> None:
    renamed = renamed_names()
    assert not columns & set(renamed["columns"])
    assert not records & set(renamed["headline"])
    # Not of these two trials: a Poisson ratio below a quarter, a synthesis.
    assert set(renamed["columns"].values()) - columns == {"tau_max_all_planes_MPa"}
    assert set(renamed["headline"].values()) - records == {"prime_radius_mm"}
