"""The paper's figures 2 to 7 of trials of standing up, recorded and modelled; see `benchmarks.standing.sites`.

Phase A: 2, force of the ground and its centre of pressure; 3, angles and rates of both chains. Phase B: 4, normal
forces of the straps; 5, torques of both chains. Phase C, by the calibrated straps and by stiffer ones: 6, angles and
rates of one trial; 7, normal forces of the straps of two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

HINGES = ("ankle", "knee", "hip", "exo_ankle", "exo_knee", "exo_hip")
GROUND = ("force_x", "force_y", "centre")
KINEMATICS = (*HINGES, *(f"{name} rate" for name in HINGES))
STRAPS = ("pelvis strap", "strap", "shank strap")
TORQUES = tuple(f"{name} torque" for name in HINGES)
CHAIN = {"A": {2: GROUND, 3: KINEMATICS}, "B": {4: STRAPS, 5: TORQUES}, "C": {6: KINEMATICS, 7: STRAPS}}
"""Channels of each figure, by phase."""

Curves = Mapping[str, Sequence[Any]]
"""Channels of trials or of predictions, by what they are called."""


def draw(folder: Path, phase: str, time: Mapping[str, Any], curves: Curves, grey: Mapping[str, str]) -> None:
    """figure_2.png and so on. `time` and the name of what is recorded beside it go by the names of curves."""
    from geocontact.view.curves.style import save

    for number, names in CHAIN[phase].items():
        save(drawn(names, time, curves, grey), folder / f"figure_{number}.png")


def drawn(names: Sequence[str], time: Mapping[str, Any], curves: Curves, grey: Mapping[str, str]) -> Any:
    """A panel for each channel; grey as recorded, once for all curves of the same trial."""
    import numpy as np

    from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, panels, style

    with style():
        figure, axes = panels(-(-len(names) // 3), 3, DOUBLE, 0.045 * -(-len(names) // 3) + 0.01)
        for ax, name in zip(axes, names, strict=True):
            seen = set()
            for k, (label, channels) in enumerate(curves.items()):
                one = next((each for each in channels if each.name == name), None)
                if one is None:
                    continue
                if np.isfinite(one.recorded).all() and grey[label] not in seen:
                    ax.plot(time[label], one.factor * one.recorded, color=GREY, lw=0.8)
                    seen.add(grey[label])
                ax.plot(time[label], one.factor * one.model, color=PALETTE[k % len(PALETTE)], lw=1.0, label=label)
                ax.set_title(f"{name} [{one.unit}]")
            ax.set_xlabel("time [s]")
        axes[0].legend(fontsize=5)
    return figure
