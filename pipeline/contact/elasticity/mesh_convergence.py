"""Mesh convergence on three or two meshes: Richardson extrapolation, order, error estimate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from camwright.geometry.errors import InputError

# Relative differences below this are scatter of the mesh position, not convergence.
_SCATTER = 2e-4
_ORDER_TRUSTED = 1.0  # below it the meshes are not in the asymptotic range
_ORDER_LEAST, _ORDER_MOST = 0.5, 3.0  # bounds of the order in the error bar
_GCI_SAFETY, _GCI_SAFETY_COARSE = 1.25, 3.0  # in and outside the asymptotic range


class IndexTerms(NamedTuple):
    """Terms of a grid convergence index, safety difference / (fine (ratio^order - 1)) + added.

    difference: of fine and middle mesh; of values that scatter their range, at an order with which
    it is not divided; added: greatest index of the same quantity on three meshes elsewhere.
    """

    safety: float
    difference: float
    ratio: float
    order: float
    added: float = 0.0

    def over(self, fine: float) -> float:
        """The index, relative to the value of the fine mesh, at zero absolute."""
        gain = float(self.ratio**self.order) - 1.0
        return self.safety * self.difference / (abs(fine) or 1.0) / gain + self.added


@dataclass(frozen=True)
class Convergence:
    """A quantity on meshes of decreasing element size.

    values, coarse to fine; extrapolated to zero element size; order, the observed one (None where
    the values scatter), or of two meshes the assumed one; gci, the grid convergence index: relative
    error bar of the finest value, and what it is made of.
    """

    values: tuple[float, ...]
    extrapolated: float
    order: float | None
    gci: float
    terms: IndexTerms | None = None


def converged(values: Sequence[float], ratio: float) -> Convergence:
    """Richardson extrapolation of three values on meshes refined by a constant ratio.

    The error bar is 1.25 |f1 - f2|/(r^p - 1), f1 the finest value. An observed order p below 1
    takes the safety factor 3 and counts as at least 0.5: it widens the bar. One above 3, the order
    of the stresses, counts as 3. Values that do not converge monotonically, or differ by less than
    2e-4, have no order; their error bar is 3 times their spread, of monotone ones not less than
    that of the order 0.5.

    Parameters
    ----------
    values : three floats   on the coarse, middle and fine mesh
    ratio : float           element size of a mesh over that of the next finer one

    Raises
    ------
    InputError
        If there are not three finite values or the ratio is below 1.1.

    References
    ----------
    Roache (1998); ASME V&V 20-2009, sec. 2-4; Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104:
    safety factor 3 and bounds of the order outside the asymptotic range: verify.
    """
    if len(values) != 3 or not np.isfinite(values).all():
        raise InputError("values", tuple(values), "three finite numbers")
    if not ratio >= 1.1:
        raise InputError("ratio", ratio, ">= 1.1")
    coarse, middle, fine = (float(v) for v in values)
    scale = abs(fine) or 1.0
    first, second = middle - coarse, fine - middle
    spread = (max(values) - min(values)) / scale
    figures = (coarse, middle, fine)
    if first * second <= 0 or abs(second) >= abs(first) or spread < _SCATTER:
        whole = float(np.log(2.0) / np.log(ratio))
        scattered = IndexTerms(_GCI_SAFETY_COARSE, max(values) - min(values), ratio, whole)
        least = IndexTerms(_GCI_SAFETY_COARSE, abs(second), ratio, _ORDER_LEAST)
        of_order = first * second > 0 and least.over(fine) > scattered.over(fine)
        terms = least if of_order else scattered
        return Convergence(figures, fine, None, terms.over(fine), terms)
    order = float(np.log(first / second) / np.log(ratio))
    bounded = min(max(order, _ORDER_LEAST), _ORDER_MOST)
    gain = ratio**bounded - 1.0
    safety = _GCI_SAFETY if order >= _ORDER_TRUSTED else _GCI_SAFETY_COARSE
    terms = IndexTerms(safety, abs(second), ratio, bounded)
    return Convergence(figures, fine + second / gain, order, terms.over(fine), terms)


def converged_on_two(
    values: Sequence[float], ratio: float, observed: Sequence[Convergence]
) -> Convergence:
    """Richardson extrapolation of two values with the order observed on three meshes elsewhere.

    The order is the least observed one, within its bounds 0.5 and 3; unless every place has one the
    finer value is not extrapolated, and its bar is that of the order 0.5. The safety factor is 3;
    the greatest observed bar is added, as the scatter of the finest mesh is not known here.

    Parameters
    ----------
    values : two floats   on the coarse and the fine mesh
    ratio : float         element size of the coarse mesh over that of the fine one
    observed : sequence   convergence of the same quantity on three meshes, at least one

    Raises
    ------
    InputError
        If there are not two finite values, no observed convergence, or the ratio is below 1.1.

    References
    ----------
    Roache (1998), sec. 5.6: safety factor 3 on two meshes.
    """
    if len(values) != 2 or not np.isfinite(values).all():
        raise InputError("values", tuple(values), "two finite numbers")
    if not observed:
        raise InputError("observed", 0, "at least one convergence on three meshes")
    if not ratio >= 1.1:
        raise InputError("ratio", ratio, ">= 1.1")
    coarse, fine = (float(v) for v in values)
    orders = [each.order for each in observed if each.order is not None]
    order = None
    if len(orders) == len(observed):
        order = min(max(min(orders), _ORDER_LEAST), _ORDER_MOST)
    assumed, added = order or _ORDER_LEAST, max(each.gci for each in observed)
    change = (fine - coarse) / (ratio**assumed - 1.0)
    terms = IndexTerms(_GCI_SAFETY_COARSE, abs(fine - coarse), ratio, assumed, added)
    return Convergence(
        values=(coarse, fine),
        extrapolated=fine if order is None else fine + change,
        order=order,
        gci=terms.over(fine),
        terms=terms,
    )
