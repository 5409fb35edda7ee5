"""A ball over a plate, analysed, and the page of it before it becomes HTML."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.area import page as contact_page
from geocontact.analyses.area.page_sections import Told
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.area import AS_GIVEN
from geocontact.geometry.contact_area.evolution import Settings, area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import block, sphere

MM = 1e-3
R, T = 20.0, 4.0
WIDE = tuple(0.5 * k * MM for k in range(13))


def swept(degrees):
    """The ball turned about its vertical axis at one height."""
    motion = moved([20.5] * len(degrees))
    return replace(motion, coordinate=("flexion", np.radians(degrees)))


def moved(heights):
    """The ball over the plate, its centre at these heights [mm]."""
    shift = np.zeros((len(heights), 3))
    shift[:, 1] = np.asarray(heights) * MM
    return Motion(0.1 * np.arange(len(heights)), RigidTransform.from_translation(shift))


def analysed(heights=(22.0, 21.0, 20.5, 30.0), every=1, settings=None, motion=None):
    """Bodies, motion, evolution and maps."""
    ball, ground = (
        Surface(v * MM, f, name) for (v, f), name in ((sphere(R, 8), "ball"), (block(40.0, 40.0, 10.0, 16), "plate"))
    )
    motion = moved(heights) if motion is None else motion
    settings = settings or Settings(
        (1 * MM, T * MM), refinement=AS_GIVEN, split=Plane.across("z"), medial_side=-1, sensitivity=WIDE
    )
    maps = DistanceMaps(ball, ground, every)
    evolution = area_evolution(ball, ground, motion, settings, each=maps.add)
    return ball, ground, motion, settings, evolution, maps


def told(*args, **kwargs):
    """What the page tells, all frames kept."""
    *known, maps = analysed(*args, **kwargs)
    return Told(*known, maps, np.arange(len(maps.frames)))


def page(*args, **kwargs):
    """The page before it becomes HTML, and the areas."""
    here = told(*args, **kwargs)
    return contact_page.contact_page(here, ""), here.evolution


def section(found, kind, n=0):
    return [s for s in found.sections if isinstance(s, kind)][n]
