"""Change of a case: other values at dotted keys, and the case with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.levers import BEARING, BUSH_A, BUSH_B, BUSH_PIVOT, CAM_MATERIAL
from camwright.pipeline.base.quantities import PURE
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.substitution import with_bush, with_cam_material, with_roller
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import with_values
from camwright.pipeline.case.case_values import quantity_of, replaced, unit_at, value_of
from camwright.pipeline.case.consistency import check_numbers
from camwright.pipeline.case.toml_text import TomlValue

PARTS = (BEARING, CAM_MATERIAL, BUSH_A, BUSH_B, BUSH_PIVOT)
"""Keys whose value is the name of a card."""


class Applicable(Protocol):
    """A change of a case: a `Change` of values, or parts with what depends on them."""

    def applied(self, case: Case, folder: Path | None) -> Case:
        """The case with the change; see `Change.applied`."""


@dataclass(frozen=True)
class Change:
    """Change of a case: new values at dotted keys.

    Parameters
    ----------
    values : tuple   dotted key and value: text as in a case file, a number in SI, or the name of a
                     card at one of `PARTS`
    """

    values: tuple[tuple[str, str | float], ...] = ()

    @classmethod
    def of(cls, values: Mapping[str, str] | Mapping[str, float]) -> Change:
        """Change to the values of a mapping, in its order."""
        return cls(tuple(values.items()))

    def __str__(self) -> str:
        return ", ".join(f"{key}: {value}" for key, value in self.values)

    def is_numbers_of(self, case: Case) -> bool:
        """Whether all values are numbers that replace numbers of a case.

        Those of a material are not: its bodies, which name it, have them by reading the case.
        """
        return not any(
            key in PARTS or key.startswith("materials.") or value_of(case, key) is None
            for key, _ in self.values
        )

    def applied(self, case: Case, folder: Path | None) -> Case:
        """A case with the values, read and checked as a case file.

        A part of the catalogue brings the values that depend on it: a bearing the size of the
        roller, its pin, the widths, the overhang and the mass, with the same base circle.

        Parameters
        ----------
        folder : Path   of the user's cards; None: shipped cards only

        Raises
        ------
        InputError
            If the values do not fit into the case.
        """
        values = dict(self.values)
        cards = {key: str(values[key]) for key in PARTS if key in values}
        entries = {key: _entry(key, value) for key, value in self.values if key not in PARTS}
        if entries:
            case = with_values(case, entries)
        for key, name in cards.items():
            if key == BEARING:
                case = with_roller(case, name, catalogue_of(folder).rollers[name], folder)
            elif key == CAM_MATERIAL:
                case = with_cam_material(case, name, folder)
            else:
                case = with_bush(case, key, name, folder)
        return case

    def replaced(self, case: Case) -> Case:
        """Case with its numbers replaced in place, without reading it anew; see `applied`.

        Sources are not compared with the values.

        Raises
        ------
        InputError
            If the numbers do not fit into the case.
        """
        case = replaced(case, {key: number_of(key, value) for key, value in self.values})
        check_numbers(case)
        return case


def number_of(key: str, value: str | float) -> float:
    """Value at a key of a case file as a number in SI; `value` is one, or text with a unit.

    Raises
    ------
    InputError
        If a text is no number in a unit of the key.
    """
    if not isinstance(value, str):
        return value
    if unit := unit_at(key):
        return units.parse(value, unit, key)
    try:
        return float(value)
    except ValueError:
        raise InputError(key, value, PURE) from None


def _entry(key: str, value: str | float) -> TomlValue:
    """Value as in the table of a case file."""
    mark = quantity_of(key)
    return value if mark is None or mark.unit else number_of(key, value)
