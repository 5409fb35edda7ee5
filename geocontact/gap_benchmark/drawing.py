"""Which cases a benchmark is made of: how many of each kind, a seed for each, and the case that comes of it."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.gap_benchmark.synthetic import KINDS, SyntheticCase, synthetic_case
from geocontact.gap_benchmark.synthetic.catalogue import SCENES

__all__ = ["ABROAD", "HOME", "KINDS", "SHARES", "SYSTEMS", "Lot", "SyntheticCase", "drawn", "lots", "shares"]

SYSTEMS = tuple(SCENES)
"""Seeds of cases go by their place: a further one comes last."""
SHARES = {"none": 100, "single": 70, "pair": 10, "outside": 10, "absorbed": 3, "fault": 4, "shift": 3}
"""Cases of each kind among 200: half without any effect, most others with one, so that about 60 can be seen."""

HOME, ABROAD = "home", ("recorder", "placement", "inputs")
"""The laboratory that the benchmark has always had, and three others; kinds of laboratories stand beside these."""


@dataclass(frozen=True)
class Lot:
    """A case to be drawn: of which system and kind, its own seed, made of the benchmark's and its place; and where."""

    system: str
    kind: str
    seed: int
    place: int
    laboratory: str = HOME


def shares(cases: int, kinds: Sequence[str] = KINDS) -> dict[str, int]:
    """How many cases of each kind, in proportion to `SHARES`, the largest remainders rounded up."""
    total = sum(SHARES[kind] for kind in kinds)
    exact = {kind: cases * SHARES[kind] / total for kind in kinds}
    found = {kind: int(value) for kind, value in exact.items()}
    for kind in sorted(kinds, key=lambda one: found[one] - exact[one])[: cases - sum(found.values())]:
        found[kind] += 1
    return found


def lots(
    systems: Sequence[str], cases: int, kinds: Sequence[str], seed: int, laboratories: Sequence[str] = (HOME,)
) -> Iterator[Lot]:
    """Every case of a benchmark, laboratories taking turns; a kind gets the same ones whatever else is asked for."""
    for system in systems:
        for kind, count in shares(cases, kinds).items():
            for turn in range(count):
                place, which = divmod(turn, len(laboratories))
                yield Lot(system, kind, seed, place, laboratories[which])


def drawn(lot: Lot) -> SyntheticCase:
    """The labelled case; the same lot gives the same case."""
    where = () if lot.laboratory == HOME else (_key(lot.laboratory),)
    key = (SYSTEMS.index(lot.system), KINDS.index(lot.kind), lot.place, *where)
    sequence = np.random.SeedSequence(lot.seed, spawn_key=key)
    return synthetic_case(lot.system, lot.kind, sequence, laboratory=lot.laboratory)


def _key(laboratory: str) -> int:
    """Key of a laboratory's seeds: its place among the first three, else of its name: another kind changes no case."""
    return ABROAD.index(laboratory) + 1 if laboratory in ABROAD else zlib.crc32(laboratory.encode())
