"""One small mat on the thigh as three makers export it: Tekscan, XSENSOR, novel pedar."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.text import written

ROWS, COLUMNS = 3, 4
TEKSCAN = """DATA_TYPE MOVIE
ROWS 3
COLS 4
ROW_SPACING 10.16 mm
COL_SPACING 5.08 mm
SECONDS_PER_FRAME 0.02
SATURATION_PRESSURE 207 KPa
START_FRAME 1
UNITS KPa
ASCII_DATA @@
"""
XSENSOR = """Date:,"2026-02-03"
Time:,"10:00:{time:06.3f}"
Sensor:,"Seat"
Rows:,"3"
Columns:,"4"
Sensel Width (in):,"0.2"
Sensel Height (in):,"0.4"
Units:,"mmHg"
Sensels:
"""
PEDAR = """file name:  walk.sol\tdate/time  01.02.26 10.49
total time [secs]:  0.400\ttime per frame [secs]:  0.02000\tscanning rate [Hz]:   50
pressure values in  kPa

mask definition:\x20
left insole: {ids},

"""
PEDAR_LAYOUT = "rows = 3\ncolumns = 4\npitch_mm = [10.16, 5.08]\n[sensors]\nleft = {places}\n"


def make(home: Path, meshes: Path) -> None:
    """Twenty frames: a bump of 40 kPa that comes and goes; landmarks at the mat's corners."""
    row, column = np.indices((ROWS, COLUMNS))
    shape = np.exp(-0.3 * ((row - 1.0) ** 2 + (column - 1.7) ** 2))
    frames = np.round(40.0 * np.sin(np.pi * np.arange(20) / 19.0)[:, None, None] * shape, 2)
    cells = ["\n".join(",".join(f"{v:.2f}" for v in line) for line in frame) for frame in frames]
    movie = "\n\n".join(f"Frame {k + 1}\n{text}" for k, text in enumerate(cells))
    written(home / "tekscan.asf", f"{TEKSCAN}\n{movie}\n@@\n")
    seats = [f'Frame:,"{k + 1}"\n{XSENSOR.format(time=0.02 * k)}{quoted(text)}' for k, text in enumerate(cells)]
    written(home / "xsensor.csv", "\n\n".join(seats) + "\n")
    ids = ",".join(str(k + 1) for k in range(ROWS * COLUMNS))
    lines = ["time[secs]\t" + ids.replace(",", "\t")]
    lines += ["\t".join([f"{0.02 * (k + 1):.5f}", *(f"{v:.2f}" for v in f.ravel())]) for k, f in enumerate(frames)]
    written(home / "pedar.asc", PEDAR.format(ids=ids) + "\n".join(lines) + "\n")
    places = [[int(r), int(c)] for r, c in zip(row.ravel(), column.ravel(), strict=True)]
    written(home / "pedar.toml", PEDAR_LAYOUT.format(places=places))
    corners = [f"m{r}{c},{r},{c},85,{35 - 10.16 * r:g},{10 - 5.08 * c:g}" for r in (0, ROWS) for c in (0, COLUMNS)]
    written(home / "landmarks.csv", "\n".join(["id, row, column, x [mm], y [mm], z [mm]", *corners]) + "\n")


def quoted(text: str) -> str:
    """Every cell between quotation marks."""
    return "\n".join(",".join(f'"{cell}"' for cell in line.split(",")) for line in text.splitlines())
