"""Trial: one cam, its solution and the checks of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.check import Check, Screen, Verdict, binding, screen, verdict
from camwright.pipeline.checks.tolerance_corners import Outcome
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import ContactMesh, Solution


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


@dataclass(frozen=True, eq=False)
class Trial:
    """A cam with its solution and checks.

    Parameters
    ----------
    number : int       from 1, within a run
    why : str          reason for the trial
    smoothing : SmoothingRecord
    solution : Solution
    checks : tuple     not evaluated first, then by falling utilisation
    synthesis : mapping   record of the constrained synthesis; None without one
    limits_in_use : tuple  cam angles (n,), rad, and utilisation (n,) of each limit by the id of its
                          check; None without a constrained synthesis
    corners : tuple    outcomes at the nominal and at each tolerance corner; empty: none was tried
    """

    number: int
    why: str
    smoothing: SmoothingRecord
    solution: Solution
    checks: tuple[Check, ...]
    synthesis: Mapping[str, Any] | None = None
    limits_in_use: tuple[Array, Mapping[str, Array]] | None = None
    corners: tuple[Outcome, ...] = ()

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
        """Ids of the must-have checks that fail or lack data; see `binding`."""
        return binding(self.checks)
