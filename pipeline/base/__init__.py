"""Units, quantities, tables, files, disk cache, worker processes, progress.

In the order of use:

| module             | responsibility                                           | symbol, unit     |
| ------------------ | -------------------------------------------------------- | ---------------- |
| `units`            | unit strings to SI and back; units of column names       |                  |
| `printed_text`     | text with escapes for what steers a terminal             |                  |
| `missing_kinds`    | kinds of cams, followers and springs that are not done   |                  |
| `quantities`       | quantities of an input: unit, bounds, source, example    | SI               |
| `field_texts`      | docstrings below the fields of a class                   |                  |
| `source`           | source of a value, and whether it confirms the value     |                  |
| `material`         | material card: elastic constants, strengths, source      | E, Pa; nu; S, Pa |
| `hardness_rules`   | endurance of a steel surface estimated from its hardness | HB, HV; p, Pa    |
| `cooling`          | heat that the mechanism gives to its surroundings        | G, W/K; T, K     |
| `external_force`   | force over the cam angle, linear between samples         | F_e, N           |
| `stem_layout`      | guides, seats and spring along the stem                  | z, m             |
| `counterweight_body` | width, room and unbalance of a counterweight           | m; U, kg m       |
| `envelope`         | box that holds the mechanism over the turn               | m                |
| `files`            | files read, written in one step, hashed; JSON records    | SHA-256          |
| `owned_folder`     | folder of one command, locked, without foreign files     |                  |
| `extras`           | libraries that are not installed with the package        |                  |
| `kept_results`     | properties kept in a field that other owners take over   |                  |
| `columns`          | data frame and figure of columns, for a notebook         |                  |
| `fits`             | sizes with limit deviations: bores and keyways           | m                |
| `tables`           | columns with unit and meaning; CSV files                 |                  |
| `spreadsheets`     | CSV tables as .xlsx, rounded and ready to print          |                  |
| `store`            | values by key, each in a file of a folder                |                  |
| `disk_cache`       | arrays that depend on their key alone, kept between runs |                  |
| `worker_processes` | processes with one BLAS thread and a safe import path    |                  |
| `verdict`          | meaning of status, utilisation, verdict, governing       | utilisation      |
| `crossing`         | least value that passes, between one that fails and more |                  |
| `rounding`         | numbers of few significant digits, rounded up or down    |                  |
| `formula`          | formula texts of checks: read, evaluated, written        | SI               |
| `levers`           | levers of a check: keys, direction, range                | factor           |
| `progress`         | progress of a run on the terminal                        | s                |

Imports `geometry` alone. A column stands beside its values, in the `columns()` of the class that
computes them; `results.run_records.column_table` lists all.
"""
