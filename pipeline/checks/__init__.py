"""Checks: one function per limit.

In the order of the calculation:

| module                  | responsibility                             | symbol, unit             |
| ----------------------- | ------------------------------------------ | ------------------------ |
| `extremes`              | extremes over load cases and cam angles    | cam angle, rad           |
| `check`                 | declaration, demand and limit, verdict     | utilisation              |
| `demands`               | formulas common to checks and synthesis    | SI                       |
| `value_groups`          | groups of keys on which checks rest        |                          |
| `missing_keys`          | keys that the case lacks                   |                          |
| `part_data`             | data that a described part lacks           |                          |
| `torque_balance`        | ripple reduction, energy balance           | T, N m; E, J             |
| `cam_shape`             | pressure angle, curvature, interference    | alpha, rad; rho, m       |
| `jump_and_jamming`      | contact force, follower jump, jam index    | F_n, N; n, rad/s         |
| `contact_strength`      | endurance, yield, shakedown                | p0, Pa                   |
| `form_closure`          | groove, pair of discs, landings, slip      | sigma, p, Pa; v, m/s     |
| `surface_durability`    | traction, oil film, fatigue, hardened case | T/F_n; lambda; sigma, Pa |
| `roller_bearing`        | rating, life, speed, grease of the bearing | s0; L10, s; n, rad/s     |
| `guide_strength`        | pressure, PV value, temperature of guides  | p, Pa; PV, Pa m/s        |
| `spring_strength`       | strength, gaps, buckling, surge, set       | tau, Pa; f, Hz           |
| `gas_spring`            | pressure, stroke, warmth of a gas spring   | p, Pa; v, m/s; K         |
| `shaped_springs`        | torsion and extension springs, links       | sigma, tau, Pa; F, N     |
| `part_strength`         | pin, fork, ring, mass, bore, balance       | sigma, Pa; kg; e w, m/s  |
| `arm_strength`          | fatigue and yield of an arm                | sigma, Pa; safety, -     |
| `key_strength`          | key of the cam, keyway root, slip of seat  | p, tau, Pa; safety, -    |
| `camshaft_strength`     | camshaft, its bearings and driving gear    | sigma, Pa; L10, s; rad   |
| `flat_face_sliding`     | width and PV value of a flat face          | m; PV, Pa m/s            |
| `guide_wear`            | expansion and wear of the guides           | m                        |
| `pivot_bearing`         | jam index, rating of an arm's pivot        | L10, s                   |
| `assembly`              | gaps between parts that pass one another   | m                        |
| `arm_assembly`          | gaps of an arm and the boss of its pivot   | m                        |
| `pair_assembly`         | gaps of a second disc, roller, arm, face   | m                        |
| `manufacture`           | space, waviness, chord error, phase        | m                        |
| `solution_verification` | plane strain, meshes, certificate          | relative; half-widths    |
| `error_bars`            | error bars of the demands                  | relative                 |
| `lost_loads`            | checks where the follower leaves the cam   | cam angle, rad           |
| `confirmation`          | recalled values on which a check rests     |                          |
| `registry`              | all checks of a solution, with waivers     |                          |
| `tolerance_corners`     | governing tolerance corner of each check   |                          |

Imports `geometry`, `meshes`, `base`, `engine`, `contact`, `follower`, `case` and `cycle`.
"""
