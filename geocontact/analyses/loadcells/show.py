"""What is shown of load cells: static figures, and the page with curves, tray and weights."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.pages import thinned
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.analyses.loadcells.cycles import SIDES, Cut, stacked
from geocontact.analyses.loadcells.forces import RecordedCells
from geocontact.data.cell_regression import CellRegression
from geocontact.data.motion import Course
from geocontact.data.text import seconds
from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.cycles import STEPS
from geocontact.identify.signals.filters import gaps
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Shade, mean_curve
from geocontact.view.extremes import FRAMES
from geocontact.view.page.content import (
    Choices,
    Mark,
    Page,
    PageChoice,
    Plan,
    Section,
    Table,
    Track,
    Words,
)

SINGLE = 8
"""Single cycles of a style that are drawn at most: more lines tell no more, and a file must not grow with them."""


def some_cycles(trials: Float[np.ndarray, "n t"]) -> Float[np.ndarray, "k t"]:
    """All cycles, or `SINGLE` of them: the one with the highest peak, the one with the lowest, and others between."""
    if len(trials) <= SINGLE:
        return trials
    by_peak = np.argsort(trials.max(axis=1), kind="stable")
    return np.asarray(trials[np.sort(by_peak[np.linspace(0, len(trials) - 1, SINGLE).astype(int)])])


def ensemble_curves(
    sides: Mapping[str, Mapping[str, Float[np.ndarray, "_ 101"]]],
    along: str = "cycle",
    unit: str = "N",
    per_newton: float = 1.0,
) -> CurveSheet:
    """Mean and SD over the cycle and, thin, single cycles; a panel per compartment, a colour per gait style.

    Forces are shown in `unit`, of which one newton is `per_newton`.
    """
    panels = []
    for side, styles in sides.items():
        curves = [mean_curve(style, trials, k, per_newton) for k, (style, trials) in enumerate(styles.items())]
        curves += [
            Curve(style, per_newton * one, stroke=k, thin=True)
            for k, (style, trials) in enumerate(styles.items())
            for one in (some_cycles(trials) if len(trials) > 1 else ())
        ]
        panels.append(Curves(f"{side.capitalize()} contact force over the {along}", unit, curves))
    return CurveSheet(panels, Course(along, "%", STEPS))


@dataclass(frozen=True, eq=False)
class Samples:
    """Times that the page shows [s], their numbers by the recorder's clock, and how many these are in all.

    Samples that were lost are counted, so that numbers go with the clock.
    """

    given: Float[np.ndarray, " t"]
    kept: Int[np.ndarray, " k"]
    time: Float[np.ndarray, " s"]
    numbers: Int[np.ndarray, " s"]
    total: int

    def of(self, values: Float[np.ndarray, " t"]) -> Float[np.ndarray, " s"]:
        """What the page shows of values at the recording's own times; NaN in gaps."""
        found = np.full(len(self.time), np.nan)
        found[np.searchsorted(self.time, self.given[self.kept])] = values[self.kept]
        return found


def samples(
    time: Float[np.ndarray, " t"], curves: Sequence[Float[np.ndarray, " t"]] = (), most: int = FRAMES
) -> Samples:
    """Samples with the extremes of the curves, `most` about, those beside gaps, and the middle of each gap."""
    missing = gaps(time)
    after = np.array([np.searchsorted(time, each.end) for each in missing], int)
    kept = np.unique(np.concatenate([thinned(len(time), curves, most=most), after, after - 1])).astype(int)
    step = float(np.median(np.diff(time))) if len(time) > 1 else 1.0
    lost = np.maximum(np.rint((time[after] - time[after - 1]) / step).astype(int) - 1, 0)
    place = np.unique(
        np.concatenate([kept, after, after - 1, [0, len(time) - 1]])
    )  # between two of them nothing is lost
    by_clock = place + 1 + np.concatenate([[0], np.cumsum(lost)])[np.searchsorted(after, place, side="right")]
    middles = np.array([0.5 * (each.start + each.end) for each in missing])
    shown = np.unique(np.concatenate([time[kept], middles]))
    numbers = np.rint(np.interp(shown, time[place], by_clock)).astype(int)
    return Samples(time, kept, shown, numbers, int(by_clock[-1]))


def beside_their_mean(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], cuts: list[Cut], recording: str, side: str
) -> list[Curve]:
    """The force and, within each of its cycles, mean ± SD of that cycle's style; nothing between the cycles."""
    mean, lower, upper = (np.full(len(time), np.nan) for _ in range(3))
    styles = {style: mean_and_sd(trials) for style, trials in stacked(cuts, side).items()}
    for cut in cuts:
        if cut.recording != recording:
            continue
        inside = (time >= cut.span.start) & (time <= cut.span.end)
        place = 100.0 * (time[inside] - cut.span.start) / (cut.span.end - cut.span.start)
        level, spread = (np.interp(place, STEPS, each) for each in styles[cut.style])
        mean[inside], lower[inside], upper[inside] = level, level - spread, level + spread
    known = np.isfinite(values)
    for each in (mean, lower, upper):
        each[~known] = np.nan
    spread = bool(np.isfinite(lower).any())
    both = Curve("mean of the cycles ± SD", mean, lower if spread else None, upper if spread else None, stroke=0)
    return [Curve("as recorded", values, stroke=INK), both]


PLACES = {"PM": (-1.0, -1.0), "AM": (-1.0, 1.0), "AL": (1.0, 1.0), "PL": (1.0, -1.0)}
"""Posterior and anterior, medial and lateral cell, in half their distances."""
LEAST = 0.05  # of the largest total; a side with less has no centre worth a point
SLIGHT = 0.01  # of the largest total; less tension of a cell than that is an offset
WORDS = (
    "The four cells, seen from above. Each point lies between them as their forces share the load; distances are in "
    "half the spacing of the cells, because the size of the tray is not an input."
)
WIDE, DEEP, CORNER = 1.6, 1.45, 3.0  # outline in the same unit: a rounded plate, a sketch


def tray_plan(cells: dict[str, Float[np.ndarray, " t"]]) -> Plan | None:
    """Cells and the centre of pressure of each side and of the whole; None for a tray with other cells.

    The centre is that of the cells' forces at the cells. Where a side bears little or pulls there is none (NaN).
    """
    if set(cells) != set(PLACES):
        return None
    total = sum(cells.values(), np.zeros(()))
    least = LEAST * float(np.nanmax(total))
    tracks = [
        Track("medial", _centre({c: f for c, f in cells.items() if c.endswith("M")}, least)),
        Track("lateral", _centre({c: f for c, f in cells.items() if c.endswith("L")}, least)),
        Track("whole tray", _centre(cells, least)),
    ]
    turn = np.linspace(0.0, 2.0 * np.pi, 97)
    x, y = (np.sign(part) * np.abs(part) ** (2.0 / CORNER) for part in (np.cos(turn), np.sin(turn)))
    return Plan(
        "Where the force acts on the tray",
        "half spacing",
        "medial ← → lateral",
        "posterior ← → anterior",
        [np.column_stack([WIDE * x, DEEP * y]), np.array([[0.0, -DEEP], [0.0, DEEP]])],
        tracks,
        [Mark(name, place) for name, place in PLACES.items()],
        words=WORDS,
    )


def _centre(forces: dict[str, Float[np.ndarray, " t"]], least: float) -> Float[np.ndarray, "t 2"]:
    names = list(forces)
    each = np.stack([forces[name] for name in names], axis=1)
    total = each.sum(axis=1)
    bears = (total > least) & (each > -SLIGHT / LEAST * least).all(axis=1)
    moments = each @ np.array([PLACES[name] for name in names])
    found = np.full((len(total), 2), np.nan)
    found[bears] = moments[bears] / total[bears, None]
    return found


CELLS = (
    "Each cell measures the force along its own axis. The sum is the axial force on the tray; how it is shared between "
    "the compartments is a regression, not a measurement. Shear and friction are not included."
)
CYCLES, STYLES = "Cycles", "Difference to the first style (root mean square of the means)"
SHIFTS = "Swing and time of each style compared with the first, intervals of 95 % over cycles"
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


Ensemble = Callable[[ForceUnit], CurveSheet | None]
"""Means over the cycle in a unit; None where there are none."""


def loadcell_page(
    recorded: RecordedCells,
    regression: CellRegression,
    cuts: list[Cut],
    ensemble: Ensemble,
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
    forces, shown = recorded.forces, _samples(recorded, regression, FRAMES if weight is None else BOTH_UNITS)
    cells = {name: shown.of(values) for name, values in recorded.by_cell(regression).items()}
    tray = tray_plan(cells)
    many = cuts and max(len(trials) for trials in stacked(cuts, SIDES[0]).values()) > SINGLE
    words = ENSEMBLE + (SOME if many else "")

    def sections(unit: ForceUnit) -> list[Section]:
        means = ensemble(unit)
        forces_over_time, *others = _curves(recorded, shown, cells, cuts, unit)
        return [
            forces_over_time,
            *([] if tray is None else [tray]),
            *others,
            *([] if means is None else [replace(each, over=means.over, words=words) for each in means.panels]),
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
        sections=(*own, *results, *_of_the_cells(regression)),
        numbers=shown.numbers,
        total=shown.total,
        choices=choices,
    )


def _samples(recorded: RecordedCells, regression: CellRegression, most: int) -> Samples:
    """Samples with the extremes of all forces."""
    forces = recorded.forces
    return samples(forces.time, [forces.total, *forces.curves.values(), *recorded.by_cell(regression).values()], most)


def loadcell_curves(recorded: RecordedCells, regression: CellRegression, cuts: list[Cut]) -> CurveSheet:
    """Forces of the compartments and of the cells over time, cycles shaded in turns."""
    shown = _samples(recorded, regression, FRAMES)
    cells = {name: shown.of(values) for name, values in recorded.by_cell(regression).items()}
    return CurveSheet(_curves(recorded, shown, cells, cuts, NEWTON), Course("time", "s", shown.time), 1)


def _curves(
    recorded: RecordedCells, shown: Samples, cells: dict[str, np.ndarray], cuts: list[Cut], unit: ForceUnit
) -> list[Curves]:
    """Compartments, cells, and the total beside the mean of its cycles; broken where samples are missing."""
    per = unit.per_newton
    sides = {name: shown.of(values) for name, values in recorded.forces.curves.items()}
    spans = [Shade("cycle", cut.span.start, cut.span.end) for cut in cuts if cut.recording == recorded.file.stem]
    curves = [Curve(name, values * per) for name, values in sides.items()]
    panels = [Curves("Contact force", unit.name, curves, spans=spans)]
    if spans:
        beside = beside_their_mean(shown.time, sides["total"], cuts, recorded.file.stem, "total")
        panels.append(Curves("Total force, each cycle and the mean", unit.name, [_times(one, per) for one in beside]))
    panels.append(Curves("Load cells", unit.name, [Curve(name, values * per) for name, values in cells.items()]))
    return panels


def _times(curve: Curve, per: float) -> Curve:
    lower, upper = (None if each is None else each * per for each in (curve.lower, curve.upper))
    return replace(curve, values=curve.values * per, lower=lower, upper=upper)


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


def _of_the_cells(r: CellRegression) -> tuple[Table, Words]:
    """Their weights, and what these leave out."""
    said = [CELLS, f"Weights of the cells: {r.source}.", NOT_A_DEVICE]
    return _weights(r), Words("What the numbers do not contain", said)


def _weights(r: CellRegression) -> Table:
    rows = [(c, f"{m:g}", f"{k:g}") for c, m, k in zip(r.cells, r.medial, r.lateral, strict=True)]
    return Table(f"Weights of the cells, '{r.name}'", ("cell", "medial", "lateral"), rows)
