"""One limit: what is asked, what is allowed, who says so."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

Sense = Literal["at_most", "at_least"]
Status = Literal["pass", "fail", "not_evaluated", "waived"]


@dataclass(frozen=True)
class Check:
    """A demand beside its limit.

    Parameters
    ----------
    id, title : str          stable name, and what a reader sees
    demand, limit : float    in `unit`; None or NaN: the number is missing
    unit : str               as reported, such as MPa
    sense : str              "at_most": demand <= limit passes; "at_least": demand >= limit
    load_case : str          where the demand is worst; "" when it has none
    cam_angle_deg : float    where the demand is worst, deg; None when it has none
    source, method : str     clause behind the limit; how the demand was found, in words
    must_have : bool         decides the verdict
    lift_can_help : bool     a gentler lift can lower the demand
    waiver : str             name, reason and date; None when nobody waived it
    note : str               what a reader must know besides
    error_share : float      error bar of the demand over the demand; None: not known
    corner : str             the tolerance corner where the demand is worst; "" when none was tried
    corner_demand : float    the demand there; None when none was tried
    evidence : bool          tells of the numbers, not of the design: nobody can waive it
    """

    id: str
    title: str
    demand: float | None
    limit: float | None
    unit: str = ""
    sense: Sense = "at_most"
    load_case: str = ""
    cam_angle_deg: float | None = None
    source: str = ""
    method: str = ""
    must_have: bool = True
    lift_can_help: bool = False
    waiver: str | None = None
    note: str = ""
    error_share: float | None = None
    corner: str = ""
    corner_demand: float | None = None
    evidence: bool = False

    @property
    def error(self) -> float | None:
        """Half of the demand's error bar, in `unit`; None where nobody knows it."""
        demand, share = self.demand, self.error_share
        if demand is None or share is None or not math.isfinite(demand * share):
            return None
        return abs(demand) * share

    @property
    def margin(self) -> float | None:
        """What is left of the limit, as a share of it; negative beyond it."""
        used = self.utilisation
        return None if used is None else 1.0 - used

    @property
    def evaluated(self) -> bool:
        """Whether both numbers are there; NaN is a missing number, so is an infinite limit."""
        demand, limit = self.demand, self.limit
        return not (
            demand is None or math.isnan(demand) or limit is None or not math.isfinite(limit)
        )

    @property
    def utilisation(self) -> float | None:
        """Share of the limit in use, passing at <= 1; None when a number is missing.

        A demand that is not positive cannot meet a positive least value by any factor:
        infinite. So is a positive demand against a limit of zero.
        """
        if not self.evaluated:
            return None
        demand, limit = float(self.demand or 0.0), float(self.limit or 0.0)
        part, whole = (demand, limit) if self.sense == "at_most" else (limit, demand)
        if whole > 0:
            return part / whole
        return 0.0 if part <= whole else math.inf

    @property
    def status(self) -> Status:
        """`pass`, `fail`, `not_evaluated`, or `waived` where it would not have passed."""
        if self.evaluated and self._holds():
            return "pass"
        if self.waiver is not None:
            return "waived"
        return "fail" if self.evaluated else "not_evaluated"

    def _holds(self) -> bool:
        demand, limit = float(self.demand or 0.0), float(self.limit or 0.0)
        return demand <= limit if self.sense == "at_most" else demand >= limit

    @property
    def blocks(self) -> bool:
        """A must-have that neither passes nor is waived: the verdict is fail."""
        return self.must_have and self.status in ("fail", "not_evaluated")

    def as_record(self) -> dict[str, Any]:
        """The JSON record; numbers JSON cannot hold (missing, infinite) become null.

        An infinite utilisation therefore reads null beside the status `fail`, a missing one
        null beside `not_evaluated`.
        """
        return {
            "id": self.id,
            "title": self.title,
            "demand": _json_number(self.demand),
            "limit": _json_number(self.limit),
            "unit": self.unit,
            "utilisation": _json_number(self.utilisation),
            "status": self.status,
            "load_case": self.load_case,
            "cam_angle_deg": _json_number(self.cam_angle_deg),
            "source": self.source,
            "method": self.method,
            "sense": self.sense,
            "must_have": self.must_have,
            "lift_can_help": self.lift_can_help,
            "waiver": self.waiver,
            "note": self.note,
            "error": _json_number(self.error),
            "margin": _json_number(self.margin),
            "corner": self.corner,
            "corner_demand": _json_number(self.corner_demand),
            "evidence": self.evidence,
        }


def not_described(name: str, title: str, unit: str, note: str, *, must_have: bool) -> Check:
    """The check of a part that the case does not describe: not evaluated, and the note says why."""
    return Check(
        id=name,
        title=title,
        demand=None,
        limit=None,
        unit=unit,
        source=note,
        method="not evaluated",
        must_have=must_have,
        note=note,
    )


def _json_number(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)
