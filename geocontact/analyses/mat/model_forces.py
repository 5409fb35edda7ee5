"""Forces of a model at the times of the mat, about the same point and in the same frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.io.text.tables import TextTable, read_table
from geocontact.io.text.units import si_unit
from geocontact.io.text.wrench_head import WrenchHead, read_wrench_head

FORCE, MOMENT = ("fx", "fy", "fz"), ("mx", "my", "mz")
UNITS: Mapping[str, str] = {
    **dict.fromkeys(FORCE, "N"), **dict.fromkeys(MOMENT, "N m"), "normal": "N", "perpendicular": "N",
}  # fmt: skip
"""What is compared, in SI."""

SAME_POINT = 1e-6
"""m; points nearer than that are one."""

Curves = dict[str, Float[np.ndarray, " t"]]


def model_curves(record: Record, ours: Wrench, time: Float[np.ndarray, " t"], o: MatOptions) -> Curves:
    """What --compare holds of `UNITS`, NaN at times it does not cover; moments about the point of `ours`.

    A table that names its point (`# point_mm = ...`) has its moments moved to ours; one that does not is taken to
    refer to ours. Another frame is refused where --frame named ours, and warned of where nobody did.
    """
    if o.compare is None:
        return {}
    table, head = read_table(o.compare), read_wrench_head(o.compare)
    record.add_input("--compare", o.compare, rows=len(table.time))
    curves = {name: _at(table, name, unit, time, o) for name, unit in UNITS.items() if name in table.channels}
    if not curves:
        raise InputError(o.compare, "", "holds none of our columns", f"name them {', '.join(UNITS)} with their unit")
    if curves.keys() & {*FORCE, *MOMENT}:
        _check_frame(record, head, ours, o)
    record.results["compared_with"] = {
        "frame": head.frame or "not said, taken as ours",
        "point_mm": "not said, taken as ours" if head.point is None else (head.point * 1e3).tolist(),
    }
    return _moved(curves, head, ours, o)


def _at(
    table: TextTable, name: str, unit: str, time: Float[np.ndarray, " t"], o: MatOptions
) -> Float[np.ndarray, " t"]:
    known = si_unit(table.units[table.channels.index(name)])
    if known is None or known[0] != unit:
        raise InputError(o.compare or "", "", f"column '{name}' is not in {unit}", f"write `{name} [{unit}]`")
    return np.asarray(known[1] * np.interp(time, table.time, table.needed(name), np.nan, np.nan))


def _check_frame(record: Record, head: WrenchHead, ours: Wrench, o: MatOptions) -> None:
    if head.frame is None or head.frame == ours.frame:
        return
    what = f"is in the frame '{head.frame[:60]}', the mat's forces are in '{ours.frame}'"
    if o.frame is not None:
        remedy = "turn it into that frame, or give both one name where they are one"
        raise InputError(o.compare or "", "", what, remedy)
    record.warn(f"{o.compare} {what}: axes are compared as if they were one; say which frame ours is with --frame")


def _moved(curves: Curves, head: WrenchHead, ours: Wrench, o: MatOptions) -> Curves:
    there = [name for name in MOMENT if name in curves]
    if head.point is None or not there or np.abs(ours.origin - head.point).max() <= SAME_POINT:
        return curves
    lacking = [name for name in FORCE if name not in curves]
    if lacking:
        what = f"has moments about another point and no {', '.join(lacking)} to move them with"
        given = ", ".join(f"{value * 1e3:g}" for value in head.point)
        raise InputError(o.compare or "", "", what, f"add the forces, or give --point {given} (in mm)")
    nothing = np.full(len(ours.force), np.nan)
    force = np.column_stack([curves[name] for name in FORCE])
    moment = np.column_stack([curves.get(name, nothing) for name in MOMENT])
    at = np.broadcast_to(head.point, force.shape)
    moved = Wrench(force, moment, at, ours.frame).moved_to(ours.origin).moment
    return curves | {name: moved[:, MOMENT.index(name)] for name in there}
