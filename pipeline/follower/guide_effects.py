"""Why guides of finite length answer otherwise than point supports: their length, their play."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.tables import Column
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    Loads,
    Push,
    Rubbing,
    follower_loads,
)
from camwright.pipeline.follower.guide_reactions import GuidePair, GuideReactions, guide_reactions
from camwright.pipeline.follower.stem_beam import Stem


@dataclass(frozen=True, eq=False)
class Share:
    """A quantity on point supports, what length alone adds to it, and what play adds to that.

    The three sum to the quantity with the guides as they are; arrays (n,).
    """

    points: Array
    by_length: Array
    by_clearance: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @classmethod
    def between(cls, points: Array, tight: Array, full: Array) -> Share:
        """From the quantity on points, with length and no play, with length and play."""
        return cls(points, tight - points, full - tight)


@dataclass(frozen=True, eq=False)
class GuideShares:
    """Reaction of guide A under the side force of the turn (N), and the contact force (N).

    Of guide B length and play change as much: the difference of the two is the side force.
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
    """The same turn with guides of no play, and on point supports.

    Without play the guides answer in proportion to the load, so that one solution gives the
    rubbing load per lean of the push, and with it the contact force, at once.

    Parameters
    ----------
    cam_speed : float   rad/s, of the turn
    loads, reactions    of the turn with the guides as they are, see `guided_loads`
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
    leaning = loads.axial_force * Push.of(pitch, points, loads.theta).lean
    loaded = leaning > 0.0
    rubbing = Rubbing(
        loads.theta,
        np.divide(tight.rubbing_load_a, leaning, out=on_points.rubbing_a.copy(), where=loaded),
        np.divide(tight.rubbing_load_b, leaning, out=on_points.rubbing_b.copy(), where=loaded),
    )
    on_tight = follower_loads(pitch, replace(points, rubbing=rubbing), cam_speed, loads.theta)
    return GuideShares(
        Share.between(reactions.statics_a, tight.reaction_a, reactions.reaction_a),
        Share.between(on_points.normal_force, on_tight.normal_force, loads.normal_force),
    )
