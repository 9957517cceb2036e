"""Check of the assembly of a second track: gaps of disc, roller, arm and faces over the turn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from camwright.geometry.arrays import Array, Value, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.geometry.second_track import SecondTrack
from camwright.geometry.swung_bar import SwungBar
from camwright.pipeline.base import levers
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.checks.arm_assembly import (
    PartGap,
    PartOnShaft,
    about_camshaft,
    numbers_of,
    pair_of,
)
from camwright.pipeline.checks.assembly import aside, one, room_beside_shaft, shaft_radius
from camwright.pipeline.checks.check import NONE, STATED, Demand, check
from camwright.pipeline.contact.cam_body import CamConjugate, CamGroove
from camwright.pipeline.cycle.arm_bodies import (
    ARM_DEPTH,
    ARM_WIDTH,
    HUB,
    SPRING,
    SwungBody,
    swung_bodies,
    with_swing,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution

_TURN_SAMPLES = 720
"""Cam angles, and points of a contour: a least distance between them errs by 1 um at 0.1 m."""
_CHEEK = "roller.fork.cheek_height"


def beside_contour(centre: Array, other: Array) -> float:
    """Least distance of a follower on a stem from a contour over the turn, m: of the centre of its
    roller, and of its axis outwards of it.

    Parameters
    ----------
    centre : array (2, n)   path of the roller centre at equal own cam angles, m
    other : array (2, n)    contour of the other disc, m
    """
    theta = uniform_turn(centre.shape[1])[:, None]
    x, y = other[:, None, :] - centre[:, :, None]
    along, across = x * np.cos(theta) + y * np.sin(theta), y * np.cos(theta) - x * np.sin(theta)
    return float(np.hypot(np.minimum(along, 0.0), across).min())


def _second_arm(
    solution: Solution, track: SecondTrack, pair: CamConjugate, bodies: Mapping[str, SwungBody]
) -> dict[str, SwungBody]:
    """Second arm, its hub, fork and roller, like those of the first on an arm of its length."""
    arm, numbers = solution.case.follower.arm, solution.numbers
    if arm is None or pair.arm_length is None:
        return {}
    linkage, longer = pair.roller.linkage(arm.linkage), pair.arm_length - arm.length
    reached = np.hypot(*track.contour.pitch.points(uniform_turn(_TURN_SAMPLES)))
    angles = np.asarray(linkage.angle(reached))

    def second(name: str, body: SwungBody) -> Iterator[SwungBody]:
        if isinstance(body.bar, SwungBar):
            inner, outer = (
                np.where(np.asarray(end) > 0.0, end + longer, 0.0)
                for end in (body.bar.inner, body.bar.outer)
            )
            bar = SwungBar(linkage, angles.min(), angles.max(), inner, outer)
            rolls = name == solution.case.facing.word
            half = _about_second(pair, numbers) if rolls else body.half
            yield SwungBody(bar, half, body.beside)

    return {name: each for name, body in bodies.items() for each in second(name, body)}


def _about_second(pair: CamConjugate, numbers: Numbers) -> Value:
    """Radius of the second roller or its cheeks about the pin, the greater, m."""
    cheeks = numbers.get(_CHEEK)
    return np.maximum(pair.roller_radius, 0.0 if cheeks is None else 0.5 * cheeks)


def _swung(
    bodies: Mapping[str, SwungBody], contour: Contour, lift: Lift, ends: tuple[Value, Value]
) -> Iterator[tuple[str, PartGap]]:
    """Gaps of the bodies of one arm to the disc of the other over the turn, with their names.

    Parameters
    ----------
    lift : Lift   of the arm
    ends : pair   middle of the disc from that of the arm's own, and half of its width, m
    """
    for name, body in bodies.items():
        away = body.bar.from_contour(contour, lift).value - body.half
        yield name, PartGap(away, (body.half, 0.0), body.beyond(ends))


def _between_arms(
    bodies: Mapping[str, SwungBody], others: Mapping[str, SwungBody], pair: CamConjugate
) -> Iterator[tuple[str, PartGap]]:
    """Gaps of the bodies of one arm to those of the other, which swings with it, with their names;
    none of hubs and arms, which join at the pivot.
    """
    for name, body in bodies.items():
        for which, other in others.items():
            first, second = body.bar, other.bar
            if not (isinstance(first, SwungBar) and isinstance(second, SwungBar)):
                continue
            if np.all(np.maximum(first.inner, second.inner) > 0.0):
                apart = first.from_bar(second, pair.arm_angle or 0.0)
                axial = pair.spacing - sum(body.beside) - sum(other.beside)
                gap = PartGap(apart - body.half - other.half, (body.half, other.half), axial)
                yield f"{name} to second {which}", gap


def _parts(tip: Value, numbers: Numbers) -> dict[str, PartOnShaft]:
    """Parts about the camshaft, and the pinion, from the middle of the second disc."""
    spacing = numbers["cam.conjugate.spacing"]
    parts = {
        name: disc._replace(ends=(disc.ends[0] - spacing, disc.ends[1]))
        for name, disc in about_camshaft(tip, numbers).items()
        if disc.ends is not None and name != "cam"
    }
    return parts | {"camshaft": PartOnShaft((0.0, 0.0), shaft_radius(numbers, spacing), None)}


def _of_pair(
    solution: Solution, pair: CamConjugate, track: SecondTrack
) -> Iterator[tuple[str, PartGap]]:
    """Gaps of a second disc and its follower, and of either follower to the disc of the other."""
    numbers, word = solution.numbers | with_swing(solution.cams.values()), solution.case.facing.word
    first, second = solution.contour, track.contour
    half, width = numbers["follower.half_depth"] + aside(numbers), 0.5 * numbers["cam.width"]
    parts = _parts(first.radius_max().value, numbers)
    for name, disc in parts.items():
        if disc.ends is not None and name != "pinion":
            away = np.abs(disc.ends[0]) - disc.ends[1]
            yield f"second disc to {name}", PartGap(-np.inf, (0.0, 0.0), away - width)
            yield f"second {word} to {name}", PartGap(-np.inf, (0.0, 0.0), away - half)
    room = room_beside_shaft(solution.machine)
    if room is not None:
        tip = second.radius_max().value
        centre = room + numbers.limit(ASSEMBLY_GAP)
        yield "second disc to machine shaft", PartGap(centre - tip, (0.0, tip), -np.inf)
    bodies = {name: body for name, body in swung_bodies(numbers).items() if name != SPRING}
    if not bodies:
        yield from _on_stem(solution, pair, track, parts["camshaft"])
        return
    others, ends = _second_arm(solution, track, pair, bodies), (pair.spacing, width)
    for name, gap in _swung(bodies, second, first.lift, ends):
        yield f"{name} to second disc", gap
    for name, gap in _swung(others, first, second.lift, ends):
        yield f"second {name} to first disc", gap
    yield from _between_arms(bodies, others, pair)
    for name, body in others.items():
        for part, disc in parts.items():
            if name != word or part == "camshaft":
                yield f"second {name} to {part}", pair_of(body, disc)


def _on_stem(
    solution: Solution, pair: CamConjugate, track: SecondTrack, shaft: PartOnShaft
) -> Iterator[tuple[str, PartGap]]:
    """Gaps of two rollers on a stem, with forks on both sides, to the disc of the other, and of the
    second to the camshaft.
    """
    numbers, word, theta = solution.numbers, solution.case.facing.word, uniform_turn(_TURN_SAMPLES)
    contours = solution.contour, track.contour
    radii = float(numbers["follower.round"]), _about_second(pair, numbers)
    pin, half = solution.case.roller.pin, numbers["follower.half_depth"]
    if pin is not None and pin.overhung:  # its cheek is on the side away from the other disc
        half = 0.5 * numbers["roller.width"]
    axial = pair.spacing - half - aside(numbers) - 0.5 * numbers["cam.width"]
    names = f"{word} to second disc", f"second {word} to first disc"
    for name, disc, other, radius in zip(names, contours, contours[::-1], radii, strict=True):
        away = beside_contour(disc.pitch.points(theta), other.points(theta))
        yield name, PartGap(away - radius, (radius, 0.0), axial)
    least = float(np.hypot(*track.contour.pitch.points(theta)).min())
    sizes = radii[1], shaft.radius
    yield f"second {word} to camshaft", PartGap(least - sum(sizes), sizes, -np.inf)


def _in_yoke(solution: Solution) -> Iterator[tuple[str, PartGap]]:
    """Gap of the faces of a yoke, which both come down to the base circle, to the camshaft."""
    radius = shaft_radius(solution.numbers)
    least = solution.numbers["cam.prime_radius"]
    yield "face to camshaft", PartGap(least - radius, (0.0, radius), -np.inf)


def _over_groove(solution: Solution, groove: CamGroove) -> Iterator[tuple[str, PartGap]]:
    """Gaps of arm and hub of a roller in a groove to the disc around it, whose face is between
    them; of a stem none, which `fork_gap` judges.
    """
    numbers, case = solution.numbers | with_swing(solution.cams.values()), solution.case
    roller, bodies = case.roller, swung_bodies(numbers)
    face, radius = groove.middle(roller.radius, roller.width, groove.second), groove.outer_radius
    for name in ("arm", HUB):
        if name in bodies:
            body = bodies[name]
            away = body.beside[0] - body.beside[1] - face
            plane = body.from_disc(0.0, 0.0, radius)
            yield f"{name} to disc", PartGap(plane, (body.half, radius), away)


def gaps_of(solution: Solution) -> dict[str, PartGap]:
    """Gaps of a second disc with its follower, of the faces of a yoke, or of an arm to the disc of
    its groove, by the names of both parts; {} of one track and of a stem over a groove.
    """
    cam = solution.machine.cam
    if cam.groove is not None:
        return dict(_over_groove(solution, cam.groove))
    if cam.second is None:
        return {}
    if cam.conjugate is None:
        return dict(_in_yoke(solution))
    return dict(_of_pair(solution, cam.conjugate, cam.second.track(solution.contour.pitch)))


@check(
    ASSEMBLY_GAP,
    title="Gap between the second track, its follower and the parts beside them",
    formula="max(d - h - r, a) >= g; of the nearest pair: d: least distance over the turn of roller"
    " centre or centre line of an arm from the axis of the camshaft or the contour of the other"
    " disc, or of a disc from the machine shaft, or of the centre lines of both arms, h: radius of"
    " roller or cheeks, half of the depth of the arm or of its hub, r: radius of shaft or disc,"
    " none or as h of the other arm, a: gap of the two along the camshaft, over a groove from"
    " the face of its disc, that in the plane where they have none, g: limits.assembly_gap",
    symbols=dict.fromkeys("dhra", f"{STATED} [mm]"),
    reason="A second disc, roller, arm or face within camshaft, bearing, gear or the other disc"
    " cannot be assembled.",
    method="second disc and follower beside bearings and gear along the camshaft; rollers, with"
    " their forks, and arms from the other disc over the turn, from 720 angles and points, or along"
    " the camshaft; rollers and forks from the other arm; second roller and faces from the shaft;"
    " arm and hub from the disc of a groove",
    lift_can_help=True,
    moved_by_tolerance=False,
    closed_by="form",
    load_cases=NONE,
    levers=(
        levers.one("cam.conjugate.spacing"),
        levers.one("follower.arm.plane_offset"),
        levers.PRIME,
    ),
    page="Camshaft",
)
def second_track_gap(solution: Solution) -> Demand | None:
    """Least gap, m, of a second disc with its follower, of the faces of a yoke, or of an arm to the
    disc of its groove; None of a stem over a groove.
    """
    limit, pairs = solution.machine.limits[ASSEMBLY_GAP], gaps_of(solution)
    if not pairs:
        return None
    gaps = {name: one(pair.gap(limit)) for name, pair in pairs.items()}
    if np.isnan(list(gaps.values())).any():
        shaft, lacks = solution.machine.camshaft, []
        if shaft is not None and shaft.bearing_width is None:
            lacks.append("camshaft.bearing_width")
        if solution.numbers.get(ARM_DEPTH) is not None and solution.numbers.get(ARM_WIDTH) is None:
            lacks.append(ARM_WIDTH)
        return Demand(None, limit, missing=tuple(lacks))
    name = min(gaps, key=gaps.__getitem__)
    frame = "" if solution.machine.cam.yoke is None else "; the frame is not in the case"
    return Demand(gaps[name], limit, note=f"{name}{frame}", stated=_stated(pairs[name]))


def _stated(pair: PartGap) -> dict[str, float]:
    """Numbers of the formula by symbol; one along the camshaft alone is also that in the plane."""
    if np.isfinite(one(pair.plane)):
        return numbers_of(pair)
    along = one(pair.axial)
    return {"d": along, "h": 0.0, "r": 0.0, "a": along}
