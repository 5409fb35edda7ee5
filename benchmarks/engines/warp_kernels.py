# mypy: ignore-errors
"""Warp's own language: it reads annotations as types, so this file does without the postponed ones."""


def load():
    """The module `warp` and two kernels: unsigned distance, signed distance."""
    import warp as wp

    wp.config.quiet = True
    wp.config.log_level = 40
    wp.init()

    @wp.kernel
    def plain(
        mesh: wp.uint64, points: wp.array(dtype=wp.vec3), bound: float, far: float, distance: wp.array(dtype=float)
    ):
        i = wp.tid()
        found = wp.mesh_query_point_no_sign(mesh, points[i], bound)
        d = far
        if found.result:
            d = wp.length(wp.mesh_eval_position(mesh, found.face, found.u, found.v) - points[i])
        distance[i] = d

    @wp.kernel
    def with_sign(
        mesh: wp.uint64, points: wp.array(dtype=wp.vec3), bound: float, far: float, distance: wp.array(dtype=float)
    ):
        i = wp.tid()
        found = wp.mesh_query_point_sign_normal(mesh, points[i], bound)
        d = far
        if found.result:
            d = found.sign * wp.length(wp.mesh_eval_position(mesh, found.face, found.u, found.v) - points[i])
        distance[i] = d

    return wp, plain, with_sign
