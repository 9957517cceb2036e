"""Torque of any periodic machine: period, torque over the cycle and over the cam turn.

In the order of the calculation:

| module            | responsibility                                   | symbol, unit    |
| ----------------- | ------------------------------------------------ | --------------- |
| `period`          | angle of the cycle, shaft turns per cam turn     | theta, rad      |
| `trace_file`      | text of a trace file, units of its header        |                 |
| `angle_trace`     | one quantity against shaft angle                 | theta, rad; SI  |
| `tabled_torque`   | torque from a table, its checks                  | T, N m          |
| `harmonic_torque` | torque of a mean and harmonics                   | T, N m          |
| `piston_drive`    | crank drive and areas of a piston                | p, Pa; T, N m   |
| `pressure_torque` | torque of pressures from a file                  | p, Pa; T, N m   |
| `valved_cylinder` | compressor and piston pump                       | p, Pa; T, N m   |
| `press_torque`    | force over the stroke of a ram                   | F, N; T, N m    |
| `motor_line`      | torque of a motor over its speed                 | T, N m; omega   |
| `machine_torque`  | marks of a cycle, drive or load                  | theta, rad      |
| `torque`          | torque as a sum of components; onto the cam turn | T, N m          |

Imports `geometry` and `pipeline.base`.
"""
