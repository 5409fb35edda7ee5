"""Forces of a mat beside those of a model, by phase."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.recording import SLOWEST
from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.identify.signals.agreement import (
    FEWEST,
    ROUNDED,
    by_phase,
    clock_off,
    clock_words,
    likely_cause,
    overlap,
    samples_within,
)
from geocontact.identify.signals.filters import at_times, even_times
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import TextTable, read_table
from geocontact.io.text.units import si_unit
from geocontact.io.text.wrench_head import WrenchHead, read_wrench_head
from geocontact.loads.mat_load import MatLoad
from geocontact.trial_checks.channel_checks import odd_rate

MM, MM2 = 1e3, 1e6
AXES = "xyz"


def load_table(load: MatLoad, time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """Wrench, pressing, area, pressures and centre of every frame; the centre is empty below the gate."""
    force, moment, centre = load.wrench.force, load.wrench.moment, load.centre * MM
    return pd.DataFrame(
        {
            "time [s]": time,
            **{f"f{axis} [N]": force[:, k] for k, axis in enumerate(AXES)},
            **{f"m{axis} [N m]": moment[:, k] for k, axis in enumerate(AXES)},
            "normal [N]": load.pressing,
            "perpendicular [N]": load.perpendicular,
            "area [mm^2]": load.area * MM2,
            "peak [Pa]": load.peak,
            "mean [Pa]": load.mean,
            **{f"cop_{axis} [mm]": centre[:, k] for k, axis in enumerate(AXES)},
        }
    )


COLUMNS = ("name", "start [s]", "end [s]")
Stretches = list[tuple[int, int]]
"""First frame of each and the one after its last."""


@dataclass(frozen=True)
class Phase:
    """A phase once: its name, and from when to when [s]."""

    name: str
    start: float
    end: float


def read_phases(o: MatOptions) -> tuple[Phase, ...] | None:
    """Phases in the order of the file; None where nobody names any."""
    if o.phases is None:
        return None
    table = read_side_table(o.phases, COLUMNS)
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(o.phases, "line 1", f"no column {', '.join(missing)}", f"write {', '.join(COLUMNS)}")
    add_input("`phases`", o.phases, rows=len(table))
    return tuple(Phase(str(name), start, end) for name, start, end in zip(*(table[c] for c in COLUMNS), strict=True))


def frames_of(phases: tuple[Phase, ...], time: Float[np.ndarray, " t"], o: MatOptions) -> dict[str, Stretches]:
    """Frames of each phase, in the order in which names first occur."""
    file = o.phases or Path()
    found: dict[str, Stretches] = {}
    for k, phase in enumerate(phases, 1):
        first, last = samples_within(time, phase.start, phase.end)
        within = phase.start >= time[0] - ROUNDED and phase.end <= time[-1] + ROUNDED
        if not phase.end > phase.start or last - first < FEWEST or not within:
            what = f"phase '{phase.name}' from {phase.start:g} to {phase.end:g} s holds {max(last - first, 0)} frames"
            remedy = f"at least {FEWEST} are needed, between {time[0]:g} and {time[-1]:g} s"
            raise InputError(file, f"row {k}", what, remedy)
        found.setdefault(phase.name, []).append((first, last))
    for name, stretches in found.items():
        if name == "all" or overlap(stretches):
            what = "is the name of the whole recording" if name == "all" else "overlaps itself"
            raise InputError(file, "", f"phase '{name}' {what}", "correct its name, or its start and end")
    return found


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


def read_model(o: MatOptions) -> ModelForces | None:
    """The forces to compare with; None where there are none."""
    if o.compare is None:
        return None
    model = ModelForces(o.compare, read_table(o.compare), read_wrench_head(o.compare))
    add_input("`compare`", o.compare, rows=len(model.table.time))
    for odd in odd_rate(str(o.compare), "", model.table.time, SLOWEST):
        reserve(str(odd))
    return model


def model_curves(model: ModelForces, ours: Wrench, time: Float[np.ndarray, " t"], o: MatOptions) -> Curves:
    """What the model has of `UNITS`, NaN at times it does not cover; moments about the point of `ours`.

    A table that names its point (`# point_mm = ...`) has its moments moved to ours; one that does not is taken to
    refer to ours. Another frame is refused where the frame of `ours` was named, and warned of where nobody did.
    """
    known = model.table.channels
    curves = {name: _at(model, name, unit, time) for name, unit in UNITS.items() if name in known}
    if not curves:
        raise InputError(model.file, "", "holds none of our columns", f"name them {', '.join(UNITS)} with their unit")
    if curves.keys() & {*FORCE, *MOMENT}:
        _check_frame(model, ours, o)
    head = model.head
    note(
        "compared_with",
        {
            "frame": head.frame or "not said, taken as ours",
            "point_mm": "not said, taken as ours" if head.point is None else (head.point * 1e3).tolist(),
        },
    )
    return _moved(curves, model, ours)


def _at(model: ModelForces, name: str, unit: str, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    table = model.table
    known = si_unit(table.units[table.channels.index(name)])
    if known is None or known[0] != unit:
        raise InputError(model.file, "", f"column '{name}' is not in {unit}", f"write `{name} [{unit}]`")
    return np.asarray(known[1] * np.interp(time, table.time, table.needed(name), np.nan, np.nan))


def _check_frame(model: ModelForces, ours: Wrench, o: MatOptions) -> None:
    if model.head.frame is None or model.head.frame == ours.frame:
        return
    what = f"is in the frame '{model.head.frame[:60]}', the mat's forces are in '{ours.frame}'"
    if o.frame is not None:
        raise InputError(model.file, "", what, "turn it into that frame, or give both one name where they are one")
    reserve(f"{model.file} {what}: axes are compared as if they were one; say which frame ours is with `frame`")


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


PARTS = 10
HARDLY = dict.fromkeys(FORCE, 5.0) | dict.fromkeys(MOMENT, 0.5)
"""N and N m, by which a force or a moment changes that is not compared: noise of the cells."""

Curve = Float[np.ndarray, " t"]


def compared(
    model: ModelForces, phases: tuple[Phase, ...] | None, whole: MatLoad, time: Curve, o: MatOptions
) -> pd.DataFrame:
    """One row per channel and phase ("all", then those that are named, or "0-10 %", …)."""
    if len(time) < 3 * PARTS:
        raise InputError(model.file, "", f"{len(time)} frames are too few to compare", f"{3 * PARTS} are needed")
    even, step = even_times(time)
    if even is not time:
        reserve("frames are not evenly spaced: agreement is computed at even times, without gaps")
    measured = load_table(whole, time)
    named = None if phases is None else frames_of(phases, even, o)
    curves = {
        name: (at_times(time, theirs, even, step), at_times(time, _own(measured, name), even, step))
        for name, theirs in model_curves(model, whole.wrench, time, o).items()
    }
    rows = [
        {"channel": name, "unit": UNITS[name], "phase": phase, **asdict(each)}
        for name, (theirs, ours) in curves.items()
        for phase, each in by_phase(theirs, ours, step, named, PARTS).items()
    ]
    agreed = pd.DataFrame(rows).rename(columns={"lag": "lag [s]", "r2": "r2 [-]", "correlation": "correlation [-]"})
    if not (agreed.loc[agreed["phase"] == "all", "samples"] > 0).any():
        raise InputError(model.file, "", "has no time in common with the mat", "check its time column")
    _report(agreed[agreed["phase"] == "all"])
    doubts = tuple(_of_model(model.file, curves, step))
    judge(GoodnessOfFit(doubts, ("forces of the model",)))
    return agreed


def _own(measured: pd.DataFrame, name: str) -> Curve:
    return measured[f"{name} [{UNITS[name]}]"].to_numpy(float)


def _of_model(file: Path, curves: Mapping[str, tuple[Curve, Curve]], step: float) -> Iterator[Doubt]:
    """Doubts for forces of a model that a constant would do better than, and for a clock that is off."""
    for name, (theirs, ours) in curves.items():
        both = np.isfinite(theirs) & np.isfinite(ours)
        if name not in HARDLY or both.sum() < FEWEST or np.ptp(ours[both]) < HARDLY[name]:
            continue
        r2 = 1.0 - np.sum((theirs - ours)[both] ** 2) / np.sum((ours[both] - ours[both].mean()) ** 2)
        if r2 < 0.0:
            cause = likely_cause(theirs, ours) or ": are its axes, frame and trial those of the mat?"
            what = f"{file} {name}: R² is {r2:.2f}, a constant would describe the mat's force better{cause}"
            yield Doubt(what, False, -float(r2))
        elif lag := clock_off(theirs, ours, step):
            yield Doubt(f"{file} {name}: {clock_words(-lag)}", False, abs(lag))


def _report(whole: pd.DataFrame) -> None:
    note("agreement", whole.replace({np.nan: None}).to_dict(orient="records"))
    for row in whole.itertuples():
        say(f"{row.channel}: mean absolute difference {row.mae:.4g} {row.unit}, root mean square {row.rmsd:.4g}")
