"""Every reader of the package as a function of one file, and what it read as plain numbers."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd


@dataclass(frozen=True)
class Reader:
    """Parameters
    ----------
    read
        The reader, called with the file that is damaged.
    gaps
        Whether NaN says that something was not measured.
    open_ended
        Whether infinity says that there is no bound.
    seconds
        Patience beyond the usual, for readers that start a process.
    """

    read: Callable[[Path], Any]
    gaps: bool = False
    open_ended: bool = False
    seconds: float = 0.0


def _table(path: Path) -> Any:
    from geocontact.io.text.tables import read_table

    table = read_table(path)
    return [table.time, *(table.needed(name) for name in table.channels)]


def _motion(**how: Any) -> Callable[[Path], Any]:
    def read(path: Path) -> Any:
        from geocontact.io.motion.motion import read_motion

        motion = read_motion(path, **how)
        return motion.time, [pose.as_matrix() for pose in motion.poses]

    return read


def _joint_motion(path: Path) -> Any:
    return _motion(osim=path.parents[1] / "meshes" / "knee.osim", joint="knee_r")(path)


def _study(path: Path) -> Any:
    from geocontact.study.description import read_study_file
    from geocontact.study.steps import runs_of

    return runs_of(read_study_file(path))


def _case(path: Path) -> Any:
    from geocontact.io.cases.gap_case import read_gap_case

    return read_gap_case(path.parent if path.name == "case.toml" else path.parents[1])


def _population(path: Path) -> Any:
    from geocontact.analyses.misalignment.population.drawn import UNITS
    from geocontact.io.recordings.population import read_population

    return read_population(path, UNITS)


def _device(path: Path) -> Any:
    from geocontact.analyses.shoulder.devices import CONTROLLER_UNITS, HINGE_UNITS, UNITS
    from geocontact.data.parameter import SOURCES
    from geocontact.io.recordings.shoulder_device import read_device_file

    return read_device_file(path, UNITS, CONTROLLER_UNITS, SOURCES, HINGE_UNITS)


def _contact_parameters(path: Path) -> Any:
    from geocontact.io.recordings.spheres import read_contact_intervals, read_contact_parameters

    units = {"k": "N/m", "b": "N s/m"}
    return read_contact_parameters(path, units, dict.fromkeys(units, (0.0, 1e6))), read_contact_intervals(path, units)


def _pedar(path: Path) -> Any:
    from geocontact.io.mats.catalogue import read_mat
    from geocontact.io.mats.layout import read_layout

    return read_mat(path, read_layout(path.with_name("pedar.toml")))


def _grid(path: Path) -> Any:
    from geocontact.io.mats.catalogue import read_mat
    from geocontact.io.mats.layout import read_layout

    return read_mat(path, read_layout(path.with_name("layout.toml")))


def _forces_of(path: Path) -> Any:
    from geocontact.io.opensim.osim_forces import read_passive_forces
    from geocontact.io.opensim.osim_multibody import read_multibody

    return read_passive_forces(path, read_multibody(path))


def _elbow_json(path: Path) -> Any:
    from geocontact.analyses.misalignment.compare.pairs import _law

    return _law(path)


def _run(path: Path) -> Any:
    from geocontact.analyses.frame.rerun import read_run

    run = read_run(path)  # its options are read again as they were typed
    return run.command, run.folder


def _axis(path: Path) -> Any:
    from geocontact.analyses.frame.places import axis

    return axis(str(path), "mm")


def _called(module: str, name: str, *given: Any) -> Callable[[Path], Any]:
    """A function of a module, with the file first."""

    def read(path: Path) -> Any:
        from importlib import import_module

        return getattr(import_module(f"geocontact.{module}"), name)(path, *given)

    return read


READERS: dict[str, Reader] = {
    "mesh": Reader(_called("io.mesh.meshes", "read_mesh", "mm")),
    "particles": Reader(_called("io.mesh.particles", "read_particles", "mm")),
    "table": Reader(_table),
    "poses": Reader(_motion(order="XYZ")),
    "rows of matrices": Reader(_motion(unit="mm", rate=100.0)),
    "joint motion": Reader(_joint_motion),
    "mapped motion": Reader(_motion(mapping="rz=knee_flexion,rx=knee_adduction,tx=knee_tx,ty=knee_ty", angles="rad")),
    "clinical motion": Reader(_motion(grood_suntay_side="right")),
    "placement": Reader(_called("io.motion.poses", "read_pose", "mm")),
    "faces": Reader(_called("io.mesh.faces", "read_face_indices", 20000)),
    "study": Reader(_study),
    "markers": Reader(_called("io.mocap.markers", "read_markers"), gaps=True),
    "marker map": Reader(_called("io.mocap.markers", "read_marker_map")),
    "plates": Reader(_called("io.mocap.force_plates", "read_force_plates"), gaps=True),
    "c3d markers": Reader(_called("io.mocap.c3d_markers", "read_c3d_markers"), gaps=True, seconds=60.0),
    "c3d plates": Reader(_called("io.mocap.force_plates", "read_force_plates"), gaps=True, seconds=60.0),
    "c3d analogs": Reader(_called("io.mocap.c3d_analogs", "read_c3d_analogs"), gaps=True, seconds=60.0),
    "c3d events": Reader(_called("io.mocap.c3d_events", "read_c3d_strikes"), seconds=60.0),
    "osim joint": Reader(_called("io.opensim.osim", "read_joint", "knee_r"), open_ended=True),
    "osim placement": Reader(_called("io.opensim.osim_meshes", "mesh_placements", "tibial_insert")),
    "osim multibody": Reader(_called("io.opensim.osim_multibody", "read_multibody"), open_ended=True),
    "osim forces": Reader(_forces_of),
    "osim spheres": Reader(_called("io.opensim.osim_contact", "read_contact_spheres", "foot")),
    "marker weights": Reader(_called("io.opensim.marker_weights", "read_marker_weights")),
    "loads": Reader(_called("io.opensim.external_loads", "read_external_loads")),
    "ik setup": Reader(_called("io.opensim.tool_setup", "read_tool_setup", "InverseKinematicsTool")),
    "id setup": Reader(_called("io.opensim.tool_setup", "read_tool_setup", "InverseDynamicsTool")),
    "scale setup": Reader(_called("io.opensim.tool_setup", "read_tool_setup", "ScaleTool")),
    "gap case": Reader(_case, gaps=True, open_ended=True),
    "gathering": Reader(_called("io.cases.gathering", "read_gathering"), open_ended=True),
    "areas": Reader(lambda path: _called("io.recordings.area_table", "read_area_table")([path])),
    "area over force": Reader(_called("io.recordings.area_table", "read_area_over_force")),
    "cycles": Reader(_called("io.recordings.load_cells", "read_cycle_table")),
    "load cells": Reader(_called("io.recordings.load_cells", "read_load_cells", ("AL", "PM", "AM", "PL"), "N", {})),
    "forces": Reader(_called("io.recordings.area_table", "read_force_curves", None, {})),
    "regression": Reader(_called("io.recordings.load_cells", "read_regression")),
    "elbow recording": Reader(
        _called("io.recordings.elbow_recording", "read_elbow_recording", {"beta": (1.0, "hinge")}, None, None, ())
    ),
    "drift": Reader(_called("io.recordings.elbow_recording", "read_axis_drift")),
    "population": Reader(_population),
    "mat grid": Reader(_grid, gaps=True, open_ended=True),
    "mat layout": Reader(_called("io.mats.layout", "read_layout")),
    "mat landmarks": Reader(_called("io.recordings.mat_results", "read_mat_landmarks", 16, 8)),
    "mat export": Reader(_called("io.mats.catalogue", "read_mat"), gaps=True, open_ended=True),
    "mat pedar": Reader(_pedar, gaps=True, open_ended=True),
    "wrench head": Reader(_called("io.text.wrench_head", "read_wrench_head")),
    "spheres": Reader(_called("io.recordings.spheres", "read_spheres")),
    "law": Reader(_called("io.recordings.spheres", "read_law")),
    "gait study": Reader(_called("io.recordings.gait_study", "read_gait_study")),
    "standing study": Reader(_called("io.recordings.standing_study", "read_standing_study")),
    "overhead study": Reader(_called("io.recordings.overhead_study", "read_overhead_study")),
    "device": Reader(_device),
    "person": Reader(
        _called("io.recordings.shoulder_device", "read_person_file", ("upper_arm", "shoulder_width", "torso"))
    ),
    "contact parameters": Reader(_contact_parameters),
    "profile": Reader(_called("io.recordings.area_table", "read_radius_profile")),
    "fit.json": Reader(_axis),
    "elbow.json": Reader(_elbow_json),
    "run.json": Reader(_run),
}
"""By what they read."""


def numbers(value: Any, depth: int = 0) -> Iterator[np.ndarray]:
    """Every array of numbers in what a reader returns."""
    if isinstance(value, (bool, str, bytes, Path)) or value is None or depth > 8:
        return
    if isinstance(value, (int, float, np.number)):
        yield np.array([float(value)])
    elif isinstance(value, np.ndarray):
        if value.dtype.kind in "iuf":
            yield value.astype(float).ravel()
    elif isinstance(value, pd.DataFrame):
        yield value.select_dtypes("number").to_numpy(float).ravel()
    elif hasattr(value, "as_matrix"):
        yield np.asarray(value.as_matrix()).ravel()
    else:
        for part in _parts(value):
            yield from numbers(part, depth + 1)


def _parts(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return [getattr(value, each.name, None) for each in dataclasses.fields(value)]
    if isinstance(value, Mapping):
        return value.values()
    if isinstance(value, (list, tuple, set, frozenset)):
        return value
    own = type(value).__module__.startswith("geocontact") and hasattr(value, "__dict__")
    return vars(value).values() if own else ()


@dataclass(frozen=True)
class Found:
    """How many things and numbers a reader returned, how many of them are NaN or infinite, and the largest other."""

    things: int
    numbers: int
    gaps: int
    endless: int
    largest: float


def summary(value: Any) -> Found:
    """What is in it, in numbers."""
    found = [each for each in numbers(value) if each.size]
    whole = np.concatenate(found) if found else np.zeros(0)
    finite = np.abs(whole[np.isfinite(whole)])
    gaps = int(np.isnan(whole).sum())
    return Found(_things(value), whole.size, gaps, whole.size - finite.size - gaps, float(finite.max(initial=0.0)))


def _things(value: Any) -> int:
    """Length of what is a list, else 1."""
    try:
        return len(value)
    except TypeError:
        return 1
