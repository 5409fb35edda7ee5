"""The way in of a recorded trial: it is checked against itself before anything is computed from it."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import reserve
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import OPENSIM_FRAME, read_force_plates
from geocontact.trial_checks.landmarks import FOOT, middle
from geocontact.trial_checks.recorded import UP, Check, FootPlate, TrialInputs
from geocontact.trial_checks.table import CHECKS, contradictions
from geocontact.trial_checks.twice import same_recordings

STEADY_FOR, STEADY = 1.0, 0.01
"""s, and standard deviation of what all plates carry over its mean, of somebody whose whole weight is on them."""


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


@dataclass(frozen=True, eq=False)
class StandsOn:
    """Plates of a recording of markers on which the person stands: `plates`, `stands_at` and `surely` of a trial."""

    plates: tuple[FootPlate, ...] = ()
    stands_at: float | None = None
    surely: bool = False


def standing_on(seen: MarkerTrajectories, file: Path, turn: Rotation | None, c3d_unit: str | None) -> StandsOn:
    """Plates that a .c3d file has beside its markers, where all of the person's weight is on them for `STEADY_FOR`.

    Who stands sways: what is on a foot changes, what is on both feet does not. Where markers of the feet are known,
    both have to be above plates as well. Nothing of other files, of plates that cannot be read, and of other trials.
    """
    if file.suffix.lower() != ".c3d":
        return StandsOn()
    try:  # plates that the analysis itself does not need: what is odd about them is no matter of its own
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            read = read_force_plates(file, c3d_unit)
    except InputError:
        return StandsOn()
    plates = read if turn is None else tuple(plate.turned(turn) for plate in read)
    normal = np.sum([np.nan_to_num(plate.wrench.force @ plate.normal) for plate in plates], axis=0)
    time = plates[0].time
    count = round(STEADY_FOR / float(np.median(np.diff(time)))) if len(time) > 1 else 0
    if not 1 < count <= len(time):
        return StandsOn()
    windows = np.lib.stride_tricks.sliding_window_view(normal, count)[:: max(count // 10, 1)]
    spread = windows.std(axis=1) / np.maximum(windows.mean(axis=1), LOADED)
    best = int(np.argmin(spread))
    feet = [middle(seen, FOOT, side) for side in ("right", "left")]
    known = [np.nanmedian(foot, axis=0) for foot in feet if foot is not None and np.isfinite(foot).any()]
    off = any(not any(_above(plate, foot) for plate in plates) for foot in known)
    if off or spread[best] > STEADY or windows[best].mean() < LOADED:
        return StandsOn()
    at = float(time[best * max(count // 10, 1) + count // 2])
    return StandsOn(tuple(FootPlate(plate, str(file)) for plate in plates), at, len(known) == 2)


def _above(plate: ForcePlate, place: Float[np.ndarray, " 3"]) -> bool:
    """Whether a point is above the surface between the corners; where these are not known, nobody knows."""
    if plate.corners is None:
        return False
    sides = np.column_stack([plate.corners[1] - plate.corners[0], plate.corners[3] - plate.corners[0]])
    along = np.linalg.lstsq(sides, place - plate.corners[0], rcond=None)[0]
    return bool((along >= 0.0).all() and (along <= 1.0).all())


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
