"""The page of effects names every effect, system, parameter, unit and variant that is offered, and no other."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

from geocontact.effects.catalogue import EFFECTS, candidates
from geocontact.systems.sit_to_stand import SITES
from tests.systems.examples import example

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "gap_effects.md"
LISTED = ("elbow", "foot", "shoulder", "knee", "sit_to_stand")


def rows() -> dict[str, list[str]]:
    """Cells by effect."""
    lines = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return {each[0]: each[1:] for each in cells if each[0] != "effect"}


def parameters(cell: str) -> set[tuple[str, str]]:
    """Every name with each of its units."""
    told = re.findall(r"(\w+) \[([^]]+)\]", cell)
    return {(name, unit.strip()) for name, units in told for unit in units.split(",")}


def test_effects_stages_and_systems() -> None:
    told = rows()
    assert list(told) == [one.name for one in EFFECTS]
    for one in EFFECTS:
        stage, systems = told[one.name][:2]
        there = {name for name in LISTED if one.name in {c.name for c in candidates(example(name)[0])}}
        assert stage == one.stage
        assert (set(LISTED) if systems == "all" else set(systems.split(", "))) == there, one.name


def test_parameters_units_and_variants() -> None:
    told, offered, parts, channels = rows(), defaultdict(set), defaultdict(set), set()
    for name in LISTED:
        system = example(name)[0]
        channels |= {*system.inputs, *system.outputs}
        for one in candidates(system):
            offered[one.name] |= {(p.name.rpartition(".")[2], p.unit) for p in one.parameters}
            parts[one.name] |= {*one.label.split(".")[1:]}
    for name, (_, _, _, names, variants) in told.items():
        assert parameters(names) == offered[name], name
        listed = set() if variants == "–" else set(variants.split(", "))
        if listed & {"input", "output"}:
            assert parts[name] - {"forces"} <= channels and (listed - {"input", "output"}) == parts[name] - channels
        elif any("channel" in each or "output" in each for each in listed):
            assert len(listed) == 1 and parts[name], name
        else:
            assert {"site" if part in SITES else part for part in parts[name]} == listed, name
