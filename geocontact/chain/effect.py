"""An effect of the vocabulary, and the candidates that it offers for a system."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from geocontact.chain.candidate import Candidate, Stage
from geocontact.chain.contact_sites import placed
from geocontact.chain.system import System
from geocontact.data.gap.case import LISTED_SYSTEMS


@dataclass(frozen=True)
class Effect:
    """A row of the vocabulary.

    Parameters
    ----------
    name
        As in `diagnosis.json`.
    stage
        Where in the chain it acts.
    systems
        Names of the systems that it applies to; of the listed ones, those that the vocabulary names.
    offer
        Makes the candidates for one of these; none where a system has no channel for it.
    source
        Where the formula is from.
    needs
        Numbers of the law or the geometry that it sets; a system that is not listed gets it where these are free.
    together
        Whether, of several places of contact, all may have it alike; what depends on where a place is may not.

    Examples
    --------
    >>> import geocontact as gc
    >>> from dataclasses import replace
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> system = spring.build((gc.Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
    >>> tare = gc.Parameter("tare.torque", "N m", 0.5, -5.0, 5.0)
    >>> def link(one):
    ...     change = gc.chain.Modifier("tare", 5.0, lambda outputs, movement, values: outputs + values["tare.torque"])
    ...     return replace(one, sensor=one.sensor.having(change))
    >>> def offer(one):
    ...     return (gc.chain.Candidate("tare", "", "sensor", (tare,), link),)
    >>> effect = gc.chain.Effect("tare", "sensor", ("spring",), offer, "drawing 12 of the spring")
    >>> [one.label for one in effect.candidates(system)]
    ['tare']
    """

    name: str
    stage: Stage
    systems: tuple[str, ...]
    offer: Callable[[System], tuple[Candidate, ...]]
    source: str
    needs: tuple[str, ...] = ()
    together: bool = True

    def applies(self, system: System) -> bool:
        """Whether the vocabulary, or else the links of the system, admit it."""
        if system.name in LISTED_SYSTEMS:
            return system.name in self.systems
        links = (system.law.slots, system.geometry.slots)
        return all(any(slots.free(name) for slots in links) for name in self.needs)

    def candidates(self, system: System) -> tuple[Candidate, ...]:
        """Candidates for a system, with bounds from its scale; none where the effect does not apply."""
        if not self.applies(system):
            return ()
        return (
            placed(self.offer, system, together=self.together) if self.needs and system.places else self.offer(system)
        )
