"""A beam in bores that only push: equilibrium at every position by an active set."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ContactError

MAX_STEPS = 60
TOLERANCE = 1e-10  # of the contact law, over the largest depth in the bore
_ROUND_OFF = 1e-14
_LEAST_DENT = 1e-12  # of the play: smaller loads are solved enlarged, their pushes divided
_LEAST_LENGTH = 1e-15  # of a step: none is left out whole
_TOUCH = 1e-9  # of the play: how far a rigid beam may be into the bore


@dataclass(frozen=True, eq=False)
class BearingLine:
    """A beam along a bore with play, both known at knots; arrays (knots,), SI.

    Parameters
    ----------
    positions : array (k,)        along the beam from its loaded end, m
    weights : array (k,)          length each knot stands for, m
    foundation : array (k,)       stiffness of the bore per length, N/m2
    play : array (k,)             way to the bore on either side, m, >= 0
    compliance : array (k, k)     deflection under unit pushes, beam clamped at the loaded end, m/N
    edges : array (e,) of int     knots at the ends of the guides, where a rigid beam would touch
    """

    positions: Array
    weights: Array
    foundation: Array
    play: Array
    compliance: Array
    edges: Array

    def __post_init__(self) -> None:
        names = ("positions", "weights", "foundation", "play", "compliance")
        freeze(self, **{name: getattr(self, name) for name in names})

    @cached_property
    def stiffness(self) -> Array:
        """Of the bore at each knot, N/m."""
        return self.foundation * self.weights

    @cached_property
    def rigid_modes(self) -> Array:
        """Deflection at each knot under unit shift and unit tilt of the loaded end, (k, 2)."""
        return np.stack([np.ones_like(self.positions), self.positions], axis=1)

    def deflection(self, push: Array, rigid: Array) -> Array:
        """Deflection at the knots, (k, n), m, under the bores' pushes and the end's motion."""
        return self.rigid_modes @ rigid - self.compliance @ push

    def law(self, deflection: Array) -> Array:
        """Push of the bore at a deflection, (k, n), N: none within the play, linear beyond."""
        depth = np.abs(deflection) - self.play[:, None]
        return self.stiffness[:, None] * np.sign(deflection) * np.maximum(depth, 0.0)

    def law_miss(self, deflection: Array, push: Array) -> Array:
        """Miss of the contact law at the worst knot, (n,), as a depth in the bore, m."""
        miss = np.abs(push - self.law(deflection)) / self.stiffness[:, None]
        return np.asarray(miss.max(axis=0))

    def law_residual(self, push: Array, rigid: Array) -> Array:
        """Miss of the contact law at the worst knot over the largest deflection, (n,)."""
        deflection = self.deflection(push, rigid)
        scale = np.abs(deflection).max(axis=0)
        miss = self.law_miss(deflection, push)
        return np.asarray(np.divide(miss, scale, out=np.zeros_like(scale), where=scale > 0.0))

    def settled(self, push: Array, rigid: Array) -> NDArray[np.bool_]:
        """Where the contact law holds, (n,) bool, to `TOLERANCE` of the depth in the bore.

        No closer than round-off of the deflection, which counts where a load hardly dents it.
        """
        depth = (np.abs(push) / self.stiffness[:, None]).max(axis=0)
        terms = np.abs(self.compliance) @ np.abs(push) + self.rigid_modes @ np.abs(rigid)
        allowed = TOLERANCE * depth + _ROUND_OFF * terms.max(axis=0)
        return np.asarray(self.law_miss(self.deflection(push, rigid), push) <= allowed)

    def enlargement(self, load: Array) -> Array:
        """Factor that lets a load dent the bore by more than the round-off of its play, (n,)."""
        size = np.abs(load[0]) + np.abs(load[1]) / self.positions[-1]
        least = _LEAST_DENT * self.stiffness.min() * self.play.max()
        return np.where((size > 0.0) & (size < least), least / np.where(size > 0.0, size, 1.0), 1.0)

    def slack_corners(self) -> Array:
        """End motions at which a rigid beam takes up the play, (2, corners).

        They are the corners of the motions the play allows, each with the beam a
        shade into two edges of the guides.
        """
        modes, play = self.rigid_modes[self.edges], self.play[self.edges]
        corners = []
        for pair in combinations(range(len(play)), 2):
            for sign in ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
                corner = np.linalg.solve(modes[list(pair)], np.array(sign) * play[list(pair)])
                if (np.abs(modes @ corner) <= play * (1.0 + _TOUCH) + _TOUCH * play.max()).all():
                    corners.append(corner * (1.0 + _TOUCH))
        return np.array(corners).T


def settle(
    line: BearingLine, force: Array, moment: Array, start: tuple[Array, Array] | None = None
) -> tuple[Array, Array]:
    """Pushes of the bores in equilibrium with a force and a moment on the beam's end.

    The beam and the bores store energy that is convex and piecewise quadratic in the pushes p
    that bend the beam and the end motion r:  p G p/2 + sum K depth^2/2 - load r. Each step of
    the active set solves the linear problem of the knots that touch, exactly, and goes the
    length that lowers the energy most, so that it cannot cycle; it ends when the knots that
    touch are those it assumed. The first guess is the rigid beam with its play taken up, or what
    a like load led to.

    Parameters
    ----------
    line : BearingLine
    force, moment : array (n,)   N and N m, on the loaded end; positive with shift and tilt
    start : push, rigid          an earlier answer at the same positions

    Returns
    -------
    push : array (k, n)    N, against positive deflection
    rigid : array (2, n)   shift, m, and tilt, rad, of the loaded end

    Raises
    ------
    ContactError
        If a position has not settled after 60 steps.
    """
    load = np.stack([force, moment])
    enlargement = line.enlargement(load)
    load = load * enlargement
    if start is None:
        push = np.zeros((len(line.positions), load.shape[1]))
        corners = line.slack_corners()
        rigid = corners[:, np.argmax(corners.T @ load, axis=0)]
    else:
        push, rigid = start[0] * enlargement, start[1].copy()
    idle = np.abs(load).max(axis=0) == 0.0
    push[:, idle], rigid[:, idle] = 0.0, 0.0
    unsettled = np.flatnonzero(~idle)
    for _ in range(MAX_STEPS):
        if not len(unsettled):
            return push / enlargement, rigid
        now, at, on = push[:, unsettled], rigid[:, unsettled], load[:, unsettled]
        next_push, next_rigid = _linear_step(line, now, at, on)
        settled = line.settled(next_push, next_rigid)
        length = _best_length(line, now, at, next_push - now, next_rigid - at, on)
        length[settled] = 1.0
        push[:, unsettled] = now + length * (next_push - now)
        rigid[:, unsettled] = at + length * (next_rigid - at)
        unsettled = unsettled[~settled]
    raise ContactError(f"guides: {len(unsettled)} positions not settled in {MAX_STEPS} steps")


def _linear_step(line: BearingLine, push: Array, rigid: Array, load: Array) -> tuple[Array, Array]:
    """Equilibrium if the knots that touch now are bound to the bore and the others free.

    Positions with the same knots in touch share one factorisation. The end's motion is found as
    a change of the present one, so that small loads do not drown in the play.
    """
    deflection = line.deflection(push, rigid)
    touch = np.abs(deflection) >= line.play[:, None]
    offset = np.sign(deflection) * line.play[:, None] - line.rigid_modes @ rigid
    push, rigid = np.zeros_like(push), rigid.copy()
    alike: dict[bytes, list[int]] = {}
    for place, pattern in enumerate(np.packbits(touch, axis=0).T):
        alike.setdefault(pattern.tobytes(), []).append(place)
    for here in map(np.array, alike.values()):
        knots = np.flatnonzero(touch[:, here[0]])
        solution = _bound(line, knots, offset[np.ix_(knots, here)], load[:, here])
        push[np.ix_(knots, here)] = solution[:-2]
        rigid[:, here] += solution[-2:]
    return push, rigid


def _bound(line: BearingLine, knots: NDArray[np.intp], offset: Array, load: Array) -> Array:
    """Pushes and change of end motion with some knots bound to the bore, (active + 2, n).

    Rows and columns are scaled to the bore's compliance and the line's length, so that stiff
    bores, stiff beams and short guides all solve to round-off.
    """
    modes = line.rigid_modes[knots] / np.array([1.0, line.positions[-1]])
    softness = line.compliance[np.ix_(knots, knots)] + np.diag(1.0 / line.stiffness[knots])
    scale = float(softness.diagonal().max())
    system = np.zeros((len(knots) + 2, len(knots) + 2))
    system[:-2, :-2], system[:-2, -2:], system[-2:, :-2] = softness / scale, -modes, modes.T
    if len(knots) < 2:  # the beam could still swing: hold it back a little
        system[-2:, -2:] = 1e-6 * np.eye(2)
    right = np.vstack([-offset / scale, load / np.array([[1.0], [line.positions[-1]]])])
    solution = np.linalg.solve(system, right)
    solution[-2:] *= scale
    solution[-1] /= line.positions[-1]
    return solution


def _best_length(
    line: BearingLine, push: Array, rigid: Array, push_step: Array, rigid_step: Array, load: Array
) -> Array:
    """Step length in (0, 1] that lowers the energy most, (n,).

    The energy's slope along the step rises, so that a slope still falling at the whole step asks
    for all of it. It is straight between the lengths at which a knot leaves the bore or enters
    it on the other side: its zero lies on the piece where these turn it positive.
    """
    before, change = line.deflection(push, rigid), line.deflection(push_step, rigid_step)
    bent = line.compliance @ push_step
    fixed = (load * rigid_step).sum(axis=0)
    spread = (push_step * bent).sum(axis=0)

    def slope(length: float) -> Array:
        stored = (push * bent).sum(axis=0) + length * spread
        law = line.law(before + length * change)
        return np.asarray(stored + (law * change).sum(axis=0) - fixed)

    first, last = slope(0.0), slope(1.0)
    length_best = np.ones(load.shape[1])
    far = np.flatnonzero(last > TOLERANCE * np.abs(first))
    if far.size:
        length_best[far] = _zero(line, before[:, far], change[:, far], first[far], spread[far])
    return length_best


def _zero(line: BearingLine, before: Array, change: Array, first: Array, spread: Array) -> Array:
    """Where a slope of value `first` at 0, positive at 1, is zero, (n,)."""
    pace = np.where(change == 0.0, 1e-300, change)
    toward = np.sign(pace) * line.play[:, None]
    stiffening = line.stiffness[:, None] * change**2
    leaves, enters = (np.clip((side - before) / pace, 0.0, 1.0) for side in (-toward, toward))
    touching = (stiffening * (leaves > 0.0)).sum(axis=0)
    corners = np.concatenate([leaves, enters, np.ones((1, first.size))])
    turns = np.concatenate([-stiffening, stiffening, np.zeros((1, first.size))])
    turns[: len(leaves)] *= leaves > 0.0
    order = np.argsort(corners, axis=0)
    corners = np.take_along_axis(corners, order, axis=0)
    turns = np.take_along_axis(turns, order, axis=0)
    # Rise on the piece that ends at each corner, and the slope there.
    rise = np.cumsum(np.vstack([spread + touching, turns[:-1]]), axis=0)
    width = np.diff(corners, axis=0, prepend=0.0)
    value = first + np.cumsum(rise * width, axis=0)
    piece = np.argmax(value >= 0.0, axis=0)[None, :]  # the last, where round-off leaves none
    end, over, steep = (np.take_along_axis(x, piece, axis=0)[0] for x in (corners, value, rise))
    back = np.divide(over, steep, out=np.zeros_like(over), where=(steep > 0.0) & (over > 0.0))
    length = np.where(over >= 0.0, end - back, 1.0)
    return np.asarray(np.clip(length, _LEAST_LENGTH, 1.0))
