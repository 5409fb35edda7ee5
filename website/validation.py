"""The validation report: docs/reference/validation.md, its figures taken from benchmarks/results.

Words stand in validation.toml; a figure in it is a place in a file of results, so that none is copied by hand.
"""

from __future__ import annotations

import json
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from website.stage import ROOT

PAGE = "docs/reference/validation.md"
RESULTS = ROOT / "benchmarks" / "results"
WORDS = Path(__file__).with_name("validation.toml")
FACTORS = {
    "Software quality assurance": "Verification, code",
    "Numerical code verification": "Verification, code",
    "Discretisation error": "Verification, calculation",
    "Numerical solver error": "Verification, calculation",
    "Use error": "Verification, calculation",
    "Model form": "Validation, model",
    "Model inputs": "Validation, model",
    "Test samples": "Validation, comparator",
    "Test conditions": "Validation, comparator",
    "Equivalency of inputs": "Validation, assessment",
    "Output comparison": "Validation, assessment",
    "Relevance of the quantities of interest": "Applicability",
    "Relevance of the validation to the context of use": "Applicability",
}
"""Credibility factors of ASME V&V 40-2018, table 5-1, in its order, with the activity that they belong to."""


def report(words: Path = WORDS) -> str:
    """The whole page."""
    given = tomllib.loads(words.read_text(encoding="utf-8"))
    parts = ["# Validation report", *given["introduction"]]
    if "all" in given:
        parts += ["## All systems", _evidence(given["all"])]
    for name, system in given["system"].items():
        parts += [f"## {name}", _aims(system), _evidence(system["evidence"])]
        parts.append("Without evidence: " + (", ".join(missing(system, given)) or "none") + ".")
        parts.append("**Judgement.** " + system["judgement"])
    return "\n\n".join(parts) + "\n"


def missing(system: dict[str, Any], given: dict[str, Any]) -> list[str]:
    """Credibility factors for which a system has no evidence."""
    there = {*system["evidence"], *given.get("all", {})}
    return [factor.lower() for factor in FACTORS if factor not in there]


def _aims(system: dict[str, Any]) -> str:
    lines = {
        "Question of interest": system["question"],
        "Context of use": system["context"],
        "Model influence": system["influence"],
        "Decision consequence": system["consequence"],
        "Model risk": system["risk"],
    }
    more = " · ".join(f"[{title}]({link})" for title, link in system["more"].items())
    return " ".join([*(f"**{name}.** {words}" for name, words in lines.items()), more])


def _evidence(evidence: dict[str, list[dict[str, Any]]]) -> str:
    unknown = set(evidence) - set(FACTORS)
    if unknown:
        raise ValueError(f"{WORDS.name}: no credibility factors: {', '.join(sorted(unknown))}")
    items = []
    for factor in FACTORS:
        told = [f"{_told(one)} ({_source(one)})." for one in evidence.get(factor, [])]
        items += [f"- *{factor}*: {' '.join(told)}"] if told else []
    return "\n".join(items)


def _told(one: dict[str, Any]) -> str:
    figures = {name: figure(place) for name, place in one.get("figures", {}).items()}
    return str(one["text"].format(**figures))


def _source(one: dict[str, Any]) -> str:
    files = dict.fromkeys(place[0] for place in one.get("figures", {}).values())
    links = ", ".join(f"[`{file}.json`](../../benchmarks/results/{file}.json)" for file in files)
    return links or str(one.get("from", ""))


def figure(place: list[Any]) -> Any:
    """What stands at a place: name of the file of results, then keys and numbers of rows."""
    found = _results(place[0])
    for key in place[1:]:
        found = found[key]
    return found


@cache
def _results(name: str) -> Any:
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
