"""Train the room detector on folders of panoramas with boxes, and choose its threshold on validation rooms.

It needs PyTorch, which the course does not install: nothing else uses it. Folders come from make-data training-rooms.
"""

import argparse
import importlib.util
import json
import sys
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path

from course_lib.files import atomic_write

DATA = Path(__file__).parents[1] / "data" / "detector"
RECORDED_WIDTH = 1280  # columns of a panorama: the finished detector sees them so, not scaled as the training does


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `train_detector`."""
    add = parser.add_argument
    folder, number = {"required": True, "type": Path, "metavar": "FOLDER"}, {"type": int, "metavar": "N"}
    add("--images", **folder, nargs="+", help="panoramas to train on, with boxes.json (no default)")
    what = "panoramas of other rooms, which choose the threshold (no default)"
    add("--validation", **folder, nargs="+", help=what)
    add("--out", **folder, help="checkpoints, weights and results go here (no default)")
    add("--minutes", type=float, metavar="M", help="training time (default: 60, unless --epochs)")
    add("--epochs", **number, help="stop after N epochs, if the time has not run out")
    add("--batch", **number, default=8, help="images a step (default: 8)")
    add("--seed", **number, default=0, help="seed of the random numbers (default: 0)")
    what = "go on from the checkpoint in --out (default: start anew, or from --weights)"
    add("--resume", action="store_true", help=what)
    add("--weights", type=Path, metavar="FILE", help="start from these Darknet weights (default: random)")
    add("--learning-rate", type=float, default=1.5e-3, metavar="R", help="the largest (default: 0.0015)")
    for option, what in (("cfg", "the network"), ("names", "its classes")):
        path = DATA / f"room_yolo.{option}"
        what += f" (default: data/detector/{path.name})"
        add(f"--{option}", type=Path, default=path, metavar="FILE", help=what)
    add("--processes", **number, default=1, help="with one thread each (default: 1, with all threads)")
    add("--threads", **number, help="processor threads (default: PyTorch's choice)")


def run(arguments: argparse.Namespace) -> int:
    """Train, write the weights, and measure the finished detector on the validation images; 0 when all was done."""
    from courseware.commands.arguments import require_output_folder, require_seed

    require_seed(arguments.seed)
    require_output_folder(arguments.out)
    _require_positive(arguments)
    if importlib.util.find_spec("torch") is None:
        raise ValueError(f"no PyTorch here; install it for {sys.executable}: pip install 'torch>=2.6'")
    import torch

    from course_lib.spherical_stereo.detection.darknet import read_names
    from tools.detector_evaluation import measure_detector
    from tools.detector_training.images import read_panoramas
    from tools.detector_training.train import TrainingPlan, train

    if arguments.threads:
        torch.set_num_threads(arguments.threads)
    given = {name: getattr(arguments, name) for name in ("epochs", "learning_rate", "seed", "processes")}
    minutes = 60.0 if arguments.minutes is None and arguments.epochs is None else arguments.minutes
    plan = TrainingPlan(minutes=minutes, batch_size=arguments.batch, **given)
    folders = arguments.images, arguments.validation, arguments.out
    how = {"resume": arguments.resume, "initial_weights": arguments.weights, "log": _log, "progress": _bar}
    result = train(arguments.cfg, arguments.names, *folders, plan, **how)
    for path in (arguments.cfg, arguments.names):
        if path.resolve().parent != arguments.out.resolve():
            atomic_write(arguments.out / path.name, path.read_bytes())
    cfg, names = arguments.out / arguments.cfg.name, arguments.out / arguments.names.name
    panoramas = read_panoramas(arguments.validation, read_names(names), RECORDED_WIDTH)
    validation = measure_detector(cfg, result.weights, names, panoramas)
    text = json.dumps(report(plan, result, validation, arguments.weights), indent=1)
    atomic_write(arguments.out / "training.json", text + "\n")
    print(text)
    print(f"Written to {arguments.out}: {result.weights.name}, {cfg.name}, {names.name}, training.json")
    return 0


def report(plan, result, validation, initial_weights: Path | None) -> dict:
    """What training.json holds: the numbers, the seed, the versions, and of which weights the training began."""
    import torch

    from courseware.experiments.results import versions

    return {
        "version": 1,
        "score_threshold": round(validation.threshold, 3),
        "validation": asdict(validation),
        "plan": asdict(plan),
        "started_from_sha256": sha256(initial_weights.read_bytes()).hexdigest() if initial_weights else None,
        "position": asdict(result.position),
        "images_per_second": round(result.images_per_second, 2),
        "versions": versions() | {"torch": torch.__version__},
    }


def _require_positive(arguments: argparse.Namespace) -> None:
    for name in ("minutes", "epochs", "batch", "learning_rate", "threads", "processes"):
        value = getattr(arguments, name)
        if value is not None and not value > 0:
            raise ValueError(f"--{name.replace('_', '-')} must be above 0; got {value}")


def _log(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _bar(batches, count: int):
    from tqdm import tqdm

    # On a terminal a bar that goes away after its epoch; in a log the lines between epochs say enough.
    return tqdm(batches, total=count, desc="training", unit="batch", file=sys.stderr, leave=False, disable=None)


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.train_detector"))
