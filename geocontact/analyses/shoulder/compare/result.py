"""A simulated arm beside logger and mat: `geocontact shoulder compare`, `gc.shoulder.compare`.

>>> import geocontact as gc
>>> trial = "meshes/overhead_P1T1S100/markers.trc"
>>> full = gc.shoulder.simulate(trial, level=1.0, side="right").table("right")
>>> recorded = full[["time [s]", "elevation [deg]", "supporting [N]"]]
>>> recorded.rename(columns={"supporting [N]": "force [N]"}).to_csv("recorded.csv", index=False)
>>> half = gc.shoulder.simulate(trial, level=0.5, side="right").write("half") / "right.csv"
>>> result = gc.shoulder.compare(half, "recorded.csv")
>>> result.fit_outcome
'contradicts'
>>> print(result)
the result contradicts its data, and its numbers must not be used: force: R² is -0.66, a constant would fit better
elevation, all: MAE 4.02, RMSD 4.51 deg
elevation, work: MAE 4.93, RMSD 5.12 deg
force, all: MAE 13.4, RMSD 14.7 N
force, work: MAE 16.1, RMSD 16.6 N
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, thinned
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.compare.shear import (
    MeasuredShear,
    friction_beside,
    friction_table,
    measured_shear,
    say_shear,
    shear_doubts,
)
from geocontact.analyses.shoulder.recording_doubts import recording_doubts
from geocontact.analyses.shoulder.recordings import recorded_channels, shown_in
from geocontact.analyses.shoulder.simulated_arm import out_of_cuff_words
from geocontact.data.errors import InputError
from geocontact.data.motion import Course
from geocontact.identify.goodness_of_fit import GoodnessOfFit, of_range
from geocontact.io.text.side_table import LARGEST_RESULT, read_side_table
from geocontact.shoulder_exoskeleton.beside_recording import (
    ALL,
    ALONG,
    AROUND,
    ELEVATION,
    FORCE,
    NORMAL,
    PASSIVE,
    SHEAR,
    TANGENTIAL,
    WORK,
    Channels,
    ComparedChannel,
    beside_recording,
)
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Words
from geocontact.view.page.tables import frame_table

SIMULATED = {
    ELEVATION: "elevation [rad]",
    FORCE: "supporting [N]",
    **{joint: f"{joint} [rad]" for joint in PASSIVE},
    NORMAL: "normal [N]",
    SHEAR: "shear [N]",
    ALONG: "distal [N]",
    AROUND: "shear around [N]",
}
"""Columns of the simulated arm that the recorded channels are compared with."""
OUT = "out of the cuff"
MAT = (
    "The simulated force is the component that lifts the arm; a pressure mat also counts what presses from the sides, "
    "and is loaded by straps, sleeves and a push force on the tool that the simulation does not know."
)


@dataclass(frozen=True, eq=False)
class ArmAndRecording:
    """A simulated arm with its phases in words, and the recording.

    Parameters
    ----------
    out_of_cuff
        Share of the simulated time for which the sphere is out of the cuff.
    friction
        Static friction of the cuff; None where no shear was recorded.
    """

    simulated: Channels
    phase: tuple[str, ...]
    out_of_cuff: float
    recorded: Channels
    friction: float | None = None


def read(o: ShoulderCompareOptions) -> ArmAndRecording:
    """Both files."""
    recorded = recorded_channels(o.recorded, o.map, o.angles, o.unit, o.delay)
    sheared = any(name in recorded.curves for name in TANGENTIAL)
    wanted = {ELEVATION, FORCE, *recorded.curves, *((NORMAL,) if sheared else ())}
    simulated, phase, out = _simulated(o.simulated, wanted)
    if o.friction is not None and not sheared:
        raise InputError("", "`friction`", "has no effect without measured shear", "leave it out")
    friction = friction_beside(o.simulated, o.friction) if sheared else None
    _doubt_side(o)
    add_input("simulated", o.simulated, frames=len(phase))
    add_input("recorded", o.recorded, samples=len(recorded.time))
    return ArmAndRecording(simulated, phase, out, recorded, friction)


def _doubt_side(o: ShoulderCompareOptions) -> None:
    """A warning where the names of what was recorded and of what was simulated are of two sides."""
    named = f"{o.recorded.stem} {o.map or ''}".lower()
    for side, other in (("right", "left"), ("left", "right")):
        if o.simulated.stem.lower() == side and other in named and side not in named:
            what = f"{o.simulated.name} is of the {side} arm, names of what was recorded say {other}"
            reserve(f"{o.recorded.name}: {what}: are both of one arm?")


def _simulated(path: Path, channels: Collection[str]) -> tuple[Channels, tuple[str, ...], float]:
    own = {channel: name for channel, name in SIMULATED.items() if channel in channels}
    needed = ("time [s]", "phase", *own.values())
    table = read_side_table(path, (*needed, OUT), LARGEST_RESULT)
    missing = [name for name in needed if name not in table]
    if missing:
        remedy = "give right.csv or left.csv of shoulder simulate"
        raise InputError(path, "", f"no column {missing[0]}", remedy)
    phase = tuple(map(str, table["phase"]))
    odd = [name for name in phase if name not in PHASES]
    if odd:
        raise InputError(path, "phase", f"{odd[0]!r} is not a phase", f"phases are {', '.join(PHASES)}")
    values = {channel: np.asarray(table[name], float) for channel, name in own.items()}
    out = float(np.mean([str(each) != "0" for each in table[OUT]])) if OUT in table else 0.0
    return Channels(np.asarray(table["time [s]"], float), values), phase, out


def compared(both: ArmAndRecording, o: ShoulderCompareOptions) -> tuple[ComparedChannel, ...]:
    """Every channel that was recorded, over the whole trial, over the work and in each phase."""
    simulated = both.simulated
    models = {channel: (channel, curve) for channel, curve in simulated.curves.items()}
    found = beside_recording(simulated.time, models, both.phase, both.recorded)
    if not found.channels:
        ours, theirs = (f"{each.time[0]:g} to {each.time[-1]:g} s" for each in (simulated, both.recorded))
        raise InputError(o.recorded, "", f"runs from {theirs}, the simulation from {ours}", "give `delay`")
    if found.share < 1.0:
        reserve(f"{o.recorded.name}: {found.share:.0%} of the simulated time was recorded")
    return tuple(found.channels.values())


def comparison_table(channels: Sequence[ComparedChannel]) -> pd.DataFrame:
    """One row for each channel and part of the trial."""
    rows = []
    for one in channels:
        unit, factor = shown_in(one.channel)
        for phase, a in one.errors.items():
            rows.append(
                {
                    "channel": one.channel,
                    "phase": phase,
                    "unit": unit,
                    "mae": a.mae * factor,
                    "rmsd": a.rmsd * factor,
                    "bias": a.bias * factor,
                    "r2 [-]": a.r2,
                    "lag [s]": a.lag,
                    "samples": a.samples,
                }
            )
    return pd.DataFrame(rows)


def channel_curves(channels: Sequence[ComparedChannel]) -> CurveSheet:
    """Each channel, recorded and simulated."""
    panels = []
    for one in channels:
        unit, factor = shown_in(one.channel)
        curves = [
            Curve("recorded", factor * one.measured, stroke=INK),
            Curve("simulated", factor * one.model, stroke=0),
        ]
        panels.append(Curves(one.channel.capitalize(), unit, curves))
    return CurveSheet(panels, Course("time", "s", channels[0].time))


UNITS = {"deg": "°", "N": " N"}


def answer(channels: Sequence[ComparedChannel], reserved: str = "") -> list[str]:
    """How far each channel is off over the whole trial, and over the work; `reserved` ends the first sentence."""
    told = []
    for part, where in ((ALL, "over the whole trial"), (WORK, "while the arm works")):
        off = [f"the {one.channel} by {_size(one, part)}" for one in channels if part in one.errors]
        if off:
            told.append(f"{' and '.join(off)} (root mean square) {where}")
    return [f"The simulation misses {told[0]}{reserved}.", *(f"It misses {words}." for words in told[1:])]


def _size(one: ComparedChannel, part: str) -> str:
    unit, factor = shown_in(one.channel)
    return f"{factor * one.errors[part].rmsd:.3g}{UNITS[unit]}"


def _facts(channels: Sequence[ComparedChannel]) -> list[tuple[str, str]]:
    """Error and R² of each channel over the whole trial, and error over the work."""
    facts = []
    for one in channels:
        r2 = one.errors[ALL].r2
        known = "" if np.isnan(r2) else f", R² {r2:.2f}"
        facts.append((f"{one.channel}, whole trial, RMSD", f"{_size(one, ALL)}{known}"))
        if WORK in one.errors:
            facts.append((f"{one.channel}, at work, RMSD", _size(one, WORK)))
    return facts


def comparison_page(
    recorded: str, channels: Sequence[ComparedChannel], reserved: str, shear: MeasuredShear | None = None
) -> Page:
    """Both curves of each channel, and errors by phase; `recorded` is the name of the recording.

    `reserved` are the words of `answer`, `shear` is what was measured of it.
    """
    limits = () if shear is None else (frame_table("Shear beside the friction limit", friction_table(shear)),)
    time = channels[0].time
    shown = thinned(len(time), [values for one in channels for values in (one.measured, one.model)])
    return Page(
        title=f"Simulated arm against {recorded}",
        subtitle="Shoulder exoskeleton: elevation of its arm, forces in its cuff, passive joints",
        time=time[shown],
        time_label="time [s]",
        headline=answer(channels, reserved),
        facts=_facts(channels),
        start_frame=int(np.argmax(np.nan_to_num(channels[-1].measured[shown]))),
        sections=(
            *channel_curves(channels).at(shown),
            frame_table("Errors by channel and phase", comparison_table(channels)),
            *limits,
            INPUTS,
            OPTIONS,
            Words("What the numbers do not contain", [MAT, NOT_A_DEVICE]),
        ),
        numbers=shown + 1,
        total=len(time),
    )


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShoulderCompareResult(Result):
    """A simulated arm beside a recording.

    Parameters
    ----------
    channels
        Those that were recorded.
    out_of_cuff
        Share of the simulated time for which the sphere is out of the cuff.
    shear
        Measured shear beside its friction limit; None where none was recorded.
    """

    options: ShoulderCompareOptions
    channels: tuple[ComparedChannel, ...]
    out_of_cuff: float
    shear: MeasuredShear | None = None

    @property
    def rmsd(self) -> dict[tuple[str, str], float]:
        """Root mean square difference by channel and phase: force [N], angles [rad]."""
        return {(one.channel, phase): a.rmsd for one in self.channels for phase, a in one.errors.items()}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`: one row per channel and phase; `friction` where shear was measured."""
        found = {"comparison": comparison_table(self.channels)}
        return found if self.shear is None else {**found, "friction": friction_table(self.shear)}

    def curves(self) -> dict[str, CurveSheet]:
        """`comparison`: each channel, recorded and simulated."""
        return {"comparison": channel_curves(self.channels)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Both curves of each channel, and errors by phase."""
        reserved = out_of_cuff_words(self.out_of_cuff)
        return {REPORT: comparison_page(self.options.recorded.name, self.channels, reserved, self.shear)}


def run(both: ArmAndRecording, o: ShoulderCompareOptions) -> ShoulderCompareResult:
    """Errors of every channel that was recorded, and what is to be said of them."""
    channels = compared(both, o)
    shear = _shear_of(both, channels)
    judge(goodness_of(channels, both.out_of_cuff, o.delay, shear))
    reserved = out_of_cuff_words(both.out_of_cuff)
    for one in channels:
        unit, factor = shown_in(one.channel)
        for name in (name for name in (ALL, WORK) if name in one.errors):
            a = one.errors[name]
            say(f"{one.channel}, {name}: MAE {factor * a.mae:.3g}, RMSD {factor * a.rmsd:.3g} {unit}{reserved}")
    note(
        "comparison",
        plain({each.channel: {name: vars(error) for name, error in each.errors.items()} for each in channels}),
    )
    if shear is not None:
        say_shear(shear)
    return ShoulderCompareResult(options=o, channels=channels, out_of_cuff=both.out_of_cuff, shear=shear)


def _shear_of(both: ArmAndRecording, channels: Sequence[ComparedChannel]) -> MeasuredShear | None:
    if both.friction is None:
        return None
    normal = np.interp(channels[0].time, both.simulated.time, both.simulated.curves[NORMAL])
    return measured_shear({one.channel: one for one in channels}, normal, both.friction, both.recorded.curves)


def goodness_of(
    channels: Sequence[ComparedChannel], out_of_cuff: float, delay: float | None, shear: MeasuredShear | None = None
) -> GoodnessOfFit:
    """Every channel against its recording, shear against friction, and whether the sphere is where the model holds."""
    doubts = [doubt for one in channels for doubt in recording_doubts(one, delay)]
    doubts += shear_doubts(shear, {one.channel: one for one in channels})
    doubts += of_range("the sphere is out of the cuff for", out_of_cuff)
    return GoodnessOfFit(tuple(doubts), (*(one.channel for one in channels), "sphere in its cuff"))


compare = Job("shoulder compare", ShoulderCompareOptions, read, run)
