"""Commands of the command line: arguments in, exit code out; `cli` registers them.

| module                | responsibility                                          |
| --------------------- | ------------------------------------------------------- |
| `output_streams`      | output streams whose reader may leave before the end    |
| `terminal`            | exit codes, output streams, progress, text of a verdict |
| `run_command`         | `run`, `report`, `init`                                 |
| `check_command`       | `check` of a run or the preview of a case; `schema`     |
| `signature_commands`  | `keygen`, `sign`: signatures of the record of a run     |
| `explain_command`     | `explain`: a key of the case file, or a check           |
| `smoother_command`    | `compare`: smoothers ranked on a case                   |
| `contact_command`     | `contact`, `deck`                                       |
| `inspect_command`     | `inspect`: measured cam                                 |
| `design_command`      | `design`: a case with all parts from a torque table     |
| `redesign_command`    | `redesign`: search of the catalogues                    |
| `crown_command`       | `crown`: least crown of cam or follower                 |
| `size_command`        | `size`: keys that a case leaves open                    |
| `study_command`       | `study`: many designs on a cluster; answers and page    |

Imports every other package.
"""
