r"""Which effect a model lacks: `geocontact gap diagnose`, `gc.diagnose`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> Path("case/trials").mkdir(parents=True)
>>> time, noise = 0.04 * np.arange(160), np.random.default_rng(3)
>>> for k in range(1, 6):
...     angle = 0.3 * np.sin((2.0 + 0.4 * k) * time) + 0.08 * np.sin((5.0 + k) * time)
...     torque = 60.0 * angle + 3.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, 160)
...     trial = pd.DataFrame({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
...     trial.to_csv(f"case/trials/t{k}.csv", index=False)
>>> text = 'format = 1\nsystem = "geocontact.systems.elastic_joint:JOINT"\n'
>>> text += 'calibration = ["t1", "t2", "t3"]\nevaluation = ["t4", "t5"]\n[noise]\ntorque = 0.2\n'
>>> text += '[parameters.k]\nstart = 50.0\nlower = 10.0\nupper = 200.0\nunit = "N m/rad"\n'
>>> _ = Path("case/case.toml").write_text(text)
>>> gc.diagnose("case").sentences[0]
'damping is missing; it sits in torque (phase 31–100 %, fast part of angle); on the 2 held-out trials adding it
removes 93 % of the error (2.92 → 0.21 N m, noise floor 0.21); 0 % stays unexplained'
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.frame.collector import as_it_fits, contradicted, judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import PARTS, REPORT, Part, Result
from geocontact.analyses.gap.case import CaseWithModel, odd_gains
from geocontact.analyses.gap.diagnose.answer import diagnosis_tables, untried_law, verdict_sentences
from geocontact.analyses.gap.diagnose.curves import gap_figures, map_figure
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.show import gap_page
from geocontact.analyses.gap.thinning import read_thinned
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.gap_case import GapCase
from geocontact.data.version import VERSION
from geocontact.gap.diagnose import Findings
from geocontact.gap.diagnose import diagnose as findings_of
from geocontact.gap.held_out_fit import goodness_of_diagnosis, without_claims
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.io.text.results import CASES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiagnoseResult(Result):
    """Where a model misses the measurement, which effect it lacks, how far the gap shrinks with it.

    Parameters
    ----------
    case
        What was diagnosed, SI units.
    findings
        Answer, gap map, held-out curves, ranking, and all that they rest on.
    injected
        Which effect was put into the trials, and whether it was found, in sentences; none in trials as they came.
    """

    options: DiagnoseOptions
    case: GapCase
    findings: Findings
    injected: tuple[str, ...] = ()

    @property
    def diagnosis(self) -> Diagnosis:
        """The answer, as in diagnosis.json."""
        return self.findings.diagnosis

    @property
    def title(self) -> str:
        """Name of the case."""
        return self.diagnosis.case

    @property
    def parts(self) -> frozenset[Part]:
        """Tables alone where no more is wanted."""
        return frozenset(("tables",)) if self.options.bare else PARTS

    @property
    def probabilities(self) -> dict[str, float]:
        """Probability of each answer [-]: effects, "none", "unknown"."""
        return dict(self.diagnosis.probabilities)

    @property
    def rmse(self) -> dict[str, tuple[float, float]]:
        """Root mean square error of each channel before and after [SI unit of the channel]."""
        return {name: (each.rmse_before, each.rmse_after) for name, each in self.diagnosis.gap.items()}

    @property
    def reduction(self) -> dict[str, float]:
        """By which share of it the error of each channel in trials held out shrinks [-]."""
        return {name: each.reduction for name, each in self.diagnosis.gap.items()}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`gap_map`, `ranking`, `held_out`; `trials` where something is named, `surface` where a mat has cells."""
        return diagnosis_tables(self.findings)

    def units(self, table: str) -> Mapping[str, str]:
        """SI, as in the case."""
        return CASES

    def figure(self) -> Figure:
        """Where the gap is."""
        return map_figure(self.findings)

    def figures(self) -> dict[str, Figure]:
        """All figures by the name of their files."""
        return gap_figures(self.findings)

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Verdict, curves of held-out trials, figures and tables."""
        return {REPORT: gap_page(self.case, self.findings, drawings, self.injected)}

    def write_files(self, folder: Path) -> None:
        """Also the answer."""
        super().write_files(folder)
        write_json(folder / "diagnosis.json", as_it_fits(self.diagnosis.as_dict()))


def read(o: DiagnoseOptions) -> CaseWithModel:
    """Case and base model."""
    return read_thinned(o.case, o.run_simulator)


def run(given: CaseWithModel, o: DiagnoseOptions) -> DiagnoseResult:
    """Diagnosis, and what is found in words."""
    with listener().stages(o.case.resolve().name) as at:
        found = findings_of(given.case, given.system, VERSION, at)
    gains = gain_doubts(found)
    for line in gains:
        reserve(line)
    judge(GoodnessOfFit(tuple(Doubt(line, False) for line in gains), ("gains of the trials",)), warned=True)
    findings = _held_to(found)
    findings = replace(findings, diagnosis=replace(findings.diagnosis, thinned=given.thinned))
    note(
        "diagnosis",
        {
            "verdict": findings.diagnosis.verdict,
            "effects": list(findings.diagnosis.effects),
            "seconds": round(findings.diagnosis.seconds, 3),
        },
    )
    for sentence in verdict_sentences(findings.diagnosis, findings.cells):
        say(sentence)
    untried = untried_law(findings.diagnosis, given.system)
    if untried is not None:
        reserve(untried)
    return DiagnoseResult(options=o, case=given.case, findings=findings)


def gain_doubts(found: Findings) -> list[str]:
    """Trials of which a channel has another gain than in the others, beside the answer's model, in words."""
    problem, model = found.attribution.clean, found.attribution.answer.chosen.judged.model
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    outputs = [*problem.calibration.outputs, *problem.evaluation.outputs]
    said = []
    for c, channel in enumerate(problem.system.outputs):
        measured = {trial.name: values[:, c] for trial, values in zip(trials, outputs, strict=True)}
        off = {trial.name: values[:, c] for trial, values in zip(trials, model.residuals, strict=True)}
        predicted = {name: values - off[name] for name, values in measured.items()}
        said += odd_gains(channel, measured, predicted, len(problem.system.outputs))
    return said


def _held_to(findings: Findings) -> Findings:
    """The findings beside their own errors on held-out trials: what those contradict is not named."""
    fit = goodness_of_diagnosis(findings.diagnosis)
    judge(fit, warned=not findings.diagnosis.effects)  # an unknown gap says so by itself
    if not contradicted():
        return findings
    first = max((doubt for doubt in fit.doubts if doubt.contradicts), key=lambda doubt: doubt.size)
    curves = tuple(replace(trial, named=None) for trial in findings.held_out)
    return replace(findings, diagnosis=without_claims(findings.diagnosis, first.what), held_out=curves, trials=())


diagnose = Job("gap diagnose", DiagnoseOptions, read, run)
