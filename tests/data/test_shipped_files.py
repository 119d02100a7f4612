"""What is shipped: complete, unchanged, small, and with the parameters that stand in the code."""

from pathlib import Path

import pytest

from courseware.simulation.data_folder import checksums, parameter_tables
from courseware.simulation.room import data as room
from courseware.simulation.room import finale_data as finale
from tools import corridor_data as corridor

DATA = Path(__file__).resolve().parents[2] / "data"
DETECTOR = ("room_yolo.cfg", "room_yolo.names", "room_yolo.weights", "scores.json", "training.json", "training_picture")
PRODUCTS = {"corridor": corridor.PRODUCTS, "room": room.PRODUCTS, "finale": finale.PRODUCTS}
PRODUCTS |= {"detector": DETECTOR, "projects": ("rooms_practice.json",)}
PRODUCTS |= {"../courseware/answers": ("rooms_hidden.json",)}
MAX_BYTES = {"corridor": 18e6, "room": 15e6, "finale": 2e6, "detector": 10e6}  # the others 1e6


@pytest.mark.parametrize("name", PRODUCTS)
def test_every_file_is_as_its_checksum_says_and_small(name):
    assert (DATA / name / "SHA256SUMS").read_text() == checksums(DATA / name, PRODUCTS[name])
    made = [DATA / name / product for product in PRODUCTS[name]]
    sizes = [path.stat().st_size for one in made for path in (one, *one.rglob("*")) if path.is_file()]
    assert sum(sizes) < MAX_BYTES.get(name, 1e6)
    assert max(sizes) < 10e6


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("corridor", corridor.corridor_parameters(corridor.CorridorModels())),
        ("room", parameter_tables(room.RoomModels(), "room")),
        ("finale", finale.finale_parameters(finale.FinaleModels())),
    ],
)
def test_the_parameters_are_those_of_the_code(name, parameters):
    assert (DATA / name / "PARAMETERS.md").read_text() == parameters
