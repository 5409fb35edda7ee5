"""Make the sample data: `python meshes/make.py [--resolution NAME …] [--out DIR] [--check]`.

Without options the committed files are written anew, byte for byte; `--check` only compares them. A named resolution
(`fine`, `finest`, or any factor on the cells of the coarse mesh such as `5.5`) goes to `meshes/generated/`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # so that the script runs from anywhere

from geocontact.shoulder_exoskeleton.synthetic import condition, participant, synthetic_trial, task
from meshes.form_files import form_files
from meshes.gait import synthetic_gait
from meshes.knee_leg import knee_leg_files
from meshes.leg_files import leg_model, leg_swing
from meshes.mat_files import recording_files
from meshes.mat_recordings import recordings
from meshes.motion_files import opensim_model, opensim_motion, pose_table, poses_text
from meshes.overhead_files import trial_files
from meshes.patella import COARSE, PAIRS, RESTING, patella, patella_in_insert
from meshes.segment_meshes import RINGS, segment_mesh
from meshes.simple_shapes import SAMPLES
from meshes.stl import snapped, stl_bytes
from meshes.total_knee import RESOLUTIONS, total_knee

HERE = Path(__file__).resolve().parent
COMMITTED = (("right", "coarse"), ("right", "medium"), ("left", "coarse"))


def knee_files(side: str, resolution: str) -> dict[str, bytes]:
    """STL files of insert and femoral component by name."""
    factor = RESOLUTIONS[resolution] if resolution in RESOLUTIONS else float(resolution)
    names = (f"tibial_insert_{side}_{resolution}.stl", f"femoral_component_{side}_{resolution}.stl")
    title = f"geocontact synthetic total knee, {side}, {resolution}, mm"
    return {name: stl_bytes(*body, title) for name, body in zip(names, total_knee(factor, side), strict=True)}


def simple_files() -> dict[str, bytes]:
    """STL files of the shapes with closed-form areas."""
    files = {}
    for name, (make, lengths, n) in SAMPLES.items():
        vertices, faces = make(*lengths, n)
        files[f"{name}.stl"] = stl_bytes(snapped(vertices), faces, f"geocontact synthetic {name}, n = {n}, mm")
    return files


def all_knee_files() -> dict[str, bytes]:
    """STL files of the committed pairs."""
    return {name: data for which in COMMITTED for name, data in knee_files(*which).items()}


def leg_files() -> dict[str, bytes]:
    """Legs with markers, and how they swing."""
    texts = {"leg.osim": leg_model(), "leg_swing.mot": leg_swing(), **knee_leg_files()}
    return {name: text.encode("ascii") for name, text in texts.items()}


def gait_files() -> dict[str, bytes]:
    """The gait cycle, settled on the medium right pair, as table, motion and model; a patellar button that follows."""
    insert, femoral = total_knee(RESOLUTIONS["medium"])
    gait = synthetic_gait(insert, femoral)
    button = patella(COARSE)
    texts = {
        "gait_patella.csv": poses_text(gait.time, *patella_in_insert(gait, femoral, button)),
        "knee_pairs.toml": PAIRS,
        "resting_knee.toml": RESTING,
        "gait.csv": pose_table(gait),
        "gait_left.csv": pose_table(gait.mirrored()),
        "gait.mot": opensim_motion(gait),
        "knee.osim": opensim_model("tibial_insert_right_medium.stl", "femoral_component_right_medium.stl"),
    }
    title = "geocontact synthetic patellar button, right, coarse, mm"
    surface = {"patella_right_coarse.stl": stl_bytes(snapped(button[0]), button[1], title)}
    files = surface | {name: text.encode("ascii") for name, text in texts.items()}
    return files | form_files(texts["gait.csv"])


def mat_files() -> dict[str, bytes]:
    """STL files of the body segments, and the recordings of the mats on them."""
    files = {}
    for segment, rings in RINGS.items():
        title = f"geocontact synthetic {segment.name.replace('_', ' ')}, n = {rings}, mm"
        files[f"{segment.name}.stl"] = stl_bytes(*segment_mesh(segment, rings), title)
    for recording in recordings():
        files |= recording_files(recording)
    return files


def overhead_files() -> dict[str, bytes]:
    """One of the 18 trials of overhead work that `geocontact.shoulder_exoskeleton.synthetic` makes."""
    trial = synthetic_trial(participant("P1"), task("T1"), condition("S100"))
    return {f"overhead_{trial.name}/{name}": text.encode("ascii") for name, text in trial_files(trial).items()}


def committed_files() -> dict[str, bytes]:
    """Every generated file that belongs to the repository."""
    return all_knee_files() | simple_files() | gait_files() | leg_files() | mat_files() | overhead_files()


def differing(files: dict[str, bytes], folder: Path) -> list[str]:
    """Names of files that are missing in `folder` or hold other bytes."""
    return [n for n, data in files.items() if not (folder / n).is_file() or (folder / n).read_bytes() != data]


def write(files: dict[str, bytes], folder: Path) -> None:
    """Write the files into `folder`, made if need be."""
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


def main() -> int:
    """Command line; exit 1 when `--check` finds a difference."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--resolution", nargs="+", help=f"{', '.join(RESOLUTIONS)}, or a factor on the coarse cells")
    parser.add_argument("--side", choices=("right", "left"), default="right")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    options = parser.parse_args()
    if options.resolution:
        files = {k: v for name in options.resolution for k, v in knee_files(options.side, name).items()}
        folder = options.out or HERE / "generated"
    else:
        files, folder = committed_files(), options.out or HERE
    if options.check:
        wrong = differing(files, folder)
        sys.stdout.write(f"{len(files)} files, differing: {', '.join(wrong) or 'none'}\n")
        return 1 if wrong else 0
    write(files, folder)
    sys.stdout.write("".join(f"{folder.name}/{name}: {len(data)} bytes\n" for name, data in files.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
