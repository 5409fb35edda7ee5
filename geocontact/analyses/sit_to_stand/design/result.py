"""An exoskeleton chosen for standing up: `geocontact sit-to-stand design`, `gc.sit_to_stand.design`.

>>> import geocontact as gc
>>> held_out, planted = "meshes/standing_up_held_out/study.toml", "meshes/standing_up_exoskeleton/truth.csv"
>>> result = gc.sit_to_stand.design(held_out, parameters=planted, vary="share", nodes=5)
>>> print(result.sentences[0])
peak force of the strap, smooth: without help … N, chosen … N
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import contradicted, judge, listener, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.main_numbers import by_name
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.design.answer import AnsweredDesign, answer, at_bounds, tiles
from geocontact.analyses.sit_to_stand.design.designs import (
    TrialsToHelp,
    certificates_table,
    chosen_table,
    designs_table,
    draws_table,
    in_units,
    read,
    sensitivity_table,
)
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.design.show import choice_page, design_curves
from geocontact.analyses.sit_to_stand.exports import write_motion, write_standing_model
from geocontact.analyses.sit_to_stand.goodness import goodness_of_movement
from geocontact.analyses.sit_to_stand.trial_tables import mesh_table, not_certified, ran_table
from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.solve import SolverOptions, stopped_by_ctrl_c
from geocontact.standing_up.assistance_room import ROOM
from geocontact.standing_up.assisted_model import AssistedModel
from geocontact.standing_up.assisted_movement import UNITS, StoppedByHandError
from geocontact.standing_up.help_search import (
    ROBUST,
    WORN,
    CertifiedDesign,
    DrawnGain,
    HelpSearch,
    HelpSettings,
    NoMovementError,
    design_numbers,
    gain_interval,
)

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

TOLERANCE = 1e-8
PARTS = {"share": "of the person's knee torque", "timing": "of the movement"}
"""What numbers without a unit are parts of."""
AIMS = {
    "strap": ("peak force of the strap", "smooth", "true"),
    "energy": ("energy of the strap", "mean", "largest"),
    "shank": ("peak force of the strap at the shank", "smooth", "true"),
    "pelvis": ("peak force of the strap at the pelvis", "smooth", "true"),
}
"""What is least, how it is measured, and what is said beside it."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingDesignResult(Result):
    """Exoskeletons for one person.

    Parameters
    ----------
    model
        What moved.
    designs
        Without help, share alone, chosen, and chosen for the draws where that was asked for.
    front
        Best ones at further limits of the knee, the loosest first.
    draws
        What the gain is with drawn parameters.
    """

    claims: ClassVar[frozenset[str]] = frozenset(("certified",))

    options: StandingDesignOptions
    given: TrialsToHelp
    model: AssistedModel
    designs: tuple[CertifiedDesign, ...]
    front: tuple[CertifiedDesign, ...]
    draws: tuple[DrawnGain, ...]

    @property
    def best(self) -> CertifiedDesign:
        """The last that was chosen."""
        return self.designs[-1]

    @property
    def reference(self) -> CertifiedDesign:
        """What the gain is relative to: share alone, or no help where nothing else was sought."""
        return self.designs[1] if len(self.designs) > 2 else self.designs[0]

    @property
    def gain(self) -> float:
        """Part of the reference's aim that is saved [-]."""
        aim = self.options.aim
        return 1.0 - self.best.movement.asked.at(aim) / self.reference.movement.asked.at(aim)

    @property
    def true_gain(self) -> float:
        """The same of true peaks, or of the largest energy [-]."""
        aim = self.options.aim
        return 1.0 - self.best.movement.asked.largest_at(aim) / self.reference.movement.asked.largest_at(aim)

    @property
    def accepted(self) -> bool:
        """Whether every search found its answer, none was left out, and every motion is certified."""
        each, o = (*self.designs, *self.front), self.options
        wanted = (2 if o.varied == ("share",) else 3) + int(o.robust) + o.front
        return len(each) == wanted and all(one.certified and (one.design is None or one.design.met) for one in each)

    @property
    def chosen(self) -> dict[str, float]:
        """Value of each thing that was varied, at the best design [SI unit of each]."""
        return by_name(self.table("chosen"), ("name",), "value")

    def tables(self) -> dict[str, pd.DataFrame]:
        """`designs`, `chosen`, `sensitivity`, `certificate`, `numbers`, `mesh`; `front` and `draws` if asked for."""
        every = (*self.designs, *self.front)
        found = {
            "designs": designs_table(self.designs),
            "chosen": chosen_table(self.best),
            "sensitivity": sensitivity_table(self.best, self.given),
            "certificate": certificates_table(every),
            "numbers": ran_table(design_numbers(self.model, every, self.given.trials.trials)),
            "mesh": mesh_table("design", [(one.name, one.movement.found.motions) for one in every]),
        }
        if self.front:
            found["front"] = designs_table((self.designs[0], *self.front, self.best))
        if self.draws:
            found["draws"] = draws_table(self.draws, self.options.aim)
        return found

    def curves(self) -> dict[str, CurveSheet]:
        """`design`: strap and knee over the movement, and the front."""
        return {"design": design_curves(self.designs, self.front, self.options.aim)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The chosen exoskeleton moving, curves of all, tables."""
        subject, curves = self.given.trials.subject, self.curves()["design"]
        what, unit = AIMS[self.options.aim][0], UNITS[self.options.aim]
        known = self.answered(self.designs)
        said = [*(answer(what, unit, known, self.answered(self.front)) if self.fits else ()), *self.sentences]
        facts = tiles(what, unit, known, in_units(self.best)) if self.fits else []
        return {REPORT: choice_page(said, facts, subject, self.designs, curves, self.tables())}

    def answered(self, designs: Sequence[CertifiedDesign]) -> list[AnsweredDesign]:
        """Aim (smooth) and knee (true) of designs."""
        aim, peak = self.options.aim, self.designs[0].movement.asked.largest_at("knee")
        return [
            AnsweredDesign(
                one.name,
                one.limit,
                one.movement.asked.at(aim),
                one.movement.asked.largest_at("knee") / peak,
            )
            for one in designs
        ]

    def write_files(self, folder: Path) -> None:
        """Trajectories and model; tables, figure, page."""
        p = self.best.movement.found.p
        values = {of.name: of.value(float(value)) for of, value in zip(self.model.standing.parameters, p, strict=True)}
        subject, sites = self.given.trials.subject, self.given.trials.sites
        for trial in self.best.trials:
            write_motion(folder, subject, trial, values, self.best.movement.found.solved, sites)
        write_standing_model(folder / "model.osim", subject, values, worn=True, sites=sites)
        super().write_files(folder)


def run(given: TrialsToHelp, o: StandingDesignOptions) -> StandingDesignResult:
    """Every design; InputError where the person does not stand up with the given parameters.

    Ctrl-C ends the search: what was found until then is the result. KeyboardInterrupt where nothing was.
    """
    settings = HelpSettings(o.varied, o.aim, o.knee, o.nodes, o.draws, o.seed)
    options = SolverOptions("radau", o.degree, 1, TOLERANCE, o.iterations, o.time_limit)
    with listener().stages("choosing") as stage:
        kept = given.trials
        search = HelpSearch(kept.subject, kept.trials, given.p, given.sd, settings, options, stage, kept.sites)
        with stopped_by_ctrl_c(search), _in_terms_of(o):
            worn = search.worn()
            designs = [worn, *search.chosen(worn, robust=o.robust)]
            front = search.front(worn, next(one for one in designs[::-1] if one.name != ROBUST), o.front)
            draws = search.drawn(designs)
    result = StandingDesignResult(
        options=o, given=given, model=search.model, designs=tuple(designs), front=front, draws=draws
    )
    doubt(result, stopped=search.stop)
    judge(goodness_of_movement(result.designs[0].trials, given.trials.noise))
    _report(result, search.movements.solved, search.movements.seconds)
    return result


@contextmanager
def _in_terms_of(o: StandingDesignOptions) -> Iterator[None]:
    """InputError for parameters or designs without a movement, KeyboardInterrupt where nothing is there to keep."""
    try:
        yield
    except StoppedByHandError as error:
        raise KeyboardInterrupt from error
    except NoMovementError as error:
        if error.design == WORN:
            remedy = "check that they are of this person"
            raise InputError(o.parameters, "", f"standing up fails with these: {error}", remedy) from error
        remedy = "vary less, or give more `nodes`"
        raise InputError("", f"`vary`, {error.design}", f"no movement was computed: {error}", remedy) from error


def doubt(r: StandingDesignResult, *, stopped: bool) -> None:
    """Searches without an answer, movements without a certificate, numbers at the end of what can be built.

    `stopped` by Ctrl-C: what was not begun is missing.
    """
    if stopped:
        reserve(f"interrupted after {r.best.name}: the last iterate is saved, and later results are missing")
    for one in (*r.designs, *r.front):
        if one.design is not None and not one.design.met and not one.design.stopped:
            reserve(f"{one.name}: {one.design.ending}; the varied quantities may not reach the knee's limit")
        for trial in one.trials:
            seen = trial.judged.certificate
            if seen is not None and not seen.converged:
                reserve(not_certified(f"{trial.recorded.name} {one.name}", seen))
    best = r.best.design
    if best is not None:
        room = {name: (least, most) for name, (_, least, most) in ROOM.items()}
        for line in at_bounds(in_units(r.best), best.on_end.tolist(), room):
            reserve(f"{line}: what can be built decides here, not the strap")
    if len(r.draws) < r.options.draws and not stopped:
        reserve(f"{r.options.draws - len(r.draws)} of {r.options.draws} draws gave no movement and are left out")


def _report(r: StandingDesignResult, solved: int, seconds: float) -> None:
    """The aim and the knee by each design, what was chosen, the gain, and what it cost to find."""
    aim, unit = r.options.aim, UNITS[r.options.aim]
    what, sought, beside = AIMS[r.options.aim]
    asked = {one.name: one.movement.asked for one in r.designs}
    for how, largest in ((sought, False), (beside, True)):
        sizes = {name: of.largest_at(aim) if largest else of.at(aim) for name, of in asked.items()}
        each = ", ".join(f"{name} {size:.3g} {unit}" for name, size in sizes.items())
        say(f"{what}, {how}: {each}")
    say(_of_knee(r))
    interval = gain_interval(r.draws)
    if not contradicted():
        _say_choice(r, solved, seconds)
    note(
        "design",
        {
            "aim": r.options.aim,
            "values": {name: dict(zip(of.measures, of.sizes.tolist(), strict=True)) for name, of in asked.items()},
            "largest": {name: dict(zip(of.measures, of.largest.tolist(), strict=True)) for name, of in asked.items()},
            "chosen": {name: value for name, value, _ in in_units(r.best)},
            "price": None if r.best.design is None else r.best.design.price,
            "gain": r.gain,
            "gain_interval": [*interval] if np.isfinite(interval[0]) else None,
            "movements": solved,
            "cpu_seconds": round(seconds, 3),
        },
    )


def _say_choice(r: StandingDesignResult, solved: int, seconds: float) -> None:
    """What was chosen, the gain over not choosing it, and how many motions are certified."""
    what, sought, beside = AIMS[r.options.aim]
    for line in answer(what, UNITS[r.options.aim], r.answered(r.designs), r.answered(r.front))[1:]:
        say(line)
    numbers = ", ".join(f"{name} {value:.3g} {PARTS.get(name, of)}" for name, value, of in in_units(r.best))
    say(f"{r.best.name}: {numbers}")
    gain, (low, high) = r.gain, gain_interval(r.draws)
    also = f", {low:.0%} to {high:.0%} over {counted(len(r.draws), 'draw')}" if np.isfinite(low) else ""
    both = f"{gain:.0%} ({sought}{also}), {r.true_gain:.0%} ({beside})"
    say(f"gain over {r.reference.name}: {both}; shear of the strap is predicted, a mat cannot measure it")
    seen = [trial for one in (*r.designs, *r.front) for trial in one.trials]
    passed = sum(t.judged.certificate is not None and t.judged.certificate.converged for t in seen)
    say(f"{passed} of {counted(len(seen), 'motion')} certified; {counted(solved, 'movement')} in {seconds:.0f} s")


def _of_knee(r: StandingDesignResult) -> str:
    """How far the knee's true peak and its smooth one are below those without help."""
    without, *others = r.designs
    parts, own = [], without.movement.asked
    peak = own.largest_at("knee")
    for one in others:
        true, smooth = one.movement.asked.largest_at("knee") / peak, one.movement.asked.at("knee") / own.at("knee")
        parts.append(f"{one.name} {true:.1%} (smooth {smooth:.1%})")
    return f"knee at most {r.options.knee:.0%} of its true peak of {peak:.1f} N m without help: {', '.join(parts)}"


design = Job("sit-to-stand design", StandingDesignOptions, read, run)
