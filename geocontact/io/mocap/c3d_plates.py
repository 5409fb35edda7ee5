"""Force plates of a .c3d file, read by ezc3d in a process of its own: damaged files end or stall the library.

`python -m geocontact.io.mocap.c3d_plates FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
from os import PathLike, fspath
from pathlib import Path
from typing import Literal

import numpy as np

from geocontact.data.errors import InputError
from geocontact.data.magnitude import TOO_LARGE, too_large
from geocontact.io.text.file_preflight import read_bytes

PATIENCE = 8.0, 2e-7
"""Seconds for a file on an idle machine: to start, and per byte; several times what whole files take."""

MIPS = 86
"""Processor type in the parameter section whose integers have the high byte first."""

LARGEST = 500_000_000
"""Bytes; ten plates at 2 kHz with a hundred markers for an hour."""

Arrays = dict[str, np.ndarray]


def read_c3d_plates(path: str | PathLike[str]) -> Arrays:
    """Arrays of all plates of a file.

    `frames`, `rate` [Hz] and `start` [s]; for plate k = 0, 1 …: `force_k`, `moment_k`, `corners_k` in the file's units,
    and those in `units_k` (force, position, moment). `labels` of the analog channels.
    """
    return read_apart(path, __name__)


def read_apart(path: str | PathLike[str], module: str) -> Arrays:
    """Arrays that `python -m module FILE` writes of a .c3d file, `frames` among them, in another process."""
    file = fspath(path)
    data = read_bytes(path)
    if len(data) < 512 or data[1] != 0x50:
        raise InputError(file, "", "is not a .c3d file although its name says so", "export or download it again")
    if len(data) > LARGEST:
        raise InputError(file, "", f"{len(data) / 1e6:.0f} MB is more than the {LARGEST / 1e6:.0f} MB limit", "cut it")
    arrays = _run(file, module, (PATIENCE[0] + PATIENCE[1] * len(data)) * _waiting())
    declared, found = _frames_declared(data), int(arrays["frames"])
    if found < declared:  # ezc3d passes over what is missing without a word
        raise InputError(file, "", f"holds {found} of the {declared} frames it declares", "is it complete?")
    for name, values in arrays.items():
        if values.dtype.kind == "f" and too_large(values).any():
            raise InputError(file, "", f"holds a number in {name.partition('_')[0]} that {TOO_LARGE}", "is it damaged?")
    return arrays


def _run(file: str, module: str, patience: float) -> Arrays:
    """The module in another process, which finds the modules that this one finds."""
    here = str(Path(__file__).resolve().parents[2])
    paths = os.pathsep.join(dict.fromkeys([*(path for path in sys.path if path), here]))
    command = [sys.executable, "-P", "-W", "ignore", "-m", module, str(Path(file).absolute())]
    try:
        child = subprocess.run(
            command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, timeout=patience, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise InputError(file, "", f"is not read within {patience:.0f} s", "is the file damaged?") from error
    if child.returncode == 0:
        with np.load(io.BytesIO(child.stdout), allow_pickle=False) as arrays:
            return dict(arrays)
    said = child.stderr.decode(errors="replace").strip().splitlines()
    if said and said[-1].startswith("ModuleNotFoundError"):
        raise InputError(file, "", "reading .c3d needs ezc3d", "pip install 'geocontact[mocap]'")
    why = said[-1][:160] if said and child.returncode > 0 else "ezc3d stopped"
    raise InputError(file, "", f"cannot be read ({why})", "is the file damaged?")


def _waiting() -> float:
    """How many times longer a process takes beside those that wait for a processor now; 1 where none has to wait."""
    try:
        return max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
    except (AttributeError, OSError):  # Windows has no such figure
        return 1.0


def plates_of(path: str) -> Arrays:
    """The same, in this process."""
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path, extract_forceplat_data=True)
    points, analogs = content["header"]["points"], content["header"]["analogs"]
    arrays: Arrays = {
        "frames": np.array(content["data"]["points"].shape[2]),
        "rate": np.array(float(analogs["frame_rate"])),
        "start": np.array(float(points["first_frame"]) / max(float(points["frame_rate"]), 1e-9)),
        "labels": np.array([str(label).strip() for label in content["parameters"]["ANALOG"]["LABELS"]["value"]]),
    }
    for k, plate in enumerate(content["data"].get("platform", [])):
        units = [str(plate[key]) for key in ("unit_force", "unit_position", "unit_moment")]
        arrays |= {f"{key}_{k}": np.asarray(plate[key], float).T for key in ("force", "moment", "corners")}
        arrays[f"units_{k}"] = np.array(units)
    return arrays


def _frames_declared(data: bytes) -> int:
    """Frames by the header's first and last frame; 0 where it cannot tell (16 bits, wrapped in long files)."""
    parameters = (data[0] - 1) * 512
    processor = data[parameters + 3] if 0 <= parameters < len(data) - 3 else 0
    order: Literal["big", "little"] = "big" if processor == MIPS else "little"
    first, last = (int.from_bytes(data[at : at + 2], order) for at in (6, 8))
    return last - first + 1 if first <= last < 0xFFFF else 0


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **plates_of(sys.argv[1]))  # type: ignore[arg-type]
