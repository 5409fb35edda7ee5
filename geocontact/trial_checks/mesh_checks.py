"""Two surfaces against each other and against what their bodies are called: a table like that of recorded trials."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from geocontact.geometry.surface import Surface
from geocontact.trial_checks.recorded import Contradiction

SAME = 1e-6
"""Share of an edge's length in which two copies of one surface differ, whatever their places."""
TIMES = 8.0
"""Times that the diagonal of one surface's box may be that of the other; 10 is a unit of length, a femur is 6 times as
long as a talus."""
BONES = {
    "femur": r"fem(ur|oral)?",
    "tibia": r"tib(ia|ial)?|insert|plateau",
    "patella": r"patell?(a|ar)?",
    "talus": r"tal(us|ar)",
    "calcaneus": r"calc(aneus|aneal|n)?",
    "pelvis": r"pelvis|acetabul(um|ar)|cup",
}
"""Patterns of words in names of files and bodies, in lower case."""


@dataclass(frozen=True, eq=False)
class SurfacePair:
    """Two surfaces that an analysis sets beside each other.

    Parameters
    ----------
    moving, fixed
        As they are read, in their own frames.
    roles
        What the analysis calls them.
    bodies
        What the user calls the bodies that they belong to; None where that is not asked for.
    layered
        Whether the second one is the softer of the two.
    beside
        Names of what goes with them: of files of motion, or the side that the user says.
    """

    moving: Surface
    fixed: Surface
    roles: tuple[str, str] = ("MOVING", "FIXED")
    bodies: tuple[str, str] | None = None
    layered: bool = False
    beside: tuple[str, ...] = ()


@dataclass(frozen=True)
class MeshCheck:
    """A comparison of two surfaces; see `recorded.Check`."""

    name: str
    compares: str
    limit: str
    find: Callable[[SurfacePair], Iterator[Contradiction]]


def bone(name: str) -> str:
    """The bone, or the part of its joint, that a name has a word of; "" for none or for several.

    >>> bone("Femoral Component.stl"), bone("tibial_insert_right.stl"), bone("tibia_r"), bone("ball.stl")
    ('femur', 'tibia', 'tibia', '')
    """
    words = re.split(r"[^a-z]+", name.lower())
    found = {kind for kind, pattern in BONES.items() if any(re.fullmatch(pattern, word) for word in words)}
    return found.pop() if len(found) == 1 else ""


def side(name: str) -> str:
    """The side that a name has the word of; "" for none or for both.

    >>> side("tibial_insert_right.stl"), side("gait_left.csv"), side("tibia_r"), side("leftover.csv")
    ('right', 'left', '', '')
    """
    found = {"right", "left"} & set(re.split(r"[^a-z]+", name.lower()))
    return found.pop() if len(found) == 1 else ""


def body_side(name: str) -> str:
    """The side of a model's body: the word, or the letter at the end; "" for none.

    >>> body_side("femur_r"), body_side("tibia_l"), body_side("tibia_left"), body_side("pelvis")
    ('right', 'left', 'left', '')
    """
    return side(name) or {"_r": "right", "_l": "left"}.get(name.lower()[-2:], "")


def same_surface(pair: SurfacePair) -> Iterator[Contradiction]:
    """Edges of the one against those of the other."""
    a, b = pair.moving, pair.fixed
    if len(a.vertices) != len(b.vertices) or not np.array_equal(a.faces, b.faces):
        return
    if np.allclose(a.edge_length, b.edge_length, rtol=SAME, atol=0.0):
        what = f"{pair.roles[0]} and {pair.roles[1]} are the same surface, edge by edge"
        yield Contradiction(a.name, "", what, "unless they are copies of one part, name the other one's file")


def sizes(pair: SurfacePair) -> Iterator[Contradiction]:
    """The size of the one against that of the other."""
    one, other = (float(np.linalg.norm(np.ptp(each.vertices[each.used], axis=0))) for each in (pair.moving, pair.fixed))
    if max(one, other) > TIMES * min(one, other):
        what = f"{pair.roles[0]} is {1e3 * one:.3g} mm from corner to corner, {pair.fixed.name} {1e3 * other:.3g} mm"
        yield Contradiction(pair.moving.name, "", what, "are both files in one unit?")


def called(pair: SurfacePair) -> Iterator[Contradiction]:
    """Names of the files against those of the bodies, and against which of them has the layer."""
    files = bone(pair.moving.name), bone(pair.fixed.name)
    if pair.bodies is not None and all(files) and files[0] != files[1]:
        named = bone(pair.bodies[0]), bone(pair.bodies[1])
        if named == files[::-1]:
            what = f"{pair.roles[0]} is {pair.moving.name} and {pair.roles[1]} {pair.fixed.name}"
            remedy = "by their names they are exchanged: write that of MOVING first"
            yield Contradiction("", f"`bodies` {','.join(pair.bodies)}", what, remedy)
    if pair.layered and files == ("tibia", "femur"):
        what = f"the layer is that of {pair.roles[1]}, {pair.fixed.name}, which is metal in a knee"
        yield Contradiction(pair.moving.name, "", what, "are the two surfaces exchanged?")


def of_one_side(pair: SurfacePair) -> Iterator[Contradiction]:
    """Right and left in the names of the files, of the motion, of the bodies, and in the side that is said."""
    sides = {name: side(name) for name in (pair.moving.name, pair.fixed.name, *pair.beside)}
    sides |= {f"{name} in `bodies`": body_side(name) for name in pair.bodies or ()}
    first, *others = [name for name, known in sides.items() if known] or [""]
    for other in others:
        if sides[other] != sides[first]:
            what = f"is of the {sides[first]} by its name, and {other} of the {sides[other]}"
            yield Contradiction(first, "", what, "unless one was mirrored, are both of one joint?")
            return


MESH_CHECKS = (
    MeshCheck(
        "same surface",
        "edges of one surface with those of the other",
        f"all alike to {SAME:g}",
        same_surface,
    ),
    MeshCheck(
        "sizes of two surfaces",
        "boxes of the two surfaces",
        f"one {TIMES:g} times as long as the other; a unit of length is 10, a femur is 6 times as long as a talus",
        sizes,
    ),
    MeshCheck(
        "names of two surfaces",
        "names of files with those in `bodies`, and with which of them has the layer",
        "each named as the other; a layer on a femoral component that meets a tibial insert",
        called,
    ),
    MeshCheck(
        "sides of two surfaces",
        "right and left in names of files, those of the motion among them, of `bodies`, and in `side`",
        "one says right, another left",
        of_one_side,
    ),
)
"""Every check of two surfaces: `area`, `knee settle`, `fit` with `other`, `mat` with a second scan."""


def surface_contradictions(pair: SurfacePair) -> list[Contradiction]:
    """Whatever any check finds."""
    return [one for check in MESH_CHECKS for one in check.find(pair)]
