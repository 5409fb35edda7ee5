"""The page of a gap diagnosis: what, where, how far and how sure at the top; curves of held-out trials after that."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.gap.diagnose.curves import resampled
from geocontact.analyses.gap.diagnose.figures import SURFACE, effect_words, quantity_of
from geocontact.analyses.gap.diagnose.page_tables import (
    cells_table,
    gap_table,
    parameters_table,
    ranking_table,
    trials_table,
)
from geocontact.analyses.gap.diagnose.words import (
    in_part,
    in_question,
    not_ruled_out,
    one_law_words,
    place,
    verdict_sentences,
    with_classes,
)
from geocontact.analyses.gap.words import names, percent
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.data.gap.case import GapCase
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.data.gap.held_out import HeldOut
from geocontact.gap.diagnose import Findings
from geocontact.view.curves.quantity import Quantity
from geocontact.view.curves.text import number
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Words

FRAMES = 201
PANELS = 12  # held-out trials times channels; more are left to the tables
STROKES = {"measured": 0, "base model": 1}
"""Colours that hold in all panels; the model with the effect has the next."""
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
REDUCTIONS = (
    "Root mean square error of each channel on trials that no parameter was fitted to; the whisker is the 95 % "
    "interval of what stays on fresh trials of the same kind, the dashed line the noise floor."
)
CAPTIONS = {
    "gap_map": ("Where the gap is", MAP),
    "reductions": ("How far it shrinks", REDUCTIONS),
    "ranking": ("How sure that is", RANKING),
}
LEFT_OVER = {"gap_residuals": ("What is left over", RESIDUALS)}
CHOSEN = (
    "Probabilities weigh the effects that the vocabulary has for this system, none, and anything unknown; an effect is "
    "named because it predicts these trials best, not because it was seen."
)
HELD_OUT = (
    "Errors and reduction are those of predictions from measured inputs on trials that no parameter was fitted to; the "
    "interval is for the reduction on fresh trials of the same kind."
)


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


def facts_of(findings: Findings) -> list[tuple[str, str]]:
    """What is missing, where, how far, how sure."""
    d = findings.diagnosis
    answer = {"explained": with_classes(d, d.effects), "no_gap": "nothing beyond noise"}.get(
        d.verdict, WORDS[d.verdict]
    )
    lines = [("What is missing", answer)]
    if d.where:
        lines.append(("Where", place(d.where[0], findings.cells)))
        gap = d.gap[d.where[0].channel]
        if d.effects:
            low, high = gap.ci95
            reduction = f"{percent(gap.reduction)} % [{percent(low)}, {percent(high)}] of the error of "
            lines.append(("Adding it removes", f"{reduction}{d.where[0].channel} on trials not used"))
    if d.partial is not None:
        lines.append(("Explained in part", in_part(d.partial)))
    alive = ", ".join(f"{name} {value:.2f}" for name, value in _likeliest(d) if value >= 0.005)
    lines.append(("Probabilities", alive))
    if d.one_law:
        lines.append(("What it cannot be told from", "; ".join(one_law_words(d))))
    if d.verdict == "unresolved":
        lines.append(("Cannot be told apart", names(d.ambiguity)))
    elif rest := not_ruled_out(d) if d.effects else d.ambiguity:
        lines.append(("Not ruled out", "; ".join(rest)))
    return lines


def _likeliest(d: Diagnosis, most: int = 5) -> list[tuple[str, float]]:
    return sorted(d.probabilities.items(), key=lambda pair: -pair[1])[:most]


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
        said.append(f"Not told by these trials: {names(weak)}.")
    return Words("What cannot be told apart", said or ["Nothing is confounded with the answer in these trials."])


def _limits(case: GapCase, d: Diagnosis, missing: int) -> Words:
    said = [CHOSEN, HELD_OUT]
    if not case.noise:
        said.append("The case tells no sensor noise; it was estimated from the trials themselves.")
    if missing:
        said.append(f"{missing} panels of trials and channels are left out here; held_out.csv has them all.")
    return Words("What the numbers do not contain", [*said, NOT_A_DEVICE])
