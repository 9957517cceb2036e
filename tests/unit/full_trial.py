"""The made-up trial of `fake_trial` with every part a case can describe, so that all is checked."""

from types import SimpleNamespace

import fake_trial as fake
import numpy as np

from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.checks.trial import TrialEvidence

WAVE = np.sin(fake.THETA)
WIRE, COIL, COILS, FREE = 6e-3, 40e-3, 8.2, 0.13
SHARE = SimpleNamespace(by_length=np.zeros(fake.POSITIONS), by_clearance=np.zeros(fake.POSITIONS))
KEY = SimpleNamespace(width=5e-3, depth=2.3e-3, angle=0.0)


def hollow() -> Contour:
    """Three lobes on a small base: convex tips and hollow flanks."""
    lift = Lift(fake.THETA, 0.005 * (1.0 - np.cos(3.0 * fake.THETA)))
    return Contour(PitchCurve(lift, 0.03), fake.ROLLER)


def case(**changes):
    """A case that describes spring, pin, ring, key, shaft, gear and bushes."""
    base = fake.case()
    nylon = SimpleNamespace(
        yield_strength=60e6,
        conductivity=0.25,
        temperature_limit=353.15,
        expansion=8e-5,
        swelling=0.01,
        source="maker",
    )
    steel = fake.changed(
        base.materials["steel"], density=7850.0, fatigue_bending=400e6, tensile_strength=900e6
    )
    materials = base.materials | {"nylon": nylon, "steel": steel}
    guide = fake.changed(
        base.guides.a,
        friction_max=0.2,
        thermal_resistance=None,
        clearance=1e-4,
        wear_rate=1e-16,
    )
    design = SimpleNamespace(
        wire_diameter=WIRE,
        mean_diameter=COIL,
        coils=COILS,
        free_length=FREE,
        end_factor=0.5,
        shear_modulus=77.2e9,
        density=7850.0,
        strength_at_1mm=1974e6,
        strength_exponent=0.108,
        treatment="peened",
        source="wire",
    )
    ring = SimpleNamespace(
        outer_diameter=2.0 * fake.ROLLER,
        fatigue_bending=700e6,
        tensile_strength=2000e6,
        source="ring",
    )
    roller = fake.changed(
        base.roller,
        radius=fake.ROLLER,
        hub_radius=0.004,
        pin=SimpleNamespace(material="hard", mounting="straddled"),
        bearing=fake.changed(
            base.roller.bearing, ring=ring, viscosity=20e-6, pitch_diameter=0.0105
        ),
    )
    shaft = SimpleNamespace(
        bearing_spacing=0.06,
        cam_position=0.02,
        gear_position=-0.015,
        gear_radius=0.02,
        mesh_angle=np.pi,
        pressure_angle=np.radians(20.0),
        drag=0.5,
        diameter=0.017,
        material="steel",
        notch_bending=2.14,
        notch_torsion=3.0,
        bearing_rating=9950.0,
        gear=SimpleNamespace(
            teeth=40,
            pinion_teeth=20,
            width=0.01,
            material="steel",
            application_factor=1.5,
            bending_limit=300e6,
            contact_limit=1200e6,
            source="gear",
        ),
        source="shaft",
    )
    plain = {
        "cam": fake.changed(base.cam, keyway=KEY, width=0.01, counter_hole=None),
        "spring": fake.changed(
            base.spring, rate_tolerance=0.05, preload_tolerance=0.05, design=design
        ),
        "guides": fake.changed(base.guides, a=guide, b=guide, ambient_temperature=293.15),
        "roller": roller,
        "roller_given": roller,
        "camshaft": shaft,
        "materials": materials,
        "limits": fake.asked(
            unbalance=1.0,
            shaft_bearing_life=3600.0,
            key_pressure=200e6,
            bore_pressure=100e6,
            curvature_rate=1e6,
        ),
    }
    made = fake.changed(base, **(plain | changes))
    made.material = lambda name: made.materials[name]
    return made


def parts(**changes):
    """What the parts of `cycle` carry, in round figures."""
    rubbed = 10.0 * np.abs(fake.cycle().loads.velocity)  # by the guides' 10 N each
    heat = SimpleNamespace(temperature=330.0, mean_power=0.0, power=rubbed)
    still = np.zeros(fake.POSITIONS)
    greatest = SimpleNamespace(friction_force_a=still, friction_force_b=still, velocity=still)
    plain = {
        "friction": SimpleNamespace(jam_index_max=0.3 + 0.1 * WAVE, greatest=greatest),
        "elastic": SimpleNamespace(
            response=SimpleNamespace(contact_force=300.0 + 100.0 * WAVE), flights=(), method="m"
        ),
        "bush_peak_a": 30e6 + 10e6 * WAVE,
        "bush_peak_b": 20e6 + 10e6 * WAVE,
        "heat_a": heat,
        "heat_b": heat,
        "pin_stress": 200e6 + 100e6 * WAVE,
        "ring_amplitude": 300e6 + 100e6 * WAVE,
        "ring_mean": np.full(fake.POSITIONS, 400e6),
        "key_pressure": 100e6 * WAVE,
        "bore_pressure": 20e6 + 10e6 * WAVE,
        "reversals": (),
        "surge_force": None,
        "shares": SimpleNamespace(reaction_a=SHARE, reaction_b=SHARE),
    }
    return SimpleNamespace(**(plain | changes))


def cycle(**changes):
    """The cycle of `fake_trial` with its parts and the forces on the shaft."""
    plain = fake.cycle()
    loads = fake.changed(
        plain.loads, axial_force=300.0 + 100.0 * WAVE, tangential_force=100.0 * WAVE
    )
    guides = fake.changed(plain.guides, statics_a=-400.0 * WAVE, statics_b=-150.0 * WAVE)
    given = {"parts": parts(), "loads": loads, "guides": guides}
    return fake.changed(plain, **(given | changes))


def evidence(**changes) -> TrialEvidence:
    """A trial of which every check can say something; `changes` replace its parts."""
    return fake.evidence(**({"case": case(), "cycles": (cycle(),)} | changes))
