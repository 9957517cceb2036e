"""Long stems in stiff bushes: cases whose guides are solved at every tolerance corner."""

from __future__ import annotations

from pathlib import Path

import pytest

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.tolerance_corners import outcomes
from camwright.pipeline.smoothing.required_lift import cam_lift

CASES = Path(__file__).parents[1] / "data" / "strangers" / "05-shm-imperial"


@pytest.mark.parametrize("name", ["bronze_spacing_300", "case3"])
def test_every_tolerance_corner_is_solved(name: str) -> None:
    case = read_case(CASES / f"{name}.toml")
    torques = engine_torques(case)
    contour = case.contour(cam_lift(case, torques))
    tried = outcomes(case, machines(case, torques), contour, declarations=())
    assert len(tried) == 29
    assert not [one.refused for one in tried if one.refused]
