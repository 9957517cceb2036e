"""Searches: changed designs of a case, judged and compared to find the best.

In the order of the calculation:

| module      | responsibility                                       | symbol, unit       |
| ----------- | ---------------------------------------------------- | ------------------ |
| `change`    | other values of a case, the case with them           | SI                 |
| `judge`     | judgement of a change: solution, checks, figures     | utilisation, -     |
| `figures`   | figures of a judged case: ripple, size, mass         | N m; mm; g         |
| `front`     | front of two objectives                              |                    |
| `remedies`  | smallest change that cures a failed check            | factor             |
| `sizes`     | open keys of a case, as small as its limits allow    | r, e, m; k, N/m    |
| `crown`     | crown of a line contact within a ratio of pressures  | K, -; drop, m      |
| `parts`     | Pareto front over the catalogues                     | N m; m; kg         |
| `machine`   | from a torque to a case with all parts               | E, J; k, N/m; m    |
| `smoothers` | smoothers on one case by previews                    | N m                |

A run searches remedies, and the searches judge by previews: the packages lie on one floor with
`preview` and `run`, without a circle of modules.
"""
