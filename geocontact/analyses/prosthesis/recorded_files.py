"""What a recording of a person with a prosthesis holds, as of a right leg: markers, plates, and the law of the sole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import fspath
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.motion.checked_trial import check_trial, turned_plates
from geocontact.analyses.motion.markers import markers_given, renamed_as_told, turn_of
from geocontact.analyses.prosthesis.ranges import LIMB, pair_of
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.from_markers import as_right, mirrored_name, of_side
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import AS_STOOD, FootOffset, Side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.plate_checks import require_weight
from geocontact.below_knee_prosthesis.simulate import GATE
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import LOADED, ForcePlate
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.io.recordings.spheres import LawFile, read_law
from geocontact.loads.sole_law import changed_law
from geocontact.trial_checks.recorded import FootPlate, TrialInputs

OTHER: Mapping[Side, Side] = {"right": "left", "left": "right"}
"""The other side of the body."""


@dataclass(frozen=True)
class LaboratoryFiles:
    """How the files of a trial are read, all of them alike, and what of them is checked against each other.

    Parameters
    ----------
    side
        The prosthesis is on.
    axes
        Which axes of the files, markers and plates, are ours; None where they are ours already.
    markers_map
        Our names by those of the recording.
    c3d_unit
        Of a .c3d file whose own is empty.
    """

    side: Side
    axes: str | None = None
    markers_map: str | None = None
    c3d_unit: str | None = None

    def markers(self, role: str, file: Path, time: tuple[float, float] | None = None) -> MarkerTrajectories:
        """Markers of a file by the names used here, on the side that they are on."""
        seen = renamed_as_told(markers_given(file, self.axes, time, self.c3d_unit), self.markers_map)
        add_input(role, file, frames=len(seen), markers=len(seen.names))
        return seen

    def plates(self, file: Path) -> tuple[ForcePlate, ...]:
        """All plates of a file in the axes of the markers."""
        return turned_plates(read_force_plates(file, self.c3d_unit), turn_of(self.axes), file)

    def plate_under_foot(self, file: Path, name: str | None, mass: float, option: str = "plate") -> ForcePlate:
        """One plate of a file; InputError where nobody of that mass [kg] stands on it.

        `option` is that by which the plate is named.
        """
        plate = plate_named(self.plates(file), name, file, f"`{option}`")
        add_input(f"`{option}s`", file, plate=plate.name)
        require_weight(self.stance(plate, file), mass * GRAVITY, f"`{option}`")
        return plate

    def right(self, seen: MarkerTrajectories) -> MarkerTrajectories:
        """Markers as of a right prosthesis."""
        return as_right(seen, self.side)

    def stance(self, plate: ForcePlate, file: Path) -> PlateStance:
        """Force and centre of pressure of one plate, as of a right prosthesis."""
        refuse_gaps(plate, file)
        force = of_side(np.nan_to_num(plate.wrench.force), self.side)
        centre = of_side(plate.centre_of_pressure(GATE), self.side)
        return PlateStance(plate.time, force, centre, plate.name, fspath(file))

    def check(
        self,
        standing: MarkerTrajectories | None,
        seen: MarkerTrajectories | None,
        mass: float,
        file: Path | None = None,
        own: ForcePlate | None = None,
        other: ForcePlate | None = None,
        floor: float | None = 0.0,
        height: float | None = None,
        age: float | None = None,
    ) -> None:
        """Warn of whatever two of these say differently; InputError where that leaves no result.

        Parameters
        ----------
        standing, seen
            Markers while standing, and of the trial; as they were recorded.
        mass
            Of the person [kg].
        file, own, other
            Plates, and of these the one under the prosthesis and the one under the other foot.
        floor
            Height that the floor is taken to have [m]; None where it is not level.
        height, age
            Of the person [m, years]; None where it is not known.
        """
        feet = ((own, self.side), (other, OTHER[self.side]))
        plates = tuple(FootPlate(plate, fspath(file), side) for plate, side in feet if plate is not None and file)
        named = {on.plate.name for on in plates}
        beside = tuple(each for each in self.plates(file) if each.name not in named) if file else ()
        turn = turn_of(self.axes)
        check_trial(TrialInputs(seen, standing, plates, mass, height, age=age, floor=floor, turn=turn, beside=beside))


SHORTEST_SWING = 0.25
"""s; for less a foot does not leave the floor while walking: a force that is missing for so long is a gap."""


def refuse_gaps(plate: ForcePlate, file: Path) -> None:
    """InputError for a force that is missing while somebody stands on the plate; unloaded ones may be left out."""
    missing = ~np.isfinite(plate.wrench.force).all(axis=1)
    loaded = ~missing & (np.linalg.norm(np.nan_to_num(plate.wrench.force), axis=1) >= LOADED)
    edges = np.diff(np.concatenate([[0], missing.astype(int), [0]]))
    for first, behind in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        within = first > 0 and behind < len(missing) and loaded[first - 1] and loaded[behind]
        if within and plate.time[behind] - plate.time[first - 1] < SHORTEST_SWING:
            what = f"its force is missing from {plate.time[first]:g} to {plate.time[behind - 1]:g} s, under load"
            raise InputError(file, plate.name, what, "fill the gap, or leave that step out with `time`")


def residual_of(standing: MarkerTrajectories, length: float | None, markers: str | None, side: Side) -> float | None:
    """Length of the residual limb [m]: the one that is given, or the distance of two markers while standing.

    None where neither is; InputError for markers that are not there or so far apart as no limb is. `standing` is as of
    a right prosthesis, the names of the markers are those of the person's own side.
    """
    if markers is None:
        return length
    names = {name if side == "right" else mirrored_name(name): name for name in pair_of(markers)}
    missing = [own for name, own in names.items() if name not in standing.names]
    if missing:
        what = f"no marker {', '.join(missing)} in the standing trial"
        raise InputError(standing.source, "`residual_markers`", what, "name two of its markers")
    places = [np.nanmedian(standing.of((name,))[:, 0], axis=0) for name in names]
    found = float(np.linalg.norm(places[0] - places[1]))
    LIMB.require(found, "`residual_markers`")
    _refuse_other_leg(standing, places, list(names.values()))
    return found


def _refuse_other_leg(standing: MarkerTrajectories, places: list[np.ndarray], own: list[str]) -> None:
    """InputError for a marker that is nearer to the sound shank than to that of the prosthesis, as of a right one."""
    ends = [(f"{side}KNE", f"{side}ANK") for side in "RL"]
    if not {name for pair in ends for name in pair} <= set(standing.names):
        return
    shanks = [[np.nanmedian(standing.of((name,))[:, 0], axis=0) for name in pair] for pair in ends]
    for place, name in zip(places, own, strict=True):
        along = [np.clip((place - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0) for a, b in shanks]
        right, left = (np.linalg.norm(a + s * (b - a) - place) for s, (a, b) in zip(along, shanks, strict=True))
        if left < right:
            what = f"{name} lies {1e3 * right:.0f} mm from the shank of the prosthesis, {1e3 * left:.0f} from the other"
            raise InputError(standing.source, "`residual_markers`", what, "name markers of the residual limb; `side`?")


def foot_with_law(foot: VariableStiffnessFoot, file: Path | None) -> VariableStiffnessFoot:
    """The foot with the numbers that a file gives, for all spheres or by zone; the rest are as they were."""
    if file is None:
        return foot
    law = read_law(file)
    add_input("`law`", file)
    _require_same_cut(foot, law, file)
    zones = {zone: of.model_dump(exclude_none=True) for zone, of in law.zone.items()}
    given = law.model_dump(exclude={"zone", "foot", "columns"}, exclude_none=True)
    try:
        changed = changed_law(foot.law, foot.sole.spheres.zone, given, zones)
    except InputError as error:
        raise replace(error, file=file) from error
    except ValueError as error:
        raise InputError(file, "force law", str(error), "correct the number") from error
    return replace(foot, law=changed)


def require_factors(foot: VariableStiffnessFoot, given: Path | None, law: Path | None) -> None:
    """InputError for a zone without damping or friction, on which `calibrate` and `design` seek or vary a factor."""
    spheres = foot.sole.spheres
    numbers = {"damping": foot.law.damping, "friction": np.broadcast_to(foot.law.kinetic, len(spheres))}
    for zone, chosen in spheres.zones.items():
        for name, values in numbers.items():
            if not values[chosen].min() > 0.0:
                kind = "damping, of foam its retardation," if name == "damping" else "kinetic friction"
                remedy = "give a positive number: it is multiplied by a factor"
                raise InputError(law or given or "", f"zone {zone}", f"{kind} is 0", remedy)


def _require_same_cut(foot: VariableStiffnessFoot, law: LawFile, file: Path) -> None:
    """InputError for stiffness or damping of a sphere or column of another sole than the foot's."""
    zones = [number for each in law.zone.values() for number in (each.k, each.b)]
    of_one = any(number is not None for number in (law.k, law.b, *zones))
    spheres = foot.sole.spheres
    columns = None if foot.sole.foam is None else len(spheres)
    if not of_one or law.columns == columns:
        return
    own = "one sphere" if law.columns is None else f"one of {law.columns} columns of foam"
    what = f"k and b are of {own}, and the sole of {foot.record.name} has {len(spheres)} {spheres.kinds}"
    raise InputError(file, "columns", what, "calibrate this foot, or name the one that the law was calibrated on")


def offset_of_law(file: Path | None, standing: Path) -> FootOffset:
    """How the foot is beside a standing trial; none where the file does not say, or says it of another trial."""
    beside = None if file is None else read_law(file).foot
    if beside is None:
        return AS_STOOD
    if beside.standing is not None and beside.standing != digest(standing):
        reserve(
            f"{file}: [foot] is of another standing trial than `static`, and is left out: height and pitch "
            "are errors of that trial (if it is the same in another file, take the line `standing` out of the law)"
        )
        return AS_STOOD
    return FootOffset(beside.height, beside.pitch, beside.height_sd, beside.pitch_sd)
