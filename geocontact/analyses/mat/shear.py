"""Shear of a two-axis mat on its surface: force and moment over time, beside the friction limit of its pressures.

A cell of area A with shear stresses τ_r and τ_c passes A (τ_r t_r + τ_c t_c) on to the body at its centre; t_r and t_c
are the directions of growing row and column on the surface, from the cell's corners, across the cell's normal. Only
cells that press count: what others show is noise, and sizes of noise would add up. wrench.csv has pressures alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float, Int

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import MatInputs, PlacedMat
from geocontact.analyses.mat.recording import TOUCH
from geocontact.analyses.mat.travel import Travel
from geocontact.data.frame_blocks import worked
from geocontact.data.pressure_frames import PressureFrames
from geocontact.loads.friction_limit import CAUSES, FrictionLimit, friction_limit, noise_of
from geocontact.loads.mat_load import MatLoad

FRICTION = 1.0
"""Static friction that shear is compared with where none is stated: rubber; textiles on skin have less."""


@dataclass(frozen=True, eq=False)
class MatShear:
    """Shear of the mat on the body, in the frame of the loads and about their point.

    Parameters
    ----------
    force, moment
        Of all cells that press [N], [N m].
    limit
        `size` beside friction times the sum of pressure times area: never more than its cells' own sizes together.
    cells_beyond
        Share of loaded cells and frames whose own shear stress exceeds friction times their pressure.
    """

    force: Float[np.ndarray, "t 3"]
    moment: Float[np.ndarray, "t 3"]
    limit: FrictionLimit
    cells_beyond: float

    @property
    def size(self) -> Float[np.ndarray, " t"]:
        """Length of the force [N]."""
        return np.asarray(np.linalg.norm(self.force, axis=1))


def mat_shear(
    given: MatInputs,
    there: PlacedMat,
    frames: PressureFrames,
    pressed: tuple[Float[np.ndarray, "t n"], MatLoad],
    travel: Travel | None,
    o: MatOptions,
) -> MatShear | None:
    """None of a mat without shear; says its largest force and how it stands beside friction.

    Parameters
    ----------
    pressed
        Pressures of the cells on the surface [Pa], and their load.
    """
    if given.shear is None:
        return None
    pressure, whole = pressed
    kept = same_times(given.recorded.time, frames.time)  # frames follow each other, those without a pose are at an end
    both = [there.cells.of(each.pressure[kept[0] : kept[-1] + 1]) for each in given.shear]
    mu = FRICTION if o.friction is None else o.friction
    rows, columns = tangents(there)
    area, centre = there.cells.area, there.cells.centre

    def of_part(pressed: np.ndarray, along: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Force, moment about the origin, whether a cell presses, and cells that are loaded and beyond friction."""
        pressing, loaded = pressed > 0.0, pressed >= o.touched
        stress = np.where(pressing, along, 0.0)[..., None] * rows + np.where(pressing, across, 0.0)[..., None] * columns
        each = area[:, None] * stress
        moment, beyond = np.cross(centre[None], each), np.linalg.norm(stress, axis=2) > mu * pressed
        counts = [pressing.any(axis=1), loaded.sum(axis=1), (loaded & beyond).sum(axis=1)]
        return np.column_stack([each.sum(axis=1), moment.sum(axis=1), *counts])

    every = worked(of_part, pressure, *both, each=10 * len(area))
    force, moment, origin = every[:, :3], every[:, 3:6], whole.wrench.origin
    if travel is not None:
        turn = travel.poses.rotation
        force, moment = turn.apply(force), turn.apply(moment) + np.cross(travel.poses.translation, turn.apply(force))
    moment = moment - np.cross(origin, force)
    pressing, loaded, over = every[:, 6] > 0.0, float(every[:, 7].sum()), float(every[:, 8].sum())
    beyond = over / loaded if loaded else 0.0
    limit = friction_limit(np.linalg.norm(force, axis=1), whole.pressing, mu, _noise(force, pressing))
    found = MatShear(np.asarray(force), np.asarray(moment), limit, beyond)
    _report(found, frames.time, "" if o.friction is not None else " (the default: state `friction`)")
    return found


def same_times(recorded: Float[np.ndarray, " r"], wanted: Float[np.ndarray, " t"]) -> Int[np.ndarray, " k"]:
    """Indices of recorded times that are among the wanted ones, which grow, but for rounding."""
    after = np.searchsorted(wanted, recorded)
    ends = [wanted[np.clip(k, 0, len(wanted) - 1)] for k in (after - 1, after)]
    return np.flatnonzero(np.min([np.abs(recorded - end) for end in ends], axis=0) <= TOUCH)


def _noise(force: Float[np.ndarray, "t 3"], pressing: Bool[np.ndarray, " t"]) -> float:
    """Noise of the three parts together, where a cell presses [N]: the length of noise varies less than they do."""
    under = np.where(pressing[:, None], force, np.nan)
    return float(np.linalg.norm([noise_of(part) for part in under.T]))


def tangents(there: PlacedMat) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    """Unit directions of growing row and of growing column of each cell on the surface."""
    row, column = there.cells.cell.T
    nodes, normal = there.drape.nodes, there.drape.normal[row, column]
    corners = {(i, j): nodes[row + i, column + j] for i in (0, 1) for j in (0, 1)}
    down = corners[1, 0] + corners[1, 1] - corners[0, 0] - corners[0, 1]
    right = corners[0, 1] + corners[1, 1] - corners[0, 0] - corners[1, 0]
    flat = (each - np.einsum("ni,ni->n", each, normal)[:, None] * normal for each in (down, right))
    first, second = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in flat)
    return np.asarray(first), np.asarray(second)


def shear_table(found: MatShear, normal: Float[np.ndarray, " t"], time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """Force and moment of the shear alone, its size beside the sum of pressure times area, and their ratio; empty
    where nothing presses.
    """
    ratio = np.divide(found.size, normal, out=np.full(len(time), np.nan), where=normal > 0.0)
    return pd.DataFrame(
        {
            "time [s]": time,
            **{f"f{axis} [N]": found.force[:, k] for k, axis in enumerate("xyz")},
            **{f"m{axis} [N m]": found.moment[:, k] for k, axis in enumerate("xyz")},
            "shear [N]": found.size,
            "normal [N]": normal,
            "shear over normal [-]": ratio,
        }
    )


def _report(found: MatShear, time: Float[np.ndarray, " t"], default: str) -> None:
    limit, most = found.limit, int(np.argmax(found.size))
    say(
        f"shear up to {found.size[most]:.1f} N at {time[most]:g} s (vector sum, cells that press; in shear.csv, not in "
        f"wrench.csv), over the normal force: median {limit.usual:.2f}, at most {limit.largest:.2f}"
    )
    if not limit.kept:
        what = f"shear exceeds friction {limit.friction:g}{default} times the normal force"
        reserve(f"{what} for {limit.beyond:.0%} of the time, first at {time[limit.first]:g} s: {CAUSES}")
    note("shear", {"friction": limit.friction, "beyond": limit.beyond, "cells_beyond": found.cells_beyond})
