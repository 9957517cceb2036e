"""Forms of ``run.json`` and of its parts."""

from typing import Literal, NotRequired, get_args

from typing_extensions import TypedDict

from camwright.pipeline.base.verdict import Screen, Verdict
from camwright.pipeline.records.forms import (
    Condition,
    Count,
    Depth,
    Least0,
    Least0OrNull,
    Names,
    Sha256,
    Time,
    Versions,
    form,
)

FormNumber = Literal[7]
SCHEMA: FormNumber = get_args(FormNumber)[0]
"""Number of the form of a run folder; a folder of another form is refused."""
_JUDGED = Condition(
    "depth",
    ("certified",),
    {"verdict": "string", "screen": "null"},
    {"verdict": "null", "screen": "string"},
)


@form()
class ScopeRecord(TypedDict):
    """Parts that the sign-off does not cover."""

    not_covered: list[str]
    """Parts by name, such as camshaft."""
    reason: str
    """Why they are not covered."""
    statement: str
    """Both in one sentence; empty where all parts are covered."""


@form()
class ImpliedRecord(TypedDict):
    """A value beside the one that the others imply."""

    id: str
    """Key of the quantity."""
    title: str
    """Quantity in words."""
    given: float
    """Value stated."""
    implied: float
    """Value that the other inputs imply."""
    unit: str
    """Unit of both; - for a pure number."""
    difference_percent: float | None
    """Implied over stated, less 1; null beyond bounds."""
    flagged: bool
    """Whether they are more than 10 % apart."""
    how: str
    """Derivation of the implied value."""


@form()
class Finding(ImpliedRecord):
    """An input beside the value that the other inputs imply."""

    load_case: str
    """Load case; empty where it is of the case."""


@form()
class LoadEndRecord(TypedDict):
    """"""

    load_case: str
    """Name of the load case."""
    cam_angle_deg: float
    """Cam angle at which the loads end."""
    statement: str
    """Both in words."""


@form()
class BodyStresses(TypedDict):
    """Greatest stresses of cam and follower, of the final trial."""

    von_mises_max_MPa: float | None
    """Maximum von Mises stress below the contact."""
    von_mises_depth_mm: float | None
    """Depth of the greatest von Mises stress below the surface of the cam."""
    follower_von_mises_max_MPa: float | None
    """Greatest von Mises stress in the follower below the contact."""
    follower_von_mises_depth_mm: float | None
    """Depth of that stress below the surface of the follower."""
    ring_stress_max_MPa: float | None
    """Greatest bending stress of the outer ring of the roller; null without a ring."""


@form()
class HeadlineRecord(BodyStresses):
    """Key figures of the final trial."""

    torque_std_before_Nm: float | None
    """Standard deviation of the engine torque; null without an engine."""
    torque_std_after_Nm: float | None
    """Standard deviation of the crank torque with the cam."""
    torque_p2p_before_Nm: float | None
    """Engine torque, peak to peak."""
    torque_p2p_after_Nm: float | None
    """Crank torque with the cam, peak to peak."""
    torque_mean_Nm: float | None
    """Mean engine torque."""
    lift_max_mm: float | None
    """Maximum lift."""
    pressure_angle_max_deg: float | None
    """Maximum pressure angle."""
    pitch_radius_of_curvature_min_mm: float | None
    """Minimum convex radius of the pitch curve."""
    normal_force_min_N: float | None
    """Minimum normal force over all load cases."""
    normal_force_max_N: float | None
    """Maximum normal force over all load cases."""
    p0_max_MPa: float | None
    """Peak contact pressure; null where the contour is no body."""
    p0_hertz_max_MPa: float | None
    """Peak contact pressure by Hertz."""
    half_width_max_mm: float | None
    """Maximum contact half-width."""
    guide_reaction_A_max_N: float | None
    """Maximum reaction of guide A."""
    guide_reaction_B_max_N: float | None
    """Maximum reaction of guide B."""
    friction_loss_J_per_cam_turn: float | None
    """Friction loss of one cam turn."""
    p0_difference_max_percent: float | None
    """Maximum difference of p0 by finite elements to Hertz; null below the depth cycle."""
    residual_equilibrium_max: float | None
    """Maximum relative residual of equilibrium; null where the contact is unknown."""


@form()
class QualityRecord(TypedDict):
    """Quality of the mesh at the worst angle."""

    min_angle_deg: float
    """Least angle of an element."""
    min_scaled_jacobian: float
    """Least scaled Jacobian, 1 of a regular element."""
    edges_across_half_width: float
    """Edges across the contact half-width."""
    elements: Count
    """Number of elements."""
    nodes: Count
    """Number of nodes."""


@form()
class TrialPointRecord(TypedDict):
    """Ripple and worst utilisation of a trial."""

    trial: Count
    """Number of the trial, from 1."""
    ripple_Nm: Least0OrNull
    """Standard deviation of the crank torque with the cam; null without an engine."""
    limit: str
    """Id of the worst must-have check that depends on the lift; empty without one."""
    utilisation: Least0OrNull
    """Utilisation of that check; null where infinite."""
    passes: bool
    """Whether no must-have check within the depth of the trial fails."""


@form()
class RippleSlope(TypedDict):
    """Decrease of the ripple by a limit or a number of the machine."""

    words: str
    """Limit or number in words."""
    value: float
    """Its value."""
    unit: str
    """Unit of the value."""
    ripple_per_unit_Nm: float
    """Decrease of the ripple per unit."""
    ripple_per_percent_Nm: float
    """Decrease of the ripple per percent."""
    of: str
    """What the price is of: the ripple or the weighted objective."""
    sentence: str
    """The price in words."""


@form()
class PriceRecord(RippleSlope):
    """Shadow price of a limit."""

    limit: str
    """Id of the check of the limit."""
    binds_at_deg: list[tuple[float, float]]
    """Ranges of cam angle in which the limit is active."""


@form()
class MachinePriceRecord(RippleSlope):
    """Price of a number of the machine."""

    parameter: str
    """Key of the number of the machine."""


@form()
class MotionRecord(TypedDict):
    """Motion of the crank over one cycle."""

    mean_rad_per_s: float
    """Mean speed."""
    std_rad_per_s: float
    """Standard deviation of the speed."""
    p2p_rad_per_s: float
    """Speed, peak to peak."""
    fluctuation: float
    """Peak to peak over mean."""
    minimum_rad_per_s: float
    """Minimum speed."""
    minimum_crank_angle_deg: float
    """Crank angle of the minimum."""
    maximum_rad_per_s: float
    """Maximum speed."""
    maximum_crank_angle_deg: float
    """Crank angle of the maximum."""
    load_mean_Nm: float
    """Mean load torque."""
    closure: float
    """Relative difference of the speed after one cycle."""


@form()
class Refused(TypedDict):
    """Reason why it cannot be solved."""

    refused: str
    """Reason, in one line."""


@form()
class FlywheelRecord(TypedDict):
    """Flywheel with which the engine alone has the same standard deviation of the speed."""

    added_inertia_kg_m2: float
    """Added moment of inertia."""
    outer_radius_mm: float
    """Outer radius, that of the cam."""
    disc_mass_kg: float
    """Mass as a solid disc."""
    rim_mass_kg: float
    """Mass as a rim."""


@form()
class SpeedRecord(TypedDict):
    """Crank speed of a load case."""

    before: MotionRecord
    """Engine alone."""
    inertia_alone: MotionRecord
    """With the rotating parts of the mechanism, without cam force."""
    after: MotionRecord
    """With the cam."""
    flywheel_for_the_same_std: FlywheelRecord
    """Flywheel with which the engine alone has the same standard deviation of the speed."""


@form()
class RippleMapRecord(TypedDict):
    """Torque ripple over crank speed and engine load."""

    load_case: str
    """Load case of the cam torque."""
    engine: str
    """How the engine torque is solved."""
    crank_speed_rpm: list[float]
    """Crank speeds, a column each."""
    intake_pressure_kPa: list[float] | None
    """Intake pressures, a row each; null for a measured engine."""
    ratio: list[list[float | None]]
    """Ripple with the cam over that of the engine, by row and column."""
    ripple_before_Nm: list[list[float | None]]
    """Standard deviation of the engine torque."""
    ripple_after_Nm: list[list[float | None]]
    """Standard deviation of the crank torque with the cam."""


@form()
class ValveTrainRow(TypedDict):
    """A value of a load case."""

    load_case: str
    """Load case; empty: of all."""
    name: str
    """Quantity."""
    value: float
    """Value in its unit."""
    unit: str
    """Unit; - for a pure number."""
    note: str
    """Source or remark."""


@form()
class ValveTrainRecord(TypedDict):
    """Machine motion of a valve cam."""

    module: Literal["B", "C"]
    """Distribution mechanism after Petrescu."""
    rows: list[ValveTrainRow]
    """Values with their sources."""


@form()
class WheelRecording(TypedDict):
    """Record of a trigger wheel."""

    runs: NotRequired[Count]
    """Number of runs in the record of a trigger wheel."""
    wheel: NotRequired[str]
    """Trigger wheel: pitches of a turn, missing and additional teeth, such as 60-2."""
    sampling_rate_Hz: NotRequired[float]
    """Sampling rate of a voltage."""


@form()
class IndicatedTorque(TypedDict):
    """Indicated torque of a measured pressure against the brake torque."""

    indicated_torque_Nm: NotRequired[float]
    """Mean indicated torque of all cylinders."""
    indicated_torque_per_deg_Nm: NotRequired[float]
    """Its change with the dead centre 1 deg earlier."""
    brake_torque_Nm: NotRequired[float]
    """Measured brake torque."""
    friction_mep_kPa: NotRequired[float]
    """Friction mean effective pressure, indicated less brake torque."""
    motored_lead_deg: NotRequired[float]
    """Crank angle of the motored peak before the dead centre."""


@form()
class WheelErrors(TypedDict):
    """Pitch errors of a trigger wheel."""

    pitch_tolerance_deg: NotRequired[float]
    """Standard deviation of the place of an edge of the wheel before correction."""
    pitch_errors_rms_deg: NotRequired[float]
    """Estimated pitch errors of the wheel, corrected; with a reference."""
    pitch_errors_left_deg: NotRequired[float]
    """Standard deviation of what remains of them."""
    torque_change_percent: NotRequired[float]
    """Change of the gas torque over the speeds of the calibration, by the half orders."""


@form()
class Measurement(WheelRecording, IndicatedTorque, WheelErrors):
    """Statistics of a measured engine; the keys are those of its kind."""

    kind: str
    """Kind of the engine in the case file."""
    cycles: Count
    """Number of cycles."""
    imep_mean_kPa: NotRequired[float]
    """Mean indicated pressure, mean of the cycles."""
    imep_std_kPa: NotRequired[float]
    """Its standard deviation."""
    imep_cov_percent: NotRequired[float]
    """Its coefficient of variation."""
    peak_mean_MPa: NotRequired[float]
    """Mean peak pressure."""
    peak_angle_mean_deg: NotRequired[float]
    """Mean crank angle of the peak."""
    scatter_max_kPa: NotRequired[float]
    """Maximum scatter of the pressure."""
    pegging_mean_kPa: NotRequired[float]
    """Mean pegging offset."""
    dead_centre: NotRequired[str]
    """How the dead centre is determined."""
    turned_by_deg: NotRequired[float]
    """Shift of the crank angle."""
    mean_rad_per_s: NotRequired[float]
    """Mean speed."""
    std_rad_per_s: NotRequired[float]
    """Standard deviation of the speed."""
    p2p_rad_per_s: NotRequired[float]
    """Speed, peak to peak."""
    scatter_max_rad_per_s: NotRequired[float]
    """Maximum scatter of the speed."""
    tooth_noise_rad_per_s: NotRequired[float]
    """Noise of the teeth."""
    bandwidth_Hz: NotRequired[float]
    """Bandwidth of the filter."""
    bandwidth_harmonics_of_cycle: NotRequired[float]
    """Bandwidth in harmonics of the cycle."""
    noise_amplification_Nm_per_rad_per_s: NotRequired[float]
    """Torque noise per speed noise."""
    torque_noise_floor_Nm: NotRequired[float]
    """Noise floor of the torque."""
    torque_error_bar_max_Nm: NotRequired[float]
    """Greatest half-width of the 95 % band about the torque over the cycle."""
    torque_error_bar_percent: NotRequired[float]
    """The same, of the torque from peak to peak."""
    torque_wheel_bar_max_Nm: NotRequired[float]
    """Its part due to pitch errors of the trigger wheel."""
    half_orders_percent: NotRequired[float]
    """Half orders, unlike in the two turns of a cycle, in the variance of the speed."""
    notes: NotRequired[list[str]]
    """What the speed shows of wheel and cycle, as printed."""


@form()
class RecordHead(TypedDict):
    """Form of a record, and its case."""

    schema: FormNumber
    """Number of the form of the run folder."""
    case: str
    """Name of the case."""


@form(conditions=(_JUDGED,))
class VerdictRecord(TypedDict):
    """Verdict of a certified run, screen of a shallower one."""

    depth: Depth
    """Depth of the solution."""
    verdict: Verdict | None
    """Verdict of the must-have checks of a certified run; null below that depth."""
    screen: Screen | None
    """Result below the certified depth; null of a certified run."""


@form()
class StatedVerdict(VerdictRecord):
    """Verdict or screen, and both in one line."""

    verdict_line: str
    """Verdict or screen with the counts of the checks behind it."""


@form(written=("governing",))
class BindingIds(TypedDict):
    """Checks that bind."""

    binding: Names
    """Ids of the must-have checks that fail or lack data."""
    governing: NotRequired[str | None]
    """Id of the must-have check of the design of the greatest utilisation; null where none is
    evaluated."""


@form()
class BindingRecord(BindingIds):
    """Checks that bind, and what the sign-off leaves out."""

    scope: ScopeRecord
    """Parts that the sign-off does not cover."""


@form()
class CrankSpeedRecord(TypedDict):
    """Crank speed, and consistency of the inputs."""

    speed: dict[str, SpeedRecord | Refused] | None
    """Crank speed by load case; null without a crankshaft."""
    consistency: list[Finding]
    """Inputs beside the values that the others imply."""


@form(written=("load_ends", "mesh_quality", "measurement", "valve_train"))
class SolvedSummary(CrankSpeedRecord):
    """Part of the summary of a run that no certificate changes."""

    trials: Count
    """Number of trials."""
    final_trial: Count
    """Number of the trial that is the result."""
    trial_points: list[TrialPointRecord]
    """Ripple and worst utilisation of each trial."""
    scope: ScopeRecord
    """Parts that the sign-off does not cover."""
    headline: HeadlineRecord
    """Key figures of the final trial."""
    load_ends: NotRequired[list[LoadEndRecord]]
    """Load cases in which the follower leaves the cam or locks: the loads end there."""
    prices: list[PriceRecord] | None
    """Shadow prices of the limits in use; null without a constrained synthesis."""
    machine_prices: list[MachinePriceRecord] | None
    """Prices of the numbers of the machine; null without a constrained synthesis."""
    mesh_quality: NotRequired[QualityRecord | None]
    """Quality of the mesh; null without finite elements or without a body."""
    ripple_map: RippleMapRecord | Refused | None
    """Torque ripple over speed and load; null without a running engine."""
    measurement: NotRequired[Measurement | None]
    """Statistics of a measured engine; null for a model."""
    valve_train: NotRequired[ValveTrainRecord | None]
    """Machine motion of a valve cam; null without one."""


@form()
class JudgedSummary(VerdictRecord, BindingIds):
    """Part of the summary of a run that follows from the checks and the certificate."""

    statement: str
    """Stopping criterion, in words."""
    benchmarks: dict[str, float] | None
    """Relative deviations from published contact benchmarks; null below the certified depth."""


@form(written=("started",))
class ClockRecord(TypedDict):
    """Start and times of a run."""

    started: NotRequired[Time | None]
    """Start of the program, UTC; null for a design of a study."""
    timings_s: dict[str, Least0]
    """Wall-clock time by stage, and total; empty for a design of a study."""


@form()
class Summary(RecordHead, SolvedSummary, JudgedSummary, ClockRecord):
    """Summary of a finished run."""

    input_sha256: Sha256
    """Hash of the case file with its included files."""
    versions: Versions
    """Versions of camwright, its source text, Python and the libraries."""
    platform: str
    """System and processor."""
    files: dict[str, Sha256]
    """SHA-256 by path, relative to the run folder."""
