"""The solution of `made_trial` with one thing changed: a limit, a figure, a shape, a NaN."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import made_trial as made
import numpy as np

from camwright.geometry.arm_face import ArmFaceContour, ArmFacePath
from camwright.geometry.arrays import freeze
from camwright.geometry.contour import RollerContour
from camwright.geometry.interference import SecondContact
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import DEGREE, PeriodicPolynomial
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.contact.shrink_fit import SeatFit
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.rolling_history import RollingHistory, SweptStress
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.camshaft_loads import Counterweight, Reversal
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.spring_kinds import ExtensionSpring, GasSpring, TorsionSpring
from camwright.pipeline.follower.spring_link import LinkedSpring, SpringLink

NAN = np.full(made.POSITIONS, np.nan)
TWO_ENDS = np.tile([-1e-4, 1e-4], (made.POSITIONS, 1))
NO_ROLLING = RollingHistory.unknown(made.POSITIONS)


def with_case(**sections: Any) -> Solution:
    return made.solution(case=made.case(**sections))


def with_limits(**values: Any) -> Solution:
    return made.solution(case=made.limits(**values))


def with_part(section: str, **values: Any) -> Solution:
    """The solution with a section of its case changed."""
    return with_case(**{section: made.changed(getattr(made.case(), section), **values)})


def with_gas_spring(preload_tolerance: float = 0.05, **values: Any) -> Solution:
    """The solution on a gas spring: a column of 50 mm, 30 bar above the surroundings."""
    stated = {
        "temperature": 320.0, "pressure_limit": 1e7, "temperature_limit": 353.0,
        "speed_limit": 2.0, "stroke": 0.02, "stroke_rate_limit": 50.0, "source": "made up",
        "cold_temperature": 300.0, "loss": 0.02,
    }  # fmt: skip
    gas = GasSpring(pressure=30e5, area=100e-6, volume=5e-6, **(stated | values))
    return with_part(
        "spring",
        kind="gas",
        design=None,
        gas=gas,
        rate=gas.rate,
        preload=gas.preload,
        preload_tolerance=preload_tolerance,
    )


def with_torsion_spring(seat_height: float | None = None, **values: Any) -> Solution:
    """The solution on a torsion spring, its arm square to the follower at zero lift."""
    stated = {
        "wire_diameter": 0.006, "mean_diameter": 0.048, "tensile_strength": 1.7e9,
        "stress_range": 5e8, "source": "made up",
    }  # fmt: skip
    spring = TorsionSpring(moment=12.0, angular_rate=20.0, arm=0.04, **(stated | values))
    return with_part(
        "spring",
        kind="torsion",
        design=None,
        torsion=spring,
        seat_height=seat_height,
        rate=spring.rate,
        preload=spring.preload,
    )


def with_extension_spring(**values: Any) -> Solution:
    """The solution on an extension spring that pulls an arm along its arc, without a link."""
    stated = {
        "force": 400.0, "initial_tension": 60.0, "wire_diameter": 0.006, "mean_diameter": 0.042,
        "coils": 8.0, "shear_modulus": 79.5e9, "hook_radius": 0.020, "side_radius": 0.012,
        "tensile_strength": 1.6e9, "source": "made up",
    }  # fmt: skip
    spring = ExtensionSpring(**(stated | values))
    arm = FollowerArm(centre_distance=0.12, length=0.1, swing="with", source="made up")
    return with_case(
        spring=made.changed(
            made.case().spring, kind="extension", design=None, extension=spring, rate=spring.rate,
            preload=spring.preload,
        ),
        follower=made.changed(made.case().follower, kind="oscillating", arm=arm),
    )  # fmt: skip


def on_arm(cycle: Cycle | None = None, **values: Any) -> Solution:
    """The solution with the section of an arm, on the contour of a stem."""
    stated = {
        "width": 0.02, "depth": 0.02, "hub": 0.03, "bore": 0.01, "spring_distance": 0.04,
        "pivot_notch": 2.0, "roller_notch": 3.0, "material": made.case().roller.pin.material,
    }  # fmt: skip
    arm = FollowerArm(centre_distance=0.09, length=0.08, swing="with", **(stated | values))
    case = made.case(follower=made.changed(made.case().follower, arm=arm))
    return made.solution(case=case, cycles=(cycle or made.cycle(),))


def with_second_arm(**values: Any) -> Solution:
    """The solution with a rocker of half the ratio on an arm, which moves 20 kg."""
    stated = {"width": 0.006, "depth": 0.010, "hub": 0.03, "notch": 2.0} | values
    rocker, plain = Rocker(ratio=0.5, output_mass=20.0, **stated), on_arm()
    return made.changed_solution(plain, case=made.changed(plain.case, rocker=rocker))


def with_linked_spring(length: float = 0.1) -> Solution:
    """The solution on a coil spring between an arm and a fixed point; length: of the arm, m."""
    link = SpringLink(
        arm_radius=0.05, fixed_radius=0.06, fixed_angle=np.radians(70.0), rate=50e3, preload=400.0,
        length=length, source="made up",
    )  # fmt: skip
    spring = LinkedSpring(link=link)
    forces = {"rate": spring.rate, "preload": spring.preload}
    arm = FollowerArm(centre_distance=0.12, length=length, swing="with", source="made up")
    return with_case(
        spring=made.changed(made.case().spring, link=link, design=None, **forces),
        follower=made.changed(made.case().follower, kind="oscillating", arm=arm),
    )


def on_pivot(bearing: str = "bush", loads: dict[str, Any] | None = None, **values: Any) -> Solution:
    """The solution on an arm with other values of the bearing of its pivot, or other loads."""
    case = made.arm_case(bearing)
    part = made.changed(getattr(case.follower.pivot, bearing), **values)
    pivot = made.changed(case.follower.pivot, **{bearing: part})
    case = made.changed(case, follower=made.changed(case.follower, pivot=pivot))
    cycle = made.cycle(made.arm_contour())
    turn = cycle_with("loads", cycle, **loads) if loads else cycle
    return made.arm_solution(bearing, case=case, cycles=(turn,))


def at_worst_on_pivot(**values: Any) -> Solution:
    """The solution on an arm with other loads at the greatest friction of its pivot."""
    cycle = made.cycle(made.arm_contour())
    bounds = cycle.parts.friction
    worst = replace(bounds, greatest=replace(bounds.greatest, **values))
    return made.arm_solution(cycles=(cycle_with("parts", cycle, friction=worst),))


def on_nylon(**values: Any) -> Solution:
    """The solution on an arm with a bush of other nylon."""
    case = made.arm_case()
    card = made.changed(case.materials["nylon"], **values)
    return made.arm_solution(case=made.with_card(case, card))


def with_material(name: str, **values: Any) -> Solution:
    """The solution with a material changed, wherever a part is made of it."""
    card = made.changed(made.case().materials[name], **values)
    return made.solution(case=made.with_card(made.case(), card))


def without_endurance(name: str) -> Solution:
    """The solution with a material whose card has no endurance pressure."""
    return with_material(name, endurance_pressure=None, sliding_endurance_pressure=None)


def with_speed(speed: float) -> Solution:
    """The solution at another speed of the crank, rad/s; its figures stay as they are."""
    return with_case(load_cases=(made.load_case("idle", speed=speed),))


def with_bearing(**values: Any) -> Solution:
    return with_part("roller", bearing=made.changed(made.case().roller.bearing, **values))


def with_ring(**values: Any) -> Solution:
    return with_bearing(ring=made.changed(made.case().roller.bearing.ring, **values))


def with_shaft(**values: Any) -> Solution:
    return with_part("camshaft", **values)


def weighted(**values: Any) -> Solution:
    """The solution with a counterweight of 10 mm between cam and second bearing; changed values."""
    weight = Counterweight(unbalance=2e-4, angle=0.0, position=0.04, radius=0.025, width=0.01)
    return with_shaft(counterweight=made.changed(weight, **values))


def with_fit(**changed: Any) -> Solution:
    """The solution with an interference of 20 to 30 um and other values of the steel.

    shaft_material: that of the camshaft.
    """
    shaft = {key[6:]: changed.pop(key) for key in list(changed) if key.startswith("shaft_")}
    plain = with_material("steel", **changed)
    fit = SeatFit(least_interference=20e-6, greatest_interference=30e-6, source="made up")
    case = plain.case
    cam, camshaft = made.changed(case.cam, fit=fit), made.changed(case.camshaft, **shaft)
    return made.changed_solution(plain, case=made.changed(case, cam=cam, camshaft=camshaft))


def without_seat() -> Solution:
    """The solution without fit and slip torque."""
    plain = with_shaft(slip_torque=None)
    cam = made.changed(plain.case.cam, fit=None)
    return made.changed_solution(plain, case=made.changed(plain.case, cam=cam))


def with_key(**values: Any) -> Solution:
    return with_part("cam", key=made.changed(made.case().cam.key, **values))


def with_keyway(**values: Any) -> Solution:
    return with_part("cam", keyway=made.changed(made.case().cam.keyway, **values))


def with_gear(**values: Any) -> Solution:
    return with_shaft(gear=made.changed(made.case().camshaft.gear, **values))


def with_fork(**values: Any) -> Solution:
    return with_part("roller", fork=made.changed(made.case().roller.fork, **values))


def beside(diameter: float | None) -> Solution:
    """The solution with a machine shaft beside the cam, 75 mm from the camshaft."""
    gear = made.changed(made.case().camshaft.gear, machine_shaft_diameter=diameter)
    return with_shaft(gear=gear, gear_radius=0.05)


def unknown_beside() -> Solution:
    """The same with a contour of which no place is known."""
    return made.changed_solution(beside(0.02), contour=unknown().contour)


def with_guide(side: str, **values: Any) -> Solution:
    guide = made.changed(getattr(made.case().guides, side), **values)
    return with_part("guides", **{side: guide})


def frictionless(overspeed: float) -> Solution:
    """The solution without friction in the guides, up to an overspeed, rad/s of the crank."""
    guides = made.case().guides
    smooth = {
        side: made.changed(getattr(guides, side), friction=0.0, friction_max=0.0)
        for side in ("a", "b")
    }
    limits = made.changed(made.case().limits, overspeed=overspeed)
    return with_case(guides=made.changed(guides, **smooth), limits=limits)


def with_design(**values: Any) -> Solution:
    return with_part("spring", design=made.changed(made.case().spring.design, **values))


def with_cycle(cycle: Cycle | None = None, **values: Any) -> Solution:
    return made.solution(cycles=(made.changed_cycle(cycle or made.cycle(), **values),))


def cycle_with(part: str, base: Cycle | None = None, **values: Any) -> Cycle:
    """The made-up cycle with some figures of its loads, contact, guides, rolling or parts."""
    base = base or made.cycle()
    return made.changed_cycle(base, **{part: replace(getattr(base, part), **values)})


def with_loads(**values: Any) -> Solution:
    return with_cycle(cycle_with("loads", **values))


def with_contact(**values: Any) -> Solution:
    return with_cycle(cycle_with("contact", **values))


def with_guides(**values: Any) -> Solution:
    return with_cycle(cycle_with("guides", **values))


def with_rolling(**values: Any) -> Solution:
    return with_cycle(cycle_with("rolling", **values))


def with_bore(**values: Any) -> Solution:
    return with_rolling(bore=replace(made.cycle().rolling.bore, **values))


def with_map(**values: Any) -> Solution:
    swept = replace(made.cycle().rolling.envelope, **values)
    return with_rolling(swept=SweptStress(lambda: swept))


def with_parts(**values: Any) -> Solution:
    return with_cycle(cycle_with("parts", **values))


def without_heat(side: str) -> Solution:
    """The friction power of a guide at the greatest friction is NaN."""
    return with_parts(**{f"heat_max_{side}": NAN})


def geared(off: float) -> Solution:
    """The solution with teeth, 40 : 20, that are off the ratio of the mechanism by a share."""
    return with_part("mechanism", gear_ratio=2.0 / (1.0 + off))


def without_power() -> Solution:
    """A torque without a mean, of a machine that states no power."""
    plain = with_cycle(throughput=0.0)
    states = tuple(made.changed(each, power=None) for each in plain.case.load_cases)
    return made.changed_solution(plain, case=made.changed(plain.case, load_cases=states))


def with_worst_friction(**values: Any) -> Solution:
    """The solution with other loads at the greatest friction of the guides."""
    bounds = made.cycle().parts.friction
    return with_parts(friction=replace(bounds, greatest=replace(bounds.greatest, **values)))


def stiffened(ratio: float) -> Solution:
    """Natural frequency of the follower over the speed of the cam by the stiffness of its stem."""
    machine = made.solution().machine
    total = machine.mass_without_spring * (ratio * machine.cam_speed) ** 2
    return with_part("follower", stiffness=total - machine.spring.rate)


def with_elastic_force(force: Any) -> Solution:
    elastic = made.cycle().elastic
    response = replace(elastic.response, contact_force=force)
    return with_cycle(elastic=replace(elastic, response=response))


def with_certificate(**values: Any) -> Solution:
    """The solution with other figures at the second certified angle."""
    first, second = made.CERTIFICATE
    return made.solution(certificate=(first, replace(second, **values)))


def with_mesh(**values: Any) -> Solution:
    quality = replace(made.MESH.quality, **values)
    return made.solution(mesh=replace(made.MESH, quality=quality))


def with_benchmark(name: str, off: float) -> Solution:
    return made.solution(benchmarks=made.BENCHMARKS | {f"{name}_half_width": off})


class UnknownLift(Lift):
    """A lift of NaN, which `Lift` itself refuses: no check may pass on it."""

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, values=self.values)

    @cached_property
    def spline(self) -> PeriodicPolynomial:
        return PeriodicPolynomial(np.full((DEGREE + 1, self.theta.size), np.nan))


def unknown() -> Solution:
    """The solution on a contour of which no place is known."""
    lift = UnknownLift(made.THETA, NAN, np.nan)
    return made.solution(contour=RollerContour(PitchCurve(lift, made.BASE), made.ROLLER))


def open_ended() -> Solution:
    """The solution on a lift whose source missed its start by half a nanometre."""
    shape = made.contour()
    lift = replace(shape.pitch.lift, closure=5e-10)
    return made.solution(contour=replace(shape, pitch=replace(shape.pitch, lift=lift)))


def pressed() -> Solution:
    """The solution with contact pressures a hundred-thousandth too great."""
    return with_contact(pressure=1.00001 * made.cycle().contact.pressure)


def coasting() -> Solution:
    """The solution on a lift of three accelerations, a, 0 and -a, and their reverse."""
    turn = made.THETA / (2.0 * np.pi)
    rise = 2.0 * np.minimum(turn, 1.0 - turn)  # a quarter, a half and a quarter
    beside = np.minimum(rise, 1.0 - rise)
    low = np.where(beside < 0.25, 8.0 * beside**2 / 3.0, (4.0 * beside - 0.5) / 3.0)
    values = made.STROKE * np.where(rise < 0.5, low, 1.0 - low)
    path = PitchCurve(Lift(made.THETA, values), made.BASE)
    return made.solution(contour=RollerContour(path, made.ROLLER))


@dataclass(frozen=True, eq=False)
class SearchedContour(RollerContour):
    """A contour whose search for a second contact has a made-up result."""

    gap: SecondContact

    def second_contact(self) -> SecondContact:
        return self.gap


def with_gap(gap: float, theta: float = np.nan) -> Solution:
    """The solution with a least gap, m, between roller and cam away from the contact."""
    shape = made.contour()
    return made.solution(
        contour=SearchedContour(shape.pitch, shape.roller_radius, SecondContact(gap, theta, np.nan))
    )


def hollow() -> Solution:
    return made.solution(contour=made.hollow())


def wheeled() -> Solution:
    """The hollow cam under a wheel three times its least concave radius."""
    return made.changed_solution(
        hollow(),
        case=made.case(
            workshop=made.changed(made.case().workshop, tool_radius=0.2),
            limits=made.limits(tool_radius=None).limits,
        ),
    )


def soft(**values: Any) -> Solution:
    """A cam without a hardened case."""
    card = {"case_depth": None, "treatment": "through_hardened"}
    return with_material("steel", **(card | values))


def faced(cycle: Cycle | None = None, **values: Any) -> Solution:
    """The solution with a flat face of 20 mm; the contact is 5 mm off the stem's axis at most."""
    follower = made.face_case().follower
    face = made.changed(follower.face, **values)
    return made.solution(
        case=made.changed(made.face_case(), follower=made.changed(follower, face=face)),
        contour=made.face_contour(),
        cycles=(cycle or made.cycle(made.face_contour()),),
    )


class _Unchecked(ArmFacePath):
    """A path that takes an unknown lift."""

    def __post_init__(self) -> None:
        pass


def swung(*, lift: Lift | None = None, **values: Any) -> Solution:
    """The solution with a flat face on an arm, 8 mm from the pivot towards the cam."""
    follower = made.face_case().follower
    arm = FollowerArm(centre_distance=0.09, length=0.08, swing="with", source=follower.face.source)
    face = made.changed(follower.face, **{"offset": 0.008, **values})
    plain = faced()
    path = _Unchecked(
        lift or made.contour().pitch.lift, arm.linkage, arm.start(made.BASE, 0.008), 0.008
    )
    return made.changed_solution(
        plain,
        case=made.changed(plain.case, follower=made.changed(follower, arm=arm, face=face)),
        contour=ArmFaceContour(path),
    )


def rolled(**values: Any) -> Solution:
    """The solution with an arm of 87 mm that is square to the line of the cam axis at zero lift.

    On a cam that lifts nothing: a disc of 42 mm.
    """
    sizes = {"depth": 0.010, "width": 0.012, "hub": 0.040} | values
    length = 0.1 * float(np.cos(np.pi / 6.0))
    arm = FollowerArm(centre_distance=0.1, length=length, swing="with", **sizes)
    follower = made.changed(made.case().follower, kind="oscillating", arm=arm)
    return made.solution(case=made.case(follower=follower), contour=made.ring())


def cooled(**values: Any) -> Solution:
    """The solution with another cooling."""
    return with_part("cooling", **values)


def oiled(**values: Any) -> Solution:
    """A flat face in another oil."""
    plain = faced()
    oil = made.changed(plain.case.lubricant, **values)
    return made.changed_solution(plain, case=made.changed(plain.case, lubricant=oil))


def reversing(count: int) -> Solution:
    return with_parts(reversals=(Reversal(1.0, 1.0),) * count)


def struck(torque: Any = 4.0, **gear: Any) -> Solution:
    """The teeth cross their backlash under a steady torque, N m, on a rigid shaft."""
    cycle = cycle_with("loads", cam_torque=np.full(made.POSITIONS, torque))
    plain = with_cycle(cycle_with("parts", cycle, reversals=(Reversal(1.0, 1.0),)))
    shaft = plain.case.camshaft
    gear_of = made.changed(shaft.gear, backlash=1e-4, **gear)
    shaft = made.changed(shaft, gear=gear_of, diameter=None)
    return made.changed_solution(plain, case=made.changed(plain.case, camshaft=shaft))


def lossy() -> Solution:
    """A cam whose torque pays one part in ten million more than the guides' heat."""
    loads = made.cycle().loads
    spent = loads.cam_torque - (loads.spring_force + loads.inertia_force) * loads.lift_slope
    return with_loads(cam_torque=loads.cam_torque + 1e-7 * spent)
