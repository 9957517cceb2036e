"""Sizes and remedies of cams that pull: the smallest that pass, and what is not sought."""

from pathlib import Path

import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.preview import preview_case
from camwright.pipeline.search.remedies.remedy_search import remedies_of
from camwright.pipeline.search.sizes.open_case import parse_open_case
from camwright.pipeline.search.sizes.sizing import sized

ROOT = Path(__file__).parents[2]
GROOVE = ROOT / "cases" / "motions" / "feeder-groove.toml"
DATA = ROOT / "tests" / "data"


def statuses(text):
    return {each.id: each.status for each in preview_case(parse_case(text), corners=False).checks}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "governs"),
    [(GROOVE, "curvature_ratio"), (DATA / "yoke_pump.toml", "minimum_wall")],
)
def test_the_prime_radius_is_the_smallest_that_passes(file, governs):
    """A tenth of a millimetre less fails the check that governs."""
    text = file.read_text(encoding="utf-8")
    best = sized(parse_open_case(text, free=("cam.prime_radius",)))
    assert best.verdict == "pass" and best.others == ()
    assert not {each.id for each in best.checks} & {"jump", "spring_travel"}
    value, offset = (best.values[f"cam.{key}"] for key in ("prime_radius", "offset"))
    assert offset == 0.0
    stated = next(row for row in text.splitlines() if row.startswith("prime_radius"))
    smaller = text.replace(stated, f'prime_radius = "{1e3 * value - 0.1:.4f} mm"')
    assert statuses(smaller)[governs] == "fail"


def test_sizes_of_two_discs_are_refused():
    text = (DATA / "conjugate_arm.toml").read_text(encoding="utf-8")
    with pytest.raises(InputError, match=r"cam\.closure = conjugate, must be .* for sizes"):
        parse_open_case(text, free=("cam.prime_radius",))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "old", "new", "check", "key"),
    [
        (GROOVE, 'landing_speed = "50', 'landing_speed = "30',
         "landing_speed", "cam.groove.clearance"),
        (GROOVE, 'clearance = "0.02', 'clearance = "0.006',
         "groove_clearance", "cam.groove.clearance"),
        (DATA / "preloaded_arm.toml", 'interference = "0.02', 'interference = "0.009',
         "preload_least", "cam.conjugate.interference"),
        (DATA / "preloaded_feeder.toml", 'interference = "0.013', 'interference = "0.0075',
         "preload_least", "cam.conjugate.interference"),
    ],
)  # fmt: skip
def test_a_remedy_names_the_key_and_holds(file, old, new, check, key):
    """The changed case passes the check at every tolerance corner."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    trial = preview_case(parse_case(text.replace(old, new)))
    remedy = remedies_of(trial)[check]
    ((changed, value),) = remedy.change.values
    assert remedy.cures and changed == key
    cured = preview_case(with_values(trial.case, {key: value}))
    assert next(each for each in cured.checks if each.id == check).status == "pass"
