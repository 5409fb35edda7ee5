"""Inverse dynamics: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.json_file import plain, write_json
from geocontact.analyses.motion.inverse_dynamics.external_loads import loads_on_bodies
from geocontact.analyses.motion.inverse_dynamics.page import Forces, write_forces_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.quantities import time_span
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.id import IdOptions
from geocontact.data.errors import InputError
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.data.wrench import Wrench
from geocontact.dynamics.forces_along import SMOOTH, forces_along
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.even_times import UNEVEN
from geocontact.identify.signals.zero_lag import as_opensim
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import Table, read_table
from geocontact.view.page.tables import inputs_table


def analyse(coordinates: Path, o: IdOptions) -> int:
    """Run the whole analysis."""
    record = Record("id", {"coordinates": coordinates, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
        table = read_table(coordinates)
        record.add_input("coordinates", coordinates, frames=len(table.time))
        values = _filtered(table, motion_of(table, model, o.angles), o.cutoff)
        shown = _shown(table, o.time)
        time = table.time[shown]
        loads = loads_on_bodies(record, o, model, time, values[shown])
        found = forces_along(tree_of(model), table.time, values, time, loads)
        forces = Forces(time, model, found, _peak(loads))
        _write(record, forces, draft)
        title = f"Inverse dynamics of {coordinates.name}"
        tables = [inputs_table(record.inputs), options_table(record)]
        write_forces_report(draft / "report.html", title, forces, tables, list(record.warnings))
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _filtered(table: Table, values: Float[np.ndarray, "t n"], cutoff: float) -> Float[np.ndarray, "t n"]:
    if len(table.time) <= SMOOTH:
        raise InputError(table.file, "", f"{len(table.time)} frames are too few", f"{SMOOTH + 1} are needed")
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "accelerations need seconds")
    if not (np.isfinite(cutoff) and cutoff >= 0.0):
        raise InputError("", "--cutoff", f"{cutoff:g} is not a frequency", "0 leaves the coordinates as they are")
    if cutoff == 0.0:
        return values
    step = float(table.time[-1] - table.time[0]) / (len(table.time) - 1)
    if np.abs(table.time - table.time[0] - step * np.arange(len(table.time))).max() > UNEVEN * step:
        what = f"frames are not {step:g} s apart to {UNEVEN:.0%} everywhere"
        raise InputError(table.file, "", what, "fill the gaps, or pass --cutoff 0")
    try:
        return as_opensim(values, step, cutoff)
    except ValueError as error:
        raise InputError(table.file, "--cutoff", str(error), "0 leaves the coordinates as they are") from error


def _shown(table: Table, text: str | None) -> slice:
    if text is None:
        return slice(None)
    first, last = time_span(text)
    inside = np.flatnonzero((table.time >= first - 1e-6) & (table.time <= last + 1e-6))
    if not len(inside):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(table.file, "--time", what, f"it is from {table.time[0]:g} to {table.time[-1]:g} s")
    return slice(int(inside[0]), int(inside[-1]) + 1)


def _peak(loads: dict[str, Wrench]) -> float:
    return max((float(np.linalg.norm(wrench.force, axis=1).max()) for wrench in loads.values()), default=0.0)


def named(model: Multibody) -> tuple[str, ...]:
    """Columns as OpenSim calls them: knee_angle_r_moment, pelvis_tx_force."""
    return tuple(f"{c.name}_{'moment' if c.kind == 'rotational' else 'force'}" for c in model.coordinates)


def _write(record: Record, forces: Forces, draft: Path) -> None:
    names = named(forces.model)
    title = "Inverse Dynamics Generalized Forces"
    write_storage(draft / "id.sto", forces.time, names, forces.values, title=title, degrees=False)
    units = ["N_m" if name.endswith("_moment") else "N" for name in names]
    left = {
        name: {f"rms_{unit}": float(np.sqrt(np.mean(column**2))), f"max_{unit}": float(np.abs(column).max())}
        for name, unit, column in zip(names, units, np.asarray(forces.values).T, strict=True)
    }
    base = forces.at_ground
    told = {
        "frames": len(forces.time),
        "peak_external_force_N": forces.peak,
        "residual_force_rms_N": forces.residual,
        "residual_share_of_peak": forces.residual / forces.peak if forces.peak > 0.0 else float("nan"),
        "residuals": [name for name, there in zip(names, base, strict=True) if there],
        "coordinates": left,
    }
    record.results.update(plain(told))
    write_json(draft / "id.json", told)
    if not base.any():
        record.warn(f"no joint frees a body from the {GROUND} with six coordinates: nothing tells what is left over")
    largest = int(np.argmax(np.abs(np.where(base, 0.0, forces.values)).max(axis=0)))
    said = f"{len(forces.time)} frames; most at {names[largest]}, {np.abs(forces.values[:, largest]).max():.4g}"
    if forces.peak > 0.0 and np.isfinite(forces.residual):
        said += (
            f"; left over at the joint to the {GROUND}: {forces.residual:.3g} N, root mean square, "
            f"{forces.residual / forces.peak:.1%} of the largest measured force"
        )
    record.say(said)
