"""Several bodies at rest on the layers of all pairs, frame by frame: what is read, and what the frames came to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.area.contact import PIECE, elastic_layer
from geocontact.analyses.area.pairs.bodies import TouchingBodies, TouchingPair, doubt_together, of_pair
from geocontact.analyses.area.pairs.bodies import read as read_touching
from geocontact.analyses.area.pairs.options import PairsOptions, SettlePairsOptions
from geocontact.analyses.area.pairs.totals import body_loads
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.data.errors import InputError
from geocontact.geometry.curvature import corner_normals
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.contact_pairs import DescribedFree
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.loads.foundation import layer_loads
from geocontact.loads.pressure_load import PressureLoad
from geocontact.loads.settling import Rest
from geocontact.loads.settling_bodies import (
    COORDINATES,
    Assembly,
    BodiesEnergy,
    FreeBody,
    PressedPair,
    settled,
    turned_too_far,
)


@dataclass(frozen=True, eq=False)
class PressingBodies:
    """All bodies, the pairs of them that have a layer, and which bodies are free.

    Parameters
    ----------
    touching
        All pairs, and how the bodies move.
    names, pairs
        Pairs that have a layer.
    free
        Bodies that come to rest.
    axes
        Of each of these: the body along whose axes its coordinates are; None for the common frame's.
    forces
        On those whose force changes over time, along these axes [N].
    """

    touching: TouchingBodies
    names: tuple[str, ...]
    pairs: tuple[PressedPair, ...]
    free: Mapping[str, FreeBody]
    axes: Mapping[str, str | None]
    forces: Mapping[str, Float[np.ndarray, "t 3"]]

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Times of the frames."""
        return self.touching.time

    @cached_property
    def recorded(self) -> dict[str, RigidTransform]:
        """Poses of every body in the common frame, as they were recorded."""
        return {name: self.touching.poses(name) for name in self.touching.motions}

    @cached_property
    def surfaces(self) -> dict[str, Surface]:
        """Surface of every body of a pair."""
        found = {}
        for pair in self.touching.pairs:
            found[pair.moving], found[pair.fixed] = pair.bodies.moving, pair.bodies.fixed
        return found

    def at(self, k: int) -> Assembly:
        """All bodies in one frame."""
        poses = {name: course[k] for name, course in self.recorded.items()}
        axes = {name: RigidTransform.identity() if on is None else poses[on] for name, on in self.axes.items()}
        free = {
            name: replace(one, force=self.forces[name][k]) if name in self.forces else one
            for name, one in self.free.items()
        }
        return Assembly(self.pairs, poses, axes, free)


def read(o: SettlePairsOptions) -> PressingBodies:
    """Everything the description names."""
    touching = read_touching(PairsOptions(o.description), areas=False)
    if not touching.free:
        what = "no body is free: all stay where they are"
        raise InputError(o.description, "[[free]]", what, "write one with body, settles and a force")
    layered = [pair for pair in touching.pairs if pair.options.pressure]
    if bare := tuple(pair.name for pair in touching.pairs if not pair.options.pressure):
        reserve(
            f"{o.description}: no layer in {listed(bare)}: nothing presses there, whether the bodies overlap or not"
        )
    pressing = {name for pair in layered for name in (pair.moving, pair.fixed)}
    for k, one in enumerate(touching.free, 1):
        if one.body not in pressing:
            what = f"{one.body} is in no pair that has a layer: nothing presses on it"
            raise InputError(o.description, f"[[free]] {k} body", what, "describe the layer of one of its pairs")
    forces = {one.body: _over_time(one, one.forces, touching) for one in touching.free if one.forces is not None}
    if not any(one.fx or one.fy or one.fz or one.body in forces for one in touching.free):
        what = "no force acts on any of the bodies: nothing presses them together"
        raise InputError(o.description, "[[free]]", what, "write fx, fy or fz of one")
    free = {one.body: _free(one) for one in touching.free}
    doubt_together(touching, o.description, free)
    pairs = tuple(_pressed(pair, o) for pair in layered)
    axes = {one.body: one.axes for one in touching.free}
    return PressingBodies(touching, tuple(pair.name for pair in layered), pairs, free, axes, forces)


def _over_time(one: DescribedFree, file: Path, touching: TouchingBodies) -> Float[np.ndarray, "t 3"]:
    """Force on a body at the times of the motion, linear between the rows of its table [N]."""
    table, time = read_table(file), touching.time
    add_input(f"forces on {one.body}", file, rows=len(table.time))
    begin, end = table.time[[0, -1]]
    if begin > time[0] + 1e-9 or end < time[-1] - 1e-9:
        what = f"runs from {begin:g} to {end:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "put both on one clock, or cut the motion")
    found = np.zeros((len(time), 3))
    columns = _columns(one, file, table)
    for axis, name in columns.items():
        values = _newtons(table, name, file)
        if values.any() and f"t{axis}" not in one.settles:
            what = f"column '{name}' has no effect: t{axis} of {one.body} is held"
            raise InputError(file, "", what, f"add t{axis} to settles, or leave the column out")
        found[:, "xyz".index(axis)] = np.interp(time, table.time, values)
    if not found.any():
        raise InputError(file, "", f"no force acts on {one.body}", "check its columns, or leave `forces` out")
    sharing = [each.body for each in touching.free if each.forces == file]
    theirs = {name for body in sharing for axis in "xyz" for name in (f"f{axis}", f"{body}_f{axis}")}
    unused = tuple(name for name in table.channels if name not in theirs)
    if unused and one.body == sharing[0]:
        reserve(f"{file}: columns not used as forces on {listed(tuple(sharing))}: {listed(unused)}")
    return found


def _columns(one: DescribedFree, file: Path, table: TextTable) -> dict[str, str]:
    """Column of each axis that a table has for a body; InputError for two of one axis, and for none at all."""
    both = {axis: [n for n in (f"f{axis}", f"{one.body}_f{axis}") if n in table.channels] for axis in "xyz"}
    for names in both.values():
        if len(names) > 1:
            what = f"has columns {' and '.join(names)}, both of {one.body}"
            raise InputError(file, "", what, "leave one of them out")
    columns = {axis: names[0] for axis, names in both.items() if names}
    if not columns:
        what = f"no column fx, fy, fz or {one.body}_fx, {one.body}_fy, {one.body}_fz"
        raise InputError(file, "", what, f"columns are: {listed(table.channels)}")
    return columns


def _newtons(table: TextTable, name: str, file: Path) -> Float[np.ndarray, " t"]:
    """A column of forces [N]; without a unit those of .mot and .sto are in N, and those of other tables refused."""
    table.needed(name)
    said, storage = table.units[table.channels.index(name)], file.suffix.lower() in (".mot", ".sto")
    if not said and not storage:
        raise InputError(file, "", f"column '{name}' has no unit", f"write it behind the name: {name} [N]")
    return column_in_newtons(table, name, None if said else "N")[0]


def _free(one: DescribedFree) -> FreeBody:
    return FreeBody(
        np.array([one.px, one.py, one.pz]),
        np.isin(COORDINATES, one.settles),
        np.array([one.fx, one.fy, one.fz]),
        np.array([one.springs.get(name, 0.0) for name in COORDINATES]),
    )


def _pressed(pair: TouchingPair, o: SettlePairsOptions) -> PressedPair:
    """FIXED's layer as `area` makes it, and MOVING."""
    moving, asked, place = pair.bodies.moving, pair.options, f"[[pairs]] {pair.name}"
    if not moving.closed:
        what = f"{pair.moving} is open ({moving.topology.why_open}): it has no inside, so there is no depth"
        raise InputError(o.description, place, what, "close it, or write closed = true if it is")
    counted = pair.bodies.settings.moving_faces
    if counted is not None and not counted.all():
        reserve(f"{o.description}: {place}: all of {pair.moving} presses, whatever `region_moving` says")
    edge = PIECE if asked.piece is None else asked.piece
    with of_pair(o.description, pair.name):
        layer = elastic_layer(pair.bodies, pair.bodies.settings.fixed_faces, asked, edge)
    return PressedPair(layer, pair.fixed, moving, corner_normals(moving), pair.moving)


@dataclass(frozen=True, eq=False)
class RestFrame:
    """All bodies of one frame, and where the search for their equilibrium ended."""

    assembly: Assembly
    rest: Rest[BodiesEnergy]

    @property
    def converged(self) -> bool:
        """Whether all free bodies are at rest."""
        return self.rest.converged

    @property
    def apart(self) -> tuple[str, ...]:
        """Free bodies that no layer presses on."""
        touched = set()
        for pair, state in zip(self.assembly.pairs, self.rest.total.states, strict=True):
            if len(state.pressed):
                touched |= {pair.moving, pair.fixed}
        return tuple(name for name in self.assembly.bodies if name not in touched)


def settle_frames(pressing: PressingBodies, each: Callable[[RestFrame], None]) -> list[RestFrame]:
    """Equilibrium of each frame, from where the frame before came to rest, or else from the recorded poses.

    `each` is called with every frame; what it raises ends the work.
    """
    frames: list[RestFrame] = []
    off: Float[np.ndarray, " n"] | None = None
    for k in range(len(pressing.time)):
        assembly = pressing.at(k)
        recorded = assembly.recorded
        rest = None if off is None else settled(assembly, recorded + off)
        if rest is None or not rest.converged:
            rest = settled(assembly, recorded)
        frames.append(RestFrame(assembly, rest))
        each(frames[-1])
        if rest.converged:
            off = np.where(assembly.free, rest.total.values - recorded, 0.0)
    return frames


def refuse_indeterminate(frame: RestFrame, o: SettlePairsOptions) -> None:
    """InputError where contact and springs leave a free coordinate anywhere, or two coordinates of a body are one."""
    body = turned_too_far(frame.assembly, frame.rest.total.values)
    if body is not None:
        what = f"{body} is turned by more than 80 degrees about x of its axes, where ry and rz are hardly two"
        raise InputError(o.description, "[[free]] axes", what, "name a body that it is turned less against")
    loose = frame.assembly.loose(frame.rest.total) if frame.converged else ()
    if loose:
        what = f"nothing holds {' and '.join(loose)}: contacts and springs have no stiffness along it"
        raise InputError(o.description, "[[free]] settles", what, "leave it out, or write a spring")


@dataclass(frozen=True, eq=False)
class RestingBodies:
    """What every frame came to; not a number where it came to no rest."""

    pressing: PressingBodies
    frames: tuple[RestFrame, ...]

    @cached_property
    def converged(self) -> Bool[np.ndarray, " t"]:
        """Frames at rest."""
        return np.array([frame.converged for frame in self.frames])

    @property
    def kept(self) -> np.ndarray:
        """Numbers of the frames at rest."""
        return np.flatnonzero(self.converged)

    @cached_property
    def values(self) -> Float[np.ndarray, "t n"]:
        """Coordinates of all free bodies [m, rad]."""
        lost = np.full(6 * len(self.pressing.free), np.nan)
        return np.array([frame.rest.total.values if frame.converged else lost for frame in self.frames])

    def coordinates(self, body: str) -> Float[np.ndarray, "t 6"]:
        """Those of one free body, in the order of `COORDINATES`."""
        k = list(self.pressing.free).index(body)
        return self.values[:, 6 * k : 6 * k + 6]

    @cached_property
    def residuals(self) -> Float[np.ndarray, "t b"]:
        """Residual force of each free body [N]; also where that is too much."""
        return np.array([frame.assembly.residuals(frame.rest.total) for frame in self.frames])

    @cached_property
    def poses(self) -> dict[str, RigidTransform]:
        """Poses of every body in the common frame in the frames at rest."""
        placed = [self.frames[k].assembly.placed(self.frames[k].rest.total.values) for k in self.kept]
        return {name: RigidTransform.concatenate([one[name] for one in placed]) for name in self.pressing.recorded}

    @cached_property
    def contacts(self) -> dict[str, list[PressureLoad | None]]:
        """Load on FIXED of each pair, in its frame; None without rest."""
        return {
            name: [
                layer_loads(pair.layer, frame.rest.total.states[k])["total"] if frame.converged else None
                for frame in self.frames
            ]
            for k, (name, pair) in enumerate(zip(self.pressing.names, self.pressing.pairs, strict=True))
        }

    def of_contact(self, name: str, value: Callable[[PressureLoad], float]) -> Float[np.ndarray, " t"]:
        """A number of the load of one pair."""
        return np.array([np.nan if load is None else value(load) for load in self.contacts[name]])

    @cached_property
    def wrenches(self) -> dict[str, Float[np.ndarray, "t 6"]]:
        """Force [N] and moment about the common frame's origin [N m] on FIXED of each pair, in the common frame."""
        found = {}
        for name, pair in zip(self.pressing.names, self.pressing.pairs, strict=True):
            rows = np.full((len(self.frames), 6), np.nan)
            for place, k in enumerate(self.kept):
                load = self.contacts[name][k]
                if load is not None:
                    there = load.wrench.seen_from(self.poses[pair.fixed][place], "common").moved_to(np.zeros(3))
                    rows[k] = [*there.force, *there.moment]
            found[name] = rows
        return found

    @property
    def loads(self) -> dict[str, Float[np.ndarray, "t 6"]]:
        """What all contacts together put on each body: force [N], moment about the common frame's origin [N m]."""
        return body_loads(self.wrenches, self.pressing.touching.of_pairs)

    @property
    def largest_strain(self) -> dict[str, float]:
        """Largest strain of each pair's layer [-]."""
        found = {}
        for k, (name, pair) in enumerate(zip(self.pressing.names, self.pressing.pairs, strict=True)):
            states = [self.frames[j].rest.total.states[k] for j in self.kept]
            strains = [state.depth / pair.layer.thickness[state.pressed] for state in states]
            found[name] = max(float(strain.max(initial=0.0)) for strain in strains)
        return found

    def face_pressure(self, body: str, frame: int) -> Float[np.ndarray, " f"]:
        """Mean pressure of each face of a body [Pa], of all pairs whose layer it has; frame at rest."""
        total = np.zeros(len(self.pressing.surfaces[body].faces))
        for k, pair in enumerate(self.pressing.pairs):
            if pair.fixed == body:
                state, pieces = self.frames[frame].rest.total.states[k], pair.layer.pieces
                pressure = np.zeros(len(pieces.area))
                pressure[state.pressed] = state.pressure
                total += pieces.face_means(pressure, len(total))
        return total
