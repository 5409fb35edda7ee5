"""A person of a study of overhead work with own segments, and a child."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import read
from geocontact.data.errors import InputWarning
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.human_arm import arm_track, smoothed
from geocontact.shoulder_exoskeleton.synthetic import PARTICIPANTS, TASKS, condition, synthetic_trial
from tests.analyses.shoulder.test_optimise import study

OWN_ARM = """height = { value = 1.78, unit = "m" }
segments.upper_arm = { mass = { value = 2.9, unit = "kg" } }
segments.hand = { centre = { value = 60, unit = "mm" }, length = { value = 90, unit = "mm" } }
"""


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_own_values_of_a_study_are_in_the_torque_that_is_needed(tmp_path: Path) -> None:
    """Weight of the arm at its joints by numpy, the hand's centre at 60 of 90 mm, the upper arm of 2.9 kg."""
    plain = read(ShoulderOptimiseOptions(study(tmp_path, 1, 1)))
    file = tmp_path / "study.toml"
    file.write_text(file.read_text().replace('dominant = "right"', f'dominant = "right"\n{OWN_ARM}'), encoding="utf-8")
    own = read(ShoulderOptimiseOptions(file))
    trial = synthetic_trial(PARTICIPANTS[0], TASKS[0], condition("S0"))
    motions = arm_motions(trial.markers, MarkerSettings(upright=(0.0, 0.25)))
    for motion, before, after in zip(motions.arms, plain.trials, own.trials, strict=True):
        track = smoothed(arm_track(trial.markers, motions.frame, motion.side), 6.0)
        hand = track.hand - track.wrist
        lever = (60.0 / 90.0 - 0.79) * hand * (0.0061 * 82.0)
        lever += (2.9 - 0.0271 * 82.0) * 0.5772 * (track.elbow - track.shoulder)
        more = np.einsum("ti,ti->t", track.raising(), np.cross(lever, [0.0, 9.80665, 0.0]))
        np.testing.assert_allclose(after.needed.weight - before.needed.weight, more, atol=0.02)
        assert np.abs(more).max() > 1.0 and after.arm_moment > 1.05 * before.arm_moment


@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_a_child_of_a_study_is_said_to_be_one(tmp_path: Path) -> None:
    file = study(tmp_path, 1, 1)
    text = file.read_text().replace("value = 82.0", "value = 45").replace('sex = "male"', 'sex = "male"\nAGE')
    file.write_text(text.replace("AGE", 'age = { value = 13, unit = "years" }'), encoding="utf-8")
    with pytest.warns(InputWarning, match=r"\[persons.P1\] age: masses of segments of boys of 13 years"):
        (one, _) = read(ShoulderOptimiseOptions(file)).trials
    assert one.needed.weight.max() > 0.0
