"""First case of each kind: complete, within every limit by 5 % at the depth of a preview."""

import re

import numpy as np
import pytest

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.template import KINDS, first_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.preview import preview_case
from camwright.pipeline.solver import solve

LEAST_MARGIN = 0.05
MEASURED = ("table", "pressure", "speed", "voltage")
UNLIKE = {"table": 2e-4, "pressure": 0.03, "speed": 0.01, "voltage": 0.03}
"""Deviation of the torque from that of the model, rms over that of its ripple: three decimals of a
torque; a pressure knows no valve train; 20 harmonics of a speed; a voltage sampled at 20 kHz."""


def written(folder, kind):
    """The case of a kind at the fewest positions, its random corners left out."""
    first = first_case(kind, kind)
    (folder / f"{kind}.toml").write_text(first.text, encoding="utf-8")
    if first.data_name:
        (folder / first.data_name).write_text(first.data, encoding="utf-8")
    case = read_case(folder / f"{kind}.toml").with_positions(36)
    few = case.tolerances.model_copy(update={"samples": 0})
    return case.model_copy(update={"tolerances": few})


def holds(trial):
    """Whether each required check passes, those that a design can change by the least margin."""
    judged = [each for each in trial.checks if each.must_have and not each.judged_at]
    assert len(judged) > 60
    margins = {each.id: each.margin for each in judged if not each.evidence}
    assert not [each.id for each in judged if each.status != "pass"]
    assert all(margin is not None and margin >= LEAST_MARGIN for margin in margins.values())


@pytest.fixture(scope="module")
def balancing(tmp_path_factory):
    """Case of the cylinder model and its preview."""
    case = written(tmp_path_factory.mktemp("balancing"), "cylinder")
    return case, preview_case(case)


def test_the_cam_of_the_cylinder_model(balancing):
    case, trial = balancing
    holds(trial)
    assert not case.scope.not_covered and not case.waivers
    assert next(each for each in trial.checks if each.id == "torque_reduction").must_have


@pytest.mark.parametrize("kind", ["lift", "eccentric", "arm", "groove"])
def test_a_cam_without_engine(tmp_path, kind):
    case = written(tmp_path, kind)
    assert not case.scope.not_covered
    trial = preview_case(case)
    holds(trial)
    assert "torque_reduction" not in {each.id for each in trial.checks}


@pytest.mark.parametrize("kind", MEASURED)
def test_a_cam_in_the_measured_torque_of_the_model(tmp_path, balancing, kind):
    """Of the cam of the cylinder model; each kind is run with its own in the slow tests."""
    modelled, trial = balancing
    case = written(tmp_path, kind)
    torques = engine_torques(case)
    (name,) = torques
    expected = engine_torques(modelled)[name].without_mean().total
    deviation = torques[name].without_mean().total - expected
    assert np.std(deviation) < UNLIKE[kind] * np.std(expected)
    holds(solve(case, trial.contour, tier=Tier.PREVIEW, torques=torques, corners=False))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["torque", "harmonics", "compressor", "pump"])
def test_a_cam_of_another_machine(tmp_path, kind):
    case = written(tmp_path, kind)
    assert case.period.cycles == 1
    holds(preview_case(case))


def test_the_machine_is_the_same_in_each_kind(tmp_path):
    """But for the teeth of the pinion, which are those of the ratio, an arm and a groove."""
    cases = [written(tmp_path, kind) for kind in KINDS if kind not in ("arm", "groove")]
    for case in cases:
        gear = case.camshaft.gear
        assert gear.teeth == case.mechanism.gear_ratio * gear.pinion_teeth
    for part in ("spring", "cam", "camshaft", "roller", "follower", "guides", "materials"):
        texts = {re.sub(r"pinion_teeth=\d+", "", repr(getattr(case, part))) for case in cases}
        assert len(texts) == 1
