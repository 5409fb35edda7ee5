"""Motions of an area analysis: from files, of both bodies, or a sweep along a direction."""

from __future__ import annotations

import glob
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.bodies import typed_axis
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.text import cannot_be_named, same_place
from geocontact.geometry.fit.cylinder import fit_cylinder
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import sweep
from geocontact.io.motion.motion import read_motion

FROZEN, JUMPS = 5, 3.0
"""Frames with one pose, and parts of a usual step that the one after them is."""


DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def motions_given(o: AreaOptions, moving: Surface) -> list[tuple[str, Motion]]:
    """Name of the sub-folder (empty when there is one motion) and motion, with the offset of adduction asked for."""
    motions = _read(o) if o.sweep is None else [("", _swept(o, o.sweep, moving))]
    if o.adduction is None:
        return motions
    axis, angle = o.adduction
    return [(folder, motion.turned(DIRECTIONS[axis], angle)) for folder, motion in motions]


def _read(o: AreaOptions) -> list[tuple[str, Motion]]:
    paths = expanded(o.motion or ())
    _refuse_names(paths)
    motions = {path: _motion(path, o) for path in paths}
    bases = _motions_of_fixed(o, paths)
    _refuse_unheeded(o, {**motions, **dict(bases.values())})
    found = []
    for path, motion in motions.items():
        folder = path.stem if len(motions) > 1 else ""
        add_input("motion", path, frames=len(motion), source=motion.source, folder=folder or ".")
        _doubt_frozen(path, motion)
        if path in bases:
            motion = _relative(motion, *bases[path])
        found.append((folder, motion))
    if o.osim is not None:
        add_input("model", o.osim, joint=o.joint)
    return found


def _motion(path: Path, o: AreaOptions) -> Motion:
    return read_motion(
        path,
        osim=o.osim,
        joint=o.joint,
        moving=o.moving_body or "child",
        mapping=o.map,
        order=o.order,
        angles=o.angles,
        grood_suntay_side=o.side if o.convention else None,
        unit=o.unit,
        rate=o.rate,
    )


def _motions_of_fixed(o: AreaOptions, paths: list[Path]) -> dict[Path, tuple[Path, Motion]]:
    """File and poses of FIXED for each motion of MOVING; none where FIXED stays."""
    if not o.motion_fixed:
        return {}
    fixed = expanded(o.motion_fixed)
    if len(fixed) != len(paths):
        what = f"names {len(fixed)} files for {len(paths)} of `motion`"
        raise InputError("", "`motion_fixed`", what, "give one for each, in the same order")
    read = [read_motion(path, order=o.order, angles=o.angles, unit=o.unit, rate=o.rate) for path in fixed]
    return dict(zip(paths, zip(fixed, read, strict=True), strict=True))


def _doubt_frozen(path: Path, motion: Motion) -> None:
    """A warning for one pose in `FROZEN` frames or more, after which the body jumps: what rests starts slowly."""
    step = np.linalg.norm((motion.poses[:-1].inv() * motion.poses[1:]).as_matrix() - np.eye(4), axis=(1, 2))
    still = step == 0.0
    if still.all() or not still.any():
        return
    usual = float(np.median(step[~still]))
    edges = np.flatnonzero(np.diff(np.r_[False, still, False].astype(int)))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        inside = first > 0 and last < len(step)
        if inside and last - first + 1 >= FROZEN and step[last] > JUMPS * usual:
            when = f"{motion.time[first]:g} to {motion.time[last]:g} s"
            reserve(
                f"{path}: one pose in {last - first + 1} frames, {when}, and a jump after it: was the body lost there?"
            )
            return


def _relative(motion: Motion, file: Path, fixed: Motion) -> Motion:
    """Poses of MOVING in FIXED, both moving in one frame."""
    add_input("motion of fixed", file, frames=len(fixed), source=fixed.source)
    try:
        found = motion.relative_to(fixed)
    except ValueError as error:
        raise InputError(file, "", str(error), "cut `motion` to times at which both are known") from error
    if fixed.at(motion.time) is not fixed:
        reserve(
            f"{file}: has other times than the motion of MOVING; interpolated to those, translations linearly, "
            "rotations along the shortest arc"
        )
    return found


def _refuse_unheeded(o: AreaOptions, motions: dict[Path, Motion]) -> None:
    """InputError for options of reading that had no say in any of the motions read."""
    heeded = frozenset[str]().union(*(motion.heeded for motion in motions.values()))
    files = ", ".join(map(str, motions))
    for option, unread, remedy in (
        ("convention", "knee angle is", "name its columns with `map`"),
        ("order", "two angles to put in order are", "leave it out"),
        ("angles", "angle is", "leave it out"),
        ("rate", "pose without a time is", "leave it out"),
    ):
        if o.given(option) and option not in heeded:
            raise InputError("", f"`{option}`", f"has no effect here: no {unread} read from {files}", remedy)


def expanded(patterns: Sequence[str]) -> list[Path]:
    """Files that are named, and those of patterns in the order of names."""
    paths: list[Path] = []
    for pattern in patterns:
        matches = [pattern] if Path(pattern).exists() or not glob.has_magic(pattern) else sorted(glob.glob(pattern))
        if not matches:
            raise InputError(pattern, "", "matches no file", "check the pattern")
        paths += [Path(match) for match in matches]
    return paths


def _refuse_names(paths: Sequence[Path]) -> None:
    """InputError for motions that cannot have a sub-folder each."""
    names = [path.stem for path in paths]
    for name in names if len(names) > 1 else ():
        if cannot_be_named(name) or name.lower() == "run.json":
            raise InputError("", "`motion`", f"a motion called {name!r} cannot name a folder", "rename its file")
    twice = same_place(names)
    if twice is not None:
        raise InputError("", "`motion`", f"two motions are called {twice}", "their results would share a folder")


def _swept(o: AreaOptions, asked: tuple[str, float, float, float], moving: Surface) -> Motion:
    name, start, stop, step = asked
    if o.axis is not None:
        line = typed_axis("`axis`", o.axis, moving, o.unit)
    else:
        fit = fit_cylinder(moving.vertices[moving.used])
        line = fit.line
        reserve(
            f"no `axis`: turned about the cylinder fitted to all of {moving.name}, "
            f"radius {(fit.radius or 0.0) * 1e3:.2f} mm, rms {fit.rms * 1e3:.2f} mm"
        )
    try:
        return sweep(line, start, stop, step, name)
    except ValueError as error:
        raise InputError("", "`sweep`", str(error), "give name, start, stop and step") from error
