"""Pressures on FIXED as an elastic layer, frame by frame: from options to numbers."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.analyses import quantities
from geocontact.analyses.area.pressure_layers import PIECE, layer_given, skin_given
from geocontact.analyses.progress import progress
from geocontact.analyses.run_record import Record
from geocontact.cli.area import AreaOptions
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import Layer, Skin, pressed
from geocontact.loads.pressure_load import PressureLoad

AGREED = 0.01  # of the force; pieces of half the size may change it by no more without a word
STRAINED = 0.2  # largest strain that the linear law is trusted to
Faces = Bool[np.ndarray, " f"]


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
    def thickness(self) -> tuple[float, float]:
        """Least and greatest thickness of what was pressed, or of all where nothing was [m]."""
        pressed_on = self.layer.thickness[self.touched] if self.touched.any() else self.layer.thickness
        return float(pressed_on.min()), float(pressed_on.max())


def pressure_evolution(
    record: Record, moving: Surface, fixed: Surface, motion: Motion, settings: Settings, o: AreaOptions,
    kept: list[int], name: str,
) -> PressureEvolution:  # fmt: skip
    """Loads of all frames; pressures of the frames in `kept` and of the one with the largest force."""
    if not moving.closed:
        what = f"{moving.name} is open ({moving.topology.why_open}): it has no inside, so there is no depth"
        raise InputError("", "--pressure", what, "close it, or see --assume-closed moving")
    edge = quantities.length(PIECE if o.piece is None else o.piece, "--piece")
    layer = layer_given(record, fixed, settings.fixed_faces, settings, o, edge)
    skin = skin_given(record, moving, o)
    rotation = np.ascontiguousarray(motion.poses.rotation.as_matrix().reshape(-1, 3, 3))
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    loads: list[PressureLoad] = []
    parts: dict[str, list[PressureLoad]] = {side: [] for side in layer.parts}
    maps: dict[int, np.ndarray] = {}
    heaviest, strain = 0, 0.0
    touched = np.zeros(len(layer.pieces.area), bool)
    with (
        ThreadPoolExecutor(o.workers or os.cpu_count() or 1) as pool,
        progress(f"pressure {name}".strip(), len(motion)) as step,
    ):
        for k, found in enumerate(pool.map(lambda r, t: pressed(layer, moving, r, t, skin), rotation, translation)):
            loads.append(found.load)
            for side, part in found.parts.items():
                parts[side].append(part)
            strain = max(strain, found.strain)
            touched |= found.pressure > 0.0
            first = k == 0 or found.load.pressing > loads[heaviest].pressing
            if first and heaviest not in kept:
                maps.pop(heaviest, None)
            heaviest = k if first else heaviest
            if first or k in kept:
                maps[k] = layer.pieces.face_means(found.pressure, len(fixed.faces))
            step()
    frames = sorted(maps)
    around = _around(fixed, maps[heaviest] > 0.0, settings.fixed_faces)
    finer = layer_given(record, fixed, around, settings, o, 0.5 * edge)
    again = pressed(finer, moving, rotation[heaviest], translation[heaviest], skin).load.pressing
    pressure = np.array([maps[k] for k in frames])
    evolution = PressureEvolution(loads, parts, frames, pressure, heaviest, layer, skin, touched, strain, again)
    _summarise(record, evolution, name)
    return evolution


def _around(fixed: Surface, faces: Faces, counted: Faces | None) -> Faces:
    """These faces and their neighbours, as far as they count."""
    touched = np.zeros(len(fixed.vertices), bool)
    touched[fixed.faces[faces]] = True
    near = touched[fixed.faces].any(axis=1)
    return np.asarray(near if counted is None else near & counted)


def _summarise(record: Record, e: PressureEvolution, name: str) -> None:
    force, again, layer, strain = e.loads[e.heaviest].pressing, e.finer, e.layer, e.strain
    off = abs(force - again) / again if again > 0.0 else 0.0
    if off > AGREED:
        record.warn(f"pieces of half the size change the largest force by {off:.1%}; give a smaller --piece")
    if not force > 0.0:
        record.warn("the bodies never overlap: an elastic layer is not pressed, and all forces are 0")
    if layer.law == "linear" and strain > STRAINED:
        record.warn(f"the layer is strained by up to {strain:.0%}: --foundation logarithmic is for that")
    record.results[f"pressure {name}".strip()] = {
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
    }
    label = f"{name}: " if name else ""
    peak = max(load.peak for load in e.loads)
    record.say(f"{label}{layer.law} foundation: force up to {force:.1f} N, pressure up to {peak * 1e-6:.2f} MPa")


def pressure_table(motion: Motion, e: PressureEvolution) -> pd.DataFrame:
    """A row per frame: force on FIXED, its moment about the frame's origin, centre of pressure (empty without load)."""
    wrenches = [load.wrench for load in e.loads]
    columns: dict[str, object] = {"time [s]": motion.time, "force [N]": e.pressing}
    for axis, letter in enumerate("xyz"):
        columns[f"force_{letter} [N]"] = [w.force[axis] for w in wrenches]
    for axis, letter in enumerate("xyz"):
        columns[f"moment_{letter} [N m]"] = [w.moment[axis] for w in wrenches]
    columns |= _columns("", e.loads)
    for side, loads in e.parts.items():
        columns[f"force_{side} [N]"] = [load.pressing for load in loads]
        columns |= _columns(f"_{side}", loads)
    return pd.DataFrame(columns)


def _columns(suffix: str, loads: list[PressureLoad]) -> dict[str, object]:
    centres = np.array([load.centre for load in loads]) * 1e3
    return {
        f"peak{suffix} [MPa]": [load.peak * 1e-6 for load in loads],
        f"pressed_area{suffix} [mm^2]": [load.area * 1e6 for load in loads],
        **{f"cop{suffix}_{letter} [mm]": centres[:, axis] for axis, letter in enumerate("xyz")},
    }
