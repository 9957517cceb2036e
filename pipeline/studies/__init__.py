"""Studies besides a run: inspection, comparisons, redesign, published values.

In the order of the calculation:

| module                   | responsibility                                | symbol, unit        |
| ------------------------ | --------------------------------------------- | ------------------- |
| `two_cylinders`          | line contact of two cylinders by three models | p0, Pa; a, m        |
| `finite_length_document` | ends, crown and tilt of this contact          | K, -; N mm; mrad    |
| `two_cylinders_document` | options, document and text of this contact    | MPa, mm             |
| `smoother_comparison`    | smoothers on one case by previews             | N m                 |
| `cam_inspection`         | measured cam: fit, cycle, checks              | m; um in the record |
| `redesign`               | Pareto front over the catalogues              |                     |
| `design`                 | from a torque to a case with all parts        | E, J                |
| `papers`                 | published values, recomputed                  |                     |
| `batch`                  | studies of many designs                       |                     |

Imported by `commands`.
"""
