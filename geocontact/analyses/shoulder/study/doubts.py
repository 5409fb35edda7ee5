"""What is said and doubted of all arms of a study together: equal warnings are one line with their range."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from geocontact.analyses.frame.collector import judge, reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.shoulder.recording_doubts import recording_doubts
from geocontact.analyses.shoulder.simulated_arm import share_words
from geocontact.analyses.shoulder.study.cases import COPIED, StudyCase
from geocontact.identify.goodness_of_fit import MUCH, GoodnessOfFit, of_many_r2, of_range
from geocontact.shoulder_exoskeleton.beside_recording import ALL
from geocontact.shoulder_exoskeleton.device import JOINTS
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation

NAMED = 3
"""Arms that a line names."""


def say_doubts(cases: Sequence[StudyCase], reserved: str) -> None:
    """Joints at their stops, spheres out of the cuff, and what speaks against recordings.

    A joint that lies at its stop in every simulation is said as a finding: it is a property of the device's numbers.
    `reserved` is what sentences on all simulations end with.
    """
    found = [(case.name, case.within.simulation) for case in cases]
    found += [(f"{case.name} as {case.trial.without}", one.simulation) for case in cases if (one := case.without)]
    _stops(found, reserved)
    out = {name: float(s.out_of_cuff.mean()) for name, s in found if s.out_of_cuff.any()}
    if out:
        far = max(1e3 * float(np.abs(s.outputs["place"][s.out_of_cuff, 0]).max()) for name, s in found if name in out)
        reserve(
            f"the sphere is out of the cuff in {len(out)} of {counted(len(found), 'simulation')}, for "
            f"{_range(out.values())} of the time and up to {far:.0f} mm from its middle: {_named(out)}"
        )
    short = {case.name: case.beside.share for case in cases if case.beside is not None and case.beside.share < 1.0}
    if short:
        recorded = counted(sum(case.beside is not None for case in cases), "recording")
        span = _range(short.values())
        verb = "holds" if len(short) == 1 else "hold"
        reserve(f"{len(short)} of {recorded} {verb} {span} of the simulated time only: {_named(short, least=True)}")
    judge(goodness_of(cases, found))


def goodness_of(cases: Sequence[StudyCase], found: Sequence[tuple[str, ArmSimulation]]) -> GoodnessOfFit:
    """All arms against their recordings, and whether their spheres are where the model holds.

    One arm may be recorded wrongly; half of them contradict the simulation.
    """
    doubts, met = [], dict[str, dict[str, float]]()
    for case in cases:
        channels = {} if case.beside is None else case.beside.channels
        for name, compared in channels.items():
            if name != COPIED:
                met.setdefault(name, {})[case.name] = compared.errors[ALL].r2
                own = recording_doubts(compared)
                doubts += [replace(each, what=f"{case.name}, {each.what}", contradicts=False) for each in own]
    for name, values in met.items():
        doubts += [each for each in of_many_r2(name, values) if each.contradicts]
    lost = [name for name, simulation in found if simulation.out_of_cuff.mean() >= MUCH]
    doubts += of_range("the sphere is out of the cuff most of the time in", len(lost) / len(found), "all simulations")
    return GoodnessOfFit(tuple(doubts), (*met, "spheres in their cuffs"))


def _stops(found: Sequence[tuple[str, ArmSimulation]], reserved: str) -> None:
    for k, joint in enumerate(JOINTS):
        at = {name: float(s.at_stop[:, k].mean()) for name, s in found if s.at_stop[:, k].any()}
        if not at:
            continue
        if len(at) == len(found):
            say(
                f"{joint} is at a stop in all of {counted(len(found), 'simulation')}, for {_range(at.values())} of the "
                f"time: the ranges and springs among the device's numbers do not fit these arms{reserved}"
            )
        else:
            reserve(
                f"{joint} is at a stop in {len(at)} of {counted(len(found), 'simulation')}, for {_range(at.values())} "
                f"of the time: {_named(at)}"
            )


def _range(shares: Iterable[float]) -> str:
    every = sorted(shares)
    least, most = every[0], every[-1]
    return (
        share_words(most) if share_words(least) == share_words(most) else f"{share_words(least)} to {share_words(most)}"
    )


def _named(shares: dict[str, float], least: bool = False) -> str:
    """The arms with the largest shares, or the `least`, and how many more there are."""
    most = sorted(shares, key=lambda name: shares[name] if least else -shares[name])
    more = f" and {len(most) - NAMED} more" if len(most) > NAMED else ""
    return ", ".join(most[:NAMED]) + more
