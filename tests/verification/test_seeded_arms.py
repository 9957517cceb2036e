"""Plausible arms by `camwright check`: a verdict or one clear line, in time, and no NaN shown."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
from seeded_checks import checked, faults
from swung_face import face_text

from camwright.geometry.motion_laws import LAWS
from camwright.pipeline.case.template import first_case

COUNT, QUICK, SEED = 60, 4, 44
MOVING = sorted(name for name in LAWS if name != "dwell")


def drawn(k: int) -> dict[str, Any]:
    """Tables of one arm: its follower in turn, spring and pivot by lot, its sizes at random."""
    draw = np.random.default_rng([SEED, k])
    kind = ("roller", "flat", "curved")[k % 3]
    text = first_case("swing", "arm").text if kind == "roller" else face_text(kind)
    tables = tomllib.loads(text)
    follower, cam = tables["follower"], tables["cam"]
    arm, spring = follower["arm"], tables["spring"]

    def size(key: str, table: dict[str, Any], low: float, high: float) -> float:
        stated = float(str(table[key]).split()[0]) * draw.uniform(low, high)
        table[key] = f"{stated:.4g} {str(table[key]).split()[1]}"
        return stated

    prime, length = size("prime_radius", cam, 0.85, 1.5), size("length", arm, 0.8, 1.4)
    distance = float(np.hypot(prime, length)) * draw.uniform(0.9, 1.15)
    arm["centre_distance"] = f"{distance:.4g} mm"
    if kind != "roller":  # the flat of an arm may be long
        follower["face"]["width"] = "180 mm" if kind == "flat" else "30 mm"
    arm["swing"] = str(draw.choice(["with", "against"]))
    swing, rise = draw.uniform(2.0, 15.0), float(draw.integers(60, 150))
    back, rest = float(draw.integers(60, 150)), float(draw.integers(5, 30))
    laws = [str(each) for each in draw.choice(MOVING, 2)]
    tables["lift"]["segment"] = [
        {"law": laws[0], "angle": f"{rise} deg", "stroke": f"{swing:.3g} deg"},
        {"law": "dwell", "angle": f"{rest} deg"},
        {"law": laws[1], "angle": f"{back} deg", "stroke": f"-{swing:.3g} deg"},
        {"law": "dwell", "angle": f"{360.0 - rise - back - rest} deg"},
    ]
    tables["load_case"][0]["speed"] = f"{draw.integers(30, 1500)} rpm"
    spring["travel_max"] = f"{1.1 * length * np.radians(swing):.4g} mm"
    if (way := draw.integers(3)) == 1:
        del spring["rate"], spring["preload"], spring["design"]
        moment, rate = draw.uniform(20.0, 150.0), draw.uniform(100.0, 1500.0)
        spring["kind"] = "torsion_pivot"
        spring["torsion_pivot"] = {
            "moment": f"{moment:.3g} N m", "angular_rate": f"{rate:.3g} N m/rad",
            "wire_diameter": "14 mm", "mean_diameter": "90 mm",
        }  # fmt: skip
    elif way == 2:
        spring["link"] = {
            "arm_radius": f"{draw.uniform(0.4, 1.2) * length:.4g} mm", "fixed_radius":
            f"{draw.uniform(0.5, 1.5) * distance:.4g} mm", "rate": spring.pop("rate"),
            "fixed_angle": f"{draw.uniform(40.0, 120.0):.3g} deg", "preload": spring.pop("preload"),
        }  # fmt: skip
    if draw.random() < 0.5:
        arm |= {"width": "20 mm", "depth": f"{draw.uniform(14.0, 40.0):.3g} mm", "material": "c45",
                "pivot_notch": 2.0, "roller_notch": 2.5}  # fmt: skip
        tables["scope"] = {"not_covered": ["pivot"], "reason": "not drawn"}
    if draw.random() < 0.5:
        seat = {"length": "25 mm", "diameter": f"{draw.uniform(12.0, 30.0):.3g} mm"}
        bush = seat | {"friction": 0.1, "card": "ptfe_lined"}
        needles = seat | {"friction": 0.004, "C": "20 kN", "C0": "30 kN"}
        chosen = {"bush": bush} if draw.random() < 0.5 else {"needle_bearing": needles}
        follower["pivot"] = {"pin_material": "case_hardened", **chosen}
    return tables


def judged(k: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[list[str], int, str]:
    """Faults, exit code and words of the check of one arm."""
    code, words, spent = checked(f"arm{k}", drawn(k), folder, capsys)
    return list(faults(f"arm {k}", code, words, spent)), code, words


def test_a_few_seeded_arms_are_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arms = np.random.default_rng(SEED).choice(COUNT, QUICK, replace=False).tolist()
    assert [word for k in arms for word in judged(k, tmp_path, capsys)[0]] == []


@pytest.mark.slow
def test_sixty_seeded_arms_are_judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two of three at least are judged: what is refused says why."""
    answers = [judged(k, tmp_path, capsys) for k in range(COUNT)]
    assert [word for wrong, _, _ in answers for word in wrong] == []
    refused = [words for _, code, words in answers if code == 2]
    assert len(refused) <= COUNT // 3, refused
