"""Path of the centre of a milling cutter or grinding wheel that cuts the contour."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, positive, readonly
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError, in_millimetres
from camwright.geometry.interference import SecondContact, second_contact


class CutterPath(NamedTuple):
    """Path of the tool centre: cam angle, rad; centre (2, n), m; radius of curvature, m."""

    theta: Array
    centre: Array
    radius_of_curvature: Array


def cutter_path(contour: Contour, tool_radius: float, theta: Array) -> CutterPath:
    """Centre of a round tool in contact with the contour at the cam angles.

    Parameters
    ----------
    contour : Contour
    tool_radius : float     m, > 0; for the roller radius the path is the pitch curve
    theta : array (n,)      cam angle, rad

    Raises
    ------
    GeometryError
        If the tool is larger than the minimum concave radius, or the contour is undercut.

    References
    ----------
    Rothbart, Cam Design Handbook (2004), sec. 6.4: the cutter's centre as a parallel curve.
    """
    positive("tool.radius", tool_radius, "m")
    contour.require_no_undercut()
    concave = contour.concave_radius_min()
    if not tool_radius < concave.value:
        shown, least = in_millimetres(tool_radius, float(concave.value))
        raise GeometryError(
            f"tool.radius = {shown}, must be < {least}, "
            f"the minimum concave radius, at cam angle {np.degrees(concave.theta):.2f} deg"
        )
    centre = contour.points(theta) + tool_radius * contour.normal(theta)
    return CutterPath(
        readonly(theta),
        readonly(centre),
        readonly(contour.radius_of_curvature(theta) + tool_radius),
    )


def tool_interference(contour: Contour, tool_radius: float) -> SecondContact:
    """Minimum gap between a round tool on the contour and the contour away from their contact.

    The tool touches every point of the contour from outside; a negative gap is the depth to which
    it cuts another part, or its own neighbourhood where the concave radius is smaller.

    Parameters
    ----------
    contour : Contour
    tool_radius : float     m, > 0
    """
    positive("tool.radius", tool_radius, "m")

    def gap(contact: Array, other: Array) -> Array:
        centre = contour.points(contact) + tool_radius * contour.normal(contact)
        return np.asarray(np.hypot(*(contour.points(other) - centre)) - tool_radius)

    return second_contact(gap, len(contour.lift.theta))
