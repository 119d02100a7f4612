"""The training loop: steps, schedule, checkpoints, validation between epochs, and the Darknet weights at the end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import torch

from course_lib.detector_training.augmentation import AugmentationRanges
from course_lib.detector_training.batches import Batch, epoch_batches
from course_lib.detector_training.checkpoints import Position, load_checkpoint, save_checkpoint
from course_lib.detector_training.export import read_weights, write_weights
from course_lib.detector_training.images import PanoramaFolder, TrainingDataError
from course_lib.detector_training.loss import Loss, yolo_loss
from course_lib.detector_training.network import DarknetNetwork
from course_lib.detector_training.schedule import AveragedNetwork, learning_rate
from course_lib.detector_training.validation import Validation, every_nth, network_detector, validate
from course_lib.spherical_stereo.darknet import check_names, read_cfg, read_names
from course_lib.spherical_stereo.detection_scores import DetectionScoreError

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
    window: tuple[int, int] = (1024, 416)
    """Width and height of a training sample, pixels, multiples of 32. One panorama is 1024 x 512 there: floor and
    ceiling are mostly cut off, which saves a fifth of the time and shifts the horizon."""
    panorama_width: int = 1024
    """Width to which panoramas are scaled in memory; 1024 makes 1280 with the appended quarter, the cfg's input."""
    learning_rate: float = 2e-3
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
    images: Path,
    validation_images: Path,
    output: Path,
    plan: TrainingPlan | None = None,
    resume: bool = False,
    initial_weights: Path | None = None,
    ranges: AugmentationRanges | None = None,
    log: Callable[[str], None] = print,
    progress: Callable[[Iterable, int], Iterable] = lambda batches, count: batches,
) -> TrainingResult:
    """Trains the network of `cfg` on a folder of panoramas and writes `OUTPUT/<cfg name>.weights`.

    New images in the folder are taken up at the start of each epoch. Checkpoints are written between epochs; `resume`
    goes on from the one in `output`, `initial_weights` starts from a `.weights` file. `progress(batches, count)` may
    draw a bar. Raises `DarknetError`, `TrainingDataError`, `CheckpointError`.
    """
    plan = plan or TrainingPlan()
    sections, names = read_cfg(cfg), read_names(names_file)
    check_names(sections, names)
    check_window(plan.window)
    training = PanoramaFolder(images, names, plan.panorama_width)
    validating = PanoramaFolder(validation_images, names, plan.panorama_width)
    output.mkdir(parents=True, exist_ok=True)
    network = DarknetNetwork(sections, torch.Generator().manual_seed(plan.seed))
    if initial_weights is not None:
        read_weights(network, initial_weights)
    network = network.to(memory_format=torch.channels_last).train()
    average = AveragedNetwork(network)
    optimiser = _optimiser(network, plan)
    position = Position(plan.seed)
    if resume:
        position = load_checkpoint(output, network, average, optimiser, plan.seed)
        log(f"going on after epoch {position.epoch}, {position.seconds / 60:.1f} minutes")
    log(f"{len(training)} training and {len(validating)} validation images, {torch.get_num_threads()} threads")
    path = output / (Path(cfg).stem + ".weights")
    last_validation, validated_at, saved_at, rate = None, position.seconds, position.seconds, 0.0
    while not _finished(plan, position):
        _take_up_new_images(training, log)
        rate, mean = _run_epoch(network, average, optimiser, training, position, plan, ranges, progress)
        line = f"epoch {position.epoch}: {len(training)} images, {position.seconds / 60:.1f} min, {rate:.1f} images/s, "
        log(line + mean)
        over = _finished(plan, position)
        if over or position.seconds - saved_at > 60 * plan.minutes_between_checkpoints:
            save_checkpoint(output, network, average, optimiser, position)
            write_weights(average.network, path, position.images_seen)
            saved_at = position.seconds
        if over or position.seconds - validated_at > 60 * plan.minutes_between_validations:
            _take_up_new_images(validating, log)
            last_validation = _validation(average.network, validating, names, plan, log)
            validated_at = position.seconds
    write_weights(average.network, path, position.images_seen)
    return TrainingResult(path, position, last_validation, rate)


def training_step(
    network: DarknetNetwork, optimiser: torch.optim.Optimizer, batch: Batch, bfloat16: bool = False
) -> Loss:
    """One step of the optimiser on a batch; returns the loss before the step."""
    images = batch.images.contiguous(memory_format=torch.channels_last)
    with torch.autocast("cpu", torch.bfloat16, enabled=bfloat16):
        outputs = network(images)
    loss = yolo_loss(outputs, network.heads, batch.targets, images.shape[-1])
    optimiser.zero_grad(set_to_none=True)
    loss.total.backward()
    torch.nn.utils.clip_grad_norm_(network.parameters(), LONGEST_GRADIENT)
    optimiser.step()
    return loss


def check_window(window: tuple[int, int]) -> None:
    """Raises `TrainingDataError` unless width and height are positive multiples of 32, the network's largest stride."""
    if len(window) != 2 or any(size < 32 or size % 32 for size in window):
        raise TrainingDataError(f"the window must be two multiples of 32 pixels (width, height); got {window}")


def _run_epoch(network, average, optimiser, training, position, plan, ranges, progress) -> tuple[float, str]:
    """One epoch, or what is left of the time; returns images per second and the mean losses as text."""
    batches = epoch_batches(training, plan.batch_size, plan.window, plan.seed, position.epoch, ranges)
    count = max(1, len(training) // plan.batch_size)
    sums, n_images, n_steps, started = [0.0, 0.0, 0.0, 0.0], 0, 0, position.seconds
    clock = time.monotonic()
    for batch in progress(batches, count):
        share = _progress(plan, position, count)
        for group in optimiser.param_groups:
            group["lr"] = learning_rate(plan.learning_rate, position.step, plan.warm_up_steps, share)
        loss = training_step(network, optimiser, batch, plan.bfloat16)
        average.update(network)
        sums = [a + b for a, b in zip(sums, (loss.total.item(), loss.box, loss.objectness, loss.classes), strict=True)]
        n_images += len(batch.images)
        n_steps += 1
        position.step += 1
        position.images_seen += len(batch.images)
        position.seconds = started + time.monotonic() - clock
        if plan.minutes is not None and position.seconds >= 60 * plan.minutes:
            break
    position.epoch += 1
    total, box, objectness, classes = (value / n_steps for value in sums)
    text = f"loss {total:.3f} (box {box:.3f}, objectness {objectness:.3f}, class {classes:.3f})"
    return n_images / max(1e-9, position.seconds - started), text


def _finished(plan: TrainingPlan, position: Position) -> bool:
    out_of_time = plan.minutes is not None and position.seconds >= 60 * plan.minutes
    return out_of_time or (plan.epochs is not None and position.epoch >= plan.epochs)


def _progress(plan: TrainingPlan, position: Position, steps_per_epoch: int) -> float:
    """Share of the training that is done, by time or by epochs, whichever is further."""
    by_time = position.seconds / (60 * plan.minutes) if plan.minutes else 0.0
    by_step = position.step / (plan.epochs * steps_per_epoch) if plan.epochs else 0.0
    return max(by_time, by_step)


def _optimiser(network: DarknetNetwork, plan: TrainingPlan) -> torch.optim.Optimizer:
    """AdamW; weight decay only for kernels, since scales and biases are not what over-fits."""
    kernels = [p for p in network.parameters() if p.ndim > 1]
    others = [p for p in network.parameters() if p.ndim == 1]
    groups = [{"params": kernels, "weight_decay": plan.weight_decay}, {"params": others, "weight_decay": 0.0}]
    return torch.optim.AdamW(groups, lr=plan.learning_rate)


def _take_up_new_images(folder: PanoramaFolder, log: Callable[[str], None]) -> None:
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
