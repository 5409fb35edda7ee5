"""Inverse kinematics: reads, computes, writes, says what it found."""

from __future__ import annotations

import json
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.cli.ik import IkOptions
from geocontact.cli.output import written_whole
from geocontact.cli.patience import progress
from geocontact.cli.provenance import options_table
from geocontact.cli.quantities import number, time_span
from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.data.joint import Coordinate
from geocontact.data.marker_tasks import MarkerTasks
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody import Multibody
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.io.marker_weights import read_marker_weights
from geocontact.io.osim_multibody import read_multibody
from geocontact.io.results import write_table
from geocontact.io.storage_writer import write_storage
from geocontact.io.tables import listed
from geocontact.io.trc import read_trc
from geocontact.view.contact_tables import inputs_table
from geocontact.view.kinematics_page import write_kinematics_report

HELD = 1e3  # weight of a coordinate that is held, against 1 of a marker: a radian as dear as 30 m of a marker


def analyse(markers: Path, o: IkOptions) -> int:
    """Run the whole analysis."""
    record = Record("ik", {"markers": markers, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
        seen = _chosen(read_trc(markers), o)
        record.add_input("markers", markers, frames=len(seen), markers=len(seen.names))
        tasks = _tasks(record, model, seen, o)
        tree = tree_of(model)
        began = time.perf_counter()
        with progress("frames", len(seen)) as step:
            try:
                found = inverse_kinematics(tree, seen, tasks, lambda _: step())
            except ValueError as error:
                raise InputError(markers, "", str(error), "compare the names in the file with the model's") from error
        seconds = time.perf_counter() - began
        _write(record, model, found, draft, seconds)
        title = f"Inverse kinematics of {markers.name}"
        tables = [inputs_table(record.inputs), options_table(record)]
        write_kinematics_report(draft / "report.html", title, model, found, tables, list(record.warnings))
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _chosen(seen: MarkerTrajectories, o: IkOptions) -> MarkerTrajectories:
    if o.time is None:
        return seen
    first, last = time_span(o.time)
    part = seen.between(first, last)
    if not len(part):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(seen.source, "--time", what, f"the recording is from {seen.time[0]:g} to {seen.time[-1]:g} s")
    return part


def _tasks(record: Record, model: Multibody, seen: MarkerTrajectories, o: IkOptions) -> MarkerTasks:
    """Weights of --tasks, or 1 for every marker of the model; then what single options say."""
    if o.tasks is None:
        tasks = MarkerTasks({m.name: 1.0 for m in model.markers})
    else:
        tasks = read_marker_weights(o.tasks)
        record.add_input("--tasks", o.tasks, markers=len(tasks.markers), coordinates=len(tasks.coordinates))
    known = {c.name: c for c in model.coordinates}
    markers = {**tasks.markers, **_named(o.weight, "--weight", {m.name for m in model.markers}, "R.Heel=10")}
    if min(markers.values()) < 0.0:
        raise InputError("", "--weight", "a weight is negative", "weights are 0 or more")
    held = _named(o.hold, "--hold", set(known), "subtalar_angle_r=5.2")
    wanted = {name: (HELD, np.radians(v) if known[name].kind == "rotational" else v) for name, v in held.items()}
    lost = [name for name, weight in markers.items() if weight > 0.0 and name not in seen.names]
    if lost:
        record.warn(f"{seen.source}: markers that have a weight were not recorded: {listed(tuple(lost))}")
    absent = {m.name for m in model.markers}
    left = [name for name, weight in markers.items() if weight > 0.0 and name not in absent]
    if left:
        record.warn(f"markers that have a weight are not in the model: {listed(tuple(left))}")
    return MarkerTasks(markers, {**tasks.coordinates, **wanted})


def _named(texts: tuple[str, ...], option: str, names: set[str], example: str) -> dict[str, float]:
    found = {}
    for text in texts:
        name, equals, value = text.rpartition("=")
        if not equals or name not in names:
            what = f"'{text}' names nothing of the model"
            raise InputError("", option, what, f"write for example {example}; there are {listed(tuple(sorted(names)))}")
        found[name] = number(value, option, example)
    return found


def printed(coordinates: tuple[Coordinate, ...], values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t n"]:
    """Values as OpenSim's files in degrees have them: rotations in degrees, all else as it is."""
    return values * np.array([np.degrees(1.0) if c.kind == "rotational" else 1.0 for c in coordinates])


def _write(record: Record, model: Multibody, found: Poses, draft: Path, seconds: float) -> None:
    values = printed(model.coordinates, found.values)
    write_storage(draft / "ik.mot", found.time, found.names, values, title="Coordinates", degrees=True)
    off = {f"{name} [mm]": 1e3 * d for name, d in zip(found.markers, found.distances.T, strict=True)}
    write_table(pd.DataFrame({"time [s]": found.time, **off}), draft, False, "markers")
    rms = np.sqrt(np.nanmean(found.distances**2))
    worst = int(np.nanargmax(np.sqrt(np.nanmean(found.distances**2, axis=0))))
    told = {
        "frames": len(found.time),
        "frames_per_second": len(found.time) / seconds,
        "steps_mean": float(found.steps.mean()),
        "unsettled_frames": int((~found.settled).sum()),
        "rms_mm": 1e3 * float(rms),
        "max_mm": 1e3 * float(np.nanmax(found.distances)),
        "markers": {
            name: {"rms_mm": 1e3 * float(np.sqrt(np.nanmean(d**2))), "max_mm": 1e3 * float(np.nanmax(d))}
            for name, d in zip(found.markers, found.distances.T, strict=True)
        },
    }
    record.results.update(told)
    (draft / "ik.json").write_text(json.dumps(told, indent=2) + "\n", encoding="utf-8")
    if not found.settled.all():
        record.warn(f"{told['unsettled_frames']} frames did not settle: markers and model may not belong together")
    record.say(
        f"{len(found.time)} frames, {len(found.markers)} markers: {1e3 * rms:.1f} mm from the model, root mean square, "
        f"most at {found.markers[worst]}"
    )
