"""Sizing: open keys of a case, as small as its limits allow.

In the order of the calculation:

| module          | responsibility                                    | symbol, unit       |
| --------------- | ------------------------------------------------- | ------------------ |
| `open_case`     | a case with open keys; the case with their values |                    |
| `shapes`        | prime or base radius, offset, roller, face        | r, e, m            |
| `spring_size`   | rate and preload against follower jump            | k, N/m; P, N       |
| `spring_choice` | rate and preload against jump, surge              | k, N/m; P, N       |
| `sizing`        | values of the open keys, their checks             | SI                 |
| `size_chart`    | pressure angle and curvature over the base radius | alpha, rad; rho, m |
| `size_record`   | record, text and source of the sized values       | mm, N, deg         |

Imports `screening` and what it imports.
"""
