"""Classes of rclpy with types in brackets, as annotations have them."""

import typing

import rclpy
from probe import show, typed
from rclpy.action import ActionClient, ActionServer
from rclpy.action.client import ClientGoalHandle
from rclpy.action.server import ServerGoalHandle
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.lifecycle import LifecyclePublisher
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.task import Future, Task
from rclpy.timer import Timer
from rclpy.waitable import Waitable

for c, k in (
    (Client, 1),
    (Client, 2),
    (Service, 1),
    (Service, 2),
    (Future, 1),
    (Task, 1),
    (ActionClient, 1),
    (ActionClient, 3),
    (ActionServer, 1),
    (ActionServer, 3),
    (ServerGoalHandle, 1),
    (ServerGoalHandle, 3),
    (ClientGoalHandle, 1),
    (ClientGoalHandle, 3),
    (Parameter, 1),
    (Publisher, 1),
    (Subscription, 1),
    (Timer, 1),
    (LifecyclePublisher, 1),
    (Waitable, 1),
):
    typed(f"{c.__name__}[{k}]", lambda: bool(c[int if k == 1 else (int,) * k]))


def f(a: "Future[int]") -> "typing.Optional[Client]": ...


show("get_type_hints", lambda: len(typing.get_type_hints(f)))
show(
    "isinstance",
    lambda: (
        isinstance(rclpy.qos.qos_profile_sensor_data, rclpy.qos.QoSProfile),
        issubclass(rclpy.executors.SingleThreadedExecutor, Executor),
    ),
)
