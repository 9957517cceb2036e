"""Form of the output of ``design sizes --json``."""

from typing import NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Verdict
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.forms import Names, form


@form()
class SizedKey(TypedDict):
    """Value of an open key, as in the complete case."""

    value: float
    """Value in its unit."""
    unit: str
    """Unit of the value."""
    source: str
    """Reason of the value."""


@form()
class SizeLengths(TypedDict):
    """Lengths of a cam of either follower."""

    base_radius_mm: float
    """Base radius of the cam."""
    offset_mm: float
    """Offset of the follower."""
    governs: str
    """What governs the base radius, in words."""
    centre_distance_mm: NotRequired[float]
    """Distance of the pivot of an arm from the cam axis; absent of a stem."""


@form()
class RollerSizeRecord(SizeLengths):
    """A cam with a roller or the curved face of an arm, with its extremes on the exact lift."""

    prime_radius_mm: float
    """Prime radius of the cam."""
    roller_radius_mm: float
    """Radius of roller or curved face."""
    pressure_angle_rise_deg: float
    """Greatest pressure angle of the rise."""
    pressure_angle_rise_at_deg: float
    """Cam angle of it."""
    pressure_angle_return_deg: float
    """Greatest pressure angle of the return."""
    pressure_angle_return_at_deg: float
    """Cam angle of it."""
    convex_pitch_radius_min_mm: float
    """Least convex radius of the pitch curve."""
    concave_pitch_radius_min_mm: float | None
    """Least concave radius of the pitch curve; null: it is convex."""
    second_prime_radius_mm: NotRequired[float]
    """Prime radius of the second disc of a conjugate pair; absent without one."""
    second_roller_radius_mm: NotRequired[float]
    """Radius of its roller."""


@form()
class FaceSizeRecord(SizeLengths):
    """A cam with a flat face, with its extremes on the exact lift."""

    face_width_mm: float
    """Width of the face."""
    radius_of_curvature_min_mm: float
    """Least radius of curvature of the contour."""
    undercut_factor_min: float
    """Least factor against undercut."""


@form()
class SizedSpring(TypedDict):
    """Spring of the complete case."""

    rate_N_per_mm: float
    """Rate of the spring."""
    preload_N: float
    """Preload of the spring."""
    force_at_full_lift_N: float
    """Force at full lift."""
    energy_at_full_lift_J: float
    """Energy at full lift."""
    active_mass_max_g: float
    """Mass of the active coils at which the surge frequency is at its limit."""


@form()
class SizeCurve(TypedDict):
    """A quantity over the base radius."""

    label: str
    """Name of the curve; empty of the only one."""
    x: list[float]
    """Base radii, mm."""
    y: list[float]
    """Values, in the unit of the panel."""
    dashed: bool
    """Whether it is drawn dashed."""


@form()
class SizePanel(TypedDict):
    """Curves of a quantity with its limits."""

    quantity: str
    """Quantity in words."""
    unit: str
    """Unit of the quantity; empty for a pure number."""
    limits: dict[str, float]
    """Limits by label."""
    curves: list[SizeCurve]
    """Curves over the base radius."""


@form()
class SizeChart(TypedDict):
    """Pressure angle and curvature over the base radius."""

    base_radius_mm: float
    """Base radius of the sized cam."""
    panels: list[SizePanel]
    """A panel for each quantity."""


@form()
class SizeDocument(TypedDict):
    """Sizes that a case left open."""

    case: str
    """Name of the case."""
    follower: str
    """Kind of the follower."""
    verdict: Verdict
    """Verdict of the checks that the open keys decide; pass without any."""
    sized: dict[str, SizedKey]
    """Sized values by key of the case file."""
    smallest: RollerSizeRecord | FaceSizeRecord
    """The exact cam at the geometric limits, nominal."""
    drawn: RollerSizeRecord | FaceSizeRecord
    """The cam of the complete case."""
    spring: SizedSpring
    """Spring of the complete case."""
    checks: list[CheckRecord]
    """Checks of the preview that the open keys decide."""
    other_failures: Names
    """Ids of the other must-have checks that fail."""
    chart: SizeChart
    """Pressure angle and curvature over the base radius."""
