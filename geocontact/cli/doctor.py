"""`geocontact doctor`: what works on this machine, and the exact fix for what does not."""

from __future__ import annotations

import os
import platform
import subprocess
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from geocontact.view.surfaces import child, probe

PATIENCE = 8.0  # s for all child processes together
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
        "pip install pyarrow",
        needed=True,
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
        probe.PROGRAM,
        probe.REMEDY,
    ),
    Feature(
        "scan registration",
        "open3d",
        "body scans",
        "import open3d",
        f"pip install open3d (Python < 3.13), and apt-get install {SYSTEM_GL} libusb-1.0-0 (trixie: also libidn2-0)",
    ),
    Feature("optimal control", "casadi", "body models", "import casadi", "pip install casadi"),
    Feature("motion capture", "ezc3d", ".c3d files", "import ezc3d", "pip install ezc3d"),
)


def doctor() -> int:
    """Say what works on this machine, feature by feature, with the exact fix for what does not.

    Exit 1 when something that every analysis needs does not work.
    """
    print(f"geocontact {_version('geocontact')}, Python {platform.python_version()}, {platform.platform()}")
    print(f"{os.cpu_count()} cores; compiled kernels are kept in {_cache_folder()}")
    running = [(feature, _started(feature)) for feature in FEATURES]
    sound = True
    for feature, started in running:
        trouble = "not installed" if started is None else child.outcome(started, PATIENCE)
        slow = trouble.startswith(child.SLOW)
        installed = _version(feature.package)
        if not trouble:
            print(f"  ok       {feature.name:20} {feature.package} {installed}")
            continue
        sound = sound and (not feature.needed or slow)
        word = "unclear " if slow else "MISSING " if feature.needed else "missing "
        print(f"  {word} {feature.name:20} {feature.package} {installed} ({feature.purpose}): {trouble}")
        print(f"           fix: {LATER if slow else ''}{feature.fix}")
    print("everything an analysis needs works" if sound else "an analysis cannot run here before the fixes above")
    return 0 if sound else 1


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
