"""The exoskeleton's own dynamics by the command: the shipped motion without a person, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import Subject
from meshes.standing_unloaded import planted
from tests.cli.calls import MESHES, call

ANGLES, MOTORS = (MESHES / "standing_up_exoskeleton" / f"unloaded_{what}.sto" for what in ("coordinates", "motors"))


def test_parameters_and_torque_of_a_trial(tmp_path: Path) -> None:
    """What is told by itself lies within three standard deviations; torques of the person are what is left."""
    both = pd.DataFrame({"time [s]": [0.0, 30.0]} | {f"{j}_moment [N m]": 100.0 for j in ("ankle", "knee", "hip")})
    both.to_csv(tmp_path / "forces.csv", index=False)
    options = ("--trial", ANGLES, "--trial-motors", MOTORS, "--together", tmp_path / "forces.csv")
    made = call(
        "sit-to-stand",
        "device",
        ANGLES,
        "--motors",
        MOTORS,
        *options,
        "--out",
        tmp_path / "device",
        folder=tmp_path / "device",
    )
    assert made.code == 0, made.err
    table = made.table("parameters.csv")
    assert table["told"].value_counts().to_dict() == {"by itself": 11, "in sums only": 6, "not at all": 1}
    alone = table["told"] == "by itself"
    off = (table["value"] - planted(Subject()))[alone] / ((table["upper"] - table["lower"])[alone] / (2.0 * 1.96))
    assert np.abs(off).max() < 3.0
    assert table.loc[~alone, ["lower", "upper"]].isna().all(axis=None)
    torque = made.table("torque.csv")
    for person, hinge in (("ankle", "exo_ankle"), ("knee", "exo_knee"), ("hip", "exo_hip")):
        own = torque[f"{hinge} motor [N m]"] - torque[f"{hinge} friction [N m]"]
        np.testing.assert_allclose(torque[f"{hinge} torque [N m]"], own, atol=1e-9)
        np.testing.assert_allclose(torque[f"{person} torque [N m]"], 100.0 - own, atol=1e-9)
    written = read_table(made.folder / "torques.sto")
    assert written.channels == ("ankle", "knee", "hip", "exo_ankle", "exo_knee", "exo_hip")


def test_torques_that_are_not_of_this_motion_are_doubted(tmp_path: Path) -> None:
    """Ankle and hip exchanged."""
    motors = tmp_path / "motors.sto"
    exchanged = MOTORS.read_text().replace("exo_ankle", "hip").replace("exo_hip", "exo_ankle")
    motors.write_text(exchanged.replace("hip\texo_knee", "exo_hip\texo_knee"))
    with pytest.warns(gc.InputWarning, match="are left of the motors' torques"):
        gc.sit_to_stand.device(ANGLES, motors=motors)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text.replace("exo_hip", "hip"), "no column for exo_hip"),
        (lambda text: "\n".join(text.splitlines()[:47]) + "\n", "frames"),
    ],
)
def test_recordings_that_cannot_be_are_refused(tmp_path: Path, change: object, words: str) -> None:
    file = tmp_path / "angles.sto"
    text = change(ANGLES.read_text())  # type: ignore[operator]
    file.write_text(text.replace("nRows=1000", f"nRows={len(text.splitlines()) - 7}"))
    made = call(
        "sit-to-stand", "device", file, "--motors", MOTORS, "--out", tmp_path / "device", folder=tmp_path / "device"
    )
    assert made.code == 2 and words in made.err and made.err.count("\n") == 1
    assert not (tmp_path / "device").exists()
