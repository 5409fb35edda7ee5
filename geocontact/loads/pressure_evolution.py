"""Pressures of an elastic layer along a motion: the load of every frame, and maps of some of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.data.motion import Motion
from geocontact.geometry.surface import Surface
from geocontact.loads.foundation import Layer, Pressed, Skin, pressed
from geocontact.loads.pressure_load import PressureLoad

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

    def table(self, time: Float[np.ndarray, " t"]) -> pd.DataFrame:
        """A row per frame, at these times [s]: force on the layer, its moment about the frame's origin, centre of
        pressure (empty without load), largest pressure and area under pressure, of all and of each compartment.
        """
        wrenches = [load.wrench for load in self.loads]
        columns: dict[str, object] = {"time [s]": time, "force [N]": self.pressing}
        for axis, letter in enumerate("xyz"):
            columns[f"force_{letter} [N]"] = [w.force[axis] for w in wrenches]
        for axis, letter in enumerate("xyz"):
            columns[f"moment_{letter} [N m]"] = [w.moment[axis] for w in wrenches]
        columns |= _columns("", self.loads)
        for side, loads in self.parts.items():
            columns[f"force_{side} [N]"] = [load.pressing for load in loads]
            columns |= _columns(f"_{side}", loads)
        return pd.DataFrame(columns)


def _columns(suffix: str, loads: Sequence[PressureLoad]) -> dict[str, object]:
    centres = np.array([load.centre for load in loads]) * 1e3
    return {
        f"peak{suffix} [MPa]": [load.peak * 1e-6 for load in loads],
        f"pressed_area{suffix} [mm^2]": [load.area * 1e6 for load in loads],
        **{f"cop{suffix}_{letter} [mm]": centres[:, axis] for axis, letter in enumerate("xyz")},
    }


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
    layer: Layer,
    fixed: Surface,
    moving: Surface,
    motion: Motion,
    skin: Skin,
    kept: Sequence[int],
    finer: Callable[[Faces], Layer],
    workers: int | None = None,
    step: Callable[[], None] = lambda: None,
    each: Callable[[Pressed], None] = lambda found: None,
) -> PressureEvolution:
    """Load on an elastic layer in every frame of a motion.

    Parameters
    ----------
    layer, fixed
        The layer, and the surface that it is on.
    moving, skin
        The closed body that presses into it, and what it brings besides its triangles.
    motion
        Poses of MOVING in FIXED.
    kept
        Frames whose pressures are kept as means of FIXED's faces; that with the largest force is kept in any case.
    finer
        Makes the same layer of smaller pieces under the faces marked, for the largest force again: those that are
        pressed then, and their neighbours.
    workers
        Threads; all cores unless stated. The figures do not depend on it.
    step
        Called after each frame.
    each
        Called with what is found of each frame, in their order: `loads.wear.Wearing` gathers so.

    Raises
    ------
    ValueError
        `moving` is open: without an inside there is no depth.
    """
    rotation = np.ascontiguousarray(motion.poses.rotation.as_matrix().reshape(-1, 3, 3))
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    found = _Gathered(layer, len(fixed.faces), kept)
    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        for frame in pool.map(lambda r, t: pressed(layer, moving, r, t, skin), rotation, translation):
            found.add(frame)
            each(frame)
            step()
    worst = found.heaviest
    again = pressed(finer(_around(fixed, found.maps[worst] > 0.0)), moving, rotation[worst], translation[worst], skin)
    return _evolution(found, skin, again.load.pressing)


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


def _around(fixed: Surface, faces: Faces) -> Faces:
    """These faces and their neighbours."""
    touched = np.zeros(len(fixed.vertices), bool)
    touched[fixed.faces[faces]] = True
    return np.asarray(touched[fixed.faces].any(axis=1))
