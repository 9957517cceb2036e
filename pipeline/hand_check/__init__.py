"""Hand-check sheet: checks of a finished run evaluated again from their formula texts.

| module          | responsibility                                                    |
| --------------- | ----------------------------------------------------------------- |
| `hand_sheet`    | symbols on the numbers of the run, steps, result beside the check |
| `sheet_lines`   | the sheet as lines of text                                        |
| `printed_sheet` | the sheet as words and formulas of page and PDF                   |

Imports `geometry`, `base`, `case`, `cycle`, `checks` and `results`.
"""
