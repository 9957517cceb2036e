"""Springs that push and pull beside a cam that pulls: energy over the turn, stress, refusals."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, simpson

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.cam_shape import spring_travel
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.smoothing.required_lift import cam_lift

MOTIONS = Path(__file__).parents[2] / "cases" / "motions"
TURNED = (
    '{head}kind = "torsion"\n[spring.torsion]\nmoment = "-6 N m"\nangular_rate = "20 N m/rad"\n'
    'arm = "40 mm"\narm_angle = "-15 deg"\nsource = "chosen"\n'
)
ABOUT_PIVOT = (
    '{head}kind = "torsion_pivot"\n[spring.torsion_pivot]\nmoment = "-4 N m"\n'
    'angular_rate = "70 N m/rad"\nwire_diameter = "6 mm"\nmean_diameter = "48 mm"\n'
    'tensile_strength = "1500 MPa"\nstress_range = "700 MPa"\nsource = "chosen"\n'
)
LINKED = (
    '{head}[spring.link]\narm_radius = "60 mm"\nfixed_radius = "90 mm"\nfixed_angle = "70 deg"\n'
    'rate = "20 kN/m"\npreload = "-60 N"\nsource = "chosen"\n'
)
COIL = '{head}rate = "20 kN/m"\npreload = "-200 N"\n'


def turned(lift):
    """Energy of the torsion spring of a stem, by the angle of its arm."""
    angle = np.arcsin(np.sin(np.radians(-15.0)) + lift / 0.04) - np.radians(-15.0)
    return -6.0 * angle + 10.0 * angle**2


def about_pivot(lift):
    return -4.0 * lift / 0.09 + 35.0 * (lift / 0.09) ** 2


def linked(lift):
    """Energy of the coil between arm and frame, by the cosine law."""

    def apart(swing):
        return np.sqrt(0.06**2 + 0.09**2 - 2 * 0.06 * 0.09 * np.cos(np.radians(70.0) - swing))

    pressed = apart(0.0) - apart(lift / 0.09)
    return -60.0 * pressed + 10e3 * pressed**2


def text_of(name, spring):
    """A shipped case of a cam that pulls, with a spring."""
    text = (MOTIONS / f"{name}.toml").read_text(encoding="utf-8")
    head = '[spring]\ntravel_max = "40 mm"\nsource = "chosen"\n'
    place = "# --- The mechanism"
    return text.replace(place, spring.replace("{head}", head) + "\n" + place, 1)


@pytest.mark.parametrize(
    ("name", "spring", "energy"),
    [
        ("feeder-groove", TURNED, turned),
        ("tucker-groove", ABOUT_PIVOT, about_pivot),
        ("transfer-conjugate", LINKED, linked),
        ("placer-preloaded", LINKED, linked),
    ],
)
def test_a_spring_that_pushes_and_pulls_returns_its_energy_over_a_turn(name, spring, energy):
    """What it takes of the torque without friction, summed up from the start of the turn, is its
    energy; with friction the cam drives the friction alone. 1e-6 of the swing of the energy, of
    the friction: Simpson's rule on 7200 steps.
    """
    case = parse_case(text_of(name, spring))
    contour, machine = case.contour(given_lift(case)), machines(case)[0]
    theta = np.linspace(0.0, FULL_TURN, 7201)
    free = machine.system.with_friction(0.0, 0.0)
    without = replace(free, spring=replace(COIL_OF_NO_FORCE, travel_max=None))
    loads, bare = (
        follower_loads(contour.pitch, each, machine.cam_speed, theta) for each in (free, without)
    )
    assert loads.spring_force.min() < -20.0 and loads.spring_force.max() > 20.0
    taken = cumulative_simpson(loads.cam_torque - bare.cam_torque, x=theta, initial=0.0)
    held = energy(loads.lift) - energy(loads.lift[0])
    assert taken == pytest.approx(held, abs=1e-6 * np.ptp(held))
    rubbed = follower_loads(contour.pitch, machine.system, machine.cam_speed, theta)
    work, lost = (
        simpson(each, x=theta)
        for each in (rubbed.cam_torque, rubbed.friction_power / machine.cam_speed)
    )
    assert work == pytest.approx(lost, rel=1e-6)


COIL_OF_NO_FORCE = machines(parse_case(text_of("feeder-groove", "")))[0].spring


@pytest.mark.slow
def test_a_spring_that_is_unwound_at_rest_is_judged_there():
    """-4 N m at rest, 5 % more, is more than what 5.5 deg wind it up beyond; the range by the
    swing.
    """
    trial = preview_case(parse_case(text_of("tucker-groove", ABOUT_PIVOT)), corners=False)
    checks = {each.id: each for each in trial.checks}
    curved = (8.0 + 0.07) / (8.0 - 0.75) * 32.0 / (np.pi * 0.006**3)
    wound = 70.0 * np.radians(5.5)
    assert 1.05 * wound - 0.95 * 4.0 < 4.2
    assert checks["torsion_stress"].demand == pytest.approx(curved * 4.2, rel=1e-9)
    assert checks["torsion_fatigue"].demand == pytest.approx(curved * 1.05 * wound, rel=1e-6)
    assert checks["friction_balance"].demand < 1e-6


def drawn(name, spring):
    """Case with a torque in place of its lift."""
    text = text_of(name, spring)
    begin, end = text.index("[lift]"), text.index("[spring]")
    torque = (
        '[torque]\nkind = "harmonics"\nmean = "0 N m"\n'
        'harmonics = [{ order = 1, cosine = "0 N m", sine = "0.03 N m" }]\n'
        '[smoothing]\nkind = "none"\n\n'
    )
    text = text[:begin] + torque + text[end:]
    return text.replace("gear_ratio = 1.0", 'gear_ratio = "2:1"')


def test_a_torsion_spring_about_the_pivot_draws_the_lift_of_a_coil():
    """Its force is linear along the arc: -4 N m and 70 N m/rad over 90 mm."""
    coil = '{head}rate = "8.6419753086420 kN/m"\npreload = "-44.4444444444444 N"\n'
    lifts = [
        cam_lift(case, engine_torques(case)).values
        for spring in (ABOUT_PIVOT, coil)
        for case in (parse_case(drawn("tucker-groove", spring)),)
    ]
    assert np.ptp(lifts[0]) > 1e-3
    assert lifts[0] == pytest.approx(lifts[1], abs=1e-12)


def test_a_spring_of_no_preload_is_none_that_is_absent():
    case = parse_case(text_of("feeder-groove", COIL.replace("-200 N", "0 N")))
    assert not case.spring.absent and COIL_OF_NO_FORCE.absent
    for spring in (case.spring, COIL_OF_NO_FORCE):
        numbers = {"spring.preload": spring.preload, "spring.rate": spring.rate}
        assert spring_travel.measured.applies(None, numbers) == (spring is case.spring)


GAS = (
    '{head}kind = "gas"\n[spring.gas]\npressure = "-5 bar"\narea = "113 mm^2"\n'
    'volume = "12 cm^3"\nsource = "chosen"\n'
)
HOOKED = (
    '{head}kind = "extension"\n[spring.extension]\nforce = "-30 N"\ninitial_tension = "5 N"\n'
    'wire_diameter = "2 mm"\nmean_diameter = "16 mm"\ncoils = 20.0\nshear_modulus = "79.5 GPa"\n'
    'source = "chosen"\n[spring.link]\narm_radius = "60 mm"\nfixed_radius = "90 mm"\n'
    'fixed_angle = "-70 deg"\naction = "pull"\nsource = "chosen"\n'
)
WOUND = (
    '{head}rate = "7 kN/m"\npreload = "-30 N"\n[spring.design]\ncard = "chrome_silicon"\n'
    'wire_diameter = "4.5 mm"\nmean_diameter = "40 mm"\ncoils = 9.0\nfree_length = "146 mm"\n'
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (text_of("feeder-groove", GAS), r"spring\.gas\.pressure = -5 bar, must be > 0 and"),
        (text_of("tucker-groove", HOOKED), r"spring\.extension\.force = -30 N, must be > 0 and"),
        (text_of("feeder-groove", WOUND), r"spring\.preload = -30 N, must be > 0 N, or cam\.clos"),
        (drawn("feeder-groove", TURNED), r"spring\.torsion\.moment = -6 N m, must be > 0 without"),
        (
            text_of("packaging-arm", "").replace(
                '[spring]\nrate = "7 kN/m"\npreload = "300 N"                    # at rest\n',
                '[spring]\nkind = "torsion_pivot"\n',
            ).replace("[spring.design]", ABOUT_PIVOT.split("\n", 1)[1] + "[xx]"),
            r"spring\.torsion_pivot\.moment = -4 N m, must be > 0 N m, or cam\.closure",
        ),
    ],
)  # fmt: skip
def test_a_spring_that_cannot_pull_is_refused(text, message):
    begin, end = (text.find(each) for each in ("[xx]", "[cam]"))
    text = text if begin < 0 else text[:begin] + text[end:]
    with pytest.raises(InputError, match=message):
        parse_case(text)
