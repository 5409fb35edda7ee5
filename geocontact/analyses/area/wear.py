"""Wear of FIXED's layer over many cycles of a motion: its factor, what is to be doubted, its table, and the page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.frame.collector import add_input, note, reserve, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.motion.styles import Cutting
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM, MM2
from geocontact.data.motion import Motion
from geocontact.data.plausible import BEARING, WEAR
from geocontact.geometry.surface import Surface
from geocontact.io.text.side_table import read_side_table
from geocontact.loads.pressure_evolution import PressureEvolution
from geocontact.loads.wear import LayerWear, WearFactor, Wearing
from geocontact.view.page.content import FaceMap, Words

CYCLES = 1e6
"""Cycles by default: wear is stated per million of them (ISO 14243-2)."""
COLUMNS = ["cross_shear [-]", "wear_factor [m^2/N]"]
MM3, MM3_PER_N_M = 1e9, 1e9  # of a m^3, and of a m^2/N
HALF = 0.5  # the largest cross-shear ratio: as much work across as along


def wear_factor_of(o: AreaOptions) -> WearFactor | None:
    """The factor that the options say; None where no wear is asked for.

    Raises
    ------
    InputError
        The table lacks a column, or its numbers cannot be those of a wear factor.
    """
    if o.cross_shear is None:
        return None if o.wear_factor is None else WearFactor.same(o.wear_factor)
    table = read_side_table(o.cross_shear, COLUMNS)
    if missing := [name for name in COLUMNS if name not in table.columns]:
        what = f"no column {', '.join(missing)}"
        raise InputError(o.cross_shear, "line 1", what, "write cross_shear [-], wear_factor [mm^3/(N m)]")
    add_input("`cross_shear`", o.cross_shear, rows=len(table))
    ratio, factor = (table[name].to_numpy(float) for name in COLUMNS)
    if len(ratio) < 2:
        raise InputError(o.cross_shear, "", "one row is one factor for all ratios", "give two rows, or `wear_factor`")
    _check_factors(o.cross_shear, factor)
    try:
        return WearFactor(ratio, factor)
    except ValueError as error:
        raise InputError(o.cross_shear, "", str(error), "give ratios from 0 to 0.5, sorted, each once") from error


def _check_factors(table: Path, factor: Float[np.ndarray, " n"]) -> None:
    """The same refusal and doubt as for one factor."""
    for row, value in enumerate(factor.tolist(), start=1):
        if (refusal := WEAR.refusal(value)) is not None:
            raise InputError(table, f"row {row}", *refusal)
    doubts = [doubt for value in factor.tolist() if (doubt := WEAR.doubt(value)) is not None]
    if doubts:
        reserve(f"{table}: {doubts[0]}")


WHOLE = 0.02
"""Share of the frames that may lie outside of the one cycle."""


def refuse_other_cycles(
    wear: WearFactor | None, cutting: Cutting | None, motions: Sequence[tuple[str, Motion]], stems: Sequence[str]
) -> None:
    """InputError where there is wear, which is that of all frames repeated, and by its events a motion is not one
    whole cycle.
    """
    if wear is None or cutting is None:
        return
    for stem, (_, motion) in zip(stems, motions, strict=True):
        if motion.time_unit != "s":
            continue
        start, end = float(motion.time[0]), float(motion.time[-1])
        near = WHOLE * (end - start)
        found = [
            cycle
            for cycle in replace(cutting, part=None).cycles_of(stem)
            if start - near <= cycle.start and cycle.end <= end + near
        ]
        if len(found) == 1 and found[0].start <= start + near and found[0].end >= end - near:
            continue
        what = f"{stem} holds {counted(len(found), 'cycle')}, and wear repeats all of its frames as one"
        if len(found) == 1:
            what = (
                f"the cycle of {stem} is {found[0].start:g} to {found[0].end:g} s, and wear repeats all of its frames, "
                f"{start:g} to {end:g} s"
            )
        raise InputError(cutting.file, "", what, "cut the motion to one cycle, or leave out `events` or wear")


def worn_over(o: AreaOptions, factor: WearFactor, wearing: Wearing, name: str, e: PressureEvolution) -> LayerWear:
    """Wear of the layer over all cycles of one motion, and what is to be said of it."""
    found = wearing.after(factor, CYCLES if o.wear_cycles is None else o.wear_cycles)
    label = f"{name}: " if name else ""
    if not found.total_work > 0.0:
        reserve(f"{label}nothing slides under pressure: there is no wear")
    _doubt_pressure(e, label)
    _doubt_motion(found, label)
    _doubt_depth(found, e, label)
    _doubt_ratios(found, factor, label)
    place = found.pieces.point[found.deepest] * MM if found.volume > 0.0 else ()
    note(
        f"wear {name}".strip(),
        {
            "cycles": found.cycles,
            "volume_mm3": found.volume * MM3,
            "volume_mm3_per_million_cycles": found.volume * MM3 * 1e6 / found.cycles,
            "deepest_mm": float(found.depth.max(initial=0.0)) * MM,
            "deepest_at_mm": [round(float(x), 4) for x in place] or None,
            "force_times_path_J_per_cycle": found.total_work,
            "cross_shear_ratio": mean_ratio(found),
            "way_back_not_counted": _share(found.closing, found.total_work),
            "every_second_frame_changes": found.coarser,
        },
    )
    say(f"{label}{wear_sentence(found)}")
    return found


def _doubt_pressure(e: PressureEvolution, label: str) -> None:
    """A reservation where pressures are beyond those of bearings: wear is as wrong as they are."""
    peak = max(load.peak for load in e.loads)
    doubt = BEARING.doubt(peak) if peak > 0.0 else None
    if doubt is not None:
        reserve(
            f"{label}wear follows the pressures: {doubt}; "
            "check `modulus`, `thickness` and the poses, which should be those at rest under the load"
        )


FRAMES = 0.1
"""Share of the depths that leaving out every second frame may change; the error of all frames is about a third of it,
as that of the trapezoidal rule falls with the square of the step."""
OPEN = 0.01
"""Share of the work that the way from the last pose back to the first may be without a warning."""


def _doubt_motion(found: LayerWear, label: str) -> None:
    if found.coarser > FRAMES:
        reserve(
            f"{label}every second frame alone changes the depths of wear by {found.coarser:.0%} on average: "
            "between two frames the contact moves far beside its size; give more of them"
        )
    back = _share(found.closing, found.total_work)
    if back > OPEN:
        reserve(
            f"{label}the motion does not end where it begins: the way back, {back:.1%} of force times path, is not "
            "counted; is it one whole cycle?"
        )


THIN = 0.05
"""Share of the layer's thickness that may wear without a warning."""


def _doubt_depth(found: LayerWear, e: PressureEvolution, label: str) -> None:
    """A reservation where the surface changes so much that its pressures would."""
    depth, thickness = float(found.depth.max(initial=0.0)), float(e.layer.thickness[found.deepest])
    pressed = e.strain * float(e.layer.thickness.max())
    if depth <= min(THIN * thickness, pressed):
        return
    than = f"{depth / thickness:.0%} of the layer" if depth > THIN * thickness else "more than the layer is pressed in"
    reserve(
        f"{label}the deepest place wears by {depth * MM:.3g} mm, {than}: the surface is not updated, and a worn one "
        "fits better and has lower pressures; take fewer `wear_cycles`"
    )


BEYOND = 0.01
"""Share of the work that may be at ratios that the table does not hold."""


def _doubt_ratios(found: LayerWear, factor: WearFactor, label: str) -> None:
    if not factor.depends:
        return
    low, high = factor.ratio[0], factor.ratio[-1]
    outside = (found.ratio < low) | (found.ratio > high)
    share = _share(float(found.work[outside] @ found.pieces.area[outside]), found.total_work)
    if share > BEYOND:
        reserve(
            f"{label}{share:.0%} of the work is at cross-shear ratios beyond the table's {low:g} to {high:g}: "
            "the factor of its nearest row is taken there"
        )


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else 0.0


def mean_ratio(found: LayerWear) -> float:
    """Cross-shear ratio of the layer, places weighted with their work [-]."""
    return _share(float((found.ratio * found.work) @ found.pieces.area), found.total_work)


def wear_sentence(found: LayerWear) -> str:
    """How much, and where it is deepest."""
    said = f"wear after {found.cycles:g} cycles: {found.volume * MM3:.4g} mm^3"
    return f"{said}, deepest {_deepest(found)}" if found.volume > 0.0 else said


def _deepest(found: LayerWear) -> str:
    """Depth and place of the piece that loses the most."""
    x, y, z = found.pieces.point[found.deepest] * MM
    return f"{found.depth[found.deepest] * MM:.3g} mm at x {x:.1f}, y {y:.1f}, z {z:.1f} mm"


def wear_table(found: LayerWear, fixed: Surface) -> pd.DataFrame:
    """A row for each face of FIXED that wears: place, mean depth, volume, cross-shear ratio and wear factor."""
    faces, pieces = len(fixed.faces), found.pieces
    volume = np.bincount(pieces.face, found.depth * pieces.area, faces)
    worn = np.flatnonzero(volume > 0.0)
    work = np.bincount(pieces.face, found.work * pieces.area, faces)[worn]

    def by_work(values: Float[np.ndarray, " p"]) -> Float[np.ndarray, " w"]:
        return np.asarray(np.bincount(pieces.face, values * found.work * pieces.area, faces)[worn] / work)

    x, y, z = fixed.vertices[fixed.faces[worn]].mean(axis=1).T * MM
    return pd.DataFrame(
        {
            "face": worn,
            "x [mm]": x,
            "y [mm]": y,
            "z [mm]": z,
            "depth [mm]": face_depths(found, faces)[worn] * MM,
            "area [mm^2]": np.bincount(pieces.face, pieces.area, faces)[worn] * MM2,
            "volume [mm^3]": volume[worn] * MM3,
            "cross_shear [-]": by_work(found.ratio),
            "wear_factor [mm^3/(N m)]": by_work(found.factor) * MM3_PER_N_M,
        }
    )


def face_depths(found: LayerWear, faces: int) -> Float[np.ndarray, " f"]:
    """Mean depth of wear of each of the `faces` faces of FIXED [m]."""
    return found.pieces.face_means(found.depth, faces)


def wear_map(found: LayerWear, faces: int, frames: int) -> FaceMap:
    """Colours of the wear, the same in all frames."""
    depth = face_depths(found, faces) * MM
    return FaceMap(f"wear after {found.cycles:g} cycles", "mm", 0, np.tile(depth, (frames, 1)))


def wear_facts(found: LayerWear) -> list[tuple[str, str]]:
    """Volume and depth."""
    volume = (f"Volume worn after {found.cycles:g} cycles", f"{found.volume * MM3:.4g} mm³")
    return [volume, ("Deepest wear", _deepest(found))] if found.volume > 0.0 else [volume]


def wear_words(found: LayerWear) -> Words:
    """The law of wear and what it leaves out."""
    used = found.factor[found.work > 0.0] * MM3_PER_N_M
    ends = dict.fromkeys(f"{end:.3g}" for end in (used.min(), used.max())) if len(used) else {"0": None}
    law = (
        f"Depth = wear factor × pressure × sliding path (Archard), wear factor {' … '.join(ends)} mm³/(N m), times "
        f"{found.cycles:g} cycles; all of it on the fixed body. Force times path is {found.total_work:.4g} J a cycle, "
        f"the mean cross-shear ratio {mean_ratio(found):.3f} (0: one direction, {HALF:g}: as much across as along)."
    )
    limits = (
        "Pressures are those of the surface as it is given in each cycle: it is not updated as it wears, and creep is "
        "not included. Poses are prescribed, so that an error of the pressure is one of the wear in the same ratio."
    )
    frames = (
        f"Every second frame alone changes the depths by {found.coarser:.2%} on average. Colours are means over faces; "
        "the deepest wear is that of a piece of one."
    )
    return Words("Wear", [law, limits, frames])
