"""Measured loads on the bodies of a model, at the times of its motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.cli.record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody import Multibody
from geocontact.data.wrench import Wrench
from geocontact.io.external_loads import ExternalLoad, read_external_loads
from geocontact.io.force_plates import ForcePlate, plate_named, read_force_plates
from geocontact.io.tables import listed


def loads_on_bodies(
    record: Record, file: Path | None, model: Multibody, time: Float[np.ndarray, " t"]
) -> dict[str, Wrench]:
    """One wrench on each body that a plate acts on, about the ground's origin; several plates on a body add up."""
    if file is None:
        return {}
    data, loads = read_external_loads(file)
    record.add_input("--loads", file, forces=len(loads))
    plates = read_force_plates(data)
    record.add_input("plates", data, plates=len(plates))
    found: dict[str, Wrench] = {}
    for load in loads:
        _refuse_unknown(file, load, model)
        plate = plate_named(plates, load.plate, data, f"{file} <force_identifier>")
        wrench = _during(record, data, plate, time)
        before = found.get(load.body)
        if before is not None:
            wrench = Wrench(wrench.force + before.force, wrench.moment + before.moment, wrench.origin, wrench.frame)
        found[load.body] = wrench
    return found


def _refuse_unknown(file: Path, load: ExternalLoad, model: Multibody) -> None:
    names = tuple(body.name for body in model.bodies)
    if load.body not in names:
        raise InputError(file, "<applied_to_body>", f"no body '{load.body}'", f"bodies are: {listed(names)}")


def _during(record: Record, file: Path, plate: ForcePlate, time: Float[np.ndarray, " t"]) -> Wrench:
    if time[0] < plate.time[0] - 1e-6 or time[-1] > plate.time[-1] + 1e-6:
        what = f"runs from {plate.time[0]:g} to {plate.time[-1]:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, plate.name, what, "cut the motion with --time")
    wrench = plate.at(np.clip(time, plate.time[0], plate.time[-1]))
    lost = ~(np.isfinite(wrench.force).all(axis=1) & np.isfinite(wrench.moment).all(axis=1))
    if lost.any():
        idle = np.abs(np.nan_to_num(wrench.force)).max(axis=1) == 0.0
        if (lost & ~idle).any():
            first = time[np.argmax(lost & ~idle)]
            what = f"force, point or torque is missing at {first:g} s and {int((lost & ~idle).sum())} frames in all"
            raise InputError(file, plate.name, what, "give columns of force, point and torque")
        record.warn(f"{file}: {plate.name} has no point in {int(lost.sum())} frames without force; taken as unloaded")
    return Wrench(np.nan_to_num(wrench.force), np.nan_to_num(wrench.moment), wrench.origin, wrench.frame)
