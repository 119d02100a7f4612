"""What changes from step to step of a training, and the checkpoint that keeps it; the learning rate."""

import copy
import io
import math
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from torch import nn

from course_lib.files import atomic_write

FILE = "checkpoint.pt"
LAST_SHARE = 0.01  # of the largest learning rate, at the end


class CheckpointError(ValueError):
    """A checkpoint that is missing or belongs to another training."""


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


@dataclass
class Position:
    """Where a training is. Samples are drawn from (seed, epoch, place), so no state of a generator is kept."""

    seed: int
    epoch: int = 0  # finished
    step: int = 0
    images_seen: int = 0
    seconds: float = 0.0  # spent training, over all sessions


@dataclass
class TrainingState:
    """All that a training needs to go on."""

    network: nn.Module
    average: AveragedNetwork
    optimiser: torch.optim.Optimizer
    position: Position

    def save(self, folder: Path) -> None:
        """Write the checkpoint in `folder`, whole or not at all."""
        content = {
            "network": self.network.state_dict(),
            "average": self.average.network.state_dict(),
            "average_steps": self.average.steps,
            "optimiser": self.optimiser.state_dict(),
            "position": asdict(self.position),
        }
        packed = io.BytesIO()
        torch.save(content, packed)
        atomic_write(folder / FILE, packed.getvalue())

    def load(self, folder: Path) -> None:
        """Go on from the checkpoint of `folder`. Raises `CheckpointError` for none, another cfg's, another seed's."""
        path = folder / FILE
        if not path.is_file():
            raise CheckpointError(f"{path} is missing, so there is nothing to go on from: leave --resume out")
        content = torch.load(path, map_location="cpu", weights_only=True)
        position, seed = Position(**content["position"]), self.position.seed
        if position.seed != seed:
            raise CheckpointError(f"{path} is of a training with seed {position.seed}, not {seed}: give that --seed")
        try:
            self.network.load_state_dict(content["network"])
            self.average.network.load_state_dict(content["average"])
        except RuntimeError as error:
            raise CheckpointError(f"{path} is of another network than the cfg: {str(error).splitlines()[0]}") from None
        self.average.steps = content["average_steps"]
        self.optimiser.load_state_dict(content["optimiser"])
        self.position = position
