"""`python -m validation mechanisms`: prints, draws, refuses."""

import json
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from validation.mechanism_comparison import compared, lines, load_comparison
from validation.pages import mechanism_figures

ROOT = Path(__file__).resolve().parents[2]
CASE = ROOT / "cases" / "papers" / "mechanisms.toml"


@pytest.fixture(scope="module")
def document():
    return compared(CASE)


def test_prints_the_energies_and_the_slip_beside_them(document):
    text = "\n".join(lines(document))
    for figure in (
        "47.38", "44.31", "122.50", "153 of 153", "0.8 to 10.9 %", "4.6 to 65.2 %",
        "slipping at mu 0.2", "with an offset of 0.75 cranks",
    ):  # fmt: skip
        assert figure in text


def test_an_offset_never_pays_where_there_is_room_for_it(document):
    """Rods of 3.5 cranks and more leave room for an offset of 0.75: 7 ratios of 9, 17 cranks."""
    space = document["workspace"]
    for name in ("slider_crank", "big_roller", "small_roller"):
        offset = np.array(space[f"{name}_offset_above_best_percent"], dtype=float)
        assert np.isfinite(offset).sum() == 17 * 7
        assert np.isnan(offset[:, :2]).all()
        assert np.nanmin(offset) >= 0.0


def test_document_is_json(document):
    assert json.loads(json.dumps(document, allow_nan=False)) == document


def test_draws_both_workspaces_and_the_turn(document, tmp_path):
    drawn = mechanism_figures.draw(document, tmp_path)
    assert [path.stem for path in drawn] == [
        "energies", "turn", "workspace_slider_crank", "workspace_eccentric_cam",
    ]  # fmt: skip
    for path in drawn:
        assert path.read_bytes().startswith(b"\x89PNG")
        assert path.stat().st_size > 10_000


def test_decay_file_is_identified(tmp_path):
    time = np.linspace(0, 1.0, 100)
    speed = 40 * np.exp(-2.0 * time) - 3 + np.random.default_rng(2).normal(0, 0.01, 100)
    np.savetxt(tmp_path / "down.csv", np.column_stack([time, speed]), delimiter=",", header="t,w")
    path = tmp_path / "case.toml"
    extra = '\n[[decay]]\nname = "shaft"\nkind = "run_down"\nfile = "down.csv"\n'
    path.write_text(CASE.read_text() + extra + 'inertia = "0.075 kg m^2"\n')
    found = compared(path)["identified"][0]
    assert found["viscous_interval"][0] < 0.15 < found["viscous_interval"][1]
    assert found["coulomb_interval"][0] < 0.45 < found["coulomb_interval"][1]
    path.write_text(path.read_text().replace('"down.csv"', '"../down.csv"'))
    with pytest.raises(InputError, match=r"decay\.file"):
        compared(path)


def test_dry_friction_stands_besides(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE.read_text() + "\n[dry_friction]\nguide = 0.1\npins = 0.1\n")
    document = compared(path)
    assert all(found["dry_losses_J"]["guide"] > 0 for found in document["mechanisms"])
    assert "dry friction, additional" in "\n".join(lines(document))


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('crank = "20 mm"', 'crank = "0 mm"', "crank"),
        ('crank = "20 mm"', 'crank = "20"', "crank"),
        ('crank = "20 mm"', 'crunk = "20 mm"', "crunk"),
        ('speed = "37.219 rad/s"', 'speed = "-1 rad/s"', "speed"),
        ('preload = "59 N"', "", "preload"),
        ('name = "mechanisms"', "name = ", "case"),
    ],
)
def test_bad_case_is_refused_in_one_line(tmp_path, old, new, field):
    text = CASE.read_text()
    assert text.count(old) == 1
    path = tmp_path / "bad.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=field) as caught:
        load_comparison(path)
    assert "\n" not in str(caught.value)


def test_linkage_that_cannot_turn_is_refused(tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text(CASE.read_text().replace('rod = "80 mm" ', 'rod = "20 mm" '))
    with pytest.raises(InputError, match=r"mechanism\.rod"):
        compared(path)


def test_missing_case_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"none\.toml = No such file .* a readable TOML file"):
        load_comparison(tmp_path / "none.toml")
