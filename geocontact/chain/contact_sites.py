"""Candidates of a system that makes contact at several places: at one of them, or at all alike.

An effect on law or geometry is offered by each place as if there were no other. At one place its parameters carry the
place's name ("stiffening.thigh.gain"); at all places together one set of parameters serves all, while magnitudes that
are no parameters (reference deflections, middles of ranges) stay those of each place.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from geocontact.chain.candidate import Candidate
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter

Offer = Callable[[System], tuple[Candidate, ...]]


def placed(offer: Offer, system: System, *, together: bool) -> tuple[Candidate, ...]:
    """What `offer` has for each place, and `together` for all of them, where there are several."""
    offered = {place: offer(system.at(place)) for place in system.places}
    found = [at_one(place, one) for place, some in offered.items() for one in some]
    if together and len(offered) > 1:
        variants = zip(*offered.values(), strict=True)
        found += [at_all(dict(zip(offered, alike, strict=True))) for alike in variants]
    return tuple(found)


def at_one(place: str, one: Candidate) -> Candidate:
    """The candidate of a place, in the whole system."""
    names = {p.name: _named(place, p.name) for p in one.parameters}
    return replace(
        one,
        variant=f"{one.variant}.{place}" if one.variant else place,
        parameters=tuple(replace(p, name=names[p.name]) for p in one.parameters),
        link=_linked({place: one}, names),
        neutral={names[name]: value for name, value in one.neutral.items()},
        starts=tuple({names[name]: value for name, value in start.items()} for start in one.starts),
    )


def at_all(alike: Mapping[str, Candidate]) -> Candidate:
    """The same candidate at all places, with the widest bounds of each parameter and the mean of its starts."""
    ones = list(alike.values())
    first = ones[0]
    starts = tuple(
        {name: sum(start[name] for start in same) / len(same) for name in same[0]}
        for same in zip(*(one.starts for one in ones), strict=True)
    )
    parameters = tuple(
        Parameter(
            same[0].name,
            same[0].unit,
            starts[0][same[0].name],
            min(p.lower for p in same),
            max(p.upper for p in same),
        )
        for same in zip(*(one.parameters for one in ones), strict=True)
    )
    names = {p.name: p.name for p in parameters}
    return replace(first, parameters=parameters, link=_linked(alike, names), starts=starts)


def _named(place: str, name: str) -> str:
    """Name of a parameter at a place, "stiffening.gain" → "stiffening.thigh.gain"."""
    effect, _, last = name.rpartition(".")
    return f"{effect}.{place}.{last}"


def _linked(alike: Mapping[str, Candidate], names: Mapping[str, str]) -> Callable[[System], System]:
    """Does at each place what its candidate does there, parameters read by their names in the whole system."""

    def link(system: System) -> System:
        for place, one in alike.items():
            before = system.at(place)
            after = one.link(before)
            law = _added(before.law.slots, after.law.slots, place, names)
            geometry = _added(before.geometry.slots, after.geometry.slots, place, names)
            system = replace(system, law=system.law.having(law), geometry=system.geometry.having(geometry))
        return system

    return link


def _added(before: LawParameters, after: LawParameters, place: str, names: Mapping[str, str]) -> dict[str, Source]:
    """What was added to the numbers of a place, as it is called in the whole system."""
    return {
        f"{place}.{name}": names.get(source, source) if isinstance(source, str) else source
        for name, source in after.sources.items()
        if name not in before.sources
    }
