"""Record of a crown design, and its text."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from camwright.pipeline.base.tables import table
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.records.crown_document import (
    CrownDocument,
    CrownDrop,
    CrownLengths,
    CrownLine,
    CrownShape,
    CrownState,
)
from camwright.pipeline.search.crown.crown_design import CrownDesign

_WORDS = {
    "johns_gohar": "Johns-Gohar",
    "lundberg": "Lundberg",
    "circular": "circular",
    "table": "relief of the ends",
}


def crown_record(design: CrownDesign) -> CrownDocument:
    """Record of a crown design."""
    chosen, centre, rows = design.chosen, design.centres, table(design.columns())
    return {
        "case": design.case.name,
        "on": design.on,
        "kind": design.kind,
        "ratio_limit": design.limit,
        "ratio": chosen.ratio,
        "ratio_straight": float(chosen.straight.max()),
        "crown": _shape_record(design),
        "lightest": _drop_record(design, design.chosen.lightest),
        "heaviest": _heaviest_record(design),
        "governing": _governing_record(design),
        "centre": {"straight": centre[0], "crowned": centre[1]},
        "life": design.lives,
        "tilt": [{"moment_factor": factor, "ratio": value} for factor, value in design.tilts],
        "tolerance": [
            {"deviation_um": in_unit(deviation, "um"), "ratio": _finite(value)}
            for deviation, value in design.deviations
        ],
        "lines": _lines_record(design),
        "drop_table": {name: [float(v) for v in values] for name, values in rows.columns.items()},
        "toml": design.text,
    }


def crown_lines(design: CrownDesign) -> Iterator[str]:
    """Lines of text on a crown design: crown, greatest pressure ratio and where, pressure at the
    centre, lives, range of the drop, sensitivity to tilt and to a deviation of the drop.
    """
    chosen, governing = design.chosen, _governing_record(design)
    shape, (before, after) = design.shape, design.centres
    if shape is None:
        yield f"{design.on}: no crown is needed"
    else:
        words = [f"{design.on}: {_WORDS[design.kind]}"]
        if shape.line_load is not None:
            words.append(f"design load {shown(shape.line_load, 'N/mm')}")
        if shape.radius is not None:
            words.append(f"radius {shown(shape.radius, 'mm')}")
        if design.kind == "table":
            straight = chosen.family.straight * chosen.family.length
            words.append(f"straight over {shown(straight, 'mm')}")
        yield f"{', '.join(words)}, drop {shown(chosen.drop, 'um', 3)} at the ends"
    yield (
        f"greatest pressure {chosen.ratio:.4f} of plane strain, at most {design.limit:g};"
        f" {float(chosen.straight.max()):.4f} without a crown"
    )
    yield (
        f"governs: {governing['load_case']}, cam angle {governing['cam_angle_deg']:.4g} deg,"
        f" {governing['force_N']:.4g} N, moment {governing['moment_Nmm']:.4g} N mm"
    )
    yield f"centre at the greatest load: {after:.4f} of plane strain, {before:.4f} without a crown"
    for each in design.lives:
        yield (
            f"life of the {each['body']}, {each['material']}: {each['crowned']:.3g}"
            f" of that of plane strain, {each['straight']:.3g} without a crown"
        )
    if not design.lives:
        yield "life: no material has a line of endurance"
    if shape is not None:
        yield _range_words(design)
    tilts = ", ".join(f"{value:.4f} at {factor:g}" for factor, value in design.tilts)
    yield f"greatest pressure by tilt, over the greatest moment of each angle: {tilts}"
    made = ", ".join(
        f"{value:.4f} at {in_unit(deviation, 'um'):+.3g} um"
        for deviation, value in design.deviations
    )
    yield f"greatest pressure by deviation of the drop at the ends: {made}"


def _range_words(design: CrownDesign) -> str:
    """Sentence on the range of drops at the ends of the crowns within the ratio, and whether
    deviations by the tolerance stay within the ratio.
    """
    chosen = design.chosen
    low = shown(chosen.family.drop(chosen.lightest), "um", 3)
    high = "more than those tried"
    if design.heaviest is not None:
        high = shown(chosen.family.drop(chosen.heaviest), "um", 3)
    kept = all(ratio <= design.limit for _, ratio in design.deviations)
    verb = "keep" if kept else "do not keep"
    place = "its least" if chosen.load == chosen.lightest else "in its middle"
    return (
        f"range of the crowns within the ratio: drop {low} to {high} at the ends, this one {place};"
        f" deviations of {shown(design.tolerance, 'um')} {verb} it"
    )


def _shape_record(design: CrownDesign) -> CrownShape | None:
    """The crown with its lengths in the units of its keys; None: straight."""
    chosen, shape = design.chosen, design.shape
    if shape is None:
        return None
    lengths: CrownLengths = {}
    if shape.line_load is not None:
        lengths["line_load_N_per_mm"] = in_unit(shape.line_load, "N/mm")
    if shape.radius is not None:
        lengths["radius_mm"] = in_unit(shape.radius, "mm")
    if design.kind == "table":
        straight = chosen.family.straight * chosen.family.length
        lengths["straight_length_mm"] = round(in_unit(straight, "mm"), 9)
    record: CrownShape = {
        "kind": design.kind,
        "drop_at_ends_um": in_unit(chosen.drop, "um"),
        **lengths,
        "length_mm": round(in_unit(chosen.family.length, "mm"), 9),
    }
    return record


def _heaviest_record(design: CrownDesign) -> CrownDrop | None:
    if design.heaviest is None:
        return None
    return _drop_record(design, design.chosen.heaviest)


def _drop_record(design: CrownDesign, load: float) -> CrownDrop:
    return {
        "line_load_N_per_mm": in_unit(load, "N/mm"),
        "drop_at_ends_um": in_unit(design.chosen.family.drop(load), "um"),
    }


def _governing_record(design: CrownDesign) -> CrownState:
    states, row = design.chosen.problem.states, design.governing
    return {
        "load_case": design.load_cases[int(states.load_case[row])],
        "cam_angle_deg": in_unit(float(design.theta[row]), "deg"),
        "force_N": float(states.force[row]),
        "moment_Nmm": in_unit(design.moment, "N mm"),
        "p0_MPa": in_unit(float(states.p0[row]), "MPa"),
    }


def _lines_record(design: CrownDesign) -> list[CrownLine]:
    """Axial pressure over plane strain at the governing state, aligned and under its moment."""
    return [
        {
            "crown": name,
            "tilted": tilted,
            "y_mm": [in_unit(float(y), "mm") for y in line.y],
            "pressure_over_plane_strain": [float(value) for value in line.factor],
        }
        for name, tilted, line in design.lines
    ]


def _finite(value: float) -> float | None:
    """A ratio, None where the crown leaves hardly any contact."""
    return value if np.isfinite(value) else None
