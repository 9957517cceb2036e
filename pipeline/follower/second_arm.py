"""Second arm of a rocker as a beam: section at its pivot, moment by the output and its own mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower.arm_beam import ArmSection, SectionLoads
from camwright.pipeline.follower.rocker import Rocker


@dataclass(frozen=True)
class SecondArmBar:
    """Straight bar on the pivot of an arm, which its output bends at the end.

    Parameters
    ----------
    rocker : Rocker           with width, depth and notch factor of its second arm
    arm_length : float        of the arm of the follower, m
    material : Material       of the second arm
    """

    rocker: Rocker
    arm_length: Value
    material: Material

    @property
    def length(self) -> Value:
        """Pivot to the end, m; of a constant ratio that of arms that lie in one line."""
        stated, ratio = self.rocker.length, self.rocker.ratio
        return (ratio or np.nan) * self.arm_length if stated is None else stated

    @property
    def section(self) -> ArmSection:
        """Section where the second arm leaves the hub."""
        rocker = self.rocker
        width, depth, notch = (
            np.nan if each is None else each for each in (rocker.width, rocker.depth, rocker.notch)
        )
        at = 0.5 * (rocker.hub or 0.0)
        return ArmSection("second arm beside the pivot", at, width, depth, notch)

    def loads(self, force: Value, lift: Value, acceleration: Value) -> SectionLoads:
        """Moments and force (...) in its section, in the plane of the cam.

        Of the force on its end along the line of the output, across which the end slides, and of
        the inertia of a uniform bar beyond the section.

        Parameters
        ----------
        force : array (...)          on the output against its lift, N
        lift, acceleration : (...)   of the follower, m, m/s2
        """
        length, at = self.length, self.section.distance
        raised = self.rocker.raised(lift, self.arm_length)
        mass = self.material.density * self.section.width * self.section.depth  # kg/m
        # integral of xi (xi - at) over the bar beyond the section
        swung = length**3 / 3.0 - 0.5 * at * length**2 + at**3 / 6.0
        by_inertia = mass * swung * acceleration / self.arm_length
        bending = force * np.cos(raised) * (length - at) + by_inertia
        none: Array = np.asarray(0.0 * bending)
        return SectionLoads(np.asarray(bending), np.asarray(-force * np.sin(raised)), none, none)
