"""The exoskeleton's own dynamics by the command: the shipped motion without a person, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.signal import butter, sosfiltfilt
from scipy.stats import norm

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
    assert table["identified"].value_counts().to_dict() == {"by itself": 11, "in sums only": 6, "not at all": 1}
    alone = table["identified"] == "by itself"
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
    with pytest.warns(gc.InputWarning, match="contradicts its data.* of the motors' torques are not explained"):
        result = gc.sit_to_stand.device(ANGLES, motors=motors)
    assert result.fit_outcome == "contradicts" and result.exit_code == 1


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


BODIES = {"exo_shank": "exo_knee", "exo_thigh": "exo_hip", "exo_module": None}
"""Bodies from the ground upwards, and the hinge at the upper end of each."""


def recorded(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times [s], and columns of the hinges as they are."""
    rows = pd.read_csv(file, sep="\t", skiprows=file.read_text().split("endheader")[0].count("\n") + 1)
    return rows["time"].to_numpy(), rows[["exo_ankle", "exo_knee", "exo_hip"]].to_numpy()


def torques(told: dict[str, float], q: np.ndarray, u: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Newton and Euler in complex numbers (x forwards real, y up imaginary), and friction: (t, 3) [N m]."""
    turn, spin, spun = (np.cumsum(each, axis=1) for each in (q, u, a))
    change = np.full(len(q), -(told["gravity_x"] + 1j * told["gravity_y"]))
    arms, forces, moments = [], [], []
    for k, (body, above) in enumerate(BODIES.items()):
        ahead, whirl = np.exp(1j * turn[:, k]), 1j * spun[:, k] - spin[:, k] ** 2
        first = (told[f"{body} first moment along x"] + 1j * told[f"{body} first moment along y"]) * ahead
        forces.append(told[f"{body} mass"] * change + first * whirl)
        moments.append(told[f"{body} inertia"] * spun[:, k] + (first.conj() * change).imag)
        arms.append(
            0.0 * ahead if above is None else (told[f"joint {above} x"] + 1j * told[f"joint {above} y"]) * ahead
        )
        change = change + arms[-1] * whirl
    force, moment, found = 0.0 * change, 0.0 * change.real, []
    for k in (2, 1, 0):
        moment = moments[k] + moment + (arms[k].conj() * force).imag
        force = forces[k] + force
        found.append(moment)
    return np.column_stack(found[::-1]) + friction(told, u)


def friction(told: dict[str, float], u: np.ndarray) -> np.ndarray:
    hinges = ("exo_ankle", "exo_knee", "exo_hip")
    viscous, coulomb = (
        np.array([told[f"{name} {kind} friction"] for name in hinges]) for kind in ("viscous", "Coulomb")
    )
    return np.asarray(viscous * u + coulomb * np.tanh(u / told["Coulomb friction rate"]))


def test_torques_values_and_intervals_by_the_table_alone(tmp_path: Path) -> None:
    """Of `numbers.csv` and the recordings; with other options than the usual ones."""
    asked = {"height": 1.8, "cutoff": 5.0, "level": 0.9, "trial": ANGLES, "trial_motors": MOTORS}
    out = gc.sit_to_stand.device(ANGLES, motors=MOTORS, **asked).write(tmp_path / "device")
    numbers, fitted, parameters = (pd.read_csv(out / f"{name}.csv") for name in ("numbers", "unloaded", "parameters"))
    told = dict(zip(numbers["number"], numbers["value"], strict=True))
    assert (told["height"], told["filter cutoff"], told["level"]) == (1.8, 5.0, 0.9)
    (time, degrees), (_, motors) = recorded(ANGLES), recorded(MOTORS)
    order, step = int(told["filter order"]), told["sample step"]
    corner = np.arctan(np.tan(np.pi * told["filter cutoff"] * step) / (2.0**0.5 - 1.0) ** (0.5 / order)) / (
        np.pi * step
    )
    sections = butter(order, corner, fs=1.0 / step, output="sos")
    inside = (time >= time[0] + told["margin"]) & (time <= time[-1] - told["margin"])
    assert inside.sum() == told["samples"]
    q = sosfiltfilt(sections, np.radians(degrees), axis=0)
    u = np.gradient(q, step, axis=0)
    motion = q, u, np.gradient(u, step, axis=0)

    def seen(values: dict[str, float]) -> np.ndarray:
        return np.asarray(sosfiltfilt(sections, torques(told | values, *motion), axis=0)[inside])

    rows = fitted[[name for name in fitted if name.endswith("fitted [N m]")]]
    np.testing.assert_allclose(seen({}), rows, rtol=1e-8, atol=1e-8)
    trial = pd.read_csv(out / "torque.csv")
    rows = trial[[name for name in trial if name.endswith("friction [N m]")]]
    np.testing.assert_allclose(friction(told, u), rows, rtol=1e-8, atol=1e-8)

    none = dict.fromkeys(parameters["parameter"], 0.0)
    matrix = np.column_stack([seen(none | {name: 1.0}).ravel() for name in none])
    size = np.linalg.norm(matrix, axis=0)
    size[size <= told["least singular value"] * size.max()] = np.inf
    scaled, torque = matrix / size, sosfiltfilt(sections, motors, axis=0)[inside].ravel()
    back = np.linalg.pinv(scaled, rcond=told["least singular value"])
    rank = np.linalg.matrix_rank(scaled, tol=told["least singular value"] * np.linalg.norm(scaled, 2))
    left = torque - scaled @ (back @ torque)
    variance = left @ left / (len(left) - rank) / told["independent samples"]
    np.testing.assert_allclose(back @ torque / size, [told[name] for name in none], rtol=1e-6, atol=1e-7)
    alone = np.sum(back.T * scaled, axis=0) > 1.0 - told["least part"]
    reach = norm.ppf(0.5 + 0.5 * told["level"]) * np.sqrt(variance * np.sum(back**2, axis=1)) / size
    upper = np.where(alone, [told[name] for name in none] + reach, np.nan)
    assert alone.sum() == 11
    np.testing.assert_allclose(upper, parameters["upper"], rtol=1e-6)
