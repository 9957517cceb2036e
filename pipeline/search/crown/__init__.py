"""Crown: the crown of a line contact that keeps its axial pressure within a ratio.

In the order of the calculation:

| module         | responsibility                               | symbol, unit      |
| -------------- | -------------------------------------------- | ----------------- |
| `solved_lines` | axial pressure of few contacts, signed       | K, -; M, N m      |
| `least_crown`  | crowns within a ratio at loads and tilts     | w, N/m; drop, m   |
| `crown_design` | crown of a case, costs, sensitivity          | SI                |
| `crown_record` | record and text of a crown                   | mm, um, N/mm      |

Imported by `commands` alone.
"""
