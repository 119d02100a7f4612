"""One network of OpenCV for several threads and processes: what its two kinds, Darknet's and ONNX, have in common."""

from __future__ import annotations

import os
import threading
import weakref

import cv2
import numpy as np


class SharedNetwork:
    """A network that is opened once and runs one blob at a time, whoever asks.

    OpenCV keeps input and results inside the network: of two threads at once, one gets the other's boxes, without an
    error. So they take turns. Pickled, as "spawn" does it, a network takes along where its files are, and reads them
    again when it is first used there; a forked child uses what it inherits.
    """

    def __init__(self) -> None:
        """Opens the network. Raises what `_opened` raises."""
        self._turn = threading.Lock()
        self._net: cv2.dnn.Net | None = self._opened()
        _networks.add(self)

    def _opened(self) -> cv2.dnn.Net:
        """The network, read from its files."""
        raise NotImplementedError

    def _results(self, blob: np.ndarray) -> list[np.ndarray]:
        """What the network's outputs give for a blob (1, 3, H, W). Raises cv2.error, and what `_opened` raises."""
        with self._turn:
            if self._net is None:
                self._net = self._opened()
            self._net.setInput(blob)
            # Copied: the next run writes over what OpenCV gives.
            return [np.array(output) for output in self._net.forward(self._net.getUnconnectedOutLayersNames())]

    def __getstate__(self) -> dict[str, object]:
        """For pickle and copy: everything but the open network."""
        return vars(self) | {"_net": None, "_turn": None}

    def __setstate__(self, state: dict[str, object]) -> None:
        vars(self).update(state, _turn=threading.Lock())
        _networks.add(self)


_networks: weakref.WeakSet[SharedNetwork] = weakref.WeakSet()


def _open_the_turns() -> None:
    """In a forked child: a fork copies a lock as it is, and the thread that held it is not there to give it back."""
    for network in _networks:
        network._turn = threading.Lock()


if hasattr(os, "register_at_fork"):  # not on Windows, which cannot fork
    os.register_at_fork(after_in_child=_open_the_turns)
