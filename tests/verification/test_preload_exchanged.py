"""Preloaded discs named the other way round: the second disc, arm and roller as the first.

One machine, described twice: its checks, forces and certified contacts are the same.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks.demands import normal_force
from camwright.pipeline.checks.extremes import cam_of
from camwright.pipeline.checks.roller_bearing import roller_modified_life
from camwright.pipeline.cycle.certificate_angles import length_loads
from camwright.pipeline.follower import disc_preload
from camwright.pipeline.follower.bearing_life import rated_viscosity
from camwright.pipeline.follower.disc_preload import DiscPreload
from camwright.pipeline.preview import preview_case

FILE = Path(__file__).parents[1] / "data" / "preloaded_arm.toml"
DISTANCE, FIRST, SECOND, BETWEEN, STROKE, PRIME = 100.0, 90.0, 85.0, 79.0, 5.5, 64.0  # mm, deg
OWN = {
    # places of the first disc and its arm, and masses of their parts
    *("arm_gap", "arm_cam_gap", "fork_shaft_gap", "gear_gap", "second_track_gap"),
    "follower_mass",
}
"""Checks of what the case states of the first disc alone."""


def changed(text, pairs):
    for old, new in pairs.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def named():
    """Rollers that differ, both arms as far from the middle of the pivot; without a weight beside
    the pivot, which the first arm places.
    """
    return changed(FILE.read_text(encoding="utf-8"), {
        'mass_distance = "60 mm"': 'mass_distance = "1e-9 mm"',
        '[roller]\nradius = "23.5 mm"': '[roller]\ninertia = "200 kg mm^2"\nradius = "26 mm"',
        'prime_radius = "62 mm"': f'prime_radius = "{PRIME} mm"',
        'roller_radius = "22 mm"': 'roller_radius = "25 mm"',
        'swing = "with"': 'swing = "with"\nplane_offset = "20 mm"',
        "positions = 720": "positions = 240",
    })  # fmt: skip


def exchanged():
    """Second arm and disc as the first: it falls where the other rises, a quarter turn later."""
    text = named()
    begin, end = text.index("[[lift.segment]]"), text.index("[mechanism]")
    rest = '[[lift.segment]]\nlaw = "dwell"\nangle = "20 deg"\n'
    moves = ("cycloidal", STROKE), ("modified_sine", -STROKE)
    lift = "".join(
        f'[[lift.segment]]\nlaw = "{law}"\nangle = "70 deg"\nstroke = "{stroke} deg"\n{rest}'
        for law, stroke in moves * 2
    )
    first = np.arccos((DISTANCE**2 + FIRST**2 - PRIME**2) / (2.0 * DISTANCE * FIRST))
    start = np.radians(BETWEEN - STROKE) - first
    prime = np.sqrt(DISTANCE**2 + SECOND**2 - 2.0 * DISTANCE * SECOND * np.cos(start))
    return changed(text[:begin] + lift + text[end:], {
        f'prime_radius = "{PRIME} mm"': f'prime_radius = "{float(prime)!r} mm"',
        'roller_radius = "25 mm"': 'roller_radius = "26 mm"',
        'mm^2"\nradius = "26 mm"': 'mm^2"\nradius = "25 mm"',
        'arm_length = "85 mm"': 'arm_length = "90 mm"',
        'length = "90 mm"\nswing = "with"': 'length = "85 mm"\nswing = "against"',
        'mass = "1.2 kg"': f'mass = "{1.2 * (FIRST / SECOND) ** 2!r} kg"',
        'gear_position = "-25 mm"': 'gear_position = "135 mm"',
        'root_radius = "0.25 mm" }': 'root_radius = "0.25 mm", angle = "90 deg" }',
    })  # fmt: skip


def square_to_the_first(self, track, theta):
    """Preload of an interference square to the first disc."""
    along = self.interference / np.cos(track.first.pressure_angle(theta))
    touch, first = track.touch(theta), track.first.slide(theta)
    preload = disc_preload.squeezed(
        self.interference, self.compliances, first, touch, track.leverage
    )
    square = self.interference / (touch.slide.lever * np.cos(touch.pressure_angle))
    return preload._replace(preload=preload.preload * along / square)


@cache
def trials():
    """Both descriptions, with the interference of the same place."""
    first = preview_case(parse_case(named()), corners=False)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(DiscPreload, "at", square_to_the_first)
        return first, preview_case(parse_case(exchanged()), corners=False)


def test_the_order_of_the_discs_changes_no_check():
    """2e-5: the friction of the pivot settles within 1e-5 of the force."""
    one, other = ({each.id: each for each in trial.checks} for trial in trials())
    assert one.keys() == other.keys()
    judged = [name for name, each in one.items() if each.demand is not None]
    assert len(judged) > 60
    for name in set(judged) - OWN:
        assert other[name].demand == pytest.approx(one[name].demand, rel=2e-5, abs=1e-12), name
        assert other[name].status == one[name].status, name
    gaps = [each[name].demand for each in (one, other) for name in ("arm_gap", "second_track_gap")]
    assert gaps[:2] == pytest.approx(gaps[:1:-1], rel=1e-6)


def test_the_contacts_of_either_disc_are_certified_by_their_own():
    """The greatest signed pressure of each disc, the harder pressed first, under its own force and
    between its own bodies: depth of the disc to its bore and keyway, of the roller to its hub.
    """
    loads = [length_loads(trial.solution.cycles, ()) for trial in trials()]
    assert [len(each) for each in loads] == [6, 6]
    assert [[load.second for load in each] for each in loads] == [
        [True] * 3 + [False] * 3, [False] * 3 + [True] * 3,
    ]  # fmt: skip
    for load, same in zip(*loads, strict=True):
        assert load.load_case == same.load_case
        assert load.force == pytest.approx(same.force, rel=1e-6)
        assert load.factor == pytest.approx(same.factor, rel=1e-5)
        depths = [[body.depth for body in each.pair.bodies] for each in (load, same)]
        assert depths[0] == pytest.approx(depths[1], rel=1e-6)
        assert depths[0][1] == pytest.approx(1e-3 * ((25.0 if load.second else 26.0) - 11.5))


def test_the_parts_of_either_disc_bear_its_own_normal_force():
    """By its leverage the disc with less force along the travel can press its roller harder."""
    solution = trials()[0].solution
    for cycle in solution.cycles:
        sizes = cycle.loads.normal_force, cycle.loads.idle_force
        assert (sizes[1] > sizes[0]).any()
        judged = normal_force(cam_of(solution, cycle))
        assert judged == pytest.approx(np.maximum(*sizes), rel=1e-12)


def test_an_oil_too_thin_for_the_slower_roller_leaves_no_modified_life():
    """Whichever of both it is: by ISO 281 there is none below a viscosity ratio of 0.1."""
    for trial in trials():
        cam = next(iter(trial.solution.cams.values()))
        means, key = [float(np.ravel(each.mean)[0]) for each in cam.rollers], "roller.bearing."
        assert max(means) > 1.02 * min(means)
        circle = float(cam.numbers[f"{key}pitch_diameter"])
        rated = rated_viscosity(np.sqrt(np.prod(means)) * 30.0 / np.pi, circle)
        thin = cam.numbers | {f"{key}viscosity": 0.1 * rated, f"{key}cleanliness_load": 100.0}
        assert np.isnan(roller_modified_life.measure(replace(cam, numbers=thin))).all()


def test_the_stress_field_shows_the_disc_that_is_pressed_harder():
    """Contact and bodies by angle: relative radius of the track with the greater pressure."""
    cycle = trials()[0].solution.cycles[0]
    shown, (here, there) = cycle.pressed_harder, (cycle.contact, cycle.idle)
    other = there.p0_hertz > here.p0_hertz
    assert other.any() and not other.all()
    assert shown.contact.p0_hertz == pytest.approx(np.maximum(here.p0_hertz, there.p0_hertz))
    radius = np.where(other, there.relative_radius, here.relative_radius)
    assert shown.pair.relative_radius(cycle.theta) == pytest.approx(radius, rel=1e-9)
    assert (shown.pair.wall(cycle.theta) != cycle.loads.wall).sum() == other.sum()


def test_the_creep_of_either_roller_is_of_its_own_contact():
    """Loss of a turn; the moment of inertia of both rollers is the same one."""
    losses = [[each.rolling.contact.loss for each in one.solution.cycles] for one in trials()]
    assert losses[0] == pytest.approx(losses[1], rel=1e-9)
    assert min(losses[0][0], losses[0][2]) > 1e-5
