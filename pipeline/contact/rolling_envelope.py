"""What the material under the contour goes through as the load rolls over it, once a turn.

A material point meets one pass a turn. The half-width is a thousandth of the contour, so load
and curvature stand still during a pass: the pass is that of steady rolling, known once for all
depths in units of peak pressure and half-width, and scaled at every place of the contour. The
load is thereby swept without gaps, however few positions the contact was solved at.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures as stress

_DEPTH_MAX = 3.0
_DEPTHS = 61
_BALL_STEPS = 2000
_BLOCK = 120
STATIONS = 1440
"""Places along the contour at which the map is drawn; 0.25 deg apart."""


@dataclass(frozen=True)
class FatigueLimits:
    """Fully reversed limits of the material, Pa: in torsion t, in bending f."""

    torsion: float
    bending: float

    def __post_init__(self) -> None:
        if not 0 < self.torsion < np.inf:
            raise InputError("fatigue.torsion", self.torsion, "> 0 Pa")
        if not self.torsion * np.sqrt(3) / 2 < self.bending < 2 * self.torsion:
            raise InputError(
                "fatigue.bending", self.bending, "above 0.87 and below 2 times the torsion limit"
            )

    @property
    def crossland(self) -> float:
        """Weight of the greatest hydrostatic stress beside the root of J2's amplitude."""
        return float(max(3 * self.torsion / self.bending - np.sqrt(3), 0.0))

    @property
    def dang_van(self) -> float:
        """Weight of the hydrostatic stress beside the shear amplitude."""
        return 3 * (self.torsion / self.bending - 0.5)


@dataclass(frozen=True, eq=False)
class RollingPass:
    """One pass of steady rolling, arrays (k,) over the depths, in peak pressures.

    depth in half-widths; von_mises and tau_max the greatest of the pass; shear_range of the
    shear along the surface; shear_amplitude the radius of the smallest ball around the path of
    the deviator, in the norm of root J2; hydrostatic_max; shear (k, q) and hydrostatic (k, q)
    through the pass, shear the greatest on any plane, counted from the middle of the ball.
    """

    depth: Array
    von_mises: Array
    tau_max: Array
    shear_range: Array
    shear_amplitude: Array
    hydrostatic_max: Array
    shear: Array
    hydrostatic: Array
    stress: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    def crossland(self, limits: FatigueLimits) -> Array:
        """Root of J2's amplitude plus weighted greatest hydrostatic stress (k,)."""
        return self.shear_amplitude + limits.crossland * self.hydrostatic_max

    def dang_van(self, limits: FatigueLimits) -> Array:
        """Shear plus weighted hydrostatic stress, the greatest of the pass (k,).

        Compression gets no credit: below a contact it would make the criterion unsafe.

        References
        ----------
        Dang Van (1993); the cap: Desimone, Bernasconi, Beretta, Wear 260 (2006) 567.
        """
        tension = np.maximum(self.hydrostatic, 0.0)
        return np.asarray((self.shear + limits.dang_van * tension).max(axis=1))


@lru_cache(maxsize=8)
def rolling_pass(poisson: float, friction: float = 0.0) -> RollingPass:
    """The pass of a Hertz pressure with `friction` times it along the surface.

    References
    ----------
    Johnson, Contact Mechanics (1985), secs. 4.2 and 9.2, for the stresses; Dang Van,
    Griveau, Message (1989) for the smallest ball.
    """
    depth = np.linspace(0.0, _DEPTH_MAX, _DEPTHS)
    near = np.linspace(-2.0, 2.0, 321)
    far = np.geomspace(2.0, 200.0, 60)[1:]
    x = np.concatenate([-far[::-1], near, far])
    field = hertz.subsurface_stress(x, depth[:, None], friction)
    xx, zz, xz = field
    yy = poisson * (xx + zz)
    hydrostatic = (xx + yy + zz) / 3
    # Coordinates of the deviator in which root J2 is the distance from the origin.
    path = np.stack([(xx - zz) / 2, xz, np.sqrt(0.75) * (yy - hydrostatic)])
    centre, radius = _smallest_ball(path)
    a, b, c = path - centre[:, :, None]
    in_plane, out = np.hypot(a, b), c / np.sqrt(0.75)
    high = np.maximum(in_plane - out / 2, out)
    low = np.minimum(-in_plane - out / 2, out)
    return RollingPass(
        depth=depth,
        von_mises=stress.von_mises(field, poisson).max(axis=1),
        tau_max=stress.shear_in_plane(field).max(axis=1),
        shear_range=np.ptp(xz, axis=1),
        shear_amplitude=radius,
        hydrostatic_max=np.maximum(hydrostatic.max(axis=1), 0.0),
        shear=(high - low) / 2,
        hydrostatic=hydrostatic,
        stress=field,
    )


def _smallest_ball(path: Array) -> tuple[Array, Array]:
    """Centre (3, k) and radius (k,) of the smallest ball around k paths (3, k, q).

    The centre walks towards the farthest point by ever smaller steps; after n of them the
    radius is within 1/n of the least (Badoiu and Clarkson 2003).
    """
    centre = path.mean(axis=2)
    rows = np.arange(path.shape[1])
    for step in range(1, _BALL_STEPS):
        distance = ((path - centre[:, :, None]) ** 2).sum(axis=0)
        farthest = path[:, rows, distance.argmax(axis=1)]
        centre = centre + (farthest - centre) / (step + 1)
    return centre, np.sqrt(((path - centre[:, :, None]) ** 2).sum(axis=0).max(axis=1))


@dataclass(frozen=True, eq=False)
class Envelope:
    """Greatest stresses of one turn in a band under the contour, Pa, (n, k).

    theta (n,) rad and arc (n,) m place the stations; depth (n, k) m below the surface. crossland
    and dang_van are None without fatigue limits.
    """

    theta: Array
    arc: Array
    depth: Array
    von_mises: Array
    tau_max: Array
    shear_range: Array
    crossland: Array | None = None
    dang_van: Array | None = None

    def __post_init__(self) -> None:
        given = {n: getattr(self, n) for n in self.__dataclass_fields__}
        freeze(self, **{n: values for n, values in given.items() if values is not None})

    @classmethod
    def unknown(cls) -> Envelope:
        """NaN at one station: of a contour that is no body."""
        nan = np.full((1, 1), np.nan)
        return cls(nan[0], nan[0], nan, nan, nan, nan, nan, nan)

    def worst(self, name: str) -> tuple[float, float, float]:
        """Greatest value of a map, Pa, and its place: theta rad, depth m."""
        values = getattr(self, name)
        station, level = np.unravel_index(int(np.argmax(values)), values.shape)
        return (
            float(values[station, level]),
            float(self.theta[station]),
            float(self.depth[station, level]),
        )


def swept(
    pair: ContactPair,
    theta: ArrayLike,
    contact: ContactHistory,
    stations: ArrayLike,
    line_load: ArrayLike,
    *,
    friction: float = 0.0,
    limits: FatigueLimits | None = None,
    body_stress: ArrayLike | None = None,
) -> Envelope:
    """The map of one turn.

    Parameters
    ----------
    pair : ContactPair
    theta : array (m,)              rad, where the contact was solved, growing within one turn
    contact : ContactHistory        there; it gives how far finite elements are from Hertz
    stations : array (n,)           rad, where the map is drawn
    line_load : array (n,)          N/m there
    friction : float                traction over pressure
    limits : FatigueLimits          for Crossland's and Dang Van's values
    body_stress : array (3, m)      Pa, what the real body adds to the half-plane at `theta`

    Raises
    ------
    ContactError
        If the roller does not fit the contour at a station.
    """
    at, load = finite("stations", stations), np.maximum(finite("line_load", line_load), 0.0)
    turn = finite("theta", theta)
    half_width, p0 = hertz.line_contact(load, pair.relative_radius(at), pair.contact_modulus)
    half_width = half_width * _between(at, turn, contact.half_width, contact.half_width_hertz)
    p0 = p0 * _between(at, turn, contact.p0, contact.p0_hertz)
    unit = rolling_pass(pair.cam.poisson, friction)
    extra = np.zeros((3, at.size))
    if body_stress is not None:
        given = np.asarray(body_stress, dtype=float)
        extra = np.stack([np.interp(at, turn, part, period=FULL_TURN) for part in given])
    mises, shear = _with_body(unit, p0, extra, pair.cam.poisson)
    scale = p0[:, None]
    pulled = (1 + pair.cam.poisson) / 3 * (extra[0] + extra[1])
    return Envelope(
        theta=at,
        arc=arc_length(pair, at),
        depth=half_width[:, None] * unit.depth,
        von_mises=mises,
        tau_max=shear,
        shear_range=scale * unit.shear_range,
        crossland=None if limits is None else _crossland(unit, p0, pulled, limits),
        dang_van=None if limits is None else _dang_van(unit, p0, pulled, limits),
    )


def arc_length(pair: ContactPair, theta: Array) -> Array:
    """Length (n,) along the contour from angle 0, m."""
    dense = np.linspace(0, FULL_TURN, 20001)
    speed = np.abs(pair.contour.speed(dense))
    steps = np.diff(dense) * (speed[1:] + speed[:-1]) / 2
    return np.asarray(np.interp(theta, dense, np.concatenate([[0.0], np.cumsum(steps)])))


def _between(at: Array, theta: Array, found: Array, closed_form: Array) -> Array:
    """Finite elements over closed form at `at`; 1 where the contact was open."""
    loaded = closed_form > 0
    ratio = np.where(loaded, found / np.where(loaded, closed_form, 1.0), 1.0)
    return np.interp(at, theta, ratio, period=FULL_TURN)


def _with_body(unit: RollingPass, p0: Array, extra: Array, poisson: float) -> tuple[Array, Array]:
    """Greatest von Mises stress and in-plane shear (n, k) of the pass plus the body's stress."""
    mises, shear = np.empty((2, p0.size, unit.depth.size))
    if not extra.any():
        return p0[:, None] * unit.von_mises, p0[:, None] * unit.tau_max
    close = np.abs(np.arange(unit.stress.shape[2]) - unit.stress.shape[2] // 2) <= 160
    field = unit.stress[:, None, :, close]
    for start in range(0, p0.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        total = p0[part, None, None] * field + extra[:, part, None, None]
        mises[part] = stress.von_mises(total, poisson).max(axis=2)
        shear[part] = stress.shear_in_plane(total).max(axis=2)
    return mises, shear


def _crossland(unit: RollingPass, p0: Array, pulled: Array, limits: FatigueLimits) -> Array:
    """Crossland's value (n, k) with the body's hydrostatic stress `pulled` (n,) added."""
    greatest = p0[:, None] * unit.hydrostatic.max(axis=1) + pulled[:, None]
    return np.asarray(
        p0[:, None] * unit.shear_amplitude + limits.crossland * np.maximum(greatest, 0.0)
    )


def _dang_van(unit: RollingPass, p0: Array, pulled: Array, limits: FatigueLimits) -> Array:
    """Dang Van's value (n, k) likewise; compression gets no credit."""
    if not pulled.any():
        return p0[:, None] * unit.dang_van(limits)
    found = np.empty((p0.size, unit.depth.size))
    for start in range(0, p0.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        scale = p0[part, None, None]
        tension = np.maximum(scale * unit.hydrostatic + pulled[part, None, None], 0.0)
        found[part] = (scale * unit.shear + limits.dang_van * tension).max(axis=2)
    return found


def required_strength(envelope: Envelope, depth: ArrayLike) -> Array:
    """Shear strength (k,), Pa, that all places of the contour ask for at depths (k,) m.

    The greatest in-plane shear of the turn at that depth, over all stations: the least k(z) a
    hardened case must have.
    """
    at = np.asarray(depth, dtype=float)
    needed = np.zeros(at.shape)
    for levels, shear in zip(envelope.depth, envelope.tau_max, strict=True):
        if levels[-1] > 0:
            needed = np.maximum(needed, np.interp(at, levels, shear))
    return needed
