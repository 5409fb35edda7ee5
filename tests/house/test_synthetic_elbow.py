"""docs/how-to/elbow.md says of every number of a synthetic elbow recording what it is and where it comes from."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import numpy as np

from geocontact.axis_misalignment import synthetic
from geocontact.axis_misalignment.synthetic import AMPLITUDES, FULL_SCALE, PAPER, SINES, Design

PAGE = Path(__file__).resolve().parents[2] / "docs" / "how-to" / "elbow.md"
ROW = re.compile(
    r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \| ((?:paper, sec\. [IVX]+\.[A-D]|assumed)[^|]*) \|$", re.MULTILINE
)
ROWS = {option if option != "–" else number: value for number, option, value, _ in ROW.findall(PAGE.read_text("utf-8"))}
USUAL = Design()
DEGREES = "{:g}:{:g}".format(*np.degrees(USUAL.reach))
STATED = {
    "seconds": ("`--seconds`", f"{USUAL.seconds:g}"),
    "rate": ("`--rate`", f"{USUAL.rate:g}"),
    "band": ("`--band`", "{:g}:{:g}".format(*USUAL.band)),
    "reach": ("`--range`", DEGREES),
    "noise": ("`--noise`", f"{USUAL.noise:g}"),
    "memory": ("`--memory`", f"{USUAL.memory:g}"),
    "donning": ("`--donning-mm`", f"{USUAL.donning * 1e3:g}"),
    "bits": ("`--bits`", f"{USUAL.bits}"),
    "pressures": ("`--pressure`", "none"),
    "SINES": ("sines of the multisine", f"{SINES}"),
    "AMPLITUDES": ("their relative amplitudes", "{:g}:{:g}".format(*AMPLITUDES)),
    "FULL_SCALE": (
        "full scale of the converter",
        f"{np.degrees(FULL_SCALE['beta']):g}°, {FULL_SCALE['force']:g} N, {FULL_SCALE['displacement'] * 1e3:g} mm",
    ),
    "PAPER": (
        "`--numbers`",
        ",".join(f"{name}={value * (1e3 if name in 'xylz' else 1.0):g}" for name, value in PAPER.items()),
    ),
}


def test_every_number_stands_in_the_table_with_its_source() -> None:
    constants = {name for name in vars(synthetic) if name.isupper()}
    of_constants = {name for name in vars(USUAL) if name.upper() in constants}  # no options, but numbers that ran
    assert {name: getattr(USUAL, name) for name in of_constants} == {
        name: getattr(synthetic, name.upper()) for name in of_constants
    }
    assert {each.name for each in fields(Design)} - of_constants | constants == set(STATED)
    assert {name: ROWS.get(row) for name, (row, _) in STATED.items()} == {
        name: text for name, (_, text) in STATED.items()
    }
