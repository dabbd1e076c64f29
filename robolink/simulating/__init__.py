"""Run the system of a launch file in one process and in virtual time: as fast as it goes, and the same each time."""

from robolink.simulating.result import ProgramResult, RobotResult, SimulationResult, failed_by
from robolink.simulating.run import Watching, simulate
from robolink.simulating.settings import with_parameters

__all__ = [
    "ProgramResult",
    "RobotResult",
    "SimulationResult",
    "Watching",
    "failed_by",
    "simulate",
    "with_parameters",
]
