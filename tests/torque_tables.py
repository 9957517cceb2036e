"""Torque tables of nine machines that the search of a design was not tuned on, from a seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
AIR = 1.01e5  # Pa
SEED = 20261123


@dataclass(frozen=True)
class Crank:
    """A slider-crank, m; lengths scattered by a few per cent with the seed."""

    bore: float
    stroke: float
    rod: float

    @property
    def area(self) -> float:
        return 0.25 * np.pi * self.bore**2

    def position(self, angle: Array) -> Array:
        """Travel of the piston from its top dead centre, m."""
        r, sine = 0.5 * self.stroke, np.sin(angle)
        return r * (1.0 - np.cos(angle)) + self.rod - np.sqrt(self.rod**2 - (r * sine) ** 2)

    def arm(self, angle: Array) -> Array:
        """Derivative of the travel, m: torque on the crank per force down on the piston."""
        r, sine = 0.5 * self.stroke, np.sin(angle)
        return r * sine * (1.0 + r * np.cos(angle) / np.sqrt(self.rod**2 - (r * sine) ** 2))

    def volume(self, angle: Array, clearance: float) -> Array:
        """Gas volume over the swept one; clearance: share of the swept one."""
        return clearance + self.position(angle) / self.stroke


def _angle(cycle: float, rows: int) -> Array:
    return np.arange(rows) * (np.radians(cycle) / rows)


def _burnt(angle: Array, start: float, length: float) -> Array:
    """Vibe function from an angle before the top dead centre, deg."""
    share = np.clip((np.degrees(angle) + start) / length, 0.0, None)
    return 1.0 - np.exp(-6.9 * share**2.5)


def _fired(crank: Crank, angle: Array, compression: float, rise: float) -> Array:
    """Gas pressure over the turn -180 to 180 deg about the firing dead centre, Pa."""
    volume = crank.volume(angle, 1.0 / (compression - 1.0))
    most = crank.volume(np.array([np.pi]), 1.0 / (compression - 1.0))[0]
    closed = AIR * (most / volume) ** 1.33 * (1.0 + rise * _burnt(angle, 12.0, 50.0))
    opened = 0.5 + 0.5 * np.tanh((np.degrees(angle) - 140.0) / 8.0)
    return AIR + (closed - AIR) * (1.0 - opened)


def four_stroke(crank: Crank, compression: float, rise: float, rows: int) -> Array:
    """Gas torque of a four-stroke, firing in the middle of its cycle of 720 deg, N m."""
    angle = _angle(720.0, rows) - 2.0 * np.pi
    own = np.abs(angle) <= np.pi
    pressure = np.where(own, _fired(crank, np.where(own, angle, 0.0), compression, rise), AIR)
    return (pressure - AIR) * crank.area * crank.arm(angle)


def two_stroke(crank: Crank, compression: float, rise: float, rows: int) -> Array:
    """Gas torque of a two-stroke, firing in the middle of its cycle of 360 deg, N m."""
    angle = _angle(360.0, rows) - np.pi
    return (_fired(crank, angle, compression, rise) - AIR) * crank.area * crank.arm(angle)


def press(crank: Crank, force: float, rows: int) -> Array:
    """Load torque of a press that cuts over 35 to 8 % of the stroke above its lower end, N m."""
    angle = _angle(360.0, rows)
    left = 1.0 - crank.position(angle) / crank.stroke
    down = np.sin(angle) > 0.0
    works = 0.5 * (np.tanh((0.35 - left) / 0.04) + np.tanh((left - 0.08) / 0.02))
    return np.where(down, force * np.maximum(works, 0.0) * crank.arm(angle), 0.0)


def compressor(crank: Crank, suction: float, delivery: float, clearance: float, rows: int) -> Array:
    """Load torque of a single-acting compressor, polytropic 1.3, valves without loss, N m."""
    angle = _angle(360.0, rows)
    volume = crank.volume(angle, clearance)
    down = np.sin(angle) >= 0.0
    expands = np.maximum(delivery * (clearance / volume) ** 1.3, suction)
    presses = np.minimum(suction * ((1.0 + clearance) / volume) ** 1.3, delivery)
    pressure = np.where(down, expands, presses)
    return -(pressure - AIR) * crank.area * crank.arm(angle)


def pump(crank: Crank, delivery: float, rows: int) -> Array:
    """Load torque of a plunger pump that delivers on the way up; valves open in 6 deg, N m."""
    angle = _angle(360.0, rows)
    delivers = 0.5 - 0.5 * np.tanh(np.sin(angle) / np.sin(np.radians(6.0)))
    return -delivery * delivers * crank.area * crank.arm(angle)


def twin(crank: Crank, compression: float, rise: float, rows: int) -> Array:
    """Gas torque of two four-stroke cylinders that fire a turn apart, N m."""
    one = four_stroke(crank, compression, rise, rows)
    return one + np.roll(one, rows // 2)


def loom(crank: Crank, blow: float, drive: float, rows: int) -> Array:
    """Load torque of a sley by its inertia, of a beat-up over 25 deg at its front end, and rest.

    blow: force of the beat-up over the greatest one of inertia; drive: steady torque of shedding,
    let-off and take-up over the greatest one of inertia.
    """
    angle = _angle(360.0, rows)
    step, arm = angle[1] - angle[0], crank.arm(angle)
    inertia = (np.roll(arm, -1) - np.roll(arm, 1)) / (2.0 * step)
    beat = 0.5 * (np.tanh((np.radians(25.0) - angle) / 0.04) + np.tanh(angle / 0.02))
    sley = -inertia * arm
    beaten = -blow * np.abs(inertia).max() * np.maximum(beat, 0.0) * arm
    return sley + beaten - drive * np.abs(sley).max()


def duplex(crank: Crank, delivery: float, rod_share: float, rows: int) -> Array:
    """Load torque of a double-acting plunger pump; rod_share: of the area, on its way down, N m."""
    angle = _angle(360.0, rows)
    up = 0.5 - 0.5 * np.tanh(np.sin(angle) / np.sin(np.radians(6.0)))
    return -delivery * (up - (1.0 - rod_share) * (1.0 - up)) * crank.area * crank.arm(angle)


@dataclass(frozen=True)
class Machine:
    """A machine with the options of its design; swing: its energy swing, J."""

    speed: str
    swing: float
    cycle: float
    torque: Callable[[Array], Array]
    header: str = "shaft_angle_deg,torque_Nm"


def _scattered(bore: float, stroke: float, rod: float, scatter: Array) -> Crank:
    return Crank(*(1e-3 * np.array([bore, stroke, rod]) * scatter))


MACHINES: dict[str, Machine] = {
    "engine": Machine(
        "1500 rpm", 84.0, 720.0, lambda s: four_stroke(_scattered(72, 62, 105, s), 8.6, 2.4, 360)
    ),
    "diesel": Machine(
        "1000 rpm", 197.0, 720.0, lambda s: four_stroke(_scattered(80, 78, 132, s), 17.5, 0.9, 480)
    ),
    "press": Machine("75 rpm", 46.0, 360.0, lambda s: press(_scattered(1, 60, 240, s), 1.0, 240)),
    "compressor": Machine(
        "720 rpm", 21.0, 360.0,
        lambda s: compressor(_scattered(52, 40, 85, s), 0.98e5, 7.5e5, 0.06, 180),
    ),
    "pump": Machine("190 rpm", 9.5, 360.0, lambda s: pump(_scattered(28, 32, 90, s), 22e5, 180)),
    "two_stroke": Machine(
        "2200 rpm", 33.0, 360.0, lambda s: two_stroke(_scattered(48, 42, 80, s), 7.2, 2.1, 240)
    ),
    "twin": Machine(
        "1800 rpm", 38.0, 720.0, lambda s: twin(_scattered(52, 48, 86, s), 9.2, 2.2, 360)
    ),
    "loom": Machine(
        "160 rpm", 14.0, 360.0, lambda s: loom(_scattered(1, 90, 300, s), 0.8, 0.6, 240)
    ),
    "duplex": Machine(
        "140 rpm", 12.0, 360.0, lambda s: duplex(_scattered(36, 40, 110, s), 18e5, 0.25, 180)
    ),
}  # fmt: skip


def write_table(folder: Path, name: str, seed: int = SEED) -> Path:
    """Write the torque table of a machine, scaled to its energy swing."""
    machine = MACHINES[name]
    scatter = np.random.default_rng([seed, *name.encode()]).uniform(0.97, 1.03, 3)
    torque = machine.torque(scatter)
    stored = np.cumsum(torque - torque.mean()) * (np.radians(machine.cycle) / torque.size)
    torque *= machine.swing / np.ptp(stored)
    angle = np.arange(torque.size) * (machine.cycle / torque.size)
    rows = [f"{a:.6g},{t:.6g}" for a, t in zip(angle, torque, strict=True)]
    path = folder / f"{name}.csv"
    path.write_text("\n".join([machine.header, *rows]) + "\n", encoding="utf-8")
    return path
