"""TODO."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.mesh_quality import Quality
from camwright.pipeline.checks.check import Check
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.smoothing.smoothers import Smoother


@dataclass(frozen=True, eq=False)
class ContactMesh:
    """Cam and follower meshed for the contact at their worst angle (rad).

    `name` is that of the follower's body: roller or face.
    """

    theta: float
    half_width: float
    cam: BodyMesh
    follower: BodyMesh
    name: str
    quality: Quality


@dataclass(frozen=True, eq=False)
class Trial:
    """A lift and all that follows from it; `why` says what brought it about.

    synthesis is the record of the constrained synthesis that drew the lift, if one did.
    mesh is None, and the contact unknown (NaN), where the contour cannot exist as a body.
    """

    number: int
    smoother: Smoother | None
    why: str
    lift: Lift
    contour: Contour
    cycles: tuple[Cycle, ...]
    mesh: ContactMesh | None
    checks: tuple[Check, ...]
    certificate: tuple[CertificatePoint, ...] = ()
    synthesis: Mapping[str, Any] | None = None
