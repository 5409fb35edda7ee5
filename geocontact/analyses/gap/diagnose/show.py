"""A diagnosis in figures and on its page: what, where, how far and how sure; curves of held-out trials after that."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.gap.case import names, percent
from geocontact.analyses.gap.diagnose.answer import (
    axis_units,
    facts_of,
    in_question,
    verdict_sentences,
)
from geocontact.data.diagnosis import Diagnosis, HeldOut
from geocontact.data.gap_case import GapCase
from geocontact.gap.diagnose import Findings
from geocontact.view.curves.before_after import SIDE_BY_SIDE, before_after
from geocontact.view.curves.diagnosis_answers import ranking_figure, reductions_figure
from geocontact.view.curves.gap_map import (
    PHASE,
    SIGNIFICANT,
    gap_map_figure,
    gap_residuals,
    gap_surface_figure,
)
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GRID = np.linspace(0.0, 1.0, 401)
SURFACE = "gap_surface_"
PRINTED = {"N m": ("N m", 1.0), "N": ("N", 1.0), "m": ("mm", 1e3), "rad": ("°", 180.0 / np.pi)}
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
FRAMES = 201
PANELS = 12  # held-out trials times channels; more are left to the tables
STROKES = {"measured": 0, "base model": 1}
"""Colours that hold in all panels; the model with the effect has the next."""
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
REDUCTIONS = (
    "Root mean square error of each channel on trials that no parameter was fitted to; the whisker is the 95 % "
    "interval of what stays on fresh trials of the same kind, the dashed line the noise floor."
)
CAPTIONS = {
    "gap_map": ("Where the gap is", MAP),
    "reductions": ("How far it shrinks", REDUCTIONS),
    "ranking": ("How sure that is", RANKING),
}
LEFT_OVER = {"gap_residuals": ("Residuals", RESIDUALS)}
CHOSEN = (
    "Probabilities weigh the effects that the vocabulary has for this system, none, and anything unknown; an effect is "
    "named because it predicts these trials best, not because it was observed."
)
HELD_OUT = (
    "Errors and reduction are those of predictions from measured inputs on trials that no parameter was fitted to; the "
    "interval is for the reduction on fresh trials of the same kind."
)


def resampled(
    trial: HeldOut, values: Float[np.ndarray, "t c"], phase: Float[np.ndarray, " p"]
) -> Float[np.ndarray, "p c"]:
    """Columns of a trial at other phases, by linear interpolation; NaN next to what is not there."""
    return np.stack([np.interp(phase, trial.phase, column) for column in values.T], axis=1)


def quantity_of(findings: Findings, channel: str) -> Quantity:
    """A channel as it is drawn: lengths in mm, angles in degrees."""
    unit = findings.attribution.problem.system.unit(channel)
    printed, per_si = PRINTED.get(unit, (unit, 1.0))
    return Quantity(channel, printed, per_si)


def map_figure(findings: Findings) -> Figure:
    """Where the gap is."""
    return gap_map_figure(findings.cells, axis_units(findings))


def gap_figures(findings: Findings) -> dict[str, Figure]:
    """Map, errors, ranking, residuals, cells of each mat, and curves of each channel where something was named."""
    found = {
        "gap_map": map_figure(findings),
        "reductions": _reductions(findings),
        "ranking": ranking_figure(findings.ranking),
        "gap_residuals": _residuals(findings),
    }
    found |= {f"{SURFACE}{_file_name(one.site, k)}": gap_surface_figure(one) for k, one in enumerate(findings.surface)}
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        drawn = _before_after(findings, c)
        found |= {} if drawn is None else {f"before_after_{_file_name(name, c)}": drawn}
    return found


def _reductions(findings: Findings) -> Figure:
    d = findings.diagnosis
    effect = effect_words(findings) if any(t.named is not None for t in findings.held_out) else ""
    return reductions_figure(d.gap, [quantity_of(findings, name) for name in d.gap], effect)


def _residuals(findings: Findings) -> Figure:
    d, trials = findings.diagnosis, findings.held_out
    channels = findings.attribution.problem.system.outputs
    base = np.array([resampled(t, t.measured - t.base, GRID) for t in trials])
    named = [resampled(t, t.measured - t.named, GRID) for t in trials if t.named is not None]
    return gap_residuals(
        GRID,
        [quantity_of(findings, name) for name in channels],
        base,
        np.array(named) if named else None,
        {name: g.noise_floor for name, g in d.gap.items()},
        {w.channel: w.phase for w in d.where},
        effect_words(findings),
    )


def _before_after(findings: Findings, c: int) -> Figure | None:
    """One channel on the first held-out trials that have it; None where nothing is named, or gaps hide a phase."""
    trials = findings.held_out
    shown = [t for t in trials if np.isfinite(t.measured[:, c]).any()][:SIDE_BY_SIDE]
    if all(t.named is None for t in trials) or not shown:
        return None
    measured, before, after = (
        np.array([resampled(t, part, GRID)[:, c] for t, part in zip(shown, parts, strict=True)])
        for parts in ([t.measured for t in shown], [t.base for t in shown], [_named(t) for t in shown])
    )
    if not np.isfinite(measured + before + after).any(axis=1).all():
        return None
    quantity = quantity_of(findings, findings.attribution.problem.system.outputs[c])
    names, effect = [t.name for t in shown], effect_words(findings)
    return before_after(100.0 * GRID, measured, before, after, quantity, effect, range(len(shown)), names, PHASE)


def effect_words(findings: Findings) -> str:
    """What the curves are drawn with."""
    return " + ".join(findings.diagnosis.effects) or "the most probable candidate"


def _named(trial: HeldOut) -> Float[np.ndarray, "t c"]:
    return trial.base if trial.named is None else trial.named


def _file_name(channel: str, number: int) -> str:
    return channel if re.fullmatch(r"\w{1,60}", channel, re.ASCII) else str(number + 1)


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
        "Parameters of the answer", ("parameter", "value", "95 % interval", "unit", "identified by the trials"), rows
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


def gap_page(
    case: GapCase,
    findings: Findings,
    drawings: Mapping[str, bytes],
) -> Page:
    """The self-contained page of one diagnosis, before it becomes a file.

    Parameters
    ----------
    case, findings
        What was diagnosed, and what was found.
    drawings
        `gap_figures` as SVG; those that `CAPTIONS` and `LEFT_OVER` name are shown, and those of surfaces.
    """
    d = findings.diagnosis
    phase = np.linspace(0.0, 1.0, FRAMES)
    panels, missing = _panels(findings, phase)
    sentences = verdict_sentences(d, findings.cells)
    surfaces = {name: ("Where on the surface", SURFACE_WORDS) for name in drawings if name.startswith(SURFACE)}
    sections: list[Section] = [*_pictures(drawings, CAPTIONS)]
    sections += [Words("Verdict", [f"{sentence[0].upper()}{sentence[1:]}." for sentence in sentences])]
    sections += [*_pictures(drawings, surfaces)]
    sections += [*panels, _readout(findings, phase), *_pictures(drawings, LEFT_OVER)]
    sections += [gap_table(findings), ranking_table(findings)]
    sections += [trials_table(findings)] if findings.trials else []
    sections += [parameters_table(d), cells_table(findings)]
    sections += [_confounded(d), INPUTS, OPTIONS, _limits(case, d, missing)]
    window = d.where[0].phase if d.where else (0.5, 0.5)
    return Page(
        title=d.case,
        subtitle=_subtitle(case, d),
        time=100.0 * phase,
        time_label="phase of the trial [%]",
        headline=headline(sentences, most=1),
        facts=facts_of(findings),
        start_frame=round(0.5 * sum(window) * (FRAMES - 1)),
        sections=tuple(sections),
        plays=False,
        answers=sum(name in drawings for name in CAPTIONS),
    )


def _pictures(drawings: Mapping[str, bytes], captions: Mapping[str, tuple[str, str]]) -> list[Picture]:
    """Those that there are, in the order of their captions."""
    shown = [name for name in captions if name in drawings]
    return [Picture(*captions[name], drawings[name], wide=name not in CAPTIONS) for name in shown]


def _subtitle(case: GapCase, d: Diagnosis) -> str:
    labels = {word for trial in (*case.calibration, *case.evaluation) for word in trial.labels.values()}
    kind = "synthetic data, " if "synthetic" in labels else ""
    return (
        f"Gap diagnosis, {kind}base model {d.system}: {len(case.calibration)} trials fitted to, "
        f"{len(case.evaluation)} held out"
    )


def _panels(findings: Findings, phase: Float[np.ndarray, " p"]) -> tuple[list[Curves], int]:
    """Two panels per held-out trial and channel, curves and residuals, and how many trials there was no room for."""
    effect = effect_words(findings)
    panels = []
    for c, name in enumerate(findings.attribution.problem.system.outputs):
        quantity = quantity_of(findings, name)
        for trial in findings.held_out:
            models = {"base model": trial.base} | ({} if trial.named is None else {f"with {effect}": trial.named})
            off = {label: trial.measured - values for label, values in models.items()}
            for words, parts in (("", {"measured": trial.measured, **models}), (": measured − predicted", off)):
                curves = [
                    Curve(label, quantity.shown(resampled(trial, values, phase)[:, c]), stroke=STROKES.get(label, 2))
                    for label, values in parts.items()
                ]
                panels.append(Curves(f"{name}, held-out trial {trial.name}{words}", quantity.unit, curves))
    return panels[: 2 * PANELS], max(len(panels) // 2 - PANELS, 0)


def _readout(findings: Findings, phase: Float[np.ndarray, " p"]) -> Readout:
    """Root mean square residual at the phase under the cursor, over the held-out trials."""
    rows, trials = [], findings.held_out
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


def _confounded(d: Diagnosis) -> Words:
    said = []
    said += [f"{sentence[0].upper()}{sentence[1:]}." for sentence in (in_question(d) if d.effects else ())]
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
        said.append(f"Not identified by these trials: {names(weak)}.")
    return Words("What is not separable", said or ["Nothing is confounded with the answer in these trials."])


def _limits(case: GapCase, d: Diagnosis, missing: int) -> Words:
    said = [CHOSEN, HELD_OUT]
    if not case.noise:
        said.append("The case states no sensor noise; it was estimated from the trials themselves.")
    if missing:
        said.append(f"{missing} panels of trials and channels are left out here; held_out.csv has them all.")
    return Words("What the numbers do not contain", [*said, NOT_A_DEVICE])
