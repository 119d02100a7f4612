"""Checkpoints of a training, so that one that was stopped goes on: network, average, optimiser, and where it was."""

from __future__ import annotations

import io
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from torch import nn

from course_lib.files import atomic_write
from tools.detector_training.schedule import AveragedNetwork

FILE = "checkpoint.pt"


class CheckpointError(ValueError):
    """A checkpoint that is missing or belongs to another training."""


@dataclass
class Position:
    """Where a training is. Samples are drawn from (seed, epoch, place), so no state of a generator is kept."""

    seed: int
    epoch: int = 0
    """Epochs finished."""
    step: int = 0
    images_seen: int = 0
    seconds: float = 0.0
    """Time spent training, over all sessions."""


def save_checkpoint(
    folder: Path, network: nn.Module, average: AveragedNetwork, optimiser: torch.optim.Optimizer, position: Position
) -> Path:
    """Writes `checkpoint.pt` in `folder`, whole or not at all; returns its path."""
    path = folder / FILE
    content = {
        "network": network.state_dict(),
        "average": average.network.state_dict(),
        "average_steps": average.steps,
        "optimiser": optimiser.state_dict(),
        "position": asdict(position),
    }
    packed = io.BytesIO()
    torch.save(content, packed)
    atomic_write(path, packed.getvalue())
    return path


def load_checkpoint(
    folder: Path, network: nn.Module, average: AveragedNetwork, optimiser: torch.optim.Optimizer, seed: int
) -> Position:
    """Puts the checkpoint of `folder` into network, average and optimiser; returns where the training was.

    Raises `CheckpointError`: there is none, it is of another cfg, or of a training with another seed.
    """
    path = folder / FILE
    if not path.is_file():
        raise CheckpointError(f"{path} is missing, so there is nothing to go on from: leave --resume out")
    content = torch.load(path, map_location="cpu", weights_only=True)
    position = Position(**content["position"])
    if position.seed != seed:
        raise CheckpointError(f"{path} is of a training with seed {position.seed}, not {seed}: give that --seed")
    try:
        network.load_state_dict(content["network"])
        average.network.load_state_dict(content["average"])
    except RuntimeError as error:
        raise CheckpointError(f"{path} is of another network than the cfg: {str(error).splitlines()[0]}") from None
    average.steps = content["average_steps"]
    optimiser.load_state_dict(content["optimiser"])
    return position
