"""How a training changes with its progress: the learning rate, and the slow average of the weights."""

from __future__ import annotations

import copy
import math

import torch
from torch import nn

# Share of the largest learning rate that is left at the end.
LAST_SHARE = 0.01


def learning_rate(largest: float, step: int, warm_up_steps: int, progress: float) -> float:
    """The learning rate after `step` steps, at `progress` in [0, 1] of the whole training.

    rate = largest min(1, (step + 1) / warm_up) (r + (1 - r) (1 + cos(pi progress)) / 2),  r = 0.01
    """
    warm_up = min(1.0, (step + 1) / max(1, warm_up_steps))
    cosine = 0.5 * (1.0 + math.cos(math.pi * min(max(progress, 0.0), 1.0)))
    return largest * warm_up * (LAST_SHARE + (1.0 - LAST_SHARE) * cosine)


class AveragedNetwork:
    """An exponential moving average of a network's weights and running statistics, used instead of the last ones.

    average <- d average + (1 - d) weights,  d = decay (1 - exp(-steps / ramp)): the average forgets its random start.
    """

    def __init__(self, network: nn.Module, decay: float = 0.999, ramp: float = 500.0):
        self.network = copy.deepcopy(network).eval().requires_grad_(False)
        self.decay, self.ramp, self.steps = decay, ramp, 0

    @torch.no_grad()
    def update(self, network: nn.Module) -> None:
        """One step of the average towards `network`."""
        self.steps += 1
        keep = self.decay * (1.0 - math.exp(-self.steps / self.ramp))
        current = network.state_dict()
        for name, value in self.network.state_dict().items():
            if value.is_floating_point():
                value.lerp_(current[name].to(value.dtype), 1.0 - keep)
            else:
                value.copy_(current[name])
