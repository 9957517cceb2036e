"""Plausibility of a case: values that are allowed and cannot be meant, each with one warning."""

import json
from pathlib import Path

import numpy as np
import pytest
from small_machine import small_machine

from camwright.pipeline.base.progress import Progress
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.plausibility import PLAUSIBILITY, implausible
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.check_report import consistency_line
from camwright.pipeline.run import run_case

ROOT = Path(__file__).parents[2]
GX120 = (ROOT / "cases" / "gx120.toml").read_text(encoding="utf-8")
REDESIGN = (ROOT / "cases" / "gx120-redesign.toml").read_text(encoding="utf-8")


def changed(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


def warnings(case: Case) -> list[str]:
    return [one.how for one in implausible(case, engine_torques(case))]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('rate = "24.2 kN/m"', 'rate = "1e-9 N/m"',
         "spring.rate = 1e-9 N/m, usually 0.05 to 20000 kN/m"),
        ('rate = "24.2 kN/m"', 'rate = "24.2 N/m"',
         "spring.rate = 24.2 N/m, usually 0.05 to 20000 kN/m"),
        ('rate = "24.2 kN/m"', 'rate = "24.2 MN/m"',
         "spring.rate = 24.2 MN/m, usually 0.05 to 20000 kN/m"),
        ('preload = "242 N" ', 'preload = "400 kN" ',
         "spring.preload = 400 kN, usually 0.0001 to 200 kN"),
        ('preload = "242 N" ', 'preload = "24.2 kN" ', "spring.rate = 24.2 kN/m: it stores"),
        ('mass = "175 g"', 'mass = "250 kg"', "follower.mass = 250 kg, usually 0.001 to 50 kg"),
        ('clearance = "0.05 mm"', 'clearance = "0.05 mm"\nwall = "0.1 mm"',
         "guides.a.wall = 0.1 mm, usually 0.5 to 50 mm"),
        ('[materials.c45]\nE = "210 GPa"', '[materials.c45]\nE = "210 MPa"',
         "materials.c45.E = 210 MPa, usually 0.4 to 700 GPa"),
    ],
)  # fmt: skip
def test_a_value_that_cannot_be_meant_has_one_warning(old: str, new: str, words: str) -> None:
    (one,) = warnings(parse_case(changed(GX120, old, new)))
    assert one.startswith(words)
    assert one.endswith(")")  # the source of the range


@pytest.mark.parametrize(("preload", "told"), [("-50 N", False), ("-300 kN", True)])
def test_a_spring_that_pulls_is_judged_by_the_size_of_its_preload(preload: str, told: bool) -> None:
    text = (Path(__file__).parents[1] / "data" / "conjugate_feeder.toml").read_text()
    spring = f'[spring]\nrate = "1 N/mm"\npreload = "{preload}"\n\n[camshaft]\n'
    warned = implausible(parse_case(text.replace("[camshaft]\n", spring, 1)), {})
    assert ("spring.preload" in {one.title for one in warned}) is told


def test_a_motor_at_another_speed_than_the_load_case_has_one_warning() -> None:
    """3.898 N m on the line from 5 N m at 1000 rpm to none at 1200 rpm: at 1044 rpm."""
    text = (ROOT / "cases" / "machines" / "dosing-pump.toml").read_text(encoding="utf-8")
    assert warnings(parse_case(text)) == []
    text = changed(changed(text, '"113 rpm"', '"1000 rpm"'), '"120 rpm"', '"1200 rpm"')
    (one,) = warnings(parse_case(text))
    assert one == (
        "load_case[0].speed = 115 rpm, but crankshaft.motor_line carries the mean torque of"
        " 3.898 N m at 1044 rpm"
    )


def test_two_viscosities_of_one_oil_have_one_warning() -> None:
    """24 mPa s at the cam are 27.6 mm2/s; grease in the bearing is another oil."""
    text = (ROOT / "cases" / "machines" / "compressor.toml").read_text(encoding="utf-8")
    assert warnings(parse_case(text)) == []
    thin = changed(text, 'viscosity = "27 mm^2/s"', 'viscosity = "12 mm^2/s"')
    (one,) = warnings(parse_case(thin))
    assert (
        one.startswith("lubricant.viscosity = ") and "roller.bearing.viscosity = 12 mm^2/s" in one
    )
    greased = changed(thin, 'lubrication = "oil"', 'lubrication = "grease_for_life"')
    assert warnings(parse_case(greased)) == []


def test_no_part_in_operation_is_colder_than_its_surroundings() -> None:
    text = (ROOT / "cases" / "machines" / "compressor.toml").read_text(encoding="utf-8")
    cold = changed(text, 'ambient_temperature = "60 degC"', 'ambient_temperature = "100 degC"')
    found = warnings(parse_case(cold))
    assert [one.split(" = ")[0] for one in found] == [
        "lubricant.temperature", "spring.design.temperature"
    ]  # fmt: skip
    assert all("guides.ambient_temperature = 100 degC" in one for one in found)
    hot_day = changed(text, 'ambient_temperature = "30 degC"', 'ambient_temperature = "100 degC"')
    assert "cooling.ambient_temperature = 100 degC" in warnings(parse_case(hot_day))[0]


def test_a_bush_of_another_diameter_than_the_stem_is_told() -> None:
    text = (ROOT / "cases" / "machines" / "compressor.toml").read_text(encoding="utf-8")
    head, after = text.split("[guides.b]")
    wide = head + "[guides.b]" + changed(after, 'diameter = "20 mm"', 'diameter = "24 mm"')
    (one,) = warnings(parse_case(wide))
    assert one.startswith("guides.b.diameter = 24 mm, but follower.stem_diameter = 20 mm")


def test_an_endurance_beyond_that_of_the_hardness_is_told() -> None:
    """2.76 x 200 - 70 = 482 MPa of Buckingham; 1.313 x 210 + 373 = 649 MPa of gear flanks."""
    card = """
[materials.mine]
E = "210 GPa"
nu = 0.3
treatment = "{treatment}"
hardness_brinell = 200
hardness_vickers = 210
yield_strength = "370 MPa"
density = "7850 kg/m^3"
endurance_pressure = "{pressure}"
source = "test"
"""

    def found(treatment: str, pressure: str) -> list[str]:
        text = card.format(treatment=treatment, pressure=pressure)
        return warnings(parse_case(f"{GX120}\n{text}"))

    assert found("not_hardened", "960 MPa") == []
    (one,) = found("not_hardened", "1500 MPa")
    assert one.startswith("materials.mine.endurance_pressure = 1500 MPa: 3.11 times that by its")
    assert "482 MPa by Buckingham, usually up to 2 times" in one
    assert found("through_hardened", "1290 MPa") == []
    (one,) = found("through_hardened", "2000 MPa")
    assert "by its hardness, 648.7 MPa by ISO 6336-5, usually" in one
    # no rule for a card without hardness
    bare = card.replace("hardness_brinell = 200\nhardness_vickers = 210\n", "")
    text = bare.format(treatment="not_hardened", pressure="5000 MPa")
    assert warnings(parse_case(f"{GX120}\n{text}")) == []


def test_an_unbalance_finer_than_any_grade_is_told() -> None:
    """0.2 g mm over 1.8 kg is 0.111 um, at 188.5 rad/s of the cam 0.021 mm/s: below G 0.4."""
    assert warnings(parse_case(REDESIGN)) == []
    (one,) = warnings(parse_case(changed(REDESIGN, '"20 g mm"', '"0.2 g mm"')))
    assert one.startswith("camshaft.counterweight.residual = 0.2 g mm: at camshaft.rotor_mass")
    assert "a grade of G 0.021, usually 0.4 to 4000 mm/s" in one


def test_an_unbalance_finer_than_any_grade_is_told_without_the_mass_of_the_rotor() -> None:
    """By cam and shaft alone, at least; a coarse one is not, as the rotor may be heavier."""
    (line,) = (each for each in REDESIGN.splitlines() if each.startswith("rotor_mass"))
    bare = changed(REDESIGN, line, "")
    assert warnings(parse_case(bare)) == []
    fine, case = changed(bare, '"20 g mm"', '"0.2 g mm"'), parse_case(bare)
    (one,) = warnings(parse_case(fine))
    base, bore = case.cam.prime_radius - case.roller.radius, case.cam.bore_radius
    mass = np.pi * case.cam.material.density * (base**2 - bore**2) * case.cam.width
    shaft = case.camshaft
    mass += np.pi / 4.0 * shaft.material.density * shaft.diameter**2 * shaft.bearing_spacing
    speed = max(each.speed for each in case.load_cases) / case.mechanism.gear_ratio
    assert f"at {1e3 * mass:.4g} g of cam and shaft alone" in one
    assert f"a grade of G {1e3 * 2e-7 / mass * speed:.2g}, usually 0.4" in one
    assert warnings(parse_case(changed(bare, '"20 g mm"', '"90000000 g mm"'))) == []
    # 1.1 um, which a bench reaches, though it is a grade of 0.21
    assert warnings(parse_case(changed(bare, '"20 g mm"', f'"{1.1 * mass:.4g} g mm"'))) == []


def test_a_rate_a_thousand_times_too_low_contradicts_the_torque() -> None:
    text = changed(REDESIGN, 'rate = "180 kN/m"', 'rate = "180 N/m"')
    text = text[: text.index("[spring.design]")] + text[text.index("[cam]") :]
    (one,) = warnings(parse_case(text))
    assert one.startswith("spring.rate = 180 N/m: it stores 0.0018 of the energy swing of the torq")


def measured(folder: Path, torque: np.ndarray, unit: str = "Nm") -> Case:
    """The published case with a measured torque, N m."""
    rows = [f"{angle},{value:.9g}" for angle, value in enumerate(torque)]
    text = "\n".join([f"crank_angle_deg,torque_{unit}", *rows, ""])
    (folder / "torque.csv").write_text(text, encoding="utf-8")
    engine = '[engine]\nkind = "table"\nfile = "torque.csv"\n\n'
    case = GX120[: GX120.index("[engine]")] + engine + GX120[GX120.index("[crankshaft]") :]
    (folder / "case.toml").write_text(case, encoding="utf-8")
    return read_case(folder / "case.toml")


ANGLE = np.radians(np.arange(720.0))
TORQUE = 30.0 * np.sin(ANGLE) + 10.0 * np.sin(2.0 * ANGLE)


@pytest.mark.parametrize(
    ("scale", "words"),
    [
        (0.0, "engine.file: constant torque, peak to peak = 0 N m, usually 0.1 to"),
        (1e-3, "engine.file: torque, peak to peak = 0.0697 N m, usually 0.1 to"),
        (1e3, "spring.rate = 24.2 kN/m: storage of the energy swing of the torque, 6e+04 J, takes"),
    ],
)
def test_a_torque_of_zero_or_in_the_wrong_unit(tmp_path: Path, scale: float, words: str) -> None:
    (one,) = warnings(measured(tmp_path, scale * TORQUE))
    assert one.startswith(words)


def test_a_torque_in_kilonewton_metres_that_says_so_is_none(tmp_path: Path) -> None:
    assert warnings(measured(tmp_path, 1e-3 * TORQUE, "kNm")) == []
    assert warnings(measured(tmp_path, TORQUE)) == []


SHIPPED = sorted(
    path
    for path in (ROOT / "cases").rglob("*.toml")
    if path.name != "mechanisms.toml"  # mechanisms without a case
)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_cases_have_no_warning(path: Path) -> None:
    """Those of the studies too, which are the base cases of ``studies/*.toml``."""
    assert warnings(read_case(path)) == []


class Notes(Progress):
    """Keeps the notes of a run."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def stage(self, name: str) -> None: ...

    def advance(self, k: int, total: int) -> None: ...

    def note(self, text: str) -> None:
        self.notes.append(text)


class Stopped(Notes):
    """Stops the run as Ctrl-C does before its first trial."""

    def stage(self, name: str) -> None:
        if name.startswith("trial"):
            raise KeyboardInterrupt


def test_a_run_warns_goes_on_and_records_it(tmp_path: Path) -> None:
    """A torque of zero: a round cam, no division by its swing."""
    case, notes = measured(tmp_path, 0.0 * TORQUE).with_positions(36), Notes()
    run_case(case, tmp_path / "run", depth=Tier.SCREENING, progress=notes)
    (warning,) = (note for note in notes.notes if note.startswith("warning: "))
    record = json.loads((tmp_path / "run" / "run.json").read_text(encoding="utf-8"))
    (finding,) = (one for one in record["consistency"] if one["id"] == PLAUSIBILITY)
    assert warning == f"warning: {finding['how']}"
    assert (finding["given"], finding["implied"], finding["flagged"]) == (0.0, 0.1, True)
    assert finding["title"] == "engine.file"
    assert consistency_line(finding) == f"plausibility: {finding['how']}"


def test_a_run_warns_of_a_source_that_is_open_by_its_words(tmp_path: Path) -> None:
    made_up = "made up for this template: replace by the maker's table"
    text, notes = changed(small_machine("words"), made_up, "maker: verify"), Stopped()
    case = parse_case(text).with_positions(36)
    with pytest.raises(KeyboardInterrupt):
        run_case(case, tmp_path / "run", depth=Tier.SCREENING, progress=notes)
    (warning,) = (note for note in notes.notes if "version 0.1" in note)
    assert warning.startswith('warning: source "maker: verify" is to be confirmed by its words')


def test_a_curve_that_overshoots_its_table_is_told(tmp_path: Path) -> None:
    """A fall of 20 mm in 10 deg, by points 2 deg apart; a cycloidal lift leaves its points less."""
    snail = Path(__file__).parents[1] / "data" / "strangers" / "14-missing-kinds"
    (told,) = implausible(read_case(snail / "snail_table.toml"), {})
    assert told.title == "lift.file"
    assert "leaves them by 1.69% of the stroke at 0.75 deg" in told.how
    x = np.arange(0.0, 360.0, 4.0)
    up = np.clip(np.minimum(x, 180.0 - x) / 60.0, 0.0, 1.0)
    lift = 20.0 * (up - np.sin(2.0 * np.pi * up) / (2.0 * np.pi))
    rows = [f"{angle:g},{value:.9g}" for angle, value in zip(x, lift, strict=True)]
    text = "\n".join(("cam_angle_deg,lift_mm", *rows))
    (tmp_path / "snail.csv").write_text(text, encoding="utf-8")
    case = (snail / "snail_table.toml").read_text(encoding="utf-8")
    (tmp_path / "smooth.toml").write_text(case, encoding="utf-8")
    assert implausible(read_case(tmp_path / "smooth.toml"), {}) == ()
