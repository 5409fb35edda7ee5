"""Published areas beside those of a run: the flexion of its frames, and what is said of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.refused import LITERATURE
from geocontact.analyses.frame.published import beside_published_areas
from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.published import AreasWithin, KneeRun
from geocontact.io.text.columns import angles_of, parse_map
from geocontact.io.text.tables import read_table
from geocontact.loads.pressure_evolution import PressureEvolution

FLEXION = "flexion"
Flexions = Mapping[str, Float[np.ndarray, " t"]]
"""Flexion of the frames [rad] by the name of the motion."""


def flexions_of(o: AreaOptions, files: Sequence[object], motions: Sequence[tuple[str, Motion]]) -> Flexions | None:
    """Flexion of each motion, as far as it is known; None unless published areas are asked for."""
    if o.compare != LITERATURE:
        return None
    found = {}
    for k, (name, motion) in enumerate(motions):
        if motion.coordinate is not None:
            if motion.coordinate[0] == FLEXION:
                found[name] = motion.coordinate[1]
        elif o.flexion is not None or o.convention is not None:
            found[name] = _column(o, str(files[k]), motion)
    return found


def _column(o: AreaOptions, file: str, motion: Motion) -> Float[np.ndarray, " t"]:
    """The column that was named, or that of the knee convention [rad]."""
    column = o.flexion or FLEXION
    if o.flexion is None and o.map is not None:
        sign, name = parse_map(o.map, ("flexion", "adduction", "rotation", "tx", "ty", "tz")).get(
            FLEXION, (1.0, FLEXION)
        )
    else:
        sign, name = (-1.0 if column.startswith("-") else 1.0), column.lstrip("-+ ")
    table = read_table(file)
    values = sign * angles_of(table, [name], o.angles)[:, 0]
    if len(values) != len(motion):
        raise InputError(file, "`flexion`", f"has {len(values)} rows for {len(motion)} frames", "leave it out")
    return np.asarray(values)


def beside_literature(
    flexions: Flexions, motion: Motion, e: AreaEvolution, pressure: PressureEvolution | None, name: str
) -> pd.DataFrame:
    """The published areas beside those of one motion, and what is said of them."""
    pressed = {} if pressure is None else pressure.sides
    run = KneeRun(
        flexion=flexions.get(name),
        load=None if pressure is None else pressure.pressing,
        pressed={side: np.array([load.area for load in loads]) for side, loads in pressed.items()},
        within=_within(e),
        swept=motion.coordinate is not None,
    )
    return beside_published_areas(run, name)


def _within(e: AreaEvolution) -> dict[str, AreasWithin]:
    """Areas of FIXED within the thresholds asked for; of all of it within those of the page besides."""
    asked = np.asarray(e.thresholds)
    order = np.argsort(asked)
    further = ~np.isclose(np.asarray(e.sensitivity_thresholds)[:, None], asked, rtol=1e-9, atol=1e-12).any(axis=1)
    levels = np.array([*asked, *np.asarray(e.sensitivity_thresholds)[further]])
    areas = np.hstack([e.fixed.area, e.sensitivity[:, further]]) if further.any() else e.fixed.area
    found = {"total": AreasWithin(np.sort(levels), areas[:, np.argsort(levels)])}
    if e.medial_side:
        for side, part in (("medial", e.medial), ("lateral", e.lateral)):
            found[side] = AreasWithin(asked[order], part[:, order])
    return found
