"""Remedies: for a failed check the smallest single change of the case that turns it to pass.

In the order of the calculation:

| module              | responsibility                                    | symbol, unit   |
| ------------------- | ------------------------------------------------- | -------------- |
| `lever_steps`       | values of a lever in a case; the case with them   | SI             |
| `remedy`            | remedy of a check in one line, side effects       | N m; MPa; g    |
| `case_judge`        | checks of a changed case, its side effects        | utilisation, - |
| `remedy_search`     | search over the levers, verification              | factor         |

Imports `results` and what it imports.
"""
