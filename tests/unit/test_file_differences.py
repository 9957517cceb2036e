"""Every file of a run is compared by its content: round-off is none, a forgery of any kind is."""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import made_trial as made
import numpy as np
import pytest
from PIL import Image, ImageDraw
from report_fixture import cycle_columns, shape, turn, write_field

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.meshes.mesh_files import write_hexahedra, write_msh
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.files import npz_bytes
from camwright.pipeline.base.spreadsheets import spreadsheet
from camwright.pipeline.results.file_differences import (
    CLASSES,
    Kind,
    Origin,
    classes_of,
    file_differences,
    record_differences,
)
from camwright.pipeline.results.run_folder import FILES
from camwright.pipeline.results.workshop_files import write_workshop
from camwright.reports.sections import PARTS

NOISE = 1e-14
"""Round-off of another processor, relative."""

Forgery = Callable[[Path], None]


def cam(noise: float) -> Contour:
    """The harmonic cam with round-off of its lift."""
    theta = uniform_turn(720)
    draw = 1.0 + noise * np.random.default_rng(1).uniform(-1.0, 1.0, theta.size)
    lift = Lift(theta, 0.5 * made.STROKE * (1.0 - np.cos(theta)) * draw)
    return RollerContour(PitchCurve(lift, made.BASE), made.ROLLER)


def picture(shade: int = 0, spot: bool = False) -> bytes:
    """A disc on white, its edge by a shade other; a black spot on it."""
    image = Image.new("RGB", (96, 64), "white")
    drawing = ImageDraw.Draw(image)
    drawing.ellipse((16, 8, 64, 56), fill=(200, 60 + shade, 60))
    if spot:
        drawing.rectangle((30, 30, 36, 36), fill="black")
    stream = io.BytesIO()
    image.save(stream, format="png")
    return stream.getvalue()


def page(pixels: bytes, count: int = 3, factor: float = 1.25) -> str:
    image = base64.b64encode(pixels).decode()
    return (
        f"<p>{count} values to be confirmed, safety {factor!r}</p>"
        f'<img src="data:image/png;base64,{image}"><script>draw("a1b2", {factor!r});</script>'
    )


def written(folder: Path, noise: float) -> Path:
    """One file at least of each kind, with round-off."""
    (folder / "trial_1").mkdir(parents=True)
    (folder / "fields").mkdir()
    (folder / "figures").mkdir()
    write_workshop(folder / "workshop", made.case(), cam(noise))
    angle = np.arange(0.0, 360.0, 10.0)
    wave = np.sin(np.radians(angle)) * (1.0 + noise * np.cos(7.0 * angle)) + noise
    rows = "\n".join(
        f"idle,{a!r},{w!r}" for a, w in zip(angle.tolist(), wave.tolist(), strict=True)
    )
    (folder / "trial_1" / "5_cycle.csv").write_text(f"load_case,cam_angle_deg,force_N\n{rows}\n")
    table = folder / "table.csv"  # pages are drawn from the tables of the run itself
    table.write_text("cam_angle_deg,force_N\n0.0,1.25\n90.0,2.5\n")
    (folder / "workshop" / "contour.xlsx").write_bytes(spreadsheet(table))
    table.unlink()
    (folder / "trial_1" / "5_pressure.npz").write_bytes(npz_bytes({"pressure_MPa": wave}))
    write_msh(
        folder / "trial_1" / "4_mesh.msh",
        {"roller": roller_mesh(0.008 * (1.0 + noise), 0.002, 0.0, ElementSize(far_size=2e-3))},
    )
    t = turn(36)
    field = cycle_columns(t, shape(t))
    field["p0_hertz_MPa"] = field["p0_hertz_MPa"] * (1.0 + noise)
    write_field(folder / "fields" / "stress.vtkhdf", shape(t), 9, field)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    write_hexahedra(
        folder / "fields" / "ends.vtu", corners, np.array([[0, 4, 6, 2, 1, 5, 7, 3]]),
        {"von_mises_MPa": wave[:8]}, {"body": np.array([0])}, {"force_N": 100.0 * (1.0 + noise)},
    )  # fmt: skip
    (folder / "fields" / "view_stress.py").write_text("import pyvista\n")
    (folder / "figures" / "radii.png").write_bytes(picture(shade=bool(noise)))
    (folder / "8_report.html").write_text(page(picture(shade=bool(noise)), factor=1.25 + noise))
    (folder / "8_signoff.pdf").write_bytes(b"%PDF-1.7 sheet")
    record = {"demand": 1.5 * (1.0 + noise), "cam_angle_deg": 1e-7 if noise else 360.0 - 1e-7,
              "residual_force": 1e-13 + noise, "note": f"at {1234.5 + noise!r} rpm"}  # fmt: skip
    (folder / "corners.json").write_text(json.dumps(record))
    return folder


@pytest.fixture(scope="module")
def honest(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, Path]]:
    """The same files by two computers."""
    home = tmp_path_factory.mktemp("files")
    yield written(home / "stored", NOISE), written(home / "again", 0.0)


def kinds_in(folder: Path) -> dict[str, Kind]:
    names = [file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()]
    return {name: classes_of(name, 1)[0].kind for name in sorted(names)}


def test_round_off_of_another_computer_is_no_difference(honest: tuple[Path, Path]) -> None:
    stored, again = honest
    kinds = kinds_in(stored)
    assert set(kinds.values()) == set(Kind)
    other = [n for n in kinds if (stored / n).read_bytes() != (again / n).read_bytes()]
    assert {kinds[name] for name in other} >= set(Kind) - {Kind.TEXT, Kind.DOCUMENT, Kind.BOOK}
    assert dict(file_differences(stored, again, kinds.items())) == {}


def replaced(pattern: str, new: Callable[[re.Match[str]], str]) -> Forgery:
    def forge(file: Path) -> None:
        text, count = re.subn(pattern, new, file.read_text(encoding="utf-8"), count=1)
        assert count == 1, pattern
        file.write_text(text, encoding="utf-8")

    return forge


def moved(match: re.Match[str], by: float = 2e-5) -> str:
    """A number moved by 20 nm."""
    return f"{match[1]}{float(match[2]) + by!r}"


def in_hdf(name: str) -> Forgery:
    def forge(file: Path) -> None:
        with h5py.File(file, "r+") as root:
            values = root[name]
            values[0] = 0.99 * values[0]

    return forge


def in_book(file: Path) -> None:
    with zipfile.ZipFile(file) as old:
        members = {name: old.read(name) for name in old.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    changed = re.sub(rb"<v>(\d+)\.(\d)", rb"<v>\g<1>.9\2", members[sheet], count=1)
    assert changed != members[sheet]
    with zipfile.ZipFile(file, "w") as new:
        for name, content in (members | {sheet: changed}).items():
            new.writestr(name, content)


FORGED: tuple[tuple[str, Forgery, str], ...] = (
    ("workshop/cam.step", replaced(r"(CIRCLE\('',#\d+,)([\d.]+)", lambda m: moved(m, -0.5)),
     "CIRCLE"),
    ("workshop/cam.step", replaced(r"(CARTESIAN_POINT\('',\()(\d\d\.\d{9,})", moved), "CARTESIAN"),
    ("workshop/cam.step", replaced(r"(DIRECTION\('',\()0\.0,0\.0,1\.0",
                                   lambda m: f"{m[1]}0.0,1.0,0.0"), "DIRECTION"),
    ("workshop/cam.step", replaced(r"()FILE_NAME\('", lambda m: "FILE_NAME('other "), "FILE_NAME"),
    ("workshop/contour.dxf", replaced(r"(\n 10\n)(-?[1-9]\d\.\d{9,})", moved), "recomputed"),
    ("workshop/contour.dxf", replaced(r"()\bbore\b", lambda m: "hole"), "hole"),
    ("workshop/contour.csv", replaced(r"(\n90\.0,)(\d+\.\d+)", lambda m: moved(m, 0.01)),
     "polar_angle_deg at"),
    ("workshop/inspection.csv", replaced(r",(),,\n", lambda m: ",1.0,,\n"), "measured_x_mm"),
    ("workshop/dimensions.json", replaced(r'("thickness_mm": )([\d.]+)', lambda m: moved(m, 1.0)),
     "thickness_mm ="),
    ("workshop/contour.xlsx", in_book, "xl/worksheets/sheet1.xml"),
    ("trial_1/5_cycle.csv", replaced(r"idle,90", lambda m: "full,90"), "load cases"),
    ("trial_1/5_pressure.npz", lambda file: file.write_bytes(
        npz_bytes({"pressure_MPa": np.zeros(36)})), r"pressure_MPa\["),
    ("trial_1/4_mesh.msh", replaced(r"()roller_rim", lambda m: "roller_hub"), "rim"),
    ("fields/stress.vtkhdf", in_hdf("VTKHDF/cam/PointData/von_mises_MPa"), "von_mises"),
    ("fields/stress.vtkhdf", in_hdf("VTKHDF/Steps/Values"), "Values"),
    ("fields/ends.vtu", lambda file: file.write_bytes(
        file.read_bytes().replace(b"force_N", b"force_M")), "recomputed|missing|differs|type"),
    ("fields/view_stress.py", lambda file: file.write_text(
        "import os; os.system('id')\n" + file.read_text()), "is not the file"),
    ("figures/radii.png", lambda file: file.write_bytes(picture(spot=True)), "something else"),
    ("8_report.html", lambda file: file.write_text(page(picture(), count=0)), "0.*recomputed '3"),
    ("8_report.html", lambda file: file.write_text(page(picture(), factor=1.26)), "1.26"),
    ("8_report.html", lambda file: file.write_text(page(picture(spot=True))), "something else"),
    ("8_report.html", lambda file: file.write_text(page(picture()).replace("draw", "send")),
     "send"),
    ("8_signoff.pdf", lambda file: file.write_bytes(b"%PDF-1.7 other"), "is not the file"),
    ("corners.json", replaced(r'("demand": )([\d.]+)', lambda m: moved(m, 0.1)), "demand ="),
    ("corners.json", replaced(r"()rpm", lambda m: "rpm, approved"), "note ="),
)  # fmt: skip


@pytest.mark.parametrize(("name", "forge", "words"), FORGED)
def test_a_forgery_of_any_kind_is_found(
    honest: tuple[Path, Path], tmp_path: Path, name: str, forge: Forgery, words: str
) -> None:
    stored, again = honest
    file = tmp_path / name
    file.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(stored / name, file)
    forge(file)
    ((found, how),) = file_differences(tmp_path, again, [(name, classes_of(name, 1)[0].kind)])
    assert found == name
    assert re.search(words, how), how


def test_a_forgery_of_each_kind_is_tried() -> None:
    assert {classes_of(name, 1)[0].kind for name, _, _ in FORGED} == set(Kind)


def test_a_file_that_is_none_of_its_kind_is_found(
    honest: tuple[Path, Path], tmp_path: Path
) -> None:
    stored, again = honest
    for name, kind in kinds_in(stored).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(b"\x00\xff nothing")
        assert list(file_differences(tmp_path, again, [(name, kind)])), name


def test_counts_are_exact_and_numbers_up_to_round_off() -> None:
    one = {"count": 3, "passed": True, "note": "0 of 3, 1.5 mm", "contact_angle_deg": 359.9999}
    for changed in ({"count": 4}, {"passed": 1}, {"note": "0 of 4, 1.5 mm"}, {"note": "0 of 3"},
                    {"contact_angle_deg": 1.0}):  # fmt: skip
        assert len(list(record_differences(one | changed, one))) == 1, changed
    same = {"note": "0 of 3, 1.5000000000001 mm", "contact_angle_deg": 0.00001}
    assert list(record_differences(one | same, one)) == []


# --- classes


def test_every_file_of_a_run_has_one_class() -> None:
    """The names that the commands write, those of the report by its parts."""
    names = [
        "case.toml", "inputs/torque.csv", "1_torque.csv", "1_speed.csv", "corners.json", "run.json",
        "signoff.json", "signoff.intoto.jsonl", "trial_1/2_lift.csv", "trial_1/trial.json",
        "inspection/cycle.csv", "inspection/deviation.png", "exports/loads_090.000.inp",
        "fields/turn.npz", "8_live.json", "workshop/crown_roller.csv", "workshop/inspection.xlsx",
        *(f"workshop/{name}_outer.csv" for name in ("contour", "cutter", "inspection")),
        "trial_2/4_mesh.msh", "trial_2/5_cycle.xlsx",
        *(f"trial_2/{name}" for name in FILES.keys() - {"1_torque.csv", "1_speed.csv",
                                                        "corners.json"}),
        *(part.files.replace("*", "trial_2/5_cycle" if part.name == "tables" else "radii")
          for part in PARTS),
    ]  # fmt: skip
    for name in names:
        assert len(classes_of(name, 2)) == 1, name
    for name in ("workshop/cam2.step", "trial_2/x", "fields/a.py", "run.json/a", "figures/a.svg"):
        assert classes_of(name, 2) == (), name


def test_what_is_cut_opened_or_run_is_made_again_or_refused() -> None:
    """Only files of the search for the lift, of earlier trials, are listed as not compared."""
    of_search = {each.pattern for each in CLASSES if each.origin is Origin.SEARCH}
    assert of_search == {r"trial_N/2_limits\.csv", r"trial_(?!N/)\d+/[^/]+"}
    assert all(part.files for part in PARTS)


# --- cache


def test_what_is_computed_again_reads_no_entry_of_the_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path))
    monkeypatch.delenv(disk_cache.OFF, raising=False)

    def kept(value: float) -> float:
        arrays = disk_cache.kept("table", 1, lambda: {"value": np.array([value])}, (disk_cache,))
        return float(arrays["value"][0])

    assert (kept(1.0), kept(2.0)) == (1.0, 1.0)
    with disk_cache.left_out():
        assert kept(2.0) == 2.0
    assert kept(2.0) == 1.0
