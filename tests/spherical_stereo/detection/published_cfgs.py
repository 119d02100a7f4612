"""YOLOv4 and YOLOv4-tiny as cfg texts, written from their architecture; only what decides the number of weights.

CSPDarknet53 with SPP and PANet (Bochkovskiy, Wang, Liao 2020), and its small version.
"""


def net(size: int) -> str:
    return f"[net]\nwidth={size}\nheight={size}\nchannels=3\n"


def conv(filters: int, size: int, stride: int = 1, activation: str = "mish") -> str:
    return (
        f"[convolutional]\nbatch_normalize=1\nfilters={filters}\nsize={size}\nstride={stride}\npad=1\n"
        f"activation={activation}\n"
    )


def route(*layers: int, groups: int = 0) -> str:
    half = f"groups={groups}\ngroup_id=1\n" if groups else ""
    return f"[route]\nlayers={','.join(map(str, layers))}\n{half}"


def maxpool(size: int, stride: int) -> str:
    return f"[maxpool]\nsize={size}\nstride={stride}\n"


def head(classes: int, n_anchors: int, mask: str) -> str:
    anchors = ",".join(["10,14"] * n_anchors)
    return (
        f"[convolutional]\nfilters={3 * (5 + classes)}\nsize=1\nstride=1\npad=1\nactivation=linear\n"
        f"[yolo]\nmask={mask}\nanchors={anchors}\nclasses={classes}\nnum={n_anchors}\n"
    )


SHORTCUT, UPSAMPLE = "[shortcut]\nfrom=-3\nactivation=linear\n", "[upsample]\nstride=2\n"


def stage(filters: int, blocks: int) -> list[str]:
    """A cross-stage partial stage of CSPDarknet53; the first one keeps its width."""
    first = filters == 64
    half = filters if first else filters // 2
    block = [conv(32 if first else half, 1), conv(half, 3), SHORTCUT]
    parts = [conv(filters, 3, 2), conv(half, 1), route(-2), conv(half, 1), *(block * blocks), conv(half, 1)]
    return [*parts, route(-1, -(3 * blocks + 4)), conv(filters, 1)]


def squeeze(filters: int, times: int) -> list[str]:
    """Alternating 1 x 1 and 3 x 3 convolutions, ending narrow."""
    pair = [conv(filters, 1, activation="leaky"), conv(2 * filters, 3, activation="leaky")]
    return (pair * times)[: 2 * times - 1]


def leaky(filters: int, size: int, stride: int = 1) -> str:
    return conv(filters, size, stride, "leaky")


def yolov4(classes: int = 80) -> str:
    backbone = [conv(32, 3), *stage(64, 1), *stage(128, 2), *stage(256, 8), *stage(512, 8), *stage(1024, 4)]
    pyramid = [maxpool(5, 1), route(-2), maxpool(9, 1), route(-4), maxpool(13, 1), route(-1, -3, -5, -6)]
    parts = [*backbone, *squeeze(512, 2), *pyramid, *squeeze(512, 2)]
    for filters, source in ((256, 85), (128, 54)):
        parts += [leaky(filters, 1), UPSAMPLE, route(source), leaky(filters, 1), route(-1, -3), *squeeze(filters, 3)]
    parts += [leaky(256, 3), head(classes, 9, "0,1,2")]
    for filters, back, mask in ((256, -16, "3,4,5"), (512, -37, "6,7,8")):
        parts += [route(-4), leaky(filters, 3, 2), route(-1, back), *squeeze(filters, 3)]
        parts += [leaky(2 * filters, 3), head(classes, 9, mask)]
    return "\n".join([net(608), *parts])


def yolov4_tiny(classes: int = 80, size: int = 416) -> str:
    parts = [leaky(32, 3, 2), leaky(64, 3, 2)]
    for filters in (64, 128, 256):
        half = filters // 2
        parts += [leaky(filters, 3), route(-1, groups=2), leaky(half, 3), leaky(half, 3), route(-1, -2)]
        parts += [leaky(filters, 1), route(-6, -1), maxpool(2, 2)]
    parts += [leaky(512, 3), leaky(256, 1), leaky(512, 3), head(classes, 6, "3,4,5")]
    parts += [route(-4), leaky(128, 1), UPSAMPLE, route(-1, 23), leaky(256, 3), head(classes, 6, "1,2,3")]
    return "\n".join([net(size), *parts])
