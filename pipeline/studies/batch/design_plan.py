"""Plan of a study: content hash of each design, tasks of one shard each."""

from __future__ import annotations

import hashlib
import importlib.metadata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.studies.batch.design_task import Settings, Task
from camwright.pipeline.studies.batch.factor_axes import Levels
from camwright.pipeline.studies.batch.sampling import SampledDesigns

SHARD_OF: Mapping[Tier, int] = {
    Tier.SCREENING: 500, Tier.PREVIEW: 5, Tier.CYCLE: 5, Tier.CERTIFIED: 1,
}  # fmt: skip
"""Most designs of a shard: a second or so of work, so that the milliseconds of the scheduler and of
the main process are few."""
_TAIL, _LEAST_PART = 6, 5
"""A shard holds at most a sixth of the designs left, and at least a fifth of a full shard."""
_ID = 24  # hex digits: 96 bits
CASE = "case"
"""Factor that names the case, in a study of several."""


@dataclass(frozen=True, eq=False)
class Plan:
    """Numbered designs of a study, with the unique ones among them.

    Parameters
    ----------
    cases : tuple        names, one block of designs each
    designs : SampledDesigns    of each case; None: the cases are the designs
    ids : tuple          of the unique designs, in order of their first number
    place : array (n,)   unique design of each number
    """

    cases: tuple[str, ...]
    designs: SampledDesigns | None
    ids: tuple[str, ...]
    place: NDArray[np.intp]
    settings: Settings
    _first: NDArray[np.intp]

    @classmethod
    def of(cls, cases: Sequence[str], designs: SampledDesigns | None, settings: Settings) -> Plan:
        """Plan of a study: its designs for each case, of which equal ones, by a hash of case,
        values and settings, are solved once.

        Parameters
        ----------
        cases : sequence           names of the base cases
        designs : SampledDesigns   values of the factors; None: the cases themselves are the designs
        settings : Settings        of the study
        """
        count = 1 if designs is None else designs.count
        columns = {} if designs is None else designs.si()
        keys = sorted(columns)
        lists = [_list(columns[key]) for key in keys]
        known: dict[str, int] = {}
        first: list[int] = []
        place = np.empty(count * len(cases), dtype=np.intp)
        for block, case in enumerate(cases):
            head = f"{settings.templates[case]}\0{settings.cam}"
            for row in range(count):
                words = [f"\0{key}={each[row]!r}" for key, each in zip(keys, lists, strict=True)]
                text = "".join([head, *words])
                name = hashlib.sha256(text.encode()).hexdigest()[:_ID]
                number = block * count + row
                place[number] = known.setdefault(name, len(known))
                if len(known) > len(first):
                    first.append(number)
        return cls(
            tuple(cases), designs, tuple(known), place, settings, np.array(first, dtype=np.intp)
        )

    @property
    def units(self) -> dict[str, str | None]:
        """Unit of each factor by key; None: names."""
        several: dict[str, str | None] = {CASE: None} if len(self.cases) > 1 else {}
        return several | ({} if self.designs is None else self.designs.units)

    def whole(self, unique: int) -> int:
        """Number of leading designs that lie among the first so many unique ones."""
        return len(self.place) if unique >= len(self.ids) else int(self._first[unique])

    def tasks(self, tier: Tier, chosen: Sequence[int] | None = None) -> Iterator[Task]:
        """Tasks of a few different designs each, all of one case, to be solved at one depth, in the
        order of the designs.

        Parameters
        ----------
        tier : Tier         depth
        chosen : sequence   indices of the unique designs; None: all
        """
        places = range(len(self.ids)) if chosen is None else chosen
        count = 1 if self.designs is None else self.designs.count
        blocks: dict[int, list[int]] = {}
        for unique in places:
            blocks.setdefault(int(self._first[unique]) // count, []).append(unique)
        left = len(places)
        for block, members in blocks.items():
            start = 0
            while start < len(members):
                part = members[start : start + shard_size(left, SHARD_OF[tier])]
                yield self._task(tier, block, part)
                start, left = start + len(part), left - len(part)

    def _task(self, tier: Tier, block: int, members: Sequence[int]) -> Task:
        """Task that solves some unique designs of one case; its name is a hash of its content.

        Parameters
        ----------
        tier : Tier          depth
        block : int          index of the case
        members : sequence   indices of the unique designs
        """
        case, units = self.cases[block], self.units
        ids = tuple(self.ids[unique] for unique in members)
        values: dict[str, Array | Levels] = {}
        shown: dict[str, Array | Levels] = {}
        if CASE in units:
            shown[CASE] = (case,) * len(ids)
        if self.designs is not None:
            rows = self._first[np.array(members, dtype=np.intp)] - block * self.designs.count
            taken = {key: _taken(column, rows) for key, column in self.designs.columns.items()}
            shown |= taken
            values = SampledDesigns(self.designs.axes, taken, len(ids)).si()
        text = "\0".join((self.settings.sha256, tier.word, *units, *ids))
        name = hashlib.sha256(text.encode()).hexdigest()[:32]
        return Task(name, case, tier, ids, values, shown, units)


def shard_size(left: int, most: int) -> int:
    """Designs in the next shard, fewer towards the end so that processes finish together.

    It does not depend on the number of processes, nor do the bytes of a study.

    Parameters
    ----------
    left : int   designs of the stage in no shard yet
    most : int   of a full shard

    References
    ----------
    Polychronopoulos and Kuck, Guided self-scheduling, IEEE Trans. Comput. C-36 (1987) 1425.
    """
    return min(most, max(-(-left // _TAIL), -(-most // _LEAST_PART)))


def study_versions() -> dict[str, str]:
    """Versions of program and libraries on which the rows and their bytes depend."""
    return versions() | {"pyarrow": importlib.metadata.version("pyarrow")}


def _taken(column: Array | Levels, rows: NDArray[np.intp]) -> Array | Levels:
    if isinstance(column, np.ndarray):
        return np.asarray(column[rows])
    return tuple(column[row] for row in rows)


def _list(column: Array | Levels) -> list[str | bool | int | float]:
    return column.tolist() if isinstance(column, np.ndarray) else list(column)
