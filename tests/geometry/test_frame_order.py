"""A frame's numbers depend on its pose alone: not on the frames before it, on their order, or on the threads."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings, area_evolution
from geocontact.geometry.surface import Surface
from meshes.total_knee import total_knee
from tests.geometry.bodies import MM, cube

SETTINGS = Settings(thresholds=(0.5 * MM, 4 * MM), sensitivity=(1 * MM, 3 * MM, 6 * MM))
INSERT, FEMORAL = total_knee(1.5)
PLATE, BLOCK = cube((0, 0, 0), (20, 5, 20)), cube((0, 5, 0), (8, 5, 6))
HEIGHTS = {
    "knee": np.array([60.0, 34.0, 31.0, 30.6, 30.47, 30.4, 30.06, 29.6, 28.5, 31.5]),
    "blocks": np.array([40.0, 7.0, 5.8, 5.0 + 1e-3, 5.0, 5.0 - 1e-3, 4.5, 3.0, 1.0, 6.0]),
}
"""Of MOVING above FIXED [mm]: out of reach, near, touching, penetrating, near again."""
LAST = len(HEIGHTS["knee"]) - 1
ORDERS = {
    "in order": range(LAST + 1),
    "shuffled": np.random.default_rng(7).permutation(LAST + 1),
    "with jumps": [0, LAST - 1, 0, 4, LAST, 1, 4, LAST - 1, 4, 2],
}


def bodies(name: str) -> tuple[Surface, Surface]:
    """MOVING and FIXED, made anew: nothing that was found out about them is known."""
    moving, fixed = {"knee": (FEMORAL, INSERT), "blocks": (BLOCK, PLATE)}[name]
    return Surface(moving[0] * MM, moving[1], "moving"), Surface(fixed[0] * MM, fixed[1], "fixed")


def motion(name: str, frames: object) -> Motion:
    """Those poses of the pair, by number, as a motion of their own."""
    k = np.asarray(frames)
    y = HEIGHTS[name][k]
    if name == "knee":
        shift, turn = (
            np.column_stack([-3 + 0.1 * k, y, 0.05 * k]),
            Rotation.from_euler("z", (4.0 + k)[:, None], degrees=True),
        )
    else:
        shift, turn = np.column_stack([0.5 * k, y, 0.0 * k]), Rotation.from_euler("y", 3.0 * k[:, None], degrees=True)
    return Motion(0.1 * np.arange(len(k)), RigidTransform.from_components(shift * MM, turn))


def rows(name: str, frames: object, workers: int, pair: tuple[Surface, Surface] | None = None) -> list[dict]:
    """All numbers of each frame, with both maps."""
    maps: list[dict] = []

    def keep(_: int, frame) -> None:
        sides = {"fixed": frame.fixed_distances, "moving": frame.moving_distances}
        maps.append({f"{s}.{k}": v for s, d in sides.items() for k, v in vars(d).items() if k != "across"})

    found = area_evolution(*(pair or bodies(name)), motion(name, frames), SETTINGS, workers, keep)
    return [one | numbers(found, k) for k, one in enumerate(maps)]


def numbers(found: AreaEvolution, k: int) -> dict:
    """One frame of the result: areas, bounds, errors and centres of both sides, separation, depth, further areas."""
    sides = {"fixed": found.fixed, "moving": found.moving}
    names = ("area", "lower", "upper", "error", "centroid", "negative")
    table = {f"{side}.{name}": getattr(values, name)[k] for side, values in sides.items() for name in names}
    whole = ("min_distance", "max_penetration_fixed", "sensitivity", "undecided")
    return table | {name: getattr(found, name)[k] for name in whole}


def differences(one: dict, other: dict) -> list[str]:
    """Names of the numbers that are not the same to the bit."""
    assert one.keys() == other.keys()
    return [name for name in one if np.asarray(one[name]).tobytes() != np.asarray(other[name]).tobytes()]


@pytest.fixture(scope="module", params=["knee", "blocks"])
def cold(request: pytest.FixtureRequest) -> tuple[str, list[dict]]:
    """Each frame by itself, by one thread, of bodies of which nothing is known."""
    return request.param, [rows(request.param, [k], 1)[0] for k in range(LAST + 1)]


def test_the_frames_hold_every_case(cold) -> None:
    gap = np.array([float(row["min_distance"]) for row in cold[1]])
    area = np.array([row["fixed.area"][1] for row in cold[1]])
    assert (area == 0.0).any() and ((gap > 0.0) & (area > 0.0)).any()
    assert (gap < -1e-3).any() and (np.abs(gap) < 0.1e-3).any()
    if cold[0] == "blocks":
        assert gap[4] == pytest.approx(0.0, abs=1e-12), "exactly touching"
        assert gap[[1, 3, 6]] == pytest.approx([2e-3, 1e-6, -0.5e-3], abs=2e-9), "closed form: heights of the faces"


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("order", list(ORDERS))
def test_a_frame_is_the_same_in_any_order_and_by_any_threads(cold, order: str, workers: int) -> None:
    name, alone = cold
    frames = ORDERS[order]
    for k, row in zip(frames, rows(name, frames, workers), strict=True):
        assert not differences(row, alone[k]), f"frame {k} {order}, {workers} workers"


def test_a_second_motion_of_the_same_bodies_is_as_the_first(cold) -> None:
    name, alone = cold
    pair = bodies(name)
    rows(name, range(LAST, -1, -1), 1, pair)
    for k, row in enumerate(rows(name, range(LAST + 1), 2, pair)):
        assert not differences(row, alone[k]), f"frame {k}"
