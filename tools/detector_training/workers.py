"""Several processes that train one network together, each on a part of the images with one thread of its own.

After every step the gradients are averaged. All processes must make the same calls in the same order; in a training of
one process these functions return what they were given.
"""

from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import cv2
import torch
import torch.distributed as distributed
import torch.multiprocessing
from torch import nn

# Loading some thousand images on a busy machine takes minutes; a process that is silent for longer is dead.
MAX_SILENCE = timedelta(minutes=10)


def join_others(rank: int, count: int, meeting_file: Path) -> None:
    """Wait for the other processes. `meeting_file` is a file, not there yet, by which they find each other."""
    torch.set_num_threads(1)
    cv2.setNumThreads(1)
    meeting = {"init_method": meeting_file.as_uri(), "rank": rank, "world_size": count, "timeout": MAX_SILENCE}
    distributed.init_process_group("gloo", **meeting)


def leave_others() -> None:
    """Part from the others."""
    if distributed.is_initialized():
        distributed.destroy_process_group()


def start_others(count: int, meeting_file: Path, work: Callable, arguments: tuple) -> list:
    """Start processes 1 .. count - 1, each running work(*arguments) with the others, which end with this process."""
    given = (count, meeting_file, work, arguments)
    return torch.multiprocessing.start_processes(_work, given, count - 1, join=False, daemon=True).processes


def _work(index: int, count: int, meeting_file: Path, work: Callable, arguments: tuple) -> None:
    join_others(index + 1, count, meeting_file)
    work(*arguments)
    leave_others()


def rank_and_count() -> tuple[int, int]:
    """Which process this is, from 0, and how many there are."""
    return (distributed.get_rank(), distributed.get_world_size()) if distributed.is_initialized() else (0, 1)


def agree(value: float) -> float:
    """The value of the first process."""
    values = torch.tensor([value], dtype=torch.float64)
    if distributed.is_initialized():
        distributed.broadcast(values, src=0)
    return float(values[0])


def least(value: int) -> int:
    """The smallest value of any process."""
    values = torch.tensor([value])
    if distributed.is_initialized():
        distributed.all_reduce(values, op=distributed.ReduceOp.MIN)
    return int(values[0])


def average_gradients(network: nn.Module) -> None:
    """Replace the gradients of all parameters by their mean over the processes."""
    _average([parameter.grad for parameter in network.parameters() if parameter.grad is not None])


@torch.no_grad()
def average_statistics(network: nn.Module) -> None:
    """Replace the running means and variances of batch normalization by their mean over the processes."""
    _average([buffer for buffer in network.buffers() if buffer.is_floating_point()])


def _average(tensors: list[torch.Tensor]) -> None:
    if not distributed.is_initialized():
        return
    values = torch.cat([tensor.reshape(-1) for tensor in tensors])
    distributed.all_reduce(values)
    values /= distributed.get_world_size()
    for tensor, part in zip(tensors, values.split([tensor.numel() for tensor in tensors]), strict=True):
        tensor.copy_(part.view_as(tensor))
