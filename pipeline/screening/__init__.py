"""Screening: lift, contour, loads and closed-form checks of thousands of designs as arrays.

In the order of the calculation:

| module              | responsibility                                      | symbol, unit         |
| ------------------- | --------------------------------------------------- | -------------------- |
| `design_factors`    | factors of the designs, their bounds; groups        |                      |
| `design_arrays`     | lift, contour, loads and contact of many designs    | s, m; F_n, N; p0, Pa |
| `screened_checks`   | demand and limit of each check of many designs      | SI                   |
| `design_screening`  | columns of the screening: demands, status, `screen` | as in the record     |

The formulas are those of the checks: `checks`, `follower` and `contact` on arrays (designs, cam
angles). Guides are point supports, the crank speed is constant, no corner and no speed sweep is
solved. Imports `solver`, `preview` and what they import.
"""
