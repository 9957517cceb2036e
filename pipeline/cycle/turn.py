"""TODO."""

from __future__ import annotations

from dataclasses import dataclass

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.cycle.crank_speed import cam_speed
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.follower.guide_reactions import KNOTS, GuidePair, GuideReactions
from camwright.pipeline.follower.stem_beam import Stem

_FEW_KNOTS = 5  # of a guide, for a look ahead


# A load case at rest is a turn so slow (rad/s) that inertia, film and heat are as good as none.
CREEP = 1e-3


@dataclass(frozen=True, eq=False)
class Turn:
    """What acts on the cam over one turn of one load case, before the contact is solved.

    Arrays (n,) at the cam angles theta (rad). The loads are in balance with the guides, friction
    included, but for friction_residual, relative. cam_speed, rad/s, is that of a crank that the
    engine and the cam drive, where the case tells its inertia, else constant; the loads are those
    of the constant one. torque_before and residual_torque are crank
    torques (N m) without and with the cam, their means taken off; None without an engine.
    """

    load_case: str
    crank_speed: float
    theta: Array
    loads: Loads
    guides: GuideReactions
    friction_residual: Array
    cam_speed: Array
    torque_before: Array | None
    residual_torque: Array | None

    def __post_init__(self) -> None:
        names = ("theta", "friction_residual", "cam_speed")
        freeze(self, **{name: getattr(self, name) for name in names})
        if self.torque_before is not None and self.residual_torque is not None:
            freeze(self, torque_before=self.torque_before, residual_torque=self.residual_torque)


def turn(
    case: Case,
    contour: Contour,
    torque: Torque | None,
    load_case: str,
    positions: int,
    ahead: bool = False,
) -> Turn:
    """Loads and guide reactions of one load case at `positions` equally spaced cam angles.

    A look ahead takes few knots in the guides and a constant speed.
    """
    theta = uniform_turn(positions)
    ratio = case.mechanism.gear_ratio
    given = next(state.speed for state in case.load_cases if state.name == load_case)
    speed, state = max(given, CREEP), case.at(load_case)
    stem, guides = Stem.from_case(state), GuidePair.from_case(state)
    system = FollowerSystem.from_case(state)
    knots = _FEW_KNOTS if ahead else KNOTS
    found = guided_loads(contour.pitch, system, stem, guides, speed / ratio, theta, knots)
    loads, driven = found.loads, None if ahead else torque
    before = None if torque is None else torque.without_mean().resampled(positions).total
    return Turn(
        load_case=load_case,
        crank_speed=speed,
        theta=theta,
        loads=loads,
        guides=found.reactions,
        friction_residual=found.residual,
        cam_speed=cam_speed(state, driven, speed, contour.pitch, loads.rubbing),
        torque_before=before,
        residual_torque=None if before is None else before - loads.cam_torque / ratio,
    )
