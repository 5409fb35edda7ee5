"""Bodies that move together: their poses in one frame at the times of one of them, and each pair as `area` reads it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.area.bodies import Bodies, read_moved
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.pairs.options import PairsOptions
from geocontact.analyses.frame.collector import add_input, current, reserve
from geocontact.analyses.frame.landmarks import region_kind
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.motion.motion import read_motion
from geocontact.io.motion.poses import PASS_RATE
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.recordings.contact_pairs import (
    DescribedBody,
    DescribedFree,
    DescribedPair,
    PairsDescription,
    read_pairs,
)
from geocontact.io.text.tables import listed, read_table

FRAME = "the common frame"
TOGETHER = 1e-9
"""m and rad, less than a digit of a file."""


@dataclass(frozen=True, eq=False)
class TouchingPair:
    """Two of the bodies.

    Parameters
    ----------
    name
        That of its folder.
    moving, fixed
        Names of the bodies.
    options
        As `area` would be asked for this pair alone.
    bodies
        As `area` reads it.
    """

    name: str
    moving: str
    fixed: str
    options: AreaOptions
    bodies: Bodies

    @property
    def motion(self) -> Motion:
        """Poses of MOVING in FIXED."""
        return self.bodies.motions[0][1]


@dataclass(frozen=True, eq=False)
class TouchingBodies:
    """All pairs, the poses of all bodies in the common frame, None for a body at rest, and what is free to settle."""

    pairs: tuple[TouchingPair, ...]
    motions: Mapping[str, Motion | None]
    time: Float[np.ndarray, " t"]
    free: tuple[DescribedFree, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the pairs."""
        return tuple(pair.name for pair in self.pairs)

    @property
    def of_pairs(self) -> dict[str, tuple[str, str]]:
        """FIXED and MOVING of each pair."""
        return {pair.name: (pair.fixed, pair.moving) for pair in self.pairs}

    def poses(self, body: str) -> RigidTransform:
        """Poses of a body in the common frame, one for each time."""
        motion = self.motions[body]
        return _rest(self.time).poses if motion is None else motion.poses


def read(o: PairsOptions, *, areas: bool = True) -> TouchingBodies:
    """Everything the description names; `areas` is that of `read_moved`."""
    given = read_pairs(o.description)
    add_input("description", o.description, bodies=len(given.bodies), pairs=len(given.pairs))
    used = {name for pair in given.pairs for name in (pair.moving, pair.fixed)}
    used |= {one.axes for one in given.free if one.axes is not None}
    for body in given.bodies:
        if body.name not in used:
            reserve(f"{o.description}: {body.name} is in no pair and is left out")
    described = given.model_copy(update={"bodies": tuple(body for body in given.bodies if body.name in used)})
    if all(body.motion is None and body.segment is None for body in described.bodies):
        raise InputError(o.description, "[[bodies]]", "no body of a pair moves", "write a motion for one")
    motions = _at_one_clock(described, _motions(described, o.description))
    time = next(motion.time for motion in motions.values() if motion is not None)
    pairs = tuple(_pair(described, pair, o, motions, time, areas=areas) for pair in described.pairs)
    return TouchingBodies(pairs, motions, time, given.free)


def _motions(described: PairsDescription, file: Path) -> dict[str, tuple[Path, Motion] | None]:
    """File and poses of each body in the common frame; None for a body at rest."""
    segments = _segments(described, file)
    heeded, found = set[str](), dict[str, tuple[Path, Motion] | None]()
    for body in described.bodies:
        found[body.name] = segments.get(body.name)
        if body.motion is not None:
            motion = _motion_of(described, body.motion, file)
            add_input(f"motion of {body.name}", body.motion, frames=len(motion), source=motion.source)
            found[body.name] = body.motion, motion
            heeded |= motion.heeded
    for key in ("order", "rate"):
        if getattr(described, key) is not None and key not in heeded:
            raise InputError(file, key, "has no effect here: no motion is read with it", "leave it out")
    return found


def _motion_of(described: PairsDescription, motion: Path, file: Path) -> Motion:
    """Motion of a body; an InputError that asks for `rate` says how the description has it."""
    unit, rate = described.unit, described.rate
    try:
        return read_motion(motion, order=described.order, angles=described.angles, unit=unit, rate=rate)
    except InputError as error:
        if error.remedy != PASS_RATE:
            raise
        remedy = f'write rate = {{ value = 100, unit = "Hz" }} into {file.name}, above its first [[…]], with the value'
        raise InputError(error.file, error.place, error.what, f"{remedy} of the recording") from error


def _segments(described: PairsDescription, file: Path) -> dict[str, tuple[Path, Motion]]:
    """Poses in the ground of the bodies that are fixed to segments of the model."""
    if described.model is None or described.coordinates is None:
        return {}
    model, table = read_multibody(described.model), read_table(described.coordinates)
    add_input("model", described.model, bodies=len(model.bodies))
    add_input("coordinates", described.coordinates, frames=len(table.time))
    poses, found = model.poses(motion_of(table, model, described.angles)), {}
    source = f"{described.coordinates.name} with {described.model.name}"
    for body in described.bodies:
        if body.segment is None:
            continue
        if body.segment not in poses:
            what = f"{body.name}: no segment {body.segment!r} in {described.model.name}"
            raise InputError(file, "[[bodies]] segment", what, f"there are {listed(tuple(poses))}")
        moved = Motion(table.time, poses[body.segment], f"{body.segment}: {source}", table.time_unit)
        found[body.name] = described.coordinates, moved
    return found


def _at_one_clock(
    described: PairsDescription, read: Mapping[str, tuple[Path, Motion] | None]
) -> dict[str, Motion | None]:
    """All motions at the times of the first body of a pair that moves."""
    first = next(known for body in described.bodies if (known := read[body.name]) is not None)
    found: dict[str, Motion | None] = {}
    for name, known in read.items():
        found[name] = None
        if known is None:
            continue
        file, motion = known
        if motion.time_unit != first[1].time_unit:
            what = f"is over {motion.time_unit}, {first[0]} over {first[1].time_unit}"
            raise InputError(file, "", what, "write both over one")
        try:
            found[name] = motion.at(first[1].time)
        except ValueError as error:
            raise InputError(file, "", str(error), f"cut {first[0]} to times at which all are known") from error
        if found[name] is not motion:
            reserve(
                f"{file}: has other times than {first[0]}; interpolated to those, translations linearly, rotations "
                "along the shortest arc"
            )
    return found


def _pair(
    described: PairsDescription,
    pair: DescribedPair,
    o: PairsOptions,
    motions: Mapping[str, Motion | None],
    time: Float[np.ndarray, " t"],
    *,
    areas: bool,
) -> TouchingPair:
    before = len(current().inputs)
    moving, fixed = described.body(pair.moving), described.body(pair.fixed)
    motion = _relative(motions[pair.moving], motions[pair.fixed], time)
    if motion is None:
        what = f"neither {pair.moving} nor {pair.fixed} moves"
        raise InputError(o.description, f"[[pairs]] {pair.name}", what, "write a motion for one")
    with of_pair(o.description, pair.name):
        asked = _asked(described, pair, o, moving, fixed)
        bodies = read_moved(asked, lambda _: [(pair.name, motion)], areas=areas)
    for entry in current().inputs[before:]:
        entry["folder"] = pair.name
    return TouchingPair(pair.name, pair.moving, pair.fixed, asked, bodies)


@contextmanager
def of_pair(description: Path, name: str) -> Iterator[None]:
    """An InputError of no file is said to be of this pair of the description; each body's unit is its key `unit`."""
    try:
        yield
    except InputError as error:
        if error.file:
            remedy = error.remedy.replace("`unit_moving`", "`unit`")
            raise InputError(error.file, error.place, error.what, remedy) from error
        place = f"[[pairs]] {name} {error.place}".rstrip()
        raise InputError(description, place, error.what, error.remedy) from error


def doubt_together(touching: TouchingBodies, file: Path, free: Collection[str] = ()) -> None:
    """A warning for two bodies that do not move against each other in any frame, each having poses of its own.

    Those of `free` are where the search for rest begins and may be constant.
    """
    for pair in touching.pairs:
        both = (pair.moving, pair.fixed)
        if any(name in free or touching.motions[name] is None for name in both) or len(pair.motion) < 2:
            continue
        turned = (pair.motion.poses[:1].inv() * pair.motion.poses).as_matrix()
        if np.allclose(turned, np.eye(4), rtol=0.0, atol=TOGETHER):
            what = f"{pair.moving} and {pair.fixed} keep their place to each other in all {len(pair.motion)} frames"
            reserve(f"{file} [[pairs]] {pair.name}: {what}: is the motion of one that of the other?")


def _relative(moving: Motion | None, fixed: Motion | None, time: Float[np.ndarray, " t"]) -> Motion | None:
    """Poses of MOVING in FIXED; None where neither moves."""
    if fixed is None:
        return moving
    return (moving or replace(_rest(time), time_unit=fixed.time_unit)).relative_to(fixed)


def _rest(time: Float[np.ndarray, " t"]) -> Motion:
    return Motion(time, RigidTransform.from_translation(np.zeros((len(time), 3))), "at rest")


def _asked(
    described: PairsDescription, pair: DescribedPair, o: PairsOptions, moving: DescribedBody, fixed: DescribedBody
) -> AreaOptions:
    """What `area` would be asked for this pair alone."""
    home = o.description.parent
    mover = described.coordinates if moving.segment is not None else moving.motion
    closed = {(True, True): "both", (True, False): "moving", (False, True): "fixed"}
    layer = pair.layer
    return AreaOptions(
        moving.mesh,
        fixed.mesh,
        unit=fixed.unit or described.unit,
        unit_moving=None if moving.unit == fixed.unit else moving.unit or described.unit,
        merge_tolerance=described.merge_tolerance,
        motion=(str(mover or fixed.motion or described.coordinates),),
        threshold=o.threshold,
        rule=o.rule,
        bounds=o.bounds,
        workers=o.workers,
        place_moving=_beside(home, moving.place),
        place_fixed=_beside(home, fixed.place),
        region=_faces(home, pair.region),
        region_moving=_faces(home, pair.region_moving),
        assume_closed=closed.get((moving.closed, fixed.closed)),  # type: ignore[arg-type]
        pressure=layer is not None,
        modulus=None if layer is None else layer.modulus,
        poisson=None if layer is None else layer.poisson,
        thickness=None if layer is None else layer.thickness,
        piece=None if layer is None else layer.piece,
        foundation=None if layer is None else layer.foundation,
    )


def _beside(home: Path, place: str | None) -> str | None:
    return None if place is None else str(home / place)


def _faces(home: Path, text: str | None) -> str | None:
    """An expression, or a file of face numbers or of landmarks beside the description."""
    if text is None:
        return None
    kind, of = region_kind(text)
    return f"{kind}{home / of}" if kind or (home / of).is_file() else text
