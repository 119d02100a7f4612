"""The list of faults: each still applies, and its tests are there."""

import pytest

from tools import mutants

FAULTS = mutants.read_faults()


def test_each_has_a_name_of_its_own():
    assert len({one["name"] for one in FAULTS}) == len(FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault["name"])
def test_a_fault_applies_and_its_tests_are_there(fault):
    path, source = mutants.edited(mutants.ROOT, fault)
    assert source != path.read_text()
    compile(source, path, "exec")
    for test in fault["tests"]:
        path, _, function = test.partition("::")
        assert f"def {function.partition('[')[0]}" in (mutants.ROOT / path).read_text()
