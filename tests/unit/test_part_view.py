"""Shop drawing of the cam: the circle of its detail is about the surface and clear of the sizes."""

from __future__ import annotations

import numpy as np
import pytest

from camwright.pipeline.base.fits import Size
from camwright.reports.drawing.drawing_shapes import DrawnOutline, Text, circle
from camwright.reports.drawing.part_view import DrawnCam, GrooveView, StepView, Track, views


def drawn(thickness: float, groove: GrooveView | None) -> DrawnCam:
    contour = circle(44.0)
    size = Size(0.030)
    track = Track(thickness, ("sharp", 0.0), None)
    return DrawnCam(contour, None, None, thickness, size, None, None, None, "0.01", "A", "",
                    track, groove)  # fmt: skip


@pytest.mark.parametrize("thickness", [2.0, 6.0, 12.0, 18.0, 30.0, 60.0])
@pytest.mark.parametrize("depth", [0.0, 0.3, 0.8])
def test_the_circle_of_the_detail_is_about_the_surface_and_clear_of_the_sizes(thickness, depth):
    """About both edges of a disc, or about the walls and floor of a groove of a share of the
    thickness; text is outside of it, also that of the thickness.
    """
    steps = (StepView(circle(44.0), circle(92.0), 24.0, 24.0, depth * thickness),)
    groove = GrooveView(steps, 0.4, 120.0) if depth else None
    part = drawn(thickness, groove)
    (section,) = (group for group in views(part).groups if group.name == "section")
    rounds = [
        line for shape in section.shapes if isinstance(shape, DrawnOutline) for line in shape.lines
        if line.shape[1] > 20
    ]  # fmt: skip
    (ring,) = rounds
    middle, radius = ring.mean(axis=1), 0.5 * np.ptp(ring[0])
    texts = [shape for shape in section.shapes if isinstance(shape, Text)]
    assert {text.words for text in texts} == {"D", "C–C", f"{thickness:g}"}
    for text in texts:
        assert np.hypot(*(np.array(text.place) - middle)) > radius
