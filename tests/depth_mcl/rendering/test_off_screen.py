"""A window off the screen where the disk of the user's cache is full."""

import subprocess
import sys

import pytest

from course_lib.commands.full_disk import why_no_disk

DRAWS_ON_A_FULL_DISK = """
import os, subprocess, sys
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", sys.argv[1]], check=True)
os.environ["XDG_CACHE_HOME"] = os.environ["HOME"] = sys.argv[1]
try:
    with open(sys.argv[1] + "/filled", "wb", buffering=0) as file:
        while file.write(bytes(4096)):
            pass
except OSError as error:
    print(error.strerror)
import numpy as np
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from tests.depth_mcl.shapes import SMALL, room
with DepthRenderer(room(), SMALL, "vtk") as renderer:
    print(np.isfinite(renderer.render(np.zeros(6))).all())
"""


@pytest.mark.skipif(why_no_disk() is not None, reason="no disk of one's own can be mounted here")
def test_opengl_draws_where_the_users_cache_is_on_a_full_disk(tmp_path):
    """Mesa ended the process there (SIGBUS), after minutes of work: at a command's first picture of the map."""
    command = ["unshare", "-rm", sys.executable, "-c", DRAWS_ON_A_FULL_DISK, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout == "No space left on device\nTrue\n", (done.returncode, done.stderr)
