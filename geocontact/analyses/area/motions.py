"""The motions of a run: read from files, one sub-folder each when there are several, or swept about an axis."""

from __future__ import annotations

import glob
from collections.abc import Sequence
from pathlib import Path

from geocontact.analyses import quantities
from geocontact.analyses.run_record import Record
from geocontact.cli.area import AreaOptions
from geocontact.cli.idle import refuse_unheeded
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.fit.cylinder import fit_cylinder
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import sweep as swept
from geocontact.io.motion.motion import read_motion


def motions_given(record: Record, o: AreaOptions, files: Sequence[str], moving: Surface) -> list[tuple[str, Motion]]:
    """Name of the sub-folder (empty when there is one motion) and motion, with the offset of adduction asked for."""
    motions = _motions(record, o, files, moving)
    if o.adduction is None:
        return motions
    axis, angle = quantities.turn(o.adduction, "--adduction")
    return [(folder, motion.turned(axis, angle)) for folder, motion in motions]


def _motions(record: Record, o: AreaOptions, files: Sequence[str], moving: Surface) -> list[tuple[str, Motion]]:
    if o.sweep is not None:
        return [("", _swept(o.sweep, o.axis, o.unit, moving, record))]
    motions = {}
    for path in _expanded(files):
        motions[path] = read_motion(
            path,
            osim=o.osim,
            joint=o.joint,
            moving=o.moving_body or "child",
            mapping=o.map,
            order=o.order,
            angles=o.angles,
            grood_suntay_side=o.side if o.convention else None,
        )
    refuse_unheeded(o, motions)
    named = [(path.stem if len(motions) > 1 else "", path, motion) for path, motion in motions.items()]
    for folder, path, motion in named:
        record.add_input("motion", path, frames=len(motion), source=motion.source, folder=folder or ".")
    if o.osim is not None:
        record.add_input("model", o.osim, joint=o.joint)
    return [(folder, motion) for folder, _, motion in named]


def _expanded(patterns: Sequence[str]) -> list[Path]:
    paths: list[Path] = []
    for pattern in patterns:
        matches = [pattern] if Path(pattern).exists() or not glob.has_magic(pattern) else sorted(glob.glob(pattern))
        if not matches:
            raise InputError(pattern, "", "matches no file", "check the pattern")
        paths += [Path(match) for match in matches]
    names = [path.stem for path in paths]
    for name in names if len(names) > 1 else ():
        if name in ("", ".", "..") or name.lower() == "run.json":
            raise InputError("", "--motion", f"a motion called {name!r} cannot name a folder", "rename its file")
        if names.count(name) > 1:
            raise InputError("", "--motion", f"two motions are called {name}", "their results would share a folder")
    return paths


def _swept(text: str, axis: str | None, unit: str, moving: Surface, record: Record) -> Motion:
    name, start, stop, step = quantities.sweep_range(text)
    if axis is not None:
        file = quantities.named_file(axis)
        if file is not None:
            record.add_input("--axis", file)
        return swept(quantities.axis(axis, unit), start, stop, step, name)
    fit = fit_cylinder(moving.vertices[moving.used])
    record.warn(
        f"no --axis: turned about the cylinder fitted to all of {moving.name}, "
        f"radius {(fit.radius or 0.0) * 1e3:.2f} mm, rms {fit.rms * 1e3:.2f} mm"
    )
    return swept(fit.line, start, stop, step, name)
