"""What the node of a simulated world is made of (`nodes/world.py`): topics, services, pace and diagnostics.

simulation = Simulation(node, description, epoch=0)  # the world, and the topics of its robots
runner = Runner(node, simulation, rtf=1.0)           # makes its steps by the clock
Services(node, simulation, runner)                   # ~/reset, ~/pause, ~/spawn ...
"""

from robolink.sim_node.diagnostics import diagnostics, listed, report
from robolink.sim_node.runner import Runner
from robolink.sim_node.services import Services
from robolink.sim_node.simulation import Simulation

__all__ = ["Runner", "Services", "Simulation", "diagnostics", "listed", "report"]
