"""Actions that start nodes, and that set what counts for the nodes behind them (`launch_ros.actions`)."""

from __future__ import annotations

from robolink.launch.ros.launch.actions import TimerAction
from robolink.launch.ros.launch_ros.components import ComposableNodeContainer, LoadComposableNodes
from robolink.launch.ros.launch_ros.lifecycle import LifecycleNode, LifecycleTransition
from robolink.launch.ros.launch_ros.node import Node
from robolink.launch.ros.launch_ros.settings import (
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetRosLogDir,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetRosLogDir",
    "SetUseSimTime",
]


class ROSTimer(TimerAction):
    """Actions for later, by the launcher's own time: it has no /clock."""


RosTimer = ROSTimer
