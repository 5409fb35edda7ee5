"""The page of a load-cell recording: how much, on which side, where on the tray, and by which weights."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.analyses.loadcells.cycles import SIDES, Cut, stacked
from geocontact.analyses.loadcells.figure import CYCLES as SINGLE
from geocontact.analyses.loadcells.page_cycles import beside_their_mean
from geocontact.analyses.loadcells.page_samples import Samples, samples
from geocontact.analyses.loadcells.page_tray import tray_plan
from geocontact.analyses.loadcells.recorded import RecordedCells
from geocontact.analyses.page_words import NOT_A_DEVICE, counted
from geocontact.data.cell_regression import CellRegression
from geocontact.data.seconds import seconds
from geocontact.view.extremes import FRAMES
from geocontact.view.page.content import Choices, Curve, Curves, Page, PageChoice, Picture, Section, Table, Words

CELLS = (
    "Each cell measures the force along its own axis. The sum is the axial force on the tray; how it is shared between "
    "the compartments is a regression, not a measurement, and shear and friction are in neither."
)
CYCLES, STYLES = "Cycles", "Difference to the first style (root mean square of the means)"
SHIFTS = "Swing and time of each style beside the first, intervals of 95 % over cycles"
ENSEMBLE = (
    "Cycles as thin lines, the mean of each style as a thick one, mean ± SD as a band; 0 to 100 % of each cycle's own "
    "duration."
)
SOME = f" {SINGLE} cycles of each style are drawn, those with the highest and the lowest peak among them."
BOTH_UNITS = FRAMES // 2
"""Samples where forces are there in two units, so that the page stays below a megabyte."""


@dataclass(frozen=True)
class ForceUnit:
    """What forces are shown in: newtons, or per cent of body weight."""

    name: str
    per_newton: float

    def text(self, force: float) -> str:
        """A force as a sentence says it."""
        return f"{force * self.per_newton:.0f} {self.name}"


NEWTON = ForceUnit("N", 1.0)


def body_weight(weight: float) -> ForceUnit:
    """Per cent of a body weight [N]."""
    return ForceUnit("% of body weight", 100.0 / weight)


Drawn = Callable[[ForceUnit], bytes | None]
"""The figure of the mean over the cycle (SVG) in a unit; None where there is none."""


def loadcell_page(
    recorded: RecordedCells,
    regression: CellRegression,
    cuts: list[Cut],
    ensemble: Drawn,
    weight: float | None = None,
    results: Sequence[Table] = (),
) -> Page:
    """The page of one recording.

    Parameters
    ----------
    cuts
        Cycles of all recordings; empty where none were asked for.
    weight
        Of the body [N]: forces can be read in per cent of it.
    results
        Cycles and styles.
    """
    forces, by_cell = recorded.forces, recorded.by_cell(regression)
    curves = [forces.total, *forces.curves.values(), *by_cell.values()]
    shown = samples(forces.time, curves, FRAMES if weight is None else BOTH_UNITS)
    cells = {name: shown.of(values) for name, values in by_cell.items()}
    tray = tray_plan(cells)
    many = cuts and max(len(trials) for trials in stacked(cuts, SIDES[0]).values()) > SINGLE
    words = ENSEMBLE + (SOME if many else "")

    def sections(unit: ForceUnit) -> list[Section]:
        drawn = ensemble(unit)
        forces_over_time, *others = _curves(recorded, shown, cells, cuts, unit)
        return [
            forces_over_time,
            *([] if tray is None else [tray]),
            *others,
            *([] if drawn is None else [Picture("Over the cycle", words, drawn, wide=True)]),
        ]

    own, choices = sections(NEWTON), None
    if weight is not None:
        unit = body_weight(weight)
        instead = {k: other for k, other in enumerate(sections(unit)) if other is not tray}
        other = PageChoice(unit.name, _headline(recorded, cuts, unit), _facts(recorded, unit), instead)
        choices = Choices("forces in", NEWTON.name, [other])
    part = f"the page shows {len(shown.kept)} of {len(forces.time)} samples; forces.csv has all"
    return Page(
        title=f"Load cells of {recorded.file.name}",
        subtitle=f"Tibial contact force from {len(cells)} load cells, weights '{regression.name}'",
        time=shown.time,
        time_label="time [s]",
        headline=_headline(recorded, cuts, NEWTON),
        facts=_facts(recorded, NEWTON),
        reservations=(part,) if len(shown.kept) < len(forces.time) else (),
        start_frame=int(np.nanargmax(shown.of(forces.total))),
        sections=(
            *own,
            *results,
            _weights(regression),
            Words(
                "What the numbers do not contain", [CELLS, f"Weights of the cells: {regression.source}.", NOT_A_DEVICE]
            ),
        ),
        numbers=shown.numbers,
        total=shown.total,
        choices=choices,
    )


def _curves(
    recorded: RecordedCells, shown: Samples, cells: dict[str, np.ndarray], cuts: list[Cut], unit: ForceUnit
) -> list[Curves]:
    """Compartments, cells, and the total beside the mean of its cycles; broken where samples are missing."""
    per = unit.per_newton
    sides = {name: shown.of(values) for name, values in recorded.forces.curves.items()}
    panels = [Curves("Contact force", unit.name, [Curve(name, values * per) for name, values in sides.items()])]
    if any(cut.recording == recorded.file.stem for cut in cuts):
        beside = beside_their_mean(shown.time, sides["total"], cuts, recorded.file.stem, "total")
        panels.append(
            Curves("Total force, each cycle beside the mean", unit.name, [_times(one, per) for one in beside])
        )
    panels.append(Curves("Load cells", unit.name, [Curve(name, values * per) for name, values in cells.items()]))
    return panels


def _times(curve: Curve, per: float) -> Curve:
    lower, upper = (None if each is None else each * per for each in (curve.lower, curve.upper))
    return Curve(curve.name, curve.values * per, lower, upper)


def _headline(recorded: RecordedCells, cuts: list[Cut], unit: ForceUnit) -> list[str]:
    """The largest total force and how it is shared; what the cycles have in common."""
    f = recorded.forces
    k = int(np.argmax(f.total))
    share = f.medial[k] / f.total[k]
    lines = [f"The tray bears up to {unit.text(f.total[k])}, at {_when(recorded, k)}: {share:.0%} of it medially."]
    mine = [cut for cut in cuts if cut.recording == recorded.file.stem]
    for style, trials in stacked(mine, "total").items() if mine else ():
        peaks = trials.max(axis=1)
        spread = f" (SD {unit.text(float(peaks.std(ddof=1)))})" if len(peaks) > 1 else ""
        named = "" if style == recorded.file.stem else f" of {style}"
        lines.append(f"Peak total force of {counted(len(peaks), 'cycle')}{named}: {unit.text(peaks.mean())}{spread}.")
    return lines[:3]


def _when(recorded: RecordedCells, k: int) -> str:
    return f"{seconds(round(float(recorded.forces.time[k]), 3))} s"


def _facts(recorded: RecordedCells, unit: ForceUnit) -> list[tuple[str, str]]:
    f = recorded.forces
    lines = []
    for name, values in f.curves.items():
        k = int(np.argmax(values))
        lines.append((f"Largest {name} force", f"{unit.text(values[k])} at {_when(recorded, k)}"))
    k = int(np.argmax(f.total))
    lines.append(("Medial share at the largest total", f"{f.medial[k] / f.total[k]:.0%}"))
    return lines


def _weights(r: CellRegression) -> Table:
    rows = [(c, f"{m:g}", f"{k:g}") for c, m, k in zip(r.cells, r.medial, r.lateral, strict=True)]
    return Table(f"Weights of the cells, '{r.name}'", ("cell", "medial", "lateral"), rows)
