"""The files of a synthetic study of standing up: description, coordinates, rates and plates, and what was planted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.io.recordings.exoskeleton_description import EXOSKELETON, ExoskeletonFile, exoskeleton_toml
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.trials import StandingNoise, StandingTrial
from geocontact.standing_up.worn_device import SHIPPED_NUMBERS
from meshes.standing_study import SyntheticStudy
from meshes.standing_unloaded import synthetic_unloaded

SITTING, PUSHING = 0.3, 0.2
"""Time before seat-off that the files hold, and within it the time in which the chair is left [s]."""
ON_CHAIR = 300.0
"""Force on the chair while sitting [N]; what feet and chair carry before seat-off is invented and not used."""


def synthetic_files(study: SyntheticStudy) -> dict[str, str]:
    """Text of `study.toml`, `truth.csv`, and `NAME_coordinates.sto`, `NAME_rates.sto`, `NAME_plates.mot` by name."""
    files = {"study.toml": _description(study), "truth.csv": _truth(study)}
    names = study.model.equations.names
    for trial in study.trials:
        time, sitting = _time(trial)
        files[f"{trial.name}_coordinates.sto"] = _motion(trial, names, trial.q, time, sitting, "coordinates", 5)
        files[f"{trial.name}_rates.sto"] = _motion(trial, names, trial.u, time, 0.0 * sitting, "rates", 4)
        files[f"{trial.name}_plates.mot"] = _plates(trial, time, float(trial.force[-1, 1]))
        if trial.torque is not None and trial.strap is not None:
            files |= _worn(trial, names, time, sitting)
    return files


def unloaded_files(subject: Subject) -> dict[str, str]:
    """Text of `unloaded_coordinates.sto` and `unloaded_motors.sto` by name."""
    time, q, motors = synthetic_unloaded(subject)
    angles, torques = ({"time": time} | dict(zip(EXO_JOINTS, of.T, strict=True)) for of in (np.degrees(q), motors))
    return {
        "unloaded_coordinates.sto": _storage("synthetic exoskeleton alone, coordinates", angles, 4, "yes"),
        "unloaded_motors.sto": _storage("synthetic exoskeleton alone, motors", torques, 3, "no"),
    }


def shipped_description() -> str:
    """Text of the description of the exoskeleton that counts where none is given."""
    units = {name: known.unit.si for name, known in EXOSKELETON.items()}
    head = "# The exoskeleton of sit-to-stand where no other is described. Only the dashpots of straps are published.\n"
    return head + exoskeleton_toml(ExoskeletonFile("shipped exoskeleton", SHIPPED_NUMBERS), units)


def _worn(
    trial: StandingTrial, names: Sequence[str], time: Float[np.ndarray, " t"], sitting: Float[np.ndarray, " s"]
) -> dict[str, str]:
    """Torques of all joints, and the strap's normal force; before seat-off what they are there."""
    if trial.torque is None or trial.strap is None:
        raise ValueError(f"{trial.name} has no torques or no strap")
    torque = np.vstack([np.outer(sitting, trial.torque[0]), trial.torque])
    columns = {"time": time} | dict(zip(names[3:], torque.T, strict=True))
    files = {f"{trial.name}_torques.sto": _storage(f"synthetic {trial.name} torques", columns, 3, "no")}
    for key, own in _mats(trial).items():
        force = np.r_[np.full(len(sitting), own[0]), own]
        rows = [f"{t:.6g},{f:.4f}" for t, f in zip(time, force, strict=True)]
        files[f"{trial.name}_{key}.csv"] = "\n".join(["time [s],normal [N]", *rows]) + "\n"
    return files


def _mats(trial: StandingTrial) -> dict[str, Float[np.ndarray, " t"]]:
    """Normal forces that were recorded, by the key that a study has for them."""
    if trial.strap is None:
        return {}
    forces = {"strap": trial.strap} | {f"strap_{site}": force for site, force in trial.elsewhere.items()}
    return {key: force for key, force in forces.items() if np.isfinite(force).all()}


def _time(trial: StandingTrial) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " s"]]:
    """Times from sitting on, and which of them lie before seat-off."""
    before = np.arange(round(SITTING * trial.rate)) / trial.rate
    return np.r_[before, SITTING + trial.time], np.ones(len(before))


def _description(study: SyntheticStudy) -> str:
    noise: StandingNoise = study.noise
    worn = any(trial.strap is not None for trial in study.trials)
    lines = [
        "# Synthetic: a chain of four bodies on two spheres that stood up by itself, with noise. Nobody was there.",
        f'mass = {{ value = {study.subject.mass:g}, unit = "kg" }}',
        f'height = {{ value = {study.subject.height:g}, unit = "m" }}',
        *(["exoskeleton = true"] if worn else []),
        "",
        "[noise]",
        f'length = {{ value = {1e3 * noise.length:g}, unit = "mm" }}',
        f'angle = {{ value = {np.degrees(noise.angle):g}, unit = "deg" }}',
        f'rate = {{ value = {noise.rate:g}, unit = "rad/s" }}',
        f'force = {{ value = {noise.force:g}, unit = "N" }}',
        f'centre = {{ value = {1e3 * noise.centre:g}, unit = "mm" }}',
        *([f'torque = {{ value = {noise.torque:g}, unit = "N m" }}'] if worn else []),
        *([f'strap = {{ value = {noise.strap:g}, unit = "N" }}'] if worn else []),
    ]
    for trial in study.trials:
        lines += ["", "[[trials]]", f'name = "{trial.name}"']
        lines += [f'{kind} = "{trial.name}_{kind}.sto"' for kind in ("coordinates", "rates")]
        lines += [f'torques = "{trial.name}_torques.sto"'] if worn else []
        lines += [f'{key} = "{trial.name}_{key}.csv"' for key in _mats(trial)]
        lines += [f'plates = "{trial.name}_plates.mot"', 'feet = "feet_force"', 'chair = "chair_force"']
    return "\n".join(lines) + "\n"


def _truth(study: SyntheticStudy) -> str:
    rows = [
        f"{each.name},{each.unit},{each.value(float(value)):.6g}"
        for each, value in zip(study.model.parameters, study.planted, strict=True)
    ]
    return "\n".join(["parameter,unit,value", *rows]) + "\n"


def _motion(
    trial: StandingTrial,
    names: Sequence[str],
    values: Float[np.ndarray, "t n"],
    time: Float[np.ndarray, " t"],
    sitting: Float[np.ndarray, " s"],
    what: str,
    decimals: int,
) -> str:
    """In degrees; before seat-off the posture, or no rate."""
    factors = np.r_[1.0, 1.0, np.full(len(names) - 2, np.degrees(1.0))]
    table = np.vstack([np.outer(sitting, values[0]), values]) * factors
    columns = {"time": time} | dict(zip(names, table.T, strict=True))
    return _storage(f"synthetic {trial.name} {what}", columns, decimals, "yes")


def _plates(trial: StandingTrial, time: Float[np.ndarray, " t"], weight: float) -> str:
    """Both feet on one plate, the chair on another."""
    count = len(time) - len(trial.time)
    since = np.clip((time[:count] - (SITTING - PUSHING)) / PUSHING, 0.0, 1.0)
    chair = np.zeros(len(time))
    chair[:count] = ON_CHAIR * (1.0 - since)
    fore = np.r_[np.zeros(count), trial.force[:, 0]]
    up = np.r_[weight - chair[:count], trial.force[:, 1]]
    centre = np.r_[np.full(count, trial.centre[0]), trial.centre]
    columns, none = {"time": time}, np.zeros(len(time))
    for name, force, place in (("feet", (fore, up, none), centre), ("chair", (none, chair, none), none - 0.3)):
        columns |= {f"{name}_force_v{axis}": each for axis, each in zip("xyz", force, strict=True)}
        columns |= {f"{name}_force_p{axis}": each for axis, each in zip("xyz", (place, none, none), strict=True)}
        columns |= {f"{name}_torque_{axis}": none for axis in "xyz"}
    return _storage(f"synthetic {trial.name} plates", columns, 5, "no")


def _storage(title: str, columns: Mapping[str, Float[np.ndarray, " t"]], decimals: int, degrees: str) -> str:
    rows = np.column_stack(list(columns.values()))
    head = (title, "version=1", f"nRows={len(rows)}", f"nColumns={len(columns)}", f"inDegrees={degrees}", "endheader")
    cells = ("\t".join(f"{value:.{decimals}f}".rstrip("0").rstrip(".") or "0" for value in row) for row in rows)
    return "\n".join((*head, "\t".join(columns), *cells)) + "\n"
