"""Pressures of a layer along a motion: the layer as it is given, and the load of every frame."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.options import FLAT, AreaOptions
from geocontact.analyses.frame.bodies import confined_modulus, measured_thickness
from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.curvature import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import surface_quadrature
from geocontact.loads.foundation import Layer, Pressed, Skin, pressed
from geocontact.loads.pressure_load import PressureLoad

Faces = Bool[np.ndarray, " f"]


def layer_given(fixed: Surface, faces: Faces | None, settings: Settings, o: AreaOptions, edge: float) -> Layer:
    """FIXED's layer in pieces of at most `edge` [m]."""
    try:
        pieces = surface_quadrature(fixed, edge, faces)
    except ValueError as error:
        raise InputError("", "`piece`", str(error), "give a longer edge") from error
    thickness = measured_thickness(fixed, pieces.point, pieces.normal, o.thickness, "`thickness`")
    parts: dict[str, Bool[np.ndarray, " p"]] = {}
    if settings.split is not None:
        medial = settings.split.height(pieces.point) * settings.medial_side > 0.0
        parts = {"medial": medial, "lateral": ~medial}
    height = None if o.facets == FLAT else phong_offset(fixed, corner_normals(fixed), pieces.face, pieces.point)
    return Layer(pieces, thickness, confined_modulus(o.modulus, o.poisson), o.foundation or "linear", parts, height)


def skin_given(moving: Surface, o: AreaOptions) -> Skin:
    """What MOVING brings: smooth facets unless flat, and a layer where its modulus is given."""
    normals = None if o.facets == FLAT else corner_normals(moving)
    if o.modulus_moving is None:
        return Skin(normals)
    centres = moving.vertices[moving.faces].mean(axis=1)
    thickness = measured_thickness(moving, centres, moving.face_normal, o.thickness_moving, "`thickness_moving`")
    return Skin(normals, thickness, confined_modulus(o.modulus_moving, o.poisson_moving))


PIECE = 0.5e-3  # m; longest edge of a piece unless given
AGREED = 0.01  # of the force; pieces of half the size may change it by no more without a word
STRAINED = 0.2  # largest strain that the linear law is trusted to


@dataclass(frozen=True, eq=False)
class PressureEvolution:
    """Load on the layer in every frame, and the mean pressure of FIXED's faces in some.

    Parameters
    ----------
    loads
        Whole load, one per frame.
    parts
        Load of each compartment, one per frame.
    frames, pressure
        Numbers of the frames kept and pressure [Pa] of each face in them.
    heaviest
        Number of the frame with the largest force, which is among them.
    layer, skin, touched, strain
        The layer, what MOVING brings, which of its pieces were pressed in some frame, and its largest strain [-].
    finer
        Largest force again, with pieces of half the size [N].
    """

    loads: list[PressureLoad]
    parts: dict[str, list[PressureLoad]]
    frames: list[int]
    pressure: Float[np.ndarray, "k f"]
    heaviest: int
    layer: Layer
    skin: Skin
    touched: Bool[np.ndarray, " p"]
    strain: float
    finer: float

    @property
    def pressing(self) -> Float[np.ndarray, " t"]:
        """Force of each frame [N]."""
        return np.array([load.pressing for load in self.loads])

    @property
    def sides(self) -> dict[str, list[PressureLoad]]:
        """Loads of each compartment and of the "total"."""
        return {**self.parts, "total": self.loads}

    @property
    def maps(self) -> dict[int, Float[np.ndarray, " f"]]:
        """Mean pressure of each face [Pa], by the number of the frame."""
        return dict(zip(self.frames, self.pressure, strict=True))

    @property
    def thickness(self) -> tuple[float, float]:
        """Least and greatest thickness of what was pressed, or of all where nothing was [m]."""
        pressed_on = self.layer.thickness[self.touched] if self.touched.any() else self.layer.thickness
        return float(pressed_on.min()), float(pressed_on.max())


class _Gathered:
    """Takes in frame after frame: all loads, and the pressures of some frames and of that with the largest force."""

    def __init__(self, layer: Layer, faces: int, kept: Sequence[int]) -> None:
        self.layer, self._faces, self._kept = layer, faces, kept
        self.loads: list[PressureLoad] = []
        self.parts: dict[str, list[PressureLoad]] = {side: [] for side in layer.parts}
        self.maps: dict[int, Float[np.ndarray, " f"]] = {}
        self.heaviest, self.strain = 0, 0.0
        self.touched = np.zeros(len(layer.pieces.area), bool)

    def add(self, found: Pressed) -> None:
        """Take in the next frame."""
        frame = len(self.loads)
        self.loads.append(found.load)
        for side, part in found.parts.items():
            self.parts[side].append(part)
        self.strain = max(self.strain, found.strain)
        self.touched |= found.pressure > 0.0
        largest = frame == 0 or found.load.pressing > self.loads[self.heaviest].pressing
        if largest:
            if self.heaviest not in self._kept:
                self.maps.pop(self.heaviest, None)
            self.heaviest = frame
        if largest or frame in self._kept:
            self.maps[frame] = self.layer.pieces.face_means(found.pressure, self._faces)


def pressure_evolution(
    bodies: Bodies, o: AreaOptions, name: str, motion: Motion, kept: Sequence[int]
) -> PressureEvolution:
    """Loads of all frames; pressures of the frames in `kept` and of the one with the largest force."""
    moving, fixed, settings = bodies.moving, bodies.fixed, bodies.settings
    if not moving.closed:
        what = f"{moving.name} is open ({moving.topology.why_open}): it has no inside, so there is no depth"
        raise InputError("", "`pressure`", what, "close it, or see `assume_closed` moving")
    edge = PIECE if o.piece is None else o.piece
    layer = layer_given(fixed, settings.fixed_faces, settings, o, edge)
    skin = skin_given(moving, o)
    rotation = np.ascontiguousarray(motion.poses.rotation.as_matrix().reshape(-1, 3, 3))
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    found = _Gathered(layer, len(fixed.faces), kept)
    with (
        ThreadPoolExecutor(o.workers or os.cpu_count() or 1) as pool,
        listener().progress(f"pressure {name}".strip(), len(motion)) as step,
    ):
        for frame in pool.map(lambda r, t: pressed(layer, moving, r, t, skin), rotation, translation):
            found.add(frame)
            step()
    worst = found.heaviest
    around = _around(fixed, found.maps[worst] > 0.0, settings.fixed_faces)
    finer = layer_given(fixed, around, settings, o, 0.5 * edge)
    again = pressed(finer, moving, rotation[worst], translation[worst], skin).load.pressing
    evolution = _evolution(found, skin, again)
    _summarise(evolution, name)
    return evolution


def _evolution(found: _Gathered, skin: Skin, finer: float) -> PressureEvolution:
    frames = sorted(found.maps)
    return PressureEvolution(
        loads=found.loads,
        parts=found.parts,
        frames=frames,
        pressure=np.array([found.maps[k] for k in frames]),
        heaviest=found.heaviest,
        layer=found.layer,
        skin=skin,
        touched=found.touched,
        strain=found.strain,
        finer=finer,
    )


def _around(fixed: Surface, faces: Faces, counted: Faces | None) -> Faces:
    """These faces and their neighbours, as far as they count."""
    touched = np.zeros(len(fixed.vertices), bool)
    touched[fixed.faces[faces]] = True
    near = touched[fixed.faces].any(axis=1)
    return np.asarray(near if counted is None else near & counted)


def _summarise(e: PressureEvolution, name: str) -> None:
    force, again, layer, strain = e.loads[e.heaviest].pressing, e.finer, e.layer, e.strain
    off = abs(force - again) / again if again > 0.0 else 0.0
    if off > AGREED:
        reserve(f"pieces of half the size change the largest force by {off:.1%}; give a smaller `piece`")
    if not force > 0.0:
        reserve("the bodies never overlap: an elastic layer is not pressed, and all forces are 0")
    if layer.law == "linear" and strain > STRAINED:
        reserve(f"the layer is strained by up to {strain:.0%}: `foundation` logarithmic is for that")
    note(
        f"pressure {name}".strip(),
        {
            "law": layer.law,
            "layer_modulus_Pa": layer.modulus,
            "pieces": len(layer.pieces.area),
            "largest_force_N": round(force, 6),
            "with_pieces_of_half_the_size_N": round(again, 6),
            "largest_pressure_Pa": max(load.peak for load in e.loads),
            "largest_strain": round(strain, 6),
            "thickness_mm": [round(float(v) * 1e3, 4) for v in (layer.thickness.min(), layer.thickness.max())],
            "facets": "flat" if e.skin.normals is None else "smooth",
            "layer_modulus_moving_Pa": None if e.skin.thickness is None else e.skin.modulus,
        },
    )
    label = f"{name}: " if name else ""
    peak = max(load.peak for load in e.loads)
    say(f"{label}{layer.law} foundation: force up to {force:.1f} N, pressure up to {peak * 1e-6:.2f} MPa")
