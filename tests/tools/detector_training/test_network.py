"""The network that is trained and the one that OpenCV runs from the written files are the same function."""

import cv2
import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch, which only the training of the detector needs, is not installed")

from course_lib.spherical_stereo.detection.darknet import read_cfg  # noqa: E402
from tests.tools.detector_training.toy_panoramas import ROOM_CFG, TINY_CFG  # noqa: E402
from tools.detector_training.network import TrainableNetwork, decode_boxes, write_weights  # noqa: E402


def decode(raw, head, input_width):
    """All boxes (n, 5 + classes) of a map's first image as OpenCV gives them: class scores include the objectness."""
    boxes = decode_boxes(raw, head, input_width / raw.shape[-1])
    objectness, classes = torch.sigmoid(raw[:, :, 4:]).permute(0, 1, 3, 4, 2).tensor_split([1], dim=-1)
    table = torch.cat([boxes, objectness, objectness * classes], dim=-1)
    return table.permute(0, 2, 3, 1, 4).reshape(-1, table.shape[-1])


def randomized(network, seed=0):
    """Statistics and scales as a trained network has them: with the first ones, batch normalization does nothing."""
    generator = torch.Generator().manual_seed(seed)
    for module in network.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            module.running_mean.normal_(0, 0.2, generator=generator)
            module.running_var.uniform_(0.5, 2.0, generator=generator)
            module.weight.data.uniform_(0.5, 1.5, generator=generator)
            module.bias.data.normal_(0, 0.3, generator=generator)
    return network.eval()


@pytest.mark.parametrize("which", ["room", "tiny"])
def test_pytorch_and_opencv_compute_the_same_boxes_and_scores(which, tmp_path):
    cfg = tmp_path / "net.cfg"
    cfg.write_text(ROOM_CFG.read_text() if which == "room" else TINY_CFG)
    sections = read_cfg(cfg)
    network = randomized(TrainableNetwork(sections))
    weights = write_weights(network, tmp_path / "a.weights")
    shape = (1, 3, sections[0].integer("height"), sections[0].integer("width"))
    images = np.random.default_rng(1).random(shape, dtype=np.float32)
    with torch.no_grad():
        raws = network(torch.from_numpy(images))
    ours = torch.cat([decode(*one, shape[-1]) for one in zip(raws, network.heads, strict=True)]).numpy()
    net = cv2.dnn.readNetFromDarknet(str(cfg), str(weights))
    net.setInput(images)
    theirs = np.concatenate(net.forward(net.getUnconnectedOutLayersNames()))
    theirs[:, :4] *= np.array([shape[-1], shape[-2]] * 2, np.float32)
    assert ours[:, 4].std() > 1e-4, "a network that sees nothing would prove nothing"
    np.testing.assert_allclose(ours, theirs, atol=1e-3)
