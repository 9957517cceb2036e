"""A loaded cam of stated fields, for demands by hand without a cycle."""

from typing import Any

import numpy as np

from camwright.geometry.lift import Jet
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers

STILL = Jet(*(np.zeros(1) for _ in range(4)))


class GivenCam(LoadedCam):
    """A loaded cam that states some of its members; the others follow from its lift and numbers.

    ``GivenCam(numbers, normal=[300.0, 250.0], least_spring=100.0)``
    """

    def __init__(self, numbers: Numbers, jet: Jet = STILL, highest: float = 0.0, **given: Any):
        unknown = [name for name in given if not hasattr(LoadedCam, name)]
        assert not unknown, f"a loaded cam has no {unknown}"
        super().__init__(jet, numbers, highest)
        stated = {
            name: np.asarray(value) if isinstance(value, list) else value
            for name, value in given.items()
        }
        object.__setattr__(self, "given", stated)

    def __getattribute__(self, name: str) -> Any:
        given = super().__getattribute__("__dict__").get("given", {})
        return given[name] if name in given else super().__getattribute__(name)
