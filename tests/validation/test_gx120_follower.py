"""Follower of the balancing cam on a Honda GX120, against its published design.

Machine: Cardoso et al., Energies 18 (2025) 3256 (spring 24.2 kN/m, preload 242 N, follower
175 g, guides 80 mm apart, friction 0.04 and 0.2, least roller-centre radius 50 mm, 625 bearing).
The torque is that of a speed trace rebuilt from the paper's statistics, which is not shipped with
the project; the expected numbers come from an independent spectral computation of the same recipe
with an overhang of 30 mm at full lift and guide reactions from the friction-free side force. Both
ways agree to 5e-4 (they interpolate differently); liftoff and jam index are asked within 5 %.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from elastic_jump import elastic_jump_speed
from rigid_jump import rigid_jump_speed
from scipy.signal import resample

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.energy import lift_from_torque, without_mean
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower.elastic_follower import ElasticFollower
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    levers,
    turn_integral,
)
from camwright.pipeline.follower.guide_reactions import Guide, GuidePair, guide_reactions
from camwright.pipeline.follower.roller_motion import rating_life, roller_motion, static_safety
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.stem_beam import Stem

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("CAMWRIGHT_SHARED", ROOT.parent / "shared"))
TRACE = SHARED / "dossier" / "reference-speed-trace.csv"
pytestmark = pytest.mark.skipif(
    not TRACE.is_file(), reason="the reconstructed speed trace is absent"
)

THETA = uniform_turn(720)
CAM_SPEED = 75.5
SPRING = Spring(rate=24.2e3, preload=242.0)
SYSTEM = FollowerSystem(0.175, SPRING, 0.08, 0.03, 0.04, 0.2)
FREE = FollowerSystem(0.175, SPRING, 0.08, 0.03, 0.0, 0.0)

# spacing of the torque samples in the 12-point moving average (crank degrees), share of the
# torque that is balanced
DESIGNS = {"full, 60 deg": (5, 2.0), "half, 60 deg": (5, 1.0), "full, 12 deg": (1, 2.0)}
EXPECTED = {
    "full, 60 deg": {
        "stroke": 33.492e-3,
        "normal_force": (273.55, 1024.151),
        "tangential_force": (-116.961, 501.076),
        "reaction_a": (-182.609, 815.333),
        "reaction_b": (-67.854, 329.788),
        "inertia_force": (-114.933, 292.206),
        "friction": 98.084,
        "rubbing_normal_force": (258.7, 1014.8),
        "jam": 0.193,
        "liftoff_rpm": 3967.0,
        "residual_std": 1.89,
        "pitch_speed": (3.78, 6.57),
    },
    "half, 60 deg": {
        "stroke": 21.556e-3,
        "normal_force": (259.061, 743.535),
        "tangential_force": (-65.746, 285.107),
        "reaction_a": (-98.009, 436.852),
        "reaction_b": (-33.043, 155.329),
        "inertia_force": (-77.521, 161.616),
        "friction": 48.39,
        "rubbing_normal_force": (252.2, 738.1),
        "jam": 0.113,
        "liftoff_rpm": 4244.0,
        "residual_std": 3.59,
        "pitch_speed": (3.78, 5.41),
    },
    "full, 12 deg": {
        "stroke": 34.739e-3,
        "normal_force": (282.803, 1052.869),
        "tangential_force": (-147.292, 736.843),
        "reaction_a": (-265.251, 1284.753),
        "reaction_b": (-117.959, 551.283),
        "inertia_force": (-197.316, 524.34),
        "friction": 161.614,
        "rubbing_normal_force": (261.4, 1299.0),
        "jam": 0.265,
        "liftoff_rpm": 2959.0,
        "residual_std": 2.38,
        "pitch_speed": (3.78, 7.57),
    },
}


def crank_torque():
    rows = np.genfromtxt(TRACE, delimiter=",", comments="#")
    return rows[np.isfinite(rows[:, 0]), 2]


def pitch_of(design):
    """The recipe: resample, centred 12-sample mean with half weights at its ends, close."""
    spacing, multiplier = DESIGNS[design]
    samples = resample(crank_torque(), 720 // spacing)
    weights = np.r_[0.5, np.ones(11), 0.5] / 12.0
    mean = sum(w * np.roll(samples, shift) for w, shift in zip(weights, range(-6, 7), strict=True))
    torque, _ = without_mean(multiplier * resample(mean, 720))
    return PitchCurve(lift_from_torque(THETA, torque, 24.2e3, 242.0), 0.05)


@pytest.fixture(scope="module", params=list(DESIGNS))
def design(request):
    pitch = pitch_of(request.param)
    free, rubbing = (follower_loads(pitch, system, CAM_SPEED, THETA) for system in (FREE, SYSTEM))
    return pitch, free, rubbing, EXPECTED[request.param]


@pytest.mark.parametrize(
    "name", ["normal_force", "tangential_force", "reaction_a", "reaction_b", "inertia_force"]
)
def test_extremes_without_friction(design, name):
    _, free, _, expected = design
    found = getattr(free, name)
    np.testing.assert_allclose([found.min(), found.max()], expected[name], rtol=5e-4)


def test_stroke_and_surface_speed(design):
    pitch, _, _, expected = design
    assert pitch.lift.stroke == pytest.approx(expected["stroke"], rel=5e-4)
    along = roller_motion(pitch, 0.008, CAM_SPEED, THETA).pitch_speed
    np.testing.assert_allclose([along.min(), along.max()], expected["pitch_speed"], rtol=2e-3)


def test_friction_of_the_friction_free_side_force(design):
    _, free, rubbing, expected = design
    on_a, on_b = levers(free.overhang, SYSTEM.guide_spacing)
    factor = SYSTEM.friction_a * on_a + SYSTEM.friction_b * on_b
    assert (factor * np.abs(free.tangential_force)).max() == pytest.approx(
        expected["friction"], rel=5e-4
    )
    # friction feeds on itself: made implicit it is larger by the jam index, at least
    assert rubbing.friction_force.max() > 1.1 * expected["friction"]


def test_normal_force_with_friction(design):
    """0.3 %: the expected figures are rounded, and sampled at other angles."""
    _, _, rubbing, expected = design
    found = [rubbing.normal_force.min(), rubbing.normal_force.max()]
    np.testing.assert_allclose(found, expected["rubbing_normal_force"], rtol=3e-3)


def test_jam_index_and_liftoff_speed(design):
    pitch, _, rubbing, expected = design
    assert rubbing.jam_index.max() == pytest.approx(expected["jam"], rel=5e-3)
    liftoff = 2 * rigid_jump_speed(pitch, SYSTEM, THETA)[0] * 60 / (2 * np.pi)
    assert liftoff == pytest.approx(expected["liftoff_rpm"], rel=5e-3)


def test_design_scaled_to_the_printed_inertia():
    """The torque that the inertia printed in the paper (2.603e-3 kg m2) would leave of the trace's.

    Asked for is 5 %; expected figures carry at least two digits, half of the last one in the jam
    index 0.054 is 1 %.
    """
    samples = resample(crank_torque(), 144)
    weights = np.r_[0.5, np.ones(11), 0.5] / 12.0
    mean = sum(w * np.roll(samples, shift) for w, shift in zip(weights, range(-6, 7), strict=True))
    torque, _ = without_mean(2.0 * 2.603e-3 / 0.01330 * resample(mean, 720))
    pitch = PitchCurve(lift_from_torque(THETA, torque, 24.2e3, 242.0), 0.05)
    free, rubbing = (follower_loads(pitch, system, CAM_SPEED, THETA) for system in (FREE, SYSTEM))
    assert pitch.lift.stroke == pytest.approx(11.2e-3, rel=0.01)
    force = free.normal_force
    np.testing.assert_allclose([force.min(), force.max()], [249.0, 502.0], rtol=0.01)
    assert np.abs(free.reaction_a).max() == pytest.approx(185.0, rel=0.02)
    assert rubbing.jam_index.max() == pytest.approx(0.054, rel=0.01)
    liftoff = 2 * rigid_jump_speed(pitch, SYSTEM, THETA)[0] * 60 / (2 * np.pi)
    assert liftoff == pytest.approx(4760.0, rel=0.01)


def test_elastic_stem_lifts_off_like_the_rigid_one(design):
    """The stem's own stiffness (1.5e8 N/m) takes less than 0.5 % off the speed of the jump."""
    pitch, _, _, expected = design
    follower = ElasticFollower.with_damping_ratio(0.175, 1.5e8, 24.2e3, 242.0, 0.05)
    found = elastic_jump_speed(
        pitch.lift(THETA), follower, 1.2 * np.pi / 60 * expected["liftoff_rpm"]
    )
    assert 2 * found * 60 / (2 * np.pi) == pytest.approx(expected["liftoff_rpm"], rel=5e-3)


def test_residual_crank_torque_with_friction_and_inertia(design):
    _, _, rubbing, expected = design
    residual, _ = without_mean(resample(crank_torque(), 720) - 0.5 * rubbing.cam_torque)
    assert residual.std() == pytest.approx(expected["residual_std"], abs=0.015)


def test_loss_is_heat_of_the_guides(design):
    _, _, rubbing, _ = design
    assert turn_integral(rubbing.theta, rubbing.cam_torque) == pytest.approx(
        rubbing.friction_loss, rel=1e-9
    )
    assert not rubbing.separated.any()


@pytest.mark.parametrize(
    ("C", "C0", "hours", "safety"),
    [(1140.0, 380.0, (5, 16), (0.34, 0.48)), (1730.0, 670.0, (16, 58), (0.60, 0.85))],
    ids=["one maker", "another maker"],
)
def test_bearing_625_fails_sign_off(C, C0, hours, safety):
    """Two makers' cards for a 625; N_max 790 to 1120 N is the range of the designs examined."""
    pitch = pitch_of("full, 60 deg")
    force = follower_loads(pitch, SYSTEM, CAM_SPEED, THETA).normal_force
    spin = roller_motion(pitch, 0.008, CAM_SPEED, THETA).spin
    life = rating_life(force, spin, C)
    assert hours[0] <= life.seconds / 3600.0 <= hours[1]
    assert safety[0] <= static_safety(force, C0) <= safety[1]
    assert 650.0 <= life.mean_load <= 940.0


def test_guides_of_finite_length_at_every_angle(design):
    """10 x 20 mm bushes, nylon and steel: in equilibrium at all 720 angles, near the statics."""
    _, _, rubbing, _ = design
    nylon = Material(E=2.8e9, nu=0.4, yield_strength=70e6, density=1140.0, source="a test")
    steel = Material(E=210e9, nu=0.3, yield_strength=355e6, density=7850.0, source="a test")
    size = {"length": 0.02, "diameter": 0.01, "clearance": 5e-5}
    guides = GuidePair(
        spacing=0.08,
        a=Guide(**size, friction=0.04, material=nylon),
        b=Guide(**size, friction=0.2, material=steel),
    )
    reactions = guide_reactions(
        rubbing.tangential_force, rubbing.overhang, Stem(0.01, 210e9), guides
    )
    for name in ("force_residual", "moment_residual", "complementarity_residual"):
        assert getattr(reactions, name).max() <= 1e-9
    np.testing.assert_allclose(reactions.statics_a, rubbing.reaction_a, atol=1e-9)
    # the stem leans on the outer mouth of A and the far end of B: a shorter lever, a longer base
    assert 0.75 < reactions.reaction_a.max() / reactions.statics_a.max() < 1.0
    assert 0.35 < reactions.reaction_b.max() / reactions.statics_b.max() < 1.0
