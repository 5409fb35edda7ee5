"""`geocontact demo`: the main job on the shipped synthetic knee, offline."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from geocontact.cli.area import AreaOptions, area
from geocontact.data.errors import InputError


def demo(*, out: Path = Path("demo-result")) -> int:
    """Contact area of the shipped synthetic knee over a synthetic gait cycle.

    Parameters
    ----------
    out
        Folder for the results.
    """
    meshes = sample_folder()
    print("synthetic total-knee pair, synthetic gait cycle of 101 frames; medial and lateral apart")
    code = area(
        meshes / "femoral_component_right_medium.stl",
        meshes / "tibial_insert_right_medium.stl",
        options=AreaOptions(motion=[str(meshes / "gait.csv")], unit="mm", out=out, threshold="1,4", split="z"),
    )
    print(f"open {out / 'report.html'} in a browser (geocontact view {out}); the numbers are in {out / 'area.csv'}")
    return code


def sample_folder() -> Path:
    """Folder of the shipped meshes: inside an installed package, or beside it in a checkout."""
    package = Path(str(files("geocontact")))
    for folder in (package / "meshes", package.parent / "meshes"):
        if (folder / "manifest.toml").is_file():
            return folder
    raise InputError(package, "", "the sample meshes are not installed", "reinstall geocontact, or use a checkout")
