"""Redesign: Pareto front of torque ripple and size or mass over the catalogues.

In the order of the calculation:

| module           | responsibility                                | symbol, unit |
| ---------------- | --------------------------------------------- | ------------ |
| `ripple_bounds`  | lower bounds of the residual ripple           | -; J; N      |
| `part_search`    | search order over rollers, springs and bushes |              |
| `exclusions`     | limits that exclude choices, changes needed   |              |
| `redesign_study` | command: search, front, case files, record    |              |

Imported by `commands` alone.
"""
