"""Smoothing of the engine torque, and constrained synthesis of the lift.

In the order of the calculation:

| module                  | responsibility                               | symbol, unit            |
| ----------------------- | -------------------------------------------- | ----------------------- |
| `smoothers`             | zero-phase filters of one engine cycle       | T, N m; width, rad      |
| `required_lift`         | lift that delivers the smoothed torque       | T, N m; s, m            |
| `smoothing_forecast`    | checks of a wider smoother, forecast         | utilisation             |
| `smoothing_feedback`    | smoother of the next trial                   | strength                |
| `scenario`              | design variables, ratings, load cases        | k, N/m; P, N; r0, m     |
| `cam_state`             | loaded cam of a scenario, lift of an energy  | s, m; F, N              |
| `part_constraints`      | limits of checks that have no measure        | utilisation             |
| `constraints`           | all limits of a synthesis by cam angle       | utilisation             |
| `objective`             | terms of the objective over their references | loss, force; ratio      |
| `gradients`             | derivatives by complex steps                 | d/dE, d/dk, d/dP, d/dr0 |
| `bounds`                | limits in drawing units; relaxed ratings     | as in the case file     |
| `allowables`            | ratings of a case                            | SI                      |
| `energy_spline`         | stored energy as a quintic B-spline          | E, J; E', N m           |
| `synthesis_problem`     | problem, design, ripple of a crank torque    | ripple ratio            |
| `problem_setup`         | problem of a case; with other rollers        |                         |
| `cone_program`          | second-order cone programs                   | x, multipliers          |
| `linear_model`          | state of a search and its linear models      |                         |
| `sampled_problem`       | functions of a problem at sampled cam angles |                         |
| `lagrangian`            | prices and second derivatives at a state     | ripple ratio            |
| `convex_relaxation`     | convex part: global optimum as a start       | E, J                    |
| `trust_region`          | descent to a local optimum                   |                         |
| `constrained_synthesis` | cam of least ripple within all limits        | E, J; s, m              |
| `multistart`            | best design of several starts, agreement     | ripple                  |
| `shadow_prices`         | change of the ripple per unit of a limit     | N m per unit            |
| `infeasibility`         | conflicting limits, feasible relaxations     | factor                  |
| `fe_correction`         | correction by finite elements; JSON record   | ratio                   |
| `synthesis_rounds`      | rounds of synthesis and correction           |                         |

Imports `geometry`, `base`, `engine`, `contact`, `follower`, `case`, `cycle` and `checks`.
"""
