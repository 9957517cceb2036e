"""Form of ``crown.json``, the output of ``design crown --json``."""

from typing import Annotated, Literal, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import JsonBound, form

CrownKind = Literal["johns_gohar", "lundberg", "circular", "table"]
DropTable = Annotated[
    dict[str, list[float]], JsonBound(required=["y_mm", "drop_um", "drop_min_um"])
]


@form()
class CrownLengths(TypedDict):
    """Lengths of a crown, those of its kind alone."""

    line_load_N_per_mm: NotRequired[float]
    """Line load of which a logarithmic crown is made."""
    radius_mm: NotRequired[float]
    """Radius of a circular crown."""
    straight_length_mm: NotRequired[float]
    """Length between the reliefs of a table."""


@form()
class CrownShape(CrownLengths):
    """A crown, as the case states it."""

    kind: CrownKind
    """Kind of the crown in the case file."""
    drop_at_ends_um: float
    """Drop at the ends of its length."""
    length_mm: float
    """Length over which it extends."""


@form()
class CrownDrop(TypedDict):
    """An end of the range of the crowns within the ratio."""

    line_load_N_per_mm: float
    """Line load of the crown."""
    drop_at_ends_um: float
    """Drop at the ends of its length."""


@form()
class CrownState(TypedDict):
    """State of the greatest ratio."""

    load_case: str
    """Load case."""
    cam_angle_deg: float
    """Cam angle."""
    force_N: float
    """Normal force."""
    moment_Nmm: float
    """Moment that tilts the contact."""
    p0_MPa: float
    """Greatest pressure of plane strain."""


@form()
class CrownCentre(TypedDict):
    """Pressure in the middle over plane strain, at the greatest load, aligned."""

    straight: float
    """Without a crown."""
    crowned: float
    """With the crown."""


@form()
class CrownLife(TypedDict):
    """Load cycles of a body over those of plane strain."""

    body: str
    """Body, such as cam."""
    material: str
    """Name of its material."""
    pressure_exponent: float
    """Exponent of the pressure in its line of endurance."""
    straight: float
    """Without a crown."""
    crowned: float
    """With the crown."""


@form()
class CrownTilt(TypedDict):
    """Greatest pressure at a tilt."""

    moment_factor: float
    """Moment over the greatest one of each cam angle."""
    ratio: float
    """Greatest pressure over plane strain."""


@form()
class CrownDeviation(TypedDict):
    """Greatest pressure at a deviation of the drop."""

    deviation_um: float
    """Deviation of the drop at the ends."""
    ratio: float | None
    """Greatest pressure over plane strain; null where hardly any contact is left."""


@form()
class CrownLine(TypedDict):
    """Axial pressure at the governing state."""

    crown: Literal["straight", "crowned"]
    """Whether with the crown."""
    tilted: bool
    """Whether under the moment of the state."""
    y_mm: list[float]
    """Places from the middle along the contact."""
    pressure_over_plane_strain: list[float]
    """Pressure over the greatest of plane strain, at the places."""


@form()
class CrownDocument(TypedDict):
    """Crown in the middle of those within the ratio; ratios are of the greatest pressure.

    Each is over the greatest plane-strain pressure of its load case.
    """

    case: str
    """Name of the case."""
    on: str
    """Table of the crowned body: cam, roller or follower.face."""
    kind: CrownKind
    """Kind of crown that was sought."""
    ratio_limit: float
    """Greatest ratio allowed."""
    ratio: float
    """Greatest ratio with the crown."""
    ratio_straight: float
    """Greatest ratio without a crown."""
    crown: CrownShape | None
    """The crown; null: none is needed."""
    lightest: CrownDrop
    """Crown of the least drop within the ratio."""
    heaviest: CrownDrop | None
    """Crown of the greatest drop within the ratio; null: more than those tried."""
    governing: CrownState
    """State of the greatest ratio."""
    centre: CrownCentre
    """Pressure in the middle."""
    life: list[CrownLife]
    """Life of the bodies whose material has a line of endurance."""
    tilt: list[CrownTilt]
    """Greatest pressure by tilt."""
    tolerance: list[CrownDeviation]
    """Greatest pressure by deviation of the drop."""
    lines: list[CrownLine]
    """Axial pressure at the governing state."""
    drop_table: DropTable
    """Columns of the table for the workshop: place from the middle, drop, and those at the ends of
    the range."""
    toml: str
    """The crown as lines of a case file."""
