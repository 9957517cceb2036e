"""Sizes of the mechanism of a case, and its envelope over the whole turn."""

from __future__ import annotations

from math import sqrt

from camwright.pipeline.base.envelope import Disc, MechanismSizes, Sleeve
from camwright.pipeline.base.stem_layout import SEAT_MOST, StemLayout
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.case.machine import machine
from camwright.pipeline.cycle.numbers import Numbers


def sizes_of(case: Case, cam_radius: float, lift: float) -> MechanismSizes:
    """Sizes of a case under a cam of a maximum radius and lift, m; of a wound spring alone."""
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
        length = design.free_length - state.spring.preload / state.spring.rate
        layout = StemLayout(
            overhang=overhang,
            spacing=spacing,
            length_a=number("guides.a.length"),
            length_b=number("guides.b.length"),
            lift=lift,
            extent=number("follower.extent"),
            stem_diameter=stem,
            stem_length=numbers.get("follower.stem_length"),
            spring_length=length,
            spring_bore=design.mean_diameter - design.wire_diameter,
        )
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
    """Shaft with its bearings, and gear, along the camshaft."""
    shaft = case.camshaft
    if shaft is None:
        return ()
    diameter = shaft.diameter or 2.0 * case.cam.bore_radius
    width = shaft.bearing_width or shaft.widest or 0.0
    places = [0.0, shaft.bearing_spacing]
    discs = [Disc(place - shaft.cam_position, width, diameter) for place in places]
    if shaft.gear is not None:
        module = 2.0 * shaft.gear_radius / shaft.gear.teeth
        tip = 2.0 * (shaft.gear_radius + module)
        discs.append(Disc(shaft.gear_position - shaft.cam_position, shaft.gear.width, tip))
    return tuple(discs)
