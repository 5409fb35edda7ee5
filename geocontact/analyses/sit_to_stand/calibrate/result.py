"""Contacts from trials of standing up: `geocontact sit-to-stand calibrate`, `gc.sit_to_stand.calibrate`.

>>> import geocontact as gc
>>> result = gc.sit_to_stand.calibrate("meshes/standing_up/study.toml", nodes=10, resamples=0)
>>> print(result.sentences[0])
3 trials: ground reaction within … N, centre of pressure within … mm, angles within …° (largest RMSD of a trial)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.phases import (
    certificate_table,
    correlation_table,
    doubt_phase,
    parameters_table,
    phases_sought,
    profile_table,
    say_selection,
    selection_table,
)
from geocontact.analyses.sit_to_stand.calibrate.show import calibration_page
from geocontact.analyses.sit_to_stand.exports import write_motion, write_standing_model, write_strap_case
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_sites
from geocontact.analyses.sit_to_stand.rmsd_by_trial import rmsd_by_trial
from geocontact.analyses.sit_to_stand.show import PARTS, standing_curves
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.analyses.sit_to_stand.study_figures import (
    GROUND,
    KINEMATICS,
    MOMENTS,
    STRAPS,
    contact_laws,
    study_figure,
)
from geocontact.analyses.sit_to_stand.trial_tables import (
    errors_table,
    goodness_of_trials,
    mesh_table,
    ran_table,
    trial_table,
)
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.standing_up.calibrated_phase import CalibratedPhase
from geocontact.standing_up.calibration import calibrated_trials, calibration_numbers
from geocontact.standing_up.stance import SIZES
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingUpTrials
from geocontact.view.curves.declared import CurveSheet

if TYPE_CHECKING:
    from geocontact.view.page.content import Page


PUT_IN = ("force", "centre")
"""Channels of a stance that the load of the rest of the body returns (`stance.load_of_the_rest`)."""


def read(o: StandingCalibrateOptions) -> StandingUpTrials:
    """Everything in the study."""
    trials = standing_trials(o.study, "study", o.c3d_unit, o.axes, o.device)
    if trials.exoskeleton:
        doubt_sites(trials)
    return trials


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCalibrateResult(Result):
    """Parameters of the contacts, and the motions of all trials with them.

    Parameters
    ----------
    phases
        A, and B where an exoskeleton was worn.
    trials
        Channels by the last of them.
    """

    claims: ClassVar[frozenset[str]] = frozenset({"sd with the trials"})

    options: StandingCalibrateOptions
    given: StandingUpTrials
    phases: tuple[CalibratedPhase, ...]
    trials: tuple[TrialResult, ...]

    @property
    def found(self) -> CollocationResult:
        """How the last search ended."""
        return self.phases[-1].found

    @property
    def accepted(self) -> bool:
        """Whether all phases were solved and every motion is certified."""
        wanted = 2 if self.given.exoskeleton else 1
        return len(self.phases) == wanted and all(phase.certified for phase in self.phases)

    @property
    def errors(self) -> pd.DataFrame:
        """Root mean square difference of each channel of each trial."""
        return errors_table(self.trials, self.given.noise, self.given.tracks)

    @property
    def parameters(self) -> dict[tuple[str, str], float]:
        """Value of each parameter of the contacts, by phase and name [SI unit of each]."""
        return by_name(self.table("parameters"), ("phase", "parameter"), "value")

    @property
    def rmsd(self) -> dict[tuple[str, str], float]:
        """Root mean square difference by trial and quantity: angles [rad], lengths [m], forces [N]."""
        return by_name(self.errors, ("trial", "quantity"), "rmsd")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`parameters`, `errors`, `rmsd_by_trial`, `certificate`, `correlation`, `selection`, `numbers`, `mesh`;
        `trial_NAME`, `profiles` too.
        """
        noise, tracks = self.given.noise, self.given.tracks
        own = {f"trial_{trial.recorded.name}": trial_table(trial, noise, tracks) for trial in self.trials}
        return {
            "parameters": parameters_table(self.phases),
            "errors": self.errors,
            "rmsd_by_trial": rmsd_by_trial("phase", self.by_phase, self.given.trials, noise),
            "certificate": certificate_table(self.phases),
            "correlation": correlation_table(self.phases),
            "selection": selection_table(self.phases),
            **({"profiles": profile_table(self.phases)} if self.options.profiles else {}),
            "numbers": ran_table(calibration_numbers(self.phases, self.given.trials)),
            "mesh": mesh_table("phase", [(phase.name, phase.found.motions) for phase in self.phases]),
            **own,
        }

    @cached_property
    def by_phase(self) -> dict[str, tuple[TrialResult, ...]]:
        """Channels of the trials by the motions of each phase."""
        *others, last = self.phases
        return {one.name: calibrated_trials(one, self.given.trials) for one in others} | {last.name: self.trials}

    def curves(self) -> dict[str, CurveSheet]:
        """`standing_up`: ground reaction, centre of pressure, residuals, torques. `ground`, `kinematics`, with an
        exoskeleton `straps` and `moments`, and `contact_laws`: figures 2 to 5, 8 and 9 of the study.
        """
        figures = {"ground": ("A", GROUND), "kinematics": ("A", KINEMATICS)}
        figures |= {"straps": ("B", STRAPS), "moments": ("B", MOMENTS)} if "B" in self.by_phase else {}
        last = {n.name: n.value for n in self.phases[0].numbers.numbers}
        return {
            "standing_up": CurveSheet(standing_curves(self.trials), PARTS),
            **{
                name: study_figure(channels, {one.recorded.name: one for one in self.by_phase[phase]}, self.given.noise)
                for name, (phase, channels) in figures.items()
            },
            "contact_laws": contact_laws(last),
        }

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains with forces, curves, parameters."""
        return {REPORT: calibration_page(self.sentences, self.given, self.trials, self.tables())}

    def write_files(self, folder: Path) -> None:
        """Trajectories and model, the strap's case for `gap gather`; tables, figure, page."""
        values = {n.name: n.value for n in self.phases[-1].numbers.numbers}
        subject, sites = self.given.subject, self.given.sites
        for trial in self.trials:
            write_motion(folder, subject, trial, values, self.found.solved, sites)
        kind = {"worn": self.given.exoskeleton, "one_leg": self.given.one_leg}
        write_standing_model(folder / "model.osim", subject, values, sites=sites, **kind)
        if self.phases[-1].name == "B":
            write_strap_case(folder / "gap", subject, self.given.trials, values, site=sites[0])
        super().write_files(folder)


def run(given: StandingUpTrials, o: StandingCalibrateOptions) -> StandingCalibrateResult:
    """Parameters and motions of all trials."""
    with listener().stages("calibrating") as stage:
        phases = phases_sought(given, o, stage)
    trials = calibrated_trials(phases[-1], given.trials)
    result = StandingCalibrateResult(options=o, given=given, phases=phases, trials=trials)
    for phase in phases:
        doubt_phase(phase)
        say_selection(phase, o.select)
    _report(result)
    return result


def goodness_of_calibration(r: StandingCalibrateResult) -> GoodnessOfFit:
    """Channels against their noise, and parameters that are on a bound; not what the plate puts into a stance."""
    put_in = PUT_IN if r.given.one_leg else ()
    fit = goodness_of_trials(r.trials, r.given.noise, [name for name in r.given.tracks if name not in put_in])
    bound = [n.name for phase in r.phases for n in phase.numbers.numbers if n.verdict == "on its bound"]
    doubts = [Doubt(f"{name} is on the bound of its search", False) for name in dict.fromkeys(bound)]
    return replace(fit, doubts=(*fit.doubts, *doubts))


def _report(r: StandingCalibrateResult) -> None:
    errors, fit = r.errors, goodness_of_calibration(r)
    judge(fit)
    numbers = [number for phase in r.phases for number in phase.numbers.numbers if number.verdict != "held"]
    known = [number.name for number in numbers if number.verdict == "known"]
    worst = {}
    straps = errors["quantity"].str.endswith("strap")
    for name, chosen in (("force", errors["unit"] == "N"), ("centre", errors["quantity"] == "centre")):
        worst[name] = errors[chosen & ~straps]["rmsd"].max()
    angle = errors[errors["unit"] == "deg"]["rmsd"].max()
    worn = errors[straps].groupby("quantity", sort=False)["rmsd"].max()
    also = "".join(f", {name} within {off:.1f} N" for name, off in worn.items())
    on_plates = [
        f"{what} within {worst[name]:.1f} {unit}, "
        for name, what, unit in (("force", "ground reaction", "N"), ("centre", "centre of pressure", "mm"))
        if name in r.given.tracks and not r.given.one_leg
    ]
    say(
        f"{counted(len(r.trials), 'trial')}: {''.join(on_plates)}angles within {angle:.2f}°{also} "
        "(largest RMSD of a trial)"
    )
    if all(np.isclose(getattr(r.given.noise, name), size) for name, size in SIZES.items()):
        reserve(
            "the noise is the one sit-to-stand coordinates writes, invented; the test of fit rests on it: give your own"
        )
    if r.given.one_leg:
        say("the plate's load is put in: force and centre of pressure test nothing")
    if r.found.solved and fit.outcome != "contradicts":
        seen = [each for phase in r.phases for each in phase.motions]
        passed = sum(each.certificate is not None and each.certificate.converged for each in seen)
        left = max(float(each.force.max()) for each in seen), max(float(each.moment.max()) for each in seen)
        say(
            f"{passed} of {counted(len(seen), 'motion')} certified: at most {left[0]:.2g} N and {left[1]:.2g} N m are "
            "left of the balance between the points"
        )
    if fit.outcome != "contradicts":
        say(f"{len(known)} of {counted(len(numbers), 'parameter')} known: {', '.join(known) or 'none'}")
    for phase in r.phases:
        found = phase.found
        note(
            f"phase {phase.name}",
            {
                "solved": found.solved,
                "ending": found.ending,
                "iterations": found.iterations,
                "cpu_seconds": round(found.seconds, 3),
                "objective": found.objective,
                "misfit": phase.misfit,
                "starts": [{"objective": end.objective, "solved": end.solved, "same": end.same} for end in phase.ends],
                "condition": None if phase.numbers.told_apart is None else phase.numbers.told_apart.condition,
                "sharper_than_prior": phase.numbers.directions.tolist(),
                "cost_shares": phase.shares,
                "parameters": {n.name: n.value for n in phase.numbers.numbers},
            },
        )


calibrate = Job("sit-to-stand calibrate", StandingCalibrateOptions, read, run)
