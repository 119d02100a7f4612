"""The training loop: steps, schedule, checkpoints, validation between epochs, and the Darknet weights at the end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2
import torch

from course_lib.experiments.detection_scores import DetectionScoreError
from course_lib.files import temporary_folder
from course_lib.spherical_stereo.detection.darknet import check_names, class_count, read_cfg, read_names
from tools.detector_training.augmentation import AugmentationRanges
from tools.detector_training.batches import Batch, epoch_batches
from tools.detector_training.checkpoints import Position, load_checkpoint, save_checkpoint
from tools.detector_training.export import read_weights, write_weights
from tools.detector_training.images import PanoramaFolders, TrainingDataError
from tools.detector_training.loss import Loss, yolo_loss
from tools.detector_training.network import TrainableNetwork
from tools.detector_training.schedule import AveragedNetwork, learning_rate
from tools.detector_training.validation import Validation, every_nth, network_detector, validate
from tools.detector_training.workers import (
    Alone,
    Together,
    average_gradients,
    average_statistics,
    start_others,
)

# Gradients longer than this are shortened: one odd batch must not undo the ones before.
LONGEST_GRADIENT = 10.0


@dataclass(frozen=True)
class TrainingPlan:
    """How long and how fast to train. The defaults were chosen on generated rooms, two cores, bfloat16."""

    epochs: int | None = None
    """Stop after so many epochs, ..."""
    minutes: float | None = 60.0
    """... or after so much training time, whichever comes first; the learning rate falls towards that end."""
    batch_size: int = 8
    """Images a step, of all processes together."""
    processes: int = 1
    """Processes with one thread each; 1 is one process with as many threads as PyTorch has been given."""
    window: tuple[int, int] = (1024, 416)
    """Width and height of a training sample, pixels, multiples of 32. One panorama is 1024 x 512 there: floor and
    ceiling are mostly cut off, which saves a fifth of the time and shifts the horizon."""
    panorama_width: int = 1024
    """Width to which panoramas are scaled in memory; 1024 makes 1280 with the appended quarter, the cfg's input."""
    learning_rate: float = 1.5e-3
    warm_up_steps: int = 200
    weight_decay: float = 0.02
    seed: int = 0
    bfloat16: bool = True
    """Convolutions in bfloat16 (twice as fast on processors with AMX); statistics, loss and weights stay float32."""
    validation_images: int = 60
    """Images of a validation between epochs."""
    minutes_between_validations: float = 4.0
    minutes_between_checkpoints: float = 1.0


@dataclass(frozen=True)
class TrainingResult:
    """What a training leaves."""

    weights: Path
    position: Position
    validation: Validation | None
    """The last validation between epochs; None when no detection was right yet."""
    images_per_second: float


def train(
    cfg: Path,
    names_file: Path,
    images: list[Path],
    validation_images: list[Path],
    output: Path,
    plan: TrainingPlan | None = None,
    resume: bool = False,
    initial_weights: Path | None = None,
    ranges: AugmentationRanges | None = None,
    log: Callable[[str], None] = print,
    progress: Callable[[Iterable, int], Iterable] = lambda batches, count: batches,
) -> TrainingResult:
    """Trains the network of `cfg` on folders of panoramas and writes `OUTPUT/<cfg name>.weights`.

    New images in the folders are taken up at the start of each epoch. Checkpoints are written between epochs; `resume`
    goes on from the one in `output`, `initial_weights` starts from a `.weights` file. `progress(batches, count)` may
    draw a bar. Raises `DetectorError`, `TrainingDataError`, `CheckpointError`.
    """
    plan = plan or TrainingPlan()
    check_names(class_count(read_cfg(cfg)), read_names(names_file))
    check_plan(plan)
    output.mkdir(parents=True, exist_ok=True)
    given = (cfg, names_file, images, validation_images, output, plan, resume, initial_weights, ranges)
    if plan.processes == 1:
        return _train(Alone(), *given, log, progress)
    # Read here first: what is wrong with a folder is said once, not by every process.
    PanoramaFolders(images, read_names(names_file), plan.panorama_width, (0, 10**9))
    with temporary_folder() as folder:
        meeting_file = folder / "meeting"
        others = start_others(plan.processes, meeting_file, _train_beside, given)
        try:
            _one_thread()
            workers = Together(0, plan.processes, meeting_file)
            result = _train(workers, *given, log, progress)
            workers.close()
            return result
        finally:
            for process in others:
                process.join(timeout=10)
                process.terminate()


def training_step(
    network: TrainableNetwork,
    optimiser: torch.optim.Optimizer,
    batch: Batch,
    bfloat16: bool = False,
    workers: Alone | Together | None = None,
) -> Loss:
    """One step of the optimiser on a batch, the gradients averaged with the other processes'; the loss before it."""
    images = batch.images.contiguous(memory_format=torch.channels_last)
    with torch.autocast("cpu", torch.bfloat16, enabled=bfloat16):
        outputs = network(images)
    loss = yolo_loss(outputs, network.heads, batch.targets, images.shape[-1])
    optimiser.zero_grad(set_to_none=True)
    loss.total.backward()
    average_gradients(network, workers or Alone())
    torch.nn.utils.clip_grad_norm_(network.parameters(), LONGEST_GRADIENT)
    optimiser.step()
    return loss


def check_plan(plan: TrainingPlan) -> None:
    """Raises `TrainingDataError` for a window that is not multiples of 32 (the largest stride) or too small a batch."""
    if len(plan.window) != 2 or any(size < 32 or size % 32 for size in plan.window):
        raise TrainingDataError(f"the window must be two multiples of 32 pixels (width, height); got {plan.window}")
    if plan.processes < 1 or plan.batch_size < 2 * plan.processes:
        raise TrainingDataError(
            f"batches of {plan.batch_size} for {plan.processes} processes: batch normalization needs at least two "
            "images in each process"
        )


def _train_beside(rank: int, count: int, meeting_file: Path, *given) -> None:
    """What every process but the first does: the same steps on its own part of the images, and no output."""
    _one_thread()
    workers = Together(rank, count, meeting_file)
    _train(workers, *given, lambda text: None, lambda batches, count: batches)
    workers.close()


def _one_thread() -> None:
    torch.set_num_threads(1)
    cv2.setNumThreads(1)


def _train(
    workers, cfg, names_file, images, validation_images, output, plan, resume, initial_weights, ranges, log, progress
) -> TrainingResult:
    sections, names = read_cfg(cfg), read_names(names_file)
    training = PanoramaFolders(images, names, plan.panorama_width, (workers.rank, workers.count))
    first = workers.rank == 0
    validating = PanoramaFolders(validation_images, names, plan.panorama_width) if first else None
    network = TrainableNetwork(sections, torch.Generator().manual_seed(plan.seed))
    if initial_weights is not None:
        read_weights(network, initial_weights)
    network = network.to(memory_format=torch.channels_last).train()
    average = AveragedNetwork(network)
    optimiser = _optimiser(network, plan)
    position = Position(plan.seed)
    if resume:
        position = load_checkpoint(output, network, average, optimiser, plan.seed)
        log(f"going on after epoch {position.epoch}, {position.seconds / 60:.1f} minutes")
    clock = _Clock(position.seconds)
    path = output / (Path(cfg).stem + ".weights")
    last_validation, validated_at, saved_at, rate = None, position.seconds, position.seconds, 0.0
    while not _finished(plan, position):
        _take_up_new_images(training, log)
        rate, mean = _run_epoch(workers, clock, network, average, optimiser, training, position, plan, ranges, progress)
        average_statistics(average.network, workers)
        log(f"epoch {position.epoch}: {position.images_seen} images seen, {position.seconds / 60:.1f} min, {mean}")
        over = _finished(plan, position)
        if first and (over or position.seconds - saved_at > 60 * plan.minutes_between_checkpoints):
            save_checkpoint(output, network, average, optimiser, position)
            write_weights(average.network, path, position.images_seen)
            saved_at = position.seconds
        if first and (over or position.seconds - validated_at > 60 * plan.minutes_between_validations):
            _take_up_new_images(validating, log)
            last_validation = _validation(average.network, validating, names, plan, log)
            validated_at = position.seconds
    return TrainingResult(path, position, last_validation, rate)


class _Clock:
    """Seconds of training, going on from those of earlier sessions."""

    def __init__(self, seconds: float):
        self.start = time.monotonic() - seconds

    def seconds(self) -> float:
        return time.monotonic() - self.start


def _run_epoch(
    workers, clock, network, average, optimiser, training, position, plan, ranges, progress
) -> tuple[float, str]:
    """One epoch, or what is left of the time; returns images per second, and a line with it and the mean losses."""
    size = plan.batch_size // workers.count
    n_steps = workers.least(max(1, len(training) // size))
    # Each process draws its own samples, as if it trained with a seed of its own.
    seed = plan.seed if workers.rank == 0 else plan.seed + 1_000_003 * workers.rank
    batches = epoch_batches(training, size, plan.window, seed, position.epoch, n_steps, ranges)
    losses, started = [], clock.seconds()
    for batch in progress(batches, n_steps):
        position.seconds = workers.agree(clock.seconds())
        if plan.minutes is not None and position.seconds >= 60 * plan.minutes:
            break
        share = _progress(plan, position, n_steps)
        for group in optimiser.param_groups:
            group["lr"] = learning_rate(plan.learning_rate, position.step, plan.warm_up_steps, share)
        loss = training_step(network, optimiser, batch, plan.bfloat16, workers)
        average.update(network)
        losses.append((loss.total.item(), loss.box, loss.objectness, loss.classes))
        position.step += 1
        position.images_seen += len(batch.images) * workers.count
    position.epoch += 1
    if not losses:
        return 0.0, "out of time"
    total, box, objectness, classes = (sum(column) / len(losses) for column in zip(*losses, strict=True))
    rate = len(losses) * size * workers.count / max(1e-9, clock.seconds() - started)
    text = f"{len(training)} images here, {rate:.1f} images/s, "
    return rate, text + f"loss {total:.3f} (box {box:.3f}, objectness {objectness:.3f}, class {classes:.3f})"


def _finished(plan: TrainingPlan, position: Position) -> bool:
    out_of_time = plan.minutes is not None and position.seconds >= 60 * plan.minutes
    return out_of_time or (plan.epochs is not None and position.epoch >= plan.epochs)


def _progress(plan: TrainingPlan, position: Position, steps_per_epoch: int) -> float:
    """Share of the training that is done, by time or by epochs, whichever is further."""
    by_time = position.seconds / (60 * plan.minutes) if plan.minutes else 0.0
    by_step = position.step / (plan.epochs * steps_per_epoch) if plan.epochs else 0.0
    return max(by_time, by_step)


def _optimiser(network: TrainableNetwork, plan: TrainingPlan) -> torch.optim.Optimizer:
    """AdamW; weight decay only for kernels, since scales and biases are not what over-fits."""
    kernels = [p for p in network.parameters() if p.ndim > 1]
    others = [p for p in network.parameters() if p.ndim == 1]
    groups = [{"params": kernels, "weight_decay": plan.weight_decay}, {"params": others, "weight_decay": 0.0}]
    return torch.optim.AdamW(groups, lr=plan.learning_rate)


def _take_up_new_images(folder: PanoramaFolders, log: Callable[[str], None]) -> None:
    try:
        folder.refresh()
    except TrainingDataError as error:
        # boxes.json may be half-written at this moment, while the images are still being made: the next epoch reads it.
        log(f"no new images this time: {error}")


def _validation(network, validating, names, plan, log) -> Validation | None:
    try:
        result = validate(network_detector(network, names), every_nth(validating, plan.validation_images), names)
    except DetectionScoreError as error:
        log(f"validation: {error}")
        return None
    log(f"validation: {result.line()}")
    return result
