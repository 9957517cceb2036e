"""Plane-strain elasticity: closed forms and finite elements.

In the order of the calculation:

| module                  | responsibility                            | symbol, unit            |
| ----------------------- | ----------------------------------------- | ----------------------- |
| `plane_stress_measures` | maximum shear, von Mises stress           | tau, Pa; sigma_v, Pa    |
| `halfplane`             | half-plane under point force and pressure | u E'/P, -; sigma/P, 1/m |
| `radial_compliance`     | pin and bush under harmonic pressures     | w_n, 1/Pa               |
| `sparse_factor`         | factorisation of sparse matrices          |                         |
| `round_body`            | round body under harmonics, FE along it   | u E/p, -                |
| `elastic_body`          | finite-element body, condensation, stress | u, m; sigma, Pa         |
| `fitted_stress`         | stress fitted to displacements    | sigma, Pa               |
| `pressure_distribution` | pressure shapes, fitted ellipse           | p, Pa; p0, Pa; a, m     |
| `surface_integrals`     | contact frame, nodal loads                | xi, m; m                |
| `active_set`            | frictionless contact by complementarity   | p, Pa; d, m             |
| `mesh_convergence`      | Richardson extrapolation, error estimate  | gci, -                  |

Imports `geometry` and `meshes`.
"""
