"""The direction from which a page opens: where the contact patch is seen without a click."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.view.page.content import Scene, SceneBody

SEE_THROUGH = 0.25
TILT = np.radians(30.0)


def opacities(scene: Scene) -> list[float]:
    """Opacity of each body at the start: moving bodies are see-through where a fixed one is there to be seen."""
    fixed = any(body.poses is None for body in scene.bodies)
    chosen = (SEE_THROUGH if fixed and body.poses is not None else 1.0 for body in scene.bodies)
    return [auto if body.opacity is None else body.opacity for body, auto in zip(scene.bodies, chosen, strict=True)]


def opening_view(scene: Scene, frame: int) -> Float[np.ndarray, " 3"]:
    """Unit vector in S from which to look: along the patch's mean normal, leant towards the first preset.

    A patch is looked for on the most opaque coloured body; without one, the view is oblique from the first preset.
    """
    if scene.view is not None:
        return _unit(np.asarray(scene.view, float))
    up = _unit(np.asarray(scene.up, float))
    presets = [_unit(np.asarray(v, float)) for v in scene.directions.values()]
    order = np.argsort([-opacity for opacity in opacities(scene)], kind="stable")
    normals = (patch_normal(scene.bodies[k], frame, scene.threshold) for k in order)
    normal = next((n for n in normals if n is not None), None)
    if normal is None:
        return _unit((presets[0] if presets else np.array([1.0, 0.0, 0.0])) + 0.5 * up)
    towards = next((p for p in presets if abs(p @ normal) < 0.7), None)
    if towards is None:
        return normal
    sideways = _unit(towards - (towards @ normal) * normal)
    return np.asarray(np.cos(TILT) * normal + np.sin(TILT) * sideways)


def patch_normal(body: SceneBody, frame: int, threshold: float) -> Float[np.ndarray, " 3"] | None:
    """Mean outward direction in S of the faces with all corners within `threshold` [m]; None without such faces."""
    if body.distance is None:
        return None
    near = (body.distance[frame] <= threshold)[body.faces].all(axis=1)
    corners = body.vertices[body.faces[near]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    if not np.linalg.norm(normal) > 0.0:
        return None
    return _unit(normal if body.poses is None else body.poses[frame].rotation.apply(normal))


def _unit(vector: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    return np.asarray(vector / np.linalg.norm(vector))
