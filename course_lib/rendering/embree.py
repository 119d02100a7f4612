"""Rays against triangles by Intel's Embree (embreex), where it has a wheel for the processor. Embree is float32."""

from __future__ import annotations

import numpy as np

try:
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene
except ImportError:  # no wheel for this processor
    EmbreeScene = TriangleMesh = None


class EmbreeCaster:
    """Triangles ready to be hit by rays. corners: `(F, 3, 3)`. Raises `ImportError` where embreex is missing."""

    def __init__(self, corners: np.ndarray) -> None:
        if EmbreeScene is None:
            raise ImportError(
                "embreex is missing, which has wheels for x86-64 and for macOS: the simulated world needs it, so make "
                "data there (the shipped data and the lessons do not need it)"
            )
        # robust: no ray slips through the edge that two triangles share.
        self._scene = EmbreeScene(robust=True)
        self._mesh = TriangleMesh(self._scene, np.ascontiguousarray(corners, dtype=np.float32))

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First hits of rays: origins and directions `(N, 3)`.

        Returns distances `(N,)` in units of the direction's length, `inf` where nothing is hit; the faces hit `(N,)`,
        -1 where none; their normals `(N, 3)`, not of unit length.
        """
        origins, directions = (np.ascontiguousarray(array, dtype=np.float32) for array in (origins, directions))
        hits = self._scene.run(origins, directions, output=True)
        return np.where(hits["primID"] >= 0, hits["tfar"], np.inf), hits["primID"], hits["Ng"]
