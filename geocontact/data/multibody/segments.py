"""Poses or orientations of segments over time, as motion capture without markers and inertial sensors give them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False)
class SegmentPoses:
    """Orientation, and place where it is known, of each segment or sensor.

    Parameters
    ----------
    time
        [s], strictly increasing.
    rotations
        R_GS: columns are the segment's axes in the laboratory's frame; NaN where the segment was not seen.
    origins
        Of the segments in the laboratory's frame [m]; None of sensors, which know no place.
    names
        One for each segment.
    source
        The file, for messages and the record.
    """

    time: Float[np.ndarray, " t"]
    rotations: Float[np.ndarray, "t s 3 3"]
    origins: Float[np.ndarray, "t s 3"] | None
    names: tuple[str, ...]
    source: str = ""

    def __len__(self) -> int:
        return len(self.time)

    @property
    def there(self) -> Bool[np.ndarray, "t s"]:
        """Whether a segment was seen in a frame."""
        found = np.isfinite(self.rotations).all(axis=(2, 3))
        return np.asarray(found if self.origins is None else found & np.isfinite(self.origins).all(axis=2))

    def between(self, start: float, stop: float) -> SegmentPoses:
        """Frames from one time to another, both included to a millionth of a second."""
        return self._frames((self.time >= start - 1e-6) & (self.time <= stop + 1e-6))

    def _frames(self, kept: Bool[np.ndarray, " t"]) -> SegmentPoses:
        origins = None if self.origins is None else self.origins[kept]
        return replace(self, time=self.time[kept], rotations=self.rotations[kept], origins=origins)

    def turned(self, turn: Rotation) -> SegmentPoses:
        """The same in axes that this rotation turns those of the file into."""
        matrix = turn.as_matrix()
        origins = None if self.origins is None else self.origins @ matrix.T
        return replace(self, rotations=matrix @ self.rotations, origins=origins)

    def of(self, names: Sequence[str]) -> SegmentPoses:
        """These segments in this order; ValueError for one that was not recorded."""
        places = [self.names.index(name) for name in names]
        origins = None if self.origins is None else self.origins[:, places]
        return replace(self, rotations=self.rotations[:, places], origins=origins, names=tuple(names))
