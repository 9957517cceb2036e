"""Subsurface stress history along the contour under the contacts of one turn.

A material point has one load pass per turn. The half-width is a thousandth of the contour, so
that load and curvature are constant during a pass: steady rolling, solved once for all depths in
units of peak pressure and half-width, and scaled at every station of the contour. The stations
are independent of the positions at which the contact was solved.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, readonly, sealed
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures as stress

_DEPTH_MAX = 3.0
_DEPTHS = 61
_SPHERE_STEPS = 2000
_SHARE_MAX = 1.17  # shear in a conforming contact over half-planes, at 15 deg: beyond, not known
STATIONS = 1440
"""Stations of the map along the contour, 0.25 deg apart."""


@dataclass(frozen=True)
class FatigueLimits:
    """Fully reversed fatigue limits of a material in torsion and bending, Pa."""

    torsion: float
    bending: float

    def __post_init__(self) -> None:
        """Refuse a torsion limit that is not positive, and a bending limit outside sqrt(3)/2 to 2
        of it.
        """
        if not 0 < self.torsion < np.inf:
            raise InputError("fatigue.torsion", self.torsion, "> 0 Pa")
        if not self.torsion * np.sqrt(3) / 2 < self.bending < 2 * self.torsion:
            raise InputError(
                "fatigue.bending", self.bending, "> 0.87 and < 2 times the torsion limit"
            )

    @property
    def crossland(self) -> float:
        """Weight of the maximum hydrostatic stress in Crossland's criterion, 3 t/f - sqrt 3."""
        return float(max(3 * self.torsion / self.bending - np.sqrt(3), 0.0))

    @property
    def dang_van(self) -> float:
        """Weight of the hydrostatic stress in Dang Van's criterion, 3 (t/f - 1/2)."""
        return 3 * (self.torsion / self.bending - 0.5)


@dataclass(frozen=True, eq=False)
class RollingPass:
    """Stress maxima of one pass of steady rolling, (k,) over the depths, over peak pressure.

    depth in half-widths; von_mises and tau_max, maxima of the pass; shear_range of the shear along
    the surface; shear_amplitude, radius of the smallest sphere around the path of the deviator in
    the norm of root J2; hydrostatic_max; through the pass shear (k, q), the maximum on any plane
    from the centre of the sphere, hydrostatic (k, q) and stress xx, zz, xz (3, k, q).
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

    @cached_property
    def hydrostatic_greatest(self) -> Array:
        """Greatest hydrostatic stress (k,) through the pass, of either sign."""
        return readonly(self.hydrostatic.max(axis=1))

    def shear_pulled(self, weight: float) -> Array:
        """Greatest shear plus weighted hydrostatic stress (k,), compression included."""
        return _shear_pulled(self, weight)

    def crossland(self, limits: FatigueLimits) -> Array:
        """Crossland stress (k,): amplitude of root J2 plus weighted maximum hydrostatic stress."""
        return self.shear_amplitude + limits.crossland * self.hydrostatic_max

    def dang_van(self, limits: FatigueLimits) -> Array:
        """Dang Van stress (k,): maximum of shear plus weighted hydrostatic stress over the pass.

        Compression counts as zero: below a contact the criterion would otherwise be unsafe.

        References
        ----------
        Dang Van (1993); the cap: Desimone, Bernasconi, Beretta, Wear 260 (2006) 567.
        """
        tension = np.maximum(self.hydrostatic, 0.0)
        return np.asarray((self.shear + limits.dang_van * tension).max(axis=1))


@lru_cache(maxsize=16)
def _shear_pulled(unit: RollingPass, weight: float) -> Array:
    return readonly((unit.shear + weight * unit.hydrostatic).max(axis=1))


@lru_cache(maxsize=8)
def rolling_pass(poisson: float, friction: float = 0.0) -> RollingPass:
    """Pass of a Hertz pressure with traction `friction` times pressure; cached on disk.

    References
    ----------
    Johnson, Contact Mechanics (1985), secs. 4.2 and 9.2, for the stresses; Dang Van,
    Griveau, Message (1989) for the smallest sphere.
    """
    inputs = float(poisson), float(friction)
    modules = sys.modules[__name__], hertz, stress
    return RollingPass(**disk_cache.kept("pass", inputs, lambda: _pass(*inputs), modules))


def _pass(poisson: float, friction: float) -> dict[str, Array]:
    """Fields of `RollingPass` by name, of a Hertz pressure with a sliding traction `friction` times
    the pressure, on a body of Poisson's ratio `poisson`.
    """
    depth = np.linspace(0.0, _DEPTH_MAX, _DEPTHS)
    near = np.linspace(-2.0, 2.0, 321)
    far = np.geomspace(2.0, 200.0, 60)[1:]
    x = np.concatenate([-far[::-1], near, far])
    field = hertz.subsurface_stress(x, depth[:, None], friction)
    xx, zz, xz = field
    yy = poisson * (xx + zz)
    hydrostatic = (xx + yy + zz) / 3
    # Deviator coordinates with root J2 as the distance from the origin.
    path = np.stack([(xx - zz) / 2, xz, np.sqrt(0.75) * (yy - hydrostatic)])
    centre, radius = smallest_sphere(path)
    a, b, c = path - centre[:, :, None]
    in_plane, out = np.hypot(a, b), c / np.sqrt(0.75)
    high = np.maximum(in_plane - out / 2, out)
    low = np.minimum(-in_plane - out / 2, out)
    return {
        "depth": depth,
        "von_mises": stress.von_mises(field, poisson).max(axis=1),
        "tau_max": stress.shear_in_plane(field).max(axis=1),
        "shear_range": np.ptp(xz, axis=1),
        "shear_amplitude": radius,
        "hydrostatic_max": np.maximum(hydrostatic.max(axis=1), 0.0),
        "shear": (high - low) / 2,
        "hydrostatic": hydrostatic,
        "stress": field,
    }


def smallest_sphere(path: Array) -> tuple[Array, Array]:
    """Centre (3, k) and radius (k,) of the smallest enclosing sphere of k paths (3, k, q).

    Steps of decreasing length towards the farthest point; after n steps the radius is within 1/n of
    the minimum (Badoiu and Clarkson 2003).
    """
    centre = path.mean(axis=2)
    rows = np.arange(path.shape[1])
    for step in range(1, _SPHERE_STEPS):
        distance = ((path - centre[:, :, None]) ** 2).sum(axis=0)
        farthest = path[:, rows, distance.argmax(axis=1)]
        centre = centre + (farthest - centre) / (step + 1)
    return centre, np.sqrt(((path - centre[:, :, None]) ** 2).sum(axis=0).max(axis=1))


@dataclass(frozen=True, eq=False)
class Envelope:
    """Maximum stresses of one turn in a layer below the contour, Pa, (n, k).

    Stations at theta (n,) rad and arc length arc (n,) m; depth (n, k) m below the surface.
    crossland, dang_van, and of the former root_j2, its amplitude, and tension, its greatest
    hydrostatic stress from zero, are None without fatigue limits.
    """

    theta: Array
    arc: Array
    depth: Array
    von_mises: Array
    tau_max: Array
    shear_range: Array
    crossland: Array | None = None
    dang_van: Array | None = None
    root_j2: Array | None = None
    tension: Array | None = None

    def __post_init__(self) -> None:
        maps = {n: getattr(self, n) for n in self.__dataclass_fields__}
        freeze(self, **{n: values for n, values in maps.items() if values is not None})

    @classmethod
    def unknown(cls) -> Envelope:
        """NaN at one station: for a contour that does not bound a body."""
        nan = np.full((1, 1), np.nan)
        return cls(nan[0], nan[0], nan, nan, nan, nan, nan, nan)

    def worst(self, name: str) -> tuple[float, float, float]:
        """Maximum of a map, Pa, and its location: theta, rad, and depth, m."""
        values = getattr(self, name)
        station, level = np.unravel_index(first_greatest(values.ravel()), values.shape)
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
    governing: bool = False,
) -> Envelope:
    """Envelope of the subsurface stresses along the contour over one turn.

    Parameters
    ----------
    pair : ContactPair
    theta : array (m,)              cam angles of the contact, rad, increasing within one turn
    contact : ContactHistory        at theta; its ratios of finite elements to Hertz scale the map,
                                    and where it is conforming that of the greatest shear; NaN where
                                    half of a conforming contact is wider than 15 deg
    stations : array (n,)           cam angles of the map, rad
    line_load : array (n,)          at the stations, N/m
    friction : float                traction over pressure
    limits : FatigueLimits          of the criteria of Crossland and Dang Van
    body_stress : array (m,)        stress along the contour that the real body adds, at theta, Pa
    governing : bool                only the stations of `governing_stations`

    Raises
    ------
    ContactError
        If the concave radius at a station is not larger than the roller radius.
    """
    at, load = finite("stations", stations), np.maximum(finite("line_load", line_load), 0.0)
    turn = finite("theta", theta)
    half_width, p0 = hertz.line_contact(load, pair.relative_radius(at), pair.contact_modulus)
    half_width = half_width * _between(at, turn, contact.half_width, contact.half_width_hertz)
    p0 = p0 * _between(at, turn, contact.p0, contact.p0_hertz)
    if pair.wall is not None and contact.conforming.any():
        # The pass is that of half-planes: scaled to the greatest shear in the wall.
        flat = hertz.SHEAR_MAX * contact.p0
        share = _between(at, turn, contact.tau_max, flat)
        p0 = p0 * np.where(share <= _SHARE_MAX, share, np.nan)
    unit = rolling_pass(pair.cam.poisson, friction)
    along = np.zeros(at.size)
    if body_stress is not None:
        along = np.interp(at, turn, np.asarray(body_stress, dtype=float), period=FULL_TURN)
    elif governing:
        kept = governing_stations(p0, half_width)
        at, half_width, p0, along = at[kept], half_width[kept], p0[kept], along[kept]
    mises, shear = _with_body(unit, p0, along, pair.cam.poisson)
    scale = p0[:, None]
    body_hydrostatic = (1 + pair.cam.poisson) / 3 * along
    return Envelope(
        theta=at,
        arc=pair.contour.arc_length(at),
        depth=sealed(half_width[:, None] * unit.depth),
        von_mises=sealed(mises),
        tau_max=sealed(shear),
        shear_range=sealed(scale * unit.shear_range),
        **({} if limits is None else _crossland(unit, p0, body_hydrostatic, limits)),
        dang_van=None if limits is None else _dang_van(unit, p0, body_hydrostatic, limits),
    )


def governing_stations(p0: Array, half_width: Array) -> NDArray[np.intp]:
    """Non-dominated stations in pressure and half-width; all where a value is unknown.

    Without stress of the body every stress of a station grows with its pressure, and lies the
    deeper the wider the contact: the greatest stresses over the turn, and those over a strength
    that does not rise with depth, are at one of these.

    Parameters
    ----------
    p0, half_width : array (n,)   of each station
    """
    if not np.isfinite(p0 + half_width).all():
        return np.arange(p0.size)
    falling = np.lexsort((-half_width, -p0))
    widest = np.maximum.accumulate(half_width[falling])
    wider = np.append(True, widest[1:] > widest[:-1])
    return np.sort(falling[wider])


def _between(at: Array, theta: Array, finite_elements: Array, closed_form: Array) -> Array:
    """Ratio (n,) of finite elements to closed form at cam angles `at` (n,), rad, interpolated
    between those of the contact; 1 where it carries no load.

    Parameters
    ----------
    theta : array (m,)                          cam angles of the contact, rad
    finite_elements, closed_form : array (m,)   one quantity by either method
    """
    if finite_elements is closed_form:
        return np.ones(at.size)
    loaded = closed_form > 0
    ratio = np.where(loaded, finite_elements / np.where(loaded, closed_form, 1.0), 1.0)
    return np.interp(at, theta, ratio, period=FULL_TURN)


def _with_body(unit: RollingPass, p0: Array, along: Array, poisson: float) -> tuple[Array, Array]:
    """Maximum von Mises stress and in-plane shear (n, k), Pa, of a pass under p0 (n,), Pa, with a
    stress of the body added.

    Parameters
    ----------
    unit : RollingPass   stresses under p0 = 1
    along : array (n,)   stress along the surface that the real body adds to the half-plane, Pa
    poisson : float      of the cam
    """
    if not along.any():
        return p0[:, None] * unit.von_mises, p0[:, None] * unit.tau_max
    close = np.abs(np.arange(unit.stress.shape[2]) - unit.stress.shape[2] // 2) <= 160
    field, nu = unit.stress[:, :, close], poisson
    differences = np.array([[1.0, -1.0, 0.0], [1.0 - nu, -nu, 0.0], [-nu, 1.0 - nu, 0.0]])
    sideways = np.diag([0.0, 0.0, 1.0])
    mises = 0.5 * differences.T @ differences + 3.0 * sideways
    shear = 0.25 * np.outer(differences[0], differences[0]) + sideways
    return _greatest_root(mises, p0, field, along), _greatest_root(shear, p0, field, along)


def _greatest_root(form: Array, p0: Array, field: Array, along: Array) -> Array:
    """Greatest root (n, k) over x of a quadratic form of the stress p0 field + along.

    The form over the square of p0 is linear in along over p0, but for a term without x.

    Parameters
    ----------
    form : array (3, 3)      symmetric, of the components xx, yy, xy
    field : array (3, k, x)  of a unit pressure
    along : array (n,)       xx, Pa
    """
    bent = np.tensordot(form, field, axes=1)
    loaded = (p0 > 0) & np.isfinite(along)
    ratio = np.where(loaded, along, 0.0) / np.where(loaded, p0, 1.0)
    varying = greatest_line((field * bent).sum(axis=0), 2.0 * bent[0], ratio)
    squares = p0[:, None] ** 2 * varying + (form[0, 0] * along**2)[:, None]
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def greatest_line(height: Array, slope: Array, at: Array) -> Array:
    """Upper envelope (n, k) of k sets of lines, height + slope x, at abscissae x (n,).

    Walks along the upper envelope of each set, which is convex: at each corner to the line that
    is the first to cross, until no line of any set crosses before the last place.

    Parameters
    ----------
    height, slope : array (k, x)
    at : array (n,)
    """
    rows, last = np.arange(len(height)), at.max()
    line = (height + slope * at.min()).argmax(axis=1)
    greatest = np.full((at.size, rows.size), -np.inf)
    while True:
        level, rise = height[rows, line], slope[rows, line]
        np.maximum(greatest, level + at[:, None] * rise, out=greatest)
        steeper = slope - rise[:, None]
        crossing = np.full(slope.shape, np.inf)
        np.divide(level[:, None] - height, steeper, out=crossing, where=steeper > 0)
        line = crossing.argmin(axis=1)
        ahead = crossing[rows, line] <= last
        if not ahead.any():
            return greatest
        line = np.where(ahead, line, slope.argmax(axis=1))


def _crossland(
    unit: RollingPass, p0: Array, body_hydrostatic: Array, limits: FatigueLimits
) -> dict[str, Array]:
    """Crossland stress and its parts by their names in `Envelope`, (n, k), Pa, with the hydrostatic
    stress of the body added.

    Parameters
    ----------
    unit : RollingPass              k depths
    p0 : array (n,)                 peak pressure, Pa
    body_hydrostatic : array (n,)   Pa
    """
    tension = p0[:, None] * unit.hydrostatic_greatest
    tension += body_hydrostatic[:, None]
    np.maximum(tension, 0.0, out=tension)
    root = p0[:, None] * unit.shear_amplitude
    return {
        "crossland": sealed(limits.crossland * tension + root),
        "root_j2": sealed(root),
        "tension": sealed(tension),
    }


def _dang_van(
    unit: RollingPass, p0: Array, body_hydrostatic: Array, limits: FatigueLimits
) -> Array:
    """Dang Van stress (n, k) likewise; compression counts as zero."""
    pulled = p0[:, None] * unit.shear_pulled(limits.dang_van)
    pulled += limits.dang_van * body_hydrostatic[:, None]
    return sealed(np.maximum(p0[:, None] * unit.shear_pulled(0.0), pulled, out=pulled))
