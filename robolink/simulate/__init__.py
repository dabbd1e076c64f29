"""Simulation of a launch file's system in one process and virtual time: as fast as possible, the same each time."""

from robolink.simulate.result import ProgramResult, RobotResult, SimulationResult, failed_by
from robolink.simulate.run import Watching, simulate
from robolink.simulate.settings import with_parameters

__all__ = [
    "ProgramResult",
    "RobotResult",
    "SimulationResult",
    "Watching",
    "failed_by",
    "simulate",
    "with_parameters",
]
