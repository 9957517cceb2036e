"""Line contact of finite length: ends, crown, tilt.

In the order of the calculation:

| module           | responsibility                                          | symbol, unit |
| ---------------- | ------------------------------------------------------- | ------------ |
| `axial_drop`     | ends and crowns, gap of two bodies                      | y, m; gap, m |
| `pressure_cells` | rectangular cells of constant pressure                  | x, y, m      |
| `contact_span`   | cells on the part of a crowned line that touches        | y, m         |
| `half_space`     | compliance of half-spaces with mirrored ends            | m3/Pa        |
| `brick_body`     | compliance of a block by finite elements                | m3           |
| `length_contact` | pressures under force, tilt or moment                   | p, Pa; F, N  |
| `length_tiers`   | both tiers over plane strain, error bars, many contacts | K, -         |
| `block_stress`   | displacement and stress of a block at one contact       | sigma, Pa    |
| `factor_table`   | axial pressure of one pair of bodies, tabulated         | K, -         |
| `length_certificate` | both tiers at chosen angles of a cycle              | K, -         |
| `subsurface_stress` | von Mises and shear stress below middle and ends      | sigma, Pa    |

Imports `contact` and `base`.
"""
