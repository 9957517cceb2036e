"""Signatures of the sign-off record: in-toto statements in DSSE envelopes, by Ed25519.

``signoff.intoto.jsonl`` has one envelope a line and role. An envelope or statement with other keys
or values than those that `sign run` writes is refused.

References
----------
in-toto Attestation Framework, Statement v1. DSSE v1.0.2, protocol and envelope.
"""

from __future__ import annotations

import base64
import binascii
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from camwright.geometry.errors import CamError, InputError, ResultError
from camwright.pipeline.base.files import each_key_once, read_text, sha256_of, write_atomic
from camwright.pipeline.records.check_document import Role, SignatureRecord
from camwright.pipeline.results import signoff
from camwright.pipeline.results.folder_exchange import staged
from camwright.pipeline.results.signing_keys import ROLES, TrustedKey, bytes_of, fingerprint

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

STATEMENT = "https://in-toto.io/Statement/v1"
PREDICATE = "urn:camwright:signature:v1"
PAYLOAD = "application/vnd.in-toto+json"
_LONGEST_NAME = 100


@dataclass(frozen=True)
class Signature:
    """Valid signature of a run record by a trusted key.

    Parameters
    ----------
    role, name : str   as signed; role is one of `ROLES`
    date : str         UTC, such as ``2026-01-31T12:00:00Z``, by the clock of the signer
    key : str          fingerprint, as `ssh-keygen -l` prints it
    owner : str        of the key, as the file of trusted keys names him
    """

    role: Role
    name: str
    date: str
    key: str
    owner: str = ""

    @property
    def words(self) -> str:
        """Text such as ``approved by A. Meyer, 2026-01-31T12:00:00Z, key SHA256:...``."""
        owner = f" ({self.owner})" if self.owner and self.owner != self.name else ""
        return f"{self.role} by {self.name}, {self.date}, key {self.key}{owner}"

    def as_record(self) -> SignatureRecord:
        """The record of ``check --json``."""
        return {"role": self.role, "name": self.name, "date": self.date, "key": self.key}


class _RefusedError(Exception):
    """Reason why an envelope is no valid signature."""


def encoded(kind: str, payload: bytes) -> bytes:
    """DSSE pre-authentication encoding of a typed payload: the signed bytes.

    References
    ----------
    DSSE v1.0.2, protocol, "Signature Definition".
    """
    name = kind.encode()
    return b"DSSEv1 %d %s %d %s" % (len(name), name, len(payload), payload)


def checked_name(name: str) -> str:
    """Name of a signer without blanks at its ends; InputError if it is empty, too long or has
    characters that cannot be printed.
    """
    name = name.strip()
    if not name or len(name) > _LONGEST_NAME or not name.isprintable():
        limit = f"1 to {_LONGEST_NAME} printable characters"
        raise InputError("--name", " ".join(name.split())[:_LONGEST_NAME], limit)
    return name


def sign(folder: Path, private: Ed25519PrivateKey, role: str, name: str, date: str) -> Signature:
    """Sign the record of a run in a role: add the signature to ``signoff.intoto.jsonl``, the only
    file written.

    Parameters
    ----------
    folder : Path                 of a run as recorded, see `signoff.changes`
    private : Ed25519PrivateKey   of the signer
    role : str                    one of `ROLES`
    name : str                    of the signer
    date : str                    UTC, such as ``2026-01-31T12:00:00Z``

    Raises
    ------
    InputError
        If the role is not one of `ROLES` or the name is not valid.
    ResultError
        If the role is signed already, a signature is of another record, or another process writes
        into the run.
    """
    known = _role(role, ROLES)
    if known is None:
        raise InputError("--role", role, f"one of: {', '.join(ROLES)}")
    name = checked_name(name)
    with staged(folder) as place:
        return _signed(folder, place, private, known, name, date)


def _role(text: str, roles: Iterable[Role]) -> Role | None:
    """The role that a text names; None: none of these."""
    return next((each for each in roles if each == text), None)


def _signed(
    folder: Path, place: Path, private: Ed25519PrivateKey, role: Role, name: str, date: str
) -> Signature:
    """Write the file of all signatures of a run, with a new one added, into a folder; returns the
    new one.

    Parameters
    ----------
    folder : Path                 of the run
    place : Path                  for the file
    private : Ed25519PrivateKey   of the signer
    role, name, date : str        see `sign`

    Raises
    ------
    ResultError
        If the role is signed already, or a signature is of another record.
    """
    file, digest = folder / signoff.SIGNATURES, sha256_of(folder / signoff.NAME)
    before = read_text(file) if file.is_file() else ""
    for number, line in enumerate(before.splitlines(), start=1):
        try:
            _, payload, _ = _opened(line)
            earlier = _statement(payload, digest)
        except _RefusedError as error:
            raise ResultError(f"{file}: line {number}: {error}; delete the file") from None
        if earlier["role"] == role:
            words = f"{role} is signed already, by {earlier['name']}, {earlier['date']}"
            raise ResultError(f"{file}: line {number}: {words}")
    statement = {
        "_type": STATEMENT,
        "subject": [{"name": signoff.NAME, "digest": {"sha256": digest}}],
        "predicateType": PREDICATE,
        "predicate": {"role": role, "name": name, "date": date, "signoffSha256": digest},
    }
    payload = json.dumps(statement, ensure_ascii=False, separators=(",", ":")).encode()
    key = fingerprint(private.public_key())
    signed = private.sign(encoded(PAYLOAD, payload))
    envelope = {
        "payloadType": PAYLOAD,
        "payload": base64.b64encode(payload).decode(),
        "signatures": [{"keyid": key, "sig": base64.b64encode(signed).decode()}],
    }
    ended = before if before.endswith("\n") or not before else f"{before}\n"
    write_atomic(place / file.name, f"{ended}{json.dumps(envelope, separators=(',', ':'))}\n")
    return Signature(role, name, date, key)


def verified(
    folder: Path, trusted: Mapping[str, TrustedKey]
) -> tuple[tuple[Signature, ...], list[str]]:
    """Valid signatures of the record of a run, and faults of the invalid ones, one line each.

    The files of the run are not compared; `signoff.changes` does that.

    Parameters
    ----------
    folder : Path       of the run
    trusted : mapping   keys by fingerprint, of `read_trusted`
    """
    file = folder / signoff.SIGNATURES
    if not file.is_file():
        return (), [f"{signoff.NAME}: is unsigned ({signoff.SIGNATURES} is missing)"]
    try:
        lines = bytes_of(file, signoff.SIGNATURES).decode("utf-8").splitlines()
        digest = sha256_of(folder / signoff.NAME)
    except (CamError, UnicodeDecodeError) as error:
        return (), [f"{signoff.SIGNATURES}: {error}"]
    if not lines:
        return (), [f"{signoff.NAME}: is unsigned ({signoff.SIGNATURES} is empty)"]
    valid: list[Signature] = []
    faults: list[str] = []
    for number, line in enumerate(lines, start=1):
        try:
            one = _verified(line, digest, trusted)
            if one.role in {each.role for each in valid}:
                raise _RefusedError(f"{one.role} is signed twice")
        except _RefusedError as error:
            faults.append(f"{signoff.SIGNATURES}: line {number}: {error}")
        else:
            valid.append(one)
    return tuple(valid), faults


def _verified(line: str, digest: str, trusted: Mapping[str, TrustedKey]) -> Signature:
    """Signature of one envelope, verified with the trusted keys.

    Parameters
    ----------
    line : str          of JSON, the envelope
    digest : str        SHA-256 of the record that is signed
    trusted : mapping   keys by fingerprint

    Raises
    ------
    _RefusedError
        If the key is not trusted or may not sign the role, or signature or hash are wrong. The
        payload of an untrusted key is only quoted in the message.
    """
    from cryptography.exceptions import InvalidSignature

    key, payload, signature = _opened(line)
    known = trusted.get(key)
    if known is None:
        raise _RefusedError(f"untrusted key {key}{_claim(payload, digest)}")
    try:
        known.public.verify(signature, encoded(PAYLOAD, payload))
    except InvalidSignature:
        raise _RefusedError(f"was changed since it was signed with the key {key}") from None
    predicate = _statement(payload, digest)
    role = _role(predicate["role"], known.roles)
    if role is None:
        allowed = ", ".join(known.roles)
        raise _RefusedError(f"the key {key} may not sign {predicate['role']}, only {allowed}")
    return Signature(role, predicate["name"], predicate["date"], key, known.owner)


def _claim(payload: bytes, digest: str) -> str:
    """What the payload of an unverified envelope states, in words for a message; "" where it is no
    statement on the record of hash `digest`.
    """
    try:
        predicate = _statement(payload, digest)
    except _RefusedError:
        return ""
    return f", which says: {predicate['role']} by {predicate['name']}, {predicate['date']}"


def _opened(line: str) -> tuple[str, bytes, bytes]:
    """Fingerprint of the key, payload and signature of an envelope, a line of JSON; nothing is
    verified yet.

    Raises
    ------
    _RefusedError
        If it is no envelope with one signature.
    """
    envelope = _parsed(line, "envelope", ("payloadType", "payload", "signatures"))
    if envelope["payloadType"] != PAYLOAD:
        raise _RefusedError(f"payloadType is not {PAYLOAD}")
    signatures = envelope["signatures"]
    if not isinstance(signatures, list) or len(signatures) != 1:
        raise _RefusedError("must have one signature")
    one = _closed(signatures[0], "signature", ("keyid", "sig"))
    key = one["keyid"]
    if not isinstance(key, str) or not re.fullmatch(r"SHA256:[A-Za-z0-9+/]{43}", key):
        raise _RefusedError("keyid is no fingerprint of a key")
    return key, _decoded(envelope["payload"], "payload"), _decoded(one["sig"], "sig")


def _statement(payload: bytes, digest: str) -> dict[str, str]:
    """Role, name, date and hash that the payload of an envelope states.

    Parameters
    ----------
    payload : bytes   JSON
    digest : str      SHA-256 of the record of the run

    Raises
    ------
    _RefusedError
        If it is no statement on this record.
    """
    keys = ("_type", "subject", "predicateType", "predicate")
    statement = _parsed(payload, "statement", keys)
    if statement["_type"] != STATEMENT or statement["predicateType"] != PREDICATE:
        raise _RefusedError("the statement is of another type")
    predicate = _closed(
        statement["predicate"], "predicate", ("role", "name", "date", "signoffSha256")
    )
    name, date = predicate["name"], predicate["date"]
    if predicate["role"] not in ROLES:
        raise _RefusedError(f"the role is none of {', '.join(ROLES)}")
    if not isinstance(name, str) or not name.strip() or not name.isprintable():
        raise _RefusedError("the name is no printable text")
    if not isinstance(date, str) or not _is_date(date):
        raise _RefusedError("the date is not like 2026-01-31T12:00:00Z")
    subject = [{"name": signoff.NAME, "digest": {"sha256": digest}}]
    if statement["subject"] != subject or predicate["signoffSha256"] != digest:
        raise _RefusedError(f"{signoff.NAME} is not the one {predicate['role']} by {name}, {date}")
    return predicate


def _is_date(text: str) -> bool:
    """Whether a text is a time in UTC such as ``2026-01-31T12:00:00Z``."""
    try:
        datetime.strptime(text, "%Y-%m-%dT%H:%M:%SZ")
    except ValueError:
        return False
    return True


def _parsed(text: str | bytes, what: str, keys: tuple[str, ...]) -> dict[str, Any]:
    """JSON object with exactly the keys `keys`, each once; _RefusedError, naming it `what`, for any
    other text.
    """
    try:
        value = json.loads(text, object_pairs_hook=each_key_once)
    except (ValueError, RecursionError):
        raise _RefusedError(f"the {what} is no JSON object") from None
    return _closed(value, what, keys)


def _closed(value: Any, what: str, keys: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(value, dict) or set(value) != set(keys):
        raise _RefusedError(f"the {what} must have the keys {', '.join(keys)} alone")
    return value


def _decoded(text: Any, what: str) -> bytes:
    """Bytes of a base64 text; _RefusedError, naming it `what`, if it is none."""
    try:
        if not isinstance(text, str):
            raise ValueError
        return base64.b64decode(text, validate=True)
    except (ValueError, binascii.Error):
        raise _RefusedError(f"{what} is not base64") from None
