"""Project P1, the whole filter from the equations alone: its recordings, its stages, and how it is measured."""
