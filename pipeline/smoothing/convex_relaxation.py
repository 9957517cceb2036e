r"""Convex part of a synthesis, without friction and inertia, solved to its global optimum.

Without them the cam torque is E' and the ripple convex in the coefficients; of an external force
the mean alone counts, with preload and weight in P. With q = P^2 + 2 k E the limit of the travel is
linear in them, and that of the pressure angle is

    |E'| <= tan(alpha) F_s r = tan(alpha) ((r0 - P/k) sqrt(q) + q/k),

with a concave right side where r0 >= P/k: with sigma <= sqrt(q) in place of the root it is a
second-order cone, exact where it is active. A normal force of at most N follows from
q + (E'/r0)^2 <= N^2, conservative as the radius is at least r0.

Under a flat face of width w its edge takes the place of the pressure angle,
|E'| <= (w/2 - |e|) sqrt(q), and the normal force is sqrt(q).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.case.limits import PRESSURE_ANGLE, RETURN_PRESSURE_ANGLE
from camwright.pipeline.checks.cam_shape import spring_travel
from camwright.pipeline.checks.demands import NORMAL_FORCE
from camwright.pipeline.follower.spring import spring_energy
from camwright.pipeline.smoothing.cone_program import Cones
from camwright.pipeline.smoothing.energy_spline import basis_matrix
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import (
    RESERVE,
    Problem,
    ripple_of,
    thinned,
    triangle,
)

_LIGHT = {"follower.mass": 0.0, "guides.a.friction": 0.0, "guides.b.friction": 0.0}


@dataclass(frozen=True, eq=False)
class Core:
    """Optimum of the convex problem: coefficients, J, and ripple without friction."""

    coefficients: Array
    ripple: float


def convex_start(problem: Problem) -> Core | None:
    """Energy of least frictionless ripple within travel, pressure angle and normal force.

    Of a face, within its width in place of the pressure angle.

    Parameters
    ----------
    problem : Problem   at its spring and prime radius, on at most 240 points

    Returns
    -------
    Core or None   None if the problem is not convex (r0 < P/k, an offset, a spring that is not
                   linear, a yoke) or not solved

    References
    ----------
    Boyd and Vandenberghe, Convex Optimization (2004), sec. 4.4.2: second-order cone programs;
    Demeulenaere et al., ASME J. Mech. Des. 131 (2009) 101004: splines by convex programs.
    """
    variables, ratings = problem.variables, problem.ratings
    if variables.shape is not None or variables.of_lift or ratings.offset != 0.0:
        return None
    if variables.prime_radius * variables.rate < variables.closing:
        return None
    points = problem.coarse_points
    turns = tuple(
        replace(item.at(_LIGHT), torque=thinned(item.torque, points))
        for item in problem.scenarios
        if item.weight > 0
    )
    search = Search(replace(problem, scenarios=turns, points=points, seed=None))
    result = _program(search).solved()
    if result is None:
        return None
    count = problem.coefficients
    return Core(readonly(search.scale * result[0][:count]), float(result[0][count]))


def _program(search: Search) -> Cones:
    """Cone program for the cam of least ripple without friction and inertia, a convex problem.

    Unknowns: coefficients of the energy over their scale, greatest ripple, and at each point sigma
    / P, sigma being at most the spring force and P that at zero lift. Bounds: least and greatest
    initial energy, travel, pressure angle or width of a flat face, normal force.
    """
    problem, variables, ratings = search.problem, search.problem.variables, search.problem.ratings
    count, points = problem.coefficients, problem.points
    theta = uniform_turn(points)
    level, slope = (
        search.scale * basis_matrix(theta, count, order, problem.lobes) for order in (0, 1)
    )
    program = Cones(count + 1 + points)
    energy, torque = program.columns(level, 0), program.columns(slope, 0)
    program.charge(1.0, count)
    _ripple(search, program)
    program.at_most(-energy, -problem.energy[0])
    if np.isfinite(problem.energy[1]):
        k = int(np.argmin(search.turn.energy(search.exact)[0]))
        program.at_most(energy[[k]], problem.energy[1])
    if (travel := ratings.bounds.get(spring_travel.id)) is not None:
        top = travel * (1.0 - RESERVE)
        program.at_most(energy, spring_energy(variables.closing, variables.rate, top))
    # q / P^2 = 1 + growth, and sigma / P is the unknown
    growth = (2.0 * variables.rate / variables.closing**2) * energy
    sigma = program.columns(scipy.sparse.csr_array(np.eye(points)), count + 1)
    steepest = ratings.bounds.get(PRESSURE_ANGLE.id)
    if ratings.slope_max is not None:
        wide = ratings.slope_max * (1.0 - RESERVE) * variables.closing
        for side in (1.0, -1.0):
            program.at_most(side * torque - wide * sigma, 0.0)
        program.square_at_most(sigma, growth, 1.0)
    elif steepest is not None and ratings.tilting:
        back = ratings.bounds.get(RETURN_PRESSURE_ANGLE.id, steepest)
        stretch = variables.closing / variables.rate
        height = (variables.prime_radius - stretch) * sigma + stretch * growth
        for side, angle in ((1.0, steepest), (-1.0, back)):
            steep = np.tan(angle * (1.0 - RESERVE)) * variables.closing
            program.at_most(side * torque - steep * height, steep * stretch)
        program.square_at_most(sigma, growth, 1.0)
    if (force := ratings.bounds.get(NORMAL_FORCE)) is not None:
        share = (force * (1.0 - RESERVE) / variables.closing) ** 2
        sideways = ratings.tilting * torque / (variables.prime_radius * variables.closing)
        program.square_at_most(sideways, -growth, share - 1.0)
    return program


def _ripple(search: Search, program: Cones) -> None:
    """Add the objective of the convex problem to its cone program: the greatest weighted ripple of
    the scenarios, and the weighted square of the third derivative of the energy, which stands for
    the jerk of the lift.
    """
    problem = search.problem
    count = problem.coefficients
    slope, third = (
        search.scale * basis_matrix(search.turn.theta, count, order, problem.lobes).toarray()
        for order in (1, 3)
    )
    for item in problem.scenarios:
        columns = np.column_stack([-slope / problem.gear_ratio, item.torque])
        level, slopes = triangle(item.weight * ripple_of(problem, item, columns))
        program.norm_at_most(slopes, level, count)
    norm = float(np.linalg.norm(third @ search.exact)) / search.scale or 1.0
    jerk = np.sqrt(problem.jerk_weight) / norm * third
    program.charge_square(jerk.T @ jerk)
