"""A torque without ripple: one line by its key, in every command that balances it."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import engine_torques, require_ripple
from camwright.pipeline.checks.check import BOUNDLESS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.run import run_case

DATA = Path(__file__).parents[1] / "data" / "strangers" / "constant-torque"
REFUSED = (
    "engine.file = a constant torque of 5 N m, must be one that varies over the cycle, for"
    " smoothing.kind = constrained: there is no ripple to balance"
)
COMMANDS = {
    "check": ("check", "const.toml"),
    "run": ("run", "const.toml", "--out", "run", "--depth", "preview"),
    "parts": ("design", "parts", "const.toml", "--out", "redesigned.toml"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for file in DATA.iterdir():
        shutil.copy(file, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def with_smoother(kind):
    text = (DATA / "const.toml").read_text(encoding="utf-8")
    head, _, rest = text.partition("[smoothing]\n")
    return f'{head}[smoothing]\nkind = "{kind}"\n\n' + rest[rest.index("# --- Requirements") :]


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_that_balances_it_refuses_it_in_one_line(folder, command, name):
    code, _, errors = command(*COMMANDS[name])
    assert code == 2
    assert errors.strip().splitlines()[-1] == f"camwright: {REFUSED}"


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("kind", ["none", pytest.param("moving_average", marks=pytest.mark.slow)])
def test_without_a_synthesis_the_cam_is_round(folder, kind):
    """No ripple before and none after: its reduction is not evaluated."""
    (folder / "round.toml").write_text(with_smoother(kind))
    trial = preview_case(read_case(folder / "round.toml"))
    assert np.ptp(trial.contour.pitch.lift(np.linspace(0.0, 6.0, 50))) < 1e-12
    (reduction,) = (each for each in trial.checks if each.id == "torque_reduction")
    assert reduction.status == "not_evaluated"


@pytest.mark.slow
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_run_of_a_round_cam_can_be_read(folder):
    """Its pin bears a constant load: a fatigue safety factor without bound, 1e12 in the record,
    which was null and refused as marked better than its numbers."""
    case = read_case(_round(folder)).with_positions(36)
    run_case(case, folder / "run", depth=Tier.PREVIEW)
    (trial,) = read_run(folder / "run").trials
    (pin,) = (each for each in trial.checks if each["id"] == "roller_pin_fatigue")
    assert (pin["demand"], pin["status"]) == (BOUNDLESS, "pass")


def _round(folder):
    (folder / "round.toml").write_text(with_smoother("none"))
    return folder / "round.toml"


def test_a_design_from_its_table_is_refused_by_its_column(folder, command):
    code, _, errors = command(
        "design", "machine", "d.csv", "--speed", "1500 rpm", "--out", "case.toml"
    )
    assert code == 2
    assert "d.csv, torque_Nm = constant, 5 N m, must be a torque that varies" in errors


@pytest.mark.parametrize("level", [5.0, 0.0, -1e4])
def test_whatever_its_level(folder, level):
    rows = "".join(f"{angle},{level}\n" for angle in range(0, 720, 2))
    (folder / "d.csv").write_text("crank_angle_deg,torque_Nm\n" + rows)
    with pytest.raises(InputError, match=re.escape(f"torque of {level:.4g} N m, must")):
        preview_case(read_case(folder / "const.toml"))


def varying(folder, case_lines):
    """A case whose second load case has the constant torque."""
    angle = np.arange(720)
    torque = 30.0 * np.sin(np.radians(angle)) + 10.0 * np.sin(np.radians(0.5 * angle))
    rows = "".join(f"{a},{t:.9g}\n" for a, t in zip(angle, torque, strict=True))
    (folder / "v.csv").write_text("crank_angle_deg,torque_Nm\n" + rows)
    text = (DATA / "const.toml").read_text(encoding="utf-8").replace('"d.csv"', '"v.csv"')
    text += '\n[[load_case]]\nname = "held"\nspeed = "1200 rpm"\ntorque = "d.csv"\n' + case_lines
    (folder / "two.toml").write_text(text)
    return read_case(folder / "two.toml")


@pytest.mark.parametrize(
    "lines", ["", "ripple_weight = 0.5\n", "ripple_weight = 0\ntorque_reduction = 0.3\n"]
)
def test_one_of_several_load_cases_is_refused_by_its_own_key(folder, lines):
    with pytest.raises(InputError, match=r"load_case\[1\]\.torque = a constant torque of 5 N m"):
        preview_case(varying(folder, lines))


def test_a_load_case_that_counts_for_nothing_may_be_constant(folder):
    case = varying(folder, "ripple_weight = 0\n")
    torques = engine_torques(case)
    assert np.ptp(torques["held"].total) == 0.0
    require_ripple(case, torques)


@pytest.mark.parametrize("edges", [1, 2])
def test_the_torque_of_an_even_speed_is_constant_within_round_off(folder, edges):
    """Edges at equal times: a speed without ripple, and no torque."""
    times = np.arange(8 * 36 * edges) * 2.0**-8 / edges
    (folder / "t.csv").write_text("time_s\n" + "".join(f"{t!r}\n" for t in times.tolist()))
    engine = f'kind = "speed"\nfile = "t.csv"\nedges = {edges}\n'
    engine += '\n[crankshaft]\ninertia = "0.01 kg m^2"\n'
    text = (DATA / "const.toml").read_text(encoding="utf-8")
    text = text.replace('kind = "table"\nfile = "d.csv"\n', engine)
    case = parse_case(text, folder)
    with pytest.raises(InputError, match=r"engine\.file = a constant torque of"):
        require_ripple(case, engine_torques(case))
