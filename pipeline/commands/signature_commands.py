"""Commands `sign key` and `sign run`: signatures of the record of a run."""

from __future__ import annotations

import sys
from getpass import getpass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import ALTERED, PASSED, RunArgument, say, stdout
from camwright.pipeline.results.signing_keys import ROLES

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey


def key(
    file: Annotated[Path, Words("Private key to write.", "FILE")],
    *,
    owner: Annotated[str, Words("Owner, stated in the public key FILE.pub.", "NAME")] = "",
) -> int:
    """Make an Ed25519 key: FILE (private, PEM) and FILE.pub (public, OpenSSH).

    The public key is added to the keys that this user trusts. Keys of ssh-keygen -t ed25519, also
    with a passphrase, and of openssl genpkey -algorithm ed25519 serve as well.

    Example: camwright sign key office.pem --owner "A. Meyer"
    """
    from camwright.pipeline.results import signing_keys

    public = signing_keys.write_key(file, owner)
    stdout.print(f"private key: {file}, keep it to yourself", markup=False)
    stdout.print(f"public key: {public}", markup=False)
    trusted = signing_keys.trust(public)
    if trusted is not None:
        stdout.print(f"trusted by you: added to {trusted}", markup=False)
    return PASSED


def sign(
    folder: RunArgument,
    *,
    private: Annotated[Path, Words("Private Ed25519 key, PEM or OpenSSH.", "FILE", "--key")],
    role: Annotated[str, Words("What the signer did.", "ROLE", choices=ROLES)],
    name: Annotated[str, Words("Name of the signer.", "NAME")],
) -> int:
    """Sign the record of a run in a role; the run must be as recorded.

    Adds a line to signoff.intoto.jsonl and writes no other file.

    Example: camwright sign run runs/pump --key office.pem --role approved --name "A. Meyer"
    """
    from camwright.pipeline.base.progress import utc
    from camwright.pipeline.results import signatures, signoff
    from camwright.pipeline.results.folder_exchange import complete_amendment
    from camwright.pipeline.results.run_reader import read_verdict

    name = signatures.checked_name(name)
    complete_amendment(folder)
    differences = signoff.changes(folder)
    if differences:
        for each in differences:
            say(f"{folder / str(each)}")
        return ALTERED
    made = signatures.sign(folder, _private_key(private), role, name, utc())
    stdout.print(f"verdict: {read_verdict(folder)['verdict_line']}", markup=False)
    stdout.print(f"signed: {made.words}", markup=False)
    return PASSED


def _private_key(file: Path) -> Ed25519PrivateKey:
    """Key of a file; the passphrase of an encrypted one is read from the terminal."""
    from camwright.pipeline.results.signing_keys import PassphraseError, read_private_key

    try:
        return read_private_key(file)
    except PassphraseError:
        if not sys.stdin.isatty():
            limit = "not encrypted, or signed with at a terminal, which reads its passphrase"
            raise InputError("--key", str(file), limit) from None
    secret = getpass(f"passphrase of {file}: ", stream=sys.stderr)
    return read_private_key(file, secret.encode())
