"""Wrong inputs on commands and their pages, 19 of 50 of them silent then: each is heard of now, by name."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import read as read_stances
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.predict.predictions import read as read_predictions
from tests.analyses.findings.heard import Finding, Lines, as_lines, as_parameters, heard, heard_reading, typed
from tests.analyses.gap import test_gather_checks as gathered
from tests.analyses.misalignment.test_compare import law
from tests.analyses.misalignment.test_population import described
from tests.analyses.misalignment.trials import STROKE, changed, free, locked, recorded
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.analyses.prosthesis.test_compare import written as stances
from tests.analyses.shoulder import test_compare as arm
from tests.cli.calls import MESHES, PLATE, SPHERE, poses
from tests.cli.gap_cases import damped_elbow
from tests.trial_checks import test_commands as trials

ANGLE = np.degrees(arm.raised(arm.TIME))
WIDE = "".join(
    f"[{name}]\nunit = 'mm'\nnormal = {{ mean = {mean}, sd = 5 }}\n"
    for name, mean in (("l", 180), ("z", 100), ("y", 0))
)
STIFF = "[k]\nunit = 'N/m'\nvalue = 200\n"
Attempt = Callable[[Path], Lines]


def people(text: str) -> Attempt:
    """Elbow population of this description."""

    def attempt(folder: Path) -> Lines:
        (folder / "people.toml").write_text(text)
        return heard(
            gc.misalignment.population, folder / "people.toml", range=gc.deg(0, 120), limit=10.0, samples=1000, seed=1
        )

    return attempt


def designed(*words: object) -> Attempt:
    """Elbow design with these words for the range and the rest."""
    return lambda folder: typed(
        "elbow", "design", "--l-mm", 180, "--z-mm", 100, "--limit", 5, *words, "--out", folder / "o"
    )


def compared_elbow(
    pick: Callable[[Path], tuple[Path, ...]], spoil: Callable[[Path, Path], Path], **slide: Any
) -> Attempt:
    """Elbow compare of a recording beside the true law."""

    def attempt(folder: Path) -> Lines:
        first = pick(recorded(folder, stroke=STROKE))[0]
        return heard(gc.misalignment.compare, (spoil(first, folder),), fit=law(folder), **slide)

    return attempt


def as_locked(file: Path, folder: Path) -> Path:
    """A free trial without its column of displacement, as a locked one is."""
    copy = folder / "as_locked.csv"
    pd.read_csv(file).drop(columns="displacement [mm]").to_csv(copy, index=False)
    return copy


def in_radians(file: Path, folder: Path) -> Path:
    table = pd.read_csv(file)
    name = next(each for each in table.columns if "[deg]" in each)
    table[name] = np.radians(table[name])
    copy = folder / "radians.csv"
    table.to_csv(copy, index=False)
    return copy


def compared_arm(late: float = 0.0, names: str | None = None, **columns: np.ndarray) -> Attempt:
    """Shoulder compare of the right arm with such columns recorded."""
    return lambda folder: heard(
        gc.shoulder.compare, arm.simulated(folder), arm.recorded(folder, late=late, **columns), map=names
    )


def calibrated(damage: trials.Damage) -> Attempt:
    """Prosthesis calibrate on the shipped walk with one thing wrong."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(trials.WALK, folder)
        return as_lines(trials.calibrate(there, **damage(there)))

    return attempt


def compared_stances(*changed_words: str, settings: tuple[str, ...] = ("low",)) -> Attempt:
    """Prosthesis compare on a study with words replaced, up to its reading."""
    return lambda folder: heard_reading(
        read_stances, ProsthesisCompareOptions, stances(folder, *settings, changed=changed_words or ("", ""))
    )


def touching(*shifts: float, **options: Any) -> Attempt:
    """Area of the plate on the ball."""

    def attempt(folder: Path) -> Lines:
        motion = poses(folder, *((0.0, shift, 0.0) for shift in shifts or (-21.5,)))
        return heard(gc.area, PLATE, SPHERE, unit="mm", motion=(str(motion),), threshold=(4e-3,), **options)

    return attempt


def pose_sd(text: str) -> Attempt:
    """Area with this deviation of the pose as it is typed."""
    return lambda folder: typed(
        "area", PLATE, SPHERE, "--unit", "mm", "--motion", poses(folder, (0, -21.5, 0), (0, -22, 0)),
        "--pose-sd", text, "--draws", 20, "--out", folder / "out",
    )  # fmt: skip


def pressed(*words: object) -> Attempt:
    """Modulus with these words beside the synthetic step."""
    return lambda folder: typed(
        "modulus", "--area", areas(folder), "--force", forces(folder), "--radius-mm", 37, "--bootstrap", 0, *words,
        "--out", folder / "out",
    )  # fmt: skip


def gathering(**what: Any) -> Attempt:
    """Gap gather of three synthetic trials."""

    def attempt(folder: Path) -> Lines:
        lag, sign, copy, level = (what.get(name) for name in ("lag", "sign", "copy", "level"))
        made = [gathered.trial(1, offset=25.0), gathered.trial(2, offset=25.0), gathered.trial(3, offset=25.0)]
        if lag:
            made[2] = gathered.trial(3, lag=lag, offset=25.0)
        if sign:
            made[1] = gathered.trial(2, times=-60.0, offset=-25.0)
        file = gathered.settings(folder, made, ("t01", "t02", "t01") if copy else ("t01", "t02", "t03"))
        if level:
            file.write_text(file.read_text().replace("geocontact.systems.elastic_joint:JOINT", "shoulder"))
            with file.open("a") as more:
                more.write(f"[trial.t01]\nlevel = {level}\n")
        return heard(gc.gather, file)

    return attempt


def injected(effect: str = "damping", **options: Any) -> Attempt:
    return lambda folder: heard(
        gc.inject, damped_elbow(folder / "elbow", damping=25.0), effect=effect, bare=True, **options
    )


def diagnosed_of_two(spoil: Callable[[Path], None] | None = None) -> Attempt:
    """Gap diagnose with one trial to fit and one held out."""

    def attempt(folder: Path) -> Lines:
        case = damped_elbow(folder / "elbow")
        file = case / "case.toml"
        text = file.read_text().replace("['t01', 't02']", "['t01']").replace("['t03', 't04']", "['t03']")
        file.write_text(text)
        if spoil:
            spoil(case)
        return heard(gc.diagnose, case, bare=True)

    return attempt


def twice(case: Path) -> None:
    """The trial to fit is the one held out, too."""
    (case / "trials" / "t03.csv").write_bytes((case / "trials" / "t01.csv").read_bytes())


def stood_up_against_itself(_: Path) -> Lines:
    """Sit-to-stand compare, up to its reading."""
    own = MESHES / "standing_up_exoskeleton"
    return heard_reading(
        read_predictions, StandingCompareOptions, own / "study.toml", parameters=own / "truth.csv",
        against=own / "study.toml",
    )  # fmt: skip


def at_once(study: str) -> Attempt:
    """Prosthesis calibrate on the shipped walk of another setting."""
    return lambda folder: heard(
        gc.prosthesis.calibrate, trials.WALK / "walking.trc", static=trials.WALK / "standing.trc", mass=trials.MASS,
        plates=trials.WALK / "plates.mot", plate="own_force", setting=study, starts=1,
    )  # fmt: skip


def one_stance(*words: str) -> Attempt:
    """Prosthesis compare of one stance, to its end."""
    return lambda folder: heard(gc.prosthesis.compare, stances(folder, "low", changed=words), workers=1, socket_turns=0)


def in_one_set(folder: Path) -> Lines:
    """A trial both to fit and held out."""
    case = damped_elbow(folder / "elbow")
    file = case / "case.toml"
    file.write_text(file.read_text().replace("['t03', 't04']", "['t01', 't04']"))
    return heard(gc.diagnose, case, bare=True)


def along(motion: str, model: str = "leg.osim", **words: str) -> Attempt:
    """Markers of the shipped leg along a motion with words replaced."""

    def attempt(folder: Path) -> Lines:
        text = (MESHES / motion).read_text()
        for name, value in words.items():
            assert f"{name}=" in text
            text = re.sub(rf"{name}=\w+", f"{name}={value}", text)
        (folder / "motion.mot").write_text(text)
        return typed(
            "markers", folder / "motion.mot", "--model", MESHES / (model or "leg.osim"), "--out", folder / "out"
        )

    return attempt


def without_against(folder: Path) -> Lines:
    own = MESHES / "standing_up_exoskeleton"
    return typed(
        "sit-to-stand", "compare", own / "study.toml", "--parameters", own / "truth.csv", "--out", folder / "o"
    )


TRIAL = {"elevation [deg]": ANGLE}

FINDINGS: dict[str, Finding] = {
    # refused then
    "k 0.222 N/m for N/mm": Finding(designed("--k", 0.222, "--range", "0:120deg"), "refused: --k: .*0.222 N/mm meant"),
    "correlation 1.5": Finding(
        people(f"{WIDE}{STIFF}[x]\nunit = 'mm'\nvalue = 0\n[correlation]\nl_y = 1.5\n"),
        "refused: .*l_y: is not below",
    ),
    "range without unit": Finding(designed("--k", 222, "--range", "0:120"), "refused: --range: .*with its unit"),
    "samples 10": Finding(
        lambda folder: heard(
            gc.misalignment.population, described(folder), range=gc.deg(0, 120), limit=1.0, samples=10
        ),
        "refused: `samples`: 10 is not 100 to",
    ),
    "radians in elbow compare": Finding(compared_elbow(locked, in_radians), "refused: .*are these radians"),
    "congruence 400 mm": Finding(touching(congruence=0.4), "refused: `congruence`: 400 mm cannot be"),
    "congruence 0.1 mm": Finding(touching(congruence=1e-4), "refused: .*give `congruence` 8.4mm"),
    "pose-sd x=0.3": Finding(pose_sd("x=0.3"), "refused: --pose-sd: .*write --pose-sd t=0.5,r=1"),
    "adhesion without work": Finding(pressed("--adhesion", "jkr"), "refused: --adhesion: needs --work-of-adhesion"),
    "work without adhesion": Finding(pressed("--work-of-adhesion", 0.05), "refused: .*no effect without --adhesion"),
    "negative work": Finding(
        pressed("--adhesion", "jkr", "--work-of-adhesion", -0.05), "refused: .*cannot be the work of adhesion"
    ),
    "adhesion with reading discs": Finding(
        pressed("--adhesion", "jkr", "--work-of-adhesion", 0.05, "--reading", "discs"), "refused: .*leave out --reading"
    ),
    "columns exchanged in shoulder compare": Finding(
        compared_arm(**{"elevation [N]": ANGLE, "force [deg]": 0.2 * ANGLE}), "refused: .*'elevation' is in 'N'"
    ),
    "wrong plate in calibrate": Finding(
        calibrated(trials.option(plate="other_force")), "refused: .*plate: it carries no whole stance"
    ),
    "wrong plate in compare": Finding(
        compared_stances('plate = "own_force"', 'plate = "other_force"'), "refused: `plate`: .*for both feet"
    ),
    "side left": Finding(calibrated(trials.option(side="left")), "refused: .*is `side` right"),
    "markers of another trial": Finding(
        compared_stances("gait_P1_low_1/walking.trc", "gait_P1_high_1/walking.trc"), "refused: .*both need one clock"
    ),
    "effect dampng": Finding(injected("dampng"), "refused: `effect`: 'dampng' is not an effect.*damping"),
    "size 0": Finding(injected(size=0.0), "refused: `size`: 0 is not a gap above 0"),
    "damping -40": Finding(injected(value={"damping.b": -40.0}), "refused: .*its bounds are physical"),
    "evaluation = calibration": Finding(in_one_set, "refused: .*'t01' is listed in calibration too"),
    "inDegrees=no": Finding(along("leg_swing.mot", inDegrees="no"), "refused: .*too much for the radians"),
    "a motion of another model": Finding(along("gait.mot"), "refused: .*no column for any coordinate of the model"),
    "a model without markers": Finding(along("gait.mot", "knee.osim"), "refused: .*has no markers"),
    "no --against": Finding(without_against, "refused: --against is missing"),
    # warned of then
    "elbow force turned": Finding(
        compared_elbow(locked, lambda file, folder: changed(file, folder, force=lambda t: -t["force [N]"])),
        "(warned|contradicts): .*sign turned",
    ),
    "a free trial as a locked one": Finding(compared_elbow(free, as_locked), "(warned|contradicts): .*constant would"),
    "radians in shoulder's logger": Finding(
        compared_arm(**{"elevation [deg]": np.radians(ANGLE)}), "(warned|contradicts): .*0.017 times.*unit right"
    ),
    "pose-sd 30 degrees": Finding(pose_sd("t=0.5,r=30"), "warned: --pose-sd: 30 deg is unusual"),
    "pose-sd t = 30": Finding(pose_sd("t=30,r=1"), "warned: --pose-sd: 30 mm is unusual"),
    "work 1000": Finding(pressed("--adhesion", "dmt", "--work-of-adhesion", 1000), "warned: --work-of-adhesion: 1000"),
    # silent then
    "gather: the same files held out": Finding(gathering(copy=True), "refused: .*the same as in .*sample by sample"),
    "gather: level 50": Finding(gathering(level=50), "refused: .*0.5 .50 %. meant"),
    "gather: a force turned": Finding(gathering(sign=True), "warned: torque: in t02 its sign is opposite"),
    "gather: 1 s late": Finding(gathering(lag=1.0), "warned: trial t03: .*1 s later .*same clock"),
    "inject of nothing": Finding(injected(value={"damping.b": 1e-6}), "said: not identified: ", slow=True),
    "diagnose 1 + 1": Finding(diagnosed_of_two(), "refused: .*1 trial to fit to"),
    "diagnose 1 + 1, the same twice": Finding(diagnosed_of_two(twice), "refused: .*t03: .*sample by sample"),
    "calibrate with 170 lb as kg": Finding(calibrated(trials.option(mass=170.0)), "warned: .*is about # kg: check"),
    "compare with lb for kg": Finding(
        compared_stances('unit = "kg"', 'unit = "lb"'), "warned: .*about 72 kg: check mass and its unit"
    ),
    "shoulder compare, force turned": Finding(
        compared_arm(**TRIAL, **{"force [N]": -0.2 * ANGLE}), "(warned|contradicts): .*force: .*sign turned"
    ),
    "shoulder compare, force in kN": Finding(
        compared_arm(**TRIAL, **{"force [N]": 2e-4 * ANGLE}), "(warned|contradicts): .*force: .*unit right"
    ),
    "shoulder compare, the other arm": Finding(
        compared_arm(names="elevation=elevation_left", **{"elevation_left [deg]": 0.55 * ANGLE + 30.0}),
        "warned: .*right arm.*say left: are both of one arm",
    ),
    "shoulder compare, 1 s late": Finding(compared_arm(1.0, **TRIAL), "warned: .*1.00 s late: is its clock right"),
    "calibrate, setting high on a medium trial": Finding(at_once("high"), "warned: .*check `mass`, `sett", long=True),
    "compare, setting high on a low trial": Finding(
        one_stance('setting = "low"', 'setting = "high"'),
        "(warned|contradicts): .*setting",
        slow=True,
    ),
    "population with x in m": Finding(
        people(f"{WIDE}{STIFF}[x]\nunit = 'm'\nnormal = {{ mean = 0, sd = 15 }}\n"), "refused: .*15 mm meant"
    ),
    "pose-sd t = 0.0003 m": Finding(pose_sd("t=0.0003,r=0.01"), "warned: --pose-sd: 0.0003 mm is unusual"),
    "sit-to-stand compare against itself": Finding(stood_up_against_itself, "warned: T1: the same recording is T1"),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines
