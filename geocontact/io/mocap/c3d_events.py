"""Heel strikes that a .c3d file marks, read by ezc3d in a process of its own as force plates are.

`python -m geocontact.io.mocap.c3d_events FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import sys
from os import PathLike

import numpy as np
from jaxtyping import Float

from geocontact.io.mocap.c3d_plates import Arrays, read_apart

STRIKE = ("foot strike", "heel strike", "foot contact", "initial contact")
"""Labels of a foot that comes to the ground, without regard to case."""


def read_c3d_strikes(path: str | PathLike[str]) -> dict[str, Float[np.ndarray, " k"]]:
    """Times of heel strikes [s] by side, "right" and "left"; empty where the file marks none."""
    found: dict[str, list[float]] = {}
    for side, _, time in read_c3d_events(path, STRIKE):
        found.setdefault(side, []).append(time)
    return {side: np.unique(times) for side, times in found.items()}


def read_c3d_events(path: str | PathLike[str], labels: tuple[str, ...]) -> list[tuple[str, str, float]]:
    """Side, label in small letters and time [s] of the events that are called so, in the order of the file."""
    arrays = read_apart(path, __name__, analogs=False)
    events = zip(arrays["contexts"], arrays["labels"], arrays["times"], strict=True)
    every = [(str(side).lower(), str(label).lower(), float(time)) for side, label, time in events]
    return [each for each in every if each[0] in ("right", "left") and each[1] in labels]


def events_of(path: str) -> Arrays:
    """Context, label and time [s] of every event, in this process; the file has minutes and seconds apart."""
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path)
    told = content["parameters"].get("EVENT", {})
    lists = [[str(each).strip() for each in told.get(key, {"value": []})["value"]] for key in ("CONTEXTS", "LABELS")]
    times = np.asarray(told.get("TIMES", {"value": np.zeros((2, 0))})["value"], float).reshape(2, -1)
    count = min(*map(len, lists), times.shape[1])
    return {
        "frames": np.array(content["data"]["points"].shape[2]),
        "contexts": np.array(lists[0][:count], dtype=str),
        "labels": np.array(lists[1][:count], dtype=str),
        "times": (60.0 * times[0] + times[1])[:count],
    }


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **events_of(sys.argv[1]))  # type: ignore[arg-type]
