"""Friction of guides of finite length: in balance with the contact force it raises."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import ContactError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower import friction_coupling
from camwright.pipeline.follower.follower_forces import (
    JAM_FLOOR,
    FollowerSystem,
    follower_loads,
    turn_integral,
)
from camwright.pipeline.follower.friction_coupling import (
    MovingFollower,
    balanced,
    guided_loads,
    guided_strokes,
)
from camwright.pipeline.follower.guide_effects import guide_shares
from camwright.pipeline.follower.guide_reactions import Guide, GuidePair, guide_reactions
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.stem_beam import Stem

THETA = uniform_turn(180)
PITCH = PitchCurve(Lift(THETA, 0.01 * (1 - np.cos(THETA)) + 0.002 * (1 - np.cos(3 * THETA))), 0.05)
SPRING = Spring(rate=24.2e3, preload=242.0)
SYSTEM = FollowerSystem(0.175, SPRING, 0.08, 0.03, 0.04, 0.2)
ROUGH = replace(SYSTEM, friction_a=0.2, friction_b=0.3)
STEM = Stem(0.01, 210e9)
SPEED = 75.0
# Its elastic constants play no part: every guide has a stiffness of its own.
CARD = Material(E=2.8e9, nu=0.4, yield_strength=70e6, density=1140.0, source="a test")


def guide(length, clearance, modulus):
    """A guide whose foundation has a modulus, N/m2; its friction is that of the system."""
    return Guide(
        length=length, diameter=0.01, clearance=clearance, stiffness=modulus * length,
        friction=0.0, material=CARD,
    )  # fmt: skip


NYLON, STEEL = guide(0.02, 5e-5, 2e10), guide(0.02, 5e-5, 9e11)
PAIR = GuidePair(spacing=0.08, a=NYLON, b=STEEL)


def tight(pair):
    return replace(pair, a=replace(pair.a, clearance=0.0), b=replace(pair.b, clearance=0.0))


def guided(system, pair=PAIR, pitch=PITCH, theta=THETA):
    return guided_loads(pitch, system, STEM, pair, SPEED, theta)


def solved_anew(loads, pair=PAIR):
    return guide_reactions(loads.tangential_force, loads.overhang, STEM, pair)


def test_strokes_solved_at_once_are_those_solved_alone():
    """Of other friction, offset, speed and number of positions; 1e-10 is the axial balance."""
    strokes = [
        MovingFollower(PITCH, SYSTEM, SPEED, THETA),
        MovingFollower(PitchCurve(PITCH.lift, 0.05, 0.012), ROUGH, 0.0, uniform_turn(36)),
        MovingFollower(PITCH, replace(ROUGH, mass=0.3), 2.0 * SPEED, THETA),
    ]
    for stroke, together in zip(strokes, guided_strokes(strokes, STEM, PAIR), strict=True):
        pitch, system, speed, theta = stroke
        alone = guided_loads(pitch, system, STEM, PAIR, speed, theta)
        np.testing.assert_array_equal(together.loads.theta, theta)
        for name in ("normal_force", "friction_force_a", "friction_force_b"):
            wanted = getattr(alone.loads, name)
            np.testing.assert_allclose(
                getattr(together.loads, name), wanted, rtol=1e-10, atol=1e-10 * wanted.max()
            )


@pytest.mark.parametrize("offset", [0.0, 0.012, -0.012])
@pytest.mark.parametrize("system", [SYSTEM, ROUGH, replace(SYSTEM, viscous_damping=30.0)])
def test_forces_along_the_stem_cancel(system, offset):
    """The guides solved anew under the side force found rub with what the push has too much.

    1e-10 of the axial force is the limit; both solutions meet their equations to round-off.
    """
    loads = guided(system, pitch=PitchCurve(PITCH.lift, 0.05, offset)).loads
    bearing = solved_anew(loads)
    rubs = system.friction_a * bearing.rubbing_load_a + system.friction_b * bearing.rubbing_load_b
    carried = loads.spring_force + loads.inertia_force + loads.viscous_force
    miss = loads.axial_force - carried - np.sign(loads.velocity) * rubs
    assert (np.abs(miss) <= 1e-10 * loads.axial_force).all()
    np.testing.assert_allclose(
        loads.friction_force_a, system.friction_a * bearing.rubbing_load_a, rtol=1e-9, atol=1e-9
    )


def test_agrees_with_plain_repetition():
    """Statics, guides, friction, force, round and round: the same, only slower. 1e-9 of the force.

    Each round shrinks the miss by the jam index, so 30 rounds at 0.35 do.
    """
    rough = replace(SYSTEM, friction_a=0.6, friction_b=1.0)
    found = guided(rough)
    system = replace(rough, rubbing=None)
    for _ in range(30):
        loads = follower_loads(PITCH, system, SPEED, THETA)
        bearing = solved_anew(loads)
        side = np.abs(loads.tangential_force)
        a, b = (
            np.divide(load, side, out=np.ones_like(side), where=side > 0.0)
            for load in (bearing.rubbing_load_a, bearing.rubbing_load_b)
        )
        system = replace(system, rubbing=friction_coupling.Rubbing(THETA, a, b))
    assert found.loads.jam_index.max() > 0.2
    np.testing.assert_allclose(found.loads.normal_force, loads.normal_force, rtol=1e-9)
    assert found.rounds < 15


def test_cam_work_is_the_heat_of_the_finite_guides():
    """Energy over a turn closes with the loads of the guides, not those of point supports: 1e-9."""
    loads = guided(ROUGH).loads
    bearing = solved_anew(loads)
    heat = 0.2 * bearing.rubbing_load_a + 0.3 * bearing.rubbing_load_b
    taken = float(np.mean(heat * np.abs(loads.lift_slope)) * 2 * np.pi)
    assert turn_integral(loads.theta, loads.cam_torque) == pytest.approx(taken, rel=1e-9)
    assert loads.friction_loss == pytest.approx(taken, rel=1e-9)
    on_points = follower_loads(PITCH, ROUGH, SPEED, THETA)
    assert abs(turn_integral(on_points.theta, on_points.cam_torque) / taken - 1.0) > 0.05


def test_short_stiff_guides_are_the_papers_statics():
    """Guides of 20 micrometres: contact force, friction, jam index of point supports, 1e-6."""
    short = guide(2e-5, 0.0, 1e12)
    found = guided(ROUGH, GuidePair(spacing=0.08, a=short, b=short)).loads
    points = follower_loads(PITCH, ROUGH, SPEED, THETA)
    for name in ("normal_force", "cam_torque", "jam_index"):
        peak = np.abs(getattr(points, name)).max()
        np.testing.assert_allclose(getattr(found, name), getattr(points, name), atol=1e-6 * peak)


def test_without_friction_the_guides_have_no_say():
    smooth = replace(SYSTEM, friction_a=0.0, friction_b=0.0)
    found, points = guided(smooth).loads, follower_loads(PITCH, smooth, SPEED, THETA)
    np.testing.assert_array_equal(found.normal_force, points.normal_force)
    assert found.friction_loss == 0.0


def test_more_friction_more_force_out_and_less_back():
    levels = [
        guided(replace(SYSTEM, friction_a=mu, friction_b=mu)).loads.axial_force
        for mu in (0.0, 0.05, 0.1, 0.2)
    ]
    steps = np.diff(levels, axis=0)
    loaded = np.abs(np.tan(PITCH.pressure_angle(THETA))) > 1e-3
    moving = np.abs(PITCH.lift(THETA, 1)) > 1e-5
    rising = PITCH.lift(THETA, 1) > 0.0
    assert (steps[:, rising & loaded & moving] > 0.0).all()
    assert (steps[:, ~rising & loaded & moving] < 0.0).all()


def test_a_jam_is_told_by_its_index_and_the_forces_stay_finite():
    steep = PitchCurve(Lift(THETA, 0.1 * (1.0 - np.cos(THETA))), 0.02)
    locked = replace(SYSTEM, friction_a=0.5, friction_b=0.9)
    found = guided(locked, pitch=steep).loads
    assert found.jammed.any()
    assert np.isfinite(found.normal_force).all()
    np.testing.assert_allclose(
        found.axial_force[found.jammed],
        follower_loads(
            steep, replace(locked, friction_a=0, friction_b=0), SPEED, THETA
        ).axial_force[found.jammed]
        / JAM_FLOOR,
    )


def test_the_least_push_that_moves_the_follower():
    """A stiff tight guide B bites harder under more load: at some angles a balance at 0.6 of the
    jam, another at 0.9 and the jam itself answer. Below the push found none does.

    The guides are solved anew at 40 pushes from that without friction up to 0.98 of the one found.
    """
    lift = Lift(THETA, 0.0134 * (1.0 - np.cos(THETA)))
    pitch = PitchCurve(lift, 0.0315, -0.0092)
    a, b = guide(0.0113, 1e-5, 5.4e8), guide(0.027, 1e-6, 9.9e11)
    pair = GuidePair(spacing=0.0551, a=a, b=b)
    system = FollowerSystem(0.175, SPRING, 0.0551, 0.0069, 0.105, 0.384)
    found = guided(system, pair, pitch).loads
    free = follower_loads(
        pitch, replace(system, friction_a=0.0, friction_b=0.0), SPEED, THETA
    ).axial_force
    rising = (found.lift_slope > 1e-4) & (found.jam_index > 0.5) & ~found.jammed
    assert rising.sum() > 5
    free, least = free[rising], found.axial_force[rising]
    tangent, overhang = np.tan(found.pressure_angle[rising]), found.overhang[rising]

    def needed(push):
        bearing = guide_reactions(push * tangent, overhang, STEM, pair)
        return free + 0.105 * bearing.rubbing_load_a + 0.384 * bearing.rubbing_load_b

    for share in np.linspace(0.0, 1.0, 40):
        push = free + share * (0.98 * least - free)
        assert (needed(push) > push).all()
    np.testing.assert_allclose(needed(least), least, rtol=1e-9)
    # pushed so hard from elsewhere, the same guides would hold the follower fast
    assert (needed(30.0 * least) > 30.0 * least).any()


def test_machines_at_random_are_in_balance():
    """Lengths, plays, stiffness, friction and offset at random: 1e-10 everywhere, in few rounds."""
    rng = np.random.default_rng(8)
    rounds = []
    for _ in range(20):
        length, play = rng.uniform(0.005, 0.04, 2), rng.choice([0.0, 1e-6, 5e-5, 2e-4], 2)
        stiff = 10 ** rng.uniform(8.5, 12.0, 2)
        a, b = (guide(n, c, k) for n, c, k in zip(length, play, stiff, strict=True))
        pair = GuidePair(spacing=float(rng.uniform(0.045, 0.1)), a=a, b=b)
        reach = 0.5 * float(length[0]) + float(rng.uniform(0.001, 0.05))
        mu = rng.uniform(0.0, 0.3, 2)
        system = FollowerSystem(0.175, SPRING, pair.spacing, reach, *map(float, mu))
        found = guided(system, pair, PitchCurve(PITCH.lift, 0.05, float(rng.uniform(-0.02, 0.02))))
        assert found.residual.max() <= 1e-10
        rounds.append(found.rounds)
    assert np.mean(rounds) < 15


def test_lost_contact_rubs_nothing():
    found = guided_loads(PITCH, SYSTEM, STEM, PAIR, 900.0, THETA)
    assert found.loads.separated.any()
    apart = found.loads.separated
    np.testing.assert_array_equal(found.loads.friction_force[apart], 0.0)
    np.testing.assert_array_equal(found.reactions.rubbing_load_a[apart], 0.0)


def test_positions_do_not_depend_on_their_company():
    some = np.array([0.4, 1.3, 2.9, 4.4])
    together = guided(ROUGH, theta=some).loads.axial_force
    alone = [guided(ROUGH, theta=np.array([angle])).loads.axial_force[0] for angle in some]
    np.testing.assert_allclose(together, alone, rtol=1e-10)


def test_balance_of_functions_with_a_known_answer():
    """x = a + b x, steep and falling ones among them, and one too steep for a secant."""
    a, b = np.array([1.0, 1.0, 2.0, 0.0]), np.array([0.3, 0.97, -4.0, 0.0])

    def answer(x, at):
        line = a[at] + b[at] * x
        return np.where(at == 3, np.where(x < 0.7, 0.9, 0.7 * (0.7 / x) ** 40), line)

    high = np.array([100.0, 100.0, 2.0, 1.0])
    x, rounds = balanced(answer, np.zeros(4), high, np.array([5.0, 5.0, 1.0, 0.1]))
    np.testing.assert_allclose(x[:3], (a / (1 - b))[:3], rtol=1e-10)
    assert x[3] == pytest.approx(0.7, rel=1e-10)
    assert rounds <= 60


def test_no_balance_raises(monkeypatch):
    monkeypatch.setattr(friction_coupling, "_ROUNDS_MAX", 1)
    with pytest.raises(ContactError, match="not converged"):
        guided(ROUGH)


def test_a_residual_that_is_missed_raises(monkeypatch):
    solve = friction_coupling.guide_reactions

    def careless(*args, **more):
        found = solve(*args, **more)
        return replace(found, rubbing_load_a=found.rubbing_load_a * (1 + 1e-8))

    monkeypatch.setattr(friction_coupling, "guide_reactions", careless)
    with pytest.raises(ContactError, match="residual"):
        guided(ROUGH)


def shares(pair, system=ROUGH):
    found = guided(system, pair)
    return found, guide_shares(PITCH, system, STEM, pair, SPEED, found.loads, found.reactions)


def test_length_and_clearance_explain_the_difference():
    """The tight guides' share comes of one solution; solved in full they are the same: 1e-9."""
    found, parts = shares(PAIR)
    alone = guided(ROUGH, tight(PAIR))
    force, points = parts.normal_force, follower_loads(PITCH, ROUGH, SPEED, THETA)
    np.testing.assert_array_equal(force.points, points.normal_force)
    np.testing.assert_allclose(force.points + force.by_length, alone.loads.normal_force, rtol=1e-9)
    for share, whole in (
        (force, found.loads.normal_force),
        (parts.reaction_a, found.reactions.reaction_a),
    ):
        total = share.points + share.by_length + share.by_clearance
        np.testing.assert_allclose(total, whole, atol=1e-9 * np.abs(whole).max())
    changed = parts.reaction_a.by_length + parts.reaction_a.by_clearance
    statics = found.loads.tangential_force * found.loads.overhang / 0.08
    np.testing.assert_allclose(
        statics + changed, found.reactions.reaction_b, atol=1e-9 * np.abs(statics).max()
    )
    assert np.abs(force.by_length).max() > 1e-3 * force.points.max()
    assert np.abs(force.by_clearance).max() > 1e-3 * force.points.max()


def test_each_share_goes_with_its_cause():
    """No play, no share of it; guides as short as a point, no share of length: 1e-6 of it all."""
    found, parts = shares(tight(PAIR))
    peak = np.abs(found.reactions.reaction_a).max()
    assert np.abs(parts.reaction_a.by_clearance).max() <= 1e-9 * peak
    less = replace(PAIR, a=replace(NYLON, clearance=1e-6), b=replace(STEEL, clearance=1e-6))
    small = np.abs(shares(less)[1].reaction_a.by_clearance).max()
    assert small < 0.2 * np.abs(shares(PAIR)[1].reaction_a.by_clearance).max()
    short = guide(2e-5, 0.0, 1e12)
    _, points = shares(GuidePair(spacing=0.08, a=short, b=short))
    assert np.abs(points.reaction_a.by_length).max() <= 1e-6 * peak
