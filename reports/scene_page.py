"""Interactive 3-D view of cam and follower over the turn, a self-contained page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, rotation
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.envelope import Sleeve
from camwright.pipeline.base.files import Json, read_npz, write_atomic
from camwright.pipeline.base.tables import Table
from camwright.pipeline.results.field_file import EndField, read_end_field
from camwright.reports import scene_arm, scene_second, stress_map
from camwright.reports.arrangement_data import mechanism_of, pulling_at
from camwright.reports.drawing.arrangement import DrawnArm, DrawnMechanism
from camwright.reports.interactive import script_safe_json, scripts
from camwright.reports.page import environment
from camwright.reports.pressure_figures import Record
from camwright.reports.report_data import ReportMaterial
from camwright.reports.report_tables import ROUND_OFF_DEG
from camwright.reports.scene_groove import SceneGroove, scene_groove
from camwright.reports.scene_solids import (
    Lattice,
    Solid,
    box,
    fork,
    joined,
    pin,
    ring,
    rod,
    sector,
    tube,
    unit_circle,
)
from camwright.reports.sheet_turn import SheetTurn

FILE = "scene.html"
TURN, ENDS = Path("fields") / "turn.npz", Path("fields") / "ends.vtu"
_NAMES = (
    *("cycle_row", "cam_angle_deg", "cam_outline_mm", "follower_nodes_mm"),
    *("follower_origin_mm", "follower_rotation_deg"),
)
MAP = "von_mises_MPa"
_DIGITS = 5
# Over half the greatest width of contact: width and depth of the blocks shown, half their distance.
_BESIDE, _APART = 2.5, 0.5
_STRETCHED = 0.3  # width and depth over the length, as drawn
_ARC, _PROUD = 29, 0.01  # points of the arc of a counterweight; mm of a mouth before its face
_HERE = Path(__file__).parent
_SCRIPTS = (_HERE / "vendor" / "plotly-gl3d.min.js", _HERE / "templates" / "scene.js")
_READOUT = (
    ("lift", "lift_mm", "mm"), ("normal force", "normal_force_N", "N"),
    ("peak pressure p0", "p0_fe_MPa", "MPa"), ("half-width", "half_width_fe_mm", "mm"),
    ("pressure angle", "pressure_angle_deg", "deg"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class TurnView:
    """Outlines and poses of both bodies at f cam angles of one load case.

    position (f,) rows of the cycle; angle (f,) deg; contour and bore (2, stations), mm, in the
    frame of the cam; follower (2, n), mm, points of the follower in its own frame, which has its
    origin (f, 2), mm, in the frame of the cam and is turned by turn (f,), rad.
    """

    load_case: str
    position: NDArray[np.int64]
    angle: Array
    contour: Array
    bore: Array
    follower: Array
    origin: Array
    turn: Array

    @property
    def is_roller(self) -> bool:
        """Whether the follower is a roller, which has a hole; a face has none."""
        return bool(np.hypot(*self.follower).min() > 0.05 * np.hypot(*self.follower).max())

    @property
    def to_lab(self) -> Array:
        """Rotation (f,), rad, of the cam in the frame in which the follower moves along +y."""
        return 0.5 * np.pi - np.radians(self.angle)

    def lab_origin(self) -> Array:
        """Origin (2, f), mm, of the follower in the frame of the guides, motion along +y."""
        cosine, sine = np.cos(self.to_lab), np.sin(self.to_lab)
        x, y = self.origin.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y])

    def arc(self) -> Array:
        """Arc length (f,) of the contour from the first angle, mm, by chords."""
        steps = np.hypot(*np.diff(self.contour, axis=1, append=self.contour[:, :1]))
        along = np.r_[0.0, np.cumsum(steps)]
        return np.interp(self.angle, np.linspace(0.0, 360.0, along.size), along)


def read_turn_view(folder: Path) -> TurnView:
    """Recorded turn of a run.

    Raises
    ------
    ResultError
        If the file is missing, as under a contour that encloses no body, or unreadable.
    """
    path = folder / TURN
    if not path.is_file():
        raise ResultError(f"{path}: no such file; run the case again to write it")
    entry = read_npz(path)
    try:
        arrays = {name: entry[name] for name in (*_NAMES, "load_case")}
    except KeyError as error:
        raise ResultError(f"{path}: {error}") from None
    return TurnView(
        str(arrays["load_case"]), arrays["cycle_row"], arrays["cam_angle_deg"],
        arrays["cam_outline_mm"][:, :, 0], arrays["cam_outline_mm"][:, :, -1],
        arrays["follower_nodes_mm"], arrays["follower_origin_mm"],
        np.radians(arrays["follower_rotation_deg"]),
    )  # fmt: skip


def write(material: ReportMaterial) -> Sequence[Path]:
    """Write ``scene.html``; none for a run without a recorded turn."""
    try:
        view = read_turn_view(material.run.path)
    except ResultError:
        return []
    own, hashes = scripts(_SCRIPTS)
    data = scene(material, view)
    text = environment().get_template("scene.html").render(
        title=str(material.case.get("title") or material.run.summary["case"]),
        load_case=view.load_case,
        last=view.angle.size - 1,
        scripts=own,
        hashes=hashes,
        ends=data["ends"],
        data=Markup(script_safe_json(data)),  # noqa: S704 - no "<" is left in it
    )  # fmt: skip
    return [write_atomic(material.folder / FILE, text.encode("utf-8", "replace"))]


def scene(material: ReportMaterial, view: TurnView) -> dict[str, Json]:
    """Data of the page: triangulated bodies, mm, poses, values at each angle.

    The axis of the cam is z; the follower moves along y.
    """
    turn = material.turn
    width = turn.length("cam", "width") or 5.0
    lab = view.lab_origin()
    rows = material.run.final.cycle.of_load_case(view.load_case)
    mechanism = mechanism_of(turn)
    groove, middle = None, 0.0
    if mechanism.groove is not None:
        groove = scene_groove(turn, mechanism.groove, view.contour, view.bore, width)
        middle, width = groove.middle, groove.roller
    faces = _cam(view, width) if groove is None else groove.disc()
    carried = [faces, *(each.deeper(middle) for each in _counterweight(mechanism))]
    flank = _flank(material, view, width) if groove is None else _walls(material, view, groove)
    bodies = {"flank": flank, "cam": joined(carried).as_record(_DIGITS)}
    holes = [ring(view.bore, width), *_drilled(mechanism, width)]
    bodies["bore"] = (joined(holes) if groove is None else groove.hole()).as_record(_DIGITS)
    arm = mechanism.arm
    end = mechanism.stem_end - mechanism.lowest if arm is None else arm.length
    stem = mechanism.stem if arm is None else 2.0 * arm.half
    lean, follower = None, _follower(view, width, stem, end)
    if arm is not None:
        lean = arm.turn(rows["lift_mm"][view.position])
        if not view.is_roller:
            lean, follower = view.to_lab + view.turn - np.pi, _face_on_arm(view, width, arm)
    if groove is not None:
        follower = groove.follower(stem, end, _pin_radius(view))
    pair = scene_second.carrier(mechanism, width, _pin_radius(view))
    bodies["follower"] = (pair or follower).as_record(_DIGITS)
    bodies["guide"] = _frame(
        mechanism, middle, 0.0 if groove is None else groove.cheek[0]
    ).as_record(_DIGITS)
    lifts = rows["lift_mm"][view.position]
    envelope = mechanism.envelope
    spin = view.arc() / float(np.hypot(*view.follower).max()) if view.is_roller else 0.0
    return {
        "bodies": bodies,
        "roller": _roller(view, width) if view.is_roller else None,
        "angle": _rounded(view.angle),
        "turn": _rounded(view.to_lab),
        "origin": [_rounded(part) for part in lab],
        "facing": _rounded(view.to_lab + view.turn + spin),
        "lean": None if lean is None else _rounded(lean),
        "moving": [
            *([] if groove is None else groove.moving(view.angle, lab, _DIGITS)),
            *scene_arm.moving(mechanism, lifts, width, _DIGITS),
            *scene_second.moving(
                mechanism,
                view.bore,
                (lifts, view.to_lab),
                width,
                _DIGITS,
                _second_disc(material, view),
            ),
        ],
        "contact": [
            _rounded(part) for part in _carried(turn, view, rows, _contacts(view, lab, arm))
        ],
        "half": width / 2,
        "readout": [
            {"words": words, "unit": unit, "values": _shown(rows[name][view.position], unit)}
            for words, name, unit in _READOUT
            if name in rows
        ],
        "shaft": turn.words.shaft,
        "ratio": float(rows["crank_angle_deg"][1] / rows["cam_angle_deg"][1]),
        "reach": {
            "side": float(np.abs(envelope.across).max()),
            "low": -float(envelope.along[0]),
            "top": float(envelope.along[1]),
            "deep": float(np.abs(envelope.depth).max()) + abs(middle),
        },
        "ends": _ends(material),
    }


def _carried(turn: SheetTurn, view: TurnView, rows: Table, first: Array) -> Array:
    """Contact points (3, f), mm, on the track that carries, third the place of its disc along the
    shaft; first : array (2, f), on the first track.
    """
    pulling, second = pulling_at(turn, view.angle), mechanism_of(turn).second
    level = np.zeros(view.angle.size)
    if pulling is None or second is None:
        return np.vstack([first, level])
    pulls = rows["wall"][view.position] < 0.0
    return np.where(
        pulls, np.vstack([pulling[0], level + second.spacing]), np.vstack([first, level])
    )


def _flank(material: ReportMaterial, view: TurnView, width: float) -> Json:
    """Record of the flank for the page, with the maximum von Mises stress of the turn below each
    point of the contour, MPa, where it is known.
    """
    count = view.contour.shape[1]
    record = ring(view.contour, width).as_record(_DIGITS)
    stresses = _by_track(material, view, count)
    if stresses is None:
        return record
    greatest, second = stresses
    if second is not None and material.turn.second_disc is None:  # the other face half a turn on
        greatest = np.maximum(greatest, np.roll(second, count // 2))
    words = _stress_words("", greatest)
    return record | {"values": _rounded(np.tile(greatest, 2)), "words": words * 2}


def _second_disc(material: ReportMaterial, view: TurnView) -> tuple[list[float], list[str]] | None:
    """Maximum von Mises stress of the turn at the points of the second disc, MPa, and its words;
    None where not known.
    """
    stresses = None
    if material.turn.second_disc is not None:
        stresses = _by_track(material, view, view.contour.shape[1])
    if stresses is None or stresses[1] is None:
        return None
    return _rounded(stresses[1]), _stress_words("second disc, ", stresses[1])


def _walls(material: ReportMaterial, view: TurnView, groove: SceneGroove) -> Json:
    """Record of both walls of a groove for the page, with the maximum von Mises stress of the turn,
    MPa, at points where their wall carries and 0 elsewhere; without stresses where they are not
    known.
    """
    record = groove.walls().as_record(_DIGITS) | {"loops": 4}
    stresses = _by_track(material, view, groove.inner.shape[1])
    if stresses is None or stresses[1] is None:
        return record
    values: list[Array] = []
    words: list[str] = []
    for name, stress in (("inner", stresses[0]), ("outer", stresses[1])):
        values += 2 * [stress]
        words += 2 * _stress_words(f"{name} wall, ", stress)
    return record | {"values": _rounded(np.concatenate(values)), "words": words}


def _stress_words(name: str, stress: Array) -> list[str]:
    """Words on the stress (n,), MPa, at equal cam angles; name: of the surface."""
    angle = np.linspace(0.0, 360.0, stress.size, endpoint=False)
    return [f"{name}cam {a:.1f}°: {v:.4g} MPa" for a, v in zip(angle, stress, strict=True)]


def _by_track(
    material: ReportMaterial, view: TurnView, stations: int
) -> tuple[Array, Array | None] | None:
    """Maximum von Mises stress, MPa, at equal cam angles (stations,) on the first and the second
    track, 0 where the other one carries, of preloaded discs less in proportion to its pressure;
    second None of one track, and None without a map.
    """
    greatest = _greatest(material, view, stations)
    rows = material.run.final.cycle.of_load_case(view.load_case)
    if greatest is None or "wall" not in rows:
        return None if greatest is None else (greatest, None)
    angle = np.linspace(0.0, 360.0, stations, endpoint=False)
    first, second = shares_of_tracks(rows, angle)
    return first * greatest, second * greatest


def shares_of_tracks(rows: Table, angle: Array) -> tuple[Array, Array]:
    """Contact pressure of the first and the second track over the greater of both at cam angles
    (n,), deg: 1 where a track carries alone, and 0 on the other.
    """
    at, wall = rows["cam_angle_deg"], rows["wall"]
    if "idle_p0_hertz_MPa" not in rows:
        carries = np.sign(np.interp(angle, at, wall, period=360.0))
        return np.asarray(1.0 * (carries == 1.0)), np.asarray(1.0 * (carries == -1.0))
    more, less = rows["p0_hertz_MPa"], rows["idle_p0_hertz_MPa"]
    pressures = np.where(wall > 0.0, more, less), np.where(wall > 0.0, less, more)
    first, second = (np.interp(angle, at, each, period=360.0) for each in pressures)
    greater = np.maximum(first, second)
    divisor = np.where(greater > 0.0, greater, 1.0)
    return np.asarray(first / divisor), np.asarray(second / divisor)


def _greatest(material: ReportMaterial, view: TurnView, stations: int) -> Array | None:
    """Maximum von Mises stress below each of `stations` points of the contour at equal cam angles,
    MPa; None without a map.
    """
    try:
        envelope = stress_map.read_envelope(
            material.run.final.path / stress_map.FILE, view.load_case
        )
    except ResultError:
        return None
    solved = np.isfinite(envelope[MAP]).any(axis=1)
    if not solved.any():
        return None
    angle = np.linspace(0.0, 360.0, stations, endpoint=False)
    greatest = np.nanmax(envelope[MAP][solved], axis=1)
    return np.interp(angle, envelope["cam_angle_deg"][solved], greatest, period=360.0)


def _cam(view: TurnView, width: float) -> Solid:
    """Both end faces of the cam."""
    return joined([tube(view.contour, view.bore, side * width / 2) for side in (-1, 1)])


def _counterweight(mechanism: DrawnMechanism) -> list[Solid]:
    """Sector of the counterweight, which turns with the cam, as a list; [] without one."""
    weight = mechanism.counterweight
    if weight is None:
        return []
    angles = weight.angle + weight.half * np.linspace(-1.0, 1.0, _ARC)
    return [sector(angles, (weight.inner, weight.outer), weight.width).deeper(weight.position)]


def _drilled(mechanism: DrawnMechanism, width: float) -> list[Solid]:
    """Wall of the hole that balances the cam, and its mouth on both faces; [] without one."""
    if mechanism.counter_hole is None:
        return []
    x, y, radius = mechanism.counter_hole
    outline = radius * unit_circle() + np.array([[x], [y]])
    middle = np.broadcast_to(np.array([[x], [y]]), outline.shape)
    mouths = [tube(outline, middle, side * (0.5 * width + _PROUD)) for side in (-1, 1)]
    return [ring(outline, width), *mouths]


def _roller(view: TurnView, width: float) -> Json:
    """Record of the roller: rim, faces, cover of its bearing, and a spoke by its two radii, mm,
    which shows its rotation.

    Parameters
    ----------
    width : float   of the roller, mm
    """
    unit = unit_circle()
    away = np.hypot(*view.follower)
    outer, inner = away.max() * unit, away.min() * unit
    walls = [ring(outer, width), ring(inner, width)]
    faces = [tube(outer, inner, side * width / 2) for side in (-1, 1)]
    # the cover of the balls between outer ring and pin
    cover = [tube(inner, _pin_radius(view) * unit, 0.4 * side * width) for side in (-1, 1)]
    solid = joined([*walls, *faces, *cover])
    spoke = np.array([away.min(), 0.9 * away.max()])
    return solid.as_record(_DIGITS) | {"spoke": _rounded(spoke)}


def _follower(view: TurnView, width: float, stem: float, top: float) -> Solid:
    """Stem with fork and pin of a roller, or with the block of a flat face, about the follower's
    origin; mm.

    Parameters
    ----------
    width : float   of the cam
    stem : float    diameter of the stem
    top : float     height of the end of the stem
    """
    low, high = view.follower.min(axis=1), view.follower.max(axis=1)
    if not view.is_roller:
        # the y axis of the body points to the cam, downwards here
        block = box((-high[0], -high[1], -width / 2), (-low[0], -low[1], width / 2))
        return joined([block, rod(stem, -float(low[1]), top)])
    return fork(float(high[1]), _pin_radius(view), width, stem, top)


def _pin_radius(view: TurnView) -> float:
    """Radius of the roller pin, mm: of the hole; of about half an outer ring."""
    away = np.hypot(*view.follower)
    return float(min(0.98 * away.min(), 0.52 * away.max()))


def _frame(mechanism: DrawnMechanism, disc: float = 0.0, before: float = 0.0) -> Solid:
    """Fixed parts: guides, space of the spring with its seats over the turn, shaft with bearings
    and gear; of an arm its pivot in place of the guides.

    Parameters
    ----------
    disc : float     place of the middle of the cam along the shaft, mm
    before : float   place of the stem and its guides along the shaft, mm
    """
    highest, arm = mechanism.lowest + mechanism.stroke, mechanism.arm
    if arm is None:
        solids = [
            _sleeve(each, mechanism.stem, highest).shifted(mechanism.axis).deeper(before)
            for each in mechanism.sizes.sleeves
        ]
    else:
        apart = 0.0 if mechanism.second is None else mechanism.second.spacing
        half = 2.0 * mechanism.sizes.follower[1] - 1.5 * apart
        solids = [pin(0.5 * arm.bearing, half).deeper(0.5 * apart).raised(arm.pivot)]
    discs = [each._replace(place=each.place + disc) for each in mechanism.sizes.discs]
    solids += [pin(0.5 * each.diameter, 0.5 * each.width).deeper(each.place) for each in discs]
    if discs:
        ends = [each.place + side * 0.5 * each.width for each in discs for side in (-1, 1)]
        outline = 0.5 * min(each.diameter for each in discs) * unit_circle()
        solids.append(ring(outline, max(ends) - min(ends)).deeper(0.5 * (max(ends) + min(ends))))
    return joined(solids)


def _sleeve(sleeve: Sleeve, bore: float, highest: float) -> Solid:
    """Sleeve about the stem, its axis along y.

    Parameters
    ----------
    sleeve : Sleeve   ends as heights over roller centre or face at maximum lift, outer diameter, mm
    bore : float      diameter, mm
    highest : float   height of roller centre or face above the cam axis at maximum lift, mm
    """
    length = sleeve.high - sleeve.low
    outer, inner = 0.5 * sleeve.diameter * unit_circle(), 0.5 * bore * unit_circle()
    walls = [ring(outer, length), ring(inner, length)]
    ends = [tube(outer, inner, side * length / 2) for side in (-1, 1)]
    return joined([*walls, *ends]).upright(highest + 0.5 * (sleeve.low + sleeve.high))


def _face_on_arm(view: TurnView, width: float, arm: DrawnArm) -> Solid:
    """Block of a face with its arm; the origin is the middle of the face, which travels along +y;
    mm.

    Parameters
    ----------
    width : float   of the cam
    """
    low, high = view.follower.min(axis=1), view.follower.max(axis=1)
    # the y axis of the body points to the cam, downwards here
    block = box((-high[0], -high[1], -width / 2), (-low[0], -low[1], width / 2))
    thick, half = -float(low[1]), arm.half
    bottom, top = max(arm.depth - half, 0.25 * thick), max(arm.depth + half, thick)
    end = arm.sense * arm.length
    bar = box((min(0.0, end), bottom, -width / 4), (max(0.0, end), top, width / 4))
    post = box((-half, 0.25 * thick, -width / 4), (half, top, width / 4))
    return joined([block, bar, post])


def _contacts(view: TurnView, lab: Array, arm: DrawnArm | None = None) -> Array:
    """Contact points (2, f) in the frame of the guides, mm: on a roller along the contact normal,
    under a face the outermost point of the contour.

    Parameters
    ----------
    lab : array (2, f)       origins of the follower in the frame of the guides, mm
    arm : DrawnArm or None   that carries the follower; its face may be curved
    """
    angle = view.to_lab + view.turn
    if view.is_roller:
        reach = float(np.hypot(*view.follower).max())
        return np.asarray(lab + reach * np.stack([-np.sin(angle), np.cos(angle)]))
    touched = []
    for k, turn in enumerate(view.to_lab):
        there = rotation(turn) @ view.contour
        outwards = there[1] if arm is None else rotation(np.pi - angle[k])[1] @ there
        if arm is not None and arm.radius is not None:
            centre = lab[:, k] + rotation(angle[k]) @ np.array([0.0, -arm.radius])
            outwards = -np.hypot(*(there - centre[:, None]))
        touched.append(there[:, int(np.argmax(outwards))])
    return np.stack(touched, axis=1)


def _ends(material: ReportMaterial) -> Json:
    """Halves of both bodies at the contact of the worst certified angle; None without a field.

    The follower is drawn apart from the cam; width and depth are stretched, so that they are
    `_STRETCHED` of the length.
    """
    try:
        field = read_end_field(material.run.path / ENDS)
    except ResultError:
        return None
    touching = field.points[field.cells[field.pressure > 0]].reshape(-1, 3)
    half, length = float(touching[:, 0].max()), float(np.ptp(field.points[:, 1]))
    reach = _BESIDE * half
    stretch = max(1.0, float(np.round(_STRETCHED * length / reach)))
    blocks = [_end_block(field, field.body == number, reach) for number in (0, 1)]
    for block, side in zip(blocks, (-1.0, 1.0), strict=True):
        x, axis, height = np.array(block.pop("points")).T
        apart = side * _APART * half + height
        block |= {"x": _rounded(stretch * x), "y": _rounded(stretch * apart), "z": _rounded(axis)}
    return {
        "blocks": blocks,
        "stretch": stretch,
        "reach": {"side": stretch * reach, "deep": 0.5 * length},
        "words": _end_words(material, field),
    }


def _end_block(field: EndField, of_body: NDArray[np.bool_], reach: float) -> dict[str, Json]:
    """Record of the faces of one body near the middle of the contact: points, mm, triangles, von
    Mises stress at the points and contact pressure on the triangles, MPa.

    Parameters
    ----------
    of_body : array (cells,)   whether a cell is of this body
    reach : float              from the middle of the contact, across and in depth, mm
    """
    nodes = np.unique(field.cells[of_body])
    points, first = field.points[nodes], int(nodes[0])
    axes = [np.unique(part) for part in points.T]
    counts = [axis.size for axis in axes]
    order = points.reshape(*counts, 3)
    kept = [int((np.abs(axis) <= reach).sum()) for axis in (axes[0], axes[2])]
    wide, deep = (max(2, count) for count in kept)
    lattice = order[:wide, :, :deep]
    solid, chosen, behind = Lattice(lattice).surface()
    stress = field.von_mises[first : first + len(nodes)].reshape(counts)[:wide, :, :deep]
    cells = field.pressure[of_body].reshape([count - 1 for count in counts])
    pressed = cells[: wide - 1, :, : deep - 1].ravel()[behind]
    top = np.arange(behind.size) < 2 * (wide - 1) * (counts[1] - 1)
    return {
        "points": solid.points.T.tolist(),
        **dict(zip("ijk", solid.triangles.tolist(), strict=True)),
        "stress": _rounded(stress.ravel()[chosen]),
        "pressure": _rounded(np.where(top, pressed, 0.0)),
    }


def _end_words(material: ReportMaterial, field: EndField) -> str:
    """Place and load of the field."""
    records: Sequence[Record] = material.run.final.record.get("length_certificate") or []
    cases = [
        f" of load case {record['load_case']}"
        for record in records
        if np.isclose(record["cam_angle_deg"], field.cam_angle)
    ]
    return (
        f"cam angle {field.cam_angle:.4g}°{''.join(cases[:1])}: force {field.force:.4g} N, "
        f"moment {field.moment:.4g} N mm"
    )


def _shown(values: Array, unit: str) -> list[float]:
    """Values to read, without round-off: zero below 1e-9 of the greatest one, and of angles that
    are all round-off.
    """
    size = np.abs(np.nan_to_num(values))
    least = max(1e-9 * size.max(), ROUND_OFF_DEG if unit == "deg" else 0.0)
    return _rounded(np.where(size > least, values, 0.0))


def _rounded(values: ArrayLike) -> list[float]:
    return [float(f"{v:.{_DIGITS}g}") for v in np.nan_to_num(np.asarray(values, float)).tolist()]
