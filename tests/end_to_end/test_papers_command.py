"""The command `camwright papers`: page and data where asked for; a wrong name in one line."""

import json


def test_one_figure_is_written_with_its_data(command, tmp_path):
    folder = tmp_path / "new" / "place"
    code, out, errors = command("papers", "p15-cams", "--out", folder)
    assert code == 0, errors
    assert "figures: p15-cams" in out
    assert sorted(path.name for path in folder.iterdir()) == ["papers.html", "papers.json"]
    document = json.loads((folder / "papers.json").read_text(encoding="utf-8"))
    assert [one["name"] for one in document["figures"]] == ["p15-cams"]
    assert "<svg " in (folder / "papers.html").read_text(encoding="utf-8")


def test_a_wrong_name_is_refused_in_one_line(command, tmp_path):
    code, _, errors = command("papers", "p16", "--out", tmp_path / "none")
    assert code == 2
    assert "NAME = p16, must be a paper (C25, C24, P15, E24)" in errors
    assert errors.count("\n") == 1
    assert not (tmp_path / "none").exists()
