"""Every number that synthetic recordings of an elbow were made with, in SI, and where it is from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd

from geocontact.analyses.misalignment.simulate.trials import LoadedTrial
from geocontact.axis_misalignment.synthetic import PAPER, Design
from geocontact.data.sourced_number import Source

COLUMNS = ["number", "value", "unit", "source", "note"]
LAW = {"k": "N/m", "x": "m", "y": "m", "l": "m", "z": "m", "b": "N s/m", "s": "1/Pa", "c": "m/N"}
"""Units of the law's numbers."""
Row = tuple[str, float, str, Source, str]
Named = tuple[str, float | tuple[float, float], str, Source]
USUAL = Design()


def numbers_table(made: Sequence[LoadedTrial], design: Design | None) -> pd.DataFrame:
    """Of the experiment once, then of every trial: the law as it was there, stroke, pressure, turning."""
    rows = [] if design is None else [*_of_design(design)]
    for each in made:
        rows += _of_trial(each)
    return pd.DataFrame(rows, columns=COLUMNS)


def _of_design(design: Design) -> Iterator[Row]:
    each: list[Named] = [
        ("seconds", design.seconds, "s", "paper"),
        ("rate", design.rate, "Hz", "paper"),
        ("band", design.band, "Hz", "paper"),
        ("reach", design.reach, "rad", "invented"),
        ("noise", design.noise, "N", "invented"),
        ("memory", design.memory, "s", "invented"),
        ("donning", design.donning, "m", "invented"),
        ("bits", design.bits, "-", "paper"),
        ("sines", design.sines, "-", "invented"),
        ("amplitudes", design.amplitudes, "-", "invented"),
    ]
    for name, value, unit, source in each:
        told = source if value == getattr(USUAL, name) else "derived"
        yield from _ends(name, value, unit, told, "" if told == source else "asked for")
    if design.pressures is not None:
        yield from _ends("pressures", design.pressures, "Pa", "derived", "asked for")
    for channel, unit in (("beta", "rad"), ("force", "N"), ("displacement", "m")):
        yield f"full_scale {channel}", design.full_scale[channel], unit, "invented", "of the converter"


def _of_trial(made: LoadedTrial) -> Iterator[Row]:
    name = made.recording.name
    for number, unit in LAW.items():
        value = made.numbers[number]
        paper = value == PAPER[number]
        yield f"{name} {number}", value, unit, "paper" if paper else "derived", "" if paper else "asked for, and donned"
    if made.stroke is not None:
        yield from _ends(f"{name} stroke", made.stroke, "m", "derived", "asked for")
    yield f"{name} mean_pressure", made.mean_pressure, "Pa", "derived", "at which the stiffness is k"
    yield f"{name} turning", made.turning, "N m/rad", "derived", "stiffness of the cuff against turning"


def _ends(name: str, value: int | float | tuple[float, float], unit: str, source: Source, note: str) -> Iterator[Row]:
    """One row, or one for each end of a range."""
    if isinstance(value, tuple):
        for end, at in zip(("least", "most"), value, strict=True):
            yield f"{name} {end}", float(at), unit, source, note
    else:
        yield name, float(value), unit, source, note
