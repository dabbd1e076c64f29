"""A ROS 2 package for Webots, for tests: a world, a plugin of the driver, a URDF, a node and a launch file."""

from __future__ import annotations

from pathlib import Path

WHEEL = """HingeJoint {
      jointParameters HingeJointParameters { axis 0 1 0 }
      device [ RotationalMotor { name "%(side)s motor" maxVelocity 20 } PositionSensor { name "%(side)s encoder" } ]
      endPoint Solid { translation 0 %(y)s -0.02 rotation 1 0 0 1.5707963
        children [ Shape { geometry Cylinder { radius 0.03 height 0.01 } } ] }
    }"""
ROBOT = """Robot {
  name "%(name)s"
  translation 0 %(at)s 0.05
  children [
    Shape { geometry Box { size 0.1 0.08 0.05 } }
    %(wheels)s
    DistanceSensor { name "eye left" translation 0.05 0.03 0 rotation 0 0 1 0.5 lookupTable [ 0 0 0, 0.3 0.3 0 ] }
    DistanceSensor { name "eye right" translation 0.05 -0.03 0 rotation 0 0 1 -0.5 lookupTable [ 0 0 0, 0.3 0.3 0 ] }
    Lidar { name "LDS" fieldOfView 3.14 horizontalResolution 31 maxRange 5 minRange 0.1 }
    Camera { name "front" width 32 height 24 }
    Gyro { } Accelerometer { } InertialUnit { }
  ]
}
"""
ARENA = """#VRML_SIM R2023b utf8
WorldInfo { title "pen" basicTimeStep 20 }
RectangleArena { floorSize 2 2 wallHeight 0.2 }
"""
PLUGIN = """
import rclpy
from geometry_msgs.msg import Twist


class Cart:
    def init(self, webots_node, properties):
        robot = webots_node.robot
        self.reach = float(properties.get("halfAxle", "0.05"))
        self.motors = [robot.getDevice("left motor"), robot.getDevice("right motor")]
        for motor in self.motors:
            motor.setPosition(float("inf"))
            motor.setVelocity(0.0)
        self.twist = Twist()
        rclpy.init(args=None)
        self.node = rclpy.create_node("cart_plugin")
        self.node.create_subscription(Twist, "cmd_vel", self.on_twist, 1)

    def on_twist(self, twist):
        self.twist = twist

    def step(self):
        rclpy.spin_once(self.node, timeout_sec=0)
        turn = self.twist.angular.z * self.reach
        for motor, speed in zip(self.motors, [self.twist.linear.x - turn, self.twist.linear.x + turn]):
            motor.setVelocity(speed / 0.03)
"""
AVOIDER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Range


class Avoider(Node):
    def __init__(self):
        super().__init__("avoider")
        self.left = 1.0
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Range, "left_eye", self.on_left, 1)
        self.create_subscription(Range, "right_eye", self.on_right, 1)

    def on_left(self, message):
        self.left = message.range

    def on_right(self, message):
        twist = Twist()
        twist.linear.x = 0.1
        if min(self.left, message.range) < 0.25:
            twist.angular.z = -2.0
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Avoider())
"""
EYES = """
    <device reference="eye left" type="DistanceSensor">
      <ros><topicName>/left_eye</topicName><alwaysOn>true</alwaysOn><frameName>left_eye_link</frameName></ros>
    </device>
    <device reference="eye right" type="DistanceSensor">
      <ros><topicName>/right_eye</topicName><alwaysOn>true</alwaysOn></ros>
    </device>"""
CART = '<plugin type="pen.cart.Cart"><halfAxle>0.05</halfAxle></plugin>'
SETUP = """
from setuptools import setup

setup(name="pen", packages=["pen"], entry_points={"console_scripts": ["avoider = pen.avoider:main"]})
"""
LAUNCH = """
import os

import launch
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node
from webots_ros2_driver.wait_for_controller_connection import WaitForControllerConnection
from webots_ros2_driver.webots_controller import WebotsController
from webots_ros2_driver.webots_launcher import WebotsLauncher


def generate_launch_description():
    share = get_package_share_directory("pen")
    webots = WebotsLauncher(world=os.path.join(share, "worlds", "pen.wbt"), ros2_supervisor=True)
    driver = WebotsController(
        robot_name="my cart",
        parameters=[{"robot_description": os.path.join(share, "resource", "cart.urdf")}],
        remappings=[("/my_cart/front/image_color", "/seen")],
        respawn=True,
    )
    avoider = Node(package="pen", executable="avoider")
    return LaunchDescription([
        webots,
        webots._supervisor,
        driver,
        WaitForControllerConnection(target_driver=driver, nodes_to_start=[avoider]),
        launch.actions.RegisterEventHandler(
            event_handler=launch.event_handlers.OnProcessExit(
                target_action=webots, on_exit=[launch.actions.EmitEvent(event=launch.events.Shutdown())]
            )
        ),
    ])
"""


def robot(name: str = "my cart", at: float = 0.0) -> str:
    """Return a Robot node with two wheels and sensors, at a y."""
    wheels = "\n    ".join(WHEEL % {"side": side, "y": y} for side, y in (("left", 0.05), ("right", -0.05)))
    return ROBOT % {"name": name, "at": at, "wheels": wheels}


def urdf(webots: str) -> str:
    """Return a URDF whose tag <webots> has this inside."""
    return f'<?xml version="1.0" ?>\n<robot name="my cart">\n  <webots>{webots}\n  </webots>\n</robot>\n'


def make_webots_package(workspace: Path, *, robots: str = "", webots: str = EYES + CART) -> Path:
    """Make the package `pen` in a workspace; return its launch file.

    Args:
        workspace: Folder of the workspace.
        robots: Robots of the world, '' for one.
        webots: What the robot description's tag <webots> has inside.
    """
    package = workspace / "src" / "pen"
    for name, text in (
        ("package.xml", "<package format='3'><name>pen</name></package>"),
        (
            "setup.py",
            SETUP,
        ),
        ("pen/__init__.py", ""),
        ("pen/cart.py", PLUGIN),
        ("pen/avoider.py", AVOIDER),
        ("resource/cart.urdf", urdf(webots)),
        ("worlds/pen.wbt", ARENA + (robots or robot())),
        ("launch/pen.launch.py", LAUNCH),
    ):
        path = package / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return package / "launch" / "pen.launch.py"
