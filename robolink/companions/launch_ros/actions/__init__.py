"""Actions about nodes (`launch_ros.actions`)."""

from robolink.companions.launch_ros.actions.containers import ComposableNodeContainer, LoadComposableNodes
from robolink.companions.launch_ros.actions.lifecycle import LifecycleNode, LifecycleTransition
from robolink.companions.launch_ros.actions.node import Node
from robolink.companions.launch_ros.actions.scope import (
    PushROSNamespace,
    PushRosNamespace,
    ROSTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

RosTimer = ROSTimer
SetRosLogDir = SetROSLogDir

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
