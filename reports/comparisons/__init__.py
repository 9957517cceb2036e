"""Pages and pictures of comparisons, sizes and inspections. Nothing is solved.

In the order of use:

| module                | responsibility                                                       |
| --------------------- | -------------------------------------------------------------------- |
| `smoother_page`       | comparison of smoothers                                              |
| `redesign_page`       | Pareto front of a redesign                                           |
| `inspection_pictures` | deviation of a measured cam, normal force and contact pressure       |

Imported by `commands`.
"""
