"""A .c3d file with one force plate, composed by hand: what its channels must read under a known load."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

FRAMES, PER_FRAME, RATE = 100, 10, 100.0
CENTRE = np.array([0.460, 0.240, 0.0])
"""Where the load acts [m], on a plate from (0.2, 0) to (0.6, 0.4) m."""

PEAK, FREE = 700.0, 1.4
"""Largest normal force [N], and the free moment at it [N m]."""

_MIDDLE, _DEEP = np.array([0.4, 0.2, 0.0]), 0.040


def stance() -> np.ndarray:
    """Share of the peak at each sample: nothing, half a sine from 0.3 to 0.7 s, nothing."""
    time = np.arange(FRAMES * PER_FRAME) / (RATE * PER_FRAME)
    return np.where((time >= 0.3) & (time <= 0.7), np.sin(np.pi * (time - 0.3) / 0.4), 0.0)


def channels(share: np.ndarray, at: np.ndarray = CENTRE) -> np.ndarray:
    """(6, t) Fx Fy Fz [N] Mx My Mz [N m] of a type 2 plate whose x is the laboratory's, y and z are turned over.

    Its moments are about a point 40 mm below the surface: M = r x F + T, with r from there to the load.
    """
    force = share[:, None] * np.array([30.0, -20.0, PEAK])
    r = (at - _MIDDLE) * np.array([1.0, -1.0, 1.0]) - np.array([0.0, 0.0, _DEEP])
    moment = np.cross(r, force) + share[:, None] * np.array([0.0, 0.0, FREE])
    return np.column_stack([force, moment]).T


def plate_file(
    file: Path,
    values: np.ndarray,
    units: tuple[str, str, str] = ("mm", "N", "Nmm"),
    length: float = 1e-3,
    moment: float = 1e-3,
    **platform: Any,
) -> Path:
    """The file: `values` as `channels` has them; `units` of points, forces and moments, of `length` m, `moment` N m.

    `platform` are further parameters of FORCE_PLATFORM and ANALOG (`ANALOG_BITS`), or other values of them.
    """
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    content = ezc3d.c3d()
    point, analog = content["parameters"]["POINT"], content["parameters"]["ANALOG"]
    point["UNITS"]["value"], point["RATE"]["value"] = [units[0]], [RATE]
    point["LABELS"]["value"] = ["HEE"]
    analog["LABELS"]["value"] = ["Fx1", "Fy1", "Fz1", "Mx1", "My1", "Mz1"]
    analog["UNITS"]["value"] = [units[1]] * 3 + [units[2]] * 3
    analog["RATE"]["value"] = [RATE * PER_FRAME]
    content["data"]["points"] = np.tile(np.array([0.3, 0.2, 0.1, length])[:, None, None] / length, (1, 1, FRAMES))
    content["data"]["analogs"] = (values / np.array([1.0] * 3 + [moment] * 3)[:, None])[None]
    corners = np.array([[0.6, 0.0, 0.0], [0.2, 0.0, 0.0], [0.2, 0.4, 0.0], [0.6, 0.4, 0.0]]).T / length
    told: dict[str, Any] = {
        "USED": [1],
        "TYPE": [2],
        "ZERO": [0, 0],
        "CORNERS": corners[:, :, None],
        "ORIGIN": np.array([[0.0], [0.0], [-_DEEP / length]]),
        "CHANNEL": np.arange(1, 7)[:, None],
    }
    for name, value in (told | platform).items():
        group, parameter = ("ANALOG", name[7:]) if name.startswith("ANALOG_") else ("FORCE_PLATFORM", name)
        if parameter in content["parameters"][group]:
            content["parameters"][group][parameter]["value"] = value
        else:
            content.add_parameter(group, parameter, value)
    content.write(str(file))
    return file
