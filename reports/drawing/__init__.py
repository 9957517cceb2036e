"""Drawing of the mechanism: cam, follower, guides, spring and forces as lines. Nothing is solved.

In the order of use:

| module           | responsibility                                            | symbol, unit |
| ---------------- | --------------------------------------------------------- | ------------ |
| `drawing_shapes` | outlines, arrows, texts; groups that move together        | x, y, mm     |
| `spring_shapes`  | coils, gas spring, torsion spring between their seats     | L, mm        |
| `arm_parts`      | second arm with its output, spring between arm and ground | lift, mm     |
| `second_follower` | second roller or face, its arm or frame, second disc     | mm           |
| `arrangement`    | the mechanism at a cam angle, with force arrows to scale  | theta, rad   |
| `part_view`      | the cam in front view, section and detail, dimensioned    | mm           |
| `drawing_svg`    | a drawing as SVG, in fixed colours or in those of a page  |              |

Coordinates are in the plane of the cam, y along the follower axis, away from the cam. Imports
`geometry` and `base`; `reports` reads the sizes from a run.
"""
