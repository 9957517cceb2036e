"""The sections of a case file: pydantic models of SI floats, read from unit strings."""

from __future__ import annotations

import datetime as dt
import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, isfinite, radians
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    field_validator,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from geometry.errors import InputError
from pipeline import units

if TYPE_CHECKING:
    from pipeline.engine.cylinder import CylinderEngine

SAFE_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9_-])?")


def refusal(limit: str, **context: str) -> PydanticCustomError:
    """A validation error that says what would be accepted."""
    return PydanticCustomError("limit", "must be {limit}", {"limit": limit, **context})


@dataclass(frozen=True)
class In:
    """Marks a float field: read from a unit string into SI, bounds in the unit shown.

    With no unit it is a pure number, written bare.
    """

    unit: str = ""
    above: float = -inf
    at_least: float = -inf
    below: float = inf
    at_most: float = inf

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, given: object) -> float:
        value = self._number(given)
        shown = [f"> {self.above:g}"] if self.above > -inf else []
        shown += [f">= {self.at_least:g}"] if self.at_least > -inf else []
        shown += [f"< {self.below:g}"] if self.below < inf else []
        shown += [f"<= {self.at_most:g}"] if self.at_most < inf else []
        inside = self._si(self.above) < value < self._si(self.below) and self._si(
            self.at_least
        ) <= value <= self._si(self.at_most)
        if not inside:
            raise refusal(f"{' and '.join(shown)} {self.unit}".rstrip())
        return value

    def _number(self, given: object) -> float:
        if self.unit:
            try:
                return units.parse(given, self.unit, "")
            except InputError as error:
                raise refusal(error.limit) from None
        if isinstance(given, bool) or not isinstance(given, (int, float)):
            raise refusal("a number without a unit")
        value = float(given) if abs(given) < 1e308 else inf
        if not isfinite(value):
            raise refusal("finite")
        return value

    def _si(self, bound: float) -> float:
        if not isfinite(bound) or not self.unit:
            return bound
        return units.parse(f"{bound!r} {self.unit}", self.unit, "")


def _printable(text: str) -> str:
    if not all(character.isprintable() or character in "\n\t" for character in text):
        raise refusal("printable text")
    return text


def _safe_name(name: str) -> str:
    if not SAFE_NAME.fullmatch(name):
        raise refusal("1 to 40 letters, digits, '_', '-' or '.', starting with a letter or digit")
    return name


Name = Annotated[str, AfterValidator(_safe_name)]
Text = Annotated[str, Field(max_length=10_000), AfterValidator(_printable)]
FileName = Annotated[str, Field(min_length=1, max_length=200), AfterValidator(_printable)]

Length = Annotated[float, In("mm", above=0, at_most=10_000)]
Angle = Annotated[float, In("deg")]
Duration = Annotated[float, In("deg", above=0, at_most=720)]
Mass = Annotated[float, In("g", above=0, at_most=1e6)]
Pressure = Annotated[float, In("MPa", above=0, at_most=1e6)]
GasPressure = Annotated[float, In("kPa", above=0, at_most=1e5)]
Temperature = Annotated[float, In("K", above=0, at_most=5000)]
Force = Annotated[float, In("N", at_least=0, at_most=1e9)]
Share = Annotated[float, In(at_least=0, at_most=1)]
Positive = Annotated[float, In(above=0, at_most=1e6)]
Fraction = Annotated[float, In(above=0, at_most=1)]
Safety = Annotated[float, In(above=0, at_most=100)]
Residual = Annotated[float, In(above=0, at_most=1e-3)]


class Section(BaseModel):
    """Base of all sections: frozen, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    @model_validator(mode="before")
    @classmethod
    def _know_every_key(cls, given: Any) -> Any:
        """Refuse unknown keys before missing ones: a slip of the pen is both."""
        known = [field.alias or name for name, field in cls.model_fields.items()]
        for key in given if isinstance(given, dict) else ():
            if key not in known:
                raise refusal(f"a known key{_suggestion(key, known)}", unknown_key=str(key))
        return given


def _suggestion(word: str, known: Iterable[str]) -> str:
    close = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {close[0]}?" if close else f": {', '.join(known)}"


class LiftPoint(Section):
    """One row of a valve's lift table, at the valve."""

    angle: Angle
    lift: Annotated[float, In("mm", at_least=0, at_most=1000)]


LiftRows = Annotated[tuple[LiftPoint, ...], Field(strict=False, max_length=720)]


class TorqueTable(Section):
    """Engine torque over one cycle, from a file: crank angle column, torque column."""

    kind: Literal["table"] = "table"
    file: FileName


class Cylinder(Section):
    """Lumped single-cylinder model; crank angle 0 is the top dead centre where intake starts."""

    kind: Literal["cylinder"] = "cylinder"
    bore: Length
    crank_radius: Length
    rod_length: Length
    compression_ratio: Annotated[float, In(above=1, at_most=40)]
    piston_mass: Mass
    rod_mass: Mass
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000)] = 0.0
    rod_big_end_share: Share = 2.0 / 3.0
    firing_offsets: Annotated[tuple[Angle, ...], Field(strict=False, min_length=1)] = (0.0,)

    intake_valve_open: Angle = 0.0
    intake_valve_close: Angle = radians(220.0)
    exhaust_valve_open: Angle = radians(470.0)
    exhaust_valve_close: Angle = radians(720.0)
    valve_lift: Length = 0.0055
    intake_lift_table: LiftRows = ()
    exhaust_lift_table: LiftRows = ()
    intake_valve_diameter: Length = 0.025
    exhaust_valve_diameter: Length = 0.022
    valve_discharge_coefficient: Fraction = 0.6
    valve_spring_rate: Annotated[float, In("N/m", at_least=0, at_most=1e9)] = 5884.0
    valve_spring_preload: Force = 47.0
    rocker_ratio: Positive = 1.0

    intake_pressure: GasPressure = 30.5e3
    exhaust_pressure: GasPressure = 101.3e3
    crankcase_pressure: GasPressure = 101.3e3
    intake_temperature: Temperature = 305.0
    exhaust_temperature: Temperature = 700.0
    wall_temperature: Temperature = 400.0

    ignition: Literal["spark", "compression"] = "spark"
    spark: Angle = radians(335.0)
    ignition_delay: Annotated[float, In("deg", at_least=0, at_most=180)] = radians(8.0)
    burn_duration: Duration = radians(80.0)
    wiebe_a: Positive = 5.0
    wiebe_m: Positive = 2.0
    premixed_share: Share = 0.0
    premixed_duration: Duration = radians(8.0)
    premixed_m: Positive = 1.5
    combustion_efficiency: Fraction = 0.9
    air_fuel_ratio: Annotated[float, In(above=1, at_most=1000)] = 13.5
    lower_heating_value: Annotated[float, In("MJ/kg", above=0, at_most=1000)] = 43.5e6

    heat_loss: Literal["hohenberg", "woschni"] = "hohenberg"
    heat_loss_factor: Annotated[float, In(at_least=0, at_most=100)] = 1.0
    friction_pressure: Annotated[float, In("kPa", at_least=0, at_most=1e4)] | None = None
    dipper_area: Annotated[float, In("mm^2", at_least=0, at_most=1e6)] = 0.0
    dipper_radius: Length = 0.035
    dipper_drag_coefficient: Positive = 1.2
    dipper_immersion: Annotated[float, In("deg", above=0, at_most=180)] = radians(40.0)
    oil_density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)] = 870.0

    def build(self) -> CylinderEngine:
        """The engine as the cycle model takes it; no friction pressure means the closing one."""
        from pipeline.engine.cylinder import CylinderEngine

        tables = ("intake_lift_table", "exhaust_lift_table")
        values = self.model_dump(exclude={"kind", "friction_pressure", *tables})
        for name in tables:
            rows = tuple((row.angle, row.lift) for row in getattr(self, name))
            values[name] = rows or None
        pressure = self.friction_pressure
        return CylinderEngine(**values, friction="closing" if pressure is None else pressure)


class Mechanism(Section):
    """The drive between crank and cam: crank turns per cam turn.

    compensation is the share of the engine's torque that the cam is cut to take.
    """

    gear_ratio: Annotated[float, In(above=0, at_most=100)] = 2.0
    compensation: Annotated[float, In(above=0, at_most=1)] = 1.0


class SpringDesign(Section):
    """The spring as it is wound; its strength is that of a 1 mm wire times (d/mm)^-exponent."""

    wire_diameter: Length
    mean_diameter: Length
    coils: Annotated[float, In(at_least=1.5, at_most=1000)]
    free_length: Length
    end_factor: Annotated[float, In(above=0, at_most=2)] = 0.5
    shear_modulus: Annotated[float, In("GPa", above=0, at_most=1e5)]
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    strength_at_1mm: Pressure
    strength_exponent: Annotated[float, In(at_least=0, below=1)]
    treatment: Literal["plain", "peened"] = "plain"
    source: Text = ""


class Spring(Section):
    """The spring that stores the engine's excess energy."""

    rate: Annotated[float, In("kN/m", above=0, at_most=1e6)]
    preload: Annotated[float, In("N", above=0, at_most=1e9)]
    travel_max: Length | None = None
    rate_tolerance: Annotated[float, In(at_least=0, below=1)] = 0.0
    preload_tolerance: Annotated[float, In(at_least=0, below=1)] = 0.0
    design: SpringDesign | None = None
    source: Text = ""


class Keyway(Section):
    """A keyway in the bore; the angle is that of its middle, in the cam frame."""

    width: Length
    depth: Length
    angle: Angle = 0.0


class Cam(Section):
    """The cam disc; the pitch base radius is the smallest radius of the roller's centre."""

    pitch_base_radius: Length
    offset: Annotated[float, In("mm", above=-10_000, below=10_000)] = 0.0
    width: Length
    bore_radius: Length
    material: Name
    keyway: Keyway | None = None
    roughness: Annotated[float, In("um", above=0, at_most=1000)] | None = None
    profile_tolerance: Annotated[float, In("mm", above=0, at_most=10)] | None = None
    waviness_length: Length = 0.005
    source: Text = ""


class Camshaft(Section):
    """The cam's shaft: places from its first bearing, and the gear that drives it."""

    bearing_spacing: Length
    cam_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_radius: Length
    mesh_angle: Angle = radians(180.0)
    pressure_angle: Annotated[float, In("deg", at_least=0, below=45)] = radians(20.0)
    drag: Annotated[float, In("N m", at_least=0, at_most=1e6)] = 0.0
    source: Text = ""


class Bearing(Section):
    """The roller's bearing as its maker rates it; a shipped card fills in what is left out."""

    card: Name | None = None
    name: Text
    C: Force | None = None
    C0: Force | None = None
    radial_limit: Annotated[float, In("N", above=0, at_most=1e9)] | None = None
    speed_limit: Annotated[float, In("rpm", above=0, at_most=1e6)] | None = None
    drag_torque: Annotated[float, In("N mm", at_least=0, at_most=1e6)] | None = None
    friction: Annotated[float, In(at_least=0, below=1)] | None = None
    source: Text = ""

    @model_validator(mode="before")
    @classmethod
    def _from_card(cls, given: Any) -> Any:
        """Fill in from the card; what the case gives itself stands."""
        if not isinstance(given, dict) or not isinstance(given.get("card"), str):
            return given
        from pipeline.follower.bearing_cards import read_cards

        cards = read_cards()
        if given["card"] not in cards:
            raise refusal(f"without card, or with one of: {', '.join(sorted(cards))}")
        card = cards[given["card"]]
        filled = {"name": card.name, "source": card.source}
        for key, unit in (("C", "N"), ("C0", "N"), ("speed_limit", "rpm")):
            filled[key] = units.format(getattr(card, key), unit)
        return filled | given


class Pin(Section):
    """The pin that carries the roller: held on both sides, or on one (span to its face)."""

    diameter: Length
    span: Length
    mounting: Literal["straddled", "overhung"] = "straddled"
    material: Name
    source: Text = ""


class Oil(Section):
    """What wets the contact of cam and roller, at the temperature it has there."""

    viscosity: Annotated[float, In("mPa s", above=0, at_most=1e5)]
    pressure_viscosity: Annotated[float, In("1/GPa", above=0, at_most=1000)]
    source: Text = ""


class Roller(Section):
    """The roller on the follower; the hub radius is that of its pin or inner ring.

    friction is that of the roller sliding on the cam; roughness the rms one.
    """

    radius: Length
    width: Length
    chamfer: Annotated[float, In("mm", at_least=0, at_most=1000)] = 0.0
    hub_radius: Length
    inertia: Annotated[float, In("kg mm^2", above=0, at_most=1e9)] | None = None
    crowned: bool = False
    friction: Annotated[float, In(above=0, below=2)] | None = None
    roughness: Annotated[float, In("um", above=0, at_most=1000)] | None = None
    material: Name
    bearing: Bearing
    pin: Pin | None = None


class Follower(Section):
    """The translating follower; the overhang is from guide A to the roller's centre."""

    kind: Literal["roller", "flat"] = "roller"
    mass: Mass
    stem_diameter: Length
    stem_length: Length | None = None
    stem_material: Name
    overhang_at_max_lift: Length
    viscous_damping: Annotated[float, In("N s/m", at_least=0, at_most=1e6)] = 0.0
    stiffness: Annotated[float, In("N/mm", above=0, at_most=1e12)] | None = None
    damping_ratio: Annotated[float, In(at_least=0, below=1)] = 0.05
    source: Text = ""


def _no_press_fit(clearance: float) -> float:
    if clearance < 0:
        raise refusal(">= 0 mm: a press fit cannot slide")
    return clearance


class Guide(Section):
    """One guide of the stem; its limits hold for dry running unless the source says more."""

    length: Length
    diameter: Length
    friction: Annotated[float, In(at_least=0, below=2)]
    friction_min: Annotated[float, In(at_least=0, below=2)] | None = None
    friction_max: Annotated[float, In(at_least=0, below=2)] | None = None
    lubrication: Literal["dry", "greased_once", "regularly_greased", "flooded"] | None = None
    clearance: Annotated[
        float, In("mm", at_least=-100, at_most=100), AfterValidator(_no_press_fit)
    ] = 0.0
    material: Name
    pressure_limit: Pressure | None = None
    pv_limit: Annotated[float, In("MPa m/s", above=0, at_most=1e6)] | None = None
    stiffness: Annotated[float, In("N/mm", above=0, at_most=1e9)] | None = None
    thermal_resistance: Annotated[float, In("K/W", above=0, at_most=1e6)] | None = None
    source: Text = ""

    @model_validator(mode="after")
    def _friction_in_order(self) -> Self:
        low, high = self.friction_min, self.friction_max
        if low is not None and not low <= self.friction:
            raise refusal("of friction_min <= friction")
        if high is not None and not self.friction <= high:
            raise refusal("of friction <= friction_max")
        return self


class Guides(Section):
    """Guide A stands next to the cam, guide B beyond it; the spacing is middle to middle."""

    spacing: Length
    ambient_temperature: Temperature = 293.15
    a: Guide
    b: Guide


class Material(Section):
    """A material card: elastic constants, strengths and where they come from."""

    E: Annotated[float, In("GPa", above=0, at_most=1e5)]
    nu: Annotated[float, In(at_least=0, below=0.5)]
    yield_strength: Pressure
    tensile_strength: Pressure | None = None
    hardness: Annotated[float, In(above=0, at_most=10_000)] | None = None
    endurance_pressure: Pressure | None = None
    endurance_slope: Annotated[float, In(above=0, at_most=100)] | None = None
    endurance_intercept: Annotated[float, In(above=0, at_most=1000)] | None = None
    conductivity: Annotated[float, In("W/m/K", above=0, at_most=1e4)] | None = None
    temperature_limit: Temperature | None = None
    fatigue_torsion: Pressure | None = None
    fatigue_bending: Pressure | None = None
    case_depth: Length | None = None
    core_yield_strength: Pressure | None = None
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    condition: Text = ""
    source: Text


FreeName = Literal["initial_energy", "spring_rate", "preload", "pitch_base_radius"]
Rate = Annotated[float, In("kN/m", above=0, at_most=1e6)]
Preload = Annotated[float, In("N", above=0, at_most=1e9)]


class Smoothing(Section):
    """What is done to the torque before the lift is drawn from it; angles are crank angles.

    `constrained` draws the lift of least ripple within all limits; what is `free` it may change
    as well, within its range.
    """

    kind: Literal[
        "none", "moving_average", "gaussian", "harmonic", "savitzky_golay", "constrained"
    ] = "none"
    points: Annotated[int, Field(ge=1, le=720)] = 12
    spacing: Annotated[float, In("deg", above=0, at_most=120)] = radians(5.0)
    width: Duration = radians(60.0)
    harmonics: Annotated[float, In(at_least=1, at_most=360)] = 12.0
    taper: Annotated[float, In(at_least=0, below=1)] = 0.25
    degree: Annotated[int, Field(ge=0, le=20)] = 2
    free: Annotated[tuple[FreeName, ...], Field(strict=False)] = ("initial_energy",)
    spring_rate_range: Annotated[tuple[Rate, Rate], Field(strict=False)] | None = None
    preload_range: Annotated[tuple[Preload, Preload], Field(strict=False)] | None = None
    pitch_base_radius_range: Annotated[tuple[Length, Length], Field(strict=False)] | None = None
    coefficients: Annotated[int, Field(ge=12, le=240)] = 96
    torque_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 1.0
    speed_weight: Annotated[float, In(at_least=0, at_most=1e6)] = 0.0
    jerk_weight: Annotated[float, In(at_least=0, at_most=1e3)] = 1e-5
    corners: bool = False
    source: Text = ""

    @model_validator(mode="after")
    def _knows_how_far(self) -> Self:
        for name in self.free:
            if name == "initial_energy":
                continue
            ends = getattr(self, f"{name}_range")
            if ends is None or not ends[0] < ends[1]:
                field = f"smoothing.{name}_range"
                raise InputError(field, ends, "two rising values, as it is free")
        return self

    @model_validator(mode="after")
    def _fits_into_a_cycle(self) -> Self:
        if self.points * self.spacing > radians(720.0) + 1e-9:
            raise InputError("smoothing.points", self.points, "<= 720 deg over smoothing.spacing")
        return self


class Limits(Section):
    """What the checks compare with; a safety above 1 asks for more than the bare limit."""

    closure: Annotated[float, In("mm", above=0, at_most=1)] = 1e-9
    pressure_angle: Annotated[float, In("deg", above=0, below=90)] = radians(30.0)
    curvature_ratio: Annotated[float, In(at_least=1, at_most=100)] = 1.5
    undercut_factor: Annotated[float, In(above=0, below=1)] = 0.3
    second_contact_depth: Annotated[float, In("mm", above=0, at_most=1)] = 1e-6
    tool_radius: Length | None = None
    minimum_wall: Annotated[float, In(at_least=1, at_most=100)] = 1.75
    contact_safety: Safety = 1.0
    yield_safety: Safety = 1.0
    shakedown_safety: Safety = 1.0
    contact_force_margin: Annotated[float, In(above=0, below=1)] = 0.2
    jump: Safety = 1.0
    overspeed: Annotated[float, In("rpm", above=0, below=20_000)] | None = None
    jump_speed: Annotated[float, In(at_least=1, at_most=100)] = 1.3
    clearance: Annotated[float, In("mm", above=0, at_most=1000)] = 0.001
    cam_radius: Length | None = None
    target_life: Annotated[float, In("h", above=0, at_most=1e6)] | None = None
    edge_factor: Annotated[float, In(at_least=1, at_most=5)] = 1.3
    waviness: Annotated[float, In(above=0, at_most=1)] = 0.2
    chord_share: Fraction = 0.25
    jam_index: Annotated[float, In(above=0, below=1)] = 0.5
    roller_static_safety: Safety = 1.0
    roller_life: Annotated[float, In("h", above=0, at_most=1e6)] | None = None
    roller_speed_share: Fraction = 0.7
    pin_share: Fraction = 0.6
    spring_fatigue: Safety = 1.2
    spring_solid: Annotated[float, In(above=0, at_most=10)] = 0.1
    spring_surge: Annotated[float, In(above=0, at_most=1e4)] = 13.0
    key_pressure: Pressure = 100e6
    unbalance: Annotated[float, In("mm/s", above=0, at_most=1e4)] | None = None
    film_ratio: Annotated[float, In(above=0, at_most=100)] = 1.0
    skid: Annotated[float, In(above=0, at_most=1)] = 0.5
    fatigue_safety: Safety = 1.0
    case_safety: Safety = 1.0
    torque_reduction: Annotated[float, In(above=0, below=1)] = 0.4
    energy_closure: Residual = 1e-9
    friction_balance: Residual = 1e-6
    equilibrium: Residual = 1e-9
    complementarity: Residual = 1e-9
    mesh_uncertainty: Annotated[float, In(above=0, at_most=1)] = 0.03
    sources: dict[str, Text] = Field(default_factory=dict)

    @field_validator("sources")
    @classmethod
    def _name_limits(cls, given: dict[str, str]) -> dict[str, str]:
        known = [name for name in cls.model_fields if name != "sources"]
        for key in given:
            if key not in known:
                raise refusal(f"a known limit{_suggestion(key, known)}", unknown_key=key)
        return given


class Solver(Section):
    """How finely and how long to compute."""

    positions: Annotated[int, Field(ge=36, le=7200)] = 720
    max_trials: Annotated[int, Field(ge=1, le=20)] = 6
    certificate_positions: Annotated[int, Field(ge=1, le=64)] = 8


class Waiver(Section):
    """A failed check that a named person has accepted, and why."""

    check: Name
    name: Annotated[str, Field(min_length=1, max_length=200), AfterValidator(_printable)]
    reason: Annotated[str, Field(min_length=1, max_length=2000), AfterValidator(_printable)]
    date: dt.date


class Tolerances(Section):
    """How far the case may be from what is built: shares of the nominal, phase in crank degrees.

    Those of the spring and the line profile stand in their own sections; friction goes from
    guides.*.friction_min to friction_max where they are given.
    """

    friction: Annotated[float, In(at_least=0, below=1)] = 0.0
    mass: Annotated[float, In(at_least=0, below=1)] = 0.0
    phase: Annotated[float, In("deg", at_least=0, at_most=90)] = 0.0
    samples: Annotated[int, Field(ge=0, le=1000)] = 16
    seed: Annotated[int, Field(ge=0, le=2**31)] = 1
    source: Text = ""


class LoadCase(Section):
    """One state the cam has to bear: crank speed and, where it differs, the torque.

    At speed 0 the cam stands or creeps: springs and friction act, inertia does not. The ripple
    counts with its weight; at 0 the case only loads the cam and no reduction is asked for.
    A preload of its own loads the cam that was cut for spring.preload.
    """

    name: Name
    speed: Annotated[float, In("rpm", at_least=0, below=20_000)]
    preload: Preload | None = None
    torque: FileName | None = None
    ripple_weight: Annotated[float, In(at_least=0, at_most=1000)] = 1.0
    source: Text = ""
