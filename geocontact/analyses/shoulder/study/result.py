r"""A study of a shoulder exoskeleton: `geocontact shoulder study`, `gc.shoulder.study`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> text = '[tasks.T1]\ntool = { value = 1.3, unit = "kg" }\npush = { value = 35, unit = "N" }\n'
>>> text += '[persons.P1]\nmass = { value = 82, unit = "kg" }\nsex = "male"\ndominant = "right"\n'
>>> text += 'upper_arm = { value = 296, unit = "mm" }\n[[trials]]\nname = "t1"\nperson = "P1"\ntask = "T1"\n'
>>> text += 'markers = "meshes/overhead_P1T1S100/markers.trc"\ntool = "meshes/overhead_P1T1S100/tool.csv"\n'
>>> _ = Path("study.toml").write_text(text + 'level = "100%"\n')
>>> result = gc.shoulder.study("study.toml")
>>> sorted(result.tables())
['differences', 'errors', 'normalised', 'passive', 'summary']
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.analyses.shoulder.simulated_arm import out_of_cuff_clause
from geocontact.analyses.shoulder.study.cases import (
    StudyCase,
    StudyTrialInputs,
    difference_table,
    error_table,
    normalised_table,
    passive_table,
    read,
    study_case,
    summary_table,
)
from geocontact.analyses.shoulder.study.doubts import say_doubts
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study.show import answer, error_bars, facts, normalised_curves, study_curves
from geocontact.shoulder_exoskeleton.device import Device
from geocontact.view.curves.declared import CurveSheet
from geocontact.view.page.content import Page, Words
from geocontact.view.page.tables import frame_table

PASSIVE = (
    "What turns the passive joints is the sphere's push sideways; about the third direction only friction, stops and "
    "joint damping hold them, so their angles depend on numbers that are invented."
)
SAMPLES = 301
"""Samples of each curve on the page."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StudyResult(Result):
    """Every arm in every trial of a study, simulated along both motions."""

    options: StudyOptions
    cases: tuple[StudyCase, ...]
    device: Device

    @property
    def rmsd(self) -> dict[tuple[str, str], float]:
        """Mean root mean square difference by channel and part of the trial: force [N], angles [rad]."""
        return by_name(self.table("summary"), ("channel", "part"), "rmsd")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary` over all arms and trials, `errors` of each, `differences` of both groups, `passive` joints,
        `normalised` curves over the work in per cent.
        """
        return {
            "summary": summary_table(self.cases),
            "errors": error_table(self.cases),
            "differences": difference_table(self.cases),
            "passive": passive_table(self.cases),
            "normalised": normalised_table(self.cases),
        }

    def curves(self) -> dict[str, CurveSheet]:
        """`study`: elevation and supporting force of each arm, recorded, and simulated along both motions;
        `normalised`: both groups over the work in per cent, with the shoulder.
        """
        return {"study": study_curves(self.cases), "normalised": normalised_curves(self.table("normalised"))}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves of each arm and tables."""
        tables, curves = self.tables(), self.curves()
        words = {
            "summary": "Errors over all arms",
            "differences": "Motion recorded in the device less that without it, screw-in",
            "passive": "Passive joints and slip",
            "errors": "Errors by trial and arm",
        }
        page = Page(
            title=f"Study of {counted(len({each.trial.name for each in self.cases}), 'trial')} with {self.device.name}",
            subtitle="Shoulder exoskeleton driven by human motion, compared with its logger and a pressure mat",
            time=np.zeros(1),
            time_label="",
            headline=answer(self.cases, self.sentences),
            facts=facts(tables["summary"]),
            sections=(
                *error_bars(tables["errors"]),
                *(panel.bounded(SAMPLES) for panel in curves["study"].panels),
                *curves["normalised"].panels,
                *(frame_table(title, tables[name], 3) for name, title in words.items() if len(tables[name])),
                INPUTS,
                OPTIONS,
                Words("What the numbers do not contain", [PASSIVE, NOT_A_DEVICE]),
            ),
        )
        return {REPORT: page}


def run(trials: tuple[StudyTrialInputs, ...], o: StudyOptions) -> StudyResult:
    """Trial by trial, arm by arm; each is 0.03 s of work."""
    cases = []
    with listener().progress("trials", len(trials)) as step:
        for each in trials:
            cases += [study_case(each, arm, o) for arm in each.within.arms]
            step()
    device = trials[0].within.device
    invented = sum(number.source == "invented" for number in device.numbers.values())
    reserve(f"{device.name}: {invented} of {len(device.numbers)} numbers are invented")
    result = StudyResult(options=o, cases=tuple(cases), device=device)
    within = [case.within.simulation for case in cases]
    without = [case.without.simulation for case in cases if case.without is not None]
    out, out_of_both = out_of_cuff_clause(*within), out_of_cuff_clause(*within, *without)
    for row in summary_table(result.cases).to_dict("records"):
        if row["part"] in ("all", "work"):
            say(
                f"{row['channel']}, {row['part']}: MAE {row['mae']:.3g}, RMSD {row['rmsd']:.3g} {row['unit']} "
                f"over {counted(row['arms'], 'arm')} in {'its trial' if row['arms'] == 1 else 'their trials'}{out}"
            )
    for row in difference_table(result.cases).to_dict("records"):
        if row["trial"] == "mean":
            say(
                f"screw-in, motion in the device against without it, mean size over the arms: "
                f"exoskeleton {row['exoskeleton [deg]']:.3g} deg, shoulder {row['shoulder [deg]']:.3g} deg, "
                f"force {row['force [N]']:.3g} N; shoulder less exoskeleton "
                f"{row['shoulder less exoskeleton [deg]']:.3g} deg{out_of_both}"
            )
    say_doubts(cases, out_of_both)
    note(
        "study",
        plain({c.name: {ch: {part: vars(a) for part, a in e.items()} for ch, e in c.errors.items()} for c in cases}),
    )
    return result


study = Job("shoulder study", StudyOptions, read, run)
