"""Actions of launch descriptions (`launch.actions`)."""

from robolink.companions.launch.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from robolink.companions.launch.actions.declare import DeclareLaunchArgument
from robolink.companions.launch.actions.environment import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from robolink.companions.launch.actions.functions import LogInfo, OpaqueCoroutine, OpaqueFunction
from robolink.companions.launch.actions.group import GroupAction
from robolink.companions.launch.actions.include import IncludeLaunchDescription
from robolink.companions.launch.actions.loops import ForEach, ForLoop
from robolink.companions.launch.actions.processes import ExecuteLocal, ExecuteProcess
from robolink.companions.launch.actions.reactions import (
    EmitEvent,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
)

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
