"""Are the system libraries here that gmsh and VTK load, and can Python make environments?

Run by the system's Python before anything is installed, so it needs the standard library only:

    python3 scripts/system_libraries.py

Names the Debian packages that are missing and installs them where it may (root, apt-get).
Exit code 0: all there, 1: something is missing.
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence

LEAST_PYTHON = (3, 11)

# Debian package by what it is loaded as; any one of the names in a row will do.
LIBRARIES: tuple[tuple[tuple[str, ...], str], ...] = (
    (("libGLU.so.1",), "libglu1-mesa"),
    (("libGL.so.1",), "libgl1"),
    (("libXrender.so.1",), "libxrender1"),
    (("libXcursor.so.1",), "libxcursor1"),
    (("libXfixes.so.3",), "libxfixes3"),
    (("libXext.so.6",), "libxext6"),
    (("libXft.so.2",), "libxft2"),
    (("libXinerama.so.1",), "libxinerama1"),
    (("libX11.so.6",), "libx11-6"),
    (("libfontconfig.so.1",), "libfontconfig1"),
    (("libgomp.so.1",), "libgomp1"),
    (("libEGL.so.1", "libOSMesa.so.8"), "libegl1"),
)


def missing_packages(
    load: Callable[[str], object] = ctypes.CDLL,
    find_module: Callable[[str], object] = importlib.util.find_spec,
) -> list[str]:
    """Debian packages whose library cannot be loaded, or whose module cannot be found."""
    packages = [package for names, package in LIBRARIES if not _any_loads(names, load)]
    if find_module("venv") is None or find_module("ensurepip") is None:
        packages.append("python3-venv")
    return packages


def _any_loads(names: Sequence[str], load: Callable[[str], object]) -> bool:
    for name in names:
        try:
            load(name)
        except OSError:
            continue
        return True
    return False


def install(packages: Sequence[str]) -> bool:
    """Install Debian packages; False where that is not allowed or does not work."""
    apt = shutil.which("apt-get")
    if apt is None or os.geteuid() != 0:
        return False
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (
        [apt, "update", "-qq"],
        [apt, "install", "-y", "-qq", "--no-install-recommends", *packages],
    ):
        done = subprocess.run(  # noqa: S603 - the words are fixed
            command, check=False, env=environment, stdout=subprocess.DEVNULL
        )
        if done.returncode:
            return False
    return True


def main() -> int:
    """Look, install, look again; one line where something stays missing."""
    if sys.version_info < LEAST_PYTHON:
        found = ".".join(str(part) for part in sys.version_info[:3])
        say(f"Python {found} is too old, must be >= 3.11: make PYTHON=/path/to/python3.11")
        return 1
    if not sys.platform.startswith("linux"):
        return 0
    packages = missing_packages()
    if not packages:
        return 0
    say(f"missing Debian packages: {' '.join(packages)}")
    if install(packages):
        packages = missing_packages()
    if packages:
        say(f"as root: apt-get install {' '.join(packages)}")
        return 1
    return 0


def say(text: str) -> None:
    print(text, file=sys.stderr)  # noqa: T201 - a script's voice


if __name__ == "__main__":
    sys.exit(main())
