"""The strip chart of the limits, from the columns of a run."""

import numpy as np

from camwright.pipeline.base.tables import Table
from camwright.reports.analysis_sheet import BINDS, limits_strip
from camwright.reports.figure_svg import svg_of
from camwright.reports.interactive import specification
from camwright.reports.machine_words import words_of

ENGINE = words_of({}, 2.0)


def columns():
    theta = np.arange(360.0)
    return Table(
        {
            "cam_angle_deg": theta,
            "pressure_angle": 0.999 * np.abs(np.sin(np.radians(theta))),
            "roller_life": np.full(360, 0.999),
            "undercut": np.full(360, 0.2),
        }
    )


def test_strips_show_what_is_used_and_mark_where_it_binds():
    figure = limits_strip(columns(), 2.0, ENGINE)
    assert [panel.quantity for panel in figure.panels] == ["pressure angle", "roller life"]
    use, tight = (curve.y[:-1] for curve in figure.panels[0].curves)
    marked = np.flatnonzero(np.isfinite(tight))
    # 0.999 |sin| is above 0.997 within 3.6 deg of 90 and 270
    assert set(marked) == {*range(87, 94), *range(267, 274)}
    assert np.all(use[marked] >= BINDS)
    assert np.isfinite(figure.panels[1].curves[1].y).all()
    assert figure.panels[0].curves[0].x[-2] == 718.0


def test_strips_are_drawn_still_and_live():
    figure = limits_strip(columns(), 2.0, ENGINE)
    assert "roller life" in svg_of(figure)
    live = specification(figure)
    assert "pressure angle" in str(live["layout"])


def test_runs_without_a_record_have_no_strips():
    assert limits_strip(None, 2.0, ENGINE) is None
    unused = Table({"cam_angle_deg": np.arange(4.0), "undercut": np.full(4, 0.1)})
    assert limits_strip(unused, 2.0, ENGINE) is None
