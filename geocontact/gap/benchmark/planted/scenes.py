"""Scenes by system."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from geocontact.gap.benchmark.planted.elbow_scene import elbow_scene
from geocontact.gap.benchmark.planted.foot_scene import foot_scene
from geocontact.gap.benchmark.planted.knee_scene import knee_scene
from geocontact.gap.benchmark.planted.scene import Scene
from geocontact.gap.benchmark.planted.shoulder_scene import shoulder_scene
from geocontact.gap.benchmark.planted.sit_to_stand_scene import sit_to_stand_scene

SCENES: Mapping[str, Callable[..., Scene]] = {
    "elbow": elbow_scene,
    "foot": foot_scene,
    "shoulder": shoulder_scene,
    "knee": knee_scene,
    "sit_to_stand": sit_to_stand_scene,
}
