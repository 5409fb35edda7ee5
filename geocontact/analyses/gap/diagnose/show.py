"""A diagnosis on its page: what the error consists of, measured and simulated, how far and how sure; then tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.gap.case import names, percent
from geocontact.analyses.gap.diagnose.answer import PART_WORDS, axis_units, facts_of, in_question, verdict_sentences
from geocontact.analyses.gap.diagnose.curves import (
    FRAMES,
    OVER,
    budget_words,
    quantity_of,
    readout,
    residual_panel,
    surface_names,
    trial_panel,
    worst_first,
)
from geocontact.analyses.gap.diagnose.page_answers import map_strips, ranking_bars, reduction_bars
from geocontact.analyses.gap.diagnose.shrinking import axis_words, interval, telling
from geocontact.analyses.gap.nats import ODDS
from geocontact.data.diagnosis import ChannelGap, Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.gap.diagnose import Findings
from geocontact.gap.reduction.error_budget import PARTS
from geocontact.view.curves.gap_map import SIGNIFICANT
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Curves, Page, Picture, Section, Table, Words

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
    "p-value",
)
CELLS_HEADER = (
    "channel",
    "along",
    "between",
    "share of the channel's gap",
    "95 % interval",
    "floor: of the squared residual, no gap",
    "p-value, whole map",
)
PANELS = 12  # held-out trials times channels; more are left to the tables
SURFACE_WORDS = (
    "Part of each cell of the mat in the load that the base model expects, and in the gap on held-out trials."
)
CHOSEN = (
    "Probabilities weigh the effects that the vocabulary has for this system, none, and anything unknown; an effect is "
    "named because it predicts these trials best, not because it was observed."
)
HELD_OUT = (
    "Errors and reduction are those of predictions from measured inputs on trials that no parameter was fitted to; the "
    "interval is for the reduction on fresh trials of the same kind."
)
PROBABILITY = (
    "p is the probability of an answer, from 0 to 1: each effect that was tried, none of them, or anything unknown. It "
    "takes into account how often such answers were wrong on cases whose truth was known."
)
BUDGET = (
    "Sizes are root mean squares on held-out trials, whose squares add; bars are shares of the squared error. "
    "Variation is what base parameters, placement, zeros and gains differ by from trial to trial, as far as is usual."
)
P_VALUE = (
    "A p-value is something else: how often chance alone would give a gap as clear as this one. It is small where "
    "there surely is a gap."
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
        rest = "–" if g.unexplained is None else f"{percent(g.unexplained)} %"
        window = ["–"] * 3
        if w is not None:
            window = [f"{percent(w.share)} %", f"{percent(w.phase[0])}–{percent(w.phase[1])} %", f"{w.p_value:.2g}"]
        rows.append((name, quantity.unit, *sizes, *_expected(g), rest, *window))
    return Table("How far the gap shrinks, held-out trials (root mean squares)", GAP_HEADER, rows)


def _expected(gap: ChannelGap) -> tuple[str, str]:
    """Reduction and interval; neither where that is too wide to show how far."""
    return (f"{percent(gap.reduction)} %", interval(gap.ci95)) if telling(gap.ci95) else ("not shown", "too wide")


def budget_shares(findings: Findings) -> Table:
    """What the squared error of the base model on held-out trials consists of, channel by channel."""
    d = findings.diagnosis
    rows = []
    for name, parts in d.budget.items():
        quantity, before = quantity_of(findings, name), d.gap[name].rmse_before
        shown = [
            f"{percent(part.share)} % [{percent(part.ci95[0])}, {percent(part.ci95[1])}]" for part in parts.values()
        ]
        rows.append((name, f"{number(float(quantity.shown(np.array(before))))} {quantity.unit}", *shown))
    header = ("channel", "error before", *(PART_WORDS[name] for name in PARTS))
    return Table("What the squared error consists of, held-out trials [95 % interval]", header, rows)


def budget_picture(findings: Findings, drawings: Mapping[str, bytes]) -> list[Picture]:
    """The budget as bars before and after, and in words; nothing where no channel has an error."""
    if not findings.diagnosis.budget:
        return []
    words = " ".join(_sentence(line) for line in budget_words(findings))
    return [Picture("What the error consists of", f"{words} {BUDGET}", drawings["budget"], wide=True)]


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
            axis_words(c.axis),
            f"{c.low:.4g} … {c.high:.4g} {units.get(c.axis, '')}".replace("inf", "∞"),
            f"{percent(c.share)} %",
            " … ".join(percent(part) for part in c.ci95) + " %",
            f"{percent(c.floor)} %",
            f"{c.p_value:.2g}",
        )
        for c in cells[:CELLS]
    ]
    return Table(f"Gap map: {len(rows)} of {len(cells)} significant cells", CELLS_HEADER, rows)


def regions_table(findings: Findings) -> Table:
    """Regions in which the base model misses something, the largest share first."""
    rows = []
    for one in findings.diagnosis.regions:
        quantity = quantity_of(findings, one.channel)
        missed = f"{float(quantity.shown(np.array(one.mean))):+.3g} {quantity.unit}"
        rows.append((one.channel, one.place, missed, f"{percent(one.share)} %", f"{one.q_value:.2g}"))
    header = ("channel", "where", "measured less predicted", "share of the squared error", "false-discovery rate")
    missing = "no share worth a name" if findings.diagnosis.verdict == "no_gap" else "something"
    return Table(f"Regions in which the base model misses {missing}", header, rows)


def gap_page(case: GapCase, findings: Findings, drawings: Mapping[str, bytes], injected: Sequence[str] = ()) -> Page:
    """The self-contained page of one diagnosis, before it becomes a file.

    Parameters
    ----------
    case, findings
        What was diagnosed, and what was found.
    drawings
        `gap_figures` as SVG; those of surfaces are shown.
    injected
        Which effect was put into the trials, and whether it was found, in sentences.
    """
    d = findings.diagnosis
    first, further = _panels(findings)
    missing = max(len(findings.held_out) * len(d.gap) - PANELS, 0)
    sentences = verdict_sentences(d, findings.cells)
    sections: list[Section] = [
        *budget_picture(findings, drawings),
        *first,
        reduction_bars(findings),
        ranking_bars(findings),
        map_strips(findings),
    ]
    sections += [*further, readout(findings)]
    sections += [Words("What was injected", [_sentence(line) for line in injected])] if injected else []
    sections += [Words("Verdict", [_sentence(line) for line in sentences])]
    sections += [Words("How to read these numbers", reading(d))]
    surfaces = [drawings[name] for name in surface_names(findings)]
    sections += [Picture("Where on the surface", SURFACE_WORDS, each, wide=True) for each in surfaces]
    sections += [gap_table(findings), *([budget_shares(findings)] if d.budget else []), ranking_table(findings)]
    sections += [trials_table(findings)] if findings.trials else []
    sections += [parameters_table(d), cells_table(findings), *([regions_table(findings)] if d.regions else [])]
    sections += [_confounded(d), INPUTS, OPTIONS, _limits(case, d, missing)]
    window = d.where[0].phase if d.where else (0.5, 0.5)
    return Page(
        title=d.case,
        subtitle=_subtitle(case, d),
        time=OVER.values,
        time_label=OVER.label,
        headline=_headline(findings, sentences, injected),
        facts=facts_of(findings),
        start_frame=round(0.5 * sum(window) * (FRAMES - 1)),
        sections=tuple(sections),
        plays=False,
    )


def _headline(findings: Findings, sentences: Sequence[str], injected: Sequence[str]) -> tuple[str, ...]:
    """The verdict, what is expected of a new trial, and the budget of the channel with most of the gap."""
    d = findings.diagnosis
    main = d.where[0].channel if d.where else next(iter(d.gap))
    first = [*injected[1:], *sentences[: 2 if d.effects else 1]]
    budget = [line for line in budget_words(findings) if line.startswith(f"{main}:")]
    return headline([*first, *budget], most=len(first) + 1)


def _sentence(words: str) -> str:
    """With a full stop, and a capital unless it begins with the name of a channel or an effect."""
    first = words.split(maxsplit=1)[0]
    named = "_" in first or first.endswith(":")
    return f"{words if named else words[0].upper() + words[1:]}."


def reading(d: Diagnosis) -> list[str]:
    """What p, nats and an interval that reaches below zero mean, as far as this diagnosis has them."""
    said = [PROBABILITY]
    main = d.where[0].channel if d.where else next(iter(d.gap), None)
    if d.effects and main is not None and d.gap[main].ci95[0] < 0.0 and telling(d.gap[main].ci95):
        low, high = d.gap[main].ci95
        p = sum(d.probabilities.get(name, 0.0) for name in d.effects)
        said.append(
            f"The 95 % interval {interval((low, high))} reaches below 0 beside p = {p:.2f}. These are two "
            f"questions. p says how sure it is that {names(d.effects)} {'is' if len(d.effects) == 1 else 'are'} there, "
            "from all trials together. The interval says how much smaller the error of a new trial may be. Trials "
            f"differ, and few were held out: on a new trial the error of {main} may shrink by up to {percent(high)} %, "
            f"or grow by up to {percent(-low)} %."
        )
    return [*said, ODDS, P_VALUE]


def _panels(findings: Findings) -> tuple[list[Curves], list[Curves]]:
    """Each channel on the first held-out trial, that with the largest gap first; then what else there is room for."""
    channels, trials = worst_first(findings), findings.held_out
    pairs = [(name, trial) for name in channels for trial in trials][:PANELS]
    first = [trial_panel(findings, name, trials[0]) for name in channels[:PANELS]]
    further = []
    for name, trial in pairs:
        further += [] if trial is trials[0] else [trial_panel(findings, name, trial)]
        further.append(residual_panel(findings, name, trial))
    return first, further


def _subtitle(case: GapCase, d: Diagnosis) -> str:
    labels = {word for trial in (*case.calibration, *case.evaluation) for word in trial.labels.values()}
    kind = "synthetic data, " if "synthetic" in labels else ""
    return (
        f"Gap diagnosis, {kind}base model {d.system}: {len(case.calibration)} trials fitted to, "
        f"{len(case.evaluation)} held out"
    )


def _confounded(d: Diagnosis) -> Words:
    said = []
    said += [_sentence(line) for line in (in_question(d) if d.effects else ())]
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
