"""Cases that an earlier run had finished: their results are kept where nothing they rest on has changed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geocontact.analyses.gap.diagnose.many_result import Outcome
from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.run_again import read_run, results_of
from geocontact.analyses.stale_results import RUN, digest
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION

ANSWER = "diagnosis.json"
SOURCES, SAID = "sources", "said"
"""Of the results in run.json: which sources they came of, and the verdict in words."""


def kept(case: Path, folder: Path, o: ManyOptions, sources: str) -> Outcome | None:
    """What an earlier run found of a case, or None where it must be diagnosed again.

    Parameters
    ----------
    folder
        Of its results.
    sources
        Digest of the package's sources now.
    """
    try:
        before = read_run(folder)
        if before.command != "gap diagnose" or before.version != VERSION or case / "case.toml" not in before.inputs:
            return None
        told = json.loads((folder / RUN).read_bytes())
        alike = all(told["options_si"].get(name) == getattr(o, name) for name in ("bare", "run_simulator"))
        if not alike or told["results"][SOURCES] != sources or before.changed():
            return None
        if any(digest(folder / name) != known for name, known in results_of(folder).items()):
            return None
        answer = json.loads((folder / ANSWER).read_bytes())
        return Outcome(case.name, 0, told["results"][SAID], tuple(told["warnings"]), row(answer))
    except (InputError, OSError, KeyError, TypeError, AttributeError, ValueError):
        return None  # nothing there, or not of this make


def run_of(folder: Path) -> str:
    """Mark of the run that results are of."""
    return str(json.loads((folder / RUN).read_bytes())["results"]["run"])


def row(d: Mapping[str, Any]) -> tuple[tuple[str, str | float], ...]:
    """A case in the summary, from what diagnosis.json holds."""
    effects = d["effects"]
    answer = effects or {"no_gap": ("none",), "unknown": ("unknown",)}.get(d["verdict"], ())
    return (
        ("case", d["case"]),
        ("system", d["system"]),
        ("verdict", d["verdict"]),
        ("effects", " + ".join(effects)),
        ("ambiguity", " ".join(d["ambiguity"])),
        ("one_law", " ".join("=".join(group) for group in d.get("one_law", []))),
        ("probability [-]", float(sum(d["probabilities"].get(name, 0.0) for name in answer))),
        ("largest_reduction [-]", max((g["reduction"] for g in d["gap"].values()), default=0.0)),
        ("seconds [s]", round(d["seconds"], 3)),
    )
