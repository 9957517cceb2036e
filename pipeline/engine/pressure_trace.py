"""Measured cylinder pressure: cycle statistics, pegging, dead centre, torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi, radians
from pathlib import Path
from typing import Annotated, ClassVar, Literal, get_args

import numpy as np
import scipy

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, FileName, GasPressure, In, Known, Part
from camwright.pipeline.base.units import shown
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CrankDrive, FrictionPressure
from camwright.pipeline.torque.angle_trace import (
    GAP_MAX,
    Trace,
    guard_order,
    guard_span,
    one_period,
)
from camwright.pipeline.torque.torque import SAMPLES, Torque, all_cylinders, uniform_cycle
from camwright.pipeline.torque.trace_file import (
    ANGLE_UNITS,
    QUANTITY_UNITS,
    HeaderText,
    angle_column,
    columns_of,
    numbered_columns,
    require_alike,
    trace_text,
)

DeadCentre = Literal["given", "symmetry", "loss_angle"]

PEAK_RANGE = (1.2e5, 4.0e7)  # Pa, of the peak of any engine that compresses
FIRING_WINDOW = np.radians((300.0, 480.0))  # of the peak of a cycle
BOTTOM_WINDOW = np.radians((170.0, 190.0))  # in which the cylinder is assumed at intake pressure
COMPRESSION_WINDOW = np.radians((270.0, 320.0))
POLYTROPIC_EXPONENT = 1.32
SCALE_MAX = 2.2  # measured over expected rise in compression; a wrong unit is 10 or more
UNLIKE = 0.5  # rms difference of columns over the rms about the mean; misfires are near 0.7
LOSS_ANGLE = radians(0.6)  # typical lead of a motored peak over the dead centre


@dataclass(frozen=True, kw_only=True)
class _PressureFile(Part):
    """File of a measured cylinder pressure: columns, units, angles, dead centre."""

    table: ClassVar[str] = "engine"

    kind: str
    file: FileName
    column: Annotated[HeaderText, Known("the file", "run1")] = ""
    """columns of the file, by the beginning of their headers; without a header by number, `2` or `2
    to 9`; left out, all runs or cycles, or the primary trigger of a log"""
    angle_unit: Annotated[HeaderText, Known("the file", "deg")] = ""
    """unit of the angles of a file without header"""
    pressure_unit: Annotated[HeaderText, Known("the file", "bar")] = ""
    """unit of the pressures of a file without header"""
    firing_angle: Annotated[Angle, Known("the file")] = 2.0 * pi
    """angle of firing dead centre in the file"""
    gap_max: Annotated[float, In("deg", above=0, at_most=90), Known("own choice")] = GAP_MAX
    """greatest gap between two angles of the file"""
    dead_centre: Annotated[DeadCentre, Known("test bench")] = "given"
    """origin of the top dead centre: as given, by symmetry or by loss angle of a motored cycle"""
    motored_file: Annotated[FileName | None, Known("test bench", "motored.csv")] = None
    """motored pressure of the same cylinder, for the dead centre"""
    loss_angle: Annotated[
        float, In("deg", at_least=0, at_most=5), Known("textbooks: 0.4 to 1 deg")
    ] = LOSS_ANGLE
    """crank angle of the peak motored pressure before top dead centre"""


@dataclass(frozen=True, kw_only=True)
class PressureTable(CrankDrive, _PressureFile):
    """Case table: file of cylinder pressure over crank angle, and the crank drive.

    The file has one column a cycle, or cycles one below the other; both units together mean that it
    has no header. Without an intake pressure the pressure is absolute. Friction closes the torque
    balance with the brake torque where it is measured.

    Raises
    ------
    InputError
        As `CrankDrive`; if one unit lacks the other, a dead centre its motored file, or the brake
        has both a torque and a power.
    """

    kind: Literal["pressure"] = "pressure"
    intake_pressure: GasPressure | None = None
    crankcase_pressure: GasPressure = 101.3e3
    friction_pressure: FrictionPressure | None = None
    brake_torque: Annotated[
        float | None, In("N m", at_least=0, at_most=1e8), Known("test bench", "18 N m")
    ] = None
    """measured brake torque, which the indicated torque must exceed"""
    brake_power: Annotated[
        float | None, In("kW", at_least=0, at_most=1e6), Known("test bench", "3.4 kW")
    ] = None
    """measured brake power at the speed of the first load case, in place of its torque"""

    def __post_init__(self) -> None:
        """Refuse keys that exclude or need one another; see the class."""
        super().__post_init__()
        if self.brake_torque is not None and self.brake_power is not None:
            power = shown(self.brake_power, "kW")
            raise InputError("engine.brake_power", power, "left out beside engine.brake_torque")
        if bool(self.angle_unit) != bool(self.pressure_unit):
            raise InputError("engine.pressure_unit", self.pressure_unit, "given with angle_unit")
        if self.dead_centre != "given" and self.motored_file is None:
            raise InputError("engine.motored_file", "missing", f"given for {self.dead_centre}")

    @property
    def units(self) -> tuple[str, str] | None:
        """Units of angle and pressure of a file without a header; None: the header has them."""
        return (self.angle_unit, self.pressure_unit) if self.angle_unit else None

    def brake(self, crank_speed: float) -> float | None:
        """Measured brake torque at a crank speed (rad/s), N m; None: not measured.

        Raises
        ------
        InputError
            For a power at standstill.
        """
        if self.brake_power is None:
            return self.brake_torque
        if not crank_speed > 0.0:
            raise InputError("load_case.speed", "0 rpm", "> 0 rpm in one for engine.brake_power")
        return self.brake_power / crank_speed


@dataclass(frozen=True, eq=False)
class PressureTrace:
    """Cylinder pressure of one cycle or more at equal crank angles.

    Parameters
    ----------
    source : str            name of the file
    cycles : array (m, n)   Pa, absolute once pegged; angle 0 the TDC of intake
    pegging : array (m,)    Pa, added to each cycle to bring it to intake pressure; 0: not pegged
    offset : float          rad, by which the angles of the file were shifted
    """

    source: str
    cycles: Array
    pegging: Array
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Refuse values that are not finite, and fewer than 12 angles; the arrays become
        read-only.
        """
        cycles = finite(f"{self.source} pressure", self.cycles)
        if cycles.ndim != 2 or cycles.shape[1] < 12:
            raise InputError(f"{self.source} pressure", cycles.shape, "(cycles, 12 angles or more)")
        freeze(self, cycles=cycles, pegging=self.pegging)

    @property
    def theta(self) -> Array:
        return uniform_cycle(self.cycles.shape[1])

    @property
    def mean(self) -> Array:
        """Mean over the cycles at each angle, Pa."""
        return np.asarray(self.cycles.mean(axis=0))

    @property
    def scatter(self) -> Array:
        """Standard deviation over the cycles at each angle, Pa; zero for one cycle."""
        if self.cycles.shape[0] < 2:
            return np.zeros(self.cycles.shape[1])
        return np.asarray(self.cycles.std(axis=0, ddof=1))

    def pegged(self, intake_pressure: float) -> PressureTrace:
        """Each cycle shifted to intake pressure (Pa) about the bottom dead centre of intake.

        References
        ----------
        Randolph, SAE 900170 (1990): inlet manifold pressure referencing.
        """
        if not 0.0 < intake_pressure < np.inf:
            raise InputError("engine.intake_pressure", intake_pressure, "> 0 Pa")
        low, high = BOTTOM_WINDOW
        near = (self.theta >= low - 1e-9) & (self.theta <= high + 1e-9)
        shift = intake_pressure - self.cycles[:, near].mean(axis=1)
        return replace(
            self, cycles=self.cycles + shift[:, None], pegging=np.asarray(self.pegging) + shift
        )

    def turned(self, offset: float) -> PressureTrace:
        """Trace shifted to later crank angles by `offset`, rad: p(theta - offset); by Fourier
        series.
        """
        if offset == 0.0:
            return self
        order = np.arange(self.cycles.shape[1] // 2 + 1) * (2.0 * pi / CYCLE_ANGLE)
        spectrum = np.fft.rfft(self.cycles, axis=1) * np.exp(-1j * order * offset)
        turned = np.fft.irfft(spectrum, n=self.cycles.shape[1], axis=1)
        return replace(self, cycles=turned, offset=self.offset + offset)

    def guarded(self) -> PressureTrace:
        """The trace itself; InputError if it is implausible as a cylinder pressure.

        Raises
        ------
        InputError
            If the mean cycle is not above zero, or its peak is out of range (with a hint at the
            unit) or not about firing TDC.
        """
        mean, name = self.mean, f"{self.source} pressure"
        if not mean.min() > 0.0:
            at = self.theta[mean.argmin()]
            hint = "> 0 Pa, absolute; give engine.intake_pressure to peg a relative trace"
            raise InputError(f"{name} at {np.degrees(at):.4g} deg", f"{mean.min():.4g} Pa", hint)
        peak = float(mean.max())
        if not PEAK_RANGE[0] <= peak <= PEAK_RANGE[1]:
            limit = f"from {PEAK_RANGE[0]:g} to {PEAK_RANGE[1]:g} Pa{_unit_hint(peak)}"
            raise InputError(f"{name} peak", f"{peak:.4g} Pa", limit)
        at = float(self.theta[mean.argmax()])
        if not FIRING_WINDOW[0] <= at <= FIRING_WINDOW[1]:
            limit = "from 300 to 480 deg; set engine.firing_angle to where the file fires"
            raise InputError(f"{name} peak angle", f"{np.degrees(at):.4g} deg", limit)
        return self

    def scale(self, engine: CrankDrive, intake_pressure: float) -> float:
        """Ratio of the rise of the mean pressure in compression, over `COMPRESSION_WINDOW`, to that
        of a polytropic from intake pressure, Pa, at bottom dead centre; 1 where both agree.
        """
        low, high = COMPRESSION_WINDOW
        ends = np.interp([low, high], self.theta, self.mean)
        volumes = engine.volume(np.array([pi, low, high]))
        share = (volumes[0] / volumes[1:]) ** POLYTROPIC_EXPONENT
        expected = intake_pressure * (share[1] - share[0])
        return float((ends[1] - ends[0]) / expected)

    def guard_scale(self, engine: CrankDrive, intake_pressure: float) -> None:
        """Refuse pressures whose rise in compression does not agree with the geometry of the
        engine; see `scale`.

        Parameters
        ----------
        engine : CrankDrive       cylinder volume over crank angle
        intake_pressure : float   absolute, Pa

        Raises
        ------
        InputError
            If the ratio is not within 1/`SCALE_MAX` to `SCALE_MAX`; names the unit that agrees, if
            one does.
        """
        scale = self.scale(engine, intake_pressure)
        if 1.0 / SCALE_MAX <= scale <= SCALE_MAX:
            return
        limit = f"from {1 / SCALE_MAX:.2g} to {SCALE_MAX:g} times that of a polytropic"
        known = {10.0: "bar, not MPa", 0.1: "MPa, not bar", 1e5: "Pa, not bar", 1e-5: "bar, not Pa"}
        for factor, words in known.items():
            if 1.0 / SCALE_MAX <= scale / factor <= SCALE_MAX:
                limit += f"; the values look like {words}"
        field = f"{self.source} pressure rise in compression"
        raise InputError(field, f"{scale:.3g} of the expected", limit)


def _unit_hint(peak: float) -> str:
    """End of a message: the unit in which a peak pressure, read as `peak`, Pa, would be in the
    usual range; "" where none would.
    """
    typical = (4e5, 2e7)
    for factor, words in ((1e5, "bar"), (1e6, "MPa"), (1e-5, "Pa"), (1e3, "kPa"), (1e-6, "Pa")):
        if typical[0] <= peak * factor <= typical[1]:
            return f"; the values look like {words}"
    return ""


@dataclass(frozen=True, eq=False)
class CycleStatistics:
    """Statistics over m cycles: net IMEP, peak pressure and its angle, (m,) each."""

    imep: Array  # Pa, net, all four strokes
    peak: Array  # Pa
    peak_angle: Array  # rad

    def __post_init__(self) -> None:
        freeze(self, imep=self.imep, peak=self.peak, peak_angle=self.peak_angle)

    @property
    def imep_std(self) -> float:
        return float(self.imep.std(ddof=1)) if self.imep.size > 1 else 0.0

    @property
    def imep_variation(self) -> float:
        """Coefficient of variation (COV) of the net IMEP, std / mean.

        References
        ----------
        Heywood, Internal Combustion Engine Fundamentals (1988), sec. 9.4.2.
        """
        return self.imep_std / abs(float(self.imep.mean()))


def cycle_statistics(trace: PressureTrace, engine: CrankDrive) -> CycleStatistics:
    """Net IMEP, peak pressure and its angle of each cycle."""
    step = CYCLE_ANGLE / trace.cycles.shape[1]
    work = trace.cycles @ engine.volume_rate(trace.theta) * step
    return CycleStatistics(
        imep=work / engine.displacement,
        peak=trace.cycles.max(axis=1),
        peak_angle=trace.theta[trace.cycles.argmax(axis=1)],
    )


def dead_centre_offset(
    motored: PressureTrace, method: DeadCentre, loss_angle: float = LOSS_ANGLE
) -> float:
    """Crank angle (rad) that shifts the dead centre of a motored trace to 360 deg.

    By `symmetry`, the dead centre is the axis about which both flanks within 60 deg agree best;
    heat transfer and leakage advance it by some tenths of a degree. By `loss_angle`, it is the
    peak of the mean cycle plus a stated loss angle.

    Parameters
    ----------
    motored : PressureTrace    without combustion
    method : str               "symmetry" or "loss_angle"
    loss_angle : float         rad

    References
    ----------
    Hohenberg, Definition und Eigenschaften des thermodynamischen Verlustwinkels, TU Graz (1976),
    as cited by Pischinger, Klell and Sams, Thermodynamik der Verbrennungskraftmaschine: verify.
    """
    if method not in get_args(DeadCentre) or method == "given":
        raise InputError("engine.dead_centre", method, "symmetry or loss_angle")
    mean, theta = motored.mean, motored.theta
    order = np.arange(mean.size // 2 + 1) * (2.0 * pi / CYCLE_ANGLE)
    spectrum = np.fft.rfft(mean) / mean.size
    spectrum[1:] *= 2.0
    kept = order <= 60.0  # a compression has no content above, only noise
    spectrum, order = spectrum[kept], order[kept]

    def pressure(angle: Array) -> Array:
        return np.asarray((np.exp(1j * np.outer(angle, order)) @ spectrum).real)

    start = float(theta[mean.argmax()])
    reach = np.radians(np.arange(2.0, 60.5, 1.0))
    step = float(np.radians(8.0))

    def skew(axis: float) -> float:
        return float(((pressure(axis + reach) - pressure(axis - reach)) ** 2).sum())

    def below(axis: float) -> float:
        return -float(pressure(np.array([axis]))[0])

    cost = skew if method == "symmetry" else below
    optimum = scipy.optimize.minimize_scalar(
        cost, bounds=(start - step, start + step), method="bounded", options={"xatol": 1e-7}
    )
    axis = float(optimum.x) + (loss_angle if method == "loss_angle" else 0.0)
    return 2.0 * pi - axis


def pressure_from_csv(
    path: str | Path,
    *,
    column: str = "",
    units: tuple[str, str] | None = None,
    firing_angle: float = 2.0 * pi,
    gap_max: float = GAP_MAX,
) -> PressureTrace:
    """Pressure trace from a file with a column per cycle, or with the cycles in sequence.

    Angles continue from cycle to cycle, or start again with each.

    Parameters
    ----------
    path : path
    column : str                beginning of the headers of the pressure columns; without a header
                                their numbers, as of `numbered_columns`
    units : (angle, pressure)   of a file without a header, whose first column is the angle
    firing_angle : float        rad, of firing TDC in the file's angles
    gap_max : float             rad, maximum gap between rows

    Raises
    ------
    InputError
        As `read_trace` and `numbered_columns`; if a cycle is incomplete, or columns that are not
        named are unlike. `PressureTrace.guarded` checks the values, after pegging.
    """
    example = "angle_deg,pressure_bar, or engine.angle_unit and engine.pressure_unit"
    text = trace_text(Path(path), example, headed=units is None)
    name, header = text.name, text.header
    angle_at, angle_factor = angle_column(name, header) if units is None else _bare_angle(units)
    known = ", ".join(QUANTITY_UNITS["pressure"])
    if units is None:
        wanted = columns_of(header, "pressure", column)
    else:
        unit = QUANTITY_UNITS["pressure"].get(units[1])
        if unit is None:
            raise InputError("engine.pressure_unit", units[1], f"one of {known}")
        wanted = dict.fromkeys(numbered_columns(name, column, len(header)), unit)
    if not wanted:
        limit = f"a column of pressure with its unit ({known})"
        raise InputError(f"{name} header", ", ".join(header), limit)
    table, numbers = text.numbers((angle_at, *wanted)), text.line_numbers
    values = table[:, 1:] * np.array(list(wanted.values()))
    labels = [header[at] for at in wanted]
    traces = _cycles(name, numbers, table[:, 0], angle_factor, values, labels, gap_max)
    spacing = float(np.median(traces[0].spacing))
    count = max(SAMPLES, round(CYCLE_ANGLE / spacing))
    cycles = np.array([trace.uniform(count) for trace in traces])
    if not column:
        shapes = cycles.reshape(-1, len(wanted), count).mean(axis=0)
        shapes = shapes - shapes.mean(axis=1, keepdims=True)
        require_alike(name, [header[at] for at in wanted], shapes, UNLIKE, headed=units is None)
    return PressureTrace(name, cycles, np.zeros(len(cycles))).turned(2.0 * pi - firing_angle)


def _bare_angle(units: tuple[str, str]) -> tuple[int, float]:
    """Index of the angle column, 0, of a file without a header, and the factor from its unit to
    rad.

    Parameters
    ----------
    units : tuple of str   stated units of angle and pressure

    Raises
    ------
    InputError
        If the unit of the angle is not known.
    """
    factor = ANGLE_UNITS.get(units[0])
    if factor is None:
        raise InputError("engine.angle_unit", units[0], f"one of {', '.join(ANGLE_UNITS)}")
    return 0, factor


def _cycles(
    name: str,
    lines: Sequence[int],
    written: Array,
    factor: float,
    values: Array,
    labels: Sequence[str],
    gap_max: float,
) -> list[Trace]:
    """Pressure trace of each cycle and column of a file; cycles may also stand one below the other.

    Parameters
    ----------
    name : str               of the file
    lines : sequence (n,)    line of each row in the file
    written : array (n,)     crank angles in the unit of the file
    factor : float           from this unit to rad
    values : array (n, k)    pressures, Pa, of k columns
    labels : sequence (k,)   headers of the columns
    gap_max : float          maximum gap between rows, rad

    Raises
    ------
    InputError
        If the angles are not in order, a cycle is not 720 deg long, or a gap is too wide.
    """
    angle = _unwrapped(written * factor)
    guard_order(name, lines, angle / factor, "crank angle")
    spacing = float(np.median(np.diff(angle)))
    count = round((angle[-1] - angle[0] + spacing) / CYCLE_ANGLE)
    if count < 2:
        guard_span(name, angle, factor, CYCLE_ANGLE, gap_max)
        return [
            one_period(name, "pressure", label, lines, angle, values[:, k], gap_max=gap_max)
            for k, label in enumerate(labels)
        ]
    traces = []
    for k in range(count):
        start = angle[0] + k * CYCLE_ANGLE - 1e-6
        inside = (angle >= start) & (angle < start + CYCLE_ANGLE)
        part = angle[inside] - k * CYCLE_ANGLE
        span = part[-1] - part[0] + spacing if part.size else 0.0
        if abs(span - CYCLE_ANGLE) > max(1.5 * spacing, 1e-9):
            field = f"{name} cycle {k + 1} of {count}"
            raise InputError(field, f"{np.degrees(span):.6g} deg long", "720 deg, as every cycle")
        rows = [line for line, held in zip(lines, inside, strict=True) if held]
        traces += [
            one_period(name, "pressure", label, rows, part, values[inside, j], gap_max=gap_max)
            for j, label in enumerate(labels)
        ]
    left = angle[-1] - (angle[0] + count * CYCLE_ANGLE)
    if left > 1.5 * spacing:
        field = f"{name} after cycle {count}"
        raise InputError(field, f"{np.degrees(left):.4g} deg more", "whole cycles of 720 deg")
    return traces


def _unwrapped(angle: Array) -> Array:
    """Angles (n,), rad, that start again with each cycle, made continuous by adding a cycle at each
    step back.
    """
    steps = np.diff(angle)
    spacing = float(np.median(steps))
    back = np.abs(steps + CYCLE_ANGLE - spacing) <= 1.5 * abs(spacing)
    return np.asarray(angle + np.concatenate([[0.0], np.cumsum(back)]) * CYCLE_ANGLE)


def torque_from_pressure(
    trace: PressureTrace, engine: PressureTable, crank_speed: float, brake: float = 0.0
) -> Torque:
    """Engine torque, by component, from the mean of the measured pressure cycles, common to all
    cylinders.

    Components are the gas, the inertia of the reciprocating masses at constant speed, and friction:
    of the friction mean effective pressure or, without one, what closes the balance with the brake
    torque.

    Parameters
    ----------
    trace : PressureTrace    of one cylinder, Pa, absolute
    engine : PressureTable   crank drive and firing offsets
    crank_speed : float      rad/s
    brake : float            mean brake torque of the engine, N m; 0: it drives nothing

    Raises
    ------
    InputError
        As `CrankDrive.friction_torque`.
    """
    theta = trace.theta
    gas = (trace.mean - engine.crankcase_pressure) * engine.volume_rate(theta)
    inertia = engine.inertia_torque(theta, crank_speed)
    driving = float(gas.mean()) - brake / len(engine.firing_offsets)
    friction = engine.friction_torque(engine.friction_pressure, driving)
    parts = {"gas": gas, "inertia": inertia, "friction": np.full_like(theta, friction)}
    coarse = uniform_cycle(SAMPLES)
    parts = {name: _thinned(part) for name, part in parts.items()}
    return Torque(
        coarse,
        all_cylinders(parts, coarse, engine.firing_offsets),
        engine.reciprocating_inertia(coarse),
    )


def _thinned(values: Array) -> Array:
    """Values at the angles of a torque, without the harmonics above their Nyquist order."""
    spectrum = np.fft.rfft(values)[: SAMPLES // 2 + 1]
    return np.asarray(np.fft.irfft(spectrum, n=SAMPLES) * (SAMPLES / values.size))
