"""What the contact costs, and how far its tiers are apart.

Prints CPU seconds, which other work on the machine hardly touches: the cycle tier for a whole
turn and per position, one certificate solution with its meshes given and the whole certificate
of eight angles on three meshes, the spread of the tiers,
and the cost of meshing and solving every position in full over that of the cycle tier.

The normal contact of a turn, with its corrections known, has a budget in solutions of 1000 dense
equations on the same core, so that it holds on another machine: 0.2 s where one takes 20 ms. Beyond
it the exit code is 1. The mortar contact of Kratos Multiphysics, whose own Hertz example has p0
within 1.3 %, took 0.153 s a position on a core that takes 20 ms for a dense solution: the ratio to
it, and the error of p0 here, against the extrapolated one of the certificate, are printed as well.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import resource
import sys
import time

import numpy as np
import parts

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.certificate import (
    EDGES,
    certificate_point,
    mesh_figures,
    solve_pair,
)
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.contact_pair import ContactPair, elastic_body
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.full_contact import ContactSide, solve_contact
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history

POSITIONS = 720
ANGLES = 8
SAMPLED = (0, 90, 200)
BUDGET = 10.0  # dense solutions, for the contact of 720 positions
KRATOS = 0.153 / 0.020  # dense solutions, for the contact of one position


def balancing_cam() -> tuple[ContactPair, np.ndarray, np.ndarray]:
    """A cam, roller and spring of the size of the Honda GX120 case."""
    theta = uniform_turn(POSITIONS)
    lift = Lift(theta, 8e-3 * (1 - np.cos(2 * theta)))
    contour = RollerContour(PitchCurve(lift, 50e-3), 8e-3)
    steel = Elastic(210e9, 0.3)
    pair = ContactPair(
        contour, 4.4e-3, 8.5e-3, None, steel, RollerBody(contour.roller_radius, 4.2e-3, steel)
    )
    return pair, theta, 242.0 + 24.2e3 * lift(theta)


def cpu(function):
    """Result of a call and its CPU seconds."""
    start = time.process_time()
    found = function()
    return found, time.process_time() - start


def certificate_with_meshes_given(pair, solved, theta, force):
    """CPU seconds of one full solution at h = a/8 on the meshes of an earlier one."""
    materials = (pair.cam, pair.follower.material)
    sides = tuple(
        ContactSide(elastic_body(side.body.mesh, material, side.body.held), side.surface)
        for side, material in zip(solved.sides, materials, strict=True)
    )
    load = force / pair.width
    width, _ = hertz.line_contact(load, pair.relative_radius(theta), pair.contact_modulus)

    def solve():
        return solve_contact(
            sides, solved.frame, lambda xi: pair.gap(np.array([theta]), xi[None])[0], load,
            float(width),
        )  # fmt: skip

    return cpu(solve)[1]


def main() -> int:
    pair, theta, force = balancing_cam()
    _, template = cpu(lambda: contact_patch(0.3))
    bodies, meshing = cpu(lambda: CycleBodies.meshed(pair))
    history, cycle = cpu(lambda: two_scale_history(pair, bodies, theta, force))
    known = parts.seconds(lambda: two_scale_history(pair, bodies, theta, force))
    unit = parts.dense_solution()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    spread, full, given = 0.0, [], []
    for k in SAMPLED:
        solved, seconds = cpu(lambda k=k: solve_pair(pair, float(theta[k]), float(force[k])))
        full.append(seconds)
        given.append(certificate_with_meshes_given(pair, solved, float(theta[k]), float(force[k])))
        for name in ("p0", "half_width", "tau_max", "von_mises"):
            ratio = getattr(history, name)[k] / getattr(solved.solution, name)
            spread = max(spread, abs(ratio - 1))
    per_position = (cycle + meshing) / POSITIONS
    print(f"patch template (0 when kept)     {template:8.2f} s")
    print(f"bodies meshed                    {meshing:8.2f} s")
    print(f"cycle tier, {POSITIONS} positions        {cycle:8.2f} s")
    print(f"  corrections known              {known:8.2f} s")
    print(f"  in dense solutions             {known / unit:8.1f}, budget {BUDGET:.0f}")
    print(f"  Kratos / it, per position      {POSITIONS * KRATOS * unit / known:8.0f} times")
    print(f"  per position                   {1e3 * per_position:8.2f} ms")
    print(f"  peak memory                    {memory:8.2f} GiB")
    print(f"certificate at a/8, with meshing {np.mean(full):8.2f} s")
    print(f"  meshes given                   {np.mean(given):8.2f} s")
    worst = np.linspace(0, POSITIONS, ANGLES, endpoint=False).astype(int)

    def certified(k: int) -> CertificatePoint:
        at, load = float(theta[k]), float(force[k])
        meshes = [mesh_figures(pair, at, load, edges) for edges in EDGES]
        return certificate_point(history, k, at, meshes)

    signed, seconds = cpu(lambda: [certified(int(k)) for k in worst])
    spread = max(spread, *(point.spread for point in signed))
    print(f"certificate, {ANGLES} angles x 3 meshes {seconds:7.2f} s")
    error = max(abs(point.p0_cycle / point.p0.extrapolated - 1) for point in signed)
    print(f"error of p0 of the cycle tier    {100 * error:8.3f} %, Kratos 1.3 %")
    print(f"tier spread at {len(SAMPLED) + ANGLES} positions      {100 * spread:8.3f} %")
    print(f"remesh and solve / cycle tier    {np.mean(full) / per_position:8.0f} times")
    return 0 if known <= BUDGET * unit else 1


if __name__ == "__main__":
    sys.exit(main())
