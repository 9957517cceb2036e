"""The cam in space: a page of its own with a slider over the turn, complete without a network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.reports import stress_map
from camwright.reports.interactive import script_safe_json, scripts
from camwright.reports.page import environment
from camwright.reports.report_data import Material
from camwright.reports.scene_solids import Solid, box, joined, ring, tube

FILE = "scene.html"
TURN = Path("fields") / "turn.npz"
_NAMES = (
    *("position", "cam_angle_deg", "cam_mm", "follower_mm", "follower_origin_mm"),
    "follower_turn_deg",
)
MAP = "von_mises_MPa"
_DIGITS = 5
_ROUND = 48
_HERE = Path(__file__).parent
_SCRIPTS = (_HERE / "vendor" / "plotly-gl3d.min.js", _HERE / "templates" / "scene.js")
_TOLD = (
    ("lift", "lift_mm", "mm"), ("normal force", "normal_force_N", "N"),
    ("peak pressure p0", "p0_fe_MPa", "MPa"), ("half-width", "half_width_fe_mm", "mm"),
    ("pressure angle", "pressure_angle_deg", "deg"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class TurnView:
    """Outlines and positions of both bodies at f cam angles, of one load case.

    position (f,) rows of the load case's turn; angle (f,) deg; contour and bore (2, stations) mm
    in the cam's frame; follower (2, n) mm, points of its body in its own frame; origin (f, 2) mm
    and turn (f,) rad place that frame in the cam's.
    """

    load_case: str
    position: Any
    angle: Array
    contour: Array
    bore: Array
    follower: Array
    origin: Array
    turn: Array

    @property
    def is_roller(self) -> bool:
        """Whether the follower's body has a hole in its middle, as a roller has."""
        return bool(np.hypot(*self.follower).min() > 0.05 * np.hypot(*self.follower).max())

    @property
    def to_lab(self) -> Array:
        """Turn (f,), rad, from the cam's frame to one in which the follower moves along +y."""
        return 0.5 * np.pi - np.radians(self.angle)

    def lab_origin(self) -> Array:
        """Origin (2, f), mm, of the follower's frame where the follower moves along +y."""
        cosine, sine = np.cos(self.to_lab), np.sin(self.to_lab)
        x, y = self.origin.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y])

    def arc(self) -> Array:
        """Length of the contour, mm, from the first angle to each (f,), straight between points."""
        steps = np.hypot(*np.diff(self.contour, axis=1, append=self.contour[:, :1]))
        along = np.r_[0.0, np.cumsum(steps)]
        return np.interp(self.angle, np.linspace(0.0, 360.0, along.size), along)


def read_turn_view(folder: Path) -> TurnView:
    """The view of the run in a folder.

    Raises
    ------
    ResultError
        If the run has none, such as one of an earlier version, or it cannot be read.
    """
    path = folder / TURN
    if not path.is_file():
        raise ResultError(f"{path}: no such file; run the case again to have it")
    try:
        with np.load(path, allow_pickle=False) as entry:
            found = {name: entry[name] for name in (*_NAMES, "load_case")}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise ResultError(f"{path}: {error}") from None
    return TurnView(
        str(found["load_case"]), found["position"], found["cam_angle_deg"],
        found["cam_mm"][:, :, 0], found["cam_mm"][:, :, -1], found["follower_mm"],
        found["follower_origin_mm"], np.radians(found["follower_turn_deg"]),
    )  # fmt: skip


def write(material: Material) -> Sequence[Path]:
    """Write ``scene.html`` into the run folder; nothing for a run without a view of its turn."""
    try:
        view = read_turn_view(material.folder)
    except ResultError:
        return []
    own, hashes = scripts(_SCRIPTS)
    text = environment().get_template("scene.html").render(
        title=str(material.case.get("title") or material.run.summary["case"]),
        load_case=view.load_case,
        last=view.angle.size - 1,
        scripts=own,
        hashes=hashes,
        data=Markup(script_safe_json(scene(material, view))),  # noqa: S704 - no "<" is left in it
    )  # fmt: skip
    return [write_atomic(material.folder / FILE, text.encode("utf-8", "replace"))]


def scene(material: Material, view: TurnView) -> dict[str, Any]:
    """All that the page draws: bodies as triangles in mm, where they are at each angle, values.

    The cam's axis is z; the follower moves along y.
    """
    turn = material.turn
    width = turn.length("cam", "width") or 5.0
    stem = turn.length("follower", "stem_diameter") or 0.6 * width
    lab = view.lab_origin()
    rows = material.run.final.cycle.where("load_case", view.load_case).columns
    bodies = {"flank": _flank(material, view, width), "cam": _cam(view, width).as_record(_DIGITS)}
    bodies["bore"] = ring(view.bore, width).as_record(_DIGITS)
    bodies["follower"] = _follower(material, view, width, stem).as_record(_DIGITS)
    guide = _guide(material, view, stem)
    if guide is not None:
        bodies["guide"] = guide.as_record(_DIGITS)
    spin = view.arc() / float(np.hypot(*view.follower).max()) if view.is_roller else 0.0
    return {
        "bodies": bodies,
        "roller": _roller(view, width) if view.is_roller else None,
        "angle": _rounded(view.angle),
        "turn": _rounded(view.to_lab),
        "origin": [_rounded(part) for part in lab],
        "facing": _rounded(view.to_lab + view.turn + spin),
        "contact": [_rounded(part) for part in _contacts(view, lab)],
        "half": width / 2,
        "told": [
            {"words": words, "unit": unit, "values": _rounded(rows[name][view.position])}
            for words, name, unit in _TOLD
            if name in rows
        ],
        "ratio": float(rows["crank_angle_deg"][1] / rows["cam_angle_deg"][1]),
        "reach": {
            "side": float(np.hypot(*view.contour).max()),
            "top": float(lab[1].min()) + _stem_end(material, view, stem),
        },
    }


def _flank(material: Material, view: TurnView, width: float) -> dict[str, Any]:
    """The contour drawn out to the width, with the greatest stress of the turn under each place."""
    outer = view.contour
    record = ring(outer, width).as_record(_DIGITS)
    greatest = _greatest(material, view, outer.shape[1])
    if greatest is not None:
        angle = np.linspace(0.0, 360.0, outer.shape[1], endpoint=False)
        words = [f"cam {a:.1f}°: {v:.4g} MPa" for a, v in zip(angle, greatest, strict=True)]
        record |= {"values": _rounded(np.tile(greatest, 2)), "words": words * 2}
    return record


def _greatest(material: Material, view: TurnView, stations: int) -> Array | None:
    """Greatest von Mises stress under each station of the contour, MPa; None in older runs."""
    try:
        found = stress_map.read_envelope(material.run.final.path / stress_map.FILE, view.load_case)
    except ResultError:
        return None
    angle = np.linspace(0.0, 360.0, stations, endpoint=False)
    return np.interp(angle, found["cam_angle_deg"], np.nanmax(found[MAP], axis=1), period=360.0)


def _cam(view: TurnView, width: float) -> Solid:
    """Both faces of the cam."""
    return joined([tube(view.contour, view.bore, side * width / 2) for side in (-1, 1)])


def _roller(view: TurnView, width: float) -> dict[str, Any]:
    turn = np.linspace(0.0, 2 * np.pi, _ROUND, endpoint=False)
    unit = np.stack([np.cos(turn), np.sin(turn)])
    away = np.hypot(*view.follower)
    outer, inner = away.max() * unit, away.min() * unit
    walls = [ring(outer, width), ring(inner, width)]
    faces = [tube(outer, inner, side * width / 2) for side in (-1, 1)]
    # Between a bearing's outer ring and the pin: the balls' cover, a little inside.
    cover = [tube(inner, _pin_radius(view) * unit, 0.4 * side * width) for side in (-1, 1)]
    solid = joined([*walls, *faces, *cover])
    spoke = np.array([away.min(), 0.9 * away.max()])
    return solid.as_record(_DIGITS) | {"spoke": _rounded(spoke)}


def _follower(material: Material, view: TurnView, width: float, stem: float) -> Solid:
    """Stem and, round a roller, its fork; or the block of a flat face. Origin as the body's."""
    low, high = view.follower.min(axis=1), view.follower.max(axis=1)
    top = _stem_end(material, view, stem)
    if not view.is_roller:
        # The body looks at the cam along its own y, which is downwards here.
        block = box((-high[0], -high[1], -width / 2), (-low[0], -low[1], width / 2))
        return joined([block, _rod(stem, -float(low[1]), top)])
    radius, plate = float(high[1]), 0.25 * width
    bridge = radius + 0.15 * stem
    half = 0.5 * min(stem, radius)
    inside, outside = width / 2 + 0.1 * width, width / 2 + 0.1 * width + plate
    plates = [
        box((-half, -half, min(side * inside, side * outside)),
            (half, bridge + plate, max(side * inside, side * outside)))
        for side in (-1.0, 1.0)
    ]  # fmt: skip
    yoke = box((-half, bridge, -outside), (half, bridge + plate, outside))
    pin = _across(_pin_radius(view), 1.1 * outside)
    return joined([*plates, yoke, pin, _rod(stem, bridge + plate, top)])


def _pin_radius(view: TurnView) -> float:
    """Of the pin a roller turns on, mm: its hole's, but of an outer ring half the ring's."""
    away = np.hypot(*view.follower)
    return float(min(0.98 * away.min(), 0.52 * away.max()))


def _rod(stem: float, start: float, end: float) -> Solid:
    """A rod along y, round."""
    turn = np.linspace(0.0, 2 * np.pi, _ROUND, endpoint=False)
    circle = 0.5 * stem * np.stack([np.cos(turn), np.sin(turn)])
    return ring(circle, end - start).upright((start + end) / 2)


def _across(radius: float, half: float) -> Solid:
    """A pin along z through the origin, closed at its ends."""
    turn = np.linspace(0.0, 2 * np.pi, _ROUND, endpoint=False)
    circle = radius * np.stack([np.cos(turn), np.sin(turn)])
    ends = [tube(circle, 0.0 * circle, side * half) for side in (-1, 1)]
    return joined([ring(circle, 2 * half), *ends])


def _guide(material: Material, view: TurnView, stem: float) -> Solid | None:
    """The bush of guide A, where the case says where it is."""
    length = material.turn.length("guides", "a", "length")
    overhang = material.turn.length("follower", "overhang_at_max_lift")
    if length is None or overhang is None:
        return None
    turn = np.linspace(0.0, 2 * np.pi, _ROUND, endpoint=False)
    unit = np.stack([np.cos(turn), np.sin(turn)])
    outer, inner = 0.85 * stem * unit, 0.5 * stem * unit
    walls = [ring(outer, length), ring(inner, length)]
    ends = [tube(outer, inner, side * length / 2) for side in (-1, 1)]
    middle = float(view.lab_origin()[1].max()) + overhang
    bush = joined([*walls, *ends]).upright(middle)
    return bush.moved(float(view.lab_origin()[0].mean()))


def _contacts(view: TurnView, lab: Array) -> Array:
    """Where the bodies touch (2, f), mm: the point of the follower's surface that faces the cam."""
    angle = view.to_lab + view.turn
    if view.is_roller:
        reach = float(np.hypot(*view.follower).max())
        return np.asarray(lab + reach * np.stack([-np.sin(angle), np.cos(angle)]))
    surface = view.contour
    lowest = []
    for turn in view.to_lab:
        there = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ surface
        lowest.append(there[:, int(np.argmax(there[1]))])
    return np.stack(lowest, axis=1)


def _stem_end(material: Material, view: TurnView, stem: float) -> float:
    """Height of the stem's end over the follower's origin, mm: past guide A wherever it stands."""
    length = material.turn.length("guides", "a", "length")
    overhang = material.turn.length("follower", "overhang_at_max_lift")
    if length is None or overhang is None:
        return 4.0 * stem + float(view.follower[1].max())
    lifted = view.lab_origin()[1]
    return overhang + 0.5 * length + float(np.ptp(lifted)) + 0.5 * stem


def _rounded(values: Any) -> list[float]:
    return [float(f"{v:.{_DIGITS}g}") for v in np.nan_to_num(np.asarray(values, float)).tolist()]
