"""The probe that runs before anything is installed."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "system_libraries.py"


@pytest.fixture
def probe() -> ModuleType:
    specification = importlib.util.spec_from_file_location("system_libraries", SCRIPT)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_names_the_package_of_a_missing_library(probe: ModuleType) -> None:
    def load(name: str) -> object:
        if name in ("libGLU.so.1", "libEGL.so.1"):
            raise OSError(name)
        return object()

    assert probe.missing_packages(load, lambda _: object()) == ["libglu1-mesa"]
    assert probe.missing_packages(lambda _: object(), lambda _: None) == ["python3-venv"]
    assert probe.missing_packages(lambda _: object(), lambda _: object()) == []


def test_one_line_says_what_to_install(
    probe: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(probe, "missing_packages", lambda: ["libxft2"])
    monkeypatch.setattr(probe, "install", lambda _: False)
    assert probe.main() == 1
    assert capsys.readouterr().err.splitlines() == [
        "missing Debian packages: libxft2",
        "as root: apt-get install libxft2",
    ]


def test_installs_only_as_root(probe: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    called: list[list[str]] = []

    def record(command: list[str], **_: object) -> subprocess.CompletedProcess[str]:
        called.append(command)
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(probe.subprocess, "run", record)
    monkeypatch.setattr(probe.shutil, "which", lambda _: "/usr/bin/apt-get")
    monkeypatch.setattr(probe.os, "geteuid", lambda: 1000)
    assert probe.install(["libxft2"]) is False
    assert called == []
    monkeypatch.setattr(probe.os, "geteuid", lambda: 0)
    assert probe.install(["libxft2"]) is True
    assert [command[1] for command in called] == ["update", "install"]
    assert called[1][-1] == "libxft2"


def test_old_python_is_named(
    probe: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(probe, "LEAST_PYTHON", (99, 0))
    assert probe.main() == 1
    assert "is too old" in capsys.readouterr().err


def test_needs_the_standard_library_only() -> None:
    done = subprocess.run([sys.executable, "-I", "-S", SCRIPT, "--help"], check=False)
    assert done.returncode in (0, 1)
