"""Loads on cam, follower and guides over one turn, before the contact is solved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.crank_speed import DrivenCam, driven_cam
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.friction_coupling import Guided, Stroke, guided_strokes
from camwright.pipeline.follower.guide_friction import FrictionBounds, friction_bounds
from camwright.pipeline.follower.guide_reactions import KNOTS, GuidePair, GuideReactions
from camwright.pipeline.follower.stem_beam import Stem
from camwright.pipeline.torque.torque import Torque

COARSE_KNOTS = 5  # of a guide, for ratios of demands


@dataclass(frozen=True, eq=False)
class Turn:
    """Loads over one turn of one load case.

    Arrays (n,) at equal cam angles theta, rad. The loads are in equilibrium with the guides,
    friction included, up to the relative friction_residual; friction holds the loads at the bounds
    of the friction. The speed of the driven cam varies with the crank if the machine has a
    crankshaft; the loads are those of the constant mean speed. torque_before and torque_after are
    crank torques without and with the cam less their means, N m; None without an engine.
    """

    machine: Machine
    theta: Array
    loads: Loads
    friction: FrictionBounds
    guides: GuideReactions
    friction_residual: Array
    driven: DrivenCam
    torque_before: Array | None
    torque_after: Array | None

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, friction_residual=self.friction_residual)
        if self.torque_before is not None and self.torque_after is not None:
            freeze(self, torque_before=self.torque_before, torque_after=self.torque_after)


class TurnInput(NamedTuple):
    """Machine in a load case, its cam, and the torque of its engine; None without one."""

    machine: Machine
    contour: Contour
    torque: Torque | None


def turn(
    machine: Machine,
    contour: Contour,
    torque: Torque | None,
    positions: int,
    *,
    coarse: bool = False,
) -> Turn:
    """Loads and guide reactions of a load case.

    Parameters
    ----------
    torque : Torque     of the engine; None without one
    positions : int     equal cam angles of the turn
    coarse : bool       coarse guide mesh, constant crank speed
    """
    (one,) = turns([TurnInput(machine, contour, torque)], positions, coarse=coarse)
    return one


def turns(inputs: Sequence[TurnInput], positions: int, *, coarse: bool = False) -> tuple[Turn, ...]:
    """As `turn` of each load case; those in the same guides are solved at once."""
    theta, knots = uniform_turn(positions), COARSE_KNOTS if coarse else KNOTS
    wanted: dict[tuple[Stem, GuidePair], dict[_Key, Stroke]] = {}
    for machine, contour, _ in inputs:
        strokes = wanted.setdefault((machine.stem, machine.guides), {})
        for system in _rubbed(machine):
            key = id(contour.pitch), system, machine.cam_speed
            strokes[key] = Stroke(contour.pitch, system, machine.cam_speed, theta)
    guided: dict[tuple[Stem, GuidePair], dict[_Key, Guided]] = {}
    for (stem, guides), strokes in wanted.items():
        solved = guided_strokes(tuple(strokes.values()), stem, guides, knots)
        guided[stem, guides] = dict(zip(strokes, solved, strict=True))
    engine = {id(torque): torque for _, _, torque in inputs if torque is not None}
    before = {
        key: torque.without_mean().resampled(positions).total for key, torque in engine.items()
    }
    return tuple(
        _turn(
            each,
            theta,
            guided[each.machine.stem, each.machine.guides],
            before.get(id(each.torque)),
            coarse=coarse,
        )
        for each in inputs
    )


_Key = tuple[int, FollowerSystem, float]


def _rubbed(machine: Machine) -> tuple[FollowerSystem, ...]:
    """Follower with the friction of the load case, and at the bounds of the friction."""
    friction, system = machine.friction, machine.system
    bounds = friction.least, friction.nominal, friction.greatest
    return system, *(replace(system, friction_a=a, friction_b=b) for a, b in bounds)


def _turn(
    given: TurnInput,
    theta: Array,
    guided: Mapping[_Key, Guided],
    before: Array | None,
    *,
    coarse: bool,
) -> Turn:
    """Turn of one load case; `before` (n,), N m, is the torque of the engine less its mean."""
    machine, contour, torque = given
    pitch = contour.pitch

    def solved(system: FollowerSystem) -> Guided:
        return guided[id(pitch), system, machine.cam_speed]

    nominal = solved(machine.system)
    loads, driving = nominal.loads, None if coarse else torque
    after = None if before is None else before - loads.cam_torque / machine.gear_ratio
    return Turn(
        machine=machine,
        theta=theta,
        loads=loads,
        friction=friction_bounds(
            lambda system: solved(system).loads, machine.system, machine.friction
        ),
        guides=nominal.reactions,
        friction_residual=nominal.residual,
        driven=driven_cam(machine, driving, pitch, loads.rubbing),
        torque_before=before,
        torque_after=after,
    )
