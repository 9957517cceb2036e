"""A solution of real objects whose demands are known by hand; every check has its data.

Computed by the product: the case of `tests/data/every_part.toml` with its machines, the harmonic
lift and its contour at 72 angles, and one cycle of it by closed forms. Made up, in round figures
put into that cycle: contact and guide forces, pressures and stresses, friction of 10 N in each
guide, torques, temperatures, the fatigue map, the stress at the bore, residuals; besides the cycle
the quality of the mesh, certificate, benchmarks and speed ripple. The made-up figures do not agree
with one another: each check is tried by itself.
"""

import tomllib
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arm_path import ArmContour
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.mesh_quality import Quality
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.case.section import Section
from camwright.pipeline.contact.bore_stress import BoreStress
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence
from camwright.pipeline.contact.rolling_envelope import Envelope
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle import solution as solving
from camwright.pipeline.cycle.contact_heat import flash_history
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.elastic_response import ElasticHistory
from camwright.pipeline.cycle.length_history import LengthHistory
from camwright.pipeline.cycle.line_tilt import LineTilt
from camwright.pipeline.cycle.oil_film_history import FilmHistory
from camwright.pipeline.cycle.part_loads import PartLoads
from camwright.pipeline.cycle.rolling_history import RollingHistory, SweptStress
from camwright.pipeline.cycle.solution import ContactMesh, Solution
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.follower.guide_friction import thermal_resistance

POSITIONS = 72
THETA = uniform_turn(POSITIONS)
WAVE = np.sin(THETA)
BASE, ROLLER, STROKE = 0.05, 0.008, 0.01
RATE, PRELOAD, MASS, CAM_SPEED = 24_200.0, 242.0, 0.175, 80.0
CASE_FILE = Path(__file__).parents[1] / "data" / "every_part.toml"
FACE = {
    "width": "20 mm",
    "depth": "10 mm",
    "thickness": "5 mm",
    "friction": 0.1,
    "roughness": "0.1 um",
    "pv_limit": "200 MPa m/s",
    "material": "hard",
    "source": "f",
}

ARM = {"centre_distance": "70 mm", "length": "60 mm", "swing": "with", "source": "a"}
_SEAT = {"length": "20 mm", "diameter": "10 mm", "friction": 0.1, "friction_max": 0.2}
BUSH = _SEAT | {
    "clearance": "0.1 mm", "material": "nylon", "pressure_limit": "5 MPa", "wall": "2.5 mm",
    "pv_limit": "0.6 MPa m/s", "wear_rate": "1e-8 mm^3/N/m", "housing_resistance": "2 K/W",
    "speed_limit": "1 m/s", "source": "maker",
}  # fmt: skip
NEEDLES = _SEAT | {"C": "10 kN", "C0": "12 kN", "source": "maker"}
PIVOT = {"pin_material": "steel", "ambient_temperature": "40 degC", "source": "p"}


# --- the case --------------------------------------------------------------------------------


def changed(base: Any, **values: Any) -> Any:
    """A section or part of a case with some of its fields replaced, by what they may be."""
    if isinstance(base, Part):
        defaults = {field.name: field.default for field in fields(base)}
    else:
        assert isinstance(base, Section)
        defaults = {name: field.default for name, field in type(base).model_fields.items()}
    for name, value in values.items():
        assert value is not None or defaults[name] is None, f"{name} cannot be left out"
    return replace(base, **values) if isinstance(base, Part) else base.model_copy(update=values)


@cache
def _case() -> Case:
    return read_case(CASE_FILE)


def case(**sections: Any) -> Case:
    """The case that describes every part; `sections` replace its own."""
    if "roller" in sections:
        sections["roller_given"] = sections.pop("roller")
    return changed(_case(), **sections)


@cache
def face_case() -> Case:
    """The same case with a flat face in place of the roller."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["roller"]
    tables["follower"] |= {"kind": "flat", "face": FACE}
    return case_of(tables)


@cache
def arm_case(bearing: str = "bush") -> Case:
    """The same case on an arm, whose pivot has a bush or a needle_bearing, in place of a stem."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["guides"]
    seat = {"bush": BUSH, "needle_bearing": NEEDLES}[bearing]
    tables["follower"] = {
        "kind": "oscillating", "mass": "175 g", "spring_share": 0.2, "arm": ARM,
        "pivot": PIVOT | {bearing: seat},
    }  # fmt: skip
    tables["scope"] = {"not_covered": ["arm"], "reason": "made up"}
    return case_of(tables)


@cache
def groove_case() -> Case:
    """The same case with a groove in place of the spring."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["spring"]
    groove = {"clearance": "0.02 mm", "depth": "12 mm", "outer_radius": "90 mm", "source": "g"}
    tables["cam"] |= {"closure": "groove", "width": "20 mm", "groove": groove}
    tables["roller"]["pin"]["mounting"] = "overhung"
    tables["follower"]["restitution"] = 0.0
    return case_of(tables)


@cache
def stepped_case() -> Case:
    """The groove with a step of its own for a second roller on the same pin."""
    tables = groove_case().tables()
    ring = {"outer_diameter": "14 mm", "thickness": "1.2 mm", "pitch_diameter": "9.2 mm",
            "balls": 7, "fatigue_bending": "700 MPa", "tensile_strength": "2000 MPa",
            "source": "ring"}  # fmt: skip
    own = {"name": "624", "C": "3 kN", "C0": "1.5 kN", "fatigue_load_limit": "70 N", "ring": ring,
           "speed_limit": "2000 rad/s", "grease_life": "1500 h", "radial_limit": "900 N",
           "static_radial_limit": "900 N", "source": "c"}  # fmt: skip
    second = {"radius": "7 mm", "spacing": "10.2 mm", "step_depth": "10.5 mm", "relief": "0.5 mm",
              "bearing": own}  # fmt: skip
    tables["cam"] |= {"width": "30 mm"}
    tables["cam"]["groove"] |= {"depth": "21 mm", "second": second}
    return case_of(tables)


@cache
def pair_case() -> Case:
    """The same case with a second disc and an opposite roller in place of the spring."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["spring"]
    second = {"roller_radius": "8 mm", "distance": "110 mm", "clearance": "0.02 mm"}
    second |= {"spacing": "30 mm", "source": "second"}
    tables["cam"] |= {"closure": "conjugate", "conjugate": second}
    tables["camshaft"]["bearing_spacing"] = "100 mm"
    tables["follower"]["stem_length"] = "300 mm"
    return case_of(tables)


@cache
def yoke_case() -> Case:
    """The case with a flat face, and a second one in place of the spring."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["spring"], tables["roller"]
    yoke = {"clearance": "0.05 mm", "source": "yoke"}
    tables["cam"] |= {"closure": "yoke", "yoke": yoke}
    tables["follower"] |= {"kind": "flat", "face": FACE, "stem_length": "300 mm"}
    return case_of(tables)


@cache
def preloaded_case() -> Case:
    """The same case with two discs, whose rollers are pressed on two arms without friction."""
    tables = tomllib.loads(CASE_FILE.read_text())
    del tables["spring"], tables["guides"]
    second = {"roller_radius": "8 mm", "arm_length": "60 mm", "arm_angle": "100 deg"}
    second |= {"interference": "0.02 mm", "spacing": "30 mm", "source": "second"}
    tables["cam"] |= {"closure": "conjugate", "conjugate": second}
    tables["follower"] = {
        "kind": "oscillating", "mass": "175 g", "arm": ARM, "stiffness": "20000 N/mm",
    }  # fmt: skip
    tables["scope"] = {"not_covered": ["arm", "pivot"], "reason": "made up"}
    return case_of(tables)


def limits(**values: Any) -> Case:
    """The case with some of its limits replaced."""
    return case(limits=changed(_case().limits, **values))


def load_case(name: str, **values: Any) -> LoadCase:
    return changed(_case().load_cases[0], name=name, **values)


def with_card(whole: Any, card: Material) -> Any:
    """A section or part of a case with that card for every material of its name."""
    if isinstance(whole, Material):
        return card if whole.name == card.name else whole
    if isinstance(whole, Part):
        names = [field.name for field in fields(whole)]
        return replace(whole, **{name: with_card(getattr(whole, name), card) for name in names})
    if isinstance(whole, Section):
        names = list(type(whole).model_fields)
        parts = {name: with_card(getattr(whole, name), card) for name in names}
        return whole.model_copy(update=parts)
    if isinstance(whole, dict):
        return {key: with_card(value, card) for key, value in whole.items()}
    return whole


# --- contours --------------------------------------------------------------------------------


@cache
def contour(stroke: float = STROKE, base: float = BASE, roller: float = ROLLER) -> Contour:
    """A simple harmonic lift: s = stroke (1 - cos theta) / 2."""
    lift = Lift(THETA, 0.5 * stroke * (1.0 - np.cos(THETA)))
    return RollerContour(PitchCurve(lift, base), roller)


@cache
def face_contour() -> FlatFaceContour:
    """The same lift under a flat face."""
    return FlatFaceContour(FacePath(contour().pitch.lift, BASE))


@cache
def arm_contour() -> Contour:
    """The same lift under the roller of an arm."""
    return arm_case().contour(contour().pitch.lift)


def ring() -> Contour:
    """A cam that lifts nothing."""
    return contour(stroke=0.0)


@cache
def hollow() -> Contour:
    """Three lobes on a small base: convex tips and hollow flanks."""
    lift = Lift(THETA, 0.005 * (1.0 - np.cos(3.0 * THETA)))
    return RollerContour(PitchCurve(lift, 0.03), ROLLER)


@cache
def undercut() -> Contour:
    """Five lobes under a roller too large for their tips: cusps, and a contour that crosses."""
    theta = uniform_turn(360)
    return RollerContour(PitchCurve(Lift(theta, 0.006 * (1.0 - np.cos(5.0 * theta))), 0.03), 0.02)


# --- the cycle -------------------------------------------------------------------------------


@cache
def computed(shape: Contour) -> Cycle:
    """The cycle of a contour by closed forms, as the product computes it."""
    own = face_case() if isinstance(shape, FlatFaceContour) else case()
    own = arm_case() if isinstance(shape, ArmContour) else own
    return solving.solution(own, shape, Tier.PREVIEW, torques={}, positions=POSITIONS).cycles[0]


def put(result: Any, **values: Any) -> Any:
    """A result with its figures replaced, those it has: None stays None."""
    return replace(
        result, **{name: v for name, v in values.items() if getattr(result, name) is not None}
    )


RESULTS = ("length", "rolling", "parts", "pin_slope", "pivot", "elastic")


def with_results(cycle: Cycle, **results: Any) -> Cycle:
    """The cycle with these for those of `RESULTS`."""
    cycle.results.update(results)
    return cycle


def changed_cycle(cycle: Cycle, **values: Any) -> Cycle:
    """A cycle with some of its fields, of those of its turn, or its results replaced."""
    results = {name: values.pop(name, getattr(cycle, name)) for name in RESULTS}
    names = {field.name for field in fields(Turn)} & set(values)
    turn = replace(cycle.turn, **{name: values.pop(name) for name in names})
    return with_results(replace(cycle, turn=turn, **values), **results)


def cycle(
    shape: Contour | None = None, load_case: str = "idle", scale: float = 1.0, **values: Any
) -> Cycle:
    """A cycle of made-up figures; `scale` multiplies force, stress and torque."""
    base = computed(shape or contour())
    slope = base.loads.lift_slope
    rub = np.full(POSITIONS, 10.0)
    force = 300.0 * scale + 100.0 * WAVE
    driven = (base.loads.spring_force + base.loads.inertia_force) * slope
    plain = {
        "machine": replace(base.machine, load_case=load_case),
        "torque_before": 10.0 * WAVE,
        "torque_after": 5.0 * WAVE * scale,
        "friction_residual": np.full(POSITIONS, 1e-14),
        "loads": replace(
            base.loads,
            normal_force=force,
            axial_force=force,
            tangential_force=100.0 * WAVE,
            friction_force_a=rub,
            friction_force_b=rub,
            cam_torque=driven + 2.0 * rub * np.abs(slope),
            jam_index=0.2 + 0.1 * WAVE,
            jam_index_statics=0.25 + 0.1 * WAVE,
            pivot_load=np.stack([300.0 * WAVE, 400.0 * WAVE]),
        ),
        "contact": replace(
            base.contact,
            tier=Tier.CYCLE,
            pressure=_pressure(base, driven + 2.0 * rub * np.abs(slope)),
            p0=(800e6 + 100e6 * WAVE) * scale,
            p0_hertz=(800e6 + 100e6 * WAVE) * scale / 1.01,
            von_mises=(400e6 + 100e6 * WAVE) * scale,
            half_width=np.full(POSITIONS, 1e-4),
            tau_depth=np.full(POSITIONS, 0.786e-4),
            von_mises_depth=np.full(POSITIONS, 0.7e-4),
            residual_equilibrium=np.full(POSITIONS, 1e-9),
            residual_complementarity=np.full(POSITIONS, 1e-11),
        ),
        "guides": replace(
            base.guides,
            reaction_a=-500.0 * WAVE,
            reaction_b=-200.0 * WAVE,
            statics_a=-400.0 * WAVE,
            statics_b=-150.0 * WAVE,
            rubbing_load_a=np.abs(500.0 * WAVE),
            rubbing_load_b=np.abs(200.0 * WAVE),
            line_pressure_a=_even(-500.0 * WAVE, base.guides.knots_a),
            line_pressure_b=_even(-200.0 * WAVE, base.guides.knots_b),
            force_residual=np.full(POSITIONS, 1e-13),
            moment_residual=np.full(POSITIONS, 1e-12),
        ),
        "length": _length(),
        "rolling": _rolling(base),
        "parts": _parts(base),
        "pin_slope": None,
        "pivot": None,
        "elastic": _elastic(base),
    }
    return changed_cycle(base, **(plain | values))


def _length() -> LengthHistory:
    """A quarter more pressure along the line of the roller, and 1 N m that the guides hold."""
    one = np.ones(POSITIONS)
    corner = np.zeros(POSITIONS, dtype=bool)
    tilt = LineTilt(0.1e-3 * one, 0.1e-3, 0.1e-3, 0.5e-3, 0.4e-3)
    return LengthHistory(
        one, 1.1 * one, 1.25 * one, one, corner, 1e-4, tilt, one, 0.0 * one, is_crowned=False
    )


def _even(force: np.ndarray, knots: np.ndarray) -> np.ndarray:
    """Line load (knots, n) of a force spread evenly over the length of a guide."""
    return np.tile(force / np.ptp(knots), (knots.size, 1))


def _pressure(base: Cycle, torque: np.ndarray) -> np.ndarray:
    """Pressures of the cycle's own shape whose moment about the cam axis is a torque, N m."""
    shape, xi = base.contact.pressure, base.contact.pressure_xi
    force = base.pair.width * np.trapezoid(shape, xi, axis=1)
    arm = base.loads.lift_slope * np.cos(base.loads.pressure_angle)
    wanted = np.divide(torque, arm, out=force.copy(), where=np.abs(arm) > 1e-9)
    return shape * (wanted / np.where(force == 0.0, 1.0, force))[:, None]


def _rolling(base: Cycle) -> RollingHistory:
    still = np.zeros(POSITIONS)
    face, force = base.rolling.sliding, 300.0 + 100.0 * WAVE
    sliding = face and replace(face, power=FACE["friction"] * force * face.speed)
    contact = replace(base.contact, half_width=np.full(POSITIONS, 1e-4))
    rolling = put(
        base.rolling,
        sliding=sliding,
        flash=sliding and flash_history(base.machine, base.pair, THETA, contact, sliding),
        traction_demand=0.02 + 0.01 * WAVE,
        von_mises=420e6 + 100e6 * WAVE,
    )
    return replace(
        rolling,
        film=FilmHistory(np.full(POSITIONS, 1e-6), 2.0 + 0.5 * WAVE),
        bore=BoreStress(
            von_mises=np.full(POSITIONS, 500e6),
            x=still,
            y=still,
            at_edge=np.ones(POSITIONS),
            away_from_edges=np.full(POSITIONS, 200e6),
            excluded=5e-4,
        ),
        swept=SweptStress(
            lambda: Envelope(
                theta=np.zeros(1),
                arc=np.zeros(1),
                depth=np.array([[0.0, 0.5e-3]]),
                von_mises=np.array([[300e6, 400e6]]),
                tau_max=np.array([[150e6, 200e6]]),
                shear_range=np.array([[150e6, 200e6]]),
                crossland=np.array([[150e6, 200e6]]),
                dang_van=np.array([[180e6, 240e6]]),
            )
        ),
    )


def _parts(base: Cycle) -> PartLoads:
    parts = base.parts
    heat = 10.0 * np.abs(base.loads.velocity)  # of the 10 N in each guide
    guides, pivot = base.machine.guides, base.machine.pivot

    def hot(place: Any, bush: Any) -> np.ndarray:
        """Heat of a bush at 330 K."""
        power = (330.0 - place.ambient_temperature) / thermal_resistance(bush)
        return heat / (heat.mean() or 1.0) * power

    hot_a, hot_b = (heat, heat) if pivot else (hot(guides, each) for _, each in guides.both)
    speed = np.abs(base.loads.velocity)
    rubs = (
        np.divide(hot(pivot, pivot.bush), 1.2 * speed, out=0.0 * speed, where=speed > 0)
        if pivot
        else 0.0
    )
    still = np.zeros(POSITIONS)
    roughest = replace(
        parts.friction.greatest,
        jam_index=0.3 + 0.1 * WAVE,
        friction_force_a=still,
        friction_force_b=still,
        pivot_friction=rubs + still,
    )
    return put(
        parts,
        friction=replace(parts.friction, greatest=roughest),
        guide_edge_pressure_a=30e6 + 10e6 * WAVE,
        guide_edge_pressure_b=20e6 + 10e6 * WAVE,
        pivot_edge_pressure=25e6 + 10e6 * WAVE,
        pivot_rubbing=600.0 * np.abs(WAVE),  # of 500 N
        pivot_bearing=750.0 * np.abs(WAVE),
        heat_a=heat,
        heat_b=heat,
        heat_max_a=hot_a,
        heat_max_b=hot_b,
        key_pressure=100e6 * WAVE,
        reversals=(),
    )


def _elastic(base: Cycle) -> ElasticHistory:
    response = replace(base.elastic.response, contact_force=300.0 + 100.0 * WAVE)
    return replace(base.elastic, response=response)


# --- beside the cycle ------------------------------------------------------------------------


def converged(gci: float) -> Convergence:
    """Values that settle at 1, with an error bar."""
    return Convergence((1.1, 1.02, 1.0), 1.0, 2.0, gci)


def _certified(theta: float, off_percent: float, gci_percent: float) -> CertificatePoint:
    """A point from which the cycle's peak pressure is that far off; it has the widest error bar."""
    return CertificatePoint(
        theta=theta,
        p0=converged(0.010 * gci_percent),
        half_width=converged(0.008 * gci_percent),
        von_mises=converged(0.006 * gci_percent),
        tau_max=converged(0.004 * gci_percent),
        edges=(4.0, 8.0, 16.0),
        dofs=(1000, 4000, 16000),
        p0_hertz=1.0,
        p0_cycle=1.0 + 0.01 * off_percent,
        half_width_cycle=1.0,
        tau_max_cycle=1.0,
        von_mises_cycle=1.0,
        residual_equilibrium=1e-9,
        residual_complementarity=1e-11,
    )


def _meshed(quality: Quality) -> ContactMesh:
    """Bodies of one triangle each: the checks read nothing of a mesh but its quality."""
    corners = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    points = np.hstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=1))])
    body = BodyMesh(points, np.arange(6)[:, None], {})
    return ContactMesh(1.0, 1e-4, body, body, "roller", quality)


CERTIFICATE = (_certified(0.5, 0.2, 0.5), _certified(1.5, -0.4, 0.4))
MESH = _meshed(
    Quality(
        min_angle_deg=28.0,
        min_scaled_jacobian=0.5,
        edges_across_half_width=10.0,
        elements=1,
        nodes=6,
    )
)
BENCHMARKS = {
    f"{name}_{figure}": 0.01 for name in ("nafems", "hertz") for figure in ("p0", "half_width")
}


# --- the solution ----------------------------------------------------------------------------


def solution(**values: Any) -> Solution:
    """A certified solution that passes; `values` replace its parts."""
    plain = Solution(
        case=case(),
        contour=contour(),
        machines=machines(case())[:1],
        tier=Tier.CERTIFIED,
        mesh=MESH,
        cycles=(cycle(),),
        certificate=CERTIFICATE,
        benchmarks=BENCHMARKS,
        crank_speed={"idle": (2.0, 1.0)},
    )
    return changed_solution(plain, **values)


@cache
def in_groove() -> Solution:
    """A preview of the groove with the harmonic lift, in the load case of the file."""
    solved = solving.solution(
        groove_case(), contour(), Tier.PREVIEW, torques={}, positions=POSITIONS
    )
    return replace(solved, machines=solved.machines[:1], cycles=solved.cycles[:1])


@cache
def in_steps() -> Solution:
    """A preview of the groove of two steps likewise."""
    solved = solving.solution(
        stepped_case(), contour(), Tier.PREVIEW, torques={}, positions=POSITIONS
    )
    return replace(solved, machines=solved.machines[:1], cycles=solved.cycles[:1])


@cache
def on_two_discs() -> Solution:
    """A preview of the pair of discs likewise."""
    solved = solving.solution(pair_case(), contour(), Tier.PREVIEW, torques={}, positions=POSITIONS)
    return replace(solved, machines=solved.machines[:1], cycles=solved.cycles[:1])


@cache
def in_yoke() -> Solution:
    """A preview of the yoke likewise."""
    whole = yoke_case()
    shape = whole.contour(contour().pitch.lift)
    solved = solving.solution(whole, shape, Tier.PREVIEW, torques={}, positions=POSITIONS)
    return replace(solved, machines=solved.machines[:1], cycles=solved.cycles[:1])


@cache
def preloaded() -> Solution:
    """A preview of the preloaded pair likewise."""
    whole = preloaded_case()
    shape = whole.contour(contour().pitch.lift)
    solved = solving.solution(whole, shape, Tier.PREVIEW, torques={}, positions=POSITIONS)
    return replace(solved, machines=solved.machines[:1], cycles=solved.cycles[:1])


def changed_solution(base: Solution, **values: Any) -> Solution:
    """A solution with some of its parts replaced; its cycles have its contour and its machines."""
    bare = replace(base, **values)
    stated = {each.name for each in bare.case.load_cases}
    states = {each.load_case: each for each in machines(bare.case) if each.load_case in stated}
    cycles = tuple(
        changed_cycle(each, machine=states[each.load_case], contour=bare.contour)
        for each in bare.cycles
    )
    return replace(bare, machines=tuple(states.values()), cycles=cycles)


def arm_solution(bearing: str = "bush", **values: Any) -> Solution:
    """The same on an arm, whose pivot has a bush or a needle_bearing."""
    own = {"case": arm_case(bearing), "contour": arm_contour(), "cycles": (cycle(arm_contour()),)}
    return solution(**(own | values))


def of_load_cases(*cycles: Cycle) -> Solution:
    """A solution of several cycles, of a case with a load case for each."""
    names = dict.fromkeys(each.load_case for each in cycles)
    return solution(case=case(load_cases=tuple(map(load_case, names))), cycles=cycles)
