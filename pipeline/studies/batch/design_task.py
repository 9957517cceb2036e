"""Tasks of a study: designs of one case solved together, common settings, runs to keep.

A worker of the cluster reads them; none needs a case.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.tiers import Tier

if TYPE_CHECKING:
    from camwright.pipeline.studies.batch.factor_axes import Levels


@dataclass(frozen=True)
class Settings:
    """Settings, besides the designs, on which the rows depend.

    templates: hash by case name; versions: of the program and its libraries.
    """

    templates: Mapping[str, str]
    versions: Mapping[str, str]
    cam: str
    positions: int | None
    corners: bool
    outputs: tuple[str, ...]
    seconds: float
    bytes: int

    @property
    def sha256(self) -> str:
        """Hash of all settings."""
        text = json.dumps(vars(self), sort_keys=True, default=dict)
        return hashlib.sha256(text.encode()).hexdigest()


@dataclass(frozen=True)
class Wanted:
    """Rule for which designs a run folder is made with their row.

    Parameters
    ----------
    screen : str         of these designs
    objectives : tuple   column and sign of each value that is minimised
    bars : tuple         values of designs that are solved: what one of them dominates is not kept
    """

    screen: str
    objectives: tuple[tuple[str, float], ...] = ()
    bars: tuple[tuple[float, ...], ...] = ()

    def takes(self, screen: str, cells: Mapping[str, object]) -> bool:
        """Whether the run folder of a design may be kept by the rule; True where a value of an
        objective is not known yet.

        Parameters
        ----------
        screen : str      of the design
        cells : mapping   its values by name of column
        """
        if screen != self.screen or any(name not in cells for name, _ in self.objectives):
            return screen == self.screen  # a factor is no cell of a solution
        values = [(sign, cells[name]) for name, sign in self.objectives]
        return self.may_keep(
            tuple(sign * value if isinstance(value, float) else math.nan for sign, value in values)
        )

    def may_keep(self, point: tuple[float, ...]) -> bool:
        """Whether no bar dominates these values, with their signs; () without objectives."""
        return all(map(math.isfinite, point)) and not any(
            all(map(float.__le__, bar, point)) and bar != point for bar in self.bars
        )


@dataclass(frozen=True, eq=False)
class Task:
    """Shard: designs of one case at one depth, solved together.

    Parameters
    ----------
    name : str          content hash, the name of the shard
    case : str          name of the case
    tier : Tier
    ids : tuple         of the designs
    values : mapping    by key, SI, (n,)
    shown : mapping     by key, in the unit of the study file, (n,)
    units : mapping     by key; None: names
    """

    name: str
    case: str
    tier: Tier
    ids: tuple[str, ...]
    values: Mapping[str, Array | Levels]
    shown: Mapping[str, Array | Levels]
    units: Mapping[str, str | None]

    def alone(self, row: int) -> Task:
        """Task of a single one of its designs."""

        def one(columns: Mapping[str, Array | Levels]) -> dict[str, Array | Levels]:
            return {key: values[row : row + 1] for key, values in columns.items()}

        return Task(
            self.name, self.case, self.tier, self.ids[row : row + 1],
            one(self.values), one(self.shown), self.units,
        )  # fmt: skip

    def value_of(self, row: int) -> dict[str, str | bool | int | float]:
        """Values of one design by key, SI."""
        return {key: _scalar(values[row]) for key, values in self.values.items()}


def _scalar(value: str | bool | int | float) -> str | bool | int | float:
    return value.item() if isinstance(value, np.generic) else value
