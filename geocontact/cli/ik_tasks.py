"""What counts in inverse kinematics and how much, as typed."""

from __future__ import annotations

import numpy as np

from geocontact.cli.ik import IkOptions
from geocontact.cli.quantities import number
from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.data.marker_tasks import MarkerTasks
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody import Multibody
from geocontact.io.marker_weights import read_marker_weights
from geocontact.io.tables import listed

HELD = 1e3  # weight of a coordinate that is held, against 1 of a marker: a radian as dear as 30 m of a marker


def marker_tasks(record: Record, model: Multibody, seen: MarkerTrajectories, o: IkOptions) -> MarkerTasks:
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
