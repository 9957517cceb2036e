"""The machine motion of the published valve cams beside their runs."""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.results.valve_train import (
    machine_motion,
    valve_cam,
    valve_record,
)
from camwright.pipeline.solver import solve
from camwright.reports.verification_tables import valve_train

PAPERS = Path(__file__).resolve().parents[2] / "cases" / "papers"
POSITIONS = 720


def text(name):
    return (PAPERS / f"petrescu_{name}.toml").read_text()


def record(given):
    case = parse_case(given)
    contour = case.contour(given_lift(case))
    turns = turns_of(machines(case), contour, POSITIONS)
    return case, machine_motion(valve_cam(case), turns)


def solved(given):
    """A trial of few positions."""
    case = parse_case(given)
    return solve(
        case, case.contour(given_lift(case)), tier=Tier.PREVIEW, positions=72, corners=False
    )


def value(found, name):
    rows = [row for row in found["rows"] if row["name"].startswith(name)]
    return rows[0]["value"]  # of the load case of the file


# Mean and maximum of the paper's eq. 6.18 over the rise, computed apart from this code.
INDICES = {
    "b1": (0.2136, 0.2974), "b2": (0.2183, 0.2932), "b3": (0.2075, 0.3010),
    "b4": (0.1843, 0.3014), "c": (0.0652, 0.1272),
}  # fmt: skip


@pytest.mark.parametrize("name", INDICES)
def test_shape_index_of_every_published_cam_to_four_digits(name):
    _, found = record(text(name))
    assert found["module"] == ("C" if name == "c" else "B")
    assert round(value(found, "Shape index, mean"), 4) == INDICES[name][0]
    assert round(value(found, "Shape index, greatest"), 4) == INDICES[name][1]


def test_flat_cam_by_hand():
    """The cosine law on a disc of 200 g: J* = m_c r_A^2/2 + m_T s'^2, half its extremes' sum."""
    case, found = record(text("c"))
    phi = np.linspace(0, np.pi / 2, 200_001)
    s, slope = 0.003 * (1 - np.cos(2 * phi)), 0.006 * np.sin(2 * phi)
    inertia = 0.1 * ((0.013 + s) ** 2 + slope**2) + 0.1 * slope**2
    mean = 0.5 * (inertia.max() + inertia.min())
    assert value(found, "Mean reduced inertia") == pytest.approx(1e6 * mean, rel=1e-6)
    shaft = np.pi * 5000 / 60
    fastest = shaft * np.sqrt(mean / inertia.min())
    assert value(found, "Shaft speed, greatest") == pytest.approx(fastest, rel=1e-6)
    assert valve_cam(case).module == "C"


def test_true_efficiency_is_one_without_friction():
    plain = text("c").replace("friction = 0.08", "#").replace("friction = 0.05", "friction = 0.0")
    free, rubbing = record(plain)[1], record(text("c"))[1]
    assert value(free, "True efficiency") == pytest.approx(1.0, abs=1e-9)
    assert 0.5 < value(rubbing, "True efficiency") < 0.9


def test_stiff_train_gives_way_as_its_spring_presses():
    """At full lift a still train gives way by the spring's force over K + k."""
    _, found = record(text("c").replace('mass = "100 g"', 'stiffness = "10 kN/mm"\nmass = "100 g"'))
    still = (4500.0 + 150e3 * 0.006) / (10e6 + 150e3)
    assert value(found, "Deflection at full lift, at rest") == pytest.approx(1e6 * still, rel=1e-9)
    printed, exact = (
        value(found, f"Deflection at full lift, {how}") for how in ("as printed", "by the quadr")
    )
    assert 0.9 < printed / exact < 1.0


def test_what_is_reconstructed_is_said_on_the_page():
    _, found = record(text("b1"))
    for row in found["rows"]:
        certain = row["name"].startswith(("Shape", "True", "Acceleration of"))
        assert ("reconstructed" in row["note"]) is not certain, row["name"]
    table = valve_train(found)
    assert len(table.rows) == len(found["rows"])
    assert any("no efficiency" in cell for cell in table.rows[0])
    assert valve_train(None).rows == []


def test_the_record_of_a_run_holds_module_and_rows_of_the_trial_s_own_turns():
    trial = solved(text("c"))
    found = valve_record(trial)
    assert found == machine_motion(valve_cam(trial.case), [cycle.turn for cycle in trial.cycles])
    assert found["module"] == "C"
    stated = trial.case.load_cases[0].name
    assert {row["load_case"] for row in found["rows"]} == {"", stated, "standstill"}


def test_a_case_that_does_not_ask_gets_nothing():
    bare = text("c").replace("[valve_train]", "#").replace("cam_mass", "#")
    assert valve_record(solved(bare)) is None
    assert valve_cam(read_case(PAPERS / "eccentric.toml")) is None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'cam_mass = "200 g"',
            'cam_mass = "-200 g"',
            r"valve_train\.cam_mass = -200 g, must be > 0",
        ),
        ('cam_mass = "200 g"', "cam_mass = 0.2", r"valve_train\.cam_mass = 0\.2, must be"),
        ('cam_mass = "200 g"', 'mass = "200 g"', r"valve_train\.mass = unknown key"),
    ],
)
def test_bad_valve_train_is_refused(old, new, message):
    with pytest.raises(InputError, match=message):
        parse_case(text("c").replace(old, new))


def test_machine_motion_asks_for_segments():
    given = (PAPERS / "eccentric.toml").read_text()
    with pytest.raises(InputError, match="valve_train = a table, must be left out unless"):
        parse_case(given + '\n[valve_train]\ncam_mass = "1 kg"\n')
