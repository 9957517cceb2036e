"""Commands of the command line: arguments in, exit code out; `cli` runs them.

| module                | responsibility                                               |
| --------------------- | ------------------------------------------------------------ |
| `arguments`           | arguments and options from the signature of a command; help  |
| `output_streams`      | output streams whose reader may leave before the end         |
| `terminal`            | exit codes, output streams, progress, text of a verdict      |
| `command_tree`        | commands by their words; the tree on a screen; former words  |
| `completion`          | completion by bash                                           |
| `new_command`         | `new`: a first case                                          |
| `check_command`       | `check` of a run or the preview of a case; `design remedies` |
| `run_command`         | `run`: a case to a run folder                                |
| `report_command`      | `report`: page, figures and sheets of a run                  |
| `explain_command`     | `explain`: a key, a check or a record                        |
| `inspect_command`     | `inspect`: measured cam                                      |
| `machine_command`     | `design machine`: a case with all parts from a torque table  |
| `parts_command`       | `design parts`: search of the catalogues                     |
| `sizes_command`       | `design sizes`: keys that a case leaves open                 |
| `crown_command`       | `design crown`: crown of cam or follower                     |
| `smoother_command`    | `design smoother`: smoothers ranked on a case                |
| `contact_command`     | `contact cylinders`, `contact deck`                          |
| `study_command`       | `study run`, `study report`: many designs                    |
| `signature_commands`  | `sign key`, `sign run`: signatures of the record of a run    |

Imports every other package.
"""
