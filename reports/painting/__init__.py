"""Pixels of a field by VTK, in a process of its own, which imports little else of this program.

| module              | responsibility                                              | symbol, unit |
| ------------------- | ----------------------------------------------------------- | ------------ |
| `matplotlib_import` | the first import of matplotlib, by none of the user's files |              |
| `field_painter`     | colours and lines of a field on triangles as pixels         | x, y, mm     |
"""
