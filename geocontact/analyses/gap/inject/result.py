r"""Would an effect be found? `geocontact gap inject`, `gc.inject`.

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
>>> gc.inject("case", effect="damping", size=1.0).sentences[0]
'injected damping (damping.b = 0.9232 N m s/rad, damping.exponent = 1); it makes a gap of 1 times the noise
floor'
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.frame.collector import collecting, current, judge, listener, note, reserve, say
from geocontact.analyses.frame.folder import Scratch
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.result import Part, Result
from geocontact.analyses.gap.case import CaseWithModel, read_case
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from geocontact.analyses.gap.diagnose.result import read as read_diagnosis
from geocontact.analyses.gap.diagnose.result import run as run_diagnosis
from geocontact.analyses.gap.inject.injection import answer, parameter_rows, planted, sentences
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.gap.thinning import thinned_and_said
from geocontact.chain.effect import Candidate
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.errors import InputError
from geocontact.gap.diagnose import diagnose
from geocontact.gap.inject import Injected, Judgement, judged
from geocontact.io.cases.gap_case_writer import write_trials
from geocontact.systems.catalogue import system_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CASE, DIAGNOSIS = "case", "diagnosis"
COLUMNS = ["parameter", "unit", "planted", "found", "low", "high"]
LEAST = 0.5  # of the size that was asked for, from which a bound of the amplitude deserves a word


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class InjectResult(Result):
    """A known effect in measured trials, and what the diagnosis makes of them.

    Parameters
    ----------
    effect
        What was put in.
    planted
        The case that has it, values of its parameters (SI), and the gap that it makes.
    diagnosed
        The diagnosis of that case.
    judgement
        Whether the effect was found, against the diagnosis of the case without it.
    scratch
        Where the case lies until it is written.
    """

    options: InjectOptions
    effect: Candidate
    planted: Injected
    diagnosed: DiagnoseResult
    judgement: Judgement
    scratch: Scratch

    @property
    def diagnosis(self) -> Diagnosis:
        """The answer, as in diagnosis/diagnosis.json."""
        return self.diagnosed.diagnosis

    @property
    def title(self) -> str:
        """Which effect was put into which case."""
        return f"{self.effect.label} in {self.diagnosis.case}"

    @property
    def parts(self) -> frozenset[Part]:
        """None: the diagnosis writes its own, planted.json has the effect's parameters."""
        return frozenset()

    @property
    def amplitudes(self) -> dict[str, float]:
        """Parameters of the effect as they were injected [SI unit of each]."""
        return dict(self.planted.values)

    @property
    def size(self) -> float:
        """Gap that the effect makes, in multiples of the noise floor [-]."""
        return self.planted.size

    @property
    def evidence(self) -> float:
        """Most evidence for it that all trials can hold [nats]."""
        return self.planted.nats

    @property
    def probabilities(self) -> dict[str, float]:
        """Probability of each answer of the diagnosis [-]."""
        return dict(self.diagnosis.probabilities)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`planted`: parameters of the effect as they were put in and found; `diagnosis/ranking` and so on."""
        rows = parameter_rows(self.effect, self.planted, self.diagnosis)
        found = {f"{DIAGNOSIS}/{name}": table for name, table in self.diagnosed.tables().items()}
        return {"planted": pd.DataFrame(rows, columns=COLUMNS), **found}

    def figures(self) -> dict[str, Figure]:
        """Those of the diagnosis: `diagnosis/gap_map` and so on."""
        return {f"{DIAGNOSIS}/{name}": figure for name, figure in self.diagnosed.figures().items()}

    def figure(self) -> Figure:
        """Where the gap is."""
        return self.diagnosed.figure()

    def write_files(self, folder: Path) -> None:
        """The case, its diagnosis with a record of its own, and what was put in."""
        shutil.copytree(self.scratch.folder / CASE, folder / CASE)
        (folder / DIAGNOSIS).mkdir()
        self.diagnosed.record.without = self.record.without
        self.diagnosed.put(folder / DIAGNOSIS)
        write_json(folder / "planted.json", answer(self.effect, self.planted, self.diagnosis, self.judgement))

    def write_page(self, file: Path, largest: int | None = None) -> None:
        """That of the diagnosis."""
        self.diagnosed.write_page(file, largest)


def read(o: InjectOptions) -> CaseWithModel:
    """Case and base model; results do not go into the folder that is copied."""
    out = current().options.get("out")
    if isinstance(out, Path) and o.case.resolve() in (out.resolve(), *out.resolve().parents):
        raise InputError(out, "", "lies inside the case that is copied there", "`out` names a folder outside the case")
    return read_case(o.case, o.run_simulator)


def run(given: CaseWithModel, o: InjectOptions) -> InjectResult:
    """The case with the effect in it, and its diagnosis as from a folder, to the digits printed there.

    The case without it is diagnosed first: what it lacks anyway is not found because of what was injected.
    """
    one, made = planted(given, o)
    with listener().stages("the case without it") as at:
        used, _ = thinned_and_said(given.case, given.system)
        before = diagnose(used, system_of(used), at=at).diagnosis
    scratch = Scratch()
    shutil.copytree(given.folder, scratch.folder / CASE)
    write_trials(made.case, scratch.folder / CASE)
    if given.case.cells:
        reserve("cells of mats are left as they were: they do not show the effect")
    found = _diagnosed(scratch.folder / CASE, o)
    if found.record.fit is not None:
        judge(found.record.fit, warned=True)
    judgement = judged(one, made, before, found.diagnosis)
    said = tuple(sentences(one, made, found.diagnosis, judgement))
    found = replace(found, injected=said)
    result = InjectResult(options=o, effect=one, planted=made, diagnosed=found, judgement=judgement, scratch=scratch)
    note("planted", answer(one, made, found.diagnosis, judgement))
    for sentence in said:
        say(sentence)
    if made.size < LEAST * o.size and not (one.parameters and one.parameters[0].name in o.value):
        reserve("the amplitude is as large as its bounds admit; base parameters imitate the rest")
    say(found.sentences[0])
    return result


def _diagnosed(home: Path, o: InjectOptions) -> DiagnoseResult:
    """Diagnosis with a record of its own, which names files as they will lie beside it."""
    out = Path(str(current().options.get("out", "")))
    options = DiagnoseOptions(home, bare=o.bare, run_simulator=o.run_simulator)
    typed = {"case": out / CASE, "out": out / DIAGNOSIS, "bare": o.bare}
    own = Record("gap diagnose", typed, options.in_si() | {"case": out / CASE}, listener=listener())
    with collecting(own):
        found = run_diagnosis(read_diagnosis(options), options)
    for entry in own.inputs:
        entry["file"] = str(entry["file"]).replace(str(home), str(out / CASE), 1)
    return found


inject = Job("gap plant", InjectOptions, read, run)
