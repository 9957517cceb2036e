"""Engine: working cycle, torque over the cycle, measured traces, crank speed.

In the order of the calculation:

| module                   | responsibility                              | symbol, unit            |
| ------------------------ | ------------------------------------------- | ----------------------- |
| `cylinder`               | crank drive, valves, charge, burn, friction | x, m; V, m3; theta, rad |
| `working_gas`            | heat capacity, energy and enthalpy          | gamma, -; u, h, J/kg    |
| `valves`                 | valve lift, mass flow, valve spring torque  | s, m; kg/(s m2); T, N m |
| `combustion`             | burnt fraction by Wiebe functions           | x_b, -                  |
| `heat_loss`              | film coefficient: Hohenberg, Woschni        | W/(m2 K)                |
| `indicated_cycle`        | working cycle: gas, torques, balance        | p, Pa; T, K; m, kg      |
| `indicated_cycle_solver` | first law until the cycle is periodic       | p, Pa; T, K; m, kg      |
| `engine_torque`          | engine torque of a model or from a table    | T, N m                  |
| `pressure_trace`         | measured cylinder pressure, its torque      | p, Pa; T, N m           |
| `brake_balance`          | indicated torque against the brake's        | T, N m; p, Pa           |
| `trigger_wheel`          | teeth of the wheel, places of the edges     | t, s; theta, rad        |
| `tooth_pattern`          | missing and additional teeth, runs          | t, s                    |
| `crankshaft`             | crank speed from torques, energy swing      | J, kg m2; omega, rad/s  |
| `torque_error_bar`       | noise of a speed record to torque           | T, N m                  |
| `band_fit`               | band-limited series through a cycle         | omega, rad/s            |
| `passing_times`          | passing times of edges, mean over cycles    | t, s                    |
| `pitch_errors`           | places of the edges from several speeds     | theta, rad              |
| `wheel_calibration`      | pitch errors or tolerance of a wheel        | theta, rad              |
| `speed_trace`            | measured crank speed, its torque            | omega, rad/s; T, N m    |
| `speed_file`             | crank speed from a file                     | t, s; omega, rad/s      |
| `pickup_voltage`         | edges from the voltage of a pick-up         | U, V; t, s              |
| `torque_consistency`     | torque, speed, inertia and work compared    | J, kg m2; E, J          |
| `modelled_trace`         | trace files of a modelled engine            | T, N m; p, Pa; t, s; V  |

Imports `geometry`, `pipeline.base` and `pipeline.torque`.
"""
