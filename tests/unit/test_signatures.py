"""Signatures of the record of a run: valid ones, and every attack on them and on the folder."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ec import SECP256R1, generate_private_key
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from securesystemslib.dsse import Envelope
from securesystemslib.exceptions import VerificationError
from securesystemslib.signer import SSlibKey
from small_run import TORQUE, check, small_case, summary, values, write_run, write_trial

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import sha256_of
from camwright.pipeline.results import signatures, signing_keys, signoff
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.signatures import encoded, sign, verified
from camwright.pipeline.results.signing_keys import (
    TrustedKey,
    fingerprint,
    read_private_key,
    read_trusted,
)

Command = Callable[..., tuple[int, str, str]]
DATE = "2026-01-31T12:00:00Z"
A, B = (Ed25519PrivateKey.from_private_bytes(bytes([k]) * 32) for k in (1, 2))
TRUSTED = {fingerprint(A.public_key()): TrustedKey(A.public_key(), "A. Meyer")}


@pytest.fixture(autouse=True)
def no_own_keys(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The keys that the user of the tests trusts: none."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("APPDATA", str(tmp_path / "config"))
    return tmp_path / "config" / "camwright" / "trusted_keys"


@pytest.fixture(scope="module")
def original(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A passing run with files of every kind, prepared and approved by A."""
    out = tmp_path_factory.mktemp("signed") / "run"
    with RunFolder(out, small_case()) as folder:
        folder.write("1_torque.csv", values(TORQUE))
        (folder.fields / "stress.vtkhdf").write_bytes(b"field")
        (folder.figures / "lift.png").write_bytes(b"png")
        (folder.path / "8_report.html").write_text("<p>PASS</p>")
        write_trial(folder, [check(limit=2.0)])
        folder.finish(summary())
    sign(out, A, "prepared", "A. Meyer", DATE)
    sign(out, A, "approved", "A. Meyer", DATE)
    return out


@pytest.fixture
def run(original: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(original, tmp_path / "run"))


@pytest.fixture
def trusted(tmp_path: Path) -> Path:
    file = tmp_path / "trusted"
    file.write_text(f"# office\n\n{public_line(A)} A. Meyer\n")
    return file


def public_line(key: Ed25519PrivateKey) -> str:
    form = serialization.Encoding.OpenSSH, serialization.PublicFormat.OpenSSH
    return key.public_key().public_bytes(*form).decode()


def envelopes(run: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (run / signoff.SIGNATURES).read_text().splitlines()]


def write_envelopes(run: Path, made: list[dict[str, Any]]) -> None:
    (run / signoff.SIGNATURES).write_text("".join(f"{json.dumps(each)}\n" for each in made))


def payload(envelope: dict[str, Any]) -> dict[str, Any]:
    decoded: dict[str, Any] = json.loads(base64.b64decode(envelope["payload"]))
    return decoded


def resigned(
    statement: dict[str, Any] | bytes, key: Ed25519PrivateKey = A, kind: str = signatures.PAYLOAD
) -> dict[str, Any]:
    """An envelope of a statement, built here by the words of the specification."""
    body = statement if isinstance(statement, bytes) else json.dumps(statement).encode()
    signed = key.sign(b" ".join(
        (b"DSSEv1", str(len(kind)).encode(), kind.encode(), str(len(body)).encode(), body)
    ))  # fmt: skip
    return {
        "payloadType": kind,
        "payload": base64.b64encode(body).decode(),
        "signatures": [{
            "keyid": fingerprint(key.public_key()), "sig": base64.b64encode(signed).decode(),
        }],
    }  # fmt: skip


# --- what is written


def test_the_encoding_is_that_of_the_specification() -> None:
    """The example of the DSSE protocol, v1.0.2."""
    made = encoded("http://example.com/HelloWorld", b"hello world")
    assert made == b"DSSEv1 29 http://example.com/HelloWorld 11 hello world"
    assert encoded("å", "ü".encode()) == "DSSEv1 2 å 2 ü".encode()


def test_another_library_verifies_the_envelopes(run: Path) -> None:
    public = A.public_key()
    key = SSlibKey.from_crypto(public, keyid=fingerprint(public))
    other = SSlibKey.from_crypto(B.public_key(), keyid=fingerprint(public))
    made = [Envelope.from_dict(each) for each in envelopes(run)]
    assert len(made) == 2
    for each in made:
        assert list(each.verify([key], 1)) == [fingerprint(public)]
        with pytest.raises(VerificationError):
            each.verify([other], 1)


def test_the_statement_is_one_of_in_toto_on_the_record(run: Path) -> None:
    digest = hashlib.sha256((run / "signoff.json").read_bytes()).hexdigest()
    first, second = envelopes(run)
    assert payload(first) == {
        "_type": "https://in-toto.io/Statement/v1",
        "subject": [{"name": "signoff.json", "digest": {"sha256": digest}}],
        "predicateType": "urn:camwright:signature:v1",
        "predicate": {
            "role": "prepared", "name": "A. Meyer", "date": DATE, "signoffSha256": digest,
        },
    }  # fmt: skip
    assert payload(second)["predicate"]["role"] == "approved"
    assert first["payloadType"] == "application/vnd.in-toto+json"


def test_signing_writes_no_other_file(tmp_path: Path) -> None:
    run = write_run(tmp_path / "run")
    before = {p: p.read_bytes() for p in run.rglob("*") if p.is_file()}
    made = sign(run, A, "checked", " Ä. Müller ", DATE)
    assert made.name == "Ä. Müller"
    assert {p: p.read_bytes() for p in run.rglob("*") if p.is_file() and p in before} == before
    assert {p.name for p in run.rglob("*") if p.is_file() and p not in before} == {
        "signoff.intoto.jsonl"
    }
    assert signoff.changes(run) == []
    assert verified(run, TRUSTED) == ((made_by_owner(made),), [])


def made_by_owner(made: signatures.Signature) -> signatures.Signature:
    return signatures.Signature(made.role, made.name, made.date, made.key, "A. Meyer")


def test_the_fingerprint_is_that_of_openssh(tmp_path: Path) -> None:
    """RFC 8032, test 1: the digest of the public key, by the form of RFC 8709 written out here."""
    public = bytes.fromhex("d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a")
    secret = bytes.fromhex("9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60")
    blob = b"\0\0\0\x0bssh-ed25519\0\0\0\x20" + public
    expected = base64.b64encode(hashlib.sha256(blob).digest()).decode().rstrip("=")
    key = Ed25519PrivateKey.from_private_bytes(secret)
    assert fingerprint(key.public_key()) == f"SHA256:{expected}"


@pytest.mark.parametrize(
    ("role", "name", "message"),
    [
        ("owner", "A", "--role = owner, must be one of: prepared, checked, approved"),
        ("checked", " ", "--name = , must be 1 to 100 printable characters"),
        ("checked", "A" * 101, "1 to 100 printable"),
        ("checked", "A\x1b[2J", "1 to 100 printable"),
        ("checked", "A\u202eB", "1 to 100 printable"),
        ("approved", "B", "line 2: approved is signed already, by A. Meyer, 2026"),
    ],
)
def test_what_cannot_be_signed(run: Path, role: str, name: str, message: str) -> None:
    with pytest.raises((InputError, ResultError), match=message):
        sign(run, A, role, name, DATE)


def test_signatures_of_another_record_are_not_added_to(run: Path, tmp_path: Path) -> None:
    other = write_run(tmp_path / "other")
    shutil.copy(run / signoff.SIGNATURES, other)
    with pytest.raises(ResultError, match=r"line 1: signoff\.json is not the one prepared by A"):
        sign(other, A, "checked", "A. Meyer", DATE)
    (other / signoff.SIGNATURES).write_text("{}\n")
    with pytest.raises(ResultError, match="line 1: the envelope must have the keys"):
        sign(other, A, "checked", "A. Meyer", DATE)


# --- keys


def test_keys_of_every_form_are_read(tmp_path: Path) -> None:
    pem, openssh, secret = (tmp_path / name for name in ("pem", "openssh", "secret"))
    none = serialization.NoEncryption()
    phrase = serialization.BestAvailableEncryption(b"phrase")
    pem_form, openssh_form = serialization.PrivateFormat.PKCS8, serialization.PrivateFormat.OpenSSH
    for file, form, lock in (
        (pem, pem_form, none), (openssh, openssh_form, none), (secret, pem_form, phrase),
    ):  # fmt: skip
        file.write_bytes(A.private_bytes(serialization.Encoding.PEM, form, lock))
    for file, given in ((pem, None), (openssh, None), (secret, b"phrase"), (pem, b"phrase")):
        assert fingerprint(read_private_key(file, given).public_key()) in TRUSTED
    for given in (None, b"other"):
        with pytest.raises(signing_keys.PassphraseError, match="read with its passphrase"):
            read_private_key(secret, given)


@pytest.mark.parametrize("content", [b"", b"no key", b"\0" * 99, b"-" * (1 << 21)])
def test_what_is_no_key_is_refused(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "key"
    file.write_bytes(content)
    with pytest.raises(InputError, match=r"--key = .*, must be"):
        read_private_key(file)
    with pytest.raises(InputError, match="a readable file"):
        read_private_key(tmp_path / "none")


def test_a_key_of_another_algorithm_is_refused(tmp_path: Path) -> None:
    key, file = generate_private_key(SECP256R1()), tmp_path / "key"
    file.write_bytes(key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    ))  # fmt: skip
    with pytest.raises(InputError, match="a private Ed25519 key in PEM or OpenSSH form"):
        read_private_key(file)
    file.write_bytes(key.public_key().public_bytes(
        serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    ))  # fmt: skip
    with pytest.raises(InputError, match="PEM block, must be a public Ed25519 key"):
        read_trusted(file)


def test_trusted_keys_of_both_forms_with_owners_and_roles(tmp_path: Path) -> None:
    form = serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    pem = B.public_key().public_bytes(*form).decode()
    file = tmp_path / "trusted"
    file.write_text(f"{pem}\nprepared,checked {public_line(A)} A. Meyer, office\n")
    keys = read_trusted(file)
    assert [(each.owner, each.roles) for each in keys.values()] == [
        ("", ("prepared", "checked", "approved")),
        ("A. Meyer, office", ("prepared", "checked")),
    ]
    for line in ("boss " + public_line(A), "ssh-rsa AAAA", "ssh-ed25519 AAAA", "x"):
        file.write_text(f"{pem}{line}\n")
        with pytest.raises(InputError, match=r"--trusted = .*, line 4, must be"):
            read_trusted(file)
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="text in UTF-8"):
        read_trusted(file)


def test_a_new_key_is_written_trusted_and_never_overwritten(
    tmp_path: Path,
    command: Command,
    no_own_keys: Path,
) -> None:
    run, key = write_run(tmp_path / "run"), tmp_path / "key"
    assert command("sign", "key", key, "--owner", "A. Meyer")[0] == 0
    assert key.stat().st_mode & 0o777 == 0o600
    assert no_own_keys.read_text() == (tmp_path / "key.pub").read_text()
    code, out, _ = command(
        "sign", "run", run, "--key", key, "--role", "approved", "--name", "A. Meyer"
    )
    assert code == 0
    assert "verdict: PASS" in out and "signed: approved by A. Meyer, 2" in out
    code, out, _ = command("check", run, "--verify-record")
    assert code == 0
    assert "signed: approved by A. Meyer, 2" in out
    before = key.read_bytes()
    code, _, err = command("sign", "key", key)
    assert code == 2 and "exists already, not overwritten" in err
    assert key.read_bytes() == before
    no_own_keys.unlink()
    code, _, err = command("check", run, "--verify-record")
    assert code == 4
    assert "no key is trusted: state --trusted FILE" in err and "untrusted key SHA256:" in err


@pytest.mark.skipif(shutil.which("ssh-keygen") is None, reason="no ssh-keygen")
def test_keys_of_ssh_keygen_serve(tmp_path: Path) -> None:
    file = tmp_path / "key"
    subprocess.run(
        ["ssh-keygen", "-q", "-t", "ed25519", "-N", "phrase", "-C", "a@b", "-f", file], check=True
    )
    said = subprocess.run(
        ["ssh-keygen", "-l", "-f", file], check=True, capture_output=True, text=True
    ).stdout
    (key,) = read_trusted(tmp_path / "key.pub")
    assert key == fingerprint(read_private_key(file, b"phrase").public_key()) == said.split()[1]


# --- attacks: code 4, the file or line named


def edited(name: str) -> Callable[[Path], None]:
    def attack(run: Path) -> None:
        content = bytearray((run / name).read_bytes())
        content[len(content) // 2] ^= 1
        (run / name).write_bytes(bytes(content))

    return attack


def deleted(name: str) -> Callable[[Path], None]:
    return lambda run: (run / name).unlink()


def added(name: str) -> Callable[[Path], None]:
    def attack(run: Path) -> None:
        (run / name).parent.mkdir(exist_ok=True)
        (run / name).write_text("new")

    return attack


def forged(run: Path) -> None:
    """A failed check turned to pass, and every hash written anew, as the product writes it."""
    file = run / "trial_1" / "6_checks.json"
    records = json.loads(file.read_text())
    records[0] |= {"limit": 5.0, "utilisation": 0.2}
    file.write_text(json.dumps(records))
    said = json.loads((run / "run.json").read_text())
    said["files"]["trial_1/6_checks.json"] = sha256_of(file)
    (run / "run.json").write_text(json.dumps(said))
    signoff.write(run)


def of_another_run(run: Path) -> None:
    other = write_run(run.with_name("other"))
    shutil.copy(other / "signoff.json", run)


def swapped(run: Path) -> None:
    """Every file of another run but the signatures of this one."""
    kept = (run / signoff.SIGNATURES).read_bytes()
    shutil.rmtree(run)
    write_run(run)
    (run / signoff.SIGNATURES).write_bytes(kept)


def by_another_key(run: Path) -> None:
    write_envelopes(run, [resigned(payload(each), B) for each in envelopes(run)])


def by_another_key_with_this_id(run: Path) -> None:
    made = [resigned(payload(each), B) for each in envelopes(run)]
    for each in made:
        each["signatures"][0]["keyid"] = fingerprint(A.public_key())
    write_envelopes(run, made)


def payload_changed(key: str, value: object) -> Callable[[Path], None]:
    def attack(run: Path) -> None:
        made = envelopes(run)
        statement = payload(made[0])
        statement["predicate"][key] = value
        made[0]["payload"] = base64.b64encode(json.dumps(statement).encode()).decode()
        write_envelopes(run, made)

    return attack


def statement_changed(**changes: object) -> Callable[[Path], None]:
    """Changed and signed again by its own signer."""

    def attack(run: Path) -> None:
        write_envelopes(run, [resigned(payload(envelopes(run)[0]) | changes)])

    return attack


def predicate_changed(**changes: object) -> Callable[[Path], None]:
    def attack(run: Path) -> None:
        statement = payload(envelopes(run)[0])
        statement["predicate"] |= changes
        write_envelopes(run, [resigned(statement)])

    return attack


def envelope_changed(**changes: object) -> Callable[[Path], None]:
    def attack(run: Path) -> None:
        write_envelopes(run, [envelopes(run)[0] | changes])

    return attack


def of_another_type(run: Path) -> None:
    write_envelopes(run, [resigned(payload(envelopes(run)[0]), A, "text/plain")])


def twice_signed(run: Path) -> None:
    made = envelopes(run)
    made[0]["signatures"] *= 2
    write_envelopes(run, made)


def key_twice(run: Path) -> None:
    """Two roles in one signed statement: the reader must not choose."""
    text = json.dumps(payload(envelopes(run)[0]))
    both = text.replace('"role": ', '"role": "approved", "role": ')
    write_envelopes(run, [resigned(both.encode())])


def text(content: str) -> Callable[[Path], None]:
    return lambda run: (run / signoff.SIGNATURES).write_text(content) and None


FILES = (
    "case.toml", "run.json", "1_torque.csv", "8_report.html", "figures/lift.png",
    "fields/stress.vtkhdf", "trial_1/2_lift.csv", "trial_1/3_contour.csv", "trial_1/5_cycle.csv",
    "trial_1/6_checks.json", "trial_1/trial.json",
)  # fmt: skip
ADDED = ("notes.txt", "trial_2/2_lift.csv", "inspection/deviation.csv", ".hidden", "fields/x.vtu")
SIGNED = r"signoff\.intoto\.jsonl: line 1: "
ATTACKS: tuple[tuple[str, Callable[[Path], None], str], ...] = (
    *((f"edited {name}", edited(name), f"{name}: was changed") for name in FILES),
    *((f"deleted {name}", deleted(name), f"{name}: is missing") for name in FILES),
    *((f"added {name}", added(name), f"{name}: was added") for name in ADDED),
    ("forged limits, all hashes recomputed", forged, SIGNED + r"signoff\.json is not the one"),
    ("record of another run", of_another_run, "figures/lift.png: was added"),
    ("signatures of another run", swapped, SIGNED + r"signoff\.json is not the one prepared by A"),
    ("record deleted", deleted("signoff.json"), r"signoff\.json: No such file"),
    ("record emptied", added("signoff.json"), r"signoff\.json: not JSON"),
    ("signature stripped", deleted(signoff.SIGNATURES), r"signoff\.json: is unsigned"),
    ("signatures emptied", text(""), r"signoff\.json: is unsigned"),
    ("another key", by_another_key, SIGNED + "untrusted key SHA256:.*: prepared by A. Meyer"),
    ("another key, this id", by_another_key_with_this_id, SIGNED + "was changed since it was"),
    ("role changed", payload_changed("role", "checked"), SIGNED + "was changed since it was"),
    ("name changed", payload_changed("name", "B"), SIGNED + "was changed since it was signed"),
    ("date changed", payload_changed("date", "2020-01-01T00:00:00Z"), SIGNED + "was changed since"),
    ("role unknown", predicate_changed(role="owner"), SIGNED + "the role is none of prepared"),
    ("role a list", predicate_changed(role=["approved"]), SIGNED + "the role is none of"),
    ("name of control characters", predicate_changed(name="A\x1b[1m"), SIGNED + "the name is no"),
    ("date of words", predicate_changed(date="today"), SIGNED + "the date is not like"),
    ("entry added", predicate_changed(more=1), SIGNED + "the predicate must have the keys"),
    ("hash of words", predicate_changed(signoffSha256="0"), SIGNED + r"signoff\.json is not the"),
    ("no subject", statement_changed(subject=[]), SIGNED + r"signoff\.json is not the one"),
    ("other type", statement_changed(predicateType="x"), SIGNED + "the statement is of another"),
    ("other version", statement_changed(_type="https://in-toto.io/Statement/v0.1"), "another type"),
    ("other payload type", of_another_type, SIGNED + "payloadType is not application"),
    ("payload type relabelled", envelope_changed(payloadType="text/plain"), "payloadType is not"),
    ("no signatures", envelope_changed(signatures=[]), SIGNED + "must have one signature"),
    ("signed twice in a line", twice_signed, SIGNED + "must have one signature"),
    ("role signed twice", lambda run: write_envelopes(run, 2 * envelopes(run)[:1]), "signed twice"),
    ("a key stands twice", key_twice, SIGNED + "the statement is no JSON object"),
    ("payload of no base64", envelope_changed(payload="%"), SIGNED + "payload is not base64"),
    ("no JSON", text("{\n"), SIGNED + "the envelope is no JSON object"),
    ("nested", text("[" * 100_000), SIGNED + "the envelope is no JSON object"),
    ("no text", lambda run: (run / signoff.SIGNATURES).write_bytes(b"\xff") and None, "codec"),
)  # fmt: skip


@pytest.mark.parametrize(("attack", "message"), [
    pytest.param(attack, message, id=name) for name, attack, message in ATTACKS
])  # fmt: skip
def test_an_attack_on_a_signed_run_is_named(
    run: Path,
    trusted: Path,
    command: Command,
    attack: Callable[[Path], None],
    message: str,
) -> None:
    attack(run)
    code, out, err = command("check", run, "--verify-record", "--trusted", trusted)
    assert (code, out) == (4, "")
    assert re.search(f"(?m)^camwright: {run}/.*{message}", err)


def test_a_role_that_its_key_may_not_sign(run: Path, trusted: Path, command: Command) -> None:
    """A signer who signs again in another role."""
    trusted.write_text(f"prepared {public_line(A)} A. Meyer\n")
    code, _, err = command("check", run, "--verify-record", "--trusted", trusted)
    assert code == 4
    assert "line 2: the key SHA256:" in err and "may not sign approved, only prepared" in err
    assert f"{run}: signed: prepared by A. Meyer" in err


def test_the_signers_of_a_run_are_listed(run: Path, trusted: Path, command: Command) -> None:
    code, out, err = command("check", run, "--verify-record", "--trusted", trusted)
    assert (code, err) == (0, "")
    key = fingerprint(A.public_key())
    for role in ("prepared", "approved"):
        assert f"signed: {role} by A. Meyer, {DATE}, key\n  {key}" in out
    document = json.loads(
        command("check", run, "--verify-record", "--trusted", trusted, "--json")[1]
    )
    assert document["signatures"] == [
        {"role": role, "name": "A. Meyer", "date": DATE, "key": key}
        for role in ("prepared", "approved")
    ]


def test_a_signed_run_is_not_written_into(run: Path, command: Command) -> None:
    def files() -> Iterator[tuple[str, bytes]]:
        yield from ((str(p), p.read_bytes()) for p in sorted(run.rglob("*")) if p.is_file())

    before = list(files())
    for arguments in (("report", run), ("contact", "deck", run, "--angle", "10")):
        code, _, err = command(*arguments)
        assert code == 2
        assert f"{run}: is signed, nothing more is written into it" in err or "lacks" in err
    with pytest.raises(ResultError, match="holds a signed run; choose another folder"):
        RunFolder(run, small_case())
    assert list(files()) == before


def test_a_changed_run_is_not_signed(tmp_path: Path, command: Command) -> None:
    run, key = write_run(tmp_path / "run"), tmp_path / "key"
    assert command("sign", "key", key)[0] == 0
    edited("trial_1/5_cycle.csv")(run)
    code, _, err = command("sign", "run", run, "--key", key, "--role", "checked", "--name", "A")
    assert (code, err) == (
        4,
        f"camwright: {run}/trial_1/5_cycle.csv: was changed since the sign-off\n",
    )
    assert not (run / signoff.SIGNATURES).exists()


def test_a_file_that_cannot_be_read_is_an_error_of_the_run(tmp_path: Path) -> None:
    """Not one of the program, which would hide the other runs of a table."""
    with pytest.raises(ResultError, match=r"signoff\.json: No such file"):
        sha256_of(tmp_path / "signoff.json")
