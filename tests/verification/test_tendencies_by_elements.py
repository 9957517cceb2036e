"""Tendencies at a fixed lift, by the finite elements of contact and guides at a few angles."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import Corner, Machine, machines
from camwright.pipeline.checks import contact_strength, guide_strength, jump_and_jamming
from camwright.pipeline.checks.check import Check, Declaration
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.turn import turn

POSITIONS = 36
# What elements and the real bodies' give add to Hertz changes with the load, by as much.
ELEMENTS = 2e-3


@lru_cache(maxsize=1)
def case() -> Case:
    """The template's machine in guides without play, which answer in proportion to the load."""
    plain = parse_case(small_machine("tendency"))
    tight = {name: replace(getattr(plain.guides, name), clearance=0.0) for name in "ab"}
    return plain.model_copy(update={"guides": replace(plain.guides, **tight)})


@lru_cache(maxsize=1)
def cam() -> Contour:
    """One and the same lift of 20 mm for every load on it."""
    theta = uniform_turn(72)
    return case().contour(Lift(theta, 0.01 * (1.0 - np.cos(theta))))


@lru_cache(maxsize=1)
def bodies() -> CycleBodies:
    """Meshed and factored once: neither loads nor widths change them."""
    return CycleBodies.meshed(contact_pair(machines(case())[0], cam()))


def at(corner: Corner, width: float) -> Machine:
    """The machine at a corner, cam and roller as much wider, the roller without chamfers."""
    machine, roller = machines(case())[0].at_corner(corner), case().roller
    return replace(
        machine,
        cam=replace(machine.cam, width=width * machine.cam.width),
        follower=replace(roller, width=width * roller.width, end=None),
    )


@lru_cache(maxsize=16)
def cycle(corner: Corner, width: float = 1.0) -> Cycle:
    """The turn at a corner of the machine."""
    machine = at(corner, width)
    loaded = turn(machine, cam(), POSITIONS)
    pair = contact_pair(machine, cam())
    contact = two_scale_history(pair, bodies(), loaded.theta, loaded.loads.normal_force)
    return Cycle(loaded, cam(), pair, bodies(), contact)


def judged(declared: Declaration, corner: Corner, width: float = 1.0) -> Check:
    """A check of that turn."""
    one = cycle(corner, width)
    return declared(Solution(case(), cam(), (one.machine,), Tier.CYCLE, None, (one,)))


PLAIN = Corner("plain")


def test_more_load_raises_the_pressure_as_the_root() -> None:
    """Spring and mass four times as strong: every force four times, the pressure twice."""
    heavy = Corner("heavy", rate=4.0, preload=4.0, mass=4.0)
    force = cycle(heavy).loads.normal_force / cycle(PLAIN).loads.normal_force
    np.testing.assert_allclose(force, 4.0, rtol=1e-9)
    ratio = cycle(heavy).contact.p0 / cycle(PLAIN).contact.p0
    np.testing.assert_allclose(ratio, 2.0, rtol=ELEMENTS)
    assert np.abs(ratio - 2.0).max() > 0.0, "the elements are not Hertz's formula"
    wide = cycle(heavy).contact.half_width / cycle(PLAIN).contact.half_width
    np.testing.assert_allclose(wide, 2.0, rtol=ELEMENTS)
    pressures = [judged(contact_strength.contact_pressure, c).demand for c in (PLAIN, heavy)]
    assert pressures[1] == pytest.approx(2.0 * pressures[0], rel=ELEMENTS)


def test_a_wider_roller_lowers_the_pressure() -> None:
    """As one over the root of the width that both carry."""
    narrow, wide = cycle(PLAIN), cycle(PLAIN, width=2.0)
    np.testing.assert_allclose(wide.contact.p0, narrow.contact.p0 / np.sqrt(2.0), rtol=ELEMENTS)
    assert (
        judged(contact_strength.shakedown, PLAIN, 2.0).demand
        < judged(contact_strength.shakedown, PLAIN).demand
    )


def test_a_larger_preload_raises_friction_loss_and_least_contact_force() -> None:
    corners = [Corner(f"preload {p}", preload=p) for p in (0.8, 1.0, 1.2)]
    losses = [cycle(corner).loads.friction_loss for corner in corners]
    least = [float(cycle(corner).loads.normal_force.min()) for corner in corners]
    assert np.all(np.diff(losses) > 0)
    assert np.all(np.diff(least) > 0)
    pv = [judged(guide_strength.guide_pv_a, corner).demand for corner in corners]
    assert np.all(np.diff(pv) > 0)
    # Over the preload itself the margin falls: the cam's own force grows by less.
    share = [judged(jump_and_jamming.contact_force_margin, corner).demand for corner in corners]
    assert np.all(np.diff(share) < 0)


def test_worse_friction_raises_the_reactions_on_the_rise_and_lowers_them_on_the_return() -> None:
    """Of the guides' elements, wherever the cam pushes sideways at all."""
    smooth, rough = (cycle(Corner(f"friction {f}", friction_a=f, friction_b=f)) for f in (0.5, 2.0))
    slope, moves = smooth.loads.lift_slope, np.abs(smooth.loads.tangential_force) > 1.0
    rise, fall = moves & (slope > 0), moves & (slope < 0)
    assert rise.sum() > 10 and fall.sum() > 10
    for name in ("reaction_a", "reaction_b"):
        more = np.abs(getattr(rough.guides, name)) - np.abs(getattr(smooth.guides, name))
        assert np.all(more[rise] > 0), name
        assert np.all(more[fall] < 0), name
    assert np.all(rough.contact.p0[rise] > smooth.contact.p0[rise])
    assert np.all(rough.contact.p0[fall] < smooth.contact.p0[fall])
