"""`python -m validation`: pages and records in the given folder; a wrong name in one line."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from validation.__main__ import main

ROOT = Path(__file__).resolve().parents[2]
MECHANISMS = ROOT / "cases" / "papers" / "mechanisms.toml"


def test_values_are_written_with_their_page(tmp_path):
    folder = tmp_path / "new" / "place"
    done = subprocess.run(
        [sys.executable, "-m", "validation", "values", "--out", str(folder)], cwd=ROOT,
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    document = json.loads((folder / "values.json").read_text(encoding="utf-8"))
    assert len(document["rows"]) == 62
    assert "62 published values by basis:\n  independent: reproduced " in done.stdout
    text = (folder / "values.html").read_text(encoding="utf-8")
    assert text.count("<tr ") >= 62
    assert sorted(path.name for path in folder.iterdir()) == ["values.html", "values.json"]


def test_one_figure_is_written_with_its_data(capsys, tmp_path):
    folder = tmp_path / "new" / "place"
    assert main(["figures", "p15-cams", "--out", str(folder)]) == 0
    assert "figures: p15-cams" in capsys.readouterr().out
    assert sorted(path.name for path in folder.iterdir()) == ["figures.html", "figures.json"]
    document = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in document["figures"]] == ["p15-cams"]
    assert "<svg " in (folder / "figures.html").read_text(encoding="utf-8")


def test_mechanisms_are_printed_and_drawn(capsys, tmp_path):
    assert main(["mechanisms", str(MECHANISMS), "--out", str(tmp_path / "drawn")]) == 0
    assert "figures: energies.png, turn.png" in capsys.readouterr().out
    assert main(["mechanisms", str(MECHANISMS), "--out", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["case"] == "mechanisms"


def test_a_wrong_name_is_refused_in_one_line(capsys, tmp_path):
    assert main(["figures", "p16", "--out", str(tmp_path / "none")]) == 2
    errors = capsys.readouterr().err
    assert "validation: NAME = p16, must be a paper (C25, C24, P15, E24)" in errors
    assert errors.count("\n") == 1
    assert not (tmp_path / "none").exists()


def test_a_file_that_cannot_be_written_is_refused_in_one_line(capsys, tmp_path):
    (tmp_path / "file").write_text("")
    assert main(["figures", "p15-cams", "--out", str(tmp_path / "file" / "place")]) == 2
    assert "validation: " in capsys.readouterr().err.splitlines()[-1]


def test_an_unknown_command_ends_with_the_code_of_an_error(capsys):
    with pytest.raises(SystemExit) as leaving:
        main(["validate"])
    assert leaving.value.code == 2
