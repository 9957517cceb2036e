"""`camwright design crown`: least crown of a case, its text, drop table, record and picture."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from record_validation import schema_errors

import camwright as cw
from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machine
from camwright.pipeline.cli import run_line
from camwright.pipeline.commands.crown_command import CrownOptions, crown
from camwright.pipeline.commands.terminal import PASSED

GX120 = Path(__file__).parents[2] / "cases" / "gx120.toml"


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "ratio"), [("circular", 1.35), ("table", 1.3)])
def test_a_pasted_crown_is_that_of_the_drop_table(kind, ratio, tmp_path, capsys):
    out = tmp_path / "crown"
    assert crown(GX120, options=CrownOptions(ratio, kind=kind), out=out, as_json=True) == PASSED
    record = json.loads(capsys.readouterr().out)
    assert json.loads((out / "crown.json").read_text()) == record
    assert schema_errors("crown", record) == []
    assert record["ratio"] <= ratio < record["ratio_straight"]
    assert record["centre"]["crowned"] > record["centre"]["straight"]
    ratios = [each["ratio"] for each in record["tilt"]]
    # A circular crown lets the contact move along it: light moments change next to nothing.
    assert ratios[-1] > 1.05 * ratios[0] and (np.diff(ratios) >= -1e-3 * ratios[0]).all()
    assert max(each["ratio"] for each in record["tolerance"]) > record["ratio"]
    assert (out / "crown.png").stat().st_size > 10_000

    text = GX120.read_text(encoding="utf-8") + "\n" + (out / "crown.toml").read_text()
    for file in GX120.parent.iterdir():
        if file.is_file():
            (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "crown_drop.csv").write_bytes((out / "crown_drop.csv").read_bytes())
    case = parse_case(text, tmp_path)
    (pair,) = machine(case, case.load_cases[0]).finite_pairs
    rows = read_table(out / "crown_drop.csv")
    drop = pair.crown.drop(1e-3 * rows["y_mm"])
    np.testing.assert_allclose(1e6 * drop, rows["drop_um"], atol=1e-3)
    assert (rows["drop_max_um"] >= rows["drop_um"]).all()
    assert (rows["drop_um"] >= rows["drop_min_um"]).all()
    ends = [record[name]["drop_at_ends_um"] for name in ("lightest", "heaviest")]
    assert record["crown"]["drop_at_ends_um"] == pytest.approx(sum(ends) / 2, rel=0.02)


@pytest.mark.parametrize(
    "options",
    [
        ("--kind", "parabolic"),
        ("--tolerance", "-1 um"),
        ("--ratio", "0"),
    ],
)
def test_bad_options_are_named_as_typed(options):
    with pytest.raises(InputError) as refused:
        run_line(["design", "crown", str(GX120), *options])
    assert (refused.value.field, refused.value.value) == options
    if options[0] == "--kind":
        assert "johns_gohar" in refused.value.limit


def test_a_folder_with_files_is_not_overwritten(tmp_path):
    (tmp_path / "kept").touch()
    with pytest.raises(ResultError, match="not overwritten"):
        crown(GX120, options=CrownOptions(), out=tmp_path)


def test_the_body_is_one_of_the_case():
    with pytest.raises(InputError, match="cam or roller"):
        cw.crown(cw.read_case(GX120), on="face")


def test_a_case_without_an_end_is_refused():
    case = cw.read_case(GX120)
    without = case.model_copy(update={"cam": replace(case.cam, end=None)})
    with pytest.raises(InputError, match=r"cam\.end"):
        cw.crown(without)
