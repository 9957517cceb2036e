"""The road, one line a stage: torque, lift, contour, mesh, cycle, checks, smoothing, report."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.errors import CamError
from camwright.geometry.lift import Lift
from camwright.pipeline import solver as road
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.given_lift import lift_origin
from camwright.pipeline.case.load_case_torque import measurement_record
from camwright.pipeline.checks.tolerance_corners import governed, outcomes
from camwright.pipeline.checks.tolerance_corners import record as corners_record
from camwright.pipeline.checks.verdict import binding, in_order, verdict
from camwright.pipeline.contact.contact_benchmarks import benchmarks
from camwright.pipeline.contact.contact_pair import ContactPair, CycleBodies
from camwright.pipeline.cycle.certificate_angles import certified, positions_to_certify
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.crank_speed import consistency, rubbing_of, speed_record, study_of
from camwright.pipeline.cycle.cycle import Cycle, finished
from camwright.pipeline.cycle.guide_pressure import bush_arrays
from camwright.pipeline.cycle.rolling_history import (
    envelope_arrays,
    rolling_history,
    rolling_record,
)
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.cycle.valve_train import valve_record
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.results.field_output import write_fields
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_records import (
    contour_columns,
    headline,
    lift_columns,
    pressure_arrays,
    trial_record,
)
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.results.workshop_files import write_shop
from camwright.pipeline.smoothing import fe_correction
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.multistart import Starts, explored
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.roller_alternatives import roller_problems
from camwright.pipeline.smoothing.shadow_prices import limits_in_use
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.smoothing_feedback import Next, Stop, next_smoother
from camwright.pipeline.smoothing.smoothing_forecast import Attempt


@dataclass
class Stopwatch:
    """Seconds per stage; a stage timed again counts anew, so the last trial is what stays."""

    seconds: dict[str, float] = field(default_factory=dict)
    began: float = field(default_factory=time.perf_counter)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start

    def read(self) -> dict[str, float]:
        total = time.perf_counter() - self.began
        return {name: round(s, 3) for name, s in (self.seconds | {"total": total}).items()}


@dataclass(frozen=True, eq=False)
class Journey:
    """What every trial of a run shares."""

    case: Case
    folder: RunFolder
    torques: Mapping[str, Torque]
    progress: Progress
    watch: Stopwatch


def run_case(
    case: Case,
    out: Path,
    *,
    positions: int | None = None,
    jobs: int | None = None,
    resume: bool = False,
    progress: Progress,
    present: Callable[[Path], object] = lambda _: None,
) -> dict[str, Any]:
    """Walk a case down the road until it passes or the limit that binds is named.

    Parameters
    ----------
    positions : int   per cam turn, instead of the case's
    jobs : int        processes for the certificate; default: the processors there are, at most 4
    resume : bool     go on with what an interrupted run left
    present : callable   draws page and pictures into the folder, from its files alone

    Returns
    -------
    dict    the contents of ``run.json``

    Raises
    ------
    CamError
        In one line, for whatever the user can act upon.
    """
    case = case if positions is None else case.with_positions(positions)
    with RunFolder(out, case, resume=resume) as folder:
        watch = Stopwatch()
        progress.stage("torque")
        with watch.stage("torque"):
            torques = road.engine_torques(case)
            _write_torque(folder, case, torques)
        journey = Journey(case, folder, torques, progress, watch)
        journey, trials, stop = _trials(journey)
        case = journey.case  # with the spring and base radius of a constrained synthesis
        final = _at_corners(journey, _certified(journey, trials[-1], jobs))
        for done in (*trials[:-1], final):
            folder.write_checks(done.number, [check.as_record() for check in done.checks])
            turns = {cycle.load_case: cycle.rolling for cycle in done.cycles}
            folder.write_trial(
                done.number, trial_record(case, done) | {"rolling": rolling_record(turns)}
            )
        _write_fields(journey, final)
        _write_shop(journey, final)
        summary = {
            "timings_s": watch.read(),
            "trials": len(trials),
            "verdict": verdict(final.checks),
            "binding": list(binding(final.checks)),
            "statement": stop.reason,
            "headline": headline(case, torques, final),
            "prices": None if final.synthesis is None else final.synthesis["prices"],
            "benchmarks": benchmarks(case.contact_radius) if final.certificate else None,
            "mesh_quality": None if final.mesh is None else asdict(final.mesh.quality),
            "valve_train": valve_record(case, final.cycles),
            **_crank_speed(folder, case, torques, final),
        }
        with watch.stage("report"):
            progress.stage("report")
            folder.write_summary(summary)
            present(folder.path)
        return folder.finish(summary | {"timings_s": watch.read()})


def _trials(journey: Journey) -> tuple[Journey, list[Trial], Stop]:
    """Trials until one passes or none could do better."""
    case = journey.case
    if case.smoothing.kind == "constrained":
        return _constrained_trials(journey)
    if case.engine is None:
        alone = _trial(journey, 1, None, lift_origin(case))
        found = binding(alone.checks)
        reason = "the given lift passes" if not found else "a given lift is not smoothed"
        return journey, [alone], Stop(reason, found, 1)
    step = Next(Smoother.from_case(case.smoothing), "the smoothing the case asks for")
    foreseen = cache(partial(road.foreseen, case, journey.torques))
    trials: list[Trial] = []
    while True:
        trials.append(_trial(journey, len(trials) + 1, step.smoother, step.why))
        attempts = [Attempt(t.smoother, t.checks) for t in trials if t.smoother is not None]
        after = next_smoother(attempts, case.solver.max_trials, foreseen)
        if isinstance(after, Stop):
            return journey, trials, after
        journey.progress.note(f"trial {len(trials)} fails: {after.why}")
        step = after


def _constrained_trials(journey: Journey) -> tuple[Journey, list[Trial], Stop]:
    """Synthesis and finite elements in turn, until these move no limit in use any more."""
    given, problem = journey.case, problem_of(journey.case, journey.torques)
    why = "the cam of least ripple within all limits"
    trials: list[Trial] = []
    starts: Starts | None = None
    earlier: fe_correction.Moved | None = None
    while True:
        journey.progress.stage(f"trial {len(trials) + 1}: synthesis")
        with journey.watch.stage("synthesis"):
            if trials:  # from the trial before, whose optimum it follows
                design = synthesise(problem)
            else:
                design, starts = explored(problem, given.smoothing.starts)
        journey = replace(journey, case=fe_correction.redrawn(given, design))
        done = _trial(journey, len(trials) + 1, None, why, design.lift())
        drawn_from = None if trials else starts
        trials.append(
            replace(done, synthesis=fe_correction.design_record(design, problem, drawn_from))
        )
        journey.folder.write_limits(len(trials), *limits_in_use(design))
        found = binding(done.checks)
        if not design.feasible:
            journey.progress.stage("which limits conflict")
            report = infeasibility(problem, roller_problems(given, journey.torques, problem))
            record = {**(trials[-1].synthesis or {}), "infeasible": report.as_record()}
            trials[-1] = replace(trials[-1], synthesis=record)
            return journey, trials, Stop(report.sentence, found, len(trials))
        corrections = fe_correction.corrections_of(done.cycles)
        moved = fe_correction.moved(design, problem, corrections)
        settled = fe_correction.settled(moved, done.checks)
        if settled or done.mesh is None or len(trials) == given.solver.max_trials:
            last = f"trial {len(trials)} {'fails' if found else 'passes every must-have check'}"
            agree = "" if starts is None else f"; {starts.sentence}"
            reason = f"{last}; {moved.sentence}{agree}"
            return journey, trials, Stop(reason, found, len(trials))
        why = moved.sentence
        journey.progress.note(f"trial {len(trials)}: {why}")
        problem = fe_correction.refined_problem(problem, design, corrections, moved.swing(earlier))
        earlier = moved


def _trial(
    journey: Journey, number: int, smoother: Smoother | None, why: str, lift: Lift | None = None
) -> Trial:
    """One trial, written down as it goes; the lift is drawn by the smoother unless given."""
    case, folder, progress, watch = (
        journey.case, journey.folder, journey.progress, journey.watch
    )  # fmt: skip
    progress.stage(f"trial {number}: lift and contour")
    with watch.stage("lift"):
        if lift is None:
            lift = road.designed_lift(case, journey.torques, smoother)
        folder.write_lift(number, lift_columns(case, lift))
    with watch.stage("contour"):
        contour = road.cam_contour(case, lift)
        folder.write_contour(number, contour_columns(case, contour))
        sound = road.is_body(contour)
        turns = road.turns_of(case, contour, journey.torques, case.solver.positions)
    progress.stage(f"trial {number}: mesh")
    with watch.stage("mesh"):
        mesh = road.meshed(contact_pair(case, contour), turns) if sound else None
        if mesh is not None:
            road.write_mesh(folder.mesh_path(number), mesh)
    progress.stage(f"trial {number}: contact")
    with watch.stage("cycle"):
        if sound:
            # One pair of meshes, factored once, serves every load case.
            pair = contact_pair(case, contour)
            bodies = CycleBodies.meshed(pair)
            cycles = tuple(_cycle(journey, number, pair, bodies, given) for given in turns)
        else:
            cycles = tuple(
                finished(case, contour, given, road.unknown_contact(given)) for given in turns
            )
        _write_cycles(journey, number, cycles)
    progress.stage(f"trial {number}: checks")
    with watch.stage("checks"):
        made = Trial(number, smoother, why, lift, contour, cycles, mesh, ())
        return road.checked(case, made, journey.torques, searching=True)


def _cycle(
    journey: Journey, number: int, pair: ContactPair, bodies: CycleBodies, given: Turn
) -> Cycle:
    """The contact of a turn, kept piece by piece so that an interruption loses little."""
    key = road.chunk_key(pair, given)
    known = journey.folder.load_chunks(number, given.load_case, key)
    pieces = {}
    total = road.chunk_count(given)
    for index, arrays in road.contact_chunks(pair, bodies, given, known):
        pieces[index] = arrays
        if index not in known:
            journey.folder.save_chunk(number, given.load_case, index, arrays, key)
        journey.progress.advance(index + 1, total)
    contact = road.joined(pieces)
    done = finished(journey.case, pair.contour, given, contact)
    state = journey.case.at(given.load_case)
    speed = given.crank_speed / state.mechanism.gear_ratio
    return replace(
        done,
        rolling=rolling_history(state, pair, bodies, given.loads, contact, speed),
    )


def _certified(journey: Journey, final: Trial, jobs: int | None) -> Trial:
    """The final trial with its certificate, checked again."""
    case, progress = journey.case, journey.progress
    if final.mesh is None:
        return road.checked(case, final, journey.torques)
    chosen = positions_to_certify(final.cycles, case.solver.certificate_positions)
    if not chosen:
        return road.checked(case, final, journey.torques)
    progress.stage(f"certificate at {len(chosen)} angles")
    with journey.watch.stage("certificate"):
        points = certified(
            contact_pair(case, final.contour), final.cycles, chosen, jobs, progress.advance
        )
    progress.stage("benchmarks")
    with journey.watch.stage("benchmarks"):
        solved = benchmarks(case.contact_radius)
    return road.checked(case, replace(final, certificate=points), journey.torques, solved)


def _at_corners(journey: Journey, final: Trial) -> Trial:
    """The final trial with each check's governing corner; ``corners.json`` on the way."""
    journey.progress.stage("tolerance corners")
    with journey.watch.stage("corners"):
        found = outcomes(journey.case, journey.torques, final.contour)
        if len(found) > 1:
            journey.folder.write_corners(corners_record(journey.case, found))
        return replace(final, checks=in_order(governed(final.checks, found)))


def _write_torque(folder: RunFolder, case: Case, torques: Mapping[str, Torque]) -> None:
    if not torques:
        return
    design = torques[case.load_cases[0].name]
    parts = {"total": design.total, **design.components}
    folder.write_torque(design.theta_crank, parts)


def _crank_speed(
    folder: RunFolder, case: Case, torques: Mapping[str, Torque], final: Trial
) -> dict[str, Any]:
    """Ripple of the crank with the final cam, whether the inputs agree, what was measured."""
    pitch, ripple, findings = final.contour.pitch, {}, []
    running = [state for state in case.load_cases if state.name in torques and state.speed > 0]
    for number, state in enumerate(running):
        torque = torques[state.name]
        rubbing = rubbing_of(final.cycles)[state.name]
        study = None
        try:
            study = study_of(case.at(state.name), torque, state.speed, pitch, rubbing)
        except CamError as error:  # a crank that stalls contradicts the case, not the cam
            ripple[state.name] = {"refused": str(error)}
        if study is not None:
            radius = final.contour.radius_max().value
            ripple[state.name] = speed_record(study, radius)
            if number == 0:
                folder.write_speed(study.columns)
        asked = None
        if number == 0 and final.smoother is not None and case.smoothing.kind != "constrained":
            asked = road.asked_torque(case, torque, final.smoother)
        found = consistency(case, state, torque, pitch, study, asked, rubbing)
        findings += [{"load_case": state.name, **one.as_record()} for one in found]
    measured = measurement_record(case)
    return {"speed": ripple or None, "consistency": findings, "measurement": measured}


def _write_cycles(journey: Journey, number: int, cycles: tuple[Cycle, ...]) -> None:
    """All load cases, one below the other."""
    ratio = journey.case.mechanism.gear_ratio
    tables = [cycle.columns(ratio) for cycle in cycles]
    names = dict.fromkeys(name for table in tables for name in table)
    # What one load case knows and another does not, such as the torque of an engine at rest.
    unknown = np.full(cycles[0].theta.size, np.nan)
    journey.folder.write_cycle(
        number, {name: np.concatenate([t.get(name, unknown) for t in tables]) for name in names}
    )
    journey.folder.write_pressure(number, pressure_arrays(cycles))
    journey.folder.write_bushes(number, bush_arrays(journey.case, cycles))
    turns = {cycle.load_case: cycle.rolling for cycle in cycles}
    journey.folder.write_envelope(number, envelope_arrays(turns))


def _write_fields(journey: Journey, final: Trial) -> None:
    journey.progress.stage("fields")
    with journey.watch.stage("fields"):
        write_fields(journey.folder.fields, journey.case, final, journey.progress.advance)


def _write_shop(journey: Journey, final: Trial) -> None:
    if final.mesh is None:
        return  # no body, nothing to cut
    journey.progress.stage("shop")
    note = journey.progress.note
    write_shop(journey.folder.path / "shop", journey.case, final.contour, note=note)
