"""CPU seconds of the first check of seeded variants: python benchmarks/variants.py [count] [first]

Each variant is a shipped machine with some values changed as a designer would: offset, sizes,
masses, speeds, spring, limits, crown, number of cam angles; one machine in ten has a flat face. It
is checked as a process with an empty cache. The values are drawn by the seed alone, so that two
versions compare on the same cases. A draw that the check refuses is told and replaced by the next
one of its seed, so that each seed is a case that is judged; its time counts too.
The budget is told in rounds of `mixed_work`, measured before each check: 5 s where one takes 50 ms.
Beyond it the exit code is 1. With `--keep FOLDER` the checks are written there as JSON, to be
compared with those of another version.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path

import numpy as np
import tomli_w
from parts import mixed_work

from camwright.geometry.errors import CamError
from camwright.pipeline.case.case_file import enter, parse_case, tables_in
from camwright.pipeline.case.case_values import steps_of
from camwright.pipeline.case.toml_text import Tables, TomlValue

CASES = Path(__file__).resolve().parent.parent / "cases"
SHIPPED = tuple(sorted([*CASES.glob("*.toml"), *(CASES / "machines").glob("*.toml")]))
COUNT = 60
_DRAWS = 6  # of a seed, of which one is not refused
BUDGET = 100.0  # rounds of mixed work
_EXIT_CODES = (0, 1, 3)  # judged, not refused
# An installation has its bytecode.
_ENVIRONMENT = {
    name: text for name, text in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"
}

# Least and greatest factor on all keys of a line, drawn evenly in the logarithm.
FACTORS: Mapping[tuple[str, ...], tuple[float, float]] = {
    ("cam.prime_radius",): (0.75, 1.3),
    ("cam.width",): (0.6, 1.4),
    ("cam.profile_tolerance",): (0.5, 3.0),
    ("roller.radius",): (0.6, 1.3),
    ("roller.width",): (0.5, 1.3),
    ("follower.face.width",): (0.7, 1.5),
    ("spring.rate",): (0.5, 2.0),
    ("spring.preload",): (0.4, 2.0),
    ("follower.mass",): (0.5, 2.0),
    ("follower.overhang_at_max_lift",): (0.8, 1.4),
    ("follower.stem_diameter", "guides.a.diameter", "guides.b.diameter"): (0.8, 1.4),
    ("guides.spacing",): (0.7, 1.5),
    ("guides.a.length",): (0.6, 1.5),
    ("guides.b.length",): (0.6, 1.5),
    ("guides.a.clearance", "guides.b.clearance"): (0.5, 2.0),
    ("camshaft.bearing_spacing",): (0.7, 2.0),
    ("camshaft.diameter",): (0.8, 1.2),
    ("crankshaft.inertia",): (0.5, 2.0),
    ("limits.torque_reduction",): (0.5, 1.5),
}
SPEEDS = (0.3, 2.5)  # factor on the speeds of the load cases and the over-speed
POSITIONS = (72, 127, 240, 720)
MOST = 7  # changed factors
_QUANTITY = re.compile(r"([-+.\deE]+)\s*(.*)")


def variants(seed: int) -> Iterator[tuple[str, Path]]:
    """Texts of the cases of a seed that are read, and the folder of their files."""
    draw = np.random.default_rng(seed)
    base = SHIPPED[seed % len(SHIPPED)]
    while True:
        tables = tables_in(base.read_bytes())
        _change(tables, draw)
        tables["name"] = f"variant-{seed}"
        text = tomli_w.dumps(tables)
        try:
            parse_case(text, base.parent)
        except CamError:
            continue
        yield text, base.parent


def _change(tables: Tables, draw: np.random.Generator) -> None:
    """Change some values of the tables of a case."""
    lines = [keys for keys in FACTORS if all(_value(tables, key) is not None for key in keys)]
    for number in draw.permutation(len(lines))[: draw.integers(2, MOST + 1)]:
        factor = _drawn(draw, FACTORS[lines[number]])
        for key in lines[number]:
            _scale(tables, key, factor)
    if draw.random() < 0.5:
        factor = _drawn(draw, SPEEDS)
        for key in ("limits.overspeed", *_each(tables, "load_case", "speed")):
            _scale(tables, key, factor)
        for key in _each(tables, "crankshaft.motor_line", "speed"):
            _scale(tables, key, factor)
    radius = _value(tables, "roller.radius")
    if radius is not None and draw.random() < 0.5:
        share = float(draw.uniform(-0.5, 0.5))
        enter(tables, "cam.offset", _scaled(radius, share))
    if draw.random() < 0.25:
        bulge = f"{_drawn(draw, (300.0, 3000.0)):.0f} mm"
        enter(tables, "cam.crown", {"kind": "circular", "radius": bulge})
    if draw.random() < 0.5:
        enter(tables, "solver.positions", int(draw.choice(POSITIONS)))


def _drawn(draw: np.random.Generator, ends: tuple[float, float]) -> float:
    return float(np.exp(draw.uniform(*np.log(ends))))


def _each(tables: Tables, key: str, name: str) -> Iterator[str]:
    """Dotted keys of a value of each table of an array of tables."""
    several = _value(tables, key)
    for number in range(len(several) if isinstance(several, list) else 0):
        yield f"{key}[{number}].{name}"


def _value(tables: Tables, key: str) -> TomlValue | None:
    """Value at a dotted key; None without it."""
    value: TomlValue | None = tables
    for step in steps_of(key):
        if isinstance(value, dict) and isinstance(step, str):
            value = value.get(step)
        elif isinstance(value, list) and isinstance(step, int):
            value = value[step]
        else:
            return None
    return value


def _scale(tables: Tables, key: str, factor: float) -> None:
    value = _value(tables, key)
    if value is not None:
        enter(tables, key, _scaled(value, factor))


def _scaled(value: TomlValue, factor: float) -> TomlValue:
    """Number, or text of number and unit, times a factor."""
    if not isinstance(value, str):
        return float(f"{float(value) * factor:.4g}")  # type: ignore[arg-type]
    number, unit = _QUANTITY.fullmatch(value).groups()  # type: ignore[union-attr]
    return f"{float(number) * factor:.6g} {unit}"


def check_seconds(text: str, folder: Path) -> tuple[float, int, str]:
    """CPU seconds, exit code and JSON of the check of a case, as a process with an empty cache."""
    with tempfile.TemporaryDirectory() as place:
        for file in folder.glob("*.csv"):
            shutil.copy(file, place)
        case = Path(place, "case.toml")
        case.write_text(text, encoding="utf-8")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ended = subprocess.run(
            [sys.executable, "-m", "camwright", "check", str(case), "--json"],
            capture_output=True,
            env=_ENVIRONMENT | {"CAMWRIGHT_CACHE": str(Path(place, "cache"))},
            check=False,
            text=True,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return spent, ended.returncode, ended.stdout if ended.stdout else ended.stderr


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int, nargs="?", default=COUNT)
    parser.add_argument("first", type=int, nargs="?", default=0)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    rounds, refused = [], 0
    for seed in range(options.first, options.first + options.count):
        machine = SHIPPED[seed % len(SHIPPED)].stem
        for text, folder in islice(variants(seed), _DRAWS):
            unit = mixed_work()
            seconds, code, printed = check_seconds(text, folder)
            rounds.append(seconds / unit)
            judged = code in _EXIT_CODES
            note = "" if judged else printed.strip().splitlines()[-1][:90]
            shown = f"{seconds:6.2f} s {rounds[-1]:4.0f} rounds"
            print(f"{seed:4d} {machine:16s} {shown}, exit code {code} {note}", flush=True)
            if judged:
                break
            refused += 1
        if options.keep:
            options.keep.mkdir(parents=True, exist_ok=True)
            (options.keep / f"{seed}.json").write_text(printed, encoding="utf-8")
            (options.keep / f"{seed}.toml").write_text(text, encoding="utf-8")
    middle, most_of, most = np.quantile(rounds, [0.5, 0.9, 1.0])
    print(f"refused and replaced: {refused} of {len(rounds)}")
    print(f"median {middle:.0f} rounds, 90 % {most_of:.0f}, most {most:.0f}, budget {BUDGET:g}")
    return int(most > BUDGET)


if __name__ == "__main__":
    sys.exit(main())
