"""Checks that screening judges, with demand and limit of many designs at once.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.checks.spring_strength import torsion_strength
from camwright.pipeline.screening import screened_loads as loads
from camwright.pipeline.screening import screened_shape as shape
from camwright.pipeline.screening import screened_springs as springs
from camwright.pipeline.screening.design_arrays import Screened

_SCREENED: tuple[Screened, ...] = (
    *(
        shape.by_measure(each)
        for each in CHECKS
        if each.measured is not None and each.measured.deviation is not None
    ),
    Screened("torque_reduction", loads.torque_reduction, 0.001),
    Screened("spring_stress", springs.of_spring(springs.spring_stress), 0.1),
    Screened("spring_fatigue", springs.of_spring(springs.spring_fatigue), 0.1),
    Screened("spring_solid", springs.of_spring(springs.spring_solid), 0.0001),
    Screened("spring_coil_gap", springs.of_spring(springs.spring_coil_gap), 0.0001),
    Screened("spring_solid_stress", springs.of_spring(springs.spring_solid_stress), 0.0001),
    Screened("spring_buckling", springs.of_spring(springs.spring_buckling), 0.0001),
    Screened("spring_rate", springs.of_spring(springs.spring_rate), 0.0001),
    Screened("spring_relaxation", springs.of_spring(springs.spring_relaxation), 0.0001),
    Screened("spring_surge", springs.of_spring(springs.spring_surge), 0.0001),
    Screened("gas_pressure", springs.of_gas(springs.gas_pressure, "pressure_limit"), 0.0001),
    Screened("gas_stroke", springs.of_gas(lambda designs, _: designs.highest, "stroke"), 0.0001),
    Screened("gas_speed", springs.of_gas(springs.gas_speed, "speed_limit"), 0.002),
    Screened("gas_temperature", springs.gas_temperature, 0.0),
    Screened("torsion_stress", springs.of_torsion(lambda _, most: most, torsion_strength), 0.0001),
    Screened(
        "torsion_fatigue",
        springs.of_torsion(lambda least, most: most - least, lambda torsion: torsion.stress_range),
        0.0001,
    ),
)
_PLACES = {declared.id: place for place, declared in enumerate(CHECKS)}
SCREENED = tuple(sorted(_SCREENED, key=lambda each: _PLACES[each.check]))
"""Checks that screening judges, in the order of the calculation."""
