"""From a case to a verdict: the calculation in packages, lowest first.

A run: `case` is read and its `engine` torque computed; `smoothing` gives the lift; `geometry` the
contour; `meshes` the bodies; `contact` and `follower` the loads; `cycle` the turn; `checks` the
verdict; a failed trial is smoothed again. `results` writes the run folder, `reports` the page.

| package              | responsibility                                       | symbol, unit       |
| -------------------- | ---------------------------------------------------- | ------------------ |
| `geometry`           | motion law, lift, pitch curve, contour               | s, m; rho, m       |
| `meshes`             | outlines, meshes, mesh files                         | h, m               |
| `base`               | units, quantities, tables, files, cache, processes   |                    |
| `records`            | forms of the JSON records                            | mm, N, MPa         |
| `torque`             | period of a machine, torque over its cycle           | T, N m; theta, rad |
| `engine`             | indicated cycle, torque, crankshaft                  | T, N m             |
| `contact.elasticity` | plane-strain elasticity                              | u, m; sigma, Pa    |
| `contact`            | contact of cam and follower, traction, oil film      | p0, Pa; a, m; h, m |
| `contact.finite_length` | bodies of finite length: ends, crown, tilt        | K, -               |
| `follower`           | forces, guides, spring, roller, flat face            | F_n, N; p, Pa      |
| `case`               | case file, limits, `Machine`                         | SI                 |
| `case.cards`         | materials, bushes, oils, wires, springs, bearings    |                    |
| `cycle`              | loads, contact and part loads over one cam turn      | theta, rad         |
| `checks`             | one function per check: demand, limit                | utilisation, -     |
| `smoothing`          | smoothers, constrained synthesis, shadow prices      | s, m               |
| `results`            | trial, run folder, records, workshop files, sign-off | mm, N, MPa         |
| `hand_check`         | formulas of the checks evaluated once more           | utilisation, -     |
| `solver`             | solution of one design at one tier                   |                    |
| `preview`            | synthesis and preview of a case                      |                    |
| `iteration`          | trials with smoothing between them                   |                    |
| `run`                | trials and certificate of a case, run folder         |                    |
| `recomputation`      | finished run computed again from case and lift       |                    |
| `search`             | searches over changed designs: front of objectives   |                    |
| `search.remedies`    | smallest change that cures a failed check            | factor             |
| `screening`          | closed-form checks of thousands of designs as arrays | p0, Pa; F_n, N     |
| `search.sizes`       | open keys of a case, as small as its limits allow    | r, e, m; k, N/m    |
| `search.crown`       | crown of a line contact within a ratio of pressures  | K, -; drop, m      |
| `search.parts`       | Pareto front over the catalogues                     |                    |
| `search.machine`     | from a torque to a case with all parts               | E, J; k, N/m; m    |
| `studies`            | inspection, line contact of two cylinders            |                    |
| `reports.drawing`    | drawing of cam, follower, guides, spring, forces     | mm                 |
| `reports.painting`   | pixels of a field by VTK                             |                    |
| `reports`            | report and pictures from a run folder                |                    |
| `reports.study`      | page of a study                                      |                    |
| `reports.comparisons` | pages of comparisons, sizes, inspections            |                    |
| `studies.batch`      | studies of many designs                              |                    |
| `commands`           | one function per command                             |                    |
| `cli`                | command line                                         |                    |

`geometry`, `meshes` and `reports` lie beside this package. A module imports from its own package
and from those above it in the table.
"""
