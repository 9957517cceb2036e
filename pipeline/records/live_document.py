"""Form of ``8_live.json``."""

from typing import Annotated, Literal

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import (
    Count,
    JsonBound,
    Least0,
    Least0Count,
    Unit,
    form,
)


@form()
class LiveFactor(TypedDict):
    """Number of the design that the live preview changes."""

    name: Unit
    """Name in words."""
    keys: Annotated[dict[str, float], JsonBound(minProperties=1)]
    """Keys of the case file with their values in the run, in the unit; all change in proportion."""
    unit: Unit
    """Unit of the values."""
    low: Least0
    """Least factor on the values."""
    high: Least0
    """Greatest factor on the values."""


@form()
class LiveSurface(TypedDict):
    """Polynomial of a quantity over the factors."""

    scale: Literal["linear", "log", "square"]
    """Scale of the polynomial: of the value, of its natural logarithm or of its square."""
    coefficients: Annotated[list[float], JsonBound(minItems=1)]
    """Coefficients of the terms; a single one is a constant."""
    error: Least0
    """Greatest deviation of the value from the preview."""
    share: bool
    """The error is a share of the value."""


@form()
class LiveContact(TypedDict):
    """Contact in a load case."""

    state: Least0Count
    """Number of the load case in `states`."""
    surface: LiveSurface
    """Least force that holds the follower on the cam, N."""


@form()
class LivePart(TypedDict):
    """Quantity in a load case."""

    state: int
    """Number of the load case in `states`; -1: of none, or of several together."""
    loads: list[Least0Count]
    """Load cases on whose loads it rests: no value where the follower leaves the cam in one."""
    surface: LiveSurface | None
    """Its values; null where too few designs have one."""


@form()
class LiveQuantity(TypedDict):
    """A quantity that the live preview follows; the worst of its parts counts."""

    id: Unit
    """Id of the check, or name of the key figure."""
    title: Unit
    """Name in words."""
    unit: Unit
    """Unit of value and limit; - for a pure number."""
    worst: Literal["greatest", "least"]
    """Which value of the load cases counts."""
    parts: Annotated[list[LivePart], JsonBound(minItems=1)]
    """Values by load case."""
    limit: LiveSurface | None
    """Limit of the check; null for a key figure."""


@form()
class LiveDocument(TypedDict):
    """Response surfaces of the live preview of a page."""

    case: str
    """Name of the case."""
    lift: Literal["run", "case"]
    """Lift of the designs: that of the run, or that of the case times its stroke."""
    factors: list[LiveFactor]
    """Numbers that change."""
    powers: list[list[Least0Count]]
    """Degrees of the Chebyshev polynomials in each term, a number a factor."""
    states: list[str]
    """Load cases, standstill and over-speed."""
    contact: list[LiveContact]
    """Contact by load case; below zero the follower leaves the cam. Of a cam that pulls none."""
    quantities: list[LiveQuantity]
    """Key figures, then checks by the utilisation in the run."""
    left_out: dict[str, str]
    """Checks among the greatest utilisations that are not followed, and why."""
    settings: Count
    """Designs to which the surfaces are fitted."""
    held_out: Count
    """Designs that state the errors."""
    refused: Least0Count
    """Designs within the ranges that the case refuses; no surface holds there."""
