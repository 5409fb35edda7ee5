"""Wrong inputs of which nothing or something else was said: each is heard of by its true cause; right ones are not."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.gap.case import odd_gains
from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.recordings import gathered
from geocontact.analyses.gap.gather.recordings import read as read_gather
from geocontact.analyses.misalignment.simulate.result import as_offset
from geocontact.analyses.motion.inverse_dynamics.loads import read as read_id
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.shape.goodness import unsaid
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predictions import read as read_predictions
from geocontact.geometry.fit.sphere import fit_sphere
from tests import legs
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, heard, heard_reading
from tests.analyses.findings.test_recordings import rewritten
from tests.analyses.mat.samples import THIGH
from tests.analyses.misalignment.trials import KNOWN, locked, recorded
from tests.cli.calls import MESHES
from tests.cli.gap_cases import damped_elbow
from tests.trial_checks import test_commands as trials

Attempt = Callable[[Path], Lines]
Change = Callable[[pd.DataFrame], object]


def cup(half: float, rim: float, squeezed: float = 1.0, rough: float = 0.0) -> Attempt:
    """Sphere fitted to a cap of radius 24 mm, out to `half` [deg], with a flat rim of a width [mm] around it."""

    def attempt(folder: Path) -> Lines:
        turn = np.radians(np.arange(0.0, half + 0.1, 4.0))[1:]
        profile = [(24.0 * np.sin(p), -24.0 * squeezed * np.cos(p)) for p in turn]
        r, y = profile[-1]
        profile += [(r + w, y) for w in np.linspace(0.0, rim, int(rim / 0.5) + 1)[1:]]
        around = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
        places = np.array([(r * np.cos(a), y, r * np.sin(a)) for r, y in profile for a in around])
        places += rough * np.random.default_rng(0).standard_normal(places.shape)
        lines = [f"v {x} {y} {z}" for x, y, z in places]
        for ring in range(0, 72 * (len(profile) - 1), 72):
            for k in range(72):
                a, b = ring + k + 1, ring + (k + 1) % 72 + 1
                lines += [f"f {a} {b} {b + 72}", f"f {a} {b + 72} {a + 72}"]
        (folder / "cup.obj").write_text("\n".join([*lines, ""]), encoding="utf-8")
        return heard(gc.fit_shape, folder / "cup.obj", shape="sphere", unit="mm")

    return attempt


def remembered(**options: float) -> Attempt:
    """Elbow simulate of one short trial."""
    return lambda _: heard(gc.misalignment.simulate, trials=1, **options)


def diagnosed(times: float, trial: str = "t03") -> Attempt:
    """Gap diagnose of the damped elbow, of one trial whose force is multiplied."""

    def attempt(folder: Path) -> Lines:
        case = damped_elbow(folder / "elbow")
        rewritten(case / "trials" / f"{trial}.csv", lambda t: t.__setitem__("force [N]", times * t["force [N]"]))
        return heard(gc.diagnose, case)

    return attempt


def in_unit(factor: float) -> Attempt:
    """Mat of the shipped thigh, numbers of its cells times a factor below the same unit."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(THIGH, folder)
        table = pd.read_csv(there / "frames.csv", comment="#", skipinitialspace=True)
        table[table.columns[1:]] *= factor
        table.to_csv(there / "frames.csv", index=False)
        files = {"layout": there / "layout.toml", "landmarks": there / "landmarks.csv"}
        return heard(gc.mat, there / "frames.csv", surface=MESHES / "thigh.stl", unit="mm", cutoff=0.0, **files)

    return attempt


def pitched(sign: float) -> Attempt:
    """Gap gather of two walks, of which one foot's pitch may have the other sign."""

    def attempt(folder: Path) -> Lines:
        there = trials.gather_files(folder)
        rewritten(there / "t02.csv", lambda table: table.__setitem__("pitch [rad]", sign * table["pitch [rad]"]))
        return heard_reading(lambda o: gathered(read_gather(o), o), GatherOptions, there / "gather.toml")

    return attempt


def elbow_fitted(change: Change) -> Attempt:
    """Elbow fit of three synthetic trials, of which the second is changed."""

    def attempt(folder: Path) -> Lines:
        files = locked(recorded(folder))
        rewritten(files[1], change)
        return heard(gc.misalignment.identify, files, **KNOWN)

    return attempt


def armed(copied: bool) -> Attempt:
    """Shoulder simulate, up to its reading, with the right arm's markers for the left one's."""

    def change(seen: Any, places: np.ndarray) -> np.ndarray:
        for end in ("up", "dn") if copied else ():
            left, right = (seen.names.index(f"humerus_{side}{end}") for side in "lr")
            places[:, left] = places[:, right]
        return places

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.OVERHEAD, folder)
        trials.markers_changed("markers.trc", change)(there)
        return as_lines(trials.shoulder(there))

    return attempt


def strapped(of: str) -> Attempt:
    """Sit-to-stand predict, up to its reading, with the strap's force of another trial."""

    def attempt(folder: Path) -> Lines:
        worn = trials.files_of(MESHES / "standing_up_exoskeleton", folder)
        held = trials.files_of(MESHES / "standing_up_held_out", folder)
        if of:
            shutil.copy(worn / f"{of}_strap.csv", held / "P1_strap.csv")
        return heard_reading(
            read_predictions, StandingPredictOptions, held / "study.toml", parameters=worn / "truth.csv",
            against=worn / "study.toml",
        )  # fmt: skip

    return attempt


def jointed(lag: float = 0.0, seconds: float = 0.7) -> Attempt:
    """Functional hip of the synthetic leg, the thigh's markers on a clock that is late [s]."""

    def attempt(folder: Path) -> Lines:
        _, model, time, values = legs.planted(folder, amplitude=2.5)
        places = legs.markers_of(model, time, values)
        late = model.marker_places(np.array([np.interp(time - lag, time, column) for column in values.T]).T)
        thigh = [k for k, name in enumerate(places.names) if name.startswith("femur")]
        places.positions[:, thigh] = late[:, thigh]
        hip, knee = ("pelvis", "femur_r"), ("femur_r", "tibia_r")
        first, second = (",".join(f"{body}{k}" for k in range(4)) for body in (hip if seconds > 0.5 else knee))
        asked = {"first": first, "second": second, "axis": seconds < 0.5, "time": (0.2, 0.2 + seconds)}
        return heard(gc.functional_joint, legs.trc_file(folder, places), **asked)

    return attempt


def of_one_knee(folder: Path) -> Lines:
    """Id of the synthetic leg whose knee has the column of the hip."""
    there = trials.trial_of("id", folder)
    trials.columns_changed("swing.mot", lambda c: c.update(knee=c["hip_z"].copy()))(there)
    return heard_reading(read_id, IdOptions, there / "swing.mot", model=there / "leg.osim", loads=there / "loads.xml")


def backwards(table: pd.DataFrame) -> None:
    table["beta [deg]"] = table["beta [deg]"].to_numpy()[::-1]


def from_the_other_end(table: pd.DataFrame) -> None:
    table["beta [deg]"] = table["beta [deg]"].max() + table["beta [deg]"].min() - table["beta [deg]"]


def turned(table: pd.DataFrame) -> None:
    table["force [N]"] *= -1.0


FINDINGS: dict[str, Finding] = {
    "fit: a shallow cup with its rim": Finding(cup(60.0, 6.0), "warned: .* 24.00 mm by the inner half .*is a rim, lip"),
    "fit: the same, scanned": Finding(cup(60.0, 6.0, rough=0.1), "warned: .* 2(3.9|4.0). mm by the inner half"),
    "fit: a glenoid with its rim": Finding(cup(34.0, 4.0), "warned: .* 24.00 mm by the inner half .*is a rim, lip"),
    "fit: a cup's cavity and its back": Finding(
        lambda _: heard(gc.fit_shape, MESHES / "cup_r24.stl", shape="sphere", unit="mm"),
        "warned: cup_r24.stl: .* of the area look away from the centre and .* towards it: are inside and outside",
    ),
    "elbow simulate: a memory of 10 s in 5 s": Finding(
        remembered(memory=10.0, seconds=5.0), "warned: `memory`: 10 s beside trials of 5 s: 85% of the variance"
    ),
    "diagnose: one held-out trial's force times 1.4": Finding(
        diagnosed(1.4), "warned: trial t03: force is 1.40 times as large beside the model .*amplifier", slow=True
    ),
    "diagnose: one calibration trial's force times 1.4": Finding(
        diagnosed(1.4, "t01"), "warned: trial t01: force is 1.40 times as large beside the model .*amplifier", slow=True
    ),
    "mat: mmHg under kPa": Finding(
        in_unit(7.5),
        "warned: .*reads 218.* kPa, and cells end at 60 kPa: are the pressures in .*29.* if they are in mmHg",
    ),
    "gather: pitch of one trial turned": Finding(
        pitched(-1.0), "warned: .*t02.csv pitch: with its sign turned the sole agrees"
    ),
    "joint: one segment 0.1 s late": Finding(
        jointed(lag=0.1), "contradict.* of the second segment move 0.1[01] s later than those of the first.*one clock"
    ),
    "joint: 0.1 s of a trial": Finding(jointed(seconds=0.1), "warned: .*frames over 0.1 s are no movement"),
    "id: a knee with the hip's column": Finding(
        of_one_knee, "warned: .*knee has the values of hip_z, sample by sample"
    ),
    "elbow fit: an angle backwards in time": Finding(
        elbow_fitted(backwards),
        r"warned: .*does not go with .*most likely its angle runs backwards in time \((0.99|1.00)",
    ),
    "elbow fit: an angle from the other end": Finding(
        elbow_fitted(from_the_other_end), "refused: .*most likely .*its angle is counted from the other end"
    ),
    "elbow fit: a force turned": Finding(
        elbow_fitted(turned), "refused: .*most likely the sign of its force is turned"
    ),
    "shoulder: one arm twice": Finding(
        armed(copied=True), "refused: .*the left upper arm are where those of the right one are.*columns are copied"
    ),
    "predict: the strap of another trial": Finding(
        strapped("T2"), "refused: .*P1_strap.csv: runs from .*is it of another trial"
    ),
}
RIGHT: dict[str, Attempt] = {
    "a cup's cavity": lambda _: heard(
        gc.fit_shape, MESHES / "cup_r24.stl", shape="sphere", unit="mm", centre="0,0,0", region="outward<-0.5"
    ),
    "a cup": cup(60.0, 0.0),
    "a cup, scanned": cup(80.0, 0.0, rough=0.3),
    "a cup that is no sphere": cup(80.0, 0.0, squeezed=1.1),
    "a cup whose rim is ignored as an outlier": cup(90.0, 3.0, rough=0.05),
    "elbow simulate: a memory of 1 s in 5 s": remembered(memory=1.0, seconds=5.0),
    "elbow simulate: a memory of 10 s without noise": remembered(memory=10.0, seconds=5.0, noise=0.0),
    "mat": in_unit(1.0),
    "mat: twice the pressures, within the cells' range": in_unit(2.0),
    "gather": pitched(1.0),
    "joint": jointed(),
    "elbow fit": elbow_fitted(lambda _: None),
    "shoulder: two arms": armed(copied=False),
    "predict": strapped(""),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of_by_its_cause(finding: Finding, tmp_path: Path) -> None:
    """What is said first names it."""
    lines = finding.attempt(tmp_path)
    loud = [line for line in lines if not line.startswith("said")]
    assert loud and re.search(finding.words, loud[0]), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_is_right_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "|".join(finding.words.partition(".*")[2] or finding.words for finding in FINDINGS.values())
    assert not [line for line in attempt(tmp_path) if line.startswith("refused") or re.search(words, line)]


def test_the_share_of_an_offset_is_that_of_many_draws() -> None:
    """An autoregressive series of 400 steps, drawn 4000 times: the variance of its means over that of its values."""
    rng, steps = np.random.default_rng(5), 400
    keep = np.exp(-5.0 / steps / 4.0)  # a memory of 4 s over 5 s
    series = np.empty((4000, steps))
    series[:, 0] = rng.standard_normal(4000)
    for k in range(1, steps):
        series[:, k] = keep * series[:, k - 1] + np.sqrt(1.0 - keep**2) * rng.standard_normal(4000)
    assert as_offset(4.0, 5.0) == pytest.approx(series.mean(axis=1).var() / series.var(), rel=0.06)
    assert as_offset(0.0, 5.0) == 0.0


def test_a_gain_that_only_one_trial_has() -> None:
    """Harmonics times gains that are known; an offset, and gains that differ in all trials, are none."""
    rng, time = np.random.default_rng(2), np.linspace(0.0, 20.0, 400)
    model = {f"t{k}": 3.0 * np.sin(time + k) + k for k in range(5)}

    def said(gains: tuple[float, ...], offset: float = 0.0) -> list[str]:
        made = zip(gains, model.items(), strict=True)
        own = {name: gain * values + 0.1 * rng.standard_normal(400) for gain, (name, values) in made}
        own["t2"] += offset
        return odd_gains("force", own, model)

    (line,) = said((1.0, 1.02, 0.7, 0.98, 1.0))
    assert line.startswith("trial t2: force is 0.70 times as large beside the model as in the others (0.98 to 1.02)")
    assert not said((1.0, 1.02, 1.1, 0.98, 1.0)) and not said((1.0, 1.02, 1.0, 0.98, 1.0), offset=2.0)
    assert not said((0.8, 1.02, 1.4, 0.9, 1.2))


def test_gains_of_few_trials_that_all_differ_are_none() -> None:
    """Of 500 cases of four trials whose gains differ by 6 %, at most 2 % are doubted in either channel."""
    rng, time = np.random.default_rng(7), np.linspace(0.0, 20.0, 100)
    model = {f"t{k}": 3.0 * np.sin(time + k) + k for k in range(4)}

    def doubted() -> bool:
        own = [
            {name: np.exp(0.06 * rng.standard_normal()) * values for name, values in model.items()} for _ in range(2)
        ]
        return any(odd_gains("force", each, model, channels=2) for each in own)

    assert sum(doubted() for _ in range(500)) <= 10


def test_of_four_trials_one_is_named_where_the_others_agree() -> None:
    """Factors of 1.2 and 1.4: three gains within 1 %, and within 6 %, which say nothing of a fourth."""
    time = np.linspace(0.0, 20.0, 100)
    model = {f"t{k}": 3.0 * np.sin(time + k) + k for k in range(4)}

    def said(*gains: float) -> list[str]:
        return odd_gains("force", {f"t{k}": gain * model[f"t{k}"] for k, gain in enumerate(gains)}, model)

    for factor in (1.2, 1.4):
        (line,) = said(1.0, factor, 1.005, 0.995)
        assert line.startswith("trial t1: ")
    assert not said(1.0, 1.4, 1.06, 0.94)


@pytest.mark.parametrize("seed", [3, 9])
def test_a_rough_shallow_cap_has_no_rim(seed: int) -> None:
    """400 points on 25 degrees of 24 mm, 1 mm off: the inner half is as well described by a plane."""
    rng = np.random.default_rng(seed)
    up, turn = 1.0 - (1.0 - np.cos(np.radians(25.0))) * rng.random(400), 2.0 * np.pi * rng.random(400)
    way = np.column_stack([np.sqrt(1.0 - up**2) * np.cos(turn), np.sqrt(1.0 - up**2) * np.sin(turn), up])
    points = np.ascontiguousarray(1e-3 * (24.0 + rng.standard_normal(400))[:, None] * way)
    assert not [doubt for doubt in unsaid("cap", fit_sphere(points), points) if "rim" in doubt.what]
