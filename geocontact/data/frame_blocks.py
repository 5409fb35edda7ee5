"""Long recordings a part at a time: what is worked out frame by frame takes the memory of one part."""

from __future__ import annotations

from collections.abc import Iterator

AT_ONCE = 1 << 21
"""Values of a part: 16 MB."""


def blocks(count: int, each: int) -> Iterator[slice]:
    """Slices that follow each other over `count` frames, or channels, of `each` values; one at least."""
    step = max(1, AT_ONCE // max(1, each))
    yield from (slice(start, min(start + step, count)) for start in range(0, max(1, count), step))
