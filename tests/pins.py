"""Pinned figures of the shipped cases: checks, screened designs, gradients, synthesised cams.

`make pins` writes them again: a change of them is to be explained. Figures of drawn cams are held
to 1e-12, of synthesised ones to 1e-9, error bars to 1e-6, texts exactly; the cam angle of an
extreme, which follows round-off on a plateau, not at all, nor the numbers of its formula, which the
hand-check sheets hold.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

TESTS = Path(__file__).parent
sys.path[:0] = [str(TESTS), str(TESTS / "verification"), str(TESTS / "unit")]

import made_trial as made  # noqa: E402
from clamped_case import read_clamped  # noqa: E402
from synthesis_problems import described, with_corrections  # noqa: E402
from test_part_constraints_agree import random_cam  # noqa: E402
from test_screening import POSITIONS, drawn, stated  # noqa: E402

from camwright.geometry.arrays import uniform_turn  # noqa: E402
from camwright.geometry.contour import Contour  # noqa: E402
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour  # noqa: E402
from camwright.pipeline.case.case import Case  # noqa: E402
from camwright.pipeline.case.case_file import read_case  # noqa: E402
from camwright.pipeline.case.load_case_torque import engine_torques  # noqa: E402
from camwright.pipeline.checks.registry import all_checks  # noqa: E402
from camwright.pipeline.contact.tiers import Tier  # noqa: E402
from camwright.pipeline.cycle.solution import solution  # noqa: E402
from camwright.pipeline.preview import preview_case  # noqa: E402
from camwright.pipeline.screening.design_screening import screen_designs  # noqa: E402
from camwright.pipeline.smoothing.cam_state import loaded  # noqa: E402
from camwright.pipeline.smoothing.constraints import (  # noqa: E402
    shape_utilisations,
    utilisations_of,
)
from camwright.pipeline.smoothing.gradients import Point, differentiated  # noqa: E402
from camwright.pipeline.smoothing.problem_setup import problem_of  # noqa: E402
from camwright.pipeline.smoothing.required_lift import cam_lift  # noqa: E402
from camwright.pipeline.smoothing.sampled_problem import Search  # noqa: E402

CASES = TESTS.parent / "cases"
STORED = TESTS / "data" / "pins"
TEXTS = STORED / "texts.json"
DRAWN = (
    "gx120", "gx120-loads", "papers/c24_idle800", "papers/c25_half_torque", "papers/c25_preload",
    "papers/eccentric", "papers/petrescu_b1", "papers/petrescu_b2", "papers/petrescu_b3",
    "papers/petrescu_b4", "papers/petrescu_c",
)  # fmt: skip
CONSTRAINED = ("gx120-redesign", "gx120-flat-face")
MADE = ("every_part", "every_part hollow", "every_part face")
SCREENED = ("gx120", "papers/petrescu_c", *CONSTRAINED)
DESIGNS = 50
NOT_PINNED = ("cam_angle_deg", "stated")
TIGHT, LOOSE, ERRORS = 1e-12, 1e-9, 1e-6
Json = Any


def records(case: Case, contour: Contour, **how: Any) -> Json:
    """Records of the checks of a preview, and what differs from them in a screening."""
    how = {"torques": engine_torques(case)} | how
    both = {
        tier: {
            each.id: {key: value for key, value in each.as_record().items()
                      if value not in (None, "", [], False) and key not in NOT_PINNED}
            for each in all_checks(solution(case, contour, tier, **how))
        }
        for tier in (Tier.PREVIEW, Tier.SCREENING)
    }  # fmt: skip
    preview, screening = both.values()
    other = {}
    for name, record in screening.items():
        at_preview = preview.get(name, {})
        own = {key: record.get(key) for key in sorted(record.keys() | at_preview.keys())
               if record.get(key) != at_preview.get(key) and key != "method"}  # fmt: skip
        if own:
            other[name] = own
    return {"preview": preview, "screening": other, "screened": sorted(screening)}


def of_a_drawn_cam(name: str) -> Json:
    """Checks of the cam of a shipped case without synthesis."""
    case = read_case(CASES / f"{name}.toml")
    torques = engine_torques(case)
    return records(case, case.contour(cam_lift(case, torques)), torques=torques, positions=180)


def of_a_stated_cam(name: str) -> Json:
    """Checks of a stated cam in the machine of a synthesised case."""
    case = read_case(CASES / f"{name}.toml")
    contour: Contour = random_cam(case, 0) if case.follower.face is None else None
    if contour is None:
        lift = random_cam(read_case(CASES / "gx120-redesign.toml"), 0).lift
        contour = FlatFaceContour(FacePath(lift, case.cam.prime_radius, case.cam.offset))
    return records(case, contour, positions=120)


def of_a_made_cam(name: str) -> Json:
    """Checks of the machine with every part."""
    if name.endswith("face"):
        return records(made.face_case(), made.face_contour(), torques={}, positions=72)
    contour = made.hollow() if name.endswith("hollow") else made.contour()
    return records(made.case(), contour, positions=72)


def of_designs(name: str, count: int = DESIGNS) -> Json:
    """Columns of random designs about a shipped case."""
    factors = drawn(name, count, ("guides.spacing",))
    columns = screen_designs(stated(name), factors, positions=POSITIONS.get(name, 180))
    return {key: [_plain(each) for each in values] for key, values in columns.items()}


def _plain(value: Any) -> Json:
    return value if isinstance(value, str) else float(value)


def of_gradients(name: str) -> Json:
    """Utilisations and derivatives of a synthesis at its start, along random directions."""
    case = read_clamped(CASES / f"{name}.toml")
    smoothing = case.smoothing.model_copy(update={"corners": True})
    case = case.model_copy(update={"smoothing": smoothing})
    problem = problem_of(case, engine_torques(case))
    if case.follower.face is None:
        problem = described(problem)
    problem = with_corrections(problem, 3)
    search, variables, ratings = Search(problem), problem.variables, problem.ratings
    stack = search.stack(search.turn, variables)
    at = Point(search.turn.energy(search.start), search.highest(search.start, variables), variables)
    functions: dict[str, Callable[..., Any]] = {
        "shape": lambda jet, _, v: shape_utilisations(jet, v, ratings),
        "loads": lambda jet, top, v: utilisations_of(loaded(jet, top, v, ratings, stack)),
    }
    found: dict[str, Json] = {}
    for function in functions.values():
        for limit, each in differentiated(function, at, True).items():
            draw = np.random.default_rng(7)
            parts = {"terms": each.terms, "local": each.local, "shared": each.shared}
            found[limit] = {key: _projected(draw, part) for key, part in parts.items()}
            if each.mean is not None:
                found[limit]["mean"] = np.ravel(each.mean.value).tolist()
    return found


def _projected(draw: np.random.Generator, values: np.ndarray) -> list[float]:
    """Root mean square, and three random projections over the root of the number of values."""
    flat, size = np.ravel(values), math.sqrt(values.size)
    own = [float(draw.normal(size=flat.size) @ flat) / size for _ in range(3)]
    return [float(np.linalg.norm(flat)) / size, *own]


def of_a_synthesised_cam(name: str) -> Json:
    """Checks of the synthesised cam of a shipped case, its lift, mm, and its variables."""
    trial = preview_case(read_case(CASES / f"{name}.toml"), corners=False)
    found = records(trial.case, trial.contour, positions=180)
    case = trial.case
    return found | {
        "lift": (1e3 * trial.contour.pitch.lift(0.1 + uniform_turn(24))).tolist(),
        "drawn": [case.spring.rate, case.spring.preload, case.cam.prime_radius],
        "utilisations": {key: float(value) for key, value in _uses(trial.synthesis)},
    }


def _uses(record: Any) -> Iterator[tuple[str, float]]:
    for key, value in sorted(dict(record).items()):
        if isinstance(value, int | float) and not isinstance(value, bool):
            yield key, value


PINS: Mapping[str, Callable[[], Json]] = {
    **{f"checks/{name}": lambda name=name: of_a_drawn_cam(name) for name in DRAWN},
    **{f"checks/{name} stated": lambda name=name: of_a_stated_cam(name) for name in CONSTRAINED},
    **{f"checks/{name}": lambda name=name: of_a_made_cam(name) for name in MADE},
    **{f"designs/{name}": lambda name=name: of_designs(name) for name in SCREENED},
    **{f"gradients/{name}": lambda name=name: of_gradients(name) for name in CONSTRAINED},
    **{f"synthesis/{name}": lambda name=name: of_a_synthesised_cam(name) for name in CONSTRAINED},
}
SYNTHESISED = tuple(name for name in PINS if name.startswith("synthesis") or (
    name.startswith("designs") and name.split("/", 1)[1] in CONSTRAINED))  # fmt: skip
QUICK = (
    "checks/gx120", "checks/papers/petrescu_c", *(f"checks/{name} stated" for name in CONSTRAINED),
    *(f"checks/{name}" for name in MADE), *(f"gradients/{name}" for name in CONSTRAINED),
)  # fmt: skip
"""Pins of a few seconds, compared on every change; the others are slow."""


def path_of(name: str) -> Path:
    return STORED / f"{name.replace('/', '-').replace(' ', '-')}.json"


def _pooled(value: Json, pool: dict[str, str]) -> Json:
    """A value with each long text by its key in a pool."""
    if isinstance(value, dict):
        return {key: _pooled(each, pool) for key, each in value.items()}
    if isinstance(value, list):
        return [_pooled(each, pool) for each in value]
    if not isinstance(value, str) or len(value) < 24:
        return value
    key = "#" + hashlib.sha256(value.encode()).hexdigest()[:8]
    pool[key] = value
    return key


def differences(name: str) -> list[str]:
    """What differs between a pin and what is computed now."""
    tolerance = LOOSE if name in SYNTHESISED else TIGHT
    stored = json.loads(path_of(name).read_text(encoding="utf-8"))
    texts = json.loads(TEXTS.read_text(encoding="utf-8"))
    now = json.loads(json.dumps(_pooled(PINS[name](), texts)))
    lines = _differing(now, stored, tolerance, "", 0.0)
    return [re.sub("#[0-9a-f]{8}", lambda key: texts.get(key[0], key[0]), line) for line in lines]


def _differing(
    now: Json, stored: Json, tolerance: float, where: str, scale: float
) -> Iterator[str]:
    if isinstance(now, dict) and isinstance(stored, dict):
        evidence = bool(stored.get("evidence", now.get("evidence")))
        least = max((abs(stored.get(key) or 0.0) for key in ("demand", "limit")
                     if not isinstance(stored.get(key), list | dict)), default=0.0)  # fmt: skip
        for key in sorted(now.keys() | stored.keys()):
            own = ERRORS if key == "error" or evidence else tolerance
            size = 1.0 if evidence and key in ("utilisation", "margin") else least
            path = f"{where}.{key}"
            yield from _differing(now.get(key), stored.get(key), own, path, size)
    elif isinstance(now, list) and isinstance(stored, list) and len(now) == len(stored):
        floats = [abs(each) for each in stored if isinstance(each, float) and math.isfinite(each)]
        size = floats[0] if where.startswith(".") and floats and len(floats) == 4 else 0.0
        for k, pair in enumerate(zip(now, stored, strict=True)):
            yield from _differing(*pair, tolerance, f"{where}[{k}]", size)
    elif isinstance(now, float) and isinstance(stored, float):
        same = now == stored or (math.isnan(now) and math.isnan(stored))
        if not same and not abs(now - stored) <= tolerance * max(abs(now), abs(stored), scale):
            yield f"{where}: {stored!r} -> {now!r}"
    elif now != stored:
        yield f"{where}: {stored!r} -> {now!r}"


def write(names: list[str]) -> None:
    STORED.mkdir(exist_ok=True)
    texts = json.loads(TEXTS.read_text(encoding="utf-8")) if names and TEXTS.exists() else {}
    for name in names or list(PINS):
        own = {key: _lines(each) for key, each in _pooled(PINS[name](), texts).items()}
        lines = ",\n".join(f"{json.dumps(key)}: {text}" for key, text in own.items())
        path_of(name).write_text(f"{{{lines}}}\n", encoding="utf-8")
        print(f"{name}: {path_of(name).stat().st_size} bytes", flush=True)
    TEXTS.write_text(json.dumps(texts, indent=0, sort_keys=True) + "\n", encoding="utf-8")


def _lines(value: Json) -> str:
    """A table of tables with a line each, anything else on one line."""
    if isinstance(value, dict) and any(isinstance(each, dict) for each in value.values()):
        each = (f" {json.dumps(key)}: {json.dumps(one)}" for key, one in value.items())
        return "{\n" + ",\n".join(each) + "}"
    return json.dumps(value)


if __name__ == "__main__":
    write(sys.argv[1:])
