"""Contact of cam and follower: Hertz, finite elements, traction, oil film.

In the order of the calculation:

| module               | responsibility                                 | symbol, unit         |
| -------------------- | ---------------------------------------------- | -------------------- |
| `elasticity`         | plane-strain elasticity of bodies and surfaces |                      |
| `tiers`              | tiers of a solution: preview, finite elements  |                      |
| `axial_shape`        | ends and crown of a body, as a case has them   | m                    |
| `shrink_fit`         | fit of the cam on its shaft: pressure, slip    | p, Pa; T, N m        |
| `rolling_bearing`    | bearing of a roller, its outer ring            |                      |
| `cam_body`           | cam disc: radii, width, bore, key, material    | m                    |
| `hertz`              | line contact, subsurface stress                | a, m; p0, Pa; E*, Pa |
| `follower_body`      | roller or flat face in contact with the cam    | m                    |
| `contact_pair`       | cam and follower: relative radius, gap         | R, m; gap, m         |
| `contact_history`    | contact over the turn, certificate point       | p0, Pa; a, m         |
| `closed_form`        | contact over the turn by Hertz                 | p0, Pa; a, m         |
| `contact_patch`      | finite-element template of the half-plane      | -                    |
| `body_compliance`    | correction of the half-plane for a real body   | Pa m/N; 1/N          |
| `two_scale`          | contact over the turn by patch and corrections | p0, tau, sigma_v, Pa |
| `full_contact`       | two bodies in contact by finite elements       | p, Pa; u, m          |
| `certificate`        | full contact at one cam angle on its meshes    | gci, -               |
| `contact_benchmarks` | benchmarks: NAFEMS R0094 and Hertz             | -                    |
| `ring_body`          | outer ring of a bearing on balls               | N/m                  |
| `pin_in_hole`        | conforming contact: Persson, complementarity   | p, Pa; phi, rad      |
| `pin_in_bush`        | tilted pin in a bush of finite length, FE      | p, Pa; tilt, rad     |
| `conforming_line`    | roller in a concave wall, over positions       | p0, Pa; a, m         |
| `traction`           | stick zone, creepage, slip of a driven roller  | F_t, N; slip, m/s    |
| `tangential_patch`   | finite-element template under tractions        | -                    |
| `bore_stress`        | stress at bore and keyway                      | sigma_v, Pa          |
| `hub_elements`       | cam on its shaft: pressure, keyway's root      | p, sigma, Pa         |
| `rolling_envelope`   | stress below the contour, fatigue              | Pa; depth, m         |
| `oil_film`           | film thickness, asperity load share            | h, m; lambda, -      |
| `flash_temperature`  | flash and bulk temperature of a sliding contact | T, K                |
| `finite_length`      | ends, crown and tilt of finite bodies          | K, -                 |

Imports `geometry`, `meshes` and `base`.
"""
