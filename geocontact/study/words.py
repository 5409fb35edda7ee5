"""What a study found, in sentences: how many evaluations are new, what conditions differ in, which trials lie apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.analyses.frame.collector import reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.io.text.units import split_header
from geocontact.study.curves import STEPS, StudyCurves
from geocontact.study.plan import Evaluation
from geocontact.study.surface import SurfaceValues, surface_differences
from geocontact.study.tables import differences_of, outlier_table
from geocontact.study.trial_run import DONE

LEVEL = 0.05


def say_how_many(evaluations: Sequence[Evaluation]) -> None:
    """Say "3 of 4 trials of area have results, 1 of them new", of several steps for each by its name."""
    names = list(dict.fromkeys(one.run.step for one in evaluations))
    for name in names:
        own = [one for one in evaluations if one.run.step == name]
        done = [one for one in own if one.state == DONE]
        called = own[0].run.analysis if name == names[-1] else name
        new = len({one.address for one in done} - {one.address for one in done if one.kept})
        say(f"{len(done)} of {counted(len(own), 'trial')} of {called} have results, {new} of them new")


def say_differences(curves: Sequence[StudyCurves]) -> None:
    """What conditions differ in, and which trials lie apart."""
    for one, first, second, found in differences_of(curves):
        name = f"{split_header(one.column)[0]}, {first} against {second}"
        where = STEPS[found.p <= LEVEL]
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
        elif len(where):
            say(f"{name}: p is at most 5 % at {len(where)} of 101 places, {where[0]:g} to {where[-1]:g} %")
        else:
            say(f"{name}: no difference shown by {subjects}, the smallest p is {found.p.min():.2g}")
    apart = outlier_table(curves)
    for name in dict.fromkeys(apart["name"]):
        reserve(f"{name} lies apart from the other trials of its condition")


def say_surface(surface: SurfaceValues) -> None:
    """On how many points conditions differ."""
    for first, second, there, found in surface_differences(surface):
        name = f"distance at {len(surface.points)} particles, {first} against {second}"
        subjects = counted(found.subjects, "subject")
        if found.smallest > LEVEL:
            say(f"{name}: {subjects} cannot show a difference, the smallest p is {found.smallest:.2g}")
            continue
        shown = np.zeros(there.shape, bool)
        shown[there] = found.p <= LEVEL
        say(f"{name}: p is at most 5 % at {shown.any(axis=0).sum()} of them, by {subjects}")
