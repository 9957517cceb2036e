"""Loads on cam, follower and guides over one turn, before the contact is solved."""

from __future__ import annotations

from dataclasses import dataclass

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.contour import Contour
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.crank_speed import driven_cam_speed
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.follower.guide_reactions import KNOTS, GuideReactions

COARSE_KNOTS = 5  # of a guide, for ratios of demands


@dataclass(frozen=True, eq=False)
class Turn:
    """Loads over one turn of one load case.

    Arrays (n,) at equal cam angles theta, rad. The loads are in equilibrium with the guides,
    friction included, up to the relative friction_residual. cam_speed, rad/s, varies with the
    crank if the machine has a crankshaft; the loads are those of the constant mean speed.
    torque_before and torque_after are crank torques without and with the cam less their means,
    N m; None without an engine.
    """

    machine: Machine
    theta: Array
    loads: Loads
    guides: GuideReactions
    friction_residual: Array
    cam_speed: Array
    torque_before: Array | None
    torque_after: Array | None

    def __post_init__(self) -> None:
        freeze(
            self,
            theta=self.theta,
            friction_residual=self.friction_residual,
            cam_speed=self.cam_speed,
        )
        if self.torque_before is not None and self.torque_after is not None:
            freeze(self, torque_before=self.torque_before, torque_after=self.torque_after)


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
    theta, pitch = uniform_turn(positions), contour.pitch
    guided = guided_loads(
        pitch,
        machine.system,
        machine.stem,
        machine.guides,
        machine.cam_speed,
        theta,
        COARSE_KNOTS if coarse else KNOTS,
    )
    loads, driving = guided.loads, None if coarse else torque
    before = None if torque is None else torque.without_mean().resampled(positions).total
    after = None if before is None else before - loads.cam_torque / machine.gear_ratio
    return Turn(
        machine=machine,
        theta=theta,
        loads=loads,
        guides=guided.reactions,
        friction_residual=guided.residual,
        cam_speed=driven_cam_speed(machine, driving, pitch, loads.rubbing),
        torque_before=before,
        torque_after=after,
    )
