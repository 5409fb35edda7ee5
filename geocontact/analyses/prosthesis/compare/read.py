"""What a comparison starts from: every stance of the study as a single simulation starts from it."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.motion.markers import unit_of_c3d
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.read import Walk, fitted_walk
from geocontact.analyses.prosthesis.simulate.read import read as read_walk
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.model.leg import RESIDUAL
from geocontact.below_knee_prosthesis.stance_errors import PlateStance
from geocontact.io.recordings.gait_study import GaitPerson, GaitStance, read_gait_study


@dataclass(frozen=True, eq=False)
class StudiedStance:
    """One stance of a study: as it is described, what a simulation of it is asked, and what its files hold."""

    trial: GaitStance
    person: GaitPerson
    asked: ProsthesisSimulateOptions
    walk: Walk
    plate: PlateStance


def read(o: ProsthesisCompareOptions, record: Record) -> tuple[StudiedStance, ...]:
    """Every stance; what is warned of several is warned once."""
    study = read_gait_study(o.study)
    record.add_input("study", o.study, trials=len(study.trials), persons=len(study.persons))
    return tuple(_stance(each, study.persons[each.person], o, record) for each in study.trials)


def _stance(trial: GaitStance, person: GaitPerson, o: ProsthesisCompareOptions, record: Record) -> StudiedStance:
    asked = _asked(trial, person, o)
    own = Record("prosthesis simulate", {})
    walk = fitted_walk(read_walk(asked, own), asked, own)
    for entry in own.inputs:
        record.inputs.append(entry | {"role": f"{trial.name} {entry['role']}"})
    for line in own.warnings:
        if not any(line in known for known in record.warnings):
            record.warn(f"{trial.name}: {line}")
    if walk.plate is None:  # every stance of a study names its plate
        raise ValueError(f"{trial.name}: no plate")
    return StudiedStance(trial, person, asked, walk, walk.plate)


def _asked(trial: GaitStance, person: GaitPerson, o: ProsthesisCompareOptions) -> ProsthesisSimulateOptions:
    return ProsthesisSimulateOptions(
        trial.markers,
        static=person.static,
        mass=person.mass,
        side=person.side,
        sex=person.sex,
        functional=person.functional,
        setting=trial.setting or "medium",
        fulcrum=trial.fulcrum,
        law=trial.law or person.law,
        ground=trial.ground,
        socket=o.socket,
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
    )
