"""Rocker of a follower: a second arm that moves a valve or another output, with lash."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Annotated, ClassVar, Literal

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.rocker_lift import RockerArm, RockerLinkage
from camwright.pipeline.base.material import MadeOf
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Mass,
    Part,
    Positive,
    Resolved,
    TableSource,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.camshaft_loads import Notch, Surface

_Raised = Annotated[float, In("deg", at_least=-75, at_most=75)]


@dataclass(frozen=True, kw_only=True)
class Rocker(Part):
    """Second arm on the pivot of the follower's arm, or of a rocker that a stem moves.

    Of a constant ratio, or with the true geometry of its arms, whose ends slide across straight
    lines. The lash is at the output.

    Raises
    ------
    InputError
        If a value is out of its bounds, or neither or both of ratio and length are stated.
    """

    table: ClassVar[str] = "rocker"
    resolved: ClassVar[Mapping[str, Resolved]] = {
        "mass": Resolved(
            "> 0 kg",
            "mass that the output moves, as `output_mass`; `follower.mass` contains it from then"
            " on, by the square of the ratio at zero lift",
            Known("weighed, or drawing", "90 g"),
        ),
        "force": Resolved(
            "N",
            "constant force on the output against its lift, of a rocker of constant `ratio`, as"
            " `output_force`; `follower.external_force` contains it from then on",
            Known("process, or measured", "200 N"),
        ),
    }
    defaults: ClassVar[Mapping[str, str]] = {
        "ratio": "by `length` and `angle`",
        "length": "by `ratio`, constant",
        "input_length": "that of `[follower.arm]`",
        "ramp": "without lash there is none",
        "material": "that of `[follower.arm]`",
        "hub": "none: the second arm is judged at the axis of its pivot",
        "output_mass": "`mass`, else none",
        "output_force": "`force`, else none",
    }

    ratio: Annotated[Positive | None, Known("drawing", 1.5)] = None
    """lift of the output over that of the follower, constant"""
    length: Annotated[Length | None, Known("drawing", "40 mm")] = None
    """length of the second arm from the pivot to its end, in place of `ratio`"""
    angle: Annotated[_Raised, Known("drawing", "-10 deg")] = 0.0
    """angle of the second arm at zero lift from square to the line of the output, positive in its
    outward stroke"""
    input_length: Annotated[Length | None, Known("drawing", "30 mm")] = None
    """length of the arm that a stem moves, with `length`"""
    input_angle: Annotated[_Raised, Known("drawing", "-10 deg")] = 0.0
    """angle of the arm that a stem moves at zero lift, likewise"""
    side: Annotated[Literal["opposite", "same"], Known("drawing", "opposite")] = "opposite"
    """side of the pivot on which the second arm lies, seen from the first"""
    lash: Annotated[
        float, In("mm", at_least=0, at_most=100), Known("setting of the engine", "0.2 mm")
    ] = 0.0
    """clearance at the output, taken up before it moves"""
    lift: Annotated[Literal["follower", "output"], Known("own choice", "output")] = "follower"
    """whose lift `[lift]` states"""
    ramp: Annotated[
        float | None, In("deg", above=0, at_most=180), Known("own choice", "30 deg")
    ] = None
    """cam angle over which the cam takes up the lash, and gives it back, of a stated lift of the
    output"""
    output_mass: Annotated[Mass | None, Known("weighed, or drawing", "90 g")] = None
    """mass of the output that `follower.mass` contains by the square of the ratio at zero lift"""
    output_force: Annotated[
        float | None, In("N", at_least=-1e7, at_most=1e7), Known("process, or measured", "200 N")
    ] = None
    """constant force on the output against its lift that `follower.external_force` contains by the
    constant `ratio`"""
    width: Annotated[Length | None, Known("drawing", "20 mm")] = None
    """width of the second arm along the cam axis"""
    depth: Annotated[Length | None, Known("drawing", "25 mm")] = None
    """depth of the second arm across its length in the plane of the cam"""
    hub: Annotated[Length | None, Known("drawing", "35 mm")] = None
    """outer diameter of the hub around the pivot, where the second arm begins"""
    material: Annotated[MadeOf | None, Known("drawing", "c45")] = None
    surface: Annotated[Surface, Known("drawing")] = "machined"
    """surface finish of the second arm"""
    notch: Annotated[
        Notch | None, Known("Peterson's Stress Concentration Factors: hole or fillet", 2.0)
    ] = None
    """fatigue notch factor of the second arm at its pivot"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a rocker unless it has either a ratio or a length, angles with a ratio, and a lash
        of the output without a ramp.
        """
        super().__post_init__()
        if (self.ratio is None) == (self.length is None):
            value = "missing" if self.ratio is None else f"{self.ratio:g}"
            raise InputError("rocker.ratio", value, "one of ratio and length")
        if self.length is None:
            for name in ("angle", "input_angle"):
                if stated := getattr(self, name):
                    raise InputError(
                        f"rocker.{name}", shown(stated, "deg"), "left out with a constant ratio"
                    )
        if self.lash > 0.0 and self.lift == "output" and self.ramp is None:
            raise InputError("rocker.ramp", "missing", "given with a lash and a lift of the output")
        if self.output_force is not None and self.ratio is None:
            stated = shown(self.output_force, "N")
            raise InputError("rocker.output_force", stated, "left out without a constant ratio")

    def linkage(self, arm_length: float | None) -> RockerLinkage:
        """Linkage of the two arms of the rocker with the lash.

        Parameters
        ----------
        arm_length : float or None   of the arm of the follower, m; None: a stem moves the rocker

        Raises
        ------
        InputError
            If the length of the arm that a stem moves is missing, or stated beside that of an arm.
        """
        if self.ratio is not None and self.input_length is None:
            return RockerLinkage.of_ratio(self.ratio, self.lash)
        if self.length is None or (self.input_length is None) == (arm_length is None):
            value = "missing" if self.input_length is None else shown(self.input_length, "mm")
            limit = "given with rocker.length and a follower on a stem alone"
            raise InputError("rocker.input_length", value, limit)
        first = (
            RockerArm(self.input_length or 0.0, self.input_angle)
            if arm_length is None
            else RockerArm(arm_length)
        )
        return RockerLinkage(first, RockerArm(self.length, self.angle), self.lash)

    @property
    def is_described(self) -> bool:
        """Whether the section of the second arm is stated, by one of its dimensions at least."""
        return self.width is not None or self.depth is not None

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on the drawing of the cam, of the second arm that it moves."""
        if self.length is None:
            arm = f"constant ratio {self.ratio:g}"
        else:
            raised = shown(self.angle, "deg", 4)
            arm = f"second arm {shown(self.length, 'mm')}, at zero lift {raised} from square to the"
            arm += " line of its output"
        side = "beyond the pivot" if self.side == "opposite" else "on the side of the arm"
        lash = f", lash {shown(self.lash, 'mm')}" if self.lash else ""
        return (f"rocker of {arm}, {side}{lash}",)

    def push_on_arm(self, force: Array, lift: Array, arm_length: float | None) -> Array:
        """Force of the output on the rocker (2, ...), N: along the arm from the pivot, and
        outwards.

        The second arm lies in line with the first one, on its side of the pivot.

        Parameters
        ----------
        force : array (...)          on the output against its lift, N
        lift : array (...)           of the follower, m
        arm_length : float or None   of the arm of the follower, m; None: of a stem
        """
        side = -1.0 if self.side == "opposite" else 1.0
        raised = self.raised(lift, arm_length)
        return np.asarray(-side * force * np.stack([np.sin(raised), np.cos(raised)]))

    def raised(self, lift: Value, arm_length: Value | None) -> Value:
        """Angle (...) of the second arm from square to the line of its output, rad; 0 of a constant
        ratio. See `push_on_arm`.
        """
        if self.length is None or arm_length is None:
            return 0.0 * lift
        return self.angle + lift / arm_length

    @property
    def ramp_angle(self) -> float:
        """Cam angle over which the lash is taken up, rad."""
        return pi if self.ramp is None else self.ramp


@dataclass(frozen=True)
class RockerOutput:
    """Mass and constant force that a rocker moves, as forces on the follower and its second arm.

    The output follows its arm without lash. arm_length: of the arm of the follower, m; None: a stem
    moves the rocker.

    References
    ----------
    Kinetic energy m_o v'^2 s'^2/2 of an output v(s) on a lift s; Lagrange's equation.
    """

    rocker: Rocker
    arm_length: float | None

    @cached_property
    def linkage(self) -> RockerLinkage:
        """Arms of the rocker."""
        return self.rocker.linkage(self.arm_length)

    @cached_property
    def ratio(self) -> float:
        """Travel of the output per lift of the follower at zero lift."""
        return float(self.linkage.ratio(0.0))

    @property
    def mass(self) -> float:
        """Mass of the output, kg."""
        return self.rocker.output_mass or 0.0

    @property
    def force(self) -> float:
        """Constant force on the output against its lift, N."""
        return self.rocker.output_force or 0.0

    @property
    def changes(self) -> bool:
        """Whether its mass at the follower changes with the lift."""
        return self.mass > 0.0 and self.rocker.length is not None

    @property
    def reduced_mass(self) -> float:
        """Its share of the mass of the follower, kg."""
        return self.mass * self.ratio**2

    @property
    def reduced_force(self) -> float:
        """Its share of the external force on the follower, N."""
        return self.force * self.ratio

    @property
    def unloaded(self) -> RockerOutput:
        """Without the constant force."""
        return replace(self, rocker=replace(self.rocker, output_force=None))

    def moving_mass(self, lift: Value) -> Value:
        """Mass (...), kg, at the follower beyond that of zero lift, by the square of the ratio."""
        return self.mass * (self.linkage.travel(lift)[1] ** 2 - self.ratio**2)

    def whole_inertia(self, lift: Value, velocity: Value, acceleration: Value) -> Value:
        """Inertia force (...), N, of the output on the follower; m, m/s and m/s2 of it."""
        return self.reduced_mass * acceleration + self.inertia(lift, velocity, acceleration)

    def inertia(self, lift: Value, velocity: Value, acceleration: Value) -> Value:
        """Inertia force (...), N, on the follower beyond that of the mass at zero lift; m, m/s and
        m/s2 of the follower.
        """
        _, ratio, change, _ = self.linkage.travel(lift)
        turned = ratio * change * velocity**2
        return self.mass * ((ratio**2 - self.ratio**2) * acceleration + turned)

    def push(self, lift: Value, velocity: Value, acceleration: Value) -> Value:
        """Force (...), N, of the output on the second arm against its lift, inertia included."""
        _, ratio, change, _ = self.linkage.travel(lift)
        return self.force + self.mass * (ratio * acceleration + change * velocity**2)


UNIFORM = Rocker(ratio=1.0)
"""Rocker of a ratio of one."""
