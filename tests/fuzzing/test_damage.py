"""The damage: the same bytes for the same seed, for every format, whatever is in the file."""

import zlib
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course_lib.fuzzing.bombs import LINKS, make_bombs, put_link, zeros
from course_lib.fuzzing.campaign import FORMATS, damage, plan, put
from course_lib.fuzzing.image_mutators import chunks, png
from course_lib.fuzzing.mutators import BY_TRAIT, BYTES, mutators_for
from course_lib.fuzzing.samples import write_samples

MUTATORS = sorted({one for group in (BYTES, *BY_TRAIT.values()) for one in group}, key=lambda one: one.__name__)


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    folder = tmp_path_factory.mktemp("samples")
    write_samples(folder)
    return folder


def whole(samples, name):
    return (samples / FORMATS[name].file).read_bytes()


def test_the_samples_are_the_same_bytes_every_time(samples, tmp_path):
    write_samples(tmp_path / "again")
    for one in FORMATS.values():
        assert (tmp_path / "again" / one.file).read_bytes() == (samples / one.file).read_bytes(), one.name


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_seed_does_the_same_damage_and_another_seed_another(name, samples):
    first, again, other = (
        [damage(FORMATS[name], whole(samples, name), seed, number) for number in range(40)] for seed in (1, 1, 2)
    )
    assert first == again
    assert first != other
    assert sum(one.content != whole(samples, name) for one in first) > 30


def test_every_kind_of_damage_is_done(samples):
    names = Counter()
    for name, one in FORMATS.items():
        for number in range(150):
            names.update(damage(one, whole(samples, name), 1, number).name.split(", "))
    assert {one.__name__ for one in MUTATORS} <= set(names)
    assert {f"link: {kind}" for kind in LINKS} <= set(names)
    assert sum(one.startswith("bomb: ") for one in names) > 20


@pytest.mark.parametrize("trait", BY_TRAIT)
def test_a_bomb_is_a_small_file_and_the_same_every_time(trait):
    for name, make in make_bombs(trait).items():
        data = make()
        assert 0 < len(data) < 10_000_000, name
        assert data == make_bombs(trait)[name](), name


@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda one: one.__name__)
@given(data=st.binary(max_size=300), seed=st.integers(0, 2**32))
def test_whatever_the_bytes_are_a_mutator_gives_bytes(mutator, data, seed):
    """Two are applied one after the other: the second one gets what is no valid file any more."""
    found = mutator(data, np.random.default_rng(seed))
    assert isinstance(found, bytes)
    assert found == mutator(data, np.random.default_rng(seed))


def test_each_format_has_mutators_of_its_own():
    for one in FORMATS.values():
        assert one.traits <= set(BY_TRAIT), one.name
        assert mutators_for(one.traits), one.name


def test_a_png_taken_apart_and_put_together_is_the_same_file(samples):
    data = whole(samples, "depth-png")
    assert png(chunks(data)) == data


@pytest.mark.parametrize("count", [1, 10**6, 7_654_321])
def test_packed_zeros_unpack_to_zeros(count):
    found = zlib.decompress(zeros(count))
    assert count <= len(found) < count + 10**6
    assert not any(found)


@pytest.mark.parametrize("kind", LINKS)
def test_what_is_no_file_is_put_in_its_place(kind, tmp_path):
    path = tmp_path / "poses.txt"
    put_link(kind, path, b"whole")
    assert (path.is_file() and not path.is_symlink()) is False
    assert path.is_symlink() == (kind not in ("missing", "folder", "fifo"))
    if kind == "link to itself whole":
        assert path.read_bytes() == b"whole"


def test_the_plan_takes_every_format_in_turn_and_slow_ones_seldom():
    planned = list(plan(list(FORMATS), 2_000))
    assert len(planned) == len(set(planned)) == 2_000
    counts = Counter(name for name, _ in planned)
    assert set(counts) == set(FORMATS)
    assert counts["glb"] < counts["ply"] / 2
    assert list(plan(["glb"], 3)) == [("glb", 0), ("glb", 1), ("glb", 2)]


def test_a_damaged_file_is_put_in_place(samples, tmp_path):
    data = whole(samples, "ply")
    for number in range(60):
        done = damage(FORMATS["ply"], data, 3, number)
        if done.content is not None:
            put(done, tmp_path / "room.ply", data)
            assert (tmp_path / "room.ply").read_bytes() == done.content
