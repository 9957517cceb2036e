"""The exception family. A failed check is a result, not one of these."""

from __future__ import annotations

Refused = str | float | tuple[float, ...] | None
"""Value of an input that is out of bounds: text, number, shape, or None where it is missing."""


class CamError(Exception):
    """Anything the user can act upon; its message is one line."""


class InputError(CamError):
    """A value the user gave is out of bounds.

    Parameters
    ----------
    field : str    dotted name of the input, such as ``roller.radius``
    value : Refused    value of the input
    limit : str    what would be accepted, such as ``> 0 m``
    """

    def __init__(self, field: str, value: Refused, limit: str) -> None:
        self.field, self.value, self.limit = field, value, limit
        super().__init__(field, value, limit)

    def __str__(self) -> str:
        text = " ".join(str(self.value).split())
        shortened = text if len(text) <= 80 else f"{text[:30]}...{text[-47:]}"  # paths end in names
        return f"{self.field} = {shortened}, must be {self.limit}"


class GeometryError(CamError):
    """A shape that cannot be built."""


class MeshError(CamError):
    """A mesh that cannot be made or is not good enough."""


class ContactError(CamError):
    """A contact solution that did not converge or is out of its theory's range."""


class ResultError(CamError):
    """A run folder that cannot be read or written."""
