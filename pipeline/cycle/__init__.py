"""Cycle: loads, contact, rolling and part loads over one cam turn.

In the order of the calculation:

| module               | responsibility                                  | symbol, unit           |
| -------------------- | ----------------------------------------------- | ---------------------- |
| `cam_balance`        | unbalance of the cam, counter-hole              | U, kg m; F, N          |
| `contact_setup`      | cam and follower of a machine as a contact pair |                        |
| `numbers`            | numbers of a machine by dotted key              | SI                     |
| `loaded_cam`         | motion, forces, guides, contact as arrays       | F_n, N; s, m; p0, Pa   |
| `arm_bodies`         | parts of an arm over its swing                  | m; psi, rad            |
| `machine_envelope`   | parts of the mechanism, envelope over the turn  | m                      |
| `crank_speed`        | crank speed with and without cam, consistency   | omega, rad/s; J, kg m2 |
| `turn`               | loads and guide reactions of a load case        | F_n, N; T, N m         |
| `elastic_response`   | follower on its elastic stem, loss of contact   | F, N; delta, m         |
| `part_loads`         | guides, stem, spring, pin, ring, key, camshaft  | p, sigma, Pa; F, N     |
| `pivot_history`      | pin in the bush of a pivot by finite elements   | p, Pa; tilt, rad       |
| `oil_film_history`   | film thickness and its ratio to roughness       | h, m; lambda           |
| `line_tilt`          | tilt of the line of contact, its parts          | rad                    |
| `length_history`     | pressure along the line: ends, crown, tilt      | K, -; M, N m           |
| `contact_heat`       | flash temperature of a flat face                | T, K                   |
| `rolling_history`    | traction, creep, rolling fatigue, bore stress   | tau, sigma, Pa; xi     |
| `crossover_history`  | landings on a track: force, pressure, slip      | v, m/s; F_n, N         |
| `cycle`              | turn with contact; columns of its table         |                        |
| `speed_sweep`        | surge, contact force, torque over the speed     | F_n, N; T, N m         |
| `valve_cam`          | machine motion of a valve cam                   | J*, kg m2; rad/s       |
| `ripple_map`         | torque ripple by speed and engine load          | std ratio, -           |
| `axial_pressure`     | pressure along the line at every position       | y, m; p, Pa            |
| `guide_pressure`     | line load of the guides, pressure in the bores  | P', N/m; p, Pa         |
| `length_records`     | contacts of finite length as records            | K, -                   |
| `contact_store`      | store of solved pieces of the contact           |                        |
| `certificate_angles` | angles of the certificate, their solution       | theta, rad             |
| `pressed_discs`      | discs under the contacts of their followers     | theta, rad; F_n, N     |
| `notch_fatigue`      | keyway's root: Goodman, FKM, bound              | sigma, Pa; use, -      |
| `hub_history`        | keyway's root over the turns, its fatigue       | sigma, Pa; safety, -   |
| `solution`           | all load cases of a cam, by one tier            |                        |
| `solved_cam`         | loaded cam of a solution                        | F_n, N; s, m           |

Imports `case`, `contact`, `engine`, `follower` and what they import; no checks and no files.
"""
