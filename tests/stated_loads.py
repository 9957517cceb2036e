"""A solution in the load cases of a case file alone, without standstill and over-speed.

For recomputations of one load case by hand; that the other two are judged has tests of its own.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, solved_turns, turns_of
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.torque.torque import Torque


def stated_loads(
    case: Case,
    contour: Contour,
    positions: int,
    *,
    tier: Tier = Tier.PREVIEW,
    torques: Mapping[str, Torque] = MappingProxyType({}),
    coarse: bool = False,
) -> Solution:
    """Solution of a cam in the load cases that its case states; no engine torque by default."""
    states = machines(case, torques)[: len(case.load_cases)]
    turns = turns_of(states, contour, positions, coarse=coarse)
    return solved_turns(case, contour, turns, tier, coarse=coarse)


def pivot_reaction(loads: Loads) -> Array:
    """Force of the pivot on the arm (2, n), N, along the line from cam axis to pivot and across it.

    Across is clockwise, as in `Loads.on_shaft`.
    """
    along, across = loads.pivot_load
    cos, sin = np.cos(loads.travel), np.sin(loads.travel)
    return -np.stack([along * cos + across * sin, across * cos - along * sin])
