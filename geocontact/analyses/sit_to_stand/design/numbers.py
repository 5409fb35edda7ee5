"""Every number of a choice as it ran."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.analyses.sit_to_stand.design.chosen import CertifiedDesign
from geocontact.analyses.sit_to_stand.numbers_table import GIVEN
from geocontact.standing_up.assistance.assisted_model import ASSISTED_PARAMETERS, AssistedModel
from geocontact.standing_up.assistance.habit import HabitSizes
from geocontact.standing_up.assistance.room import ROOM
from geocontact.standing_up.numbers_that_ran import Ran, model_numbers, parameter_numbers, search_numbers
from geocontact.standing_up.trials import StandingTrial


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
