"""Cam of a constrained synthesis in the disk cache, read by a preview of the same case."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from camwright.pipeline import preview
from camwright.pipeline.base import disk_cache
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.results.trial import CONSTRAINED, Trial

CASES = Path(__file__).parents[2] / "cases"
GX120 = (CASES / "gx120.toml").read_text(encoding="utf-8")
RECORD = {
    "feasible": True,
    "ripple_left": 1 / 3,
    "starts": None,
    "prices": [{"value": float("inf")}],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of the syntheses alone: the tables of the contact are those of other tests."""
    monkeypatch.delenv(disk_cache.OFF, raising=False)

    def kept(*arguments: Any) -> disk_cache.Arrays:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv(disk_cache.FOLDER, str(tmp_path))
            return disk_cache.kept(*arguments)

    monkeypatch.setattr(preview, "disk_cache", SimpleNamespace(kept=kept))
    return tmp_path


@pytest.fixture(scope="module")
def case() -> Case:
    text = GX120.replace('kind = "moving_average"', 'kind = "constrained"')
    return parse_case(text).with_positions(72)


@pytest.fixture(scope="module")
def drawn(case: Case) -> Trial:
    """Trial of a cam, as if drawn by a synthesis."""
    averaged = preview.preview_case(parse_case(GX120).with_positions(72), corners=False)
    lift = averaged.contour.pitch.lift
    solved = preview._solved(case, lift, 1e-7, engine_torques(case), preview.SILENT)
    return preview._trial_of(solved, RECORD, preview.SILENT)


@pytest.fixture
def previewed(
    folder: Path, case: Case, drawn: Trial, monkeypatch: pytest.MonkeyPatch
) -> tuple[Callable[..., Trial], list[Case]]:
    """Preview of a case with the cache, and the cases of which a cam is drawn."""
    syntheses: list[Case] = []

    def synthesised(case: Case, *_: Any) -> Trial:
        syntheses.append(case)
        return drawn

    monkeypatch.setattr(preview, "_synthesised", synthesised)

    def of(case: Case = case, *, kept: bool = True) -> Trial:
        return preview.preview_case(case, corners=False, kept=kept)

    assert of() is drawn and len(syntheses) == 1 and len(list(folder.iterdir())) == 1
    return of, syntheses


def records(trial: Trial) -> str:
    """Checks and synthesis to the last bit, as they are written."""
    return json.dumps([*(each.as_record() for each in trial.checks), trial.synthesis])


def test_the_kept_cam_has_the_same_numbers(previewed, drawn: Trial) -> None:
    of, syntheses = previewed
    again = of()
    assert again is not drawn and len(syntheses) == 1
    assert records(again) == records(drawn)
    assert again.smoothing == CONSTRAINED
    assert again.case.sha256 == drawn.case.sha256
    assert again.solution.synthesis_gain == drawn.solution.synthesis_gain == 1e-7
    np.testing.assert_array_equal(again.contour.pitch.lift.values, drawn.contour.pitch.lift.values)


def test_another_case_or_program_has_another_cam(
    previewed, case: Case, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    of, syntheses = previewed
    of(with_values(case, {"spring.preload": 1.01 * case.spring.preload}))
    of(case.with_positions(90))
    monkeypatch.setattr(preview, "versions", lambda: {"source": "another"})
    of()
    assert len(syntheses) == 4 == len(list(folder.iterdir()))


def test_a_damaged_entry_is_written_again(previewed, folder: Path) -> None:
    of, syntheses = previewed
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[:-200])
    of()
    assert len(syntheses) == 2 and path.read_bytes() == whole


def test_no_other_preview_reads_it(previewed) -> None:
    of, syntheses = previewed
    of(kept=False)
    assert len(syntheses) == 2


@pytest.mark.slow
def test_a_synthesis_is_kept_to_the_last_bit(folder: Path) -> None:
    case = read_case(CASES / "machines" / "two-stroke.toml").with_positions(72)
    first, second = (preview.preview_case(case, kept=True) for _ in range(2))
    assert len(list(folder.glob("synthesis-*"))) == 1 and second is not first
    assert records(second) == records(first)
    assert second.synthesis is not None and second.synthesis["feasible"]
