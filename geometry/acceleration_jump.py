"""Discontinuities of the acceleration of a lift, from equally spaced values."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, median, readonly

_SIDE_POINTS = 5
"""Values on either side of the interval in which a discontinuity is sought."""
_FIT_DEGREE = 4
"""Of the polynomial of the smooth part."""
_JUMP_PLACES = 9
"""Places of a discontinuity within the interval; eight times as many for a kink alone."""
_JUMP_OVER_KINK = 0.3
"""A jump explains the values if it leaves at most this share of the residual of a kink."""
_UNRESOLVED = 0.15
"""Residual, as an acceleration over its range, above which the values resolve no law."""
_NOISE_SHARE = 0.05
"""Noise of a jump, over the range, up to which the spacing is fine enough."""
_CONFIDENCE = 4.0
"""Standard deviations of the noise."""
_NARROWEST_STEP, _WIDEST_STEP = np.radians(1.0), np.radians(6.0)
"""Least and greatest spacing to which values are thinned."""
_SCATTER_ROUND_OFF = 1e-12
"""Of the greatest value: smaller residuals are those of a dwell."""


class Jump(NamedTuple):
    """Greatest discontinuity of s'' over the turn.

    size : float        m/rad^2, >= 0; where the values resolve no law, the greatest that they allow
    theta : float       cam angle, rad
    span : float        range of s'', m/rad^2
    noise : float       four standard deviations of a size, from the scatter of the values, m/rad^2
    resolved : bool     whether a polynomial with at most one kink or jump passes through every ten
                        neighbouring values
    """

    size: float
    theta: float
    span: float
    noise: float
    resolved: bool


def acceleration_jump(values: Array) -> Jump:
    """Greatest discontinuity of s'' of a lift by its values at equal angles.

    Ten neighbouring values are fitted by a polynomial of degree 4 with a jump of s'' and of s''' in
    the middle interval: one-sided fits with common lift, slope and place. A jump is accepted where
    a kink of s'' alone, anywhere among the ten, leaves over three times its residual. Values closer
    than 1 deg are thinned to 1 deg, and further up to 6 deg as long as their scatter hides a jump
    of 5 % of the range.

    Parameters
    ----------
    values : array (n,)    lift at n equal angles of the turn, m

    References
    ----------
    Bai and Perron, Econometrica 66 (1998) 47: least-squares fits with an unknown break: verify.
    """
    spacing = FULL_TURN / values.size
    best = None
    for stride in range(
        max(1, round(_NARROWEST_STEP / spacing)), values.size // (2 * _SIDE_POINTS) + 1
    ):
        if best is not None and stride * spacing > _WIDEST_STEP:
            break
        here = _at_spacing(values, stride)
        if best is None or here.noise * best.span < best.noise * here.span:
            best = here
        if best.noise <= _NOISE_SHARE * best.span:
            break
    return _at_spacing(values, 1) if best is None else best


def _at_spacing(values: Array, stride: int) -> Jump:
    """Greatest jump of s'' of lift values (n,), m, at equal angles of the turn, from windows of ten
    values that are `stride` samples apart; see `acceleration_jump`.
    """
    count, step = values.size, stride * FULL_TURN / values.size
    start = np.arange(0, count, stride)
    near = np.arange(1 - _SIDE_POINTS, _SIDE_POINTS + 1)
    window = values[(start[:, None] + stride * near) % count]
    acceleration = np.diff(window[:, _SIDE_POINTS - 2 : _SIDE_POINTS + 1], 2)[:, 0] / step**2
    span = float(np.ptp(acceleration))
    window = window - window[:, _SIDE_POINTS - 1 : _SIDE_POINTS]
    jumps, kinks = _fits()
    with_jump, place = _residual(window, jumps.complement)
    with_kink, _ = _residual(window, kinks.complement)
    size = np.abs(np.sum(jumps.row[place] * window, axis=1)) / step**2
    gain = jumps.gain[place] / step**2
    scatter = with_jump[with_jump > _SCATTER_ROUND_OFF * np.abs(values).max()]
    free = jumps.complement.shape[2]
    middle = median(scatter) if scatter.size else 0.0
    noise = _CONFIDENCE * median(gain) * middle / float(np.sqrt(free))
    proven = (with_jump <= _JUMP_OVER_KINK * with_kink) & (size > noise)
    greatest = float(np.max(size, where=proven, initial=0.0))
    # a jump in the other intervals of its window explains the residual there
    strong = np.flatnonzero(proven & (size > 0.5 * greatest))
    beside = np.zeros(start.size, dtype=bool)
    beside[(strong[:, None] + near - 1) % start.size] = True
    left = np.where(beside, 0.0, gain * np.minimum(with_jump, with_kink))
    unresolved = left > _UNRESOLVED * span
    counted = np.where(proven | unresolved, size, 0.0)
    worst = int(np.argmax(counted))
    theta = (start[worst] + stride * place[worst] / (_JUMP_PLACES - 1.0)) * FULL_TURN / count
    return Jump(float(counted[worst]), float(theta % FULL_TURN), span, noise, not unresolved.any())


class _Fits(NamedTuple):
    """Least-squares fits with a break at each of k places.

    complement : array (k, m, f)   orthonormal directions of the residual
    row, gain : (k, m), (k,)       jump of s'' times the square of the spacing, and its norm
    """

    complement: Array
    row: Array
    gain: Array


@cache
def _fits() -> tuple[_Fits, _Fits]:
    """Fits with a jump and a kink in the middle interval, and with a kink anywhere."""
    middle = np.linspace(0.0, 1.0, _JUMP_PLACES)
    everywhere = np.linspace(1.5 - _SIDE_POINTS, _SIDE_POINTS - 0.5, 8 * (2 * _SIDE_POINTS - 2) + 1)
    return _fit(middle, (2, 3)), _fit(everywhere, (3,))


def _fit(places: Array, powers: tuple[int, ...]) -> _Fits:
    """Least-squares fits of ten equally spaced values by a polynomial and, beyond a break, powers
    of the distance from it: 2 for a jump of s'', 3 for a kink. places : (k,), of the break, in
    steps from the fifth value.
    """
    x = np.arange(1 - _SIDE_POINTS, _SIDE_POINTS + 1) / _SIDE_POINTS
    smooth = x[:, None] ** np.arange(_FIT_DEGREE + 1)
    complement, row = [], []
    for place in places / _SIDE_POINTS:
        beyond = np.maximum(x - place, 0.0)
        basis = np.column_stack([smooth, *(beyond**power for power in powers)])
        complement.append(np.linalg.qr(basis, mode="complete")[0][:, basis.shape[1] :])
        row.append(2.0 * np.linalg.pinv(basis)[_FIT_DEGREE + 1] / _SIDE_POINTS**2)
    rows = np.array(row)
    return _Fits(readonly(complement), readonly(rows), readonly(np.linalg.norm(rows, axis=1)))


def _residual(window: Array, complement: Array) -> tuple[Array, Array]:
    """Least norm of the residual of each window over the places of the break (n,), in the unit of
    the values, and the index of that place (n,); window (n, m), complement (k, m, f).
    """
    norms = np.linalg.norm(window @ complement, axis=2)
    return norms.min(axis=0), norms.argmin(axis=0)
