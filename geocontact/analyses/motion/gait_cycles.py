"""Cycles of a walk: heel strikes from events, markers or plates, and curves over the cycle."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.frame.quantities import named_file, number
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.data.gait_events import OFF, STANCE, STRIKE, GaitEvent, Part, of_recording, times_of
from geocontact.data.motion import Course
from geocontact.data.sides import LEFT, RIGHT, stem_and_side
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.cycles import STEPS
from geocontact.identify.signals.gait_cycles import GaitCycles, Strikes
from geocontact.io.recordings.gait_events import read_gait_events
from geocontact.view.curves.declared import Curves, mean_curve, stroke

ONSET = 20.0
"""N at which a foot is on the ground; gait laboratories use 10 to 30 N."""
EXAMPLE = "right=0.63,1.86"


def strikes_typed(texts: tuple[str, ...]) -> Strikes:
    """`right=0.63,1.86`, a text for each side."""
    found: Strikes = {}
    for text in texts:
        side, equals, times = text.partition("=")
        side = side.strip().lower()
        if not equals or side not in (RIGHT, LEFT) or side in found:
            raise InputError(
                "", "`events`", f"'{text}' is not a side and its times", f"write {EXAMPLE}, each side once"
            )
        found[side] = np.array([number(part, "`events`", EXAMPLE) for part in times.split(",")])
        if len(found[side]) < 2 or not (np.diff(found[side]) > 0.0).all():
            raise InputError("", "`events`", f"'{text}' are not two or more increasing times", f"write {EXAMPLE}")
    return found


def cutting_of(file: Path | None, side: str | None, part: Part) -> Cutting | None:
    """Events of a table or a .c3d; None where there is no file."""
    if file is None:
        return None
    add_input("`events`", file)
    return Cutting(file, read_gait_events(file), side, part)


def events_given(texts: tuple[str, ...], recording: Path) -> tuple[GaitEvent, ...]:
    """Events of a file, those typed for each side, or those that a .c3d recording marks; none without."""
    file = named_file(texts[0]) if len(texts) == 1 else None
    if file is not None:
        add_input("`events`", file)
        return read_gait_events(file)
    if texts:
        typed = strikes_typed(texts)
        return tuple(GaitEvent(side, STRIKE, float(time)) for side, times in typed.items() for time in times)
    return read_gait_events(recording) if recording.suffix.lower() == ".c3d" else ()


def strikes_and_offs(events: Iterable[GaitEvent], recording: str) -> tuple[Strikes, Strikes]:
    """Times of heel strikes and of toe offs of one recording by side."""
    own = of_recording(events, recording)
    found = []
    for event in (STRIKE, OFF):
        times = {side: times_of(own, event, side) for side in (RIGHT, LEFT)}
        found.append({side: np.array(each) for side, each in times.items() if each})
    return found[0], found[1]


def cycles_table(cycles: GaitCycles) -> pd.DataFrame:
    """Mean and SD of every coordinate at each per cent, lengths in mm; the SD is empty where there is one cycle."""
    columns: dict[str, object] = {"cycle [%]": STEPS}
    for name, trials in cycles.curves.items():
        unit, factor = ("mm", 1e3) if cycles.units[name] == "m" else (cycles.units[name], 1.0)
        mean, sd = (factor * each for each in mean_and_sd(trials))
        columns |= {f"{name}_mean [{unit}]": mean, f"{name}_sd [{unit}]": sd}
    return pd.DataFrame(columns)


def _end(part: Part) -> str:
    """Up to where a cycle is used."""
    if part == STANCE:
        return "to its toe off"
    return "to its next" if part is None else f"over the first {100.0 * float(part):g} % of the way to its next"


def cycles_curves(cycles: GaitCycles) -> list[Curves]:
    """Mean ± SD over the gait cycle, both sides of a coordinate in one panel; nothing without cycles."""
    grouped: dict[str, dict[str, str]] = {}
    for name in cycles.curves:
        stem, side = stem_and_side(name)
        grouped.setdefault(stem if side else name, {})[side or next(iter(cycles.counts))] = name
    counts = " and ".join(f"{count} of the {side} side" for side, count in cycles.counts.items())
    words = (
        f"From one heel strike of a side {_end(cycles.part)}: mean as a line, mean ± SD as a band, {counts}. "
        f"What has no side is cut at the heel strikes of the {next(iter(cycles.counts), RIGHT)} side."
    )
    over = Course("gait cycle", "%", STEPS)
    return [
        Curves(
            f"{title} over the gait cycle",
            cycles.units[next(iter(sides.values()))],
            [
                mean_curve(side, cycles.curves[sides[side]], stroke(k, k))
                for k, side in enumerate((RIGHT, LEFT))
                if side in sides
            ],
            over=over,
            words="" if place else words,
        )
        for place, (title, sides) in enumerate(grouped.items())
    ]
