"""The words that a reviewer of a contact-area analysis looks for, with this analysis's own numbers in them.

The order follows ASME V&V 40 (question of interest, context of use, credibility of the model, its numerical error).
"""

from __future__ import annotations

import numpy as np

from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.data.evolution import MM, MM2, AreaEvolution
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.rules import CLIP, REFINED
from geocontact.geometry.surface import Surface
from geocontact.view.page.content import Words


def reviewers_words(
    moving: Surface,
    fixed: Surface,
    settings: Settings,
    e: AreaEvolution,
    main: int,
    shown: int,
    pressed: bool = False,
) -> list[Words]:
    """Question, context of use, numerical error, and what was not checked."""
    return [
        Words("Question", [_question(moving, fixed, settings, e, main)]),
        Words("Context of use", [_context(e, pressed), NOT_A_DEVICE]),
        Words("Numerical error", _error(settings, e, main)),
        Words("What the numbers do not contain", _missing(len(e.time), shown)),
    ]


def _question(moving: Surface, fixed: Surface, settings: Settings, e: AreaEvolution, main: int) -> str:
    said = (
        f"How much of the surface of {fixed.name} (fixed) lies within {e.thresholds[main] * MM:g} mm of {moving.name} "
        f"(moving), where, and how does it change over the motion? Parts that overlap count as contact."
    )
    for body, faces in ((fixed, settings.fixed_faces), (moving, settings.moving_faces)):
        if faces is not None:
            said += f" Of {body.name} only {int(faces.sum())} of {len(faces)} faces count; the others are left grey."
    return said


def _context(e: AreaEvolution, pressed: bool) -> str:
    signs = {
        "both": "Both surfaces are closed, so distances carry a sign and overlap is known on both.",
        "fixed": "The moving surface is closed, the fixed one is not: overlap is known on the fixed surface only.",
        "moving": "The fixed surface is closed, the moving one is not: overlap is known on the moving surface only.",
        "none": "Neither surface is closed: distances are unsigned and overlap cannot be told from closeness.",
    }
    forces = (
        "areas and distances are those of undeformed bodies, and pressures those of a layer that they overlap in. "
        if pressed
        else "nothing deforms, no force is computed. "
    )
    return (
        f"Geometric contact of two rigid triangulated surfaces in given poses: {forces}"
        "An area within a threshold is a measure of congruence; it is the area that carries load only as far as the "
        f"threshold stands for the deformation. {signs[e.signed]}"
    )


def _error(settings: Settings, e: AreaEvolution, main: int) -> list[str]:
    area, lower, upper = (values[:, main] * MM2 for values in (e.fixed.area, e.fixed.lower, e.fixed.upper))
    widest = int(np.argmax(upper - lower))
    bounds = (
        f"The true area of the two triangulated surfaces lies between the bounds shown in every frame; they are "
        f"{upper[widest] - lower[widest]:.1f} mm² apart at most (frame {widest + 1}, area {area[widest]:.1f} mm²). "
        "They follow from the 1-Lipschitz property of the distance. "
    )
    if settings.rule == REFINED:
        bounds += (
            f"Triangles in doubt were divided; the estimated error of the area is "
            f"{e.fixed.error[:, main].max() * MM2:.2g} mm² at most."
        )
    elif settings.rule == CLIP:
        bounds += "Triangles were cut once where the distance, taken as linear between corners, is the threshold."
    else:
        bounds += (
            f"The areas themselves were counted in whole triangles (rule {settings.rule}): they may lie outside the "
            "bounds, and they change with the mesh in the first order of its edges."
        )
    sides = f"Up to {int(e.undecided.max(initial=0))} points per frame have no decidable side and count as outside."
    picture = (
        "The colours and the threshold contour on the picture interpolate 8-bit distances between vertices; the "
        "numbers do not come from the picture."
    )
    return [bounds, sides, picture] if e.undecided.any() else [bounds, picture]


def _missing(frames: int, shown: int) -> list[str]:
    inputs = (
        "How well the triangles resemble the parts, how well the parts resemble worn or loaded ones, and how well the "
        "motion was measured: tenths of a millimetre there matter more than all of the above. Repeat with another mesh "
        "resolution and see the strip of thresholds before concluding."
    )
    validation = (
        "Validation against measured contact areas is not part of this page unless a comparison table is shown."
    )
    thinned = f"The page shows {shown} of {frames} frames; the table file holds all of them."
    return [inputs, validation, thinned] if shown < frames else [inputs, validation]
