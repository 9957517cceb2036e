"""Dimensions of the mechanism of a case, and its envelope over the turn."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from math import sqrt

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base.counterweight_body import CounterweightBody
from camwright.pipeline.base.envelope import Disc, MechanismSizes, Sleeve
from camwright.pipeline.base.stem_layout import SEAT_MOST, StemLayout
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.case.machine import machine
from camwright.pipeline.cycle.arm_bodies import SwungBody, swung_bodies
from camwright.pipeline.cycle.loaded_cam import wire_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.camshaft_loads import Counterweight


def stem_layout(lift: Value, numbers: Numbers, preload: Value) -> StemLayout:
    """Layout of guides, stem and coil spring at a maximum lift, m, and preload, N; lengths in m.

    Raises
    ------
    InputError
        If the case has no wound spring.
    """
    wire = wire_of(numbers)

    def size(key: str) -> Value:
        value = numbers.get(key)
        return 0.0 if value is None else value

    return StemLayout(
        overhang=size("follower.overhang_at_max_lift"),
        spacing=size("guides.spacing"),
        length_a=size("guides.a.length"),
        length_b=size("guides.b.length"),
        lift=lift,
        extent=size("follower.extent"),
        stem_diameter=size("follower.stem_diameter"),
        stem_length=numbers.get("follower.stem_length"),
        spring_length=wire.free_length - preload / numbers["spring.rate"],
        spring_bore=wire.mean_diameter - wire.wire_diameter,
        outer_a=guide_outer("a", numbers),
        outer_b=guide_outer("b", numbers),
    )


def guide_outer(side: str, numbers: Numbers) -> Value:
    """Outer diameter of the bush of guide a or b, m; NaN where its wall is not known."""
    bore, wall = (numbers.get(f"guides.{side}.{name}") for name in ("diameter", "wall"))
    return np.nan if bore is None or wall is None else bore + 2.0 * wall


def lowest_follower(numbers: Numbers, swung: Mapping[str, SwungBody]) -> Value:
    """Least distance of the follower, with its fork or what swings with an arm, from the axis of
    the cam, m.
    """
    lowest: Value = numbers["cam.prime_radius"] - numbers["follower.round"]
    return reduce(np.minimum, (each.from_disc(0.0, 0.0, 0.0) for each in swung.values()), lowest)


def density_of_counterweight(case: Case) -> float:
    """Density of a counterweight, kg/m3: that of the camshaft, else that of the cam."""
    shaft = None if case.camshaft is None else case.camshaft.material
    return (case.cam.material if shaft is None else shaft).density


def counterweight_body(
    weight: Counterweight, product: Value, numbers: Numbers
) -> CounterweightBody:
    """Body of the counterweight of a case, m, as stated, else one that passes below the follower.

    Parameters
    ----------
    product : float or array   unbalance that it has, kg m

    Raises
    ------
    InputError
        If the case has no camshaft.
    """
    case = numbers.known_case
    if case.camshaft is None:
        raise InputError("camshaft", "missing", "described for its counterweight")
    radius: Value | None = weight.radius
    if radius is None:
        radius = lowest_follower(numbers, swung_bodies(numbers)) - 2.0 * numbers.limit(ASSEMBLY_GAP)
    return CounterweightBody.of(
        weight.position - case.camshaft.cam_position,
        numbers["cam.width"],
        (radius, weight.width),
        numbers["cam.bore_radius"],
        density_of_counterweight(case),
        product,
    )


def sizes_of(case: Case, cam_radius: float, lift: float) -> MechanismSizes:
    """Dimensions of a case's mechanism, m, at a maximum cam radius and lift, m; dimensions that are
    not stated are estimated or zero.
    """
    numbers, state = Numbers({}, case), machine(case, case.load_cases[0])

    def number(key: str, other: float = 0.0) -> float:
        value = numbers.get(key)
        return other if value is None else float(value)

    prime, offset, stem = (
        number(key) for key in ("cam.prime_radius", "cam.offset", "follower.stem_diameter")
    )
    overhang, spacing = number("follower.overhang_at_max_lift"), number("guides.spacing")
    sleeves = []
    for name, middle in (("a", overhang), ("b", overhang + spacing)):
        half = 0.5 * number(f"guides.{name}.length")
        outer = number(f"guides.{name}.diameter", stem) + 2.0 * number(f"guides.{name}.wall")
        sleeves.append(Sleeve(middle - half, middle + half, outer))
    end = number("follower.stem_length", sleeves[1].high + lift)
    design = state.spring.design
    if design is not None:
        layout = stem_layout(lift, numbers, state.spring.preload)
        length = float(layout.spring_length)
        thick = number("spring.seat_thickness", SEAT_MOST * stem)
        stated = numbers.get("spring.seat_height")
        seat = float(layout.seated(thick, case.limits[ASSEMBLY_GAP], stated).height)
        outer = design.mean_diameter + design.wire_diameter
        sleeves.append(Sleeve(seat - lift - thick, seat - lift + length, outer))
    flat = number("follower.half_flat")
    across = max(flat, number("follower.round"))
    deep = float(numbers["follower.half_depth"]) + number("roller.axial_offset")
    lowest = prime if flat else sqrt(prime**2 - offset**2)
    return MechanismSizes(
        cam_radius=cam_radius,
        cam_width=case.cam.width,
        axis=0.0 if flat else offset,
        lowest=lowest,
        lift=lift,
        follower=(across, deep),
        stem_diameter=stem,
        stem_end=end,
        sleeves=tuple(sleeves),
        discs=_discs(case),
    )


def _discs(case: Case) -> tuple[Disc, ...]:
    """Bearings on the shaft, counterweight of stated size and gear: distance from the cam along the
    shaft, width, diameter, m; empty without a camshaft.
    """
    shaft = case.camshaft
    if shaft is None:
        return ()
    diameter = shaft.diameter or 2.0 * case.cam.bore_radius
    width = shaft.bearing_width or shaft.widest or 0.0
    places = [0.0, shaft.bearing_spacing]
    discs = [Disc(position - shaft.cam_position, width, diameter) for position in places]
    weight = shaft.counterweight
    if weight is not None and weight.width is not None and weight.radius is not None:
        from_cam = weight.position - shaft.cam_position
        discs.append(Disc(from_cam, weight.width, 2.0 * weight.radius))
    if shaft.gear is not None:
        module = 2.0 * shaft.gear_radius / shaft.gear.teeth
        tip = 2.0 * (shaft.gear_radius + module)
        discs.append(Disc(shaft.gear_position - shaft.cam_position, shaft.gear.width, tip))
    return tuple(discs)
