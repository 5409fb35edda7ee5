"""Everything the centre of pressure writes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.cop.figure import LoadCurves, draw_cop
from geocontact.analyses.cop.force_plate import PlateCurves
from geocontact.cli.cop import CopOptions
from geocontact.data.motion import Motion
from geocontact.io.text.results import write_table
from geocontact.loads.centre_of_pressure import CentreOfPressure
from geocontact.loads.sphere_loads import SphereLoads
from geocontact.loads.sphere_set import SoleLaw, SphereSet

FRAME = "# frame = ground, in which the motion gives the foot's pose; forces are those on the foot; cop = {}"
CENTRES = {"ground": "centre of the ground points", "sphere": "centre of the sphere centres"}


@dataclass(frozen=True)
class Foot:
    """A sole with its law and its motion."""

    name: str
    sole: SphereSet
    law: SoleLaw
    motion: Motion


def write_results(
    foot: Foot,
    loads: SphereLoads,
    centre: CentreOfPressure,
    plate: PlateCurves | None,
    comparison: pd.DataFrame | None,
    o: CopOptions,
    folder: Path,
) -> None:
    """Tables with the frame in their first line, and the figure."""
    line = FRAME.format(CENTRES[o.point])
    time = foot.motion.time
    _write(cop_table(foot.motion, loads, centre), folder, "cop", line, o)
    _write(zone_table(foot, loads), folder, "zones", line, o)
    if comparison is not None:
        _write(comparison, folder, "comparison", line, o)
    ours = LoadCurves(time, centre.wrench.force, centre.centre, centre.free_moment)
    theirs = None
    if plate is not None:
        theirs = LoadCurves(time[plate.frames], plate.force, plate.centre, plate.free_moment)
    title = f"{foot.name} on the ground, {o.motion.name}"
    draw_cop(ours, theirs, centre.normal, title, (folder / "cop.png", folder / "cop.svg"))


def cop_table(motion: Motion, loads: SphereLoads, c: CentreOfPressure) -> pd.DataFrame:
    """Force, centre and free moment of every frame; centre and free moment are empty below the gate."""
    vectors = {
        f"{name}_{axis} [{unit}]": values[:, k]
        for name, unit, values in (("force", "N", c.wrench.force), ("cop", "m", c.centre))
        for k, axis in enumerate("xyz")
    }
    return pd.DataFrame(
        {
            "time [s]": motion.time,
            **vectors,
            "free_moment [N m]": c.free_moment,
            "normal [N]": c.pressing,
            "spheres [-]": np.count_nonzero(loads.depth > 0.0, axis=1),
            "max_depth [m]": np.maximum(loads.depth.max(axis=1), 0.0),
        }
    )


def zone_table(foot: Foot, loads: SphereLoads) -> pd.DataFrame:
    """Normal force of every zone."""
    zones = {f"{name} [N]": loads.pressing[:, which].sum(axis=1) for name, which in foot.sole.zones.items()}
    return pd.DataFrame({"time [s]": foot.motion.time, **zones})


def _write(table: pd.DataFrame, folder: Path, name: str, line: str, o: CopOptions) -> None:
    write_table(table, folder, o.parquet, name)
    file = folder / f"{name}.csv"
    file.write_text(f"{line}\n{file.read_text(encoding='utf-8')}", encoding="utf-8", newline="\n")
