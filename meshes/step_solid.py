"""STEP file of the cam: the outline with bore, keyway and counter-hole, extruded."""

from __future__ import annotations

import itertools
import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import numpy as np

from camwright.geometry.arrays import FULL_TURN, positive
from camwright.geometry.cad_drawing import Outline, clamped_spline
from camwright.geometry.cutouts import keyway_corners
from camwright.geometry.errors import GeometryError, MeshError, ResultError
from camwright.meshes.element_size import MILLIMETRE
from camwright.meshes.gmsh_mesher import session

_STEP_ERROR = 1e-8  # m; a smaller one only enlarges the file
_DATE = re.compile(rb"(FILE_NAME\('[^']*',\s*)'[^']*'")
_PRODUCT = re.compile(
    rb"PRODUCT\('Open CASCADE STEP translator \S+ \d+((?:\.\d+)*)',\s*'[^']*',\s*'',\s*"
)
_OCCURRENCE = re.compile(rb"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'")
_PIECES = 8
"""Splines of the contour; on longer ones the areas of the CAD kernel err by more than 1e-6."""


def write_step(path: Path, outline: Outline, width: float) -> None:
    """STEP file of the cam as one solid from z = 0 to its width, mm.

    Parameters
    ----------
    path
    outline : Outline
    width : float        m

    Raises
    ------
    GeometryError
        If the contour is undercut.
    MeshError
        If the CAD kernel rejects the outline.
    ResultError
        If the file cannot be written.
    """
    positive("cam.width", width, "m")
    outline.contour.require_no_undercut()
    try:
        with session() as gmsh:
            occ = gmsh.model.occ
            outer = occ.addCurveLoop(_contour_curves(occ, outline))
            hole = occ.addCurveLoop(_hole_curves(occ, outline))
            face = occ.addPlaneSurface([outer, hole, *_counter_hole(occ, outline)])
            occ.extrude([(2, face)], 0.0, 0.0, width / MILLIMETRE)
            occ.synchronize()
            with _without_stdout():
                gmsh.write(str(path))
    except (GeometryError, MeshError):
        raise
    except Exception as error:
        raise MeshError(
            f"outline of the solid = rejected by gmsh: {' '.join(str(error).split())}"
        ) from error
    if not path.is_file() or b"END-ISO-10303-21" not in path.read_bytes()[-200:]:
        raise ResultError(f"{path}: incomplete file")
    path.write_bytes(_reproducible(path.read_bytes()))


def _reproducible(text: bytes) -> bytes:
    """The same bytes for the same cam: a fixed date, names without the counters of the process."""
    count = itertools.count(1)
    text = _DATE.sub(rb"\g<1>'1970-01-01T00:00:00'", text, count=1)
    text = _PRODUCT.sub(rb"PRODUCT('cam\g<1>','cam\g<1>','',", text)
    return _OCCURRENCE.sub(lambda match: match[1] + b"'%d'" % next(count), text)


def _contour_curves(occ: ModuleType, outline: Outline) -> list[int]:
    """Contour as splines over equal parts of the turn with common end points."""
    seams = np.linspace(0.0, FULL_TURN, _PIECES + 1)
    corners = (outline.contour.points(seams[:-1]) / MILLIMETRE).T.tolist()
    ends = [occ.addPoint(x, y, 0.0) for x, y in corners]
    curves = []
    for k in range(_PIECES):
        spline = clamped_spline(outline.contour, _STEP_ERROR, seams[k], seams[k + 1])
        inner = [occ.addPoint(x, y, 0.0) for x, y in (spline.c[1:-1] / MILLIMETRE).tolist()]
        knots, repeats = np.unique(spline.t, return_counts=True)
        curves.append(
            occ.addBSpline(
                [ends[k], *inner, ends[(k + 1) % _PIECES]],
                degree=spline.k,
                knots=knots.tolist(),
                multiplicities=repeats.tolist(),
            )
        )
    return curves


def _hole_curves(occ: ModuleType, outline: Outline) -> list[int]:
    radius = outline.bore_radius / MILLIMETRE
    if outline.keyway is None:
        return [occ.addCircle(0.0, 0.0, 0.0, radius)]
    corners = keyway_corners(outline.bore_radius, outline.keyway) / MILLIMETRE
    points = [occ.addPoint(x, y, 0.0) for x, y in corners.T.tolist()]
    sides = [occ.addLine(points[k], points[k + 1]) for k in range(3)]
    # two arcs, since the kernel accepts none of half a turn or more
    centre = occ.addPoint(0.0, 0.0, 0.0)
    back = -corners.mean(axis=1) / np.hypot(*corners.mean(axis=1)) * radius
    far = occ.addPoint(back[0], back[1], 0.0)
    arcs = [
        occ.addCircleArc(points[3], centre, far),
        occ.addCircleArc(far, centre, points[0]),
    ]
    return [*sides, *arcs]


def _counter_hole(occ: ModuleType, outline: Outline) -> list[int]:
    """Loop of the counter-hole, if there is one."""
    if outline.counter_hole is None:
        return []
    x, y = (outline.counter_hole.centre / MILLIMETRE).tolist()
    return [occ.addCurveLoop([occ.addCircle(x, y, 0.0, outline.counter_hole.radius / MILLIMETRE)])]


@contextmanager
def _without_stdout() -> Iterator[None]:
    """Standard output closed: the CAD kernel prints regardless of gmsh's options."""
    sys.stdout.flush()
    kept = os.dup(1)
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(null)
        os.close(kept)
