"""What scaling may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import C3dUnit, Excludes, Expression, Texts, TimeSpan
from geocontact.analyses.frame.options import Options
from geocontact.data.plausible import MASS


@dataclass(frozen=True)
class ScaleOptions(Options):
    """Scale a model to a subject from a static trial: sizes of bodies, mass, places of markers.

    Parameters
    ----------
    static
        Markers while the subject stands still (.trc, .c3d, .csv).
    model
        Generic OpenSim model (.osim) with markers.
    scale
        Bodies and the pairs of markers whose distances give their size: femur_r,femur_l=R.Hip/R.Knee,L.Hip/L.Knee.
        May be given again; bodies that are not named keep their size. femur_r:xz=… is along these axes of the body,
        and a number takes the place of the pairs: femur_r:xz=1.05.
    marker_set
        Markers of the model from a file of their own (.xml with a MarkerSet) in place of the model's.
    markers_map
        Names of recorded markers as the model calls them: RHEE=R.Heel,LHEE=L.Heel, or a file with a pair in each line.
    naming
        Recorded markers known by their marker set: auto recognises it from the labels, or its name (plug-in-gait,
        helen-hayes, opencap, …). The model's markers take the recording's labels, missing ones are placed from a table,
        and without `scale` the set's pairs measure the bodies.
    model_setup
        Set-up of a public full-body model: pairs of markers that measure each segment, weights of markers. auto knows
        the model by its name or bodies; or gait2392, hamner, rajagopal, laiuhlrich. Includes `naming` auto.
    mass
        Mass of the subject [kg], shared among the bodies as in the model.
    mass_by_volume
        Masses of bodies scale with their volume before the subject's mass is distributed; otherwise sizes leave masses
        as they are.
    sizes
        Trial in which distances of markers are measured (.trc, .c3d, .csv), in place of the static trial.
    sizes_time
        First and last time [s] of measuring distances, in place of those of standing still.
    keep_markers
        Leave markers where scaling puts them, and the model's default pose; otherwise markers are moved to where they
        were seen in the static trial, but for those that the model calls fixed, and its pose becomes the default.
    tasks
        OpenSim's setup of inverse kinematics or its task set (.xml) for the static pose; without it all markers alike.
    axes
        Which of the markers' axes are the model's x, y and z: x,z,-y where the laboratory's z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    time
        First and last time [s] of standing still.
    """

    writes: ClassVar[str] = """
    Writes scaled.osim (for ik, id and OpenSim; its defaults are the static pose), scale.json and run.json into OUT.
    """

    static: Path
    _: KW_ONLY
    model: Path
    scale: Texts = ()
    marker_set: Path | None = None
    markers_map: str | None = None
    naming: Annotated[str | None, Excludes("markers_map"), Excludes("tasks")] = None
    model_setup: Annotated[str | None, Excludes("markers_map"), Excludes("tasks")] = None
    mass: Annotated[float | None, MASS] = None
    mass_by_volume: bool = False
    sizes: Path | None = None
    sizes_time: TimeSpan | None = None
    keep_markers: bool = False
    tasks: Path | None = None
    axes: Expression | None = None
    c3d_unit: C3dUnit = None
    time: TimeSpan | None = None
