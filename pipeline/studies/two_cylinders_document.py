"""What `camwright contact` computes and prints: two cylinders, from text to a document."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.pipeline.base import units
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
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

_MM, _MPA = 1e3, 1e-6
# Relative excess of another plane's shear from which on it is worth a line.
_WORTH = 1e-3
_OPTIONS = {"radius_1": "--r1", "radius_2": "--r2", "friction": "--friction"}


@dataclass(frozen=True)
class Asked:
    """The command's options as text; a bare number is in mm, MPa, N/mm or N."""

    r1: str
    r2: str
    e1: str
    e2: str | None
    nu1: float
    nu2: float | None
    line_load: str | None = None
    load: str | None = None
    width: str | None = None
    friction: float = 0.0
    depth_1: str | None = None
    depth_2: str | None = None

    def pair(self) -> TwoCylinders:
        """The contact in SI.

        Raises
        ------
        InputError
            By the option's name.
        """
        first = Elastic(_quantity(self.e1, "MPa", "--e1"), self.nu1)
        second = Elastic(
            first.modulus if self.e2 is None else _quantity(self.e2, "MPa", "--e2"),
            self.nu1 if self.nu2 is None else self.nu2,
        )
        for number, body in ((1, first), (2, second)):
            if not body.modulus > 0:
                raise InputError(f"--e{number}", body.modulus, "> 0 Pa")
            if not 0 <= body.poisson < 0.5:
                raise InputError(f"--nu{number}", body.poisson, "in [0, 0.5)")
        radii = _radius(self.r1, "--r1"), _radius(self.r2, "--r2")
        load = self._line_load()
        try:
            return TwoCylinders(*radii, first, second, load, self.friction)
        except InputError as error:
            option = _OPTIONS.get(error.field, error.field)
            raise InputError(option, error.value, error.limit) from None

    def depths(self) -> tuple[float | None, float | None]:
        """Depths of the points whose approach is asked for, m."""
        first, second = (
            None if text is None else _quantity(text, "mm", name)
            for text, name in ((self.depth_1, "--depth1"), (self.depth_2, "--depth2"))
        )
        return first, second

    def _line_load(self) -> float:
        if self.line_load is not None:
            if self.load is not None:
                raise InputError("--load", self.load, "left out beside --line-load")
            found = _quantity(self.line_load, "N/mm", "--line-load")
        else:
            if self.load is None or self.width is None:
                raise InputError("--line-load", "missing", "given, or --load and --width")
            width = _quantity(self.width, "mm", "--width")
            if not width > 0:
                raise InputError("--width", width, "> 0 m")
            found = _quantity(self.load, "N", "--load") / width
        if not found >= 0:
            raise InputError("--line-load", found, ">= 0 N/m")
        return found


def solved(
    asked: Asked, *, with_approach: bool = False, field: Path | None = None
) -> dict[str, Any]:
    """Everything the command says, in mm, MPa and N.

    Raises
    ------
    InputError
        If an option is out of bounds.
    ContactError
        If the contact is beyond all theories here.
    """
    start = time.perf_counter()
    pair = asked.pair()
    document: dict[str, Any] = {
        "line_load_N_per_mm": pair.line_load / 1e3,
        "contact_modulus_MPa": _MPA * pair.contact_modulus,
        "relative_radius_mm": _MM / pair.curvature,
        "hertz": _figures(closed_form(pair)),
    }
    if is_conforming(pair):
        if field is not None:
            raise InputError("--field", str(field), "left out: the contact is no half-plane's")
        document |= {"fe": None, "conforming": _conforming(conforming(pair), pair)}
    else:
        found = finite_elements(pair)
        document |= {"fe": _finite_elements(found), "finite_body": _finite_body(pair)}
        if field is not None:
            _write_field(field, found, (pair.body_1.poisson, pair.body_2.poisson))
            document["field"] = str(field)
    if with_approach:
        document["approach_mm"] = _MM * approach(pair, asked.depths())
    document["seconds"] = time.perf_counter() - start
    return document


def lines(document: Mapping[str, Any]) -> Iterator[str]:
    """The document for people."""
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
            yield f"{name.replace('_', ' ')} as a finite disc would add {share:.3g} MPa of shear"
    else:
        yield document["conforming"]["why"]
        for name, title in (("persson", "Persson, bodies alike"), ("numerical", "numerical")):
            found = document["conforming"][name]
            if found is not None:
                yield (
                    f"{title}: peak pressure {found['p0_MPa']:.6g} MPa, "
                    f"half contact angle {found['half_angle_deg']:.4g} deg"
                )
    if "approach_mm" in document:
        yield f"approach {document['approach_mm']:.6g} mm"
    yield f"{document['seconds']:.2f} s"


def _quantity(text: str, unit: str, option: str) -> float:
    """SI value of a number, with a unit or in `unit`."""
    try:
        float(text)
    except ValueError:
        return units.parse(text, unit, option)
    return units.parse(f"{text.strip()} {unit}", unit, option)


def _radius(text: str, option: str) -> float:
    if text.strip().lower() in ("inf", "+inf", "infinity", "flat"):
        return float("inf")
    radius = _quantity(text, "mm", option)
    if radius == 0:
        raise InputError(option, text, "other than 0; inf for a flat, negative for a hollow")
    return radius


def _figures(found: LineContact) -> dict[str, float]:
    record = {
        "p0_MPa": _MPA * found.p0,
        "half_width_mm": _MM * found.half_width,
        "tau_max_MPa": _MPA * found.tau_max,
        "tau_depth_mm": _MM * found.tau_depth,
        "von_mises_MPa": _MPA * found.von_mises,
        "von_mises_depth_mm": _MM * found.von_mises_depth,
    }
    if found.shear_any_plane > (1 + _WORTH) * found.tau_max:
        record["tau_max_all_planes_MPa"] = _MPA * found.shear_any_plane
    return record


def _finite_elements(found: FiniteElementContact) -> dict[str, Any]:
    return {
        **_figures(found.figures),
        "dofs": found.dofs,
        "error_bar_percent": 100 * found.error_bar,
        "residual": found.residual,
    }


def _finite_body(pair: TwoCylinders) -> dict[str, float]:
    """In-plane shear, MPa, that a disc pressed along its diameter adds, by body."""
    return {
        f"body_{number}": _MPA * float(hertz.disc_correction(pair.line_load, radius))
        for number, radius in ((1, pair.radius_1), (2, pair.radius_2))
        if 0 < radius < np.inf
    }


def _conforming(found: ConformingContact, pair: TwoCylinders) -> dict[str, Any]:
    def record(angle: float, p0: float) -> dict[str, float]:
        return {"p0_MPa": _MPA * p0, "half_angle_deg": float(np.degrees(angle))}

    persson = None
    if found.persson_angle is not None and found.persson_p0 is not None:
        persson = record(found.persson_angle, found.persson_p0)
    friction = "; friction is left out" if pair.friction > 0 else ""
    return {
        "why": (
            f"half contact angle beyond {np.degrees(HALF_ANGLE_MAX):.0f} deg: no Hertz contact "
            f"any more, a pin in a hole without friction in its place{friction}"
        ),
        "persson": persson,
        "numerical": {**record(found.angle, found.p0), "residual": found.residual},
    }


def _write_field(path: Path, found: FiniteElementContact, poissons: tuple[float, float]) -> None:
    """Stress of both bodies around the contact as VTU: body 1 below y = 0, body 2 above."""
    from camwright.meshes.mesh_files import write_vtu

    meshes, fields = {}, {}
    for number, (nu, side, of) in enumerate(zip(poissons, (-1, 1), found.stresses, strict=True)):
        mesh, order = patch_mesh(nu)
        name = f"body_{number + 1}"
        meshes[name] = _placed(mesh, found.half_width_hertz, upward=side > 0)
        fields[name] = _fields(of[:, order], nu, side)
    write_vtu(path, meshes, fields)


def _placed(mesh: BodyMesh, size: float, *, upward: bool) -> BodyMesh:
    """The patch below y = 0 in its size; turned over, with the triangles' sense, for body 2."""
    if not upward:
        return BodyMesh(mesh.points * size, mesh.triangles, {})
    points = mesh.points * np.array([[size], [-size]])
    return BodyMesh(points, mesh.triangles[[0, 2, 1, 5, 4, 3]], {})


def _fields(of: Array, poisson: float, side: int) -> dict[str, Array]:
    """Stresses by name, MPa; `side` is the sense of the depth along y."""
    xx, yy, xy = of
    all_planes = plane_stress_measures.shear_any_plane((xx, yy, xy), poisson)
    return {
        "stress_xx_MPa": _MPA * xx,
        "stress_yy_MPa": _MPA * yy,
        "stress_zz_MPa": _MPA * poisson * (xx + yy),
        "stress_xy_MPa": side * _MPA * xy,
        "von_mises_MPa": _MPA * plane_stress_measures.von_mises((xx, yy, xy), poisson),
        "tau_max_MPa": _MPA * plane_stress_measures.shear_in_plane((xx, yy, xy)),
        "tau_max_all_planes_MPa": _MPA * all_planes,
    }
