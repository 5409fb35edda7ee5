"""The way in of a recorded trial: it is checked against itself before anything is computed from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import reserve
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.io.mocap.force_plates import OPENSIM_FRAME
from geocontact.trial_checks.recorded import UP, Check, TrialInputs
from geocontact.trial_checks.table import CHECKS, contradictions
from geocontact.trial_checks.twice import same_recordings


def check_trial(trial: TrialInputs, only: Sequence[Check] = CHECKS) -> frozenset[str]:
    """Every check of `trial_checks.table`: a warning for each contradiction; InputError for one that leaves no result.

    `only` are the checks of a second recording beside a standing trial that was checked already.

    Returns
    -------
    frozenset of str
        Names of the checks that found something.
    """
    found = contradictions(trial, only)
    for check, one in found:
        if one.refuse:
            raise InputError(one.source, one.place, one.what, one.remedy)
        reserve(str(one), cause=check.of_all)
    return frozenset(check.name for check, _ in found)


def check_apart(recordings: Mapping[str, Float[np.ndarray, "*shape"]], what: str) -> None:
    """A warning for each two recordings, by name, that are one and the same; `what` is counted wrongly then."""
    for first, second in same_recordings(recordings):
        reserve(f"{second}: its recording is that of {first}, sample by sample: {what}; give two different recordings")


def turned_plates(
    plates: tuple[ForcePlate, ...], turn: Rotation | None, file: Path, up: Float[np.ndarray, " 3"] = UP
) -> tuple[ForcePlate, ...]:
    """Plates in the axes that `axes` turns the markers into, in which `up` is upwards.

    Where the force under load is upwards before that turn and would not be after it, the file is in the model's axes
    already, y up as OpenSim has it: it is left as it is, with a warning.
    """
    if turn is None:
        return plates
    after = tuple(_turned(plate, turn, up) for plate in plates)
    if _along(up, plates) and not _along(up, after):
        axis = "xyz"[int(np.argmax(np.abs(up)))]
        reserve(
            f"{file}: its forces are along {axis} under load, which is up: `axes` turns the markers, not these plates"
        )
        return plates
    return after


def _turned(plate: ForcePlate, turn: Rotation, up: Float[np.ndarray, " 3"]) -> ForcePlate:
    """A plate in other axes; the floor of a table, which says nothing of it, is level where its loads act."""
    turned = plate.turned(turn)
    if plate.wrench.frame != OPENSIM_FRAME:
        return turned
    loaded = np.linalg.norm(turned.wrench.force, axis=1) >= LOADED
    height = float(np.median(turned.wrench.origin[loaded] @ up)) if loaded.any() else 0.0
    return replace(turned, point=height * up, normal=up.copy())


def _along(up: Float[np.ndarray, " 3"], plates: tuple[ForcePlate, ...]) -> bool:
    """Whether forces under load are upwards, in the median of all plates that carry anything."""
    forces = np.concatenate([np.nan_to_num(plate.wrench.force) for plate in plates])
    size = np.linalg.norm(forces, axis=1)
    loaded = size >= LOADED
    return bool(loaded.any() and np.median(np.abs(forces[loaded] @ up) / size[loaded]) > 0.7)
