"""Checks that screening judges, with demand and limit of many designs at once.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from camwright.pipeline.case.limits import CONTACT_SAFETY, SHAKEDOWN_SAFETY
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.screening import screened_contact as contact
from camwright.pipeline.screening import screened_loads as loads
from camwright.pipeline.screening import screened_shape as shape
from camwright.pipeline.screening.design_arrays import Screened
from camwright.pipeline.screening.design_lengths import has_many_shapes

_SCREENED: tuple[Screened, ...] = (
    *(
        shape.by_measure(each)
        for each in CHECKS
        if each.measured is not None and each.measured.deviation is not None
    ),
    Screened("torque_reduction", loads.torque_reduction, 0.001),
    Screened(
        "contact_pressure",
        contact.contact("contact_pressure", CONTACT_SAFETY),
        0.001,
        is_bound=contact.crown_is_bound,
    ),
    # The friction of the guides, which holds a tilt, is interpolated.
    Screened(
        "edge_pressure",
        contact.contact("contact_pressure", CONTACT_SAFETY, contact.signed_pressure),
        0.01,
        is_bound=has_many_shapes,
    ),
    Screened(
        "shakedown",
        contact.contact("shakedown", SHAKEDOWN_SAFETY),
        0.001,
        is_bound=contact.crown_is_bound,
    ),
    Screened("roller_static", contact.roller_static, 0.005),
    Screened("roller_load_share", contact.roller_load_share, 0.005),
    Screened("roller_radial", contact.roller_radial, 0.005),
    Screened("roller_static_radial", contact.roller_static_radial, 0.005),
    Screened("roller_speed", contact.roller_speed, 0.0002),
    Screened("roller_life", contact.roller_life, 0.03),
    Screened("face_width", contact.face_width, 0.001),
    Screened("face_pv", contact.face_pv, 0.001),
)
_PLACES = {declared.id: place for place, declared in enumerate(CHECKS)}
SCREENED = tuple(sorted(_SCREENED, key=lambda each: _PLACES[each.check]))
"""Checks that screening judges, in the order of the calculation."""
