"""Processes of the plant library as the engine's matrices."""

from looplab.engine.mimo import ProcessMatrix
from looplab.engine.systems import parse_transfer_function
from looplab.plants import load_transfer_matrix


def library(plant_id: str) -> ProcessMatrix:
    return ProcessMatrix(tuple(tuple(e.system() for e in row) for row in load_transfer_matrix(plant_id).entries))


def matrix(rows: list[list[str]]) -> ProcessMatrix:
    return ProcessMatrix(tuple(tuple(parse_transfer_function(text) for text in row) for row in rows))
