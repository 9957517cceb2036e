"""The redesigned GX120, under a roller and a flat face: no required check fails or lacks data."""

import json
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.run import run_case

CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.slow
def test_redesigned_case_keeps_every_limit_at_its_corners(tmp_path):
    case = read_case(CASES / "gx120-redesign.toml")
    assert {state.name for state in case.load_cases} == {"idle", "governed"}
    summary = run_case(case, tmp_path / "run", positions=180, progress=Silent()).summary
    final = read_run(tmp_path / "run").final
    open_or_failing = {each["id"] for each in final.checks if each["status"] != "pass"}
    assert open_or_failing == {"torque_reversals", "curvature_rate", "speed_reduction"}
    assert not any(each["must_have"] for each in final.checks if each["id"] in open_or_failing)
    assert summary["verdict"] == "pass", summary["binding"]
    assert not case.scope.not_covered and not case.waivers
    figures = summary["headline"]
    assert figures["torque_std_after_Nm"] <= 0.5 * figures["torque_std_before_Nm"]
    assert summary["prices"]
    trial = json.loads((tmp_path / "run" / "trial_1" / "trial.json").read_text(encoding="utf-8"))
    assert trial["smoothing_kind"] == "constrained" and trial["synthesis"]["feasible"]
    starts = trial["synthesis"]["starts"]
    assert starts["agree"] and starts["sentence"] in summary["statement"]
    limits = final.limits
    assert limits is not None
    dearest = summary["prices"][0]["limit"]
    assert limits[dearest].max() == pytest.approx(1.0, abs=3e-3)  # it binds, a reserve in hand
    assert case.roller.bearing.ring is not None  # from a card of the catalogue


@pytest.mark.slow
def test_cam_under_a_flat_face_fails_by_friction_and_heat_alone(tmp_path):
    """Certified: solved contact and guides in every load case, and the tolerance corners."""
    case = read_case(CASES / "gx120-flat-face.toml")
    summary = run_case(case, tmp_path / "run", positions=180, progress=Silent()).summary
    final = read_run(tmp_path / "run").final
    open_or_failing = {each["id"] for each in final.checks if each["status"] != "pass"}
    assert open_or_failing == {
        "torque_reversals", "curvature_rate", "speed_reduction", "film_ratio", "friction_power",
        "mechanism_temperature", "contact_temperature",
    }  # fmt: skip
    decisive = {each["id"] for each in final.checks if each["must_have"]}
    heat = {"friction_power", "mechanism_temperature", "contact_temperature"}
    assert open_or_failing & decisive == heat
    assert summary["verdict"] == "fail"
    record = final.record["synthesis"]
    assert record["feasible"] and record["starts"]["agree"]
    face = {"undercut", "face_width", "face_pv", "contact_pressure", "bore_pressure"}
    assert face <= record["utilisation"].keys()
    assert {"cam.prime_radius"} <= {each["parameter"] for each in record["machine_prices"]}
    assert not {"pressure_angle", "roller_static"} & record["utilisation"].keys()
    figures = summary["headline"]
    assert figures["torque_std_after_Nm"] <= 0.5 * figures["torque_std_before_Nm"]


@pytest.mark.slow
def test_cam_under_an_arm_keeps_every_limit_at_its_corners(tmp_path):
    """Certified, with the torque of the solved pressure on the contour against that of the arm."""
    case = read_case(CASES / "gx120-arm.toml")
    summary = run_case(case, tmp_path / "run", positions=180, progress=Silent()).summary
    final = read_run(tmp_path / "run").final
    open_or_failing = {each["id"] for each in final.checks if each["status"] != "pass"}
    assert not any(each["must_have"] for each in final.checks if each["id"] in open_or_failing)
    assert summary["verdict"] == "pass", summary["binding"]
    assert case.scope.without == ("guides", "stem")
    checks = {each["id"]: each for each in final.checks}
    assert checks["contact_torque"]["status"] == checks["contact_work"]["status"] == "pass"
    assert not {name for name in checks if name.startswith(("guide_", "jam_", "mesh_reaction"))}
    assert not (tmp_path / "run" / "trial_1" / "5_guides.npz").exists()
    headers = final.cycle.keys()
    assert not {name for name in headers if name.startswith(("guide_", "stem_slope"))}
    figures = summary["headline"]
    assert figures["torque_std_after_Nm"] <= 0.5 * figures["torque_std_before_Nm"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["feeder-groove", "tucker-groove"])
def test_a_roller_in_a_groove_passes_certified(tmp_path, name):
    """On a stem and on an arm both walls carry, within the limits of all checks, by finite elements
    as by Hertz.
    """
    case = read_case(CASES / "motions" / f"{name}.toml")
    summary = run_case(case, tmp_path / "run", progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    final = read_run(tmp_path / "run").final
    assert set(np.unique(final.cycle["wall"])) == {-1.0, 1.0}
    assert np.abs(final.cycle["p0_difference_percent"]).max() < 0.1


@pytest.mark.slow
def test_a_groove_of_two_steps_passes_certified(tmp_path):
    """Each roller carries on its own wall, by finite elements as by Hertz."""
    case = read_case(CASES.parent / "tests" / "data" / "stepped_groove.toml")
    summary = run_case(case, tmp_path / "run", positions=180, progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    final = read_run(tmp_path / "run").final
    assert set(np.unique(final.cycle["wall"])) == {-1.0, 1.0}
    assert np.abs(final.cycle["p0_difference_percent"]).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["transfer-conjugate", "pump-yoke"])
def test_two_tracks_pass_certified(tmp_path, name):
    """Both discs of a pair, both faces of a yoke carry; finite elements agree with Hertz."""
    case = read_case(CASES / "motions" / f"{name}.toml")
    summary = run_case(case, tmp_path / "run", progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    final = read_run(tmp_path / "run").final
    pushes = final.cycle["wall"] > 0.0
    for at in (pushes, ~pushes):
        assert at.any()
        assert np.abs(final.cycle["p0_difference_percent"][at]).max() < 0.1


@pytest.mark.slow
def test_a_preloaded_pair_passes_certified(tmp_path):
    """Both discs press at every angle; finite elements agree with Hertz on the disc that bears more
    and on the other.
    """
    case = read_case(CASES / "motions" / "placer-preloaded.toml")
    summary = run_case(case, tmp_path / "run", progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    cycle = read_run(tmp_path / "run").final.cycle
    assert set(np.unique(cycle["wall"])) == {-1.0, 1.0}
    assert cycle["idle_force_N"].min() > 0.0
    assert np.abs(cycle["p0_difference_percent"]).max() < 0.1
    assert cycle["idle_p0_fe_MPa"] == pytest.approx(cycle["idle_p0_hertz_MPa"], rel=1e-3)


@pytest.mark.slow
def test_a_lifter_under_its_weight_passes_certified(tmp_path):
    """The weight holds the contact all over the turn, at the over-speed, too."""
    case = read_case(CASES / "motions" / "lifter-gravity.toml")
    summary = run_case(case, tmp_path / "run", progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    final = read_run(tmp_path / "run").final
    assert final.cycle["normal_force_N"].min() > 0.0
    assert np.abs(final.cycle["spring_force_N"]).max() < 1e-6


@pytest.mark.slow
def test_an_arm_with_two_dwells_passes_certified(tmp_path):
    """15 deg of swing by the laws of its case: the contour at rest and in the dwell is round."""
    case = read_case(CASES / "motions" / "packaging-arm.toml")
    summary = run_case(case, tmp_path / "run", progress=Silent()).summary
    assert summary["verdict"] == "pass", summary["binding"]
    final = read_run(tmp_path / "run").final
    angle = final.lift["arm_angle_deg"]
    assert np.ptp(angle) == pytest.approx(15.0, abs=1e-6)
    radius = np.hypot(final.contour["contour_x_mm"], final.contour["contour_y_mm"])
    theta = final.contour["cam_angle_deg"]
    for low, high in ((112.0, 168.0), (282.0, 358.0)):
        dwell = radius[(theta > low) & (theta < high)]
        assert np.ptp(dwell) == pytest.approx(0.0, abs=1e-6)
