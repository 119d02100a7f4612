"""YOLOv4-tiny as a cfg text, written from its architecture; only what decides the number of weights.

Source: Bochkovskiy, Wang, Liao 2020.
"""


def conv(filters: int, size: int, stride: int = 1) -> str:
    return (
        f"[convolutional]\nbatch_normalize=1\nfilters={filters}\nsize={size}\nstride={stride}\npad=1\n"
        "activation=leaky\n"
    )


def route(*layers: int, half: bool = False) -> str:
    return f"[route]\nlayers={','.join(map(str, layers))}\n" + ("groups=2\ngroup_id=1\n" if half else "")


def head(mask: str) -> str:
    anchors = ",".join(["10,14"] * 6)
    return (
        "[convolutional]\nfilters=255\nsize=1\nstride=1\npad=1\nactivation=linear\n"
        f"[yolo]\nmask={mask}\nanchors={anchors}\nclasses=80\nnum=6\n"
    )


def yolov4_tiny() -> str:
    parts = ["[net]\nwidth=416\nheight=416\nchannels=3\n", conv(32, 3, 2), conv(64, 3, 2)]
    for filters in (64, 128, 256):
        parts += [conv(filters, 3), route(-1, half=True), conv(filters // 2, 3), conv(filters // 2, 3), route(-1, -2)]
        parts += [conv(filters, 1), route(-6, -1), "[maxpool]\nsize=2\nstride=2\n"]
    parts += [conv(512, 3), conv(256, 1), conv(512, 3), head("3,4,5")]
    parts += [route(-4), conv(128, 1), "[upsample]\nstride=2\n", route(-1, 23), conv(256, 3), head("1,2,3")]
    return "\n".join(parts)
