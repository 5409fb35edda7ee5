"""The page of a gap diagnosis: verdict, where, before and after on held-out trials, ranking, what cannot be told."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.gap.diagnose.curves import HeldOut, resampled
from geocontact.analyses.gap.diagnose.figures import SURFACE, axis_units, quantity_of, ranking
from geocontact.analyses.gap.diagnose.words import names, percent, place, verdict_sentences
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.gap.diagnose import Findings
from geocontact.view.curves.diagnosis.gap_map import SIGNIFICANT
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.style import in_style
from geocontact.view.curves.text import number
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRAMES = 201
PANELS = 12  # held-out trials times channels; more are left to the tables
WIDE = ("gap_map", "gap_residuals")  # drawings as wide as the page
CELLS = 12  # of the gap map that the page lists
WORDS = {"explained": "explained", "no_gap": "no gap", "unknown": "unknown", "unresolved": "unresolved"}
MAP = (
    "Share of each channel's squared residual over the phase of the trial, over inputs, their rates and the load (cut "
    "at quantiles), over frequency bands, and over the phase again of what is faster than 5 Hz; all trials, base model."
)
RANKING = "Gain of evidence over the base model of every model that was tried, in nats."
RESIDUALS = (
    "Residuals of the held-out trials over the phase; the band is the noise floor, the grey window holds 70 % of the "
    "gap."
)
SURFACE_WORDS = (
    "Part of each cell of the mat in the load that the base model expects, and in the gap on held-out trials."
)
CAPTIONS = {
    "gap_map": ("Where the gap is", MAP),
    "ranking": ("What explains it", RANKING),
    "gap_residuals": ("What is left over", RESIDUALS),
}
CHOSEN = (
    "Probabilities weigh the effects that the vocabulary has for this system, none, and anything unknown; an effect is "
    "named because it predicts these trials best, not because it was seen."
)
HELD_OUT = (
    "Errors and reduction are those of predictions from measured inputs on trials that no parameter was fitted to; the "
    "interval is for the reduction on fresh trials of the same kind."
)


def write_gap_report(
    path: Path,
    case: GapCase,
    findings: Findings,
    trials: Sequence[HeldOut],
    figures: Mapping[str, Figure],
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
) -> int:
    """Write the self-contained page of one diagnosis; returns its size in bytes.

    Parameters
    ----------
    path
        HTML file to write.
    case, findings
        What was diagnosed, and what was found.
    trials
        Held-out trials, from `gap_curves.held_out`.
    figures
        From `gap_figures.gap_figures`; those that `CAPTIONS` names are shown.
    provenance
        Further tables: inputs with hashes, options, versions.
    warnings
        Reservations that came up on the way.
    """
    return write_page(gap_page(case, findings, trials, figures, provenance, warnings), Path(path))


def gap_page(
    case: GapCase,
    findings: Findings,
    trials: Sequence[HeldOut],
    figures: Mapping[str, Figure],
    provenance: Sequence[Table] = (),
    warnings: Sequence[str] = (),
) -> Page:
    """The page before it becomes a file."""
    d = findings.diagnosis
    phase = np.linspace(0.0, 1.0, FRAMES)
    panels, missing = _panels(findings, trials, phase)
    sections: list[Section] = [_readout(findings, trials, phase), *panels]
    sections += [Words("Verdict", [f"{sentence[0].upper()}{sentence[1:]}." for sentence in _verdict(findings)])]
    sections += [
        Picture(*CAPTIONS[name], _svg(figures[name]), wide=name in WIDE) for name in CAPTIONS if name in figures
    ]
    sections += [
        Picture("Where on the surface", SURFACE_WORDS, _svg(figure), wide=True)
        for name, figure in figures.items()
        if name.startswith(SURFACE)
    ]
    sections += [_gap_table(findings), _ranking_table(findings)]
    sections += [_trials_table(findings)] if findings.trials else []
    sections += [_parameters_table(d), _cells_table(findings)]
    sections += [_confounded(d), *provenance, _limits(case, d, missing)]
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    window = d.where[0].phase if d.where else (0.5, 0.5)
    return Page(
        title=d.case,
        subtitle=_subtitle(case, d),
        time=100.0 * phase,
        time_label="phase of the trial [%]",
        headline=_headline(findings),
        start_frame=round(0.5 * sum(window) * (FRAMES - 1)),
        sections=tuple(sections),
    )


def _verdict(findings: Findings) -> list[str]:
    return verdict_sentences(findings.diagnosis, findings.cells)


def _subtitle(case: GapCase, d: Diagnosis) -> str:
    labels = {word for trial in (*case.calibration, *case.evaluation) for word in trial.labels.values()}
    kind = "synthetic data, " if "synthetic" in labels else ""
    return (
        f"Gap diagnosis, {kind}base model {d.system}: {len(case.calibration)} trials fitted to, "
        f"{len(case.evaluation)} held out"
    )


def _headline(findings: Findings) -> list[tuple[str, str]]:
    """What is missing, where, how far, how sure."""
    d = findings.diagnosis
    answer = {"explained": names(d.effects), "no_gap": "nothing beyond noise"}.get(d.verdict, WORDS[d.verdict])
    lines = [("What is missing", answer)]
    if d.where:
        lines.append(("Where", place(d.where[0], findings.cells)))
        gap = d.gap[d.where[0].channel]
        if d.effects:
            low, high = gap.ci95
            reduction = f"{percent(gap.reduction)} % [{percent(low)}, {percent(high)}] of the error of "
            lines.append(("Adding it removes", f"{reduction}{d.where[0].channel} on trials not used"))
    alive = ", ".join(f"{name} {value:.2f}" for name, value in _likeliest(d) if value >= 0.005)
    lines.append(("Probabilities", alive))
    if len(d.ambiguity) > max(len(d.effects), 1):
        lines.append(("Cannot be told apart", names(d.ambiguity)))
    return lines


def _likeliest(d: Diagnosis, most: int = 5) -> list[tuple[str, float]]:
    return sorted(d.probabilities.items(), key=lambda pair: -pair[1])[:most]


def _panels(findings: Findings, trials: Sequence[HeldOut], phase: Float[np.ndarray, " p"]) -> tuple[list[Curves], int]:
    """Two panels per held-out trial and channel, curves and residuals, and how many trials there was no room for."""
    effect = " + ".join(findings.diagnosis.effects) or "the most probable candidate"
    panels = []
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        quantity = quantity_of(findings, name)
        for trial in trials:
            models = {"base model": trial.base} | ({} if trial.named is None else {f"with {effect}": trial.named})
            off = {label: trial.measured - values for label, values in models.items()}
            for words, parts in (("", {"measured": trial.measured, **models}), (": measured − predicted", off)):
                curves = [
                    Curve(label, quantity.shown(resampled(trial, values, phase)[:, c]))
                    for label, values in parts.items()
                ]
                panels.append(Curves(f"{name}, held-out trial {trial.name}{words}", quantity.unit, curves))
    return panels[: 2 * PANELS], max(len(panels) // 2 - PANELS, 0)


def _readout(findings: Findings, trials: Sequence[HeldOut], phase: Float[np.ndarray, " p"]) -> Readout:
    """Root mean square residual at the phase under the cursor, over the held-out trials."""
    rows = []
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        quantity = quantity_of(findings, name)
        for words, off in (
            ("base model", [t.measured - t.base for t in trials]),
            ("with it", [t.measured - t.named for t in trials if t.named is not None]),
        ):
            if off:
                rows.append(_row(f"{name}, {words} off by", quantity, trials, off, phase, c))
    return Readout(rows, title="At this phase, held-out trials together (rms)")


def _row(
    label: str,
    quantity: Quantity,
    trials: Sequence[HeldOut],
    off: Sequence[np.ndarray],
    phase: Float[np.ndarray, " p"],
    c: int,
) -> Row:
    values = np.array([resampled(t, part, phase)[:, c] for t, part in zip(trials, off, strict=True)])
    there = np.isfinite(values)
    squares = np.where(there, values, 0.0) ** 2
    mean = squares.sum(axis=0) / np.where(there.any(axis=0), there.sum(axis=0), np.nan)
    shown = quantity.shown(np.sqrt(mean))
    scale = float(np.nanmax(shown, initial=0.0))
    return Row(label, quantity.unit, [number(value, scale) for value in shown])


@in_style
def _svg(figure: Figure) -> bytes:
    text = StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue().encode()


def _gap_table(findings: Findings) -> Table:
    d = findings.diagnosis
    header = (
        "channel", "unit", "error before", "error after", "noise floor", "reduction", "95 % interval", "unexplained",
        "part of the whole gap", "phase with 70 % of it", "p",
    )  # fmt: skip
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
    return Table("How far the gap shrinks, held-out trials (root mean squares)", header, rows)


def _ranking_table(findings: Findings) -> Table:
    rows = []
    for one in ranking(findings):
        probability = "" if one.probability is None else f"{one.probability:.3f}"
        rows.append((one.label, one.effects, number(one.gain, 10.0), number(one.calibration, 10.0), probability))
    header = ("model", "answer", "gain, all trials [nats]", "gain, calibration trials [nats]", "probability")
    return Table("Ranking", header, rows)


def _trials_table(findings: Findings) -> Table:
    rows = [(one.trial, "yes" if one.held_out else "no", number(one.nats, 10.0)) for one in findings.trials]
    better = sum(one.nats > 0.0 for one in findings.trials)
    title = f"Each trial predicted from all others: better with what is named in {better} of {len(rows)}"
    return Table(title, ("trial", "held out", "gain [nats]"), rows)


def _parameters_table(d: Diagnosis) -> Table:
    rows = [
        (name, f"{e.value:.5g}", f"{e.ci95[0]:.5g} … {e.ci95[1]:.5g}", e.unit, "yes" if e.identifiable else "no")
        for name, e in d.parameters.items()
    ]
    return Table(
        "Parameters of the answer", ("parameter", "value", "95 % interval", "unit", "told by the trials"), rows
    )


def _cells_table(findings: Findings) -> Table:
    units = axis_units(findings)
    cells = sorted((c for c in findings.cells if c.p_value <= SIGNIFICANT), key=lambda c: (c.p_value, -c.share))
    rows = [
        (
            c.channel, c.axis, f"{c.low:.4g} … {c.high:.4g} {units.get(c.axis, '')}".replace("inf", "∞"),
            f"{percent(c.share)} %", " … ".join(percent(part) for part in c.ci95) + " %", f"{percent(c.floor)} %",
            f"{c.p_value:.2g}",
        )
        for c in cells[:CELLS]
    ]  # fmt: skip
    header = (
        "channel", "along", "between", "share of the channel's gap", "95 % interval",
        "floor: of the squared residual, no gap", "p, whole map",
    )  # fmt: skip
    return Table(f"Gap map: {len(rows)} of {len(cells)} significant cells", header, rows)


def _confounded(d: Diagnosis) -> Words:
    said = []
    if len(d.ambiguity) > 1:
        said.append(f"Still possible, most probable first: {names(d.ambiguity)}.")
    if len(d.effects) == 2:
        said.append(f"{names(d.effects)} were found together: neither alone leaves as little.")
    if d.absorbed:
        said.append(
            f"Invisible in these trials, because refitted base parameters imitate them: {names(d.absorbed)}. Any of "
            "them may be there; it would show as a wrong parameter, not as a gap."
        )
    weak = [name for name, e in d.parameters.items() if not e.identifiable]
    if weak:
        said.append(f"Not told by these trials: {names(weak)}.")
    return Words("What cannot be told apart", said or ["Nothing is confounded with the answer in these trials."])


def _limits(case: GapCase, d: Diagnosis, missing: int) -> Words:
    said = [CHOSEN, HELD_OUT]
    if not case.noise:
        said.append("The case tells no sensor noise; it was estimated from the trials themselves.")
    if missing:
        said.append(f"{missing} panels of trials and channels are left out here; held_out.csv has them all.")
    return Words("What the numbers do not contain", [*said, NOT_A_DEVICE])
