"""The servers that a navigation has at its service: planner, controller, costmaps and recoveries, as coroutines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_bt_navigator.decisions import Do, Event, Happened
from robolink.counterparts.nav2_util.calls import ActionCall, Outcome, called
from robolink.duration import Duration
from robolink.interfaces.geometry_msgs.msg import Point, PoseStamped
from robolink.interfaces.nav2_msgs.action import (
    BackUp,
    ComputePathThroughPoses,
    ComputePathToPose,
    FollowPath,
    Spin,
    Wait,
)
from robolink.interfaces.nav2_msgs.srv import ClearEntireCostmap
from robolink.interfaces.nav_msgs.msg import Path
from robolink.node import Node

ACTIONS = {
    "compute_path_to_pose": ComputePathToPose,
    "compute_path_through_poses": ComputePathThroughPoses,
    "follow_path": FollowPath,
    "spin": Spin,
    "wait": Wait,
    "backup": BackUp,
}
CLEARED = {
    Do.CLEAR_GLOBAL: ("global_costmap/clear_entirely_global_costmap",),
    Do.CLEAR_LOCAL: ("local_costmap/clear_entirely_local_costmap",),
    Do.CLEAR_BOTH: (
        "local_costmap/clear_entirely_local_costmap",
        "global_costmap/clear_entirely_global_costmap",
    ),
}
"""Services that clear costmaps."""

ALLOWANCE = Duration(seconds=10).to_msg()
"""Longest time of a spin or of backing up, as in Nav2."""
RECOVERY_GOALS = {
    Do.SPIN: ("spin", Spin.Goal(target_yaw=1.57, time_allowance=ALLOWANCE)),
    Do.WAIT: ("wait", Wait.Goal(time=Duration(seconds=5).to_msg())),
    Do.BACK_UP: ("backup", BackUp.Goal(target=Point(x=0.3), speed=0.15, time_allowance=ALLOWANCE)),
}
"""Actions of the recoveries, and their goals: those of Nav2's default trees."""


class Planned(NamedTuple):
    """A path, or the event that there is none."""

    path: Path | None
    event: Event


class Servers:
    """Clients of all servers that a navigation calls. `patience` is the wait for a server that is not there, in s."""

    def __init__(self, node: Node, patience: float) -> None:
        self._node, self._patience = node, patience
        self._group = ReentrantCallbackGroup()
        self._calls = {name: ActionCall(node, kind, name, self._group) for name, kind in ACTIONS.items()}
        names = sorted({name for services in CLEARED.values() for name in services})
        self._clear = {name: node.create_client(ClearEntireCostmap, name, callback_group=self._group) for name in names}

    def destroy(self) -> None:
        """Withdraw the clients."""
        for call in self._calls.values():
            call.destroy()
        for client in self._clear.values():
            self._node.destroy_client(client)

    async def plan(self, goals: Sequence[PoseStamped], *, through: bool) -> Planned:
        """Plan a path to the last of some poses; with `through`, by way of the others."""
        if through:
            outcome = await self._call("compute_path_through_poses", ComputePathThroughPoses.Goal(goals=list(goals)))
        else:
            outcome = await self._call("compute_path_to_pose", ComputePathToPose.Goal(goal=goals[-1]))
        path: Any = outcome.result.path if outcome.succeeded else None
        return Planned(path, event_of(Do.PLAN, outcome))

    async def follow(self, path: Path) -> Event:
        """Follow a path to its end, in place of the one before."""
        return event_of(Do.FOLLOW, await self._call("follow_path", FollowPath.Goal(path=path)))

    async def recover(self, which: Do) -> Event:
        """Carry out a recovery, or clear a costmap."""
        if which in CLEARED:
            return await self._cleared(which)
        name, goal = RECOVERY_GOALS[which]
        return event_of(which, await self._call(name, goal))

    def stop(self) -> None:
        """Cancel planning and following."""
        for name in ("compute_path_to_pose", "compute_path_through_poses", "follow_path"):
            self._calls[name].cancel()

    def halt(self) -> None:
        """Cancel the recovery that runs."""
        for name in ("spin", "wait", "backup"):
            self._calls[name].cancel()

    async def _call(self, name: str, goal: Any) -> Outcome:
        return await self._calls[name].run(goal, self._patience)

    async def _cleared(self, which: Do) -> Event:
        for name in CLEARED[which]:
            client = self._clear[name]
            if await called(self._node, client, ClearEntireCostmap.Request(), self._patience, self._group) is None:
                return Event(Happened.FAILED, which, words=f"{name} was not answered")
        return Event(Happened.SUCCEEDED, which)


def event_of(of: Do, outcome: Outcome) -> Event:
    """Return how a goal ended as an event; without a server no recovery helps."""
    if outcome.succeeded:
        return Event(Happened.SUCCEEDED, of)
    return Event(Happened.FAILED, of, outcome.code, outcome.words, is_hopeless=outcome.result is None)
