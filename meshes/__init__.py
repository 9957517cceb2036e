"""Finite-element meshes of the bodies and of the contact patch.

In the order of the calculation:

| module          | responsibility                            | symbol, unit          |
| --------------- | ----------------------------------------- | --------------------- |
| `element_size`  | element size from the Hertz half-width    | a, m; h, m            |
| `outline`       | outlines of bodies, element edges on them | m                     |
| `cam_outline`   | contour, bore and keyway of the cam, wall | m                     |
| `gmsh_mesher`   | triangulation within outlines, by gmsh    | m                     |
| `body_mesh`     | meshes of cam, roller, face and patch     | x, y, m               |
| `shaft_mesh`    | cam on its shaft, facing nodes            | x, y, m               |
| `mesh_quality`  | angles, scaled Jacobians, edges           | deg; -                |
| `vtu`           | VTU file of a grid                        |                       |
| `mesh_files`    | MSH and VTU files                         | mm, N, MPa            |
| `calculix_deck` | input deck for CalculiX and Abaqus        | mm, N, MPa            |
| `step_text`     | STEP file of a part: header, product      | mm                    |
| `step_solid`    | solid of the cam in a STEP file           | mm                    |

Imports `geometry` alone.
"""
