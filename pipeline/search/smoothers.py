"""Comparison of the smoothers on one case by previews: ranking, recommendation."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.errors import CamError, InputError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import in_order, verdict, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.check import Check
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.results.verdict_summary import WIDTH, shortened
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.judge import Depth, Judge
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.torque.torque import Torque

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
_DRAWN = Depth(corners=None, undercut=True)
_POSITIONS = 720
RANK = (
    "ranked: fewest failing must-have checks first, then least ripple left; a cam that removes "
    "less than 1 % of the ripple comes last"
)
_USELESS = 0.99  # of the ripple without the cam


@dataclass(frozen=True, eq=False)
class Compared:
    """Smoother with parameter in words, lift and record; lift None: it gives no cam.

    width: of the filter, rad of crank angle; None without a filter.
    """

    smoother: str
    words: str
    lift: Lift | None
    record: Record
    width: float | None = None

    @property
    def label(self) -> str:
        """Kind and width of the filter."""
        if not self.width:
            return self.smoother
        return f"{self.smoother} {in_unit(self.width, 'deg'):.4g} deg"

    @property
    def failing(self) -> tuple[str, ...]:
        """Ids of the failing must-have checks, worst first."""
        return self._names("failing")

    @property
    def missing(self) -> tuple[str, ...]:
        """Ids of the must-have checks without data."""
        return self._names("missing")

    def _names(self, key: str) -> tuple[str, ...]:
        names = self.record[key]
        return tuple(names) if isinstance(names, list) else ()

    def ripple(self, when: str = "residual") -> float:
        """Standard deviation of the crank torque, N m; when: "residual" or "initial"."""
        value = self.record.get(f"{when}_std_Nm")
        return value if isinstance(value, float) else math.inf

    @property
    def rank(self) -> tuple[bool, bool, int, float]:
        """Rank by `RANK`, least is best."""
        return self.lift is None, not self.reduces, len(self.failing), self.ripple()

    @property
    def reduces(self) -> bool:
        """Whether the cam removes at least 1 % of the ripple."""
        return self.ripple() < _USELESS * self.ripple("initial")


def compared(
    case: Case, torques: Mapping[str, Torque], progress: Progress = SILENT
) -> Iterator[Compared]:
    """Results of a case with each smoother by a preview, the constrained synthesis last; a smoother
    without a cam has the reason.

    Parameters
    ----------
    case : Case           with an engine
    torques : mapping     engine torque by load case
    progress : Progress   told the smoothers

    Raises
    ------
    InputError
        If the case has no engine.
    """
    if not torques:
        raise InputError("engine", "missing", "specified: smoothers act on its torque")
    case = case.with_positions(_POSITIONS)
    progress.stage("smoothers")
    for k, smoother in enumerate(_SMOOTHERS):
        progress.advance(k, len(_SMOOTHERS) + 1)
        words = smoother.width_in_words
        try:
            lift = cam_lift(case, torques, smoother)
            judgement = Judge(case, torques, lift=lift).judged(Change(), _DRAWN)
            record, width = _record(judgement.trial), smoother.angular_width
            yield Compared(smoother.kind, words, judgement.trial.lift, record, width)
        except CamError as error:
            yield _without(smoother.kind, words, error, smoother.angular_width)
    progress.advance(len(_SMOOTHERS), len(_SMOOTHERS) + 1)
    try:
        yield _constrained(case, torques)
    except CamError as error:
        yield _without("constrained", "least ripple within all limits", error)


def ranked(results: Sequence[Compared]) -> list[Compared]:
    """Results by `RANK`, the recommended smoother first."""
    return sorted(results, key=lambda one: one.rank)


def recommendation(best: Compared) -> str:
    """Sentence that recommends the best of the ranked smoothers, with the reason."""
    if best.lift is None:
        return "no smoother gives a cam"
    left, before = best.ripple(), best.ripple("initial")
    ripple = f"{left:.3g} N m of ripple left of {before:.3g} N m"
    if not best.reduces:
        return (
            f"no smoother reduces the ripple; {best.label} has the fewest failing checks: {ripple}"
        )
    if best.failing:
        count = len(best.failing)
        fewest = f"fewest failing must-have checks, {count}; none passes"
    else:
        fewest = "no must-have check fails"
    return f"recommended: {best.label}: {fewest}; {ripple}"


def common_missing(results: Sequence[Compared]) -> tuple[str, ...]:
    """Must-have checks without data under every smoother."""
    known = [one for one in results if one.lift is not None]
    shared = set.intersection(*(set(one.missing) for one in known)) if known else set()
    return tuple(sorted(shared))


def lines(results: Sequence[Compared]) -> list[str]:
    """Lines of text: recommendation, table of the smoothers by rank, missing data; at most `WIDTH`
    wide.

    Parameters
    ----------
    results : sequence   as `ranked` orders them
    """
    wide = max(len(one.label) for one in results)
    head = f"  {'smoother':{wide}}  {'ripple, N m':>11}  {'p0, MPa':>7}  must-have checks"
    table = [head]
    for k, one in enumerate(results):
        mark = ">" if k == 0 and one.reduces else " "
        ripple, p0 = (_number(one.record.get(key)) for key in ("residual_std_Nm", "p0_max_MPa"))
        start = f"{mark} {one.label:{wide}}  {ripple:>11}  {p0:>7}  "
        table.append(start + _state(one, WIDTH - len(start)))
    said = [recommendation(results[0]), *_missing_line(results), RANK]
    first, *rest = (textwrap.wrap(text, WIDTH, subsequent_indent="  ") for text in said)
    return [*first, *table, *(line for text in rest for line in text)]


def _missing_line(results: Sequence[Compared]) -> list[str]:
    """List with a line on the number of required checks without data under all smoothers; empty
    where no check lacks data.
    """
    common = len(common_missing(results))
    most = max(len(one.missing) for one in results)
    if not most:
        return []
    further = f" ({most} with some smoothers)" if most > common else ""
    return [
        f"missing data: must-have checks not evaluated: {common}{further}; they count as no failure"
    ]


def _state(one: Compared, columns: int) -> str:
    """Failing checks of a smoother, the worst first, or the reason why it gives no cam, in
    `columns` characters.
    """
    if one.lift is None:
        return shortened(f"no cam: {one.record['why']}", columns)
    if not one.failing:
        return "none fails"
    start = f"{len(one.failing)} fail: "
    return start + _listed_within(one.failing, columns - len(start))


def _listed_within(names: Sequence[str], columns: int) -> str:
    """As many names as fit into `columns` characters, with commas and the count of those left out;
    the first one shortened where none fits.
    """
    for shown in range(len(names), 0, -1):
        rest = len(names) - shown
        text = ", ".join(names[:shown]) + (f", +{rest}" if rest else "")
        if len(text) <= columns:
            return text
    return shortened(names[0], columns)


def _number(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else "-"


def _without(kind: str, words: str, error: CamError, width: float | None = None) -> Compared:
    record: Record = {"verdict": "fail", "failing": [], "missing": [], "why": str(error)}
    return Compared(kind, words, None, record, width)


def _constrained(case: Case, torques: Mapping[str, Torque]) -> Compared:
    """Result of the constrained synthesis of the case, in place of its smoother."""
    smoothing = case.smoothing.model_copy(update={"kind": "constrained"})
    judge = Judge(case.model_copy(update={"smoothing": smoothing}), torques)
    trial = judge.synthesised(Change()).trial
    feasible = trial.synthesis is not None and trial.synthesis["feasible"]
    words = (
        "least ripple within all limits" if feasible else "the synthesis ends outside the limits"
    )
    return Compared("constrained", words, trial.lift, _record(trial))


def _record(trial: Trial) -> Record:
    figures, checks = headline(trial.solution), within_depth(trial.checks)
    return {
        "pressure_angle_max_deg": figures["pressure_angle_max_deg"],
        "lift_max_mm": figures["lift_max_mm"],
        "normal_force_max_N": figures["normal_force_max_N"],
        "p0_max_MPa": figures["p0_max_MPa"],
        "initial_std_Nm": figures["torque_std_before_Nm"],
        "residual_std_Nm": figures["torque_std_after_Nm"],
        "residual_p2p_Nm": figures["torque_p2p_after_Nm"],
        "verdict": verdict(checks),
        "failing": _ids(checks, "fail"),
        "missing": _ids(checks, "not_evaluated"),
    }


def _ids(checks: Sequence[Check], status: str) -> list[str]:
    """Ids of the must-have checks of a status, the worst first."""
    return [one.id for one in in_order(checks) if one.must_have and one.status == status]
