"""Ed25519 keys: creation, reading, trust.

References
----------
RFC 8032: Ed25519. RFC 4253, sec. 6.6, and RFC 8709: its public key in OpenSSH form.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import read_text, write_atomic
from camwright.pipeline.records.check_document import Role

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import (
        Ed25519PrivateKey,
        Ed25519PublicKey,
    )

ROLES: tuple[Role, ...] = get_args(Role)
"""Roles of a signature, in their order."""
LARGEST = 1 << 20
"""Bytes of a file of keys or signatures; one of either has a few hundred."""
_PEM = re.compile(r"-----BEGIN [A-Z ]+-----.*?-----END [A-Z ]+-----", re.DOTALL)
_OPENSSH = "ssh-ed25519"


class PassphraseError(InputError):
    """Encrypted key read without its passphrase."""


@dataclass(frozen=True)
class TrustedKey:
    """Public key with its owner's name and permitted roles."""

    public: Ed25519PublicKey
    owner: str = ""
    roles: tuple[Role, ...] = ROLES


def fingerprint(public: Ed25519PublicKey) -> str:
    """SHA-256 of a public key in OpenSSH form, as `ssh-keygen -l` prints it."""
    blob = base64.b64decode(_openssh(public).split()[1])
    digest = base64.b64encode(hashlib.sha256(blob).digest()).decode().rstrip("=")
    return f"SHA256:{digest}"


def write_key(path: Path, owner: str = "") -> Path:
    """Make a new Ed25519 key: write the private key (PEM) to `path` and its public key, with the
    owner as comment, to ``PATH.pub`` (OpenSSH); returns the path of the latter.

    Raises
    ------
    ResultError
        If a file exists already or cannot be written.
    """
    from cryptography.hazmat.primitives import serialization
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    private = Ed25519PrivateKey.generate()
    pem = private.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )
    public = path.with_name(f"{path.name}.pub")
    contents = (path, pem, 0o600), (public, _public_line(private.public_key(), owner), 0o644)
    for file, _, _ in contents:
        if os.path.lexists(file):
            raise ResultError(f"{file}: exists already, not overwritten")
    try:
        for file, content, mode in contents:
            handle = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode)
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
    except OSError as error:
        raise ResultError(f"{path}: {error.strerror or error}") from None
    return public


def read_private_key(path: Path, passphrase: bytes | None = None) -> Ed25519PrivateKey:
    """Private Ed25519 key of a PEM or OpenSSH file.

    Parameters
    ----------
    path : Path          of the file
    passphrase : bytes   of an encrypted key; None: not known

    Raises
    ------
    PassphraseError
        If the key is encrypted and the passphrase is missing or wrong.
    InputError
        If the file cannot be read or holds no such key.
    """
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
    from cryptography.hazmat.primitives.serialization import (
        load_pem_private_key,
        load_ssh_private_key,
    )

    content = bytes_of(path, "--key")
    openssh = b"BEGIN OPENSSH PRIVATE KEY" in content
    try:
        key = (load_ssh_private_key if openssh else load_pem_private_key)(content, passphrase)
    except TypeError:
        if passphrase is not None:  # stated for a key that is not encrypted
            return read_private_key(path)
        raise PassphraseError("--key", f"{path}, encrypted", "read with its passphrase") from None
    except ValueError:
        if passphrase is not None:
            raise PassphraseError("--key", str(path), "read with its passphrase") from None
        key = None
    except UnsupportedAlgorithm:
        key = None
    if not isinstance(key, Ed25519PrivateKey):
        limit = "a private Ed25519 key in PEM or OpenSSH form"
        raise InputError("--key", str(path), limit)
    return key


def own_keys() -> Path | None:
    """File of the user's trusted keys; None without a home folder."""
    try:
        if sys.platform == "win32":
            return Path(os.environ["APPDATA"]) / "camwright" / "trusted_keys"
        base = os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config"
    except (KeyError, RuntimeError):
        return None
    return Path(base) / "camwright" / "trusted_keys"


def trust(public: Path) -> Path | None:
    """Add the public key in a file to the trusted keys of the user, `own_keys`; returns that file,
    or None without a home folder.

    Raises
    ------
    ResultError
        If it cannot be written.
    """
    file = own_keys()
    if file is None:
        return None
    known = read_text(file) if file.is_file() else ""
    separated = known if known.endswith("\n") or not known else f"{known}\n"
    return write_atomic(file, separated + read_text(public))


def read_trusted(path: Path | None) -> dict[str, TrustedKey]:
    """Trusted keys by fingerprint; for None those of `own_keys`.

    A line is a public key in OpenSSH form with its owner, before it the roles it may sign where
    they are not all: ``prepared,checked ssh-ed25519 AAAA... A. Meyer``. Empty lines and those from
    ``#`` on are skipped. Public keys in PEM form may stand in the file as well.

    Raises
    ------
    InputError
        If the file cannot be read, a line is none of these, or a key stands twice with other roles.
    """
    if path is None:
        path = own_keys()
        if path is None or not path.is_file():
            return {}
    try:
        text = bytes_of(path, "--trusted").decode("utf-8")
    except UnicodeDecodeError:
        raise InputError("--trusted", str(path), "text in UTF-8") from None
    listed = [TrustedKey(_public(block, path, "PEM block")) for block in _PEM.findall(text)]
    for number, line in enumerate(_PEM.sub(_lines_alone, text).splitlines(), start=1):
        if line.strip() and not line.lstrip().startswith("#"):
            listed.append(_trusted_line(line.strip(), path, number))
    keys: dict[str, TrustedKey] = {}
    for one in listed:
        key = fingerprint(one.public)
        if keys.setdefault(key, one).roles != one.roles:
            raise InputError(
                "--trusted", f"{path}, key {key}", "stated once, or twice with the same roles"
            )
    return keys


def _lines_alone(block: re.Match[str]) -> str:
    """The line ends of a block, so that those after it keep their numbers."""
    return "\n" * block.group().count("\n")


def _trusted_line(line: str, path: Path, number: int) -> TrustedKey:
    """Trusted key of a line of a file: roles, if not all, key in OpenSSH form, owner.

    Parameters
    ----------
    line : str     without blanks at its ends
    path : Path    of the file, for the message
    number : int   of the line, for the message

    Raises
    ------
    InputError
        If it is no such line.
    """
    before, algorithm, after = line.partition(_OPENSSH)
    named = [part for part in before.strip().split(",") if part]
    roles = tuple(role for part in named for role in ROLES if role == part)
    if not algorithm or bool(before) != bool(named) or len(roles) != len(named):
        limit = f"`[{','.join(ROLES)}] {_OPENSSH} KEY [OWNER]`"
        raise InputError("--trusted", f"{path}, line {number}", limit)
    key, _, owner = after.strip().partition(" ")
    public = _public(f"{_OPENSSH} {key}", path, f"line {number}")
    return TrustedKey(public, owner.strip(), roles or ROLES)


def _public(text: str, path: Path, place: str) -> Ed25519PublicKey:
    """Public Ed25519 key of a text in OpenSSH or PEM form; InputError, with file `path` and `place`
    in it, for any other text.
    """
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
    from cryptography.hazmat.primitives.serialization import (
        load_pem_public_key,
        load_ssh_public_key,
    )

    load = load_ssh_public_key if text.startswith(_OPENSSH) else load_pem_public_key
    try:
        key = load(text.encode())
    except (ValueError, UnsupportedAlgorithm):
        key = None
    if not isinstance(key, Ed25519PublicKey):
        raise InputError("--trusted", f"{path}, {place}", "a public Ed25519 key")
    return key


def _openssh(public: Ed25519PublicKey) -> str:
    from cryptography.hazmat.primitives import serialization

    form = serialization.Encoding.OpenSSH, serialization.PublicFormat.OpenSSH
    return public.public_bytes(*form).decode()


def _public_line(public: Ed25519PublicKey, owner: str) -> bytes:
    return f"{_openssh(public)} {owner}".strip().encode() + b"\n"


def bytes_of(path: Path, field: str) -> bytes:
    """Contents of a small file; InputError naming `field` if unreadable or too large."""
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST + 1)
    except OSError as error:
        raise InputError(field, f"{path}: {error.strerror or error}", "a readable file") from None
    if len(content) > LARGEST:
        raise InputError(field, f"{path}, larger", f"at most {LARGEST // 1024} KiB")
    return content
