"""What inverse dynamics starts from: model, filtered coordinates, and loads on bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.heel_strikes import Strikes, strikes_on_plates, strikes_typed
from geocontact.analyses.motion.inverse_dynamics.external_loads import loads_on_bodies
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.skeleton import upwards
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.model import Multibody
from geocontact.data.multibody.passive_forces import PassiveForces
from geocontact.data.wrench import Wrench
from geocontact.dynamics.forces_along import SMOOTH
from geocontact.identify.signals.even_times import UNEVEN
from geocontact.identify.signals.zero_lag import as_opensim
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_forces import read_passive_forces
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import TextTable, read_table


@dataclass(frozen=True)
class Loaded:
    """A model that moves under loads.

    Parameters
    ----------
    recorded, unfiltered, values
        Times [s] and coordinates [rad, m] of the whole recording, as they are and filtered.
    time
        Those of them that are wanted.
    loads
        By body, about the ground's origin, at the wanted times.
    strikes
        When feet come to the ground.
    passive
        Forces of the model itself.
    """

    model: Multibody
    recorded: Float[np.ndarray, " n"]
    unfiltered: Float[np.ndarray, "n c"]
    values: Float[np.ndarray, "n c"]
    time: Float[np.ndarray, " t"]
    loads: dict[str, Wrench]
    strikes: Strikes
    passive: PassiveForces

    @property
    def shown(self) -> Float[np.ndarray, "t c"]:
        """Filtered coordinates at the wanted times [rad, m]."""
        first = int(np.searchsorted(self.recorded, self.time[0]))
        return self.values[first : first + len(self.time)]


def read(o: IdOptions, record: Record) -> Loaded:
    """Everything the options name."""
    model = read_multibody(o.model)
    record.add_input("`model`", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
    table = read_table(o.coordinates)
    record.add_input("coordinates", o.coordinates, frames=len(table.time))
    unfiltered = motion_of(table, model, o.angles)
    values = _filtered(table, unfiltered, o.cutoff)
    shown = _shown(table, o.time)
    time = table.time[shown]
    loads = loads_on_bodies(record, o, model, time, values[shown])
    strikes = strikes_typed(o.events) or strikes_on_plates(time, loads, upwards(model))
    passive = read_passive_forces(o.model, model, o.exclude)
    return Loaded(model, table.time, unfiltered, values, time, loads, strikes, passive)


def _filtered(table: TextTable, values: Float[np.ndarray, "t n"], cutoff: float) -> Float[np.ndarray, "t n"]:
    if len(table.time) <= SMOOTH:
        raise InputError(table.file, "", f"{len(table.time)} frames are too few", f"{SMOOTH + 1} are needed")
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "accelerations need seconds")
    if cutoff == 0.0:
        return values
    step = float(table.time[-1] - table.time[0]) / (len(table.time) - 1)
    if np.abs(table.time - table.time[0] - step * np.arange(len(table.time))).max() > UNEVEN * step:
        what = f"frames are not {step:g} s apart to {UNEVEN:.0%} everywhere"
        raise InputError(table.file, "", what, "fill the gaps, or pass `cutoff` 0")
    try:
        return as_opensim(values, step, cutoff)
    except ValueError as error:
        raise InputError(table.file, "`cutoff`", str(error), "0 leaves the coordinates as they are") from error


def _shown(table: TextTable, span: tuple[float, float] | None) -> slice:
    if span is None:
        return slice(None)
    first, last = span
    inside = np.flatnonzero((table.time >= first - 1e-6) & (table.time <= last + 1e-6))
    if not len(inside):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(table.file, "`time`", what, f"it is from {table.time[0]:g} to {table.time[-1]:g} s")
    return slice(int(inside[0]), int(inside[-1]) + 1)
