"""Parts that cannot be are refused on the command line with the reason; a bad spring only fails."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from small_machine import small_machine

from camwright.pipeline import cli

CARD = """
[bearings.own]
name = "own"
C = "1 kN"
{rest}
speed_limit = "20000 rpm"
bore = "5 mm"
outer_diameter = "32 mm"
width = "5 mm"
source = "a test"
"""
LIFT = """
[lift]
kind = "segments"

[[lift.segment]]
law = "cycloidal"
angle = "180 deg"
stroke = "12 mm"

[[lift.segment]]
law = "cycloidal"
angle = "180 deg"
stroke = "-12 mm"

[spring.design]
wire_diameter = "6 mm"
mean_diameter = "40 mm"
coils = 8.2
free_length = "75 mm"
shear_modulus = "77.2 GPa"
density = "7850 kg/m^3"
strength_at_1mm = "1974 MPa"
strength_exponent = 0.108
"""


def camwright(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr(sys, "argv", ["camwright", *map(str, arguments)])
    with pytest.raises(SystemExit) as leaving:
        cli.main()
    return int(leaving.value.code or 0)


def moving(text: str) -> str:
    """The template with a lift instead of its engine, one trial, no torque to reduce."""
    start, stop = text.index("[engine]"), text.index("[mechanism]")
    text = text[:start] + text[stop:]
    start, stop = text.index("[smoothing]"), text.index("[limits]")
    text = text[:start] + text[stop:]
    return text.replace("max_trials = 3", "max_trials = 1") + LIFT


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            'length = "24 mm"',
            'length = "90 mm"',
            "guides.spacing = 80 mm, must be > 90 mm, half of guides.a.length = ",
        ),
        (
            'clearance = "0.05 mm"',
            'clearance = "-0.01 mm"',
            "guides.a.clearance = -0.01 mm, must be >= 0 mm: a press fit cannot slide",
        ),
        (
            'stem_diameter = "12 mm"',
            'stem_diameter = "12 mm"\nstem_length = "60 mm"',
            "or the stem leaves guide B at the largest overhang",
        ),
        (
            'overhang_at_max_lift = "30 mm"',
            'overhang_at_max_lift = "1 mm"',
            "or the roller enters guide A",
        ),
        ('name = "track roller, 32 mm"', 'card = "own"', "cards.own.C0 = missing, must be given"),
        ('name = "track roller, 32 mm"', 'card = "none"', "roller.bearing.card = none, must be"),
    ],
    ids=["guides overlap", "press fit", "short stem", "short overhang", "no C0", "no card"],
)
def test_refused_with_the_reason(monkeypatch, capsys, tmp_path: Path, old, new, said) -> None:
    monkeypatch.chdir(tmp_path)
    Path("cards.toml").write_text(CARD.format(rest=""))
    text = moving(small_machine("bad"))
    assert old in text
    Path("bad.toml").write_text(text.replace(old, new))
    assert camwright(monkeypatch, "run", "bad.toml", "--out", "out", "--positions", 36) == 2
    captured = capsys.readouterr()
    assert any(said in line for line in captured.err.splitlines())
    assert not Path("out").exists()


@pytest.mark.slow
def test_a_spring_that_goes_solid_fails_a_check(monkeypatch, capsys, tmp_path: Path) -> None:
    """With a bearing of one's own card besides: what its C0 says is in the checks."""
    monkeypatch.chdir(tmp_path)
    Path("cards.toml").write_text(CARD.format(rest='C0 = "0.5 kN"'))
    text = moving(small_machine("solid"))
    start, stop = text.index("[roller.bearing]"), text.index("[follower]")
    Path("solid.toml").write_text(text[:start] + '[roller.bearing]\ncard = "own"\n' + text[stop:])
    assert camwright(monkeypatch, "run", "solid.toml", "--out", "out", "--positions", 36) == 0
    capsys.readouterr()
    checks = {c["id"]: c for c in json.loads(Path("out/trial_1/6_checks.json").read_text())}
    assert checks["spring_solid"]["status"] == "fail"
    assert checks["spring_solid"]["demand"] < 0.0
    force = max(checks["roller_static"]["demand"], 1e-9)
    assert 500.0 / force > 400.0  # the preload at least
    assert "card own: a test" in checks["roller_static"]["source"]
    balance = json.loads(Path("out/trial_1/trial.json").read_text())["balance"]
    assert balance["unbalance_g_mm"] > 0.0
