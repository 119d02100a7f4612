"""The list of faults: each still applies, its tests are there; a test that notices one kills it."""

import pytest

from tools import mutants, random_mutants

FAULTS = mutants.read_faults()


def test_there_are_at_most_eighty_each_with_a_name_of_its_own():
    assert len({one["name"] for one in FAULTS}) == len(FAULTS) <= 80


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault["name"])
def test_a_fault_applies_and_its_tests_are_there(fault):
    path, source = mutants.edited(mutants.ROOT, fault)
    assert source != path.read_text()
    compile(source, path, "exec")
    for test in fault["tests"]:
        path, _, function = test.partition("::")
        assert f"def {function.partition('[')[0]}" in (mutants.ROOT / path).read_text()


@pytest.mark.slow
def test_a_fault_that_a_test_notices_is_killed_and_another_survives(tmp_path):
    (tmp_path / "small.py").write_text("ONE = 1\n")
    (tmp_path / "test_small.py").write_text("import small\ndef test_one(): assert small.ONE > 0\n")
    fault = {"name": "", "file": "small.py", "old": "ONE = 1"}
    for new, outcome in (("ONE = 0", "killed"), ("ONE = 2", "survived"), ("__import__('time').sleep(1e6)", "hung")):
        with mutants.broken(*mutants.edited(tmp_path, fault | {"new": new})):
            assert mutants.tests_say(tmp_path, ["test_small.py"], 3.0 if outcome == "hung" else 600.0) == outcome
    assert (tmp_path / "small.py").read_text() == "ONE = 1\n"
    with pytest.raises(ValueError, match="must stand once"):
        mutants.edited(tmp_path, fault | {"old": "TWO", "new": ""})


def test_one_seed_chooses_the_same_random_faults_and_finds_their_tests():
    first, again = (random_mutants.choose(mutants.ROOT, "beyond/look_alikes", 20, 1) for _ in range(2))
    assert first == again
    tests = {test for path, *_ in first[0] for group in random_mutants.tests_of(mutants.ROOT, path) for test in group}
    assert any("tests/beyond/" in test.as_posix() for test in tests)
