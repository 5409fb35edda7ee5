"""Markers known by name: the marker set of a recording from its labels, and each label's marker of the model.

A set is recognised by how many of its labels were recorded. Its labels are tied to the markers of the model that sit at
the same anatomical place; where the model has none, a marker is put on the segment at the place of
`data.multibody.marker_sets`, in proportion to the model's segments. The model takes the labels of the recording.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.collector import reserve
from geocontact.data.errors import InputError
from geocontact.data.multibody.body_places import PLACES, Side
from geocontact.data.multibody.marker_labels import normalised
from geocontact.data.multibody.marker_sets import KEYPOINTS, MARKER_SETS
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from geocontact.dynamics.inverse_kinematics import FEWEST
from geocontact.io.text.tables import listed
from geocontact.view.page.content import Table

AUTO = "auto"
SOFT = 0.1
"""Weight of wands and clusters that a table placed against 1 of the others, before a static pose has moved them."""

PLACED = "placed by the table"
Where = tuple[str, Side]
LENGTHS = {
    "femur": ("femur{s}", "tibia{s}", 0.396),
    "tibia": ("tibia{s}", "talus{s}", 0.430),
    "calcn": ("calcn{s}", "toes{s}", 0.1788),
    "pelvis": ("femur_r", "femur_l", 0.167),
    "humerus": ("humerus{s}", "ulna{s}", 0.2867),
}
"""Bodies whose origins span a segment, and their distance in gait2392 (the arm: Rajagopal 2016) [m]."""
MEASURES = {
    "pelvis": (("asis", "asis"), ("hip_centre", "hip_centre")),
    "femur": (("hip_centre", "knee_centre"), ("hip_centre", "knee_lateral"), ("asis", "knee_lateral")),
    "tibia": (("knee_centre", "ankle_centre"), ("knee_lateral", "ankle_lateral")),
    "calcn": (("heel", "metatarsal_2"), ("heel", "toe_tip"), ("heel", "metatarsal_5")),
    "torso": (("c7", "sacrum"), ("acromion", "asis")),
    "humerus": (("shoulder_centre", "elbow_lateral"), ("acromion", "elbow_lateral")),
    "ulna": (("elbow_lateral", "wrist_radial"),),
}
"""Places whose distance measures a segment, the best pair first."""
GROWS_ALONG = {"femur": ("femur", "patella"), "calcn": ("talus", "calcn", "toes"), "ulna": ("ulna", "radius", "hand")}


@dataclass(frozen=True)
class Coverage:
    """How much of a set was recorded.

    Parameters
    ----------
    found
        Place by recorded label of the set.
    size
        Labels of the set.
    further
        Place by recorded label of other sets, which all give it this one.
    donors
        Sets that such a label is of, in words.
    """

    name: str
    found: Mapping[str, Where]
    size: int
    further: Mapping[str, Where] = field(default_factory=dict)
    donors: Mapping[str, str] = field(default_factory=dict)

    @property
    def words(self) -> str:
        """In one clause, with the only side."""
        sides = {side for _, side in self.found.values()} - {""}
        only = {"r": ", right side only", "l": ", left side only"}[min(sides)] if len(sides) == 1 else ""
        return f"{self.name} {len(self.found)} of {self.size}{only}"


def coverages(labels: Sequence[str]) -> tuple[Coverage, ...]:
    """Coverage of every set of which a label was recorded, the most labels first, then the smaller set.

    >>> [each.words for each in coverages(["LASI", "RASI", "LPSI", "S:RPSI", "foo"])][:2]
    ['plug-in-gait-lower 4 of 16', 'cgm2.3 4 of 28']
    """
    found = []
    for name, known in MARKER_SETS.items():
        places = known.places()
        there = {label: places[normalised(label)] for label in labels if normalised(label) in places}
        if there:
            found.append(Coverage(name, there, len(places)))
    return tuple(sorted(found, key=lambda each: (-len(each.found), each.size)))


def recognised(labels: Sequence[str], source: str, naming: str = AUTO) -> Coverage:
    """The set that is named, or the one with most labels; InputError where none or several that differ have them.

    Labels that it lacks are added where all sets that know them give them one place.
    """
    if naming != AUTO and naming not in MARKER_SETS:
        raise InputError(
            "", "`naming`", f"'{naming[:40]}' is no marker set", f"sets are: auto, {', '.join(MARKER_SETS)}"
        )
    every = coverages(labels)
    fitting = [each for each in every if naming in (AUTO, each.name)]
    if not fitting or len(fitting[0].found) < FEWEST:
        most = f"best is {fitting[0].words}" if fitting else "no label of it was recorded"
        what = f"no marker set is recognised ({most})" if naming == AUTO else f"is not the recording's set ({most})"
        raise InputError(source, "`naming`", what, f"recorded are {listed(tuple(labels), 30)}; give `markers_map`")
    best = fitting[0]
    _refuse_twice(best, source)
    for other in fitting[1:]:
        if differ := _tie(best, other):
            what = f"{best.words} and {other.words}: both fit, and differ in {listed(differ)}"
            raise InputError(source, "`naming`", what, f"name one: `naming` {best.name}")
    further, donors = _further(labels, best.found, every)
    return replace(best, further=further, donors=donors)


def _refuse_twice(best: Coverage, source: str) -> None:
    """InputError where two labels are one label of the set, or name one place: two subjects, or a marker twice."""
    seen: dict[object, str] = {}
    for label, where in best.found.items():
        for key in (normalised(label), where if PLACES[where[0]].at is not None else label):
            if seen.setdefault(key, label) != label:
                what = f"{best.words}: {seen[key]} and {label} are one place"
                raise InputError(source, "`naming`", what, "give a recording of one subject, a marker for each place")


ALIKE = 0.5
"""Share of another set that was recorded, over the best one's, from which it fits as well if that is incomplete."""


def _differ(best: Coverage, other: Coverage) -> tuple[str, ...]:
    """Labels of one set to which another one with as many labels gives another place, or none."""
    if len(other.found) < len(best.found):
        return ()
    return tuple(label for label, where in best.found.items() if other.found.get(label) != where)


def _tie(best: Coverage, other: Coverage) -> tuple[str, ...]:
    """Labels in which another set that fits as well as the best one differs from it."""
    return _differ(best, other) if len(best.found) < best.size and best.size >= ALIKE * other.size else ()


def _further(
    labels: Sequence[str], known: Mapping[str, Where], every: Sequence[Coverage]
) -> tuple[dict[str, Where], dict[str, str]]:
    """Labels of other sets that mean one place in all of them, at places where nothing is yet; and of which sets.

    One label, or a few of many, is no sign of a set; and keypoints of video have the names of joints whose markers
    others put on the skin.
    """
    found: dict[str, Where] = {}
    donors: dict[str, str] = {}
    there = [e for e in every if len(e.found) >= max(FEWEST, ALIKE * e.size) and e.name != KEYPOINTS]
    for label in labels:
        means = {each.found[label] for each in every if label in each.found}
        of = [each.words for each in there if label in each.found]
        if label not in known and of and len(means) == 1 and (where := means.pop()) not in {**known, **found}.values():
            found[label], donors[label] = where, ", ".join(of)
    return found, donors


@dataclass(frozen=True)
class NamedLabel:
    """A recorded label, its place, and how the model has it."""

    label: str
    where: Where | None
    body: str
    how: str


@dataclass(frozen=True)
class Naming:
    """A set, the model with the recording's labels, what each label is, and weights of markers."""

    coverage: Coverage
    model: Multibody
    labels: tuple[NamedLabel, ...]

    @property
    def weights(self) -> dict[str, float]:
        """Weights by marker: 1, and less of wands and clusters that the table placed."""
        soft = {n.label for n in self.labels if n.how == PLACED and n.where is not None and not PLACES[n.where[0]].bony}
        return {m.name: SOFT if m.name in soft else 1.0 for m in self.model.markers}

    @property
    def measures(self) -> tuple[str, ...]:
        """Pairs of markers that measure each segment, as `scale` of the analysis takes them."""
        return tuple(_measures(self))

    def _set_of(self, label: str) -> str:
        if label in self.coverage.found:
            return self.coverage.name
        return self.coverage.donors.get(label, "")

    def table(self) -> pd.DataFrame:
        """A row for each recorded label."""
        names = ("label", "set", "place", "side", "body", "marker of the model")
        sides = {"r": "right", "l": "left", "": ""}
        rows = [
            (
                n.label,
                self._set_of(n.label),
                *((PLACES[n.where[0]].words, sides[n.where[1]]) if n.where else ("", "")),
                n.body,
                n.how,
            )
            for n in self.labels
        ]
        return pd.DataFrame(rows, columns=list(names))

    def section(self) -> Table:
        """The same on a page."""
        table = self.table()
        rows = [tuple(str(cell) for cell in row) for row in table.itertuples(index=False)]
        return Table("Labels of the recording", tuple(str(name) for name in table.columns), rows)


def named_markers(model: Multibody, seen: MarkerTrajectories, naming: str) -> Naming:
    """The model with markers that are called as in the recording; one reservation says what was mapped.

    Markers of the model that were not recorded are left out.
    """
    coverage = recognised(seen.names, seen.source, naming)
    own = _own_places(model)
    rest = model.poses(np.array([[c.default for c in model.coordinates]]))
    sizes = {body: _size(rest, body) for body in {b.name for b in model.bodies}}
    made: list[Marker] = []
    labels: list[NamedLabel] = []
    for label in seen.names:
        where = coverage.found.get(label, coverage.further.get(label))
        marker, how = _marker_of(model, label, where, own, sizes)
        labels.append(NamedLabel(label, where, "" if marker is None else marker.body, how))
        if marker is not None:
            made.append(marker)
    _report(coverage, labels, seen)
    return Naming(coverage, replace(model, markers=tuple(made)), tuple(labels))


def _own_places(model: Multibody) -> dict[Where, Marker]:
    """Markers of the model by place, of the set that most of them belong to; empty where it has none.

    Labels to which another set that fits as well gives another place are left out.
    """
    by = {m.name: m for m in model.markers}
    known = coverages(tuple(by))
    if not known or len(known[0].found) < FEWEST:
        return {}
    found: dict[Where, Marker] = {}
    unclear = {label for other in known[1:] for label in _tie(known[0], other)}
    for label, where in known[0].found.items():
        if label not in unclear and PLACES[where[0]].at is not None:  # markers of a cluster have no place each
            found.setdefault(where, by[label])
    return found


def _marker_of(
    model: Multibody, label: str, where: Where | None, own: Mapping[Where, Marker], sizes: Mapping[str, float]
) -> tuple[Marker | None, str]:
    same = next((m for m in model.markers if m.name == label), None)
    if where is None:
        return (same, "the same name") if same is not None else (None, "not used: in no set")
    if where in own:
        return replace(own[where], name=label), own[where].name
    place, body = PLACES[where[0]], _body(*where)
    if same is not None and same.body == ("torso" if body == "head" and body not in sizes else body):
        return same, "the same name"
    if body not in sizes:
        return None, f"not used: no body {body}"
    if place.at is None:
        return None, "not used: no named place"
    x, y, z = place.at
    location = sizes[body] * np.array([x, y, -z if where[1] == "l" else z])
    return Marker(label, body, location), PLACED


def _body(place: str, side: Side) -> str:
    segment = PLACES[place].segment
    return segment if segment in {"pelvis", "torso", "head"} else f"{segment}_{side}"


def _size(poses: Mapping[str, RigidTransform], body: str) -> float:
    """Length of a segment of the model over that of gait2392; 1 where the model does not have both ends."""
    segment, _, side = body.rpartition("_") if body.endswith(("_r", "_l")) else (body, "", "")
    if segment not in LENGTHS:
        return 1.0
    one, other, length = LENGTHS[segment]
    ends = [poses.get(name.replace("{s}", f"_{side}")) for name in (one, other)]
    known = [np.asarray(end.translation)[0] for end in ends if end is not None]
    if len(known) < len(ends):
        return 1.0
    apart = np.subtract(*known)
    return float(np.linalg.norm(apart)) / length


def _measures(naming: Naming) -> Iterator[str]:
    made = {m.name for m in naming.model.markers}
    at = {each.where: each.label for each in naming.labels if each.where is not None and each.label in made}
    bodies = [body.name for body in naming.model.bodies]
    for segment, choices in MEASURES.items():
        if segment == "pelvis":
            pairs = [[(at.get((one, "r")), at.get((other, "l")))] for one, other in choices]
            yield from _said(pairs, [b for b in bodies if b == segment])
        elif segment == "torso":
            pairs = [[(at.get((one, s)), at.get((other, s))) for s in ("", "r", "l")] for one, other in choices]
            yield from _said(pairs, [b for b in bodies if b == segment])
        else:
            for s in "rl":
                grown = [f"{each}_{s}" for each in GROWS_ALONG.get(segment, (segment,))]
                pairs = [[(at.get((one, s)), at.get((other, s)))] for one, other in choices]
                yield from _said(pairs, [b for b in grown if b in bodies])


def _said(choices: Sequence[Sequence[tuple[str | None, str | None]]], bodies: Sequence[str]) -> Iterator[str]:
    """The first choice with a pair that is there, as text."""
    for pairs in choices:
        known = [f"{one}/{other}" for one, other in pairs if one is not None and other is not None]
        if known and bodies:
            yield f"{','.join(bodies)}={','.join(known)}"
            return


def _report(coverage: Coverage, labels: Sequence[NamedLabel], seen: MarkerTrajectories) -> None:
    placed = tuple(n.label for n in labels if n.how == PLACED)
    unused = tuple(n.label for n in labels if n.how.startswith("not used"))
    used = len(labels) - len(unused)
    if used < FEWEST:
        what = f"{coverage.words}: {used} of its labels can be put on the model; {FEWEST} are needed"
        raise InputError(seen.source, "`naming`", what, "give a model with these markers, or `markers_map`")
    others = [each for each in coverages(seen.names) if each.name != coverage.name]
    also = f" (also {', '.join(each.words for each in others[:2])})" if others else ""
    also += "".join(f"; {each.name} means others by {listed(d)}" for each in others if (d := _differ(coverage, each)))
    reserve(f"{seen.source}: labels are taken for {coverage.words}{also}; {used} markers are used, as naming.csv lists")
    if placed:
        what = f"the model has no marker for {listed(placed)}"
        reserve(
            f"{what}: placed from a table, 2 cm off in the median and up to 7 cm; scaling to a static pose moves them"
        )
    if coverage.further:
        of = "; ".join(f"{label} of {coverage.donors[label]}" for label in coverage.further)
        reserve(f"{seen.source}: labels of other sets are used besides: {of}")
    if unused:
        reserve(f"{seen.source}: labels that are not used: {listed(unused)}")
