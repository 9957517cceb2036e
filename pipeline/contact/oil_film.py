"""Elastohydrodynamic film between follower and cam; load share of the asperities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Part,
    Resolved,
    TableSource,
    Temperature,
    card_of,
)
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import shown

UNVERIFIED = Source(
    "regression of Masjedi and Khonsari (2012), not checked against the paper", confirmed=False
)
_WALTHER = 1e-6  # m2/s, unit of the viscosity in Walther's equation
_DENSITY = 870.0  # kg/m3 of a mineral oil; its thinning is not sensitive to it
_THINNEST = 0.2  # least viscosity of that equation, in its unit
_RANGE = {  # of the regression, orders of magnitude: verify
    "load": (2e-5, 5e-4),
    "speed": (1e-12, 1e-10),
    "material": (2500.0, 7500.0),
    "roughness": (0.0, 5e-5),
    "hardness": (0.005, 0.03),
}


@dataclass(frozen=True, kw_only=True)
class Lubricant(Part):
    """Oil in the contact of cam and follower at the inlet temperature.

    The source of the regression for rough surfaces is not verified. Walther's equation is log log
    (v + 0.7) = A - B log T, v in mm2/s; the default slope B is that of a mineral oil. Scuffing
    limits a film that carries; without one the adsorbed layer alone keeps the surfaces apart.
    """

    table: ClassVar[str] = "lubricant"
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "card of the oil; with temperature it supplies the viscosity", "oils.toml", "iso_vg_150"
    )
    defaults: ClassVar[Mapping[str, str]] = {
        "scuffing_temperature": "unknown: needed under a flat face, which slides",
        "boundary_temperature": "unknown: needed under a flat face, which slides",
    }

    viscosity: Annotated[
        float, In("mPa s", above=0, at_most=1e5), Known("oil data sheet", "24 mPa s")
    ]
    """dynamic viscosity at the temperature of the inlet"""
    pressure_viscosity: Annotated[
        float,
        In("1/GPa", above=0, at_most=1000),
        Known("oil maker; 15 to 25 1/GPa of mineral oil", "18 1/GPa"),
    ]
    """pressure-viscosity coefficient"""
    film: Annotated[Literal["smooth", "mixed"], Known("own choice")] = "smooth"
    """film of smooth surfaces, or of rough ones by a regression"""
    temperature: Annotated[Temperature | None, Known("measured at the machine", "80 degC")] = None
    """temperature of the oil at the inlet"""
    thinning: Annotated[
        float, In(above=0, at_most=10), Known("viscosities at 40 and 100 degC", 3.45)
    ] = 3.6
    """slope of the viscosity in Walther's equation, ASTM D341"""
    scuffing_temperature: Annotated[
        Temperature | None, Known("scuffing test of the oil", "228 degC")
    ] = None
    """temperature in a sliding contact at which the oil lets the surfaces scuff"""
    boundary_temperature: Annotated[
        Temperature | None, Known("friction of the oil by temperature without a film", "150 degC")
    ] = None
    """temperature in a sliding contact at which the layer adsorbed from the oil leaves the
    surfaces"""
    source: TableSource = NO_SOURCE

    def warmer(self, rise: float) -> Lubricant:
        """Oil warmer by a rise, K, thinned by Walther's equation; unchanged where its temperature
        is not stated or the rise is not positive.

        References
        ----------
        Walther's equation, ASTM D341.
        """
        if self.temperature is None or not rise > 0.0:
            return self
        kinematic = max(self.viscosity / _DENSITY / _WALTHER, 2.0 * _THINNEST)
        level = np.log10(np.log10(kinematic + 0.7))
        level -= self.thinning * np.log10(1.0 + rise / self.temperature)
        thinner = max(10.0 ** (10.0**level) - 0.7, _THINNEST) * _DENSITY * _WALTHER
        return replace(
            self, viscosity=min(thinner, self.viscosity), temperature=self.temperature + rise
        )


@dataclass(frozen=True, eq=False)
class LineFilm:
    """Dimensionless groups of an elastohydrodynamic line contact, arrays (...).

    load W = P'/(E' R), speed U = eta u/(E' R), material G = alpha E', with E' = 2 E*, relative
    radius R (m) and entrainment speed u, the mean surface speed through the contact.
    """

    load: Array
    speed: Array
    material: float
    radius: Array

    def __post_init__(self) -> None:
        freeze(self, load=self.load, speed=self.speed, radius=self.radius)

    @classmethod
    def of(
        cls,
        line_load: ArrayLike,
        relative_radius: ArrayLike,
        contact_modulus: float,
        entrainment_speed: ArrayLike,
        lubricant: Lubricant,
    ) -> LineFilm:
        """Groups of a line contact with an oil.

        Parameters
        ----------
        line_load : array (...)           P', N/m, >= 0
        relative_radius : array (...)     R, m
        contact_modulus : float           E*, Pa
        entrainment_speed : array (...)   mean speed of both surfaces through the contact, m/s; its
            sign does not count

        Raises
        ------
        InputError
            If a load is negative, a radius or the modulus not positive, a value not finite.
        """
        load = finite("line_load", line_load)
        if (load < 0).any():
            raise InputError("line_load", float(load.min()), ">= 0 N/m")
        radius = positive("relative_radius", relative_radius, "m")
        modulus = 2 * float(positive("contact_modulus", contact_modulus, "Pa"))
        speed = np.abs(finite("entrainment_speed", entrainment_speed))
        return cls(
            load=load / (modulus * radius),
            speed=lubricant.viscosity * speed / (modulus * radius),
            material=lubricant.pressure_viscosity * modulus,
            radius=radius,
        )


def entrainment_speed(rolling_speed: ArrayLike, slip: ArrayLike = 0.0) -> Array:
    """Entrainment speed (...), m/s: mean of both surface speeds, the roller slower by `slip`."""
    return np.abs(np.asarray(rolling_speed, dtype=float) - np.asarray(slip, dtype=float) / 2)


def minimum_film(film: LineFilm) -> Array:
    """Minimum film thickness (...) of smooth surfaces, m; NaN without load.

    References
    ----------
    Dowson and Higginson, Elasto-hydrodynamic Lubrication (1966):
    H = 2.65 U^0.70 G^0.54 W^-0.13.
    """
    loaded = ~(film.load <= 0)  # NaN is refused, not unloaded
    load = np.where(loaded, film.load, 1.0)
    film_ratio = 2.65 * film.speed**0.70 * film.material**0.54 * load**-0.13
    return np.where(loaded, film_ratio * film.radius, np.nan)


BOUNDARY, CARRYING = 0.4, 1.0
"""Film over roughness below which the surfaces bear on each other, and above which the film carries
them: regimes I and III of AGMA 925-A03, recalled: verify."""


def scuffing_limit(ratio: Array, boundary: float, carrying: float) -> Array:
    """Scuffing temperature (...) of a sliding contact by its film thickness ratio (...).

    Parameters
    ----------
    boundary : float   limit of the adsorbed layer, K, up to the ratio `BOUNDARY`
    carrying : float   limit of the oil, K, from `CARRYING` on; between them the line
    """
    carried = np.interp(ratio, (BOUNDARY, CARRYING), (0.0, 1.0))
    return np.asarray(boundary + carried * (carrying - boundary))


def lambda_ratio(thickness: ArrayLike, roughness_1: float, roughness_2: float) -> Array:
    """Film thickness ratio (...): film over combined rms roughness; > 3 full film, < 1 boundary.

    Raises
    ------
    InputError
        If a roughness is not positive.
    """
    both = np.hypot(
        float(positive("roughness", roughness_1, "m")),
        float(positive("roughness", roughness_2, "m")),
    )
    return np.asarray(np.asarray(thickness, dtype=float) / both)


@dataclass(frozen=True, eq=False)
class MixedFilm:
    """Central and minimum film thickness (m), load share of the asperities (0 to 1)."""

    central: Array
    minimum: Array
    asperity_share: Array
    source: Source = UNVERIFIED

    def __post_init__(self) -> None:
        freeze(
            self,
            central=self.central,
            minimum=self.minimum,
            asperity_share=self.asperity_share,
        )


def mixed_film(
    film: LineFilm, roughness: float, hardness: float, modulus: float
) -> tuple[MixedFilm, str]:
    """Film and asperity load of rough surfaces, by a regression of unverified source.

    Parameters
    ----------
    film : LineFilm     at positions (n,)
    roughness : float   combined rms roughness of both surfaces, m
    hardness : float    Vickers, Pa
    modulus : float     E*, Pa

    Returns
    -------
    film : MixedFilm   NaN without load and outside the range of the regression
    words : str        the first violated range; "" without one

    References
    ----------
    Masjedi and Khonsari, ASME J. Tribol. 134 (2012) 011503; coefficients as recalled: verify.
    """
    loaded = ~(film.load <= 0)  # NaN is refused, not unloaded
    at_work = LineFilm(film.load[loaded], film.speed[loaded], film.material, film.radius[loaded])
    refusals = list(_refusals(at_work, roughness, hardness, modulus))
    holds = loaded.copy()
    for where, _ in refusals:
        holds[loaded] &= ~where
    held = LineFilm(np.where(holds, film.load, np.nan), film.speed, film.material, film.radius)
    words = str(refusals[0][1]) if refusals else ""
    return _regression(held, roughness, hardness, modulus), words


def _groups(film: LineFilm, roughness: float, hardness: float, modulus: float) -> dict[str, Array]:
    """Groups of the regression by name, in the order of `_RANGE`."""
    shape = np.shape(film.load)
    return {
        "load": np.asarray(film.load),
        "speed": np.asarray(film.speed),
        "material": np.full(shape, film.material),
        "roughness": np.asarray(roughness / film.radius),
        "hardness": np.full(shape, hardness / (2 * modulus)),
    }


def _refusals(
    film: LineFilm, roughness: float, hardness: float, modulus: float
) -> Iterator[tuple[NDArray[np.bool_], InputError]]:
    """Each violated range of the regression: where (...) a group or the load share is out of it,
    bool, and the error; inputs as those of `mixed_film`, with load.
    """
    for name, values in _groups(film, roughness, hardness, modulus).items():
        low, high = _RANGE[name]
        outside = ~((values >= low) & (values <= high))
        if outside.any():
            value = float(np.atleast_1d(values)[np.atleast_1d(outside)].flat[0])
            yield outside, InputError(f"mixed film, {name} group", value, f"in [{low:g}, {high:g}]")
    with np.errstate(all="ignore"):  # out of range already where it has no value
        share = _asperity_share(film, roughness, hardness, modulus)
    above = np.asarray(share > 1)
    if above.any():
        largest = shown(float(share[above].max() if share.ndim else share), "%")
        yield above, InputError("mixed film, asperity load share", largest, "<= 100 %")


def _asperity_share(film: LineFilm, roughness: float, hardness: float, modulus: float) -> Array:
    W, U, G, s, V = _groups(film, roughness, hardness, modulus).values()
    rough = np.log1p(4470 * s**6.015 * V**1.168 * W**0.485 * U**-3.741 * G**-2.898)
    return np.asarray(0.005 * W**-0.408 * U**-0.088 * G**0.103 * rough / 100)


def _regression(film: LineFilm, roughness: float, hardness: float, modulus: float) -> MixedFilm:
    """Film thickness, m, and share of the load on asperities by the regression, whether or not it
    holds there; inputs as those of `mixed_film`.
    """
    W, U, G, s, V = _groups(film, roughness, hardness, modulus).values()
    central = 1 + 0.2 * s**1.222 * V**0.223 * W**-0.229 * U**-0.748 * G**-0.842
    least = 1 + 0.026 * s**1.120 * V**0.185 * W**-0.312 * U**-0.809 * G**-0.977
    return MixedFilm(
        central=2.691 * W**-0.135 * U**0.705 * G**0.556 * central * film.radius,
        minimum=1.652 * W**-0.077 * U**0.716 * G**0.695 * least * film.radius,
        asperity_share=_asperity_share(film, roughness, hardness, modulus),
    )
