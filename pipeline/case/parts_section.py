"""The parts of a case file: spring, cam and shaft, roller, follower, guides, materials."""

from __future__ import annotations

from math import pi, radians, sin
from typing import Annotated, ClassVar, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    Angle,
    Force,
    In,
    Length,
    Mass,
    Preload,
    Pressure,
    Rate,
    Temperature,
)
from camwright.pipeline.case.section import Name, Section, Text, refusal


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

    rate: Rate
    preload: Preload
    travel_max: Length | None = None
    rate_tolerance: Annotated[float, In(at_least=0, below=1)] = 0.0
    preload_tolerance: Annotated[float, In(at_least=0, below=1)] = 0.0
    design: SpringDesign | None = None
    source: Text = ""


class Keyway(Section):
    """A keyway in the bore; the angle is that of its middle, in the cam frame."""

    fillet: ClassVar[float] = 0.0  # its inner corners are meshed sharp

    width: Length
    depth: Length
    angle: Angle = 0.0


class CounterHole(Section):
    """Asks for the hole through the cam that takes its unbalance away.

    wall is the least steel between the hole and contour, bore or keyway.
    """

    wall: Length = 0.003


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
    counter_hole: CounterHole | None = None
    source: Text = ""


class CamshaftGear(Section):
    """The spur gear on the camshaft; its limits are those of its material for endless life.

    The teeth are of 20 deg full depth; the pinion is on the crank.
    """

    teeth: Annotated[int, Field(ge=10, le=1000)]
    pinion_teeth: Annotated[int, Field(ge=10, le=1000)]
    width: Length
    material: Name
    application_factor: Annotated[float, In(at_least=1, at_most=10)] = 1.5
    bending_limit: Pressure | None = None
    contact_limit: Pressure | None = None
    source: Text = ""


class Camshaft(Section):
    """The cam's shaft: places from its first bearing, and the gear that drives it.

    The notch factors are those of the keyway under the cam, as an end mill cuts it. The rating is
    the dynamic one, C, of each of its two ball bearings.
    """

    bearing_spacing: Length
    cam_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_radius: Length
    mesh_angle: Angle = radians(180.0)
    pressure_angle: Annotated[float, In("deg", at_least=0, below=45)] = radians(20.0)
    drag: Annotated[float, In("N m", at_least=0, at_most=1e6)] = 0.0
    diameter: Length | None = None
    material: Name | None = None
    notch_bending: Annotated[float, In(at_least=1, at_most=10)] = 2.14
    notch_torsion: Annotated[float, In(at_least=1, at_most=10)] = 3.0
    bearing_rating: Force | None = None
    gear: CamshaftGear | None = None
    source: Text = ""


class ValveTrain(Section):
    """Asks for the machine motion of a valve cam; the cam's mass counts as that of a disc."""

    cam_mass: Mass
    source: Text = ""


class OuterRing(Section):
    """A bearing's outer ring where it is itself the roller: carried by its balls alone.

    The thickness is that under the groove, the pitch diameter that of the balls' middles, their
    number that of one row; the strengths are those of the ring's steel.
    """

    outer_diameter: Length
    thickness: Length
    pitch_diameter: Length
    balls: Annotated[int, Field(ge=3, le=100)]
    rows: Annotated[int, Field(ge=1, le=4)] = 1
    fatigue_bending: Pressure | None = None
    tensile_strength: Pressure | None = None
    source: Text = ""

    @property
    def ball_diameter(self) -> float:
        """What ring and pitch circle leave for the balls, m."""
        return self.outer_diameter - 2.0 * self.thickness - self.pitch_diameter

    @model_validator(mode="after")
    def _leaves_room_for_balls(self) -> Self:
        if not self.ball_diameter > 0.0:
            raise refusal(
                "of outer_diameter > pitch_diameter + 2 thickness, to leave the balls room"
            )
        if not self.ball_diameter < self.pitch_diameter * sin(pi / self.balls):
            raise refusal("of balls that do not overlap on the pitch circle")
        if not self.thickness < 0.2 * self.outer_diameter:
            raise refusal("of thickness < 0.2 outer_diameter, a thin ring")
        return self


class Bearing(Section):
    """The roller's bearing as its maker rates it; the viscosity is that of its oil as it runs."""

    name: Text
    C: Force | None = None
    C0: Force | None = None
    radial_limit: Annotated[float, In("N", above=0, at_most=1e9)] | None = None
    speed_limit: Annotated[float, In("rpm", above=0, at_most=1e6)] | None = None
    drag_torque: Annotated[float, In("N mm", at_least=0, at_most=1e6)] | None = None
    friction: Annotated[float, In(at_least=0, below=1)] | None = None
    viscosity: Annotated[float, In("mm^2/s", above=0, at_most=1e5)] | None = None
    pitch_diameter: Length | None = None
    ring: OuterRing | None = None
    source: Text = ""


class Pin(Section):
    """The pin that carries the roller: held on both sides, or on one (span to its face)."""

    diameter: Length
    span: Length
    mounting: Literal["straddled", "overhung"] = "straddled"
    material: Name
    source: Text = ""


class Oil(Section):
    """What wets the contact of cam and roller, at the temperature it has there.

    film "mixed" adds the film of rough surfaces by a regression whose source is unverified.
    """

    viscosity: Annotated[float, In("mPa s", above=0, at_most=1e5)]
    pressure_viscosity: Annotated[float, In("1/GPa", above=0, at_most=1000)]
    film: Literal["smooth", "mixed"] = "smooth"
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

    @property
    def line_width(self) -> float:
        """Width of the line contact it can carry, m: chamfers left out."""
        return self.width - 2.0 * self.chamfer


class Face(Section):
    """The flat face of a follower, square to the stem, centred on it and held by it.

    width is its length in the plane of motion, depth that along the line of contact, thickness
    that of the block along the stem; friction is that of the face sliding on the cam.
    """

    crowned: ClassVar[bool] = False

    width: Length
    depth: Length
    thickness: Length
    friction: Annotated[float, In(above=0, below=2)] | None = None
    roughness: Annotated[float, In("um", above=0, at_most=1000)] | None = None
    pv_limit: Annotated[float, In("MPa m/s", above=0, at_most=1e9)] | None = None
    material: Name
    source: Text = ""

    @property
    def line_width(self) -> float:
        """Width of the line contact it can carry, m."""
        return self.depth


class Follower(Section):
    """The translating follower: a roller, or a flat face that slides.

    The overhang is from guide A to the roller's centre, or to the face.
    """

    kind: Literal["roller", "flat"] = "roller"
    face: Face | None = None
    mass: Mass
    stem_diameter: Length
    stem_length: Length | None = None
    stem_material: Name
    overhang_at_max_lift: Length
    viscous_damping: Annotated[float, In("N s/m", at_least=0, at_most=1e6)] = 0.0
    stiffness: Annotated[float, In("N/mm", above=0, at_most=1e12)] | None = None
    damping_ratio: Annotated[float, In(at_least=0, below=1)] = 0.05
    source: Text = ""

    @model_validator(mode="after")
    def _has_its_face(self) -> Self:
        if self.kind == "flat" and self.face is None:
            raise InputError("follower.face", "missing", 'given with follower.kind = "flat"')
        if self.kind == "roller" and self.face is not None:
            limit = 'left out, or follower.kind = "flat"'
            raise InputError("follower.face", "a table", limit)
        return self

    @property
    def face_friction(self) -> float:
        """Friction of a face on the cam; 0 where it is not given, and for a roller."""
        return 0.0 if self.face is None else self.face.friction or 0.0


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
    wear_rate: Annotated[float, In("mm^3/N/m", above=0, at_most=1e3)] | None = None
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
    """A material card: elastic constants, strengths and where they come from.

    swelling is the growth of a length from dry to as wet as it gets.
    """

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
    expansion: Annotated[float, In("1/K", at_least=0, at_most=1e-2)] | None = None
    swelling: Annotated[float, In(at_least=0, below=1)] = 0.0
    treatment: Literal["case_hardened", "induction_hardened", "through_hardened"] | None = None
    density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
    condition: Text = ""
    source: Text
