"""Tilt of a follower across the plane of the cam: of a stem in its guides, or of an arm."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.arm_beam import ArmBar
from camwright.pipeline.follower.guide_reactions import Guide, GuidePair
from camwright.pipeline.follower.stem_beam import Stem


class TiltingLoads(NamedTuple):
    """Loads against which a follower tilts, arrays (..., n), N.

    force: of the contact; rubbing, friction: normal loads of guides A and B and their greatest
    coefficients; pivot: of the arm on its pivot, 0 without one; spacing: of the guides, m
    """

    force: Array
    rubbing: tuple[Array, Array]
    friction: tuple[Value, Value]
    pivot: Array
    spacing: Value


class TiltWords(NamedTuple):
    """Words of the field for what lets a follower tilt.

    clearance: within which it does; held: what holds its couple; turned: what turns it besides
    """

    clearance: str
    held: str
    turned: str


def couple_of_second(force: Array, beyond: Value) -> Array:
    """Couple (..., n), N m, of the roller that carries about the middle of the first on their pin.

    Parameters
    ----------
    force : array (..., n)            normal force, N
    beyond : float or array (..., n)  distance of that roller from the first, m; 0: none, also of a
                                      force that is not known
    """
    return np.where(beyond == 0.0, 0.0, force * beyond)


class FollowerTilt(Protocol):
    """Tilt of a follower in the plane of the contact normal and the cam axis."""

    words: ClassVar[TiltWords]

    def within(self, spacing: Value) -> Value:
        """Greatest tilt within the clearances (...), rad, at a spacing of the guides, m."""
        ...

    def compliance(self, overhang: Value, spacing: Value) -> Value:
        """Slope under the moment of the contact (...), rad/(N m).

        Parameters
        ----------
        overhang, spacing : float or array   of the stem at maximum lift, and of the guides, m
        """
        ...

    def held(self, loads: TiltingLoads) -> Array:
        """Greatest couple (...), N m, about the middle of the follower without a tilt."""
        ...

    def turned(self, loads: TiltingLoads, offset: Value) -> Array:
        """Tilt (...), rad, by the contact force at an offset from the follower's middle, m."""
        ...

    def on_pin(self, slope: Value) -> FollowerTilt:
        """The same with a slope of the pin of a pivot in its bush per couple, rad/(N m)."""
        ...


@dataclass(frozen=True)
class StemTilt:
    """Stem that aligns itself in the clearances of its guides, up to their friction."""

    words: ClassVar = TiltWords(
        "guide clearance", "friction in the guides", "couple of the deeper roller"
    )

    stem: Stem
    guides: GuidePair

    def within(self, spacing: Value) -> Value:
        """See `FollowerTilt`."""
        return self.guides.tilt_at(spacing)

    def compliance(self, overhang: Value, spacing: Value) -> Value:
        """See `FollowerTilt`."""
        return self.guides.tilt_compliance(self.stem, overhang, spacing)

    def held(self, loads: TiltingLoads) -> Array:
        """Couple of the friction of both guides; see `FollowerTilt`."""
        pairs = zip(loads.friction, loads.rubbing, strict=True)
        on_a, on_b = (friction * load for friction, load in pairs)
        return np.asarray(np.minimum(on_a, on_b) * loads.spacing)

    def turned(self, loads: TiltingLoads, offset: Value) -> Array:  # noqa: ARG002
        """Zero: it turns back within the clearances; see `FollowerTilt`."""
        return np.zeros(loads.force.shape)

    def on_pin(self, slope: Value) -> StemTilt:  # noqa: ARG002
        """Unchanged: it has no pivot."""
        return self


@dataclass(frozen=True)
class ArmTilt:
    """Arm that its twist and the clearance of the bush in its pivot let tilt.

    Its pivot stays flat on the pin up to the couple of its load at the end of the bush. A pivot
    without a bush neither yields nor has clearance, an arm without a stated section does not twist.

    Parameters
    ----------
    twist : float    slope of its end per couple there, rad/(N m)
    offset : float   of its middle from that of the roller, m
    bush : Guide     of its pivot; None: of needles, or not described
    pin : float      slope of the pin in its bush per couple, rad/(N m); None: on its foundation
    """

    words: ClassVar = TiltWords("pivot clearance", "the load on the pivot", "twist of the arm")

    twist: Value
    offset: Value
    bush: Guide | None
    pin: Value | None = None

    def within(self, spacing: Value) -> Value:
        """Clearance over the length of the bush; see `FollowerTilt`."""
        play = 0.0 if self.bush is None else self.bush.clearance / self.bush.length
        return play + 0.0 * spacing

    @property
    def slope(self) -> Value:
        """Twist of the arm and of the pin on its bush per couple, rad/(N m)."""
        if self.bush is None:
            return self.twist
        if self.pin is not None:
            return self.twist + self.pin
        return self.twist + 12.0 / (self.bush.foundation_modulus * self.bush.length**3)

    def compliance(self, overhang: Value, spacing: Value) -> Value:
        """See `FollowerTilt`."""
        return self.slope + 0.0 * (overhang + spacing)

    def held(self, loads: TiltingLoads) -> Array:
        """Load of the pivot at the end of the bush, and the force in the arm's own middle.

        See `FollowerTilt`.
        """
        length = 0.0 if self.bush is None else self.bush.length
        return np.asarray(0.5 * length * loads.pivot + self.offset * np.maximum(loads.force, 0.0))

    def turned(self, loads: TiltingLoads, offset: Value) -> Array:
        """Elastic part alone: the clearance is in `within`; see `FollowerTilt`."""
        return np.asarray(self.slope * np.maximum(loads.force, 0.0) * (offset + self.offset))

    def on_pin(self, slope: Value) -> ArmTilt:
        """See `FollowerTilt`."""
        return replace(self, pin=slope)


def arm_tilt(arm: FollowerArm, bar: ArmBar | None, bush: Guide | None) -> ArmTilt | None:
    """Tilt of an arm as a beam, None where its section is not stated, in the bush of its pivot,
    None of another one; None where neither is described.
    """
    if bar is None and bush is None:
        return None
    return ArmTilt(0.0 if bar is None else bar.couple_compliance, arm.plane_offset, bush)
