"""Distance maps of all frames as a file, written and read."""

from __future__ import annotations

from os.path import lexists
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.io.text.file_preflight import MAX_BYTES, open_file
from geocontact.io.text.unpacked import refuse_arrays_that_lie, refuse_unpacked
from geocontact.view.surfaces.scene import ContactSeries, MappedBody

FILE = "distances.npz"


def write_maps(
    file: Path, moving: Surface, fixed: Surface, motion: Motion, evolution: AreaEvolution, maps: DistanceMaps
) -> None:
    """Compressed numpy archive, SI units; distances are infinite (negative deep inside) beyond what was asked for.

    Arrays: time (t,), time_unit, thresholds (k,), X_FM (t, 4, 4), signed, and for each body vertices (n, 3), faces
    (m, 3), distance (t, n) of its vertices to the other body.
    """
    np.savez_compressed(
        file,
        allow_pickle=False,
        time=motion.time,
        time_unit=np.asarray(motion.time_unit),
        thresholds=np.asarray(evolution.thresholds),
        X_FM=motion.poses.as_matrix().reshape(-1, 4, 4),
        signed=np.asarray(evolution.signed),
        fixed_vertices=fixed.vertices,
        fixed_faces=fixed.faces,
        fixed_distance=maps.fixed,
        moving_vertices=moving.vertices,
        moving_faces=moving.faces,
        moving_distance=maps.moving,
    )


def read_series(result: Path) -> ContactSeries:
    """Bodies, motion and distances from the folder of a result (or the file itself)."""
    file = result / FILE if result.is_dir() else result
    if not lexists(file):
        raise InputError(file, "", "is not there", "run the analysis again with `save_map`")
    try:
        refuse_unpacked(file, MAX_BYTES)
        refuse_arrays_that_lie(file)
        with open_file(file) as stream, np.load(stream, allow_pickle=False) as maps:
            fixed, moving = (
                MappedBody(*(maps[f"{body}_{what}"] for what in ("vertices", "faces", "distance")))
                for body in ("fixed", "moving")
            )
            return ContactSeries(
                time=maps["time"],
                poses=RigidTransform.from_matrix(maps["X_FM"]),
                fixed=fixed,
                moving=moving,
                thresholds=tuple(maps["thresholds"].tolist()),
                signed=str(maps["signed"]),
                time_unit=str(maps["time_unit"]),
            )
    except InputError as error:
        raise InputError(file, "", error.what, "run the analysis again with `save_map`") from error
    except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
        what = f"is not what `save_map` writes ({' '.join(str(error).split())})"
        raise InputError(file, "", what, "run the analysis again with `save_map`") from error
