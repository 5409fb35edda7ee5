"""Stances of a study simulated in processes of their own, and how far each is from its plate."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.analyses.json_file import plain
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.read import StudiedStance
from geocontact.analyses.prosthesis.compare.result import ProsthesisCompareResult
from geocontact.analyses.prosthesis.compare.tables import ALL, errors_table, summary_table
from geocontact.analyses.prosthesis.simulate.run import simulated
from geocontact.analyses.prosthesis.socket_words import counted_twice
from geocontact.analyses.run_record import Record
from geocontact.analyses.workers import each
from geocontact.below_knee_prosthesis.evaluation.judged_stance import JudgedStance, judged
from geocontact.below_knee_prosthesis.evaluation.outliers import FEWEST, oddness, reasons
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.errors import InputError

WORDS = {"resultant": "resultant force", "cop_ground": "centre of pressure", "ankle_moment": "ankle moment"}
SAID = tuple(WORDS)
"""Quantities that are told in a sentence."""
PLAIN = ("mean of the others rmse", "another rmse")
"""Columns of both predictors without a model."""


def run(given: tuple[StudiedStance, ...], o: ProsthesisCompareOptions, record: Record) -> ProsthesisCompareResult:
    """Every stance that can be simulated; InputError where none can."""
    found: dict[str, Stance] = {}
    with record.listener.progress("stances", len(given)) as step:
        for one, became in each(_stance_of, given, o.workers):
            if isinstance(became, BaseException):
                raise became
            if isinstance(became, str):
                record.warn(f"{one.trial.name} is left out: {became}")
            else:
                found[one.trial.name] = became.stance
                if not became.settled:
                    record.warn(f"{one.trial.name}: {counted_twice(became)}")
            step()
    if not found:
        raise InputError(o.study, "[[trials]]", "no stance could be simulated", "look at one with prosthesis simulate")
    stances = tuple(_judged(one, found[one.trial.name]) for one in given if one.trial.name in found)
    transfer = [one for one in stances if not one.calibrated]
    odd = oddness({one.name: one.errors.table["resultant"][1] for one in transfer})
    result = ProsthesisCompareResult(
        record=record,
        options=o,
        stances=stances,
        sides={one.trial.name: one.person.side for one in given},
        odd=odd,
    )
    _say(result)
    return result


def _stance_of(one: StudiedStance) -> LimbInSocket | str:
    """A stance along the limb's motion, or why there is none; runs in a process of its own."""
    try:
        found = simulated(one.walk, one.asked)
    except InputError as error:
        return error.what
    return found if found.stance.on.any() else "the foot never touches the floor"


def _judged(one: StudiedStance, stance: Stance) -> JudgedStance:
    trial = one.trial
    return judged(trial.name, trial.person, trial.foot, stance, one.plate, calibrated=trial.calibrated)


def _say(r: ProsthesisCompareResult) -> None:
    record, stances = r.record, r.stances
    fitted = [one.name for one in stances if one.calibrated]
    transfer = len(stances) - len(fitted)
    persons, settings = (len({getattr(one, key) for one in stances}) for key in ("person", "setting"))
    record.say(
        f"{transfer} stances, {persons} person{'s'[: persons - 1]}, {settings} setting{'s'[: settings - 1]} of the foot"
        + (f", beside {len(fitted)} that a sole was fitted to: {', '.join(fitted)}" if fitted else "")
    )
    summary = summary_table(errors_table(stances))
    rows = summary[summary["setting"] == ALL].set_index("quantity")
    for name in SAID:
        if name in rows.index:
            record.say(_told(name, rows.loc[[name]].iloc[0]))
    told = list(dict.fromkeys(one.setting for one in stances if not one.calibrated))
    for setting in told if len(told) > 1 else ():
        own = summary[summary["setting"] == setting].set_index("quantity")
        record.say(f"{setting}: {'; '.join(_of_setting(name, own.loc[[name]].iloc[0]) for name in SAID)}")
    late = [one.errors.stance[0] - one.errors.stance[1] for one in stances if not one.calibrated]
    late = [each for each in late if np.isfinite(each)]
    turned = [one.stance.motion.leg.offset.given for one in stances]
    if any(turned):
        count = f"{sum(turned)} of {len(stances)} stances"
        record.say(f"height and pitch of the foot beside its standing trial are taken from the law on {count}")
    if late:
        record.say(f"stance longer than on the plate by {1e3 * np.mean(late):+.0f} ms (SD {1e3 * np.std(late):.0f} ms)")
    for one in stances:
        if np.isnan(one.errors.stance[0]):
            what = f"is simulated over {one.errors.simulated:.0%} of its stance, and ends before toe-off"
            record.warn(f"{one.name} {what}: no stance time of it, errors over that part")
        if (oddness_of := r.odd.get(one.name)) is not None and oddness_of.outlier:
            seen = "; ".join(reasons(one)) or "nothing that is looked at tells why"
            record.warn(f"{one.name} stands out with {one.errors.table['resultant'][1]:.1%} BW: {seen}")
    if transfer < FEWEST:
        record.warn(f"with {transfer} stances none can stand out: {FEWEST} are needed")
    record.results["compare"] = plain({one.name: _numbers(one) for one in stances})


def _of_setting(name: str, row: pd.Series) -> str:
    """Errors of the model and of both predictors."""
    plain_ones = [_size(name, row[column]) for column in PLAIN if np.isfinite(row[column])]
    beside = f" (without a model {' and '.join(plain_ones)})" if plain_ones else ""
    return f"{WORDS[name]} {_size(name, row['rmse'])}{beside}"


def _size(name: str, value: float) -> str:
    what = {"resultant": "BW", "cop_ground": "of the foot"}.get(name, "N m/kg")
    return f"{value:.2f} {what}" if name == "ankle_moment" else f"{value:.1%} {what}"


def _told(name: str, row: pd.Series) -> str:
    plain_words = ", ".join(
        f"{label} {_size(name, row[column])}"
        for label, column in zip(("mean of the others", "another setting"), PLAIN, strict=True)
        if np.isfinite(row[column])
    )
    beside = f"; without a model {plain_words}; better than both on {row['better']:.0f} of {row['trials']:.0f}"
    return f"{WORDS[name]}: R² {row['r2 [-]']:.2f}, {_size(name, row['rmse'])}{beside if plain_words else ''}"


def _numbers(one: JudgedStance) -> dict[str, object]:
    return {
        "calibrated": one.calibrated,
        "stance_s": one.errors.stance[0],
        "plate_stance_s": one.errors.stance[1],
        **{name: {"r2": r2, "rmse": off} for name, (r2, off) in one.errors.table.items()},
    }
