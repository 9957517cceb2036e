"""Form of ``inspection.json``, the output of ``inspect --json``."""

from typing import NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Verdict
from camwright.pipeline.records.forms import Count, Least0, Names, form
from camwright.pipeline.records.run_summary import ScopeRecord


@form()
class CycleFigures(TypedDict):
    """Key figures as those of a run, of the load cases in which the follower neither leaves the cam
    nor locks; null: not applicable.
    """

    normal_force_max_N: float | None
    """Greatest contact force."""
    normal_force_min_N: float | None
    """Least contact force; 0 where it passes from one track to another."""
    p0_max_MPa: float | None
    """Greatest contact pressure."""
    von_mises_max_MPa: float | None
    """Greatest von Mises stress below the contact."""
    pressure_angle_max_deg: float | None
    """Greatest magnitude of the pressure angle."""
    torque_after_std_Nm: NotRequired[float]
    """Standard deviation of the crank torque in the design load case; of an engine."""


@form()
class InspectionDocument(TypedDict):
    """A measured cam against its run."""

    track: NotRequired[str]
    """Measured wall of a groove or disc of a pair, where it was stated."""
    clearance_um: NotRequired[list[float]]
    """Least and greatest clearance between two tracks over the turn, the other one as drawn; of an
    interference below zero."""
    phase_deg: float
    """Angle by which the measured contour is turned."""
    size_um: float
    """Mean deviation of the radius."""
    deviation_min_um: float
    """Least deviation from the drawing."""
    deviation_max_um: float
    """Greatest deviation from the drawing."""
    scatter_rms_um: float
    """Scatter of the points about the fitted form."""
    points: Count
    """Number of measured points."""
    tolerance_um: float
    """Width of the tolerance zone."""
    within_tolerance: bool
    """Whether all points lie in the tolerance zone."""
    waves_um: dict[str, Least0]
    """Amplitudes of the largest waves by their number per turn."""
    nominal: CycleFigures
    """Figures of the run."""
    measured: CycleFigures
    """Figures of the measured contour."""
    verdict: Verdict
    """Verdict on the measured contour."""
    verdict_line: str
    """Verdict with the counts of the checks behind it."""
    scope: ScopeRecord
    """Parts that the sign-off does not cover."""
    binding: Names
    """Ids of the must-have checks that fail or lack data."""
