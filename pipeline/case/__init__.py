"""Case: sections of a case file, their consistency, and its torque, lift and machine.

In the order of the calculation:

| module                 | responsibility                               | symbol, unit     |
| ---------------------- | -------------------------------------------- | ---------------- |
| `section`              | base of the sections; parts as fields        |                  |
| `toml_text`            | tables of a case as TOML, units included     |                  |
| `case_writer`          | text of case files: values, comments, tables |                  |
| `renamed_keys`         | former names of keys, in `renamed.toml`      |                  |
| `limits`               | table of limits, section `[limits]`          | SI               |
| `value_sources`        | source of each value, confirmed or not       |                  |
| `engine_section`       | engine: a cylinder model or a measurement    | T, N m           |
| `torque_section`       | torque of a machine of any cycle             | T, N m           |
| `lift_section`         | lift: table, segments, points or eccentric   | s, m; theta, rad |
| `scope_section`        | parts that the sign-off does not cover       |                  |
| `parts_section`        | follower, valve train                        | m, kg            |
| `requirements_section` | smoothing, tolerances, load cases, solver    | rad/s; N; rad    |
| `workshop_section`     | workshop files; title block of the documents | m, rad           |
| `case`                 | `Case`: all sections, included files, hash   |                  |
| `consistency`          | consistency of the sections with one another |                  |
| `error_text`           | first error in one line: field, value, limit |                  |
| `cards`                | cards of materials and parts, catalogues     |                  |
| `external_load`        | external force and weight of the follower    | F_e, N           |
| `given_lift`           | lift of a case without engine                | s, m             |
| `keys`                 | every key: meaning, unit, range, default     |                  |
| `added_tables`         | tables that complete a case; missing keys    |                  |
| `unknown_keys`         | unknown keys beside what else is refused     |                  |
| `closure_tables`       | what stands for the spring of such a cam     |                  |
| `arm_tables`           | scope and start angle of an oscillating arm  | psi, rad         |
| `rocker_tables`        | what the output of a rocker carries          | kg; N            |
| `case_file`            | reading of a case file                       |                  |
| `case_values`          | values by dotted key; the case with others   |                  |
| `speed_notes`          | a measured speed: its wheel and cycle        |                  |
| `load_case_torque`     | engine torque of each load case              | T, N m           |
| `template`             | first case of each kind of source            |                  |
| `plausibility`         | values beyond their usual ranges             |                  |
| `machine`              | `Machine`: the parts in one load case        | SI               |

Imports `geometry`, `pipeline.base`, `pipeline.torque`, `pipeline.engine`, `pipeline.contact` and
`pipeline.follower`.
"""
