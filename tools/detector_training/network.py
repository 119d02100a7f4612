"""A Darknet cfg as a PyTorch module, so that one file describes what is trained and what OpenCV runs; its weights."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import nn

from course_lib.files import atomic_write
from course_lib.spherical_stereo.detection import darknet
from course_lib.spherical_stereo.detection.darknet import DetectorError, Section

BATCH_NORM_EPSILON = 1e-6  # as Darknet and OpenCV: PyTorch's own 1e-5 moves the outputs by 2e-3
BATCH_NORM_MOMENTUM = 0.03  # share that a step gives to the running statistics; trainings are a few thousand steps
LEAKY_SLOPE = 0.1
PRIOR_OBJECTNESS = 0.01  # of an untrained box: else the first hundred steps learn that most boxes are background
MAX_LOG_SCALE = 4.0  # more is no furniture, only overflow at the start of a training
WEIGHTS_VERSION = (0, 2, 5)


@dataclass(frozen=True)
class YoloHead:
    """What one `[yolo]` section says about its boxes."""

    anchors: torch.Tensor  # (a, 2) width and height, pixels of the network input
    classes: int
    scale_xy: float  # stretch of the sigmoid of a box centre: 2 lets it reach half a cell over either border
    iou_threshold: float  # of the shapes of an anchor and an object that it answers for
    ignore_threshold: float  # a box that overlaps an object by more is not background


class TrainableNetwork(nn.Module):
    """The layers of a cfg in order; `DetectorError` for a section or an option that the training cannot build."""

    def __init__(self, sections: list[Section], generator: torch.Generator | None = None):
        super().__init__()
        generator = generator or torch.Generator().manual_seed(0)
        self.sections = sections
        self.heads: list[YoloHead] = []
        layers: list[nn.Module] = []
        for section, (incoming, _) in zip(sections[1:], darknet.layer_channels(sections), strict=True):
            layers.append(_build(section, incoming, generator))
            if section.kind == "yolo":
                self.heads.append(yolo_head(section))
        if not self.heads:
            raise DetectorError("the cfg has no [yolo] section, so there is nothing to train")
        self.layers = nn.ModuleList(layers)
        detections = [index for index, section in enumerate(sections[1:]) if section.kind == "yolo"]
        for index, head in zip(detections, self.heads, strict=True):
            _start_from_prior(layers[index - 1][0], head, generator)
        # Only the layers that some [route] reads are kept in memory.
        routes = [(index, section) for index, section in enumerate(sections[1:]) if section.kind == "route"]
        self._needed = {source for index, section in routes for source in _sources(section, index)}

    def forward(self, images: torch.Tensor) -> list[torch.Tensor]:
        """Raw maps (b, anchors, 5 + classes, rows, columns), a `[yolo]` each, of images (b, 3, h, w), RGB in [0, 1]."""
        kept: dict[int, torch.Tensor] = {}
        outputs = []
        value = images
        for index, (section, layer) in enumerate(zip(self.sections[1:], self.layers, strict=True)):
            if section.kind == "route":
                sources = [kept[source] for source in _sources(section, index)]
                value = sources[0] if len(sources) == 1 else torch.cat(sources, dim=1)
                value = value.chunk(section.integer("groups", 1), dim=1)[section.integer("group_id", 0)]
            elif section.kind == "yolo":
                b, channels, rows, columns = value.shape
                n_anchors = len(self.heads[len(outputs)].anchors)
                outputs.append(value.view(b, n_anchors, channels // n_anchors, rows, columns))
            else:
                value = layer(value)
            if index in self._needed:
                kept[index] = value
        return outputs


def yolo_head(section: Section) -> YoloHead:
    """The anchors and thresholds of a `[yolo]` section; raises `DetectorError` for anchors that do not fit its mask."""
    numbers = section.integers("anchors")
    mask = section.integers("mask")
    if len(numbers) % 2 or not all(0 <= index < len(numbers) // 2 for index in mask):
        raise DetectorError(
            f"[yolo] at line {section.line}: mask={mask} does not choose from {len(numbers) / 2:g} anchors (pairs)"
        )
    anchors = torch.tensor(numbers, dtype=torch.float32).view(-1, 2)[mask]
    return YoloHead(
        anchors=anchors,
        classes=section.integer("classes"),
        scale_xy=float(section.options.get("scale_x_y", 1.0)),
        iou_threshold=float(section.options.get("iou_thresh", 0.213)),
        ignore_threshold=float(section.options.get("ignore_thresh", 0.7)),
    )


def decode_boxes(raw: torch.Tensor, head: YoloHead, stride: float) -> torch.Tensor:
    """Boxes (b, a, rows, columns, 4) as u, v of the centre, width, height, in pixels, of a raw map.

    u = stride (column + s sigma(t_u) - (s - 1) / 2), v likewise; width = anchor exp(t_w), height likewise, where s is
    scale_x_y. `raw` is (b, a, 5 + classes, rows, columns). Source: paper 2, section 2.2 (its detector is YOLOv4).
    """
    rows, columns = raw.shape[-2:]
    t = raw[:, :, :4].float()
    shift = (head.scale_xy - 1.0) / 2.0
    column, row = torch.arange(columns), torch.arange(rows)[:, None]
    anchors = head.anchors.view(1, -1, 2, 1, 1)
    u = stride * (column + head.scale_xy * torch.sigmoid(t[:, :, 0]) - shift)
    v = stride * (row + head.scale_xy * torch.sigmoid(t[:, :, 1]) - shift)
    size = anchors * torch.exp(t[:, :, 2:4].clamp(max=MAX_LOG_SCALE))
    return torch.stack([u, v, size[:, :, 0], size[:, :, 1]], dim=-1)


def _build(section: Section, incoming: int, generator: torch.Generator) -> nn.Module:
    if section.kind == "convolutional":
        return _convolution(section, incoming, generator)
    if section.kind == "maxpool":
        size, stride = section.integer("size", section.integer("stride", 1)), section.integer("stride", 1)
        if stride == 1 and size % 2 == 0:
            raise DetectorError(f"[maxpool] at line {section.line}: size={size} with stride=1 needs an odd size")
        return nn.MaxPool2d(size, stride, padding=(size - 1) // 2)
    if section.kind == "upsample":
        return nn.Upsample(scale_factor=section.integer("stride", 2), mode="nearest")
    if section.kind in ("route", "yolo"):  # `forward` does what they say
        return nn.Identity()
    raise DetectorError(f"the training cannot build [{section.kind}] (line {section.line})")


def _start_from_prior(convolution: nn.Conv2d, head: YoloHead, generator: torch.Generator) -> None:
    """Let the untrained network expect hardly any object, and every class as much as the others."""
    nn.init.normal_(convolution.weight, std=0.01, generator=generator)
    bias = convolution.bias.data.view(len(head.anchors), 5 + head.classes)
    bias.zero_()
    bias[:, 4] = float(torch.logit(torch.tensor(PRIOR_OBJECTNESS)))
    bias[:, 5:] = float(torch.logit(torch.tensor(1.0 / head.classes)))


def _convolution(section: Section, incoming: int, generator: torch.Generator) -> nn.Sequential:
    normalized = bool(section.integer("batch_normalize", 0))
    size, filters = section.integer("size", 1), section.integer("filters")
    padding = size // 2 if section.integer("pad", 0) else section.integer("padding", 0)
    parts: list[nn.Module] = [
        nn.Conv2d(incoming, filters, size, section.integer("stride", 1), padding, bias=not normalized)
    ]
    nn.init.kaiming_normal_(parts[0].weight, a=LEAKY_SLOPE, generator=generator)
    if normalized:
        parts.append(nn.BatchNorm2d(filters, eps=BATCH_NORM_EPSILON, momentum=BATCH_NORM_MOMENTUM))
    activation = section.options.get("activation", "linear")
    if activation == "leaky":
        parts.append(nn.LeakyReLU(LEAKY_SLOPE, inplace=True))
    elif activation != "linear":
        raise DetectorError(f"line {section.line}: activation={activation} is not known; use leaky or linear")
    return nn.Sequential(*parts)


def _sources(section: Section, index: int) -> list[int]:
    return [source if source >= 0 else index + source for source in section.integers("layers")]


def write_weights(network: TrainableNetwork, path: str | Path, images_seen: int = 0) -> Path:
    """Write the network's weights as a Darknet file that OpenCV reads; return its path.

    The file: major, minor, revision (int32) = 0, 2, 5; images seen (int64); then for each convolution, in order, as
    float32: with batch normalization beta, gamma, running mean, running variance, without it the bias; then the kernel.
    """
    path = Path(path)
    tensors = [tensor.detach().numpy().astype("<f4") for tensor in _tensors_in_file_order(network)]
    parts = [np.array(WEIGHTS_VERSION, "<i4"), np.array([images_seen], "<i8"), *tensors]
    atomic_write(path, b"".join(part.tobytes() for part in parts))
    return path


@torch.no_grad()
def read_weights(network: TrainableNetwork, path: str | Path) -> int:
    """Put the weights of a Darknet file into the network; return the images it has seen. Raises `DetectorError`."""
    darknet.check_weights(network.sections, path)
    data = Path(path).read_bytes()
    start = darknet.header_bytes(data[:12])
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
