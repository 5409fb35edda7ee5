"""What is shown of several bodies at rest: all in one scene with pressures, loads by pair, and the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from geocontact.analyses.area.pairs.equilibrium import RestingBodies
from geocontact.analyses.area.pairs.show import LOADS, WRENCH_HEADER, wrench_texts
from geocontact.analyses.frame.pages import INPUTS, OPTIONS, Thinned
from geocontact.analyses.frame.words import MOST, NOT_A_DEVICE, counted, headline
from geocontact.data.motion import Course
from geocontact.io.text.tables import listed
from geocontact.loads.pressure_load import PressureLoad
from geocontact.loads.settling_bodies import COORDINATES
from geocontact.view.curves.declared import Curve, Curves, CurveSheet
from geocontact.view.page.content import FaceMap, Page, Readout, Row, Scene, SceneBody, Section, Table, Words
from geocontact.view.surfaces.camera import camera_directions

FRAMES, FEWEST = 101, 6  # that the page animates at most, and at least
UNUSED = 1e-3  # m; a threshold, which a scene has even where no distance is shown
MM, MM2, MPA = 1e3, 1e6, 1e-6


def rest_curves(r: RestingBodies) -> CurveSheet:
    """Forces, largest pressures and areas by pair; displacements and turns that settle, from where they were."""
    force, peak, area = (
        [Curve(name, r.of_contact(name, value), stroke=n) for n, name in enumerate(r.contacts)]
        for value in (_force, lambda load: load.peak * MPA, lambda load: load.area * MM2)
    )
    panels = [
        Curves("Contact force", "N", force),
        Curves("Largest contact pressure", "MPa", peak),
        Curves("Area under pressure", "mm²", area),
    ]
    recorded = np.array([frame.assembly.recorded for frame in r.frames])
    for title, unit, part, shown in (
        ("Displacement from the recorded pose", "mm", slice(0, 3), lambda values: values * MM),
        ("Turn from the recorded pose", "deg", slice(3, 6), np.degrees),
    ):
        curves: list[Curve] = []
        for k, (body, one) in enumerate(r.pressing.free.items()):
            for j in range(*part.indices(6)):
                if one.free[j]:
                    column = 6 * k + j
                    away = shown(r.values[:, column] - recorded[:, column])
                    curves.append(Curve(f"{body} {COORDINATES[j]}", away, stroke=len(curves)))
        if curves:
            panels.append(Curves(title, unit, curves))
    return CurveSheet(panels, _clock(r), columns=1)


def _clock(r: RestingBodies) -> Course:
    return r.pressing.touching.pairs[0].motion.course


def _force(load: PressureLoad) -> float:
    return load.pressing


def thinned_rest_page(title: str, r: RestingBodies, sentences: Sequence[str]) -> Thinned:
    """The page, of as many frames at rest as its file holds."""
    start = heaviest(r)

    def of(most: int) -> Page:
        kept = r.kept
        return _page(title, r, sentences, np.union1d(kept[:: -(-len(kept) // most)], [start]), start)

    return Thinned(of, FRAMES, FEWEST)


def heaviest(r: RestingBodies) -> int:
    """Frame at rest with the largest force of all pairs together."""
    return int(np.nanargmax(np.sum([r.of_contact(name, _force) for name in r.contacts], axis=0)))


def _page(title: str, r: RestingBodies, sentences: Sequence[str], frames: Int[np.ndarray, " k"], start: int) -> Page:
    course = _clock(r)
    found = Words("What was found", list(sentences))
    sections: list[Section] = [
        _scene(r, frames),
        Readout(_rows(r, frames)),
        *rest_curves(r).at(frames),
        _table(r, start, course.at(start)),
        *([found] if len(sentences) > MOST else []),
        INPUTS,
        OPTIONS,
        *_words(r),
    ]
    return Page(
        title=title,
        subtitle=f"Contact equilibrium of {counted(len(r.frames), 'frame')}",
        time=course.values[frames],
        time_label=course.label,
        headline=headline(sentences),
        facts=[
            ("Frames at rest", f"{int(r.converged.sum())} of {len(r.frames)}"),
            *((name, f"up to {np.nanmax(r.of_contact(name, _force)):.0f} N") for name in r.contacts),
        ],
        start_frame=int(np.flatnonzero(frames == start)[0]),
        sections=tuple(sections),
        numbers=frames + 1,
        total=len(r.frames),
    )


def _scene(r: RestingBodies, frames: Int[np.ndarray, " k"]) -> Scene:
    """All bodies in the common frame, and the pressures on each that has a layer."""
    at = np.searchsorted(r.kept, frames)
    surfaces, moves = r.pressing.surfaces, r.pressing.touching.motions
    bodies = tuple(
        SceneBody(
            name,
            surface.vertices,
            surface.faces,
            r.poses[name][at] if name in r.pressing.free or moves[name] is not None else None,
        )
        for name, surface in surfaces.items()
    )
    pressed = dict.fromkeys(pair.fixed for pair in r.pressing.pairs)
    maps = tuple(
        FaceMap(
            f"mean pressure of each face, {name}",
            "MPa",
            list(surfaces).index(name),
            np.array([r.face_pressure(name, int(k)) for k in frames]) * MPA,
        )
        for name in pressed
    )
    return Scene(
        bodies=bodies,
        thresholds=(UNUSED,),
        span=(0.0, UNUSED),
        directions=camera_directions(np.zeros(3)),
        maps=maps,
    )


def _rows(r: RestingBodies, frames: Int[np.ndarray, " k"]) -> list[Row]:
    rows = []
    for name in r.contacts:
        rows.append(Row(f"force, {name}", "N", _texts(r.of_contact(name, _force)[frames], 1)))
        rows.append(
            Row(f"largest pressure, {name}", "MPa", _texts(r.of_contact(name, lambda load: load.peak)[frames] * MPA, 2))
        )
    for k, (body, one) in enumerate(r.pressing.free.items()):
        values = r.coordinates(body)[frames]
        for j, name in enumerate(COORDINATES):
            if one.free[j]:
                unit, shown = ("mm", values[:, j] * MM) if j < 3 else ("deg", np.degrees(values[:, j]))
                rows.append(Row(f"{body} {name}", unit, _texts(shown, 3)))
        rows.append(Row(f"residual force, {body}", "N", [f"{value:.1e}" for value in r.residuals[frames, k]]))
    return rows


def _texts(values: Float[np.ndarray, " k"], digits: int) -> list[str]:
    return [f"{value:.{digits}f}" for value in values]


def _table(r: RestingBodies, k: int, when: str) -> Table:
    """Loads by pair in one frame."""
    rows = []
    for name, pair in zip(r.pressing.names, r.pressing.pairs, strict=True):
        load, wrench = r.contacts[name][k], r.wrenches[name][k]
        peak = "" if load is None else f"{load.peak * MPA:.2f} MPa"
        rows.append((name, pair.fixed, *wrench_texts(wrench), peak))
    rows += [("all pairs", body, *wrench_texts(load[k]), "") for body, load in r.loads.items()]
    return Table(LOADS.format(when), (*WRENCH_HEADER, "largest pressure"), rows)


def _words(r: RestingBodies) -> list[Section]:
    layers = "; ".join(
        f"{name}: {pair.fixed} is a layer ({pair.layer.law} law, confined modulus {pair.layer.modulus * MPA:.3g} MPa, "
        f"{pair.layer.thickness.min() * MM:.1f} to {pair.layer.thickness.max() * MM:.1f} mm), {pair.moving} is rigid"
        for name, pair in zip(r.pressing.names, r.pressing.pairs, strict=True)
    )
    settles = "; ".join(
        f"{body}: {listed(tuple(np.array(COORDINATES)[one.free].tolist()))}" for body, one in r.pressing.free.items()
    )
    model = (
        f"{layers}. Springs of a layer do not know each other. Settled: {settles}; everything else is as recorded. "
        "There is no friction, no ligament, no muscle and no weight but the forces and springs of the description; "
        "every frame that is shown is at rest."
    )
    trust = (
        "Loads follow from modulus and thickness, and from how close the surfaces are. Compare a smaller piece and a "
        "finer mesh. An equilibrium found from these poses need not be the only one."
    )
    return [Words("The model", [model]), Words("Context of use", [trust, NOT_A_DEVICE])]
