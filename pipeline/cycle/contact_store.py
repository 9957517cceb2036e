"""Store of solved pieces of the contact, to resume an interrupted run."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.base.store import PACKED, Arrays, Store
from camwright.pipeline.contact.contact_pair import ContactPair

ContactStore: TypeAlias = Store[Arrays]
"""Pieces of a contact solution; workers write to it, too."""

NOT_STORED: ContactStore = Store(None, PACKED)

_WALL_ANGLES = 720  # at which the wall that carries enters the key of a piece


def kept_piece(
    store: ContactStore, load_case: str, index: int, key: str, compute: Callable[[], Arrays]
) -> Arrays:
    """Arrays of a piece of the contact by name, from the store, or computed and stored.

    Parameters
    ----------
    index : int          number of the piece in its load case
    key : str            of `piece_key`; a piece of other inputs is computed again
    compute : function   arrays of the piece by name

    Raises
    ------
    ResultError
        If the piece cannot be written.
    """

    def keyed() -> Arrays:
        return {f"a_{name}": values for name, values in compute().items()} | {"key": np.array(key)}

    piece = store.kept(f"{load_case}/{index:06d}", keyed, lambda each: str(each.get("key")) == key)
    return {name[2:]: values for name, values in piece.items() if name.startswith("a_")}


def piece_key(pair: ContactPair, normal_force: Array, *inputs: float) -> str:
    """SHA-256 of all inputs of a stored piece of the contact: pair, normal forces, N, and numbers
    such as angle and mesh size.
    """
    digest = hashlib.sha256(pair.contour.pitch.lift.values.tobytes())
    digest.update(normal_force.tobytes())
    size = pair.width, pair.bore_radius
    digest.update(repr((*size, pair.cam, pair.follower, *inputs)).encode())
    if pair.counter_hole is not None:
        digest.update(np.array([*pair.counter_hole.centre, pair.counter_hole.radius]).tobytes())
    if pair.pulling is not None and pair.wall is not None:
        digest.update(pair.wall(uniform_turn(_WALL_ANGLES)).tobytes())
        digest.update(piece_key(pair.pulling, normal_force, *inputs).encode())
    if pair.turn:
        digest.update(np.array(pair.turn).tobytes())
    if pair.rim_radius is not None:
        digest.update(np.array(pair.rim_radius).tobytes())
    return digest.hexdigest()
