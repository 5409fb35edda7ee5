"""Scenes by system."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from geocontact.gap_benchmark.synthetic.scene import SyntheticScene
from geocontact.gap_benchmark.synthetic.systems.elbow.scene import elbow_scene
from geocontact.gap_benchmark.synthetic.systems.foot.scene import foot_scene
from geocontact.gap_benchmark.synthetic.systems.knee.scene import knee_scene
from geocontact.gap_benchmark.synthetic.systems.shoulder.scene import shoulder_scene
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand.scene import sit_to_stand_scene

SCENES: Mapping[str, Callable[..., SyntheticScene]] = {
    "elbow": elbow_scene,
    "foot": foot_scene,
    "shoulder": shoulder_scene,
    "knee": knee_scene,
    "sit_to_stand": sit_to_stand_scene,
}
