"""Form of ``corners.json``."""

from typing import Annotated, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import Count, JsonBound, Least0Count, Unit, form


@form()
class CornerRecord(TypedDict):
    """A tolerance corner: factors on the nominal values, and the demands there."""

    name: Unit
    """Name of the corner; the first is nominal."""
    friction_a: float
    """Factor on the friction of guide A."""
    friction_b: float
    """Factor on the friction of guide B."""
    rate: float
    """Factor on the spring rate."""
    preload: float
    """Factor on the preload of the spring."""
    mass: float
    """Factor on the mass that moves with the follower."""
    inertia: float
    """Factor on the moment of inertia of the crankshaft."""
    phase: float
    """Shift of the cam against the crank, rad of the crank."""
    profile: float
    """Offset of the contour outwards, m."""
    demands: dict[str, float | None]
    """Demands by id of the check, in its unit; null: infinite. Empty where it is refused."""
    refused: str
    """Reason why the corner cannot be solved; empty where it is solved."""
    lost: str
    """Loads that are lost there, in words; empty without any."""
    deviation: NotRequired[dict[str, float]]
    """Deviations of tracks and rollers of a cam that pulls by their names, m; turn: rad."""


@form()
class CornersDocument(TypedDict):
    """Demands at the tolerance corners."""

    seed: int
    """Seed of the sample of all tolerances."""
    tried: Least0Count
    """Number of corners, without the nominal one."""
    positions: Count
    """Cam angles of a turn."""
    method: str
    """Calculation of the demands, in words."""
    corners: Annotated[list[CornerRecord], JsonBound(minItems=1)]
    """The nominal machine, then the corners."""
