"""The page of a load-cell recording: how much, when, on which side, and by which weights."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geocontact.analyses.loadcells.recorded import Recorded
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.data.cell_regression import CellRegression
from geocontact.loads.loadcells import CompartmentForces
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

FRAMES = 1001  # samples that the page shows at most; longer recordings are thinned out
CELLS = (
    "Each cell measures the force along its own axis. The sum is the axial force on the tray; how it is shared between "
    "the compartments is a regression, not a measurement, and shear and friction are in neither."
)
CYCLES, STYLES = "Cycles", "Difference to the first style (root mean square of the means)"
ENSEMBLE = "Mean of the cycles of each style as a line, mean ± SD as a band; 0 to 100 % of each cycle's own duration."


def write_loadcell_report(
    path: Path,
    recorded: Recorded,
    regression: CellRegression,
    ensemble: bytes | None,
    results: Sequence[Table] = (),
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
    sentences: Sequence[str] = (),
) -> int:
    """Write the self-contained page of one recording; returns its size in bytes.

    Parameters
    ----------
    ensemble
        Figure of the mean over the cycle (SVG), where cycles were asked for.
    results
        Cycles and styles.
    provenance
        Inputs with hashes, options, versions.
    warnings
        Reservations that came up on the way.
    sentences
        What was found.
    """
    forces, cells = recorded.forces, recorded.by_cell(regression)
    every = -(-len(forces.time) // FRAMES)
    shown = np.arange(0, len(forces.time), every)
    sections: list[Section] = [
        Readout([Row(name, "N", [f"{value:.1f}" for value in v[shown]]) for name, v in forces.curves.items()]),
        Curves("Contact force", "N", [Curve(name, values[shown]) for name, values in forces.curves.items()]),
        Curves("Load cells", "N", [Curve(name, values[shown]) for name, values in cells.items()]),
    ]
    if ensemble is not None:
        sections.append(Picture("Over the cycle", ENSEMBLE, ensemble, wide=True))
    sections += [*results, _weights(regression), *provenance]
    sections.append(Words("What the numbers do not contain", [CELLS, NOT_A_DEVICE]))
    if every > 1:
        warnings = [*warnings, f"the page shows every {every}th sample; forces.csv has them all"]
    page = Page(
        title=f"Load cells of {recorded.file.name}",
        subtitle=f"Tibial contact force from {len(cells)} load cells, weights '{regression.name}'",
        time=forces.time[shown],
        time_label="time [s]",
        headline=headline(sentences, most=2),
        facts=_facts(forces),
        reservations=tuple(warnings),
        start_frame=int(np.argmax(forces.total[shown])),
        sections=tuple(sections),
        numbers=shown + 1,
        total=len(forces.time),
    )
    return write_page(page, path)


def _facts(forces: CompartmentForces) -> list[tuple[str, str]]:
    lines = []
    for name, values in forces.curves.items():
        k = int(np.argmax(values))
        lines.append((f"Largest {name} force", f"{values[k]:.0f} N at {forces.time[k]:.3f} s"))
    k = int(np.argmax(forces.total))
    lines.append(("Medial share at the largest total", f"{forces.medial[k] / forces.total[k]:.0%}"))
    return lines


def _weights(r: CellRegression) -> Table:
    rows = [(c, f"{m:g}", f"{k:g}") for c, m, k in zip(r.cells, r.medial, r.lateral, strict=True)]
    return Table(f"Weights of the cells ({r.source})", ("cell", "medial", "lateral"), rows)
