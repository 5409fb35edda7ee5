"""The largest meshes that are read; checked before anything of that size is allocated."""

from __future__ import annotations

from geocontact.data.errors import InputError

MAX_FACES = 20_000_000
"""Most triangles of one mesh; a binary STL of that size has 1 GB."""

MAX_VERTICES = 3 * MAX_FACES
"""Most vertices of one mesh: three of its own for every triangle."""


def require_count(count: int, limit: int, noun: str, file: str) -> None:
    """Refuse `count` things called `noun` when there are none of them or more than `limit`."""
    if count <= 0:
        raise InputError(file, "", f"no {noun}", "export it again as a triangle surface")
    require_at_most(count, limit, noun, file)


def require_at_most(count: int, limit: int, noun: str, file: str) -> None:
    """Refuse `count` things called `noun` when there are more than `limit`."""
    if count > limit:
        raise InputError(file, "", f"{count} {noun}, more than the {limit} that are read", "decimate the mesh first")
