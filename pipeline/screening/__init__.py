"""Screening: lift, contour, loads and closed-form checks of thousands of designs as arrays.

In the order of the calculation:

| module              | responsibility                                      | symbol, unit         |
| ------------------- | --------------------------------------------------- | -------------------- |
| `design_factors`    | factors of the designs, their bounds; groups        |                      |
| `design_lengths`    | pressure along the line of contact of many designs  | K, -                 |
| `screened_cam`      | loads and contact of many designs in a load case    | F_n, N; p0, Pa       |
| `design_arrays`     | lift, contour and load cases of many designs        | s, m                 |
| `screened_pivot`    | edge pressure in the bush of the pivot of an arm    | p, Pa                |
| `screened_checks`   | the checks that screening judges                    |                      |
| `design_screening`  | columns of the screening: demands, status, `screen` | as in the record     |
| `response_surface`  | polynomials through values of many designs          |                      |
| `live_preview`      | surfaces about the design of a run, for its page    | ``8_live.json``      |

The formulas are those of the checks: `checks`, `follower` and `contact` on arrays (designs, cam
angles). Loads of the guides are interpolated in tables, the crank speed is constant, no corner and
no speed sweep is solved. Imports `solver`, `preview` and what they import.
"""
