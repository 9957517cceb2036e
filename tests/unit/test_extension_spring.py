"""Extension spring that pulls an arm: a published example, its case, what is refused."""

from functools import cache

import numpy as np
import pytest
from test_oscillating_case import text

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.spring_kinds import ExtensionSpring
from camwright.pipeline.follower.spring_link import LinkedSpring, SpringLink
from camwright.pipeline.preview import preview_case

INCH, POUND, KPSI = 0.0254, 4.4482216, 6.894757e6
TABLE = """[spring]
kind = "extension"
travel_max = "16 mm"

[spring.extension]
force = "1200 N"
initial_tension = "250 N"
wire_diameter = "8 mm"
mean_diameter = "44 mm"
coils = 4.0
shear_modulus = "79.5 GPa"
hook_radius = "20 mm"
side_radius = "14 mm"
tensile_strength = "1500 MPa"
source = "made up"

[spring.link]
action = "pull"
arm_radius = "85 mm"
fixed_radius = "150 mm"
fixed_angle = "-50 deg"

[cam]"""


@cache
def whole():
    plain = text()
    return plain[: plain.index("[spring]")] + TABLE + plain.split("[cam]", 1)[1]


def hooked(**changes):
    """Spring of the example of Shigley, sec. 10-11, in SI."""
    values = {
        "force": 1.5 * POUND, "initial_tension": 1.19 * POUND, "wire_diameter": 0.035 * INCH,
        "mean_diameter": 0.213 * INCH, "coils": 12.17, "shear_modulus": 11.6e3 * KPSI,
        "hook_radius": 0.106 * INCH, "side_radius": 0.089 * INCH, "tensile_strength": 264.7 * KPSI,
    }  # fmt: skip
    return ExtensionSpring(**values | changes)


def test_stresses_of_a_published_spring():
    """Shigley's Mechanical Engineering Design, example 10-6, printed to three or four digits.

    There the body has Bergstraesser's factor (4C + 2)/(4C - 3), 1.234; here Wahl's.
    """
    spring, force = hooked(), 5.25 * POUND
    index = 0.213 / 0.035
    wahl = (4.0 * index - 1.0) / (4.0 * index - 4.0) + 0.615 / index
    assert spring.bent == pytest.approx(1.14, abs=0.005)
    assert spring.twisted == pytest.approx(1.18, abs=0.005)
    assert spring.hook_bending(force) / KPSI == pytest.approx(156.9, rel=2e-3)
    assert spring.hook_torsion(force) / KPSI == pytest.approx(78.4, rel=5e-3)
    assert spring.body_stress(force) / KPSI == pytest.approx(82.0 * wahl / 1.234, rel=5e-3)
    assert spring.rate / POUND * INCH == pytest.approx(17.91, rel=0.06)  # with fewer coils there
    most = 231.0 / np.exp(0.105 * index) + 6.9 * (4.0 - (index - 3.0) / 6.5)
    assert most * 1e6 / KPSI == pytest.approx(21.2, rel=5e-3)
    stress = 8.0 * 0.213 * spring.most_initial_tension / POUND / (np.pi * 0.035**3) / 1e3
    assert stress == pytest.approx(21.2, rel=5e-3)


def test_fatigue_by_hand():
    """Goodman of coils with Zimmerli's 241 and 379 MPa, and of the hook over 0.577, or through 45 %
    of its strength from zero, the lower.
    """
    spring, low, high = hooked(), np.array([7.0]), np.array([22.0])
    strength, shear = 264.7 * KPSI, 0.67 * 264.7 * KPSI
    endurance = 241e6 / (1.0 - 379e6 / shear)
    index, per = 0.213 / 0.035, 8.0 * 0.213 / (np.pi * 0.035**3) / INCH**2
    wahl = (4.0 * index - 1.0) / (4.0 * index - 4.0) + 0.615 / index
    coils = per * wahl * (7.5 / endurance + 14.5 / shear)
    C = 0.212 / 0.035
    bent = (4.0 * C**2 - C - 1.0) / (4.0 * C * (C - 1.0))
    bend = bent * 16.0 * 0.213 / (np.pi * 0.035**3) + 4.0 / (np.pi * 0.035**2)
    pulsating = 0.225 * strength / 0.775
    assert pulsating < endurance / 0.577
    hook = bend / INCH**2 * (7.5 / pulsating + 14.5 / strength)
    from_zero = hooked(tensile_strength=strength).fatigue_use(0.0 * high, high)[0]
    assert from_zero == pytest.approx(22.0 * bend / INCH**2 / (0.45 * strength), rel=1e-9)
    assert spring.fatigue_use(low, high)[0] == pytest.approx(max(coils, hook), rel=1e-9)
    sharp = hooked(side_radius=0.04 * INCH)  # its bend has the greater factor, 2.45
    assert sharp.twisted > wahl
    assert sharp.fatigue_use(low, high)[0] == pytest.approx(coils * sharp.twisted / wahl, rel=1e-9)
    assert np.isnan(hooked(side_radius=None).fatigue_use(low, high)).all()


def test_a_case_pulls_its_arm_by_the_own_force_of_the_spring():
    case = parse_case(whole())
    assert parse_case(case.to_toml()).spring == case.spring
    rate = 79.5e9 * 0.008**4 / (8.0 * 0.044**3 * 4.0)
    assert case.spring.own.rate == pytest.approx(rate, rel=1e-12)

    def length(s):
        end = 0.085 * np.exp(1j * s / 0.1)
        return np.abs(end - 0.150 * np.exp(-1j * np.radians(50.0)))

    trial = preview_case(case, corners=False)
    checks = {each.id: each for each in trial.checks}
    top = trial.lift.highest.value
    travel = float(length(top) - length(0.0))
    assert case.spring.energy(top) == pytest.approx(1200.0 * travel + 0.5 * rate * travel**2)
    force = 1.05 * (1200.0 + rate * travel)
    wahl = (4 * 5.5 - 1) / (4 * 5.5 - 4) + 0.615 / 5.5
    per = 8.0 * 0.044 * force / (np.pi * 0.008**3)
    bent, twisted = (4 * 25.0 - 6.0) / (4 * 5.0 * 4.0), (4 * 3.5 - 1.0) / (4 * 3.5 - 4.0)
    hook = 2.0 * per * bent + 4.0 * force / (np.pi * 0.008**2)
    demands = {
        "extension_stress": per * wahl, "extension_hook_bending": hook,
        "extension_hook_torsion": per * twisted, "extension_initial_tension": 250.0,
    }  # fmt: skip
    for name, demand in demands.items():
        assert checks[name].demand == pytest.approx(demand, rel=1e-9)
    low = 1.05 * 1200.0
    shear = 0.67 * 1500e6
    endurance = 241e6 / (1.0 - 379e6 / shear)
    half, mean = 0.5 * (force - low) / force, 0.5 * (force + low) / force
    coils = per * max(wahl, twisted) * (half / endurance + mean / shear)
    hooks = hook * (0.775 * half / 0.225 + mean) / 1500e6
    assert checks["extension_fatigue"].demand == pytest.approx(1.0 / max(coils, hooks), rel=1e-9)
    shares = (0.45, 0.75, 0.40)
    for name, share in zip(demands, shares, strict=False):
        assert checks[name].limit == pytest.approx(share * 1500e6)
    stainless = whole().replace('source = "made up"\n\n[spring.link]', 'wire_kind = "austenitic"\n'
                                'source = "made up"\n\n[spring.link]')  # fmt: skip
    of = {each.id: each for each in preview_case(parse_case(stainless), corners=False).checks}
    for name, share in zip(demands, (0.35, 0.55, 0.30), strict=False):
        assert of[name].limit == pytest.approx(share * 1500e6)
    assert checks["extension_initial_tension"].status == "pass"
    assert checks["data_extension_spring"].status == "pass"
    assert "spring_stress" not in checks and "data_spring" not in checks


def test_the_initial_tension_is_below_the_preload_and_what_coiling_gives():
    case = parse_case(whole().replace('"250 N"', '"1150 N"'))
    (check,) = (each for each in preview_case(case, corners=False).checks
                if each.id == "extension_initial_tension")  # fmt: skip
    most = 231e6 / np.exp(0.105 * 5.5) + 6.9e6 * (4.0 - 2.5 / 6.5)
    most *= np.pi * 0.008**3 / (8.0 * 0.044)
    assert check.status == "fail"
    assert check.limit == pytest.approx(min(0.95 * 1200.0, most), rel=1e-12)


@pytest.mark.parametrize(("old", "new", "message"), [
    ('action = "pull"', 'action = "push"', "spring.link.fixed_angle = -50 deg"),
    ('fixed_angle = "-50 deg"', 'fixed_angle = "50 deg"', "spring.link.fixed_angle = 50 deg"),
    ('mean_diameter = "44 mm"', 'mean_diameter = "18 mm"', "spring.extension.mean_diameter"),
    ('side_radius = "14 mm"', 'side_radius = "3 mm"', "spring.extension.side_radius = 3 mm"),
    ('initial_tension = "250 N"\n', "", "spring.extension.initial_tension = missing"),
    ('force = "1200 N"', 'force = "0 N"', "spring.extension.force = 0 N"),
    ('kind = "extension"\n', "", 'spring.extension = a table, must be left out, or spring.kind = '),
])  # fmt: skip
def test_refused_extension_springs(old, new, message):
    assert old in whole()
    with pytest.raises(InputError) as error:
        parse_case(whole().replace(old, new, 1))
    assert str(error.value).startswith(message)


def test_an_extension_spring_does_not_push():
    link = SpringLink(arm_radius=0.085, fixed_radius=0.15, fixed_angle=0.9, length=0.1)
    with pytest.raises(InputError, match=r'link\.action = push, must be "pull" with'):
        LinkedSpring(link=link, spring=hooked())


def test_it_is_that_of_an_arm():
    spring = hooked()
    own = Spring(kind="extension", extension=spring, rate=spring.rate, preload=spring.preload)
    with pytest.raises(InputError, match=r"spring\.extension = a table, must be left out unless"):
        own.on_arm(None)
    assert own.on_arm(0.1) is own
