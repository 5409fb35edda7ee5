"""Exoskeletons with their certified movements, what draws make of the gain, and tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.trial_result import FROM_FILE, TrialResult, certificate_rows
from geocontact.standing_up.assistance_design import KNEE, NAMES, HelpDesign
from geocontact.standing_up.assistance_room import ROOM
from geocontact.standing_up.assisted_model import ASSISTED_PARAMETERS, AssistedModel, HabitSizes
from geocontact.standing_up.assisted_movement import MEASURES, UNITS, Movement
from geocontact.standing_up.numbers_that_ran import Ran, model_numbers, parameter_numbers, search_numbers
from geocontact.standing_up.trials import StandingTrial

WORN, ALONE, BEST, ROBUST = "without help", "share alone", "chosen", "chosen for the draws"


@dataclass(frozen=True, eq=False)
class CertifiedDesign:
    """One exoskeleton and the movement with it.

    Parameters
    ----------
    name
        As tables call it.
    limit
        Of the knee's true peak, as part of that without help; not a number without a limit.
    design
        None where nothing was sought.
    trials
        By the calibrated parameters.
    """

    name: str
    limit: float
    design: HelpDesign | None
    movement: Movement
    trials: tuple[TrialResult, ...]

    @property
    def certified(self) -> bool:
        """Whether every movement is."""
        seen = [trial.judged.certificate for trial in self.trials]
        return all(each is not None and each.converged for each in seen)


@dataclass(frozen=True, eq=False)
class DrawnGain:
    """The aim with one drawn set of parameters, by the exoskeleton that is compared with and by the chosen one.

    Parameters
    ----------
    reference, chosen, knee
        Smooth peaks, or mean energy, and the knee's torque with the chosen one.
    largest_reference, largest_chosen, largest_knee
        True peaks.
    """

    reference: float
    chosen: float
    knee: float
    largest_reference: float
    largest_chosen: float
    largest_knee: float

    @property
    def gain(self) -> float:
        """Part of the reference that is saved."""
        return 1.0 - self.chosen / self.reference


def gain_interval(draws: tuple[DrawnGain, ...], level: float = 0.95) -> tuple[float, float]:
    """In which the gain of another draw lies, by Student's distribution; not numbers for fewer than two."""
    if len(draws) < 2:
        return float("nan"), float("nan")
    from scipy.stats import t

    gains: Float[np.ndarray, " d"] = np.array([each.gain for each in draws])
    reach = float(t.ppf(0.5 + 0.5 * level, len(gains) - 1) * gains.std(ddof=1) * np.sqrt(1.0 + 1.0 / len(gains)))
    return float(gains.mean()) - reach, float(gains.mean()) + reach


def in_units(one: CertifiedDesign) -> list[tuple[str, float, str]]:
    """Name, value and unit of what was sought."""
    if one.design is None:
        return []
    each = [(name, ASSISTED_PARAMETERS[k]) for name, k in zip(one.design.task.vary, one.design.task.index, strict=True)]
    p = one.movement.found.p
    return [(name, of.value(float(p[NAMES.index(of.name)])), "" if of.unit == "-" else of.unit) for name, of in each]


def designs_table(designs: Sequence[CertifiedDesign]) -> pd.DataFrame:
    """One row for each: all that can be chosen, smooth peaks, true peaks (largest), and the certificate."""
    without = designs[0].movement.asked
    rows = []
    for one in designs:
        p, asked = one.movement.found.p, one.movement.asked
        row: dict[str, object] = {"design": one.name, "limit of the knee [-]": one.limit}
        for name, (parameter, _, _) in ROOM.items():
            of = ASSISTED_PARAMETERS[NAMES.index(parameter)]
            unit, factor = ("mm", 1e3) if of.unit == "m" else (of.unit, 1.0)
            row[f"{name} [{unit}]"] = factor * of.value(float(p[NAMES.index(parameter)]))
        for k, measure in enumerate(MEASURES):
            row[f"{measure} [{UNITS[measure]}]"] = float(asked.sizes[k])
            row[f"largest {measure} [{UNITS[measure]}]"] = float(asked.largest[k])
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


def sensitivity_table(best: CertifiedDesign, sd: Float[np.ndarray, " p"]) -> pd.DataFrame:
    """How the least aim changes with every number that is held, and with the limit of the knee."""
    if best.design is None:
        raise ValueError("nothing was chosen")
    task, rows = best.design.task, []
    for k, of in enumerate(ASSISTED_PARAMETERS):
        if k not in task.index:
            slope = float(best.design.slopes[k])
            per = "1 of the logarithm" if of.logarithm else f"1 {of.unit}" if of.unit != "-" else "1"
            told = {"number": of.name, "per": per, f"change [{UNITS[task.aim]}]": slope}
            rows.append({**told, "sd": sd[k] or np.nan, "change by one sd": slope * sd[k] or np.nan})
    told = {"number": "limit of the knee", "per": "1 N m", f"change [{UNITS[task.aim]}]": -best.design.price}
    rows.append({**told, "sd": np.nan, "change by one sd": np.nan})
    return pd.DataFrame(rows)


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


def design_numbers(
    model: AssistedModel, designs: Sequence[CertifiedDesign], trials: Sequence[StandingTrial]
) -> list[Ran]:
    """Model, held parameters and the movement's cost once; what may vary and the meshes for each design."""
    first = designs[0].movement
    chosen = {parameter for parameter, _, _ in ROOM.values()}
    rows = model_numbers(model.standing)
    rows.append(Ran("help width", model.width, "-", "invented", "of the help, in parts of the movement"))
    held = parameter_numbers(ASSISTED_PARAMETERS, first.found.p, note=FROM_FILE)
    rows += [row for row in held if row.number not in chosen]
    rows += [*_habit(first.sizes)]
    rows.append(Ran("peak order", float(first.asked.order), "-", "invented", "of the norm that smooths peaks"))
    rows.append(Ran("peak places", float(first.asked.places), "-", "invented", "of an interval, for true peaks"))
    for one in designs:
        prefix = f"{one.name} "
        own = parameter_numbers(ASSISTED_PARAMETERS, one.movement.found.p, note="as chosen, or as given", prefix=prefix)
        rows += [row for row in own if row.number.removeprefix(prefix) in chosen]
        if one.design is not None:
            note = "true peak of the person's knee torque at most"
            rows.append(Ran(f"{prefix}limit of the knee", one.design.task.knee, "N m", "derived", note))
        rows += search_numbers(one.movement.found.motions, trials, prefix)
    return rows


def _habit(sizes: HabitSizes) -> list[Ran]:
    units = {"place": "m", "turn": "rad", "lean": "rad", "jerk": "(m/s^3)^-2 and (rad/s^3)^-2", "torque": "1/(N m)^2"}
    counts = dict.fromkeys(("place", "turn", "lean"), "deviation that counts as 1")
    rows = [
        Ran(f"habit {name}", getattr(sizes, name), unit, "invented", counts.get(name, "weight of the square"))
        for name, unit in units.items()
    ]
    note = "of the polynomials through the recorded coordinates"
    return [*rows, Ran("habit degree", float(sizes.degree), "-", "invented", note)]
