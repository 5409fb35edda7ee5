"""The page of effects names every effect, system, parameter, unit and variant that is offered, and no other."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import pytest

from geocontact.effects.catalogue import EFFECTS, candidates
from geocontact.systems.sit_to_stand import SITES
from tests.elsewhere import Elsewhere
from tests.systems.examples import example

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "gap_effects.md"
LISTED = ("elbow", "foot", "shoulder", "knee", "sit_to_stand")


@dataclass(frozen=True)
class Offered:
    """A candidate: its effect, what its label adds to that, names of its parameters behind the last dot and units."""

    name: str
    parts: tuple[str, ...]
    parameters: tuple[tuple[str, str], ...]
    called: tuple[str, ...]


def offered() -> dict[str, tuple[set[str], list[Offered]]]:
    """Channels and candidates by system."""
    found = {}
    for name in LISTED:
        system = example(name)[0]
        channels = {*system.inputs, *system.outputs}
        some = [
            Offered(
                one.name,
                tuple(one.label.split(".")[1:]),
                tuple((p.name.rpartition(".")[2], p.unit) for p in one.parameters),
                tuple(p.name for p in one.parameters),
            )
            for one in candidates(system)
        ]
        found[name] = (channels, some)
    return found


@pytest.fixture(scope="module")
def there(elsewhere: Elsewhere) -> dict[str, tuple[set[str], list[Offered]]]:
    return elsewhere(offered)


def rows() -> dict[str, list[str]]:
    """Cells by effect."""
    lines = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return {each[0]: each[1:] for each in cells if each[0] != "effect"}


def parameters(cell: str) -> set[tuple[str, str]]:
    """Every name with each of its units."""
    told = re.findall(r"(\w+) \[([^]]+)\]", cell)
    return {(name, unit.strip()) for name, units in told for unit in units.split(",")}


def test_effects_stages_and_systems(there: dict[str, tuple[set[str], list[Offered]]]) -> None:
    told = rows()
    assert list(told) == [one.name for one in EFFECTS]
    for one in EFFECTS:
        stage, systems = told[one.name][:2]
        listed = {name for name, (_, some) in there.items() if one.name in {each.name for each in some}}
        assert stage == one.stage
        assert (set(LISTED) if systems == "all" else set(systems.split(", "))) == listed, one.name


def test_parameters_units_and_variants(there: dict[str, tuple[set[str], list[Offered]]]) -> None:
    told, units, parts, channels = rows(), defaultdict(set), defaultdict(set), set()
    for own, some in there.values():
        channels |= own
        for one in some:
            units[one.name] |= set(one.parameters)
            parts[one.name] |= set(one.parts)
    for name, (_, _, _, names, variants) in told.items():
        assert parameters(names) == units[name], name
        listed = set() if variants == "–" else set(variants.split(", "))
        if listed & {"input", "output"}:
            assert parts[name] - {"forces"} <= channels and (listed - {"input", "output"}) == parts[name] - channels
        elif any("channel" in each or "output" in each for each in listed):
            assert len(listed) == 1 and parts[name], name
        else:
            assert {"site" if part in SITES else part for part in parts[name]} == listed, name


def test_parameters_are_called_by_label_and_name(there: dict[str, tuple[set[str], list[Offered]]]) -> None:
    told = " ".join(PAGE.read_text(encoding="utf-8").split())
    assert "only that `buffer` and `thinning` have the names of the form without" in told
    for _, some in there.values():
        for one in some:
            label = ".".join((one.name, *(part for part in one.parts if part not in ("buffer", "thinning"))))
            assert one.called == tuple(f"{label}.{name}" for name, _ in one.parameters)
