"""Limits of the model, for report, sign-off record and documentation."""

from __future__ import annotations

from dataclasses import dataclass

from camwright.pipeline.checks.camshaft_strength import shaft_deflection
from camwright.pipeline.checks.contact_strength import (
    edge_pressure,
    shakedown,
    shakedown_traction,
)
from camwright.pipeline.checks.jump_and_jamming import contact_over_speed
from camwright.pipeline.checks.roller_bearing import roller_radial
from camwright.pipeline.checks.solution_verification import excluded_zone, held_distance
from camwright.pipeline.records.signoff_record import LimitationsRecord


@dataclass(frozen=True)
class ModelLimit:
    """A simplification of the model.

    Parameters
    ----------
    statement : str
    check : str        id of the check that fails where the statement would mislead; "" without one
    singular : bool    whether the stress there has no bound and is excluded
    """

    statement: str
    check: str = ""
    singular: bool = False


MODEL_LIMITS = (
    ModelLimit(
        "Contact and stress are solved in plane strain. The pressure along the line of contact, its"
        " ends, crown and tilt, is a factor on it by half-spaces with mirrored ends, 5 % of the"
        " mean at a corner and 2 % elsewhere from finite elements. Under a forced tilt stem and"
        " camshaft bend; guides, roller bearing and pin do not yield. The moment of the contact"
        " loads pin, fork and seat, that of a forced tilt the guides, without effect on their"
        " friction; of the roller's bearing the angle between the rings is limited in its place.",
        edge_pressure.id,
    ),
    ModelLimit(
        "Both bodies are linear elastic. Above first yield the stresses are those before shakedown,"
        " and no plastic strain is solved.",
        shakedown.id,
    ),
    ModelLimit(
        "The contact is solved without traction. Creep, film thickness, mixed friction and traction"
        " stress are closed-form results for the lubricant, roughness and friction of the case,"
        " without effect on the contact pressure. The friction of a flat face loads the follower.",
        shakedown_traction.id,
    ),
    ModelLimit(
        "The roller is solid on its hub unless the case states outer ring and balls; the ring then"
        " has one thickness, its balls no clearance, and the contact is over a ball. Bearing"
        " ratings are those of the manufacturer; its load is radial, the normal force. Without"
        " load_case.duty the worst load case counts as if it ran for the whole life.",
        roller_radial.id,
    ),
    ModelLimit(
        "The cam speed is constant in each load case. The speed ripple of the shaft acts on the"
        " elastic stem only, where the case states the inertia of the machine."
    ),
    ModelLimit(
        "Camshaft, camshaft bearings and the drive of the cam are rigid, without backlash."
        " The deflection of the camshaft is checked apart; its slope at the cam tilts the line of"
        " contact, and neither changes lift nor loads.",
        shaft_deflection.id,
    ),
    ModelLimit(
        "The loads are those of a rigid follower on a spring without mass. The surge of a coil"
        " spring enters the contact force over the speed range, the stress of the spring and the"
        " life of the roller bearing, with a damping ratio that is hardly known; coils that touch"
        " and the motion after a loss of contact do not. A gas or torsion spring has no surge; the"
        " friction of its seal or pin is left out. One mass on bearing, pin, fork, stem and"
        " camshaft in series, as far as the case describes them, with impacts after loss of"
        " contact, is solved in addition.",
        contact_over_speed.id,
    ),
    ModelLimit(
        "Guide friction is Coulomb friction with constant coefficients, and viscous drag where the"
        " case states it, in equilibrium with guides of finite length and clearance. The couple of"
        " the friction forces about the stem axis is left out. PV value, wear, heat and jam index"
        " of the guides are with the pushes across the plane of the cam, of a forced tilt and of a"
        " second roller, as the root of both squares; the friction in the loads is without them."
    ),
    ModelLimit(
        "An arm is a straight bar of one rectangular section, which its hubs do not stiffen;"
        " without a stated one it is rigid. Without a described pivot it has no weight, friction"
        " and clearance there. The friction of a pivot is Coulomb friction of its whole load at"
        " the diameter of the pin, opposite to the swing, none at rest; the lift that balances a"
        " torque is drawn with the weight of the arm at zero lift, its torque with the true one."
        " The rating life of needles counts the path that the arm swings: a swing below the"
        " pitch of the needles is not judged, nor is the load along the pin. A spring beside the"
        " plane of the cam (`spring.link.plane_offset`) twists neither arm nor pivot."
    ),
    ModelLimit(
        "Pin and bush of a pivot are solved by finite elements where the contact of the cam is; the"
        " housing is rigid, the bush bonded in it and of one material, and the pin held along its"
        " axis: what it bends between its supports is left out. Pressure, PV value, wear, heat"
        " and jam index are by the slices, of the pushes on both sides under the greatest couple;"
        " the friction in the loads is that of the load of the pivot alone. The elastic"
        " follower stands on the slices, whose compliance is a fifth of that of the elements. In a"
        " preview, and for the ratios of the tolerance corners, the pin is rigid in a bush of"
        " independent slices. Over finite elements it has,"
        " under a load in the plane of the couple, 0.99 to 1.08 of the edge pressure on one side of"
        " the bush, 1.37 between both edges and a third of the elastic tilt; under a load beside"
        " that plane 0.78 to 2.0 of the pressure; and 0.97 to 1.23 of the pushes on both sides,"
        " shown for a lined bush of 20 mm."
    ),
    ModelLimit(
        "An extension spring has no surge, and its hooks are bent by closed formulas; buckling,"
        " coil gaps and relaxation are those of compression springs alone."
    ),
    ModelLimit(
        "The output of a rocker follows its second arm without lash; its friction and weight are"
        " those of `rocker.force`. Its mass at the elastic follower of a load case, and in a"
        " flight, is that of the ratio at the lift; over the speed range that at zero lift. The"
        " second arm is judged at its pivot on an arm alone, not on a rocker that a stem moves."
    ),
    ModelLimit(
        "A face does not turn about its stem; its block is held by the stem, or over its whole back"
        " by an arm."
    ),
    ModelLimit(
        "A cam that holds its follower on both sides carries it by one side at a time, unless both"
        " rollers are preloaded. Lift and contours are those without clearance; a landing heats the"
        " mechanism, not the place where it strikes, and a preload has no torque but by friction."
        " Between the rollers of a stem this goes on with the section that it has in its guides."
        " The wear of clearance is that of one side. Without a preload both rollers of a pair of"
        " discs load the life of one bearing."
        " The moment of inertia of two arms is shared as that of two bars of one section with equal"
        " ends; the couples of both contacts on the pin of their pivot add up by their sizes. The"
        " frame of a yoke around its cam is not in the case: neither its strength nor its room is"
        " judged."
    ),
    ModelLimit(
        "Hertz theory assumes half-planes. The finite size of the bodies is part of the difference"
        " between Hertz theory and finite elements."
    ),
    ModelLimit(
        "In the bodies of the contact the keyway corners are meshed sharp. Stress there and at the"
        " edge of the bore has no bound as the mesh is refined and is excluded from all checks; the"
        " root of the keyway is checked apart by its fillet, under a press fit by elements of the"
        " cam on a solid shaft without friction, in plane stress; the keyway of the shaft, a tight"
        " key and friction that relieves it are left out.",
        excluded_zone.id,
        singular=True,
    ),
    ModelLimit(
        "Stress where the bodies are held is excluded; the contact must lie ten half-widths away"
        " from there.",
        held_distance.id,
        singular=True,
    ),
    ModelLimit(
        "The pressure at a corner that ends the line of contact has no bound: a mean over a stated"
        " length, limits.end_mean_length, is signed there.",
        edge_pressure.id,
        singular=True,
    ),
)


def limitations() -> LimitationsRecord:
    """Limits of the model by kind: ``limitations``, and excluded ``singularities``."""
    return {
        "limitations": [each.statement for each in MODEL_LIMITS if not each.singular],
        "singularities": [each.statement for each in MODEL_LIMITS if each.singular],
    }
