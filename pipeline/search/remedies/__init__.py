"""Remedies: smallest single change of a case that turns a failed check to pass.

In the order of the calculation:

| module              | responsibility                                    | symbol, unit   |
| ------------------- | ------------------------------------------------- | -------------- |
| `lever_steps`       | changes of a lever in a case                      | SI             |
| `remedy`            | remedy of a check in one line, side effects       |                |
| `side_effects`      | checks that fail or pass with a change, figures   | N m; MPa; g    |
| `remedy_search`     | search over the levers, verification              | factor         |

Imports `results` and what it imports.
"""
