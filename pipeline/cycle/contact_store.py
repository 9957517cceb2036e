"""Store of solved pieces of the contact, to resume an interrupted run."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.contact_pair import ContactPair


class ContactStore(Protocol):
    """Pieces of a contact solution, kept over an interruption; workers write to it, too."""

    def load(self, load_case: str, key: str) -> Mapping[int, Mapping[str, Array]]:
        """Pieces of a load case and a key, by index."""
        ...

    def save(self, load_case: str, index: int, arrays: Mapping[str, Array], key: str) -> None:
        """Store a piece."""
        ...


class NotStored:
    """A store without effect."""

    def load(self, load_case: str, key: str) -> Mapping[int, Mapping[str, Array]]:  # noqa: ARG002
        return {}

    def save(self, load_case: str, index: int, arrays: Mapping[str, Array], key: str) -> None: ...


NOT_STORED = NotStored()


def piece_key(pair: ContactPair, normal_force: Array, *inputs: float) -> str:
    """SHA-256 of the inputs of a piece: the pair, its normal forces, N, and all others."""
    digest = hashlib.sha256(pair.contour.pitch.lift.values.tobytes())
    digest.update(normal_force.tobytes())
    size = pair.width, pair.bore_radius
    digest.update(repr((*size, pair.cam, pair.follower, *inputs)).encode())
    if pair.counter_hole is not None:
        digest.update(np.array([*pair.counter_hole.centre, pair.counter_hole.radius]).tobytes())
    return digest.hexdigest()
