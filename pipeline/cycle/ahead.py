"""A cycle foreseen by closed forms, with all that a trial's has but the elements of the contact."""

from __future__ import annotations

from dataclasses import replace

from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.contact_pair import closed_form_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle, finished
from camwright.pipeline.cycle.rolling_history import rolling_history
from camwright.pipeline.cycle.turn import Turn


def foreseen_cycle(case: Case, contour: Contour, given: Turn) -> Cycle:
    """The turn with Hertz's contact, the guides, the parts and what rolling does.

    Where an elastic follower leaves the cam, its flights are not followed.
    """
    state, pair = case.at(given.load_case), contact_pair(case, contour)
    speed = given.crank_speed / case.mechanism.gear_ratio
    force = given.loads.normal_force
    contact = closed_form_history(pair, given.theta, force)
    return replace(
        finished(case, contour, given, contact, flights=False),
        rolling=rolling_history(state, pair, None, given.loads, contact, speed),
    )
