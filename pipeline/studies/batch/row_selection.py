"""Selection of designs to solve deeper or to keep: best, borderline, front, failed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.study_document import DesignCounts
from camwright.pipeline.search.front import front
from camwright.pipeline.studies.batch.answers_yield import states_of
from camwright.pipeline.studies.batch.dataset import (
    DEPTH,
    GOVERNING,
    ID,
    MESSAGE,
    SCREEN,
    VERDICT,
    values_of,
)
from camwright.pipeline.studies.batch.design_rows import FAILED, NO_RESULT
from camwright.pipeline.studies.batch.design_task import Wanted
from camwright.pipeline.studies.batch.study_file import Objective

if TYPE_CHECKING:
    import pyarrow as pa

_MESSAGES_MOST = 50


@dataclass
class RowFigures:
    """Figures of the rows so far that the selection needs, by design id.

    A later row of a design, of a deeper stage, replaces the earlier one.
    """

    objectives: Sequence[Objective]
    _rows: dict[str, tuple[str, str, str, str, float, tuple[float, ...]]] = field(
        default_factory=dict
    )

    def add(self, table: pa.Table) -> None:
        """Add the figures of the rows of a shard; those of a design known already are replaced."""
        names = set(table.column_names)
        texts = {
            each.name: [text or "" for text in table[each.name].to_pylist()]
            for each in (ID, DEPTH, SCREEN, VERDICT, GOVERNING, MESSAGE)
        }
        used = {
            name: values_of(table[f"{name}.utilisation"])
            for name in set(texts[GOVERNING.name])
            if f"{name}.utilisation" in names
        }
        wanted = []
        for each in self.objectives:
            values = values_of(table[each.column]) if each.column in names else None
            wanted.append(np.full(len(table), np.nan) if values is None else _sign(each) * values)
        for row, name in enumerate(texts[ID.name]):
            ruling = texts[GOVERNING.name][row]
            use = float(used[ruling][row]) if ruling in used else np.nan
            self._rows[name] = (
                texts[DEPTH.name][row], texts[SCREEN.name][row], texts[VERDICT.name][row],
                texts[MESSAGE.name][row], use, tuple(float(each[row]) for each in wanted),
            )  # fmt: skip

    def keep(self, ids: set[str]) -> None:
        """Forget all designs but these."""
        self._rows = {name: row for name, row in self._rows.items() if name in ids}

    def best(self, count: int) -> list[str]:
        """Ids of the best designs that do not fail, by the first objective."""
        ranked = sorted((row[5][0], name) for name, row in self._rows.items() if _in(row))
        return [name for _, name in ranked[:count]]

    def borderline(self, count: int) -> list[str]:
        """Ids of the designs with governing utilisation nearest to one."""
        ranked = sorted(
            (abs(row[4] - 1.0), name) for name, row in self._rows.items() if np.isfinite(row[4])
        )
        return [name for _, name in ranked[:count]]

    def front(self) -> list[str]:
        """Ids of the designs that do not fail on the Pareto front of the first two objectives; of
        one objective, the best.
        """
        rows = [(name, row[5]) for name, row in self._rows.items() if _in(row)]
        pairs = [(each[0], each[min(1, len(each) - 1)]) for _, each in rows]
        known = [k for k, pair in enumerate(pairs) if np.isfinite(pair).all()]
        return [rows[known[k]][0] for k in front([pairs[k] for k in known])]

    def failed(self) -> list[str]:
        """Ids of the failed designs; those without a result have no run."""
        return [name for name, row in self._rows.items() if row[1] == FAILED]

    def kept(self, kind: str, count: int) -> list[str]:
        """Ids of the designs selected by `Study.keep`."""
        if kind == "best":
            return self.best(count)
        return self.front() if kind == "pareto" else self.failed() if kind == "failed" else []

    def of(self, tier: Tier, ids: Collection[str] | None = None) -> RowFigures:
        """Figures of the rows of one depth, of all designs or of some."""
        rows = {
            name: row
            for name, row in self._rows.items()
            if row[0] == tier.word and (ids is None or name in ids)
        }
        return RowFigures(self.objectives, rows)

    def taken(self, ids: Iterable[str], wanted: Wanted) -> set[str]:
        """Figures of the designs whose run may be kept."""
        return {
            name
            for name in ids
            if (row := self._rows[name])[1] == wanted.screen
            and wanted.may_keep(row[5][: len(wanted.objectives)])
        }

    def wanted(self, kind: str, count: int) -> Wanted:
        """Rule for the designs whose run folder the study may still keep, whatever rows follow.

        A design that one on the front dominates, or that is worse than the last of the best, is not
        kept in the end either.

        Parameters
        ----------
        kind, count : str, int   as in `Study.kept`: "failed", "pareto" or "best", and the number of
                                 the best
        """
        if kind == "failed":
            return Wanted(FAILED)
        names = self.kept(kind, count)
        if kind == "best":
            names = names[count - 1 :]
        goals = self.objectives[: 1 if kind == "best" else 2]
        bars = tuple(self._rows[name][5][: len(goals)] for name in names)
        return Wanted("open", tuple((each.column, _sign(each)) for each in goals), bars)

    def record(self) -> DesignCounts:
        """Numbers of different designs by depth, screen, verdict and message, for
        ``study.json``.
        """
        rows = list(self._rows.values())
        words = Counter(row[3] for row in rows if row[3])
        ranked = sorted(words.items(), key=lambda each: (-each[1], each[0]))
        return {
            "depth": _counts(row[0] for row in rows),
            "screen": _counts(row[1] for row in rows),
            "verdict": _counts(row[2] for row in rows if row[2]),
            "messages": [
                {"message": text, "count": count} for text, count in ranked[:_MESSAGES_MOST]
            ],
        }


def _sign(objective: Objective) -> float:
    return 1.0 if objective.goal == "min" else -1.0


def _in(row: tuple[str, str, str, str, float, tuple[float, ...]]) -> bool:
    return row[1] not in (FAILED, NO_RESULT) and bool(np.isfinite(row[5][0]))


def _counts(words: Iterable[str]) -> dict[str, int]:
    return dict(sorted(Counter(words).items()))


def states_in(table: pa.Table) -> NDArray[np.uint8]:
    """State (n,) of each row of a shard, as in the answers."""
    state, _ = states_of(values_of(table[VERDICT.name]), values_of(table[SCREEN.name]))
    return state
