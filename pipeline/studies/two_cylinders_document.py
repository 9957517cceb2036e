"""Command `contact cylinders`: line contact of two cylinders, from options to a document."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.pipeline.base import units
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.studies.finite_length_document import (
    LengthOptions,
    finite_length,
)
from camwright.pipeline.studies.finite_length_document import lines as length_lines
from camwright.pipeline.studies.two_cylinders import (
    HALF_ANGLE_MAX,
    ConformingContact,
    FiniteElementContact,
    LineContact,
    TwoCylinders,
    approach,
    closed_form,
    conforming,
    finite_elements,
    is_conforming,
    patch_mesh,
)

# Relative excess of the shear on another plane above which it is listed.
_SHEAR_EXCESS = 1e-3
# Dundurs' constant of like materials: round-off.
_ZERO_DUNDURS = 1e-12
Document = dict[str, Any]

# Young's moduli of solids from soft rubber to diamond, Pa.
_MODULI = 1e6, 1.2e12
_OPTIONS = {"radius_1": "--r1", "radius_2": "--r2", "friction": "--friction"}


@dataclass(frozen=True)
class ContactOptions:
    """Options of the command as text; numbers without unit in mm, N/mm or N, or MPa if no other
    unit of a modulus is plausible."""

    r1: str
    """Radius of body 1, mm; inf: flat, negative: concave."""
    r2: str
    """Radius of body 2, mm."""
    e1: str
    """Young's modulus of body 1, such as "210 GPa"."""
    nu1: float
    """Poisson ratio of body 1."""
    e2: str | None = None
    """Young's modulus of body 2; default: of body 1."""
    nu2: float | None = None
    """Poisson ratio of body 2; default: of body 1."""
    line_load: str | None = None
    """Line load, N/mm."""
    load: str | None = None
    """Normal force, N; needs --width, or --length1 and --length2."""
    width: str | None = None
    """Width of the contact, mm."""
    friction: float = 0.0
    """Friction coefficient of full sliding; default: 0."""
    depth1: str | None = None
    """Depth of the reference point in body 1, mm."""
    depth2: str | None = None
    """Depth of the reference point in body 2, mm."""
    lengths: LengthOptions = dataclasses.field(default_factory=LengthOptions)

    def pair(self) -> TwoCylinders:
        """The contact in SI.

        Raises
        ------
        InputError
            Naming the option.
        """
        first = Elastic(_modulus(self.e1, "--e1"), self.nu1)
        second = Elastic(
            first.modulus if self.e2 is None else _modulus(self.e2, "--e2"),
            self.nu1 if self.nu2 is None else self.nu2,
        )
        for number, body in ((1, first), (2, second)):
            if not body.modulus > 0:
                text = self.e1 if number == 1 or self.e2 is None else self.e2
                raise InputError(f"--e{number}", _as_read(text, "MPa"), "> 0 MPa")
            if not 0 <= body.poisson < 0.5:
                raise InputError(f"--nu{number}", body.poisson, "in [0, 0.5)")
        radii = _radius(self.r1, "--r1"), _radius(self.r2, "--r2")
        load = self._line_load()
        try:
            return TwoCylinders(*radii, first, second, load, self.friction)
        except InputError as error:
            option, limit = _OPTIONS.get(error.field, error.field), error.limit
            stated = {"--r1": _as_read(self.r1, "mm"), "--r2": _as_read(self.r2, "mm")}
            for name, other in _OPTIONS.items():
                limit = limit.replace(name, f"{other} = {stated.get(other)}")
            raise InputError(option, stated.get(option, error.value), limit) from None

    def depths(self) -> tuple[float | None, float | None]:
        """Depths of the reference points of the approach, m; None: the centre."""
        first, second = (
            None if text is None else units.parse_or_bare(text, "mm", name)
            for text, name in ((self.depth1, "--depth1"), (self.depth2, "--depth2"))
        )
        return first, second

    def _line_load(self) -> float:
        """Line load, N/m, >= 0: stated, or load over width.

        Raises
        ------
        InputError
            If neither or both are stated, or it is negative; names the option.
        """
        if self.line_load is not None:
            if self.load is not None:
                raise InputError("--load", self.load, "left out beside --line-load")
            line_load = units.parse_or_bare(self.line_load, "N/mm", "--line-load")
        else:
            if self.load is None or (self.width is None and not self.lengths.stated):
                raise InputError("--line-load", "missing", "specified, or --load and --width")
            line_load = units.parse_or_bare(self.load, "N", "--load") / self._width()
        if not line_load >= 0:
            unit = "N/mm" if self.load is None else "N"
            text = self.load or self.line_load or ""
            raise InputError(
                "--line-load" if self.load is None else "--load",
                _as_read(text, unit),
                f">= 0 {unit}",
            )
        return line_load

    def _width(self) -> float:
        """Width of the contact, m, for the line load: as stated or, where lengths of the bodies
        are, the length on which both bodies are without ends.
        """
        if self.width is None:
            return self.lengths.contact_length()
        if self.lengths.stated:
            raise InputError("--width", _as_read(self.width, "mm"), "left out beside --length1")
        width = units.parse_or_bare(self.width, "mm", "--width")
        if not width > 0:
            raise InputError("--width", _as_read(self.width, "mm"), "> 0 mm")
        return width


def solved(
    options: ContactOptions, *, with_approach: bool = False, field: Path | None = None
) -> Document:
    """Line contact of two cylinders as a document, in mm, MPa and N: Hertz, finite elements or,
    where conforming, pin in a hole.

    Parameters
    ----------
    options : ContactOptions   of the command
    with_approach : bool       whether the approach of the bodies is computed
    field : Path               VTU file of the stresses to be written; None: none

    Raises
    ------
    InputError
        If an option is out of bounds.
    ContactError
        If the contact is outside the validity of all models.
    """
    start = time.perf_counter()
    pair = options.pair()
    document: Document = {
        "line_load_N_per_mm": in_unit(pair.line_load, "N/mm"),
        "contact_modulus_MPa": in_unit(pair.contact_modulus, "MPa"),
        "dundurs_beta": pair.dundurs_beta,
        "relative_radius_mm": in_unit(1.0 / pair.curvature, "mm"),
        "hertz": _figures(closed_form(pair)),
    }
    if is_conforming(pair):
        if field is not None:
            raise InputError("--field", str(field), "left out: the contact is conforming")
        if options.lengths.stated:
            raise InputError("--length1", "stated", "left out: the contact is conforming")
        document |= {"fe": None, "conforming": _conforming(conforming(pair), pair)}
    else:
        contact = finite_elements(pair)
        document |= {"fe": _finite_elements(contact), "finite_body": _finite_body(pair)}
        axial = None
        if options.lengths.stated:
            axial = finite_length(options.lengths, pair, options.depths())
            document["finite_length"] = axial.records()
        if field is not None and axial is not None:
            axial.write(field)
            document["field"] = str(field)
        elif field is not None:
            _write_field(field, contact, (pair.body_1.poisson, pair.body_2.poisson))
            document["field"] = str(field)
    if with_approach:
        document["approach_mm"] = in_unit(approach(pair, options.depths()), "mm")
    document["seconds"] = time.perf_counter() - start
    return document


def lines(document: Document) -> Iterator[str]:
    """Lines of text of a contact document."""
    fe, theory = document["fe"], document["hertz"]
    yield f"{'':18}{'Hertz':>14}{'' if fe is None else 'finite elements':>18}"
    for name, title in (
        ("p0_MPa", "peak pressure"), ("half_width_mm", "half-width"),
        ("tau_max_MPa", "shear in plane"), ("tau_depth_mm", "at depth"),
        ("von_mises_MPa", "von Mises"), ("von_mises_depth_mm", "at depth"),
        ("tau_max_all_planes_MPa", "shear, all planes"),
    ):  # fmt: skip
        if name in theory:
            unit = name.rpartition("_")[2]
            second = "" if fe is None else f"{fe.get(name, float('nan')):18.6g}"
            yield f"{title:18}{theory[name]:14.6g}{second} {unit}"
    if fe is not None:
        yield (
            f"error bar {fe['error_bar_percent']:.2g} %, {fe['dofs']} unknowns, "
            f"residual {fe['residual']:.1e}; stresses of body 1"
        )
        for name, share in document["finite_body"].items():
            yield f"{name.replace('_', ' ')} as a finite disc: {share:.3g} MPa more shear"
    else:
        yield document["conforming"]["why"]
        for name, title in (("persson", "Persson, equal materials"), ("numerical", "numerical")):
            solution = document["conforming"][name]
            if solution is not None:
                yield (
                    f"{title}: peak pressure {solution['p0_MPa']:.6g} MPa, "
                    f"half contact angle {solution['half_angle_deg']:.4g} deg"
                )
    if "finite_length" in document:
        yield from length_lines(document["finite_length"])
    if abs(beta := document["dundurs_beta"]) > _ZERO_DUNDURS:
        yield f"unlike materials, Dundurs' beta {beta:.4g}: pressure of a frictionless contact"
    if "approach_mm" in document:
        yield f"approach {document['approach_mm']:.6g} mm"
    yield f"{document['seconds']:.2f} s"


def _as_read(text: str, unit: str) -> str:
    """Text of an option as typed, for messages; with the unit in which it is read, `unit`, where it
    states none.
    """
    try:
        float(text)
    except ValueError:
        return units.rounded(text)
    return f"{units.rounded(text)} {unit}"


def _modulus(text: str, option: str) -> float:
    """Young's modulus, Pa; a number without a unit is in MPa where no other unit is plausible."""
    modulus = units.parse_or_bare(text, "MPa", option)
    try:
        number = float(text)
    except ValueError:
        return modulus
    readings = [
        each for each in ("MPa", "Pa", "GPa")
        if _MODULI[0] <= number * units.factor(each) <= _MODULI[1]
    ]  # fmt: skip
    if number > 0.0 and readings not in ([], ["MPa"]):
        shown_ = " or ".join(f'"{text.strip()} {each}"' for each in readings)
        raise InputError(option, text, f"stated with its unit, {shown_}")
    return modulus


def _radius(text: str, option: str) -> float:
    """Radius, m, not 0; infinite for a flat body, negative for a concave one."""
    if text.strip().lower() in ("inf", "+inf", "infinity", "flat"):
        return float("inf")
    radius = units.parse_or_bare(text, "mm", option)
    if radius == 0:
        raise InputError(option, text, "other than 0; inf: flat, negative: concave")
    return radius


def _figures(contact: LineContact) -> dict[str, float]:
    """Results of a contact in MPa and mm by key."""
    record = {
        "p0_MPa": in_unit(contact.p0, "MPa"),
        "half_width_mm": in_unit(contact.half_width, "mm"),
        "tau_max_MPa": in_unit(contact.tau_max, "MPa"),
        "tau_depth_mm": in_unit(contact.tau_depth, "mm"),
        "von_mises_MPa": in_unit(contact.von_mises, "MPa"),
        "von_mises_depth_mm": in_unit(contact.von_mises_depth, "mm"),
    }
    if contact.shear_any_plane > (1 + _SHEAR_EXCESS) * contact.tau_max:
        record["tau_max_all_planes_MPa"] = in_unit(contact.shear_any_plane, "MPa")
    return record


def _finite_elements(contact: FiniteElementContact) -> dict[str, float]:
    return {
        **_figures(contact.figures),
        "dofs": contact.dofs,
        "error_bar_percent": in_unit(contact.error_bar, "%"),
        "residual": contact.residual,
    }


def _finite_body(pair: TwoCylinders) -> dict[str, float]:
    """Increase of the in-plane shear of a disc over the half-plane, MPa, by body."""
    return {
        f"body_{number}": in_unit(float(hertz.disc_correction(pair.line_load, radius)), "MPa")
        for number, radius in ((1, pair.radius_1), (2, pair.radius_2))
        if 0 < radius < np.inf
    }


def _conforming(contact: ConformingContact, pair: TwoCylinders) -> Document:
    """Document of a solved pin in a hole: half contact angle and maximum pressure by Persson's
    closed form, None for materials of different elastic constants, and of the numerical solution,
    with the residual of its equilibrium.
    """

    def record(angle: float, p0: float) -> dict[str, float]:
        """Half contact angle, rad, and maximum pressure, Pa, in the units of the document."""
        return {"p0_MPa": in_unit(p0, "MPa"), "half_angle_deg": in_unit(angle, "deg")}

    persson = None
    if contact.persson_angle is not None and contact.persson_p0 is not None:
        persson = record(contact.persson_angle, contact.persson_p0)
    friction = "; friction is neglected" if pair.friction > 0 else ""
    return {
        "why": (
            f"half contact angle > {shown(HALF_ANGLE_MAX, 'deg', 3)}: no Hertz contact; "
            f"solved as a pin in a hole without friction{friction}"
        ),
        "persson": persson,
        "numerical": {**record(contact.angle, contact.p0), "residual": contact.residual},
    }


def _write_field(path: Path, contact: FiniteElementContact, poissons: tuple[float, float]) -> None:
    """Write the stresses of both bodies at the contact as a VTU file: body 1 below y = 0, body 2
    above.

    Parameters
    ----------
    path : Path                      of the file
    contact : FiniteElementContact   stresses at the points of both patches
    poissons : tuple                 Poisson's ratio of each body
    """
    from camwright.meshes.mesh_files import write_vtu

    meshes, fields = {}, {}
    for number, (nu, side, of) in enumerate(zip(poissons, (-1, 1), contact.stresses, strict=True)):
        mesh, order = patch_mesh(nu)
        name = f"body_{number + 1}"
        meshes[name] = _placed(mesh, contact.half_width_hertz, upward=side > 0)
        fields[name] = _fields(of[:, order], nu, side)
    write_vtu(path, meshes, fields)


def _placed(mesh: BodyMesh, size: float, *, upward: bool) -> BodyMesh:
    """Mesh of the contact patch in m; above y = 0 where `upward`, its triangles still
    counter-clockwise.

    Parameters
    ----------
    mesh : BodyMesh   lengths in half-widths, body below y = 0
    size : float      half-width, m
    """
    if not upward:
        return BodyMesh(mesh.points * size, mesh.triangles, {})
    points = mesh.points * np.array([[size], [-size]])
    return BodyMesh(points, mesh.triangles[[0, 2, 1, 5, 4, 3]], {})


def _fields(of: Array, poisson: float, side: int) -> dict[str, Array]:
    """Stress measures of a body in plane strain, MPa, (m,) by name.

    Parameters
    ----------
    of : array (3, m)   in-plane stresses xx, yy, xy, Pa, in the axes of the patch, y into the body
    poisson : float     Poisson's ratio
    side : int          sign of y of the file along the depth
    """
    xx, yy, xy = of
    in_si = {
        "stress_xx": xx,
        "stress_yy": yy,
        "stress_zz": poisson * (xx + yy),
        "stress_xy": side * xy,
        "von_mises": plane_stress_measures.von_mises(of, poisson),
        "tau_max": plane_stress_measures.shear_in_plane(of),
        "tau_max_all_planes": plane_stress_measures.shear_any_plane(of, poisson),
    }
    scale = units.factor("MPa")
    return {units.column(name, "MPa"): values / scale for name, values in in_si.items()}
