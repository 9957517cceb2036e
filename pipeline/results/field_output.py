"""Field files of a run: contact at its maximum, bodies and patch over the turn, stress map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from camwright.meshes.mesh_files import write_sheet
from camwright.pipeline.base.files import npz_bytes, write_atomic
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.rolling_envelope import Envelope
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.certificate_angles import positions_to_certify
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.rolling_history import MAPS
from camwright.pipeline.results.contact_patch_series import write_patches
from camwright.pipeline.results.recorded_turn import turn_view
from camwright.pipeline.results.stress_fields import IntArray, write_bodies, write_contact
from camwright.pipeline.results.trial import Trial

BODIES_STEP = np.radians(5.0)
ENVELOPE = "envelope.vtu"
TURN = "turn.npz"
_MEGAPASCAL = 1e6


def write_fields(
    folder: Path, final: Trial, advance: Callable[[int, int], None] = lambda *_: None
) -> None:
    """Write ``fields/`` of a trial; nothing if the contour encloses no body.

    Series and map are those of the load case with the maximum contact pressure.
    """
    if final.mesh is None:
        return
    pair = final.cycles[0].pair
    index = round(final.mesh.theta / (final.cycles[0].theta[1] - final.cycles[0].theta[0]))
    force = max(float(cycle.loads.normal_force[index]) for cycle in final.cycles)
    write_contact(
        folder / "contact_worst.vtu", solve_pair(pair, final.mesh.theta, force), pair.follower.name
    )
    chosen = hardest(final.cycles)
    cycle = final.cycles[chosen]
    certified = positions_to_certify(final.cycles, final.case.solver.certificate_positions)
    indices = shown_positions(cycle, [k for number, k in certified if number == chosen])
    bodies = cycle.bodies or CycleBodies.meshed(pair)
    write_bodies(folder, pair, bodies, cycle, indices, chosen + 1, advance)
    write_patches(folder, pair, bodies, cycle, chosen + 1, advance)
    write_envelope(folder / ENVELOPE, pair, cycle.rolling.envelope, chosen + 1)
    write_atomic(folder / TURN, npz_bytes(turn_view(pair, bodies, cycle)))


def hardest(cycles: Sequence[Cycle]) -> int:
    """Number, from 0, of the load case with the maximum contact pressure."""
    return int(np.argmax([cycle.contact.p0_hertz.max() for cycle in cycles]))


def shown_positions(cycle: Cycle, certified: Sequence[int]) -> IntArray:
    """Positions at every `BODIES_STEP`, and the certified ones."""
    stride = max(1, round(BODIES_STEP / (cycle.theta[1] - cycle.theta[0])))
    return np.union1d(np.arange(0, cycle.theta.size, stride), np.array(certified, dtype=np.int64))


def write_envelope(path: Path, pair: ContactPair, map_: Envelope, number: int) -> None:
    """Maximum stresses of a turn in a band under the contour, in the cam frame.

    Depths are along the inward normal; `number` is that of the load case, from 1.
    """
    at, normal = pair.contour.points(map_.theta), pair.contour.normal(map_.theta)
    points = at[:, :, None] - normal[:, :, None] * map_.depth
    fields = {
        f"{name}_MPa": values / _MEGAPASCAL
        for name in MAPS
        if (values := getattr(map_, name)) is not None
    }
    places = {
        "depth_mm": map_.depth * 1e3,
        "cam_angle_deg": np.broadcast_to(np.degrees(map_.theta)[:, None], map_.depth.shape),
    }
    write_sheet(path, points, fields | places, {"load_case_number": number})
