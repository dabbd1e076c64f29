"""Parts of the node of a simulated world (`nodes/world.py`): topics, services, pace and diagnostics.

simulation = Simulation(node, description, epoch=0)  # the world, and the topics of its robots
runner = Runner(node, simulation, rtf=1.0)           # makes its steps by the clock
Services(node, simulation, runner)                   # ~/reset, ~/pause, ~/spawn ...
Shapes(node, simulation, runner.steady)              # ~/floor, ~/walls, ~/objects: markers for viewers
"""

from robolink.world_node.runner import Runner, diagnostics, listed, report
from robolink.world_node.services import Services
from robolink.world_node.shapes import Shapes
from robolink.world_node.simulation import Simulation

__all__ = ["Runner", "Services", "Shapes", "Simulation", "diagnostics", "listed", "report"]
