"""Loads on cam, follower and guides over one turn, before the contact is solved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError
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
    friction included, up to the relative friction_residual; bounds computes the loads at the bounds
    of the friction. The speed of the driven cam varies with the crank if the machine has a
    crankshaft; the loads are those of the constant mean speed. torque_before and torque_after are
    crank torques without and with the cam less their means, N m; None without an engine.
    """

    machine: Machine
    theta: Array
    loads: Loads
    bounds: Callable[[], FrictionBounds]
    guides: GuideReactions
    friction_residual: Array
    driven: DrivenCam
    torque_before: Array | None
    torque_after: Array | None

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, friction_residual=self.friction_residual)
        if self.torque_before is not None and self.torque_after is not None:
            freeze(self, torque_before=self.torque_before, torque_after=self.torque_after)

    @cached_property
    def friction(self) -> FrictionBounds:
        """Loads at the bounds of the friction, solved when they are first read.

        Raises
        ------
        ContactError
            If the guides cannot be solved there.
        """
        return self.bounds()


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
    guided = _guided([(each, each.machine.system) for each in inputs], theta, knots)
    bounds = _Bounds(inputs, theta, knots)
    engine = {id(torque): torque for _, _, torque in inputs if torque is not None}
    before = {
        key: torque.without_mean().resampled(positions).total for key, torque in engine.items()
    }
    return tuple(
        _turn(
            each,
            theta,
            guided[_key(each, each.machine.system)],
            bounds,
            before.get(id(each.torque)),
            coarse=coarse,
        )
        for each in inputs
    )


_Rubbed = tuple[TurnInput, FollowerSystem]
_Key = tuple[Stem, GuidePair, int, FollowerSystem, float]


def _key(given: TurnInput, system: FollowerSystem) -> _Key:
    machine = given.machine
    return machine.stem, machine.guides, id(given.contour.pitch), system, machine.cam_speed


def _guided(rubbed: Sequence[_Rubbed], theta: Array, knots: int) -> dict[_Key, Guided]:
    """Loads of followers; those in the same guides are solved at once."""
    wanted: dict[tuple[Stem, GuidePair], dict[_Key, Stroke]] = {}
    for given, system in rubbed:
        machine, pitch = given.machine, given.contour.pitch
        strokes = wanted.setdefault((machine.stem, machine.guides), {})
        strokes[_key(given, system)] = Stroke(pitch, system, machine.cam_speed, theta)
    guided: dict[_Key, Guided] = {}
    for (stem, guides), strokes in wanted.items():
        solved = guided_strokes(tuple(strokes.values()), stem, guides, knots)
        guided |= zip(strokes, solved, strict=True)
    return guided


@dataclass(frozen=True, eq=False)
class _Bounds:
    """Loads of turns at the bounds of their friction, all solved when the first are read."""

    inputs: Sequence[TurnInput]
    theta: Array
    knots: int

    def of(self, given: TurnInput, nominal: Loads) -> FrictionBounds:
        """Bounds of one turn, whose loads at its nominal friction are known."""
        guided = self._together
        if guided is None:  # one of them at least cannot be solved: each on its own
            guided = self._solved([given])

        def loads(system: FollowerSystem) -> Loads:
            known = system == given.machine.system
            return nominal if known else guided[_key(given, system)].loads

        return friction_bounds(loads, given.machine.system, given.machine.friction)

    @cached_property
    def _together(self) -> dict[_Key, Guided] | None:
        try:
            return self._solved(self.inputs)
        except CamError:
            return None

    def _solved(self, inputs: Sequence[TurnInput]) -> dict[_Key, Guided]:
        rubbed = []
        for each in inputs:
            system, friction = each.machine.system, each.machine.friction
            bounds = friction.least, friction.nominal, friction.greatest
            systems = [replace(system, friction_a=a, friction_b=b) for a, b in bounds]
            rubbed += [(each, one) for one in systems if one != system]
        return _guided(rubbed, self.theta, self.knots)


def _turn(
    given: TurnInput,
    theta: Array,
    nominal: Guided,
    bounds: _Bounds,
    before: Array | None,
    *,
    coarse: bool,
) -> Turn:
    """Turn of one load case; `before` (n,), N m, is the torque of the engine less its mean."""
    machine, contour, torque = given
    loads, driving = nominal.loads, None if coarse else torque
    after = None if before is None else before - loads.cam_torque / machine.gear_ratio
    return Turn(
        machine=machine,
        theta=theta,
        loads=loads,
        bounds=lambda: bounds.of(given, loads),
        guides=nominal.reactions,
        friction_residual=nominal.residual,
        driven=driven_cam(machine, driving, contour.pitch, loads.rubbing),
        torque_before=before,
        torque_after=after,
    )
