"""A case that gives everything it may: every optional result comes out, in its column."""

import csv
import json
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from every_option import full_case

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.run import run_case
from camwright.reports.analysis_sheet import groups
from camwright.reports.report_data import read_material

COLUMNS = (
    "tau_max_with_traction_MPa",
    "von_mises_with_traction_MPa",
    "creepage",
    "slip_speed_m_per_s",
    "film_thickness_um",
    "film_thickness_ratio",
    "film_thickness_mixed_um",
    "asperity_load_share",
    "contact_force_elastic_stem_N",
    "shaft_bearing_load_1_N",
    "key_pressure_MPa",
    "bore_pressure_MPa",
    "spring_stress_MPa",
    "spring_surge_force_N",
    "pin_stress_MPa",
    "roller_speed_rpm",
    "roller_acceleration_rad_per_s2",
    "ring_stress_amplitude_MPa",
    "ring_stress_mean_MPa",
    "p0_change_between_balls_percent",
)
CHECKS = (
    "roller_static", "roller_speed", "roller_pin", "roller_ring_fatigue", "traction_demand",
    "spring_stress", "spring_fatigue", "spring_solid", "spring_buckling", "spring_rate",
    "spring_surge", "key_pressure", "torque_reversals",
)  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("full") / "run"
    run_case(full_case(), folder, progress=Silent(), jobs=1, depth=Tier.CYCLE)
    return folder


@pytest.fixture(scope="module")
def cycle(run):
    rows = list(csv.DictReader((run / "trial_1" / "5_cycle.csv").open(encoding="utf-8")))
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@pytest.mark.parametrize("name", COLUMNS)
def test_every_option_has_its_column(cycle, name):
    values = np.array([float(text) if text else np.nan for text in cycle[name]])
    assert np.isfinite(values).any()


def test_every_part_that_is_described_is_judged(run):
    checks = {c["id"]: c for c in json.loads((run / "trial_1" / "6_checks.json").read_text())}
    for name in CHECKS:
        assert checks[name]["status"] in ("pass", "fail"), name
        assert checks[name]["missing"] == [], name
        assert checks[name]["source"], name


LIMITED = (
    ("parts", "roller pin", "roller_pin"), ("parts", "key", "key_pressure"),
    ("parts", "bore", "bore_pressure"), ("roller", "speed", "roller_speed"),
    ("roller", "traction", "traction_reserve"), ("lift", "s", "spring_travel"),
    ("speed", "velocity", "guide_speed_A"),
)  # fmt: skip


def test_the_limit_of_a_figure_is_that_of_the_check_of_its_greatest_value(run):
    """The greatest value that is drawn against the demand of the check, which is found apart."""
    turn = read_material(run).turn
    panels = {(each.id, panel.quantity): panel for _, figures in groups(turn) for each in figures
              for panel in getattr(each, "panels", ())}  # fmt: skip
    checks = {check["id"]: check for check in turn.checks}
    for figure, quantity, name in LIMITED:
        panel, check = panels[figure, quantity], checks[name]
        limits = [] if check["limit"] is None else [check["limit"]]
        assert [line.value for line in panel.limits if line.value > 0] == limits, name
        drawn = [part for c in panel.curves for part in (c.y, c.lower, c.upper) if part is not None]
        greatest = np.nanmax(np.abs(drawn))
        assert greatest == pytest.approx(check["demand"], rel=1e-3), name  # between samples too


def test_the_bearings_of_the_camshaft_have_the_rating_over_the_required_safety(run):
    turn = read_material(run).turn
    (panel,) = [p for _, figures in groups(turn) for each in figures if each.id == "parts"
                for p in each.panels if p.quantity == "bearing load"]  # fmt: skip
    check = next(each for each in turn.checks if each["id"] == "shaft_bearing_static")
    greatest = max(float(np.max(curve.y)) for curve in panel.curves)
    assert panel.limits[0].value / greatest * check["limit"] == pytest.approx(check["demand"])


def test_the_method_says_how_the_roller_is_taken(run):
    """As a ring where balls and ring are given; else solid, and why."""
    record = json.loads((run / "trial_1" / "trial.json").read_text())
    assert "outer ring of its bearing on balls" in record["contact_method"]
    case = read_case(run / "case.toml")
    roller = machines(case)[0].follower
    assert record["contact_method"].endswith(roller.body_model)
    plain = replace(roller, bearing=replace(roller.bearing, ring=None))
    assert plain.body_model == (
        "roller solid on its hub: ring and balls of the bearing are not specified"
    )


def test_balance_is_recorded_and_drilled(run):
    found = json.loads((run / "trial_1" / "trial.json").read_text())["balance"]
    assert found["hole_drilled"]
    assert 0.0 <= found["residual_unbalance_g_mm"] < found["unbalance_g_mm"]
    drawn = ezdxf.readfile(run / "workshop" / "contour.dxf").query('CIRCLE[layer=="counter_hole"]')
    assert [2 * c.dxf.radius for c in drawn] == [pytest.approx(found["hole_diameter_mm"])]


def test_traction_of_rolling_never_eases_the_stress(cycle):
    """Small traction adds at second order only: within the 1e-4 of the fields' grid."""
    plain, rolling = (
        cycle[name].astype(float) for name in ("tau_max_MPa", "tau_max_with_traction_MPa")
    )
    assert (rolling != plain).any()
    assert (rolling >= plain * (1 - 1e-4)).all()


def test_mixed_film_says_what_it_is_worth(run):
    trial = json.loads((run / "trial_1" / "trial.json").read_text(encoding="utf-8"))
    film = trial["rolling"]["idle"]["film_thickness_mixed"]
    assert "(to be confirmed)" in film["source"]
    assert bool(film["refusal"]) == bool(film["positions_refused"])
