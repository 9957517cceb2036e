"""Solution: turns, contact and cycles of a cam in every load case, at one depth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.errors import CamError
from camwright.geometry.extrema import TIE, first_greatest
from camwright.geometry.second_track import CamDisc, discs_of
from camwright.geometry.track_deviation import EXACT, TrackDeviation
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.mesh_quality import Quality, gate, quality
from camwright.pipeline.base.kept_results import KeptResult
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.store import Arrays
from camwright.pipeline.base.worker_processes import Crew
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import END_MEAN_LENGTH
from camwright.pipeline.case.machine import Machine, machines
from camwright.pipeline.contact.bore_stress import bore_stress
from camwright.pipeline.contact.certificate import EDGES, contact_meshes
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.contact_benchmarks import benchmarks
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.finite_length.length_certificate import (
    BegunEnds,
    LengthCertificate,
    begun_ends,
)
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, loaded_cam, two_scale_history
from camwright.pipeline.cycle.certificate_angles import begun, length_loads, positions_to_certify
from camwright.pipeline.cycle.contact_setup import contact_pair, under_load
from camwright.pipeline.cycle.contact_store import (
    NOT_STORED,
    ContactStore,
    kept_piece,
    piece_key,
)
from camwright.pipeline.cycle.crank_speed import SpeedRipple
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.hub_history import HubFatigue, hub_fatigue
from camwright.pipeline.cycle.numbers import Numbers, presses
from camwright.pipeline.cycle.solved_cam import ForcesCam, SolvedCam, numbers_of_discs
from camwright.pipeline.cycle.speed_sweep import (
    SpeedSweep,
    SpringSweep,
    highest_speed,
    speed_sweep,
    spring_sweep,
)
from camwright.pipeline.cycle.turn import Turn, TurnInput, turns
from camwright.pipeline.follower.spring import LEAST_DAMPING
from camwright.pipeline.torque.torque import Torque

# Positions solved and stored together; an interruption loses at most one such piece.
CHUNK = 180
MESHING, CONTACT = "mesh", "cycle"
CERTIFICATE, BENCHMARKS, ENDS = "certificate", "benchmarks", "ends"
_OTHER_TRACK = ".idle"
"""Ending of the name of the load case under which the contact of that track is stored."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactMesh(Displayed):
    """Meshes of cam and follower for the contact at the worst angle, rad.

    `name` is that of the follower's body: roller or face.
    """

    theta: float
    half_width: float
    cam: BodyMesh
    follower: BodyMesh
    name: str
    quality: Quality

    @property
    def longest_edge(self) -> float:
        """Longest edge in the contact of both bodies, m."""
        return self.half_width / self.quality.edges_across_half_width


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Displayed):
    """Solved cam in every load case; input of the checks and of the results.

    Parameters
    ----------
    machines, cycles : tuple     one a load case, the design load case first
    mesh : ContactMesh           None in a preview, and if the contour encloses no body: the
                                 contact is then NaN
    certificate : tuple          full two-body solutions; empty unless certified
    length_certificate : object  contact of bodies with ends by both tiers; None unless certified
                                 by finite elements
    benchmarks : mapping         see `benchmarks`; None unless certified
    crank_speed : mapping        load case -> std of the crank speed, rad/s, without and with the
                                 cam; empty without a crankshaft
    crank_speed_halved : mapping   the same of the torque at every second crank angle
    bore_error : float           discretisation error of the bore stress, relative; None: not known
    coarse : bool                coarse guide mesh, constant crank speed: for ratios of demands
    synthesis_gain : float       of its lift: what another step of the synthesis would gain, of the
                                 engine's ripple; None: not a synthesis, or one without a cam
                                 within all limits
    results : dict               sweeps over the speed by name, computed on first use
    """

    case: Case
    contour: Contour
    machines: tuple[Machine, ...]
    tier: Tier
    mesh: ContactMesh | None
    cycles: tuple[Cycle, ...]
    certificate: tuple[CertificatePoint, ...] = ()
    length_certificate: LengthCertificate | None = None
    benchmarks: Mapping[str, float] | None = None
    crank_speed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    crank_speed_halved: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    bore_error: float | None = None
    coarse: bool = False
    synthesis_gain: float | None = None
    results: dict[str, object] = field(default_factory=dict, init=False, repr=False)

    @property
    def machine(self) -> Machine:
        """The machine in the design load case."""
        return self.machines[0]

    @property
    def discs(self) -> tuple[CamDisc, ...]:
        """CamDisc of the contour, and the second one of a conjugate pair."""
        return discs_of(self.contour, self.machine.cam.second)

    @property
    def least_radius(self) -> float:
        """Minimum radius of the contour of all discs, m."""
        return min(float(each.contour.radius_min().value) for each in self.discs)

    @property
    def pressure_angle_max(self) -> float:
        """Maximum pressure angle on all discs, rad."""
        return max(float(each.contour.pressure_angle_max().value) for each in self.discs)

    @property
    def greatest_radius(self) -> float:
        """Maximum radius of all discs, m: of their contours, or of the disc around a groove."""
        groove = self.machine.cam.groove
        if groove is not None:
            return groove.outer_radius
        return max(float(each.contour.radius_max().value) for each in self.discs)

    @cached_property
    def numbers(self) -> Numbers:
        """Numbers of the machine in the design load case, and the greatest cam speed."""
        return numbers_of_discs(self.case, self.machines, self.contour)

    @cached_property
    def cams(self) -> Mapping[Cycle, SolvedCam]:
        """Loaded cam of each cycle."""
        return {each: SolvedCam.of(each, self.numbers) for each in self.cycles}

    @cached_property
    def cams_between(self) -> Mapping[Cycle, ForcesCam]:
        """Loaded cam of each cycle at the angles of `Cycle.loads_between`."""
        return {each: ForcesCam.between(each, self.numbers) for each in self.cycles}

    def adopt(self, other: Solution) -> None:
        """Take over results of another solution of the same loads, but for the crank speed."""
        for cycle, same in zip(self.cycles, other.cycles, strict=True):
            cycle.adopt(same)
        self.results.update(other.results)

    @KeptResult
    def speed_sweeps(self) -> tuple[SpeedSweep, ...]:
        """Sweeps from standstill to over-speed, one for each preload of the load cases."""
        first = {cycle.machine.spring.preload: cycle for cycle in reversed(self.cycles)}
        return tuple(
            speed_sweep(each.machine, self.contour, each.loads.rubbing, self._speeds)
            for each in first.values()
        )

    @KeptResult
    def hardest_spring(self) -> SpringSweep | None:
        """Least and greatest force at both ends of the hardest spring in tolerance over the speed;
        None without a wound spring.
        """
        design = self.machine.spring.design
        if design is None:
            return None
        preload = max(machine.spring.preload for machine in self.machines)
        return spring_sweep(self.machine, design, self.contour.pitch, preload, self._speeds)

    @cached_property
    def least_damped(self) -> Solution | None:
        """The solution with the least damping ratio that a spring may have, for its surge; None if
        the case states the damping ratio or no design of a coil spring.

        The machines alone are replaced, no cycle is solved again. None in a coarse solution, too,
        and where the cycles have no error bars.
        """
        design, barred = self.machine.spring.design, self.cycles[0].error_bars
        if self.coarse or not barred or design is None or design.damping_ratio is not None:
            return None
        return replace(
            self,
            machines=tuple(_least_damped(each) for each in self.machines),
            cycles=tuple(
                replace(each, turn=replace(each.turn, machine=_least_damped(each.machine)))
                for each in self.cycles
            ),
        )

    @KeptResult
    def hub_fatigue(self) -> HubFatigue | None:
        """Fatigue of the keyway root by finite elements.

        None in a preview, without a press fit or its data, and if the contour encloses no body.
        """
        if self.tier < Tier.CYCLE or self.mesh is None or not presses(self.numbers):
            return None
        return hub_fatigue(self.contour, self.cycles, self.numbers)

    @property
    def _speeds(self) -> tuple[float, ...]:
        """Crank speeds of the load cases and over-speed, rad/s."""
        speeds = [machine.crank_speed for machine in self.machines]
        return (*speeds, highest_speed(self.machines))


def _least_damped(machine: Machine) -> Machine:
    spring = machine.spring
    design = spring.design and replace(spring.design, damping_ratio=LEAST_DAMPING)
    return replace(machine, spring=replace(spring, design=design))


def solution(
    case: Case,
    contour: Contour,
    tier: Tier = Tier.CYCLE,
    *,
    torques: Mapping[str, Torque],
    positions: int | None = None,
    coarse: bool = False,
    bounds: bool = True,
    deviation: TrackDeviation = EXACT,
    store: ContactStore = NOT_STORED,
    progress: Progress = SILENT,
) -> Solution:
    """Solution of a cam in every load case of a case.

    Parameters
    ----------
    torques : mapping     engine torque by load case
    positions : int       per cam turn; None: those of the case
    coarse : bool         coarse guide mesh, constant crank speed: for ratios of demands
    bounds : bool         see `turns`
    deviation : TrackDeviation   of measured tracks
    store : ContactStore  of the pieces of the contact, to resume an interrupted solution

    Raises
    ------
    CamError
        If a mesh, the contact or the guides cannot be solved.
    """
    count = case.solver.positions if positions is None else positions
    states = machines(case, torques, deviation)
    turns = turns_of(states, contour, count, coarse=coarse, bounds=bounds)
    return solved_turns(case, contour, turns, tier, coarse=coarse, store=store, progress=progress)


def turns_of(
    states: tuple[Machine, ...],
    contour: Contour,
    positions: int,
    *,
    coarse: bool = False,
    bounds: bool = True,
) -> tuple[Turn, ...]:
    """Loads of the machine in every load case, before the contact is solved; see `turns`."""
    inputs = [TurnInput(each, contour) for each in states]
    return turns(inputs, positions, coarse=coarse, bounds=bounds)


def solved_turns(
    case: Case,
    contour: Contour,
    turns: tuple[Turn, ...],
    tier: Tier,
    *,
    coarse: bool = False,
    store: ContactStore = NOT_STORED,
    progress: Progress = SILENT,
    speed_contour: Contour | None = None,
    advance: float = 0.0,
    body: bool | None = None,
    error_bars: bool = True,
) -> Solution:
    """Contact and crank speed of turns whose loads are solved.

    Parameters
    ----------
    coarse : bool             the turns are coarse; the crank speed is not computed
    speed_contour : Contour   cam of the crank speed, if its phase on the shaft differs
    advance : float           cam angle by which that cam leads, rad
    body : bool               whether the contour encloses a body; None: to be determined
    error_bars : bool         compute the errors by sampling and by every second crank angle
    """
    states = tuple(each.machine for each in turns)
    pair = contact_pair(states[0], contour)
    mesh = bodies = None
    if body is None:
        body = all(is_body(each.contour) for each in discs_of(contour, states[0].cam.second))
    if body and tier >= Tier.CYCLE:
        progress.stage(MESHING)
        mesh = meshed(pair, turns)
        progress.stage(CONTACT)
        # One pair of meshes, factored once, serves every load case.
        bodies = CycleBodies.meshed(pair)
    cycles = tuple(
        Cycle(
            each,
            contour,
            loaded,
            bodies,
            _contact(loaded, bodies, each, body, store, progress),
            error_bars=error_bars,
            idle=_idle(loaded, bodies, each, body, store, progress),
        )
        for each, loaded in ((each, under_load(pair, each.loads)) for each in turns)
    )
    rubbing = {c.load_case: c.loads.rubbing for c in cycles}
    rubbing = {name: replace(each, theta=each.theta - advance) for name, each in rubbing.items()}
    pitch = (speed_contour or contour).pitch
    solved = Solution(case, contour, states, tier, mesh, cycles, coarse=coarse)
    if coarse:
        return solved
    solved = replace(solved, crank_speed=SpeedRipple(states, pitch, rubbing))
    if not error_bars:
        return solved
    halved = tuple(_halved(each) for each in states)
    return replace(solved, crank_speed_halved=SpeedRipple(halved, pitch, rubbing))


def _halved(machine: Machine) -> Machine:
    """The machine with its torque at every second crank angle."""
    torque = machine.torque
    return replace(machine, torque=torque and torque.resampled(torque.theta.size // 2))


def certified_solution(
    solved: Solution,
    workers: Crew,
    *,
    store: ContactStore = NOT_STORED,
    progress: Progress = SILENT,
) -> Solution:
    """Solution with certificate and benchmarks added.

    Parameters
    ----------
    workers : Crew         processes that solve the meshes
    store : ContactStore   of the figures of the meshes, to resume an interrupted certificate
    """
    final = replace(solved, tier=Tier.CERTIFIED)
    chosen = positions_to_certify(solved.cycles, solved.case.solver.certificate_positions)
    if solved.mesh is None or not chosen:
        return final
    pair = solved.cycles[0].pair
    ends = _begun_ends(solved, workers, progress)
    certificate = begun(solved.cycles, chosen, workers, store=store)
    progress.stage(BENCHMARKS)
    differences = benchmarks(solved.case.contact_radius)
    error = bore_error(pair, solved.cycles)
    progress.stage(CERTIFICATE)
    points = certificate.points(progress.advance)
    final = replace(final, certificate=points, benchmarks=differences, bore_error=error)
    return final if ends is None else _with_ends(final, ends, progress)


def _begun_ends(
    solved: Solution, workers: Crew, progress: Progress
) -> BegunEnds | LengthCertificate | None:
    """Certificate of the contact of finite length, its meshes submitted to worker processes; a
    refused one where they cannot be made, None without body ends.
    """
    elements, mean_length = solved.case.solver.end_elements, solved.machine.limits[END_MEAN_LENGTH]
    if elements == 0:
        return None
    loads = length_loads(solved.cycles, solved.case.solver.end_angles)
    if not loads:
        return None
    try:
        begun_blocks = begun_ends(loads, mean_length, elements, workers)
    except CamError as error:
        return LengthCertificate((), mean_length, elements, str(error))
    if begun_blocks.fresh:
        progress.note(
            f"finite-element ends: {begun_blocks.fresh} meshes of the ends of cam and"
            f" {solved.cycles[0].pair.follower.name} are solved and kept for the next run"
        )
    return begun_blocks


def _with_ends(
    final: Solution, ends: BegunEnds | LengthCertificate, progress: Progress
) -> Solution:
    """The solution with the certificate of its ends, and with cycles corrected by it."""
    progress.stage(ENDS)
    try:
        certificate = (
            ends if isinstance(ends, LengthCertificate) else ends.certificate(progress.advance)
        )
    except CamError as error:
        certificate = LengthCertificate((), ends.mean_length, ends.elements, str(error))
    if certificate.refused:
        progress.note(
            f"finite-element ends: not solved, the stated error bars hold: {certificate.refused}"
        )
    cycles = tuple(each.with_ends(certificate.corrections) for each in final.cycles)
    return replace(final, length_certificate=certificate, cycles=cycles)


def bore_error(pair: ContactPair, cycles: tuple[Cycle, ...]) -> float | None:
    """Relative error of the greatest bore stress of all cycles, by a mesh of half the element size.

    3 times the change at the worst cam angle, under the same excluded zone: the grid convergence
    index of two meshes at the order 1. None where a cycle has no bore stress or an unknown one, and
    without load.

    References
    ----------
    Roache (1998), sec. 5.6.
    """
    worst: tuple[float, Cycle, int] | None = None
    both = ((each, each.on_other_track) for each in cycles)
    for cycle in (track for pair in both for track in pair if track is not None):
        bore = cycle.rolling.bore
        if bore is None or np.isnan(bore.away_from_edges).any():
            return None
        k = first_greatest(bore.away_from_edges)
        if worst is None or bore.away_from_edges[k] > worst[0] * (1.0 + TIE):
            worst = float(bore.away_from_edges[k]), cycle, k
    if worst is None or not worst[0] > 0:
        return None
    value, cycle, k = worst
    theta, bore = cycle.theta[[k]], cycle.rolling.bore
    pressed = cycle.pair.carrying(float(theta[0]))
    pressed = pair if pressed.rim_radius is not None else pressed
    fine = bore_stress(
        loaded_cam(pressed, refinement=2.0),
        *pressed.touched(theta),
        cycle.contact.line_load[[k]],
        excluded=None if bore is None else bore.excluded,
    )
    return float(3.0 * abs(fine.away_from_edges[0] / value - 1.0))


def is_body(contour: Contour) -> bool:
    """Whether the contour encloses a body: no undercut, no self-intersection."""
    return not contour.undercut().present and not contour.self_intersections()


def meshed(pair: ContactPair, turns: tuple[Turn, ...]) -> ContactMesh | None:
    """Meshes of cam and follower at the angle of maximum Hertz pressure over all turns; None
    without load.

    Raises
    ------
    MeshError
        If a mesh does not pass the quality gate.
    """
    worst = None
    for each in turns:
        loaded = under_load(pair, each.loads)
        history = closed_form_history(loaded, each.theta, each.loads.normal_force)
        k = first_greatest(history.p0)
        if history.p0[k] > 0 and (worst is None or history.p0[k] > worst[0] * (1.0 + TIE)):
            theta = float(each.theta[k])
            worst = history.p0[k], theta, float(history.half_width[k]), loaded.carrying(theta)
    if worst is None:
        return None
    _, theta, half_width, pair = worst
    bodies = contact_meshes(pair, theta, half_width, EDGES[1])
    contact, _ = pair.touched(theta)
    gated = [gate(quality(body, contact, half_width), edges_min=EDGES[1]) for body in bodies]
    both = Quality(
        min_angle_deg=min(q.min_angle_deg for q in gated),
        min_scaled_jacobian=min(q.min_scaled_jacobian for q in gated),
        edges_across_half_width=min(q.edges_across_half_width for q in gated),
        elements=sum(q.elements for q in gated),
        nodes=sum(q.nodes for q in gated),
    )
    return ContactMesh(theta, half_width, *bodies, pair.follower.name, both)


def _contact(
    pair: ContactPair,
    bodies: CycleBodies | None,
    each: Turn,
    body: bool,
    store: ContactStore,
    progress: Progress,
) -> ContactHistory:
    """Contact over a turn.

    Parameters
    ----------
    pair : ContactPair             contour, bodies and materials
    bodies : CycleBodies or None   meshed bodies: by finite elements; None: Hertz, in closed form
    each : Turn                    with cam angles and normal forces
    body : bool                    False: the contour encloses no body, and all values are NaN
    store : ContactStore           of pieces that are solved already
    """
    if not body:
        return ContactHistory.unknown(each.theta.size)
    if bodies is None:
        return closed_form_history(pair, each.theta, each.loads.normal_force)
    pieces = list(_pieces(pair, bodies, each, store, progress))
    arrays = {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
    return ContactHistory(**arrays, tier=Tier.CYCLE)


def _idle(
    pair: ContactPair,
    bodies: CycleBodies | None,
    each: Turn,
    body: bool,
    store: ContactStore,
    progress: Progress,
) -> ContactHistory | None:
    """Contact over a turn on the track that bears less, of preloaded discs; None of others.

    Parameters as of `_contact`.
    """
    if each.machine.disc_preload is None:
        return None
    machine = replace(each.machine, load_case=f"{each.machine.load_case}{_OTHER_TRACK}")
    loads = replace(each.loads, normal_force=each.loads.idle_force)
    other = replace(each, machine=machine, loads=loads)
    return _contact(pair.other_track, bodies, other, body, store, progress)


def _pieces(
    pair: ContactPair, bodies: CycleBodies, each: Turn, store: ContactStore, progress: Progress
) -> Iterator[Arrays]:
    """Arrays of the contact over a turn in pieces of `CHUNK` positions in order, each from the
    store if it has it.
    """
    name, key = each.machine.load_case, piece_key(pair, each.loads.normal_force, CHUNK)
    total = -(-each.theta.size // CHUNK)
    for index in range(total):
        part = slice(index * CHUNK, (index + 1) * CHUNK)
        solved = partial(_piece, pair, bodies, each.theta[part], each.loads.normal_force[part])
        yield kept_piece(store, name, index, key, solved)
        progress.advance(index + 1, total)


def _piece(pair: ContactPair, bodies: CycleBodies, theta: Array, normal_force: Array) -> Arrays:
    return two_scale_history(pair, bodies, theta, normal_force).arrays
