"""What cams that hold their follower on both sides have in common in tests."""

from __future__ import annotations

from dataclasses import replace

import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.follower.friction_coupling import guided_loads

FORCES = ("axial_force", "normal_force", "cam_torque", "friction_force_a", "reaction_a")


def assert_as_closed_by_a_strong_spring(cycle: Cycle, machine: Machine) -> None:
    """Under a strong spring the first track alone carries: forces, guides and torque to 1e-9."""
    sprung = replace(machine.spring, preload=900.0, rate=20e3)
    closed = replace(machine.system, spring=sprung, held=False, second=None)
    args = (machine.stem, machine.guides, machine.cam_speed, uniform_turn(90))
    path = cycle.contour.pitch
    plate = guided_loads(path, closed, *args)
    held = guided_loads(path, replace(closed, held=True, second=machine.cam.second), *args)
    assert not plate.loads.separated.any()
    for name in FORCES:
        plain, own = (getattr(each.loads, name) for each in (plate, held))
        assert own == pytest.approx(plain, rel=1e-9, abs=1e-9), name
