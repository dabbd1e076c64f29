"""Node of the fuzz: diagnostic_updater and parameter events, of messages that are passed on."""

import robolink
from robolink import Node
from robolink.companions.diagnostic_updater import (
    DiagnosedPublisher,
    FrequencyStatusParam,
    TimeStampStatusParam,
    Updater,
)
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.parameter_event_handler import ParameterEventHandler


class Diagnosed(Node):
    """A node that passes on poses with diagnostics, and follows all parameter events."""

    def __init__(self) -> None:
        super().__init__("diagnosed")
        updater = Updater(self)
        updater.setHardwareID("none")
        bounds = FrequencyStatusParam({"min": 1.0, "max": 10.0})
        out = self.create_publisher(PoseStamped, "out", 10)
        self.poses = DiagnosedPublisher(out, updater, bounds, TimeStampStatusParam())
        self.create_subscription(PoseStamped, "pose", self.poses.publish, 10)
        self.events = ParameterEventHandler(self)
        self.declare_parameter("x", 1)
        self.kept = self.events.add_parameter_callback("x", "diagnosed", lambda parameter: None)
        self.all = self.events.add_parameter_event_callback(lambda event: None)


robolink.init()
robolink.spin(Diagnosed())
