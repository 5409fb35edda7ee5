"""A diagnosis in sentences and tables: what is missing, where it sits, how far the gap shrinks, what is alike."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from geocontact.analyses.gap.case import names, percent, proposal_words
from geocontact.analyses.gap.diagnose.shrinking import (
    expected_words,
    held_out_words,
    interval,
    removed_words,
    sizes_words,
    telling,
)
from geocontact.chain.system import System
from geocontact.data.diagnosis import CellsHeld, Diagnosis, Partial, Where
from geocontact.data.gap_cells import BAND, FAST_PHASE, Cell
from geocontact.gap.diagnose import Findings
from geocontact.gap.levels import WORTH_NAMING
from geocontact.gap.localise.gap_map import load_outputs

SIGNIFICANT = 0.05  # family-wise
TELLING = 0.35  # share of a channel's gap along one axis that a part of its range must hold to be named
MISTAKES = ("unit_error", "sign_flip", "side_swap")  # of the data; nothing that a model could lack
FEW = 4  # cells that are named one by one
VERDICTS = {
    "explained": "explained",
    "partly_explained": "explained in part",
    "no_gap": "no gap",
    "unknown": "unknown",
    "unresolved": "unresolved",
}
PART_WORDS = {
    "sensor": "noise of the sensor",
    "inputs": "noise of the inputs",
    "variation": "variation from trial to trial",
    "effects": "what is named",
    "unexplained": "unexplained",
}
MOST = 0.1  # share of the whole gap from which a further channel is mentioned


def verdict_sentences(d: Diagnosis, cells: Sequence[Cell]) -> list[str]:
    """The verdict first, then what limits it; one sentence each, without a full stop."""
    explained = {"explained": _explained, "partly_explained": _explained}
    found = {**explained, "no_gap": _no_gap, "unknown": _unknown, "unresolved": _unresolved}[d.verdict]
    then = [] if d.next_experiment is None else [proposal_words(d.next_experiment, d.verdict)]
    described = (f"no effect of the table: {one.told}" for one in d.unmodelled)
    return [*found(d, cells), *described, *_faults(d), *(f"remark: {remark}" for remark in d.remarks), *then]


def untried_law(d: Diagnosis, system: System) -> str | None:
    """Where no effect explains the gap of a simulator that takes no force law: that none of those was among them."""
    if d.verdict != "unknown" or system.law.slots.neutral:
        return None
    return (
        f"effects of a force law (damping, friction, play, stops) were not tried: {system.name} has no law that they "
        "act on; a simulator in Python can take one (`acts_on`)"
    )


def place(where: Where, cells: Sequence[Cell]) -> str:
    """Where one channel's gap is: "force (phase 42–61 %, fast part of beta)"."""
    low, high = (100.0 * edge for edge in where.phase)
    parts = [f"phase {low:.0f}–{high:.0f} %", *states(where.channel, cells), *on_mat(where.cells)]
    return f"{where.channel} ({', '.join(parts)})"


def on_mat(held: CellsHeld | None) -> list[str]:
    """Which part of a mat holds most of a channel's gap."""
    if held is None:
        return []
    if held.p_value > SIGNIFICANT:
        return ["over the mat as the load is"]
    few = f"{len(held.ids)} of {held.count} cells" + (f", {names(held.ids)}," if len(held.ids) <= FEW else "")
    return [f"{few} that carry {percent(held.load)} % of the load hold {percent(held.share)} % of it"]


def states(channel: str, cells: Sequence[Cell]) -> list[str]:
    """Parts of the inputs, of their rates and of the load that hold most of a channel's gap, the fullest first."""
    found: list[tuple[float, str]] = []
    axes = dict.fromkeys(c.axis for c in cells if c.channel == channel and c.axis not in ("phase", BAND, FAST_PHASE))
    for axis in axes:
        own = sorted((c for c in cells if c.channel == channel and c.axis == axis), key=lambda c: c.low)
        words = ["low", "middle", "high"]
        thirds = [own[len(own) * k // 3 : len(own) * (k + 1) // 3] for k in range(3)]
        held = [sum(c.share for c in third if c.p_value <= SIGNIFICANT) for third in thirds]
        if axis.endswith("'"):  # fast is far from standing still, either way
            held, words = [held[0] + held[2], held[1]], ["fast", "slow"]
        best = max(range(len(held)), key=lambda k: held[k])
        chance = 2.0 / 3.0 if axis.endswith("'") and best == 0 else 1.0 / 3.0
        if held[best] > chance + (1.0 - chance) * TELLING:
            found.append((held[best] / chance, f"{words[best]} part of {axis.rstrip(chr(39))}"))
    found.sort(key=lambda each: -each[0])
    return [words for _, words in found[:2]]


def _explained(d: Diagnosis, cells: Sequence[Cell]) -> list[str]:
    mistakes = [name for name in d.effects if name in MISTAKES]
    lacking = [name for name in d.effects if name not in mistakes]
    parts = [*_named(d, lacking, "missing"), *_named(d, mistakes, "a mistake in the data")]
    it, main = "it" if len(d.effects) == 1 else "them", d.where[0].channel if d.where else next(iter(d.gap))
    parts += [f"with {it} the error of {name} is larger ({sizes_words(d.gap[name])})" for name in _larger(d)]
    if d.where:
        parts.append(f"{'it sits' if it == 'it' else 'they sit'} in {place(d.where[0], cells)}")
    others = [w.channel for w in d.where[1:] if w.share >= MOST]
    gaps = {name: d.gap[name] for name in (main, *others)}
    doing = " and ".join([*["adding"] * bool(lacking), *["undoing"] * bool(mistakes)])
    parts.append(f"{held_out_words(d.gap[main])} {doing} {it} removes {removed_words(gaps)}")
    rest = d.gap[main].unexplained
    if d.verdict == "partly_explained":
        parts.append("something else remains that is not named")
    elif rest is not None:
        parts.append(f"{percent(rest)} % stays unexplained")
    return ["; ".join(parts), f"on a new trial: {expected_words(gaps)}", *in_question(d), *_absorbed(d)]


def _larger(d: Diagnosis) -> list[str]:
    """Channels whose error on held-out trials is surely larger with what is named."""
    parts = {name: one["effects"] for name, one in d.budget.items() if "effects" in one}
    return [name for name, one in parts.items() if one.ci95[1] < 0.0 and one.share <= -WORTH_NAMING]


def in_question(d: Diagnosis) -> list[str]:
    """Why effects that are not named are in question: one law with what is named, or not far enough behind."""
    return [*one_law_words(d), *not_ruled_out(d)]


def not_ruled_out(d: Diagnosis) -> list[str]:
    """How far effects are behind what is named that are not one law with it, and how much these trials tell."""
    said, alike = [], [name for group in d.one_law for name in group]
    for name in (each for each in d.ambiguity if each not in (*d.effects, *alike)):
        why = [f"{d.behind[name]:.1f} nats behind"] if name in d.behind else []
        why += [f"the two differ by {d.apart[name]:.1f} nats on these trials"] if name in d.apart else []
        said.append(f"{name} is not ruled out{': ' if why else ''}{', '.join(why)}")
    return said


def one_law_words(d: Diagnosis) -> list[str]:
    """Which effects are one law on these trials, how close they are, and how probable they are together."""
    said = []
    for group in d.one_law:
        most = max(d.apart.get(name, 0.0) for name in group)
        total = sum(d.probabilities.get(name, 0.0) for name in group)
        close = f"they predict what {group[0]} does to within {most:.1f} nats, together p = {total:.2f}"
        said.append(f"these trials cannot distinguish {names(group[:1])} from {names(group[1:], 'or')}: {close}")
    return said


def with_classes(d: Diagnosis, some: Sequence[str]) -> str:
    """Effects that are named, each with the class that it is in: `damping or filter_lag (one law on these trials)`."""
    groups = {group[0]: f"{names(group, 'or')} (one law on these trials)" for group in d.one_law}
    shown = [groups.get(name, name) for name in some]
    return ", and ".join(shown) if groups else names(shown)  # "and" and "or" in one list would mean two things


def _named(d: Diagnosis, some: Sequence[str], what: str) -> list[str]:
    return [f"{with_classes(d, some)} {'is' if len(some) == 1 else 'are'} {what}"] if some else []


def _no_gap(d: Diagnosis, cells: Sequence[Cell]) -> list[str]:
    nothing = "nothing is missing beyond noise and trial-to-trial variation"
    return [nothing, *_open(d), *_not_ruled_out(d), *_absorbed(d)]


def _open(d: Diagnosis) -> list[str]:
    """How much of a channel's squared error is not known to be noise although nothing is found missing."""
    parts = ((name, one["unexplained"].share) for name, one in d.budget.items() if "unexplained" in one)
    return [
        f"the budget leaves {percent(share)} % of the squared error of {name} open: that less than "
        f"{percent(WORTH_NAMING)} % is missing is not sure"
        for name, share in parts
        if share >= WORTH_NAMING
    ]


def _unknown(d: Diagnosis, cells: Sequence[Cell]) -> list[str]:
    where = f" in {place(d.where[0], cells)}" if d.where else ""
    explained = " and none of the known effects explains it"
    if d.partial is not None:
        explained = f"; {in_part(d.partial)}, and something else remains that no known effect explains"
    said = [f"there is a gap{where}{explained}"]
    return [*said, *_not_ruled_out(d), *_absorbed(d)]


def in_part(partial: Partial) -> str:
    """What known effects explain, the most first: "slip explains 70 % (95 % interval 62 to 78 %) of the error of …"."""
    shares = [(name, part, ci95) for name, (part, ci95) in partial.removed.items() if part > 0.0]
    shares.sort(key=lambda each: -each[1])
    parts = [
        f"{percent(part)} %{f' (95 % interval {interval(ci95)})' if telling(ci95) else ''} of "
        f"{'that' if k else 'the error'} of {name}"
        for k, (name, part, ci95) in enumerate(shares)
    ]
    some = f"{names(partial.effects)} {'explains' if len(partial.effects) == 1 else 'explain'}"
    return f"{some} {', '.join(parts)} on trials not used"


def _not_ruled_out(d: Diagnosis) -> list[str]:
    return [f"{names(d.ambiguity)} {'is' if len(d.ambiguity) == 1 else 'are'} not ruled out"] if d.ambiguity else []


def _unresolved(d: Diagnosis, cells: Sequence[Cell]) -> list[str]:
    where = f" in {place(d.where[0], cells)}" if d.where else ""
    alike = one_law_words(d)
    return [f"there is a gap{where}; these data cannot separate {names(d.ambiguity)}", *alike, *_absorbed(d)]


def _absorbed(d: Diagnosis) -> list[str]:
    if not d.absorbed:
        return []
    return [f"base parameters would imitate {names(d.absorbed, 'or')}: these trials cannot show it either way"]


def _faults(d: Diagnosis) -> list[str]:
    said = []
    for fault in d.faults:
        what = f"{fault.effect} of {fault.channel}" if fault.channel else fault.effect
        times = f" (reads {fault.factor:.4g} times what it should)" if fault.factor != 1.0 else ""
        said.append(f"mistake in the data: {what}{times} in {names(fault.trials)}, taken as undone in all that follows")
    return said


def facts_of(findings: Findings) -> list[tuple[str, str]]:
    """What is missing, where, how far, how sure."""
    d = findings.diagnosis
    named = with_classes(d, d.effects)
    answer = {
        "explained": named,
        "partly_explained": f"{named}, and something else",
        "no_gap": "nothing beyond noise",
    }.get(d.verdict, VERDICTS[d.verdict])
    lines = [("What is missing", answer)]
    if d.where:
        lines.append(("Where", place(d.where[0], findings.cells)))
        gap = d.gap[d.where[0].channel]
        if d.effects:
            removed = f"{percent(gap.removed)} % of the error of {d.where[0].channel} ({sizes_words(gap)})"
            lines.append(("Adding it removes", f"{removed} {held_out_words(gap)}"))
            lines.append(("On a new trial", expected_words({d.where[0].channel: gap})))
    if d.partial is not None:
        lines.append(("Explained in part", in_part(d.partial)))
    alive = ", ".join(f"{name} {value:.2f}" for name, value in _likeliest(d) if value >= 0.005)
    lines.append(("Probability p of each answer", alive))
    if d.one_law:
        lines.append(("One law on these trials", "; ".join(names(group, "or") for group in d.one_law)))
    if d.verdict == "unresolved":
        lines.append(("Not separable", names(d.ambiguity)))
    elif rest := not_ruled_out(d) if d.effects else d.ambiguity:
        lines.append(("Not ruled out", "; ".join(rest)))
    return lines


def _likeliest(d: Diagnosis, most: int = 5) -> list[tuple[str, float]]:
    return sorted(d.probabilities.items(), key=lambda pair: -pair[1])[:most]


def diagnosis_tables(findings: Findings) -> dict[str, pd.DataFrame]:
    """`gap_map`, `ranking`, `held_out`, `budget`; with an answer `trials`; with cells of a mat `surface`."""
    found = {
        "gap_map": gap_map_table(findings),
        "ranking": ranking_table(findings),
        "held_out": held_out_table(findings),
        "budget": budget_table(findings.diagnosis),
    }
    found |= {"trials": trials_table(findings)} if findings.trials else {}
    return found | ({"surface": surface_table(findings)} if findings.surface else {})


def axis_units(findings: Findings) -> dict[str, str]:
    """SI unit of each axis of the gap map."""
    system = findings.attribution.problem.system
    units = {"phase": "–", BAND: "Hz", FAST_PHASE: "–"}
    for row in load_outputs(system):
        units["load"] = system.unit(system.outputs[row])
    for name in system.inputs:
        units |= {name: system.unit(name), f"{name}'": f"{system.unit(name)}/s"}
    return units


def gap_map_table(findings: Findings) -> pd.DataFrame:
    """A row per cell; `low` and `high` in the unit of the axis, `gap` in that of the channel, SI."""
    units, system = axis_units(findings), findings.attribution.problem.system
    return pd.DataFrame(
        {
            "channel": [c.channel for c in findings.cells],
            "axis": [c.axis for c in findings.cells],
            "low": [c.low for c in findings.cells],
            "high": [c.high for c in findings.cells],
            "axis_unit": [units.get(c.axis, "-").replace("–", "-") for c in findings.cells],
            "gap": [c.gap for c in findings.cells],
            "gap_unit": [system.unit(c.channel) for c in findings.cells],
            "share [-]": [c.share for c in findings.cells],
            "share_low [-]": [c.ci95[0] for c in findings.cells],
            "share_high [-]": [c.ci95[1] for c in findings.cells],
            "floor [-]": [c.floor for c in findings.cells],
            "p_value [-]": [c.p_value for c in findings.cells],
        }
    )


def ranking_table(findings: Findings) -> pd.DataFrame:
    """A row per model that was tried, the largest gain first."""
    rows = findings.ranking
    return pd.DataFrame(
        {
            "model": [one.label for one in rows],
            "answer": [one.effects for one in rows],
            "gain [nats]": [one.gain for one in rows],
            "gain_calibration [nats]": [one.calibration for one in rows],
            "probability [-]": [one.probability for one in rows],
        }
    )


def trials_table(findings: Findings) -> pd.DataFrame:
    """A row per trial: how much better it is predicted from all others with what was named."""
    return pd.DataFrame(
        {
            "trial": [one.trial for one in findings.trials],
            "held_out": [one.held_out for one in findings.trials],
            "gain_left_out [nats]": [one.nats for one in findings.trials],
        }
    )


def surface_table(findings: Findings) -> pd.DataFrame:
    """A row per cell of a mat: where it lies in the scan's frame, its part in the load and in the channel's gap."""
    parts = [
        pd.DataFrame(
            {
                "site": one.site,
                "channel": one.channel,
                "id": one.ids,
                **{f"{axis} [m]": one.place[:, k] for k, axis in enumerate("xyz")},
                "load_share [-]": one.load,
                "gap_share [-]": one.gap,
                "holds_most": [name in one.holding for name in one.ids],
            }
        )
        for one in findings.surface
    ]
    return pd.concat(parts, ignore_index=True)


def budget_table(d: Diagnosis) -> pd.DataFrame:
    """A row for each channel and part of its squared error on held-out trials: its share, and the interval of that."""
    rows = [
        (channel, name, part.share, *part.ci95) for channel, parts in d.budget.items() for name, part in parts.items()
    ]
    return pd.DataFrame(rows, columns=["channel", "part", "share [-]", "share_low [-]", "share_high [-]"])


def held_out_table(findings: Findings) -> pd.DataFrame:
    """A row per sample of the held-out trials: measured, base model, and with what was named."""
    system = findings.attribution.problem.system
    parts = []
    for trial in findings.held_out:
        columns: dict[str, object] = {"trial": trial.name, "time [s]": trial.time}
        for c, name in enumerate(system.outputs):
            unit = system.unit(name)
            columns[f"{name} [{unit}]"] = trial.measured[:, c]
            columns[f"{name}_base [{unit}]"] = trial.base[:, c]
            if trial.named is not None:
                columns[f"{name}_with_effects [{unit}]"] = trial.named[:, c]
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
