"""Follower: forces, guides, spring, roller, flat face, loads of the camshaft.

In the order of the calculation:

| module                  | responsibility                             | symbol, unit          |
| ----------------------- | ------------------------------------------ | --------------------- |
| `stem_beam`             | stem as a chain of beam elements           | E I, N m2; m/N        |
| `wound_wire`            | wire of a helical spring: rate, strength   | k, N/m; tau, Pa       |
| `spring_kinds`          | gas, torsion, extension; lift from energy  | rho, m; p, Pa         |
| `spring_link`           | spring between an arm and a fixed point    | u, m; du/ds           |
| `spring`                | helical spring, strength, buckling, surge  | k, N/m; P, N; tau, Pa |
| `pivot_forces`          | moments about the pivot of an arm          | R, N; mu, -           |
| `follower_forces`       | forces with guide friction                 | F_a, N; T, N m        |
| `guide_contact`         | beam in bores with unilateral contact      | N; m                  |
| `guide_reactions`       | reactions and pressures of two guides      | A, B, N; p, Pa        |
| `friction_coupling`     | contact force with guide friction          | F_a, N                |
| `guide_table`           | reactions over side force and overhang     | F_t, N; a, m          |
| `guide_effects`         | effects of guide length and clearance      | N                     |
| `guide_friction`        | friction bounds and power, temperature     | mu, -; W; K           |
| `elastic_follower`      | elastic follower, periodic response        | x, m; N, N            |
| `follower_flight`       | flights and landings in time               | m; m/s; J             |
| `disc_preload`          | both discs of a pair pressed               | P, N; b, -            |
| `crossover`             | flight and landing between two tracks      | t, s; v, m/s          |
| `roller_parts`          | pin, fork                                  |                       |
| `roller_motion`         | spin, traction demand, rating life         | rad/s; L10, s         |
| `bearing_life`          | lubrication, modified life, grease life    | kappa; a_ISO; L, s    |
| `bearing_ring`          | bending of the outer ring                  | M, N m; sigma, Pa     |
| `bearing_ring_elements` | outer ring on balls by finite elements     | m/N; Pa/N             |
| `ring_on_balls`         | outer ring as roller                       |                       |
| `pin_strength`          | bending, shear, pressure of the pin        | sigma, Pa             |
| `flat_face_motion`      | sliding and entrainment speed of a face    | m/s; pv, Pa m/s       |
| `arm`                   | arm of an oscillating follower             | c, l, m; psi, rad     |
| `pivot`                 | bush or needle bearing of an arm's pivot   | kg; m; N m            |
| `rocker`                | second arm for a valve, with lash          | r, -; lash, m         |
| `follower_kind`         | protocol of the kinds of follower          |                       |
| `roller`                | roller: geometry, contact body, rolling    | r, m                  |
| `flat_face`             | flat face: geometry, contact body, sliding | m                     |
| `camshaft_loads`        | key, bearings, unbalance, counter-hole     | N; Pa; kg m           |
| `shaft_strength`        | camshaft sections, bending; gear teeth     | Pa; safety, -; rad    |
| `arm_beam`              | arm as a beam: sections, stress, bending   | M, N m; Pa; m/N       |
| `second_arm`            | second arm of a rocker as a beam           | M, N m                |
| `pivot_bush`            | pin tilted in the bush of a pivot          | rad; N/m              |
| `follower_tilt`         | tilt of stem or arm across the cam         | rad; rad/(N m)        |
| `follower_stiffness`    | bearing, pin, fork, stem, shaft in series  | m/N; N/m              |

A further kind of follower is a class with the attributes of `follower_kind.FollowerKind`, a contour
in `geometry`, a contact body in `contact` and a section in `case`; for the constrained synthesis a
motion in `smoothing.cam_state`.

Imports `geometry`, `base` and `contact`.
"""
