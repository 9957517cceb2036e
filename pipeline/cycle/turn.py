"""Turn: loads on cam, follower and guides over one turn, before the contact."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.errors import CamError
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.crank_speed import DrivenCam, driven_cam
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.friction_coupling import Guided, MovingFollower, guided_strokes
from camwright.pipeline.follower.guide_friction import FrictionBounds, friction_bounds
from camwright.pipeline.follower.guide_reactions import KNOTS, GuidePair, GuideReactions
from camwright.pipeline.follower.stem_beam import Stem

COARSE_KNOTS = 5  # of a guide, for ratios of demands


@dataclass(frozen=True, eq=False, repr=False)
class Turn(Displayed):
    """Loads over one turn of one load case.

    Arrays (n,) at equal cam angles theta, rad. The loads are in equilibrium with the guides,
    friction included, up to the relative friction_residual; bounds computes the loads at the bounds
    of the friction. The speed of the driven cam varies with the crank if the machine has a
    crankshaft; the loads are those of the constant mean speed. torque_before and torque_after are
    crank torques without and with the cam less their means, N m, and throughput the mean torque of
    the machine's power; None without an engine.
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
    throughput: float | None = None

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
    """Machine in a load case with its cam."""

    machine: Machine
    contour: Contour


def turn(machine: Machine, contour: Contour, positions: int, *, coarse: bool = False) -> Turn:
    """Loads and guide reactions of a load case.

    Parameters
    ----------
    positions : int     equal cam angles of the turn
    coarse : bool       coarse guide mesh, constant crank speed
    """
    (one,) = turns([TurnInput(machine, contour)], positions, coarse=coarse)
    return one


def turns(
    inputs: Sequence[TurnInput], positions: int, *, coarse: bool = False, bounds: bool = True
) -> tuple[Turn, ...]:
    """Turns of several load cases; those in the same guides are solved together.

    Parameters
    ----------
    positions : int   equal cam angles of the turn
    coarse : bool     few knots in the guides and a constant cam speed, for ratios of demands
    bounds : bool     solve the bounds of the friction at once, too, not when they are first read
    """
    theta, knots = uniform_turn(positions), COARSE_KNOTS if coarse else KNOTS
    strokes = _Strokes(inputs, theta, knots)
    strokes.solve(
        (each, system)
        for each in inputs
        for system in (
            each.machine.system,
            *(_followers_by_friction(each.machine) if bounds else ()),
        )
    )
    torques = (each.machine.torque for each in inputs)
    engine = {id(torque): torque for torque in torques if torque is not None}
    before = {
        key: torque.without_mean().resampled(positions).total for key, torque in engine.items()
    }
    return tuple(
        _turn(
            each,
            theta,
            strokes,
            before.get(id(each.machine.torque)),
            coarse=coarse,
        )
        for each in inputs
    )


_Key = tuple[Stem, GuidePair, int, FollowerSystem, float]


def _followers_by_friction(machine: Machine) -> tuple[FollowerSystem, ...]:
    """Follower with the least, nominal and greatest friction coefficients of guides A and B, in
    this order.
    """
    friction, system = machine.friction, machine.system
    bounds = friction.least, friction.nominal, friction.greatest
    return tuple(system.with_friction(*each) for each in bounds)


@dataclass(eq=False)
class _Strokes:
    """Followers of the load cases in their guides; those in the same guides are solved at once."""

    inputs: Sequence[TurnInput]
    theta: Array
    knots: int
    _known: dict[_Key, Guided] = field(default_factory=dict)
    _together: bool = True

    def of(self, turn_input: TurnInput, system: FollowerSystem) -> Guided:
        """Follower of a load case moving in its guides with the friction of `system`.

        On the first call the followers of all load cases are solved together, each at the least,
        nominal and greatest friction; where one of them cannot be solved, each load case on its
        own.
        """
        key = _key(turn_input, system)
        if key not in self._known and self._together:
            try:
                self.solve(
                    (each, one)
                    for each in self.inputs
                    for one in _followers_by_friction(each.machine)
                )
            except CamError:  # of one load case at least: each on its own
                self._together = False
        if key not in self._known:
            self.solve((turn_input, one) for one in _followers_by_friction(turn_input.machine))
        return self._known[key]

    def solve(self, wanted: Iterable[tuple[TurnInput, FollowerSystem]]) -> None:
        """Solve those of the wanted followers that are not solved yet, and keep them.

        Raises
        ------
        CamError
            If one of them cannot be solved.
        """
        left: dict[tuple[Stem, GuidePair], dict[_Key, MovingFollower]] = {}
        for turn_input, system in wanted:
            key, machine = _key(turn_input, system), turn_input.machine
            if key not in self._known:
                strokes = left.setdefault((machine.stem, machine.guides), {})
                strokes[key] = MovingFollower(
                    turn_input.contour.pitch, system, machine.cam_speed, self.theta
                )
        for (stem, guides), strokes in left.items():
            solved = guided_strokes(tuple(strokes.values()), stem, guides, self.knots)
            self._known |= zip(strokes, solved, strict=True)


def _key(turn_input: TurnInput, system: FollowerSystem) -> _Key:
    machine = turn_input.machine
    return machine.stem, machine.guides, id(turn_input.contour.pitch), system, machine.cam_speed


def _turn(
    turn_input: TurnInput,
    theta: Array,
    strokes: _Strokes,
    before: Array | None,
    *,
    coarse: bool,
) -> Turn:
    """Loads over the turn of one load case at cam angles (n,), rad; before (n,) : torque of the
    engine less its mean, N m, None without an engine; coarse : with constant cam speed.
    """
    machine, contour = turn_input
    nominal = strokes.of(turn_input, machine.system)
    loads, driving = nominal.loads, replace(machine, torque=None) if coarse else machine
    after = None if before is None else before - loads.cam_torque / machine.gear_ratio
    return Turn(
        machine=machine,
        theta=theta,
        loads=loads,
        bounds=lambda: friction_bounds(
            lambda system: strokes.of(turn_input, system).loads, machine.system, machine.friction
        ),
        guides=nominal.reactions,
        friction_residual=nominal.residual,
        driven=driven_cam(driving, contour.pitch, loads.rubbing),
        torque_before=before,
        torque_after=after,
        throughput=None if machine.torque is None else machine.torque.throughput,
    )
