"""Cams, followers, laws, springs and machines that are not supported, or by another name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

LISTED = "docs/theory.md lists the kinds that are not done"
Area = Literal["follower", "cam", "lift", "spring", "guides", "drive"]
_AREAS: dict[str, Area] = {
    "follower": "follower", "roller": "follower", "valve_train": "follower", "cam": "cam",
    "lift": "lift", "spring": "spring", "guides": "guides", "engine": "drive", "torque": "drive",
    "mechanism": "drive", "camshaft": "drive", "crankshaft": "drive",
}  # fmt: skip


@dataclass(frozen=True)
class MissingKind:
    """Kind of part or machine that is not supported, with the nearest supported one; or one that a
    case file states in other words.

    Parameters
    ----------
    name : str      in the words of the field
    area : str      part of the machine that it is a kind of
    words : tuple   by which a value names it, joined by underscores
    instead : str   what comes nearest to it, or states it; "" without any
    keys : tuple    words that name it as a key or table, too
    done : bool     whether it is supported, stated by `instead`
    """

    name: str
    area: Area
    words: tuple[str, ...]
    instead: str = ""
    keys: tuple[str, ...] = ()
    done: bool = False

    @property
    def sentence(self) -> str:
        """Message: how the kind is stated; or that it is not supported, the nearest one, where all
        are listed.
        """
        if self.done:
            return f"{self.name} is stated by {self.instead}"
        nearest = f" (nearest: {self.instead})" if self.instead else ""
        return f"{self.name} is not done{nearest}; {LISTED}"


_PLATE = 'a plate cam with a spring, or cam.closure = "groove"'
_BY_TABLE = '[lift] kind = "table" or "points"'
_DRAWINGS = ("dxf", "dwg", "igs", "iges", "stp", "contour", "outline", "surface_points")
_OF_CONTOUR = f"its lift as {_BY_TABLE}"
_AS_FORCE = "its force over the cam angle as follower.external_force_file"
MISSING_KINDS = (
    MissingKind(
        "a rocker, finger or lever", "follower",
        ("rocking", "rocker", "rocker_arm", "finger", "lever"),
        'kind = "oscillating" with a roller or a face, and [rocker] for its second arm',
        keys=("rocker_arm", "lever"), done=True,
    ),
    MissingKind(
        "a knife-edge (pointed) follower", "follower",
        ("knife", "knife_edge", "pointed", "point", "edge", "wedge"), "a roller of small radius",
        keys=("knife_edge",),
    ),
    MissingKind(
        "a stem with a curved face (mushroom, spherical)", "follower",
        ("mushroom", "spherical", "sphere", "domed", "curved", "curved_face", "convex", "barrel"),
        'kind = "oscillating" with follower.face.radius, "roller", or a flat face with a crown',
    ),
    MissingKind(
        "a follower that holds the cam on both sides", "follower",
        ("yoke", "scotch_yoke", "constant_breadth", "constant_width", "constant_diameter",
         "positive_drive", "positive_return", "double_roller", "twin_roller", "two_rollers"),
        'cam.closure = "yoke", "conjugate", or "groove" with [cam.groove.second]',
        keys=("yoke", "second_roller"), done=True,
    ),
    MissingKind(
        "a follower with a hydraulic element, or lash without [rocker]", "follower",
        ("hydraulic", "lash", "valve_lash", "tappet_clearance", "pushrod", "push_rod", "bucket"),
        "the masses and forces reduced to the follower",
        keys=("lash", "pushrod", "hydraulic"),
    ),
    MissingKind(
        "a groove (track, face) cam", "cam",
        ("groove", "grooved", "groove_width", "track", "face", "face_cam", "slot", "slotted",
         "box", "box_cam", "closed", "internal"),
        'cam.closure = "groove" and [cam.groove], with [cam.groove.second] for two rollers',
        keys=("groove_width", "groove_depth", "track", "track_width"), done=True,
    ),
    MissingKind(
        "a pair of discs", "cam",
        ("conjugate", "complementary", "double", "double_disc", "dual", "twin", "counter_cam"),
        'cam.closure = "conjugate" and [cam.conjugate]',
        keys=("conjugate_cam", "second_cam", "counter_cam"), done=True,
    ),
    MissingKind(
        "a desmodromic (positively driven) cam", "cam",
        ("desmodromic", "desmo", "positive_motion", "positive_drive", "positive"),
        'cam.closure = "groove", "conjugate" or "yoke"',
        keys=("desmodromic", "desmo"), done=True,
    ),
    MissingKind(
        "a barrel (cylindrical, drum) cam", "cam",
        ("barrel", "cylindrical", "cylinder", "drum", "bell"), _PLATE, keys=("barrel", "drum"),
    ),
    MissingKind(
        "a globoidal (roller gear) or other indexing cam", "cam",
        ("globoidal", "globoid", "roller_gear", "ferguson", "concave", "indexing", "index",
         "parallel_index", "geneva", "maltese", "step"),
        keys=("globoidal", "globoid", "indexing", "geneva", "turret"),
    ),
    MissingKind(
        "a spatial (conical, end, swash-plate) cam", "cam",
        ("conical", "cone", "spatial", "three_dimensional", "3d", "camoid", "end_cam", "axial",
         "swash", "swash_plate", "wobble"),
        keys=("swash_plate", "cone_angle"),
    ),
    MissingKind(
        "a wedge (linear, translating) cam", "cam",
        ("wedge", "linear", "translating", "translation", "flat_plate", "sliding"),
    ),
    MissingKind(
        "an inverse or stationary cam", "cam", ("inverse", "inverted", "stationary", "fixed"),
        "the plate cam of the same relative motion",
    ),
    MissingKind(
        "a snail (drop) cam with an abrupt fall", "cam",
        ("snail", "drop", "spiral", "scroll", "abrupt"),
        "a steep return, which the follower leaves: its flight and landing are calculated",
    ),
    MissingKind(
        "a contour (DXF, points of the cam surface) without its lift", "cam",
        _DRAWINGS, _OF_CONTOUR, keys=("contour", "outline", "dxf", "points"),
    ),
    MissingKind(
        "a contour (DXF, points of the cam surface) in place of a lift", "lift",
        _DRAWINGS, _OF_CONTOUR, keys=("contour", "outline", "dxf"),
    ),
    MissingKind(
        "an abrupt fall or rise", "lift",
        ("snail", "drop", "fall", "abrupt", "abrupt_fall", "instantaneous", "jump", "step"),
        "a steep return, which the follower leaves: its flight and landing are calculated",
    ),
    MissingKind(
        "constant velocity, whose acceleration has no bound at the ends,", "lift",
        ("constant_velocity", "uniform", "uniform_velocity", "uniform_motion", "linear",
         "straight", "straight_line", "ramp", "cv", "archimedean"),
        'law = "harmonic", of the least greatest velocity',
    ),
    MissingKind(
        "a law of another name", "lift",
        ("double_harmonic", "elliptical", "elliptic", "cubic", "gutman", "scca", "polydyne",
         "modified_uniform", "modified_constant_velocity", "trapezoidal", "fourier", "circular_arc",
         "circular_arcs", "three_arc", "tangent", "spline", "bezier", "nurbs"),
        _BY_TABLE,
    ),
    MissingKind(
        "a disc (Belleville) spring", "spring",
        ("disc", "disk", "belleville", "washer", "cup"), _AS_FORCE,
        keys=("belleville", "disc_spring"),
    ),
    MissingKind(
        "a leaf spring", "spring", ("leaf", "flexure", "plate", "blade", "cantilever", "flat"),
        "a coil spring of its rate and preload",
        keys=("leaf", "leaf_spring"),
    ),
    MissingKind(
        "a progressive, conical or barrel-shaped spring", "spring",
        ("progressive", "degressive", "conical", "tapered", "beehive", "barrel", "variable_pitch",
         "variable_rate", "nonlinear", "non_linear"),
        "a coil spring of constant rate",
        keys=("progressive",),
    ),
    MissingKind(
        "a set of nested springs", "spring",
        ("nested", "dual", "double", "twin", "inner", "outer", "parallel"),
        "one spring of their rates and preloads in sum, without [spring.design]",
        keys=("nested", "inner_spring", "outer_spring", "second_spring"),
    ),
    MissingKind(
        "an elastomer spring", "spring",
        ("elastomer", "rubber", "polyurethane", "pu", "urethane", "foam"), _AS_FORCE,
    ),
    MissingKind(
        "a closing force without a spring (constant pressure, magnet)", "spring",
        ("constant_force", "constant", "pneumatic", "air", "hydraulic", "magnet", "magnetic"),
        "a spring of small rate beside follower.external_force",
    ),
    MissingKind(
        "a follower without a spring", "spring", ("weight", "gravity", "none"),
        'cam.closure = "gravity", "groove", "conjugate" or "yoke", [spring] left out', done=True,
    ),
    MissingKind(
        "a rolling guide (ball bushing, linear bearing)", "guides",
        ("ball_bushing", "ball", "rolling", "roller_guide", "linear_bearing", "recirculating",
         "hydrostatic", "air_bearing"),
        "a bush of its friction, clearance and stiffness",
        keys=("ball_bushing", "linear_bearing"),
    ),
    MissingKind(
        "a rotary, free-piston or Stirling engine", "drive",
        ("wankel", "rotary", "stirling", "free_piston", "turbine", "gas_turbine"),
        '[torque] kind = "table" or "harmonics"',
    ),
    MissingKind(
        "a drive of the cam other than at a constant ratio (belt slip, Geneva, servo)", "drive",
        ("servo", "geneva", "electronic", "elliptical_gears", "noncircular", "universal_joint"),
        "the lift over the angle of the cam itself",
    ),
)  # fmt: skip


def missing_kind(key: str, word: str) -> MissingKind | None:
    """Unsupported kind named by a key or word of a case file; None without one.

    Parameters
    ----------
    key : str    dotted key, which tells the part of the machine; a table that no case has is
                 searched among all parts
    word : str   value at the key, in any spelling: ``Knife-Edge``; "": the key itself is unknown
    """
    kinds = missing_kinds(key, word)
    return kinds[0] if kinds else None


def missing_kinds(key: str, word: str) -> list[MissingKind]:
    """Unsupported kinds named by a word, the longest match first; see `missing_kind`."""
    area = _AREAS.get(re.split(r"[.\[]", key)[0])
    own, word = not word, word or key.rpartition(".")[2]
    sought = f"_{re.sub(r'[^a-z0-9]+', '_', word.casefold()).strip('_')}_"
    hits = [
        (len(each), kind)
        for kind in MISSING_KINDS
        for each in (kind.keys if own else kind.words)
        if area in (None, kind.area) and f"_{each}_" in sought
    ]
    ranked = sorted(hits, key=lambda hit: -hit[0])  # of equal ones in their order
    return list(dict.fromkeys(kind for _, kind in ranked))
