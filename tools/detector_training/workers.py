"""Several processes that train one network together, each on a part of the images with one thread of its own.

After every step the gradients are averaged, so that all processes hold the same weights. On a machine that others use
too this is much faster than one process with many threads, whose threads wait for each other at every layer.
"""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import torch
import torch.distributed
import torch.multiprocessing
from torch import nn

from course_lib.worker_pool import end_with_parent

# Loading some thousand images on a busy machine takes minutes; a process that is silent for longer is dead.
LONGEST_SILENCE = timedelta(minutes=10)


class Alone:
    """The only process of a training."""

    rank, count = 0, 1

    def mean(self, values: torch.Tensor) -> torch.Tensor:
        """The mean of `values` (n,) over the processes."""
        return values

    def agree(self, value: float) -> float:
        """The value of the first process."""
        return value

    def least(self, value: int) -> int:
        """The smallest value of any process."""
        return value


class Together:
    """One of several processes; all of them must make the same calls in the same order."""

    def __init__(self, rank: int, count: int, meeting_file: Path):
        """Waits for the others. `meeting_file` is a file, not there yet, by which they find each other."""
        self.rank, self.count = rank, count
        torch.distributed.init_process_group(
            "gloo", init_method=meeting_file.as_uri(), rank=rank, world_size=count, timeout=LONGEST_SILENCE
        )

    def mean(self, values: torch.Tensor) -> torch.Tensor:
        """The mean of `values` (n,) over the processes."""
        torch.distributed.all_reduce(values)
        return values / self.count

    def agree(self, value: float) -> float:
        """The value of the first process."""
        values = torch.tensor([value], dtype=torch.float64)
        torch.distributed.broadcast(values, src=0)
        return float(values[0])

    def close(self) -> None:
        """Parts from the others."""
        torch.distributed.destroy_process_group()

    def least(self, value: int) -> int:
        """The smallest value of any process."""
        values = torch.tensor([value])
        torch.distributed.all_reduce(values, op=torch.distributed.ReduceOp.MIN)
        return int(values[0])


def average_gradients(network: nn.Module, workers: Alone | Together) -> None:
    """Replaces the gradients of all parameters by their mean over the processes."""
    if workers.count == 1:
        return
    parameters = [p for p in network.parameters() if p.grad is not None]
    mean = workers.mean(torch.cat([p.grad.reshape(-1) for p in parameters]))
    for p, part in zip(parameters, mean.split([p.numel() for p in parameters]), strict=True):
        p.grad.copy_(part.view_as(p))


@torch.no_grad()
def average_statistics(network: nn.Module, workers: Alone | Together) -> None:
    """Replaces the running means and variances of batch normalization by their mean over the processes."""
    if workers.count == 1:
        return
    buffers = [b for b in network.buffers() if b.is_floating_point()]
    mean = workers.mean(torch.cat([b.reshape(-1) for b in buffers]))
    for b, part in zip(buffers, mean.split([b.numel() for b in buffers]), strict=True):
        b.copy_(part.view_as(b))


def _work_beside(work: Callable, *arguments: object) -> None:
    end_with_parent()  # a process without its first one would wait for its part of the gradients
    work(*arguments)


def start_others(count: int, meeting_file: Path, work: Callable, arguments: tuple) -> list:
    """Starts processes 1 .. count - 1, each running work(rank, count, meeting_file, *arguments); returns them."""
    context = torch.multiprocessing.get_context("spawn")
    processes = [
        context.Process(target=_work_beside, args=(work, rank, count, meeting_file, *arguments), daemon=True)
        for rank in range(1, count)
    ]
    for process in processes:
        process.start()
    return processes
