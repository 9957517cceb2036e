"""Machines that no engineer would refuse, and what in each looks like a fault."""

from dataclasses import replace
from pathlib import Path

import pytest

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case

FINE = Path(__file__).resolve().parents[1] / "data" / "fine"


WITHOUT_DATA = {"bearing_gap", "machine_shaft_gap"}
"""Their cases state neither the width of the bearings nor the shaft of the machine."""


def blocking(checks):
    return {each.id for each in checks.values() if each.blocks and not each.judged_at}


def checked(name):
    case = read_case(FINE / f"{name}.toml")
    return {each.id: each for each in preview_case(case, corners=False).checks}


def test_a_thin_film_in_the_bearing_counts_by_its_life():
    """kappa of 0.24: seven times the life that is required by the modified life of ISO 281."""
    checks = checked("thin_film")
    assert checks["bearing_lubrication"].status == "pass"
    assert checks["bearing_lubrication"].demand == pytest.approx(0.24, abs=0.01)
    life = checks["roller_modified_life"]
    assert life.demand > 7.0 * life.limit
    assert blocking(checks) == WITHOUT_DATA


def test_the_sweep_decides_on_surge():
    """11 times the frequency of the cam, where a rule of thumb wants 13; the contact holds."""
    checks = checked("surge_within_sweep")
    assert checks["spring_surge"].demand == pytest.approx(11.1, abs=0.1)
    assert not checks["spring_surge"].blocks
    for name in ("contact_over_speed", "spring_fatigue", "spring_stress"):
        assert checks[name].must_have and checks[name].status == "pass", name


def test_the_key_of_a_sliding_fit_carries_the_torque():
    checks = checked("sliding_fit")
    assert "cam_slip" not in checks
    for name in ("key_pressure", "key_pressure_shaft", "key_shear"):
        assert checks[name].must_have and checks[name].utilisation < 0.5, name
    assert blocking(checks) == WITHOUT_DATA


def test_a_wide_profile_is_no_wave():
    """A ground profile of 25 um has waves of 4 um at 5 mm; cut by laser it has waves of 25 um."""
    check = checked("ground_profile")["profile_waviness"]
    assert check.status == "pass"
    assert check.note.endswith("waves of 4 um over 5 mm")
    ground = read_case(FINE / "ground_profile.toml")
    cut = ground.model_copy(update={"cam": replace(ground.cam, process="cut")})
    of_cut = {each.id: each for each in preview_case(cut, corners=False).checks}["profile_waviness"]
    assert of_cut.status == "fail"
    assert of_cut.demand == pytest.approx(25.0 / 4.0 * check.demand, rel=1e-9)
