"""The trial of `full_trial` with one thing changed: a limit, a figure, a shape, a NaN."""

from collections import namedtuple
from dataclasses import replace
from types import SimpleNamespace

import fake_trial as fake
import full_trial as full
import numpy as np

from pipeline.checks.trial import TrialEvidence
from pipeline.contact.convergence import Convergence

NAN = np.full(fake.POSITIONS, np.nan)
Extreme = namedtuple("Extreme", "value theta")
NOWHERE = Extreme(np.nan, np.nan)


def with_case(**changes) -> TrialEvidence:
    return full.evidence(case=full.case(**changes))


def with_limits(**values) -> TrialEvidence:
    limits = fake.changed(full.case().limits, **values)
    return with_case(limits=limits)


def with_part(section: str, **values) -> TrialEvidence:
    """A section of the case changed; the roller under both its names."""
    part = fake.changed(getattr(full.case(), section), **values)
    return with_case(**{section: part}, **({"roller_given": part} if section == "roller" else {}))


def with_material(name: str, **values) -> TrialEvidence:
    materials = full.case().materials
    return with_case(materials=materials | {name: fake.changed(materials[name], **values)})


def with_bearing(**values) -> TrialEvidence:
    return with_part("roller", bearing=fake.changed(full.case().roller.bearing, **values))


def with_ring(**values) -> TrialEvidence:
    return with_bearing(ring=fake.changed(full.case().roller.bearing.ring, **values))


def with_gear(**values) -> TrialEvidence:
    return with_part("camshaft", gear=fake.changed(full.case().camshaft.gear, **values))


def with_guide(side: str, **values) -> TrialEvidence:
    return with_part("guides", **{side: fake.changed(getattr(full.case().guides, side), **values)})


def with_design(**values) -> TrialEvidence:
    return with_part("spring", design=fake.changed(full.case().spring.design, **values))


def with_cycle(**changes) -> TrialEvidence:
    return full.evidence(cycles=(full.cycle(**changes),))


def with_loads(**values) -> TrialEvidence:
    return with_cycle(loads=fake.changed(full.cycle().loads, **values))


def with_contact(**values) -> TrialEvidence:
    return with_cycle(contact=fake.changed(full.cycle().contact, **values))


def with_guides(**values) -> TrialEvidence:
    return with_cycle(guides=fake.changed(full.cycle().guides, **values))


def with_rolling(**values) -> TrialEvidence:
    return with_cycle(rolling=fake.changed(full.cycle().rolling, **values))


def with_map(**values) -> TrialEvidence:
    return with_rolling(envelope=fake.changed(full.cycle().rolling.envelope, **values))


def with_parts(**values) -> TrialEvidence:
    return with_cycle(parts=full.parts(**values))


def with_certificate(**values) -> TrialEvidence:
    points = (fake.CERTIFICATE[0], fake.changed(fake.CERTIFICATE[1], **values))
    return full.evidence(certificate=points)


def on_contour(**values) -> TrialEvidence:
    """A contour that tells of itself just this; its pitch curve under `pitch_*`."""
    lift = {"closure": np.nan, "highest": NOWHERE, "search_count": 72}
    lift |= {k.removeprefix("lift_"): v for k, v in values.items() if k.startswith("lift_")}
    pitch = {"lift": SimpleNamespace(**lift), "base_radius": fake.BASE, "offset": 0.0}
    pitch["height_base"] = fake.BASE
    pitch |= {k.removeprefix("pitch_"): v for k, v in values.items() if k.startswith("pitch_")}
    own = {k: v for k, v in values.items() if not k.startswith(("lift_", "pitch_"))}
    shape = SimpleNamespace(pitch=SimpleNamespace(**pitch), roller_radius=fake.ROLLER, **own)
    return full.evidence(contour=shape)


def hollow(evidence: TrialEvidence | None = None) -> TrialEvidence:
    return replace(evidence or full.evidence(), contour=full.hollow())


def soft(**values) -> TrialEvidence:
    """A cam without a hardened case."""
    card = {"case_depth": None, "treatment": "through_hardened"}
    return with_material("steel", **(card | values))


def faced(**values) -> TrialEvidence:
    """A flat face of 20 mm instead of the roller, its contact 3 mm off the axis."""
    face = {"width": 0.02, "pv_limit": 200e6, "source": "f", "material": "hard"}
    base = full.case()
    case = fake.changed(
        base, follower=fake.changed(base.follower, face=SimpleNamespace(**(face | values)))
    )
    push = {"push_arm": lambda theta: 0.003 + 0.0 * theta, "lift": fake.contour().pitch.lift}
    shape = SimpleNamespace(roller_radius=np.inf, pitch=SimpleNamespace(**push))
    sliding = SimpleNamespace(pv=100e6 + 50e6 * full.WAVE)
    cycle = full.cycle(rolling=fake.changed(full.cycle().rolling, sliding=sliding))
    return full.evidence(case=case, contour=shape, cycles=(cycle,))


def crossings(count: int) -> TrialEvidence:
    return on_contour(self_intersections=lambda: [(0.5, 0.0)] * count)


def reversing(count: int) -> TrialEvidence:
    return with_parts(reversals=(SimpleNamespace(slope=1.0),) * count)


def lossy() -> TrialEvidence:
    """A cam whose torque pays one part in ten million more than the guides' heat."""
    loads = full.cycle().loads
    spent = loads.cam_torque - (loads.spring_force + loads.inertia_force) * loads.lift_slope
    return with_loads(cam_torque=loads.cam_torque + 1e-7 * spent)


def meshed(gci: float) -> Convergence:
    return Convergence((1.0, 1.0, 1.0), 1.0, 2.0, gci)


def benchmark(name: str):
    return lambda off: full.evidence(benchmarks=fake.BENCHMARKS | {f"{name}_half_width": off})
