"""Choice of the certified angles, and their solution in worker processes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.geometry.extrema import first_greatest, first_least
from camwright.pipeline.base.store import Arrays
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.pipeline.contact.certificate import (
    EDGES,
    MeshFigures,
    certificate_point,
    mesh_figures,
)
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.finite_length.length_certificate import ONE_MESH, LengthLoad
from camwright.pipeline.contact.finite_length.length_tiers import plane_strain
from camwright.pipeline.cycle.contact_store import (
    NOT_STORED,
    ContactStore,
    kept_piece,
    piece_key,
)
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.length_history import length_table, signed_factor

_STORED_AS = ".certificate"  # no name of a load case
FINEST = 2
"""Cam angles at which the finest mesh is solved."""
_FINER_ABOVE = 0.005  # of cycle and certificate on two meshes: half of the limit


@dataclass(frozen=True)
class Position:
    """Contact to certify: numbers of load case and position, and whether it is that on the track of
    preloaded discs that bears less there.
    """

    case: int
    index: int
    idle: bool = False

    def contact(self, cycles: Sequence[Cycle]) -> ContactHistory:
        """Contact of the load case over the turn, on that track at this position."""
        cycle = cycles[self.case]
        return cycle.idle if self.idle and cycle.idle is not None else cycle.contact

    def theta(self, cycles: Sequence[Cycle]) -> float:
        """Cam angle, rad."""
        return float(cycles[self.case].theta[self.index])

    def pair(self, cycles: Sequence[Cycle]) -> ContactPair:
        """Bodies in contact."""
        pair = cycles[self.case].pair
        return (pair.other_track if self.idle else pair).carrying(self.theta(cycles))


def positions_to_certify(cycles: Sequence[Cycle], count: int) -> tuple[Position, ...]:
    """Positions to certify, at most `count`, the most critical first.

    The greatest pressure on either track of a cam that pulls, of preloaded discs also where the
    other one bears more; extremes of pressure, load, curvature
    and its change over all load cases; then equal steps over the turn of the first. Of angles
    closer than four positions only one is certified.
    """
    wanted: list[Position] = []

    def take(case: int, index: int, *, idle: bool = False) -> None:
        """Add a position of a load case, unless it is unloaded or loaded within round-off, near one
        that is chosen, or beyond the count.
        """
        at = Position(case, index, idle)
        contact = at.contact(cycles)
        loaded = contact.p0[index] > 0 and not contact.below_round_off[index]
        near = any(
            (each.case, each.idle) == (case, idle) and abs(each.index - index) < 4
            for each in wanted
        )
        if loaded and not near and len(wanted) < count:
            wanted.append(at)

    if cycles[0].loads.held:
        for wall in (1.0, -1.0):
            on_track = [_on_track(cycle, wall) for cycle in cycles]
            case = first_greatest([pressure.max() for pressure in on_track])
            index = first_greatest(on_track[case])
            take(case, index, idle=bool(cycles[case].loads.wall[index] != wall))
    for extreme in _EXTREMES:
        for case, cycle in enumerate(cycles):
            take(case, first_greatest(extreme(cycle.contact)))
    size = cycles[0].theta.size
    for index in np.linspace(0, size, 4 * count, endpoint=False).astype(int):
        take(0, int(index))
    return tuple(wanted)


def _on_track(cycle: Cycle, wall: float) -> Array:
    """Contact pressure on a track over the turn (n,), Pa, 0 where it is not pressed or not known;
    wall : 1 the first, -1 the other.
    """
    idle = 0.0 if cycle.idle is None else cycle.idle.p0
    return np.nan_to_num(np.where(cycle.loads.wall == wall, cycle.contact.p0, idle))


def length_loads(cycles: Sequence[Cycle], angles: Sequence[float]) -> tuple[LengthLoad, ...]:
    """Contacts with body ends to be certified by finite elements.

    The greatest signed pressure of all load cases; that of each other load case whose contact is
    about as wide, so that the same blocks serve; those of the first load case nearest to cam angles
    (rad) under load. Each at the worst moment of its range; empty without ends. A load case in
    which the follower leaves the cam or locks counts only where every one does. Of preloaded discs
    those of each, the disc with the greater pressure first.
    """
    sound = [cycle.loads.end is None for cycle in cycles]
    counted = [sound[case] or not any(sound) for case in range(len(cycles))]
    discs = [
        _loads_of_disc(cycles, pressures, counted, angles, second=number > 0)
        for number, pressures in enumerate(
            zip(*(cycle.on_each_disc(_signed_pressure) for cycle in cycles), strict=True)
        )
    ]
    ranked = sorted((each for each in discs if each.loads), key=lambda each: -each.greatest)
    return tuple(load for each in ranked for load in each.loads)


class _DiscLoads(NamedTuple):
    """Contacts of a disc to be certified, and its greatest signed pressure, Pa."""

    loads: tuple[LengthLoad, ...]
    greatest: float


def _signed_pressure(cycle: Cycle) -> Array:
    """Signed pressure (n,), Pa, 0 where it is not known or its load vanishes."""
    pressure = np.nan_to_num(cycle.signed_pressure)
    return np.where(cycle.contact.below_round_off, 0.0, pressure)


def _loads_of_disc(
    cycles: Sequence[Cycle],
    pressures: Sequence[Array],
    counted: Sequence[bool],
    angles: Sequence[float],
    *,
    second: bool,
) -> _DiscLoads:
    """Contacts of a disc to be certified, see `length_loads`.

    Parameters
    ----------
    pressures : sequence   of each load case: signed pressure (n,) on the disc, Pa
    counted : sequence     of each load case: whether it counts
    second : bool          whether it is the second of preloaded discs
    """
    worst = [
        (case, first_greatest(pressure))
        for case, pressure in enumerate(pressures)
        if counted[case] and pressure.max() > 0
    ]
    if not worst:
        return _DiscLoads((), 0.0)

    def load(at: tuple[int, int]) -> LengthLoad:
        """Contact at the numbers of load case and position."""
        return _length_load(cycles[at[0]], at[1], second=second)

    greatest = [float(pressures[case][k]) for case, k in worst]
    first = worst[first_greatest(greatest)]
    chosen = {at: load(at) for at in (first, *worst)}
    width = _half_width(chosen[first])
    chosen = {
        at: load
        for at, load in chosen.items()
        if width / ONE_MESH < _half_width(load) < width * ONE_MESH
    }
    for angle in angles:
        apart = np.abs(np.angle(np.exp(1j * (cycles[0].theta - angle))))
        at = 0, first_least(np.where(pressures[0] > 0, apart, np.inf))
        if pressures[0][at[1]] > 0 and at not in chosen:
            chosen[at] = load(at)
    return _DiscLoads(tuple(chosen.values()), max(greatest))


def _half_width(load: LengthLoad) -> float:
    """Half-width of plane strain, m."""
    return plane_strain(load.pair, load.force)[0]


def _length_load(cycle: Cycle, index: int, *, second: bool) -> LengthLoad:
    """Contact of a load case at a position, with the end and the moment that give the greatest
    signed pressure; second : on the second of preloaded discs.
    """
    machine, other = cycle.machine, cycle.on_other_track
    bears_less = other is not None and second != bool(cycle.loads.wall[index] < 0.0)
    if other is not None and bears_less:
        cycle = other
    if cycle.length is None:
        raise ResultError("pressure along the line of contact: missing")
    force = cycle.loads.normal_force[[index]]
    curvature = 1.0 / cycle.contact.relative_radius[[index]]
    loaded = machine.with_second_in_place(cycle.contour) if second else machine
    tried = [
        (pair, pressed.bodies, share * cycle.length.moment[[index]])
        for pair, pressed in zip(machine.finite_pairs, loaded.finite_pairs, strict=True)
        for share in (0.0, 1.0, -1.0)
    ]
    lines = [
        signed_factor(length_table(pair, cycle.length.mean_length), curvature, force, moment)
        for pair, _, moment in tried
    ]
    chosen = first_greatest([line.value[0] for line in lines])
    pair, bodies, moment = tried[chosen]
    return LengthLoad(
        load_case=cycle.load_case,
        theta=float(cycle.theta[index]),
        pair=replace(pair, bodies=bodies, curvature=float(curvature[0])),
        force=float(force[0]),
        moment=float(moment[0]),
        factor=float(lines[chosen].value[0]),
        centre=float(lines[chosen].centre[0]),
        second=second,
        bears_less=bears_less,
    )


def _curvature_change(history: ContactHistory) -> Array:
    """Change of the curvature of the contact about each position (n,), 1/m."""
    curvature = 1 / history.relative_radius
    return np.abs(np.roll(curvature, -1) - np.roll(curvature, 1))


_EXTREMES: tuple[Callable[[ContactHistory], Array], ...] = (
    lambda h: np.nan_to_num(h.p0),
    lambda h: h.line_load,
    lambda h: h.relative_radius,
    lambda h: -h.relative_radius,
    _curvature_change,
    lambda h: np.nan_to_num(h.half_width),
    lambda h: -np.where(h.line_load > 0, h.line_load, np.inf),
)


def finest_positions(cycles: Sequence[Cycle], chosen: Sequence[Position]) -> tuple[Position, ...]:
    """The `FINEST` of the chosen positions with the greatest contact pressure, the greatest
    first.
    """
    left, taken = list(chosen), list[Position]()
    while left and len(taken) < FINEST:
        pressures = [at.contact(cycles).p0[at.index] for at in left]
        taken.append(left.pop(first_greatest(pressures)))
    return tuple(taken)


@dataclass(frozen=True, eq=False)
class BegunCertificate:
    """Certificate whose meshes are being solved in worker processes.

    Parameters
    ----------
    chosen : sequence   position of each angle
    finest : sequence   those with the finest mesh; their orders hold for the others
    tasks : mapping     figures of a mesh by angle and edges per half-width
    finer : function    submits the finest mesh at another angle
    observed : sequence   points on three meshes whose orders hold, where none is chosen
    """

    cycles: Sequence[Cycle]
    chosen: Sequence[Position]
    finest: Sequence[Position]
    tasks: Mapping[tuple[Position, float], PendingCall]
    finer: Callable[[Position], PendingCall]
    observed: tuple[CertificatePoint, ...] = ()

    def points(self, advance: Callable[[int, int], None]) -> tuple[CertificatePoint, ...]:
        """Certificate points at the chosen angles, when all meshes are solved.

        Where two meshes leave more than `_FINER_ABOVE` to the cycle, with the finest mesh as well:
        the order of other angles does not hold for a coarse mesh that is off by chance.
        """
        solved: dict[tuple[Position, float], MeshFigures] = {}
        for key, task in self.tasks.items():
            solved[key] = task.result()
            advance(len(solved), len(self.tasks))

        def point(at: Position, worst: Sequence[CertificatePoint] = ()) -> CertificatePoint:
            """Certificate point at a position from its solved meshes; `worst`: points on three
            meshes, whose order holds for one on two.
            """
            meshes = [solved[at, edges] for edges in EDGES if (at, edges) in solved]
            history, theta = at.contact(self.cycles), at.theta(self.cycles)
            solved_point = certificate_point(history, at.index, theta, meshes, worst)
            return replace(solved_point, bears_less=at.idle)

        worst = {at: point(at) for at in self.finest}
        observed = self.observed or tuple(worst.values())
        certified = {at: worst.get(at) or point(at, observed) for at in self.chosen}
        doubtful = [
            at for at, one in certified.items() if at not in worst and one.spread > _FINER_ABOVE
        ]
        waiting = {at: self.finer(at) for at in doubtful}
        for at, task in waiting.items():
            solved[at, EDGES[-1]] = task.result()
            certified[at] = point(at)
        return tuple(certified[at] for at in self.chosen)


def begun(
    cycles: Sequence[Cycle],
    chosen: Sequence[Position],
    workers: Crew,
    observed: tuple[CertificatePoint, ...] = (),
    store: ContactStore = NOT_STORED,
) -> BegunCertificate:
    """Certificate at chosen positions, its meshes submitted to worker processes.

    The finest mesh is solved at `finest_positions` alone; nowhere with the points `observed` on
    three meshes, whose orders then hold, and where the two coarser ones leave too much to the
    cycle. Figures that the store has are not solved again.
    """

    def submitted(at: Position, edges: float, number: int) -> PendingCall:
        """Pending figures of a mesh at a position; number : of the piece in the store."""
        loaded = at.pair(cycles)
        force = float(at.contact(cycles).line_load[at.index]) * loaded.width
        return workers.submit(_figures, store, number, loaded, at.theta(cycles), force, edges)

    finest = () if observed else finest_positions(cycles, chosen)
    tasks: dict[tuple[Position, float], PendingCall] = {}
    for edges in reversed(EDGES):  # the longest first
        for at in chosen:
            if edges == EDGES[-1] and at not in finest:
                continue
            tasks[at, edges] = submitted(at, edges, len(tasks))

    def finer(at: Position) -> PendingCall:
        return submitted(at, EDGES[-1], len(tasks) + chosen.index(at))

    return BegunCertificate(cycles, chosen, finest, tasks, finer, observed)


def _figures(
    store: ContactStore, index: int, pair: ContactPair, theta: float, force: float, edges: float
) -> MeshFigures:
    """Figures of a mesh at a cam angle, rad, and a normal force, N, from the store if it has them;
    index : of the piece in the store, edges : elements per half-width.
    """
    key = piece_key(pair, np.array(force), theta, edges)

    def solved() -> Arrays:
        figures = asdict(mesh_figures(pair, theta, force, edges))
        return {name: np.array(value) for name, value in figures.items()}

    piece = kept_piece(store, _STORED_AS, index, key, solved)
    values = {name: float(value) for name, value in piece.items()}
    return MeshFigures(dofs=int(values.pop("dofs")), **values)
