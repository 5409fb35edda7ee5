"""Tables of a choice: designs, what was chosen, sensitivities, front, draws, certificates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.design.chosen import CertifiedDesign, DrawnGain
from geocontact.analyses.sit_to_stand.standing_tables import certificate_rows
from geocontact.standing_up.assistance.assisted_model import ASSISTED_PARAMETERS
from geocontact.standing_up.assistance.design import KNEE, NAMES
from geocontact.standing_up.assistance.peaks import MEASURES, UNITS
from geocontact.standing_up.assistance.room import ROOM


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
    """Of every movement."""
    rows = []
    for one in designs:
        names = [trial.recorded.name for trial in one.trials]
        rows += certificate_rows(one.name, names, [trial.judged for trial in one.trials])
    return pd.DataFrame(rows).rename(columns={"phase": "design"})
