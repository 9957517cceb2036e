"""Records of a run: table columns, headline, trial, crank speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError
from camwright.geometry.extrema import first_greatest, greatest, sampled_peak
from camwright.geometry.form_closure import groove_wall
from camwright.geometry.lift import Lift
from camwright.meshes.mesh_quality import Quality
from camwright.pipeline.base.tables import CAM_ANGLE, CRANK_ANGLE, Cells, Column, Values
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import SHAFT_SAFETY, SPRING_FATIGUE
from camwright.pipeline.case.plausibility import implausible
from camwright.pipeline.checks.camshaft_strength import shaft_fatigue_points
from camwright.pipeline.checks.extremes import on_both_tracks, steady, tracks_of
from camwright.pipeline.checks.spring_strength import spring_fatigue_points
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence
from camwright.pipeline.contact.hertz import von_mises_peak
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cam_balance import balance
from camwright.pipeline.cycle.crank_speed import SpeedStudy, consistency, study_of
from camwright.pipeline.cycle.cycle import (
    CONTOUR_RADIUS,
    LIFT,
    PITCH_RADIUS,
    PRESSURE_ANGLE,
    Cycle,
)
from camwright.pipeline.cycle.length_records import length_record
from camwright.pipeline.cycle.rolling_history import rolling_record
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.speed_sweep import SpeedSweep
from camwright.pipeline.engine.crankshaft import CrankMotion
from camwright.pipeline.records.check_document import CamFigures, LoadCaseFigures
from camwright.pipeline.records.run_summary import (
    BodyStresses,
    CrankSpeedRecord,
    Finding,
    HeadlineRecord,
    MotionRecord,
    QualityRecord,
    Refused,
    SpeedRecord,
)
from camwright.pipeline.records.trial_contents import (
    CertificateRecord,
    ConvergenceRecord,
    FatigueRecord,
    RollingRecord,
    TrialContents,
)
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.torque.torque import Torque

SPLINE = (
    Column("spline_c0", "m", "Lift at the knot"),
    Column("spline_c1", "m/rad", "Lift to the next knot: coefficient of the angle from the knot"),
    *(
        Column(f"spline_c{k}", f"m/rad^{k}", f"Coefficient of power {k} of that angle, rad")
        for k in range(2, 6)
    ),
)
"""Coefficients of the lift from one knot to the next, in SI units: they read back bit for bit."""
PRESSURE_ARRAYS = (
    Column("load_case", "", "(n,) load case of each row of `5_cycle.csv`"),
    Column("cam_angle", "deg", "(n,) cam angle of the row"),
    Column("distance_from_contact", "mm", "(n, k) distance from the contact along its tangent"),
    Column("contact_pressure", "MPa", "(n, k) contact pressure there"),
)
"""Arrays of ``5_pressure.npz``."""
_MM, _MPA = 1e3, 1e-6
_DRAWN = 720  # least number of angles at which lift and contour are listed


def torque_columns(torque: Torque) -> dict[Column, Array]:
    """Columns of ``1_torque.csv``: shaft angle, torque of the machine, its components, error bar if
    measured.
    """
    total = Column("total", "N m", "Torque on the machine's shaft")
    parts = {
        Column(name, "N m", f"Torque on the machine's shaft, {name.replace('_', ' ')}"): values
        for name, values in torque.components.items()
    }
    columns = {CRANK_ANGLE: torque.theta, total: torque.total, **parts}
    if torque.error_bar is not None:
        bar = Column("error_bar", "N m", "Half-width of the 95 % band about the total torque")
        columns[bar] = torque.error_bar
    return columns


def spline_columns(lift: Lift) -> dict[Column, Array]:
    """Columns of ``2_spline.csv``: coefficients of the lift's polynomials between knots."""
    return {CAM_ANGLE: lift.theta, **dict(zip(SPLINE, lift.spline.coefficients, strict=True))}


def drawn_angles(case: Case) -> Array:
    """Cam angles of ``2_lift.csv`` and ``3_contour.csv``, rad.

    The positions of the cycle, and equal parts between them that leave no step above half a degree.
    """
    positions = case.solver.positions
    return uniform_turn(positions * -(-_DRAWN // positions))


def lift_columns(case: Case, lift: Lift) -> dict[Column, Array]:
    """Columns of ``2_lift.csv``: cam angle, lift and its derivatives, angle of an arm."""
    theta = drawn_angles(case)
    columns = {
        CAM_ANGLE: theta,
        CRANK_ANGLE: case.mechanism.gear_ratio * theta,
        LIFT: lift(theta),
        Column("lift_d1", "mm/rad", "First derivative of the lift by cam angle"): lift(theta, 1),
        Column("lift_d2", "mm/rad^2", "Second derivative of the lift by cam angle"): lift(theta, 2),
        Column("lift_d3", "mm/rad^3", "Third derivative of the lift by cam angle"): lift(theta, 3),
    }
    angle = case.follower.arm_angle(lift(theta), case.cam.prime_radius)
    if angle is not None:
        words = "Angle at the pivot from the line to the cam axis to the arm"
        columns[Column("arm_angle", "deg", words)] = angle
    if case.rocker_linkage is not None:
        words = "Lift of the output of the rocker, beyond the lash"
        columns[Column("output_lift", "mm", words)] = case.rocker_linkage.opening(lift(theta))
    return columns


def limit_columns(theta: Array, uses: Mapping[str, Array]) -> dict[Column, Array]:
    """Columns of ``2_limits.csv``: utilisation (n,) of each limit by check id."""
    columns = {Column(name, "", f"Utilisation of {name}"): use for name, use in uses.items()}
    return {CAM_ANGLE: theta, **columns}


def contour_columns(case: Case, contour: Contour) -> dict[Column, Array]:
    """Columns of ``3_contour.csv`` over the cam angle: pitch curve, contour, its outward normal,
    pressure angle, radii of curvature.
    """
    theta, second = drawn_angles(case), case.cam.second
    columns = {CAM_ANGLE: theta, **_track_columns(contour, theta, "", "contour")}
    if second is not None and case.cam.groove is None:
        track = second.track(contour.pitch)
        name = "contour of the second disc" if second.own_disc else "contour at the second face"
        columns |= _track_columns(track.contour, theta + track.turn, "second_", name)
    if case.cam.groove is not None:  # the contour is its inner wall
        inner = contour.require_roller()
        radius = inner.roller_radius if second is None else second.radius
        outer = groove_wall(inner, "outer", radius).points(theta)
        columns |= {
            Column(f"outer_{axis}", "mm", "Outer wall of the groove in the cam frame"): values
            for axis, values in zip("xy", outer, strict=True)
        }
    return columns


def _track_columns(contour: Contour, theta: Array, prefix: str, name: str) -> dict[Column, Array]:
    """Columns of one track at its own cam angles (n,), rad; `name`: of its surface in words."""
    lengths = {"pitch": contour.pitch.points(theta), "contour": contour.points(theta)}
    where = " of the second track" if prefix else ""
    words = {"pitch": f"Pitch curve{where}", "contour": name.capitalize()}
    columns = {
        Column(f"{prefix}{curve}_{axis}", "mm", f"{words[curve]} in the cam frame"): values
        for curve, points in lengths.items()
        for axis, values in zip("xy", points, strict=True)
    }
    columns |= {
        Column(f"{prefix}normal_{axis}", "", f"Outward normal of the {name}"): values
        for axis, values in zip("xy", contour.normal(theta), strict=True)
    }
    return columns | {
        replace(each, name=f"{prefix}{each.name}", meaning=f"{each.meaning}{where}"): values
        for each, values in (
            (PRESSURE_ANGLE, contour.pitch.pressure_angle(theta)),
            (PITCH_RADIUS, contour.pitch.radius_of_curvature(theta)),
            (CONTOUR_RADIUS, contour.radius_of_curvature(theta)),
        )
    }


def cycle_columns(cycles: tuple[Cycle, ...]) -> dict[Column, Cells]:
    """Columns of ``5_cycle.csv``: those of all load cases, one below the other, NaN where a load
    case lacks a column.
    """
    tables = [cycle.columns() for cycle in cycles]
    columns = dict.fromkeys(column for table in tables for column in table)
    # One load case has columns that another lacks, such as the torque of an engine at rest.
    unknown = np.full(cycles[0].theta.size, np.nan)
    return {
        column: np.concatenate([table.get(column, unknown) for table in tables])
        for column in columns
    }


def sweep_columns(sweeps: tuple[SpeedSweep, ...]) -> dict[Column, Array]:
    """Columns of ``5_speed_sweep.csv``, one sweep for each preload in sequence."""
    tables = [sweep.columns() for sweep in sweeps]
    return {column: np.concatenate([each[column] for each in tables]) for column in tables[0]}


def column_table(trial: Trial) -> dict[str, tuple[Column, ...]]:
    """Columns, with unit and meaning, of each table in the folder of a trial, by name of
    the file.
    """
    tables: dict[str, Values] = {
        "2_lift.csv": lift_columns(trial.case, trial.lift),
        "2_spline.csv": spline_columns(trial.lift),
        "3_contour.csv": contour_columns(trial.case, trial.contour),
        "5_cycle.csv": cycle_columns(trial.cycles),
        "5_speed_sweep.csv": sweep_columns(trial.solution.speed_sweeps),
    }
    if trial.limits_in_use is not None:
        tables["2_limits.csv"] = limit_columns(*trial.limits_in_use)
    return {name: tuple(tables[name]) for name in sorted(tables)}


def pressure_arrays(cycles: tuple[Cycle, ...]) -> dict[str, Array]:
    """Arrays of ``5_pressure.npz``: rows as in ``5_cycle.csv``, a column per knot.

    Their names are those of `PRESSURE_ARRAYS`.
    """
    return {
        "load_case": np.concatenate([np.full(c.theta.size, c.load_case) for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
        "distance_from_contact_mm": _MM * np.concatenate([c.contact.pressure_xi for c in cycles]),
        "contact_pressure_MPa": _MPA * np.concatenate([c.contact.pressure for c in cycles]),
    }


def headline(solution: Solution) -> HeadlineRecord:
    """Key figures of a solved cam in mm, N and MPa; None where not applicable.

    Loads are those of the load cases in which the follower neither leaves the cam nor locks.
    """
    first, contour = solution.cycles[0], solution.contour
    design = first.machine.torque
    loaded = [cycle for cycle in solution.cycles if cycle.end is None]

    def over(measure: Callable[[Cycle], Array]) -> float | None:
        worst = max((float(np.max(measure(cycle))) for cycle in loaded), default=np.nan)
        return worst if np.isfinite(worst) else None

    def contact(measure: Callable[[ContactHistory], Array], scale: float) -> float | None:
        def of_track(cycle: Cycle) -> Array:
            return measure(cycle.contact)

        known = solution.mesh is not None or solution.tier < Tier.CYCLE
        worst = over(lambda c: on_both_tracks(c, of_track)) if known else None
        return None if worst is None else scale * worst

    after = first.turn.torque_after if first in loaded else None
    guided = solution.machine.arm is None
    return {
        "torque_std_before_Nm": None if design is None else design.std,
        "torque_std_after_Nm": None if after is None else float(np.std(after)),
        "torque_p2p_before_Nm": None if design is None else design.peak_to_peak,
        "torque_p2p_after_Nm": None if after is None else float(np.ptp(after)),
        "torque_mean_Nm": None if design is None else design.mean,
        "lift_max_mm": _MM * contour.lift.highest.value,
        "pressure_angle_max_deg": float(np.degrees(solution.pressure_angle_max)),
        "pitch_radius_of_curvature_min_mm": _MM
        * min(each.contour.least_convex_pitch_radius().value for each in solution.discs),
        "normal_force_min_N": min(map(_least_force, solution.cycles)),
        "normal_force_max_N": over(lambda c: on_both_tracks(c, _normal_force)),
        "p0_max_MPa": contact(lambda h: h.p0, _MPA),
        "p0_hertz_max_MPa": contact(lambda h: h.p0_hertz, _MPA),
        "half_width_max_mm": contact(lambda h: h.half_width, _MM),
        **_body_stresses(solution, loaded),
        "guide_reaction_A_max_N": over(lambda c: np.abs(c.guides.reaction_a)) if guided else None,
        "guide_reaction_B_max_N": over(lambda c: np.abs(c.guides.reaction_b)) if guided else None,
        "friction_loss_J_per_cam_turn": float(first.loads.friction_loss)
        if first in loaded
        else None,
        "p0_difference_max_percent": contact(lambda h: np.abs(h.p0_difference), 100.0)
        if solution.tier >= Tier.CYCLE
        else None,
        "residual_equilibrium_max": _residual_max(solution.cycles),
    }


def _normal_force(cycle: Cycle) -> Array:
    """Normal force on the track that a cycle is seen from (n,), N."""
    return cycle.loads.normal_force


def _least_force(cycle: Cycle) -> float:
    """Least contact force of a turn, N: zero where it passes between two tracks with clearance."""
    loads = cycle.loads
    if cycle.machine.disc_preload is None and np.ptp(loads.wall) > 0.0:
        return 0.0
    return float(loads.normal_force.min())


def figures(trial: Trial) -> CamFigures:
    """Figures of a cam and of its load cases, in mm, deg, rpm, N, N m and MPa.

    Those of the cam are the worst of all its discs. Extremes are refined between the samples. Of a
    load case in which the follower leaves the cam or locks the speed and the least contact force
    alone are stated, the others are None.
    """
    solution = trial.solution
    convex = max(
        greatest(each.contour.curvature, each.contour.lift.search_count).value
        for each in solution.discs
    )

    def peak(values: Array, scale: float = 1.0) -> float | None:
        value = scale * sampled_peak(values).value
        return value if np.isfinite(value) else None

    def trough(values: Array) -> float | None:
        lowest = peak(-values)
        return None if lowest is None else -lowest

    rows: list[LoadCaseFigures] = []
    for cycle in steady(trial.solution):
        loads = cycle.loads
        p0_hertz = on_both_tracks(cycle, lambda one: one.contact.p0_hertz)
        half_width = on_both_tracks(cycle, lambda one: one.contact.half_width)
        whole = cycle.end is None
        rows.append(
            {
                "load_case": cycle.load_case,
                "speed_rpm": in_unit(cycle.machine.crank_speed, "rpm"),
                "cam_speed_rpm": in_unit(cycle.machine.cam_speed, "rpm"),
                "normal_force_min_N": _least_force(cycle) and trough(loads.normal_force),
                "normal_force_max_N": peak(on_both_tracks(cycle, _normal_force)) if whole else None,
                "drive_torque_min_Nm": trough(loads.cam_torque) if whole else None,
                "drive_torque_max_Nm": peak(loads.cam_torque) if whole else None,
                "p0_hertz_max_MPa": peak(p0_hertz, _MPA) if whole else None,
                "half_width_max_mm": peak(half_width, _MM) if whole else None,
            }
        )
    return {
        "lift_max_mm": _MM * trial.lift.highest.value,
        "pressure_angle_max_deg": float(np.degrees(solution.pressure_angle_max)),
        "convex_radius_min_mm": _MM / convex if convex > 0.0 else None,
        "cam_radius_max_mm": _MM * solution.greatest_radius,
        "load_cases": rows,
    }


def _body_stresses(solution: Solution, loaded: Sequence[Cycle]) -> BodyStresses:
    """Maximum von Mises stress, MPa, below the contact with its depth, mm, in cam and follower, and
    greatest stress of the ring of the roller; None where not known.

    The contact presses on both bodies alike: in the follower stress and depth are those of the cam
    times the ratio of the half-planes of both Poisson ratios. The ring of the bearing of the roller
    bends: amplitude plus mean at its groove.

    Parameters
    ----------
    solution : Solution   of the cam
    loaded : sequence     cycles of the load cases that count
    """
    bodies = solution.machine.bodies.values()
    (own, at), (other, there) = (von_mises_peak(card.nu) for card in bodies)
    known = tracks_of(loaded) if solution.mesh is not None or solution.tier < Tier.CYCLE else []
    stress = depth = np.nan
    if known:
        worst = known[first_greatest([c.contact.von_mises.max() for c in known])]
        k = first_greatest(worst.contact.von_mises)
        stress = _MPA * float(worst.contact.von_mises[k])
        depth = _MM * float(worst.contact.von_mises_depth[k])
    rings = [
        float(np.fmax.reduce(amplitude + np.abs(mean)))
        for cycle in loaded
        if (amplitude := cycle.parts.ring_amplitude) is not None
        and (mean := cycle.parts.ring_mean) is not None
    ]

    def finite(value: float) -> float | None:
        return value if np.isfinite(value) else None

    return {
        "von_mises_max_MPa": finite(stress),
        "von_mises_depth_mm": finite(depth),
        "follower_von_mises_max_MPa": finite(stress * other / own),
        "follower_von_mises_depth_mm": finite(depth * there / at if at > 0.0 else np.nan),
        "ring_stress_max_MPa": finite(_MPA * max(rings, default=np.nan)),
    }


def _residual_max(cycles: Sequence[Cycle]) -> float | None:
    """Maximum relative residual of equilibrium, over all load cases, of contact, guides and
    friction; None where one is not known.
    """

    def worst(cycle: Cycle) -> float:
        parts = (
            cycle.contact.residual_equilibrium,
            cycle.guides.force_residual,
            cycle.guides.moment_residual,
            cycle.turn.friction_residual,
        )
        return float(np.max([np.abs(part).max() for part in parts]))

    residual = float(np.max([worst(cycle) for cycle in cycles]))
    return residual if np.isfinite(residual) else None


def trial_record(trial: Trial) -> TrialContents:
    """Record of ``trial.json``: smoothing, reason, mesh, certificate, rolling."""
    smoothing, mesh, width = trial.smoothing, trial.mesh, trial.smoothing.angular_width
    machine, contact = trial.solution.machine, trial.cycles[0].contact
    ends = trial.solution.length_certificate
    return {
        "number": trial.number,
        "why": trial.why,
        "smoothing_kind": smoothing.kind,
        "smoothing_strength": smoothing.strength,
        "smoothing_width_deg": None if width is None else in_unit(width, "deg"),
        "smoothing_description": smoothing.words,
        "synthesis": trial.synthesis,
        "prices": None if trial.synthesis is None else trial.synthesis["prices"],
        "closure_mm": _MM * trial.lift.closure,
        "table_step_deg": in_unit(trial.lift.spacing, "deg"),
        "depth": trial.depth.word,
        "contact_method": "; ".join(filter(None, (contact.method, machine.follower.body_model))),
        "line_contact_width_mm": _MM * machine.contact_width,
        "hertz_difference": hertz_difference(trial.cycles),
        "balance": balance(machine.cam, trial.contour).record(),
        "mesh": None
        if mesh is None
        else {
            "cam_angle_deg": float(np.degrees(mesh.theta)),
            "half_width_mm": _MM * mesh.half_width,
            "sha256": {"cam": mesh.cam.sha256, mesh.name: mesh.follower.sha256},
            **quality_record(mesh.quality),
        },
        "certificate": [certificate_record(point) for point in trial.certificate],
        "length_certificate": length_record(ends, (*machine.bodies,)),
        "length_refused": None if ends is None else ends.refused or None,
        "fatigue": fatigue_record(trial.solution),
        "rolling": {cycle.load_case: _rolling(cycle) for cycle in trial.cycles},
    }


def _rolling(cycle: Cycle) -> RollingRecord:
    """Record of rolling over a turn, and of the landings between two tracks."""
    record = rolling_record(cycle.rolling)
    if cycle.flights is not None:
        lost = cycle.landing_loss
        record["landings_per_cam_turn"] = len(cycle.impacts)
        record["landing_loss_J_per_cam_turn"] = lost if np.isfinite(lost) else None
    return record


def quality_record(quality: Quality) -> QualityRecord:
    """Record of a mesh's quality figures."""
    return {
        "min_angle_deg": quality.min_angle_deg,
        "min_scaled_jacobian": quality.min_scaled_jacobian,
        "edges_across_half_width": quality.edges_across_half_width,
        "elements": quality.elements,
        "nodes": quality.nodes,
    }


def fatigue_record(solution: Solution) -> dict[str, FatigueRecord]:
    """Goodman diagrams of spring and camshaft with their required safety, MPa."""
    limits = solution.machine.limits
    parts = {
        "spring": (spring_fatigue_points(solution), limits[SPRING_FATIGUE]),
        "camshaft": (shaft_fatigue_points(solution), limits[SHAFT_SAFETY]),
    }
    return {
        part: {
            "required_safety": required,
            "points": [
                {
                    "name": point.name,
                    "amplitude_MPa": _MPA * point.amplitude,
                    "mean_MPa": _MPA * point.mean,
                    "endurance_MPa": _MPA * point.endurance,
                    "strength_MPa": _MPA * point.strength,
                }
                for point in points
            ],
        }
        for part, (points, required) in parts.items()
        if points
    }


def hertz_difference(cycles: Sequence[Cycle]) -> dict[str, list[float]] | None:
    """Least and greatest change of p0 by finite elements against Hertz over the loaded angles,
    percent, by its cause.

    p0; bending of the cam and of the part of the follower, to first order; rest: mesh and change of
    curvature along the contact. None for closed forms, and without a loaded angle.
    """
    parts: dict[str, list[Array]] = {
        "p0": [],
        "cam": [],
        cycles[0].pair.follower.part: [],
        "rest": [],
    }
    for cycle in cycles:
        contact = cycle.contact
        if contact.tier not in (Tier.CYCLE, Tier.CERTIFIED) or cycle.end is not None:
            continue
        on = (contact.p0_hertz > 0) & ~contact.unsolved & ~contact.below_round_off
        whole, cam, other = (
            values[on]
            for values in (contact.p0_difference, contact.bending_cam, contact.bending_follower)
        )
        for values, part in zip(
            parts.values(), (whole, cam, other, whole - cam - other), strict=True
        ):
            values.append(part)
    if not any(part.size for part in parts["p0"]):
        return None
    joined = {name: 100.0 * np.concatenate(values) for name, values in parts.items()}
    return {name: [float(part.min()), float(part.max())] for name, part in joined.items()}


def crank_speed_record(
    trial: Trial, required: Array | None
) -> tuple[CrankSpeedRecord, Values | None]:
    """Record of the crank speed with and without the cam, and of inputs that are inconsistent or
    implausible.

    Parameters
    ----------
    trial : Trial           solved cam
    required : array (n,)   crank torque about its mean, N m, for which the lift is drawn in the
                            design load case; None if no smoother of the torque drew it

    Returns
    -------
    record : dict       ``speed`` and ``consistency`` of ``run.json``
    columns : mapping   of ``1_speed.csv`` in the design load case; None without a crankshaft
    """
    case = trial.case
    speed: dict[str, SpeedRecord | Refused] = {}
    torques = {c.load_case: c.machine.torque for c in trial.cycles if c.machine.torque is not None}
    odd = implausible(case, torques)
    findings: list[Finding] = [{"load_case": "", **one.as_record()} for one in odd]
    columns: Values | None = None
    running = [c for c in trial.cycles if c.load_case in torques and c.machine.speed > 0]
    for number, cycle in enumerate(running):
        machine, name, pitch = cycle.machine, cycle.load_case, trial.contour.pitch
        rubbing, study = cycle.loads.rubbing, None
        try:
            study = study_of(machine, pitch, rubbing)
        except CamError as error:  # a crank that stalls
            speed[name] = {"refused": str(error)}
        if study is not None:
            speed[name] = _speed_record(study, trial.contour.radius_max().value)
            columns = study.columns() if number == 0 else columns
        agreement = consistency(
            machine,
            pitch,
            study,
            demand=required if number == 0 else None,
            rubbing=rubbing,
            measured=name == case.load_cases[0].name,
        )
        findings += [{"load_case": name, **one.as_record()} for one in agreement]
    return {"speed": speed or None, "consistency": findings}, columns


def _speed_record(study: SpeedStudy, radius: float) -> SpeedRecord:
    """Crank speed of one load case; radius (m) of the cam."""
    disc, rim = study.flywheel_masses(radius)
    return {
        "before": _motion_record(study.before),
        "inertia_alone": _motion_record(study.inertia_alone),
        "after": _motion_record(study.after),
        "flywheel_for_the_same_std": {
            "added_inertia_kg_m2": study.added_inertia,
            "outer_radius_mm": in_unit(radius, "mm"),
            "disc_mass_kg": disc,
            "rim_mass_kg": rim,
        },
    }


def _motion_record(motion: CrankMotion) -> MotionRecord:
    ripple = motion.statistics
    return {
        "mean_rad_per_s": ripple.mean,
        "std_rad_per_s": ripple.std,
        "p2p_rad_per_s": ripple.peak_to_peak,
        "fluctuation": ripple.fluctuation,
        "minimum_rad_per_s": ripple.minimum,
        "minimum_crank_angle_deg": float(np.degrees(ripple.minimum_angle)),
        "maximum_rad_per_s": ripple.maximum,
        "maximum_crank_angle_deg": float(np.degrees(ripple.maximum_angle)),
        "load_mean_Nm": float(motion.load_torque.mean()),
        "closure": motion.closure,
    }


def certificate_record(point: CertificatePoint) -> CertificateRecord:
    """Record of one certified angle, mm and MPa."""
    record: CertificateRecord = {
        "cam_angle_deg": float(np.degrees(point.theta)),
        "p0_MPa": _figure(point.p0, point.p0_cycle, _MPA),
        "half_width_mm": _figure(point.half_width, point.half_width_cycle, _MM),
        "tau_max_MPa": _figure(point.tau_max, point.tau_max_cycle, _MPA),
        "von_mises_MPa": _figure(point.von_mises, point.von_mises_cycle, _MPA),
        "p0_hertz_MPa": _MPA * point.p0_hertz,
        "edges_across_half_width": list(point.edges),
        "dofs": list(point.dofs),
        "order_observed_at_deg": [float(np.degrees(theta)) for theta in point.order_from],
        "spread_percent": 100 * point.spread,
        "spread_of": point.spread_of,
        "gci_percent": 100 * point.gci,
        "gci_of": point.gci_of,
        "residual_equilibrium": point.residual_equilibrium,
        "residual_complementarity": point.residual_complementarity,
    }
    if point.bears_less:
        record["bears_less"] = True
    return record


def _figure(figure: Convergence, cycle: float, scale: float) -> ConvergenceRecord:
    return {
        "cycle": scale * cycle,
        "meshes": [scale * value for value in figure.values],
        "extrapolated": scale * figure.extrapolated,
        "order": figure.order,
        "gci_percent": 100 * figure.gci,
    }
