"""Models for Abaqus/Standard: a surface that is held, a rigid one that moves, contact, and a step for each interval.

Rotations of the reference node are prescribed by velocity, as Abaqus asks for where rotations are finite (Keywords
Reference, *BOUNDARY): the angular velocity is constant over a step, so that each step ends at the pose of its frame.
Components of a rotation vector given by amplitudes would be added up from increments, and end elsewhere where the axis
changes. FIXED is a shell all of whose nodes are held, since a rigid surface cannot be the secondary one; its pressure
is that of a linear pressure-overclosure relation.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.io.finite_elements.rigid_pair import MPA_PER_MM, RigidPair

SHELL = 1e-3
"""Thickness of the shells [mm]: contact is at their surface, half of it from the nodes."""
MPA = 1e-6
UNITS = "units: mm, N, MPa, s, rad"
_MOST = 8
"""Numbers of elements in a line of a set."""


def write_abaqus(file: Path, pair: RigidPair, program: str) -> None:
    """Write the model; without a stiffness there are surfaces, and no contact between them."""
    file.write_text("\n".join([*_bodies(pair, program), *_contact(pair), *_steps(pair), ""]), encoding="ascii")


def _bodies(pair: RigidPair, program: str) -> Iterator[str]:
    yield "*HEADING"
    yield f"MOVING over FIXED, written by {program}"
    for line in (UNITS, *pair.notes):
        yield f"** {line.encode('ascii', 'replace').decode()}"
    fixed, moving = pair.fixed_nodes, pair.moving_nodes
    reference = 1 + len(fixed) + len(moving)
    yield "*NODE"
    for k, place in enumerate(np.vstack([fixed, moving, pair.centre]), start=1):
        yield f"{k}, {_row(place)}"
    for name, first, last in (
        ("FIXED_NODES", 1, len(fixed)),
        ("MOVING_NODES", len(fixed) + 1, reference - 1),
        ("MOVING_REFERENCE", reference, reference),
    ):
        yield f"*NSET, NSET={name}, GENERATE"
        yield f"{first}, {last}, 1"
    faces = {"FIXED": pair.fixed[1] + 1, "MOVING": pair.moving[1] + 1 + len(fixed)}
    starts = {"FIXED": 1, "MOVING": 1 + len(pair.fixed[1])}
    for body, corners in faces.items():
        yield f"*ELEMENT, TYPE=S3, ELSET={body}"
        for k, row in enumerate(corners.tolist(), start=starts[body]):
            yield f"{k}, {row[0]}, {row[1]}, {row[2]}"
    for body, some in zip(faces, pair.contact_faces(), strict=True):
        yield f"*ELSET, ELSET={body}_FACES"
        yield from _listed(some + starts[body])
        yield f"*SURFACE, TYPE=ELEMENT, NAME={body}_SURFACE"
        yield f"{body}_FACES, SPOS"
    yield "*MATERIAL, NAME=LAYER"
    yield "*ELASTIC"
    yield _row((1.0 if pair.young is None else pair.young * MPA, 0.0 if pair.poisson is None else pair.poisson))
    for body in faces:
        yield f"*SHELL SECTION, ELSET={body}, MATERIAL=LAYER"
        yield f"{SHELL:g}"
    yield f"*RIGID BODY, ELSET=MOVING, REF NODE={reference}"
    yield "*BOUNDARY"
    yield "FIXED_NODES, 1, 6"


def _contact(pair: RigidPair) -> Iterator[str]:
    if pair.stiffness is None:
        return
    yield "*SURFACE INTERACTION, NAME=LAYER_CONTACT"
    yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
    yield _number(pair.stiffness * MPA_PER_MM)
    yield "*CONTACT PAIR, INTERACTION=LAYER_CONTACT, TYPE=SURFACE TO SURFACE"
    yield "FIXED_SURFACE, MOVING_SURFACE"


def _steps(pair: RigidPair) -> Iterator[str]:
    """A static step from each frame to the next; its velocities replace those of the step before."""
    lasting = np.diff(pair.clock)
    rows = np.hstack([pair.velocity, pair.angular_velocity])
    for k, (time, row) in enumerate(zip(lasting.tolist(), rows, strict=True), start=1):
        yield f"*STEP, NAME=FRAME_{k + 1}, NLGEOM=YES, INC=1000"
        yield "*STATIC"
        yield _row((time, time))
        yield "*BOUNDARY, TYPE=VELOCITY"
        for freedom, value in enumerate(row.tolist(), start=1):
            yield f"MOVING_REFERENCE, {freedom}, {freedom}, {_number(value)}"
        yield "*OUTPUT, FIELD"
        yield "*NODE OUTPUT"
        yield "U, UR, RF, RM"
        if pair.stiffness is not None:
            yield "*CONTACT OUTPUT"
            yield "CSTRESS, CDISP"
        yield "*END STEP"


def _listed(numbers: Int[np.ndarray, " n"]) -> Iterator[str]:
    for start in range(0, len(numbers), _MOST):
        yield ", ".join(map(str, numbers[start : start + _MOST].tolist()))


def _row(values: Float[np.ndarray, " k"] | Iterable[float]) -> str:
    return ", ".join(_number(float(value)) for value in values)


def _number(value: float) -> str:
    """Twelve digits with a point, by which Abaqus knows a floating-point number."""
    text = f"{value:.12g}"
    return text if any(mark in text for mark in ".en") else f"{text}."
