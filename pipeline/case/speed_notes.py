"""Notes on a measured crank speed: trigger wheel and working cycle."""

from __future__ import annotations

import numpy as np

from camwright.pipeline.base.units import shown
from camwright.pipeline.engine.cylinder import RunningGear
from camwright.pipeline.engine.speed_trace import SpeedTrace
from camwright.pipeline.engine.wheel_calibration import Calibration
from camwright.pipeline.records.run_summary import WheelErrors

WHEEL_BAR_MAX = 0.05
"""Error bar of the torque due to the wheel, of the torque from peak to peak, with a warning."""
TORQUE_CHANGE_MAX = 0.1
"""Change of the gas torque over the speeds of a calibration, with a warning."""
HALF_ORDERS = (0.6, 0.95)
"""Share of the half orders in the variance of the speed of one cylinder: motored, idling."""
HALF_ORDERS_MIN = 0.5
"""Share of one cylinder below which they are out of proportion to the integer orders."""
HALF_ORDERS_EVEN = 0.05
"""Share of cylinders that fire alike in both turns above which they are so."""

_ASSUMED = {
    "second_speed": "given the inertia of crankshaft and running gear and the same gas torque at "
    "both speeds",
    "run_down": "given the inertia of crankshaft and running gear and the same gas torque at all "
    "speeds",
    "no_torque": "given that no gas torque acts",
}


def calibration_record(calibration: Calibration | None) -> WheelErrors:
    """Pitch errors of the trigger wheel, deg, for ``run.json``: tolerance and, where they were
    estimated, rms of the errors corrected and of what is left, with the change of torque between
    the speeds in percent. Empty without a calibration.
    """
    if calibration is None:
        return {}
    errors = calibration.errors
    known: WheelErrors = {"pitch_tolerance_deg": float(np.degrees(errors.tolerance))}
    if not calibration.kind:
        return known
    return {
        **known,
        "pitch_errors_rms_deg": float(np.degrees(errors.rms)),
        "pitch_errors_left_deg": float(np.degrees(errors.residual)),
        "torque_change_percent": 100.0 * errors.torque_change,
    }


def speed_notes(
    trace: SpeedTrace, inertia: float, running_gear: RunningGear | None = None
) -> tuple[str, ...]:
    """Lines of text on pitch errors and half orders of a measured crank speed; those that need
    action begin with ``warning:``.

    Parameters
    ----------
    trace : SpeedTrace           the speed
    inertia : float              kg m2, of all parts that turn with the crank
    running_gear : RunningGear   None: taken for one cylinder
    """
    calibration = trace.calibration
    lines, warnings = [], _half_orders(trace, running_gear)
    if calibration is not None:
        lines = [_words(calibration)] if calibration.kind else []
        warnings = [*_contradictions(calibration), *_wide_bar(trace, inertia), *warnings]
    return (*lines, *(f"warning: {text}" for text in warnings))


def _words(calibration: Calibration) -> str:
    """Line of text on estimated pitch errors: their size, the assumption, and what remains."""
    errors, kind = calibration.errors, calibration.kind
    low, high = (shown(speed, "rpm") for speed in calibration.speeds)
    change = ""
    if errors.torque_change:
        change = f" (by the half orders it changes by {100.0 * errors.torque_change:.3g} %)"
    return (
        f"pitch errors of the wheel: {shown(errors.rms, 'deg', 2)} rms, corrected, "
        f"{shown(errors.residual, 'deg', 2)} rms remain; estimated from {low} to {high}, "
        f"{_ASSUMED[kind]}{change}"
    )


def _contradictions(calibration: Calibration) -> list[str]:
    """Notes on what contradicts the assumptions of a calibration; none where nothing does."""
    errors, texts = calibration.errors, []
    if calibration.too_wide:
        texts.append(
            f"the pitch errors of the wheel, {shown(errors.rms, 'deg', 2)} rms, exceed its "
            f"tolerance of {shown(errors.tolerance, 'deg', 2)} (engine.pitch_tolerance)"
        )
    if errors.torque_change > TORQUE_CHANGE_MAX:
        texts.append(
            "the gas torque is not the same at the speeds of engine.file and engine.reference: by "
            f"the half orders it changes by {100.0 * errors.torque_change:.3g} %; the error bar "
            "allows for twice as much in the integer orders"
        )
    return texts


def _wide_bar(trace: SpeedTrace, inertia: float) -> list[str]:
    """Note, in a list, that pitch errors leave an uncertainty of the torque above `WHEEL_BAR_MAX`
    of its peak to peak; empty where they do not.

    Parameters
    ----------
    trace : SpeedTrace   with its calibration
    inertia : float      of all parts that turn with the crank, kg m2
    """
    calibration = trace.calibration
    bar = float(trace.wheel_bar(inertia).max())
    swing = trace.torque(inertia).peak_to_peak
    if calibration is None or not bar > WHEEL_BAR_MAX * swing:
        return []
    share = 100.0 * bar / swing if swing > 0.0 else np.inf
    reach = f"make the torque uncertain by {bar:.3g} N m, {share:.3g} % of its peak to peak (95 %)"
    if calibration.kind:
        return [f"the pitch errors that remain {reach}; records at more distant speeds, or of more "
                "cycles, reduce them"]  # fmt: skip
    tolerance = shown(calibration.errors.tolerance, "deg", 2)
    return [
        f"pitch errors of the wheel, {tolerance} by engine.pitch_tolerance or engine.wheel_class, "
        f"cannot be separated from the torque and {reach}; a record at a second speed or of a "
        "run-down as engine.reference corrects them"
    ]


def _half_orders(trace: SpeedTrace, running_gear: RunningGear | None) -> list[str]:
    """Note, in a list, that the half orders of the cycle are out of proportion to the integer
    orders for the firing of the cylinders; empty where they are not.

    Parameters
    ----------
    trace : SpeedTrace           the speed
    running_gear : RunningGear   firing offsets; None: one cylinder
    """
    share = trace.half_order_share
    offsets = (0.0,) if running_gear is None else running_gear.firing_offsets
    alike = abs(np.exp(0.5j * np.array(offsets)).sum()) < 1e-6 * len(offsets)
    text = (
        f"half orders are {100.0 * share:.3g} % of the variance of the speed, the two turns of the "
        f"cycle correlate to {1.0 - 2.0 * share:.3f}"
    )
    if alike and share > HALF_ORDERS_EVEN:
        return [f"{text}; cylinders that fire evenly correlate to nearly 1: the cycle phase is "
                "wrong, or one cylinder differs from the others"]  # fmt: skip
    if not alike and share < HALF_ORDERS_MIN:
        low, high = (100.0 * one for one in HALF_ORDERS)
        return [f"{text}; of one cylinder they are {low:g} to {high:g} %: the cycle phase is "
                "uncertain or wrong, or pitch errors of the wheel outweigh the torque"]  # fmt: skip
    return []
