"""Runs by finite elements on a gas or torsion spring, and under a force of the machine."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.template import first_case
from camwright.pipeline.commands.run_command import run
from camwright.pipeline.commands.terminal import PASSED

GAS = """kind = "gas"

[spring.gas]
card = "nitrogen_20x25"
pressure = "50 bar"
temperature = "45 degC"
"""
TORSION = """kind = "torsion"

[spring.torsion]
moment = "77 N m"
angular_rate = "484 N m/rad"
arm = "66 mm"
arm_angle = "-10 deg"
wire_diameter = "14 mm"
mean_diameter = "90 mm"
tensile_strength = "1600 MPa"
stress_range = "700 MPa"
source = "made up"
"""


def case_on(folder: Path, spring: str, load: str) -> Path:
    """The first case with another spring, "" for its own, and keys of its follower."""
    text = first_case("loaded").text
    head, rest = text.split("[spring]")
    if spring:
        rest = '\ntravel_max = "18 mm"\n' + spring + rest[rest.index("\n[cam]") :]
    mass = 'mass = "1.1 kg"'
    assert mass in rest
    path = folder / "loaded.toml"
    path.write_text(head + "[spring]" + rest.replace(mass, f"{mass}\n{load}"), encoding="utf-8")
    theta = np.arange(0.0, 360.0, 10.0)
    force = 100.0 + 80.0 * np.sin(np.radians(theta))
    rows = [f"{angle:g},{each:.6f}" for angle, each in zip(theta, force, strict=True)]
    (folder / "force.csv").write_text("\n".join(["cam_angle_deg,force_N", *rows]), encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spring", "load", "own", "words", "failing"),
    [
        # A gas spring is not made for 1650 strokes per minute.
        (GAS, "", "gas_", "Spring force over the travel", {"gas_heating", "gas_stroke_rate"}),
        (TORSION, "", "torsion_", "Spring force over the travel", set()),
        ("", 'external_force_file = "force.csv"\ngravity_angle = "180 deg"', "spring_",
         "Applied: weight and external force", set()),
    ],
    ids=["gas", "torsion", "force"],
)  # fmt: skip
def test_a_run_is_judged_by_the_checks_of_its_spring(
    tmp_path: Path, spring: str, load: str, own: str, words: str, failing: set[str]
) -> None:
    """Of all three only the checks of the spring at hand; the page shows its force."""
    folder = tmp_path / "run"
    assert run(case_on(tmp_path, spring, load), out=folder, jobs=1) == PASSED
    verdict = json.loads((folder / "run.json").read_text(encoding="utf-8"))["verdict"]
    assert verdict == ("fail" if failing else "pass")
    records = json.loads((folder / "trial_1" / "6_checks.json").read_text(encoding="utf-8"))
    must = (each for each in records if each["must_have"])
    assert {each["id"] for each in must if each["status"] == "fail"} == failing
    kinds = {"gas_", "torsion_", "spring_"}
    names = {each["id"] for each in records} - {"spring_travel"}
    assert {kind for kind in kinds if any(name.startswith(kind) for name in names)} == {own}
    assert words in (folder / "8_report.html").read_text(encoding="utf-8")
