"""Markers called otherwise in the laboratory than in the model: given a map, or told which names are alike."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.quantities import named_file
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map
from geocontact.io.text.column_names import near_names
from geocontact.io.text.tables import listed

MANY = 80  # names that a message still lists: marker sets of whole bodies


def renamed(seen: MarkerTrajectories, model: Multibody, given: str | None) -> MarkerTrajectories:
    """Recorded markers by the model's names, as `markers_map` says; others keep theirs."""
    if given is None:
        return seen
    file = named_file(given)
    names = marker_map_typed(given, "`markers_map`") if file is None else read_marker_map(file)
    if file is not None:
        add_input("`markers_map`", file, markers=len(names))
    own = {m.name for m in model.markers}
    usable = {lab: name for lab, name in names.items() if lab in seen.names and name in own}
    if not usable:
        what = f"names no recorded marker and one of the model together ({_pairs(names)})"
        raise InputError(file or "", "`markers_map`", what, names_told(seen, model))
    lost, foreign = [lab for lab in names if lab not in seen.names], [n for n in names.values() if n not in own]
    for what, which, there in (("was not recorded", lost, seen.names), ("is not in the model", foreign, tuple(own))):
        if which:
            near = near_names(which, there)
            hint = f"; perhaps {', '.join(near.values())}" if near else ""
            reserve(f"`markers_map`: {listed(tuple(which))} {what}{hint}")
    try:
        return seen.renamed(usable)
    except ValueError as error:
        raise InputError(file or "", "`markers_map`", str(error), "map that one too, or leave it out") from error


def names_told(seen: MarkerTrajectories, model: Multibody) -> str:
    """The names of both sides, and a map where they are nearly alike."""
    own = tuple(m.name for m in model.markers)
    both = f"recorded are: {listed(seen.names, MANY)}; the model's are: {listed(own, MANY)}"
    hint = map_hint(seen, [name for name in own if name not in seen.names])
    return f"{both}; {hint}" if hint else both


def map_hint(seen: MarkerTrajectories, wanted: Sequence[str]) -> str:
    """What to pass where wanted markers are nearly called like recorded ones; empty where none is."""
    near = near_names(wanted, [name for name in seen.names if name not in wanted])
    return f"perhaps `markers_map` {_pairs({lab: name for name, lab in near.items()})}" if near else ""


def _pairs(names: dict[str, str]) -> str:
    text = ",".join(f"{lab}={name}" for lab, name in names.items())
    return f'"{text}"' if " " in text else text
