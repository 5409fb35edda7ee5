"""The 3-D picture of a scene by pyvista; `main` is what the child process runs.

Rendering takes place in a child process even after the probe has passed: the probe's small sphere does not show that a
driver survives this scene, a crash must not take an analysis with it, and VTK writes its complaints straight to the
terminal. One child renders all views of a scene, because most of its time goes into starting.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float, Int, UInt8

from geocontact.view.surfaces.camera import Shot
from geocontact.view.surfaces.legend import (
    MOVING,
    coloured,
    known_up_to,
    level_lines,
    threshold_colour,
)
from geocontact.view.surfaces.scene import ContactScene

if TYPE_CHECKING:
    from pyvista import Plotter, PolyData

PROGRAM = "import sys; from geocontact.view.surfaces.render import main; main(sys.argv[1])"
MM = 1e3
CREASE = 30.0  # degrees between faces from which on an edge is drawn sharp


def hand_over(scene: ContactScene, shots: list[Shot], folder: Path) -> None:
    """Write what `main` needs."""
    arrays: dict[str, Any] = {name: np.asarray(value) for name, value in vars(scene).items()}
    for k, shot in enumerate(shots):
        arrays |= {f"shot_{k}_{name}": np.asarray(value) for name, value in vars(shot).items()}
    np.savez(folder / "scene.npz", allow_pickle=False, shots=len(shots), **arrays)


def main(folder: str) -> None:
    """Render every shot of the scene in `folder` into `<number>.npy` beside it: (height, width, 3) bytes."""
    with np.load(Path(folder) / "scene.npz", allow_pickle=False) as stored:
        given = dict(stored)
    names = ContactScene.__dataclass_fields__
    scene = ContactScene(
        **{name: given[name] for name in names if given[name].ndim and name != "thresholds"},
        thresholds=tuple(float(t) for t in given["thresholds"]),
    )
    for k in range(int(given["shots"])):
        part = {name: given[f"shot_{k}_{name}"] for name in ("axes", "centre", "half")}
        width, height = (int(n) for n in given[f"shot_{k}_pixels"])
        np.save(Path(folder) / f"{k}.npy", rendered(scene, Shot(**part, pixels=(width, height))), allow_pickle=False)


def rendered(scene: ContactScene, shot: Shot) -> UInt8[np.ndarray, "h w 3"]:
    """Picture of the scene without any text. May end the process: see the module."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(shot.pixels), lighting="none")
    try:
        add_fixed(plotter, scene)
        # along the view, which a parallel projection does not show
        add_lines(plotter, scene, 0.01 * float(shot.half.max()) * shot.axes[2:], width=10.0)
        add_moving(plotter, scene.moving_vertices, scene.moving_faces)
        light(plotter)
        look(plotter, shot)
        plotter.enable_depth_peeling(number_of_peels=12, occlusion_ratio=0.0)
        plotter.enable_anti_aliasing("ssaa")
        return np.asarray(plotter.screenshot(return_img=True))[:, :, :3]
    finally:
        plotter.close()


def surface(vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> PolyData:
    """Triangle surface [mm] of vertices in m."""
    import pyvista

    return pyvista.PolyData.from_regular_faces(vertices * MM, faces)


def add_fixed(plotter: Plotter, scene: ContactScene) -> Any:
    """FIXED coloured by distance; grey beyond what was asked for."""
    from matplotlib.colors import ListedColormap

    known = known_up_to(scene.distance, scene.fixed_faces)
    values, colours, limits = coloured(scene.distance, scene.thresholds, known)
    body = surface(scene.fixed_vertices, scene.fixed_faces)
    body.point_data["distance"] = values
    return plotter.add_mesh(
        body,
        scalars="distance",
        cmap=ListedColormap(colours),
        n_colors=len(colours),
        clim=limits,
        interpolate_before_map=True,
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=CREASE,
        show_scalar_bar=False,
        ambient=0.35,
        diffuse=0.65,
        specular=0.0,
    )


def add_lines(plotter: Plotter, scene: ContactScene, shift: Float[np.ndarray, "#m 3"], width: float) -> list[Any]:
    """Line of each threshold on FIXED, cased in white to stand out from every colour of the map.

    Lines are moved by `shift` [m], one for each face or one for all: off the surface, which would hide the half of
    their width that lies beneath it.
    """
    import pyvista

    shift = np.broadcast_to(shift, (len(scene.fixed_faces), 3))
    drawn = []
    for k, threshold in enumerate(scene.thresholds):
        ends, face = level_lines(scene.fixed_vertices, scene.fixed_faces, scene.distance, threshold)
        if not len(ends):
            continue
        for colour, thick, share in (("white", 2.0 * width, 0.7), (threshold_colour(k), width, 1.0)):
            points = (ends + share * shift[face][:, None, :]).reshape(-1, 3)
            lines = pyvista.line_segments_from_points(points * MM)
            drawn.append(plotter.add_mesh(lines, color=colour, line_width=thick, lighting=False))
    return drawn


def add_moving(plotter: Plotter, vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> list[Any]:
    """MOVING as a veil with its outline, thin enough for the colours beneath to be read."""
    body = surface(vertices, faces)
    outline = plotter.add_silhouette(body, color=MOVING, line_width=6.0, feature_angle=CREASE, opacity=0.9)
    veil = plotter.add_mesh(
        body,
        color=MOVING,
        opacity=0.13,
        culling="back",
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=CREASE,
        ambient=0.5,
        diffuse=0.5,
        specular=0.0,
    )
    return [outline, veil]


def light(plotter: Plotter) -> None:
    """A white background and light from beside the eye: shading tells the shape, colours stay what they mean."""
    import pyvista

    plotter.set_background("white")
    for position, strength in (((0.3, 0.4, 1.0), 0.9), ((-0.8, 0.1, 0.6), 0.25)):
        lamp = pyvista.Light(position=position, intensity=strength, light_type="camera light")
        plotter.add_light(lamp)


def look(plotter: Plotter, shot: Shot) -> None:
    """Parallel projection with the picture's height covering twice the half height of the shot."""
    far = 4.0 * float(np.linalg.norm(shot.half))
    camera = plotter.camera
    camera.focal_point = shot.centre * MM
    camera.position = (shot.centre + far * shot.axes[2]) * MM
    camera.up = shot.axes[1]
    camera.parallel_projection = True
    camera.parallel_scale = float(shot.half[1]) * MM
    camera.clipping_range = ((far - 1.1 * shot.half[2]) * MM, (far + 1.1 * shot.half[2]) * MM)


if __name__ == "__main__":
    main(sys.argv[1])
