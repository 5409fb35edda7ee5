"""`geocontact doctor`: what works on this machine, and the exact fix for what does not."""

from __future__ import annotations

import os
import platform
import subprocess
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from geocontact.dynamics import code_cache
from geocontact.view.surfaces import child

PATIENCE = 8.0  # s for all child processes together
ALONE = 30.0  # s for one that did not answer in time, asked again when the others have ended
LATER = "try again when the machine is less busy; if it stays: "


@dataclass(frozen=True)
class Feature:
    """One thing that may or may not work here.

    `probe` runs in a child process, because a missing driver kills the process instead of raising.
    """

    name: str
    package: str
    purpose: str
    probe: str
    fix: str
    needed: bool = False


SYSTEM_GL = "libegl1 libgl1"
FEATURES = (
    Feature(
        "distances and areas",
        "numba",
        "everything",
        "import numba; assert numba.njit(lambda x: x + 1)(1) == 2",
        "pip install --force-reinstall numba",
        needed=True,
    ),
    Feature(
        "inside or outside",
        "libigl",
        "signed distances",
        "import igl, numpy as np; igl.FastWindingNumberBVH()",
        "pip install libigl",
        needed=True,
    ),
    Feature(
        "exact separation",
        "python-fcl",
        "min_distance, settling",
        "import fcl; fcl.CollisionRequest()",
        "pip install python-fcl",
        needed=True,
    ),
    Feature(
        "figures",
        "matplotlib",
        "area.png, area.svg",
        "from matplotlib.figure import Figure; Figure().savefig(__import__('io').BytesIO(), format='png')",
        "pip install matplotlib",
        needed=True,
    ),
    Feature(
        "Parquet tables",
        "pyarrow",
        "--parquet",
        "import pyarrow.parquet",
        "pip install 'geocontact[parquet]'",
    ),
    Feature(
        ".vtp meshes",
        "pyvista",
        "reading .vtp files",
        "from vtkmodules.vtkIOXML import vtkXMLPolyDataReader",
        "pip install 'geocontact[view]'",
    ),
    Feature(
        "3-D off-screen",
        "pyvista",
        "3-D stills and VTP files",
        child.PROGRAM,
        child.REMEDY,
    ),
    Feature(
        "scan registration",
        "open3d",
        "body scans",
        "import open3d",
        f"pip install open3d (Python < 3.13), and apt-get install {SYSTEM_GL} libusb-1.0-0 (trixie: also libidn2-0)",
    ),
    Feature("optimal control", "casadi", "body models", "import casadi", "pip install casadi"),
    Feature("studies", "distributed", "cohort", "import distributed", "pip install 'geocontact[cohort]'"),
    Feature("motion capture", "ezc3d", ".c3d files", "import ezc3d", "pip install ezc3d"),
    Feature("STEP surfaces", "cascadio", ".step meshes", "import cascadio", "pip install 'geocontact[step]'"),
    Feature("window", "nicegui", "app", "from nicegui import ui", "pip install 'geocontact[app]'"),
    Feature("muscles", "opensim", "id --muscles", "import opensim", "pip install 'geocontact[muscles]'"),
)


def doctor() -> int:
    """Check which features work on this machine, and show how to fix those that do not.

    Exit 1 when something that every analysis needs does not work, or gave no answer.
    """
    print(f"geocontact {_version('geocontact')}, Python {platform.python_version()}, {platform.platform()}")
    print(f"{os.cpu_count()} cores; compiled kernels are kept in {_cache_folder()}")
    print(code_cache.words())
    troubles = _troubles()
    for feature in FEATURES:
        trouble, installed = troubles[feature.name], _version(feature.package)
        if not trouble:
            print(f"  ok       {feature.name:20} {feature.package} {installed}")
            continue
        slow = trouble.startswith(child.SLOW)
        word = "unclear " if slow else "MISSING " if feature.needed else "missing "
        print(f"  {word} {feature.name:20} {feature.package} {installed} ({feature.purpose}): {trouble}")
        print(f"           fix: {LATER if slow else ''}{feature.fix}")
    line, code = _verdict(troubles)
    print(line)
    return code


def _troubles() -> dict[str, str]:
    """What is wrong with each feature, "" where nothing is; the slow ones are asked again alone."""
    running = [(feature, _started(feature)) for feature in FEATURES]
    found = {
        feature.name: "not installed" if started is None else child.outcome(started, PATIENCE)
        for feature, started in running
    }
    for feature in FEATURES:
        if found[feature.name].startswith(child.SLOW):
            found[feature.name] = child.outcome(child.start(feature.probe), ALONE)
    return found


def _verdict(troubles: dict[str, str]) -> tuple[str, int]:
    """The last line, which says no more than the lines above, and the exit code."""
    slow = [one for one in FEATURES if troubles[one.name].startswith(child.SLOW)]
    if any(one.needed and troubles[one.name] and one not in slow for one in FEATURES):
        return "an analysis cannot run here before the fixes above", 1
    names = ", ".join(one.name for one in slow)
    if any(one.needed for one in slow):
        return f"whether an analysis runs here is not known: no answer from {names}{_load()}", 1
    return "everything an analysis needs works" + (f"; not known: {names}{_load()}" if slow else ""), 0


def _load() -> str:
    """How busy the machine is, where it tells."""
    if not hasattr(os, "getloadavg"):
        return ""
    return f" (this machine has {os.cpu_count()} cores and {os.getloadavg()[0]:.1f} processes that want one)"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "-"


def _cache_folder() -> str:
    folder = os.environ.get("NUMBA_CACHE_DIR", "")
    if folder:
        return folder
    package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    return package if os.access(package, os.W_OK) else "the user's cache folder"


def _started(feature: Feature) -> subprocess.Popen[str] | None:
    if _version(feature.package) == "-":
        return None
    return child.start(feature.probe)
