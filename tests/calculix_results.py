"""Results of CalculiX: a deck solved, its file of results read, the contact measured from it."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.certificate import SolvedPair


class Measured(NamedTuple):
    """Contact by CalculiX: p0, Pa; half-width, m; von Mises below the surface of the cam, Pa; force
    on the held bore, N."""

    p0: float
    half_width: float
    von_mises: float
    reaction: float


def solved_by_calculix(program: str, deck: Path) -> str:
    """Run CalculiX on a deck; its output."""
    done = subprocess.run(
        [program, deck.stem], cwd=deck.parent, capture_output=True, text=True, timeout=1800,
        check=False,
    )  # fmt: skip
    if "Job finished" not in done.stdout:
        raise RuntimeError(done.stdout[-2000:])
    return done.stdout


def read_frd(path: Path) -> dict[str, dict[int, list[float]]]:
    """Nodal results by name, the places as ``NODES``, mm: twelve characters a column."""
    read: dict[str, dict[int, list[float]]] = {}
    block: dict[int, list[float]] | None = None
    for line in path.read_text(encoding="ascii", errors="replace").splitlines():
        if line.startswith("    2C"):
            block = read.setdefault("NODES", {})
        elif line.startswith(" -4"):
            block = read.setdefault(line.split()[1], {})
        elif line.startswith((" -3", "    3C")):
            block = None
        elif line.startswith(" -1") and block is not None:
            values = re.findall(r".{12}", line[13:])
            block[int(line[3:13])] = [float(value) for value in values]
    return read


def von_mises(stress: Array) -> Array:
    """Von Mises stress of components xx, yy, zz, xy, yz, zx (6, n)."""
    xx, yy, zz, *shear = stress
    normal = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2)
    return np.asarray(np.sqrt(normal + 3.0 * np.sum(np.square(shear), axis=0)))


def measured(deck: Path, contact: SolvedPair, width: float) -> Measured:
    """Contact in the results of the deck of a contact pair of a width, m.

    p0 by a parabola through the squared pressures of the middle; the half-width is that of an
    ellipse of this p0 under the force on the bore.
    """
    read, frame = read_frd(deck.with_suffix(".frd")), contact.frame
    half = contact.half_width_hertz
    xi, _, pressure = _at(read, "CONTACT", contact, lambda values: values[3])
    middle = (np.abs(xi) < 0.75 * half) & (pressure > 0.0)
    fit = np.polyfit(xi[middle] / half, pressure[middle] ** 2, 2)
    p0 = 1e6 * float(np.sqrt(fit[2] - fit[1] ** 2 / (4.0 * fit[0])))
    xi, above, mises = _at(read, "STRESS", contact, von_mises)
    below = (np.abs(xi) < half) & (above < -0.3 * half) & (above > -3.0 * half)
    text = deck.with_suffix(".dat").read_text(encoding="ascii")
    sums = re.findall(r"total force.*\n\s*\n\s*(\S+)\s+(\S+)", text)
    reaction = float(np.array(sums[-1], dtype=float) @ frame.normal)
    half_width = 2.0 * reaction / (np.pi * width * p0)
    return Measured(p0, half_width, 1e6 * float(mises[below].max()), reaction)


def _at(read, name, contact, quantity):
    """Places along and above the contact, m, and a quantity of the results of a name."""
    nodes = sorted(read[name])
    places = 1e-3 * np.array([read["NODES"][node][:2] for node in nodes]).T
    values = np.array([read[name][node] for node in nodes]).T
    return contact.frame.along(places), contact.frame.above(places), quantity(values)
