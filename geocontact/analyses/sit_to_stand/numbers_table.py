"""Tables of every number that ran, and of where the intervals of each motion begin and end."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from geocontact.analyses.sit_to_stand.design.chosen import CertifiedDesign
from geocontact.analyses.sit_to_stand.predict.predicted_trial import PredictedTrial
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.standing_up.assistance.assisted_model import ASSISTED_PARAMETERS, AssistedModel
from geocontact.standing_up.assistance.habit import HabitSizes
from geocontact.standing_up.assistance.room import ROOM
from geocontact.standing_up.calibrated_phase import CalibratedPhase
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    belief_numbers,
    end_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)
from geocontact.standing_up.phase import PhaseSizes
from geocontact.standing_up.trials import StandingTrial

Meshes = Sequence[tuple[str, Sequence[CollocatedMotion]]]
"""Motions by the name of their phase, predictor or design."""
GIVEN = "as the file of parameters gives it"


def ran_table(rows: Sequence[Ran]) -> pd.DataFrame:
    """Every number in SI, and where it is from."""
    return pd.DataFrame(rows, columns=list(Ran._fields))


def mesh_table(of: str, meshes: Meshes) -> pd.DataFrame:
    """Ends of the intervals, from the start of each motion to its end; `of` is what the motions are named by."""
    rows = [(name, motion.name, float(at)) for name, motions in meshes for motion in motions for at in motion.breaks]
    return pd.DataFrame(rows, columns=[of, "trial", "break [s]"])


def calibration_numbers(phases: Sequence[CalibratedPhase], trials: Sequence[StandingTrial]) -> list[Ran]:
    """Of the model once, of each phase what it sought, believed and weighed, and on which meshes."""
    rows = model_numbers(phases[-1].model)
    for one in phases:
        prefix = f"phase {one.name} "
        rows += parameter_numbers(one.phase.parameters, one.found.p, prefix, free=one.phase.free)
        rows += belief_numbers(one.phase, prefix) + size_numbers(_sizes(one.phase.sizes), prefix)
        rows += search_numbers(one.found.motions, trials, prefix)
    return rows


def prediction_numbers(predictions: Sequence[PredictedTrial]) -> list[Ran]:
    """Of the model, the parameters and the cost once, which all predictors share; of each motion its mesh."""
    first = predictions[0]
    rows = model_numbers(first.model) + parameter_numbers(first.phase.parameters, first.p, note=GIVEN)
    rows += size_numbers(_sizes(first.phase.sizes)) + end_numbers(first.phase.control)
    for one in predictions:
        rows += search_numbers([one.motion], [one.trial.recorded], f"{one.name} ")
    return rows


def predicted_meshes(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """Of every motion."""
    return mesh_table("predictor", [(one.name, [one.motion]) for one in predictions])


def design_numbers(
    model: AssistedModel, designs: Sequence[CertifiedDesign], trials: Sequence[StandingTrial]
) -> list[Ran]:
    """Of the model, the held parameters and the movement's cost once; of each design what may vary, and its meshes."""
    first = designs[0].movement
    chosen = {parameter for parameter, _, _ in ROOM.values()}
    rows = model_numbers(model.standing)
    rows.append(Ran("help width", model.width, "-", "invented", "of the help, in parts of the movement"))
    held = parameter_numbers(ASSISTED_PARAMETERS, first.found.p, note=GIVEN)
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


def _sizes(of: PhaseSizes | None) -> PhaseSizes:
    if of is None:
        raise ValueError("this phase does not say what its cost is measured by")
    return of
