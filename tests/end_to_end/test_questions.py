"""The textbook questions of docs/questions.md: each is run, and right to four digits."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from command_lines import ran

from camwright.geometry.arrays import Array

PAGE = (Path(__file__).parents[2] / "docs" / "questions.md").read_text(encoding="utf-8")
QUESTIONS = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))
NUMBER = r"-?[0-9.]+(?:e[+-]?[0-9]+)?"
LINES, COMMANDS = 25, 2
TURN = np.linspace(0.0, 1.0, 2_000_001)
MODULUS = 206e9 / (2.0 * (1.0 - 0.3**2))  # E* of steel on steel


def rpm(speed: float) -> float:
    return speed * np.pi / 30.0


def cycloid(stroke: float, angle: float) -> tuple[Array, Array, Array]:
    """Lift, m, and derivatives by the cam angle of a rise; the return mirrors it."""
    lift = stroke * (TURN - np.sin(2.0 * np.pi * TURN) / (2.0 * np.pi))
    slope = stroke / angle * (1.0 - np.cos(2.0 * np.pi * TURN))
    return lift, slope, stroke * 2.0 * np.pi / angle**2 * np.sin(2.0 * np.pi * TURN)


def eccentric() -> Sequence[float]:
    theta = np.pi * TURN
    lift, slope = 0.01 * (1.0 - np.cos(theta)), 0.01 * np.sin(theta)
    force = 80.0 + 5e3 * lift + 0.6 * rpm(500.0) ** 2 * 0.01 * np.cos(theta)
    torque = float(np.max(force * slope))
    return 40.0, float(np.min(force)), float(np.max(force)), -torque, torque


def spring_and_cycloid() -> Sequence[float]:
    lift, slope, bend = cycloid(0.02, 0.5 * np.pi)
    angle = np.arctan(slope / (0.05 + lift))
    force = (300.0 + 1e4 * lift + rpm(600.0) ** 2 * bend) / np.cos(angle)
    return float(np.degrees(np.max(angle))), float(np.min(force)), float(np.max(force))


def jump() -> Sequence[float]:
    lift, _, bend = cycloid(0.02, 0.5 * np.pi)
    falling = bend < 0.0
    speed = np.sqrt(np.min((150.0 + 2e3 * lift[falling]) / -bend[falling]))
    return (float(speed / rpm(1.0)),)


def base_radius() -> Sequence[float]:
    """Of s = h/2 (1 - cos u): max tan alpha = h pi / (2 beta) / sqrt(r (r + h))."""
    needed = 20.0 * np.pi / (2.0 * np.radians(60.0)) / np.tan(np.radians(30.0))
    prime = 0.5 * (np.sqrt(20.0**2 + 4.0 * needed**2) - 20.0)
    return (float(prime - 8.0),)


def hertz() -> Sequence[float]:
    """Johnson (1985), sec. 4.2(c)."""
    radius, load = 1.0 / (1.0 / 0.02 + 1.0 / 0.03), 120e3
    half_width = np.sqrt(4.0 * load * radius / (np.pi * MODULUS))
    return 1e-6 * 2.0 * load / (np.pi * half_width), 1e3 * half_width


def torque() -> Sequence[float]:
    theta = np.pi * TURN
    lift, slope = 0.015 * (1.0 - np.cos(theta)), 0.015 * np.sin(theta)
    force = 500.0 + 8e3 * lift + 2.0 * rpm(60.0) ** 2 * 0.015 * np.cos(theta)
    greatest = float(np.max(force * slope))
    return -greatest, greatest


def preload() -> Sequence[float]:
    lift, _, bend = cycloid(0.02, 0.5 * np.pi)
    least = np.max(-1.03 * rpm(1440.0) ** 2 * bend - 0.95 * 1e4 * lift)
    return (float(least / 0.95),)


def life() -> Sequence[float]:
    """Cube mean over the turns of the roller of 10 mm, which rolls on a disc of 35 mm radius.

    Its surface has the speed of the disc less that of the line of the centres, which turns.
    """
    theta = 2.0 * np.pi * TURN
    height = -0.005 * np.cos(theta) + np.sqrt(0.045**2 - (0.005 * np.sin(theta)) ** 2)
    step = theta[1]
    slope = np.gradient(height, step, edge_order=2)
    bend = np.gradient(slope, step, edge_order=2)
    bend[:3], bend[-3:] = bend[3], bend[-4]
    force = 900.0 + 500.0 * (height - height.min()) + 0.1 * rpm(300.0) ** 2 * bend
    towards = np.arcsin(0.005 * np.sin(theta) / 0.045)  # of the normal from the axis
    spin = 0.035 - 0.045 * np.gradient(towards, step)
    normal = force / np.cos(towards)
    mean = np.cbrt(np.sum(normal**3 * spin) / np.sum(spin))
    return (float(1e6 * (9e3 / mean) ** 3 / (300.0 * 3.5) / 60.0),)


def face_width() -> Sequence[float]:
    """Twice travel and half-width where the slope is greatest; s'' is zero there."""
    load = (900.0 + 5e3 * 0.01) / 5e-3
    half_width = np.sqrt(4.0 * load * 0.04 / (np.pi * MODULUS))
    return (float(2e3 * (0.01 + half_width)),)


def inches() -> Sequence[float]:
    """Of s = c (1 - cos theta): max tan alpha = c / sqrt((r + c)^2 - c^2)."""
    crank, prime = 0.375, 1.75
    angle = np.arctan(crank / np.sqrt((prime + crank) ** 2 - crank**2))
    return 2.0 * 25.4 * crank, float(np.degrees(angle))


EXACT: dict[str, Callable[[], Sequence[float]]] = {
    "Eccentric with a flat face": eccentric,
    "Cycloid with a spring": spring_and_cycloid,
    "Jump speed": jump,
    "Base radius for a pressure angle": base_radius,
    "Hertz pressure of two cylinders": hertz,
    "Torque of a lift": torque,
    "Spring for a speed": preload,
    "Life of a roller": life,
    "Face width": face_width,
    "A lift table in inches": inches,
}


def test_the_page_has_ten_questions() -> None:
    assert list(QUESTIONS) == list(EXACT)
    assert len(QUESTIONS) == 10


@pytest.mark.parametrize("title", QUESTIONS)
def test_a_question_has_its_answer(
    title: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    measured: Callable[..., None],
) -> None:
    blocks = dict(re.findall(r"^```(\w+)\n(.*?)^```$", QUESTIONS[title], re.M | re.S))
    commands = blocks["bash"].splitlines()
    assert len(commands) <= COMMANDS
    monkeypatch.chdir(tmp_path)
    if "toml" in blocks:
        assert blocks["toml"].count("\n") <= LINES
        (case,) = {word for each in commands for word in each.split() if word.endswith(".toml")}
        Path(case).write_text(blocks["toml"], encoding="utf-8")
    if "csv" in blocks:
        Path("lift.csv").write_text(blocks["csv"], encoding="utf-8")
    printed = ""
    for command in commands:
        result = ran(shlex.split(command)[1:])
        assert result.exception is None, result.exception
        assert result.code in (0, 3), result.stdout
        printed += " ".join(result.stdout.split()) + "\n"
    (answer,) = re.findall(r"^Answer: .*$", QUESTIONS[title], re.M)
    stated = []
    for phrase in re.findall(r"`([^`]*[0-9][^`]*)`", answer):
        assert phrase in printed, printed
        stated += [float(each) for each in re.findall(rf"(?<![\w.]){NUMBER}(?![\w.])", phrase)]
    exact = list(EXACT[title]())
    assert len(stated) == len(exact)
    for number, value in zip(stated, exact, strict=True):
        unit = 10.0 ** (np.floor(np.log10(abs(value))) - 3.0)
        # half of the fourth digit; a preload is rounded up
        most = (1.0 if "rounded up" in answer else 0.51) * unit
        assert abs(number - value) <= most, title
        measured(f"Textbook question: {title}", number, value, rtol=1.01 * most / abs(value))
