"""Exceptions of the project. A failed check is a result, not an exception."""

from __future__ import annotations

Refused = str | float | tuple[float, ...] | None
"""Value of an input that is out of bounds: text, number, shape, or None where it is missing."""


def in_millimetres(*lengths: float) -> tuple[str, ...]:
    """Lengths (m) as text in mm for a message: four digits, more where two would read alike."""
    for digits in (4, 8, 17):
        texts = tuple(f"{1e3 * length:.{digits}g} mm" for length in lengths)
        if len(set(texts)) == len(set(lengths)):
            break
    return texts


class CamError(Exception):
    """Error that the user can correct; its message is one line."""

    @property
    def lines(self) -> tuple[str, ...]:
        """The message, a line for each fault that it names."""
        return (str(self),)


class InputError(CamError):
    """Input value out of bounds.

    Parameters
    ----------
    field : str        dotted name of the input, such as ``roller.radius``
    value : Refused    value of the input
    limit : str        accepted values, such as ``> 0 m``

    The message rounds a float to four digits.
    """

    def __init__(self, field: str, value: Refused, limit: str) -> None:
        self.field, self.value, self.limit = field, value, limit
        super().__init__(field, value, limit)

    def __str__(self) -> str:
        """Message such as ``roller.radius = -0.01, must be > 0 m``: field, value, limit."""
        value = self.value
        text = f"{value:.4g}" if isinstance(value, float) else " ".join(str(value).split())
        return f"{_shortened(self.field)} = {_shortened(text)}, must be {self.limit}"


class SeveralInputsError(InputError):
    """Several input values out of bounds; field, value and limit are those of the first.

    Parameters
    ----------
    errors : tuple   all of them, one or more; the message has at most `MOST`, and the number of
                     the others
    """

    MOST = 12

    def __init__(self, errors: tuple[InputError, ...]) -> None:
        first, self.errors = errors[0], errors
        super().__init__(first.field, first.value, first.limit)

    def __str__(self) -> str:
        return "; ".join(self.lines)

    @property
    def lines(self) -> tuple[str, ...]:
        """A line each."""
        more = len(self.errors) - self.MOST
        shown = tuple(str(each) for each in self.errors[: self.MOST])
        return (*shown, f"{more} more") if more > 0 else shown


def as_one(errors: tuple[InputError, ...]) -> InputError:
    """One exception for several input errors; a single one is returned unchanged."""
    return errors[0] if len(errors) == 1 else SeveralInputsError(errors)


def _shortened(text: str) -> str:
    """Ends of a long text; paths and dotted keys end in names."""
    return text if len(text) <= 80 else f"{text[:30]}...{text[-47:]}"


class GeometryError(CamError):
    """Geometry that cannot be constructed."""


class MeshError(CamError):
    """Mesh that cannot be generated or is below its quality limits."""


class ContactError(CamError):
    """Contact solution that did not converge or is outside the range of its theory."""


class ResultError(CamError):
    """Result file or run folder that cannot be read or written."""


class AlteredError(ResultError):
    """Finished run whose files differ from the hashes in its record."""
