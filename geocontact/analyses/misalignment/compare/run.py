"""A model of the elbow beside recordings: reads, compares, writes, says how far they are apart."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.misalignment import parameters as elbow_numbers
from geocontact.analyses.misalignment.figures import CONSTRAINT, comparison_figure
from geocontact.analyses.misalignment.pages import write_comparison_report
from geocontact.analyses.misalignment.parameters import MMHG, PER_SI, unit_in_key
from geocontact.analyses.misalignment.recordings import recordings
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import counted
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.law import NAMES
from geocontact.axis_misalignment.synthetic import ideal
from geocontact.cli.elbow_compare import ElbowCompareOptions
from geocontact.cli.idle import refuse, width_rule
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.agreement import Agreement, agreement
from geocontact.identify.signals.angle_bins import angle_bins, edges_over
from geocontact.identify.signals.even_times import at_times, even_times
from geocontact.io.text.results import write_table
from geocontact.view.curves.quantity import Quantity
from geocontact.view.page.tables import frame_table, inputs_table

QUANTITIES = {"force": CONSTRAINT, "displacement": Quantity("displacement of the joint", "mm", 1e3)}
Curve = Float[np.ndarray, " t"]
SAME_MOTION = float(np.radians(2.0))
"""rad, root mean square, that angles of a recording and its model may be apart."""


@dataclass(frozen=True, eq=False)
class Pair:
    """One channel of one trial: measured and model at the trial's even times, SI units."""

    trial: str
    channel: str
    time: Curve
    beta: Curve
    measured: Curve
    model: Curve
    agreement: Agreement


def compared(paths: tuple[Path, ...], o: ElbowCompareOptions) -> int:
    """Run the whole comparison."""
    record = Record("elbow compare", {"recordings": list(paths), **asdict(o)})
    _refuse_idle(paths, o)
    stroke = None if o.stroke_mm is None else elbow_numbers.interval(o.stroke_mm, "--stroke-mm")
    with record.catching_warnings(), written_whole(o.out) as draft:
        measured = recordings(record, "measured", paths, o.map, o.angles, o.unit, o.cutoff)
        if o.fit is None:
            models = recordings(record, "simulated", o.simulated or [], None, o.angles, o.unit, None)
        else:
            models = _of_fit(record, o.fit, paths, measured, stroke)
        found = [
            pair for path, r, model in zip(paths, measured, models, strict=True) for pair in _pairs(path, r, model)
        ]
        record.results["comparison"] = [
            {"trial": p.trial, "channel": p.channel, **asdict(p.agreement)} for p in found
        ]  # fmt: skip
        _write(record, found, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    for p in found:
        a, q = p.agreement, QUANTITIES[p.channel]
        if a.r2 < 0.0:
            record.warn(f"{p.trial}, {p.channel}: R² is {a.r2:.2f}, a constant would do better: is a sign turned?")
        errors = f"MAE {q.per_si * a.mae:.3g}, RMSE {q.per_si * a.rmsd:.3g} {q.unit}"
        record.say(f"{p.trial}, {p.channel}: {errors}, R² {a.r2:.3f}")
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _refuse_idle(paths: tuple[Path, ...], o: ElbowCompareOptions) -> None:
    count = len(o.simulated or [])
    refuse(
        ((o.fit is None) == (o.simulated is None), "--fit", "or --simulated: exactly one is compared with", "give one"),
        (o.simulated is not None and count != len(paths), "--simulated",
         f"is given {count} times for {counted(len(paths), 'recording')}", "give one for each, in the same order"),
        (o.stroke_mm is not None and o.fit is None, "--stroke-mm", "does nothing without --fit", "leave it out"),
        width_rule("--bin-deg", o.bin_deg),
    )  # fmt: skip


def _of_fit(
    record: Record,
    file: Path,
    paths: Sequence[Path],
    measured: Sequence[ElbowRecording],
    stroke_mm: tuple[float, float] | None,
) -> list[ElbowRecording]:
    """The identified law along each recording's angle and cuff pressure."""
    numbers, centre = _numbers(file)
    record.add_input("--fit", file)
    stroke = None if stroke_mm is None else (stroke_mm[0] * 1e-3, stroke_mm[1] * 1e-3)
    found = []
    for path, r in zip(paths, measured, strict=True):
        if numbers["s"] != 0.0 and r.pressure is None:
            raise InputError(path, "", "the law's stiffness follows the cuff's pressure, which is not here", "add it")
        pressure = 0.0 if r.pressure is None else r.pressure - centre
        try:
            force, joint = ideal(r.time, r.beta, numbers, stroke, pressure)
        except ValueError as error:
            raise InputError(path, "", str(error), "the identified law does not reach these angles") from error
        found.append(ElbowRecording(r.name, r.time, r.beta, force, None if stroke is None else joint, r.pressure))
    return found


def _numbers(file: Path) -> tuple[Mapping[str, float], float]:
    """Numbers of the law and the pressure they are counted from, in SI units."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        told, centre = content["numbers"], content["pressure_mmHg"] or 0.0
        numbers = {name: float(told[f"{name}_{unit_in_key(name)}"]) / PER_SI[name] for name in NAMES}
        if not np.isfinite([*numbers.values(), float(centre)]).all():
            raise ValueError("a number is not finite")
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(file, "", f"holds no law of an elbow ({error})", "give elbow.json of elbow fit") from error
    return numbers, float(centre) * MMHG


def _pairs(path: Path, measured: ElbowRecording, model: ElbowRecording) -> list[Pair]:
    """Channels that both have, at the measured trial's even times within both."""
    time, step = even_times(measured.time)
    inside = (time >= model.time[0]) & (time <= model.time[-1])
    if inside.sum() < 2:
        spans = f"{measured.time[0]:g} to {measured.time[-1]:g} s, the model {model.time[0]:g} to {model.time[-1]:g} s"
        raise InputError(path, "", f"runs from {spans}", "shift the clock of one of them")
    both = [("force", measured.force, model.force)]
    if measured.displacement is not None and model.displacement is not None:
        both.append(("displacement", measured.displacement, model.displacement))
    beta = at_times(measured.time, measured.beta, time, step)[inside]
    apart = float(np.sqrt(np.nanmean((beta - np.interp(time[inside], model.time, model.beta)) ** 2)))
    if apart > SAME_MOTION:
        what = f"its angle is {np.degrees(apart):.1f} degrees, root mean square, from that of the model's recording"
        raise InputError(path, "", what, "give the simulated recordings in the same order")
    found = []
    for channel, ours, theirs in both:
        here = at_times(measured.time, ours, time, step)[inside]
        there = np.interp(time[inside], model.time, theirs)
        found.append(Pair(measured.name, channel, time[inside], beta, here, there, agreement(there, here, step)))
    return found


def comparison_table(found: Sequence[Pair]) -> pd.DataFrame:
    """One row per trial and channel; lengths in mm."""
    rows = []
    for p in found:
        a, q = p.agreement, QUANTITIES[p.channel]
        rows.append({
            "trial": p.trial, "channel": p.channel, "unit": q.unit, "mae": a.mae * q.per_si, "rmse": a.rmsd * q.per_si,
            "bias": a.bias * q.per_si, "r2 [-]": a.r2, "lag [s]": a.lag, "samples": a.samples,
        })  # fmt: skip
    return pd.DataFrame(rows)


def _write(record: Record, found: Sequence[Pair], o: ElbowCompareOptions, folder: Path) -> None:
    table = comparison_table(found)
    write_table(table, folder, o.parquet, "comparison")
    drawings = []
    for channel, quantity in QUANTITIES.items():
        mine = [p for p in found if p.channel == channel]
        if mine:
            figure = comparison_figure([p.trial for p in mine], *_binned(mine, o.bin_deg), quantity)
            drawings.append((quantity.name.capitalize(), save_both(figure, folder, f"comparison_{channel}")))
    shown = frame_table("Errors by trial and channel", table)
    first = found[0]
    headline = [(f"{p.trial}, {p.channel}", f"R² {p.agreement.r2:.3f}") for p in found]
    title = f"Model beside {counted(len({p.trial for p in found}), 'recording')}"
    write_comparison_report(
        folder / "report.html", title, first.time, first.measured, first.model, headline, drawings,
        [shown, inputs_table(record.inputs), options_table(record)], record.warnings,
    )  # fmt: skip


def _binned(pairs: Sequence[Pair], width_deg: float) -> tuple[list[Curve], list[Curve], list[Curve]]:
    """Means of angle, measured and model over bins, by trial."""
    columns: tuple[list[Curve], list[Curve], list[Curve]] = ([], [], [])
    for p in pairs:
        there = np.isfinite(p.measured)
        edges = edges_over([p.beta[there]], float(np.radians(width_deg)))
        values = np.column_stack([p.beta, p.measured, p.model])[there]
        means = angle_bins([p.time[there]], [values], edges, np.inf).cells().means
        for column, row in zip(columns, means.T, strict=True):
            column.append(row)
    return columns
