"""Reading numbers off a picture."""

from __future__ import annotations

import base64
import io

import numpy as np


def pixels(data_url: str) -> np.ndarray:
    """RGB (height, width, 3) of a PNG data address."""
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data_url.partition(",")[2]))).convert("RGB")).astype(int)


def dark_runs(row: np.ndarray, below: int = 170) -> list[float]:
    """Middles of the dark runs along a row of RGB pixels (sum of the three below a limit)."""
    dark = np.flatnonzero(row.sum(axis=1) < below)
    if not len(dark):
        return []
    return [float(run.mean()) for run in np.split(dark, np.flatnonzero(np.diff(dark) > 1) + 1)]
