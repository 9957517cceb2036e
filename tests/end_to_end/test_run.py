"""A whole run of a small case: folder, verdict, resumption, and what is refused."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import printed_text
import pytest
from drawn_run import drawn_run, few_remedies
from record_validation import keeps_schema, schema_errors
from run_recomputed import RECOMPUTED, RunFiles, line_contact_by_quadrature

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import file_hashes
from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact import contact_benchmarks
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.solution import CONTACT
from camwright.pipeline.results import run_reader
from camwright.pipeline.run import run_case
from camwright.pipeline.screening.live_preview import live_differences
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).resolve().parents[2]
POSITIONS = 108


class Recorder(Silent):
    """Remembers the stages; stops the run as Ctrl-C does after some pieces of contact."""

    def __init__(self, stop_after: int | None = None) -> None:
        self.stages: list[str] = []
        self._left = stop_after

    def stage(self, name: str) -> None:
        self.stages.append(name)

    def advance(self, k: int, total: int) -> None:
        if self._left is not None and self.stages[-1].endswith(CONTACT):
            self._left -= 1
            if self._left == 0:
                raise KeyboardInterrupt


def small(folder: Path, **changes: str) -> Case:
    """The GX120 case with few positions, one certified angle and the ends by half-spaces alone,
    lines replaced by key.

    Ground by a wheel that is too large for its concave part, 15.3 mm; at 2400 rpm the follower
    still keeps to the cam.
    """
    text = (ROOT / "cases" / "gx120.toml").read_text(encoding="utf-8")
    text += '\n[workshop]\ntool_radius = "20 mm"\n'
    wanted = {"positions": str(POSITIONS), "certificate_positions": "1\nend_elements = 0"}
    wanted |= {"overspeed": '"2400 rpm"'} | changes
    for key, value in wanted.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text, count=1)
        assert count == 1, key
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return read_case(path)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Case, Path, dict[str, Any]]:
    """The GX120 run, interrupted between two pieces of its contact and resumed."""
    folder = tmp_path_factory.mktemp("run")
    case, out = small(folder), folder / "out"
    with pytest.raises(KeyboardInterrupt):
        drawn_run(case, out, jobs=1, progress=Recorder(stop_after=3))
    assert not out.exists()
    run = drawn_run(case, out, resume=True, jobs=1, progress=Silent())
    return case, out, dict(run.summary)


@pytest.fixture(scope="module")
def out(finished: tuple[Case, Path, dict[str, Any]]) -> Path:
    """Folder of the finished run."""
    return finished[1]


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same run without interruption and without its page."""
    folder = tmp_path_factory.mktemp("straight")
    with few_remedies():
        run_case(small(folder), folder / "out", jobs=1, progress=Silent())
    return folder / "out"


@pytest.mark.slow
def test_resumed_run_equals_a_straight_one_to_the_byte(
    finished: tuple[Case, Path, dict[str, Any]], straight: Path
) -> None:
    """All files but the page, the clock figures of run.json, and signoff.json, which signs them."""
    _, out, summary = finished
    clock = {"run.json", "signoff.json"}
    pages = {"8_report.html", "scene.html", "motion.svg", "8_signoff.pdf", "workshop/drawing.pdf"}
    pages |= {"workshop/contour.xlsx", "workshop/inspection.xlsx", "trial_1/5_cycle.xlsx"}
    whole, other = (
        file_hashes(folder, lambda name: name not in clock) for folder in (out, straight)
    )
    assert {name: whole[name] for name in whole if name not in pages} == other
    assert {"workshop/cam.step", "workshop/contour.dxf", "fields/stress.vtkhdf"} <= set(other)
    again = json.loads((straight / "run.json").read_text())
    files = {name: value for name, value in summary["files"].items() if name not in pages}
    clocks = {"timings_s": 0, "started": 0}
    assert summary | clocks | {"files": files} == again | clocks


def test_page_says_what_finite_elements_add_to_hertz(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    """The range of the columns of the cycle, by the bending of the ring to 0.02 % of p0."""
    _, out, summary = finished
    files = RunFiles(out)
    assert not summary["load_ends"]
    columns = files.columns("5_cycle.csv")
    hertz, elements = (columns[f"p0_{name}_MPa"] for name in ("hertz", "fe"))
    change = 100.0 * (elements / hertz - 1.0)[hertz > 0]
    record = json.loads((out / "trial_1" / "trial.json").read_text())["hertz_difference"]
    np.testing.assert_allclose(record["p0"], [change.min(), change.max()], atol=1e-6)
    np.testing.assert_allclose(record["ring of the roller"], record["p0"], atol=0.02)
    assert max(np.abs(record["cam"] + record["rest"])) < 0.02
    low, high = (f"{value:.2f}".replace("-", "\N{MINUS SIGN}") for value in record["p0"])
    page = (out / "8_report.html").read_text(encoding="utf-8").replace("\xa0", " ")
    words = f"finite elements change p0 of Hertz theory by {low} to {high} %: bending of the ring"
    assert page.count(words) == 3


def test_sheet_and_drawing_are_one_page_each_without_text_on_text(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    _, out, summary = finished
    for name, wanted in (
        ("8_signoff.pdf", ("FAIL", "Prepared", "Approved", "Lubricant", "Partnumber")),
        ("workshop/drawing.pdf", ("⌀17H7", "5JS9", "Revision", "350°", "Hardness")),
    ):
        (page,) = printed_text.pages(out / name)
        assert printed_text.covered(page) == []
        words = printed_text.words_on(page)
        assert run_reader.results_sha256(summary["files"]) in words
        assert [text for text in wanted if text not in words] == []


def test_records_keep_their_schemas(finished: tuple[Case, Path, dict[str, Any]]) -> None:
    _, out, _ = finished
    for name, file in (
        ("run", "run.json"),
        ("trial", "trial_1/trial.json"),
        ("checks", "trial_1/6_checks.json"),
        ("signoff", "signoff.json"),
    ):
        document = json.loads((out / file).read_text(encoding="utf-8"))
        assert schema_errors(name, document) == []
        if name != "checks":
            short = {key: value[:2] if isinstance(value, list) else value
                     for key, value in document.items()}  # fmt: skip
            assert keeps_schema(name, short)
            for key in short:
                lacking = {other: value for other, value in short.items() if other != key}
                assert not keeps_schema(name, lacking), f"{file} without {key}"
                other = short | {key: object_of_another_type(short[key])}
                assert not keeps_schema(name, other), f"{file}: {key}"
            assert not keeps_schema(name, short | {"further": 1})
            if "files" in short:
                assert not keeps_schema(name, short | {"files": {"run.json": "12"}})


def object_of_another_type(value: object) -> object:
    return 7 if isinstance(value, (str, dict, list)) or value is None else "seven"


def test_a_run_of_the_library_has_its_live_preview(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    """Written without a command; it is the one of the finished run, and signed with it."""
    _, out, summary = finished
    assert "live preview" in summary["timings_s"]
    assert schema_errors("live", json.loads((out / run_reader.LIVE).read_text())) == []
    assert list(live_differences(out)) == []
    assert run_reader.LIVE in json.loads((out / "signoff.json").read_text())["files"]


def test_run_folder_holds_what_was_promised(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    case, out, summary = finished
    assert summary == json.loads((out / "run.json").read_text())
    assert set(run_reader.HEADLINE) <= set(summary["headline"])
    assert all(value is not None for value in summary["headline"].values())
    stages = {"torque", "lift and contour", "mesh", "cycle", "checks", "report", "total"}
    assert stages <= set(summary["timings_s"])
    assert datetime.fromisoformat(summary["started"]).tzinfo == UTC
    assert summary["input_sha256"] == case.sha256
    assert summary["mesh_quality"]["edges_across_half_width"] >= 7.9
    for name in ("case.toml", "1_torque.csv", "8_report.html", "fields/stress.vtkhdf",
                 "fields/view_stress.py", "fields/turn.npz",
                 "trial_1/5_guides.npz", "scene.html"):  # fmt: skip
        assert (out / name).stat().st_size > 0, name
    assert not [entry.name for entry in out.iterdir() if entry.name.startswith(".")]
    found = run_reader.read_run(out)
    cycle = found.final.cycle
    assert len(cycle) == 3 * POSITIONS
    assert {"torque_after_Nm", "shear_range_MPa", "bore_stress_MPa"} <= set(cycle.columns)
    assert cycle.load_cases == ("idle", "standstill", "over-speed")


def test_every_array_of_the_run_is_documented(finished: tuple[Case, Path, dict[str, Any]]) -> None:
    case, out, _ = finished
    page = (Path(__file__).parents[2] / "docs" / "run-folder.md").read_text(encoding="utf-8")
    table = page.partition("<!-- table: arrays -->")[2].partition("<!-- end -->")[0]
    listed: dict[str, set[str]] = {}
    for name, file in re.findall(r"^\| `([\w.]+)` \| `([\w/]+\.npz)` \|", table, re.MULTILINE):
        listed.setdefault(Path(file).name, set()).add(name.removeprefix("LOAD_CASE."))
    made: dict[str, set[str]] = {}
    for path in sorted(out.rglob("*.npz")):
        with np.load(path, allow_pickle=False) as stored:
            keys = {key.rpartition(".")[2] for key in stored.files}
        made.setdefault(path.name, set()).update(keys)
    by_fatigue_limits = {"crossland_MPa", "dang_van_MPa"}
    if case.cam.material.fatigue_bending is None:
        listed["5_envelope.npz"] -= by_fatigue_limits
    if case.follower.pivot is None:
        del listed["5_pivot.npz"]
    assert made == listed


@pytest.mark.parametrize("name", RECOMPUTED)
def test_demands_by_the_files_of_the_run(out: Path, name: str) -> None:
    """Each by a formulation of its own, see `run_recomputed`."""
    function, relative, absolute = RECOMPUTED[name]
    run = RunFiles(out)
    demand = run.checks[name]["demand"]
    assert function(run) == pytest.approx(demand, rel=relative, abs=absolute)


def test_certified_stresses_are_those_of_hertz(out: Path) -> None:
    """Peaks below a line contact on a half-plane of nu = 0.3; real bodies within 3 %."""
    (point,) = RunFiles(out).record["certificate"]
    p0 = point["p0_hertz_MPa"]
    for name, share in (("p0", 1.0), ("tau_max", 0.300), ("von_mises", 0.558)):
        assert point[f"{name}_MPa"]["extrapolated"] == pytest.approx(share * p0, rel=0.03), name


def test_benchmarks_by_quadrature(out: Path) -> None:
    """Contacts solved by elements against the singular integral equation of the half-plane."""
    run, steel, soft = RunFiles(out), 210e9, 70e9
    own = 1e-3 * run.value("roller.radius")
    for name, radius, side, moduli, load in (
        ("nafems", 0.05, 0.2, (soft, steel), 35e6),
        ("hertz", own, 4.0 * own, (steel, steel), 1e5),
    ):
        p0, half_width, _ = contact_benchmarks.disc_on_block(radius, side, moduli, load)
        modulus = 1.0 / sum((1.0 - 0.3**2) / young for young in moduli)
        wanted = line_contact_by_quadrature(load, radius, modulus)
        worst = max(abs(half_width / wanted[0] - 1.0), abs(p0 / wanted[1] - 1.0))
        # the published half-width of NAFEMS has three digits
        check = run.checks[f"benchmark_{name}"]
        assert check["demand"] == pytest.approx(
            100.0 * worst, abs=0.1 if name == "nafems" else 1e-3
        )


def test_case_file_in_the_folder_repeats_the_run(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    case, out, _ = finished
    assert read_case(out / "case.toml").sha256 == case.sha256


def test_published_design_fails_where_it_must(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    _, out, summary = finished
    found = run_reader.read_run(out)
    first = {check["id"]: check for check in found.trials[0].checks}
    for name in ("roller_static", "pressure_angle", "guide_pv_A", "shakedown"):
        assert first[name]["status"] == "fail", name
    assert summary["verdict"] == "fail"
    assert "roller_static" in summary["binding"]
    assert "roller_static" in summary["statement"]
    assert summary["trials"] <= 6
    last = {check["id"]: check for check in found.final.checks}
    assert last["torque_reduction"]["status"] == "pass"
    assert last["certificate_spread"]["status"] == "pass"
    # Cardoso et al. (2025): the design is in the range its reconstruction leaves open.
    assert 25.0 < first["pressure_angle"]["limit"] < first["pressure_angle"]["demand"] < 48.0


def test_columns_agree_with_one_another(finished: tuple[Case, Path, dict[str, Any]]) -> None:
    case, out, summary = finished
    cycle = run_reader.read_run(out).final.cycle.of_load_case("idle")
    # Hertz from the columns themselves: E* of steel on steel, 1/R = 1/r_r + 1/r_c.
    modulus = 210e3 / (2 * (1 - 0.3**2))
    radius = 1 / (1 / 8.0 + 1 / cycle["contour_radius_of_curvature_mm"])
    p0 = np.sqrt(cycle["line_load_N_per_mm"] * modulus / (np.pi * radius))
    np.testing.assert_allclose(cycle["p0_hertz_MPa"], p0, rtol=1e-9)
    # The finite elements are their own. The bearing's outer ring yields on its balls, and so is
    # pressed less than the solid roller of the next test, by at most 0.35 per cent on this cam.
    share = cycle["p0_fe_MPa"] / p0
    assert (share > 1 - 3.5e-3).all()
    assert (share < 1).all()
    after = cycle["torque_before_Nm"] - cycle["cam_torque_Nm"] / case.mechanism.gear_ratio
    np.testing.assert_allclose(cycle["torque_after_Nm"], after, atol=1e-9)
    assert summary["headline"]["torque_std_after_Nm"] == pytest.approx(after.std(), rel=1e-9)


def test_a_solid_roller_is_pressed_as_hertz_says(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    """The same cam under the same forces: on so large a relative radius bodies add little."""
    case, _, _ = finished
    machine = machines(case)[0]
    bearing = replace(case.roller.bearing, ring=None)
    solid = replace(machine, follower=replace(case.roller, bearing=bearing))
    pair = contact_pair(solid, case.contour(cam_lift(case, engine_torques(case))))
    theta = uniform_turn(24)
    contact = two_scale_history(pair, CycleBodies.meshed(pair), theta, np.full(theta.size, 900.0))
    np.testing.assert_allclose(contact.p0, contact.p0_hertz, rtol=2e-3)


def test_pressure_of_every_position_carries_the_load(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    _, out, _ = finished
    cycle = run_reader.read_run(out).final.cycle
    with np.load(out / "trial_1" / "5_pressure.npz") as stored:
        assert stored["contact_pressure_MPa"].shape == stored["distance_from_contact_mm"].shape
    with np.load(run_reader.read_run(out).final.path / "5_pressure.npz") as stored:
        carried = np.trapezoid(
            stored["contact_pressure_MPa"], stored["distance_from_contact_mm"], axis=1
        )
        assert (stored["contact_pressure_MPa"] >= 0).all()
        # The end knots carry nothing, so straight lines between the knots hold it all.
        np.testing.assert_allclose(carried, cycle["line_load_N_per_mm"], rtol=1e-9)


def test_map_of_the_turn_agrees_with_the_angles(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    """Worst stress of the swept load within 1 % of that at the worst angle, and where it is."""
    _, out, _ = finished
    trial = run_reader.read_run(out).final
    worst = json.loads((trial.path / "trial.json").read_text())["rolling"]
    name = "idle"
    assert set(worst) == {name, "standstill", "over-speed"}
    with np.load(trial.path / "5_envelope.npz") as stored:
        for column, key in (("von_mises_MPa", "von_mises"), ("shear_range_MPa", "shear_range")):
            map_ = stored[f"{name}.{column}"]
            along = trial.cycle.of_load_case(name)[column]
            assert map_.max() == pytest.approx(along.max(), rel=1e-2)
            assert worst[name][key]["value_MPa"] == pytest.approx(map_.max())
        assert stored[f"{name}.depth_mm"].shape == map_.shape
    # The load is swept: the map may find more than the angles, never much less.
    assert worst[name]["bore"]["von_mises_MPa"] == pytest.approx(
        trial.cycle.of_load_case(name)["bore_stress_MPa"].max()
    )


def test_report_can_be_rebuilt_from_the_folder(
    finished: tuple[Case, Path, dict[str, Any]],
) -> None:
    _, out, _ = finished
    page = (out / "8_report.html").read_text(encoding="utf-8")
    assert "FAIL" in page
    # The bundled plotting library names addresses; nothing on the page may fetch one.
    assert not re.search(r"(?i)<(link|script|img|iframe)[^>]+(href|src)\s*=\s*.?https?:", page)
    assert "default-src 'none'" in page


def test_folder_of_another_case_is_refused(
    finished: tuple[Case, Path, dict[str, Any]], tmp_path: Path
) -> None:
    _, out, summary = finished
    other = small(tmp_path, preload='"250 N"')
    with pytest.raises(ResultError, match="holds the run of"):
        run_case(other, out, progress=Silent())
    assert json.loads((out / "run.json").read_text()) == summary


@pytest.mark.slow
def test_undercut_is_a_verdict(tmp_path: Path) -> None:
    case = small(tmp_path, radius='"20 mm"', prime_radius='"34 mm"')
    text = (tmp_path / "case.toml").read_text().replace('kind = "moving_average"', 'kind = "none"')
    (tmp_path / "case.toml").write_text(text)
    case = read_case(tmp_path / "case.toml")
    summary = drawn_run(case, tmp_path / "out", progress=Silent()).summary
    assert summary["verdict"] == "fail"
    assert "undercut" in summary["binding"]
    assert "contact_pressure" in summary["binding"], "an unknown contact must not pass"
    assert summary["headline"]["p0_max_MPa"] is None
    found = run_reader.read_run(tmp_path / "out")
    assert np.isnan(found.final.cycle["p0_fe_MPa"]).all()
    assert (tmp_path / "out" / "8_report.html").is_file()


def test_a_run_may_begin_at_the_lift(tmp_path: Path) -> None:
    """An eccentric: its curvature, and with it the relative radius, is that of a circle."""
    base, eccentricity = 30e-3, 6e-3
    angle = np.arange(0.0, 360.0, 2.0)
    along = eccentricity * np.cos(np.radians(angle))
    across = eccentricity * np.sin(np.radians(angle))
    radius = base + eccentricity
    lift = along + np.sqrt(radius**2 - across**2) - base
    rows = "\n".join(f"{a},{1e3 * s!r}" for a, s in zip(angle, lift.tolist(), strict=True))
    (tmp_path / "lift.csv").write_text(f"cam_angle_deg,lift_mm\n{rows}\n")
    case = small(tmp_path, prime_radius='"30 mm"', positions="36")
    text = (tmp_path / "case.toml").read_text()
    engine = re.search(r"(?ms)^\[engine\]\n.*?^\[mechanism\]", text)
    assert engine is not None
    text = text.replace(engine.group(), '[lift]\nfile = "lift.csv"\n\n[mechanism]')
    (tmp_path / "case.toml").write_text(text)
    case = read_case(tmp_path / "case.toml")
    run = run_case(case, tmp_path / "out", jobs=1, progress=Silent(), depth=Tier.CYCLE)
    summary = run.summary
    assert not (tmp_path / "out" / "1_torque.csv").exists()
    assert summary["headline"]["torque_std_before_Nm"] is None
    cycle = run_reader.read_run(tmp_path / "out").final.cycle
    assert "torque_before_Nm" not in cycle
    np.testing.assert_allclose(cycle["pitch_radius_of_curvature_mm"], 1e3 * radius, rtol=1e-6)
