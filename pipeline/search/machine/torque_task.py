"""Design task: torque over one cycle, speeds, requirements, stated or assumed."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from math import inf, isfinite
from pathlib import Path
from typing import cast

import numpy as np
from typing_extensions import Unpack

from camwright.geometry.arrays import FULL_TURN, Array, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.source import Source
from camwright.pipeline.records.design_document import DesignOptions
from camwright.pipeline.torque.angle_trace import guard_order
from camwright.pipeline.torque.period import Period
from camwright.pipeline.torque.tabled_torque import TabledTorqueFile, tabled_torque
from camwright.pipeline.torque.torque import SAMPLES, uniform_cycle
from camwright.pipeline.torque.trace_file import angle_column, trace_text

_OVER = 1.2  # over-speed over the greatest speed
_LIFE = "2000 h"
_AMBIENT = "40 degC"
_REMOVE = 0.5
_WHOLE_TURNS = 0.02  # of a turn: a span this near to whole turns is a cycle of them

NAMES = ("speeds", "overspeed", "cycle", "ratio", "space", "life", "ambient", "remove")
"""Options that are assumed where they are not given."""
_UNITS = {"cycle": "deg", "space": "mm", "life": "h", "ambient": "K"}


@dataclass(frozen=True, eq=False)
class TorqueDemand:
    """Torque to balance: ripple, and energy to store.

    Parameters
    ----------
    torque : array (720,)   N m at equal shaft angles of one cycle, without its mean
    mean : float            N m
    cycle : float           rad of the shaft
    """

    torque: Array
    mean: float
    cycle: float

    @property
    def ripple(self) -> float:
        """Standard deviation, N m."""
        return float(self.torque.std())

    @property
    def peak(self) -> float:
        """Greatest deviation from the mean, N m."""
        return float(np.abs(self.torque).max())

    @property
    def energy_swing(self) -> float:
        """Greatest less least energy of the cycle, J: integral of the torque over the angle."""
        energy = np.cumsum(self.torque) * (self.cycle / self.torque.size)
        return float(np.ptp(energy))


@dataclass(frozen=True, kw_only=True)
class DesignTask:
    """Torque, and requirements on the cam that balances it, SI.

    space: from the far side of the cam to the top of the roller at maximum lift, None: not limited;
    remove: share of the torque ripple to be removed; options: stated options by name.
    """

    file: Path
    demand: TorqueDemand
    speed: float
    speeds: tuple[float, float]
    overspeed: float
    period: Period
    space: float | None
    life: float
    ambient: float
    remove: float
    options: DesignOptions

    @property
    def assumed(self) -> frozenset[str]:
        """Names of the options not stated."""
        return frozenset(NAMES) - frozenset(self.options)

    def relaxed(self, changes: DesignOptions) -> DesignTask:
        """Task with some options changed."""
        options: DesignOptions = {**self.options, **changes}
        return task_of(self.file, **options)

    def command(self, out: Path) -> str:
        """The command line of the task.

        Parameters
        ----------
        out : Path   case file
        """
        words = ["camwright", "design", "machine", str(self.file)]
        for name, value in self.options.items():
            words += [f"--{name}", _words(name, value)]
        return shlex.join([*words, "--out", str(out)])

    @property
    def ripple_allowed(self) -> float:
        """Allowed residual torque ripple, standard deviation, N m."""
        return (1.0 - self.remove) * self.demand.ripple

    def source(self, name: str, reason: str = "") -> Source:
        """Source of a requirement for the case file."""
        if name not in self.assumed:
            return Source("given", confirmed=True)
        return Source(f"assumed: {reason}" if reason else "assumed", confirmed=False)

    @property
    def ratio(self) -> float:
        """Shaft turns per cam turn."""
        return self.period.ratio

    @property
    def cam_speed(self) -> float:
        """Cam speed at the over-speed, rad/s."""
        return self.overspeed / self.ratio


def _words(name: str, value: object) -> str:
    """Value of an option as text of the command line, with its unit.

    Parameters
    ----------
    name : str       of the option, which sets the unit
    value : object   number in SI, text, path, or a pair of numbers
    """
    if isinstance(value, tuple):
        return "..".join(_words(name, each) for each in value)
    if not isinstance(value, float | int):
        return str(value)
    if name in ("ratio", "remove"):
        return f"{value:.12g}"
    return units.format(value, _UNITS.get(name, "rpm"))


def task_of(torque: str | Path, **options: Unpack[DesignOptions]) -> DesignTask:
    """Task of a torque table; numbers in SI, or text with a unit.

    Parameters
    ----------
    torque : path   CSV: a column of shaft angle, one of torque, with their units
    options         see `DesignOptions`; None: not given

    Raises
    ------
    InputError
        Naming the option, if a value is missing, cannot be read or is out of its bounds, or the
        table is no torque of a cycle: no file, no units, constant, not periodic, rows too coarse
        for its waves.
    """
    if unknown := options.keys() - {"speed", *NAMES}:
        raise InputError(min(unknown), "unknown", f"one of: speed, {', '.join(NAMES)}")
    stated = cast(
        DesignOptions, {name: value for name, value in options.items() if value is not None}
    )
    if "speed" not in stated:
        raise InputError("speed", "missing", 'stated: speed of the shaft, such as "1500 rpm"')
    path = Path(torque)
    running = _number(stated["speed"], "rpm", "speed", above=0.0)
    least, most = _range(stated.get("speeds"), running)
    fastest = _OVER * most
    if "overspeed" in stated:
        fastest = _number(stated["overspeed"], "rpm", "overspeed", at_least=most)
    angle = _cycle(path, stated.get("cycle"))
    return DesignTask(
        file=path,
        demand=_demand(path, angle),
        speed=running,
        speeds=(least, most),
        overspeed=fastest,
        period=_period(angle, _turns(stated["ratio"]) if "ratio" in stated else None),
        space=_number(stated["space"], "mm", "space", above=0.0) if "space" in stated else None,
        life=_number(stated.get("life", _LIFE), "h", "life", above=0.0),
        ambient=_number(stated.get("ambient", _AMBIENT), "K", "ambient", above=0.0),
        remove=_share(stated["remove"]) if "remove" in stated else _REMOVE,
        options=stated,
    )


def _number(
    value: str | float, unit: str, field: str, *, above: float = -inf, at_least: float = -inf
) -> float:
    """Value of an option in SI.

    Parameters
    ----------
    value : float or str   number in SI, or text with a unit
    unit : str             in which limits are shown, of the quantity of the option
    field : str            name of the option
    above : float          lower bound, excluded
    at_least : float       lower bound, included

    Raises
    ------
    InputError
        If it is not finite or not within the bounds.
    """
    read = units.parse(value, unit, field) if isinstance(value, str) else float(value)
    if not (isfinite(read) and read > above):
        raise InputError(field, _as_text(value), f"> {units.shown(above, unit)}")
    if not read >= at_least * (1.0 - 1e-12):
        raise InputError(field, _as_text(value), f">= {units.shown(at_least, unit)}")
    return read


def _as_text(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def _range(
    speeds: str | tuple[str | float, str | float] | None, running: float
) -> tuple[float, float]:
    """Least and greatest speed of the machine, rad/s; both the running speed where no range is
    stated.

    Parameters
    ----------
    speeds : str, tuple or None   text such as ``800..3600 rpm``, or two numbers or texts
    running : float               running speed, rad/s, which has to be in the range
    """
    if speeds is None:
        return running, running
    if isinstance(speeds, str):
        least, dots, most = speeds.partition("..")
        if not dots:
            raise InputError("speeds", speeds, "two speeds, such as 800..3600 rpm")
        unit = most.strip().lstrip("+-.0123456789eE").strip()
        speeds = (least if any(c.isalpha() for c in least) else f"{least.strip()} {unit}", most)
    low, high = (_number(each, "rpm", "speeds", above=0.0) for each in speeds)
    if not low <= running * (1.0 + 1e-12) or not running <= high * (1.0 + 1e-12):
        shown = f"{units.shown(low, 'rpm')} to {units.shown(high, 'rpm')}"
        raise InputError("speeds", shown, f"about speed = {units.shown(running, 'rpm')}")
    return low, high


def _share(value: str | float) -> float:
    """Share of the ripple to be removed, above 0 and below 1, from a number or text such as
    ``60%``.
    """
    text = str(value).strip()
    try:
        share = 0.01 * float(text[:-1]) if text.endswith("%") else float(text)
    except ValueError:
        raise InputError("remove", text[:40], "a share, such as 60% or 0.6") from None
    if not 0.0 < share < 1.0:
        raise InputError("remove", text, "> 0 % and < 100 %")
    return share


def _cycle(path: Path, cycle: str | float | None) -> float:
    """Shaft angle of a cycle, rad: as stated, or the whole turns that the angles of a torque table
    span.

    Parameters
    ----------
    path : Path                  torque table
    cycle : str, float or None   stated angle: text with a unit, or rad; None: from the table

    Raises
    ------
    InputError
        If the table spans no whole number of turns.
    """
    if cycle is not None:
        return _number(cycle, "deg", "cycle", above=0.0)
    text = trace_text(path, "angle_deg,torque_Nm")
    at, factor = angle_column(text.name, text.header)
    written = text.numbers((at,))[:, 0]
    guard_order(text.name, text.line_numbers, written, text.header[at])
    angle = written * factor
    spacing = float(np.median(np.diff(angle)))
    span = float(angle[-1] - angle[0])
    for whole in (span, span + spacing):
        turns = max(round(whole / FULL_TURN), 1)
        if abs(whole / FULL_TURN - turns) <= _WHOLE_TURNS:
            return turns * FULL_TURN
    limit = "whole turns of the shaft, or the angle of the cycle as option cycle"
    raise InputError(f"{text.name} span", f"{np.degrees(span):.6g} deg", limit)


def _turns(ratio: str | float) -> float:
    """A ratio as a number, or as text such as ``3:2``."""
    text = str(ratio).strip()
    above, colon, below = text.partition(":")
    try:
        value = float(above) / float(below) if colon else float(above)
    except (ValueError, ZeroDivisionError):
        raise InputError("ratio", text[:40], 'a number or "3:2"') from None
    return value


def _period(cycle: float, ratio: float | None) -> Period:
    """Period of the machine; without a ratio a cam turn is one cycle, of one turn or more."""
    if ratio is None:
        return Period(cycle, cycle / FULL_TURN * max(1, round(FULL_TURN / cycle)))
    try:
        return Period(cycle, ratio)
    except InputError as error:
        raise InputError("ratio", error.value, error.limit) from None


def _demand(path: Path, cycle: float) -> TorqueDemand:
    """Torque about its mean at `SAMPLES` equal angles of the cycle, and the mean, N m,
    of a table.
    """
    source = TabledTorqueFile(file=path.name, cycle=cycle)
    values = tabled_torque(source, path).torque(uniform_cycle(SAMPLES, cycle))
    mean = float(values.mean())
    return TorqueDemand(readonly(values - mean), mean, cycle)
