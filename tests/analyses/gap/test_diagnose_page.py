"""The page and the figures of a gap diagnosis say what diagnosis.json says, and text stays text."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.pages import Drawings, finished
from geocontact.analyses.frame.record import Record
from geocontact.analyses.gap.case import percent
from geocontact.analyses.gap.diagnose.answer import axis_units, facts_of, states, untried_law, verdict_sentences
from geocontact.analyses.gap.diagnose.curves import budget_bars, gap_figures
from geocontact.analyses.gap.diagnose.show import gap_page, gap_table, reading
from geocontact.analyses.gap.nats import ahead_words, odds_words
from geocontact.chain.system import System
from geocontact.data.diagnosis import (
    BudgetPart,
    ChannelGap,
    DataErrorFound,
    Diagnosis,
    Estimate,
    Partial,
    Where,
)
from geocontact.data.diagnosis_evidence import Ranked
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import Cell
from geocontact.gap.budget_verdict import partial
from geocontact.gap.diagnose import Findings, behind
from geocontact.view.curves.sheet import number
from geocontact.view.page.content import Curves, Intervals, Page, Picture, Strips, Table, Words
from geocontact.view.page.write import page_html
from tests.cli.gap_cases import diagnosed_elbow

pytestmark = pytest.mark.slow

Told = tuple[GapCase, Findings]


@pytest.fixture(scope="module")
def told() -> Told:
    """Diagnosis of a damped elbow."""
    result = diagnosed_elbow()
    return result.case, result.findings


def as_left(case: GapCase, findings: Findings, reservation: str) -> Page:
    """The page with its pictures, as the frame leaves it."""
    page = gap_page(case, findings, Drawings(lambda: gap_figures(findings)))
    return finished(page, Record("gap diagnose", {}, {}), "", (reservation,))


@pytest.fixture(scope="module")
def page(told: Told) -> Page:
    """Its page."""
    return as_left(*told, "a reservation")


def table(page: Page, title: str) -> dict[str, tuple[str, ...]]:
    """Rows of a table by their first cell."""
    (found,) = [s for s in page.sections if isinstance(s, Table) and s.title.startswith(title)]
    return {row[0]: tuple(row[1:]) for row in found.rows}


@pytest.mark.slow
def test_the_answer_stands_at_the_top(told: Told, page: Page) -> None:
    d = told[1].diagnosis
    said = dict(page.facts)
    assert page.title == "elbow_7" and "synthetic data" in page.subtitle
    assert page.subtitle.endswith("base model elbow: 2 trials fitted to, 2 held out")
    assert said["What is missing"] == "damping"
    assert said["Where"].startswith("force (phase ")
    gap = d.gap["force"]
    sizes = (gap.rmse_before, gap.rmse_after, gap.noise_floor)
    before, after, floor = (number(size, gap.rmse_before) for size in sizes)
    part = percent(1.0 - gap.rmse_after / gap.rmse_before)
    words = f"({before} → {after} N, noise floor {floor})"
    assert said["Adding it removes"] == f"{part} % of the error of force {words} on the 2 held-out trials"
    interval = f"{percent(gap.ci95[0])} to {percent(gap.ci95[1])} %"
    assert said["On a new trial"].startswith(f"{percent(gap.reduction)} % expected, 95 % interval {interval}")
    assert page.headline[1].startswith(f"On a new trial: {percent(gap.reduction)} % expected")
    assert f"damping {d.probabilities['damping']:.2f}" in said["Probability p of each answer"]


def kinds(page: Page) -> list[str]:
    """Titles of what is drawn, in the order of the page."""
    return [s.title for s in page.sections if isinstance(s, Curves | Intervals | Strips | Picture)]


def test_the_budget_leads_and_measured_and_simulated_follow(page: Page) -> None:
    """On the first screen; where, how far and how sure after that, then what else there is of the trials."""
    assert page.leads == range(1) and kinds(page) == [
        "What the error consists of",
        "force, held-out trial t03",
        "How far the error shrinks on held-out trials",
        "How sure that is",
        "Where the gap of force is",
        "force, held-out trial t03: measured − predicted",
        "force, held-out trial t04",
        "force, held-out trial t04: measured − predicted",
    ]
    html = page_html(page)
    lead, verdict = html.index('id="section-0"'), html.index("<bdi>Verdict</bdi>")
    assert html.index("force, held-out trial t03") < verdict and lead < html.index("How sure that is") < verdict


def test_the_budget_opens_the_page_in_words_and_as_a_picture(told: Told, page: Page) -> None:
    """Sizes in words are roots of shares of the squared error; it is the only picture of an elbow."""
    (picture,) = [s for s in page.sections if isinstance(s, Picture)]
    assert picture.title == "What the error consists of" and picture.svg.startswith(b"<?xml")
    d = told[1].diagnosis
    parts, before = d.budget["force"], d.gap["force"].rmse_before
    size = number(before * parts["effects"].share ** 0.5)
    for words in (page.headline[-1], picture.words):
        assert f"of {number(before)} N, " in words and f"{size} N what is named" in words
    assert d.gap["force"].noise_floor <= before * sum(parts[p].share for p in ("sensor", "inputs", "variation")) ** 0.5


def test_bars_of_the_budget_are_its_shares(told: Told) -> None:
    """Before all of them, after those that stay."""
    before, after = budget_bars(told[1])
    shares = {name: part.share for name, part in told[1].diagnosis.budget["force"].items()}
    assert before.parts == shares and before.label == "force, base model" and after.label == "force, with damping"
    assert sum(after.parts.values()) == pytest.approx(1.0 - shares["effects"])
    axes = gap_figures(told[1])["budget"].axes[0]
    drawn = {round(bar.get_y() + 0.35): 0.0 for bar in axes.patches}
    for bar in axes.patches:
        drawn[round(bar.get_y() + 0.35)] += bar.get_width()
    assert drawn[0] == pytest.approx(100.0 * sum(max(s, 0.0) for s in shares.values()))
    assert drawn[1] < drawn[0]


def test_the_map_holds_every_cell_with_its_sign(told: Told, page: Page) -> None:
    (strips,) = [s for s in page.sections if isinstance(s, Strips)]
    cells = told[1].cells
    strips = replace(strips, blocks=[block for block in strips.blocks if not block.name.startswith("regions")])
    assert sum(block.values.size for block in strips.blocks) == len(cells)
    phases = ["phase of the trial [%]", "phase, faster than 5 Hz [%]"]
    assert [block.name for block in strips.blocks if block.wide] == phases
    others = {block.name for block in strips.blocks if not block.wide}
    assert others == {"beta [°]", "rate of beta [°/s]", "load [N]", "frequency [Hz]"}
    along = {"beta [°]": "beta", "rate of beta [°/s]": "beta'"}
    for block in strips.blocks:
        if block.name not in along:
            continue
        own = sorted((c for c in cells if c.axis == along[block.name]), key=lambda c: c.low)
        np.testing.assert_allclose(block.values[0], [min(max(2.0 * c.share, 0.0), 1.0) for c in own], atol=1e-12)
        signs = [("+" if c.gap > 0.0 else "−") if c.p_value <= 0.05 else "" for c in own]
        assert list(block.marks[0]) == signs and any(signs) == (block.name == "rate of beta [°/s]")
        assert float(block.edges[0].replace("−", "-")) == pytest.approx(np.degrees(own[0].low), rel=5e-3)


def test_bars_of_errors_have_the_interval_of_new_trials(told: Told, page: Page) -> None:
    gap = told[1].diagnosis.gap["force"]
    bars = next(s for s in page.sections if isinstance(s, Intervals))
    base, named, floor = bars.intervals
    assert [base.kind, named.kind, floor.kind] == ["base model", "with damping", "noise floor"]
    assert base.value == 100.0 and named.value == pytest.approx(100.0 * gap.rmse_after / gap.rmse_before)
    assert (named.lower, named.upper) == pytest.approx((100.0 * (1.0 - gap.ci95[1]), 100.0 * (1.0 - gap.ci95[0])))
    assert named.name == f"force: {number(gap.rmse_after)} N"


def test_evidence_is_said_as_odds(told: Told, page: Page) -> None:
    bars = next(s for s in page.sections if isinstance(s, Intervals) and s.title == "How sure that is")
    assert [row.value for row in bars.intervals] == [one.gain for one in told[1].ranking[:12]]
    assert "with 20 nats e²⁰ = 500 million times" in bars.words
    own, *_ = (one for one in told[1].ranking if one.effects == "damping")
    other, *_ = (one for one in told[1].ranking if "damping" not in one.effects.split(" + "))
    by = f"damping is {own.gain - other.gain:.1f} nats ahead of {other.label}, the best model without it: the data are "
    assert by in bars.words


@pytest.mark.parametrize(
    ("nats", "words"),
    [(0.0, "1 times"), (1.0, "2.7 times"), (3.0, "20 times"), (6.0, "400 times"), (20.0, "5 × 10⁸ times")],
)
def test_nats_in_words(nats: float, words: str) -> None:
    """e, e³ = 20.1, e⁶ = 403, e²⁰ = 4.85e8."""
    assert odds_words(nats) == words


def test_little_ahead_decides_nothing() -> None:
    """Pairs that hold what is named do not speak against it."""
    pair = Ranked("damping + drift", "damping + drift", 20.1, 9.0, None)
    rows = [pair, Ranked("damping", "damping", 20.0, 9.0, 0.6), Ranked("damping.other", "damping", 19.9, 9.0, None)]

    def words(gain: float, *named: str) -> str:
        return ahead_words([*rows, Ranked("slip", "slip", gain, 9.0, 0.4)], named)

    assert words(19.0, "damping") == (
        "damping is 1.0 nats ahead of slip, the best model without it: the data are 2.7 times as probable with it. A "
        "difference of less than 3 nats decides nothing."
    )
    assert words(10.0, "damping").endswith("the data are 20000 times as probable with it.")
    assert words(22.5, "damping") == "damping is 2.5 nats behind slip, which a rule keeps from being named."
    assert words(19.0) == words(19.0, "nobody") == ahead_words([], ["damping"]) == ""


def test_an_interval_below_zero_is_explained_where_there_is_one(told: Told) -> None:
    d = told[1].diagnosis
    low = {"force": replace(d.gap["force"], reduction=0.26, ci95=(-0.03, 0.45))}
    doubtful = replace(d, gap=low, probabilities={"damping": 0.95, "none": 0.05})
    first, second, *_ = reading(doubtful)
    assert first.startswith("p is the probability of an answer, from 0 to 1")
    assert second.startswith("The 95 % interval −3 to 45 % reaches below 0 beside p = 0.95. These are two questions.")
    assert second.endswith("the error of force may shrink by up to 45 %, or grow by up to 3 %.")
    for ci95 in ((0.8, 0.9), (-0.03, 0.95)):
        other = replace(d, gap={"force": replace(d.gap["force"], reduction=0.86, ci95=ci95)})
        assert not any("reaches below 0" in line for line in reading(other))
        (row,) = gap_table(replace(told[1], diagnosis=other)).rows
        assert ("too wide" in row) == (ci95[0] < 0.0) == ("86 %" not in row)


def test_errors_are_drawn_before_and_after_with_their_interval(told: Told) -> None:
    d = told[1].diagnosis
    axes = gap_figures(told[1])["reductions"].axes[0]
    gap = d.gap["force"]
    before, after = (bar.get_width() for bar in axes.patches)
    assert before == pytest.approx(100.0) and after == pytest.approx(100.0 * gap.rmse_after / gap.rmse_before)
    whisker, *_ = (line for line in axes.lines if line.get_marker() == "|")
    ends = [100.0 * (1.0 - gap.ci95[1]), 100.0 * (1.0 - gap.ci95[0])]
    assert whisker.get_xdata() == pytest.approx(ends)
    assert [text.get_text() for text in axes.texts] == [f"{number(e)} N" for e in (gap.rmse_before, gap.rmse_after)]


def test_curves_are_measured_base_and_with_the_effect_of_each_held_out_trial(told: Told, page: Page) -> None:
    panels = {s.title: s for s in page.sections if isinstance(s, Curves)}
    d = told[1].diagnosis
    for trial in told[1].held_out:
        panel, off = (panels[f"force, held-out trial {trial.name}{w}"] for w in ("", ": measured − predicted"))
        assert [c.name for c in off.curves] == ["base model", "with damping", "noise alone, 95 %"]
        for residual, curve in zip(off.curves, panel.curves[1:], strict=False):
            np.testing.assert_allclose(residual.values, panel.curves[0].values - curve.values, atol=1e-9)
            assert residual.stroke == curve.stroke, "one colour for one thing"
        noise = off.curves[2]
        assert noise.lower is not None and noise.upper is not None
        np.testing.assert_allclose(noise.upper, 1.959964 * d.gap["force"].noise_floor)
        np.testing.assert_allclose(noise.lower, -noise.upper)
        assert [(s.start, s.end) for s in off.spans] == [tuple(100.0 * edge for edge in d.where[0].phase)]
        assert [c.name for c in panel.curves] == ["measured", "base model", "with damping"]
        assert trial.named is not None
        for curve, values in zip(panel.curves, (trial.measured, trial.base, trial.named), strict=True):
            expected = np.interp(page.time / 100.0, trial.phase, values[:, 0])
            np.testing.assert_allclose(curve.values, expected)


def test_figures_of_curves_are_those_of_the_page(told: Told, page: Page) -> None:
    """Drawn from the same declaration."""
    panels = {s.title: s for s in page.sections if isinstance(s, Curves)}
    figures = gap_figures(told[1])
    assert {"before_after_force", "gap_residuals"} < set(figures)
    for axes, trial in zip(figures["before_after_force"].axes, told[1].held_out, strict=True):
        drawn = [line.get_ydata() for line in axes.lines if len(np.atleast_1d(line.get_ydata())) > 2]
        for values, curve in zip(drawn, panels[f"force, held-out trial {trial.name}"].curves, strict=True):
            assert np.nanmax(values) == pytest.approx(np.nanmax(curve.values), abs=1e-9)


def test_tables_hold_the_numbers_of_the_answer(told: Told, page: Page) -> None:
    d = told[1].diagnosis
    row = table(page, "How far")["force"]
    gap = d.gap["force"]
    assert float(row[1]) == pytest.approx(gap.rmse_before, rel=5e-3)
    assert float(row[2]) == pytest.approx(gap.rmse_after, rel=5e-3)
    assert row[4] == f"{percent(gap.reduction)} %"
    assert set(table(page, "Parameters")) == set(d.parameters)
    models = table(page, "Ranking")
    assert float(models["damping"][3]) == pytest.approx(d.probabilities["damping"], abs=1e-3)
    assert models["none"][1] == "0.0"


def test_the_ranking_gives_each_single_answer_its_probability_once(told: Told) -> None:
    d = told[1].diagnosis
    rows = told[1].ranking
    assert [row.gain for row in rows] == sorted((row.gain for row in rows), reverse=True)
    told_ones = {row.effects: row.probability for row in rows if row.probability is not None}
    assert len(told_ones) == sum(row.probability is not None for row in rows)
    assert told_ones["none"] == d.probabilities["none"] and told_ones["unknown"] == d.probabilities["unknown"]
    assert all(row.probability is None for row in rows if "+" in row.effects)


def test_nothing_is_fetched(page: Page) -> None:
    html = page_html(page)
    assert "default-src &#39;none&#39;" in html
    assert not re.search(r'(?:src|href)\s*=\s*"(?!data:)', html.split("<script", 1)[0])
    assert not re.search(r"(?:src|href)=[\"']https?:", html)


HOSTILE = '<script>alert("1")</script>'


def test_hostile_names_stay_text(told: Told) -> None:
    case, findings = told
    d = findings.diagnosis
    spoilt = replace(
        d,
        case=HOSTILE,
        parameters={HOSTILE: Estimate(1.0, (0.5, 2.0), HOSTILE, False)},
        remarks=(HOSTILE,),
        faults=(DataErrorFound("unit_error", HOSTILE, 2.0, (HOSTILE,)),),
    )
    shown = tuple(replace(trial, name=HOSTILE) for trial in findings.held_out)
    there = replace(findings, diagnosis=spoilt, held_out=shown)
    html = page_html(as_left(case, there, HOSTILE))
    assert "<script>alert" not in html and "&lt;script&gt;alert" in html


def test_words_name_reservations_and_what_is_invisible(told: Told, page: Page) -> None:
    words = {s.title: " ".join(s.paragraphs) for s in page.sections if isinstance(s, Words)}
    assert page.reservations == ("a reservation",)
    assert "not a clinical device" in words["What the numbers do not contain"]
    for name in told[1].diagnosis.absorbed:
        assert name in words["What is not separable"]


def test_axes_have_units(told: Told) -> None:
    assert axis_units(told[1]) == {
        "phase": "–",
        "fast phase": "–",
        "band": "Hz",
        "load": "N",
        "beta": "rad",
        "beta'": "rad/s",
    }


def test_what_an_effect_explains_is_told_unless_a_rule_speaks_against_it(told: Told) -> None:
    """Were this gap called unknown: the part that is stated of the effect that is named."""
    found, gap = told[1].attribution, told[1].diagnosis.gap["force"]
    best = partial(found)
    assert best is not None and best[0].names == ("damping",)
    part = best[1]
    assert part.effects == ("damping",) and part.gain_nats > 100.0
    assert part.removed["force"] == (pytest.approx(gap.reduction), pytest.approx(gap.ci95))
    assert part.as_dict()["removed"]["force"]["reduction"] == pytest.approx(gap.reduction)
    other = partial(replace(found, objections={one.label: "why" for one in found.contenders if "damping" in one.names}))
    assert other is not None
    second = other[1]
    assert "damping" not in second.effects and second.gain_nats < part.gain_nats
    assert partial(replace(found, objections={one.label: "why" for one in found.contenders})) is None
    assert partial(replace(found, contenders=())) is None


def test_a_mistake_in_the_data_is_no_part_of_a_gap_nor_is_what_takes_little(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = told[1].attribution
    damped = next(one for one in found.contenders if one.names == ("damping",))
    alone = replace(found, contenders=(damped,))
    assert partial(alone) is not None
    (candidate,) = damped.candidates
    wrong = replace(damped, candidates=(replace(candidate, somewhere=lambda trials: candidate.link),))
    assert partial(replace(found, contenders=(wrong,))) is None
    shrunk = {"force": SimpleNamespace(reduction=0.05, low=-0.6, high=0.6)}
    monkeypatch.setattr("geocontact.gap.budget_verdict.error_reduction", lambda *_: shrunk)
    assert partial(alone) is None


def test_rivals_are_behind_by_the_difference_of_their_evidence(told: Told) -> None:
    found = told[1].attribution
    both = replace(found, answer=replace(found.answer, ambiguity=("damping", "dry_friction", "nobody")))
    gains = {row.label: row.gain for row in told[1].ranking}
    best = max(gain for label, gain in gains.items() if label.startswith("dry_friction.") and "+" not in label)
    assert behind(both) == {"dry_friction": pytest.approx(gains["damping"] - best)}


# Words of each verdict, on answers made by hand.

GAP = {"force": ChannelGap(2.1, 0.31, 0.22, 0.84, (0.80, 0.89), 0.03, "N", 2)}
WHERE = (Where("force", (0.42, 0.61), 1.0, 0.001, "constitutive"),)


def said(**changes: object) -> list[str]:
    """Sentences of an answer."""
    plain = Diagnosis(
        "case", "elbow", "explained", ("damping",), {"damping": 1.0}, ("damping",), (), WHERE, GAP, {}, 1.0, "0"
    )
    return verdict_sentences(replace(plain, **changes), rates((0.45, 0.04, 0.01, 0.01, 0.04, 0.45)))


def test_effects_that_no_law_could_have_are_said_to_be_untried() -> None:
    unknown = Diagnosis("case", "rod", "unknown", (), {"unknown": 1.0}, (), (), WHERE, GAP, {}, 1.0, "0")

    def rod(**law: str) -> System:
        return gc.simulator_base("rod", {"q": "m"}, {"force": "N"}, print, **law).build((), {}, {})

    told = untried_law(unknown, rod())
    assert told is not None and "damping" in told and "rod has no law" in told and "`acts_on`" in told
    assert untried_law(unknown, rod(acts_on="q")) is None
    assert untried_law(replace(unknown, verdict="no_gap"), rod()) is None


def rates(shares: tuple[float, ...], p_value: float = 0.001, axis: str = "beta'") -> tuple[Cell, ...]:
    """Cells along the rate of beta."""
    ends = [(k - 3.0, k - 2.0, 1.0, share, p_value, (0.0, 1.0), 0.1) for k, share in enumerate(shares)]
    return tuple(Cell("force", axis, *each) for each in ends)


def test_the_sentence_of_the_issue() -> None:
    first, second = said()
    assert first == (
        "damping is missing; it sits in force (phase 42–61 %, fast part of beta); on the 2 held-out trials adding it "
        "removes 85 % of the error (2.10 → 0.31 N, noise floor 0.22); 3 % stays unexplained"
    )
    assert second == "on a new trial: 84 % expected, 95 % interval 80 to 89 %"


def test_a_wide_interval_of_few_trials_says_to_record_more() -> None:
    """The numbers of the held-out trials and of a new one stand side by side, however far they are apart."""

    def of(trials: int, low: float) -> list[str]:
        return said(gap={"force": ChannelGap(3.85, 0.2, 0.2, 0.86, (low, 0.95), 0.02, "N m", trials)})[:2]

    first, second = of(2, 0.37)
    assert "on the 2 held-out trials adding it removes 95 % of the error (3.85 → 0.20 N m, noise floor 0.20)" in first
    assert second == (
        "on a new trial: 86 % expected, 95 % interval 37 to 95 %; the interval is wide because there are 2 held-out "
        "trials: record more"
    )
    assert of(1, 0.37)[1].endswith("because there is 1 held-out trial: record more")
    assert of(5, 0.37)[1].endswith("37 to 95 %") and of(2, 0.8)[1].endswith("80 to 95 %")
    shows = "not show how far the error shrinks: record more"
    assert of(2, -0.03)[1] == f"on a new trial: 2 held-out trials do {shows}"
    assert of(1, -0.03)[1] == f"on a new trial: 1 held-out trial does {shows}"


def test_what_is_not_ruled_out_is_said_with_how_far_it_is_behind() -> None:
    _, _, second, third = said(ambiguity=("damping", "filter_lag", "relaxation"))
    assert (second, third) == ("filter_lag is not ruled out", "relaxation is not ruled out")
    rivals = {"ambiguity": ("damping", "filter_lag"), "behind": {"filter_lag": 1.24}, "apart": {"filter_lag": 9.71}}
    _, _, second = said(**rivals)
    assert second == "filter_lag is not ruled out: 1.2 nats behind, the two differ by 9.7 nats on these trials"


def test_a_class_is_the_answer_where_effects_are_one_law() -> None:
    alike = {
        "ambiguity": ("damping", "filter_lag", "slip"),
        "probabilities": {"damping": 0.6, "filter_lag": 0.3, "slip": 0.1},
        "one_law": (("damping", "filter_lag"),),
        "apart": {"filter_lag": 1.26, "slip": 8.0},
    }
    first, _, second, third = said(**alike)
    assert first.startswith("damping or filter_lag (one law on these trials) is missing; it sits in force (")
    close = "they predict what damping does to within 1.3 nats, together p = 0.90"
    assert second == f"these trials cannot distinguish damping from filter_lag: {close}"
    assert third == "slip is not ruled out: the two differ by 8.0 nats on these trials"
    both = said(**alike | {"effects": ("damping", "preload")})[0]
    assert both.startswith("damping or filter_lag (one law on these trials), and preload are missing")
    many = said(**alike | {"effects": (), "verdict": "unresolved"})
    assert many[1] == second and "separate damping, filter_lag and slip" in many[0]


def test_what_is_not_ruled_out_stands_apart_from_what_cannot_be_told(told: Told) -> None:
    """At the top of the page, for each verdict."""

    def facts(**changes: object) -> dict[str, str]:
        findings = told[1]
        return dict(facts_of(replace(findings, diagnosis=replace(findings.diagnosis, **changes))))

    alike = {"one_law": (("damping", "filter_lag"),), "apart": {"filter_lag": 0.4, "slip": 8.0}}
    rivals = {"effects": ("damping",), "ambiguity": ("damping", "filter_lag", "slip"), "behind": {"slip": 3.0}}
    found = facts(verdict="explained", **alike, **rivals)
    assert found["One law on these trials"] == "damping or filter_lag"
    why = "slip is not ruled out: 3.0 nats behind, the two differ by 8.0 nats on these trials"
    assert found["Not ruled out"] == why
    nothing = facts(verdict="no_gap", effects=(), ambiguity=("slip",), one_law=(), apart={})
    assert nothing["Not ruled out"] == "slip" and "One law on these trials" not in nothing
    many = facts(verdict="unresolved", effects=(), ambiguity=("damping", "filter_lag", "slip"), **alike)
    assert many["Not separable"] == "damping, filter_lag and slip" and "Not ruled out" not in many
    assert many["One law on these trials"] == "damping or filter_lag"


def test_two_effects_are_missing_together() -> None:
    first = said(effects=("damping", "preload"), ambiguity=("damping", "preload"))[0]
    assert first.startswith("damping and preload are missing; they sit in force (")
    assert "adding them removes 85 %" in first


@pytest.mark.parametrize(
    ("verdict", "ambiguity", "words"),
    [
        ("no_gap", (), ["nothing is missing beyond noise and trial-to-trial variation"]),
        (
            "unknown",
            ("slip",),
            [
                "there is a gap in force (phase 42–61 %, fast part of beta) and none of the known effects explains it",
                "slip is not ruled out",
            ],
        ),
        (
            "unresolved",
            ("a", "b", "c", "d"),
            ["there is a gap in force (phase 42–61 %, fast part of beta); these data cannot separate a, b, c and d"],
        ),
    ],
)
def test_other_verdicts(verdict: str, ambiguity: tuple[str, ...], words: list[str]) -> None:
    assert said(verdict=verdict, effects=(), ambiguity=ambiguity) == words


def test_no_gap_says_how_much_its_budget_leaves_open() -> None:
    """30 % that are no stated noise may be noise; 9 % are below what is worth a name."""
    parts = {share: {"force": {"unexplained": BudgetPart(share, (0.0, 0.5))}} for share in (0.3, 0.09)}
    nothing = "nothing is missing beyond noise and trial-to-trial variation"
    much, little = (said(verdict="no_gap", effects=(), budget=parts[share]) for share in (0.3, 0.09))
    assert much[:1] == little[:1] == [nothing] and len(much) == len(little) + 1
    assert much[1] == (
        "the budget leaves 30 % of the squared error of force open: that less than 10 % is missing is not sure"
    )


def test_what_is_explained_in_part_is_said() -> None:
    """Channels whose error shrinks, the most first."""
    removed = {"force": (0.7, (0.62, 0.78)), "exo": (-0.1, (-0.3, 0.1)), "cop_x": (0.8, (0.7, 0.9))}
    first, *_ = said(verdict="unknown", effects=(), partial=Partial(("dry_friction",), 80.0, removed))
    assert first == (
        "there is a gap in force (phase 42–61 %, fast part of beta); dry_friction explains 80 % (95 % interval "
        "70 to 90 %) of the error of cop_x, 70 % (95 % interval 62 to 78 %) of that of force on trials not used, and "
        "something else remains that no known effect explains"
    )


def test_a_mistake_in_the_data_is_not_called_missing() -> None:
    fault = DataErrorFound("sign_flip", "force", 1.0, ("t03",))
    alone, both = (said(effects=names, faults=(fault,))[0] for names in (("sign_flip",), ("damping", "sign_flip")))
    assert alone.startswith("sign_flip is a mistake in the data; it sits in force (") and "undoing it removes" in alone
    assert both.startswith("damping is missing; sign_flip is a mistake in the data; they sit in force (")
    assert "adding and undoing them removes 85 %" in both


def test_invisible_effects_faults_and_oddities_are_said() -> None:
    fault = DataErrorFound("unit_error", "force", 1e-3, ("t01", "t03"))
    found = said(absorbed=("preload", "slip"), faults=(fault,), remarks=("a line at 8 Hz in force",))
    found = [found[0], *found[2:]]
    assert found[1] == "base parameters would imitate preload or slip: these trials cannot show it either way"
    assert found[2] == (
        "mistake in the data: unit_error of force (reads 0.001 times what it should) in t01 and t03, taken as undone "
        "in all that follows"
    )
    assert found[3:] == ["remark: a line at 8 Hz in force"]


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (rates((0.4, 0.1, 0.0, 0.0, 0.1, 0.4)), ["fast part of beta"]),
        (rates((0.0, 0.0, 0.5, 0.5, 0.0, 0.0)), ["slow part of beta"]),
        (rates((1 / 6,) * 6), []),
        (rates((0.4, 0.1, 0.0, 0.0, 0.1, 0.4), p_value=0.2), []),
        (rates((0.0, 0.0, 0.0, 0.0, 0.2, 0.8), axis="beta"), ["high part of beta"]),
        (rates((0.9, 0.1, 0.0, 0.0, 0.0, 0.0), axis="load"), ["low part of load"]),
    ],
)
def test_states_are_named_where_they_hold_most_of_the_gap(cells: tuple[Cell, ...], expected: list[str]) -> None:
    assert states("force", cells) == expected
