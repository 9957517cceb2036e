"""Body ends, crown and tilt in `contact cylinders`: from options to a document."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.axial_shape import BodyEnd
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    Crown,
    FiniteBody,
    FinitePair,
    Straight,
    TabulatedCrown,
    iso16281,
    johns_gohar,
    lundberg,
)
from camwright.pipeline.contact.finite_length.length_tiers import (
    FACTORS,
    MEAN_LENGTH,
    SIZES,
    TierResult,
    both_tiers,
)
from camwright.pipeline.cycle.length_records import factors, stress_peaks
from camwright.pipeline.studies.two_cylinders import TwoCylinders

Document = dict[str, Any]

_ENDS = "sharp, chamfer:SIZE or radius:SIZE"
_CROWNS = (
    "johns-gohar:LOAD, lundberg:LOAD, iso16281, circular:RADIUS or a CSV file of y_mm and drop_um"
)
_TITLES = {"half_space": "half-space", "finite_elements": "finite elements"}
# Moment over force and length of contact: round-off.
_MOMENT_ROUND_OFF = 1e-12
# Depth of a body without one, in the shorter length, by Saint-Venant.
_DEPTH_OVER_LENGTH = 2.0


@dataclass(frozen=True)
class LengthOptions:
    """Options of the bodies' lengths as text; numbers without unit in mm, N/mm, mrad, N mm."""

    length1: str | None = None
    """Length of body 1, mm."""
    length2: str | None = None
    """Length of body 2, mm."""
    end1: str | None = None
    """Ends of body 1: sharp, chamfer:0.3, radius:0.3 (mm)."""
    end2: str | None = None
    """Ends of body 2."""
    crown: str | None = None
    """johns-gohar:"200 N/mm", lundberg:"200 N/mm", iso16281, circular:500 or a CSV file of y_mm
    and drop_um."""
    tilt: str | None = None
    """Tilt of the bases, mrad; closes the gap at y > 0."""
    moment: str | None = None
    """Moment about the middle, N mm, instead of the tilt."""
    mean_length: str | None = None
    """Length of the mean pressure at the ends, mm; default: 0.1."""

    @property
    def stated(self) -> bool:
        """Whether a length, or an option that needs one, is stated."""
        return self != LengthOptions()

    def bodies(
        self, pair: TwoCylinders, depths: Sequence[float | None]
    ) -> tuple[FiniteBody, FiniteBody]:
        """Both bodies with length, ends and the depth at which they are held, m.

        Without a stated depth it is `_DEPTH_OVER_LENGTH` times the shorter length, at most the
        radius of a convex body.

        Parameters
        ----------
        pair : TwoCylinders   materials and radii
        depths : sequence     stated depth of each body, m; None: not stated

        Raises
        ------
        InputError
            Naming the option.
        """
        self.contact_length()
        shorter = min(self.lengths())
        bodies = [
            FiniteBody(
                material, length, end, _DEPTH_OVER_LENGTH * shorter if depth is None else depth
            )
            for material, length, end, depth in zip(
                (pair.body_1, pair.body_2), self.lengths(), self.ends(), depths, strict=True
            )
        ]
        for number, radius in enumerate((pair.radius_1, pair.radius_2)):
            if depths[number] is None and radius > 0:
                body = bodies[number]
                bodies[number] = replace(body, depth=min(radius, body.depth))
        return bodies[0], bodies[1]

    def lengths(self) -> tuple[float, float]:
        """Lengths of both bodies, m."""
        first, second = (
            self._positive(text, "mm", option)
            for text, option in ((self.length1, "--length1"), (self.length2, "--length2"))
        )
        return first, second

    def ends(self) -> tuple[BodyEnd, BodyEnd]:
        """Ends of both bodies."""
        return self._end(self.end1, "--end1"), self._end(self.end2, "--end2")

    def contact_length(self) -> float:
        """Length on which both bodies are without ends, m."""
        ends = self.ends()
        flat = [length - 2.0 * end.size for length, end in zip(self.lengths(), ends, strict=True)]
        if not min(flat) > 0:
            worst = int(np.argmin(flat))
            raise InputError(f"--end{worst + 1}", shown(ends[worst].size, "mm"), "< half a length")
        return min(flat)

    def finite_pair(self, pair: TwoCylinders, depths: Sequence[float | None]) -> FinitePair:
        """Both bodies with their crown."""
        straight = FinitePair(self.bodies(pair, depths), pair.curvature, Straight())
        return replace(straight, crown=self._crown(straight, pair))

    def tilt_or_moment(self) -> tuple[float | None, float | None]:
        """Stated tilt, rad, and stated moment, N m, one of them None; a tilt of 0 where neither is
        stated.
        """
        if self.moment is None:
            if self.tilt is None:
                return 0.0, None
            return units.parse_or_bare(self.tilt, "mrad", "--tilt"), None
        if self.tilt is not None:
            raise InputError("--moment", self.moment, "left out beside --tilt")
        return None, units.parse_or_bare(self.moment, "N mm", "--moment")

    def mean(self) -> float:
        """Length at each end over which the pressure is averaged, m."""
        if self.mean_length is None:
            return MEAN_LENGTH
        mean, most = self._positive(self.mean_length, "mm", "--mean-length"), self.contact_length()
        if not SIZES.at_end <= mean <= most:
            limit = f"at least {shown(SIZES.at_end, 'mm')}, the cell at the end, and at most "
            limit += f"{shown(most, 'mm')}, the length of contact"
            raise InputError("--mean-length", shown(mean, "mm"), limit)
        return mean

    def _crown(self, straight: FinitePair, pair: TwoCylinders) -> Crown:
        """Crown of the option, such as ``johns-gohar:300 N/mm`` or a table file; straight without
        it.

        Parameters
        ----------
        straight : FinitePair   contact without a crown
        pair : TwoCylinders     radii

        Raises
        ------
        InputError
            If the crown cannot be read or does not fit the bodies.
        """
        if self.crown is None:
            return Straight()
        kind, _, value = self.crown.partition(":")
        if kind in ("johns-gohar", "lundberg", "circular") and not value:
            raise InputError("--crown", self.crown, _CROWNS)
        length, modulus = straight.contact_length, straight.contact_modulus
        if kind in ("johns-gohar", "lundberg"):
            load = self._positive(value, "N/mm", "--crown")
            even = lundberg(load, length, modulus)
            if kind == "lundberg":
                return even
            half_width, _ = hertz.line_contact(load, 1.0 / straight.curvature, modulus)
            if not float(half_width) < length:
                raise InputError("--crown", self.crown, "a load of less half-width than length")
            return johns_gohar(load, length, modulus, float(half_width))
        if kind == "circular":
            return CircularCrown(self._positive(value, "mm", "--crown"))
        if self.crown == "iso16281":
            if not np.isfinite(pair.smaller_radius):
                raise InputError("--crown", self.crown, "on a round body")
            return iso16281(2.0 * pair.smaller_radius, length)
        return _tabulated(self.crown)

    @staticmethod
    def _positive(text: str | None, unit: str, option: str) -> float:
        """Number in SI from the text of an option, above zero; InputError where it is not.

        Parameters
        ----------
        text : str or None   with a unit, or a number in `unit`
        unit : str           of a number without a unit
        option : str         name of the option
        """
        if not text:
            raise InputError(option, "missing", f"specified, > 0 {unit}")
        value = units.parse_or_bare(text, unit, option)
        if not value > 0:
            raise InputError(option, units.rounded(text), f"> 0 {unit}")
        return value

    @classmethod
    def _end(cls, text: str | None, option: str) -> BodyEnd:
        """End of a body from text such as ``chamfer:0.5 mm``; sharp without it."""
        kind, _, size = (text or "sharp").partition(":")
        if kind == "sharp" and not size:
            return BodyEnd()
        if kind == "chamfer" and size:
            return BodyEnd("chamfer", cls._positive(size, "mm", option))
        if kind == "radius" and size:
            return BodyEnd("radius", cls._positive(size, "mm", option))
        raise InputError(option, text, _ENDS)


def _tabulated(text: str) -> TabulatedCrown:
    """Crown from a drop table; errors name the option."""
    path = Path(text)
    if not path.is_file():
        raise InputError("--crown", text, _CROWNS)
    try:
        return TabulatedCrown.read(path)
    except InputError as error:
        raise InputError(f"--crown {path}: {error.field}", error.value, error.limit) from None


@dataclass(frozen=True, eq=False)
class FiniteLength:
    """Finite-length contact by half-spaces and by finite elements."""

    pair: FinitePair
    tiers: tuple[TierResult, TierResult]

    def records(self) -> list[Document]:
        """One object per tier; factors over plane-strain p0, error bars in percent."""
        return [self._record(tier) for tier in self.tiers]

    def _record(self, tier: TierResult) -> Document:
        """Document of the contact by one method, half-spaces or finite elements: pressures over
        plane-strain p0 with error bars in percent, moment, tilt, place of the greatest pressure,
        stress peaks, residual.

        An error bar is None, unbounded, where the greatest pressure is at a singular end.
        """
        values = factors(tier)
        contact, cells = tier.contact, tier.contact.cells
        is_singular = self.pair.has_singular_end and tier.greatest_is_at_an_end
        bars: dict[str, float | None] = {
            f"{name}_error_percent": in_unit(each.gci, "%")
            for name, each in zip(FACTORS, tier.convergence, strict=True)
        }
        if is_singular:
            bars["greatest_error_percent"] = None
        moment, scale = float(contact.moment[0]), float(contact.force[0]) * self.pair.contact_length
        place = int(contact.centre_line[0].argmax())
        record: Document = {
            "tier": tier.tier,
            **values,
            "mean_length_mm": in_unit(tier.factors.mean_length, "mm"),
            **bars,
            "greatest_at_mm": in_unit(float(cells.centres_along[place]), "mm"),
            "greatest_is_singular": is_singular,
            "moment_Nmm": in_unit(moment, "N mm")
            if abs(moment) > _MOMENT_ROUND_OFF * scale
            else 0.0,
        }
        if tier.tier == "finite_elements":
            depths = [in_unit(body.depth, "mm") for body in self.pair.bodies]
            record |= {
                "tilt_mrad": in_unit(float(contact.tilt[0]), "mrad"),
                "held_at_depth_mm": depths,
            }
        for number, peaks in enumerate(stress_peaks(self.pair, tier), 1):
            record[f"stress_body{number}"] = peaks
        return record | {
            "unknowns": tier.unknowns,
            "residual": float(max(contact.equilibrium[0], contact.complementarity[0])),
        }

    def write(self, path: Path) -> None:
        """VTU file of the pressure cells with the pressure of each tier, MPa."""
        from camwright.meshes.mesh_files import write_rectangles

        cells = self.tiers[0].contact.cells
        x = np.concatenate([-cells.x[:0:-1], cells.x])
        values = {}
        for tier in self.tiers:
            half = tier.contact.pressure[0]
            whole = np.concatenate([half[:, ::-1], half], axis=1)
            values[units.column(f"pressure_{tier.tier}", "MPa")] = whole / units.factor("MPa")
        write_rectangles(path, x, cells.y, values)


def finite_length(
    options: LengthOptions, pair: TwoCylinders, depths: Sequence[float | None]
) -> FiniteLength:
    """Contact of two cylinders of finite length, by half-spaces and by finite elements.

    Parameters
    ----------
    options : LengthOptions   lengths, ends, crown, tilt or moment
    pair : TwoCylinders       radii, materials, line load
    depths : sequence         at which each body is held, m; None: not stated

    Raises
    ------
    InputError
        If an option is out of bounds, named.
    ContactError
        If the bodies tip over or the contact leaves its cells.
    """
    if not pair.line_load > 0:
        raise InputError("--line-load", shown(pair.line_load, "N/mm"), "> 0 N/mm beside --length1")
    tilt, moment = options.tilt_or_moment()
    mean_length = options.mean()
    try:
        finite = options.finite_pair(pair, depths)
        force = pair.line_load * finite.contact_length
        tiers = both_tiers(finite, force, tilt=tilt, moment=moment, mean_length=mean_length)
    except InputError as error:
        known = {"moment": "--moment", "tilt": "--tilt", "depth": "--depth1 or --depth2"}
        if error.field.startswith("--"):
            raise
        field = known.get(error.field, f"--crown: {error.field}")
        raise InputError(field, error.value, error.limit) from None
    return FiniteLength(finite, tiers)


def lines(records: Sequence[Document]) -> Iterator[str]:
    """Lines of text of a finite-length contact."""
    mean = f"{records[0]['mean_length_mm']:g} mm"
    titles = ("centre", "greatest", f"last {mean}, y < 0", f"last {mean}, y > 0")
    yield f"{'over plane strain':22}" + "".join(f"{_TITLES[r['tier']]:>24}" for r in records)
    for name, title in zip(FACTORS, titles, strict=True):
        bars = [record[f"{name}_error_percent"] for record in records]
        yield f"{title:22}" + "".join(
            f"{record[name]:13.4f} " + (f"{'unbounded':>10}" if bar is None else f"± {bar:6.2g} %")
            for record, bar in zip(records, bars, strict=True)
        )
    blocks = records[1]
    for depth, number in zip(blocks["held_at_depth_mm"], (1, 2), strict=True):
        yield f"body {number} held at a depth of {depth:.4g} mm"
    moment, tilt = blocks["moment_Nmm"], blocks["tilt_mrad"]
    yield f"moment {moment:.4g} N mm, tilt of the bases {tilt:.4g} mrad"
    where = f"greatest at y = {blocks['greatest_at_mm']:.4g} mm"
    if blocks["greatest_is_singular"]:
        yield f"{where}, at a corner: it grows with the mesh, the mean over {mean} does not"
    else:
        yield f"{where}: a bounded peak"
