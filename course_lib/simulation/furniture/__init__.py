"""The seven kinds of furniture that a semantic map lists, each in a file of its own."""

from course_lib.simulation.furniture.cabinet import random_cabinet
from course_lib.simulation.furniture.chair import random_chair
from course_lib.simulation.furniture.plant import random_plant
from course_lib.simulation.furniture.refrigerator import random_refrigerator
from course_lib.simulation.furniture.sofa import random_sofa
from course_lib.simulation.furniture.table import random_table
from course_lib.simulation.furniture.television import random_television

RANDOM_PIECES = {
    "sofa": random_sofa,
    "chair": random_chair,
    "table": random_table,
    "television": random_television,
    "potted plant": random_plant,
    "refrigerator": random_refrigerator,
    "cabinet": random_cabinet,
}
