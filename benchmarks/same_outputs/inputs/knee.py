"""Load cells of a tray, and areas and forces of a knee with a known modulus."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import table, written

PERIOD = 1.1
"""Of a stride [s]."""
CELLS = ("PM", "AM", "AL", "PL")
LEVELS = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
"""Thresholds [mm]."""
MODULUS, RADIUS, SHARE = 6.8e6, 0.037, 0.55
"""Pa, m, and the medial share of the area."""


def make(home: Path, meshes: Path) -> None:
    """Recordings of two styles of walking; a step with its areas at five thresholds, another for predictions."""
    walk(home / "walk.csv", 1.0)
    walk(home / "bouncy.csv", 1.2)
    starts = (0.2, 1.3, 2.4)
    lines = [f"{style},{style},{start},{start + PERIOD}" for style in ("walk", "bouncy") for start in starts]
    written(home / "cycles.csv", "\n".join(["style, recording, start [s], end [s]", *lines]) + "\n")
    written(home / "tray.toml", 'name = "tray"\ncells = ["AL", "PM", "AM", "PL"]\nmedial = [0.1, 0.9, 0.8, 0.0]\n')
    for name, size in (("step", 1.0), ("other", 0.8)):
        step(home / f"{name}_area.csv", home / f"{name}_forces.csv", size)
    time = np.linspace(0.0, 1.0, 41)
    flexion = 25.0 + 20.0 * np.sin(2.0 * np.pi * time)
    table(home / "flexion.csv", {"time [s]": time, "flexion [deg]": flexion})
    table(home / "calibration.csv", {"force [N]": [3000.0, 4000.0], "area [mm^2]": [1650.0, 2000.0]})


def walk(file: Path, height: float) -> None:
    """Cells [N] over four strides, loaded for 60 % of each."""
    time = np.arange(0.0, 5.0, 0.01)
    phase = ((time - 0.2) / PERIOD) % 1.0
    wave = np.where(phase < 0.6, np.sin(np.pi * phase / 0.6), 0.0)
    shares = (500.0 * wave**3, 400.0 * wave, 150.0 * wave, 200.0 * wave**3)
    cells = {name: height * (20.0 + share) for name, share in zip(CELLS, shares, strict=True)}
    table(file, {"time [s]": time, **cells})


def step(areas: Path, forces: Path, size: float) -> None:
    """Areas [mm^2] with two humps over 1.1 s, and the law's forces of them with a ripple [N]."""
    time = np.linspace(0.0, PERIOD, 45)
    phase = np.pi * time / PERIOD
    humps = size * (500.0 * np.sin(phase) ** 2 + 150.0 * np.sin(3.0 * phase))
    area = 600.0 + humps[:, None] + 250.0 * LEVELS + 30.0 * np.outer(np.sin(phase), LEVELS)
    flat = area.ravel()
    columns = {"time [s]": np.repeat(time, len(LEVELS)), "threshold [mm]": np.tile(LEVELS, len(time))}
    columns |= {"area_fixed [mm^2]": flat, "area_fixed_medial [mm^2]": SHARE * flat}
    table(areas, columns | {"area_fixed_lateral [mm^2]": (1.0 - SHARE) * flat})
    force = 4.0 / 3.0 * MODULUS * (1e-6 * area[:, 3] / np.pi) ** 1.5 / RADIUS + 20.0 * np.sin(40.0 * time)
    medial, lateral = force * SHARE**1.5, force * (1.0 - SHARE) ** 1.5
    table(forces, {"time [s]": time, "medial [N]": medial, "lateral [N]": lateral, "total [N]": force})
