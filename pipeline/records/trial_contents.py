"""Forms of ``trial.json`` and of its parts."""

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from camwright.pipeline.records.forms import Depth, Sha256, form
from camwright.pipeline.records.run_summary import MachinePriceRecord, PriceRecord, QualityRecord

ContactFigure = Literal["p0", "half_width", "tau_max", "von_mises"]
StressMap = Literal["von_mises", "tau_max", "shear_range", "crossland", "dang_van"]


@form()
class ConvergenceRecord(TypedDict):
    """A quantity on successive meshes."""

    cycle: float
    """Value of the cycle."""
    meshes: list[float]
    """Values on successively finer meshes."""
    extrapolated: float
    """Richardson extrapolation."""
    order: float | None
    """Observed order, on two meshes the assumed one; null: scatter, no order observed."""
    gci_percent: float
    """Grid convergence index of the finest mesh."""


@form()
class CertificateRecord(TypedDict):
    """Contact at one cam angle solved in full."""

    cam_angle_deg: float
    """Cam angle."""
    p0_MPa: ConvergenceRecord
    """Maximum contact pressure."""
    half_width_mm: ConvergenceRecord
    """Half-width."""
    tau_max_MPa: ConvergenceRecord
    """Maximum in-plane shear stress."""
    von_mises_MPa: ConvergenceRecord
    """Maximum von Mises stress."""
    p0_hertz_MPa: float
    """Maximum contact pressure by Hertz."""
    edges_across_half_width: list[float]
    """Edges across the half-width, by mesh."""
    dofs: list[int]
    """Degrees of freedom, by mesh."""
    order_observed_at_deg: list[float]
    """Cam angles at which the order is observed; empty: here."""
    spread_percent: float
    """Greatest deviation of the cycle from the extrapolated value."""
    spread_of: ContactFigure
    """Its quantity."""
    gci_percent: float
    """Greatest grid convergence index."""
    gci_of: ContactFigure
    """Its quantity."""
    residual_equilibrium: float
    """Pressure against line load, relative."""
    residual_complementarity: float
    """Pressure times gap, relative."""
    bears_less: NotRequired[bool]
    """True: the contact of preloaded discs that bears less there."""


@form()
class MeshRecord(QualityRecord):
    """Meshes of both bodies at the worst angle."""

    cam_angle_deg: float
    """Cam angle."""
    half_width_mm: float
    """Half-width there."""
    sha256: dict[str, Sha256]
    """Hash of each mesh by body."""


@form()
class StartsRecord(TypedDict):
    """Synthesis from several starts."""

    tried: int
    """Number of starts."""
    ripple_left: list[float | None]
    """Ripple left by each, over that of the engine; null where a limit is not kept."""
    spread_percent: float
    """Greatest over least ripple left, less 1."""
    agree: bool
    """Whether all keep the limits and differ by at most 1 %."""
    sentence: str
    """The agreement in words."""


@form()
class ResolutionRecord(TypedDict):
    """Ripple left by the number of splines of the lift."""

    splines: int
    """Number of splines."""
    coarser_splines: int | None
    """Number of splines of the coarser synthesis; null without one."""
    change_percent: float
    """Change of the ripple left by the finer splines."""
    settled: bool
    """Whether it is negligible."""
    sentence: str
    """The change in words."""


@form()
class ConflictRecord(TypedDict):
    """Limits that conflict, and the relaxations that end the conflict, the smallest first."""

    conflict: list[str]
    """Ids of the checks of the limits."""
    relaxations: list[dict[str, str | float]]
    """Changes that each make the synthesis feasible: what, from, to, unit, factor, sentence."""


@form()
class SynthesisRecord(TypedDict):
    """Constrained synthesis of the lift."""

    feasible: bool
    """Whether it keeps all limits."""
    converged: bool
    """Whether it converged."""
    steps: int
    """Number of steps."""
    ripple_left: float
    """Ripple left, over that of the engine."""
    initial_energy_J: float
    """Energy of the spring at the least lift."""
    spring_rate_N_per_mm: float
    """Rate of the spring; of a torsion spring that of its line."""
    preload_N: float
    """Preload of the spring."""
    prime_radius_mm: float
    """Prime radius."""
    phase_deg: float
    """Phase of the lift."""
    reserve: float
    """Share of each limit that is kept in reserve."""
    starts: StartsRecord | None
    """Other starts; null for a design started from the trial before."""
    resolution: ResolutionRecord | None
    """Finer splines; null for a design started from the trial before."""
    corrections: dict[str, dict[str, list[float]]]
    """Least and greatest correction by finite elements, by load case and quantity."""
    utilisation: dict[str, float]
    """Greatest utilisation of each limit, the greatest first."""
    prices: list[PriceRecord]
    """Shadow prices of the limits in use; none where limits conflict."""
    machine_prices: NotRequired[list[MachinePriceRecord]]
    """Prices of the numbers of the machine, of a run."""
    infeasible: NotRequired[ConflictRecord]
    """Where the limits conflict."""
    ended: NotRequired[bool]
    """Where the effort of a preview ended the search."""


@form()
class BalanceRecord(TypedDict):
    """Unbalance of the cam with bore and keyway, and its counter-hole."""

    mass_g: float
    """Mass of the cam."""
    unbalance_g_mm: float
    """Unbalance without the hole."""
    unbalance_angle_deg: float
    """Its angle in the cam frame."""
    residual_unbalance_g_mm: float
    """Unbalance with the hole."""
    hole_diameter_mm: float | None
    """Diameter of the hole; null without one."""
    hole_x_mm: float | None
    """Centre of the hole in the cam frame; null without one."""
    hole_y_mm: float | None
    """Centre of the hole in the cam frame; null without one."""
    hole_drilled: bool
    """Whether the hole is drilled."""
    hole_note: str
    """Why no hole removes the whole unbalance; empty where one does."""


@form()
class FatiguePointRecord(TypedDict):
    """Point of a Goodman diagram."""

    name: str
    """Place and load case."""
    amplitude_MPa: float
    """Amplitude of the stress."""
    mean_MPa: float
    """Mean stress."""
    endurance_MPa: float
    """Endurance limit at a mean stress of zero."""
    strength_MPa: float
    """Strength at an amplitude of zero."""


@form()
class FatigueRecord(TypedDict):
    """Goodman diagram of a part."""

    required_safety: float | None
    """Safety factor that is required; null: not set."""
    points: list[FatiguePointRecord]
    """Points of the part."""


@form()
class StressPeakRecord(TypedDict):
    """Greatest stresses below a place of the contact over plane-strain p0."""

    von_mises: float
    """Von Mises stress."""
    von_mises_depth_mm: float
    """Its depth."""
    shear: float
    """Maximum shear stress."""
    shear_depth_mm: float
    """Its depth."""


@form()
class AxialPressureRecord(TypedDict):
    """Pressure along the line of contact."""

    y_mm: list[float]
    """Place from the middle of the contact."""
    factor: list[float]
    """Pressure over plane-strain p0."""


@form()
class LengthFactors(TypedDict):
    """Greatest pressures of a contact of finite length over plane-strain p0."""

    centre: float
    """At the middle of the length."""
    greatest: float
    """Anywhere."""
    end1_mean: float
    """Mean of the first end."""
    end2_mean: float
    """Mean of the second end."""


@form()
class LengthTier(LengthFactors):
    """The factors by one model, with their grid convergence indices."""

    centre_gci_percent: float
    """Grid convergence index of `centre`."""
    greatest_gci_percent: float
    """Grid convergence index of `greatest`."""
    end1_mean_gci_percent: float
    """Grid convergence index of `end1_mean`."""
    end2_mean_gci_percent: float
    """Grid convergence index of `end2_mean`."""
    mean_length_mm: float
    """Length over which an end is averaged."""
    unknowns: int
    """Number of unknowns of the finest mesh."""


@form()
class LengthElements(LengthTier):
    """The factors by finite elements, with the pressure and the stresses of both bodies."""

    axial: AxialPressureRecord
    """Pressure at the middle of each cell."""
    stress: dict[str, dict[str, StressPeakRecord]]
    """Greatest stresses below middle and ends by body and place."""


@form()
class LengthPointRecord(TypedDict):
    """Contact of bodies with ends at one cam angle."""

    load_case: str
    """Load case."""
    cam_angle_deg: float
    """Cam angle."""
    bears_less: NotRequired[bool]
    """True: the contact of preloaded discs that bears less there."""
    force_N: float
    """Contact force."""
    moment_Nmm: float
    """Moment about the middle of the contact."""
    plane_strain_p0_MPa: float
    """Greatest pressure of bodies without ends."""
    cycle_factor: float
    """Factor that the cycle takes."""
    signed_factor: float
    """Factor that is signed."""
    signed_gci_percent: float
    """Its grid convergence index."""
    is_mean_at_corner: bool
    """Whether it is the mean of an end with a sharp corner, where the pressure is not bounded."""
    ratio: float
    """Factor by finite elements over that of half-spaces."""
    half_space: LengthTier
    """By half-spaces with ends."""
    finite_elements: LengthElements
    """By finite elements of both bodies."""
    difference: LengthFactors
    """Of finite elements to half-spaces, relative."""


@form()
class StressMaximum(TypedDict):
    """Greatest stress over the turn and its place."""

    value_MPa: float
    """Stress."""
    cam_angle_deg: float
    """Cam angle."""
    depth_mm: float
    """Depth below the surface."""


@form()
class BoreMaximum(TypedDict):
    """Greatest stress at the wall of the bore."""

    von_mises_MPa: float
    """Von Mises stress."""
    x_mm: float
    """Place in the cam frame."""
    y_mm: float
    """Place in the cam frame."""
    away_from_edges_MPa: float
    """Greatest stress away from the edges of the keyway."""
    note: str
    """Remark; empty without one."""


@form()
class MixedFilmRecord(TypedDict):
    """Oil film of rough surfaces."""

    minimum_um: float | None
    """Least film thickness; null where it is not known."""
    positions_refused: int
    """Number of cam angles beyond the range of the formula."""
    refusal: str
    """Why they are refused; empty without any."""
    source: str
    """Source of the formula."""


@form()
class RollingRecord(TypedDict):
    """Maxima of rolling over one turn; null where the contact is unknown at some angle."""

    von_mises: NotRequired[StressMaximum | None]
    """Von Mises stress."""
    tau_max: NotRequired[StressMaximum | None]
    """In-plane shear stress."""
    shear_range: NotRequired[StressMaximum | None]
    """Range of the orthogonal shear stress."""
    crossland: NotRequired[StressMaximum | None]
    """Equivalent shear stress of Crossland."""
    dang_van: NotRequired[StressMaximum | None]
    """Equivalent shear stress of Dang Van."""
    bore: NotRequired[BoreMaximum]
    """Wall of the bore."""
    sliding_loss_J_per_cam_turn: NotRequired[float | None]
    """Friction loss of the contact."""
    gross_slip_share: NotRequired[float]
    """Share of the turn with gross slip."""
    landings_per_cam_turn: NotRequired[int]
    """Landings of the follower between two tracks."""
    landing_loss_J_per_cam_turn: NotRequired[float | None]
    """Energy lost at them."""
    film_thickness_mixed: NotRequired[MixedFilmRecord]
    """Oil film of rough surfaces."""


@form(
    written=(
        "line_contact_width_mm",
        "fatigue",
        "length_certificate",
        "length_refused",
        "rolling",
    )
)
class TrialContents(TypedDict):
    """A trial: smoothing, reason, mesh, certificate, rolling."""

    number: int
    """Number of the trial, from 1."""
    why: str
    """Reason for the trial."""
    smoothing_kind: str | None
    """Kind of the smoother; null of a given lift."""
    smoothing_strength: float | None
    """Strength of the smoother; null where none of the torque drew the lift."""
    smoothing_width_deg: float | None
    """Its width, crank angle; null where it has none."""
    smoothing_description: str
    """Smoothing in words."""
    synthesis: SynthesisRecord | None
    """Constrained synthesis; null without one."""
    prices: list[PriceRecord] | None
    """Shadow prices of the limits in use; null without a constrained synthesis."""
    closure_mm: float
    """Difference of the lift after one turn."""
    table_step_deg: float
    """Step of the knots of the lift."""
    depth: Depth
    """Depth of the solution."""
    contact_method: str
    """Solution of the contact."""
    line_contact_width_mm: NotRequired[float]
    """Length of the line of contact."""
    hertz_difference: dict[str, list[float]] | None
    """Least and greatest difference of p0 by finite elements to Hertz, percent, by its part; null
    for closed forms."""
    balance: BalanceRecord
    """Unbalance of the cam."""
    mesh: MeshRecord | None
    """Meshes; null without finite elements or without a body."""
    certificate: list[CertificateRecord]
    """Contact solved in full; empty unless certified."""
    length_certificate: NotRequired[list[LengthPointRecord]]
    """Ends of the contact; empty unless certified."""
    length_refused: NotRequired[str | None]
    """Why finite elements did not solve the ends; null where they did."""
    fatigue: NotRequired[dict[str, FatigueRecord]]
    """Goodman diagrams by part."""
    rolling: NotRequired[dict[str, RollingRecord]]
    """Maxima of rolling by load case."""
