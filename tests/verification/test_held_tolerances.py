"""Clearance of two tracks under deviations, by points of the contours; landings and preload there.

The cases are tests/data/conjugate_arm.toml and conjugate_feeder.toml; what moves them is in
geometry/track_deviation.py.
"""

from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from camwright.geometry.arrays import rotation, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.measured_contour import inspected
from camwright.geometry.track_deviation import TrackDeviation
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import Corner, machines
from camwright.pipeline.checks.manufacture import preload_waviness
from camwright.pipeline.checks.tolerance_corners import POSITIONS, corners_of, outcomes
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.crossover_history import impacts
from camwright.pipeline.cycle.solution import solved_turns, turns_of
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.workshop_files import measured_surface, real_cam
from camwright.pipeline.studies.cam_inspection import measured_tracks

ROOT = Path(__file__).parents[2]
GROOVE = ROOT / "cases" / "motions" / "feeder-groove.toml"
DATA = ROOT / "tests" / "data"
FINE = uniform_turn(20_000)
STEP = 2e-5  # m or rad
SHARED = "tracks", "rollers", "apart", "turn", "wear_depth"
"""Deviations of a stem as of an arm."""


@cache
def pair(name):
    """Case, contour and track of the second disc of a file of tests/data."""
    case = read_case(DATA / f"{name}.toml")
    contour = case.contour(given_lift(case))
    return case, contour, case.cam.second.track(contour.pitch)


def axes(theta):
    along = np.array([np.cos(theta), np.sin(theta)])
    return along, np.array([-along[1], along[0]])


def on_arms(name, theta, angle, deviation):
    """Centres of both rollers of the arms at an arm angle."""
    case, contour, _ = pair(name)
    arm, second, (u, v) = contour.pitch.arm, case.cam.second, axes(theta)
    far, other = arm.centre_distance + deviation.centre, second.angle - angle
    other = other + deviation.apart / second.length
    first = u * (far - arm.length * np.cos(angle)) + v * arm.sense * arm.length * np.sin(angle)
    back = u * (far - second.length * np.cos(other))
    return first, back - v * arm.sense * second.length * np.sin(other)


def on_stem(name, theta, height, deviation):
    """Centres of both rollers of the stem at a height of the first."""
    case, contour, _ = pair(name)
    u, v = axes(theta)
    beside = v * contour.pitch.offset
    distance = case.cam.second.distance + deviation.apart
    return u * height + beside, u * (height - distance) + beside


def nearest(point, curve):
    """Distance of a point from a closed curve by a parabola through the three nearest points."""
    square = ((curve - point[:, None]) ** 2).sum(axis=0)
    k = int(square.argmin())
    before, here, after = square[[k - 1, k, (k + 1) % square.size]]
    return np.sqrt(here - (before - after) ** 2 / (8.0 * (before - 2.0 * here + after)))


def gap(name, theta, deviation, made=None):
    """Clearance of the second roller while the first touches, m, but for that of the drawing.

    made : tuple   points (2, n), m, of both discs as made; None: as drawn
    """
    case, contour, track = pair(name)
    place = on_stem if case.follower.arm is None else on_arms
    path = contour.pitch
    at = path.height(theta) if place is on_stem else path.start + path.lift(theta) / path.arm.length
    filled = deviation.rollers + deviation.tracks - deviation.wear_depth
    first, second = made or (contour.points(FINE), track.contour.points(FINE))
    turned = np.array([axes(-deviation.turn)[0], axes(-deviation.turn)[1]]).T @ second

    def inside(where):
        return nearest(place(name, theta, where, deviation)[0], first) - case.roller.radius - filled

    where = brentq(inside, at - 0.01, at + 0.01, xtol=1e-13)
    other = place(name, theta, where, deviation)[1]
    return nearest(other, turned) - case.cam.second.radius - filled


@pytest.mark.parametrize(
    ("name", "kind"),
    [("conjugate_arm", "centre")]
    + [(name, kind) for name in ("conjugate_arm", "conjugate_feeder") for kind in SHARED],
)
def test_clearance_by_points_of_both_discs(name, kind):
    """Of first order: 20 um leave 1e-3 of the change, 20 urad 1e-8 m per rad of the turn."""
    case, contour, _ = pair(name)
    deviation = TrackDeviation(**{kind: STEP})
    for theta in (0.3, 0.9, 2.0):
        change = gap(name, theta, deviation) - gap(name, theta, TrackDeviation())
        opened = deviation.opened(contour.pitch, case.cam.second, np.array([theta]))
        assert opened[0] == pytest.approx(change, rel=1e-3, abs=1e-8 * STEP)


def test_worn_clearance_is_judged_where_it_is_greatest():
    text = (DATA / "conjugate_arm.toml").read_text(encoding="utf-8")
    text = text.replace('spacing = "40 mm"', 'spacing = "40 mm"\nwear_depth = "20 um"')
    case = parse_case(text.replace("[limits]", '[limits]\nworn_clearance = "0.1 mm"'))
    trial = preview_case(case, corners=False)
    check = next(each for each in trial.checks if each.id == "worn_clearance")
    worn = TrackDeviation(wear_depth=20e-6)
    opened = [gap("conjugate_arm", theta, worn) for theta in np.linspace(0.0, 6.2, 32)]
    drawn = [gap("conjugate_arm", theta, TrackDeviation()) for theta in np.linspace(0.0, 6.2, 32)]
    most = case.cam.clearance + np.subtract(opened, drawn).max()
    assert check.demand == pytest.approx(most, rel=2e-3)  # 32 angles, first order
    assert check.status == "pass"


def groove():
    case = read_case(GROOVE)
    return case, case.contour(given_lift(case)), machines(case)[0]


@pytest.mark.parametrize(
    ("corner", "clearance"),
    [({"tracks": -4e-6}, 28e-6), ({"rollers": 3e-6}, 14e-6), ({"wear_depth": 10e-6}, 40e-6)],
)
def test_landings_in_a_wider_groove(corner, clearance):
    """Those of a groove whose drawing has that clearance: the same equations, to round-off."""
    _, contour, machine = groove()
    there = impacts(machine.at_corner(Corner("x", **corner)), contour)
    wide = replace(machine.cam, groove=replace(machine.cam.groove, clearance=clearance))
    drawn = impacts(replace(machine, cam=wide), contour)
    assert len(there) == len(drawn) > 3
    for one, other in zip(there, drawn, strict=True):
        assert one.flight.speed == pytest.approx(other.flight.speed, rel=1e-9)
        assert one.pressure == pytest.approx(other.pressure, rel=1e-9)


def test_a_groove_that_closes_in_is_refused():
    _, contour, machine = groove()
    with pytest.raises(InputError, match=r"cam\.groove\.clearance = -0\.004 mm"):
        impacts(machine.at_corner(Corner("x", rollers=12e-6)), contour)


PRESSED = pytest.mark.parametrize("name", ["preloaded_arm", "preloaded_feeder"])


def with_tolerances(name):
    """Preloaded rollers with tolerances, and a wear of the discs, of 2 um."""
    text = (DATA / f"{name}.toml").read_text(encoding="utf-8")
    stated = ["roller_tolerance", "place_tolerance", "wear_depth"]
    if "[follower.arm]" in text:
        stated.append("centre_tolerance")
    rows = "".join(f'{key} = "2 um"\n' for key in stated) + 'turn_tolerance = "0.01 deg"\n'
    return parse_case(text.replace("[cam.conjugate]\n", f"[cam.conjugate]\n{rows}"))


@PRESSED
def test_preload_opens_and_closes_with_the_corners(name):
    case = with_tolerances(name)
    contour = case.contour(given_lift(case))
    names = {each.name for each in corners_of(case)}
    varied = {f"{each} {end}" for each in ("roller radius", "second track", "phase of the discs",
              "wear of the tracks") for end in ("low", "high")}  # fmt: skip
    assert varied <= names
    assert ("centre distance low" in names) == (case.follower.arm is not None)
    corners = [Corner("nominal"), Corner("more", rollers=2e-6), Corner("less", wear_depth=2e-6)]
    tried = {each.corner.name: each for each in outcomes(case, machines(case), contour, corners)}
    least = {name: each.demands["preload_least"] for name, each in tried.items()}
    most = {name: each.demands["preload_pressure"] for name, each in tried.items()}
    assert least["less"] < least["nominal"] < least["more"]
    assert most["less"] < most["nominal"] < most["more"]
    machine = machines(case)[0]
    theta = uniform_turn(90)
    track = case.cam.second.track(contour.pitch)
    plain, worn = (
        machine.at_corner(each).system.preload.at(track, theta).preload for each in corners[::2]
    )
    opened = TrackDeviation(wear_depth=2e-6).on(track, theta)
    assert worn / plain == pytest.approx(1.0 - opened / case.cam.conjugate.interference, rel=1e-12)
    loads = follower_loads(contour.pitch, machine.system, machine.cam_speed, theta)
    assert (loads.idle_force > 0.0).all()


@PRESSED
def test_a_corner_without_preload_is_refused(name):
    case = with_tolerances(name)
    contour = case.contour(given_lift(case))
    gone = Corner("gone", wear_depth=12e-6)
    (tried,) = outcomes(case, machines(case), contour, [gone])
    assert "cam.conjugate.interference" in tried.refused


def with_ranges(name, seed):
    """Case of a file of tests/data with seeded tolerances of what moves the clearance."""
    text, draw = (DATA / f"{name}.toml").read_text(encoding="utf-8"), np.random.default_rng(seed)
    (table,) = (each for each in ("conjugate", "groove", "yoke") if f"[cam.{each}]" in text)
    stated = ["wear_depth"]
    stated += ["roller_tolerance"] * (table != "yoke") + ["place_tolerance"] * (table != "groove")
    stated += ["centre_tolerance"] * (table == "conjugate" and "[follower.arm]" in text)
    rows = [f'{key} = "{draw.uniform(0.3, 1.5):.3f} um"' for key in stated]
    rows += [f'turn_tolerance = "{draw.uniform(2e-3, 5e-3):.5f} deg"'] * (table == "conjugate")
    header = f"[cam.{table}]\n"
    return parse_case(text.replace(header, "\n".join((header.strip(), *rows, ""))))


def limits_and_combinations(case):
    """Corners of the limits of the fit, and those of every combination of the ends."""
    limits = [each for each in corners_of(case) if each.name.startswith(("minimum", "maximum"))]
    moved = [
        [{field: ends[k] for field, ends in fields.items()} for k in (0, 1)]
        for fields in case.cam.deviations.values()
        if any(low != high for low, high in fields.values())
    ]
    every = [{k: v for each in chosen for k, v in each.items()} for chosen in product(*moved)]
    return limits, [Corner(f"{k}", **values) for k, values in enumerate(every)]


def extremes(values):
    return min(values), max(values)


@pytest.mark.parametrize(
    "name",
    ["conjugate_arm", "conjugate_feeder", "preloaded_arm", "preloaded_feeder", "stepped_groove",
     "yoke_pump"],
)  # fmt: skip
@pytest.mark.parametrize("seed", range(4))
def test_limits_of_the_fit_are_the_extremes_of_all_combinations(name, seed):
    """Least and greatest opening over the turn: linear in the deviations, so that one of the
    combinations of their ends has it.
    """
    case = with_ranges(name, seed)
    path, theta = case.contour(given_lift(case)).pitch, uniform_turn(72)
    limits, every = limits_and_combinations(case)
    assert 2 <= len(limits) < len(every)
    fit = "clearance" if case.cam.clearance > 0.0 else "interference"
    opened = {
        each: each.deviation.opened(path, case.cam.second, theta) for each in (*limits, *every)
    }
    narrow = [each for each in limits if (f"minimum {fit}" in each.name) == (fit == "clearance")]
    wide = [each for each in limits if each not in narrow]
    least = min(opened[each].min() for each in every)
    most = max(opened[each].max() for each in every)
    assert min(opened[each].min() for each in narrow) == pytest.approx(least, rel=1e-12)
    assert max(opened[each].max() for each in wide) == pytest.approx(most, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "checks"),
    [("conjugate_feeder", ("landing_speed", "landing_pressure")),
     ("preloaded_feeder", ("preload_least", "preload_pressure"))],
)  # fmt: skip
def test_checks_at_the_limits_of_the_fit_are_the_extremes_of_all_combinations(name, checks):
    """The same corners among both: to round-off."""
    case = with_ranges(name, 5)
    contour = case.contour(given_lift(case))
    limits, every = limits_and_combinations(case)
    tried = outcomes(case, machines(case), contour, [*limits, *every])
    for check in checks:
        demands = [each.demands[check] for each in tried]
        apart = extremes(demands[: len(limits)]), extremes(demands[len(limits) :])
        assert apart[0] == pytest.approx(apart[1], rel=1e-9)
        assert apart[0][1] > 1.1 * apart[0][0] > 0.0


def test_profile_tolerance_is_judged_against_the_interference_left():
    """Discs with their profiles at the lower limit leave the preload of an interference less by the
    width of the tolerance.
    """
    case = with_tolerances("preloaded_arm")
    contour, (state, *_) = case.contour(given_lift(case)), machines(case)
    corner = Corner("less", wear_depth=2e-6)
    (tried,) = outcomes(case, [state], contour, [corner])
    machine = state.at_corner(corner)
    theta, preload = uniform_turn(POSITIONS), machine.system.preload
    track = case.cam.second.track(contour.pitch)
    narrow = replace(preload, interference=preload.interference - case.cam.profile_tolerance)
    here, there = preload.at(track, theta), narrow.at(track, theta)
    loads = follower_loads(contour.pitch, machine.system, machine.cam_speed, theta)
    pressed = np.minimum(*here.forces(loads.axial_force)) - here.preload + there.preload
    least = (pressed / here.preload).min()
    assert tried.demands["preload_least"] == pytest.approx(least, rel=1e-6)


def test_waves_are_judged_against_the_force_that_the_profile_tolerance_leaves():
    """On worn discs: the inertia of the waves by a tolerance of next to nothing, over the force of
    an interference less by the stated one.
    """
    case = with_tolerances("preloaded_arm")
    contour, states = case.contour(given_lift(case)), machines(case)[:1]
    turns = turns_of((states[0].at_corner(Corner("less", wear_depth=2e-6)),), contour, POSITIONS)
    ((cycle, cam),) = solved_turns(case, contour, turns, Tier.SCREENING).cams.items()
    squeeze, preload = cam.squeeze, cycle.machine.disc_preload
    narrow = replace(preload, interference=preload.interference - case.cam.profile_tolerance)
    lost = squeeze.preload - narrow.at(cycle.loads.second.track(contour.pitch), cycle.theta).preload
    forces, shares = squeeze.forces(cam.axial), (squeeze.share, 1.0 - squeeze.share)
    height = cam.numbers["cam.waviness"]
    still = cam.numbers | {"cam.profile_tolerance": 1e-12, "cam.waviness": height}
    exact = preload_waviness.measure(replace(cam, numbers=still))
    inertia = exact * np.minimum(*(f / b for f, b in zip(forces, shares, strict=True)))
    used = [share * inertia / (force - lost) for force, share in zip(forces, shares, strict=True)]
    judged = preload_waviness.measure(cam)
    assert judged == pytest.approx(np.maximum(*used), rel=1e-6)


def made(contour, theta):
    """Points (2, n), m, of a contour that is 3 um proud, with a form of 2 um, and 50 urad ahead."""
    proud = 3e-6 + 2e-6 * np.cos(3.0 * theta + 0.4)
    return rotation(50e-6) @ (contour.points(theta) + proud * contour.normal(theta))


@pytest.mark.parametrize("name", ["conjugate_arm", "conjugate_feeder"])
@pytest.mark.parametrize("measured", ["first", "second"])
def test_a_measured_disc_opens_or_closes_the_clearance_as_it_is(name, measured):
    """By points of both discs, the other one as drawn; of first order, within 0.5 %."""
    case, contour, track = pair(name)
    drawn = [contour, track.contour]
    surface = drawn[("first", "second").index(measured)]
    fit = inspected(surface, made(surface, uniform_turn(720)))
    deviation = measured_tracks(case, measured, fit, keep_phase=True)
    discs = tuple(made(each, FINE) if each is surface else each.points(FINE) for each in drawn)
    for theta in (0.3, 0.9, 2.0):
        change = gap(name, theta, TrackDeviation(), discs) - gap(name, theta, TrackDeviation())
        opened = deviation.opened(contour.pitch, case.cam.second, np.array([theta]))
        assert opened[0] == pytest.approx(change, rel=5e-3, abs=1e-9)
        there = deviation.beside(TrackDeviation(rollers=2e-6))
        alone = TrackDeviation(rollers=2e-6).opened(
            contour.pitch, case.cam.second, np.array([theta])
        )
        both = there.opened(contour.pitch, case.cam.second, np.array([theta]))
        assert both == pytest.approx(opened + alone, rel=1e-12)


@pytest.mark.parametrize("track", ["inner", "outer"])
def test_a_measured_wall_narrows_the_groove(track):
    """By 5 um: the landings of the drawing with that clearance, the path as measured; 0.2 %."""
    case, contour, machine = groove()
    surface = measured_surface(case, contour, track)
    theta = uniform_turn(720)
    fit = inspected(surface, surface.points(theta) + 5e-6 * surface.normal(theta))
    real = real_cam(case, contour, track, replace(surface, pitch=surface.pitch))
    there = impacts(replace(machine, deviation=measured_tracks(case, track, fit)), real)
    narrow = replace(machine.cam, groove=replace(machine.cam.groove, clearance=15e-6))
    drawn = impacts(replace(machine, cam=narrow), contour)
    assert len(there) == len(drawn) > 3
    for one, other in zip(there, drawn, strict=True):
        assert one.flight.speed == pytest.approx(other.flight.speed, rel=2e-3)


def test_both_faces_of_a_yoke_run_on_the_measured_cam():
    case = read_case(DATA / "yoke_pump.toml")
    contour, theta = case.contour(given_lift(case)), uniform_turn(72)
    proud = 4e-6 * (1.0 + np.cos(2.0 * theta))
    dense = uniform_turn(720)
    points = contour.points(dense) + 4e-6 * (1.0 + np.cos(2.0 * dense)) * contour.normal(dense)
    fit = inspected(contour, points)
    deviation = measured_tracks(case, None, fit)
    opened = deviation.opened(contour.pitch, case.cam.second, theta)
    assert opened == pytest.approx(-proud - np.roll(proud, -36), abs=2e-7)


def test_a_spring_closed_cam_has_no_clearance_to_measure():
    case = read_case(ROOT / "cases" / "gx120.toml")
    assert measured_tracks(case, None, None) == TrackDeviation()
