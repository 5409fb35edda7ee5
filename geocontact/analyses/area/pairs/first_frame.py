"""All bodies of a description at the first frame, for a picture of a form."""

from __future__ import annotations

from geocontact.analyses.area.first_frame import FirstFrame, FramePair, frame_words
from geocontact.analyses.area.pairs.bodies import read
from geocontact.analyses.area.pairs.options import PairsOptions
from geocontact.geometry.surface import Surface


def first_frame(o: PairsOptions) -> FirstFrame:
    """The bodies of `pairs` in their first frame; InputError as the analysis has it."""
    touching = read(o)
    surfaces, pairs = dict[str, Surface](), []
    for each in touching.pairs:
        surfaces |= {each.fixed: each.bodies.fixed, each.moving: each.bodies.moving}
        pairs.append(FramePair.of(each.bodies, each.motion, o.bounds, (each.name, each.moving, each.fixed)))
    poses = {name: None if touching.motions[name] is None else touching.poses(name)[:1] for name in surfaces}
    return FirstFrame(surfaces, poses, tuple(pairs), frame_words(touching.pairs[0].motion))
