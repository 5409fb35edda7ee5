"""What a page says of pressures: their map, curves, numbers, facts and words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.frame.words import rounded
from geocontact.data.motion import Course
from geocontact.geometry.sagittal import silhouette
from geocontact.geometry.surface import Surface
from geocontact.loads.pressure_evolution import PressureEvolution
from geocontact.view.page.content import Curve, Curves, FaceMap, Plan, Row, Section, Track, Words

MM, MM2, MPA = 1e3, 1e6, 1e-6
DEEPER = 0.1e-3  # m; what the words put into pressure


@dataclass(frozen=True, eq=False)
class Pressures:
    """Pressures on FIXED over all frames of a motion, and the maps of some.

    Parameters
    ----------
    force, centre
        Force [N] and centre of pressure [m] of each compartment and of the "total"; NaN where nothing presses.
    peak, area
        Largest pressure [Pa] and area under pressure [m^2] of the whole.
    maps
        Mean pressure of each face [Pa], by the number of the frame.
    law, modulus, thickness, other_modulus
        Law of the layer, its confined modulus [Pa], the least and greatest thickness where it is pressed [m], and the
        confined modulus of MOVING's layer [Pa], infinite where MOVING is rigid.
    finer
        Largest force again, with pieces of half the size [N].
    seen_along
        Axis 0, 1, 2 across the plan of the centre of pressure: the one that the load acts along.
    outline
        FIXED as seen along that axis, pairs of points [m].
    """

    force: Mapping[str, Float[np.ndarray, " t"]]
    centre: Mapping[str, Float[np.ndarray, "t 3"]]
    peak: Float[np.ndarray, " t"]
    area: Float[np.ndarray, " t"]
    maps: Mapping[int, Float[np.ndarray, " f"]]
    law: str
    modulus: float
    thickness: tuple[float, float]
    other_modulus: float
    finer: float
    seen_along: int
    outline: Float[np.ndarray, "e 2 3"]

    @property
    def heaviest(self) -> int:
        """Frame with the largest force."""
        return int(np.argmax(self.force["total"]))


def shown_pressures(e: PressureEvolution, fixed: Surface) -> Pressures:
    """What the page shows of pressures."""
    along = load_axis(fixed, e.maps[e.heaviest])
    welded = fixed.vertices.round(9)
    unique, place = np.unique(welded, axis=0, return_inverse=True)
    edges = silhouette(unique, place.ravel()[fixed.faces], np.eye(3)[along])
    return Pressures(
        force={side: np.array([load.pressing for load in loads]) for side, loads in e.sides.items()},
        centre={side: np.array([load.centre for load in loads]) for side, loads in e.sides.items()},
        peak=np.array([load.peak for load in e.loads]),
        area=np.array([load.area for load in e.loads]),
        maps=e.maps,
        law=e.layer.law,
        modulus=e.layer.modulus,
        thickness=e.thickness,
        other_modulus=e.skin.modulus,
        finer=e.finer,
        seen_along=along,
        outline=unique[edges],
    )


def face_map(p: Pressures, frames: Int[np.ndarray, " k"], body: int) -> FaceMap:
    """The colours of the frames shown."""
    values = np.array([p.maps[k] for k in frames.tolist()]) * MPA
    return FaceMap("mean pressure of each face", "MPa", body, values)


def load_axis(fixed: Surface, pressure: Float[np.ndarray, " f"]) -> int:
    """Axis 0, 1, 2 of FIXED's frame along which the pressed faces look most; 1 where none is pressed."""
    pressed = pressure > 0.0
    if not pressed.any():
        return 1
    return int(np.argmax(np.abs((fixed.face_normal * fixed.face_area[:, None])[pressed].sum(axis=0))))


def sentence(p: Pressures, course: Course, moving: str, fixed: str) -> str:
    """How hard, and when."""
    k, peak = p.heaviest, float(p.peak.max()) * MPA
    force = float(p.force["total"][k])
    if not force > 0.0:
        return f"{moving} never presses on {fixed}: the bodies do not overlap in any frame."
    most = f"up to {rounded(force)} N (at {course.at(k)}) and up to {rounded(peak, 3)} MPa"
    return f"{moving} presses on {fixed} with {most}."


def facts(p: Pressures, course: Course) -> list[tuple[str, str]]:
    """How much and when."""
    at = {"force": p.heaviest, "peak": int(np.argmax(p.peak))}
    when = {name: f"at {course.at(k)}" for name, k in at.items()}
    lines = [
        ("Largest contact force", f"{p.force['total'][at['force']]:.0f} N {when['force']}"),
        ("Largest contact pressure", f"{p.peak[at['peak']] * MPA:.1f} MPa {when['peak']}"),
    ]
    x, y, z = p.centre["total"][at["force"]] * MM
    if np.isfinite(x):
        whole = p.force["total"][at["force"]]
        where = [f"x {x:.1f}, y {y:.1f}, z {z:.1f} mm"]
        shares = [f"{values[at['force']] / whole:.0%} {side}" for side, values in p.force.items() if side != "total"]
        where += [", ".join(shares)] if shares else []
        lines.append(("Centre of pressure, largest force", "; ".join(where)))
    return lines


def pressure_rows(p: Pressures, frames: Int[np.ndarray, " k"]) -> list[Row]:
    """Numbers of the frame shown."""
    centre = p.centre["total"][frames] * MM
    return [
        *(Row(f"force, {side}", "N", _texts(values, 1)) for side, values in _forces(p, frames).items()),
        Row("largest pressure", "MPa", _texts(p.peak[frames] * MPA, 2)),
        Row("area under pressure", "mm²", _texts(p.area[frames] * MM2, 2)),
        *(Row(f"centre of pressure {axis}", "mm", _texts(centre[:, k], 2)) for k, axis in enumerate("xyz")),
    ]


def pressure_sections(p: Pressures, frames: Int[np.ndarray, " k"]) -> list[Section]:
    """Curves over time, and the path of the centre of pressure."""
    parts = _forces(p, frames)
    return [
        Curves("Contact force, elastic foundation", "N", [Curve(side, values) for side, values in parts.items()]),
        Curves("Largest contact pressure", "MPa", [Curve("largest pressure", p.peak[frames] * MPA)]),
        _path(p, frames),
    ]


def _path(p: Pressures, frames: Int[np.ndarray, " k"]) -> Plan:
    right, up = ((2, 1), (2, 0), (0, 1))[p.seen_along]
    plane = [right, up]
    return Plan(
        "Path of the centre of pressure on the fixed body",
        "mm",
        "xyz"[right],
        "xyz"[up],
        lines=tuple(p.outline[:, :, plane] * MM),
        tracks=[Track(side, values[frames][:, plane] * MM) for side, values in p.centre.items()],
    )


def _forces(p: Pressures, frames: Int[np.ndarray, " k"]) -> dict[str, Float[np.ndarray, " k"]]:
    return {side: values[frames] for side, values in p.force.items()}


def pressure_words(p: Pressures) -> Words:
    """What the pressures rest on, and how far to trust them."""
    thin, thick = (length * MM for length in p.thickness)
    largest = float(p.force["total"].max())
    other = "rigid" if np.isinf(p.other_modulus) else f"another one of {p.other_modulus * MPA:.4g} MPa"
    layer = (
        f"FIXED is an elastic layer on a rigid base ({p.law} law, confined modulus {p.modulus * MPA:.4g} MPa, "
        f"thickness {thin:.3g} … {thick:.3g} mm where it is pressed) and MOVING is {other}. The pressure at each "
        "point depends on the depth at that point only: effects on the surface beside it, friction and creep are "
        "neglected."
    )
    more = p.modulus * DEEPER / p.thickness[0] * MPA
    pose = (
        f"The pose decides: {DEEPER * MM:g} mm deeper is up to {more:.3g} MPa more. Recorded poses are rarely that "
        "accurate; maps from them show where the pressure is, not how large."
    )
    off = abs(largest - p.finer) / p.finer if p.finer > 0.0 else 0.0
    error = (
        f"Pieces of half the size change the largest force by {off:.2%}. The error of the triangles is not included: "
        "repeat with a finer mesh."
    )
    shown, peak = max(float(each.max()) for each in p.maps.values()) * MPA, float(p.peak.max()) * MPA
    colours = (
        f"The colours are means over faces, up to {shown:.3g} MPa; the largest pressure of a piece is {peak:.3g} MPa. "
        "They agree where faces are small compared with the patch."
    )
    return Words("Pressures", [layer, pose, error, colours])


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return ["–" if np.isnan(value) else f"{value:.{digits}f}" for value in values]
