"""Field files of a run: stress of both bodies over the turn, and their poses."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from importlib.resources import files
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.cutouts import KeywayLike
from camwright.geometry.extrema import first_greatest
from camwright.meshes.mesh_files import write_hexahedra
from camwright.pipeline.base.files import npz_bytes, write_atomic
from camwright.pipeline.base.tables import Column
from camwright.pipeline.base.worker_processes import ALONE, Crew
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.finite_length.block_stress import BlockField, block_field
from camwright.pipeline.contact.finite_length.length_tiers import with_depths_on_ladder
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.certificate_angles import positions_to_certify
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.results.contact_zone import zone_nodes
from camwright.pipeline.results.field_file import FieldFile, MeshBlock, Notes, field_file
from camwright.pipeline.results.stress_fields import (
    BodyField,
    IntArray,
    TurnFields,
    follower_places,
)
from camwright.pipeline.results.trial import Trial

STEP = np.radians(15.0)
STRESS, TURN, VIEW, ENDS = "stress.vtkhdf", "turn.npz", "view_stress.py", "ends.vtu"
FIELDS = {"displacement_mm": 3, "stress_MPa": 6, "von_mises_MPa": 1, "tau_max_MPa": 1}
"""Point data and their components; stress in the order XX, YY, ZZ, XY, YZ, XZ of VTK."""
FRAMES = 360
"""Maximum number of recorded positions."""

_MILLIMETRE, _MEGAPASCAL = 1e-3, 1e6
_FIELDS_AT_ONCE = 24  # positions whose fields are in memory at once
_TO_MM = 1e3
_ANGLE_DIGITS = 9  # of a cam angle, deg


class Shown(StrEnum):
    """Cam angles of the stress field: none, the worst, `shown_positions`, or all."""

    NONE = "none"
    WORST = "worst"
    DEFAULT = "default"
    ALL = "all"


def write_fields(
    folder: Path, final: Trial, shown: Shown = Shown.DEFAULT,
    advance: Callable[[int, int], None] = lambda *_: None,
) -> None:  # fmt: skip
    """Write the field files of a trial: stress of both bodies over the turn, and arrays that turn
    them; none if the contour encloses no body.

    The load case is that with the maximum contact pressure; of preloaded discs that which is
    pressed harder is shown at each angle.

    Parameters
    ----------
    folder : Path        for the files
    final : Trial        with its mesh
    shown : Shown        cam angles with stresses
    advance : callable   told number of angles written and number of all
    """
    if final.mesh is None:
        return
    chosen = hardest(final.cycles)
    cycle = final.cycles[chosen].pressed_harder
    bodies = cycle.bodies or CycleBodies.meshed(cycle.pair)
    write_atomic(folder / TURN, npz_bytes(turn_view(cycle.pair, bodies, cycle)))
    if shown is Shown.NONE:
        return
    certified = positions_to_certify(final.cycles, final.case.solver.certificate_positions)
    positions = shown_positions(cycle, shown, [at.index for at in certified if at.case == chosen])
    write_stress(folder / STRESS, TurnFields(cycle.pair, bodies, cycle), positions, advance)
    script = files("camwright.pipeline.results") / "templates" / VIEW
    write_atomic(folder / VIEW, script.read_bytes())


def write_end_field(path: Path, final: Trial, workers: Crew = ALONE) -> None:
    """Write the stress field of both bodies, with their ends, at the worst certified angle; no file
    where the length is not certified by finite elements.

    Half x >= 0 of each body on the coarser of the last two meshes: x along the rolling direction, y
    along the axis, z = 0 in the contact, below it the cam, above it the follower.

    Parameters
    ----------
    path : Path      of the VTU file
    final : Trial    with its certificate
    workers : Crew   processes that compute the fields

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    certificate = final.solution.length_certificate
    if certificate is None or not certificate.points:
        return
    point = certificate.points[0]
    contact, pair = point.finite_elements.coarser, with_depths_on_ladder(point.load.pair)
    tasks = [workers.submit(block_field, body, contact) for body in pair.bodies]
    blocks: list[BlockField] = [task.result() for task in tasks]
    up = np.array([1.0, 1.0, -1.0]), np.array([1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
    turned = (up, (np.ones(3), np.ones(6)))
    stress = [block.stress * signs for block, (_, signs) in zip(blocks, turned, strict=True)]
    motion = [block.displacement * signs for block, (signs, _) in zip(blocks, turned, strict=True)]
    count = len(blocks[0].points)
    cells = [blocks[0].cells[:, [4, 5, 6, 7, 0, 1, 2, 3]], blocks[1].cells + count]
    load = point.load
    write_hexahedra(
        path,
        np.concatenate([b.points * signs for b, (signs, _) in zip(blocks, turned, strict=True)]),
        np.concatenate(cells),
        {
            "displacement_mm": np.concatenate(motion) / _MILLIMETRE,
            "stress_MPa": np.concatenate(stress) / _MEGAPASCAL,
            "von_mises_MPa": np.concatenate([block.von_mises for block in blocks]) / _MEGAPASCAL,
        },
        {
            "contact_pressure_MPa": np.concatenate([b.pressure for b in blocks]) / _MEGAPASCAL,
            "body": np.repeat([0, 1], [len(block.cells) for block in blocks]),
        },
        {
            "cam_angle_deg": round(float(np.degrees(load.theta)), _ANGLE_DIGITS),
            "force_N": load.force,
            "moment_Nmm": load.moment * _TO_MM,
        },
    )


def hardest(cycles: Sequence[Cycle]) -> int:
    """Index of the load case with the maximum contact pressure.

    A load case in which the follower leaves the cam or locks counts only where every one does: its
    loads are no results.
    """
    whole = [cycle.end is None for cycle in cycles]
    counted = whole if any(whole) else [True] * len(cycles)
    pressures = [cycle.pressed_harder.contact.p0_hertz.max() for cycle in cycles]
    return first_greatest(np.where(counted, pressures, -np.inf))


def shown_positions(cycle: Cycle, shown: Shown, certified: Sequence[int]) -> IntArray:
    """Ascending indices of the positions of a cycle whose stress is shown: by default one every
    `STEP` of cam angle, the certified ones, and that of the greatest contact pressure.

    Parameters
    ----------
    cycle : Cycle          at its cam angles
    shown : Shown          the worst alone, the default, or all
    certified : sequence   indices of the certified positions
    """
    count = cycle.theta.size
    worst = first_greatest(cycle.contact.p0_hertz)
    if shown is Shown.WORST:
        return np.array([worst])
    stride = max(1, round(float(STEP / (cycle.theta[1] - cycle.theta[0]))))
    every = np.arange(0, count, 1 if shown is Shown.ALL else stride)
    return np.union1d(every, np.array([worst, *certified], dtype=np.int64))


def write_stress(
    path: Path, fields: TurnFields, positions: IntArray,
    advance: Callable[[int, int], None] = lambda *_: None,
) -> None:  # fmt: skip
    """Write stress and displacement of both bodies at some positions of a cycle as one VTKHDF file.

    A block per body on its coarse mesh, and one below the contact of each, of names ending in
    `ZONE`; elements of the coarse mesh which that one replaces are hidden. In the cam frame, in
    which the follower rotates. Times are cam angles in degrees.

    Parameters
    ----------
    path : Path              of the file
    fields : TurnFields      of the cycle
    positions : array (k,)   indices of the positions
    advance : callable       told number of positions written and number of all
    """
    cam, _ = fields.names
    coarse = fields.coarse_points
    blocks = {
        name: MeshBlock(triangles, coarse[name].shape[1] if name in coarse else zone_nodes())
        for name, triangles in fields.triangles.items()
    }
    blocks[cam] = MeshBlock(blocks[cam].triangles, blocks[cam].nodes, coarse[cam] / _MILLIMETRE)
    times = np.asarray(np.degrees(fields.cycle.theta[positions]), dtype=float).round(_ANGLE_DIGITS)
    notes = _notes(fields, positions, times)
    with field_file(path, times, blocks, FIELDS, notes) as file:
        for start in range(0, positions.size, _FIELDS_AT_ONCE):
            part = positions[start : start + _FIELDS_AT_ONCE]
            shown = fields.at(part)
            for name, field in shown.items():
                _write(file, name, start, field, fields.poisson[name], blocks[name])
            advance(min(start + _FIELDS_AT_ONCE, positions.size), positions.size)


def _notes(fields: TurnFields, positions: IntArray, times: Array) -> Notes:
    """Field data of each of k steps by name: load case, cam angle, and contact figures.

    Parameters
    ----------
    fields : TurnFields      of the cycle
    positions : array (k,)   indices of the positions
    times : array (k,)       cam angles, deg
    """
    cycle = fields.cycle
    contact, theta = cycle.contact, cycle.theta[positions]
    point, normal = fields.pair.contacts(theta)
    point = point / _MILLIMETRE
    return {
        "load_case": [cycle.load_case] * positions.size,
        "cam_angle_deg": times,
        "line_load_N_per_mm": contact.line_load[positions] * _MILLIMETRE,
        "half_width_mm": contact.half_width[positions] / _MILLIMETRE,
        "half_width_hertz_mm": contact.half_width_hertz[positions] / _MILLIMETRE,
        "p0_fe_MPa": contact.p0[positions] / _MEGAPASCAL,
        "p0_hertz_MPa": contact.p0_hertz[positions] / _MEGAPASCAL,
        "von_mises_MPa": contact.von_mises[positions] / _MEGAPASCAL,
        "contact_x_mm": point[0],
        "contact_y_mm": point[1],
        "normal_x": normal[0],
        "normal_y": normal[1],
    }


def _write(
    file: FieldFile, name: str, first: int, field: BodyField, poisson: float, block: MeshBlock
) -> None:
    """Write displacement, mm, and stresses, MPa, of one block of a field file at consecutive steps.

    Parameters
    ----------
    file : FieldFile    to be written
    name : str          of the block
    first : int         index of the first step
    field : BodyField   of the body, SI
    poisson : float     its Poisson's ratio, for the stress along the axis
    block : MeshBlock   without points: these move and are written as well
    """
    points = None
    if block.points is None:
        points = field.points.transpose(2, 1, 0) / _MILLIMETRE
    stress = field.stress / _MEGAPASCAL
    measures = {
        "von_mises_MPa": plane_stress_measures.von_mises(stress, poisson).T,
        "tau_max_MPa": plane_stress_measures.shear_in_plane(stress).T,
    }
    xx, yy, xy = stress.transpose(0, 2, 1)
    nothing = np.zeros_like(xx)
    whole = [xx, yy, poisson * (xx + yy), xy, nothing, nothing]
    displaced = field.displacement.transpose(2, 1, 0) / _MILLIMETRE
    data = {
        "displacement_mm": np.concatenate([displaced, nothing[:, :, None]], axis=-1),
        "stress_MPa": np.stack(whole, axis=-1),
        **measures,
    }
    file.write(name, first, data, field.hidden.T, points)


TURN_ARRAYS = (
    Column("load_case", "", "the design load case"),
    Column("cycle_row", "", "(f,) row of the load case in `5_cycle.csv`"),
    Column("cam_angle", "deg", "(f,) cam angle of the row"),
    Column("cam_outline", "mm", "(2, s, 2) contour, then bore with keyway, in the cam frame"),
    Column("follower_nodes", "mm", "(2, n) nodes of the follower mesh in its own frame"),
    Column("follower_origin", "mm", "(f, 2) origin of that frame in the cam frame"),
    Column("follower_rotation", "deg", "(f,) rotation of that frame in the cam frame"),
)
"""Arrays of ``fields/turn.npz``."""


def turn_view(pair: ContactPair, bodies: CycleBodies, cycle: Cycle) -> Mapping[str, ArrayLike]:
    """Arrays of ``fields/turn.npz``, with which a viewer turns cam and follower through a turn:
    outline of the cam, nodes of the follower, its pose at each angle shown.

    Parameters
    ----------
    pair : ContactPair     cam and follower
    bodies : CycleBodies   their meshes
    cycle : Cycle          at its cam angles

    Returns
    -------
    mapping   by the headers of `TURN_ARRAYS`
    """
    count = cycle.theta.size
    shown = np.arange(0, count, -(-count // FRAMES))
    if pair.pulling is not None and pair.pulling.rim_radius is None:
        pair = replace(pair, pulling=None, wall=None)  # the first roller or face, all over the turn
    places = follower_places(pair, cycle.theta[shown])
    return {
        "load_case": np.array(cycle.load_case),
        "cycle_row": shown,
        "cam_angle_deg": np.degrees(cycle.theta[shown]),
        "cam_outline_mm": _TO_MM * cam_outlines(pair, 2 * shown.size),
        "follower_nodes_mm": _TO_MM * bodies.follower.body.mesh.points,
        "follower_origin_mm": _TO_MM * places.origin,
        "follower_rotation_deg": np.degrees(places.angle),
    }


def cam_outlines(pair: ContactPair, stations: int) -> Array:
    """Outlines of a cam, contour and then bore with its keyway, at the same polar angles: points
    (2, stations, 2), m, the last axis being the outline.
    """
    outer = pair.contour.points(uniform_turn(stations))
    radius, angle = np.hypot(*outer), np.arctan2(outer[1], outer[0])
    inner = outer * (bore_reach(pair.bore_radius, pair.keyway, angle) / radius)
    return np.stack([outer, inner], axis=-1)


def bore_reach(bore_radius: float, keyway: KeywayLike | None, angle: Array) -> Array:
    """Distance (...) from the axis to the edge of bore and keyway, m, in directions (...), rad."""
    reach = np.full(angle.shape, bore_radius)
    if keyway is None:
        return reach
    off = np.abs((angle - keyway.angle + np.pi) % (2 * np.pi) - np.pi)
    half, floor = 0.5 * keyway.width, bore_radius + keyway.depth
    with np.errstate(divide="ignore"):
        slot = np.minimum(floor / np.maximum(np.cos(off), 1e-9), half / np.sin(off))
    return np.where(off < np.arcsin(half / bore_radius), slot, reach)
