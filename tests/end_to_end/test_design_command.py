"""`camwright design`: a torque table to a case that passes, or its relaxation, which passes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.commands.design_command import design
from camwright.pipeline.commands.terminal import FAILED, PASSED

pytestmark = pytest.mark.slow


def piston_pump(folder: Path) -> Path:
    """Torque of a piston pump: 25 mm bore, 40 mm stroke, 15 bar, rod of infinite length."""
    angle = np.arange(0.0, 360.0, 3.0)
    sine = np.sin(np.radians(angle))
    delivers = 0.5 - 0.5 * np.tanh(sine / 0.08)
    torque = 15e5 * delivers * 0.25 * np.pi * 0.025**2 * 0.02 * sine
    path = folder / "pump.csv"
    rows = [f"{a:g},{t:.6g}" for a, t in zip(angle, torque, strict=True)]
    path.write_text("\n".join(["shaft_angle_deg,torque_Nm", *rows]) + "\n", encoding="utf-8")
    return path


def test_a_pump_passes_by_finite_elements(tmp_path: Path) -> None:
    """The chosen case is run; its points and picture are beside it, and a repetition is equal."""
    table, out = piston_pump(tmp_path), tmp_path / "pump.toml"
    assert design(table, "150 rpm", out, run=True) == PASSED
    record = (tmp_path / "pump_design" / "design.json").read_text(encoding="utf-8")
    document = json.loads(record)
    assert document["chosen"]["removed"] >= 0.5
    sizes = [row["size_mm"] for row in document["points"]]
    assert sizes == sorted(sizes)
    assert (tmp_path / "pump_design" / "design.png").read_bytes().startswith(b"\x89PNG")
    text = out.read_text(encoding="utf-8")
    assert 'overspeed = "assumed' in text
    assert design(table, "150 rpm", out) == PASSED  # from the cached points
    assert (tmp_path / "pump_design" / "design.json").read_text(encoding="utf-8") == record
    assert out.read_text(encoding="utf-8") == text


def test_too_small_a_space_names_one_that_passes(tmp_path: Path) -> None:
    table, out = piston_pump(tmp_path), tmp_path / "small.toml"
    assert design(table, "150 rpm", out, space="70 mm") == FAILED
    record = (tmp_path / "small_design" / "design.json").read_text(encoding="utf-8")
    conflict = json.loads(record)["conflict"]
    assert conflict["limits"]
    room = next(each["to"] for each in conflict["relaxations"] if each["option"] == "--space")
    assert design(table, "150 rpm", out, space=room) == PASSED
