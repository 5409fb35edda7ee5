"""Tables on the page of a diagnosis."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.gap.diagnose.figures import axis_units, quantity_of
from geocontact.analyses.gap.words import percent
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.diagnose import Findings
from geocontact.view.curves.diagnosis.gap_map import SIGNIFICANT
from geocontact.view.curves.text import number
from geocontact.view.page.content import Table

CELLS = 12  # of the gap map that the page lists
GAP_HEADER = (
    "channel",
    "unit",
    "error before",
    "error after",
    "noise floor",
    "reduction",
    "95 % interval",
    "unexplained",
    "part of the whole gap",
    "phase with 70 % of it",
    "p",
)
CELLS_HEADER = (
    "channel",
    "along",
    "between",
    "share of the channel's gap",
    "95 % interval",
    "floor: of the squared residual, no gap",
    "p, whole map",
)


def gap_table(findings: Findings) -> Table:
    """Errors, reduction and place of each channel."""
    d = findings.diagnosis
    where = {w.channel: w for w in d.where}
    rows = []
    for name, g in d.gap.items():
        quantity, w = quantity_of(findings, name), where.get(name)
        sizes = [
            number(float(quantity.shown(np.array(value)))) for value in (g.rmse_before, g.rmse_after, g.noise_floor)
        ]
        interval = f"{percent(g.ci95[0])} … {percent(g.ci95[1])} %"
        rest = "–" if g.unexplained is None else f"{percent(g.unexplained)} %"
        window = ["–"] * 3
        if w is not None:
            window = [f"{percent(w.share)} %", f"{percent(w.phase[0])}–{percent(w.phase[1])} %", f"{w.p_value:.2g}"]
        rows.append((name, quantity.unit, *sizes, f"{percent(g.reduction)} %", interval, rest, *window))
    return Table("How far the gap shrinks, held-out trials (root mean squares)", GAP_HEADER, rows)


def ranking_table(findings: Findings) -> Table:
    """Every model that was tried."""
    rows = []
    for one in findings.ranking:
        probability = "" if one.probability is None else f"{one.probability:.3f}"
        rows.append((one.label, one.effects, number(one.gain, 10.0), number(one.calibration, 10.0), probability))
    header = ("model", "answer", "gain, all trials [nats]", "gain, calibration trials [nats]", "probability")
    return Table("Ranking", header, rows)


def trials_table(findings: Findings) -> Table:
    """What each trial gains when it is predicted from all others."""
    rows = [(one.trial, "yes" if one.held_out else "no", number(one.nats, 10.0)) for one in findings.trials]
    better = sum(one.nats > 0.0 for one in findings.trials)
    title = f"Each trial predicted from all others: better with what is named in {better} of {len(rows)}"
    return Table(title, ("trial", "held out", "gain [nats]"), rows)


def parameters_table(d: Diagnosis) -> Table:
    """Parameters of the answer with intervals."""
    rows = [
        (name, f"{e.value:.5g}", f"{e.ci95[0]:.5g} … {e.ci95[1]:.5g}", e.unit, "yes" if e.identifiable else "no")
        for name, e in d.parameters.items()
    ]
    return Table(
        "Parameters of the answer", ("parameter", "value", "95 % interval", "unit", "told by the trials"), rows
    )


def cells_table(findings: Findings) -> Table:
    """The most significant cells of the gap map."""
    units = axis_units(findings)
    cells = sorted((c for c in findings.cells if c.p_value <= SIGNIFICANT), key=lambda c: (c.p_value, -c.share))
    rows = [
        (
            c.channel,
            c.axis,
            f"{c.low:.4g} … {c.high:.4g} {units.get(c.axis, '')}".replace("inf", "∞"),
            f"{percent(c.share)} %",
            " … ".join(percent(part) for part in c.ci95) + " %",
            f"{percent(c.floor)} %",
            f"{c.p_value:.2g}",
        )
        for c in cells[:CELLS]
    ]
    return Table(f"Gap map: {len(rows)} of {len(cells)} significant cells", CELLS_HEADER, rows)
