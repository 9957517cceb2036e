"""Stem and guides against closed forms, a collocation solver and their own limits."""

from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine
from skfem.helpers import dd, ddot

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.material import Material
from camwright.pipeline.follower.follower_forces import FollowerSystem
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.follower.guide_contact import BearingLine, settle
from camwright.pipeline.follower.guide_reactions import (
    KNOTS,
    Guide,
    GuidePair,
    bearing_line,
    guide_reactions,
    lobatto,
)
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.stem_beam import Stem, end_flexibility, stem_compliance

# Virtual work of unit bending stiffness, the integral of u'' v''.
bending = BilinearForm(lambda u, v, _: ddot(dd(u), dd(v)))
STEM = Stem(0.01, 210e9)
EI = STEM.bending_stiffness
# Its elastic constants play no part: every guide has a stiffness of its own.
CARD = Material(E=2.8e9, nu=0.4, yield_strength=70e6, density=1140.0, source="a test")


def guide(length, clearance, modulus):
    """A guide without friction whose foundation has a modulus, N/m2."""
    return Guide(
        length=length, diameter=0.01, clearance=clearance, stiffness=modulus * length,
        friction=0.0, material=CARD,
    )  # fmt: skip


def guide_pair(length=0.02, clearance=0.0, modulus=2e10, spacing=0.08):
    both = guide(length, clearance, modulus)
    return GuidePair(spacing=spacing, a=both, b=both)


def test_bending_stiffness_of_a_bar_and_of_a_tube():
    assert pytest.approx(210e9 * np.pi * 0.01**4 / 64, rel=1e-14) == EI
    tube = replace(STEM, bore=0.006)
    assert tube.bending_stiffness == pytest.approx(210e9 * np.pi * (1e-8 - 0.006**4) / 64)


def test_cantilever_under_force_and_moment_at_its_end():
    """Against one Hermite element, which is exact for end loads; round-off of its inverse."""
    for length in (0.5, 1.0, 3.0):
        basis = Basis(MeshLine(np.array([0.0, length])), ElementLineHermite())
        end = [int(dofs[1]) for dofs in basis.nodal_dofs]
        stiffness = EI * bending.assemble(basis).toarray()[np.ix_(end, end)]
        np.testing.assert_allclose(
            end_flexibility(length, STEM), np.linalg.inv(stiffness), rtol=1e-12, atol=0
        )


@pytest.mark.parametrize("knots", [5, 25, 97])
def test_cantilever_loaded_anywhere(knots):
    """Green's function xi^2 (3 x - xi)/6EI, on nodes that crowd at the mouths of two guides."""
    unit, _ = lobatto(knots)
    nodes = np.r_[0.01 * (1 + unit), 0.09 + 0.01 * unit]
    near, far = np.minimum.outer(nodes, nodes), np.maximum.outer(nodes, nodes)
    deflection, slope = stem_compliance(nodes, STEM)
    np.testing.assert_allclose(deflection, near**2 * (3 * far - near) / (6 * EI), rtol=1e-8, atol=0)
    x, load = np.meshgrid(nodes, nodes, indexing="ij")
    turned = np.where(x < load, x * (2 * load - x), load**2) / (2 * EI)
    np.testing.assert_allclose(slope, turned, rtol=1e-8, atol=0)


def test_condensed_chain_is_the_assembled_system():
    """The same elements assembled over the whole stem and factorised: 1e-8 on even elements."""
    nodes = np.linspace(0.0, 0.1, 21)
    basis = Basis(MeshLine(nodes), ElementLineHermite())
    free = np.setdiff1d(np.arange(basis.N), [dofs[0] for dofs in basis.nodal_dofs])
    stiffness = EI * bending.assemble(basis).toarray()[np.ix_(free, free)]
    inverse = np.zeros((basis.N, basis.N))
    inverse[np.ix_(free, free)] = np.linalg.inv(stiffness)
    at, turned = basis.nodal_dofs
    deflection, slope = stem_compliance(nodes, STEM)
    largest = np.abs(deflection).max()
    np.testing.assert_allclose(inverse[np.ix_(at, at)], deflection, atol=1e-8 * largest)
    np.testing.assert_allclose(inverse[np.ix_(turned, at)], slope, atol=1e-8 * np.abs(slope).max())


@pytest.mark.parametrize("bore", [0.0, 0.006])
def test_shear_adds_its_closed_form(bore):
    """Timoshenko cantilever: + P L/(kappa G A); Cowper's kappa for a solid bar is 6/7 at nu = 0.

    A very thin tube tends to kappa = 2 (1 + nu)/(4 + 3 nu).
    """
    plain = Stem(0.01, 210e9, 0.0, bore=bore)
    shears = replace(plain, shear=True)
    area = np.pi / 4 * (0.01**2 - bore**2)
    added = end_flexibility(0.05, shears) - end_flexibility(0.05, plain)
    kappa = 0.05 / (added[0, 0] * 105e9 * area)
    if bore == 0.0:
        assert kappa == pytest.approx(6 / 7, rel=1e-12)
    np.testing.assert_allclose(added, [[added[0, 0], 0.0], [0.0, 0.0]], atol=1e-24)
    skin = Stem(0.01, 210e9, 0.3, shear=True, bore=0.01 * (1 - 1e-7))
    thin = 1 / (skin.shear_flexibility * 210e9 / 2.6 * np.pi / 4 * (0.01**2 - skin.bore**2))
    assert thin == pytest.approx(2 * 1.3 / (4 + 0.9), rel=1e-6)


def test_shear_of_a_compliance_matrix():
    """Every node past a load follows it without turning: the shear term is min(x, xi)/(kGA)."""
    nodes = np.linspace(0.0, 0.1, 8)
    shears = replace(STEM, shear=True)
    added = stem_compliance(nodes, shears)[0] - stem_compliance(nodes, STEM)[0]
    np.testing.assert_allclose(
        added, np.minimum.outer(nodes, nodes) * shears.shear_flexibility, atol=1e-19
    )


def test_overhanging_beam_on_two_point_supports():
    """Tip deflection F a^2 (a+b)/3EI and slope F a b/3EI at the first support: 1e-8.

    The supports yield by A/K and B/K, which turns the beam by a little more.
    """
    span, reach, force = 0.08, np.array([0.03, 0.06]), np.array([800.0, -200.0])
    nodes, stiffness = np.array([0.0, span]), 1e14
    line = BearingLine(
        positions=nodes,
        weights=np.ones(2),
        foundation=np.full(2, stiffness),
        play=np.zeros(2),
        compliance=stem_compliance(nodes, STEM)[0],
        edges=np.array([0, 1]),
    )
    push, rigid = settle(line, force, -force * reach)
    np.testing.assert_allclose(push[0], force * (reach + span) / span, rtol=1e-12)
    np.testing.assert_allclose(push[1], -force * reach / span, rtol=1e-12)
    yielding = (push[1] - push[0]) / stiffness / span
    slope = -force * reach * span / (3 * EI) + yielding
    np.testing.assert_allclose(rigid[1], slope, rtol=1e-8)
    tip = rigid[0] - rigid[1] * reach + end_flexibility(reach, STEM)[:, 0, 0] * force
    expected = force * reach**2 * (reach + span) / (3 * EI)
    expected += push[0] / stiffness - yielding * reach
    np.testing.assert_allclose(tip, expected, rtol=1e-8)


def hetenyi(x, length, modulus, force):
    """Deflection of a free beam on an elastic foundation, loaded at its end x = 0.

    Hetenyi, Beams on Elastic Foundation (1946), ch. III, free ends and a load at one of them.
    """
    stretch = (modulus / (4 * EI)) ** 0.25
    full, at, rest = stretch * length, stretch * x, stretch * (length - x)
    shape = np.sinh(full) * np.cos(at) * np.cosh(rest) - np.sin(full) * np.cosh(at) * np.cos(rest)
    return 2 * force * stretch / modulus * shape / (np.sinh(full) ** 2 - np.sin(full) ** 2)


def foundation_error(modulus, knots):
    """Worst deflection on the foundation of guide A, B as soft as air, over that of its end."""
    length, force = 0.04, 500.0
    alone = GuidePair(spacing=0.08, a=guide(length, 0.0, modulus), b=guide(0.01, 0.0, 1e-5))
    found = guide_reactions([force], 0.5 * length, STEM, alone, knots=knots)
    expected = hetenyi(found.knots_a + 0.5 * length, length, modulus, force)
    miss = np.abs(found.line_pressure_a[:, 0] / modulus - expected).max()
    return max(miss / expected[0], abs(found.roller_deflection[0] / expected[0] - 1))


@pytest.mark.parametrize(("modulus", "knots"), [(1e8, 33), (1e9, 65), (2e10, 129)])
def test_beam_on_an_elastic_foundation(modulus, knots):
    """1e-8 of the end's deflection, with more knots where the foundation is stiffer."""
    assert foundation_error(modulus, knots) <= 1e-8


@pytest.mark.parametrize(("modulus", "limit"), [(2e10, 3e-6), (9e11, 2e-5)])
def test_the_knots_in_use_meet_the_foundation(modulus, limit):
    """With the default knots, on a nylon and on a steel bush twice as long as usual."""
    assert foundation_error(modulus, KNOTS) <= limit


def test_foundation_converges_with_the_fourth_order():
    """The beam's kernel has a corner in its third derivative: order 4 in the knot spacing."""
    error = [foundation_error(9e11, n) for n in (33, 65, 129)]
    order = np.log2(np.divide(error[:-1], error[1:]))
    np.testing.assert_allclose(order, 4.0, atol=0.2)


def test_end_force_and_end_moment_are_reciprocal():
    """Turn per unit force is deflection per unit moment (Maxwell), overhang included."""
    pair, step = guide_pair(), 1e-7
    force, reach = 300.0, 0.045
    by_moment = guide_reactions([0.0], reach, STEM, pair, end_moment=[1.0]).roller_deflection[0]
    tips = [
        guide_reactions([force], r, STEM, pair).roller_deflection[0] for r in (reach, reach + step)
    ]
    assert by_moment * force < 0.0 < tips[0] < tips[1]
    with_both = guide_reactions([force], reach, STEM, pair, end_moment=[2.0])
    assert with_both.roller_deflection[0] == pytest.approx(tips[0] + 2.0 * by_moment, rel=1e-10)
    assert with_both.statics_b[0] == pytest.approx((force * reach - 2.0) / 0.08)
    arm = reach - 0.01
    cantilever = end_flexibility(arm, STEM)
    mouth = guide_reactions([force], 0.01, STEM, pair, end_moment=[-force * arm])
    tilt_by_force = (tips[0] - mouth.roller_deflection[0] - cantilever[0, 0] * force) / arm
    force_by_moment = guide_reactions([0.0], 0.01, STEM, pair, end_moment=[1.0])
    shift = force_by_moment.roller_deflection[0] - tilt_of_mouth(pair, 1.0) * arm
    assert by_moment == pytest.approx(shift - cantilever[0, 1], rel=1e-9)
    assert tilt_by_force > 0.0


def tilt_of_mouth(pair, moment):
    """Tilt of the stem at the mouth under a moment there, from two overhangs."""
    near = guide_reactions([0.0], 0.01, STEM, pair, end_moment=[moment]).roller_deflection[0]
    far = guide_reactions([0.0], 0.02, STEM, pair, end_moment=[moment]).roller_deflection[0]
    return (near - far - end_flexibility(0.01, STEM)[0, 1] * moment) / 0.01


def test_short_stiff_guides_are_the_papers_point_supports():
    """1e-6 of the reactions, with guides of 20 micrometres that yield as little as long ones."""
    force, reach = np.array([800.0, -150.0]), np.array([0.03, 0.06])
    found = guide_reactions(force, reach, STEM, guide_pair(length=2e-5, modulus=1e12))
    np.testing.assert_allclose(found.reaction_a, force * (reach + 0.08) / 0.08, rtol=1e-6)
    np.testing.assert_allclose(found.reaction_b, force * reach / 0.08, rtol=1e-6)
    assert np.abs(found.moment_a / (force * reach)).max() < 1e-6


def test_difference_from_point_supports_falls_with_the_square_of_the_length():
    """At the same stiffness k L of the support the couple it can hold goes as k L^3."""

    def difference(length):
        pair = guide_pair(length, modulus=1e8 / length)
        found = guide_reactions([500.0], 0.04, STEM, pair)
        return abs(found.reaction_a[0] / found.statics_a[0] - 1)

    misses = np.array([difference(1e-3 * 0.5**k) for k in range(4)])
    np.testing.assert_allclose(misses[:-1] / misses[1:], 4.0, rtol=3e-3)


def test_a_short_guide_with_play_is_a_point_support_too():
    """Play tilts the stem but moves no reaction of a point: the miss falls with L squared.

    1e-6 of the statics at 50 micrometres, at the same stiffness of the support.
    """

    def found(length):
        pair = guide_pair(length=length, modulus=1e6 / length, clearance=2e-5)
        return guide_reactions([500.0], 0.04, STEM, pair)

    misses = np.array([1.0 - found(2e-4 * 0.5**k).reaction_b[0] / 250.0 for k in range(3)])
    np.testing.assert_allclose(misses[:-1] / misses[1:], 4.0, rtol=0.01)
    assert 0.0 < misses[2] < 1e-6
    assert found(1e-4).rubbing_load_a[0] == pytest.approx(750.0, rel=1e-6)
    assert found(1e-4).slope_a[0] != 0.0


def test_a_light_load_leans_on_the_mouths():
    """Stem against the outer mouth of A and the far end of B: levers a - L/2 and b + L."""
    pair = guide_pair(length=0.02, clearance=1e-4)
    found = guide_reactions([1e-7], 0.05, STEM, pair)
    assert found.reaction_b[0] == pytest.approx(1e-7 * 0.04 / 0.10, rel=1e-9)
    assert found.slope_a[0] == pytest.approx(-1e-4 / 0.10, rel=1e-6)
    assert found.moment_a[0] < 0.0 < found.reaction_a[0]


def test_a_tight_guide_a_holds_a_light_load_alone():
    """With play only in B both mouths of A carry it, in the levers a -+ L/2."""
    pair = GuidePair(spacing=0.08, a=guide(0.02, 1e-6, 1e12), b=guide(0.02, 1e-3, 1e12))
    found = guide_reactions([1e-7], 0.05, STEM, pair)
    assert found.reaction_b[0] == 0.0
    assert found.reaction_a[0] == pytest.approx(1e-7, rel=1e-9)
    assert found.rubbing_load_a[0] == pytest.approx(1e-7 * (0.06 + 0.04) / 0.02, rel=1e-6)


@pytest.mark.parametrize("force", [40.0, 900.0])
@pytest.mark.parametrize("clearance", [1e-5, 6e-5])
def test_partial_contact_against_a_displacement_solution(force, clearance):
    """The same beam as an assembled displacement model: even elements, the bore at Gauss points.

    A Newton iteration in the displacements, no knots and no compliance; 1e-3 of the reactions.
    """
    modulus, reach, span, half = 2e10, 0.045, 0.08, 0.01
    pair = guide_pair(clearance=clearance)
    found = guide_reactions([force], reach, STEM, pair, knots=65)
    basis = Basis(
        MeshLine(np.linspace(0.0, span + 2 * half, 201)), ElementLineHermite(), intorder=8
    )
    place = basis.global_coordinates()[0].ravel()
    weight = basis.dx.ravel() * modulus * ((place < 2 * half) | (place > span))
    shape = basis.probes(place[None, :]).toarray()
    stiffness = EI * bending.assemble(basis).toarray()
    load = np.zeros(basis.N)
    load[[dofs[0] for dofs in basis.nodal_dofs]] = force, -force * (reach - half)
    play, w = 0.5 * clearance, np.where(place < 0.6 * span, 1.0, -1.0)
    for _ in range(60):
        touch = weight * (np.abs(w) > play)
        tangent = stiffness + (shape.T * touch) @ shape
        u = np.linalg.solve(tangent, load + shape.T @ (touch * np.sign(w) * play))
        settled = np.array_equal(np.abs(shape @ u) > play, np.abs(w) > play)
        w = shape @ u
        if settled:
            break
    assert settled
    push = weight * np.sign(w) * np.maximum(np.abs(w) - play, 0.0)
    reference = [push[place < 2 * half].sum(), -push[place > span].sum()]
    np.testing.assert_allclose([found.reaction_a[0], found.reaction_b[0]], reference, rtol=1e-3)
    assert found.slope_a[0] == pytest.approx(
        np.interp(half, basis.doflocs[0][basis.nodal_dofs[1]], u[basis.nodal_dofs[1]]), rel=1e-3
    )


def test_partial_contact_converges_with_the_knots():
    """25 knots miss the reactions by < 0.1 %, the peak of a guide whose mouth bites by < 2 %."""
    force, pair = np.array([30.0, 300.0, 900.0]), guide_pair(clearance=5e-5)
    by_knots = {n: guide_reactions(force, 0.045, STEM, pair, knots=n) for n in (13, KNOTS, 161)}

    def miss(knots, name):
        return np.abs(getattr(by_knots[knots], name) / getattr(by_knots[161], name) - 1).max()

    assert miss(KNOTS, "reaction_b") < 1e-3
    assert miss(KNOTS, "line_pressure_max_a") < 2e-2
    assert miss(KNOTS, "reaction_b") < miss(13, "reaction_b")


def test_many_guides_settle_in_equilibrium():
    """Random lengths, plays, stiffnesses and loads; every residual is far below 1e-9."""
    rng = np.random.default_rng(11)
    worst = 0.0
    for _ in range(25):
        lengths = rng.uniform(0.003, 0.04, 2)
        moduli = 10 ** rng.uniform(7.0, 12.5, 2)
        plays = rng.choice([0.0, 1e-6, 1e-5, 1e-4, 1e-3], 2)
        spacing = lengths.mean() + rng.uniform(0.001, 0.1)
        a, b = (guide(n, c, k) for n, c, k in zip(lengths, plays, moduli, strict=True))
        force = rng.normal(size=60) * 10 ** rng.uniform(-3.0, 4.0)
        reach = 0.5 * lengths[0] + rng.uniform(0.0, 0.08, 60)
        moment = rng.normal(size=60) * rng.integers(0, 2)
        pair = GuidePair(spacing=spacing, a=a, b=b)
        reactions = guide_reactions(force, reach, STEM, pair, moment)
        worst = max(worst, reactions.force_residual.max(), reactions.moment_residual.max())
        assert reactions.complementarity_residual.max() <= 1e-9
    assert worst <= 1e-11


def any_guides(rng):
    """A stem and guides: spacings to 9 m, bores to 9e11 N/m, tight or with clearance."""
    diameter = 10 ** rng.uniform(-2.5, -1.3)

    def bore():
        length = diameter * 10 ** rng.uniform(-1.5, 0.7)
        modulus = min(9e11 / length, 10 ** rng.uniform(9.0, 13.5))
        clearance = diameter * 10 ** rng.uniform(-4.5, -2.0) * (rng.random() < 0.8)
        made = guide(length, clearance, modulus)
        return replace(made, diameter=diameter)

    a, b = bore(), bore()
    spacing = min(9.0, 0.5 * (a.length + b.length) * (1.0 + 10 ** rng.uniform(-2.0, 2.5)))
    return Stem(diameter, 210e9, shear=bool(rng.integers(2))), GuidePair(spacing=spacing, a=a, b=b)


def test_stems_of_any_length_settle_in_bores_of_any_stiffness():
    """Loads from 1e-25 N, as splines leave them in dwells, to 10 kN: residuals below 5e-10.

    In the last one round-off leaves the contact law at more than 1e-10 of the indentation.
    """
    for seed in (*range(100), 888):
        rng = np.random.default_rng(seed)
        stem, pair = any_guides(rng)
        force = rng.choice([-1.0, 1.0], 60) * 10 ** rng.uniform(-25.0, 4.0, 60)
        reach = 0.5 * pair.a.length + pair.spacing * 10 ** rng.uniform(-1.0, 1.5)
        moment = force * rng.choice([0.0, 0.01, 0.5]) * rng.uniform(-1.0, 1.0, 60)
        solved = guide_reactions(force, reach + np.linspace(0.0, 0.02, 60), stem, pair, moment)
        for name in ("force_residual", "moment_residual", "complementarity_residual"):
            assert getattr(solved, name).max() <= 5e-10, (seed, name)


def test_a_small_load_is_carried_by_two_edges():
    """Statics on the outer edges of two bores with clearance, R = F (1 + x/l), and F x/l.

    The rigid stem rests at half the clearance on either side there.
    """
    stem, pair = STEM, guide_pair(length=0.03, clearance=3e-5, modulus=1e12, spacing=0.3)
    force, reach = np.array([-6e-22, 6e-22, 1e-16, 1e-12]), 0.06
    solved = guide_reactions(force, reach, stem, pair)
    lever = (reach - 0.015) / 0.33
    np.testing.assert_allclose(solved.reaction_a, force * (1.0 + lever), rtol=1e-12, atol=0)
    np.testing.assert_allclose(solved.reaction_b, force * lever, rtol=1e-12, atol=0)
    tilted = np.sign(force) * (1.5e-5 + 3e-5 * lever)
    np.testing.assert_allclose(solved.roller_deflection, tilted, rtol=1e-12, atol=0)
    assert solved.complementarity_residual.max() <= 1e-12


def test_many_loads_solved_at_once_are_those_solved_few_at_a_time():
    """Those solved at once start from solutions of similar loads; the deflections agree to 1e-7.

    From 1e-14 N, where the round-off of the clearance limits them, to 10 kN.
    """
    rng = np.random.default_rng(5)
    for clearance, modulus in ((0.0, 2e10), (1e-4, 2e10), (1e-3, 1e12)):
        pair = replace(guide_pair(clearance=clearance), a=guide(0.03, 5e-5, modulus))
        line = bearing_line(STEM, pair, 9)[0]
        size, direction = 10 ** rng.uniform(-14.0, 4.0, 1200), rng.uniform(-np.pi, np.pi, 1200)
        size[::100] = 0.0
        force, moment = size * np.cos(direction), 0.1 * size * np.sin(direction)
        pushes = settle(line, force, moment)[0]
        few = [settle(line, force[part], moment[part])[0] for part in np.split(np.arange(1200), 12)]
        scale = np.abs(pushes).max(axis=0)
        assert (np.abs(pushes - np.concatenate(few, axis=1)) <= 1e-7 * scale).all()
        assert (np.abs(pushes.sum(axis=0) - force) <= 1e-9 * size).all()


def test_more_play_more_tilt_and_longer_guides_less_pressure():
    tilt = [
        abs(guide_reactions([600.0], 0.05, STEM, guide_pair(clearance=c)).slope_a[0])
        for c in (0.0, 1e-5, 5e-5, 2e-4)
    ]
    assert (np.diff(tilt) > 0.0).all()
    peak = [
        guide_reactions([600.0], 0.05, STEM, guide_pair(n, modulus=1e9)).line_pressure_max_a[0]
        for n in (0.005, 0.01, 0.02, 0.03)
    ]
    assert (np.diff(peak) < 0.0).all()


def test_friction_balances_where_the_guides_have_round_off():
    """A long stem whose rubbing loads scatter by 2e-12 is solved to 1e-10 of the axial force."""
    theta = uniform_turn(90)
    for seed in (3, 27):
        rng = np.random.default_rng(seed)
        stem, pair = any_guides(rng)
        rise, back = np.clip((theta - 0.5) / 2.0, 0.0, 1.0), np.clip((theta - 3.5) / 1.5, 0.0, 1.0)
        size = 10 ** rng.uniform(-3.0, -1.3)
        shape = [x - np.sin(2.0 * np.pi * x) / (2.0 * np.pi) for x in (rise, back)]
        lift = Lift(theta, np.maximum(size * (shape[0] - shape[1]), 0.0))
        system = FollowerSystem(
            mass=10 ** rng.uniform(-1.0, 1.0),
            spring=Spring(rate=10 ** rng.uniform(2.0, 5.0), preload=10 ** rng.uniform(0.0, 3.0)),
            guide_spacing=pair.spacing,
            overhang_at_max_lift=0.5 * pair.a.length
            + size
            + pair.spacing * 10 ** rng.uniform(-1.0, 0.5),
            friction_a=rng.uniform(0.0, 0.4),
            friction_b=rng.uniform(0.0, 0.4),
        )
        pitch, speed = PitchCurve(lift, rng.uniform(2.0, 5.0) * size), 10 ** rng.uniform(-1.0, 1.5)
        knots = int(rng.choice([5, 25]))
        solved = guided_loads(pitch, system, stem, pair, speed, theta, knots=knots)
        assert solved.residual.max() <= 1e-10


def test_small_loads_among_many_settle_in_tight_guides():
    """Started between solutions of loads 1e30 times as great: three steps, not two."""
    rng = np.random.default_rng(7)
    force = rng.choice([-1.0, 1.0], 700) * 10 ** rng.uniform(-28.0, 3.0, 700)
    solved = guide_reactions(force, rng.uniform(0.02, 0.05, 700), STEM, guide_pair())
    for name in ("force_residual", "moment_residual", "complementarity_residual"):
        assert getattr(solved, name).max() <= 5e-10, name
