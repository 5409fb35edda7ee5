"""A foot and its stances on plates along the markers of the socket, and the sole's numbers sought in them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from geocontact.analyses.frame.collector import add_input, listener, reserve
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.analyses.person import name_unused, stated_of_body
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.ranges import TURNS
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, foot_with_law, require_factors
from geocontact.analyses.prosthesis.stance_files import counted_twice
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration, calibrate
from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    Errors,
    RecordedStance,
    WalkedStance,
    stance_on_plate,
    walked_stance,
)
from geocontact.below_knee_prosthesis.calibration.whole_calibration import (
    WholeCalibration,
    along_limb,
    calibrate_whole,
    limb_on_sole,
)
from geocontact.below_knee_prosthesis.from_markers import Walked, standing_leg, walked
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.force_plates import plate_named
from geocontact.io.recordings.gait_study import GaitPerson, read_gait_study

FIRST = "first"
"""What the stance that the command names is called beside others."""
ANGLES_CUTOFF = 6.0
"""Hz; of the markers that tell the leg's angles, as `prosthesis simulate` has it."""


@dataclass(frozen=True)
class StanceFiles:
    """Files of one stance and the setting of the foot in it; in a study its name there."""

    name: str
    markers: Path
    static: Path
    plates: Path
    plate: str | None
    other_plate: str | None
    setting: str
    fulcrum: float | None


@dataclass(frozen=True, eq=False)
class StanceOnPlate:
    """A stance as of a right leg; for the whole model the markers, their fit and the leg's motion."""

    asked: StanceFiles
    stance: RecordedStance
    seen: MarkerTrajectories
    fit: Walked | None
    walked: WalkedStance | None


@dataclass(frozen=True, eq=False)
class FootOnPlate:
    """A foot and its stances, the one that the command names first."""

    foot: VariableStiffnessFoot
    stances: tuple[StanceOnPlate, ...]


def read(o: ProsthesisCalibrateOptions) -> FootOnPlate:
    """Everything the options name."""
    with listener().preparing():
        foot = foot_of(o.foot)
        fulcrum_at(foot, o.setting, o.fulcrum)
        foot = foot_with_law(foot, o.law)
        require_factors(foot, o.foot, o.law)
    first = StanceFiles("", o.markers, o.static, o.plates, o.plate, o.other_plate, o.setting, o.fulcrum)
    more = further_stances(o)
    asked = [replace(first, name=FIRST) if more else first, *more]
    found = tuple(_stance(each, foot, o) for each in asked)
    if o.full:
        reserve("the hip's centre comes from a regression")
    return FootOnPlate(foot, found)


def further_stances(o: ProsthesisCalibrateOptions) -> list[StanceFiles]:
    """Stances of the study that are fitted together with the one named; InputError where they are no such stances.

    Those marked as `calibrated`, all of the person where none is; the one named itself is left out.
    """
    if o.further is None:
        return []
    study = read_gait_study(o.further)
    add_input("`further`", o.further, trials=len(study.trials))
    marked = [each for each in study.trials if each.calibrated] or list(study.trials)
    own = [each for each in marked if not _same(each.markers, o.markers)]
    if not own:
        raise InputError(o.further, "[[trials]]", "no stance beside the one named", "describe at least one more")
    names = sorted({each.person for each in own})
    if len(names) > 1:
        what = f"stances of {', '.join(names)}: a sole is one person's"
        raise InputError(o.further, "[[trials]]", what, "keep those of one person, or mark them as calibrated")
    person = study.persons[names[0]]
    _require_person(person, names[0], o, o.further)
    why = "the person is that of its options"
    name_unused((o.further, f"[persons.{names[0]}]"), stated_of_body(person), "prosthesis calibrate", why)
    for each in own:
        if each.ground is not None:
            what = f"{each.name} is on another ground, and a calibration is on the floor y = 0"
            raise InputError(o.further, "ground", what, "leave that stance out")
    if person.law is not None or any(each.law is not None for each in own):
        reserve(f"{o.further}: its laws are not used here; `law` has the usual numbers")
    return [
        StanceFiles(
            each.name,
            each.markers,
            person.static,
            each.plates,
            each.plate,
            each.other_plate if o.full else None,
            each.setting or o.setting,
            each.fulcrum,
        )
        for each in own
    ]


SAME_MASS = 0.02
"""Relative difference of two masses that are those of one person."""


def _require_person(person: GaitPerson, name: str, o: ProsthesisCalibrateOptions, file: Path) -> None:
    """InputError where the person of the study is not the one that the options describe."""
    if abs(person.mass / o.mass - 1.0) > SAME_MASS:
        what = f"{name} has {person.mass:g} kg, `mass` is {o.mass:g} kg"
        raise InputError(file, f"[persons.{name}] mass", what, "a sole is calibrated on stances of one person")
    if person.side != o.side:
        what = f"the prosthesis is on the {person.side}, `side` is {o.side}"
        raise InputError(file, f"[persons.{name}] side", what, "correct one of them")
    if person.foot is not None and (o.foot is None or not _same(person.foot, o.foot)):
        what = "another foot than `foot`"
        raise InputError(file, f"[persons.{name}] foot", what, "a sole is calibrated on one foot")


def _same(one: Path, other: Path) -> bool:
    return one.resolve() == other.resolve()


def _stance(asked: StanceFiles, foot: VariableStiffnessFoot, o: ProsthesisCalibrateOptions) -> StanceOnPlate:
    """One stance from its files."""
    fulcrum = fulcrum_at(foot, asked.setting, asked.fulcrum)
    named = _same(asked.markers, o.markers)
    unit = o.c3d_unit if named else unit_of_c3d(o.c3d_unit, asked.markers, asked.static, asked.plates)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, unit)
    role = "" if named else f"{asked.name} "
    still = lab.markers(f"{role}`static`", asked.static)
    walking = lab.markers(f"{role}markers", asked.markers)
    own = lab.plate_under_foot(asked.plates, asked.plate, o.mass)
    there = plate_named(lab.plates(asked.plates), asked.other_plate, asked.plates, "`other_plate`") if o.full else None
    lab.check(still, walking, o.mass, asked.plates, own, there)
    standing, seen, plate = lab.right(still), lab.right(walking), lab.stance(own, asked.plates)
    leg = standing_leg(standing, Person(o.mass), foot.keel, foot.record.below)
    errors = Errors(force=o.force_noise, height=o.height_error, pitch=o.pitch_error, speed=o.speed_error)
    cutoff = None if o.cutoff == 0.0 else o.cutoff
    given = seen, leg, plate, foot, fulcrum
    found = stance_on_plate(*given, cutoff=cutoff, gap_limit=o.gap_limit, errors=errors)
    stance = replace(found, standing=digest(asked.static))
    if there is None:
        return StanceOnPlate(asked, stance, seen, None, None)
    fit = walked(seen, leg, cutoff=ANGLES_CUTOFF, gap_limit=o.gap_limit)
    on_model = walked_stance(stance, fit, lab.stance(there, asked.plates), seen.source)
    return StanceOnPlate(asked, stance, seen, fit, on_model)


def along_poses(given: FootOnPlate, o: ProsthesisCalibrateOptions) -> SoleCalibration:
    """The sole's numbers along the recorded poses; InputError where the keel finds no equilibrium."""
    stances = [each.stance for each in given.stances]
    try:
        with listener().stages("calibrating"):
            return calibrate(stances, given.foot, starts=o.starts, seed=o.seed, level=o.level)
    except ArithmeticError as error:
        remedy = "check height and pitch of the foot; the sole must press and not sink"
        raise InputError(o.markers, "", str(error), remedy) from error


def on_whole_model(
    given: FootOnPlate, found: SoleCalibration, o: ProsthesisCalibrateOptions
) -> WholeCalibration | None:
    """The numbers sought on with the whole model; None where that is not asked for."""
    if not o.full:
        return None
    machine_code = o.machine_code
    try:
        with listener().stages("calibrating on the whole model"):
            stances = [_along_limb(one, found, place, o) for place, one in enumerate(given.stances)]
            return calibrate_whole(stances, given.foot, found.at, level=o.level, machine_code=machine_code)
    except ArithmeticError as error:
        raise InputError(o.markers, "", str(error), "check `mass`, `side` and `axes`, or leave `full` out") from error


def _along_limb(one: StanceOnPlate, found: SoleCalibration, place: int, o: ProsthesisCalibrateOptions) -> WalkedStance:
    """One stance along the limb's own motion; ArithmeticError where it cannot be simulated."""
    if one.walked is None or one.fit is None:  # `full` reads them
        raise ValueError(f"{one.asked.markers}: no fit of the walk")
    limb = limb_on_sole(
        found,
        one.walked,
        one.seen,
        one.fit,
        cutoff=ANGLES_CUTOFF,
        gap_limit=o.gap_limit,
        turns=TURNS,
        place=place,
        machine_code=o.machine_code,
    )
    if not limb.settled:
        reserve(f"{one.asked.name}: {counted_twice(limb)}" if one.asked.name else counted_twice(limb))
    return along_limb(one.walked, limb)
