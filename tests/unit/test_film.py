"""Film thickness, lambda ratio, and the regression that refuses outside its range."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.oil_film import (
    LineFilm,
    Lubricant,
    entrainment_speed,
    lambda_ratio,
    minimum_film,
    mixed_film,
)

OIL = Lubricant(viscosity=0.03, pressure_viscosity=2e-8)
MODULUS = 115.4e9


def groups(load=1e5, radius=0.0065, speed=4.0, oil=OIL):
    return LineFilm.of(load, radius, MODULUS, speed, oil)


def test_groups_by_hand():
    film = groups()
    assert film.load == pytest.approx(1e5 / (2 * 115.4e9 * 0.0065))
    assert film.speed == pytest.approx(0.03 * 4 / (2 * 115.4e9 * 0.0065))
    assert film.material == pytest.approx(2e-8 * 2 * 115.4e9)


@pytest.mark.parametrize(
    ("at_40", "at_100"), [(32.0, 5.4), (150.0, 15.0), (460.0, 30.8)], ids=["32", "150", "460"]
)
def test_a_warmer_oil_is_that_of_its_card(at_40, at_100):
    """The viscosity at 40 degC leads to that at 100; its density of 870 kg/m3 is exact here."""
    slope = (np.log10(np.log10(at_40 + 0.7)) - np.log10(np.log10(at_100 + 0.7))) / np.log10(
        373.15 / 313.15
    )
    cold = Lubricant(
        viscosity=870e-6 * at_40, pressure_viscosity=2e-8, temperature=313.15, thinning=slope
    )
    assert cold.warmer(60.0).viscosity == pytest.approx(870e-6 * at_100, rel=1e-9)
    assert cold.warmer(0.0) is cold
    # the default is that of mineral oils of VG 32 to 460 within a tenth of its viscosity
    usual = replace(cold, thinning=3.6)
    assert usual.warmer(30.0).viscosity == pytest.approx(cold.warmer(30.0).viscosity, rel=0.15)
    assert replace(cold, temperature=None).warmer(60.0).viscosity == cold.viscosity


def test_dowson_higginson_by_hand():
    U, G, W = 8e-11, 4616.0, 6.7e-5
    film = LineFilm(np.array(W), np.array(U), G, np.array(0.0065))
    expected = 2.65 * U**0.7 * G**0.54 * W**-0.13 * 0.0065
    assert minimum_film(film) == pytest.approx(expected, rel=1e-12)
    assert 1e-7 < expected < 1e-6


@pytest.mark.parametrize(
    ("change", "power"),
    [
        ({"speed": 8.0}, 0.70),
        ({"load": 2e5}, -0.13),
        ({"oil": replace(OIL, pressure_viscosity=4e-8)}, 0.54),
    ],
)
def test_film_grows_by_its_powers(change, power):
    assert minimum_film(groups(**change)) / minimum_film(groups()) == pytest.approx(2**power)


def test_without_load_there_is_no_film_to_speak_of(recwarn):
    found = minimum_film(groups(load=np.array([0.0, 1e5])))
    assert np.isnan(found[0])
    assert found[1] > 0
    assert not recwarn.list


def test_at_rest_the_film_is_gone():
    assert minimum_film(groups(speed=0.0)) == 0


def test_slip_of_the_roller_slows_the_entrainment():
    assert entrainment_speed([4.0, -4.0], [1.0, 0.0]).tolist() == [3.5, 4.0]


def test_lambda_counts_both_roughnesses():
    assert lambda_ratio(1e-6, 3e-7, 4e-7) == pytest.approx(2.0)


@pytest.mark.parametrize(
    "bad",
    [{"load": -1.0}, {"radius": 0.0}, {"speed": np.nan}],
)
def test_groups_refuse(bad):
    with pytest.raises(InputError):
        groups(**bad)


@pytest.mark.parametrize(
    ("name", "value"),
    [("viscosity", 0.0), ("viscosity", -0.03), ("pressure_viscosity", np.nan)],
)
def test_lubricant_refuses(name, value):
    with pytest.raises(InputError, match=rf"lubricant\.{name}"):
        replace(OIL, **{name: value})


MIXED = {"W": 1e-4, "U": 2e-11, "G": 4500.0}


def mixed(roughness=1e-7, hardness=3e9, **changes):
    given = MIXED | changes
    load, speed, radius = (np.array([value]) for value in (given["W"], given["U"], 0.0065))
    return mixed_film(LineFilm(load, speed, given["G"], radius), roughness, hardness, MODULUS)


def test_the_regression_says_that_its_source_is_unverified():
    assert not mixed()[0].source.confirmed


def test_the_regression_within_its_range():
    found, words = mixed()
    assert words == ""
    assert found.central > found.minimum > 0
    assert 0 <= found.asperity_share <= 1
    smooth, rough = mixed(roughness=1e-9)[0], mixed(roughness=3e-7)[0]
    assert rough.asperity_share > smooth.asperity_share
    assert smooth.central == pytest.approx(
        2.691 * 1e-4**-0.135 * 2e-11**0.705 * 4500**0.556 * 0.0065, rel=1e-2
    )


@pytest.mark.parametrize(
    ("change", "group"),
    [
        ({"W": 1e-6}, "load"),
        ({"W": 1e-3}, "load"),
        ({"U": 5e-13}, "speed"),
        ({"U": 2e-10}, "speed"),
        ({"G": 1000.0}, "material"),
        ({"roughness": 1e-6}, "roughness"),
        ({"hardness": 1e8}, "hardness"),
        ({"W": np.nan}, "load"),
    ],
)
def test_the_regression_refuses_outside_its_range(change, group):
    found, words = mixed(**change)
    assert group in words
    assert np.isnan([found.minimum, found.central, found.asperity_share]).all()


def test_along_a_turn_the_regression_answers_where_it_holds_and_says_what_it_refused():
    """An unloaded position is no refusal; one out of range is NaN and named, the rest stand."""
    load = np.array([0.0, 1e-6, 1e-4, 2e-4])
    film = LineFilm(load, np.full(4, MIXED["U"]), MIXED["G"], np.full(4, 0.0065))
    found, words = mixed_film(film, 1e-7, 3e9, MODULUS)
    assert np.isnan(found.minimum[:2]).all()
    assert found.minimum[2] == mixed()[0].minimum
    assert found.minimum[3] == mixed(W=2e-4)[0].minimum
    assert words == "mixed film, load group = 1e-06, must be in [2e-05, 0.0005]"


def test_nothing_refused_is_nothing_said():
    film = LineFilm(np.array([0.0, 1e-4]), np.full(2, MIXED["U"]), MIXED["G"], np.full(2, 0.0065))
    _, words = mixed_film(film, 1e-7, 3e9, MODULUS)
    assert words == ""


def test_a_load_share_above_one_is_refused_though_every_group_is_within_range():
    film = LineFilm(np.array([2.7e-5]), np.array([1.5e-12]), 4600.0, np.array([0.0065]))
    found, words = mixed_film(film, 4.8e-5 * 0.0065, 0.0078 * 2 * MODULUS, MODULUS)
    assert np.isnan(found.minimum).all()
    assert "asperity load share" in words
