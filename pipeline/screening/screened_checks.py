"""Checks that screening judges, with demand and limit of many designs at once.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.screening import screened_loads as loads
from camwright.pipeline.screening import screened_shape as shape
from camwright.pipeline.screening.design_arrays import Screened

_SCREENED: tuple[Screened, ...] = (
    *(
        shape.by_measure(each)
        for each in CHECKS
        if each.measured is not None and each.measured.deviation is not None
    ),
    Screened("torque_reduction", loads.torque_reduction, 0.001),
)
_PLACES = {declared.id: place for place, declared in enumerate(CHECKS)}
SCREENED = tuple(sorted(_SCREENED, key=lambda each: _PLACES[each.check]))
"""Checks that screening judges, in the order of the calculation."""
