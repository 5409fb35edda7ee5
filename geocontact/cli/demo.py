"""`geocontact demo`: the main job on the shipped synthetic knee, offline."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.job import Call, execute
from geocontact.analyses.frame.options import declared
from geocontact.cli.command import speller, tell
from geocontact.cli.show import Terminal
from geocontact.data.errors import InputError


def demo(*, out: Path = Path("demo-result")) -> int:
    """Contact area of the shipped synthetic knee over a synthetic gait cycle.

    Parameters
    ----------
    out
        Folder for the results.
    """
    from geocontact.analyses.area.result import area  # numba and friends: not for --help

    meshes = sample_folder()
    print("synthetic total-knee pair, synthetic gait cycle of 101 frames; medial and lateral apart")
    options = AreaOptions(
        meshes / "femoral_component_right_medium.stl",
        meshes / "tibial_insert_right_medium.stl",
        unit="mm",
        motion=(str(meshes / "gait.csv"),),
        threshold=(1e-3, 4e-3),
        split="z",
        side="right",
    )
    typed = {**vars(options), "threshold": "1,4", "out": out}
    result, files = execute(area, options, out, Call(typed, Terminal(), speller(declared(AreaOptions))))
    tell(result, out, files)
    print(f"open {out / 'report.html'} in a browser (geocontact view {out}); the numbers are in {out / 'area.csv'}")
    return 0


def sample_folder() -> Path:
    """Folder of the shipped meshes: inside an installed package, or beside it in a checkout."""
    package = Path(str(files("geocontact")))
    for folder in (package / "meshes", package.parent / "meshes"):
        if (folder / "manifest.toml").is_file():
            return folder
    raise InputError(package, "", "the sample meshes are not installed", "reinstall geocontact, or use a checkout")
