"""Where on a mat the gap lies: synthetic cells under the elbow's cuff, whose parts in the gap are known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import CellChannels, CellTrial, SurfaceGap
from geocontact.gap.case.admission import admitted
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.diagnose import diagnose
from geocontact.gap.localise.on_surface import on_surface
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import NOISE, elbow_case

SIDE = 8
IDS = tuple(f"c{k}" for k in range(SIDE * SIDE))
ROW, COLUMN = np.divmod(np.arange(SIDE * SIDE), SIDE)
PLACE = 0.01 * np.column_stack([ROW, COLUMN, 0.0 * ROW])
AREA = np.full(SIDE * SIDE, 1e-4)
CORNER = (ROW >= 5) & (COLUMN >= 5)
"""9 of 64 cells, off the middle of the load."""

Spread = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(time, extra force) → force of each cell beyond its part of the usual load."""


def bump(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
    return force + extra(time)


def extra(time: np.ndarray) -> np.ndarray:
    """A push that no effect of the vocabulary is."""
    return 3.0 * np.exp(-0.5 * ((time - 6.0) / 0.5) ** 2)


def usual() -> np.ndarray:
    """Part of each cell in the load."""
    hill = np.exp(-0.5 * ((ROW - 3.0) ** 2 + (COLUMN - 3.0) ** 2) / 2.0**2)
    return np.asarray(hill / hill.sum())


def in_corner(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    return np.outer(push, CORNER / CORNER.sum())


def as_load(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    return np.outer(push, usual())


def behind(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    return np.zeros((len(time), SIDE * SIDE))


def wandering(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    """The push in the corner, while the load moves along the mat, slower and larger, through the middle at its time."""
    along = (ROW - ROW.mean()) * usual()
    return in_corner(time, push) + np.outer(
        20.0 * np.sin(2.0 * np.pi * (time - 6.0) / time[-1]), along - along.sum() * usual()
    )


def cells_of(case: GapCase, spread: Spread, rng: np.random.Generator) -> CellChannels:
    """Cells that together read the force, each with noise of its own."""
    trials = {}
    for trial in (*case.calibration, *case.evaluation):
        push = extra(trial.time)
        forces = np.outer(trial.column("force") - push, usual()) + spread(trial.time, push)
        noise = NOISE / SIDE * rng.standard_normal(forces.shape)
        trials[trial.name] = CellTrial(trial.time, (forces + noise - noise.mean(axis=1, keepdims=True)) / AREA)
    return CellChannels("force", IDS, PLACE, AREA, trials)


def with_cells(spread: Spread, seed: int = 4) -> GapCase:
    """The elbow with a push, and cells under its cuff."""
    case = elbow_case(seed=seed, change=bump)
    return replace(case, cells={"cuff": cells_of(case, spread, np.random.default_rng(seed))})


def found_on(spread: Spread) -> tuple[SurfaceGap, ...]:
    case = with_cells(spread)
    return on_surface(problem_of(case, system_of(case)), None, None, case.cells)


def test_a_push_on_nine_cells_is_found_there(elsewhere: Elsewhere) -> None:
    (found,) = elsewhere(found_on, in_corner)
    assert found.gap.sum() == pytest.approx(1.0) and found.load.sum() == pytest.approx(1.0)
    assert set(found.holding) <= {IDS[k] for k in np.flatnonzero(CORNER)}
    np.testing.assert_allclose(found.gap[CORNER], 1.0 / 9.0, atol=0.02)
    assert np.abs(found.gap[~CORNER]).max() < 0.02
    np.testing.assert_allclose(found.load, usual(), atol=0.01)
    share, load = found.held
    assert 0.7 <= share < 0.7 + 0.13 and load < 0.1
    assert found.p_value < 0.02


def placed_by_chance(draws: int) -> tuple[SurfaceGap, int]:
    """A gap that is spread as the load is, and in how many draws of the cells' noise it is said not to be."""
    case = with_cells(as_load)
    problem = problem_of(case, system_of(case))
    found = [
        on_surface(problem, None, None, {"cuff": cells_of(case, as_load, np.random.default_rng(seed))})[0]
        for seed in range(draws)
    ]
    return found[0], sum(one.p_value <= 0.05 for one in found)


def test_a_push_that_is_spread_as_the_load_is_not_placed(elsewhere: Elsewhere) -> None:
    """5 % of 60 draws are 3; more than 8 come by chance once in a hundred times."""
    found, placed = elsewhere(placed_by_chance, 60)
    np.testing.assert_allclose(found.gap, usual(), atol=0.02)
    assert placed <= 8


def test_a_load_that_moves_over_the_mat_at_other_times_does_not_count(elsewhere: Elsewhere) -> None:
    (found,) = elsewhere(found_on, wandering)
    assert set(found.holding[:6]) <= {IDS[k] for k in np.flatnonzero(CORNER)}


def test_cells_that_do_not_show_the_gap_say_nothing(elsewhere: Elsewhere) -> None:
    assert elsewhere(found_on, behind) == ()


def said_of(spread: Spread) -> dict[str, object]:
    case = with_cells(spread)
    entry: dict[str, object] = diagnose(case, system_of(case)).diagnosis.as_dict()["where"][0]
    return entry


@pytest.mark.slow
def test_a_diagnosis_names_the_cells(elsewhere: Elsewhere) -> None:
    entry = elsewhere(said_of, in_corner)
    cells = entry["cells"]
    assert entry["channel"] == "force" and isinstance(cells, list)
    assert set(cells) <= {IDS[k] for k in np.flatnonzero(CORNER)} and len(cells) >= 6
    assert isinstance(entry["cells_p_value"], float) and entry["cells_p_value"] < 0.05


def test_cells_of_what_is_not_predicted_are_refused() -> None:
    case = with_cells(in_corner)
    wrong = replace(case, cells={"cuff": replace(case.cells["cuff"], channel="beta")})
    with pytest.raises(InputError, match="does not predict beta, which the cells of cuff add up to"):
        admitted(wrong, system_of(wrong))
