"""Set-ups of public full-body models: which one a model has, what it measures in a recording, and weights of markers.

A set-up is stated by places of the body (`data.multibody.model_setups`), a recording's labels are known by place
(`naming`). Where a recording lacks all pairs of a measurement, the pairs that `naming` takes by itself measure its
bodies, and a reservation says so; a body with neither keeps its size.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.motion.naming import AUTO, SOFT, Naming, Where, coverages
from geocontact.data.errors import InputError
from geocontact.data.multibody.body_places import PLACES
from geocontact.data.multibody.markers import MarkerTasks
from geocontact.data.multibody.model import Multibody
from geocontact.data.multibody.model_setups import MODEL_SETUPS, ModelSetup, Weights
from geocontact.io.text.tables import listed

PLANE = 3
"""Markers that fix a segment."""


@dataclass(frozen=True)
class KnownSetup:
    """A set-up, and how the model was known: by its name, by its bodies, or because it was asked for."""

    name: str
    setup: ModelSetup
    by: str


def known_setup(model: Multibody, asked: str) -> KnownSetup:
    """The set-up that is asked for, or that of the model; InputError where none or several fit.

    A model is known by its name, else by its bodies: the set-up whose bodies are all there, with the most of them, and
    of several with the same bodies that whose marker set the model carries.
    """
    if asked != AUTO:
        if asked not in MODEL_SETUPS:
            what, sets = f"'{asked[:40]}' is no set-up", f"auto, {', '.join(MODEL_SETUPS)}"
            raise InputError("", "`model_setup`", what, f"set-ups are: {sets}")
        found = KnownSetup(asked, MODEL_SETUPS[asked], "as asked for")
    else:
        found = _by_name(model) or _by_bodies(model)
    there = {body.name for body in model.bodies}
    lost = tuple(name for name in found.setup.all_bodies if name not in there)
    if len(lost) == len(found.setup.all_bodies):
        raise InputError("", "`model_setup`", f"{model.name} has no body of {found.name}", "give its own with `scale`")
    said = f"set-up {found.name} ({found.setup.source}), {found.by}"
    if lost or found.by.startswith("by its bodies"):
        reserve(f"{said}: is {model.name} one of {found.setup.words}?{f' It has no {listed(lost)}' if lost else ''}")
    else:
        say(said)
    note("model_setup", found.name)
    return found


def _by_name(model: Multibody) -> KnownSetup | None:
    """The set-up with the longest part of its names in the model's: LaiUhlrich before Rajagopal in a name of both."""
    name = "".join(c for c in model.name.lower() if c.isalnum())
    parts = [(part, key) for key, setup in MODEL_SETUPS.items() for part in setup.names if part in name]
    if not parts:
        return None
    _, key = max(parts, key=lambda each: len(each[0]))
    return KnownSetup(key, MODEL_SETUPS[key], f"by the model's name {model.name}")


def _by_bodies(model: Multibody) -> KnownSetup:
    there = {body.name for body in model.bodies}
    whole = {key: setup for key, setup in MODEL_SETUPS.items() if there >= set(setup.all_bodies)}
    if not whole:
        share = {key: len(there & set(setup.all_bodies)) for key, setup in MODEL_SETUPS.items()}
        best = max(share, key=lambda key: share[key] / len(MODEL_SETUPS[key].all_bodies))
        what = f"no set-up is known for {model.name} (bodies: {best} {share[best]} of {_count(best)})"
        raise InputError("", "`model_setup`", what, f"name one of {', '.join(MODEL_SETUPS)}, or leave it out")
    most = max(_count(key) for key in whole)
    fitting = [key for key in whole if _count(key) == most]
    by = f"by its bodies, {most} of {most}"
    if len(fitting) > 1:
        sets = [each.name for each in coverages([m.name for m in model.markers])[:1]]
        carried = [key for key in fitting if set(sets) & set(whole[key].marker_sets)]
        by, fitting = f"{by}, and its markers of {', '.join(sets)}", carried or fitting
    if len(fitting) > 1:
        what = f"{model.name} has the bodies of {' and of '.join(fitting)}"
        raise InputError("", "`model_setup`", what, f"name one: `model_setup` {fitting[0]}")
    return KnownSetup(fitting[0], whole[fitting[0]], by)


def _count(key: str) -> int:
    return len(MODEL_SETUPS[key].all_bodies)


def setup_measures(known: KnownSetup, naming: Naming) -> tuple[str, ...]:
    """Measurements of the set-up by the recording's labels, as `scale` takes them; a sentence has their number.

    A reservation names the bodies that other pairs measure, and those that nothing does.
    """
    labels, there = _labels(naming), {body.name for body in naming.model.bodies}
    own = dict(_each(naming.measures))
    texts: list[str] = []
    instead: list[str] = []
    lost: list[str] = []
    count = whole = pairs_there = pairs_all = 0
    for text in known.setup.measurements:
        bodies, _, pairs = text.partition("=")
        wanted = [body for body in bodies.split(",") if body.partition(":")[0] in there]
        if not wanted:
            continue
        found = [pair for pair in (_pair(each, labels) for each in pairs.split(",")) if pair]
        count, pairs_all = count + 1, pairs_all + len(pairs.split(","))
        whole, pairs_there = whole + bool(found), pairs_there + len(found)
        if found:
            texts.append(f"{','.join(wanted)}={','.join(found)}")
            continue
        for by in dict.fromkeys(own.get(body.partition(":")[0], "") for body in wanted):
            alike = ",".join(body for body in wanted if own.get(body.partition(":")[0], "") == by)
            (instead if by else lost).append(f"{alike}={by}" if by else alike)
    say(f"set-up {known.name}: {whole} of {count} measurements, {pairs_there} of {pairs_all} pairs were recorded")
    if instead:
        reserve(f"{known.name}: pairs that were not recorded, others in their stead: {'; '.join(instead)}")
    if lost:
        reserve(f"{known.name}: nothing measures {', '.join(lost)}: sizes are kept")
    return (*texts, *instead)


def _each(texts: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs by body."""
    return [(body, pairs) for bodies, _, pairs in (t.partition("=") for t in texts) for body in bodies.split(",")]


def _labels(naming: Naming) -> dict[Where, str]:
    made = {m.name for m in naming.model.markers}
    return {n.where: n.label for n in naming.labels if n.where is not None and n.label in made}


def _pair(text: str, labels: Mapping[Where, str]) -> str:
    """Labels of a pair of places; empty where one was not recorded."""
    ends = [labels.get(_place(each)) for each in text.split("/")]
    return "/".join(end for end in ends if end is not None) if None not in ends else ""


def _place(text: str) -> Where:
    """Place and side of asis_r, or of sacrum."""
    return (text[:-2], text[-1]) if text.endswith(("_r", "_l")) else (text, "")


def setup_tasks(known: KnownSetup, naming: Naming, *, standing: bool) -> MarkerTasks:
    """Weights of markers, and of coordinates that the set-up keeps near their defaults.

    A bony place that the source leaves out counts nothing where three others fix its segment. Without them, and at a
    place that the source does not have, a marker counts as much as others on the segment do (`_alike`).
    """
    given = known.setup.standing if standing else known.setup.moving
    used = {m.name for m in naming.model.markers}
    labels = [n for n in naming.labels if n.label in used]
    weighed = [n.body for n in labels if n.where is not None and given.get(n.where[0], 0.0) > 0.0]
    fixed = {body for body in weighed if weighed.count(body) >= PLANE}
    soft, markers, others = naming.weights, {}, []
    for n in labels:
        place = "" if n.where is None else n.where[0]
        left_out = given.get(place) == 0.0 and (n.body in fixed or not PLACES[place].bony)
        own = 0.0 if left_out else given.get(place, 0.0) or _alike(given, place, n.body)
        markers[n.label] = own * (SOFT if soft[n.label] == SOFT else 1.0)
        if not left_out and not given.get(place):
            others.append(n.label)
    if others:
        reserve(
            f"{known.name}: the source has no weight for {listed(tuple(others))}: that of the others on the segment"
        )
    names = {c.name for c in naming.model.coordinates}
    near = {name: (weight, None) for name, weight in known.setup.coordinates.items() if name in names}
    return MarkerTasks(markers, near)


def _alike(given: Weights, place: str, body: str) -> float:
    """Weight of a place that the source lacks: the largest of its body where it is bony, else the smallest.

    Where the source has nothing on the body, the median of all.
    """
    segment = body.removesuffix("_r").removesuffix("_l")
    there = [w for other, w in given.items() if w > 0.0 and PLACES[other].segment == segment]
    if not there:
        return median([w for w in given.values() if w > 0.0])
    return max(there) if place and PLACES[place].bony else min(there)
