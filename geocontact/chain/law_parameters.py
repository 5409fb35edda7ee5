"""Numbers that a compiled link reads, and the parameters or constants that they come from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

Source = str | float | Callable[[Mapping[str, float]], float]
"""A parameter, constant or covariate by its name; a fixed number; or a function of all of them."""


@dataclass(frozen=True)
class LawParameters:
    """Named numbers in a fixed order; those without a source stay neutral, as if their term were not there.

    Parameters
    ----------
    neutral
        Every number of the link in the order in which its kernel reads them, with the value that means "absent".
    sources
        For some of them where they come from: a name, a fixed number, or a function (a stiffness that depends on a
        trial's setting).

    Examples
    --------
    >>> import geocontact as gc
    >>> slots = gc.chain.LawParameters({"k": 0.0, "power": 1.0}).having({"k": "stiffness"})
    >>> slots.numbers({"stiffness": 60.0}).tolist(), slots.free("power")
    ([60.0, 1.0], True)
    >>> list(slots.apart(("thigh", "shank")).neutral)
    ['thigh.k', 'thigh.power', 'shank.k', 'shank.power']
    """

    neutral: Mapping[str, float]
    sources: Mapping[str, Source] = field(default_factory=lambda: MappingProxyType({}))

    def free(self, name: str) -> bool:
        """Whether the link has such a number and nothing sets it yet."""
        return name in self.neutral and name not in self.sources

    def having(self, sources: Mapping[str, Source]) -> LawParameters:
        """The same link with more of its numbers coming from somewhere.

        A number that the link does not know, or that has a source already, is refused: an effect is added once.
        """
        for name in sources:
            if name not in self.neutral:
                raise ValueError(f"this link has no {name}; it has {', '.join(self.neutral)}")
            if name in self.sources:
                raise ValueError(f"{name} is set already, by {self.sources[name]}")
        return replace(self, sources={**self.sources, **sources})

    def apart(self, places: Sequence[str]) -> LawParameters:
        """The same numbers once for every place, "thigh.k"; those of the first place come first."""
        neutral = {f"{place}.{name}": value for place in places for name, value in self.neutral.items()}
        return LawParameters(neutral, {f"{place}.{name}": s for place in places for name, s in self.sources.items()})

    def at(self, place: str) -> LawParameters:
        """The numbers of one place, named as if there were no other."""
        here = f"{place}."
        neutral = {name.removeprefix(here): v for name, v in self.neutral.items() if name.startswith(here)}
        return LawParameters(
            neutral, {name.removeprefix(here): s for name, s in self.sources.items() if name.startswith(here)}
        )

    def numbers(self, values: Mapping[str, float]) -> Float[np.ndarray, " slots"]:
        """All numbers in order; KeyError for a name that has no value."""
        found = self._fixed.copy()
        for place, source in self._open:
            found[place] = source(values) if callable(source) else values[source]
        return found

    @cached_property
    def _fixed(self) -> Float[np.ndarray, " slots"]:
        """Numbers that no parameter changes."""
        fixed = {name: s for name, s in self.sources.items() if not (isinstance(s, str) or callable(s))}
        return np.array([float(fixed.get(name, value)) for name, value in self.neutral.items()])

    @cached_property
    def _open(self) -> tuple[tuple[int, str | Callable[[Mapping[str, float]], float]], ...]:
        """Place and source of the others."""
        places = {name: place for place, name in enumerate(self.neutral)}
        return tuple((places[name], s) for name, s in self.sources.items() if isinstance(s, str) or callable(s))
