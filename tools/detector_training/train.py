"""The training loop: batches, steps, schedule, checkpoints, validation between epochs, and the Darknet weights.

Every sample has a generator of its own, seeded by (seed, epoch, place in the epoch): a stopped training goes on alike.
"""

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from course_lib.files import temporary_folder
from course_lib.spherical_stereo.detection.darknet import check_names, class_count, read_cfg, read_names
from tools.detector_evaluation import DetectionScoreError, Validation, measure_detector
from tools.detector_training import workers
from tools.detector_training.images import AugmentationRanges, TrainingDataError, augmented_sample, read_panoramas
from tools.detector_training.loss import Loss, Targets, make_targets, yolo_loss
from tools.detector_training.network import TrainableNetwork, read_weights, write_weights
from tools.detector_training.state import AveragedNetwork, Position, TrainingState, learning_rate
from tools.training_images import read_image_list

MAX_GRADIENT = 10.0  # longer ones are shortened: one odd batch must not undo the ones before
BATCHES_AHEAD = 4  # made while the training works: enough to bridge a slow one, little memory


@dataclass(frozen=True)
class TrainingPlan:
    """How long and how fast to train. The defaults were chosen on generated rooms, two cores, bfloat16."""

    epochs: int | None = None  # stop after so many, ...
    minutes: float | None = 60.0  # ... or after so much time; the learning rate falls towards the first of both
    batch_size: int = 8  # images a step, of all processes together
    processes: int = 1  # with one thread each; 1 is one process with all threads of PyTorch
    window: tuple[int, int] = (1024, 416)  # pixels of a sample, multiples of 32: floor and ceiling are mostly cut off
    panorama_width: int = 1024  # in memory; makes 1280 with the appended quarter, the cfg's input
    learning_rate: float = 1.5e-3
    warm_up_steps: int = 200
    weight_decay: float = 0.02
    seed: int = 0
    bfloat16: bool = True  # convolutions only: twice as fast on processors with AMX
    validation_images: int = 60  # of a validation between epochs
    minutes_between_validations: float = 4.0
    minutes_between_checkpoints: float = 1.0


@dataclass(frozen=True)
class TrainingResult:
    """What a training leaves."""

    weights: Path
    position: Position
    validation: Validation | None  # the last between epochs; None when no detection was right yet
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
    """Train the network of `cfg` on folders of panoramas and write `OUTPUT/<cfg name>.weights`.

    Checkpoints are written between epochs; `resume` goes on from the one in `output`, `initial_weights` starts from a
    `.weights` file. `progress(batches, count)` may draw a bar.
    """
    plan = plan or TrainingPlan()
    check_names(class_count(read_cfg(cfg)), read_names(names_file), names_file)
    if len(plan.window) != 2 or any(size < 32 or size % 32 for size in plan.window):  # 32: the largest stride
        raise TrainingDataError(f"the window must be two multiples of 32 pixels (width, height); got {plan.window}")
    if plan.processes < 1 or plan.batch_size < 2 * plan.processes:
        raise TrainingDataError(
            f"batches of {plan.batch_size} for {plan.processes} processes: batch normalization needs at least two "
            "images in each process"
        )
    output.mkdir(parents=True, exist_ok=True)
    given = (cfg, names_file, images, validation_images, output, plan, resume, initial_weights, ranges)
    if plan.processes == 1:
        return _train(*given, log, progress)
    for folder in images:  # what is wrong with a folder is said once, not by every process
        read_image_list(folder)
    with temporary_folder() as folder:
        others = workers.start_others(plan.processes, folder / "meeting", _train, (*given, _silent, _unchanged))
        try:
            workers.join_others(0, plan.processes, folder / "meeting")
            return _train(*given, log, progress)
        finally:
            workers.leave_others()
            for process in others:
                process.join(timeout=10)
                process.terminate()


def _silent(text: str) -> None:
    """The log of all processes but the first."""


def _unchanged(batches: Iterable, count: int) -> Iterable:
    """The progress bar of all processes but the first."""
    return batches


def _train(
    cfg, names_file, images, validation_images, output, plan, resume, initial_weights, ranges, log, progress
) -> TrainingResult:
    """What every process does. Only the first writes and validates."""
    rank, count = workers.rank_and_count()
    names = read_names(names_file)
    training = read_panoramas(images, names, plan.panorama_width, (rank, count))
    validating = read_panoramas(validation_images, names, plan.panorama_width) if rank == 0 else []
    spread = np.linspace(0, len(validating) - 1, min(plan.validation_images, len(validating)))  # the same every time
    validating = [validating[index] for index in np.unique(spread.round().astype(int))]
    network = TrainableNetwork(read_cfg(cfg), torch.Generator().manual_seed(plan.seed))
    if initial_weights is not None:
        read_weights(network, initial_weights)
    network = network.to(memory_format=torch.channels_last).train()
    state = TrainingState(network, AveragedNetwork(network), _optimiser(network, plan), Position(plan.seed))
    if resume:
        state.load(output)
        log(f"going on after epoch {state.position.epoch}, {state.position.seconds / 60:.1f} minutes")
    average, position, path = state.average.network, state.position, output / (Path(cfg).stem + ".weights")
    last_validation, validated_at, saved_at, rate = None, position.seconds, position.seconds, 0.0
    started = time.monotonic() - position.seconds
    while not _finished(plan, position):
        rate, text = _run_epoch(state, started, training, plan, ranges, progress)
        workers.average_statistics(average)
        log(f"epoch {position.epoch}: {position.images_seen} images seen, {position.seconds / 60:.1f} min, {text}")
        over = _finished(plan, position)
        if rank == 0 and (over or position.seconds - saved_at > 60 * plan.minutes_between_checkpoints):
            state.save(output)
            write_weights(average, path, position.images_seen)
            saved_at = position.seconds
        if rank == 0 and (over or position.seconds - validated_at > 60 * plan.minutes_between_validations):
            write_weights(average, path, position.images_seen)
            validated_at = position.seconds
            try:
                last_validation = measure_detector(cfg, path, names_file, validating)
                log(f"validation: {last_validation.line()}")
            except DetectionScoreError as error:
                last_validation = None
                log(f"validation: {error}")
    return TrainingResult(path, position, last_validation, rate)


def _run_epoch(state, started, training, plan, ranges, progress) -> tuple[float, str]:
    """One epoch, or what is left of the time since `started`; images per second, and a line with the mean losses."""
    rank, count = workers.rank_and_count()
    position, size = state.position, plan.batch_size // count
    n_steps = workers.least(max(1, len(training) // size))
    # Each process draws its own samples, as if it trained with a seed of its own.
    seed = plan.seed + 1_000_003 * rank
    batches = epoch_batches(training, size, plan, seed, position.epoch, n_steps, ranges)
    losses, begun = [], time.monotonic()
    for images, targets in progress(batches, n_steps):
        position.seconds = workers.agree(time.monotonic() - started)
        if plan.minutes is not None and position.seconds >= 60 * plan.minutes:
            break
        share = _share_done(plan, position, n_steps)
        for group in state.optimiser.param_groups:
            group["lr"] = learning_rate(plan.learning_rate, position.step, plan.warm_up_steps, share)
        loss = _training_step(state, images, targets, plan.bfloat16)
        state.average.update(state.network)
        losses.append((loss.total.item(), loss.box, loss.objectness, loss.classes))
        position.step += 1
        position.images_seen += len(images) * count
    position.epoch += 1
    if not losses:
        return 0.0, "out of time"
    total, box, objectness, classes = (sum(column) / len(losses) for column in zip(*losses, strict=True))
    rate = len(losses) * size * count / max(1e-9, time.monotonic() - begun)
    text = f"{len(training)} images here, {rate:.1f} images/s, "
    return rate, text + f"loss {total:.3f} (box {box:.3f}, objectness {objectness:.3f}, class {classes:.3f})"


def epoch_batches(
    panoramas: list, size: int, plan: TrainingPlan, seed: int, epoch: int, n_batches: int, ranges
) -> Iterator[tuple[torch.Tensor, Targets]]:
    """The first batches of one epoch, made in a thread beside the training: images (b, 3, h, w), and their objects.

    Images are RGB in [0, 1], channels last in memory. What is left over of the panoramas is left out.
    """
    order = np.random.default_rng([seed, epoch]).permutation(len(panoramas))

    def batch(number: int) -> tuple[torch.Tensor, Targets]:
        samples = [
            augmented_sample(panoramas[int(order[k])], plan.window, np.random.default_rng([seed, epoch, k]), ranges)
            for k in range(number * size, min((number + 1) * size, len(order)))
        ]
        targets = make_targets([(sample.labels, sample.boxes, sample.ignored) for sample in samples])
        images = torch.from_numpy(np.stack([sample.image for sample in samples])[..., ::-1].copy())
        return images.permute(0, 3, 1, 2).to(torch.float32).div_(255.0), targets

    maker = ThreadPoolExecutor(1)
    waiting = deque(maker.submit(batch, number) for number in range(min(BATCHES_AHEAD, n_batches)))
    try:
        for following in range(BATCHES_AHEAD, BATCHES_AHEAD + n_batches):
            made = waiting.popleft().result()
            if following < n_batches:
                waiting.append(maker.submit(batch, following))
            yield made
    finally:
        maker.shutdown(cancel_futures=True)


def _training_step(state: TrainingState, images: torch.Tensor, targets: Targets, bfloat16: bool) -> Loss:
    """One step of the optimiser on a batch, the gradients averaged with the other processes'; the loss before it."""
    with torch.autocast("cpu", torch.bfloat16, enabled=bfloat16):
        outputs = state.network(images.contiguous(memory_format=torch.channels_last))
    loss = yolo_loss(outputs, state.network.heads, targets, images.shape[-1])
    state.optimiser.zero_grad(set_to_none=True)
    loss.total.backward()
    workers.average_gradients(state.network)
    torch.nn.utils.clip_grad_norm_(state.network.parameters(), MAX_GRADIENT)
    state.optimiser.step()
    return loss


def _finished(plan: TrainingPlan, position: Position) -> bool:
    out_of_time = plan.minutes is not None and position.seconds >= 60 * plan.minutes
    return out_of_time or (plan.epochs is not None and position.epoch >= plan.epochs)


def _share_done(plan: TrainingPlan, position: Position, steps_per_epoch: int) -> float:
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
