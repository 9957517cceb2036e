"""Studies besides a run: line contact of two cylinders, inspection, batches.

In the order of the calculation:

| module                   | responsibility                                | symbol, unit        |
| ------------------------ | --------------------------------------------- | ------------------- |
| `two_cylinders`          | line contact of two cylinders by three models | p0, Pa; a, m        |
| `finite_length_document` | ends, crown and tilt of this contact          | K, -; N mm; mrad    |
| `two_cylinders_document` | options, document and text of this contact    | MPa, mm             |
| `cam_inspection`         | measured cam: fit, cycle, checks              | m; um in the record |
| `batch`                  | studies of many designs                       |                     |

Imported by `commands`.
"""
