"""Trial: cam, solution and checks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import (
    Screen,
    Verdict,
    binding,
    in_order,
    screen,
    verdict,
    within_depth,
)
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.check import Check, depends_on_lift
from camwright.pipeline.checks.lost_loads import load_ends
from camwright.pipeline.checks.tolerance_corners import Outcome
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import ContactMesh, Solution
from camwright.pipeline.records.run_summary import LoadEndRecord, TrialPointRecord
from camwright.pipeline.records.trial_contents import SynthesisRecord
from camwright.pipeline.results.check_records import CheckList, WithChecks


@dataclass(frozen=True)
class SmoothingRecord:
    """Smoothing of the torque: kind, description, strength, and width in rad of crank angle.

    strength and angular_width are None if no smoother of the torque drew the lift.
    """

    kind: str | None
    words: str
    strength: float | None = None
    angular_width: float | None = None


GIVEN_LIFT = SmoothingRecord(None, "a given lift")
CONSTRAINED = SmoothingRecord("constrained", "constrained: the least ripple within all limits")


@dataclass(frozen=True)
class TrialPoint:
    """Ripple and worst utilisation of a trial.

    Parameters
    ----------
    number : int          from 1, within a run
    ripple : float        std of the crank torque with the cam in the design load case, N m; None:
                          without an engine torque
    limit : str           id of the worst must-have check that depends on the lift; "": none
    utilisation : float   of it, infinite included; None: no such check
    passes : bool         no must-have check within the depth of the trial fails
    """

    number: int
    ripple: float | None
    limit: str
    utilisation: float | None
    passes: bool

    @classmethod
    def of(cls, trial: Trial) -> TrialPoint:
        """Ripple of a solved trial and the worst of its checks that depend on the lift."""
        judged = [
            one
            for one in within_depth(trial.checks)
            if one.must_have and depends_on_lift(one) and one.status in ("pass", "fail")
        ]
        worst = max(judged, key=lambda one: one.utilisation or 0.0, default=None)
        after = trial.cycles[0].turn.torque_after
        return cls(
            trial.number,
            None if after is None else float(np.std(after)),
            "" if worst is None else worst.id,
            None if worst is None or worst.utilisation == math.inf else worst.utilisation,
            screen(within_depth(trial.checks)) == "open",
        )

    def as_record(self) -> TrialPointRecord:
        """JSON record; a null utilisation is infinite, or belongs to no check."""
        use = self.utilisation
        return {
            "trial": self.number,
            "ripple_Nm": self.ripple,
            "limit": self.limit,
            "utilisation": None if use is None or np.isinf(use) else use,
            "passes": self.passes,
        }


@dataclass(frozen=True, eq=False, repr=False)
class Trial(WithChecks):
    """A cam with its solution and checks.

    Parameters
    ----------
    number : int       from 1, within a run
    why : str          reason for the trial
    smoothing : SmoothingRecord
    solution : Solution
    checks : tuple     not evaluated first, then by falling utilisation
    synthesis : SynthesisRecord   record of the constrained synthesis; None without one
    limits_in_use : tuple  cam angles (n,), rad, and utilisation (n,) of each limit by the id of its
                          check; None without a constrained synthesis
    corners : tuple    outcomes at the nominal and at each tolerance corner; empty: none was tried
    """

    number: int
    why: str
    smoothing: SmoothingRecord
    solution: Solution
    checks: tuple[Check, ...]
    synthesis: SynthesisRecord | None = None
    limits_in_use: tuple[Array, Mapping[str, Array]] | None = None
    corners: tuple[Outcome, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "checks", CheckList(self.checks))

    @property
    def facts(self) -> Mapping[str, object]:
        """Number, case, depth, verdict or screen, and the checks by status."""
        return {
            "number": self.number,
            "case": self.case.name,
            "depth": self.depth.word,
            **({"verdict": self.verdict} if self.verdict else {"screen": self.screen}),
            **CheckList(self.checks).facts,
        }

    @property
    def case(self) -> Case:
        """The case as solved, with spring and prime radius of a constrained synthesis."""
        return self.solution.case

    @property
    def contour(self) -> Contour:
        """Cam contour."""
        return self.solution.contour

    @property
    def lift(self) -> Lift:
        """Follower lift."""
        return self.solution.contour.pitch.lift

    @property
    def cycles(self) -> tuple[Cycle, ...]:
        """Cycles by load case, the design load case first."""
        return self.solution.cycles

    @property
    def mesh(self) -> ContactMesh | None:
        """Meshes at the maximum Hertz pressure; None without finite elements, or without a body."""
        return self.solution.mesh

    @property
    def certificate(self) -> tuple[CertificatePoint, ...]:
        """Angles solved in full; empty unless certified."""
        return self.solution.certificate

    @property
    def load_ends(self) -> list[LoadEndRecord]:
        """Records of the load cases in which the follower leaves the cam or locks."""
        return [
            {
                "load_case": end.load_case,
                "cam_angle_deg": in_unit(end.cam_angle, "deg"),
                "statement": end.words,
            }
            for end in load_ends(self.solution)
        ]

    @property
    def depth(self) -> Tier:
        """Depth of the solution."""
        return self.solution.tier

    @property
    def verdict(self) -> Verdict | None:
        """``fail``, ``incomplete`` or ``pass``, by the must-have checks; None below certified."""
        return verdict(self.checks) if self.depth is Tier.CERTIFIED else None

    @property
    def screen(self) -> Screen | None:
        """``fail`` if a must-have check fails, else ``open``; None of a certified solution."""
        return None if self.depth is Tier.CERTIFIED else screen(self.checks)

    @property
    def binding(self) -> tuple[str, ...]:
        """Ids of the must-have checks that fail or lack data; see `verdict.binding`."""
        return binding(in_order(self.checks))
