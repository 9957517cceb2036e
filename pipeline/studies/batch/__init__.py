"""Studies of many designs: study file, sampling, solved rows, dataset.

In the order of the calculation:

| module    | responsibility                                | symbol, unit        |
| --------- | --------------------------------------------- | ------------------- |
| `dataset` | columns, shards and table of all rows         | unit of each column |

Imported by `commands` alone; Dask, Arrow and SALib are imported where they are used.
"""
