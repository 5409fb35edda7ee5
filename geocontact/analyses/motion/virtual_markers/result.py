"""Virtual markers of a model along a motion: `geocontact markers`, `gc.virtual_markers`.

>>> import geocontact as gc
>>> result = gc.virtual_markers("meshes/leg_swing.mot", model="meshes/leg.osim")
>>> print(result)
16 markers in 101 frames
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, results, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.analyses.motion.virtual_markers.show import markers_curves, markers_page
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import TextTable, read_table
from geocontact.trial_checks.recorded import MovedModel, TrialInputs
from geocontact.view.curves.drawn import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MarkersResult(Result):
    """Markers of a model over time, in the ground's frame [m].

    `values` are the coordinates of `model` that they follow [rad, m].
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"markers"})

    options: MarkersOptions
    markers: MarkerTrajectories
    model: Multibody
    values: Float[np.ndarray, "t n"]

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self.markers.time

    @property
    def positions(self) -> dict[str, Float[np.ndarray, "t 3"]]:
        """Place of each marker in the ground's frame over time [m]."""
        places = np.asarray(self.markers.positions)
        return {name: places[:, k] for k, name in enumerate(self.markers.names)}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`markers` [m]."""
        places = self.markers.positions
        columns = {
            f"{name}_{axis} [m]": places[:, k, i]
            for k, name in enumerate(self.markers.names)
            for i, axis in enumerate("xyz")
        }
        return {"markers": pd.DataFrame({"time [s]": self.markers.time, **columns})}

    def figure(self) -> Figure:
        """Every axis over time."""
        return drawn(markers_curves(self.markers))

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The model as it moves, with its markers."""
        title = f"Virtual markers along {self.options.coordinates.name}"
        return {REPORT: markers_page(title, self.model, self.values, self.markers)}

    def write_files(self, folder: Path) -> None:
        """markers.trc [mm] besides."""
        write_trc(folder / "markers.trc", self.markers)
        super().write_files(folder)


@dataclass(frozen=True)
class Moved:
    """A model with markers, and its coordinates over time."""

    model: Multibody
    table: TextTable


def read(o: MarkersOptions) -> Moved:
    """Everything the options name."""
    model = read_multibody(o.model)
    add_input("`model`", o.model, bodies=len(model.bodies), markers=len(model.markers))
    if not model.markers:
        raise InputError(o.model, "", "has no markers", "give a model with a MarkerSet")
    table = read_table(o.coordinates)
    add_input("coordinates", o.coordinates, frames=len(table.time))
    if table.time_unit != "s":
        raise InputError(o.coordinates, "", "time is in per cent of a cycle", "a .trc file needs seconds")
    return Moved(model, table)


def run(moved: Moved, o: MarkersOptions) -> MarkersResult:
    """Places of all markers in every frame."""
    model, table = moved.model, moved.table
    names = tuple(m.name for m in model.markers)
    values = motion_of(table, model, o.angles)
    places = model.marker_places(values)
    along = MovedModel(model, table.time, values, str(o.coordinates))
    seen = MarkerTrajectories(table.time, places, names, str(o.coordinates))
    check_trial(TrialInputs(seen, up=model.up, moved=along))
    results().update(frames=len(table.time), markers=len(names))
    say(f"{len(names)} markers in {len(table.time)} frames")
    markers = MarkerTrajectories(table.time, places, names)
    return MarkersResult(options=o, markers=markers, model=model, values=values)


virtual_markers = Job("markers", MarkersOptions, read, run)
