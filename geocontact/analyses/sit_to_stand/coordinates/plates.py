"""Plates under the feet and under the seat: those that are named, or those that lie there."""

from __future__ import annotations

from pathlib import Path

from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import turned_plates
from geocontact.analyses.sit_to_stand.coordinates.options import StandingCoordinatesOptions
from geocontact.analyses.sit_to_stand.trial_recordings import require_one_clock
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.standing_up.chain import GRAVITY
from geocontact.standing_up.plate_places import ALL, BodySites, PlatePlace, plate_places
from geocontact.trial_checks.foot_checks import AWAY

Plates = tuple[ForcePlate, ...]
FEET = ("right foot", "left foot", "both feet")


def chosen_plates(
    file: Path, body: BodySites, turn: Rotation | None, mass: float, o: StandingCoordinatesOptions
) -> tuple[list[ForcePlate], list[ForcePlate], tuple[PlatePlace, ...]]:
    """Plates under the feet, that of the chair, and what each plate of the file carries.

    InputError for names that are twice or none, and for plates of which none, or none of all, is under the feet.

    Parameters
    ----------
    mass
        Of the body [kg].
    """
    plates = turned_plates(read_force_plates(file, o.c3d_unit), turn, file)
    add_input("`plates`", file, plates=len(plates))
    if o.leg != "both" and o.chair is not None:
        raise InputError("", "`chair`", "has no effect on stances of one leg", "leave it out")
    places = plate_places(plates, body)
    under = (
        _named_feet(plates, file, o.feet, o) if o.feet is not None else _feet_by_place(plates, places, file, mass, o)
    )
    if o.chair is not None:
        seat = [plate_named(plates, o.chair, file, "`chair`")]
    else:
        seat = [] if o.leg != "both" or o.feet is not None else _of(plates, places, ("seat",), file)
    if any(plate is each for plate in seat for each in under):
        raise InputError("", "`chair`", f"{o.chair} is one of `feet` as well", "name each plate once")
    if len(seat) > 1:
        what = f"{' and '.join(plate.name for plate in seat)} lie under the seat"
        raise InputError(file, "`chair`", what, "name the chair's")
    for plate in (*under, *seat):
        require_one_clock(file, plate, body.time)
    _confront(plates, places, file, under if o.feet else [], seat if o.chair else [])
    return under, seat, places


def _named_feet(plates: Plates, file: Path, feet: str, o: StandingCoordinatesOptions) -> list[ForcePlate]:
    names = [name.strip() for name in feet.split(",")]
    if o.leg != "both" and len(names) > 1:
        raise InputError("", "`feet`", f"{len(names)} plates are named for one leg", "name that of its foot")
    if len(set(names)) < len(names):
        raise InputError("", "`feet`", f"{feet} names a plate twice", "name each plate once")
    return [plate_named(plates, name, file, "`feet`") for name in names]


def _of(plates: Plates, places: tuple[PlatePlace, ...], kinds: tuple[str, ...], file: Path) -> list[ForcePlate]:
    """Plates that carry one of these, each as sound as a named one has to be."""
    chosen = [place.name for place in places if place.carries in kinds]
    return [plate_named(plates, name, file, "`feet`") for name in chosen]


def _feet_by_place(
    plates: Plates, places: tuple[PlatePlace, ...], file: Path, mass: float, o: StandingCoordinatesOptions
) -> list[ForcePlate]:
    """Plates whose centre of pressure is under the foot, or both feet; InputError where they are not all there."""
    wanted = FEET if o.leg == "both" else (f"{o.leg} foot",)
    under = _of(plates, places, wanted, file)
    where = "; ".join(map(str, places))
    if not under:
        whose = "either foot" if o.leg == "both" else f"the {o.leg} foot"
        what = f"no plate lies under {whose}: {where}"
        raise InputError(file, "`feet`", what, "are `axes`, origin and clock those of the motion? else name the plates")
    if o.leg != "both":
        if len(under) > 1:
            what = f"{len(under)} plates lie under the {o.leg} foot: {where}"
            raise InputError(file, "`feet`", what, "name the one of the stance")
        return under
    sides = {place.carries for place in places if place.carries in FEET}
    most = max(float((plate.wrench.force @ plate.normal).max()) for plate in under)
    if len(sides) == 1 and "both feet" not in sides and most < ALL * mass * -float(GRAVITY[1]):
        what = f"only the {min(sides)} stands on a plate: {where}"
        raise InputError(file, "`feet`", what, "both feet need one, or ask for one `leg`")
    return under


def _confront(
    plates: Plates, places: tuple[PlatePlace, ...], file: Path, feet: list[ForcePlate], chair: list[ForcePlate]
) -> None:
    """A warning for plates that are named as something else than what they lie under."""
    at = {plate.name: place for plate, place in zip(plates, places, strict=True)}
    for plate in feet:
        place = at[plate.name]
        if place.carries == "seat" or place.from_feet > AWAY:
            reserve(f"{file}: {place}, and is one of `feet`: is it the right plate, in the axes of the motion?")
    for plate in chair:
        if at[plate.name].carries in FEET:
            reserve(f"{file}: {at[plate.name]}, and is the `chair`: are feet and chair exchanged?")
