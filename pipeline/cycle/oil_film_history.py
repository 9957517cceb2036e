"""The oil film between cam and follower along the turn, as the case asks for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.oil_film import (
    LineFilm,
    MixedFilm,
    lambda_ratio,
    minimum_film,
    mixed_film_where_it_holds,
)

BRINELL = 9.80665e6  # Pa; Vickers and Brinell numbers are alike below 450
_UM = 1e6


@dataclass(frozen=True, eq=False)
class FilmHistory:
    """Least film (n,) m of smooth surfaces and its lambda ratio (n,), where roughness is known.

    mixed, where the case asks for it: rough surfaces by a regression of unverified source, NaN
    where it refuses; refusal, its first words.
    """

    thickness: Array
    ratio: Array | None = None
    mixed: MixedFilm | None = None
    refusal: str = ""

    def __post_init__(self) -> None:
        freeze(self, thickness=self.thickness)

    def columns(self) -> Mapping[str, Array]:
        """SI values by the names of the columns of ``5_cycle.csv``."""
        found = {"film_thickness": self.thickness}
        if self.ratio is not None:
            found["lambda_ratio"] = self.ratio
        if self.mixed is not None:
            found |= {
                "mixed_film": self.mixed.minimum,
                "mixed_film_central": self.mixed.central,
                "asperity_share": self.mixed.asperity_share,
            }
        return found

    def record(self) -> dict[str, object]:
        """What the mixed film is worth, for ``trial.json``; empty where it is not asked for."""
        if self.mixed is None:
            return {}
        known = np.isfinite(self.mixed.minimum)
        least = _UM * float(self.mixed.minimum[known].min()) if known.any() else None
        return {
            "least_um": least,
            "positions_refused": int((~known & np.isfinite(self.thickness)).sum()),
            "refusal": self.refusal,
            "source": self.mixed.source,
        }


def film_history(
    machine: Machine, contact: ContactHistory, entrainment: Array
) -> FilmHistory | None:
    """Oil film at entrainment speeds (n,), m/s; None without a lubricant."""
    oil, modulus = machine.lubricant, machine.contact_modulus
    if oil is None:
        return None
    groups = LineFilm.of(
        contact.line_load,
        contact.relative_radius,
        modulus,
        entrainment,
        oil,
    )
    thickness = minimum_film(groups)
    cam, other = machine.cam.roughness, machine.follower.roughness
    if cam is None or other is None:
        return FilmHistory(thickness)
    ratio = lambda_ratio(thickness, cam, other)
    if oil.film == "smooth":
        return FilmHistory(thickness, ratio)
    mixed, refusal = mixed_film_where_it_holds(
        groups, float(np.hypot(cam, other)), BRINELL * _softer(machine), modulus
    )
    return FilmHistory(thickness, ratio, mixed, refusal)


def _softer(machine: Machine) -> float:
    """Brinell hardness of the softer surface; a case with a mixed film has both."""
    cards = (machine.cam.material, machine.follower.material)
    return min(card.hardness for card in cards if card.hardness is not None)
