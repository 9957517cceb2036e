"""A sample of `make fuzz`: mutated input files are read, or refused in one line."""

from __future__ import annotations

import random
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from mutated_inputs import ROOT, ROUND, Source, cases, exchanged, sources, tried

from camwright.geometry.errors import CamError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, enter
from camwright.pipeline.studies.batch.study_file import Study
from camwright.pipeline.studies.cam_inspection import read_measured
from camwright.pipeline.torque.angle_trace import read_trace

HEAD = "crank_angle_deg,torque_Nm\n"


SLOW_SEEDS = [pytest.param(seed, marks=pytest.mark.slow) for seed in (12, 15)]
"""Of which more cases are solved, seconds each."""


@pytest.mark.parametrize("seed", [11, 13, 14, *SLOW_SEEDS])
def test_mutated_inputs_are_read_or_refused(seed: int) -> None:
    outcomes = list(tried(100, seed))
    assert not [each for each in outcomes if each.failed]
    words = {each.what for each in outcomes}
    assert words == {"read", "refused"}  # neither are all too far from an input, nor all too near


@pytest.mark.parametrize("path", cases(), ids=lambda path: path.stem)
def test_a_value_of_any_type_is_read_or_refused(path: Path) -> None:
    rng, tables = random.Random(path.stem), tomllib.loads(path.read_text(encoding="utf-8"))
    words = set()
    for _ in range(25):
        try:
            case_of(exchanged(tables, rng), path.parent)
            words.add("read")
        except CamError as error:
            words.add("refused" if str(error).strip() else "")
    assert "refused" in words <= {"read", "refused"}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("cam.material", {}),
        ("follower.arm.length", "1e300 mm"),
        ("follower.arm.length", "1e-300 mm"),
        ("follower.arm.inertia", "1e300 kg m^2"),
        ("follower.arm.inertia", "0 kg m^2"),
    ],
)
def test_values_from_which_others_follow_are_refused(key: str, value: object) -> None:
    tables = tomllib.loads((ROOT / "cases/motions/packaging-arm.toml").read_text(encoding="utf-8"))
    enter(tables, key, value)
    with pytest.raises(CamError, match=f"{key}.* = |follower.arm.inertia = .* over length squared"):
        case_of(tables, ROOT)


@pytest.mark.parametrize("source", sources(), ids=lambda source: source.name)
def test_inputs_without_a_mutation_are_read(source: Source, tmp_path: Path) -> None:
    """By the name in the file and the bytes of the data; the contour by its radii."""
    for name, content in source.files.items():
        (tmp_path / name).write_bytes(content)
    read = source.read(tmp_path / source.name)
    if isinstance(read, np.ndarray):
        radii = np.loadtxt(tmp_path / source.name, delimiter=",", skiprows=1)[:, 1]
        np.testing.assert_allclose(np.hypot(*read), radii / 1e3, rtol=1e-12)
        return
    assert isinstance(read, Case | Study)
    (stated,) = (content for name, content in source.files.items() if name.endswith(".toml"))
    assert read.name == tomllib.loads(stated.decode())["name"]
    if isinstance(read, Case):
        assert [*read.included.values()] == [
            content for name, content in source.files.items() if name.endswith(".csv")
        ]


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (HEAD + "1,2\n" * 1_000_001, "lines, must be 1000000 lines or fewer"),
        (HEAD + "0,1\n1,2\0\n", "a binary file"),
        (HEAD + "0,1\n1;2\n", "line 3 = 1 cells"),
        (HEAD + "0,1\n" + "1" * 300_000 + ",1\n", "line 3, crank_angle_deg = 111"),
        (HEAD + '0,1\n"' + "1" * 300_000 + '",2\n', "line 3, crank_angle_deg"),
        ("\ufeff" + HEAD + "0,1\n1,\n", "line 3, torque_Nm = nothing"),
    ],
    ids=["rows", "zero", "separator", "long", "quoted", "mark"],
)
def test_a_file_of_columns_names_line_and_column(content: str, named: str, tmp_path: Path) -> None:
    path = tmp_path / "torque.csv"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(CamError, match=named):
        read_trace(path)
    path.write_text(content.replace(HEAD, "x_mm,y_mm\n"), encoding="utf-8")
    measured = named.replace("torque_Nm", "y_mm").replace("crank_angle_deg", "x_mm")
    if "nothing" not in named:  # a row that was not measured
        with pytest.raises(CamError, match=measured):
            read_measured(path, ROUND)


def test_a_sheet_without_a_measured_row_names_its_empty_columns(tmp_path: Path) -> None:
    """As `camwright inspect` takes the sheet of a run before anybody has filled it."""
    sheet = tmp_path / "sheet.csv"
    sheet.write_text("measured_x_mm,measured_y_mm\n" + ",\n" * 20, encoding="utf-8")
    with pytest.raises(CamError, match=r"measured_x_mm, measured_y_mm = empty, must be measured"):
        read_measured(sheet, ROUND)
