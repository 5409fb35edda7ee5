"""What the manifest says of each file that is shipped."""

from __future__ import annotations

import hashlib
from pathlib import Path, PurePath

import numpy as np

from meshes.segment_areas import size
from meshes.segments import SEGMENTS, Segment
from meshes.solids import area, is_closed, smallest_angle, volume
from meshes.stl import read_stl

KINDS = {".stl": "surface", ".csv": "motion", ".mot": "motion", ".osim": "model", ".toml": "study"}
FOLDER_KINDS = {
    "frames": "recording",
    "layout": "layout",
    "landmarks": "landmarks",
    "truth": "truth",
    "markers": "markers",
    "tool": "recording",
    "standing": "markers",
    "walking": "markers",
    "functional": "markers",
    "plates": "recording",
    "study": "study",
    "unloaded": "recording",
    "T1": "recording",
    "T2": "recording",
    "T3": "recording",
    "P1": "recording",
    "foot": "study",
    "spheres": "layout",
    "soft": "recording",
    "firm": "recording",
    "hard": "recording",
    "body": "model",
    "ik": "motion",
    "leg": "model",
    "swing": "motion",
    "force": "recording",
    "exoskeleton": "study",
}
"""By suffix; in the folder of a mat's recording or of a trial by the first word of the name."""
FOLDERS = ("mat_*", "amputee_*", "foot_*", "forms", "gait_*", "knee_leg_*", "overhead_*", "standing_up*", "whole_body")
"""Of recordings and trials, in the order of the manifest."""


def kind(name: PurePath) -> str:
    """What a file holds, from its path in the folder of the sample data."""
    if name.match("foot_*/walking.csv"):  # a setting's compression, no markers
        return "recording"
    if name.match("forms/*"):
        return "study" if name.suffix == ".toml" else "recording"
    return FOLDER_KINDS[name.stem.partition("_")[0]] if len(name.parts) > 1 else KINDS[name.suffix]


def data_files(folder: Path) -> list[Path]:
    """The files to describe: those in the folder itself, then the mats' recordings and the trials."""
    own = sorted(p for p in folder.iterdir() if p.suffix in KINDS and p.name != "manifest.toml")
    return [*own, *(path for pattern in FOLDERS for path in sorted(folder.glob(f"{pattern}/*")))]


def file_entry(path: Path, folder: Path) -> dict[str, object]:
    """Name, kind, label and hash of one file; of surfaces their counts and sizes."""
    name = path.relative_to(folder)
    what = "synthetic " + " ".join(name.with_suffix("").parts).replace("_", " ")
    entry: dict[str, object] = {"name": name.as_posix(), "kind": kind(name), "what": what}
    entry["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
    if path.suffix != ".stl":
        return entry
    vertices, faces = read_stl(path)
    entry |= {
        "unit": "mm",
        "faces": len(faces),
        "vertices": len(vertices),
        "closed": is_closed(faces),
        "volume_mm3": round(volume(vertices, faces), 3),
        "smallest_angle_deg": round(smallest_angle(vertices, faces), 2),
    }
    for segment in SEGMENTS:
        if segment.name == path.stem:
            entry |= segment_sizes(segment, vertices, faces)
    return entry


def segment_sizes(segment: Segment, vertices: np.ndarray, faces: np.ndarray) -> dict[str, object]:
    """Area of a segment's mesh, and area and volume of the smooth segment that it approximates."""
    smooth = size(segment)
    return {
        "area_mm2": round(area(vertices, faces), 3),
        "area_smooth_mm2": round(smooth.skin + smooth.ends, 6),
        "area_smooth_skin_mm2": round(smooth.skin, 6),
        "volume_smooth_mm3": round(smooth.volume, 3),
        "smooth_source": "quadrature of the closed form in meshes/segments.py",
    }
