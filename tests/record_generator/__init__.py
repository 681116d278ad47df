"""Hammer records whose truth is known, from a model that shares nothing with the crates under test.

    from record_generator import Setup, record, write
    setup = Setup(seed=7, noise=0.01)
    modes, places = record(setup)
    write(setup, modes, places, "some/folder")

Rooms: `beam` (finite element model, accelerance), `hammer` (pulse and exact response), `channel` (low pass, sensor,
noise, overload), `records` (a test and its hits), `files` (test.toml, CSV, UFF, truth.json), `cli` (the command).
"""

from .beam import Panel
from .files import write
from .records import FIVE_PLACES, ONE_PLACE, Setup, record

__all__ = ["FIVE_PLACES", "ONE_PLACE", "Panel", "Setup", "record", "write"]
