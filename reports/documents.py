"""Documents beside the page: sign-off sheet, PDF report, shop drawing, spreadsheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import read_json, write_atomic
from camwright.pipeline.base.fits import size_of
from camwright.pipeline.base.source import source_in
from camwright.pipeline.base.spreadsheets import SUFFIX, Excerpt, spreadsheet
from camwright.pipeline.base.tables import CAM_ANGLE
from camwright.pipeline.base.units import celsius, parse, rounded
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_records import RecordedCheck, of_records
from camwright.pipeline.results.run_reader import results_sha256
from camwright.reports import pdf
from camwright.reports.arrangement_data import arrangement_at
from camwright.reports.drawing.drawing_shapes import Drawing
from camwright.reports.drawing.part_view import (
    DrawnCam,
    GrooveView,
    StepView,
    Track,
    crown_words,
    scale_words,
    views,
)
from camwright.reports.report_content import Report, Signatures, report_content, verdict_of
from camwright.reports.report_data import ReportMaterial, title_block
from camwright.reports.report_tables import (
    DASH,
    CheckRow,
    Record,
    check_rows,
    number,
    quantity,
    shortened,
    words,
)
from camwright.reports.sheet_turn import beside_path
from camwright.reports.verdict_text import Verdict

SIGNOFF = "8_signoff.pdf"
PDF = "8_report.pdf"
MOST = 12
"""Checks in the table of safeties: those of the least safety."""
_LINE, _LONG, _CARD_MOST = 110, 330, 700
"""Characters of a fact, of the paragraphs below the facts, and of a material on the drawing, which
has all of any source that a case can state.
"""
_TEMPERATURES = (
    (("lubricant",), "lubricant"),
    (("spring", "design"), "spring"),
    (("roller", "bearing"), "roller bearing"),
)
DRAWING = "workshop/drawing.pdf"
_OTHERS = ("_outer", "_second")
"""Endings of the files of the second track: wall or disc."""
DIMENSIONS = {"": "workshop/dimensions.json", "_second": "workshop/dimensions_second.json"}
"""Dimensions of each disc, by the ending of its files."""
_MM = 1e3


@dataclass(frozen=True)
class Safety:
    """Safety factor of a check at its worst corner, with actual and required value."""

    title: str
    outcome: str
    actual: str
    required: str
    safety: str
    where: str


@dataclass(frozen=True, eq=False)
class SignoffSheet:
    """Contents of the sign-off sheet.

    block : sequence      title block; "" is a field to fill by hand
    facts : sequence      life, lubricant, temperatures, key figures
    first : sequence      scope, waivers and values to be confirmed, before the figures
    hashes : sequence     of case, results and source
    """

    kicker: str
    short_title: str
    verdict: Verdict
    block: Sequence[tuple[str, str]]
    drawing: Drawing
    facts: Sequence[tuple[str, str]]
    first: Sequence[tuple[str, str]]
    safeties: Sequence[Safety]
    others: str
    hashes: Sequence[tuple[str, str]]
    footer: str
    roles: Sequence[str] = Signatures.roles
    lines: Sequence[str] = Signatures.lines


def write_signoff(material: ReportMaterial) -> list[Path]:
    """Write the sign-off sheet.

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    content = pdf.typeset("signoff.typ", sheet_content(material))
    return [write_atomic(material.folder / SIGNOFF, content)]


@dataclass(frozen=True, eq=False)
class PrintedReport:
    """PDF report, whose first page is the sign-off sheet."""

    sheet: SignoffSheet
    report: Report


def write_report(material: ReportMaterial) -> list[Path]:
    """Write ``8_report.pdf``.

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    printed = PrintedReport(sheet_content(material), report_content(material))
    return [write_atomic(material.folder / PDF, pdf.typeset("report.typ", printed))]


def sheet_content(material: ReportMaterial) -> SignoffSheet:
    """Contents of the sign-off sheet of a run."""
    run, verdict = material.run, verdict_of(material)
    rows = [row for row in check_rows(run.final.checks) if row.must_have and not row.judged_at]
    records = {each.id: each for each in of_records(run.final.checks)}
    known = [row for row in rows
             if not row.evidence and records[row.id].utilisation is not None]  # fmt: skip
    summary = run.summary
    versions = summary["versions"]
    code = " · ".join(filter(None, (str(versions.get(k, "")) for k in ("camwright", "source"))))
    return SignoffSheet(
        "Cam sign-off" if run.verdict else "Cam, without sign-off",
        shortened(str(material.case.get("title") or summary["case"]), 110), verdict,
        title_block(material.case), arrangement_at(material.turn),
        list(_facts(material)), list(_first(verdict)),
        [_safety(row, records[row.id]) for row in known[:MOST]], _others(rows, known),
        [("case", str(summary["input_sha256"])), ("results", results_sha256(summary["files"])),
         ("Camwright", code)],
        f"Camwright · {shortened(str(summary['case']), 60)}",
    )  # fmt: skip


def _safety(row: CheckRow, check: RecordedCheck[CheckRecord]) -> Safety:
    """Row of a check in the table of safeties of the sign-off sheet; the safety is the reciprocal
    of the utilisation, a dash without a positive one.
    """
    used = check.utilisation
    safety = DASH if used is None or used <= 0.0 else number(1.0 / used, 3)
    actual = quantity(check.worst, str(check.record["unit"]))
    return Safety(shortened(row.title, 64), row.status.id, actual, row.limit, safety,
                  shortened(row.place, 34))  # fmt: skip


def _others(rows: Sequence[CheckRow], known: Sequence[CheckRow]) -> str:
    """Sentence with the number, by status, of the checks `rows` beyond those that the table shows,
    the first `MOST` of `known`; "" without any.
    """
    left = [row for row in rows if row not in known[:MOST]]
    counts = [
        (sum(row.status.id == status for row in left), text)
        for status, text in (("pass", "pass"), ("waived", "waived"), ("fail", "fail"),
                             ("not_evaluated", "lack data"))
    ]  # fmt: skip
    listed = ", ".join(f"{count} {text}" for count, text in counts if count)
    return f"Further required checks: {listed}." if listed else ""


def _facts(material: ReportMaterial) -> Iterator[tuple[str, str]]:
    """Pairs (name, value) of the sheet: load case, life, lubricant, temperatures, key figures."""
    case, checks = material.case, material.run.final.checks
    yield "Drawn load case", shortened(material.turn.load_case, 40)
    lives = [c for c in checks if c["unit"] == "h" and c["demand"] is not None]
    for check in lives[:4]:
        limit = "" if check["limit"] is None else f", required {quantity(check['limit'], 'h', 3)}"
        yield shortened(str(check["title"]), 44), f"{quantity(check['demand'], 'h', 3)}{limit}"
    if not lives:
        yield "Life in hours", "not evaluated"
    yield "Lubricant", shortened(_lubricant(case), _LINE)
    yield "Temperature", shortened(_temperatures(case) or "not stated", _LINE)
    head = material.run.summary["headline"]
    before, after = head.get("torque_std_before_Nm"), head.get("torque_std_after_Nm")
    if before is not None and after is not None:
        yield "Torque ripple", f"{number(before, 3)} to {quantity(after, 'N m', 3)}"
    if head.get("p0_max_MPa") is not None:
        yield "Peak contact pressure", quantity(head["p0_max_MPa"], "MPa")


def _lubricant(case: Record) -> str:
    """Viscosity of the oil with its source and lubrication of the roller bearing, in words."""
    oil = case.get("lubricant", {})
    viscosity = rounded(str(oil.get("viscosity", "")))
    parts = [*filter(None, (viscosity, str(source_in(oil.get("source")))))]
    bearing = case.get("roller", {}).get("bearing", {}).get("lubrication")
    parts = [*([f"roller bearing: {words(str(bearing))}"] if bearing else []), *parts]
    return ", ".join(parts) or "not stated"


def _temperatures(case: Record) -> str:
    """Temperatures in operation that the case states, in words."""
    stated = [("guides, ambient", case.get("guides", {}).get("ambient_temperature"))]
    for path, name in _TEMPERATURES:
        table: Record = case
        for key in path:
            table = table.get(key, {})
        stated.append((name, table.get("temperature")))
    return ", ".join(
        f"{name} {number(round(celsius(parse(value, 'K', name)), 6))} °C"
        for name, value in stated if value
    )  # fmt: skip


def _first(verdict: Verdict) -> Iterator[tuple[str, str]]:
    """Pairs (name, text) at the top of the sheet: scope, waivers, relaxed limits, values to be
    confirmed, the last cut to the room left.
    """
    scope = shortened(verdict.scope or "All parts are covered by this sign-off.", _LONG)
    waivers = shortened("; ".join(verdict.waived) or "none", _LONG)
    yield "Scope", scope
    yield "Waivers", waivers
    if verdict.relaxed:
        yield "Limits relaxed", shortened("; ".join(verdict.relaxed), _LONG)
    names, room = verdict.confirm, 3 * _LONG - len(scope) - len(waivers)
    listed = "; ".join(names)
    if len(listed) > room:
        shown = sum(len("; ".join(names[: k + 1])) <= room - 30 for k in range(len(names)))
        listed = f"{'; '.join(names[:shown])}; and {len(names) - shown} more"
    yield f"Values to be confirmed{f' ({len(names)})' if names else ''}", listed or "none"


# --- shop drawing


@dataclass(frozen=True, eq=False)
class ShopDrawing:
    """Contents of the shop drawing: a sheet for each disc."""

    short_title: str
    sheets: Sequence[DrawingSheet]
    results: str


@dataclass(frozen=True, eq=False)
class DrawingSheet:
    """Sheet of the shop drawing of one disc.

    radii : sequence   polar angle, deg, and radius, mm, as text
    swing : sequence   of an arm: cam angle, deg, radius, mm, and arm angle, deg, as text
    drops : sequence   title of each crown; axial coordinate, mm, and drop, um, as text
    block, facts       names and values of the title block; "" is a field to fill by hand
    """

    drawing: Drawing
    radii: Sequence[tuple[str, str]]
    extremes: Sequence[tuple[str, str]]
    swing: Sequence[tuple[str, str, str]]
    drops: Sequence[tuple[str, Sequence[tuple[str, str]]]]
    notes: Sequence[str]
    block: Sequence[tuple[str, str]]
    facts: Sequence[tuple[str, str]]


def write_drawing(material: ReportMaterial) -> list[Path]:
    """Write the shop drawing; none for a contour that encloses no body.

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    content = drawing_content(material)
    if content is None:
        return []
    return [write_atomic(material.folder / DRAWING, pdf.typeset("drawing.typ", content))]


def drawing_content(material: ReportMaterial) -> ShopDrawing | None:
    """Contents of the shop drawing of a run; None if its contour encloses no body.

    Raises
    ------
    ResultError
        If the dimensions of the run are not as `workshop_files` writes them.
    """
    sheets = []
    for end, name in DIMENSIONS.items():
        file = material.run.path / name
        if not file.is_file():
            continue
        record = read_json(file)
        try:
            sheets.append(_sheet(material, record, end))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise ResultError(f"{file}: {type(error).__name__}: {error}") from None
    if not sheets:
        return None
    title = shortened(str(material.case.get("title") or material.case["name"]), 100)
    results = results_sha256(material.run.summary["files"])
    return ShopDrawing(f"Drawing of the cam, {title}", sheets, results)


def _sheet(material: ReportMaterial, record: Record, end: str) -> DrawingSheet:
    """Sheet of a disc from the record of its dimensions, file `DIMENSIONS`: views, lists, notes,
    facts; end: of the files of the disc.
    """
    part, case = _part(material, record, end), material.case
    title = str(case.get("title") or case["name"])
    pair = (material.run.path / DIMENSIONS["_second"]).is_file()
    disc = f", disc {2 if end else 1} of 2" if pair else ""
    roughness, thickness = record["roughness_rq_um"], record["thickness_mm"]
    profile, hole = record["profile_tolerance_mm"], record["counter_hole"]
    facts = [
        ("Title", shortened(title, 110)), ("Case", shortened(str(case["name"]), 40) + disc),
        ("Thickness", quantity(thickness, "mm")),
        ("Card", shortened(record["material"], _CARD_MOST)),
        ("Hardness", shortened(record["hardness"], 60)),
        ("Roughness", "" if roughness is None else f"Rq {quantity(roughness, 'µm')}"),
        ("Scale", scale_words(part.scale)), ("General tolerances", ""),
    ]  # fmt: skip
    keyed = " Datum B: middle plane of the keyway; it sets angle zero." if part.keyway else ""
    notes = [
        f"Contour: workshop/contour{end}.dxf, layer cut, arcs within "
        f"{quantity(record['arc_error_um'], 'µm')}; points in contour{end}.csv.",
        f"Profile of a line, ISO 1101: zone {quantity(profile, 'mm')} wide, half of it to each "
        "side of the nominal contour.",
        f"Datum A: axis of the bore.{keyed}",
        "Angles grow counter-clockwise from the line marked 0°. In this view the cam turns "
        "clockwise.",
    ]
    if hole is not None:
        notes.append(
            f"Counter-hole of {quantity(2.0 * hole['radius_mm'], 'mm')} diameter through the cam "
            f"at x {quantity(hole['x_mm'], 'mm')}, y {quantity(hole['y_mm'], 'mm')}."
        )
    extremes = [
        (f"{which}, at {number(round(record[name]['polar_angle_deg'], 2) % 360.0)}°",
         f"{record[name]['radius_mm']:.4f}")
        for which, name in (("greatest", "radius_max"), ("least", "radius_min"))
    ]  # fmt: skip
    radii = [(f"{degrees}°", f"{radius:.4f}") for degrees, radius in record["radii_mm"].items()]
    if (groove := record.get("groove")) is not None:
        notes[0] = notes[0].replace("layer cut", "layer groove")
        notes.append(_groove_note(groove))
        outer = groove["outer_radii_mm"]
        radii = [(f"{at} in", inner) for (at, inner) in radii]
        radii += [(f"{degrees}° out", f"{radius:.4f}") for degrees, radius in outer.items()]
    notes += [
        f"{each[0].upper()}{each[1:].replace(' deg', '°')}."
        for each in record.get("second_track", ())
    ]
    notes.append(_mating(record["tracks"]))
    swing = _swing(record.get("arm"))
    if swing:
        notes += _pivot(record["arm"]), *(f"Follower: {each}." for each in record["arm"]["notes"])
    return DrawingSheet(
        views(part), radii, extremes, swing, list(_drops(record["tracks"])), notes,
        title_block(case), facts,
    )  # fmt: skip


def _swing(arm: Record | None) -> list[tuple[str, str, str]]:
    """Rows of the swing of an arm by cam angle, as text; none of a stem."""
    rows = {} if arm is None else arm["by_cam_angle"]
    return [
        (f"{degrees}°", f"{radius:.4f}", f"{angle:.4f}")
        for degrees, (radius, angle) in rows.items()
    ]


def _pivot(arm: Record) -> str:
    """Note on the pivot of an arm."""
    _, start = arm["by_cam_angle"]["0"]
    return (
        f"Follower: arm of {quantity(arm['length_mm'], 'mm')} from pivot to {arm['reference']}, "
        f"pivot {quantity(arm['centre_distance_mm'], 'mm')} from the cam axis; arm angle between "
        f"the lines from the pivot to the cam axis and along the arm, {start:.4f}° at cam angle "
        f"0°; outwards it swings {arm['swing']} the rotation of the cam. Cam angle: of the line to "
        "the pivot."
    )


def _part(material: ReportMaterial, record: Record, end: str) -> DrawnCam:
    """Disc to draw, from the contour of the run and the record of its dimensions; end: of its
    files.

    Lengths are in mm; the keyway is width, depth beyond the bore and angle in rad, the counter-hole
    centre x, y and radius.
    """
    contour = material.turn.contour
    keyway, hole, roughness = record["keyway"], record["counter_hole"], record["roughness_rq_um"]
    bore = size_of(record["bore"])
    width = depth = None
    if keyway is not None:
        width, depth = size_of(keyway["width"]), size_of(keyway["depth"])
    points = np.array([contour[f"{end[1:] and 'second_'}contour_{axis}_mm"] for axis in "xy"])
    return DrawnCam(
        points,
        None if width is None or depth is None else (
            _MM * width.nominal, _MM * (depth.nominal - bore.nominal),
            float(np.radians(keyway["angle_deg"])),
        ),
        None if hole is None else (hole["x_mm"], hole["y_mm"], hole["radius_mm"]),
        float(record["thickness_mm"]), bore, width, depth,
        None if keyway is None else keyway["root_radius_mm"],
        number(record["profile_tolerance_mm"]), str(record["datum"]),
        "" if roughness is None else number(roughness), _track(record["tracks"]["cam"]),
        _groove(material, points, record.get("groove")),
    )  # fmt: skip


def _groove(material: ReportMaterial, contour: Array, record: Record | None) -> GrooveView | None:
    """Groove to draw, lengths in mm; None without one.

    Parameters
    ----------
    contour : array (2, n)     wall on which the first roller runs
    record : mapping or None   groove in the record of the dimensions
    """
    wall, table = material.turn.outer_wall, material.turn.contour
    if record is None or wall is None:
        return None
    fillet, radius = (float(record[name]) for name in ("corner_radius_mm", "outer_radius_mm"))
    half = 0.5 * record["width_mm"]
    steps = [StepView(contour, wall, half, half, float(record["depth_mm"]))]
    if "steps" in record:
        steps = [
            StepView(beside_path(table, -inner), beside_path(table, outer), inner, outer, bottom)
            for bottom, inner, outer in (
                (float(step[f"{name}_mm"]) for name in ("bottom", "inner", "outer"))
                for step in record["steps"]
            )
        ]
    return GrooveView(tuple(steps), fillet, radius)


def _groove_note(record: Record) -> str:
    """Note on the groove: fit of its roller, and the files of its walls."""
    relieved, rollers = "", "roller"
    if "steps" in record:
        rollers = "rollers"
        relieved = (
            "the walls without a roller in contour_inner_relief.csv and contour_outer_relief.csv, "
            "paths of the cutter in cutter_inner_relief.csv and cutter_outer_relief.csv; "
        )
    return (
        f"Groove: the contour is its inner wall; outer wall in contour_outer.csv, inspection of "
        f"each in inspection.csv and inspection_outer.csv, paths of the cutter in cutter.csv and "
        f"cutter_outer.csv; {relieved}{rollers} with {quantity(record['clearance_mm'], 'mm')} "
        f"clearance, disc ⌀{number(2.0 * record['outer_radius_mm'])}."
    )


def _track(record: Record) -> Track:
    """Axial section of a running surface from its record; mm."""
    end, crown = record["end"], record["crown"]
    return Track(
        float(record["flat_width_mm"]),
        None if end is None else (str(end["kind"]), float(end["size_mm"])),
        None if crown is None else (
            np.array(crown["y_mm"], dtype=float), 1e-3 * np.array(crown["drop_um"], dtype=float)
        ),
    )  # fmt: skip


def _drops(tracks: Record) -> Iterator[tuple[str, Sequence[tuple[str, str]]]]:
    """Pairs (title, rows) of the crown of each running surface; a row is the axial coordinate, mm,
    and the drop there, um, as text.

    Parameters
    ----------
    tracks : mapping   records of the running surfaces by part
    """
    for word, record in tracks.items():
        crown = record["crown"]
        if crown is not None:
            rows = [(f"{y:.4g}", f"{drop:.3f}")
                    for y, drop in zip(crown["y_mm"], crown["drop_um"], strict=True)]  # fmt: skip
            yield f"Crown of the {word}, {crown_words(str(crown['kind']))}", rows


def _mating(tracks: Record) -> str:
    """Sentence on the running surface of the follower: flat width, ends, crown.

    Parameters
    ----------
    tracks : mapping   records of the running surfaces by part: the cam and roller or face
    """
    word, record = next((word, each) for word, each in tracks.items() if word != "cam")
    crown = record["crown"]
    shape = "straight" if crown is None else f"crown {crown_words(str(crown['kind']))}"
    flat = quantity(record["flat_width_mm"], "mm")
    return f"The {word} is flat over {flat}, {_track(record).end_words}, {shape}."


# --- spreadsheets


def write_tables(material: ReportMaterial) -> list[Path]:
    """Write the spreadsheets of a run beside its tables.

    Raises
    ------
    ResultError
        If a table cannot be read or a file not be written.
    """
    written = []
    for name, excerpt in _tables(material).items():
        task = material.ahead.get(name)
        file = material.run.path / name
        content = spreadsheet(file, excerpt) if task is None else task.result()
        written.append(write_atomic((material.folder / name).with_suffix(SUFFIX), content))
    return written


def begun(material: ReportMaterial, workers: Crew) -> dict[str, PendingCall]:
    """Spreadsheets submitted to worker processes, by table."""
    return {
        name: workers.submit(spreadsheet, material.run.path / name, excerpt)
        for name, excerpt in _tables(material).items()
    }


def _tables(material: ReportMaterial) -> dict[str, Excerpt | None]:
    """Tables of the run that people read; of the inspection sheet an excerpt to print."""
    # Crowns stand in the workbook of the inspection sheet.
    files: dict[str, Excerpt | None] = {
        f"{material.run.final.path.name}/5_cycle.csv": None,
        **dict.fromkeys(f"workshop/contour{end}.csv" for end in ("", *_OTHERS)),
        **{
            f"workshop/inspection{end}.csv": Excerpt("every 10 deg", CAM_ANGLE.header, 10.0, {})
            for end in _OTHERS
        },
        "workshop/inspection.csv": Excerpt(
            "every 10 deg",
            CAM_ANGLE.header,
            10.0,
            {f"crown of the {word}": f"crown_{word}.csv" for word in ("cam", "roller", "face")},
        ),
    }
    return {name: each for name, each in files.items() if (material.run.path / name).is_file()}
