"""The knee from pose to load cells: the parts put together again, what it is offered, what it refuses."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pandas as pd
import pytest

from geocontact.chain.system import System, tangents
from geocontact.data.errors import InputError
from geocontact.data.gap_case import CaseMesh, GapCase
from geocontact.effects.catalogue import candidates
from geocontact.geometry.contact_area.evolution import ContactPair, Settings
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from geocontact.io.motion.poses import motion_from_csv
from geocontact.loads.loadcells import compartment_forces
from geocontact.systems import knee_full_chain as knee_chain
from geocontact.systems.catalogue import system_of
from tests.effects.test_every_effect import VOCABULARY
from tests.systems.posed_knees import CONSTANTS, E_STAR, MESHES, bodies, chain, poses, trial

SIDES = knee_chain.SIDE_NAMES
TIME, POSES = poses(20)
TRIAL = trial("t", TIME, POSES)
MODULUS = 2.5e6


@cache
def whole() -> System:
    """From pose to cells: made by the first test that asks, not where the file is read."""
    return chain()


def test_sides_press_by_the_areas_of_the_area_command() -> None:
    motion = motion_from_csv(MESHES / "gait.csv")
    moving, fixed = (Surface.of(bodies()[name].mesh) for name in ("moving", "fixed"))
    pair = ContactPair(moving, fixed, Settings((4e-3,), split=Plane.across("z"), medial_side=-1))
    force = chain(SIDES).simulate(trial("t", TIME, POSES, SIDES), {"E_star": MODULUS})
    for k in (0, 3):
        pose = motion.poses[20 * k]
        found = pair.at(pose.rotation.as_matrix(), np.asarray(pose.translation)).fixed[0]
        area = np.array([found.negative, found.area - found.negative])
        want = 4.0 / 3.0 * MODULUS * (area / np.pi) ** 1.5 / CONSTANTS["R"]
        np.testing.assert_allclose(force[k], want, rtol=2e-3)


def test_cells_add_up_to_the_sides_and_turn_with_the_patch() -> None:
    cells = whole().simulate(TRIAL, {"E_star": MODULUS})
    force = chain(SIDES).simulate(trial("t", TIME, POSES, SIDES), {"E_star": MODULUS})
    back = compartment_forces(TIME, cells)
    np.testing.assert_allclose(np.column_stack([back.medial, back.lateral]), force, rtol=1e-10)
    forward = POSES + np.array([0.0, 0.0, 0.0, 1.5e-3, 0.0, 0.0])[:, None]
    moved = whole().simulate(trial("t", TIME, forward), {"E_star": MODULUS})
    front, ahead = ((c[:, 1] + c[:, 2]) / c.sum(axis=1) for c in (cells, moved))
    assert (ahead > front).all(), "a component that stands further forward loads the front cells more"


def test_derivatives_are_those_of_the_cells() -> None:
    axis = next(one for one in candidates(whole()) if one.name == "axis_migration")
    system = axis.apply(whole())
    values = {"E_star": MODULUS} | {p.name: 0.3 * p.upper for p in axis.parameters}
    steps = {name: 1e-7 * abs(value) for name, value in values.items()}
    found = tangents(system, TRIAL, values, steps)
    assert set(found) == set(values)
    for name, step in steps.items():
        ends = [system.simulate(TRIAL, {**values, name: values[name] + 100.0 * side * step}) for side in (1.0, -1.0)]
        known = (ends[0] - ends[1]) / (200.0 * step)
        np.testing.assert_allclose(found[name], known, rtol=1e-5, atol=1e-5 * np.abs(known).max())


def test_a_left_knee_is_the_mirror_image_of_a_right_one() -> None:
    mirrored = POSES * np.array([1.0, 1.0, 1.0, 1.0, 1.0, -1.0])[:, None]
    left = chain(side=-1.0).simulate(trial("t", TIME, mirrored), {"E_star": MODULUS})
    np.testing.assert_allclose(left, whole().simulate(TRIAL, {"E_star": MODULUS}), rtol=2e-4)


def test_effects_are_those_of_the_knee_on_every_coordinate_of_the_pose() -> None:
    offered = candidates(whole())
    assert {one.name for one in offered} == set(VOCABULARY["knee"].split())
    assert {one.variant for one in offered if one.name == "motion_offset"} == set(whole().inputs)
    assert len([one for one in offered if one.name == "crosstalk"]) == 12
    reach = whole().geometry.areas.reach[:, 0]  # type: ignore[attr-defined]
    bounds = [one.parameters[0].upper for one in offered if one.name == "motion_offset"]
    assert (np.array(bounds) < reach).all(), "a search stays on the grid"


def test_an_offset_that_is_tried_is_an_offset_of_the_pose() -> None:
    offset = next(one for one in candidates(whole()) if one.label == "motion_offset.tz").apply(whole())
    whole().simulate(TRIAL, {"E_star": MODULUS})
    got = offset.simulate(TRIAL, {"E_star": MODULUS, "motion_offset.tz.offset": 8e-4})
    shifted = POSES + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 8e-4])[:, None]
    want = chain().simulate(trial("t", TIME, shifted), {"E_star": MODULUS})
    away = np.abs(want - whole().simulate(TRIAL, {"E_star": MODULUS})).max()
    assert np.abs(got - want).max() < 0.25 * away


def test_only_the_front_of_the_insert_counts_if_the_case_says_so() -> None:
    meshes = {**bodies(), "fixed": replace(bodies()["fixed"], region="x > 0")}
    front = knee_chain.build((E_STAR,), CONSTANTS, {}, meshes)
    assert (
        front.simulate(TRIAL, {"E_star": MODULUS}).sum(axis=1)
        < 0.9 * whole().simulate(TRIAL, {"E_star": MODULUS}).sum(axis=1)
    ).all()


def test_weights_of_another_tray() -> None:
    table = pd.DataFrame(
        {
            "cell": ["AL", "PL", "PM", "AM"],
            "medial [-]": [0.05, 0.03, 0.95, 0.97],
            "lateral [-]": [0.95, 0.97, 0.05, 0.03],
        }
    )
    given = knee_chain.build((E_STAR,), CONSTANTS, {"regression": table}, bodies())
    regression = knee_chain.regression_of({"regression": table})
    order = [knee_chain.CELL_NAMES.index(name) for name in regression.cells]
    back = compartment_forces(TIME, given.simulate(TRIAL, {"E_star": MODULUS})[:, order], regression)
    force = chain(SIDES).simulate(trial("t", TIME, POSES, SIDES), {"E_star": MODULUS})
    np.testing.assert_allclose(np.column_stack([back.medial, back.lateral]), force, rtol=1e-10)


def case(constants: dict[str, float], meshes: dict[str, CaseMesh], system: str = "CELLS") -> GapCase:
    name = f"geocontact.systems.knee_full_chain:{system}"
    return GapCase("knee", name, (TRIAL,), (replace(TRIAL, name="u"),), (E_STAR,), constants, meshes=meshes)


def without(*names: str, **more: float) -> dict[str, float]:
    return {name: value for name, value in CONSTANTS.items() if name not in names} | more


@pytest.mark.parametrize(
    ("constants", "meshes", "words"),
    [
        (CONSTANTS, {}, r"the mesh moving is missing; give its file and unit under \[mesh.moving\]"),
        (CONSTANTS, {**bodies(), "tray": bodies()["fixed"]}, r"the mesh tray is not used; it takes moving, fixed"),
        (without("threshold"), bodies(), r"threshold is missing"),
        (without("threshold", threshold=0.0), bodies(), r"threshold is 0 m; it must be positive"),
        (without("side", side=2.0), bodies(), r"side is 2; write 1 for a right or -1 for a left knee"),
        (without("cell_anterior", cell_anterior=-0.1), bodies(), r"cell_anterior -0.1 m is not in front"),
        (CONSTANTS, {**bodies(), "moving": CaseMesh(bodies()["moving"].mesh, "x > 0")}, r"give the region to"),
        (CONSTANTS, {**bodies(), "fixed": CaseMesh(bodies()["fixed"].mesh, "x >")}, r"cannot be read; write for"),
    ],
)
def test_a_case_that_cannot_be_is_refused_in_one_line(
    constants: dict[str, float], meshes: dict[str, CaseMesh], words: str
) -> None:
    with pytest.raises(InputError, match=words) as caught:
        system_of(case(constants, meshes))
    assert "\n" not in str(caught.value)


def test_a_listed_system_takes_no_mesh() -> None:
    with pytest.raises(InputError, match="the mesh moving is not used; it takes none"):
        system_of(replace(case(CONSTANTS, bodies()), system="knee"))
