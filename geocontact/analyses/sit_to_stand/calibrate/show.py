"""What a calibration shows: chains with the ground's force, curves, parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from geocontact.analyses.sit_to_stand.show import motion_page, standing_curves, standing_scene
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingUpTrials
from geocontact.view.page.content import Page, Section
from geocontact.view.page.tables import frame_table

MODEL = [
    "Both legs are one planar chain: masses, torques and the ground's force are for both, a strap's force for one.",
    "Each deviation from the recording is divided by its noise.",
    "The motion is computed together with the parameters under exact equations of motion; it is not the recorded one.",
    "Identified: the trials at least halve the standard deviation of the prior. Prior-dominated: they do not.",
    "Not separable: another minimum that costs little more has another value; the interval covers both.",
    "The priors are invented, as are the usual values.",
    "Intervals hold for this model and white noise of the stated size, not beyond.",
    "The mean error of calibrations of resampled trials is subtracted from the values, if these were requested.",
    "Certified: the balance holds between the collocation points to 5 N and 1 N m.",
    "In addition, another integrator that starts at any node follows the motion over one interval and over 0.2 s.",
    "Standing up is unstable: an open loop departs even from an exact answer, at the growth rate in the table.",
]


def calibration_page(
    sentences: Sequence[str],
    given: StandingUpTrials,
    trials: Sequence[TrialResult],
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """Moving chains with forces, curves, parameters, certificates."""
    sections: list[Section] = [
        standing_scene(given.subject, trials),
        *standing_curves(trials),
        frame_table("Parameters in SI: what these trials identify", tables["parameters"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
        frame_table("Root mean square differences and the stated noise", tables["errors"], 3),
        frame_table("The same by trial: mean and SD over joints, and SD over trials", tables["rmsd_by_trial"], 3),
    ]
    if len(tables["correlation"]):
        sections.append(frame_table("Correlation of the estimates", tables["correlation"], 2))
    residual = max(float(trial.judged.force.max()) for trial in trials)
    names = ", ".join(t.recorded.name for t in trials)
    titles = "Contacts calibrated on standing up", f"{names}; {given.subject.mass:g} kg, {given.subject.height:g} m"
    facts = [
        ("Residual between the points up to", f"{residual:.2g} N"),
        ("Ground reaction up to", f"{max(float(t.model.force[:, 1].max()) for t in trials):.0f} N"),
    ]
    return motion_page(titles, sentences, sections, MODEL, facts)
