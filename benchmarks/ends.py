"""Contact of a roller on a shorter cam by finite elements of finite length: cost and CalculiX.

A steel roller of radius 8 mm, 8 mm long, on a cam of radius 20 mm, 5 mm wide, at 200 N/mm;
hexahedra of 20 nodes, a sixth of the half-width across, 0.02 mm at the end of contact. Prints CPU
seconds and memory of the first angle under a tilt, both bodies condensed anew, and the CPU seconds
of further angles of the same bodies at other curvatures, loads and tilts.

At an eighth of the half-width CalculiX solves both blocks, of the same elements, under the contact
pressure: CPU seconds and memory, and the changes of the pressure in the middle and of the mean over
the last 0.1 mm that its displacements make. Without CalculiX (Debian: calculix-ccx) this part is
left out. Beyond a limit the exit code is 1.
"""

from __future__ import annotations

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import resource
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
from calculix_results import solved_by_calculix

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.axial_shape import BodyEnd
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import brick_body, length_contact
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody, FinitePair, Straight
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid
from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.length_tiers import (
    block_compliance,
    block_grid,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import CellSizes, pressure_cells

STEEL = Elastic(210e9, 0.3)
PAIR = FinitePair(
    (FiniteBody(STEEL, 8e-3, BodyEnd(), 8e-3), FiniteBody(STEEL, 5e-3, BodyEnd(), 10e-3)),
    1 / 8e-3 + 1 / 20e-3,
    Straight(),
)
LINE_LOAD, TILT, MEAN_LENGTH = 200e3, 1e-3, 1e-4
FURTHER = ((160.0, 150e3, 0.0), (190.0, 200e3, -5e-4), (175.0, 180e3, 1e-3))
"""Curvature, 1/m, line load, N/m, and tilt, rad, of further angles."""
FIRST_MOST, FURTHER_MOST = (45.0, 3.5e9), 0.2
"""CPU seconds and bytes of the first angle, CPU seconds of each further one."""
OFF_MOST = 1e-4
"""Relative change of the pressures by CalculiX."""

Index = NDArray[np.intp]


def contact_of(
    pair: FinitePair, sizes: CellSizes, line_load: float, tilt: float
) -> tuple[LengthContact, Array]:
    """Contact and the compliance of its cells, which are those of `PAIR` at `LINE_LOAD`."""
    half_width, _ = plane_strain(PAIR, LINE_LOAD * PAIR.contact_length)
    cells = pressure_cells(PAIR, half_width, sizes)
    compliance = _compliance(sizes)
    gap, force = cells.integrated_gap(pair), line_load * pair.contact_length
    return length_contact.solve(cells, compliance, gap, force, tilt=tilt), compliance


@cache
def _compliance(sizes: CellSizes) -> Array:
    half_width, _ = plane_strain(PAIR, LINE_LOAD * PAIR.contact_length)
    cells = pressure_cells(PAIR, half_width, sizes)
    return block_compliance(cells, PAIR.bodies, brick_body.condensed)[0]


def factors(contact: LengthContact) -> tuple[float, float]:
    """Pressure in the middle and mean at the more loaded end, over plane strain."""
    _, p0 = plane_strain(PAIR, LINE_LOAD * PAIR.contact_length)
    return float(contact.centre[0] / p0), float(contact.end_means(MEAN_LENGTH).max() / p0)


def main() -> int:
    beyond = _cost()
    program = shutil.which("ccx")
    if program is None:
        print("no CalculiX: Debian has it in the package calculix-ccx")
        return int(beyond)
    return int(_beside_calculix(program) or beyond)


def _cost() -> bool:
    start = time.process_time()
    contact, _ = contact_of(PAIR, CellSizes(), LINE_LOAD, TILT)
    first = time.process_time() - start
    memory = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    centre, end = factors(contact)
    print(
        f"first angle, tilt {1e3 * TILT:g} mrad: {first:.1f} s (at most {FIRST_MOST[0]:g}), "
        f"{memory / 1e9:.2f} GB (at most {FIRST_MOST[1] / 1e9:g}); "
        f"centre {centre:.4f}, last 0.1 mm {end:.4f} of plane strain",
        flush=True,
    )
    slowest = 0.0
    for curvature, line_load, tilt in FURTHER:
        start = time.process_time()
        contact_of(replace(PAIR, curvature=curvature), CellSizes(), line_load, tilt)
        slowest = max(slowest, time.process_time() - start)
    print(f"each further angle: at most {slowest:.3f} s (at most {FURTHER_MOST:g})", flush=True)
    return first > FIRST_MOST[0] or memory > FIRST_MOST[1] or slowest > FURTHER_MOST


def _beside_calculix(program: str) -> bool:
    start = time.process_time()
    contact, compliance = contact_of(PAIR, CellSizes(per_half_width=8.0), LINE_LOAD, 0.0)
    own = time.process_time() - start
    pressure, cells = contact.pressure[0], contact.cells
    closed = np.zeros(cells.areas.size)
    unknowns = 0
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    for body in PAIR.bodies:
        grid = block_grid(cells, body)
        unknowns += grid.unknowns
        with tempfile.TemporaryDirectory() as folder:
            deck = Path(folder) / "block.inp"
            deck.write_text("\n".join(_deck(grid, body, pressure)) + "\n", encoding="ascii")
            solved_by_calculix(program, deck)
            quarter = _facet_means(grid, deck.with_suffix(".dat"))
        both = np.concatenate([quarter[::-1], quarter])
        closed += both.ravel() * cells.areas
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    other = _corrected(contact, compliance, closed)
    print(
        f"CalculiX, both blocks under the contact pressure at a/8, {unknowns} unknowns: "
        f"{used.ru_utime - before:.0f} s, {used.ru_maxrss / 1e3:.0f} MB; "
        f"here, for every pressure: {own:.0f} s"
    )
    beyond = False
    for name, here, there in zip(
        ("centre", "last 0.1 mm"), factors(contact), factors(other), strict=True
    ):
        off = there / here - 1.0
        beyond |= abs(off) > OFF_MOST
        print(f"{name}: {here:.5f} of plane strain, by CalculiX {100 * off:+.5f} %")
    return beyond


def _corrected(contact: LengthContact, compliance: Array, closed: Array) -> LengthContact:
    """The contact with the pressures at which displacements as CalculiX has them fit the gap.

    Parameters
    ----------
    closed : array (n,)   displacement of both bodies by CalculiX, integrated over the cells, m3
    """
    areas, pressure = contact.cells.areas, contact.pressure[0].ravel()
    active = np.flatnonzero(pressure > 0)
    off = (closed - compliance @ pressure)[active]
    column = areas[active, None]
    matrix = np.block([[compliance[np.ix_(active, active)], -column], [column.T, np.zeros((1, 1))]])
    change = np.linalg.solve(matrix, np.append(-off, 0.0))[:-1]
    corrected = pressure.copy()
    corrected[active] += change
    return replace(contact, pressure=corrected.reshape(contact.pressure.shape))


def _numbers(grid: BrickGrid) -> Index:
    """Node numbers on the lattice of half edges, from 1."""
    shape = [2 * axis.size - 1 for axis in (grid.x, grid.y, grid.z)]
    return 1 + np.arange(np.prod(shape)).reshape(shape)


def _deck(grid: BrickGrid, body: FiniteBody, pressure: Array) -> Iterator[str]:
    """Input of CalculiX of a quarter under the pressures (m, k), Pa: mm, N, MPa."""
    numbers = _numbers(grid)
    odd = sum(np.indices(numbers.shape) % 2)
    axes = [1e3 * np.interp(np.arange(n), np.arange(0, n, 2), axis)
            for n, axis in zip(numbers.shape, (grid.x, grid.y, grid.z), strict=True)]  # fmt: skip
    yield "*NODE,NSET=ALL"
    for i, j, k in np.argwhere(odd <= 1).tolist():
        place = ",".join(f"{axis[at]:.12g}" for axis, at in zip(axes, (i, j, k), strict=True))
        yield f"{numbers[i, j, k]},{place}"
    yield "*ELEMENT,TYPE=C3D20,ELSET=BLOCK"
    counts = [axis.size - 1 for axis in (grid.x, grid.y, grid.z)]
    for element, (i, j, k) in enumerate(product(*map(range, counts)), 1):
        around = numbers[2 * i : 2 * i + 3, 2 * j : 2 * j + 3, 2 * k : 2 * k + 3]
        nodes = [str(around[place]) for place in _C3D20]
        yield f"{element}," + ",".join(nodes[:10]) + ","
        yield ",".join(nodes[10:])
    held = {
        "X": (numbers[0], odd[0]),
        "Y": (numbers[:, 0], odd[:, 0]),
        "BASE": (numbers[..., -1], odd[..., -1]),
        "TOP": (numbers[..., 0], odd[..., 0]),
    }
    for name, (of, odds) in held.items():
        yield f"*NSET,NSET={name}"
        yield from (str(node) for node in of[odds <= 1].tolist())
    material = body.material
    yield from ("*MATERIAL,NAME=M", "*ELASTIC", f"{1e-6 * material.modulus},{material.poisson}")
    yield from ("*SOLID SECTION,ELSET=BLOCK,MATERIAL=M", "*BOUNDARY", "X,1", "Y,2", "BASE,1,3")
    yield from ("*STEP", "*STATIC", "*DLOAD")
    right = pressure[len(pressure) // 2 :]
    for j, i in np.argwhere(right > 0).tolist():
        element = 1 + (i * counts[1] + j) * counts[2]
        yield f"{element},P1,{1e-6 * right[j, i]:.12g}"
    yield from ("*NODE PRINT,NSET=TOP", "U", "*END STEP")


# Nodes of C3D20 in half edges: corners, edges of the first and of the last z, edges along z.
_CORNERS = ((0, 0), (2, 0), (2, 2), (0, 2))
_EDGES = ((1, 0), (2, 1), (1, 2), (0, 1))
_C3D20 = tuple(
    (x, y, z)
    for z, around in ((0, _CORNERS), (2, _CORNERS), (0, _EDGES), (2, _EDGES), (1, _CORNERS))
    for x, y in around
)


def _facet_means(grid: BrickGrid, path: Path) -> Array:
    """Mean displacement (along, across), m, into the block, of the facets of the cells."""
    numbers = _numbers(grid)
    rows = np.genfromtxt(path, skip_header=3)
    displacement = np.zeros(numbers.size + 1)
    displacement[rows[:, 0].astype(int)] = 1e-3 * rows[:, 3]
    top = displacement[numbers[..., 0]]
    across, along = grid.cells
    corners = sum(top[x : x + 2 * across : 2, y : y + 2 * along : 2] for x, y in _CORNERS)
    edges = sum(top[x : x + 2 * across : 2, y : y + 2 * along : 2] for x, y in _EDGES)
    return np.asarray(edges / 3.0 - corners / 12.0).T


if __name__ == "__main__":
    sys.exit(main())
