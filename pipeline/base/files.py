"""File access: bounded reading, atomic writing, hashes."""

from __future__ import annotations

import hashlib
import io
import json
import math
import os
import re
import stat
import struct
import tempfile
import tomllib
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.errors import InputError, ResultError

Json: TypeAlias = "str | float | Sequence[Json] | Mapping[str, object] | None"
"""A value of a JSON record."""

_TABLES_DEEP = 16
_NO_KEY = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+(?:""")?+'  # each text is quoted to its end or the file's
    r"|'''.*?(?:'''|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+"?+'
    r"|'[^'\n]*+'?+"
    r"|#[^\n]*+",
    re.DOTALL,
)
_KINDS = {
    stat.S_IFLNK: "a link",
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFBLK: "a device",
    stat.S_IFCHR: "a device",
}
DEFLATE_RATIO = 1032
"""Greatest ratio of length to packed length that deflate reaches."""
_ARRAYS_MAX = 1 << 30
"""Bytes of all arrays of an archive."""
_HALF_SIGN = re.compile(r"\\u[dD][89a-fA-F]")
_LONG_KEY = re.compile(rf"(?<![\w-])(?:[\w-]++[ \t]*+\.[ \t]*+){{{_TABLES_DEEP + 1}}}")


def inside(folder: Path, name: str, field: str) -> Path:
    """Path of a file in a folder, symbolic links resolved.

    Parameters
    ----------
    folder : Path   in which it has to be
    name : str      relative to the folder
    field : str     key that names it, for messages

    Raises
    ------
    InputError
        If it is no name of a file, or leads out of the folder, by a link too.
    """
    limit = "a relative path that stays in the case file's folder"
    path = Path(name)
    if path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name:
        raise InputError(field, name, limit)
    try:
        resolved = (folder / path).resolve()
    except (OSError, ValueError, RuntimeError):
        raise InputError(field, name, "a readable file") from None
    if not resolved.is_relative_to(folder.resolve()):
        raise InputError(field, name, limit)
    return resolved


def unplain(folder: Path) -> list[tuple[str, str]]:
    """Links, pipes, sockets and devices under a folder: their kind by relative name.

    Hidden parts included, by name; no link is followed and nothing is opened. A file with further
    names (hard links) is a plain file: what we write takes the place of a name and leaves the
    others as they are.

    Raises
    ------
    ResultError
        If a folder cannot be read.
    """
    odd: list[tuple[str, str]] = []
    inner = [folder]
    try:
        while inner:
            with os.scandir(inner.pop()) as entries:
                for entry in entries:
                    kind = stat.S_IFMT(entry.stat(follow_symlinks=False).st_mode)
                    if kind == stat.S_IFDIR:
                        inner.append(Path(entry.path))
                    elif kind != stat.S_IFREG:
                        name = Path(entry.path).relative_to(folder).as_posix()
                        odd.append((name, _KINDS.get(kind, "no file")))
    except OSError as error:
        raise ResultError(f"{error.filename or folder}: {error.strerror or error}") from None
    return sorted(odd)


def require_plain(folder: Path, refused: type[ResultError] = ResultError) -> None:
    """Refuse, as `refused`, a folder that holds a link, pipe, socket or device at any depth;
    nothing is opened.

    Raises
    ------
    ResultError
        Of the class `refused`, naming the first of them; or if a folder cannot be read.
    """
    odd = unplain(folder)
    if odd:
        name, kind = odd[0]
        raise refused(f"{folder / shown_name(name)}: {not_plain(kind)}")


def not_plain(kind: str) -> str:
    """Error message for an entry of `unplain`."""
    return f"is {kind}; only files and folders are read"


def shown_name(name: str) -> str:
    """Name of a file in printable characters."""
    return name if name.isprintable() else ascii(name)


def read_toml(path: Path, field: str, most: int) -> dict[str, Any]:
    """Tables of a TOML file of at most `most` bytes.

    Raises
    ------
    InputError
        Naming `field`, if the file is larger, unreadable, nested too deeply or not TOML in UTF-8.
    """
    try:
        with path.open("rb") as file:
            content = file.read(most + 1)
        if len(content) > most:
            raise InputError(field, "larger", f"at most {most // 1024} KiB")
    except OSError as error:
        raise InputError(field, error.strerror or str(error), "a readable TOML file") from None
    return parse_toml(content, field)


def parse_toml(content: bytes | str, field: str) -> dict[str, Any]:
    """Tables of a TOML text, at most 16 deep, with integers of 64 bits as TOML 1.0 has them.

    Raises
    ------
    InputError
        Naming `field`, if the text is nested more deeply, has a longer integer or is not TOML in
        UTF-8.
    """
    try:
        text = content if isinstance(content, str) else content.decode("utf-8-sig")
        # The parser takes the square of the number of parts of a key, minutes for 60,000.
        nested = _LONG_KEY.search(_NO_KEY.sub(_blank, text)) is not None
        tables = {} if nested else tomllib.loads(text)
        nested = nested or _is_deeper(tables, _TABLES_DEEP)
        long = None if nested else _long_integer(tables)
    except RecursionError:
        nested = True
    except UnicodeDecodeError as error:
        line, column = _place(error.object[: error.start].decode("utf-8", "replace"))
        where = f"byte 0x{error.object[error.start]:02x} in line {line}, column {column}"
        raise InputError(field, where, "text in UTF-8: save the file in this encoding") from None
    except ValueError as error:
        raise InputError(field, *_slip(text, str(error))) from None
    if nested:
        raise InputError(field, "nested too deeply", f"at most {_TABLES_DEEP} tables deep")
    if long is not None:
        raise InputError(field, f"an integer of {long.bit_length()} bits", "integers of 64 bits")
    return tables


def _place(before: str) -> tuple[int, int]:
    """Line and column of the character after a text, from 1."""
    return before.count("\n") + 1, len(before) - before.rfind("\n")


_PLACE = re.compile(r"\(at (?:line (\d+), column (\d+)|end of document)\)")
_TYPOGRAPHIC = re.compile("[\u201c\u201d\u201e\u00ab\u00bb\u2018\u2019]")
_UNQUOTED = re.compile(r"""[^=#"'\[{]+=\s*([^\s"'\[{#][^#"]*?)\s*(?:#.*)?""")
_RULES = (
    ("Cannot declare", "a table that is opened once"),
    ("Cannot overwrite", "a key that is stated once in its table"),
    ("Expected '='", "KEY = VALUE"),
    ("Illegal character '\\n'", "a text with its closing quote on the same line"),
    ("Unclosed array", "an array with its closing bracket"),
    ("Expected ']]'", "[[TABLE]] with its closing brackets"),
    ("Expected ']'", "[TABLE] with its closing bracket"),
)
"""How a message of the parser starts, and what the file must have there."""


def _slip(text: str, message: str) -> tuple[str, str]:
    """Place of a syntax error in a TOML text, and what is accepted there, in words.

    Nothing of the text is repeated: a link may make any file of the machine an input.

    Parameters
    ----------
    text : str      the TOML text
    message : str   of the parser
    """
    lines, match = text.split("\n"), _PLACE.search(message)
    if match is not None and match[1]:
        line, column = int(match[1]), int(match[2])
    else:  # the parser names the end where it has read the last line
        end = text.rstrip()
        line, column = _place(end)
    written = lines[line - 1].strip() if line <= len(lines) else ""
    limit = next((rule for start, rule in _RULES if message.startswith(start)), "")
    unquoted = _UNQUOTED.fullmatch(written)
    if _TYPOGRAPHIC.search(written):
        limit = 'straight quotes, "..."'
    elif written.endswith("="):
        limit = "KEY = VALUE"
    elif "\\" in written:
        limit = "a text with backslashes in single quotes, '...'"
    elif not limit and unquoted is not None and unquoted[1].lower() in ("true", "false"):
        limit = unquoted[1].lower()
    elif not limit and unquoted is not None:
        limit = 'text in quotes, "...", or a number such as 0.5'
    reason = _PLACE.sub("", message).strip()
    where = f"line {line}, column {column}"
    return where, f"{limit or 'as TOML has it'} ({reason[:80]})"


def _blank(literal: re.Match[str]) -> str:
    """A quoted text as a word, which may be a part of a key; nothing for a comment."""
    return "" if literal[0].startswith("#") else "s"


def _is_deeper(tables: dict[str, Any], depth: int) -> bool:
    """Whether tables and arrays are nested more than `depth` levels deep."""
    level: list[Any] = [tables]
    for _ in range(depth):
        level = [
            entry
            for each in level
            for entry in (each.values() if isinstance(each, dict) else each)
            if isinstance(entry, (dict, list))
        ]
    return bool(level)


def _long_integer(entry: Any) -> int | None:
    """First integer beyond 64 bits within a table, array or value; None where there is none."""
    if isinstance(entry, int):
        return None if _is_short(entry) else entry
    inner = entry.values() if isinstance(entry, dict) else entry if isinstance(entry, list) else ()
    return next((long for each in inner if (long := _long_integer(each)) is not None), None)


def _is_short(number: int) -> bool:
    """Whether an integer has 64 bits."""
    return -(2**63) <= number < 2**63


def locked(path: Path, busy: str) -> IO[str] | None:
    """Exclusive lock of a file, which is made where it is missing; released on closing or at the
    end of the process.

    None on Windows, which has no such lock. A link is not followed.

    Parameters
    ----------
    path : Path   of the file
    busy : str    message where another process has the lock

    Raises
    ------
    ResultError
        If another process has the lock.
    OSError
        If it cannot be opened, as a link cannot.
    """
    try:
        import fcntl
    except ImportError:
        return None
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o644)
        lock = os.fdopen(handle, "r+")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            raise ResultError(busy) from None
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(lock.fileno()), path.stat()):
                return lock
        lock.close()  # its holder deleted it after it was opened here


def write_atomic(path: Path, content: bytes | str, *, durable: bool = True) -> Path:
    """Write a file in one step, whole or not at all; missing parent folders are created. Returns
    its path.

    Parameters
    ----------
    path : Path              of the file
    content : bytes or str   text is written in UTF-8
    durable : bool           on the disk when this returns; a file that may be missing or cut short
                             after a loss of power need not wait for it

    Raises
    ------
    ResultError
        If the file cannot be written, such as on a full disk.
    """
    data = content.encode() if isinstance(content, str) else content
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=".", suffix=".tmp", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            if durable:
                file.flush()
                os.fsync(file.fileno())
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror or error}") from None
    finally:
        if temporary is not None:
            Path(temporary).unlink(missing_ok=True)
    return path


def hash_inputs(case_text: str, included: Mapping[str, bytes]) -> str:
    """SHA-256 of the resolved case text and the bytes of its included files."""
    digest = hashlib.sha256(case_text.encode())
    for name, content in sorted(included.items()):
        digest.update(f"\0{name}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def read_text(path: Path) -> str:
    """Text of a file in UTF-8; ResultError if it cannot be read."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8 text"
        raise ResultError(f"{path}: {reason}") from None


def read_json(path: Path) -> Any:
    """Contents of a JSON file, for the caller to check.

    Raises
    ------
    ResultError
        If it is not JSON, or other programs may read it otherwise: a repeated key, a number
        beyond 64 bits or the range of a float, half of a surrogate pair.
    """
    text = read_text(path)
    try:
        if _HALF_SIGN.search(text):
            json.dumps(json.loads(text), ensure_ascii=False).encode()
        return json.loads(
            text, parse_constant=_no_constant, parse_int=_integer, parse_float=_finite,
            object_pairs_hook=each_key_once,
        )  # fmt: skip
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path}: not JSON ({' '.join(str(error).split())})") from None


def json_text(value: Json, indent: int | None = 2) -> str:
    """JSON text of a record, numpy numbers included; ResultError for NaN and infinity.

    `indent` None: on one line, for long lists of numbers.
    """
    try:
        return json.dumps(value, indent=indent, ensure_ascii=False, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise ResultError(f"a record cannot be written: {error}") from None


def _plain(value: np.generic | np.ndarray | Mapping[str, Json]) -> Json:
    """Value that JSON can hold of a numpy number or array, or of a mapping; TypeError
    for another.
    """
    if isinstance(value, (np.generic, np.ndarray)):
        plain: Json = value.tolist()
        return plain
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def each_key_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """JSON object from its pairs; ValueError for a repeated key."""
    whole = dict(pairs)
    if len(whole) != len(pairs):
        raise ValueError("a key stands twice")
    return whole


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _integer(digits: str) -> int:
    if len(digits) > 20 or not _is_short(number := int(digits)):
        raise ValueError(f"an integer of {len(digits)} digits")
    return number


def _finite(digits: str) -> float:
    if not math.isfinite(number := float(digits)):
        raise ValueError(f"{digits[:40]} is beyond the range of a number")
    return number


def npz_bytes(arrays: Mapping[str, ArrayLike], *, compressed: bool = True) -> bytes:
    """Numpy archive (.npz) of arrays by name; the same names, types and values in the same order
    give the same bytes.
    """
    buffer = io.BytesIO()
    named = {name: np.asarray(values) for name, values in arrays.items()}
    (np.savez_compressed if compressed else np.savez)(buffer, allow_pickle=False, **named)
    return buffer.getvalue()


def read_npz(path: Path) -> dict[str, np.ndarray]:
    """Arrays by name of a numpy archive written by `npz_bytes`.

    No array is made larger than the file can hold: what a header claims is compared with the length
    of its member, and that with its packed length and the length of the file.

    Raises
    ------
    ResultError
        If the file is missing, damaged, holds anything but arrays of numbers and text, or claims
        more than it can hold.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            packed = sum(each.compress_size for each in members)
            length = sum(each.file_size for each in members)
            if packed > path.stat().st_size or length > _ARRAYS_MAX:
                raise ValueError(f"claims {length} bytes, more than it can hold")
            return {each.filename.removesuffix(".npy"): _member(archive, each) for each in members}
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror or error}") from None
    except (
        ValueError, EOFError, KeyError, TypeError, NotImplementedError, RuntimeError, struct.error,
        zipfile.BadZipFile, zlib.error,
    ) as error:  # fmt: skip
        raise ResultError(f"{path}: not an archive of arrays ({error})") from None


def _member(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> np.ndarray:
    """Array of an archive; ValueError if its header claims another size than its member has."""
    if entry.file_size > DEFLATE_RATIO * entry.compress_size:
        raise ValueError(f"{entry.filename} claims {entry.file_size} bytes")
    with archive.open(entry) as stream:
        major, _ = np.lib.format.read_magic(stream)
        read_header = {
            1: np.lib.format.read_array_header_1_0, 2: np.lib.format.read_array_header_2_0,
        }[major]  # fmt: skip
        shape, by_columns, kind = read_header(stream)
        size = math.prod(shape) * kind.itemsize
        if kind.hasobject or size != entry.file_size - stream.tell():
            raise ValueError(f"{entry.filename} claims an array of {kind} {shape}")
        content = bytearray(stream.read(size))
    return np.ndarray(shape, kind, content, order="F" if by_columns else "C")


def files_in(folder: Path) -> Iterator[tuple[str, Path]]:
    """Files under a folder: relative name, then path, sorted, without hidden ones."""
    for file in sorted(folder.rglob("*")):
        parts = file.relative_to(folder).parts
        if file.is_file() and not any(part.startswith(".") for part in parts):
            yield "/".join(parts), file


def file_hashes(folder: Path, wanted: Callable[[str], bool]) -> dict[str, str]:
    """SHA-256 by relative name of the chosen files under a folder."""
    return {name: sha256_of(file) for name, file in files_in(folder) if wanted(name)}


def sha256_of(path: Path) -> str:
    """SHA-256 of a file; ResultError if it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror or error}") from error
