r"""Many stances beside their plates: `geocontact prosthesis compare`, `gc.prosthesis.compare`.

>>> import geocontact as gc
>>> from pathlib import Path
>>> trial = "meshes/gait_P1_medium_1/"
>>> text = f'[persons.P1]\nmass = {{ value = 77.3, unit = "kg" }}\nstatic = "{trial}standing.trc"\n'
>>> for name in ("low", "medium"):
...     place = f"meshes/gait_P1_{name}_1/"
...     text += f'[[trials]]\nname = "{name}"\nperson = "P1"\nsetting = "{name}"\nmarkers = "{place}walking.trc"\n'
...     text += f'plates = "{place}plates.mot"\nplate = "own_force"\nother_plate = "other_force"\n'
>>> _ = Path("study.toml").write_text(text)
>>> print("\n".join(gc.prosthesis.compare("study.toml", workers=1).sentences[:2]))
2 stances, 1 person, 2 settings of the foot
resultant force: R² 0.95, 6.4% BW; without a model mean of the others 11.2% BW, another setting 11.2% BW; better than
both on 2 of 2
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted, judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.frame.workers import each
from geocontact.analyses.prosthesis.compare.changes import change_words, changes_of, changes_table
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.show import comparison_curves, comparison_page
from geocontact.analyses.prosthesis.compare.stances import (
    ALL,
    LASTING,
    MOVED,
    StudiedStance,
    ensembles_table,
    errors_table,
    judged_stance,
    read,
    simulated_stance,
    summary_table,
    trials_table,
)
from geocontact.analyses.prosthesis.quantity_words import ASKED, NAMES, SAID, small_force
from geocontact.analyses.prosthesis.scores import OVER, SCORES
from geocontact.analyses.prosthesis.stance_files import (
    counted_twice,
    numbers_table,
    write_coordinates,
    write_loads,
    write_spheres,
)
from geocontact.below_knee_prosthesis.comparison import odd_stances
from geocontact.below_knee_prosthesis.evaluation import JudgedStance
from geocontact.below_knee_prosthesis.foot_numbers import numbers_of
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.marker_draws import MarkerBand
from geocontact.below_knee_prosthesis.outliers import FEWEST, Oddness, reasons
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.data.errors import InputError
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_low_r2, of_many_r2
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

TRIALS = "trials"
"""Folder with what other programs read, of each stance."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisCompareResult(Result):
    """Stances of a study beside their plates.

    Parameters
    ----------
    sides
        Of the prosthesis, by trial.
    odd
        How far each stance that nothing was fitted to stands out.
    bands
        How far errors of the markers move each stance, by trial; empty without draws.
    """

    spread_bands: ClassVar[bool] = True  # of the stances

    options: ProsthesisCompareOptions
    stances: tuple[JudgedStance, ...]
    sides: Mapping[str, Side]
    odd: Mapping[str, Oddness]
    bands: Mapping[str, MarkerBand]

    @property
    def rmse(self) -> dict[tuple[str, str], float]:
        """Root mean square error by trial and quantity [BW, share of the foot, N m/kg]."""
        return by_name(self.table("errors"), ("trial", "quantity"), "rmse")

    @property
    def r2(self) -> dict[tuple[str, str], float]:
        """Coefficient of determination by trial and quantity [-]."""
        table = self.table("errors")
        return dict(zip(zip(table["trial"], table["quantity"], strict=True), table["r2 [-]"], strict=True))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary` by setting, `trials`, `errors` of each, `ensembles`, `changes` between settings of a person."""
        errors = errors_table(self.stances)
        found = {
            "summary": summary_table(errors),
            "trials": trials_table(self.stances, self.odd, self.bands),
            "errors": errors,
            "ensembles": ensembles_table(self.stances),
        }
        changes = changes_table(changes_of(self.stances))
        return found if changes.empty else found | {"changes": changes}

    def curves(self) -> dict[str, CurveSheet]:
        """`ensembles`: means and bands over the stances of each setting."""
        return {"ensembles": comparison_curves(self.stances)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Ensembles, errors beside trivial predictors, outliers."""
        return {REPORT: comparison_page(self.stances, self.tables())}

    def write_files(self, folder: Path) -> None:
        """Coordinates, loads, spheres and numbers of each stance besides, as `prosthesis simulate` writes them."""
        for one in self.stances:
            place = folder / TRIALS / one.name
            place.mkdir(parents=True)
            write_coordinates(place, one.stance, self.sides[one.name])
            write_loads(place, one.stance, self.sides[one.name])
            write_spheres(place / "paraview", one.stance, self.sides[one.name])
            write_table(numbers_table(numbers_of(one.stance)), place, "numbers")
        super().write_files(folder)


WORDS = {name: NAMES[name] for name in SAID}
PLAIN = ("mean of the others rmse", "another rmse")
"""Columns of both predictors without a model."""


def run(given: tuple[StudiedStance, ...], o: ProsthesisCompareOptions) -> ProsthesisCompareResult:
    """Every stance that can be simulated; InputError where none can."""
    found: dict[str, Stance] = {}
    bands: dict[str, MarkerBand] = {}
    with listener().progress("stances", len(given)) as step:
        for one, became in each(simulated_stance, given, o.workers):
            if isinstance(became, BaseException):
                raise became
            if isinstance(became, str):
                reserve(f"{one.name} is left out: {became}")
            else:
                found[one.name] = became.limb.stance
                if became.no_band:
                    reserve(f"{one.name} has no band: {became.no_band}")
                if became.band is not None:
                    bands[one.name] = became.band
                if not became.limb.settled:
                    reserve(f"{one.name}: {counted_twice(became.limb)}")
            step()
    if not found:
        raise InputError(o.source, o.place, "no stance could be simulated", "look at one with prosthesis simulate")
    known = [(one, found[one.name]) for one in given if one.name in found]
    score = given[0].asked.score
    judge(against_the_plates(known, OVER[score]))
    stances = tuple(judged_stance(*pair, SCORES[score]) for pair in known)
    result = ProsthesisCompareResult(
        options=o,
        stances=stances,
        sides={one.name: one.asked.side for one in given},
        odd=odd_stances(stances),
        bands=bands,
    )
    _summarise(result)
    return result


def _summarise(r: ProsthesisCompareResult) -> None:
    """Sentences, reservations and results of a comparison."""
    stances = r.stances
    fitted = [one.name for one in stances if one.calibrated]
    transfer = len(stances) - len(fitted)
    persons, settings = (len({getattr(one, key) for one in stances}) for key in ("person", "setting"))
    say(
        f"{transfer} stances, {persons} person{'s'[: persons - 1]}, {settings} setting{'s'[: settings - 1]} of the foot"
        + (f", and {len(fitted)} that a sole was fitted to: {', '.join(fitted)}" if fitted else "")
    )
    summary = summary_table(errors_table(stances))
    rows = summary[summary["setting"] == ALL].set_index("quantity")
    for name in SAID:
        if name in rows.index:
            say(_over_all(name, rows.loc[[name]].iloc[0]))
    judged = list(dict.fromkeys(one.setting for one in stances if not one.calibrated))
    for setting in judged if len(judged) > 1 else ():
        own = summary[summary["setting"] == setting].set_index("quantity")
        say(f"{setting}: {'; '.join(_of_setting(name, own.loc[[name]].iloc[0]) for name in SAID)}")
    _say_changes(stances)
    turned = [one.stance.motion.leg.offset.given for one in stances]
    if any(turned):
        count = f"{sum(turned)} of {len(stances)} stances"
        say(f"height and pitch of the foot relative to its standing trial are taken from the law on {count}")
    _say_lasting(stances, summary)
    if r.bands:
        _say_moved(r)
    for one in stances:
        if (oddness_of := r.odd.get(one.name)) is not None and oddness_of.outlier:
            seen = "; ".join(reasons(one)) or "no checked cause explains it"
            reserve(f"{one.name} is an outlier with {one.errors.table['resultant'][1]:.1%} BW: {seen}")
    if transfer < FEWEST:
        reserve(f"with {counted(transfer, 'stance')} outliers cannot be detected: {FEWEST} are needed")
    for words in filter(None, (small_force(str(name), float(r2)) for name, r2 in rows["r2 [-]"].items())):
        reserve(words)
    note("compare", plain({one.name: _numbers(one) for one in stances}))


def _say_lasting(stances: Sequence[JudgedStance], summary: pd.DataFrame) -> None:
    """Length of the stances beside that on their plates, over all and by setting."""
    late = [one.errors.stance[0] - one.errors.stance[1] for one in stances if not one.calibrated]
    late = [each for each in late if np.isfinite(each)]
    if not late:
        return
    settings = list(dict.fromkeys(one.setting for one in stances if not one.calibrated))
    own = summary[summary["quantity"] == LASTING].set_index("setting")["difference"]
    each_own = "; " + ", ".join(f"{name} {1e3 * own[name]:+.0f}" for name in settings) + " ms" if settings[1:] else ""
    say(f"stance longer than on the plate by {1e3 * np.mean(late):+.0f} ms (SD {1e3 * np.std(late):.0f} ms){each_own}")


def _say_moved(r: ProsthesisCompareResult) -> None:
    """How far errors of the markers move the stances, and how much of the plates is within that."""
    table = r.table("trials")
    force, centre, within = (float(table[name].mean()) for name in MOVED)
    say(
        f"errors of the markers move the vertical force by ±{force:.1%} BW and the centre of pressure by "
        f"±{centre:.1%} of the foot (95 %, mean over the stances); the plates' force is within that for {within:.0%} "
        "of the stance"
    )


def against_the_plates(known: Sequence[tuple[StudiedStance, Stance]], over: str = "") -> GoodnessOfFit:
    """`goodness_of` over the stances alone, whatever is scored: swing agrees by itself."""
    return goodness_of([judged_stance(*pair) for pair in known], over)


def goodness_of(stances: Sequence[JudgedStance], over: str = "") -> GoodnessOfFit:
    """Force, centre of pressure and ankle moment of every stance against its plate, and stances that end too early.

    Stances that a sole was fitted to count as well: a fit may be wrong too. `over` follows the quantities' names.
    """
    doubts = list[Doubt]()
    for quantity in SAID:
        known = {one.name: one.errors.table[quantity][0] for one in stances if quantity in one.errors.table}
        found = list(of_many_r2(f"{NAMES[quantity]}{over}", known))
        found += [
            doubt
            for name, r2 in known.items()
            if r2 >= 0.0
            for doubt in of_low_r2(f"{name}, {NAMES[quantity]}{over}", r2)
        ]
        doubts += [replace(each, what=f"{each.what}: {ASKED}") for each in found]
    for one in stances:
        if np.isnan(one.errors.stance[0]):
            what = f"is simulated over {one.errors.simulated:.0%} of its stance, and ends before toe-off"
            doubts.append(Doubt(f"{one.name} {what}: no stance time, errors are for that part only", False))
    return GoodnessOfFit(tuple(doubts), tuple(f"{NAMES[name]}{over}" for name in SAID))


def _say_changes(stances: Sequence[JudgedStance]) -> None:
    """The widest change between settings, predicted and measured."""
    for line in change_words(changes_of(stances)):
        say(line)


def _of_setting(name: str, row: pd.Series) -> str:
    """Errors of the model and of both predictors."""
    plain_ones = [_size(name, row[column]) for column in PLAIN if np.isfinite(row[column])]
    beside = f" (without a model {' and '.join(plain_ones)})" if plain_ones else ""
    return f"{WORDS[name]} {_size(name, row['rmse'])}{beside}"


def _size(name: str, value: float) -> str:
    what = {"resultant": "BW", "cop_ground": "of the foot"}.get(name, "N m/kg")
    return f"{value:.2f} {what}" if name == "ankle_moment" else f"{value:.1%} {what}"


def _over_all(name: str, row: pd.Series) -> str:
    plain_words = ", ".join(
        f"{label} {_size(name, row[column])}"
        for label, column in zip(("mean of the others", "another setting"), PLAIN, strict=True)
        if np.isfinite(row[column])
    )
    beside = f"; without a model {plain_words}"
    if not contradicted():
        beside += f"; better than both on {row['better']:.0f} of {row['trials']:.0f}"
    return f"{WORDS[name]}: R² {row['r2 [-]']:.2f}, {_size(name, row['rmse'])}{beside if plain_words else ''}"


def _numbers(one: JudgedStance) -> dict[str, object]:
    return {
        "calibrated": one.calibrated,
        "stance_s": one.errors.stance[0],
        "plate_stance_s": one.errors.stance[1],
        **{name: {"r2": r2, "rmse": off} for name, (r2, off) in one.errors.table.items()},
    }


compare = Job("prosthesis compare", ProsthesisCompareOptions, read, run)
