"""Effect of guide length and clearance on reactions and contact force."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.tables import Column
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    Loads,
    Rubbing,
    follower_loads,
)
from camwright.pipeline.follower.guide_reactions import GuidePair, GuideReactions, guide_reactions
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, eq=False)
class Share:
    """Quantity on point supports, with its changes by guide length and by clearance.

    Their sum is the quantity with length and clearance; arrays (n,).
    """

    points: Array
    by_length: Array
    by_clearance: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @classmethod
    def between(cls, points: Array, tight: Array, full: Array) -> Share:
        """From the quantity on point supports, with length alone, and with length and clearance."""
        return cls(points, tight - points, full - tight)


@dataclass(frozen=True, eq=False)
class GuideShares:
    """Effects on the reaction of guide A (N) and on the contact force (N).

    Length and clearance change the reaction of guide B by the same amount: the difference of both
    reactions is the side force.
    """

    reaction_a: Share
    normal_force: Share

    def columns(self) -> dict[Column, Array]:
        """Columns of ``5_cycle.csv``."""
        reaction, force = self.reaction_a, self.normal_force
        return {
            Column(
                "guide_reaction_by_length",
                "N",
                "Change of a guide reaction by the length of the guides",
            ): reaction.by_length,
            Column(
                "guide_reaction_by_clearance",
                "N",
                "Change of a guide reaction by the guide clearance",
            ): reaction.by_clearance,
            Column(
                "normal_force_statics", "N", "Normal force with point supports as guides"
            ): force.points,
            Column(
                "normal_force_by_length", "N", "Change of the normal force by the guide length"
            ): force.by_length,
            Column(
                "normal_force_by_clearance",
                "N",
                "Change of the normal force by the guide clearance",
            ): force.by_clearance,
        }


def guide_shares(
    pitch: FollowerPath,
    system: FollowerSystem,
    stem: Stem,
    guides: GuidePair,
    cam_speed: float,
    loads: Loads,
    reactions: GuideReactions,
) -> GuideShares:
    """Effects of the length and of the clearance of the guides on the bearing loads and the contact
    force of a turn.

    Without clearance the reactions are proportional to the load: one solution gives the rubbing
    load per axial force, and with it the contact force.

    Parameters
    ----------
    pitch : FollowerPath         motion of the follower
    system : FollowerSystem      spring, mass, friction
    stem : Stem                  that bends in the guides
    guides : GuidePair           with clearance
    cam_speed : float            rad/s, of the turn
    loads : Loads                of the turn with length and clearance, see `guided_loads`
    reactions : GuideReactions   under these loads
    """
    pair = replace(guides, a=replace(guides.a, clearance=0.0), b=replace(guides.b, clearance=0.0))
    tight = guide_reactions(
        loads.tangential_force,
        loads.overhang,
        stem,
        pair,
        loads.end_moment,
        knots=reactions.knots_a.size,
    )
    points = replace(system, rubbing=None)
    on_points = follower_loads(pitch, points, cam_speed, loads.theta)
    side_load, loaded = loads.side_load, loads.side_load > 0.0
    rubbing = Rubbing(
        loads.theta,
        np.divide(tight.rubbing_load_a, side_load, out=on_points.rubbing_a.copy(), where=loaded),
        np.divide(tight.rubbing_load_b, side_load, out=on_points.rubbing_b.copy(), where=loaded),
    )
    on_tight = follower_loads(pitch, replace(points, rubbing=rubbing), cam_speed, loads.theta)
    return GuideShares(
        Share.between(reactions.statics_a, tight.reaction_a, reactions.reaction_a),
        Share.between(on_points.normal_force, on_tight.normal_force, loads.normal_force),
    )
