"""Form of ``design.json``, the output of ``design machine --json``."""

from typing import Annotated, Literal, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import JsonBound, Least0Count, form
from camwright.pipeline.records.judgement_record import PreviewJudgement

Number = str | float


@form()
class DesignOptions(TypedDict):
    """Options of a design, numbers in SI or text with a unit."""

    speed: NotRequired[Number]
    """Speed of the shaft, such as "1500 rpm"; required."""
    speeds: NotRequired[str | tuple[Number, Number]]
    """Range of speeds of the shaft, such as "800..3600 rpm"; default: that speed."""
    overspeed: NotRequired[Number]
    """Highest speed the parts must withstand; default: 1.2 times the greatest of these."""
    cycle: NotRequired[Number]
    """Shaft angle of a cycle of the torque, such as "360 deg"; default: of the table."""
    ratio: NotRequired[Number]
    """Shaft turns per cam turn, 2 or "3:2"; default: one cycle per cam turn."""
    space: NotRequired[Number]
    """From the far side of the cam to the top of the roller at full lift; default: any."""
    life: NotRequired[Number]
    """Life of the parts; default: "2000 h"."""
    ambient: NotRequired[Number]
    """Temperature of the surroundings; default: "40 degC"."""
    remove: NotRequired[Number]
    """Share of the torque ripple to remove; default: 50%."""


FromTo = TypedDict(
    "FromTo",
    {
        "from": Annotated[str, JsonBound(description="Value before, in words.")],
        "to": Annotated[str, JsonBound(description="Value after, in words.")],
    },
)
"""A change; its first key is no name of Python."""


@form()
class TorqueRecord(TypedDict):
    """Torque that the cam is to balance."""

    file: str
    """Name of the table."""
    cycle_deg: float
    """Shaft angle of a cycle."""
    ratio: float
    """Shaft turns per cam turn."""
    speed_rpm: float
    """Speed of the shaft."""
    overspeed_rpm: float
    """Greatest speed that the parts bear."""
    ripple_Nm: float
    """Standard deviation of the torque."""
    energy_swing_J: float
    """Energy that is stored in a cycle."""
    peak_Nm: float
    """Greatest magnitude of the torque about its mean."""
    values_Nm: list[float]
    """Torque about its mean, at equal shaft angles of a cycle."""


@form()
class DesignFigures(PreviewJudgement):
    """A design that passes by its preview."""

    size_mm: float
    """From the far side of the cam to the top of the roller at maximum lift."""
    removed: float
    """Share of the torque ripple that is removed."""
    roller: str
    """Name of the roller."""
    spring: str
    """Name of the spring, or its wire, diameter and coils."""
    offset_mm: float
    """Offset of the follower."""
    stem_mm: float
    """Diameter of the stem."""
    bore_mm: float
    """Bore of the cam."""


@form()
class DesignPointRecord(DesignFigures):
    """A design of the front."""

    file: str
    """Name of its case file."""
    envelope_mm: list[float]
    """Lengths of the whole mechanism across and along the stem and along the camshaft."""


@form()
class DesignDrawing(TypedDict):
    """Contour, roller and torque of a design, for its picture."""

    contour_mm: list[list[float]]
    """Places x and y of the contour at equal cam angles, in two rows."""
    roller_radius_mm: float
    """Radius of the roller."""
    roller_centre_mm: list[float]
    """Centre of the roller on the base circle."""
    torque_after_Nm: list[float]
    """Torque with the cam about its mean, at the cam angles of the solution."""
    to_be_confirmed: list[str]
    """Values on which the must-have checks rest and which no source confirms."""


@form()
class ExchangeRecord(FromTo):
    """Exchange of a part for a smaller one of its catalogue."""

    part: str
    """Part in words."""


@form()
class FailedExchange(ExchangeRecord):
    """An exchange with which the design does not pass."""

    why: str
    """Reason, in words."""


@form()
class ExchangesRecord(TypedDict):
    """Exchanges of parts."""

    kept: list[ExchangeRecord]
    """Exchanges with which the design passes, in their order."""
    failing: list[FailedExchange]
    """Exchanges of the last design, each of which fails."""
    complete: bool
    """Whether every part of it was tried."""
    claim: str
    """What the exchanges have shown."""


@form()
class ChosenDesign(DesignPointRecord, DesignDrawing):
    """The smallest of the designs that were solved and pass, its parts exchanged."""

    exchanges: ExchangesRecord
    """Exchanges of its parts."""


@form()
class RelaxationRecord(FromTo):
    """Change of one option with which a design passes."""

    option: str
    """Option of the command."""
    fails_at: str
    """Value with which none is found, in words."""
    options: DesignOptions
    """Options that are changed with it, as text with units."""
    command: str
    """Command line with the change."""


@form()
class DesignConflict(TypedDict):
    """What no design keeps together, and what ends the conflict."""

    limits: list[str]
    """Limits in words."""
    relaxations: list[RelaxationRecord]
    """Changes that each end the conflict, the smallest first."""


@form()
class ScreenedDesign(TypedDict):
    """A design of the screening."""

    size_mm: float
    """From the far side of the cam to the top of the roller at maximum lift."""
    ripple_left_Nm: float
    """Standard deviation of the torque with the cam."""
    within_limits: bool
    """Whether it is within all limits."""


@form()
class DesignDocument(TypedDict):
    """Designs of a torque."""

    schema: Literal[2]
    """Number of the form of this record."""
    torque: TorqueRecord
    """Torque that the cam is to balance."""
    assumed: list[str]
    """Options that are not given."""
    copied: list[str]
    """Files beside the case that are copies."""
    remove: float
    """Share of the torque ripple to remove."""
    space_mm: float | None
    """Limit of the size; null: any."""
    screened: Least0Count
    """Number of designs that were screened."""
    within_limits: Least0Count
    """Number of those within all limits."""
    cloud: list[ScreenedDesign]
    """Some of them."""
    points: list[DesignPointRecord]
    """Designs of the front that pass, by increasing size."""
    chosen: ChosenDesign | None
    """The smallest of them; null where none passes."""
    conflict: DesignConflict | None
    """What no design keeps together; null where one passes."""
