"""Where along the chain of the truth something may be hooked in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np
from jaxtyping import Float

from geocontact.gap_benchmark.synthetic.course import InputCourse

Values = Float[np.ndarray, "..."]
"""Over time; at the foot one row per sample and one column per sphere."""


@dataclass(frozen=True)
class Pull:
    """What the interface does: deflection [m], its rate [m/s] and the elastic force [N] over time [s]."""

    time: Float[np.ndarray, " t"]
    deflection: Values
    rate: Values
    elastic: Values


@dataclass(frozen=True)
class Swing:
    """What an arm does at its hinge: angle [rad] with two derivatives, load of its interface [N], over time [s]."""

    time: Float[np.ndarray, " t"]
    angle: Values
    rate: Values
    acceleration: Values
    load: Values


Outputs = Float[np.ndarray, "c t"]


@dataclass(frozen=True)
class Hooks:
    """Functions by place, in physical order; all empty for the base model.

    Parameters
    ----------
    motion
        From the recorded motion to the true one.
    axis
        What is added to a length at an angle: x (elbow), o_x (shoulder), R (knee), the lever of a site.
    attachment
        Deflection left once the attachment has crept: (time, u, k) → u.
    play
        Deflection that reaches the spring.
    spring
        Factor on the elastic force, of (time, u, u').
    beside
        Force in parallel [N].
    series
        How far a spring in series gives way to a force, in the input's unit; needs a law without memory at the elbow.
    hinge
        Torque that holds back the arm of an exoskeleton [N m].
    load
        Added to the outputs.
    sensor
        (rank, outputs → outputs); lower ranks first.
    recorder
        From what the sensors gave, noise and all, to what is written down, sample by sample.
    places
        What is hooked in at one interface of several only.
    """

    motion: tuple[Callable[[InputCourse], InputCourse], ...] = ()
    axis: tuple[Callable[[Values], Values], ...] = ()
    attachment: tuple[Callable[[Float[np.ndarray, " t"], Values, float], Values], ...] = ()
    play: tuple[Callable[[Values], Values], ...] = ()
    spring: tuple[Callable[[Float[np.ndarray, " t"], Values, Values], Values], ...] = ()
    beside: tuple[Callable[[Pull], Values], ...] = ()
    series: tuple[Callable[[Values], Values], ...] = ()
    hinge: tuple[Callable[[Swing], Values], ...] = ()
    load: tuple[Callable[[InputCourse, Mapping[str, float]], Outputs], ...] = ()
    sensor: tuple[tuple[float, Callable[[InputCourse, Outputs], Outputs]], ...] = ()
    recorder: tuple[Callable[[InputCourse, Outputs], Outputs], ...] = ()

    places: Mapping[str, Hooks] = field(default_factory=dict)

    def __add__(self, other: Hooks) -> Hooks:
        places = {name: self.at(name) + other.at(name) for name in {**self.places, **other.places}}
        rows = [one.name for one in fields(self) if one.name != "places"]
        return Hooks(**{name: getattr(self, name) + getattr(other, name) for name in rows}, places=places)

    def at(self, place: str) -> Hooks:
        """What is hooked in at one interface only."""
        return self.places.get(place, Hooks())

    def seen_from(self, place: str) -> Hooks:
        """What one interface sees: what is hooked in there, and everywhere."""
        return replace(self, places={}) + self.at(place)

    @property
    def has_memory_in_law(self) -> bool:
        """Whether the force depends on more than the deflection of the moment."""
        return bool(self.attachment or self.spring or self.beside)

    @property
    def cannot_be_solved(self) -> bool:
        """Whether a spring in series stands somewhere before a law that remembers."""
        seen = [self, *(self.seen_from(place) for place in self.places)]
        return any(one.series and one.has_memory_in_law for one in seen)


BASE = Hooks()


def read(hooks: Hooks, course: InputCourse, outputs: Outputs) -> Outputs:
    """What the sensors make of the outputs."""
    for _, change in sorted(hooks.sensor, key=lambda one: one[0]):
        outputs = change(course, outputs)
    return outputs


def written_down(hooks: Hooks, course: InputCourse, outputs: Outputs) -> Outputs:
    """What the recorder makes of samples."""
    for change in hooks.recorder:
        outputs = change(course, outputs)
    return outputs
