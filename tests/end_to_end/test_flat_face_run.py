"""A flat face from the command line: one run folder, its pictures, deck and inspection."""

import csv
import io
import math
import re
import signal
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from camwright.pipeline import cli
from camwright.pipeline.results.run_reader import read_run

CASE = Path(__file__).resolve().parents[2] / "cases" / "papers" / "petrescu_c.toml"


def camwright(*arguments):
    """Exit code and all that is said, in this process."""
    said, handler = io.StringIO(), signal.getsignal(signal.SIGTERM)
    argv = ["camwright", *map(str, arguments)]
    try:
        with (
            mock.patch.object(sys, "argv", argv),
            redirect_stdout(said),
            redirect_stderr(said),
            pytest.raises(SystemExit) as leaving,
        ):
            cli.main()
    finally:
        signal.signal(signal.SIGTERM, handler)
    return int(leaving.value.code or 0), said.getvalue()


def case_text():
    """The published case, small."""
    return CASE.read_text() + "\n[solver]\npositions = 36\ncertificate_positions = 1\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("flat")
    (place / "flat.toml").write_text(case_text())
    code, said = camwright("run", place / "flat.toml", "--out", place / "run", "--jobs", 1)
    assert code == 0, said
    return place / "run"


def test_run_tells_of_a_face(folder):
    run = read_run(folder)
    cycle = run.final.cycle
    slope = 6.0 * np.sin(np.radians(2.0 * cycle["cam_angle_deg"])) * (cycle["cam_angle_deg"] < 180)
    np.testing.assert_allclose(cycle["face_contact_offset_mm"], slope, atol=0.02)
    assert (cycle["pressure_angle_deg"] == 0.0).all()
    np.testing.assert_allclose(cycle["side_force_N"], 0.08 * cycle["normal_force_N"])
    assert cycle["sliding_speed_m_per_s"].min() > 0
    assert np.abs(cycle["p0_fe_MPa"] / cycle["p0_hertz_MPa"] - 1).max() < 5e-3
    checks = {check["id"]: check for check in run.final.checks}
    for name in ("undercut", "face_width", "certificate_spread", "guide_equilibrium_moment",
                 "friction_balance", "contact_work", "contact_equilibrium"):  # fmt: skip
        assert checks[name]["status"] == "pass", name
    # The harmonic law jumps in curvature at 0 and 180 deg: there the pressure is lopsided.
    assert checks["contact_torque"]["status"] == "fail"
    assert checks["contact_torque"]["cam_angle_deg"] == 0.0
    assert checks["contact_torque"]["demand"] < 3e-3
    assert checks["face_pv"]["status"] == "not_evaluated"
    assert not {"pressure_angle", "roller_static", "traction_demand"} & set(checks)


def test_files_and_page_show_a_face(folder):
    mesh = (folder / "trial_1" / "4_mesh.msh").read_text(errors="replace")
    assert all(f'"{name}"' in mesh for name in ("cam", "face", "face_top", "face_stem"))
    assert "roller" not in mesh
    page = (folder / "8_report.html").read_text()
    figures = set(re.findall(r'<figure id="([a-z-]+)">', page))
    assert {"outline", "face"} <= figures
    assert "pressure-angle" not in figures
    assert "Contact on the face" in page
    assert "von Mises stress below the face" in page
    assert (folder / "workshop" / "cutter.csv").exists()


def test_deck_and_check_know_the_face(folder, tmp_path):
    code, said = camwright(
        "contact", "deck", folder, "--angle", "45", "--out", tmp_path / "contact.inp"
    )
    assert code == 0, said
    assert "the bore and the face's stem are held" in (tmp_path / "contact.inp").read_text()
    code, said = camwright("check", folder, "--all")  # as published, it does not pass
    assert code == 1, said
    assert "Required face width" in said


@pytest.mark.slow
def test_measured_cam_is_judged_under_the_face(folder, tmp_path):
    """Three waves of 4 um along the normal are found, but for what the phase takes of them."""
    rows = list(csv.DictReader((folder / "workshop" / "inspection.csv").read_text().splitlines()))
    lines = ["x_mm,y_mm"]
    for row in rows[::4]:
        off = 0.004 * math.cos(3 * math.radians(float(row["cam_angle_deg"])))
        x, y = (float(row[f"nominal_{c}_mm"]) + off * float(row[f"normal_{c}"]) for c in ("x", "y"))
        lines.append(f"{x},{y}")
    (tmp_path / "part.csv").write_text("\n".join(lines))
    code, said = camwright("inspect", folder, tmp_path / "part.csv")
    assert code == 1, said
    assert 3.0 < float(re.search(r"\b3: ([\d.]+) um", said)[1]) < 4.0


def sharp_cam():
    """The flat cam with a lift that bends more than its base circle makes up for."""
    text = case_text().replace('stroke = "6 mm"', 'stroke = "10 mm"')
    text = text.replace('stroke = "-6 mm"', 'stroke = "-10 mm"').replace('"16 mm"', '"30 mm"')
    return text.replace('"13 mm"', '"8 mm"').replace('bore_radius = "6 mm"', 'bore_radius = "3 mm"')


def third_cam():
    """The published cam B3 under its roller."""
    return CASE.with_name("petrescu_b3.toml").read_text() + "\n[solver]\npositions = 36\n"


@pytest.mark.slow
@pytest.mark.parametrize("cam", [sharp_cam, third_cam])
def test_undercut_is_a_verdict_of_the_run(tmp_path, cam):
    (tmp_path / "cut.toml").write_text(cam())
    code, said = camwright("run", tmp_path / "cut.toml", "--out", tmp_path / "run")
    assert code == 0, said
    run = read_run(tmp_path / "run")
    checks = {check["id"]: check for check in run.final.checks}
    assert run.verdict == "fail"
    for name in ("undercut", "self_intersection", "second_contact"):
        assert checks[name]["status"] == "fail", name
    assert checks["undercut"]["demand"] < 0
    assert "undercut" in run.summary["binding"]
    assert np.isnan(run.final.cycle["p0_fe_MPa"]).all()
    page = (tmp_path / "run" / "8_report.html").read_text()
    assert "Machine motion of the valve cam" in page
    assert "reconstructed" in page
    assert "no efficiency" in page


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('width = "16 mm"', 'width = "11.9 mm"',
         "follower.face.width = 11.9 mm, must be > 12 mm, twice the greatest |s' - cam.off"),
        ('stroke = "-6 mm"', 'stroke = "-5 mm"',
         "lift.segment.stroke = 1 mm in all, must be 0 mm in all: the lift must close"),
        ('angle = "180 deg"', 'angle = "170 deg"', "lift.segment.angle = 350 deg in all, must be"),
        ('bore_radius = "6 mm"', 'offset = "13.1 mm"\nbore_radius = "6 mm"',
         "cam.offset = 13.1 mm, must be smaller than cam.prime_radius = "),
    ],
    ids=["face too narrow", "does not close", "no turn", "offset too great"],
)  # fmt: skip
def test_bad_input_is_one_line_and_nothing_is_written(tmp_path, old, new, message):
    text = case_text()
    assert old in text
    (tmp_path / "bad.toml").write_text(text.replace(old, new, 1))
    code, said = camwright("run", tmp_path / "bad.toml", "--out", tmp_path / "run")
    assert code == 2
    assert said.startswith(f"camwright: {message}")
    assert said.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]
