"""Wrong inputs that a second input shows, silent in two rounds: each is heard of, by name; right ones are not."""

from __future__ import annotations

import re
import shutil
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.case import doubt_numbers
from geocontact.analyses.misalignment.identify.numbers import read as read_identify
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import read as read_stances
from geocontact.analyses.prosthesis.keel.compressions import read as read_keel
from geocontact.analyses.prosthesis.keel.options import ProsthesisKeelOptions
from geocontact.analyses.shoulder.simulate.arms import read as read_arms
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.study.cases import read as read_study
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predictions import read as read_predictions
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.mocap.trc import read_trc
from geocontact.io.opensim.external_loads import read_external_loads
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, changed_csv, heard, heard_reading
from tests.analyses.findings.test_new_commands import settled
from tests.analyses.findings.test_recordings import cells, rewritten
from tests.analyses.mat.samples import THIGH
from tests.analyses.misalignment.test_population import described
from tests.analyses.misalignment.trials import KNOWN, locked, recorded
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.analyses.prosthesis.test_compare import written as stances
from tests.cli.calls import MESHES
from tests.cli.gap_cases import damped_elbow
from tests.trial_checks import test_commands as trials

Attempt = Callable[[Path], Lines]
Change = Callable[[pd.DataFrame], object]
WORN = "standing_up_exoskeleton"


def warned_of(reader: Callable[[Path], object], file: Path) -> Lines:
    """What a reader warns of."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", gc.InputWarning)
        reader(file)
    return [f"warned: {each.message}" for each in said]


def drifting(force: float) -> Change:
    return lambda table: table.__setitem__("AM", table["AM"] + np.linspace(0.0, force, len(table)))


def dropping(samples: int) -> Change:
    return lambda table: table.__setitem__(
        "AM", table["AM"].where((table.index < 245) | (table.index >= 245 + samples), 0.0)
    )


def pressed(radius: float) -> Attempt:
    """Modulus of the synthetic step with another radius [mm]."""
    return lambda folder: heard(
        gc.modulus, area=(areas(folder),), force=forces(folder), radius=gc.mm(radius), bootstrap=0
    )


def clipped(share: float) -> Attempt:
    """Mat of the shipped thigh whose cells end at a share of the largest pressure."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(THIGH, folder)
        table = pd.read_csv(there / "frames.csv", comment="#", skipinitialspace=True)
        own = table.columns[1:]
        table[own] = table[own].clip(upper=share * table[own].to_numpy().max())
        table.to_csv(there / "frames.csv", index=False)
        files = {"layout": there / "layout.toml", "landmarks": there / "landmarks.csv"}
        return heard(gc.mat, there / "frames.csv", surface=MESHES / "thigh.stl", unit="mm", cutoff=0.0, **files)

    return attempt


def rate(hertz: float) -> Attempt:
    """Markers of the shipped walk, at 100 Hz, below another rate."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.WALK, folder)
        text = (there / "walking.trc").read_text().splitlines()
        text[2] = f"{hertz:g}\t{hertz:g}\t" + text[2].split("\t", 2)[2]
        (there / "walking.trc").write_text("\n".join(text) + "\n")
        return warned_of(read_trc, there / "walking.trc")

    return attempt


def read(damage: trials.Damage, command: Callable[..., Any], files: Callable[[Path], Path]) -> Attempt:
    """A command of the battery, up to its reading, with one thing wrong."""

    def attempt(folder: Path) -> Lines:
        there = files(folder)
        return as_lines(command(there, **damage(there)))

    return attempt


def offset(force: float) -> Attempt:
    """Cop beside a plate that shows a force all the time."""
    return read(
        trials.plates_changed(lambda c: c.update(own_force_vy=c["own_force_vy"] + force)), trials.cop, trials.cop_files
    )


def belt(speed: float) -> Attempt:
    """Gap gather of a walk over ground, with the speed of a belt."""
    words = 'inputs = "t01.csv"\n'
    return read(
        trials.text_changed("gather.toml", lambda text: text.replace(words, f"{words}belt = {speed}\n")),
        trials.gather,
        trials.gather_files,
    )


def walked(damage: trials.Damage) -> Attempt:
    return read(damage, trials.simulate, partial(trials.files_of, trials.WALK))


def beside_the_heel(by: float) -> trials.Damage:
    """The toes' marker of the standing trial at the heel's, or so far above it [m]."""

    def change(seen: Any, places: np.ndarray) -> np.ndarray:
        places[:, seen.names.index("RTOE")] = places[:, seen.names.index("RHEE")] + np.array([0.0, by, 0.0])
        return places

    return trials.markers_changed("standing.trc", change)


def travelling(share: float) -> trials.Damage:
    """A centre of pressure that goes this share of its way along the walk."""

    def change(columns: dict[str, np.ndarray]) -> None:
        columns["own_force_px"] = share * columns["own_force_px"]

    return trials.plates_changed(change)


def walks(copied: bool) -> Attempt:
    """Prosthesis compare of two settings, whose walks may be copies."""

    def attempt(folder: Path) -> Lines:
        study = stances(folder, "low", "high")
        other = "low" if copied else "medium"
        shutil.copy(MESHES / f"gait_P1_{other}_1" / "walking.trc", folder / "copy.trc")
        shutil.copy(MESHES / f"gait_P1_{other}_1" / "plates.mot", folder / "copy.mot")
        text = re.sub(r'"[^"]*gait_P1_high_1/walking.trc"', '"copy.trc"', study.read_text())
        study.write_text(re.sub(r'"[^"]*gait_P1_high_1/plates.mot"', '"copy.mot"', text))
        return heard_reading(read_stances, ProsthesisCompareOptions, study)

    return attempt


def strapped(times: float) -> Attempt:
    """Sit-to-stand predict, up to its reading, with another time of the strap's force."""

    def attempt(folder: Path) -> Lines:
        worn = trials.files_of(MESHES / WORN, folder)
        held = trials.files_of(MESHES / "standing_up_held_out", folder)
        rewritten(held / "P1_strap.csv", lambda table: table.__setitem__("time [s]", times * table["time [s]"]))
        return heard_reading(
            read_predictions, StandingPredictOptions, held / "study.toml", parameters=worn / "truth.csv",
            against=worn / "study.toml",
        )  # fmt: skip

    return attempt


def risen(sign: float) -> Attempt:
    """Sit-to-stand movements of a knee whose sign may be turned."""

    def attempt(folder: Path) -> Lines:
        shutil.copy(MESHES / WORN / "T1_coordinates.sto", folder / "T1.sto")
        trials.columns_changed("T1.sto", lambda c: c.update(knee=sign * c["knee"]))(folder)
        return heard(gc.sit_to_stand.movements, folder / "T1.sto")

    return attempt


def expressed(force: str, point: str) -> Attempt:
    """External loads whose force and point are expressed in bodies."""

    def attempt(folder: Path) -> Lines:
        trials.leg_files(folder)
        text = (folder / "loads.xml").read_text()
        text = re.sub(r"<(force|point)_expressed_in_body>.*?</\1_expressed_in_body>", "", text, flags=re.DOTALL)
        frames = f"<force_expressed_in_body>{force}</force_expressed_in_body>"
        frames += f"<point_expressed_in_body>{point}</point_expressed_in_body></ExternalForce>"
        (folder / "loads.xml").write_text(text.replace("</ExternalForce>", frames))
        return warned_of(read_external_loads, folder / "loads.xml")

    return attempt


def elbow_trials(twice: bool) -> Attempt:
    """Elbow fit, up to its reading, of three trials of which one may be a copy."""

    def attempt(folder: Path) -> Lines:
        first, second, third = locked(recorded(folder))
        if twice:
            shutil.copy(first, second)
        return heard_reading(read_identify, IdentifyOptions, (first, second, third), **KNOWN)

    return attempt


def noise(times: float) -> Attempt:
    """A stated noise of the elbow's force, 0.05 N, times a factor."""

    def attempt(folder: Path) -> Lines:
        file = damped_elbow(folder / "elbow") / "case.toml"
        text = re.sub(r"(\[noise\]\s*force = )(\S+)", lambda m: f"{m[1]}{times * float(m[2])!r}", file.read_text())
        file.write_text(text)
        return heard_reading(lambda _: doubt_numbers(read_gap_case(file.parent), file), lambda: None)

    return attempt


def people(**parts: str) -> Attempt:
    """Elbow population of a description with other parts."""
    return lambda folder: heard(
        gc.misalignment.population, described(folder, **parts), range=gc.deg(0, 120), limit=1.0, samples=500, seed=1
    )


def overhead(old: str = "", new: str = "", level: str = "100%") -> Attempt:
    """Shoulder study, up to its reading, of one trial with words replaced."""
    assert old in trials.OVERHEAD_STUDY

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        (there / "study.toml").write_text(trials.OVERHEAD_STUDY.replace(old, new) + f'level = "{level}"\n')
        return heard_reading(read_study, StudyOptions, there / "study.toml")

    return attempt


SECOND = """
[[trials]]
name = "second"
person = "P1"
task = "T1"
markers = "{markers}"
tool = "tool.csv"
"""


def two_trials(more: str, markers: str = "markers.trc", first: str = "") -> Attempt:
    """Shoulder study, up to its reading, of two trials."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        trials.markers_changed("markers.trc", lambda _, places: places)(there)
        shutil.copy(there / "markers.trc", there / "copy.trc")
        shutil.copy(there / "markers.trc", there / "moved.trc")
        trials.markers_changed("moved.trc", lambda _, places: places + 0.001)(there)
        text = trials.OVERHEAD_STUDY.replace("[[trials]]\n", '[[trials]]\nname = "first"\n') + first
        (there / "study.toml").write_text(text + SECOND.format(markers=markers) + more)
        return heard_reading(read_study, StudyOptions, there / "study.toml")

    return attempt


def tooled(times: float) -> Attempt:
    """Shoulder simulate, up to its reading, with another clock of the tool."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        changed = changed_csv(there / "tool.csv", folder, time=lambda seconds: times * seconds)
        asked = {"side": "right", "tool": changed}
        return heard_reading(read_arms, ShoulderSimulateOptions, there / "markers.trc", **asked)

    return attempt


def compressed(old: str = "", new: str = "", copy: bool = False) -> Attempt:
    """Prosthesis keel, up to its reading, with words of the foot replaced or one curve copied."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(MESHES / "foot_bench", folder)
        text = (there / "foot.toml").read_text()
        assert old in text
        (there / "foot.toml").write_text(text.replace(old, new, 1))
        if copy:
            shutil.copy(there / "firm.csv", there / "hard.csv")
        return heard_reading(read_keel, ProsthesisKeelOptions, there / "foot.toml")

    return attempt


ARM = 'upper_arm = { value = 296, unit = "mm" }\n'
LEVELLED = 'level = "100%"\n'
BARE = 'level = "50%"\nwithout = "first"\n'
FINDINGS: dict[str, Finding] = {
    "cells: one drifts by 400 N": Finding(cells(drifting(400.0)), "warned: .*least force of AM goes from .*drift"),
    "cells: a cable drops out": Finding(cells(dropping(10)), "warned: .*AM reads 0 N from .*was it off"),
    "modulus: radius in inches": Finding(pressed(1.457), "warned: .*wider than the radius of the contact, 1.457 mm"),
    "knee: Poisson 0.046 of polyethylene": Finding(settled(poisson=0.046), "warned: `poisson`: 0.046 beside a modulus"),
    "knee: a layer of 80 mm": Finding(settled(thickness=gc.mm(80)), "warned: `thickness`: 80 mm is more than"),
    "mat: cells end at a third": Finding(clipped(1.0 / 3.0), "warned: .*cells stop at one value.*saturation_kPa"),
    "markers: half the rate": Finding(rate(50.0), "warned: .*DataRate is 50 Hz, and the times .*100"),
    "id: forces in the foot's frame": Finding(
        expressed("calcn_r", "ground"), "warned: .*expressed in calcn_r and its point in the ground"
    ),
    "cop: a plate shows 80 N in swing": Finding(offset(80.0), "warned: .*shows # N while the foot on it swings"),
    "gather: a belt over ground": Finding(belt(1.2), "warned: .*the foot under load moves along x"),
    "prosthesis: toes at the heel": Finding(walked(beside_the_heel(0.0)), "warned: .*is where .* is, in every frame"),
    "prosthesis: a constant centre of pressure": Finding(
        walked(travelling(0.0)), "warned: .*centre of pressure stays within"
    ),
    "compare: one walk twice": Finding(walks(copied=True), "warned: .*its recording is that of .*sample by sample"),
    "predict: strap's time in ms": Finding(strapped(1e3), "warned: .*P1_strap.csv.*is its time in s, not in ms"),
    "movements: a knee turned": Finding(risen(-1.0), "warned: .*knee is -9. degrees at its least.*sign turned"),
    "elbow fit: one trial twice": Finding(elbow_trials(twice=True), "warned: .*sample by sample: intervals are too"),
    "gap: noise in mN": Finding(noise(1e3), "warned: .*more than the channel changes in the trials"),
    "gap: noise in kN": Finding(noise(1e-3), "warned: .*changes by .* from sample to sample"),
    "population: a variance for a deviation": Finding(
        people(k="unit = 'N/m'\nnormal = { mean = 222, sd = 160, lower = 50 }"),
        "warned: .*standard deviation, and not a variance",
    ),
    "study: pounds for kg": Finding(
        overhead('value = 82, unit = "kg" }\n', f'value = 180, unit = "kg" }}\n{ARM}'),
        "warned: .*with an upper arm of 296 mm, which belongs to a height",
    ),
    "study: a push downwards": Finding(
        overhead('unit = "N" }\n', 'unit = "N" }\npush_direction = [0, -1, 0]\n'), "warned: .*is downwards"
    ),
    "study: a share of 1 %": Finding(
        overhead('unit = "N" }\n', 'unit = "N" }\ndominant_share = 0.01\n'), "warned: .*1% of the push by the dominant"
    ),
    "study: a level of 0.5 %": Finding(overhead(level="0.5%"), "warned: .*level: 0.5 % is unusual"),
    "study: without a trial in the device": Finding(
        two_trials(BARE, "moved.trc", first=LEVELLED), "refused: .*'first' was recorded in the device"
    ),
    "study: one recording twice": Finding(
        two_trials(LEVELLED, "copy.trc", first=LEVELLED), "warned: .*second: its recording is that of first"
    ),
    "shoulder: the tool's clock half as fast": Finding(tooled(2.0), "warned: .*runs while no arm is raised"),
    "keel: one curve twice": Finding(compressed(copy=True), "warned: hard: its recording is that of firm"),
    "keel: kinetic friction above the static one": Finding(
        compressed("value = 0.7,", "value = 0.95,"), "refused: .*kinetic friction 0.95 is larger than the static"
    ),
    "keel: a joint in front of the fulcrum": Finding(
        compressed("posterior = { value = 66", "posterior = { value = 120"), "warned: .*the keel does not bend between"
    ),
}
RIGHT: dict[str, Attempt] = {
    "cells that drift by 20 N": cells(drifting(20.0)),
    "cells with three samples of one value": cells(dropping(3)),
    "modulus: radius 30 mm": pressed(30.0),
    "knee: Poisson 0.1 of cartilage": settled(modulus=gc.MPa(12), poisson=0.1),
    "knee: a layer of 11 mm": settled(thickness=gc.mm(11)),
    "mat: cells as they are": clipped(1.0),
    "markers: 98 Hz for 100": rate(98.0),
    "id: forces and points in the foot's frame": expressed("calcn_r", "calcn_r"),
    "id: forces and points in the ground": expressed("ground", "ground"),
    "cop: a plate shows 8 N in swing": offset(8.0),
    "gather: a belt of 0.2 m/s": belt(0.2),
    "prosthesis: toes 5 mm above the heel": walked(beside_the_heel(0.005)),
    "prosthesis: a tenth of the way": walked(travelling(0.1)),
    "compare: two walks": walks(copied=False),
    "predict: strap's time in s": strapped(1.0),
    "movements: a knee as it is": risen(1.0),
    "elbow fit: three trials": elbow_trials(twice=False),
    "gap: twice the noise": noise(2.0),
    "gap: half the noise": noise(0.5),
    "population": people(),
    "study": overhead(),
    "study: 82 kg with that arm": overhead('value = 82, unit = "kg" }\n', f'value = 82, unit = "kg" }}\n{ARM}'),
    "study: a share of 60 %": overhead('unit = "N" }\n', 'unit = "N" }\ndominant_share = 0.6\n'),
    "study: without the bare trial": two_trials(BARE, "moved.trc"),
    "shoulder: the tool's clock": tooled(1.0),
    "keel": compressed(),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_nearly_is_wrong_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "|".join(finding.words.partition(".*")[2] or finding.words for finding in FINDINGS.values())
    assert not [line for line in attempt(tmp_path) if line.startswith("refused") or re.search(words, line)]
