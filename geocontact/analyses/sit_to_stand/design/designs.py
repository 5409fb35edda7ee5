"""Trials whose movement is to be the same, as they are read, and tables of the exoskeletons chosen for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_straps
from geocontact.analyses.sit_to_stand.standing_trials import refuse_stances, standing_trials
from geocontact.analyses.sit_to_stand.trial_tables import certificate_rows
from geocontact.data.errors import InputError
from geocontact.io.recordings.spheres import read_contact_intervals, read_contact_parameters
from geocontact.standing_up.assistance_design import KNEE, NAMES
from geocontact.standing_up.assistance_room import ROOM
from geocontact.standing_up.assisted_model import ASSISTANCE_PARAMETERS, EVERY_ASSISTED, assisted_parameters
from geocontact.standing_up.assisted_movement import UNITS
from geocontact.standing_up.help_search import CertifiedDesign, DrawnGain
from geocontact.standing_up.prediction import contact_parameters
from geocontact.standing_up.strap_sites import ContactParameter, deviations, searched
from geocontact.standing_up.trials import SHIPPED, StandingUpTrials

PERSONS = ("share", "timing")
FURTHER = ("shank", "pelvis")
"""What is chosen of no strap; sites besides the thigh."""
LEVEL = 0.95
"""Probability of a calibration's intervals."""


@dataclass(frozen=True, eq=False)
class TrialsToHelp:
    """Trials whose movement is to be the same.

    Parameters
    ----------
    p
        What is searched of all parameters of the assisted model, help as it usually is.
    sd
        Standard deviations of those that the calibration has intervals of, 0 for the others.
    """

    trials: StandingUpTrials
    p: Float[np.ndarray, " p"]
    sd: Float[np.ndarray, " p"]


def read(o: StandingDesignOptions) -> TrialsToHelp:
    """Everything the options name; InputError where no exoskeleton is worn or draws lack intervals."""
    trials = standing_trials(o.study, "study", o.c3d_unit, o.axes, o.device)
    refuse_stances(trials, o.study)
    if not trials.exoskeleton:
        what, remedy = "is not of a person with an exoskeleton", "write exoskeleton = true, and torques and strap"
        raise InputError(o.study, "", what, remedy)
    if trials.weights != SHIPPED:
        reserve(f"{o.study.name}: [weights] are those of calibrations and predictions: a design has its own")
    known = contact_parameters(trials.sites)
    names = {each.name for each in known}
    odd = [name for name in o.varied if name not in PERSONS and ROOM[name][0] not in names]
    odd += [o.aim] if o.aim in FURTHER and o.aim not in [site.name for site in trials.sites] else []
    if odd:
        site = odd[0].partition("_")[0]
        what = f"{odd[0]!r} is of a strap at the {site}, and no trial of {o.study.name} has one"
        raise InputError("", "`vary`, `aim`", what, f"name its force as strap_{site}, or leave it out")
    if trials.seated:
        remedy = "leave sitting out: a movement that is kept begins at seat-off"
        raise InputError(o.study, "sitting", "has no effect on a design", remedy)
    bounds = {each.name: (each.least, each.most) for each in known}
    values = read_contact_parameters(o.parameters, {each.name: each.unit for each in known}, bounds)
    ends = read_contact_intervals(o.parameters, values)
    add_input("`parameters`", o.parameters, parameters=len(values))
    doubt_straps(o.study, trials, values)
    if o.draws and not ends:
        remedy = "give parameters.csv of a calibration, or no draws"
        raise InputError(o.parameters, "lower, upper", "has no intervals to draw from", remedy)
    every = assisted_parameters(trials.sites)
    p = searched(every, [values.get(each.name, each.usual) for each in every])
    return TrialsToHelp(trials, p, deviations(every, ends, LEVEL))


def in_units(one: CertifiedDesign) -> list[tuple[str, float, str]]:
    """Name, value and unit of what was sought."""
    if one.design is None:
        return []
    each = [(name, EVERY_ASSISTED[k]) for name, k in zip(one.design.task.vary, one.design.task.index, strict=True)]
    p = one.movement.found.p
    return [(name, of.value(float(p[NAMES.index(of.name)])), "" if of.unit == "-" else of.unit) for name, of in each]


def designs_table(designs: Sequence[CertifiedDesign]) -> pd.DataFrame:
    """One row for each: all that can be chosen, smooth peaks, true peaks (largest), and the certificate."""
    without = designs[0].movement.asked
    further = [site for site in FURTHER if site in without.measures]
    room = {name: of for name, of in ROOM.items() if not name.startswith(FURTHER) or name.startswith(tuple(further))}
    rows = []
    for one in designs:
        p, asked = one.movement.found.p, one.movement.asked
        row: dict[str, object] = {"design": one.name, "limit of the knee [-]": one.limit}
        for name, (parameter, _, _) in room.items():
            of = EVERY_ASSISTED[NAMES.index(parameter)]
            unit, factor = ("mm", 1e3) if of.unit == "m" else (of.unit, 1.0)
            row[f"{name} [{unit}]"] = factor * of.value(float(p[NAMES.index(parameter)]))
        for measure in asked.measures:
            row[f"{measure} [{UNITS[measure]}]"] = asked.at(measure)
            row[f"largest {measure} [{UNITS[measure]}]"] = asked.largest_at(measure)
        row["knee of without help [-]"] = float(asked.largest[KNEE] / without.largest[KNEE])
        row["smooth knee of without help [-]"] = float(asked.sizes[KNEE] / without.sizes[KNEE])
        row["price [1/(N m)]"] = np.nan if one.design is None else one.design.price
        row["found"] = "-" if one.design is None else "yes" if one.design.met else "no"
        row["certified"] = "yes" if one.certified else "no"
        rows.append(row)
    return pd.DataFrame(rows)


def chosen_table(best: CertifiedDesign) -> pd.DataFrame:
    """What was sought, within which room, and whether it ended on an end of it."""
    if best.design is None:
        raise ValueError("nothing was chosen")
    rows = []
    for (name, value, unit), end in zip(in_units(best), best.design.on_end, strict=True):
        _, least, most = ROOM[name]
        told = {"name": name, "unit": unit or "-", "value": value, "least": least, "most": most}
        rows.append({**told, "where": "at the end" if end else "inside"})
    return pd.DataFrame(rows)


def sensitivity_table(best: CertifiedDesign, given: TrialsToHelp) -> pd.DataFrame:
    """How the least aim changes with every number that is held, and with the limit of the knee."""
    if best.design is None:
        raise ValueError("nothing was chosen")
    task, sd, rows = best.design.task, given.sd, []
    there = {each.name for each in (*contact_parameters(given.trials.sites), *ASSISTANCE_PARAMETERS)}
    for k, of in enumerate(assisted_parameters(given.trials.sites)):
        if k not in task.index and of.name in there:
            slope = float(best.design.slopes[k])
            per = "1 of the logarithm" if of.logarithm else f"1 {of.unit}" if of.unit != "-" else "1"
            told = {"number": of.name, "per": per, f"change [{UNITS[task.aim]}]": slope}
            by_sd = {"sd": sd[k] or np.nan, "change by one sd": slope * sd[k] or np.nan}
            step, size = _step(of)
            rows.append({**told, **by_sd, "step": step, f"change by a step [{UNITS[task.aim]}]": slope * size})
    told = {"number": "limit of the knee", "per": "1 N m", f"change [{UNITS[task.aim]}]": -best.design.price}
    step_of_limit = {"step": "+1 N m", f"change by a step [{UNITS[task.aim]}]": -best.design.price}
    rows.append({**told, "sd": np.nan, "change by one sd": np.nan, **step_of_limit})
    return pd.DataFrame(rows)


def _step(of: ContactParameter) -> tuple[str, float]:
    """A step that somebody might take of a number, and its size in what is searched: 10 %, 1 mm, 0.01."""
    if of.logarithm:
        return "+10 %", float(np.log(1.1))
    return {"m": ("+1 mm", 1e-3), "-": ("+0.01", 0.01)}.get(of.unit, (f"+1 {of.unit}", 1.0))


def draws_table(draws: Sequence[DrawnGain], aim: str) -> pd.DataFrame:
    """The aim with each drawn set by what is compared with and by what was chosen."""
    unit = UNITS[aim]
    rows = [
        {
            "draw": k + 1,
            f"compared with [{unit}]": each.reference,
            f"chosen [{unit}]": each.chosen,
            "knee [N m]": each.knee,
            "gain [-]": each.gain,
            f"largest compared with [{unit}]": each.largest_reference,
            f"largest chosen [{unit}]": each.largest_chosen,
            "largest knee [N m]": each.largest_knee,
        }
        for k, each in enumerate(draws)
    ]
    columns = ["draw", f"compared with [{unit}]", f"chosen [{unit}]", "knee [N m]", "gain [-]"]
    columns += [f"largest {name} [{unit}]" for name in ("compared with", "chosen")]
    return pd.DataFrame(rows, columns=[*columns, "largest knee [N m]"])


def certificates_table(designs: Sequence[CertifiedDesign]) -> pd.DataFrame:
    """What lies between and beyond the points of every movement."""
    rows = []
    for one in designs:
        names = [trial.recorded.name for trial in one.trials]
        rows += certificate_rows(one.name, names, [trial.judged for trial in one.trials])
    return pd.DataFrame(rows).rename(columns={"phase": "design"})
