"""What is shown of a contact equilibrium: bodies with pressures, forces, pose, and how far to trust them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.pages import Thinned
from geocontact.analyses.frame.words import MOST, NOT_A_DEVICE, headline
from geocontact.analyses.knee.settle.equilibrium import SIDES, Settled
from geocontact.loads.settling_potential import NAMES
from geocontact.view.page.content import Curve, Curves, FaceMap, Page, Readout, Row, Scene, SceneBody, Section, Words
from geocontact.view.surfaces.camera import camera_directions

FRAMES = 101  # that the page animates at most
FEWEST = 6
UNUSED = 1e-3  # m; a threshold, which a scene has even where no distance is shown
MM, MPA = 1e3, 1e-6
FROM_ABOVE = (0.25, 1.0, 0.0)  # the load is along -y: from the front the rim of an insert hides the pressures


def thinned_page(s: Settled, sentences: Sequence[str]) -> Thinned:
    """The page, of as many frames as its file holds."""
    return Thinned(lambda most: settle_page(s, sentences, _shown(s, most)), FRAMES, FEWEST)


def settle_page(s: Settled, sentences: Sequence[str], frames: Int[np.ndarray, " k"]) -> Page:
    """The page of some frames; `frames` are numbers of frames at rest."""
    course = s.inputs.motion.course
    place = int(np.flatnonzero(frames == s.heaviest)[0])
    found = Words("What was found", list(sentences))
    return Page(
        title=s.inputs.title,
        subtitle=f"Contact equilibrium of {len(s.frames)} frames",
        time=course.values[frames],
        time_label=course.label,
        headline=headline(sentences),
        facts=_facts(s),
        start_frame=place,
        sections=(
            _scene(s, frames),
            Readout(_rows(s, frames)),
            *_curves(s, frames),
            *([found] if len(sentences) > MOST else []),
            *_words(s),
        ),
        numbers=frames + 1,
        total=len(s.frames),
    )


def _facts(s: Settled) -> list[tuple[str, str]]:
    """Largest pressure and when, areas, share of the force on the medial side."""
    peaks, areas = MPA * s.peaks, MM**2 * s.areas
    worst = int(np.nanargmax(peaks))
    shares = 100.0 * s.forces("medial") / s.forces("total")
    of_load = {f"{each(shares):.0f}" for each in (np.nanmin, np.nanmax)}
    return [
        ("Largest contact pressure", f"{peaks[worst]:.2f} MPa at {s.inputs.motion.course.values[worst]:.3g} s"),
        ("Contact area", f"{np.nanmin(areas):.1f} … {np.nanmax(areas):.1f} mm²"),
        ("Part of the force that is medial", f"{' … '.join(sorted(of_load, key=float))} %"),
        ("Frames at rest", f"{int(s.converged.sum())} of {len(s.frames)}"),
    ]


def _shown(s: Settled, most: int) -> Int[np.ndarray, " k"]:
    kept = s.kept
    found: Int[np.ndarray, " k"] = np.unique([*kept[:: -(-len(kept) // most)], s.heaviest])
    return found


def _scene(s: Settled, frames: Int[np.ndarray, " k"]) -> Scene:
    fixed, moving = s.inputs.fixed, s.inputs.bed.moving
    at = np.searchsorted(s.kept, frames)
    pressure = np.array([s.face_pressure(int(k)) for k in frames]) * MPA
    return Scene(
        bodies=(
            SceneBody(fixed.name, fixed.vertices, fixed.faces),
            SceneBody(moving.name, moving.vertices, moving.faces, s.poses[at]),
        ),
        thresholds=(UNUSED,),
        span=(0.0, UNUSED),
        directions=camera_directions(s.inputs.medial),
        view=FROM_ABOVE,
        maps=(FaceMap("mean pressure of each face", "MPa", 0, pressure),),
    )


def _rows(s: Settled, frames: Int[np.ndarray, " k"]) -> list[Row]:
    angles = np.degrees(s.knee_angles[frames])
    return [
        Row("load", "N", _texts(s.inputs.load[frames], 1)),
        *(Row(f"force, {side}", "N", _texts(s.forces(side)[frames], 1)) for side in SIDES[:2]),
        Row("largest pressure", "MPa", _texts(s.peaks[frames] * MPA, 2)),
        Row("contact area", "mm²", _texts(s.areas[frames] * 1e6, 1)),
        *(Row(name, "deg", _texts(angles[:, k], 2)) for k, name in enumerate(("flexion", "adduction", "rotation"))),
        *(Row(name, "mm", _texts(s.coordinates[frames, k] * MM, 3)) for k, name in enumerate(NAMES[:3])),
        Row("residual force", "N", [f"{value:.1e}" for value in s.residuals[frames]]),
    ]


def _curves(s: Settled, frames: Int[np.ndarray, " k"]) -> list[Section]:
    angles = np.degrees(s.knee_angles[frames])
    return [
        Curves("Contact force", "N", [Curve(side, s.forces(side)[frames]) for side in SIDES]),
        Curves("Largest contact pressure", "MPa", [Curve("largest pressure", s.peaks[frames] * MPA)]),
        Curves("Contact area", "mm²", [Curve("area of FIXED under pressure", s.areas[frames] * 1e6)]),
        Curves("Turns", "deg", [Curve("adduction", angles[:, 1]), Curve("internal rotation", angles[:, 2])]),
        Curves("Shifts", "mm", [Curve(name, s.coordinates[frames, k] * MM) for k, name in enumerate(NAMES[:3])]),
    ]


def _words(s: Settled) -> list[Section]:
    free = [name for name, moves in zip(NAMES, s.inputs.free, strict=True) if moves]
    held = [name for name, moves in zip(NAMES, s.inputs.free, strict=True) if not moves]
    layer = s.inputs.bed.layer
    model = (
        f"MOVING is rigid. FIXED is a layer of springs that do not know each other ({layer.law} law, confined modulus "
        f"{layer.modulus * MPA:.0f} MPa, thickness {layer.thickness.min() * MM:.1f} to "
        f"{layer.thickness.max() * MM:.1f} mm). Settled: {', '.join(free)}. "
        f"Taken from the motion: {', '.join(held)}. There is no friction, no ligament and no muscle "
        "but the load and the springs named in the options; every frame is at rest."
    )
    trust = (
        "Pressures depend on modulus and thickness, and on how close the surfaces are: a few hundredths of a "
        "millimetre change the share of the two sides. Compare a smaller piece and a finer mesh."
    )
    return [Words("The model", [model]), Words("How far to trust it", [trust, NOT_A_DEVICE])]


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]
