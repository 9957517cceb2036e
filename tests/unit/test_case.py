"""Case files: what is read, what is refused and in which words."""

from __future__ import annotations

import tomllib
from dataclasses import FrozenInstanceError
from math import radians
from pathlib import Path

import pytest

from camwright.geometry.errors import InputError, SeveralInputsError
from camwright.pipeline.case.case_file import CASE_BYTES, parse_case, read_case
from camwright.pipeline.case.limits import (
    CURVATURE_RATE,
    JAM_INDEX,
    LIMITS,
    PRESSURE_ANGLE,
    TORQUE_REDUCTION,
    AnyLimit,
    Limits,
)
from camwright.pipeline.engine.cylinder import CylinderEngine

ROOT = Path(__file__).resolve().parents[2]
GX120 = (ROOT / "cases" / "gx120.toml").read_text(encoding="utf-8")


def changed(old: str, new: str) -> str:
    """The GX120 case with one passage changed; the passage must be there once."""
    assert GX120.count(old) == 1, old
    return GX120.replace(old, new)


def refused(text: str) -> str:
    with pytest.raises(InputError) as caught:
        parse_case(text)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_gx120_is_the_published_design() -> None:
    case = parse_case(GX120)
    assert case.spring.rate == 24200.0
    assert case.spring.preload == 242.0
    assert case.cam.prime_radius == 0.050
    assert case.roller.radius == 0.008
    assert case.roller.bearing.C0 == 380.0
    assert case.guides.a.friction == 0.04
    assert case.guides.b.friction == 0.20
    assert case.guides.spacing == 0.080
    assert case.limits[TORQUE_REDUCTION] == 0.4
    assert case.solver.positions == 720
    assert [load_case.name for load_case in case.load_cases] == ["idle"]


def test_a_case_holds_the_engine_it_describes() -> None:
    engine = parse_case(GX120).engine
    assert isinstance(engine, CylinderEngine)
    assert engine.crank_radius == 0.021
    assert engine.friction_pressure is None
    text = changed(
        'heat_loss = "hohenberg"', 'friction_pressure = "165 kPa"\nheat_loss = "woschni"'
    )
    engine = parse_case(text).engine
    assert isinstance(engine, CylinderEngine)
    assert engine.friction_pressure == 165e3
    assert engine.heat_loss == "woschni"


def test_resolved_text_reads_back_bit_for_bit() -> None:
    case = parse_case(GX120)
    text = case.to_toml()
    again = parse_case(text)
    assert again == case
    assert again.to_toml() == text
    assert again.sha256 == case.sha256


def test_resolved_text_writes_defaults_out() -> None:
    resolved = tomllib.loads(parse_case(GX120).to_toml())
    assert resolved["engine"]["wall_temperature"] == "400 K"
    assert resolved["engine"]["rod_big_end_share"] == 2.0 / 3.0
    assert resolved["limits"]["undercut_factor"] == 0.3


def test_comments_do_not_change_the_hash_but_values_do() -> None:
    case = parse_case(GX120)
    assert parse_case("# a remark\n" + GX120).sha256 == case.sha256
    assert parse_case(changed('"24.2 kN/m"', '"24200 N/m"')).sha256 == case.sha256
    assert parse_case(changed('"24.2 kN/m"', '"24.3 kN/m"')).sha256 != case.sha256


def test_positions_can_be_given_again() -> None:
    case = parse_case(GX120)
    assert case.with_positions(36).solver.positions == 36
    assert case.with_positions(36).sha256 != case.sha256
    for positions in (35, 7201):
        with pytest.raises(InputError, match=r"solver\.positions"):
            case.with_positions(positions)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('radius = "8 mm" ', 'radus = "8 mm" ', "roller.radus = unknown key, must be a known key; "
         "did you mean radius?"),
        ("[spring]", "[sprung]", "sprung = unknown key, must be a known key; did you mean spring?"),
        ('rate = "24.2 kN/m" ', "", "spring.rate = missing, must be given"),
        ('rate = "24.2 kN/m"', "rate = 24200", "spring.rate = 24200, must be a number with a unit"),
        ('rate = "24.2 kN/m"', 'rate = "24.2 kN"', "spring.rate = 24.2 kN, must be in a unit of"),
        ('rate = "24.2 kN/m"', 'rate = "-24.2 kN/m"', "spring.rate = -24.2 kN/m, must be > 0"),
        ('rate = "24.2 kN/m"', 'rate = "nan kN/m"', "spring.rate = nan kN/m, must be finite"),
        ("compression_ratio = 8.5", "compression_ratio = nan", "compression_ratio = nan, must be"),
        ("compression_ratio = 8.5", "compression_ratio = true", "must be a number without a unit"),
        ("compression_ratio = 8.5", 'compression_ratio = "8.5"', "must be a number without a unit"),
        ("nu = 0.4", "nu = 0.5", "materials.nylon.nu = 0.5, must be >= 0 and < 0.5"),
        ("friction = 0.04", "friction = -0.01", "guides.a.friction = -0.01, must be >= 0 and <= 1"),
        ("friction = 0.04", "friction = 2", "guides.a.friction = 2, must be >= 0 and <= 1"),
        ("positions = 720", "positions = 35", "solver.positions = 35, must be >= 36"),
        ("positions = 720", "positions = 7201", "solver.positions = 7201, must be <= 7200"),
        ("positions = 720", "positions = 72.0", "solver.positions = 72.0, must be a whole number"),
        ('"1500 rpm" ', '"-1 rpm" ', "load_case[0].speed = -1 rpm, must be >= 0 and < 20000 rpm"),
        ('"1500 rpm" ', '"25 1/s" ', "load_case[0].speed = 25 1/s, must be in a unit of"),
        ('name = "idle"', 'name = "../idle"', "load_case[0].name = ../idle, must be 1 to 40"),
        ('name = "gx120"', 'name = "gx/120"', "name = gx/120, must be 1 to 40"),
        ('radius = "8 mm" ', 'radius = "51 mm" ',
         "roller.radius = 51 mm, must be < cam.prime_radius = 50 mm"),
        ('radius = "8 mm" ', 'radius = "7.9 mm" ',
         "roller.radius = 7.9 mm, must be >= 8 mm, half of roller.bearing.ring.outer"),
        ('"8.5 mm"', '"42 mm"', "cam.bore_radius = 42 mm, must be < 42 mm, the base"),
        ('depth = "2.3 mm"', 'depth = "34 mm"', "cam.keyway.depth = 34 mm, must be < 33.5 mm"),
        ('hub_radius = "4.2 mm"', 'hub_radius = "8 mm"',
         "roller.hub_radius = 8 mm, must be < roller.radius = 8 mm"),
        ('material = "s355"', 'material = "s354"', "cam.material = s354, must be one of"),
        ('kind = "cylinder"', 'kind = "rocket"', "engine.kind = rocket, must be"),
        ('kind = "cylinder"', "", "must be a table with kind"),
        ("gear_ratio = 2.0", "gear_ratio = 1.0",
         "mechanism.gear_ratio = 1, must be 2 or 4: a cam turn holds"),
        ("schema_version = 1", "schema_version = 2", "schema_version = 2, must be 1"),
        ("points = 12", "points = 200",
         "smoothing.points = 200, must be <= 144, a cycle of 720 deg over"),
        ("points = 12", "points = 12\nstarts = 0", "smoothing.starts = 0, must be >= 1"),
        ("points = 12", "points = 12\nstarts = 41", "smoothing.starts = 41, must be <= 40"),
        ("points = 12", 'points = 12\ncutoff = "721 deg"', "smoothing.cutoff = 721 deg, must be"),
        ("points = 12", "points = 12\ncutoff = 90", "smoothing.cutoff = 90, must be a number with"),
        ("points = 12", 'points = 12\nfree = ["phase"]', "smoothing.phase_range = None, must be"),
        ("points = 12", 'points = 12\nphase_range = ["-181 deg", "0 deg"]', "must be >= -180"),
        ("points = 12", 'points = 12\nfree = ["mass"]', "smoothing.free[0] = mass, must be"),
        ("[limits.sources]", 'curvature_rate = "-1 1/mm^2"\n[limits.sources]',
         "limits.curvature_rate = -1 1/mm^2, must be > 0"),
        ("[limits.sources]", 'return_pressure_angle = "29 deg"\n[limits.sources]',
         "limits.return_pressure_angle = 29 deg, must be >= limits.pressure_angle = 30 deg"),
        ("[limits.sources]", 'curvature_rate = "1 1/m"\n[limits.sources]',
         "limits.curvature_rate = 1 1/m, must be in a unit of"),
        ('rod_length = "73 mm"', 'rod_length = "20 mm"',
         "engine.rod_length = 20 mm, must be > crank_radius = 21 mm"),
        ("[limits.sources]", '[limits.sources]\njamindex = "x"',
         "limits.sources.jamindex = unknown key, must be a known limit; did you mean jam_index?"),
    ],
)  # fmt: skip
def test_refusals_name_field_value_and_limit(old: str, new: str, message: str) -> None:
    assert message in refused(changed(old, new))


def test_more_refusals_are_named() -> None:
    text = changed('"24.2 kN/m"', '"-1 kN/m"').replace('"242 N"', '"-2e9 N"')
    first, second = refused(text).split("; ")
    assert first == "spring.rate = -1 kN/m, must be > 0 and <= 1e+06 kN/m"
    assert second == "spring.preload = -2e9 N, must be >= -1e+09 and <= 1e+09 N"
    pulled = refused(changed('"242 N"', '"-1 N"'))
    assert pulled.startswith('spring.preload = -1 N, must be > 0 N, or cam.closure = "groove"')


def test_an_unknown_key_hides_no_wrong_value_of_its_table() -> None:
    text = changed('"24.2 kN/m"', '"-1 kN/m"\nstiffness = "1 kN/m"')
    with pytest.raises(SeveralInputsError) as error:
        parse_case(text)
    first, second = error.value.lines
    assert first.startswith("spring.stiffness = unknown key")
    assert second == "spring.rate = -1 kN/m, must be > 0 and <= 1e+06 kN/m"


def test_an_unknown_table_hides_no_contradiction_in_another() -> None:
    text = changed("[scope]", "[scoop]\n[scope]").replace('reason = "C24', '# reason = "C24')
    with pytest.raises(SeveralInputsError) as error:
        parse_case(text)
    first, second = error.value.lines
    assert first == "scoop = unknown key, must be a known key; did you mean scope?"
    assert second == "scope.reason = missing, must be given with scope.not_covered"


def test_every_refusal_is_listed_up_to_a_bound() -> None:
    keys = "".join(f"unknown_{k} = 1\n" for k in range(20))
    text = changed('"24.2 kN/m"', '"-1 kN/m"').replace("[cam]\n", f"[cam]\n{keys}")
    with pytest.raises(SeveralInputsError) as error:
        parse_case(text)
    assert len(error.value.errors) == 21
    assert error.value.field == "cam.unknown_0"
    *shown, last = error.value.lines
    assert (len(shown), last) == (SeveralInputsError.MOST, "9 more")


def test_load_case_names_differ() -> None:
    text = GX120 + '\n[[load_case]]\nname = "IDLE"\nspeed = "1600 rpm"\n'
    assert refused(text) == "load_case[1].name = IDLE, must be unlike every other"


def test_starts_at_the_torque_or_at_the_lift_never_at_both() -> None:
    assert "must be exactly one" in refused(GX120 + '\n[lift]\nfile = "lift.csv"\n')


@pytest.mark.parametrize("depth", [17, 600, 20_000])
def test_tables_nested_too_deeply_are_refused(depth: int) -> None:
    text = f"{GX120}\n[{'.'.join(['a'] * depth)}]\nb = 1\n"
    with pytest.raises(InputError, match="case = nested too deeply, must be at most 16 tables"):
        parse_case(text)


@pytest.mark.parametrize(
    "text",
    [
        "a = " + "[" * 50_000,
        "a = {" * 20_000,
        "a = 'open",
        "a = 1\na = 2",
        "a = " + "9" * 5000,
        "\0",
    ],
)
def test_broken_toml_is_one_line(text: str) -> None:
    assert refused(text).startswith("case = ")


def test_file_that_is_missing_too_large_or_not_text(tmp_path: Path) -> None:
    def message(path: Path) -> str:
        with pytest.raises(InputError) as caught:
            read_case(path)
        return str(caught.value)

    assert "must be an existing file" in message(tmp_path / "none.toml")
    assert "must be an existing file" in message(tmp_path)
    large = tmp_path / "large.toml"
    large.write_text("# " + "x" * CASE_BYTES)
    assert "must be at most 256 KiB" in message(large)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in message(binary)


def with_table(folder: Path, name: str = "torque.csv") -> Path:
    """A case of which the torque comes from a file."""
    engine = GX120[GX120.index("[engine]") : GX120.index("[mechanism]")]
    text = GX120.replace(engine, f'[engine]\nkind = "table"\nfile = {name!r}\n\n')
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_included_files_are_part_of_the_hash(tmp_path: Path) -> None:
    table = tmp_path / "torque.csv"
    table.write_text("angle_deg,torque_Nm\n0,1\n")
    case = read_case(with_table(tmp_path))
    assert case.included == {"inputs/torque.csv": table.read_bytes()}
    assert case.path("torque.csv") == tmp_path / "torque.csv"
    before = case.sha256
    table.write_text("angle_deg,torque_Nm\n0,2\n")
    assert read_case(tmp_path / "case.toml").sha256 != before


def test_resolved_case_with_its_inputs_is_the_same_case(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "torque.csv").write_text("angle_deg,torque_Nm\n0,1\n")
    case = read_case(with_table(tmp_path, "data/torque.csv"))
    kept = tmp_path / "kept"
    for name, content in case.included.items():
        (kept / name).parent.mkdir(parents=True)
        (kept / name).write_bytes(content)
    (kept / "case.toml").write_text(case.to_toml(), encoding="utf-8")
    assert read_case(kept / "case.toml").sha256 == case.sha256


@pytest.mark.parametrize(
    "name",
    [
        "/etc/passwd",
        "../torque.csv",
        "a/../../torque.csv",
        "a/../in.csv",
        "link.csv",
        "..\\torque.csv",
    ],
)
def test_includes_stay_in_the_folder(tmp_path: Path, name: str) -> None:
    (tmp_path / "torque.csv").write_text("x")
    folder = tmp_path / "case"
    folder.mkdir()
    (folder / "link.csv").symlink_to(tmp_path / "torque.csv")
    with pytest.raises(InputError, match="stays in the case file's folder"):
        read_case(with_table(folder, name))


def test_include_that_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"engine\.file = .*none\.csv, must be an existing file"):
        read_case(with_table(tmp_path, "none.csv"))


def test_frozen() -> None:
    case = parse_case(GX120)
    with pytest.raises(FrozenInstanceError):
        case.spring.rate = 1.0  # type: ignore[misc]
    with pytest.raises(ValueError, match="frozen"):
        case.solver.positions = 36  # type: ignore[misc]
    with pytest.raises(ValueError, match="frozen"):
        case.limits.jam_index = 1.0


def test_parts_hold_the_cards_of_their_materials() -> None:
    case = parse_case(GX120)
    for name, card in case.materials.items():
        assert card.name == name
    for card in (
        case.cam.material,
        case.roller.material,
        case.follower.stem_material,
        case.guides.a.material,
        case.guides.b.material,
    ):
        assert card == case.materials[card.name]
    assert (case.cam.material.name, case.guides.a.material.name) == ("s355", "nylon")


def test_limits_are_looked_up_by_their_rows() -> None:
    limits = parse_case(GX120).limits
    assert limits[JAM_INDEX] == 0.5
    assert limits[PRESSURE_ANGLE] == pytest.approx(radians(30.0), rel=1e-15)
    assert limits[CURVATURE_RATE] is None  # it has no default, and the case sets none
    assert limits.source(PRESSURE_ANGLE).text.startswith(
        "Rothbart, Cam Design Handbook (2004), ch. 6"
    )
    assert limits.source(JAM_INDEX) == JAM_INDEX.source  # the case has no words of its own


@pytest.mark.parametrize("row", LIMITS.values(), ids=LIMITS)
def test_a_limit_left_out_is_that_of_its_row(row: AnyLimit) -> None:
    assert Limits()[row] == row.default
    if row.default is not None:
        assert row.quantity.holds(row.default)


def test_the_tables_of_a_case_are_those_of_its_text() -> None:
    case = parse_case(GX120)
    assert case.tables() == tomllib.loads(case.to_toml())


def test_a_press_fit_of_the_stem_is_refused_with_the_reason() -> None:
    """A clearance of zero still slides."""
    fit = GX120.replace('clearance = "0.05 mm"', 'clearance = "0 mm"', 1)
    assert parse_case(fit).guides.a.clearance == 0.0
    tight = GX120.replace('clearance = "0.05 mm"', 'clearance = "-0.001 mm"', 1)
    assert "guides.a.clearance = -0.001 mm, must be >= 0 mm: a press fit" in refused(tight)
