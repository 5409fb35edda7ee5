"""Numbers in another unit and files of another trial, of which a warning had no test: each is heard of by name."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.gap.case import doubt_numbers
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.compare.pairs import read as read_compared
from geocontact.analyses.shoulder.devices import device_named
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predictions import read as read_predictions
from geocontact.io.cases.gap_case import read_gap_case
from tests.analyses.findings.heard import Finding, Lines, as_parameters, heard, heard_reading
from tests.analyses.findings.test_recordings import rewritten
from tests.analyses.misalignment.test_compare import law
from tests.analyses.misalignment.trials import STROKE, free, locked, recorded
from tests.cli.calls import MESHES
from tests.cli.gap_cases import damped_elbow
from tests.trial_checks import test_commands as trials

Attempt = Callable[[Path], Lines]


def device(number: str, value: float, unit: str) -> Attempt:
    """An exoskeleton's file with one number."""

    def attempt(folder: Path) -> Lines:
        file = folder / "device.toml"
        file.write_text(f'name = "arm"\n[numbers]\n{number} = {{ value = {value}, unit = "{unit}" }}\n')
        return heard_reading(lambda _: device_named(str(file)), lambda: None)

    return attempt


def compared(files: Callable[[Path], tuple[Path, ...]]) -> Attempt:
    """Elbow compare, up to its reading, of one trial beside a law with a joint that slides."""

    def attempt(folder: Path) -> Lines:
        (file, *_) = files(recorded(folder, stroke=STROKE))
        return heard_reading(read_compared, CompareOptions, (file,), fit=law(folder), stroke=STROKE)

    return attempt


def keel(bending: float) -> Attempt:
    """Prosthesis keel of the foot on a bench, of about 28 N m², whose file states a bending stiffness."""

    def attempt(folder: Path) -> Lines:
        there = trials.files_of(MESHES / "foot_bench", folder)
        text = (there / "foot.toml").read_text()
        words = 'width = { value = 58, unit = "mm" }\nthickness = { value = 7, unit = "mm" }\n'
        stated = f'bending = {{ value = {bending}, unit = "N m^2", source = "derived" }}\n'
        assert words in text
        (there / "foot.toml").write_text(text.replace(words, words + stated))
        return heard(gc.prosthesis.keel, there / "foot.toml")

    return attempt


def predicted(*copied: str) -> Attempt:
    """Sit-to-stand predict, up to its reading, of the calibration's second trial 0.01 rad straighter, some of whose
    files are as they were.
    """

    def attempt(folder: Path) -> Lines:
        known = trials.files_of(MESHES / "standing_up_exoskeleton", folder)
        own = folder / "own"
        shutil.copytree(known, own)
        changes = {"coordinates.sto": "knee", "plates.mot": "feet_force_vy", "torques.sto": "exo_knee"}
        for file, column in changes.items():
            if file not in copied:
                trials.columns_changed(f"T2_{file}", lambda c, column=column: c.update({column: c[column] + 0.01}))(own)
        rewritten(own / "T2_strap.csv", lambda t: t.__setitem__(t.columns[1], t[t.columns[1]] + 0.1))
        return heard_reading(
            read_predictions, StandingPredictOptions, own / "study.toml", parameters=known / "truth.csv",
            against=known / "study.toml",
        )  # fmt: skip

    return attempt


def constant(times: float) -> Attempt:
    """Lengths of the elbow's gap case, in m, times a factor."""

    def attempt(folder: Path) -> Lines:
        file = damped_elbow(folder / "elbow") / "case.toml"
        file.write_text(re.sub(r"(?m)^(l|z) = (\S+)", lambda m: f"{m[1]} = {times * float(m[2])!r}", file.read_text()))
        return heard_reading(lambda _: doubt_numbers(read_gap_case(file.parent), file), lambda: None)

    return attempt


FINDINGS: dict[str, Finding] = {
    "device: a cuff in m, called cm": Finding(
        device("cuff_radius", 0.5, "cm"),
        r"warned: .*device.toml \[numbers\] cuff_radius: .* is unusual .*its unit right",
    ),
    "elbow compare: a locked joint beside a stroke": Finding(
        compared(locked), "warned: .*locked_1.csv: no displacement of its joint .*was it locked"
    ),
    "keel: EI of another foot": Finding(
        keel(60.0), "warned: .*EI of the file, 60 N m², is not that of its compressions"
    ),
    "predict: plates of a trial of the calibration": Finding(
        predicted("plates.mot"), "warned: T2: its force is that of T2 in `against`; name its own file"
    ),
    "gap: lengths in mm": Finding(constant(1e3), r"warned: .*case.toml \[constants\] l: 185000 mm is unusual"),
}
RIGHT: dict[str, Attempt] = {
    "device": device("cuff_radius", 5.0, "cm"),
    "elbow compare: a free joint": compared(free),
    "keel: EI of this foot": keel(30.0),
    "predict: files of its own": predicted(),
    "gap: lengths in m": constant(1.0),
}


@pytest.mark.parametrize("finding", as_parameters(FINDINGS))
def test_a_wrong_input_is_heard_of(finding: Finding, tmp_path: Path) -> None:
    lines = finding.attempt(tmp_path)
    assert any(re.search(finding.words, line) for line in lines), lines


@pytest.mark.parametrize("attempt", RIGHT.values(), ids=RIGHT)
def test_what_is_right_is_not_doubted(attempt: Attempt, tmp_path: Path) -> None:
    words = "its unit right|was it locked|EI of the file|name its own file|is unusual"
    assert not [line for line in attempt(tmp_path) if line.startswith("refused") or re.search(words, line)]
