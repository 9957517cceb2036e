"""Path of the centre of a round cutter or grinding wheel along the contour."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, positive, readonly
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError


class CutterPath(NamedTuple):
    """Cam angle (n,) rad, centre of the tool (2, n) m, its path's radius of curvature (n,) m."""

    theta: Array
    centre: Array
    radius_of_curvature: Array


def cutter_path(contour: Contour, tool_radius: float, theta: Array) -> CutterPath:
    """Centre of a round tool that touches the contour at given cam angles.

    Parameters
    ----------
    contour : Contour
    tool_radius : float     m, > 0; that of the roller gives the pitch curve itself
    theta : array (n,)      cam angle, rad

    Raises
    ------
    GeometryError
        If the tool is too large for a hollow of the contour, or the contour is undercut.

    References
    ----------
    Rothbart, Cam Design Handbook (2004), sec. 6.4: the cutter's centre as a parallel curve.
    """
    positive("tool.radius", tool_radius, "m")
    contour.require_no_undercut()
    hollow = contour.concave_radius_min()
    if not tool_radius < hollow.value:
        raise GeometryError(
            f"tool.radius = {tool_radius:g} m, must be < {hollow.value:.6g} m, the radius of the "
            f"hollow at cam angle {np.degrees(hollow.theta):.2f} deg"
        )
    centre = contour.points(theta) + tool_radius * contour.normal(theta)
    return CutterPath(
        readonly(theta),
        readonly(centre),
        readonly(contour.radius_of_curvature(theta) + tool_radius),
    )
