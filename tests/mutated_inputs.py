"""Input files with seeded mutations: read or refused in one line, in bounded time and memory.

`python tests/mutated_inputs.py COUNT [SEED]` tries many; the suite tries a sample.
"""

from __future__ import annotations

import random
import re
import resource
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import CamError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.plausibility import implausible
from camwright.pipeline.case.template import KINDS, first_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.studies.batch.study_file import read_study
from camwright.pipeline.studies.cam_inspection import read_measured

ROOT = Path(__file__).parents[1]
ROUND = RollerContour(PitchCurve(Lift(uniform_turn(36), np.zeros(36)), 0.05), 0.01)
"""Round cam to which measured files are read."""
SECONDS_MAX, MEBIBYTES_MAX = 5.0, 500  # CPU time and growth of the memory for one input
_CYLINDER_SHARE = 0.1  # of the cases whose working cycle is solved, 0.1 s each
_PREVIEW_SHARE = 0.02  # of the cases that are solved and checked, seconds each
_SCALED_SHARE = 0.005  # of the inputs: cases of other sizes, all of them solved and checked
_PREVIEW_SECONDS_MAX = 30.0  # CPU time of a preview: of the arm 15 s, its contact tables made anew

NUMBERS = (
    "0", "-1", "-0.0", "1e308", "-1e308", "1e-308", "5e-324", "1e999", "nan", "inf", "-inf",
    "1.5.2", "0x10", "1_000", "1,5", "9" * 400, "1e5", "1e-5", "١٢", "true", '""', "[]", "{}", "1e",
    "2024-01-01", '"10 m"', '"1e300 mm"', '"-3 N"', '"5 furlong"', '"NaN mm"', '"1 mm 2"',
)  # fmt: skip
VALUES: tuple[object, ...] = (
    {}, [], True, "", "x", 0, -1, 1e308, "1e300 mm", "1e-300 mm", "-3 mm", "0 mm", {"value": 1},
    {"text": "x"}, [{}], [1, [2]],
)  # fmt: skip
"""Values of every type that TOML has, and of sizes whose squares and quotients are no numbers."""
WORDS = (
    b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"\r", b"\n\n\n", b";", b"\t", b",", b'"', b"'''", b'"""',
    b"[", b"]", b"{", b"}", b"[[", b"=", b"#", b"\\", b"../../etc/passwd", b"<script>", b"%s{0}",
    b"a." * 3000, b"[" * 3000, b"x" * 200_000, b"\xc3\x28", "\u202e\u0661".encode(), b"__class__",
)  # fmt: skip


Input, Result = TypeVar("Input"), TypeVar("Result")


class Source(NamedTuple):
    """One input file of a folder: its name, the other files of the folder, how it is read."""

    name: str
    files: dict[str, bytes]
    read: Callable[[Path], object]


class Outcome(NamedTuple):
    """A mutated input: ``read``, ``refused`` or what it must not do; CPU time, memory it took."""

    source: str
    seed: int
    what: str
    seconds: float
    mebibytes: float

    @property
    def failed(self) -> bool:
        return self.what not in ("read", "refused")


def read_whole(path: Path) -> Case:
    """Read a case with its files, as far as its first solution."""
    case = read_case(path)
    torques = {}
    solved = case.engine is not None and getattr(case.engine, "kind", "") == "cylinder"
    if not solved or random.random() < _CYLINDER_SHARE:
        torques = engine_torques(case)
    if case.lift is not None:
        case.contour(given_lift(case))
    list(implausible(case, torques))
    return case


def sources() -> list[Source]:
    """Cases of every kind, their data files, a study, a measured contour."""
    every = []
    for kind in KINDS:
        first = first_case("first", kind)
        files = {"first.toml": first.text.encode()}
        every.append(Source("first.toml", files, read_whole))
        if first.data_name:
            files[first.data_name] = first.data.encode()
            every.append(Source(first.data_name, files, _case_beside))
    every += _alone(cases(), read_whole)
    rows = "".join(f"{k},{50 + (k % 90) / 30}\n" for k in range(360))
    lift = first_case("first", "lift").text
    table = '[lift]\nfile = "lift.csv"\n'
    start, end = lift.index("[lift]"), lift.index("[mechanism]")
    files = {"first.toml": (lift[:start] + table + lift[end:]).encode()}
    files["lift.csv"] = ("cam_angle_deg,lift_mm\n" + rows).encode()
    every.append(Source("lift.csv", files, _case_beside))
    every += _alone(sorted((ROOT / "studies").glob("*.toml"))[:2], read_study)
    sheet = {"sheet.csv": ("angle_deg,radius_mm\n" + rows).encode()}
    every.append(Source("sheet.csv", sheet, partial(read_measured, contour=ROUND)))
    return every


def cases() -> list[Path]:
    """Shipped cases without data files; in the folder of motions cams that pull, and a gravity."""
    return [
        each for name in (".", "motions") for each in sorted((ROOT / "cases" / name).glob("*.toml"))
    ]


def _alone(paths: Iterable[Path], read: Callable[[Path], object]) -> Iterator[Source]:
    """Files read without others."""
    for path in paths:
        yield Source(path.name, {path.name: path.read_bytes()}, read)


def _case_beside(path: Path) -> Case:
    return read_whole(path.with_name("first.toml"))


def mutated(content: bytes, rng: random.Random) -> bytes:
    """A file with one to four mutations."""
    for _ in range(rng.randint(1, 4)):
        content = rng.choice(_MUTATIONS)(content, rng)
    return content


def scaled(content: bytes, rng: random.Random) -> bytes:
    """A case with one to three numbers scaled by 0 or 0.1 to 10: it may still be a machine."""
    lines = content.decode().split("\n")
    stated = [k for k, line in enumerate(lines) if _NUMBER.match(line)]
    for at in rng.sample(stated, rng.randint(1, 3)):
        number = _NUMBER.match(lines[at])
        assert number is not None
        value = float(number[2]) * rng.choice([0.0, 0.3, 0.8, 1.25, 3.0, 10 ** rng.uniform(-1, 1)])
        written = f"{value:.6g}" if "." in number[2] else f"{value:.0f}"
        lines[at] = number[1] + written + number[3]
    return "\n".join(lines).encode()


_NUMBER = re.compile(r"""(\w+ *= *(?:"|\[ *|\{ *value *= *)?)(\d+\.?\d*)(?![\d.])(.*)""")
"""Line of a key with a number: what stands before it, the number, the rest of the line."""


def exchanged(tables: dict[str, Any], rng: random.Random) -> dict[str, Any]:
    """Tables of a case with one of `VALUES` in the place of a table, a list or a value."""
    new = deepcopy(tables)
    held, key = rng.choice([*_places(new)])
    held[key] = rng.choice(VALUES)
    return new


def _places(held: dict[str, Any] | list[Any]) -> Iterator[tuple[Any, str | int]]:
    """Each place below a table or list: what holds it, and its key or index there."""
    rows = held.items() if isinstance(held, dict) else enumerate(held)
    for key, value in rows:
        yield held, key
        if isinstance(value, (dict, list)):
            yield from _places(value)


def _bytes_changed(content: bytes, rng: random.Random) -> bytes:
    data = bytearray(content)
    for _ in range(rng.randint(1, 8)):
        if data:
            data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def _word_entered(content: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(content))
    return content[:at] + rng.choice(WORDS) + content[at:]


def _cut(content: bytes, rng: random.Random) -> bytes:
    start = rng.randint(0, len(content))
    end = len(content) if rng.random() < 0.3 else min(len(content), start + rng.randint(1, 200))
    return content[:start] + content[end:]


def _number_changed(content: bytes, rng: random.Random) -> bytes:
    """Replace a value, of a key or a cell."""
    lines = content.split(b"\n")
    at = rng.randrange(len(lines))
    line = lines[at]
    new = rng.choice(NUMBERS).encode()
    if b"=" in line:
        lines[at] = line.split(b"=")[0] + b"= " + new
    elif b"," in line:
        cells = line.split(b",")
        cells[rng.randrange(len(cells))] = new
        lines[at] = b",".join(cells)
    return b"\n".join(lines)


def _factor(content: bytes, rng: random.Random) -> bytes:
    """Append an exponent to a number of a line: a value too large or too small."""
    lines = content.split(b"\n")
    at = rng.randrange(len(lines))
    for digit in b"123456789":
        if digit in lines[at]:
            place = lines[at].index(digit) + 1
            power = rng.choice([b"e3", b"e-3", b"e9", b"e-9", b"0000", b"e300"])
            lines[at] = lines[at][:place] + power + lines[at][place:]
            break
    return b"\n".join(lines)


def _lines_changed(content: bytes, rng: random.Random) -> bytes:
    """Repeat, drop, swap or double lines."""
    lines = content.split(b"\n")
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(4):
        case 0:
            lines[at:at] = lines[other : other + rng.randint(1, 30)]
        case 1:
            del lines[at : at + rng.randint(1, 5)]
        case 2:
            lines[at], lines[other] = lines[other], lines[at]
        case _:
            lines[at:at] = [lines[at]] * rng.choice([1, 10, 3000])
    return b"\n".join(lines)


def _separators_changed(content: bytes, rng: random.Random) -> bytes:
    old, new = rng.choice([(b",", b";"), (b".", b","), (b"\n", b"\r\n"), (b",", b" "), (b" ", b"")])
    if rng.random() < 0.5:
        return content.replace(old, new)
    return content.replace(old, new, rng.randint(1, 40))


_MUTATIONS = (
    _bytes_changed, _word_entered, _cut, _number_changed, _number_changed, _factor, _factor,
    _lines_changed, _separators_changed,
)  # fmt: skip


def tried(count: int, seed: int) -> Iterator[Outcome]:
    """Try mutated inputs, one after another."""
    every = sources()
    whole = [each for each in every if each.read is read_whole]
    with tempfile.TemporaryDirectory() as name:
        for number in range(count):
            own = seed * 1_000_003 + number
            rng = random.Random(own)
            is_scaled = rng.random() < _SCALED_SHARE
            source = rng.choice(whole if is_scaled else every)
            folder = Path(name)
            for other, content in source.files.items():
                (folder / other).write_bytes(content)
            mutation = scaled if is_scaled else mutated
            (folder / source.name).write_bytes(mutation(source.files[source.name], rng))
            random.seed(own)
            memory, start = _memory(), time.process_time()
            path = folder / source.name
            what, case = _tried(source.read, path)
            seconds, grown = time.process_time() - start, _memory() - memory
            if seconds > SECONDS_MAX or grown > MEBIBYTES_MAX:
                what = f"{seconds:.1f} s, {grown:.0f} MiB"
            if isinstance(case, Case) and (is_scaled or rng.random() < _PREVIEW_SHARE):
                start = time.process_time()
                what = _tried(_previewed, case)[0]
                if (taken := time.process_time() - start) > _PREVIEW_SECONDS_MAX:
                    what = f"preview of {taken:.1f} s"
            yield Outcome(source.name, own, what, seconds, grown)


def _previewed(case: Case) -> None:
    preview_case(case, corners=False)


def _tried(read: Callable[[Input], Result], source: Input) -> tuple[str, Result | None]:
    """``read``, ``refused`` or what went wrong; and what was read."""
    try:
        result = read(source)
    except CamError as error:
        words = str(error)
        if not words.strip() or "\n" in words or len(words) > 2000:
            return f"message of {len(words)} characters: {words[:200]!r}", None
        return "refused", None
    except Exception:  # noqa: BLE001
        return traceback.format_exc(), None
    return "read", result


def _memory() -> float:
    """Greatest memory of this process so far, MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main(count: int, seed: int) -> int:
    outcomes = []
    for each in tried(count, seed):
        outcomes.append(each)
        if each.failed:
            print(f"{each.source}, seed {each.seed}: {each.what}", flush=True)
    failed = sum(each.failed for each in outcomes)
    print(
        f"{count} inputs of seed {seed}: {failed} failed, "
        f"{sum(each.what == 'refused' for each in outcomes)} refused, at most "
        f"{max(each.seconds for each in outcomes):.2f} s and "
        f"{max(each.mebibytes for each in outcomes):.0f} MiB more for one"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1))
