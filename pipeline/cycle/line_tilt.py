"""Tilt of the line of contact: its parts, what the guides force of it, and its moment."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, Value, freeze
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.follower.follower_tilt import StemTilt, TiltWords


@dataclass(frozen=True, eq=False)
class LineTilt:
    """Parts of the tilt of the contact line, rad, in the plane of its normal and the cam axis.

    shaft (n,): slope of the camshaft at the cam, signed; parallelism: of the axes of cam and
    follower as made; run_out: of the cam on its shaft; roller: of the roller in the clearance of
    its bearing; guides: of the stem in the clearances of its guides, or of an arm in that of its
    pivot; twist: of an arm under a contact beside its middle, or of a stem by a second roller. All
    but that of the shaft have either sign, arrays that broadcast against it. words: of the follower

    A stem aligns itself with the cam within the clearances of its guides, up to their friction, an
    arm up to the couple of its load on the pivot. What cam and follower are out of parallel beyond
    these clearances is forced on the contact.
    """

    shaft: Array
    parallelism: Value
    run_out: Value
    roller: Value
    guides: Value
    twist: Value = 0.0
    words: TiltWords = StemTilt.words

    def __post_init__(self) -> None:
        freeze(self, shaft=self.shaft)

    @property
    def imposed(self) -> Array:
        """Greatest angle (n,) between cam and guides: shaft slope, worst tolerances, twist."""
        return np.asarray(np.abs(self.shaft) + self.parallelism + self.run_out + self.twist)

    @property
    def forced(self) -> Array:
        """Tilt (n,), >= 0, beyond the clearances of the stem in its guides."""
        return np.asarray(np.maximum(self.imposed - self.guides, 0.0))

    @property
    def greatest(self) -> Array:
        """Greatest tilt (n,): all parts, limited by the couple of guide friction."""
        return np.asarray(self.imposed + self.roller + self.guides)

    def parts(self, place: int) -> Iterator[tuple[str, float]]:
        """Name and size, rad, of each part of the tilt at the position of this number."""
        yield "camshaft", abs(float(self.shaft[place]))
        yield "parallelism", float(self.parallelism)
        yield "run-out", float(np.broadcast_to(self.run_out, self.shaft.shape)[place])
        yield self.words.clearance, float(self.guides)
        yield "roller bearing", float(self.roller)
        if np.any(self.twist):
            yield self.words.turned, float(np.broadcast_to(self.twist, self.shaft.shape)[place])

    def sentence(self, place: int) -> str:
        """Tilt and its parts at one angle, in words; round-off is zero."""

        def milli(angle: float) -> str:
            return f"{round(in_unit(angle, 'mrad'), 9):.3g}"

        parts = ", ".join(f"{name} {milli(angle)}" for name, angle in self.parts(place))
        greatest, forced = (milli(float(each[place])) for each in (self.greatest, self.forced))
        return f"tilt of up to {greatest} mrad ({parts}), {forced} mrad of it forced"


def line_tilt(
    shaft: Array,
    *,
    parallelism: Value,
    run_out: Value,
    base_radius: Value,
    clearance: Value,
    bearing_length: Value | None,
    guides: Value,
    twist: Value,
    words: TiltWords,
) -> LineTilt:
    """Tilt of a line of contact from shaft slope and tolerances.

    Parameters
    ----------
    shaft : array (..., n)     slope of the camshaft at the cam, rad
    parallelism : float        of the axes, rad
    run_out : float            axial, of the cam at its base circle, m: full reading
    base_radius : float, array of the base circle of the disc, m
    clearance : float          radial internal clearance of the roller's bearing, m: full play
    bearing_length : float     m; None: a follower without a bearing
    guides : float             tilt of the stem in its guides, or of an arm in its pivot, rad
    twist : float or array     of an arm under a contact beside its middle, or of a stem by a second
                               roller, rad
    words : TiltWords          of the follower
    """
    roller = 0.0 if bearing_length is None else clearance / bearing_length
    run_out = run_out / (2.0 * base_radius)
    return LineTilt(shaft, parallelism, run_out, roller, guides, twist, words)


def rigid_moment(forced: Array, compliance: Value, held: Array, most: Array) -> Array:
    """Greatest moment (...) about the middle of a line of contact that does not yield, N m.

    An upper bound of that of the pressure along the line.

    Parameters
    ----------
    forced : array (...)        see `LineTilt`, rad
    compliance : float, array   of stem and camshaft, rad/(N m)
    held, most : array (...)    couple that friction of the guides holds; force near an end, N m
    """
    return np.asarray(np.minimum(np.maximum(forced / compliance, held), most))


def follower_moment(line: Array, forced: Array, held: Array, aside: Array) -> Array:
    """Greatest moment (...) of the contact about the middle of the follower, N m, >= 0.

    Stem, pin and fork carry it. Within the clearances of the guides the stem turns until their
    friction holds what is left; beyond them the moment about the middle of the line and that of its
    distance from the stem add up.

    Parameters
    ----------
    line : array (...)     moment about the middle of the line of contact, N m
    forced : array (...)   see `LineTilt`, rad
    held : array (...)     greatest couple that friction of the guides holds, N m
    aside : array (...)    force times the distance of the middle of the line from the stem, N m
    """
    moment = line + aside
    return np.asarray(np.where(forced > 0.0, moment, np.minimum(moment, held)))
