"""Differences between files of a run and the same files made again.

Nothing depends on the versions that the run states: numbers are compared as numbers, texts by their
words and numbers, solids and fields by what they hold, pictures by their pixels, all else to the
byte.
"""

from __future__ import annotations

import base64
import io
import re
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import NamedTuple

import numpy as np

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import read_json, read_npz, read_text
from camwright.pipeline.base.tables import CAM_ANGLE, Table, read_table
from camwright.pipeline.results import signoff
from camwright.pipeline.results.run_reader import LIVE

SAME = 1e-6
"""Relative difference, of the greatest value of a column, that rounding may make."""
_REPRODUCED = 1e-9  # relative difference of numbers that are equal
_ON_A_DRAWING = 1e-6
"""Difference of a coordinate, mm, that does not count."""
_OF_A_FIELD = 2.0**-14
"""Relative difference of the values of a field, whose mantissas are cut to 15 bits."""
_RESIDUAL = "residual"
_ANGLE, _TURN = "angle_deg", 360.0
_NUMBER = re.compile(r"(?<![\w.])([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)")
_REAL = re.compile(r"[.eE]")
_PICTURE = re.compile(r"data:image/png;base64,([A-Za-z0-9+/=]+)")
_ENTITY = re.compile(r"#(\d+)=([^;]*);\n")
_REFERENCE = re.compile(r"#(\d+)\b")
_OFFSET = re.compile(r' offset="\d+"')
_CONTEXT = 40  # characters shown before a difference
_PATCH = 8  # pixels
_SHADE = 10.0  # of 255: mean over a patch, as another processor draws the edges of a field
_UNREADABLE = (
    *(OSError, ValueError, KeyError, EOFError, RecursionError, RuntimeError, TypeError),
    zipfile.BadZipFile, zlib.error,
)  # fmt: skip


# --- classes


class Kind(StrEnum):
    """Method by which two files are compared."""

    TEXT = "byte by byte"
    TABLE = "numbers by column"
    RECORD = "entries"
    ARRAYS = "arrays"
    FIELD = "arrays of a field"
    GEOMETRY = "text and coordinates"
    SOLID = "entities of a solid"
    PAGE = "text, numbers and pictures"
    BOOK = "sheets"
    DOCUMENT = "bytes of a document"
    PICTURE = "pixels"


class Origin(StrEnum):
    """Inputs that determine a file."""

    SOLVED = "case and lift"
    DRAWN = "the other files of the run"
    FITTED = "case, lift and checks, by the screening"
    SEARCH = "the search for the lift, which is not repeated"
    ELSEWHERE = "what the run does not hold"
    RECORD = "the whole run"


class FileClass(NamedTuple):
    """Class of run files: name pattern, with ``N`` for the final trial; comparison, origin."""

    pattern: str
    kind: Kind
    origin: Origin


_INNER = r"[^/]+"
CLASSES = (
    FileClass(r"case\.toml", Kind.TEXT, Origin.SOLVED),
    FileClass(rf"inputs/{_INNER}", Kind.TEXT, Origin.SOLVED),
    FileClass(r"1_(torque|speed)\.csv", Kind.TABLE, Origin.SOLVED),
    FileClass(r"corners\.json", Kind.RECORD, Origin.SOLVED),
    FileClass(r"trial_N/2_limits\.csv", Kind.TABLE, Origin.SEARCH),
    FileClass(r"trial_N/(2_lift|2_spline|3_contour|5_cycle|5_speed_sweep)\.csv",
              Kind.TABLE, Origin.SOLVED),
    FileClass(r"trial_N/4_mesh\.msh", Kind.GEOMETRY, Origin.SOLVED),
    FileClass(r"trial_N/5_(pressure|guides|pivot|length|envelope)\.npz",
              Kind.ARRAYS, Origin.SOLVED),
    FileClass(r"trial_N/(6_checks|trial)\.json", Kind.RECORD, Origin.RECORD),
    FileClass(rf"trial_(?!N/)\d+/{_INNER}", Kind.TEXT, Origin.SEARCH),
    FileClass(r"fields/(stress\.vtkhdf|ends\.vtu)", Kind.FIELD, Origin.SOLVED),
    FileClass(r"fields/turn\.npz", Kind.ARRAYS, Origin.SOLVED),
    FileClass(r"fields/view_stress\.py", Kind.TEXT, Origin.SOLVED),
    FileClass(r"workshop/(contour|cutter|inspection)(_outer|_second)?\.csv",
              Kind.TABLE, Origin.SOLVED),
    FileClass(r"workshop/((contour|cutter)_(inner|outer)_relief|crown_(cam|roller|face))\.csv",
              Kind.TABLE, Origin.SOLVED),
    FileClass(r"workshop/dimensions(_second)?\.json", Kind.RECORD, Origin.SOLVED),
    FileClass(r"workshop/contour(_second)?\.dxf", Kind.GEOMETRY, Origin.SOLVED),
    FileClass(r"workshop/cam(_second)?\.step", Kind.SOLID, Origin.SOLVED),
    FileClass(re.escape(LIVE), Kind.RECORD, Origin.FITTED),
    FileClass(r"8_report\.html|scene\.html|motion\.svg", Kind.PAGE, Origin.DRAWN),
    FileClass(r"8_signoff\.pdf|8_report\.pdf|workshop/drawing\.pdf", Kind.DOCUMENT, Origin.DRAWN),
    FileClass(r"(workshop/(contour|inspection)(_outer|_second)?|trial_N/5_cycle)\.xlsx",
              Kind.BOOK, Origin.DRAWN),
    FileClass(rf"figures/{_INNER}\.png", Kind.PICTURE, Origin.DRAWN),
    FileClass(rf"(inspection|exports)/{_INNER}", Kind.TEXT, Origin.ELSEWHERE),
    FileClass(r"run\.json", Kind.RECORD, Origin.RECORD),
    FileClass(re.escape(signoff.NAME), Kind.RECORD, Origin.RECORD),
    FileClass(re.escape(signoff.SIGNATURES), Kind.RECORD, Origin.RECORD),
)  # fmt: skip
"""Classes of the files of a run; every file that a command writes into one has exactly one."""


def classes_of(name: str, final_trial: int) -> tuple[FileClass, ...]:
    """Classes that a relative file name matches; none for a file no command writes."""
    return tuple(
        each for each in CLASSES if re.fullmatch(each.pattern.replace("N", str(final_trial)), name)
    )


# --- differences of files


def file_differences(
    stored: Path, again: Path, names: Iterable[tuple[str, Kind]]
) -> Iterator[tuple[str, str]]:
    """Files of a run that differ from those made again: name of each, and how it differs in words.

    Parameters
    ----------
    stored : Path      folder of the run
    again : Path       folder of the files computed or drawn again, all of which exist
    names : iterable   relative names, and how each is compared; other files are not
    """
    for name, kind in names:
        file, other = stored / name, again / name
        if not file.is_file():
            yield name, "is missing"
        elif file.read_bytes() != other.read_bytes():
            words = _compared(file, other, kind)
            if words:
                yield name, words


def _compared(file: Path, other: Path, kind: Kind) -> str:
    """First difference of two files in words, "" without one.

    Parameters
    ----------
    file, other : Path   stored, and made again
    kind : str           how they are compared; of a kind without a comparison any difference counts
    """
    compare = _BY_KIND.get(kind)
    if compare is None:
        return "is not the file that the case gives"
    try:
        return compare(file, other)
    except (ResultError, *_UNREADABLE) as error:
        return f"cannot be read ({error})"


# --- tables and arrays


def _tables(file: Path, other: Path) -> str:
    """The first difference of two CSV tables in words; "" without one."""
    one, two = read_table(file), read_table(other)
    if one.keys() != two.keys() or len(one) != len(two):
        return f"has {len(one)} rows of {len(one.keys())} columns, not the {len(two)} of the case"
    if one.load_cases != two.load_cases:
        return f"has the load cases {', '.join(one.load_cases)}"
    for header, values in two.numbers.items():
        k = _worst(one[header], values, header)
        if k is not None:
            at = f"{header}{_place(two, k)}"
            return f"{at} = {_shown(one[header][k])}, recomputed {_shown(values[k])}"
    return ""


def _place(table: Table, row: int) -> str:
    angle = table.get(CAM_ANGLE.header)
    state = "" if table.rows_of is None else f", {table.rows_of[row]}"
    return f" in row {row + 1}" if angle is None else f" at {angle[row]:.4g} deg{state}"


def _arrays(file: Path, other: Path) -> str:
    """The first difference of two numpy archives in words; "" without one."""
    one, two = read_npz(file), read_npz(other)
    if sorted(one) != sorted(two):
        return f"holds {', '.join(sorted(one))}, not {', '.join(sorted(two))}"
    for name in two:
        words = _array(name, one[name], two[name])
        if words:
            return words
    return ""


def _array(name: str, one: np.ndarray, two: np.ndarray) -> str:
    """The first difference of two arrays named `name`, in words; "" without one."""
    texts = one.dtype.kind == two.dtype.kind == "U"
    if one.shape != two.shape or (one.dtype != two.dtype and not texts):
        return f"{name} is of another shape or type"
    if texts:
        pairs = zip(one.ravel().tolist(), two.ravel().tolist(), strict=True)
        words = next(filter(None, (text_difference(a, b) for a, b in pairs if a != b)), "")
        return f"{name}: {words}" if words else ""
    if two.dtype.kind not in "fiu":
        return "" if np.array_equal(one, two) else f"{name} differs"
    values, others = one.ravel().astype(float), two.ravel().astype(float)
    k = _worst(values, others, name, _OF_A_FIELD if two.dtype == np.float32 else 0.0)
    return "" if k is None else f"{name}[{k}] = {_shown(values[k])}, recomputed {_shown(others[k])}"


def _worst(one: np.ndarray, two: np.ndarray, name: str, digits: float = 0.0) -> int | None:
    """Flat index of the value that is furthest beyond the allowed difference from that recomputed;
    None where none is.

    A value that is finite in one array alone comes first. Angles are compared modulo a turn.

    Parameters
    ----------
    one, two : arrays   stored and recomputed, flat
    name : str          which sets the allowed difference
    digits : float      relative difference that the digits of the values make
    """
    if not two.size:
        return None
    finite = np.isfinite(two)
    odd = (np.isfinite(one) != finite) | (~finite & (one != two) & ~(np.isnan(one) & np.isnan(two)))
    if odd.any():
        return int(np.argmax(odd))
    apart = np.abs(np.where(finite, one, 0.0) - np.where(finite, two, 0.0))
    if name.endswith(_ANGLE):
        apart = np.minimum(apart, np.abs(_TURN - apart))
    size = np.abs(np.where(finite, two, 0.0))
    beyond = apart - digits * size - _allowed(name, float(size.max()))
    k = int(np.argmax(beyond))
    return k if beyond[k] > 0.0 else None


def _fields(file: Path, other: Path) -> str:
    """The first difference of two VTU or VTKHDF files in words; "" without one."""
    read = _grid if file.suffix == ".vtu" else _members
    one, two = read(file), read(other)
    if one.keys() != two.keys():
        odd = sorted(one.keys() ^ two.keys())[0]
        return f"{odd} is {'missing' if odd in two else 'none of the case'}"
    return next(filter(None, (_array(name, one[name], two[name]) for name in two)), "")


def _grid(file: Path) -> dict[str, np.ndarray]:
    """Everything in a VTU file: arrays by name, and the tags that describe them."""
    import meshio

    tags = file.read_bytes().partition(b"<AppendedData")[0].decode()
    mesh = meshio.read(file)
    return {
        "tags": np.asarray(_OFFSET.sub("", tags)),
        "points": mesh.points,
        **{f"{cells.type} {k}": cells.data for k, cells in enumerate(mesh.cells)},
        **{f"{name} at points": np.asarray(values) for name, values in mesh.point_data.items()},
        **{
            f"{name} in cells {k}": np.asarray(values)
            for name, parts in mesh.cell_data.items()
            for k, values in enumerate(parts)
        },
    }


def _members(file: Path) -> dict[str, np.ndarray]:
    """Everything in a VTKHDF file by its path: data, attributes, and where links point to."""
    import h5py

    members: dict[str, np.ndarray] = {}

    def note(name: str, group: h5py.Group | h5py.Dataset) -> None:
        for key, value in group.attrs.items():
            members[f"{name}@{key}"] = np.asarray(value)
        if isinstance(group, h5py.Dataset):
            if group.is_virtual or group.external:
                raise ResultError(f"{name} lies in another file")
            values = np.asarray(group[()])
            members[name] = values.astype("S") if values.dtype.hasobject else values
            return
        for key in group:
            link = group.get(key, getlink=True)
            if isinstance(link, h5py.HardLink):
                note(f"{name}/{key}", group[key])
            elif isinstance(link, h5py.SoftLink):
                members[f"{name}/{key}"] = np.asarray(link.path)
            else:
                raise ResultError(f"{name}/{key} lies in another file")

    with h5py.File(file, "r") as root:
        note("", root)
    return members


# --- texts, solids, pages, pictures


def text_difference(one: str, two: str, absolute: float = _REPRODUCED) -> str:
    """First difference of two texts, in words: a word, or a number beyond round-off; "" without
    one.

    A count, written without a decimal point, must be the same.

    Parameters
    ----------
    one, two : str     stored and recomputed
    absolute : float   difference of two numbers that does not count, besides `_REPRODUCED` of the
                       number
    """
    parts, others = _NUMBER.split(one), _NUMBER.split(two)
    for place, (a, b) in enumerate(zip_longest(parts, others, fillvalue="")):
        if a == b or (place % 2 and a and b and _equal(a, b, absolute)):
            continue
        pairs = () if place % 2 else zip(a, b, strict=False)
        alike = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))
        before = ("".join(parts[max(0, place - 4) : place]) + a[:alike])[-_CONTEXT:]
        return f"'{_shown(before + a[alike:])}', recomputed '{_shown(b[alike:])}'"
    return ""


def _equal(one: str, two: str, absolute: float) -> bool:
    """Whether two numbers, as text, differ by no more than `absolute` and round-off; False where
    both are whole numbers.
    """
    if not (_REAL.search(one) or _REAL.search(two)):
        return False
    a, b = float(one), float(two)
    return abs(a - b) <= absolute + _REPRODUCED * abs(b)


def _texts(file: Path, other: Path) -> str:
    return text_difference(read_text(file), read_text(other), _ON_A_DRAWING)


def _solids(file: Path, other: Path) -> str:
    """The first difference of two STEP files in words, whatever the numbers of their entities; ""
    without one.

    Equal entities are written once, so that round-off can change how many there are.
    """
    (head, one), (other_head, two) = (_entities(read_text(each)) for each in (file, other))
    words = text_difference(head, other_head, _ON_A_DRAWING)
    if words:
        return words
    roots, other_roots = _roots(one), _roots(two)
    if len(roots) != len(other_roots):
        return f"has {len(roots)} parts, recomputed {len(other_roots)}"
    left, same = list(zip(roots, other_roots, strict=True)), set[tuple[str, str]]()
    while left:
        pair = left.pop()
        if pair in same:
            continue
        same.add(pair)
        a, b = one[pair[0]], two[pair[1]]
        words = text_difference(_REFERENCE.sub("#", a), _REFERENCE.sub("#", b), _ON_A_DRAWING)
        if words:
            return words
        left += zip(_REFERENCE.findall(a), _REFERENCE.findall(b), strict=True)
    return ""


def _entities(text: str) -> tuple[str, dict[str, str]]:
    """Text of a STEP file without its entities, and the text of each entity by its number.

    Raises
    ------
    ResultError
        If a number stands twice, or an entity refers to one that is missing.
    """
    listed = _ENTITY.findall(text)
    entities = dict(listed)
    referred = {each for words in entities.values() for each in _REFERENCE.findall(words)}
    if len(entities) != len(listed) or not referred <= entities.keys():
        raise ResultError("an entity stands twice or nowhere")
    return _ENTITY.sub("", text), entities


def _roots(entities: Mapping[str, str]) -> list[str]:
    """Entities that no other one refers to, in their order."""
    referred = {each for words in entities.values() for each in _REFERENCE.findall(words)}
    return [number for number in entities if number not in referred]


def _pages(file: Path, other: Path) -> str:
    """The first difference of two HTML pages in words, their pictures compared by pixels; ""
    without one.
    """
    one, two = read_text(file), read_text(other)
    words = text_difference(_PICTURE.sub("", one), _PICTURE.sub("", two))
    if words:
        return words
    pairs = zip(_PICTURE.findall(one), _PICTURE.findall(two), strict=True)
    drawn = (
        _pixels(*(base64.b64decode(each) for each in pair)) for pair in pairs if len({*pair}) > 1
    )
    return next(filter(None, drawn), "")


def _books(file: Path, other: Path) -> str:
    """The first difference of two spreadsheets in words; "" without one."""
    with zipfile.ZipFile(file) as one, zipfile.ZipFile(other) as two:
        if sorted(one.namelist()) != sorted(two.namelist()):
            return "has other sheets"
        for name in two.namelist():
            a, b = one.read(name), two.read(name)
            words = "" if a == b else text_difference(a.decode(), b.decode())
            if words:
                return f"{name}: {words}"
    return ""


def _pictures(file: Path, other: Path) -> str:
    return _pixels(file.read_bytes(), other.read_bytes())


def _pixels(one: bytes, two: bytes) -> str:
    """Difference of two PNG pictures in words, "" without one; the edges of a field may differ by a
    shade in some pixels.
    """
    from PIL import Image

    pictures = []
    for each in (one, two):
        with Image.open(io.BytesIO(each), formats=["PNG"]) as picture:
            pictures.append(np.asarray(picture.convert("RGBA"), dtype=float))
    a, b = pictures
    if a.shape != b.shape:
        return (
            f"a picture has {a.shape[1]} x {a.shape[0]} pixels, redrawn {b.shape[1]} x {b.shape[0]}"
        )
    apart = np.abs(a - b)
    rows, columns = (-(-size // _PATCH) for size in a.shape[:2])
    padded = np.zeros((rows * _PATCH, columns * _PATCH, 4))
    padded[: a.shape[0], : a.shape[1]] = apart
    patches = padded.reshape(rows, _PATCH, columns, _PATCH, 4).mean(axis=(1, 3))
    return "a picture shows something else" if patches.max() > _SHADE else ""


_BY_KIND: Mapping[Kind, Callable[[Path, Path], str]] = {
    Kind.TABLE: _tables,
    Kind.RECORD: lambda file, other: next(
        record_differences(read_json(file), read_json(other)), ""
    ),
    Kind.ARRAYS: _arrays,
    Kind.FIELD: _fields,
    Kind.GEOMETRY: _texts,
    Kind.SOLID: _solids,
    Kind.PAGE: _pages,
    Kind.BOOK: _books,
    Kind.PICTURE: _pictures,
}
"""Comparisons of files that are not the same bytes; of all other kinds such a file differs."""


# --- records


def record_differences(
    one: object, two: object, share: float = SAME, place: str = "", left_out: Sequence[str] = ()
) -> Iterator[str]:
    """Differences of two JSON values in words, entry by entry.

    Parameters
    ----------
    one, two : object     stored and recomputed
    share : float         relative difference of two numbers that does not count
    place : str           dotted key of the values
    left_out : sequence   keys that are not compared, anywhere
    """
    if isinstance(one, Mapping) and isinstance(two, Mapping):
        for key in {**two, **one}:
            inside = f"{place}.{key}" if place else str(key)
            if key in left_out:
                continue
            if key not in one or key not in two:
                yield f"{inside} is {'missing' if key in two else 'none of the case'}"
            else:
                yield from record_differences(one[key], two[key], share, inside, left_out)
    elif isinstance(one, list | tuple) and isinstance(two, list | tuple):
        if len(one) != len(two):
            yield f"{place} has {len(one)} entries, recomputed {len(two)}"
            return
        for k, (a, b) in enumerate(zip(one, two, strict=True)):
            yield from record_differences(a, b, share, f"{place}[{k}]", left_out)
    elif isinstance(one, float) and isinstance(two, int | float) and not isinstance(two, bool):
        apart = abs(one - two)
        if place.endswith(_ANGLE):
            apart = min(apart, abs(_TURN - apart))
        if not apart <= _allowed(place, abs(two), share):
            yield f"{place} = {_shown(one)}, recomputed {_shown(two)}"
    elif isinstance(one, str) and isinstance(two, str):
        if one != two and text_difference(one, two):
            yield f"{place} = {_shown(one)}, recomputed {_shown(two)}"
    elif one != two or isinstance(one, bool) != isinstance(two, bool):
        yield f"{place} = {_shown(one)}, recomputed {_shown(two)}"


def _allowed(name: str, greatest: float, share: float = SAME) -> float:
    """Difference of numbers of a name that does not count.

    A residual is itself a rounding error; an angle is one of the whole turn.
    """
    if _RESIDUAL in name:
        return SAME
    return share * (_TURN if name.endswith(_ANGLE) else greatest) + _REPRODUCED


def _shown(value: object) -> str:
    """Value as text of at most 60 characters."""
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    text = " ".join(str(value).split())
    return text if len(text) <= 60 else f"{text[:57]}..."
