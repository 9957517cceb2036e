"""Reactions of the guides as tables of side force and overhang, for many followers at once.

Stem and guides fixed, the guides' reactions over those of point supports are functions of side
force, overhang and spacing: they are solved at nodes and interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.follower.follower_forces import levers
from camwright.pipeline.follower.guide_reactions import GuidePair, guide_reactions
from camwright.pipeline.follower.stem_beam import Stem

_FORCES = np.geomspace(0.1, 1e6, 106)
"""Nodes of the side force, N: 15 a decade. Below the first the stem only tilts in its clearance."""
_OVERHANG_STEP = 0.03  # of the overhang over the spacing
_SPACING_STEP = 0.03  # of the logarithm of the spacing


class GuideRatios(NamedTuple):
    """Loads of guides A and B over the reactions of point supports, arrays (...).

    rubbing: sum of the pushes on both sides; bearing: see `GuideReactions`; net: the reaction.
    """

    rubbing_a: Array
    rubbing_b: Array
    bearing_a: Array
    bearing_b: Array
    net_a: Array
    net_b: Array


class Place(NamedTuple):
    """Nodes about overhang and spacing of each position, and their weights; (2 or 4, ...)."""

    rows: NDArray[np.intp]
    weights: Array

    def of(self, positions: NDArray[np.intp]) -> Place:
        """Those of some positions of the flattened arrays."""
        corners = self.rows.shape[0]
        rows, weights = self.rows.reshape(corners, -1), self.weights.reshape(corners, -1)
        return Place(rows[:, positions], weights[:, positions])


def _between_forces(side_force: Array) -> tuple[NDArray[np.intp], Array]:
    """Node below each side force, and the part of the way to the next one."""
    bounded = np.clip(side_force, _FORCES[0], _FORCES[-1])
    at = np.log(bounded / _FORCES[0]) / np.log(_FORCES[1] / _FORCES[0])
    below = np.minimum(at.astype(np.intp), _FORCES.size - 2)
    return below, at - below


@dataclass(frozen=True, eq=False)
class GuideTable:
    """Tables of a stem in guides, rows added where an overhang or a spacing needs them.

    The values depend on the stem and the guides alone, not on the positions looked up before.
    """

    stem: Stem
    guides: GuidePair
    _number: dict[tuple[int, int], int] = field(default_factory=dict)
    _tables: list[Array] = field(default_factory=list)
    _flats: dict[int, Array] = field(default_factory=dict)

    def place(self, overhang: Array, spacing: Array) -> Place:
        """Nodes about overhangs and spacings (...), m, for `ratios`."""
        reach, width = np.broadcast_arrays(overhang, spacing)
        if (spacing == self.guides.spacing).all():
            across, share = np.full(reach.shape, _STATED), np.zeros(reach.shape)
        else:
            logarithm = np.log(width) / _SPACING_STEP
            across = np.floor(logarithm).astype(np.intp)
            share = logarithm - across
        along = reach / width / _OVERHANG_STEP
        below = np.floor(along).astype(np.intp)
        part = along - below
        rows, weights = [], []
        for up, weight in ((0, 1.0 - part), (1, part)):
            for beside, other in ((0, 1.0 - share), (1, share)):
                if beside and not share.any():
                    continue
                rows.append(self._rows(below + up, across + beside))
                weights.append(weight * other)
        return Place(np.stack(rows), np.stack(weights))

    def ratios(self, side_force: Array, place: Place) -> GuideRatios:
        """Ratios at side forces (...), N, >= 0, and their places."""
        return GuideRatios(*self._interpolated(side_force, place, 6))

    def rubbing(self, side_force: Array, place: Place) -> tuple[Array, Array]:
        """Ratios of the rubbing loads alone."""
        on_a, on_b = self._interpolated(side_force, place, 2)
        return on_a, on_b

    def _interpolated(self, side_force: Array, place: Place, count: int) -> list[Array]:
        """Values (...) of the first ratios, linear in the logarithm of the force."""
        below, part = _between_forces(side_force)
        tables = [self._flat(q) for q in range(count)]
        results = [np.zeros(side_force.shape) for _ in tables]
        for rows, weights in zip(place.rows, place.weights, strict=True):
            at = rows * _FORCES.size + below
            for q, table in enumerate(tables):
                low = table.take(at)
                results[q] += weights * (low + part * (table.take(at + 1) - low))
        return results

    def _flat(self, q: int) -> Array:
        """Ratio at all nodes of the tables solved so far, rows of forces one after another."""
        if q not in self._flats or self._flats[q].size != len(self._tables) * _FORCES.size:
            self._flats[q] = np.concatenate([table[q] for table in self._tables])
        return self._flats[q]

    def _rows(self, along: NDArray[np.intp], across: NDArray[np.intp]) -> NDArray[np.intp]:
        """Numbers of the tables at nodes of overhang and spacing (...); new ones are solved."""
        keys = np.stack([along, across], axis=-1).reshape(-1, 2)
        low = keys.min(axis=0)
        extent = keys.max(axis=0) - low + 1
        flat = (keys[:, 0] - low[0]) * extent[1] + (keys[:, 1] - low[1])
        needed = np.flatnonzero(np.bincount(flat))
        numbers = np.empty(extent[0] * extent[1], dtype=np.intp)
        for each in needed:
            key = int(low[0] + each // extent[1]), int(low[1] + each % extent[1])
            if key not in self._number:
                self._number[key] = len(self._tables)
                self._tables.append(self._solved(*key))
            numbers[each] = self._number[key]
        return np.asarray(numbers[flat].reshape(along.shape))

    def _solved(self, along: int, across: int) -> Array:
        """Ratios at a node (6, forces)."""
        guides, stem = self.guides, self.stem
        if across != _STATED:
            guides = replace(guides, spacing=float(np.exp(across * _SPACING_STEP)))
        # The roller does not enter guide A: positions just outside take the node at its mouth.
        overhang = max(along * _OVERHANG_STEP * guides.spacing, 0.5 * guides.a.length)
        long = replace(stem, length=np.inf)
        reactions = guide_reactions(_FORCES, np.full(_FORCES.size, overhang), long, guides)
        on_a, on_b = (_FORCES * each for each in levers(np.asarray(overhang), guides.spacing))
        return np.stack(
            [
                reactions.rubbing_load_a / on_a, reactions.rubbing_load_b / on_b,
                reactions.bearing_load_a / on_a, reactions.bearing_load_b / on_b,
                np.abs(reactions.reaction_a) / on_a, np.abs(reactions.reaction_b) / on_b,
            ]
        )  # fmt: skip


_STATED = -(10**6)  # number of the spacing of the guides themselves


@lru_cache(maxsize=32)
def guide_table(stem: Stem, guides: GuidePair) -> GuideTable:
    """Tables of a stem in guides, kept by both."""
    return GuideTable(stem, guides)
