"""Stances of a study: each as a single simulation starts from it, simulated, and all of them in tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import add_input, collecting, current, reserve
from geocontact.analyses.frame.record import Record
from geocontact.analyses.motion.checked_trial import check_apart
from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.analyses.person import name_unused, person_segments, unused_values
from geocontact.analyses.prosthesis.compare.earlier import AskedStance, simulated_before
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import RecordedWalk, band_of, simulated, walk_of
from geocontact.analyses.prosthesis.simulate.walk import read as read_walk
from geocontact.below_knee_prosthesis.comparison import against_predictors, by_setting_and_calibrated, ensembles
from geocontact.below_knee_prosthesis.evaluation import (
    ANKLE,
    ANOTHER,
    MEAN,
    OVER_STANCE,
    JudgedStance,
    PlateStance,
    Scoring,
    at_times,
    judged,
)
from geocontact.below_knee_prosthesis.leg import RESIDUAL
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand
from geocontact.below_knee_prosthesis.outliers import Oddness, reasons
from geocontact.below_knee_prosthesis.recorded_walk import Walk
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.body_segments import BodySegments
from geocontact.data.errors import InputError
from geocontact.io.recordings.gait_study import GaitPerson, GaitStance, read_gait_study


@dataclass(frozen=True, eq=False)
class StudiedStance(AskedStance):
    """One stance and what its files hold."""

    recorded: RecordedWalk
    walk: Walk
    plate: PlateStance


@dataclass(frozen=True, eq=False)
class SimulatedStance:
    """A stance along the limb's motion, and how far errors of the markers move it: None without draws, or where these
    failed for that reason.
    """

    limb: LimbInSocket
    band: MarkerBand | None
    no_band: str = ""


def read(o: ProsthesisCompareOptions) -> tuple[StudiedStance, ...]:
    """Every stance; what is warned of several is one line."""
    seen: dict[tuple[str, bool], list[str]] = {}
    asked = described(o) if o.study else simulated_before(o.runs)
    _require_each_once(asked, o)
    found = tuple(_stance(each, o, seen) for each in asked)
    files = {each.asked.motion.resolve(): each for each in found}
    check_apart({each.name: each.recorded.seen.positions for each in files.values()}, "one walk is counted as two")
    for (line, cause), names in seen.items():
        reserve(f"{_whose(names, len(found))}: {line}", cause=cause)
    return found


def _require_each_once(stances: Sequence[AskedStance], o: ProsthesisCompareOptions) -> None:
    """InputError for the stance on one plate twice: it would be among the others that it is compared with."""
    met: dict[tuple[Path, str], str] = {}
    for one in stances:
        plates, plate = cast(Path, one.asked.plates), cast(str, one.asked.plate)  # both are required
        first = met.setdefault((plates.resolve(), plate), one.name)
        if first != one.name:
            what = f"the stance of {first} and of {one.name} is the same one, on {plate} in {plates}"
            raise InputError(o.source, o.place, what, "give each stance on a plate once")


def _whose(names: Sequence[str], count: int) -> str:
    """The stance that a warning is of, or how many of all have it."""
    if len(names) == 1:
        return names[0]
    return f"all {count} stances" if len(names) == count else f"{len(names)} of {count} stances"


def _stance(one: AskedStance, o: ProsthesisCompareOptions, seen: dict[tuple[str, bool], list[str]]) -> StudiedStance:
    """One stance; its warnings, and whether inputs contradict each other in them, go into `seen` with its name."""
    asked = one.asked
    _require_setting(one, o)
    with collecting(Record("prosthesis simulate", {})) as own:
        recorded = read_walk(asked, one.segments)
        walk = walk_of(recorded, asked)
    for entry in own.inputs:
        current().inputs.append(entry | {"role": f"{one.name} {entry['role']}"})
    for line in own.warnings:
        said = line.replace("`", "")  # keys of the study, no options of this command
        seen.setdefault((said, line in own.causes), []).append(one.name)
    if walk.plate is None:  # every stance of a study names its plate
        raise ValueError(f"{one.name}: no plate")
    return StudiedStance(
        one.name, one.person, one.setting, one.calibrated, asked, one.segments, recorded, walk, walk.plate
    )


def described(o: ProsthesisCompareOptions) -> list[AskedStance]:
    """Stances of a study's description."""
    file = o.source
    study = read_gait_study(file)
    add_input("study", file, trials=len(study.trials), persons=len(study.persons))
    bodies = {
        name: person_segments(each.sex, each.age, each.mass, each.height, each.own, (file, f"[persons.{name}]"))
        for name, each in study.persons.items()
    }
    for name, each in study.persons.items():
        idle = unused_values(each, each.mass, _of_leg)
        name_unused((file, f"[persons.{name}]"), idle, "prosthesis compare")
    return [
        AskedStance(
            each.name,
            each.person,
            each.foot,
            each.calibrated,
            _asked(each, study.persons[each.person], o),
            bodies[each.person],
        )
        for each in study.trials
    ]


def _of_leg(segments: BodySegments) -> list[float]:
    """What the leg with the prosthesis takes of the segments; lengths are those of the markers."""
    thigh, shank = segments["thigh"], segments["shank"]
    return [thigh.mass, thigh.centre, *thigh.radii, shank.mass, shank.centre]


def _asked(trial: GaitStance, person: GaitPerson, o: ProsthesisCompareOptions) -> ProsthesisSimulateOptions:
    return ProsthesisSimulateOptions(
        trial.markers,
        static=person.static,
        mass=person.mass,
        side=person.side,
        sex=person.sex,
        age=person.age,
        functional=person.functional,
        foot=person.foot or o.foot,
        setting=trial.setting or "medium",
        fulcrum=trial.fulcrum,
        law=trial.law or person.law,
        ground=trial.ground,
        socket=o.socket,
        socket_numbers=person.socket or o.socket_numbers,
        score=o.score,
        walks=o.walks,
        marker_error=o.marker_error,
        seed=o.seed,
        plates=trial.plates,
        other_plate=trial.other_plate,
        plate=trial.plate,
        cutoff=o.cutoff,
        socket_turns=o.socket_turns,
        gap_limit=o.gap_limit,
        machine_code=o.machine_code,
        markers_map=o.markers_map,
        axes=o.axes,
        c3d_unit=unit_of_c3d(o.c3d_unit, trial.markers, trial.plates, person.static, person.functional),
        residual=RESIDUAL if person.residual is None else person.residual,
        residual_length=person.residual_length,
        residual_markers=person.residual_markers,
    )


def _require_setting(one: AskedStance, o: ProsthesisCompareOptions) -> None:
    """InputError with the trial's name for a setting or a fulcrum that its foot has not."""
    with collecting(Record("prosthesis simulate", {})):
        foot = foot_of(one.asked.foot)
    try:
        fulcrum_at(foot, one.asked.setting, one.asked.fulcrum)
    except InputError as error:
        raise replace(error, file=o.source, place=f"{o.place} {one.name} {error.place.strip('`')}") from error


def simulated_stance(one: StudiedStance) -> SimulatedStance | str:
    """A stance along the limb's motion, or why there is none; runs in a process of its own."""
    try:
        limb = simulated(one.walk, one.asked)
        if not limb.stance.on.any():
            return "the foot never touches the floor"
    except InputError as error:
        return error.what
    try:
        return SimulatedStance(limb, band_of(one.recorded, limb.stance, one.asked))
    except InputError as error:
        return SimulatedStance(limb, None, error.what)


def judged_stance(one: StudiedStance, stance: Stance, scoring: Scoring = OVER_STANCE) -> JudgedStance:
    """A simulated stance beside its plate."""
    return judged(one.name, one.person, one.setting, stance, one.plate, calibrated=one.calibrated, scoring=scoring)


ALL = "all"
UNITS = {"impulse": "s", ANKLE: "N m/kg"}
"""Units of quantities that are no shares: forces are over body weight, centres over the foot's length."""


def errors_table(stances: Sequence[JudgedStance]) -> pd.DataFrame:
    """One row for each stance and quantity: the model's R² and error, and those of both trivial predictors."""
    rows = []
    for each in against_predictors(stances):
        one, name = each.stance, each.quantity
        row: dict[str, object] = {
            "trial": one.name,
            "person": one.person,
            "setting": one.setting,
            "calibrated": one.calibrated,
            "quantity": name,
            "unit": UNITS.get(name, "-"),
            "r2 [-]": each.r2,
            "rmse": each.rmse,
        }
        for label, column in ((MEAN, MEAN), (ANOTHER, "another")):
            own = each.plain.get(label)
            row[f"{column} r2 [-]"] = np.nan if own is None else own.r2
            row[f"{column} rmse"] = np.nan if own is None else own.rmsd
        row["better"] = np.nan if each.better is None else each.better
        rows.append(row)
    rows += [_lasting(one) for one in stances]
    return pd.DataFrame(rows)


LASTING = "stance"
"""Quantity of the rows on how long a stance lasts: simulated less measured, and the size of that as its error."""


def _lasting(one: JudgedStance) -> dict[str, object]:
    """Length of one stance beside that on its plate [s]; no predictor without a model has one of its own."""
    late = one.errors.stance[0] - one.errors.stance[1]
    own = {"trial": one.name, "person": one.person, "setting": one.setting, "calibrated": one.calibrated}
    return own | {"quantity": LASTING, "unit": "s", "rmse": abs(late), "difference": late}


def summary_table(errors: pd.DataFrame) -> pd.DataFrame:
    """Means and standard deviations by setting and over all, as the study's table 3; calibrated stances apart."""
    rows = []
    names = (
        "r2 [-]",
        "rmse",
        "difference",
        *(f"{label} {kind}" for label in (MEAN, "another") for kind in ("rmse", "r2 [-]")),
    )
    for calibrated, part in errors.groupby("calibrated", sort=False):
        settings = list(dict.fromkeys(part["setting"]))
        for setting in [*settings, ALL] if not calibrated else ["calibrated"]:
            own = part if setting in (ALL, "calibrated") else part[part["setting"] == setting]
            for quantity, group in own.groupby("quantity", sort=False):
                numbers: dict[str, float] = {}
                for name in names:
                    numbers[name] = float(group[name].mean())
                    if name in names[:3]:
                        spread = float(group[name].std(ddof=1)) if len(group) > 1 else np.nan
                        numbers[f"{name.partition(' ')[0]} sd"] = spread
                better = group["better"].dropna()
                told = {"setting": setting, "quantity": quantity, "unit": group["unit"].iloc[0]}
                won = int(better.astype(bool).sum()) if quantity != LASTING else np.nan
                rows.append({**told, **numbers, "better": won, "trials": len(group)})
    return pd.DataFrame(rows)


def trials_table(
    stances: Sequence[JudgedStance], odd: Mapping[str, Oddness], bands: Mapping[str, MarkerBand]
) -> pd.DataFrame:
    """One row for each stance: its length, peaks, how far it stands out, what is seen in it, and with draws of the
    markers' errors how far these move it.
    """
    rows = []
    for one in stances:
        own = odd.get(one.name, Oddness(float("nan"), float("nan")))
        model, seen = one.simulated(ANKLE), one.measured(ANKLE)
        rows.append(
            {
                "trial": one.name,
                "person": one.person,
                "setting": one.setting,
                "calibrated": one.calibrated,
                "fulcrum [mm]": 1e3 * one.stance.fulcrum,
                "foot height [mm]": 1e3 * one.stance.motion.leg.offset.height,
                "foot pitch [deg]": float(np.degrees(one.stance.motion.leg.offset.pitch)),
                "stance [s]": one.errors.stance[0],
                "stance on the plate [s]": one.errors.stance[1],
                "most vertical [-]": float(np.nanmax(one.simulated("vertical"))),
                "most vertical on the plate [-]": float(one.measured("vertical").max()),
                "most ankle moment [N m/kg]": float(np.nanmax(model)),
                "most ankle moment on the plate [N m/kg]": float(seen.max()),
                "resultant rmse [-]": one.errors.table["resultant"][1],
                **(moved_by_markers(one, bands.get(one.name)) if bands else {}),
                "off by the study's rule [-]": own.by_study,
                "off by the median [-]": own.by_median,
                "outlier": own.outlier,
                "what is seen": "; ".join(reasons(one)),
            }
        )
    return pd.DataFrame(rows)


MOVED = ("vertical moved by markers [-]", "centre moved by markers [-]", "plate within that [-]")
"""Columns on errors of the markers."""


def moved_by_markers(one: JudgedStance, band: MarkerBand | None) -> dict[str, float]:
    """Half widths of the band of 95 % while the foot is loaded, and how much of the plate's force is within it; NaN
    without a band.
    """
    if band is None:
        return dict.fromkeys(MOVED, np.nan)
    s = one.stance
    weight = s.motion.leg.person.mass * GRAVITY
    seen = at_times(s.time, one.plate.time, one.plate.force)[:, 1] / weight
    found = band.width("vertical", s.on), band.width("cop_ground", s.on), band.inside("vertical", seen, s.on)
    return dict(zip(MOVED, found, strict=True))


def ensembles_table(stances: Sequence[JudgedStance]) -> pd.DataFrame:
    """Mean and standard deviation over the stances of each setting at 101 points: simulated, measured, without a model.

    The predictors without a model are those of `comparison.plain_curves`, meant over the same stances.
    """
    frames, own = [], by_setting_and_calibrated(stances)
    for setting, found in ensembles(stances).items():
        columns: dict[str, object] = {"setting": setting, "stance [-]": own[setting][0].errors.share}
        for one in found:
            unit = UNITS.get(one.quantity, "-")
            columns |= {f"{one.label} [{unit}]": one.mean, f"{one.label} sd [{unit}]": one.sd}
        frames.append(pd.DataFrame(columns))
    return pd.concat(frames, ignore_index=True)
