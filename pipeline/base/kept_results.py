"""Properties computed on first use and kept in a field, which other owners can take over."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, Protocol, TypeVar, cast, overload


class Keeping(Protocol):
    """A frozen value with the field ``results``, which a copy of it has empty."""

    @property
    def results(self) -> dict[str, object]:
        """Results by name, of the properties that are `KeptResult`."""
        ...


Owner = TypeVar("Owner", bound=Keeping)
Result = TypeVar("Result")


class KeptResult(Generic[Owner, Result]):
    """A property computed on first use and kept in the `results` of its owner.

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
        if owner is None:
            return self
        if self.name not in owner.results:
            owner.results[self.name] = self.make(owner)
        return cast(Result, owner.results[self.name])
