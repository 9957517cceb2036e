"""Indicated torque of a measured cylinder pressure against the brake torque."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, radians

import numpy as np
import scipy

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.pressure_trace import (
    PressureTable,
    PressureTrace,
    dead_centre_offset,
)
from camwright.pipeline.records.run_summary import IndicatedTorque

SHIFT_MAX = radians(10.0)
"""Greatest error of a dead centre that is considered, rad."""


@dataclass(frozen=True)
class BrakeBalance:
    """Indicated torque of a pressure trace with its sensitivities, beside the brake torque.

    Parameters
    ----------
    source : str             name of the trace
    indicated : float        mean torque of the gas on the crank, all cylinders, N m
    slope : float            its change by an angle that makes the pressure later, N m/rad
    swept : float            swept volume of all cylinders, m3
    brake : float or None    brake torque, N m; None: not measured
    shift : float or None    rad by which a later pressure has the brake torque; None: no such
                             angle within 10 deg, or no brake torque
    motored_lead : float or None   rad by which the motored peak leads the dead centre; None: no
                                   motored cycle
    """

    source: str
    indicated: float
    slope: float
    swept: float
    brake: float | None = None
    shift: float | None = None
    motored_lead: float | None = None

    @property
    def friction_pressure(self) -> float | None:
        """Friction mean effective pressure, 4 pi (indicated - brake) / swept volume, Pa."""
        return None if self.brake is None else self._pressure(self.indicated - self.brake)

    def guarded(self, field: str = "engine.brake_torque") -> BrakeBalance:
        """The balance; refused where the brake torque exceeds the indicated torque.

        Raises
        ------
        InputError
            With the error of dead centre, gain or zero that would alone explain the difference.
        """
        if self.brake is None or self.indicated > self.brake:
            return self
        limit = (
            f"< {self.indicated:.4g} N m, the indicated torque of {self.source}, as friction is "
            "not negative: an error of the trace. Likely causes, each as large as would alone "
            f"explain it: {'; '.join(self._causes(self.brake))}"
        )
        raise InputError(field, f"{self.brake:.4g} N m", limit)

    def words(self) -> str:
        """Line of text: indicated torque, its sensitivity to the dead centre, friction."""
        parts = [
            f"indicated torque of {self.source}: {self.indicated:.4g} N m, {self._sensitivity}"
        ]
        if self.brake is not None:
            friction = self._pressure(self.indicated - self.brake)
            parts.append(
                f"brake torque {self.brake:.4g} N m, {100.0 * self.brake / self.indicated:.3g} % "
                f"of it; friction mean effective pressure {1e-3 * friction:.3g} kPa"
            )
        if self.motored_lead is not None:
            parts.append(f"motored peak {degrees(self.motored_lead):.2f} deg before dead centre")
        return "; ".join(parts)

    def as_record(self) -> IndicatedTorque:
        """JSON record of the measured values."""
        record: IndicatedTorque = {
            "indicated_torque_Nm": self.indicated,
            "indicated_torque_per_deg_Nm": self.slope * radians(1.0),
        }
        if self.brake is not None:
            record["brake_torque_Nm"] = self.brake
            record["friction_mep_kPa"] = 1e-3 * self._pressure(self.indicated - self.brake)
        if self.motored_lead is not None:
            record["motored_lead_deg"] = degrees(self.motored_lead)
        return record

    @property
    def _sensitivity(self) -> str:
        return f"{self.slope * radians(1.0):+.3g} N m with the dead centre 1 deg earlier"

    def _pressure(self, torque: float) -> float:
        """Mean effective pressure of a mean torque, Pa."""
        return torque * CYCLE_ANGLE / self.swept

    def _causes(self, brake: float) -> list[str]:
        """Sentences on the three errors of the pressure trace, of dead centre, gain or zero, each
        as large as would alone bring the indicated torque to the brake torque `brake`, N m.
        """
        missing = self._pressure(brake - self.indicated)
        if self.shift is None:
            centre = f"dead centre, but none within {degrees(SHIFT_MAX):g} deg"
        else:
            side = "earlier" if self.shift > 0.0 else "later"
            centre = f"dead centre {degrees(abs(self.shift)):.2g} deg {side}"
        centre += f" ({self._sensitivity})"
        if self.motored_lead is not None:
            centre += f", which the motored peak leads by {degrees(self.motored_lead):.2f} deg"
        gain = (
            f"gain, pressures times {brake / self.indicated:.3f}"
            if self.indicated > 0.0
            else "gain, but none makes a negative torque positive"
        )
        return [
            centre,
            gain,
            f"pegging that falls by {1e-3 * missing:.3g} kPa from compression to expansion, as by "
            "thermal shock; a constant error of pegging changes no mean torque",
        ]


def brake_balance(
    trace: PressureTrace,
    engine: PressureTable,
    brake: float | None = None,
    motored: PressureTrace | None = None,
) -> BrakeBalance:
    """Indicated torque of the mean cycle, its slope by the dead centre, and the brake torque.

    With the pressure p(theta) turned later by d, the mean torque of a cylinder is
    T(d) = (1 / 4 pi) oint p(u) V'(u + d) du; its slope has V''.

    Parameters
    ----------
    trace : PressureTrace    at its dead centre
    engine : PressureTable   crank drive
    brake : float or None    brake torque of all cylinders, N m
    motored : PressureTrace or None   without combustion, at the same dead centre
    """
    count, theta, pressure = len(engine.firing_offsets), trace.theta, trace.mean

    def indicated(shift: float) -> float:
        return count * float(np.mean(pressure * engine.volume_rate(theta + shift)))

    volume_rate_slope = engine.piston_area * engine.linkage.travel_acceleration(theta)
    shift = None
    if brake is not None:
        ends = [indicated(sign * SHIFT_MAX) - brake for sign in (-1.0, 1.0)]
        if ends[0] * ends[1] < 0.0:
            root = scipy.optimize.brentq(
                lambda angle: indicated(angle) - brake, -SHIFT_MAX, SHIFT_MAX, xtol=1e-9
            )
            shift = float(root)
    return BrakeBalance(
        trace.source,
        indicated(0.0),
        count * float(np.mean(pressure * volume_rate_slope)),
        count * engine.displacement,
        brake,
        shift,
        None if motored is None else dead_centre_offset(motored, "loss_angle", 0.0),
    )
