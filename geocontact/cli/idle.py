"""Options that would do nothing are mistakes: the user believes that they did something."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from geocontact.analyses.checks import refuse
from geocontact.cli.area import AreaOptions
from geocontact.data.motion import Motion


def refuse_idle(o: AreaOptions, files: Sequence[str]) -> None:
    """Refuse what the command line alone shows to do nothing or to be incomplete; `files` are the motions named."""
    reading = {
        "--osim": o.osim, "--joint": o.joint, "--map": o.map, "--order": o.order, "--angles": o.angles,
        "--convention": o.convention, "--side": o.side, "--moving": o.moving_body,
    }  # fmt: skip
    layer = {
        "--modulus": o.modulus, "--poisson": o.poisson, "--thickness": o.thickness, "--foundation": o.foundation,
        "--piece": o.piece, "--facets": o.facets, "--modulus-moving": o.modulus_moving,
    }  # fmt: skip
    second = {"--poisson-moving": o.poisson_moving, "--thickness-moving": o.thickness_moving}
    refuse(
        ((o.sweep is None) == (not files), "--motion", "give either --motion or --sweep", "see geocontact area --help"),
        (o.workers is not None and o.workers < 1, "--workers", "is less than one thread", "give 1 or more"),
        *((o.sweep is not None and value is not None, option, "does nothing beside --sweep, which reads no motion file",
           "leave it out") for option, value in reading.items()),
        (o.axis is not None and o.sweep is None, "--axis", "does nothing without --sweep", "give --sweep"),
        (o.map is not None and o.osim is not None, "--map", "beside --osim names the columns twice", "give one"),
        (o.convention is not None and o.osim is not None, "--convention",
         "does nothing beside --osim: the joint says what its coordinates are", "give one"),
        (o.moving_body is not None and o.osim is None and o.convention is None, "--moving",
         f"{o.moving_body} needs a joint or a knee convention", "swap the two meshes, or give --osim and --joint"),
        (o.side is not None and o.convention is None, "--side", "does nothing without --convention", "give it too"),
        (o.convention is not None and o.side is None, "--side", "is missing beside --convention", "give right or left"),
        (o.order is not None and (o.osim is not None or o.convention is not None), "--order",
         "does nothing here: the joint or the convention gives the order", "leave it out"),
        (o.medial is not None and o.split is None, "--medial", "does nothing without --split", "give --split"),
        (o.tolerance is not None and o.compare is None, "--tolerance", "does nothing without --compare",
         "give your measured areas too, or leave it out"),
        *((not o.pressure and value is not None, option, "does nothing without --pressure", "give --pressure")
          for option, value in layer.items()),
        (o.pressure and o.modulus is None, "--modulus", "is missing beside --pressure", "give for example 500MPa"),
        (o.pressure and o.poisson is None, "--poisson", "is missing beside --pressure", "give for example 0.46"),
        *((o.modulus_moving is None and value is not None, option, "does nothing without --modulus-moving",
           "give it too") for option, value in second.items()),
        (o.modulus_moving is not None and o.poisson_moving is None, "--poisson-moving",
         "is missing beside --modulus-moving", "give for example 0.46"),
    )  # fmt: skip


def refuse_unheeded(o: AreaOptions, motions: Mapping[Path, Motion]) -> None:
    """Refuse options of reading that had no say in any of the motions read."""
    heeded = frozenset[str]().union(*(motion.heeded for motion in motions.values()))
    files = ", ".join(map(str, motions))
    refuse(
        (o.convention is not None and "convention" not in heeded, "--convention",
         f"does nothing here: no knee angle is read from {files}", "name its columns with --map"),
        (o.order is not None and "order" not in heeded, "--order",
         f"does nothing here: no two angles to put in order are read from {files}", "leave it out"),
        (o.angles is not None and "angles" not in heeded, "--angles",
         f"does nothing here: no angle is read from {files}", "leave it out"),
    )  # fmt: skip
