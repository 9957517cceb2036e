"""Rows of the valve cams and of the eccentric cam, as `python -m validation values` tells them."""

import pytest

from validation import petrescu_2015, slider_crank_2024
from validation.published_figures import targets


@pytest.fixture(scope="module")
def outcomes():
    return {
        **petrescu_2015.study(targets("P15")).outcomes,
        **slider_crank_2024.study(targets("E24")).outcomes,
    }


def test_every_row_has_an_outcome(outcomes):
    assert set(outcomes) == set(targets("P15")) | set(targets("E24"))
    assert all(outcome.reason for outcome in outcomes.values())


def test_printed_yields_are_not_reproduced_and_the_page_says_why(outcomes):
    indices = [0.2136, 0.2183, 0.2075, 0.1843]
    for number, index in enumerate(indices, start=1):
        found = outcomes[f"P15-{number:02d}"]
        assert found.obtained == index
        assert found.verdict == "not reproduced"
        assert "it never passes 0." in found.reason


def test_energies_and_trends_are_reproduced(outcomes):
    open_rows = {"E24-10", "E24-12", "E24-13", "E24-19"}
    for row in targets("E24"):
        wanted = "not decidable" if row in open_rows else "reproduced"
        assert outcomes[row].verdict == wanted, row
    assert targets("E24")["E24-01"].basis == "fitted"


def test_slip_stands_beside_rolling():
    rows = slider_crank_2024.study(targets("E24")).studies["energy of a turn by pair, J"]
    names = [row["mechanism"] for row in rows]
    assert "small roller, no slip" in names
    assert "small roller, slipping at mu 0.2" in names


def test_index_stands_beside_the_true_efficiency():
    studies = petrescu_2015.study(targets("P15")).studies
    name = next(name for name in studies if "true efficiency" in name)
    assert [row["undercut"] for row in studies[name]] == [False, False, True, True]
    assert all(row["true_efficiency_of_rise"] > 0.8 for row in studies[name])
    assert any("reconstructed" in name for name in studies)
