"""Simulate a world: its robots obey cmd_vel, and publish where they are and what they sense.

    robolink run world -p world:=lab -p rtf:=2
    robolink service call /world/spawn "{name: bob, x: 2, y: 3}"

The topics of the only robot are in this node's namespace; of several each has its own. Stamps are the time of the
start plus simulated time, or with `publish_clock` simulated time alone; they only grow, also when the world is reset.
"""

from typing import Any

from robolink import Node, Parameter, VirtualTime
from robolink.documents.foreign import warnings_to
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
from robolink.parameters.descriptors import described
from robolink.sim import load_world
from robolink.sim.sensors import Camera
from robolink.workspace import find_world
from robolink.world_node import Runner, Services, Shapes, Simulation, diagnostics, listed, report

WORLD = described("The world file: its name in configs/worlds/, or its path.", read_only=True)
PUBLISH_CLOCK = described(
    "Whether time starts at 0 and is published on /clock, for nodes with use_sim_time.", read_only=True
)
PUBLISH_MAP = described(
    "Whether the frame map is joined to odom; turn it off where a node localizes the robot.", read_only=True
)
SEED = described("The seed of all noise: of sensors and of odometry.", 0, 2**63 - 1, read_only=True)
ALL_IMAGES = described(
    "Whether cameras publish images also while nobody listens, so that bags and traces have them.", read_only=True
)
RTF = described("How many times as fast as real time the world runs; 0 is as fast as it goes.", 0.0, 1000.0)


class SimulatedWorld(Node):
    """The node of a simulated world: reads the world file, and runs, serves and reports the simulation."""

    def __init__(self, **options: Any) -> None:
        super().__init__("world", **options)
        expected = self.declare_parameter("world", "obstacles", WORLD).value
        with warnings_to(self.get_logger().warning):  # what is left out of a world of Webots
            description = load_world(find_world(expected))
        rtf = self.declare_parameter("rtf", description.world.rtf, RTF).value
        seed = self.declare_parameter("seed", description.world.seed, SEED).value
        publish_clock = self.declare_parameter("publish_clock", False, PUBLISH_CLOCK).value
        publish_map = self.declare_parameter("publish_map", True, PUBLISH_MAP).value

        sees = any(isinstance(each, Camera) for robot in description.robots for each in robot.sensors)
        all_images = (
            sees and self.declare_parameter("all_images", False, ALL_IMAGES).value
        )  # else hashes stay as they were

        epoch = 0 if publish_clock else self.get_clock().now().nanoseconds
        self.simulation = Simulation(
            self,
            description,
            epoch,
            publish_clock=publish_clock,
            publish_map=publish_map,
            seed=seed,
            all_images=all_images,
            in_background=rtf > 0.0 and not isinstance(self.context.time, VirtualTime),
        )
        self.runner = Runner(self, self.simulation, rtf)
        Services(self, self.simulation, self.runner)
        if not isinstance(self.context.time, VirtualTime):  # viewers look at real time, and hashes stay as they were
            self.shapes = Shapes(self, self.simulation, self.runner.steady)
        self.diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.create_timer(1.0, self.diagnose, clock=self.runner.steady)
        self.create_timer(2.0, self.report, clock=self.runner.steady)
        self.add_post_set_parameters_callback(self.on_parameters)
        robots = listed(list(self.simulation.world.robots))
        self.get_logger().info(f"world '{description.world.name or expected}' with {robots}")

    def destroy_node(self) -> None:
        """End the thread of the cameras, too."""
        if hasattr(self, "simulation"):  # not if the world could not be read
            self.simulation.close()
        super().destroy_node()

    def on_parameters(self, parameters: list[Parameter[Any]]) -> None:
        """Set the real-time factor."""
        for each in parameters:
            if each.name == "rtf":
                self.runner.set_rate(each.value)

    def diagnose(self) -> None:
        """Publish diagnostics: the real-time factor, contacts, refused commands."""
        self.diagnostics.publish(diagnostics(self.get_name(), self.simulation, self.runner.measured()))

    def report(self) -> None:
        """Log the poses and motions of robots, unless the world is paused, and warn of a second world."""
        if self.get_fully_qualified_node_names().count(self.get_fully_qualified_name()) > 1:
            self.get_logger().warning(
                f"another {self.get_name()} runs in domain {self.context.get_domain_id()}: "
                "both get each command, and both publish; end one with Ctrl-C",
                once=True,
            )
        if self.runner.running:
            for line in report(self.simulation.world):
                self.get_logger().info(line)
