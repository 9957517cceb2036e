"""Pin in a bush of finite length by finite elements: clearance, force, couple, both elastic.

The bush is bonded into a rigid housing, its ends are free. The pin goes on beyond both of them and
is held on a core about its axis, which is a line that moves and turns: its bending between its
supports is left out. Pressures are products of hat functions around and along the bore; the gap,

    gap = c - (x + a z) cos phi - (y + b z) sin phi + compliance of both bodies,

is complementary to them, integrated with the same functions. phi is the angle from the plane of
the couple, z the place from the middle of the bush.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, freeze
from camwright.geometry.errors import ContactError
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.elasticity.round_body import Meridian, harmonic_compliance

_CORE = 0.15  # radius on which the pin is held over its own
_BEYOND = (0.06, 0.15, 0.3, 0.5)  # of the pin at either end, over the length of the bush
_GROWTH = 2.2  # of the elements from the surface inwards, the first as wide as a hat function
_WAVES_PER_HAT = 2  # per hat function around
_SWEEPS, _SIGN_ROUND_OFF = 60, 1e-11
_START = 0.45  # rad, on either side of the load: first set in contact
_MEAN = (np.arange(32) + 0.5) / 32  # points of a mean


@dataclass(frozen=True)
class BushedPin:
    """Pin in its bush, m: radius, length and radial clearance of the bush; mean_length, over which
    the pressure at an end is averaged: at a sharp edge it grows with the mesh.
    """

    pin: SolidBar
    bush: Bush
    radius: float
    length: float
    clearance: float
    mean_length: float


class BushGrid(NamedTuple):
    """Hat functions around the bore, and spaces between those along it; fine: over the coarse grid,
    by whose root the elements grow less from the surface inwards.
    """

    around: int
    along: int
    fine: float = 1.0

    def refined(self, ratio: float) -> BushGrid:
        """Grid with elements and functions smaller by a ratio, to whole numbers."""
        around, along = (round(ratio * each) for each in (self.around, self.along))
        return BushGrid(around, along, self.fine * ratio)


class PinLoad(NamedTuple):
    """Load of a pin in the middle of its bush, N and N m: force in the plane of the couple, aside
    across it, couple, which presses the end of greatest place with the force.
    """

    force: float
    aside: float
    couple: float


@dataclass(frozen=True, eq=False)
class PressedPin:
    """Pin pressed in its bush.

    pressure (m, k), Pa, at m angles and k places; line (2, k), N/m, in the plane of the couple and
    across; peak, Pa; tilt of the axis in the plane of the couple, rad; active (m, k): in contact;
    relative residuals of equilibrium and complementarity as in `active_set`.
    """

    pressure: Array
    line: Array
    peak: float
    tilt: float
    active: NDArray[np.bool_]
    equilibrium: float
    complementarity: float

    def __post_init__(self) -> None:
        freeze(self, pressure=self.pressure, line=self.line)


class PinInBush:
    """Compliance of a pin and its bush on a grid, and their contact under loads."""

    def __init__(self, seat: BushedPin, grid: BushGrid) -> None:
        """Solve the harmonics of both bodies, or read them from the cache."""
        self.seat, self.grid = seat, grid
        length, step = seat.length / seat.radius, FULL_TURN / grid.around
        along = -0.5 * length * np.cos(np.linspace(0.0, np.pi, grid.along + 1))
        self.angles: Array = step * np.arange(float(grid.around))
        self.places: Array = np.asarray(seat.radius * along)
        most = _WAVES_PER_HAT * grid.around
        order = np.arange(1, most + 1)
        waves = np.append(step, (2.0 * np.sin(0.5 * order * step)) ** 2 / (step * order**2))
        weight = waves**2 / np.pi
        weight[0] *= 0.5
        harmonics = weight[:, None, None] * self._harmonics(along, most)
        # harmonics that are alike at the angles of the hat functions
        folded = np.zeros((grid.around, *harmonics.shape[1:]))
        np.add.at(folded, np.arange(most + 1) % grid.around, harmonics)
        self._kernel: Array = np.fft.fft(folded, axis=0).real
        self._waves = np.fft.rfft(self._kernel, axis=0)
        between = np.diff(along)
        area = 0.5 * (np.append(between, 0.0) + np.append(0.0, between))
        lever = area * along + (np.append(between, 0.0) ** 2 - np.append(0.0, between) ** 2) / 6.0
        ways = waves[1] * np.array([np.cos(self.angles), np.sin(self.angles)])
        self._weights: Array = np.stack(
            [np.outer(way, each).ravel() for each in (area, lever) for way in ways], axis=1
        )
        self._ways = ways
        self._gap = np.tile(step * area * seat.clearance / seat.radius, grid.around)
        self._end_mean = self._mean_at_end()

    def _harmonics(self, along: Array, most: int) -> Array:
        """Compliance of both bodies, 1/Pa; see `harmonic_compliance`."""
        seat, stations = self.seat, tuple(along.tolist())

        def rings(depth: float) -> tuple[float, ...]:
            """Edges of the elements from the surface at 1 to a depth, negative inwards."""
            growth, first = _GROWTH ** (1.0 / self.grid.fine), FULL_TURN / self.grid.around
            count = np.log1p(abs(depth) * (growth - 1.0) / first) / np.log(growth)
            powers = growth ** np.arange(max(round(count), 1) + 1.0)
            return tuple((1.0 + depth * (powers - 1.0) / (powers[-1] - 1.0)).tolist())

        beyond = along[-1] + np.array(_BEYOND) * seat.length / seat.radius
        longer = tuple(np.concatenate([-beyond[::-1], along, beyond]).tolist())
        bush = Meridian(rings(seat.bush.wall or 1.0), stations, stations), seat.bush
        pin = Meridian(rings(_CORE - 1.0), longer, stations), seat.pin
        parts = (
            harmonic_compliance(mesh, card.poisson, most) / card.modulus
            for mesh, card in (bush, pin)
        )
        return np.asarray(sum(parts))

    def _mean_at_end(self) -> Array:
        """Weights (k,) of the mean pressure over the last `mean_length` of the greatest place."""
        count = self.places.size
        points = self.places[-1] - self.seat.mean_length * _MEAN
        hats = [np.interp(points, self.places, each) for each in np.eye(count)]
        return np.asarray(np.mean(hats, axis=1))

    def pressed(self, load: PinLoad, start: NDArray[np.bool_] | None = None) -> PressedPin:
        """Pin under a load.

        Parameters
        ----------
        start : array (m, k) of bool   first set in contact; the solution does not depend on it

        Raises
        ------
        ContactError
            If the set in contact is not found, as where it is narrower than the grid.

        References
        ----------
        Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865: primal-dual active set; where a
        set recurs, one place is exchanged at a time.
        """
        radius = self.seat.radius
        targets = np.array([load.force, load.aside, load.couple / radius, 0.0]) / radius**2
        active = (self._first(load) if start is None else start).ravel()
        seen, recurred = set[bytes](), False
        for _ in range(_SWEEPS):
            pressure, motion = self._closed(active, targets)
            gap = self._settled(pressure) + self._gap - self._weights @ motion
            least, open_least = (_SIGN_ROUND_OFF * np.abs(each).max() for each in (pressure, gap))
            updated = np.where(active, pressure >= -least, gap < -open_least)
            if (updated == active).all():
                return self._pressed(pressure, motion, gap, active, targets)
            recurred = recurred or np.packbits(updated).tobytes() in seen
            if recurred:
                changed = np.flatnonzero(updated != active)
                off = np.where(active, -pressure / least, -gap / open_least)
                updated, worst = active.copy(), changed[np.argmax(off[changed])]
                updated[worst] = not active[worst]
            seen.add(np.packbits(updated).tobytes())
            active = updated
        raise ContactError("pin in its bush: set in contact not found")

    def peak(self, pressure: Array) -> float:
        """Greatest pressure, Pa, of pressures (m, k); within `mean_length` of an end their mean."""
        inner = np.abs(self.places) <= 0.5 * self.seat.length - self.seat.mean_length
        ends = pressure @ np.stack([self._end_mean, self._end_mean[::-1]], axis=1)
        return float(max(pressure[:, inner].max(), ends.max()))

    def _first(self, load: PinLoad) -> NDArray[np.bool_]:
        """First set in contact (m, k): about the direction of a line load that is linear along the
        bush.
        """
        length = self.seat.length
        pushed = load.force + 12.0 * load.couple * self.places / length**2
        away = self.angles[:, None] - np.arctan2(np.full_like(pushed, load.aside), pushed)
        return np.asarray(np.cos(away) > np.cos(_START))

    def _closed(self, active: NDArray[np.bool_], targets: Array) -> tuple[Array, Array]:
        """Pressures (m k,), Pa, with the active places closed, and motion (4,) of the axis: shifts
        over the radius and tilts, each in the plane of the couple and across.
        """
        on = np.flatnonzero(active)
        if on.size < targets.size:
            raise ContactError("pin in its bush: contact narrower than the grid")
        around, along = np.divmod(on, self.places.size)
        apart = (around[:, None] - around) % self.grid.around
        compliance = self._kernel[apart, along[:, None], along]
        scale, ways = compliance[0, 0], self._weights[on]
        system = np.block([[compliance / scale, -ways], [ways.T, np.zeros((4, 4))]])
        try:
            solved = np.linalg.solve(system, np.append(-self._gap[on], scale * targets))
        except np.linalg.LinAlgError as error:
            raise ContactError("pin in its bush: contact narrower than the grid") from error
        pressure = np.zeros(active.size)
        pressure[on] = solved[:-4] / scale
        return pressure, solved[-4:]

    def _settled(self, pressure: Array) -> Array:
        """Gap (m k,) by the compliance of both bodies, a convolution around the bore."""
        waves = np.fft.rfft(pressure.reshape(self.grid.around, -1), axis=0)
        settled = np.einsum("nij,nj->ni", self._waves, waves)
        return np.fft.irfft(settled, self.grid.around, axis=0).ravel()

    def _pressed(
        self, signed: Array, motion: Array, gap: Array, active: NDArray[np.bool_], targets: Array
    ) -> PressedPin:
        """Solution of a settled set in contact, with its residuals; see `pressed`."""
        flat = np.maximum(signed, 0.0)
        pressure, scale = flat.reshape(self.grid.around, -1), float(np.abs(targets).max())
        most = float(flat.max()), float(np.abs(gap).max())
        violation = (
            *(-signed.min() / most[0], -gap.min() / most[1]),
            np.abs(flat * gap).max() / (most[0] * most[1]),
        )
        return PressedPin(
            pressure,
            self.seat.radius * self._ways @ pressure,
            self.peak(pressure),
            float(motion[2]),
            active.reshape(pressure.shape),
            float(np.abs(flat @ self._weights - targets).max() / scale),
            float(max(0.0, *violation)),
        )


@lru_cache(maxsize=8)
def pin_in_bush(seat: BushedPin, grid: BushGrid) -> PinInBush:
    """Pin in its bush on a grid; see `PinInBush`."""
    return PinInBush(seat, grid)
