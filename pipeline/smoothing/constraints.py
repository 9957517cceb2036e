"""Demands over limits of a cam, point by point and differentiable, as the checks see them.

Every demand is one that the checks judge too, by the same function, taken with complex numbers,
so that one complex step gives its derivative to round-off. A value of 1 is the limit. Of a demand
that has to be at least its limit the value is the shortfall, which stays smooth where the share
of the limit in use does not; a test holds each against its check.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import curvature_slope, magnitude, speed_and_curvature
from camwright.pipeline.checks import demands
from camwright.pipeline.contact.hertz import peak_pressure_square
from camwright.pipeline.follower.follower_forces import levers
from camwright.pipeline.follower.roller_motion import BALL_LIFE_EXPONENT, rolling_share, wear
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario


class Jet(NamedTuple):
    """Lift and its derivatives by the cam angle, m/rad^k, each (n,)."""

    lift: Array
    slope: Array
    bend: Array
    jerk: Array


def lift_jet(energy: tuple[Array, ...], variables: DesignVariables) -> Jet:
    """Lift at which the spring holds the energy, with three derivatives, from those of E.

    F_s = sqrt(P^2 + 2 k E), s = 2 E / (F_s + P), and E' = F_s s' differentiated.
    """
    level, first, second, third = energy
    force = np.sqrt(variables.preload**2 + 2.0 * variables.rate * level)
    slope = first / force
    bend = (second - variables.rate * slope**2) / force
    return Jet(
        lift=2.0 * level / (force + variables.preload),
        slope=slope,
        bend=bend,
        jerk=(third - 3.0 * variables.rate * slope * bend) / force,
    )


class Motion(NamedTuple):
    """What the geometry makes of a jet: velocity of the roller's centre and its path."""

    along: Array
    across: Array
    speed: Array
    curvature: Array

    @property
    def tangent(self) -> Array:
        """Of the pressure angle."""
        return self.along / self.across


def motion(jet: Jet, variables: DesignVariables, offset: float) -> Motion:
    """Pitch curve of a translating follower at each point; see `PitchCurve`."""
    along = jet.slope - offset
    across = np.sqrt(variables.prime_radius**2 - offset**2) + jet.lift
    return Motion(along, across, *speed_and_curvature(along, across, jet.slope, jet.bend))


class Forces(NamedTuple):
    """Forces of one scenario, N, and what guides A and B bear over the side force.

    lever is that of point supports; push and rub are of the guides as they are.
    """

    spring: Array
    inertia: Array
    axial: Array
    normal: Array
    jam: Array
    lever: tuple[Array, Array]
    push: tuple[Array, Array]
    rub: tuple[Array, Array]


def forces(
    jet: Jet, path: Motion, highest: float, variables: DesignVariables, scenario: Scenario
) -> Forces:
    """Follower forces with implicit guide friction; see `follower_loads`.

    Unlike there they are not held at zero where the contact is lost nor short of a jam, so that
    a design beyond these places still has a way back.
    """
    spring = (
        variables.preload * scenario.preload_factor
        + variables.rate * scenario.rate_factor * jet.lift
    )
    inertia = scenario.mass * scenario.cam_speed**2 * jet.bend
    viscous = scenario.viscous_damping * scenario.cam_speed * jet.slope
    lever = levers(scenario.overhang + highest - jet.lift, scenario.guide_spacing)
    fix = scenario.correction
    rub = (lever[0] * fix.rubbing_a, lever[1] * fix.rubbing_b)
    jam = (scenario.friction_a * rub[0] + scenario.friction_b * rub[1]) * magnitude(path.tangent)
    axial = (spring + inertia + viscous) / (1.0 - np.sign(np.real(jet.slope)) * jam)
    return Forces(
        spring=spring,
        inertia=inertia,
        axial=axial,
        normal=axial * np.sqrt(1.0 + path.tangent**2),
        jam=jam,
        lever=lever,
        push=(lever[0] * fix.guide_a, lever[1] * fix.guide_b),
        rub=rub,
    )


class Mean(NamedTuple):
    """The power of a mean over the turn; terms (n,) at equal angles."""

    terms: Array
    power: float = 1.0

    @property
    def value(self) -> Array:
        """(1,)"""
        return np.array([max(float(np.mean(self.terms)), 0.0) ** self.power])


def shape_utilisations(jet: Jet, variables: DesignVariables, ratings: Ratings) -> dict[str, Array]:
    """Limits on the shape of the cam, whatever it carries; each (n,)."""
    path = motion(jet, variables, ratings.offset)
    bend = ratings.roller_radius * path.curvature
    found: dict[str, Array] = {}
    if ratings.travel is not None:
        found["spring_travel"] = jet.lift / ratings.travel
    if ratings.pressure_angle is not None:
        found["pressure_angle"] = magnitude(np.arctan(path.tangent)) / ratings.pressure_angle
    if ratings.curvature_ratio is not None:
        found["curvature_ratio"] = bend * ratings.curvature_ratio
    if ratings.undercut_factor is not None:
        found["undercut"] = bend / (1.0 - ratings.undercut_factor)
    if ratings.hollow_radius is not None and ratings.hollow_radius > ratings.roller_radius:
        found["concave_radius"] = -path.curvature * (ratings.hollow_radius - ratings.roller_radius)
    if ratings.curvature_rate is not None:
        change = curvature_slope(path.along, path.across, jet.slope, jet.bend, jet.jerk)
        found["curvature_rate"] = magnitude(change / (1.0 - bend) ** 2) / ratings.curvature_rate
    if ratings.cam_radius is not None:
        inset = ratings.roller_radius / path.speed
        reach = demands.contour_radius(path.along, path.across, ratings.offset, inset)
        found["cam_radius"] = reach / ratings.cam_radius
    return found


def load_utilisations(
    jet: Jet, highest: float, variables: DesignVariables, ratings: Ratings, scenario: Scenario
) -> dict[str, Array | Mean]:
    """Limits on what the cam carries in one scenario; each (n,), or a `Mean` of the turn.

    The stress limit is r kappa + N / F_lim <= 1, which is p0 <= p_allowed: the pressure of a
    line contact and the undercut depend on the same factor 1 - r kappa.
    """
    path = motion(jet, variables, ratings.offset)
    load = forces(jet, path, highest, variables, scenario)
    found = _contact_utilisations(jet, load, path, variables, ratings, scenario)
    if ratings.jam_index is not None:
        found["jam_index"] = demands.jam_outward(jet.slope, load.jam) / ratings.jam_index
        if scenario.friction_worst is not None:
            first, second = scenario.friction_worst
            factor = (first * load.lever[0] + second * load.lever[1]) * scenario.correction.jam
            worst = demands.jam_outward(jet.slope, factor * magnitude(path.tangent))
            found["jam_index_friction_max"] = worst / ratings.jam_index
    found |= _roller_utilisations(load, path, ratings, scenario)
    return found | _bush_utilisations(load, path, jet, ratings, scenario)


def _contact_utilisations(
    jet: Jet,
    load: Forces,
    path: Motion,
    variables: DesignVariables,
    ratings: Ratings,
    scenario: Scenario,
) -> dict[str, Array | Mean]:
    found: dict[str, Array | Mean] = {}
    preload = variables.preload * scenario.preload_factor
    if ratings.pressure is not None:
        flat = peak_pressure_square(
            load.normal / ratings.contact_width,
            1.0 / ratings.roller_radius,
            ratings.contact_modulus,
        )
        share = scenario.correction.contact**2 * flat / ratings.pressure**2
        found["contact_pressure"] = ratings.roller_radius * path.curvature + share
    margin = ratings.contact_force_margin
    if margin is not None:
        found["contact_force_margin"] = 1.0 + margin - load.normal / preload
    if margin is not None and ratings.overspeed is not None:
        thrown = scenario.mass * ratings.overspeed**2 * jet.bend
        left = demands.force_left(load.spring, thrown, preload)
        found["contact_at_overspeed"] = 1.0 + margin - left
    if ratings.jump is not None:
        found["jump"] = demands.unloading(load.inertia, load.spring) / ratings.jump
    if ratings.jump_speed is not None:
        thrown = scenario.mass * ratings.jump_speed**2 * jet.bend
        found["jump_speed"] = demands.unloading(thrown, load.spring)
    return found


def _roller_utilisations(
    load: Forces, path: Motion, ratings: Ratings, scenario: Scenario
) -> dict[str, Array | Mean]:
    spin = scenario.cam_speed * rolling_share(path.speed, ratings.roller_radius)
    found: dict[str, Array | Mean] = {}
    if ratings.normal_force is not None:
        found["roller_static"] = load.normal / ratings.normal_force
    if ratings.roller_spin is not None:
        found["roller_speed"] = magnitude(spin) / ratings.roller_spin
    if ratings.life_force_cubed is not None:
        # life = (C / P_m)^3 1e6 turns / mean spin, and P_m^3 mean spin is this mean
        worn = wear(load.normal, spin) / ratings.life_force_cubed
        found["roller_life"] = Mean(worn, 1.0 / BALL_LIFE_EXPONENT)
    return found


def _bush_utilisations(
    load: Forces, path: Motion, jet: Jet, ratings: Ratings, scenario: Scenario
) -> dict[str, Array | Mean]:
    side = load.axial * path.tangent
    velocity = scenario.cam_speed * jet.slope
    found: dict[str, Array | Mean] = {}
    for place, name in enumerate("AB"):
        area = ratings.guide_area[place]
        limit, product = ratings.guide_pressure[place], ratings.guide_pv[place]
        if limit is not None:
            pressure = demands.bush_pressure(side * load.push[place], area)
            found[f"guide_pressure_{name}"] = pressure / limit
        if product is not None:
            spent = demands.bush_pv(side * load.rub[place], velocity, area)
            found[f"guide_pv_{name}"] = Mean(spent / product)
    return found


def delivered_torque(
    jet: Jet, highest: float, variables: DesignVariables, scenario: Scenario, offset: float
) -> Array:
    """Cam torque F_a s' with friction and inertia inside, N m, (n,)."""
    load = forces(jet, motion(jet, variables, offset), highest, variables, scenario)
    return load.axial * jet.slope
