"""Geometry of the cam: motion law, lift, pitch curve and contour.

In the order of the calculation:

| module              | responsibility                              | symbol, unit                 |
| ------------------- | ------------------------------------------- | ---------------------------- |
| `errors`            | exceptions of the project                   |                              |
| `display`           | a result in one line and as a table         |                              |
| `arrays`            | read-only arrays, checks of input values    | theta, rad                   |
| `figures`           | contents of a figure; drawn in a notebook   |                              |
| `extrema`           | extremes of a periodic function             |                              |
| `periodic_spline`   | periodic quintic (C4), cubic, and integral  |                              |
| `monotone_cubic`    | cubic without extremes between its samples  |                              |
| `acceleration_jump` | discontinuity of the acceleration           | m/rad^2                      |
| `lift`              | lift and its derivatives                    | s, m; s', s'', s''', m/rad^k |
| `motion_laws`       | lift by rise, dwell and return              | s, m                         |
| `lift_parts`        | lift in smooth parts, extremes              | s, m; s', s'', m/rad^k       |
| `lift_fit`          | lift through points or noisy tables         | s, m; residual, m            |
| `eccentric`         | eccentric disc and its slider-crank         | l1, l2, m; phi, rad          |
| `linkage`           | slider-crank                                | r, l, m                      |
| `energy`            | lift from cam torque by stored energy       | T, N m; E, J; P, N; k, N/m   |
| `rocker_lift`       | lift of a valve by a rocker, and back       | v, s, m; r, -                |
| `follower_path`     | path of a follower point in the cam frame   | d, e, m                      |
| `pitch_curve`       | path of the roller centre, pressure angle   | alpha, rad; kappa, 1/m       |
| `cam_size`          | smallest radius, best offset, face width    | r, e, m                      |
| `interference`      | self-intersection, second contact           | theta, rad; gap, m           |
| `follower_height`   | height of a follower on points of a contour | d, m                         |
| `contour`           | cam surface; that under a roller            | x, y, m; rho, m              |
| `flat_face_contour` | cam surface under a flat face               | r + s + s'', m               |
| `arm_path`          | cam surface under the roller of an arm      | psi, rad; c, l, m            |
| `arm_face`          | cam surface under a face of an arm          | psi, rad; f, q, m            |
| `arm_size`          | prime radius and centre distance of an arm  | r, c, m                      |
| `swung_bar`         | distances of an arm over its swing          | psi, rad; m                  |
| `form_closure`      | walls of a groove                           | x, y, m                      |
| `second_track`      | second roller or face of a cam that pulls   | x, y, m; l1/l2, -            |
| `track_deviation`   | clearance of two tracks under deviations    | m                            |
| `measured_contour`  | measured contour against the nominal one    | phase, rad; deviation, m     |
| `cutter_path`       | path of a milling cutter or grinding wheel  | x, y, m                      |
| `cutouts`           | bore, keyway and counter-hole               | m                            |
| `arc_polyline`      | contour as arcs within a tolerance          | m                            |
| `cad_drawing`       | clamped spline, DXF file                    | m; mm in the file            |

Imports no other package of the project.
"""
