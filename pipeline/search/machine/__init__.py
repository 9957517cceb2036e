"""Design: from a torque table to a case with all parts, and the front of ripple and size.

In the order of the calculation:

| module             | responsibility                                  | symbol, unit        |
| ------------------ | ----------------------------------------------- | ------------------- |
| `torque_task`      | torque and requirements, given or assumed       | T, N m; E, J        |
| `machine_frame`    | parts sized by roller and cam torque            | m                   |
| `wound_springs`    | springs that store the energy, as arrays        | k, N/m; P, N; s, m  |
| `design_case`      | case file of a design, with reasons and sources |                     |
| `candidate_search` | screening over rollers, springs, base circles   | T, N m; m           |
| `synthesised_points` | prime radius, preload and lift by the synthesis | r, m; P, N; s, m  |
| `part_exchange`    | parts exchanged for the next smaller ones that pass |                 |
| `relaxation_search` | smallest change of one option that passes      |                     |
| `design_study`     | front, choice, conflict and relaxations, files  |                     |

Imported by `commands` alone.
"""
