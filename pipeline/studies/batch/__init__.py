"""Studies of many designs: study file, sampling, rows on a cluster, dataset.

In the order of the calculation:

| module                | responsibility                                  | symbol, unit        |
| --------------------- | ----------------------------------------------- | ------------------- |
| `study_file`          | base cases, factors, sampling, depth, kept runs | SI                  |
| `factor_axes`         | factors: levels, distributions, values          | SI                  |
| `sampling`            | designs by grid, list, samples of the cube      | share, -            |
| `case_template`       | base cases with their files                     |                     |
| `design_task`         | designs of one shard, settings of all           |                     |
| `design_plan`         | content hash of a design; tasks                 | SHA-256             |
| `dataset`             | columns, Parquet files, reading                 | unit of each column |
| `design_rows`         | row of a design, refusals, files of a shard     |                     |
| `design_solver`       | solution of a design; files of its run          |                     |
| `solver_process`      | supervised process: time, memory, death         | s; B                |
| `cluster_worker`      | part of a Dask worker                           |                     |
| `task_scheduler`      | tasks on a local or running cluster             |                     |
| `answers_yield`       | yield with its confidence interval              | share, -            |
| `row_selection`       | best, borderline, front, failed designs         | utilisation, -      |
| `study_folder`        | files of a study, written in one step           |                     |
| `study_run`           | both stages, dataset, kept runs, summary        |                     |
| `answers_sensitivity` | main effects and Sobol indices of the factors   | share, -            |
| `answers`             | answers to a study from its dataset             | unit of each column |

Imported by `commands` alone; Dask, Arrow and SALib are imported where they are used.
"""
