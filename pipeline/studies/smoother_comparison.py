"""Comparison of the smoothers on one case by previews."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from camwright.geometry.errors import CamError, InputError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.check import binding, verdict, within_depth
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import solve

Record = dict[str, float | str | list[str] | None]

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
    """A smoother with its parameter in words, lift and record; lift None: no such cam."""

    smoother: str
    words: str
    lift: Lift | None
    record: Record


def compared(case: Case, torques: Mapping[str, Torque]) -> Iterator[Compared]:
    """Results of all smoothers, the constrained synthesis last.

    Raises
    ------
    InputError
        If the case has no engine.
    """
    if not torques:
        raise InputError("engine", "missing", "specified: smoothers act on its torque")
    case = case.with_positions(_POSITIONS)
    for smoother in _SMOOTHERS:
        words = smoother.width_in_words
        try:
            contour = case.contour(cam_lift(case, torques, smoother))
            trial = solve(case, contour, tier=Tier.PREVIEW, torques=torques)
            yield Compared(smoother.kind, words, trial.lift, _record(trial))
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
    trial = preview_case(case.model_copy(update={"smoothing": smoothing}))
    feasible = trial.synthesis is not None and trial.synthesis["feasible"]
    words = "least ripple within all limits" if feasible else "no cam keeps all limits"
    return Compared("constrained", words, trial.lift, _record(trial))


def _record(trial: Trial) -> Record:
    rest, checks = trial.cycles[0].turn.torque_after, within_depth(trial.checks)
    return {
        "pressure_angle_max_deg": in_unit(trial.contour.pressure_angle_max().value, "deg"),
        "lift_max_mm": in_unit(trial.lift.highest.value, "mm"),
        "normal_force_max_N": max(float(c.loads.normal_force.max()) for c in trial.cycles),
        "p0_max_MPa": in_unit(max(float(np.max(c.contact.p0)) for c in trial.cycles), "MPa"),
        "residual_std_Nm": None if rest is None else float(np.std(rest)),
        "residual_p2p_Nm": None if rest is None else float(np.ptp(rest)),
        "verdict": verdict(checks),
        "binding": list(binding(checks)),
    }
