"""Workshop files: dimensions, contour table, drawing, solid, cutter path, inspection sheets."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import radians
from pathlib import Path
from types import MappingProxyType

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.cad_drawing import GrooveCut, Outline, StepCut, write_dxf
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import radius_at
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import CamError, InputError, ResultError
from camwright.geometry.form_closure import WALLS, Side, groove_wall
from camwright.geometry.second_track import OppositeFace, discs_of
from camwright.meshes.step_solid import write_step
from camwright.meshes.step_text import PartTitle, stamped
from camwright.pipeline.base.files import Json, json_text, read_text, write_atomic
from camwright.pipeline.base.fits import Size, keyway_depth_deviations, size_deviations
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.tables import CAM_ANGLE, Column, table
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.workshop_section import WorkshopOrder
from camwright.pipeline.contact.cam_body import CamGroove
from camwright.pipeline.cycle.cam_balance import drilled_hole
from camwright.pipeline.cycle.cycle import LIFT, PRESSURE_ANGLE

_INSPECTION = (
    "cam_angle_deg", "polar_angle_deg", "nominal_radius_mm", "nominal_x_mm", "nominal_y_mm",
    "normal_x", "normal_y", "deviation_min_mm", "deviation_max_mm",
    "measured_x_mm", "measured_y_mm", "deviation_mm",
)  # fmt: skip

WORKSHOP = "workshop"
SOLID, DRAWN = "cam{}.step", "contour{}.dxf"
DIMENSIONS = "dimensions{}.json"
"""Files of a disc, by the ending of its name."""
CROWN = "crown_{}.csv"
"""Drop of the crown of a body, by its word."""
_OUTER, _SECOND = "_outer", "_second"
_WALLS: Mapping[str, Side] = MappingProxyType({"": "inner", _OUTER: "outer"})
"""Walls of a groove by the ending of their files."""
_DISCS = MappingProxyType({"": "first", _SECOND: "second"})
"""Discs of a conjugate pair by the ending of their files."""
SECOND_TRACKS = _WALLS[_OUTER], _DISCS[_SECOND]
"""Tracks that pull the follower back, as measured."""
RADII_STEP = 10
"""deg, between the radii of the dimensions."""
_CROWN_SHARES = (0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)  # of half the flat
_RADII_POINTS = 36_000  # of the contour: its chords are within a nanometre


@dataclass(frozen=True)
class CamDimensions:
    """Dimensions of a cam, m, and the state of its material in words; "" if not stated.

    bore : Size               diameter
    keyway_width : Size       None without a keyway, as the others of the keyway
    keyway_depth : Size       from the opposite side of the bore to the floor
    root_radius : float       fillet at the floor of the keyway, None: not known
    profile_tolerance : float width of the zone of the contour
    """

    bore: Size
    keyway_width: Size | None
    keyway_depth: Size | None
    root_radius: float | None
    thickness: float
    material: str
    hardness: str
    roughness: float | None
    profile_tolerance: float

    @property
    def datum(self) -> str:
        """Datum of the contour: axis of the bore, middle plane of the keyway."""
        return "A" if self.keyway_width is None else "A-B"


def dimensions_of(case: Case) -> CamDimensions:
    """Dimensions of the cam of a case, with their tolerances, for drawing and record."""
    cam, shop = case.cam, case.workshop
    bore, keyway = 2.0 * cam.bore_radius, cam.keyway
    width = depth = None
    if keyway is not None:
        deviations = size_deviations(keyway.width, shop.keyway_fit)
        width = Size(keyway.width, shop.keyway_fit, deviations)
        depth = Size(bore + keyway.depth, "", keyway_depth_deviations(keyway.width))
    return CamDimensions(
        Size(bore, shop.bore_fit, size_deviations(bore, shop.bore_fit)),
        width, depth, cam.keyway_root_radius, cam.width,
        ", ".join(filter(None, (cam.material.name, " ".join(cam.material.condition.split())))),
        _hardness(cam.material), cam.roughness, cam.profile_tolerance,
    )  # fmt: skip


def made_surfaces(case: Case, contour: Contour) -> dict[str, Contour]:
    """Surfaces to make by the ending of their files: the contour, both walls of a groove, or the
    contours of both discs of a conjugate pair.

    The walls of a groove are half a clearance away from the roller on its nominal path. The second
    disc is smaller by the clearance of its roller, or larger by its interference.
    """
    cam = case.cam
    if cam.groove is not None:
        track = contour.require_roller()
        distances = zip(_WALLS.items(), cam.groove.carrying(track.roller_radius), strict=True)
        return {end: groove_wall(track, side, away) for (end, side), away in distances}
    discs = discs_of(contour, cam.second)
    contours = {end: each.contour for end, each in zip(_DISCS, discs, strict=False)}
    if cam.conjugate is not None:
        second = contours[_SECOND].require_roller()
        contours[_SECOND] = replace(second, roller_radius=second.roller_radius + cam.conjugate.gap)
    return contours


def relieved_walls(case: Case, contour: Contour) -> dict[str, Contour]:
    """Walls of a groove of two steps that stand back from its rollers, by the ending of their
    files; {} of other cams.
    """
    second, track = case.cam.on_pin, contour.require_roller() if contour.rolls else None
    if second is None or track is None:
        return {}
    distances = second.radius + second.relief, track.roller_radius + second.relief
    return {
        f"_{side}_relief": groove_wall(track, side, away)
        for side, away in zip(WALLS, distances, strict=True)
    }


def measured_surface(case: Case, contour: Contour, track: str | None) -> Contour:
    """Surface of a track: wall of a groove, "inner" or "outer", disc of a pair, "first" or
    "second"; of the first one where None.

    Raises
    ------
    InputError
        If the cam has no such track.
    """
    surfaces = made_surfaces(case, contour)
    names = _WALLS if _OUTER in surfaces else _DISCS
    tracks = {names[end]: each for end, each in surfaces.items()} if len(surfaces) > 1 else {}
    if track is None:
        return surfaces[""]
    if track not in tracks:
        raise InputError("--track", track, " or ".join(tracks) or "left out: the cam has one track")
    return tracks[track]


def real_cam(case: Case, contour: Contour, track: str | None, measured: Contour) -> Contour:
    """Contour under the first roller of a cam with the measured surface of one track; the other
    track matches it, but for the clearance.
    """
    second = case.cam.second
    path = measured.pitch
    if second is not None and track == _DISCS[_SECOND]:
        path = second.seen_from(contour).of(path).contour.pitch
    return replace(contour, pitch=path)


def groove_record(case: Case, contour: Contour) -> dict[str, Json] | None:
    """Groove for ``dimensions.json``: width, clearance, depth, fillet, radius of the disc and radii
    of the outer wall by polar angle, mm; None without a groove.
    """
    groove, walls = case.cam.groove, made_surfaces(case, contour)
    if groove is None:
        return None
    outer, radius = walls[_OUTER].polygon(_RADII_POINTS), case.roller.radius
    steps = groove.steps(radius)
    record: dict[str, Json] = {
        "width_mm": in_unit(steps[0].width, "mm"),
        "clearance_mm": in_unit(groove.clearance, "mm"),
        "depth_mm": in_unit(groove.depth, "mm"),
        "corner_radius_mm": in_unit(groove.corner_radius, "mm"),
        "outer_radius_mm": in_unit(groove.outer_radius, "mm"),
        "outer_radii_mm": {
            str(degrees): in_unit(radius_at(outer, radians(degrees)), "mm")
            for degrees in range(0, 360, RADII_STEP)
        },
    }
    if groove.second is not None:
        record["steps"] = [
            {f"{name}_mm": in_unit(getattr(step, name), "mm")
             for name in ("bottom", "inner", "outer")} for step in steps
        ]  # fmt: skip
    return record


def dimensions_record(case: Case, contour: Contour, end: str = "") -> dict[str, Json]:
    """Record of ``dimensions.json``: sizes, tolerances, material, radii by polar angle; in a
    groove those of the inner wall, and of the outer one in its record.

    Parameters
    ----------
    end : str   ending of the files of a disc, "" of the first one
    """
    groove, contour = groove_record(case, contour), made_surfaces(case, contour)[end]
    size, keyway, hole = dimensions_of(case), case.cam.keyway, drilled_hole(case.cam, contour)
    polygon = contour.polygon(_RADII_POINTS)
    record: dict[str, Json] = {
        "thickness_mm": in_unit(size.thickness, "mm"),
        "bore": size.bore.as_record(),
        "keyway": None,
        "counter_hole": None,
        "profile_tolerance_mm": in_unit(size.profile_tolerance, "mm"),
        "datum": size.datum,
        "roughness_rq_um": None if size.roughness is None else in_unit(size.roughness, "um"),
        "material": size.material,
        "hardness": size.hardness,
        "arc_error_um": in_unit(case.workshop.arc_error, "um"),
        "tracks": {word: track_record(case, word) for word in ("cam", case.facing.word)},
        "radii_mm": {
            str(degrees): in_unit(radius_at(polygon, radians(degrees)), "mm")
            for degrees in range(0, 360, RADII_STEP)
        },
        "arm": swing_record(case, contour, end),
        "second_track": list(second_track_notes(case, contour, end)),
    }
    if groove is not None:
        record["groove"] = groove
    if keyway is not None and size.keyway_width is not None and size.keyway_depth is not None:
        root = size.root_radius
        record["keyway"] = {
            "width": size.keyway_width.as_record(),
            "depth": size.keyway_depth.as_record(),
            "angle_deg": in_unit(keyway.angle, "deg"),
            "root_radius_mm": None if root is None else in_unit(root, "mm"),
        }
    if hole is not None:
        x, y = (in_unit(float(each), "mm") for each in hole.centre)
        record["counter_hole"] = {"x_mm": x, "y_mm": y, "radius_mm": in_unit(hole.radius, "mm")}
    for name, extreme in (
        ("radius_max", contour.radius_max()),
        ("radius_min", contour.radius_min()),
    ):
        x, y = contour.points(np.array([extreme.theta]))[:, 0]
        record[name] = {
            "radius_mm": in_unit(extreme.value, "mm"),
            "polar_angle_deg": float(np.round(np.degrees(np.arctan2(y, x)), 6) % 360.0),
        }
    return record


def swing_record(case: Case, contour: Contour, end: str = "") -> dict[str, Json] | None:
    """Record of the arm of an oscillating follower and its swing by cam angle; None of a stem.

    Rows of two numbers: distance of the reference point of the arm from the cam axis, mm, and angle
    at the pivot between the line to the cam axis and the arm, deg. On a second disc those of the
    second arm.
    """
    arm, degrees = case.follower.arm, np.arange(0.0, 360.0, RADII_STEP)
    theta, second = np.radians(degrees), case.cam.second
    angle = case.follower.arm_angle(contour.lift(theta), case.cam.prime_radius)
    if arm is None or angle is None:
        return None
    linkage = arm.linkage
    if end and second is not None:
        linkage = second.linkage(linkage)
        angle = np.asarray(linkage.angle(np.hypot(*contour.pitch.points(theta))))
    radius = np.asarray(linkage.radius(angle))
    return {
        "centre_distance_mm": in_unit(float(linkage.centre_distance), "mm"),
        "length_mm": in_unit(float(linkage.length), "mm"),
        "swing": "with" if linkage.sense > 0.0 else "against",
        "reference": case.facing.reference,
        "notes": list(_follower_notes(case)),
        "by_cam_angle": {
            f"{at:.0f}": [in_unit(float(r), "mm"), in_unit(float(psi), "deg")]
            for at, r, psi in zip(degrees, radius, angle, strict=True)
        },
    }


def second_track_notes(case: Case, contour: Contour, end: str = "") -> Iterator[str]:
    """Notes on the place of a disc of a conjugate pair, on its roller and its fit, or on the faces
    of a yoke; none of other cams.

    Parameters
    ----------
    end : str   ending of the files of the disc
    """
    cam, pair = case.cam, case.cam.conjugate
    if cam.yoke is not None:
        breadth = OppositeFace().track(contour.pitch).reach
        apart = shown(breadth + cam.yoke.clearance, "mm", 7)
        yield (
            f"yoke: breadth {shown(breadth, 'mm', 7)} between parallel planes at every angle; faces"
            f" {apart} apart, with {shown(cam.yoke.clearance, 'mm')} clearance"
        )
    if pair is None:
        return
    number, other = (1, 2) if end == "" else (2, 1)
    side = "towards" if end else "away from"
    yield (
        f"disc {number} of 2: disc {other} is {shown(pair.spacing, 'mm')} from it along the shaft"
        f" between their middles, {side} bearing 1; 0 deg between their lines of angle zero, seen"
        " from the same side"
    )
    radius = pair.roller_radius if end else case.roller.radius
    width = f"{shown(2.0 * radius, 'mm')} in diameter, {shown(case.roller.width, 'mm')} wide"
    yield f"roller of disc {number}: {width}"
    if pair.arm_angle is not None and pair.arm_length is not None:
        between = f"{shown(pair.arm_angle, 'deg', 6)} between the arms to both rollers"
        yield f"{between}, the second {shown(pair.arm_length, 'mm', 7)} long"
    elif pair.distance is not None:
        yield f"centres of both rollers {shown(pair.distance, 'mm', 7)} apart"
    word, size = ("clearance", "smaller") if pair.gap > 0.0 else ("interference", "larger")
    gap = shown(abs(pair.gap), "mm")
    yield f"{word} of the second roller {gap}, by which the contour of disc 2 is {size}"


def _follower_notes(case: Case) -> Iterator[str]:
    """Notes on face, rocker and linked spring of the follower."""
    for part in (case.facing, case.rocker, case.spring.link):
        if part is not None:
            yield from part.notes


def track_record(case: Case, word: str) -> dict[str, Json]:
    """JSON record of the axial profile of a running surface: width of its flat, ends, crown with
    drops over y from the middle of the body; null where not stated.

    Parameters
    ----------
    word : str   "cam", else the follower
    """
    part = case.cam if word == "cam" else case.facing
    end, crown = part.end, part.crown
    drops = None if crown is None else crown_drops(case, word)
    return {
        "flat_width_mm": in_unit(part.line_width, "mm"),
        "end": None if end is None else {"kind": end.kind, "size_mm": in_unit(end.size, "mm")},
        "crown": None if crown is None or drops is None else {
            "kind": crown.kind,
            "y_mm": [in_unit(y, "mm") for y in drops[0].tolist()],
            "drop_um": [in_unit(drop, "um") for drop in drops[1].tolist()],
        },
    }  # fmt: skip


def crown_drops(case: Case, word: str) -> tuple[Array, Array]:
    """Axial coordinates (k,), m, from the middle of a body, and drops (k,) of its crown there, m.

    Both sides of the flat, as far as the drop is stated and bounded.

    Parameters
    ----------
    word : str   body: "cam", "roller" or "face"
    """
    machine = machines(case)[0]
    crown = machine.crowns[word]
    half = 0.5 * (machine.cam if word == "cam" else machine.follower).line_width
    y = half * np.array([*(-share for share in _CROWN_SHARES[:0:-1]), *_CROWN_SHARES])
    stated = y[crown.is_stated(y)]
    return stated, crown.drop(stated)


def notes_of(case: Case, end: str = "") -> Iterator[str]:
    """Notes of the DXF file of a disc: identification, sizes, tolerances and material."""
    stated, size = part_title(case, end), dimensions_of(case)
    entries = (stated.name, stated.number, stated.revision and f"revision {stated.revision}")
    yield ", ".join(filter(None, entries))
    yield f"bore {size.bore.words}, thickness {shown(size.thickness, 'mm')}"
    if size.keyway_width is not None and size.keyway_depth is not None:
        yield f"keyway width {size.keyway_width.words}, depth {size.keyway_depth.words}"
    yield (
        f"contour within {shown(size.profile_tolerance, 'mm')} (profile of a line,"
        f" ISO 1101) to datum {size.datum}: axis of the bore"
        + ("" if size.keyway_width is None else ", middle plane of the keyway")
    )
    groove = case.cam.groove
    if groove is not None:
        yield from _groove_notes(case, groove)
    arm, start = case.follower.arm, case.follower.arm_angle(np.zeros(()), case.cam.prime_radius)
    if arm is not None and start is not None:
        lengths = (
            f"pivot {shown(arm.centre_distance, 'mm')} from the cam axis, {shown(arm.length, 'mm')}"
        )
        swing = f"arm at {shown(float(start), 'deg', 6)} to the cam axis at zero lift"
        ways = f"swings outwards {arm.swing} the rotation of the cam"
        yield f"{lengths} to the {case.facing.reference}; {swing}, {ways}"
    yield from _follower_notes(case)
    yield ", ".join(filter(None, (f"material {stated.material}", size.hardness)))
    yield "cam angles grow counter-clockwise from the marked line; the cam turns clockwise"


def _groove_notes(case: Case, groove: CamGroove) -> Iterator[str]:
    """Notes on a groove, its steps, rollers and disc."""
    second, steps = groove.second, groove.steps(case.roller.radius)
    radii = [case.roller.radius] if second is None else [case.roller.radius, second.radius]
    sizes = [
        f"{shown(step.width, 'mm', 7)} wide and {shown(step.bottom, 'mm')} deep" for step in steps
    ]
    rollers = "roller" if second is None else "rollers"
    yield (
        f"groove {', below '.join(sizes)}, fillets"
        f" {shown(groove.corner_radius, 'mm')} at its floor, {rollers}"
        f" {' on the inner and '.join(shown(2.0 * each, 'mm') for each in radii)}"
        f"{'' if second is None else ' on the outer wall'}"
        f" with {shown(groove.clearance, 'mm')}"
        f" clearance; disc {shown(2.0 * groove.outer_radius, 'mm')} in diameter"
    )
    if second is not None:
        yield (
            f"walls opposite to each roller {shown(second.relief, 'mm')} from it; middles of the"
            f" rollers {shown(second.spacing, 'mm')} apart along the pin"
        )
        under = float(second.under(case.roller.radius, groove.clearance))
        if under > 0.0:
            yield f"lower step cut {shown(under, 'mm')} under the wall above it: T-slot cutter"


def _hardness(material: Material) -> str:
    """Treatment, hardness and case depth of a material card in words; "" without any."""
    words = []
    if material.treatment is not None:
        words.append(material.treatment.replace("_", "-").replace("not-", "not "))
    if material.hardness_vickers is not None:
        words.append(f"{material.hardness_vickers:g} HV")
    if material.hardness_brinell is not None:
        words.append(f"{material.hardness_brinell:g} HB")
    if material.case_depth is not None:
        words.append(f"case depth {shown(material.case_depth, 'mm')}")
    return ", ".join(words)


def outline_of(case: Case, contour: Contour, end: str = "") -> Outline:
    """Contour, bore, keyway, counter-hole and groove of a disc of a case; end: of its files."""
    cam, surfaces, cut = case.cam, made_surfaces(case, contour), None
    if cam.groove is not None:
        cut = GrooveCut(_step_cuts(case, contour, surfaces), cam.groove.outer_radius)
    return Outline(surfaces[end], cam.bore_radius, cam.keyway, drilled_hole(cam, contour), cut)


def _step_cuts(
    case: Case, contour: Contour, surfaces: Mapping[str, Contour]
) -> tuple[StepCut, ...]:
    """Steps of a groove with their walls; of the surfaces the inner one where a roller runs."""
    groove, track = case.cam.groove, contour.require_roller()
    if groove is None:
        return ()
    inner = surfaces[""].require_roller()
    return tuple(
        StepCut(
            inner if step.inner == inner.roller_radius else groove_wall(track, "inner", step.inner),
            groove_wall(track, "outer", step.outer),
            step.bottom,
        )
        for step in groove.steps(track.roller_radius)
    )


def part_title(case: Case, end: str = "") -> PartTitle:
    """Product data of a disc in its STEP file; end: of its files."""
    stated = case.document
    disc = "" if case.cam.conjugate is None else f" disc {2 if end else 1}"
    return PartTitle(
        case.name + disc,
        number=f"{stated.part_number}{disc}" if stated.part_number else "",
        revision=stated.revision or "",
        project=stated.project or "",
        author=stated.author or "",
        material=stated.material or dimensions_of(case).material,
        date="" if stated.date is None else stated.date.isoformat(),
    )


def write_workshop(
    folder: Path,
    case: Case,
    contour: Contour,
    note: Callable[[str], None] = lambda _: None,
) -> None:
    """Write the files for the workshop: dimensions, drawing and solid of each disc, points, path of
    the cutter and inspection sheet of each surface, and crowns.

    A file that the contour does not allow, such as the path of a tool larger than the minimum
    concave radius, is left out; all others are written.

    Parameters
    ----------
    folder : Path       for the files
    case : Case         dimensions and tolerances
    contour : Contour   of the cam
    note : callable     told which file is left out, and why
    """
    folder.mkdir(parents=True, exist_ok=True)
    jobs: dict[str, Callable[[Path], object]] = {}
    surfaces = made_surfaces(case, contour)
    for end in _DISCS:
        if end in surfaces:
            jobs |= _jobs_of_disc(case, contour, end)
    for end, surface in surfaces.items():
        jobs |= _jobs_of(surface, end, case.workshop_order)
    for end, wall in relieved_walls(case, contour).items():
        every = _jobs_of(wall, end, case.workshop_order)
        jobs |= {name: job for name, job in every.items() if not name.startswith("inspection")}
    for word, part in (("cam", case.cam), (case.facing.word, case.facing)):
        if part.crown is not None:
            jobs[CROWN.format(word)] = partial(_write_crown, case, word)
    for name, write in jobs.items():
        try:
            write(folder / name)
        except ResultError:  # such as on a full disk
            raise
        except CamError as error:
            (folder / name).unlink(missing_ok=True)
            note(f"{WORKSHOP}/{name} is left out: {error}")


def _jobs_of_disc(case: Case, contour: Contour, end: str) -> dict[str, Callable[[Path], object]]:
    """How to write dimensions, drawing and solid of a disc, by file; end: of these."""
    outline, error = outline_of(case, contour, end), case.workshop_order.arc_error
    sizes = partial(dimensions_text, case, contour, end)
    notes = *notes_of(case, end), *second_track_notes(case, contour, end)
    return {
        DIMENSIONS.format(end): lambda path: write_atomic(path, sizes()),
        DRAWN.format(end): lambda path: write_dxf(path, outline, error, notes),
        SOLID.format(end): lambda path: write_step(
            path, outline, case.cam.width, part_title(case, end)
        ),
    }


def _jobs_of(
    contour: Contour, end: str, order: WorkshopOrder
) -> dict[str, Callable[[Path], object]]:
    """How to write the tables of a surface, by file: points, path of the cutter, inspection."""
    theta, tool = order.theta, order.tool_radius or contour.fitting_tool
    return {
        f"contour{end}.csv": lambda path: write_atomic(path, contour_table(contour, theta)),
        f"cutter{end}.csv": lambda path: write_atomic(path, cutter_table(contour, tool, theta)),
        f"inspection{end}.csv": lambda path: write_atomic(
            path, inspection_sheet(contour, theta, order.tolerance)
        ),
    }


def _write_crown(case: Case, word: str, path: Path) -> None:
    write_atomic(path, crown_sheet(*crown_drops(case, word)))


def stamp_solid(folder: Path, case_sha256: str, results_sha256: str) -> None:
    """Write the hashes of case and results into the headers of the STEP files, if any.

    The results are complete only after the solid was written; no hash covers the solid itself.
    """
    for end in _DISCS:
        file = folder / SOLID.format(end)
        if file.is_file():
            write_atomic(file, stamped(read_text(file), case_sha256, results_sha256))


def dimensions_text(case: Case, contour: Contour, end: str = "") -> str:
    """JSON of the dimensions of a disc; GeometryError for an undercut contour."""
    made_surfaces(case, contour)[end].require_no_undercut()
    return json_text(dimensions_record(case, contour, end)) + "\n"


def contour_table(contour: Contour, theta: Array) -> str:
    """CSV text of contour, normal, curvature, pressure angle, lift and its derivatives, a row for
    each cam angle `theta` (n,), rad.
    """
    x, y = contour.points(theta)
    normal = contour.normal(theta)
    lift = contour.pitch.lift.derivatives(theta, 3)
    derivatives = {
        Column(f"lift_d{k}", f"mm/rad{'' if k == 1 else f'^{k}'}"): lift[k] for k in (1, 2, 3)
    }
    return table(
        {
            CAM_ANGLE: theta,
            Column("polar_angle", "deg"): np.mod(np.arctan2(y, x), 2 * np.pi),
            Column("radius", "mm"): np.hypot(x, y),
            Column("x", "mm"): x,
            Column("y", "mm"): y,
            Column("normal_x"): normal[0],
            Column("normal_y"): normal[1],
            Column("curvature", "1/mm"): contour.curvature(theta),
            PRESSURE_ANGLE: contour.pitch.pressure_angle(theta),
            LIFT: lift[0],
            **derivatives,
        }
    ).to_csv()


def cutter_table(contour: Contour, tool_radius: float, theta: Array) -> str:
    """CSV of the path of the tool centre in the cam frame."""
    path = cutter_path(contour, tool_radius, theta)
    return table(
        {
            CAM_ANGLE: path.theta,
            Column("x", "mm"): path.centre[0],
            Column("y", "mm"): path.centre[1],
            Column("path_radius", "mm"): path.radius_of_curvature,
            Column("tool_radius", "mm"): np.full(theta.size, tool_radius),
        }
    ).to_csv()


def inspection_sheet(contour: Contour, theta: Array, tolerance: float) -> str:
    """CSV text of nominal points of the contour with the tolerance band along the normal, mm, and
    empty columns for what is measured.

    Parameters
    ----------
    contour : Contour    of the cam
    theta : array (n,)   cam angles of the points, rad
    tolerance : float    width of the zone of the profile, m: half of it to either side
    """
    x, y = contour.points(theta) * 1e3
    normal = contour.normal(theta)
    polar = np.degrees(np.mod(np.arctan2(y, x), 2 * np.pi))
    half = np.full(theta.size, 0.5e3 * tolerance)
    angle = np.round(np.degrees(theta), 10)
    columns = (angle, polar, np.hypot(x, y), x, y, normal[0], normal[1], -half, half)
    rows = [
        ",".join([*(repr(float(value) + 0.0) for value in row), "", "", ""])
        for row in zip(*columns, strict=True)
    ]
    return "\n".join([",".join(_INSPECTION), *rows]) + "\n"


def crown_sheet(y: Array, drop: Array) -> str:
    """CSV of a crown's nominal drop at axial coordinates, with empty measured columns.

    Its first two columns are those of the table of a crown in a case.
    """
    unknown = np.full(y.size, np.nan)
    return table(
        {
            Column("y", "mm"): y,
            Column("drop", "um"): drop,
            Column("measured_drop", "um", unknown=True): unknown,
            Column("deviation", "um", unknown=True): unknown,
        }
    ).to_csv()
