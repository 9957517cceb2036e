"""What a trial lays before the checks, and where in it a demand is worst."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour

if TYPE_CHECKING:
    from camwright.meshes.mesh_quality import Quality
    from camwright.pipeline.case.case import Case
    from camwright.pipeline.case.parts_section import Face, Material, Roller
    from camwright.pipeline.checks.check import Check
    from camwright.pipeline.contact.contact_history import CertificatePoint
    from camwright.pipeline.cycle.cycle import Cycle
    from camwright.pipeline.cycle.part_loads import PartsHistory


@dataclass(frozen=True, eq=False)
class TrialEvidence:
    """All a verdict may lean on.

    Parameters
    ----------
    case : Case
    contour : Contour
    cycles : tuple of Cycle                   one a load case
    mesh_quality : Quality                    None when the trial made no mesh
    certificate : tuple of CertificatePoint   empty when none was asked for
    benchmarks : mapping                      as `contact_benchmarks` gives it; None: not solved
    speed_ripple : mapping                    load case -> std of the crank speed, rad/s, without
                                              and with the cam; empty when no crankshaft is known
    searching : bool                          one trial of a search; the answer alone is certified
    """

    case: Case
    contour: Contour
    cycles: tuple[Cycle, ...]
    mesh_quality: Quality | None = None
    certificate: tuple[CertificatePoint, ...] = ()
    benchmarks: Mapping[str, float] | None = None
    speed_ripple: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    searching: bool = False

    @property
    def rolls(self) -> bool:
        """Whether the follower has a roller; else a flat face slides on the cam."""
        return self.contour.rolls

    @property
    def face(self) -> Face | None:
        """The flat face of the follower; None where it has a roller."""
        return None if self.rolls else self.case.follower.face

    @property
    def facing(self) -> Roller | Face:
        """The part of the follower that touches the cam."""
        return self.face or self.case.roller

    @property
    def facing_name(self) -> str:
        """What that part is called."""
        return "roller" if self.rolls else "face"

    def cam_speed(self, cycle: Cycle) -> float:
        """Cam speed of a load case, rad/s."""
        return float(cycle.crank_speed / self.case.mechanism.gear_ratio)

    def preload(self, cycle: Cycle) -> float:
        """Preload of the spring in a load case, N."""
        return self.case.at(cycle.load_case).spring.preload

    @property
    def parts(self) -> Mapping[Cycle, PartsHistory] | None:
        """The parts by their cycle; None in a look ahead, which does without."""
        return {c: c.parts for c in self.cycles if c.parts is not None} or None

    def source(self, name: str, default: str, *figures: str) -> str:
        """The clause behind a limit of the case: its own words where it has some.

        The figures' origin is cited in either case, so that a recalled one stays one.

        Parameters
        ----------
        name : str   of the limit in the case
        """
        return cited(self.case.limits.sources.get(name) or default, *figures)


def cited(clause: str, *figures: str) -> str:
    """A clause, and where its figures come from as far as that is not the same."""
    return "; ".join([clause, *(figure for figure in figures if figure and figure != clause)])


def rollers_only(
    check: Callable[[TrialEvidence], Check | None],
) -> Callable[[TrialEvidence], Check | None]:
    """The check where the follower has a roller; none under a flat face."""

    @wraps(check)
    def asked(evidence: TrialEvidence) -> Check | None:
        return check(evidence) if evidence.rolls else None

    return asked


def cam_card(evidence: TrialEvidence) -> tuple[str, Material]:
    """Name and card of the cam's material."""
    name = evidence.case.cam.material
    return name, evidence.case.materials[name]


class Worst(NamedTuple):
    """The value that decides, and where: `place` fills the fields of a Check.

    error_share is what the samples' peak may miss of the true one, over the value.
    """

    value: float
    load_case: str
    cam_angle_deg: float | None
    error_share: float = 0.0

    @property
    def place(self) -> dict[str, Any]:
        return {
            "load_case": self.load_case,
            "cam_angle_deg": self.cam_angle_deg,
            "error_share": self.error_share,
        }


def greatest(evidence: TrialEvidence, measure: Callable[[Cycle], Array]) -> Worst:
    """The greatest of a measure over all load cases and angles; a NaN wins.

    Parameters
    ----------
    measure : callable   cycle -> array (n,), one value an angle
    """
    return _extreme(evidence, measure, 1.0)


def least(evidence: TrialEvidence, measure: Callable[[Cycle], Array]) -> Worst:
    """The least of a measure over all load cases and angles; a NaN wins."""
    return _extreme(evidence, measure, -1.0)


def worst_case(
    evidence: TrialEvidence, measure: Callable[[Cycle], float], at_least: bool = False
) -> Worst:
    """The load case with the greatest (or least) value of a measure of the whole turn."""
    return _extreme(evidence, lambda c: np.array([measure(c)]), -1.0 if at_least else 1.0, False)


def _extreme(
    evidence: TrialEvidence, measure: Callable[[Cycle], Array], sign: float, angle: bool = True
) -> Worst:
    found = Worst(np.nan, "", None)
    for cycle in evidence.cycles:
        values = np.asarray(measure(cycle), dtype=float)
        worst = int(np.argmax(sign * values))  # the first NaN, where there is one
        value = float(values[worst])
        if found.load_case and not (np.isnan(value) or sign * value > sign * found.value):
            continue
        degrees = float(np.rad2deg(cycle.theta[worst])) if angle else None
        share = _missed_between_samples(values, worst) if angle and values.size > 2 else 0.0
        found = Worst(value, cycle.load_case, degrees, share)
    return found


def _missed_between_samples(values: Array, worst: int) -> float:
    """What the vertex of the parabola through three samples lies beyond the middle one, share.

    A kink has no vertex; the parabola then says less than half a step of the slope, and that
    is what it is good for.
    """
    before, here, after = values[worst - 1], values[worst], values[(worst + 1) % values.size]
    if not np.isfinite([before, here, after]).all():
        return 0.0
    bend = before - 2.0 * here + after
    if bend == 0.0 or here == 0.0:
        return 0.0
    return float(abs((after - before) ** 2 / (8.0 * bend) / here))
