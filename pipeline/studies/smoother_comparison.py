"""Smoothers side by side: the same case, each way to draw the lift, judged by closed forms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError, InputError
from camwright.geometry.lift import Lift
from camwright.pipeline import solver as road
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import design_checks
from camwright.pipeline.checks.verdict import binding, verdict
from camwright.pipeline.cycle import cycle as cycles
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.preview import look_ahead
from camwright.pipeline.smoothing.smoothers import Smoother

_SMOOTHERS = (
    Smoother("none"),
    Smoother("moving_average", points=12, spacing=float(np.radians(5.0))),
    Smoother("moving_average", points=12, spacing=float(np.radians(10.0))),
    Smoother("savitzky_golay", points=24, spacing=float(np.radians(5.0))),
    Smoother("gaussian", width=float(np.radians(60.0))),
    Smoother("harmonic", harmonics=12.0),
    Smoother("smoothing_spline", cutoff=float(np.radians(120.0))),
)
_POSITIONS = 720


@dataclass(frozen=True, eq=False)
class Compared:
    """One way to draw the lift and what it leads to; lift None: there is no such cam."""

    smoother: str
    words: str
    lift: Lift | None
    record: Mapping[str, Any]


def compared(case: Case, torques: Mapping[str, Torque]) -> Iterator[Compared]:
    """Every smoother in turn, the constrained synthesis last.

    Raises
    ------
    InputError
        If the case has no engine.
    """
    if not torques:
        raise InputError("engine", "missing", "given: smoothers work on its torque")
    case = case.with_positions(_POSITIONS)
    for smoother in _SMOOTHERS:
        words = smoother.width_in_words
        try:
            lift = road.designed_lift(case, torques, smoother)
            yield _judged(case, torques, smoother.kind, words, lift)
        except CamError as error:
            yield _without(smoother.kind, words, error)
    try:
        yield _constrained(case)
    except CamError as error:
        yield _without("constrained", "least ripple within all limits", error)


def _without(kind: str, words: str, error: CamError) -> Compared:
    return Compared(kind, words, None, {"verdict": "fail", "binding": [], "why": str(error)})


def _constrained(case: Case) -> Compared:
    smoothing = case.smoothing.model_copy(update={"kind": "constrained"})
    seen = look_ahead(case.model_copy(update={"smoothing": smoothing}))
    kept = seen.design is not None and seen.design.feasible
    words = "least ripple within all limits" if kept else "no cam keeps all limits"
    record = _record(seen.case, seen.contour, seen.cycles)
    return Compared("constrained", words, seen.contour.pitch.lift, record)


def _judged(
    case: Case, torques: Mapping[str, Torque], kind: str, words: str, lift: Lift
) -> Compared:
    contour = road.cam_contour(case, lift)
    turns = road.turns_of(case, contour, torques, _POSITIONS)
    found = tuple(cycles.closed_form_cycle(case, contour, given) for given in turns)
    return Compared(kind, words, lift, _record(case, contour, found))


def _record(case: Case, contour: Contour, found: tuple[cycles.Cycle, ...]) -> dict[str, Any]:
    checks = design_checks(TrialEvidence(case=case, contour=contour, cycles=found))
    rest = found[0].residual_torque
    return {
        "pressure_angle_max_deg": float(np.degrees(contour.pitch.pressure_angle_max().value)),
        "lift_max_mm": 1e3 * contour.pitch.lift.highest.value,
        "normal_force_max_N": max(float(c.loads.normal_force.max()) for c in found),
        "p0_max_MPa": 1e-6 * max(float(np.max(c.contact.p0)) for c in found),
        "residual_std_Nm": None if rest is None else float(np.std(rest)),
        "residual_p2p_Nm": None if rest is None else float(np.ptp(rest)),
        "verdict": verdict(checks),
        "binding": list(binding(checks)),
    }
