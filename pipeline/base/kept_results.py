"""Cached properties whose results a modified copy can take over."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, Protocol, TypeVar, cast, overload


class Keeping(Protocol):
    """Frozen value with a field ``results`` of cached results; a copy starts with none."""

    @property
    def results(self) -> dict[str, object]:
        """Cached results by name of the `KeptResult` properties."""
        ...


Owner = TypeVar("Owner", bound=Keeping)
Result = TypeVar("Result")


class KeptResult(Generic[Owner, Result]):
    """Property computed on first use and cached in the `results` of its owner.

    `functools.cached_property` keeps its result out of reach: an owner that differs in what a
    result does not depend on takes it over by `results`.
    """

    def __init__(self, make: Callable[[Owner], Result]) -> None:
        self.make, self.name, self.__doc__ = make, make.__name__, make.__doc__

    @overload
    def __get__(self, owner: None, kind: type) -> KeptResult[Owner, Result]: ...
    @overload
    def __get__(self, owner: Owner, kind: type) -> Result: ...
    def __get__(self, owner: Owner | None, kind: type) -> Result | KeptResult[Owner, Result]:
        """Result of the property for its owner, computed on first use; of the class the property
        itself.
        """
        if owner is None:
            return self
        if self.name not in owner.results:
            owner.results[self.name] = self.make(owner)
        return cast(Result, owner.results[self.name])
