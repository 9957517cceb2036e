"""Lower bounds of the residual ripple for a spring and a roller, without synthesis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import ResultError
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import ROLLER_LOAD_SHARE, ROLLER_STATIC_SAFETY
from camwright.pipeline.smoothing.cone_program import Linear, Norm, solved
from camwright.pipeline.smoothing.energy_spline import basis_matrix, basis_rows
from camwright.pipeline.smoothing.scenario import Scenario
from camwright.pipeline.smoothing.synthesis_problem import thinned

RESERVE = 0.05  # relative ripple, for friction and inertia, which the bound neglects
_BOUND_COEFFICIENTS, _BOUND_POINTS = 36, 144  # splines and cam angles of a bound


@dataclass(frozen=True, eq=False)
class RippleBound:
    """Lower bound of the residual ripple for a spring of limited energy.

    The torque is the slope of the stored energy: the best approximation by the slope of any E(psi)
    between 0 and the maximum energy bounds the residual of every cam, without friction and inertia.
    One convex program per energy, exact for the splines of the turn.

    Parameters
    ----------
    torque : array (n,)   engine torque over a cam turn, crank N m
    gear_ratio : float
    """

    torque: Array
    gear_ratio: float

    def __call__(self, energy: float) -> float:
        """Lower bound of the torque ripple that a cam leaves, over that of the engine, 0 to 1,
        where its spring stores at most `energy`, J.
        """
        if not energy > 0.0:
            return 1.0
        theta = uniform_turn(_BOUND_POINTS)
        engine = thinned(self.torque, _BOUND_POINTS)
        engine = engine - engine.mean()
        scale = float(np.linalg.norm(engine))
        level, columns = basis_rows(theta, _BOUND_COEFFICIENTS)
        slope = basis_matrix(theta, _BOUND_COEFFICIENTS, 1).toarray()
        norm = Norm(engine / scale, -slope * (energy / (self.gear_ratio * scale)))
        one, point = np.ones(_BOUND_POINTS), np.arange(_BOUND_POINTS)
        rows = [
            Linear("least", 0.0 * one, -level, columns, point, point, elastic=False),
            Linear("most", -one, level, columns, point, point, elastic=False),
        ]
        none, box = np.zeros(_BOUND_COEFFICIENTS), np.full((2, _BOUND_COEFFICIENTS), 10.0)
        box[0] *= -1.0
        program = solved([norm], rows, np.diag(none), none, box, 1.0)
        if program is None:
            raise ResultError("redesign: bound of the ripple not solved")
        return program.ripple


def bearable_force(card: BearingCard, case: Case) -> float:
    """Maximum normal force (N) of a roller, by ratings and outer ring."""
    limits = (
        card.C0 / case.limits[ROLLER_STATIC_SAFETY],
        card.C * case.limits[ROLLER_LOAD_SHARE],
        card.radial_limit,
        card.static_radial_limit,
    )
    return min(limit for limit in limits if limit is not None)


def bearable_energy(force: float, rate: float, preload: float, relief: float) -> float:
    """Energy (J) at which the spring force at full lift reaches a normal force (N).

    relief: share of the spring force that the inertia of the follower may cancel.
    """
    push = force / (1.0 - relief)
    return max(0.0, (push**2 - preload**2) / (2.0 * rate))


def relief_of(scenarios: tuple[Scenario, ...], jump: float | None) -> float:
    """Greatest share of the spring force that inertia relieves in the slowest load case, 0 to 0.9.

    Inertia grows with the square of the speed.

    Parameters
    ----------
    scenarios : tuple      load cases, with their speeds
    jump : float or None   limit of this share in the fastest load case; None: 1
    """
    speeds = [float(item.numbers["cam.speed"]) for item in scenarios]
    fastest = max(speeds)
    share = 1.0 if jump is None else jump
    return min(0.9, share * (min(speeds) / fastest) ** 2) if fastest > 0 else 0.0
