"""Pitch errors of a trigger wheel, estimated from edge times at several speeds.

The place of an edge and the torque on the crank both move the time at which the edge passes. In
share of the speed, the part of a torque falls with the square of the speed; that of a pitch error
and of an inertia that varies with crank angle does not. Passing times at several speeds separate
pitch errors from torque only if the inertia of the crank mechanism is known and the gas torque is
the same at all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, freeze
from camwright.geometry.errors import CamError
from camwright.geometry.periodic_spline import periodic_cubic
from camwright.pipeline.engine.crankshaft import Inertia
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.passing_times import Passage, Passages
from camwright.pipeline.engine.trigger_wheel import TriggerWheel

CHANGE_TIMES = 2.0  # change of the integer orders over that of the half orders, standard deviation
_GAUSS_NODES = 8  # of the Gauss-Legendre rule between two edges; a gap is half a wave at most
_ESTIMATE_STEPS_MAX = 40  # of the Gauss-Newton estimate
_SHARE_MIN = 1e-6  # of a step
_TIME_STEP_END = 1e-9  # rad, largest change of a passing time in the last step
_ENERGY_MIN = 0.05  # least kinetic energy of an iterate, of that at mean speed


@dataclass(frozen=True, eq=False)
class PitchErrors:
    """Pitch errors: angle by which each edge passes later than at equal pitches, rad.

    Parameters
    ----------
    errors : array (e,)           rad, most probable values; rising edges first, then falling ones
    covariance : array (e, e)     rad2, of what remains
    tolerance : float             rad, standard deviation assumed before
    torque_change : float         change of the torque over the range of speed, as a share of it
    misfit : float                rms of what the fit leaves, over the noise; 1: noise alone
    noise : float                 rad, standard deviation of the angle at which an edge is seen in
                                  the mean of the measured cycles, its pitch error apart
    shared : array (2 e, e)       rad2, covariance of that noise, in the first turn and the second,
                                  with what is too large in `errors`
    """

    errors: Array
    covariance: Array
    tolerance: float
    torque_change: float = 0.0
    misfit: float = 1.0
    noise: float = 0.0
    shared: Array = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        freeze(self, errors=self.errors, covariance=self.covariance, shared=self.shared)

    @property
    def residual(self) -> float:
        """Standard deviation of the place of an edge about the mean of all, after correction, rad.

        The mean is the angle of the reference, of which the torque has only its phase.
        """
        left = np.diag(self.covariance).mean() - self.covariance.mean()
        return float(np.sqrt(max(left, 0.0)))

    @property
    def rms(self) -> float:
        """Root mean square of the errors about their mean, rad."""
        return float(self.errors.std())

    @classmethod
    def unknown(cls, edges: int, tolerance: float) -> PitchErrors:
        """Unknown pitch errors of a wheel with a tolerance (rad) of its edges alone."""
        return cls(np.zeros(edges), tolerance**2 * np.eye(edges), tolerance)

    def corrected(self, wheel: TriggerWheel) -> TriggerWheel:
        """Wheel with its edges at their most probable angles."""
        return wheel.displaced(self.errors)

    @property
    def of_edges(self) -> Array:
        """Covariance (2 e, 2 e), rad2, of the angles by which the e edges are seen too late in the
        mean of the measured cycles, in the first turn and then in the second: noise and remaining
        pitch errors together.
        """
        twice = np.tile(self.covariance, (2, 2))
        twice[np.diag_indices_from(twice)] += self.noise**2
        if not self.shared.size:
            return twice
        both = np.tile(self.shared, (1, 2))
        return np.asarray(twice - both - both.T)


def pitch_errors(
    records: Sequence[Passages],
    inertia: Inertia,
    tolerance: float,
    harmonics: int,
) -> PitchErrors:
    r"""Most probable pitch errors from edge times of one torque at several speeds.

    An edge at nominal angle theta_j with pitch error e_j passes at

        t_j = t_0 + \int_{theta_0}^{theta_j} dtheta / omega + e_j / omega(theta_j),

    where I(theta) omega^2 / 2 = E + m (theta - theta_0) + W(theta), work and kinetic energy of
    the crank. The periodic work W, a series of `harmonics`, is that of the torque and the same in
    every passage; it may change in proportion to the logarithm of the speed, in the integer orders
    by `CHANGE_TIMES` the share that the half orders show, which pitch errors do not touch. t_0, E
    and the mean torque m are those of each passage. Errors are a priori independent with standard
    deviation `tolerance`, so that what the records cannot separate from the torque keeps it.

    Parameters
    ----------
    records : sequence     the measured record first, if its torque is that of the others
    inertia : Inertia      of crank and mechanism, over the crank angle
    tolerance : float      rad, standard deviation of the place of an edge, > 0
    harmonics : int        of the cycle, of the work; 0: no torque acts

    Raises
    ------
    CamError
        If the fit does not converge.

    References
    ----------
    Kiencke and Nielsen, Automotive Control Systems (2005), ch. on crankshaft speed: adaptation of
    the sensor wheel, cited from memory: verify. Tarantola, Inverse Problem Theory (2005), sec. 3.2:
    most probable values and covariance of a nonlinear least-squares problem.
    """
    every = np.concatenate([np.log(record.speeds) for record in records])
    middle, span = 0.5 * (every.max() + every.min()), float(np.ptp(every))
    parts = [
        _Times.of(one, record.noise, (np.log(one.mean_speed) - middle) / span if span else 0.0,
                  record is records[0], inertia, harmonics)
        for record in records for one in record.passages
    ]  # fmt: skip
    half_orders = np.tile(np.arange(1, harmonics + 1) % 2 == 1, 2)
    free = np.where(half_orders, np.inf, 0.0) if span else np.zeros(2 * harmonics)
    edges = records[0].edges
    state = _solved(parts, _State.steady(parts, edges, harmonics), tolerance, free)
    ratio = state.change_ratio(half_orders)
    if ratio > 0.0:
        power = np.hypot(*state.work.reshape(2, -1)) / np.sqrt(2.0)
        change = CHANGE_TIMES * ratio * np.tile(power, 2)
        state = _solved(parts, state, tolerance, np.where(half_orders, np.inf, change))
    covariance = state.covariance[4 * harmonics :, 4 * harmonics :]
    total = sum(part.passage.count for part in parts if part.measured)
    shared = np.zeros((2 * edges, edges))
    for part, each in zip(parts, state.shared, strict=True):
        if part.measured:
            turn = np.mod((part.passage.angle[:-1] + 1e-6) // FULL_TURN, 2.0).astype(int)
            rows = turn * edges + part.passage.edge[:-1]
            shared[rows] += part.passage.count / total * part.noise * each[:-1, 4 * harmonics :]
    noise = records[0].noise / float(np.sqrt(total))
    return PitchErrors(state.errors, covariance, tolerance, ratio, state.misfit, noise, shared)


@dataclass(frozen=True, eq=False)
class _Times:
    """Passing times of one passage as a function of the unknowns."""

    passage: Passage
    noise: float  # rad, of the mean times
    lean: float  # place in the range of the logarithm of the speed, about its middle
    measured: bool  # belongs to the first record
    offset: Array  # rad (n - 1, q), of the nodes between two edges from the first edge
    weight: Array  # rad (n - 1, q)
    inertia: Array  # kg m2 (n - 1, q)
    waves: Array  # (n - 1, q, 2 h)
    inertia_at: Array  # kg m2 (n,), at the edges
    waves_at: Array  # (n, 2 h)

    @classmethod
    def of(
        cls,
        passage: Passage,
        noise: float,
        lean: float,
        measured: bool,
        inertia: Inertia,
        harmonics: int,
    ) -> _Times:
        """Passing times of one passage of the wheel, prepared for integration from edge to edge by
        Gauss quadrature.

        Parameters
        ----------
        passage : Passage   mean edge times of a cycle
        noise : float       of an edge of one cycle, rad
        lean : float        place of its speed in the range of speeds, about the middle of the range
        measured : bool     whether it is of the first record
        inertia : Inertia   of crank and running gear, kg m2
        harmonics : int     h, of the work over the crank angle
        """
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_NODES)
        half = 0.5 * np.diff(passage.angle)[:, None]
        at = passage.angle[:-1, None] + half * (nodes + 1.0)
        varying, turns = periodic_cubic(inertia.varying), CYCLE_ANGLE / FULL_TURN
        return cls(
            passage,
            noise / float(np.sqrt(passage.count)),
            lean,
            measured,
            at - passage.angle[0],
            half * weights,
            inertia.constant + varying(at / turns),
            _waves(at, harmonics),
            inertia.constant + varying(passage.angle / turns),
            _waves(passage.angle, harmonics),
        )

    @property
    def seen(self) -> Array:
        """Times of the edges, in noises."""
        return np.asarray(self.passage.times * (self.passage.mean_speed / self.noise))

    def predicted(self, state: _State, k: int) -> tuple[Array, Array, Array] | None:
        """Predicted times of the n edges of a passage, and their derivatives, all in units of the
        noise of a time: times (n,); by its own unknowns, start t_0, mean energy E and mean torque
        m, (n, 3); by the common unknowns, work, change of work with speed, and pitch errors, (n, 4
        h + e).

        None where the energy, and with it the speed, would nearly vanish.

        Parameters
        ----------
        state : _State   unknowns at which the times are predicted
        k : int          index of the passage in `state.own`
        """
        passage, work = self.passage, state.work + self.lean * state.change
        span = passage.angle - passage.angle[0]
        start, mean_energy, mean_torque = state.own[k]
        energy = mean_energy + mean_torque * self.offset + self.waves @ work
        energy_at = mean_energy + mean_torque * span + self.waves_at @ work
        if not min(energy.min(), energy_at.min()) > _ENERGY_MIN * mean_energy:
            return None
        scale = passage.mean_speed / self.noise
        slowness = scale * np.sqrt(0.5 * self.inertia / energy)
        slowness_at = scale * np.sqrt(0.5 * self.inertia_at / energy_at)
        slope = -0.5 * self.weight * slowness / energy
        by_work = _summed(np.einsum("nq,nqh->nh", slope, self.waves))
        by_error = np.zeros((span.size, state.errors.size))
        by_error[np.arange(span.size), passage.edge] = slowness_at
        own = (slope.sum(axis=1), (slope * self.offset).sum(axis=1))
        times = start * scale + _summed((self.weight * slowness).sum(axis=1))
        return (
            times + slowness_at * state.errors[passage.edge],
            np.column_stack([np.full(span.size, scale), *(_summed(each) for each in own)]),
            np.hstack([by_work, self.lean * by_work, by_error]),
        )


def _summed(parts: Array) -> Array:
    """Sums of the first 0, 1, ... of the parts."""
    return np.concatenate([np.zeros((1, *parts.shape[1:])), np.cumsum(parts, axis=0)])


def _waves(angle: Array, harmonics: int) -> Array:
    """Cosines, then sines, of the harmonics of the cycle, (..., 2 h)."""
    phase = angle[..., None] * (0.5 * np.arange(1, harmonics + 1))
    return np.concatenate([np.cos(phase), np.sin(phase)], axis=-1)


@dataclass(frozen=True, eq=False)
class _State:
    """Unknowns of the fit, and what is known of their errors."""

    work: Array  # J (2 h), at the middle of the range of speed
    change: Array  # J (2 h), over the range of speed
    errors: Array  # rad (e)
    own: Array  # (k, 3): t_0, s, E, J, and m, N m, of each passage
    covariance: Array  # of work, change and errors
    misfit: float = np.inf
    shared: tuple[Array, ...] = ()  # noises (n, 4 h + e) of each passage: see `PitchErrors`

    @classmethod
    def steady(cls, parts: Sequence[_Times], edges: int, harmonics: int) -> _State:
        """Steady speed and no errors, the start of the iteration."""
        own = [(0.0, 0.5 * part.inertia.mean() * part.passage.mean_speed**2, 0.0) for part in parts]
        none = np.zeros(2 * harmonics)
        return cls(none, none, np.zeros(edges), np.array(own), np.empty((0, 0)))

    def stepped(self, whole: Array, own: Array, share: float) -> _State:
        """The state after a share of a step: `whole` (4 h + e), `own` (k, 3)."""
        size = self.work.size
        return replace(
            self,
            work=self.work + share * whole[:size],
            change=self.change + share * whole[size : 2 * size],
            errors=self.errors + share * whole[2 * size :],
            own=self.own + share * own,
        )

    def change_ratio(self, marks: NDArray[np.bool_]) -> float:
        """Change of the work over the range of speed as a share of the work, over the waves marked
        (2 h,): root of the ratio of their sums of squares, noise deducted; 0 where noise alone
        explains the change, or there is no work.
        """
        size = self.work.size
        noise = np.diag(self.covariance)[size : 2 * size][marks].sum()
        square, of = (self.change[marks] ** 2).sum() - noise, (self.work[marks] ** 2).sum()
        return float(np.sqrt(square / of)) if square > 0.0 < of else 0.0


@dataclass(frozen=True, eq=False)
class _Prior:
    """What is known of the common unknowns, work, change and errors, before the fit."""

    kept: NDArray[np.bool_]  # of all unknowns, those that are not fixed at zero
    scale: Array  # unit of each kept one
    precision: Array  # inverse variance of each kept one, in its unit; 0: nothing is known

    @classmethod
    def of(cls, state: _State, tolerance: float, change: Array) -> _Prior:
        """Prior of the common unknowns: nothing is known of the work, the change has zero mean and
        a standard deviation, as have the pitch errors.

        Parameters
        ----------
        state : _State          with the energy as the unit of work and change
        tolerance : float       standard deviation of a pitch error, rad
        change : array (2 h,)   standard deviation of the change of each wave, J; 0: fixed at zero
        """
        energy = float(np.mean(state.own[:, 1]))
        size, edges = state.work.size, state.errors.size
        changing = change > 0.0
        kept = np.concatenate([np.ones(size, bool), changing, np.ones(edges, bool)])
        units = np.concatenate([np.full(2 * size, energy), np.full(edges, tolerance)])
        known = np.concatenate([np.zeros(size), energy / change[changing], np.ones(edges)])
        return cls(kept, units[kept], known**2)

    def within(self, state: _State) -> Array:
        """The free unknowns (f,) of a state as multiples of `scale`."""
        whole = np.concatenate([state.work, state.change, state.errors])
        return np.asarray(whole[self.kept] / self.scale)

    def expanded(self, scaled: Array) -> Array:
        """All unknowns (..., u), J and rad, from the free ones (..., f) as multiples of `scale`;
        those fixed are zero."""
        every = np.zeros((*scaled.shape[:-1], self.kept.size))
        every[..., self.kept] = self.scale * scaled
        return every


class _Reduced(NamedTuple):
    """Linear equations of one passage; its own unknowns are eliminated by an orthogonal basis."""

    basis: Array  # (n, 3) of the columns of its own unknowns
    triangle: Array  # (3, 3)
    columns: Array  # (n, u) of the common unknowns
    free: Array  # (n, u), without what its own unknowns make up for
    left: Array  # (n,) times not yet explained, in noises

    @classmethod
    def of(cls, part: _Times, state: _State, k: int, prior: _Prior) -> _Reduced | None:
        """Linear equations for the unknowns from the edge times of one passage, its own unknowns
        eliminated; None where the crank would nearly stand still.

        Parameters
        ----------
        part : _Times    the passage
        state : _State   at which the times are linearised
        k : int          index of the passage in `state.own`
        prior : _Prior   which common unknowns are free, and their units
        """
        predicted = part.predicted(state, k)
        if predicted is None:
            return None
        times, own, common = predicted
        basis, triangle = np.linalg.qr(own)
        columns = common[:, prior.kept] * prior.scale
        return cls(basis, triangle, columns, columns - basis @ (basis.T @ columns),
                   part.seen - times)  # fmt: skip

    @property
    def square(self) -> float:
        """Sum of squares that the own unknowns cannot explain."""
        return float((self.left**2).sum() - ((self.basis.T @ self.left) ** 2).sum())

    def own(self, step: Array) -> Array:
        """Step (3,) of the own unknowns with a step of the common ones."""
        known = self.basis.T @ (self.left - self.columns @ step)
        return np.asarray(np.linalg.solve(self.triangle, known))

    def moved(self, step: Array) -> float:
        """Largest change of a time by a step, in noises."""
        return float(
            np.abs(self.columns @ step + self.basis @ (self.triangle @ self.own(step))).max()
        )


def _solved(parts: Sequence[_Times], state: _State, tolerance: float, change: Array) -> _State:
    """Most probable work, change and pitch errors for the edge times of several passages, by
    Gauss-Newton steps.

    Parameters
    ----------
    parts : sequence        passing times of each passage
    state : _State          first values
    tolerance : float       standard deviation of a pitch error, rad
    change : array (2 h,)   J, standard deviation of the change of each wave; 0: none

    Raises
    ------
    CamError
        If the steps do not converge, or the edges do not determine the harmonics.
    """
    prior = _Prior.of(state, tolerance, change)
    rows = _reduced(parts, state, prior)
    for _ in range(_ESTIMATE_STEPS_MAX):
        if rows is None:
            break
        normal = np.diag(prior.precision) + sum(row.free.T @ row.free for row in rows)
        right = sum(row.free.T @ row.left for row in rows) - prior.precision * prior.within(state)
        try:
            step = scipy.linalg.solve(normal, right, assume_a="pos")
        except np.linalg.LinAlgError:  # the edges do not determine the harmonics
            break
        largest = max(row.moved(step) * part.noise for row, part in zip(rows, parts, strict=True))
        own = np.array([row.own(step) for row in rows])
        share, before = 1.0, state
        rows = None
        while rows is None and share > _SHARE_MIN:  # a step that would stop the crank is shortened
            state = before.stepped(prior.expanded(step), own, share)
            rows = _reduced(parts, state, prior)
            share *= 0.5
        if rows is not None and largest < _TIME_STEP_END:
            return _with_covariance(state, parts, rows, prior, scipy.linalg.inv(normal))
    raise CamError(
        "engine.reference: the pitch errors of the wheel cannot be estimated; check the inertia of "
        "crankshaft and running gear, and that both records are of this engine"
    )


def _reduced(parts: Sequence[_Times], state: _State, prior: _Prior) -> list[_Reduced] | None:
    """Equations of all passages; None where the crank would nearly stand still."""
    rows = [_Reduced.of(part, state, k, prior) for k, part in enumerate(parts)]
    known = [row for row in rows if row is not None]
    return known if len(known) == len(rows) else None


def _with_covariance(
    state: _State, parts: Sequence[_Times], rows: Sequence[_Reduced], prior: _Prior, inverse: Array
) -> _State:
    """Solved state with the covariance of its unknowns, the misfit, rms of what is left of the
    times over the noise, and the covariance of the unknowns with the noise of each time.

    Parameters
    ----------
    state : _State     solved
    parts : sequence   passing times of each passage
    rows : sequence    their linear equations at the state
    prior : _Prior     of the common unknowns
    inverse : array    of the normal matrix of the free common unknowns, in their units
    """
    freedom = sum(part.passage.angle.size - 3 for part in parts) - inverse.shape[0]
    freedom += float(prior.precision @ np.diag(inverse))  # an unknown left at its prior is none
    square = sum(row.square for row in rows)
    return replace(
        state,
        covariance=prior.expanded(prior.expanded(inverse).T),
        misfit=float(np.sqrt(max(square, 0.0) / max(freedom, 1.0))),
        shared=tuple(prior.expanded(row.free @ inverse) for row in rows),
    )
