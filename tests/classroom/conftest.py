"""Walls about strangers' code: a test that needs them is skipped where there are none, but fails where CI=true."""

import os

import pytest

from courseware.classroom.sandbox import SandboxError, copy_library, require_walls


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    """The library without solutions, on a machine that has walls."""
    try:
        require_walls()
    except SandboxError as error:
        if os.environ.get("CI") == "true":
            pytest.fail(str(error))
        pytest.skip(str(error))
    library = tmp_path_factory.mktemp("library")
    copy_library(library)
    return library
