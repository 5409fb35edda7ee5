"""What the pages of standing up share: chains side by side with the forces on them, curves, words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.data.motion import Course
from geocontact.standing_up.chain import COORDINATES, Subject
from geocontact.standing_up.exoskeleton import STRAP_PARAMETERS
from geocontact.standing_up.stance import chain_of
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.curves.declared import Curve, Curves, stroke
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.scene import Linkage, Scene

Of = Callable[[Any], Any]
FRAMES = 101
PARTS = Course("part of the movement", "%", np.linspace(0.0, 100.0, FRAMES))
"""Along what pages and figures run: trials last differently long."""
METRES_PER_NEWTON = 6e-4
"""A force of 1 kN is drawn 0.6 m long."""
BESIDE = 0.7
"""Between two trials [m]."""
METRES_PER_STRAP_NEWTON = 5e-3
"""A strap's force of 100 N is drawn 0.5 m long."""
OUTSIDE = np.array([0.0, 0.0, 0.08])
"""Where the exoskeleton is drawn beside the leg [m]."""
FREE = 3
"""Coordinates of the foot, before those of the joints."""
JOINT, LIMB, ARROW = 0.025, 0.03, 0.012
DIRECTIONS = {
    "right (+z)": (0.0, 0.0, 1.0),
    "front (+x)": (1.0, 0.0, 0.0),
    "above (+y)": (0.0, 1.0, 0.0),
}


def motion_page(
    titles: tuple[str, str],
    sentences: Sequence[str],
    sections: Sequence[Section],
    words: Sequence[str],
    facts: Sequence[tuple[str, str]] = (),
) -> Page:
    """Title and subtitle, what was found as the headline, sections, and what the numbers mean."""
    title, subtitle = titles
    return Page(
        title=title,
        subtitle=subtitle,
        time=PARTS.values,
        time_label=PARTS.label,
        headline=headline(sentences),
        facts=list(facts),
        sections=(*sections, INPUTS, OPTIONS, Words("What the numbers mean", [*words, NOT_A_DEVICE])),
    )


def standing_scene(subject: Subject, trials: Sequence[TrialResult]) -> Scene:
    """All trials side by side, each over its own time."""
    each = [_lines(subject, trial, k, len(trials)) for k, trial in enumerate(trials)]
    lines = [_as_one(alike) for alike in zip(*each, strict=True)]
    return Scene(directions=DIRECTIONS, up=(0.0, 1.0, 0.0), view=(0.5, 0.25, 1.0), linkages=lines)


def _as_one(alike: Sequence[Linkage]) -> Linkage:
    """The same of all trials: one entry of the legend."""
    first = np.cumsum([0, *(one.points.shape[1] for one in alike[:-1])])
    points = np.concatenate([one.points for one in alike], axis=1)
    lines = np.concatenate([one.lines + k for one, k in zip(alike, first, strict=True)])
    return Linkage(alike[0].name, points, lines, alike[0].tone, alike[0].radius, alike[0].width)


def at_parts(trial: TrialResult, values: Float[np.ndarray, "t ..."]) -> Float[np.ndarray, "f ..."]:
    """At the page's parts of the movement."""
    return over_parts(trial.recorded.time, values)


def over_parts(time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t ..."]) -> Float[np.ndarray, "f ..."]:
    """The same of what is known at times of its own."""
    at = np.linspace(time[0], time[-1], FRAMES)
    columns = values.reshape(len(time), -1).T
    return np.stack([np.interp(at, time, each) for each in columns], axis=1).reshape(FRAMES, *values.shape[1:])


def _lines(subject: Subject, trial: TrialResult, number: int, count: int) -> list[Linkage]:
    """Bodies, and the ground's force on both feet at its centre; trials stand side by side."""
    aside = np.array([0.0, 0.0, BESIDE * (number - 0.5 * (count - 1))])
    worn = trial.model.q.shape[1] > len(COORDINATES)
    poses = chain_of(subject, trial.model.q.shape[1]).poses(at_parts(trial, trial.model.q))
    segments = subject.segments
    toe = poses["foot"].apply(np.array([segments["foot"].length, -0.05, 0.0]))
    heel = poses["foot"].apply(np.array([-0.05, -0.05, 0.0]))
    names = [name for name in ("shank", "thigh", "trunk") if name in poses]
    top = poses[names[-1]].apply(np.array([0.0, segments[names[-1]].length, 0.0]))
    joints = [poses[name].translation for name in names]
    body = np.stack([*joints, top], axis=1)
    foot = np.stack([heel, joints[0], toe], axis=1)
    centre = np.zeros((FRAMES, 3))
    centre[:, 0] = at_parts(trial, trial.model.centre)
    end = centre.copy()
    end[:, :2] += METRES_PER_NEWTON * at_parts(trial, trial.model.force)
    arrow = np.stack([centre, end], axis=1) + aside
    edge = np.array([[-0.3, 0.0, -0.2], [-0.3, 0.0, 0.2], [0.5, 0.0, 0.2], [0.5, 0.0, -0.2]]) + aside
    loop = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
    device = []
    if worn:
        hinges = [poses[each].translation for each in ("exo_shank", "exo_thigh", "exo_module")]
        end_of = poses["exo_module"].apply(np.array([0.0, subject.device.module_height, 0.0]))
        points = np.stack([*hinges, end_of], axis=1) + aside + OUTSIDE
        device = [
            Linkage("exoskeleton", points, _open(4), "model", JOINT, LIMB),
            _strap(trial, poses["thigh"], aside),
        ]
    return [
        *device,
        Linkage(", ".join(names), body + aside, _open(len(names) + 1), "bone", JOINT, LIMB),
        Linkage("foot", foot + aside, np.array([(0, 1), (1, 2), (0, 2)]), "bone", 0.0, 0.6 * LIMB),
        Linkage(
            f"force on {'both feet' if 'trunk' in names else 'the foot'}, 0.6 m for 1 kN",
            arrow,
            _open(2),
            "force",
            0.0,
            ARROW,
        ),
        Linkage("floor", edge[None].repeat(FRAMES, axis=0), loop, "floor", 0.0, 0.5 * ARROW),
    ]


def _elsewhere(site: str, trial: StandingTrial) -> Float[np.ndarray, " t"]:
    return trial.elsewhere.get(site, np.full(len(trial.time), np.nan))


def _strap(trial: TrialResult, thigh: RigidTransform, aside: Float[np.ndarray, " 3"]) -> Linkage:
    """Normal force of one leg's strap on the person, at the usual place."""
    strap = np.zeros(len(trial.recorded.time)) if trial.model.strap is None else trial.model.strap
    at = thigh.apply(np.array([0.0, STRAP_PARAMETERS[-1].usual, 0.0]))
    across = thigh.rotation.apply(np.array([1.0, 0.0, 0.0]))
    end = at + METRES_PER_STRAP_NEWTON * at_parts(trial, strap)[:, None] * across
    points = np.stack([at, end], axis=1) + aside + OUTSIDE
    return Linkage("normal force of one strap, 0.5 m for 100 N", points, _open(2), "force", 0.0, ARROW)


def _open(points: int) -> Int[np.ndarray, "k 2"]:
    return np.array([(i, i + 1) for i in range(points - 1)], np.int64)


def _torque(k: int, trial: TrialResult) -> Float[np.ndarray, " t"]:
    return np.full(len(trial.recorded.time), np.nan) if trial.model.torque is None else trial.model.torque[:, k]


def of_trial(k: int, recorded: bool = False) -> int:
    """Stroke of a trial: its colour, as a line for the model, dashed as recorded."""
    return stroke(k % 4, 3 * (k // 4) + int(recorded))


def standing_curves(trials: Sequence[TrialResult]) -> list[Curves]:
    """Forces and centre of pressure by model and recording, residuals and torques."""
    panels = []
    pairs: list[tuple[str, str, float, Of]] = [
        ("Ground reaction upwards", "N", 1.0, lambda t: t.force[:, 1]),
        ("Ground reaction forwards", "N", 1.0, lambda t: t.force[:, 0]),
        ("Centre of pressure", "mm", 1e3, lambda t: t.centre),
    ]
    if all(trial.model.strap is not None and trial.recorded.strap is not None for trial in trials):
        pairs.append(("Normal force of one strap, forwards", "N", 1.0, lambda t: t.strap))
    sites = trials[0].model.elsewhere
    pairs += [(f"Normal force of a strap, {site}, forwards", "N", 1.0, partial(_elsewhere, site)) for site in sites]
    for title, unit, factor, of in pairs:
        curves = []
        for k, trial in enumerate(trials):
            name = trial.recorded.name
            curves.append(Curve(f"{name} model", factor * at_parts(trial, of(trial.model)), stroke=of_trial(k)))
            recorded = at_parts(trial, of(trial.recorded))
            if np.isfinite(recorded).all():
                curves.append(Curve(f"{name} recorded", factor * recorded, stroke=of_trial(k, recorded=True)))
        panels.append(Curves(title, unit, curves))
    joints = trials[0].model.q.shape[1] - FREE
    whose = " of both legs" if joints > 2 else ""
    single: list[tuple[str, str, Of]] = [
        (f"{name} torque{whose}", "N m", partial(_torque, k)) for k, name in ((1, "Knee"), (2, "Hip"))[: joints - 1]
    ]
    single += [
        ("Residual of the forces between the points", "N", lambda t: t.residual(t.judged.force)),
        ("Residual of the moments between the points", "N m", lambda t: t.residual(t.judged.moment)),
    ]
    for title, unit, of_one in single:
        curves = [
            Curve(f"{trial.recorded.name} model", at_parts(trial, of_one(trial)), stroke=of_trial(k))
            for k, trial in enumerate(trials)
        ]
        panels.append(Curves(title, unit, curves, log=title.startswith("Residual")))
    return panels
