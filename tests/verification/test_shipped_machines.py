"""The machines of cases/machines: torque against their sources, cam within limits, contact."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.certificate import mesh_figures
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_reader import read_verdict
from camwright.pipeline.run import run_case

MACHINES = sorted((Path(__file__).parents[2] / "cases" / "machines").glob("*.toml"))
NAMES = [path.stem for path in MACHINES]


def machine(name: str) -> Case:
    return read_case(next(path for path in MACHINES if path.stem == name))


def test_one_case_of_each_kind_of_machine() -> None:
    assert NAMES == [
        "compressor", "dosing-pump", "hand-pump", "indexing-drive", "press", "two-stroke",
    ]  # fmt: skip


def compressor_work(clearance: float) -> float:
    """n/(n-1) p1 (V1 - V4) (r^((n-1)/n) - 1) of the numbers in compressor.toml, J."""
    low, high, n = 101.353e3, 910.108e3, 1.13
    swept = np.pi / 4 * 0.079375**2 * 0.082804
    drawn = swept * (1 + clearance - clearance * (high / low) ** (1 / n))
    return float(n / (n - 1) * low * drawn * ((high / low) ** ((n - 1) / n) - 1))


@pytest.mark.parametrize(
    ("name", "work"),
    [
        ("compressor", -compressor_work(0.05)),
        # Norton prints a mean pressure of 26 psi, rounded, for a clearance that he does not print
        (
            "compressor",
            pytest.approx(-26 * 6894.757 * np.pi / 4 * 0.079375**2 * 0.082804, rel=0.02),
        ),
        ("hand-pump", -np.pi / 4 * 0.0635**2 * 0.125 * (199.4e3 - 101.3e3)),
        ("press", -11e3 * 2e-3),
        ("indexing-drive", pytest.approx(0.0, abs=1e-6)),
    ],
    ids=["compressor", "printed", "hand-pump", "press", "indexing-drive"],
)
def test_work_of_a_turn(name: str, work: float) -> None:
    """Within the sum over 720 angles with a corner where a valve opens."""
    (torque,) = engine_torques(machine(name)).values()
    turn = 2 * np.pi * torque.mean
    assert turn == (pytest.approx(work, rel=5e-5) if isinstance(work, float) else work)


def test_flow_of_the_hand_pump() -> None:
    """Akvopedia prints 1.8 m3/h at 10 m of head."""
    case = machine("hand-pump")
    (cylinder,) = case.torque.cylinders
    flow = cylinder.displacement * case.load_cases[0].speed / (2 * np.pi)
    assert 3600 * flow == pytest.approx(1.8, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_shipped_machine_is_within_its_limits_and_its_contact_is_that_of_hertz(
    name: str,
) -> None:
    """Both bodies at the greatest pressure; what they give behind the contact is below 0.1 %."""
    trial = preview_case(machine(name), corners=False)
    assert [one.id for one in trial.checks if one.must_have and one.status == "fail"] == []
    cycle = trial.cycles[0]
    at = int(np.argmax(cycle.contact.p0))
    force = float(cycle.contact.line_load[at]) * cycle.pair.width
    solved = mesh_figures(cycle.pair, float(cycle.theta[at]), force, 8.0)
    assert solved.p0 == pytest.approx(float(cycle.contact.p0_hertz[at]), rel=1e-3)
    assert solved.residual_equilibrium < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_shipped_machine_passes_certified(name: str, tmp_path: Path) -> None:
    """At its tolerance corners, with the finite elements of its hub, which no preview has."""
    folder = tmp_path / "run"
    run_case(machine(name), folder, fields="none")
    verdict = read_verdict(folder)
    assert verdict["verdict"] == "pass", verdict
