"""An effect of the vocabulary, and the candidates that it offers for a system."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from geocontact.chain.candidate import Candidate, Stage
from geocontact.chain.contact_sites import placed
from geocontact.chain.system import System


@dataclass(frozen=True)
class Effect:
    """A row of the vocabulary.

    Parameters
    ----------
    name
        As in `diagnosis.json`.
    stage
        Where in the chain it acts.
    offer
        Makes the candidates for a system; none where a system has no channel for it.
    source
        Where the formula is from.
    needs
        Numbers of the law or the geometry that it sets: it applies where all of them are free, of a system that makes
        contact at several places at each of these.
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
    >>> effect = gc.chain.Effect("tare", "sensor", offer, "drawing 12 of the spring")
    >>> [one.label for one in effect.candidates(system)]
    ['tare']
    """

    name: str
    stage: Stage
    offer: Callable[[System], tuple[Candidate, ...]]
    source: str
    needs: tuple[str, ...] = ()
    together: bool = True

    def __post_init__(self) -> None:
        if not callable(self.offer):  # as it was until effects no longer named systems
            raise TypeError(f"{self.name}: offer comes third; an effect names no systems, only what it `needs`")

    def applies(self, system: System) -> bool:
        """Whether the links of the system have what it needs, and nothing sets it yet."""
        if not self.needs:
            return True
        places = [system.at(place) for place in system.places] or [system]
        links = [(one.law.slots, one.geometry.slots) for one in places]
        return all(any(slots.free(name) for slots in each) for each in links for name in self.needs)

    def candidates(self, system: System) -> tuple[Candidate, ...]:
        """Candidates for a system, with bounds from its scale; none where the effect does not apply."""
        if not self.applies(system):
            return ()
        return (
            placed(self.offer, system, together=self.together) if self.needs and system.places else self.offer(system)
        )
