"""Evidence of a made-up trial whose every demand is known by hand."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np

from geometry.arrays import uniform_turn
from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.checks.trial import TrialEvidence
from pipeline.contact.convergence import Convergence

POSITIONS = 72
THETA = uniform_turn(POSITIONS)
BASE, ROLLER, STROKE = 0.05, 0.008, 0.01
RATE, PRELOAD, MASS, CAM_SPEED = 24_200.0, 242.0, 0.175, 80.0


@cache
def contour(stroke: float = STROKE, base: float = BASE, roller: float = ROLLER) -> Contour:
    """A simple harmonic lift: s = stroke (1 - cos theta) / 2."""
    lift = Lift(THETA, 0.5 * stroke * (1.0 - np.cos(THETA)))
    return Contour(PitchCurve(lift, base), roller)


def asked(**changes):
    """The limits of a fake case, those the code has no default for among them."""
    plain = {
        "sources": {},
        "cam_radius": 0.06,
        "tool_radius": 0.01,
        "curvature_rate": 1e3,
        "roller_life": 3600.0,
        "target_life": 3.6e6,
        "speed_reduction": 0.4,
    }
    return SimpleNamespace(**(plain | changes))


def case(**changes):
    """A case all of whose limits are met by `evidence()`."""
    steel = SimpleNamespace(
        yield_strength=600e6,
        endurance_pressure=1000e6,
        fatigue_torsion=300e6,
        fatigue_bending=400e6,
        case_depth=1e-3,
        treatment="case_hardened",
        tensile_strength=900e6,
        hardness=300.0,
        core_yield_strength=400e6,
        endurance_slope=14.15,
        endurance_intercept=66.22,
        E=210e9,
        nu=0.3,
        source="a card",
    )
    hard = SimpleNamespace(
        yield_strength=1500e6, endurance_pressure=None, E=210e9, nu=0.3, source="another"
    )
    guide = SimpleNamespace(
        length=0.02,
        diameter=0.01,
        material="nylon",
        pressure_limit=5e6,
        pv_limit=0.6e6,
        source="maker",
    )
    plain = {
        "limits": asked(),
        "mechanism": SimpleNamespace(gear_ratio=2.0),
        "spring": SimpleNamespace(rate=RATE, preload=PRELOAD, travel_max=0.02),
        "cam": SimpleNamespace(
            material="steel",
            bore_radius=0.0085,
            keyway=None,
            roughness=3e-7,
            profile_tolerance=4e-6,
        ),
        "lubricant": SimpleNamespace(viscosity=0.03, pressure_viscosity=2e-8),
        "roller": SimpleNamespace(
            material="hard",
            friction=0.1,
            crowned=True,
            roughness=1e-7,
            bearing=SimpleNamespace(
                name="625",
                C=1140.0,
                C0=600.0,
                radial_limit=1000.0,
                speed_limit=1500.0,
                source="c",
            ),
        ),
        "tolerances": SimpleNamespace(phase=0.04),
        "shop": SimpleNamespace(table_step=np.radians(0.5), tool_radius=None, chord_error=None),
        "follower": SimpleNamespace(mass=MASS, overhang_at_max_lift=0.03),
        "guides": SimpleNamespace(a=guide, b=guide, spacing=0.08),
        "materials": {"steel": steel, "hard": hard},
        "waivers": (),
        "load_cases": (),
    }
    return SimpleNamespace(**(plain | changes))


def cycle(shape: Contour | None = None, load_case: str = "idle", scale: float = 1.0, **changes):
    """Loads of a rubbing follower on the harmonic lift, and round figures beside them."""
    lift = (shape or contour()).pitch.lift
    s, slope, bend = (lift(THETA, order) for order in (0, 1, 2))
    spring, inertia = PRELOAD + RATE * s, MASS * CAM_SPEED**2 * bend
    rub = np.full(POSITIONS, 10.0)
    wave = np.sin(THETA)
    plain = {
        "load_case": load_case,
        "crank_speed": 2.0 * CAM_SPEED,
        "theta": THETA,
        "torque_before": 10.0 * wave,
        "residual_torque": 5.0 * wave * scale,
        "loads": SimpleNamespace(
            normal_force=300.0 * scale + 100.0 * wave,
            velocity=slope * CAM_SPEED,
            lift_slope=slope,
            spring_force=spring,
            inertia_force=inertia,
            friction_force_a=rub,
            friction_force_b=rub,
            viscous_force=np.zeros(POSITIONS),
            sliding_torque=np.zeros(POSITIONS),
            cam_torque=(spring + inertia) * slope + 2.0 * rub * np.abs(slope),
            jam_index=0.2 + 0.1 * wave,
            jam_index_statics=0.25 + 0.1 * wave,
        ),
        "contact": SimpleNamespace(
            p0=(800e6 + 100e6 * wave) * scale,
            p0_hertz=(800e6 + 100e6 * wave) * scale / 1.01,
            von_mises=(400e6 + 100e6 * wave) * scale,
            half_width=np.full(POSITIONS, 1e-4),
            tau_depth=np.full(POSITIONS, 0.786e-4),
            von_mises_depth=np.full(POSITIONS, 0.7e-4),
            residual_equilibrium=np.full(POSITIONS, 1e-9),
            residual_complementarity=np.full(POSITIONS, 1e-11),
        ),
        "friction_residual": np.full(POSITIONS, 1e-14),
        "guides": SimpleNamespace(
            reaction_a=-500.0 * wave,
            reaction_b=-200.0 * wave,
            rubbing_load_a=np.abs(500.0 * wave),
            rubbing_load_b=np.abs(200.0 * wave),
            force_residual=np.full(POSITIONS, 1e-13),
            moment_residual=np.full(POSITIONS, 1e-12),
        ),
        "rolling": SimpleNamespace(
            traction_demand=0.02 + 0.01 * wave,
            film=SimpleNamespace(ratio=2.0 + 0.5 * wave),
            sliding=None,
            bore=SimpleNamespace(
                von_mises=np.full(POSITIONS, 500e6),
                away_from_edges=np.full(POSITIONS, 200e6),
                excluded=5e-4,
            ),
            envelope=SimpleNamespace(
                crossland=np.array([[150e6, 200e6]]),
                dang_van=np.array([[180e6, 240e6]]),
                depth=np.array([[0.0, 0.5e-3]]),
                von_mises=np.array([[300e6, 400e6]]),
            ),
        ),
    }
    return SimpleNamespace(**(plain | changes))


MESH = SimpleNamespace(
    min_angle_deg=28.0, min_scaled_jacobian=0.5, edges_across_half_width=10.0, elements=1, nodes=1
)
MESHES = {
    name: Convergence((1.1, 1.02, 1.005), 1.001, 2.0, 0.01)
    for name in ("p0", "half_width", "von_mises", "tau_max")
}
CERTIFICATE = (
    SimpleNamespace(theta=0.5, spread_percent=-0.2, gci_percent=0.5, **MESHES),
    SimpleNamespace(theta=1.5, spread_percent=-0.4, gci_percent=0.4, **MESHES),
)
BENCHMARKS = {
    f"{name}_{figure}": 0.01 for name in ("nafems", "hertz") for figure in ("p0", "half_width")
}


def evidence(**changes) -> TrialEvidence:
    """A trial that passes; `changes` replace its parts."""
    speed = {"idle": (2.0, 1.0)}
    plain = TrialEvidence(case(), contour(), (cycle(),), MESH, CERTIFICATE, BENCHMARKS, speed)
    return replace(plain, **changes)


def limits(**values):
    """A case whose limits are these, the rest as in `case()`."""
    return case(limits=asked(**values))


def changed(base, **values):
    """A namespace with some of its values replaced."""
    return SimpleNamespace(**(vars(base) | values))
