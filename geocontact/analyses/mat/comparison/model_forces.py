"""Forces of a model at the times of the mat, about the same point and in the same frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.io.text.tables import TextTable, read_table
from geocontact.io.text.units import si_unit
from geocontact.io.text.wrench_head import WrenchHead, read_wrench_head

FORCE, MOMENT = ("fx", "fy", "fz"), ("mx", "my", "mz")
UNITS: Mapping[str, str] = {
    **dict.fromkeys(FORCE, "N"),
    **dict.fromkeys(MOMENT, "N m"),
    **dict.fromkeys(("normal", "perpendicular"), "N"),
}
"""What is compared, in SI."""

SAME_POINT = 1e-6
"""m; points nearer than that are one."""

Curves = dict[str, Float[np.ndarray, " t"]]


@dataclass(frozen=True)
class ModelForces:
    """A table of forces over time, and what its first lines say of point and frame."""

    file: Path
    table: TextTable
    head: WrenchHead


def read_model(record: Record, o: MatOptions) -> ModelForces | None:
    """The forces to compare with; None where there are none."""
    if o.compare is None:
        return None
    model = ModelForces(o.compare, read_table(o.compare), read_wrench_head(o.compare))
    record.add_input("`compare`", o.compare, rows=len(model.table.time))
    return model


def model_curves(
    record: Record, model: ModelForces, ours: Wrench, time: Float[np.ndarray, " t"], o: MatOptions
) -> Curves:
    """What the model has of `UNITS`, NaN at times it does not cover; moments about the point of `ours`.

    A table that names its point (`# point_mm = ...`) has its moments moved to ours; one that does not is taken to
    refer to ours. Another frame is refused where the frame of `ours` was named, and warned of where nobody did.
    """
    known = model.table.channels
    curves = {name: _at(model, name, unit, time) for name, unit in UNITS.items() if name in known}
    if not curves:
        raise InputError(model.file, "", "holds none of our columns", f"name them {', '.join(UNITS)} with their unit")
    if curves.keys() & {*FORCE, *MOMENT}:
        _check_frame(record, model, ours, o)
    head = model.head
    record.results["compared_with"] = {
        "frame": head.frame or "not said, taken as ours",
        "point_mm": "not said, taken as ours" if head.point is None else (head.point * 1e3).tolist(),
    }
    return _moved(curves, model, ours)


def _at(model: ModelForces, name: str, unit: str, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    table = model.table
    known = si_unit(table.units[table.channels.index(name)])
    if known is None or known[0] != unit:
        raise InputError(model.file, "", f"column '{name}' is not in {unit}", f"write `{name} [{unit}]`")
    return np.asarray(known[1] * np.interp(time, table.time, table.needed(name), np.nan, np.nan))


def _check_frame(record: Record, model: ModelForces, ours: Wrench, o: MatOptions) -> None:
    if model.head.frame is None or model.head.frame == ours.frame:
        return
    what = f"is in the frame '{model.head.frame[:60]}', the mat's forces are in '{ours.frame}'"
    if o.frame is not None:
        raise InputError(model.file, "", what, "turn it into that frame, or give both one name where they are one")
    record.warn(f"{model.file} {what}: axes are compared as if they were one; say which frame ours is with `frame`")


def _moved(curves: Curves, model: ModelForces, ours: Wrench) -> Curves:
    point, there = model.head.point, [name for name in MOMENT if name in curves]
    if point is None or not there or np.abs(ours.origin - point).max() <= SAME_POINT:
        return curves
    lacking = [name for name in FORCE if name not in curves]
    if lacking:
        what = f"has moments about another point and no {', '.join(lacking)} to move them with"
        given = ", ".join(f"{value * 1e3:g}" for value in point)
        raise InputError(model.file, "", what, f"add the forces, or give `point` {given} (in mm)")
    nothing = np.full(len(ours.force), np.nan)
    force = np.column_stack([curves[name] for name in FORCE])
    moment = np.column_stack([curves.get(name, nothing) for name in MOMENT])
    at = np.broadcast_to(point, force.shape)
    moved = Wrench(force, moment, at, ours.frame).moved_to(ours.origin).moment
    return curves | {name: moved[:, MOMENT.index(name)] for name in there}
