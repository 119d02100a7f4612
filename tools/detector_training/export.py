"""Darknet `.weights` files of a `TrainableNetwork`: written after the training, read to go on from one.

The file: major, minor, revision (int32) = 0, 2, 5; images seen (int64); then for each convolution, in order, as
float32: with batch normalization beta, gamma, running mean, running variance, without it the bias; then the kernel.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from torch import nn

from course_lib.files import atomic_write
from course_lib.spherical_stereo.detection.darknet import check_weights, header_bytes
from tools.detector_training.network import TrainableNetwork

VERSION = (0, 2, 5)


def write_weights(network: TrainableNetwork, path: str | Path, images_seen: int = 0) -> Path:
    """Write the network's weights as a Darknet file that OpenCV reads; return its path."""
    path = Path(path)
    tensors = [tensor.detach().numpy().astype("<f4") for tensor in _tensors_in_file_order(network)]
    parts = [np.array(VERSION, "<i4"), np.array([images_seen], "<i8"), *tensors]
    atomic_write(path, b"".join(part.tobytes() for part in parts))
    return path


@torch.no_grad()
def read_weights(network: TrainableNetwork, path: str | Path) -> int:
    """Puts the weights of a Darknet file into the network; returns the number of images it has seen.

    Raises `DetectorError` when the file is missing or its length is not what the network's cfg implies.
    """
    check_weights(network.sections, path)
    data = Path(path).read_bytes()
    start = header_bytes(data[:12])
    images_seen = int(np.frombuffer(data[12:start], "<i8" if start == 20 else "<i4")[0])
    values = torch.from_numpy(np.frombuffer(data[start:], "<f4").copy())
    for tensor in _tensors_in_file_order(network):
        count = tensor.numel()
        tensor.copy_(values[:count].view(tensor.shape))
        values = values[count:]
    return images_seen


def _tensors_in_file_order(network: TrainableNetwork):
    for layer in network.layers:
        if not (isinstance(layer, nn.Sequential) and isinstance(layer[0], nn.Conv2d)):
            continue
        convolution = layer[0]
        if convolution.bias is None:
            normalization = layer[1]
            yield from (normalization.bias, normalization.weight, normalization.running_mean, normalization.running_var)
        else:
            yield convolution.bias
        yield convolution.weight
