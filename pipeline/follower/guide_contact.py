"""Beam in bores with clearance: unilateral contact at every position by an active set."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, alike, freeze
from camwright.geometry.errors import ContactError

MAX_STEPS = 60
TOLERANCE = 1e-10  # of the contact law, over the maximum indentation
_UNCHANGED = 5e-10  # of the contact law over the terms of the deflection, in an unchanged contact
_TERMS_ROUND_OFF = 1e-14  # of the terms of a deflection
_LEAST_DENT = 1e-10  # indentation over slack below which a load is scaled up
_LEAST_GUESSED = 1e-7  # indentation over slack from which solutions are interpolated
_LEAST_LENGTH = 1e-15  # lower bound of a step length
_RIGID_STARTS = 500  # loads solved from the rigid beam each
_START_SPACING = 16  # loads between those solved from the rigid beam
_DIRECTIONS = 20  # of loads, per rad
_TOUCH = 1e-9  # initial indentation of a rigid beam over the clearance


class BoundKnots(NamedTuple):
    """Linear equations of the beam with a set of knots in contact with the bore.

    The unknowns are the bore forces at the knots and the change of the end motion, rows and columns
    scaled by bore compliance and beam length, for accuracy with stiff bores, stiff beams and short
    guides.

    Parameters
    ----------
    knots : array (active,)
    system : array (active + 2, active + 2)
    scale : float   of the rows of the knots, m/N
    """

    knots: NDArray[np.intp]
    system: Array
    scale: float


@dataclass(frozen=True, eq=False)
class BearingLine:
    """Beam in bores with clearance, discretised at knots; arrays (knots,), SI.

    Parameters
    ----------
    positions : array (k,)        along the beam from its loaded end, m
    weights : array (k,)          quadrature length of each knot, m
    foundation : array (k,)       stiffness of the bore per length, N/m2
    play : array (k,)             distance to the bore on either side, m, >= 0
    compliance : array (k, k)     deflection under unit forces, beam clamped at the loaded end, m/N
    edges : array (e,) of int     knots at the ends of the guides, contacts of a rigid beam
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
        """Stiffness of the bore at each knot, N/m."""
        return self.foundation * self.weights

    @cached_property
    def rigid_modes(self) -> Array:
        """Deflection (k, 2) at each knot under unit translation and rotation of the loaded end."""
        return np.stack([np.ones_like(self.positions), self.positions], axis=1)

    def deflection(self, push: Array, rigid: Array) -> Array:
        """Deflection (k, n), m, at the knots under bore forces and end motion."""
        return self.rigid_modes @ rigid - self.compliance @ push

    def law(self, deflection: Array) -> Array:
        """Force of the bore on the beam (k, n), N, at deflections (k, n), m: zero within the
        clearance, linear beyond, signed like the deflection.
        """
        force = np.abs(deflection)
        force -= self.play[:, None]
        np.maximum(force, 0.0, out=force)
        force *= self.stiffness[:, None]
        return np.copysign(force, deflection, out=force)

    def law_miss(self, deflection: Array, push: Array) -> Array:
        """Greatest residual of the contact law over the knots (n,), as indentation, m, of forces
        `push` (k, n), N, at deflections (k, n), m.
        """
        miss = self.law(deflection)
        np.abs(np.subtract(push, miss, out=miss), out=miss)
        miss /= self.stiffness[:, None]
        return np.asarray(miss.max(axis=0))

    def terms(self, push: Array, rigid: Array) -> Array:
        """Greatest sum (n,), m, of magnitudes of the terms of a deflection: scale of round-off."""
        terms = np.abs(self.compliance) @ np.abs(push)
        terms += self.rigid_modes @ np.abs(rigid)
        return np.asarray(terms.max(axis=0))

    def law_residual(self, push: Array, rigid: Array) -> Array:
        """Maximum residual of the contact law over the terms of the deflection, (n,).

        References
        ----------
        Higham, Accuracy and Stability of Numerical Algorithms (2002), sec. 7.2: backward error.
        """
        scale = self.terms(push, rigid)
        miss = self.law_miss(self.deflection(push, rigid), push)
        return np.asarray(np.divide(miss, scale, out=np.zeros_like(scale), where=scale > 0.0))

    def settled(self, push: Array, rigid: Array) -> NDArray[np.bool_]:
        """Whether the contact law holds at each position (n,), to `TOLERANCE` of the indentation,
        with bore forces `push` (k, n), N, and end motions `rigid` (2, n), m and rad.

        Plus the round-off of the deflection, which dominates at small indentations.
        """
        allowed = TOLERANCE * (np.abs(push) / self.stiffness[:, None]).max(axis=0)
        miss = self.law_miss(self.deflection(push, rigid), push)
        left = np.flatnonzero(miss > allowed)
        allowed[left] += _TERMS_ROUND_OFF * self.terms(push[:, left], rigid[:, left])
        return np.asarray(miss <= allowed)

    def sides(self, push: Array, rigid: Array) -> NDArray[np.int8]:
        """Contact side of each knot (k, n): -1, 1, or 0 for none."""
        deflection = self.deflection(push, rigid)
        side = np.where(self.play[:, None] > 0.0, np.sign(deflection), 1.0)
        return np.asarray(side * (np.abs(deflection) >= self.play[:, None]), dtype=np.int8)

    @cached_property
    def _bound(self) -> dict[bytes, BoundKnots]:
        return {}

    def bound_knots(self, touch: bytes) -> BoundKnots:
        """Equations with some knots bound to the bore; `touch`: bytes of bool (k,), by knot.

        Kept: the same few sets of knots recur at most positions and in most steps.
        """
        if touch not in self._bound:
            self._bound[touch] = self._bound_to(np.flatnonzero(np.frombuffer(touch, dtype=bool)))
        return self._bound[touch]

    @cached_property
    def _modes(self) -> Array:
        """Rigid modes (k, 2), the rotation that of the length."""
        return np.asarray(self.rigid_modes / np.array([1.0, self.positions[-1]]))

    @cached_property
    def _softness(self) -> Array:
        """Compliance (k, k) of beam and bore, m/N."""
        return np.asarray(self.compliance + np.diag(1.0 / self.stiffness))

    def _bound_to(self, knots: NDArray[np.intp]) -> BoundKnots:
        """Linear equations of the beam with given knots in contact with the bore and the others
        free.

        Parameters
        ----------
        knots : array (active,)   indices of the knots in contact
        """
        modes, softness = self._modes[knots], self._softness[knots[:, None], knots]
        scale = (
            float(softness.diagonal().max(initial=0.0)) or 1.0
        )  # no knot: a step without meaning
        system = np.zeros((len(knots) + 2, len(knots) + 2))
        system[:-2, :-2], system[:-2, -2:], system[-2:, :-2] = softness / scale, -modes, modes.T
        if len(knots) < 2:  # the beam could rotate: weak support
            system[-2:, -2:] = 1e-6 * np.eye(2)
        return BoundKnots(knots, system, scale)

    def size(self, load: Array) -> Array:
        """Size (n,), N, of loads (2, n): force and couple of moment over length."""
        return np.asarray(np.abs(load[0]) + np.abs(load[1]) / self.positions[-1])

    @cached_property
    def slack(self) -> float:
        """Greatest deflection, m, of the rigid beam on two edges; 0 if a bore has no clearance."""
        return float(np.abs(self.rigid_modes[self.edges] @ self.slack_corners).max())

    def enlargement(self, load: Array) -> Array:
        """Load factor (n,) at which the indentation exceeds the round-off of the slack.

        A beam without slack, tight in one guide, moves in proportion to a small load: none is
        scaled.
        """
        size, least = self.size(load), _LEAST_DENT * self.stiffness.min() * self.slack
        small = (size > 0.0) & (size < least)
        return np.asarray(np.divide(least, size, out=np.ones_like(size), where=small))

    def edge_contact(self, load: Array) -> Array:
        """End motions (2, n) of a rigid beam pressed by loads (2, n) against two edges."""
        corners = self.slack_corners
        return np.asarray(corners[:, np.argmax(corners.T @ load, axis=0)])

    @cached_property
    def slack_corners(self) -> Array:
        """Motions of the loaded end (2, corners), m and rad, with which a rigid beam touches two
        edges of the guides and is within the clearance elsewhere: corners of the free motions,
        indented slightly at both edges.
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
    """Bore forces in equilibrium with force and moment at the end of the beam.

    The energy of beam and bores is convex and piecewise quadratic in the bore forces p and the end
    motion r:  p G p/2 + sum K depth^2/2 - load r. Each step solves the linear problem of the knots
    in contact and takes the step length of minimum energy, so that it cannot cycle; it ends when
    the contact law holds to `TOLERANCE`, or where two steps have not changed the set of knots in
    contact to `_UNCHANGED`: the rest is round-off. Initial guess: a given solution of similar
    loads, or the rigid beam in contact with two edges for some loads and an interpolation for those
    between.

    Parameters
    ----------
    line : BearingLine
    force, moment : array (n,)   on the loaded end, N and N m, signed like its motion
    start : push, rigid          solution of similar loads at the same positions

    Returns
    -------
    push : array (k, n)    bore forces, N, against positive deflection
    rigid : array (2, n)   translation, m, and rotation, rad, of the loaded end

    Raises
    ------
    ContactError
        If a position has not converged in 60 steps.
    """
    load = np.stack([force, moment])
    enlargement = line.enlargement(load)
    load = load * enlargement
    if start is None:
        push, rigid = _first_guess(line, load)
    else:
        push, rigid = start[0] * enlargement, start[1].copy()
    idle = np.abs(load).max(axis=0) == 0.0
    push[:, idle], rigid[:, idle] = 0.0, 0.0
    unsettled, guessed = np.flatnonzero(~idle), np.ones(idle.shape, dtype=bool)
    steady = np.zeros(idle.shape, dtype=bool)  # the last step changed no contact
    for _ in range(MAX_STEPS):
        if not len(unsettled):
            return _reduced(line, push, rigid, load, enlargement)
        now, at, on = push[:, unsettled], rigid[:, unsettled], load[:, unsettled]
        next_push, next_rigid, knots = _linear_step(line, now, at, on)
        # A guess that has lost the bores is not in equilibrium and may never touch them again.
        lost = guessed[unsettled] & (knots < 2)
        settled = line.settled(next_push, next_rigid) & ~lost
        left = np.flatnonzero(~settled & ~lost)
        after = next_push[:, left], next_rigid[:, left]
        unchanged = (line.sides(now[:, left], at[:, left]) == line.sides(*after)).all(axis=0)
        unchanged &= line.law_residual(*after) <= _UNCHANGED
        settled[left] = unchanged & steady[unsettled[left]]
        steady[unsettled[left]] = unchanged
        push[:, unsettled[settled]] = next_push[:, settled]
        rigid[:, unsettled[settled]] = next_rigid[:, settled]
        if lost.any():
            push[:, unsettled[lost]] = 0.0
            rigid[:, unsettled[lost]] = line.edge_contact(on[:, lost])
            guessed[unsettled[lost]] = False
        rest = np.flatnonzero(~settled & ~lost)
        going = unsettled[rest]
        now, at, on = now[:, rest], at[:, rest], on[:, rest]
        push_step, rigid_step = next_push[:, rest] - now, next_rigid[:, rest] - at
        length = _best_length(line, now, at, push_step, rigid_step, on)
        push[:, going] = now + length * push_step
        rigid[:, going] = at + length * rigid_step
        unsettled = unsettled[~settled]
    raise ContactError(
        f"guides: no equilibrium of the stem at {len(unsettled)} of {load.shape[1]} cam angles "
        f"in {MAX_STEPS} steps: it is too flexible for its load and clearance "
        "(follower.stem_diameter, E of follower.stem_material)"
    )


def _first_guess(line: BearingLine, load: Array) -> tuple[Array, Array]:
    """Start of the iteration for the contact of a beam in its bores: forces (k, n), N, and motions
    of the loaded end (2, n), m and rad, near the solution.

    Some loads, in the order of direction and size, are solved, and those between interpolated.

    Parameters
    ----------
    line : BearingLine    the beam, at k knots
    load : array (2, n)   force, N, and moment, N m, at its end
    """
    count = load.shape[1]
    push, rigid = np.zeros((len(line.positions), count)), line.edge_contact(load)
    if count <= _RIGID_STARTS:
        return push, rigid
    size = line.size(load)
    direction = np.round(np.arctan2(load[1] / line.positions[-1], load[0]) * _DIRECTIONS)
    order = np.lexsort((size, direction))
    sampled = np.append(np.arange(0, count - 1, _START_SPACING), count - 1)
    solved = settle(line, *load[:, order[sampled]])
    position = np.interp(np.arange(count), sampled, np.arange(sampled.size))
    low = np.minimum(position.astype(np.intp), sampled.size - 2)
    between = [values[:, low] + (position - low) * np.diff(values)[:, low] for values in solved]
    # Of a small load the round-off of the slack, which is in the guess, would be in the solution.
    large = size[order] >= _LEAST_GUESSED * line.stiffness.max() * line.slack
    push[:, order[large]], rigid[:, order[large]] = (values[:, large] for values in between)
    return push, rigid


def _linear_step(
    line: BearingLine, push: Array, rigid: Array, load: Array
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Step of the iteration for the contact of a beam in its bores: forces (k, n), N, and motions
    of the loaded end (2, n), m and rad, in equilibrium with the loads, with the knots that now
    touch bound to the bore and the others free; number of knots in contact (n,).

    Positions with the same knots in contact share one factorisation. The unknown is the change of
    the end motion: small loads would be lost in the round-off of the clearance.

    Parameters
    ----------
    line : BearingLine     the beam, at k knots
    push : array (k, n)    present forces of the bores, N
    rigid : array (2, n)   present end motions, m and rad
    load : array (2, n)    force, N, and moment, N m, at its end
    """
    deflection = line.deflection(push, rigid)
    touch = np.abs(deflection) >= line.play[:, None]
    side = np.sign(deflection)
    side *= line.play[:, None]
    offset = line.rigid_modes @ rigid
    offset -= side
    pushes, motions = _bound_solution(line, touch, offset, load)
    return pushes, rigid + motions, touch.sum(axis=0)


def _bound_solution(
    line: BearingLine, touch: NDArray[np.bool_], offset: Array, load: Array
) -> tuple[Array, Array]:
    """Forces of the bores (k, n), N, and motions of the loaded end (2, n), m and rad, of a beam
    with given knots bound to the bore and the others free.

    Parameters
    ----------
    line : BearingLine      the beam, at k knots
    touch : array (k, n)    which knots are bound
    offset : array (k, n)   their indentation before the load acts, m
    load : array (2, n)     force, N, and moment, N m, at its end
    """
    far = load / np.array([[1.0], [line.positions[-1]]])
    pushes, motions = np.zeros_like(offset), np.empty_like(load)
    for here in alike(touch):
        bound = line.bound_knots(touch[:, here[0]].tobytes())
        knots = bound.knots[:, None]
        right = np.empty((bound.knots.size + 2, here.size))
        np.divide(offset[knots, here], bound.scale, out=right[:-2])
        right[-2:] = far[:, here]
        solution = np.linalg.solve(bound.system, right)
        pushes[knots, here] = solution[:-2]
        motions[:, here] = solution[-2:] * bound.scale
    motions[1] /= line.positions[-1]
    return pushes, motions


def _reduced(
    line: BearingLine, push: Array, rigid: Array, load: Array, enlargement: Array
) -> tuple[Array, Array]:
    """Forces of the bores (k, n), N, and end motions (2, n), m and rad, of small loads that were
    solved enlarged, brought back to their own size.

    Bore forces are in proportion to so small a load; so is what it adds to the end motion of the
    unloaded beam in contact. Neither has the round-off of the clearance then.

    Parameters
    ----------
    line : BearingLine         the beam, at k knots
    push : array (k, n)        forces under the enlarged loads, N; changed
    rigid : array (2, n)       end motions under them, m and rad; changed
    load : array (2, n)        enlarged force, N, and moment, N m
    enlargement : array (n,)   factor, >= 1
    """
    small = np.flatnonzero(enlargement > 1.0)
    if small.size:
        bound, factor = push[:, small] != 0.0, enlargement[small]
        at_size = load[:, small] / factor
        push[:, small], added = _bound_solution(line, bound, np.zeros(bound.shape), at_size)
        rigid[:, small] -= (factor - 1.0) * added
    return push, rigid


def _best_length(
    line: BearingLine, push: Array, rigid: Array, push_step: Array, rigid_step: Array, load: Array
) -> Array:
    """Length (n,), above 0 and at most 1, of the step from the present state towards that of a
    linear step at which the energy of beam and bores is least.

    The slope of the energy increases along the step, so that a negative slope at the full step
    gives length 1. The slope is piecewise linear between the lengths at which knots leave or enter
    the bore; its zero is on the piece where it changes sign.

    Parameters
    ----------
    line : BearingLine                    the beam, at k knots
    push, rigid : arrays (k, n), (2, n)   present forces, N, and end motions, m and rad
    push_step, rigid_step : same shapes   their changes over the full step
    load : array (2, n)                   force, N, and moment, N m, at its end
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
        length_best[far] = _slope_zero(
            line, before[:, far], change[:, far], first[far], spread[far]
        )
    return length_best


def _slope_zero(
    line: BearingLine, before: Array, change: Array, first: Array, spread: Array
) -> Array:
    """Length (n,) of a step, between 0 and 1, at which the slope of the energy of beam and bores
    along the step is zero.

    Parameters
    ----------
    line : BearingLine      the beam, at k knots
    before : array (k, n)   deflection at length 0, m
    change : array (k, n)   its change over the step, m
    first : array (n,)      slope at length 0, J; at length 1 it is positive
    spread : array (n,)     rate of the slope by the beam alone, J
    """
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
    # Derivative of the slope on the piece that ends at each corner, and the slope there.
    rise = np.cumsum(np.vstack([spread + touching, turns[:-1]]), axis=0)
    width = np.diff(corners, axis=0, prepend=0.0)
    value = first + np.cumsum(rise * width, axis=0)
    piece = np.argmax(value >= 0.0, axis=0)[None, :]  # the last one where round-off leaves none
    end, over, steep = (np.take_along_axis(x, piece, axis=0)[0] for x in (corners, value, rise))
    back = np.divide(over, steep, out=np.zeros_like(over), where=(steep > 0.0) & (over > 0.0))
    length = np.where(over >= 0.0, end - back, 1.0)
    return np.asarray(np.clip(length, _LEAST_LENGTH, 1.0))
