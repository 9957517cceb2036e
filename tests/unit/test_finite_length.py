"""`contact cylinders` with lengths: options, document, text, field; both tiers at coarse cells."""

from functools import partial

import numpy as np
import pytest

from camwright.geometry.errors import CamError, ContactError, InputError
from camwright.pipeline.contact.finite_length.axial_drop import iso16281
from camwright.pipeline.contact.finite_length.length_tiers import both_tiers
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes
from camwright.pipeline.studies import finite_length_document
from camwright.pipeline.studies.finite_length_document import LengthOptions
from camwright.pipeline.studies.two_cylinders_document import ContactOptions, lines, solved

COARSE = CellSizes(per_half_width=4.0, at_end=40e-6, uniform=2, growth=2.0)
FACTORS = ("centre", "greatest", "end1_mean", "end2_mean")


def options(line_load="200", load=None, width=None, depths=("2", "2"), **lengths):
    both = {"length1": "2", "length2": "2"} | lengths
    return ContactOptions(
        *("8", "20", "210 GPa", 0.3, None, None, line_load, load, width),
        depth1=depths[0],
        depth2=depths[1],
        lengths=LengthOptions(**both),
    )


@pytest.fixture
def coarse(monkeypatch):
    monkeypatch.setattr(finite_length_document, "both_tiers", partial(both_tiers, sizes=COARSE))


def test_document_text_and_field_of_a_tilted_contact(coarse, tmp_path):
    path = tmp_path / "pressure.vtu"
    document = solved(options(tilt="0.5"), field=path)
    half_space, blocks = document["finite_length"]
    assert [half_space["tier"], blocks["tier"]] == ["half_space", "finite_elements"]
    for record in (half_space, blocks):
        assert record["mean_length_mm"] == pytest.approx(0.1)
        assert record["end2_mean"] > record["end1_mean"]
        assert all(0.3 < record[name] <= record["greatest"] for name in FACTORS)
        for body in (1, 2):
            stress = record[f"stress_body{body}"]
            # Between those of a line and of a point contact, over the pressure above it.
            assert 0.5 < stress["centre"]["von_mises"] / record["centre"] < 0.65
            assert 0.28 < stress["centre"]["shear"] / record["centre"] < 0.35
            assert stress["end2"]["von_mises"] > stress["end1"]["von_mises"]
        assert record["residual"] < 1e-10
    assert blocks["tilt_mrad"] == pytest.approx(0.5)
    assert blocks["moment_Nmm"] == pytest.approx(half_space["moment_Nmm"], rel=1e-9) != 0
    assert half_space["centre"] == pytest.approx(blocks["centre"], abs=0.02)
    text = "\n".join(lines(document))
    assert "over plane strain" in text
    assert "tilt of the bases 0.5 mrad" in text

    import pyvista

    grid = pyvista.read(path)
    for tier in ("half_space", "finite_elements"):
        pressure = grid.cell_data[f"pressure_{tier}_MPa"]
        sizes = grid.compute_cell_sizes().cell_data["Area"]
        assert pressure @ sizes == pytest.approx(400.0, rel=1e-6)


def test_a_force_is_that_of_the_whole_contact(coarse):
    by_load = solved(options(line_load=None, load="400", end1="chamfer:0.2"))
    assert by_load["line_load_N_per_mm"] == pytest.approx(250.0)
    record = by_load["finite_length"][1]
    assert record["greatest_is_singular"]
    assert record["greatest_error_percent"] is None
    assert "it grows with the mesh" in "\n".join(lines(by_load))
    np.testing.assert_allclose(record["end1_mean"], record["end2_mean"], rtol=1e-9)


def test_a_rounded_end_has_a_bounded_peak(coarse):
    finite = options(end1="radius:0.1").lengths.finite_pair(options().pair(), (2e-3, 2e-3))
    assert not finite.has_singular_end
    assert finite.contact_length == pytest.approx(1.8e-3)
    beyond = np.array([0.0, 0.9e-3, 0.95e-3, 1.0e-3])
    np.testing.assert_allclose(
        finite.gap(0.0 * beyond, beyond), [0, 0, 0.1e-3 - np.sqrt(0.1**2 - 0.05**2) * 1e-3, 0.1e-3]
    )


@pytest.mark.parametrize(
    ("crown", "drop"),
    [
        # A = w/(pi E*) = 0.5517 um at 200 N/mm; b = 0.1123 mm.
        ("lundberg:200", 0.5517e-6 * np.log(1 / (1 - 0.64))),
        ("johns-gohar:200 N/mm", 0.5517e-6 * np.log(1 / (1 - (1 - 0.3033 * 0.1123) * 0.64))),
        ("iso16281", 0.00035 * 16e-3 * np.log(1 / (1 - 0.64))),
        ("circular:500", 0.8e-3**2 / (2 * 500e-3)),
    ],
)
def test_crowns(crown, drop):
    finite = options(crown=crown).lengths.finite_pair(options().pair(), (2e-3, 2e-3))
    np.testing.assert_allclose(finite.crown.drop(np.array([0.0, -0.8e-3])), [0, drop], rtol=2e-4)


def test_a_long_roller_is_crowned_at_its_ends_alone():
    shape = iso16281(10e-3, 40e-3)
    y = np.array([0.0, 7.5e-3, 13.75e-3])
    expected = [0, 0, 0.0005 * 10e-3 * np.log(1 / (1 - 0.25))]
    np.testing.assert_allclose(shape.drop(y), expected, atol=1e-12)


def test_table_of_drop(tmp_path):
    path = tmp_path / "drop.csv"
    path.write_text("y_mm,drop_um\n0,0\n0.5,0\n1,4\n")
    finite = options(crown=str(path)).lengths.finite_pair(options().pair(), (2e-3, 2e-3))
    np.testing.assert_allclose(finite.crown.drop(np.array([-0.75e-3, 0.2e-3])), [2e-6, 0])
    for text in (
        "y_mm\n0\n",
        "y_mm,drop_um\n0,0\n0,1\n",
        "y_mm,drop_um\n0,0\n1,x\n",
        "y_mm,drop_um\n0,0\n1,2e3\n",
    ):
        path.write_text(text)
        with pytest.raises(CamError, match="drop"):
            options(crown=str(path)).lengths.finite_pair(options().pair(), (2e-3, 2e-3))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"length2": None}, "--length2 = missing"),
        ({"length1": "-3"}, "--length1 = -3"),
        ({"length1": "nan"}, "--length1"),
        ({"end1": "round"}, "--end1 = round"),
        ({"end1": "chamfer"}, "--end1 = chamfer,"),
        ({"end2": "chamfer:1"}, "--end2 = 1 mm"),
        ({"end2": "radius:x"}, "--end2 = x"),
        ({"crown": "cube"}, "--crown = cube"),
        ({"crown": "circular:0"}, "--crown = 0"),
        ({"crown": "circular:0.9"}, "--crown: crown.radius"),
        ({"crown": "johns-gohar:1e9"}, "--crown"),
        ({"tilt": "1", "moment": "1"}, "--moment = 1"),
        ({"tilt": "1 mm"}, "--tilt = 1 mm"),
        ({"tilt": "1e300"}, "--tilt"),
        ({"line_load": "1e-9"}, "--depth1 or --depth2 = 2.111 mm"),
        ({"crown": "lundberg:1e300"}, "--crown"),
        ({"moment": "400"}, "--moment = 400 N mm"),
        ({"mean_length": "0"}, "--mean-length = 0"),
        ({"mean_length": "0.0199"}, "--mean-length = 0.0199 mm"),
        ({"mean_length": "2.01"}, "--mean-length = 2.01 mm"),
        ({"crown": "circular"}, "--crown = circular,"),
        ({"width": "2", "load": "100", "line_load": None}, "--width = 2"),
        ({"line_load": "0"}, "--line-load = 0"),
        ({"line_load": None}, "--line-load = missing"),
        ({"depths": ("0.1", None)}, "--depth1"),
    ],
)
def test_bad_options_are_named(change, field, coarse):
    with pytest.raises(InputError, match=field):
        solved(options(**change))


def test_a_mean_longer_than_the_contact_is_refused(coarse):
    with pytest.raises(ContactError, match="shorter than the length of the mean"):
        solved(options(mean_length="1.9", crown="circular:50"))
