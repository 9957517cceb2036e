"""Commands `keygen` and `sign`: signatures of the record of a run."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import ALTERED, PASSED, DirArgument, say, stdout

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey


def keygen(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Private key to write.")],
    owner: Annotated[
        str, typer.Option("--owner", help="Owner, stated in the public key FILE.pub.")
    ] = "",
) -> int:
    """Make an Ed25519 key: FILE (private, PEM) and FILE.pub (public, OpenSSH).

    The public key is added to the keys that this user trusts. Keys of ssh-keygen -t ed25519, also
    with a passphrase, and of openssl genpkey -algorithm ed25519 serve as well.
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
    folder: DirArgument,
    key: Annotated[
        Path, typer.Option("--key", metavar="FILE", help="Private Ed25519 key, PEM or OpenSSH.")
    ],
    role: Annotated[str, typer.Option("--role", help="prepared, checked or approved.")],
    name: Annotated[str, typer.Option("--name", help="Name of the signer.")],
) -> int:
    """Sign the record of a run in a role; the run must be as recorded.

    Adds a line to signoff.intoto.jsonl and writes no other file. Exit code 0: signed, 4: the run
    differs from its record, 2: error.
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
    made = signatures.sign(folder, _private_key(key), role, name, utc())
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
    secret = typer.prompt(f"passphrase of {file}", hide_input=True, err=True)
    return read_private_key(file, str(secret).encode())
