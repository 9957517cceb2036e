"""Points on the arcs of a drawing file, and their distance from the surface that they stand for."""

import numpy as np

from camwright.geometry.arrays import uniform_turn


def arc_points(line) -> np.ndarray:
    """Points (2, n), mm, within the arcs of a polyline, three on each."""
    points = []
    for arc in line.virtual_entities():
        assert arc.dxftype() == "ARC"
        start, stop = arc.dxf.start_angle, arc.dxf.end_angle
        between = start + np.array([0.25, 0.5, 0.75]) * ((stop - start) % 360.0)
        points += [(each.x, each.y) for each in arc.vertices(between)]
    return np.array(points).T


def away_from(surface, points) -> float:
    """Greatest distance of points (2, n), mm, from a surface, mm, along its normals."""
    theta = uniform_turn(36_000)
    places, normal = 1e3 * surface.points(theta), surface.normal(theta)
    nearest = [int(np.hypot(*(places - at[:, None])).argmin()) for at in points.T]
    off = ((points - places[:, nearest]) * normal[:, nearest]).sum(axis=0)
    return float(np.abs(off).max())
