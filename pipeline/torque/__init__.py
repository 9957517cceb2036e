"""Torque of any periodic machine: period, torque over the cycle and over the cam turn.

In the order of the calculation:

| module   | responsibility                                   | symbol, unit   |
| -------- | ------------------------------------------------ | -------------- |
| `period` | angle of the cycle, shaft turns per cam turn     | theta, rad     |
| `torque` | torque as a sum of components; onto the cam turn | T, N m         |

Imports `geometry` and `pipeline.base`.
"""
