"""Counterpart of nav2_lifecycle_manager: it starts and ends managed nodes in order."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.client import Client
from robolink.counterparts.program import pause, spin_program
from robolink.interfaces.lifecycle_msgs.msg import State, Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetState
from robolink.interfaces.nav2_msgs.srv import ManageLifecycleNodes
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.parameters.descriptors import described

Command = ManageLifecycleNodes.Request

LOOK = 0.1
"""Time between two looks for a service or a node, in seconds."""
STEPS = {
    Transition.TRANSITION_CONFIGURE: ("Configuring", State.PRIMARY_STATE_INACTIVE),
    Transition.TRANSITION_ACTIVATE: ("Activating", State.PRIMARY_STATE_ACTIVE),
    Transition.TRANSITION_DEACTIVATE: ("Deactivating", State.PRIMARY_STATE_INACTIVE),
    Transition.TRANSITION_CLEANUP: ("Cleaning up", State.PRIMARY_STATE_UNCONFIGURED),
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN: ("Shutting down", State.PRIMARY_STATE_FINALIZED),
}
"""Words and final state of each transition."""
UP = (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE)
DOWN = (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP)
COMMANDS = {
    Command.STARTUP: (UP, "Starting managed nodes bringup...", "Managed nodes are active"),
    Command.PAUSE: (DOWN[:1], "Pausing managed nodes...", "Managed nodes have been paused"),
    Command.RESUME: (UP[1:], "Resuming managed nodes...", "Managed nodes are active"),
    Command.RESET: (DOWN, "Resetting managed nodes...", "Managed nodes have been reset"),
    Command.SHUTDOWN: (
        (*DOWN, Transition.TRANSITION_UNCONFIGURED_SHUTDOWN),
        "Shutting down managed nodes...",
        "Managed nodes have been shut down",
    ),
    Command.CONFIGURE: (UP[:1], "Configuring managed nodes...", "Managed nodes are now configured"),
    Command.CLEANUP: (DOWN[1:], "Cleaning up managed nodes...", "Managed nodes have been cleaned up"),
}
"""Transitions of each command, and the lines at its begin and end."""


class LifecycleManager(Node):
    """A node that changes the states of others, on request or by itself. `options` are those of `Node`.

    Bonds are replaced by looks at who is announced: a node that is gone for `bond_timeout` seconds has the others
    reset, and once it is back they are started again.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("lifecycle_manager", **options)
        self.get_logger().info("Creating")
        words = "managed nodes, in the order in which they are started"
        any_list = ParameterDescriptor(description=words, dynamic_typing=True)  # an empty list has no type
        names: Any = self.declare_parameter("node_names", list[str](), any_list).value or []
        self.names: list[str] = [names] if isinstance(names, str) else list(map(str, names))
        autostart = self.declare_parameter("autostart", False, described("start them at once")).value
        words = "seconds after which a node that is gone counts as lost; 0 for never"
        self._timeout = self.declare_parameter("bond_timeout", 4.0, described(words, 0.0, 1e6)).value
        words = "start the nodes again when one that was lost is back"
        self._returns = self.declare_parameter("attempt_respawn_reconnection", True, described(words)).value
        words = "seconds within which a lost node has to be back"
        self._patience = self.declare_parameter("bond_respawn_max_duration", 10.0, described(words, 0.0, 1e6)).value
        self.is_active = self._is_busy = False
        self._seen_ns: dict[str, int] = {}
        self._gone: set[str] = set()
        self._lost_ns: int | None = None
        group = self._group = ReentrantCallbackGroup()
        self._change = {name: self._client(ChangeState, name, "change_state") for name in self.names}
        self._state = {name: self._client(GetState, name, "get_state") for name in self.names}
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self.on_manage, callback_group=group)
        self.create_service(Trigger, "~/is_active", self.on_is_active, callback_group=group)
        if self._timeout > 0:
            self.create_timer(LOOK, self.on_look, callback_group=group)
        if autostart:
            self._soon(Command.STARTUP)

    def _client(self, kind: type[Any], name: str, service: str) -> Client:
        return self.create_client(kind, f"{name}/{service}", callback_group=self._group)

    def _soon(self, command: int) -> None:
        """Carry out a command as soon as the node is spun."""

        async def act() -> None:
            timer.cancel()
            await self.manage(command)

        timer = self.create_timer(0.0, act, callback_group=self._group)

    async def on_manage(
        self, request: ManageLifecycleNodes.Request, response: ManageLifecycleNodes.Response
    ) -> ManageLifecycleNodes.Response:
        """Carry out a command."""
        response.success = await self.manage(request.command)
        return response

    def on_is_active(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Answer whether all nodes are active."""
        response.success = self.is_active
        return response

    async def manage(self, command: int) -> bool:
        """Carry out a command; return True if all nodes obeyed."""
        if command not in COMMANDS or self._is_busy:
            reason = "another one is being carried out" if self._is_busy else f"expected 0 to {max(COMMANDS)}"
            self.get_logger().error(f"Command {command} is refused: {reason}")
            return False
        transitions, first, last = COMMANDS[command]
        self.get_logger().info(first)
        self._is_busy, self.is_active = True, False
        try:
            if not await self._all(transitions, needed=command in (Command.STARTUP, Command.RESUME, Command.CONFIGURE)):
                return False
        finally:
            self._is_busy = False
        self.get_logger().info(last)
        self.is_active = transitions[-1] == Transition.TRANSITION_ACTIVATE
        self._seen_ns, self._lost_ns, self._gone = dict.fromkeys(self.names, self._now()), None, set()
        return True

    async def _all(self, transitions: Iterable[int], *, needed: bool) -> bool:
        """Make transitions of all nodes, upwards in their order, downwards in the reverse one.

        With `needed` the first failure ends it; otherwise nodes that are in another state, or gone, are passed over.
        """
        fine = True
        for transition in transitions:
            for name in self.names if transition in UP else reversed(self.names):
                self.get_logger().info(f"{STEPS[transition][0]} {name}")
                if not await self._one(name, transition, wait=needed):
                    fine = False
                    if needed:
                        self.get_logger().error("Failed to bring up all requested nodes. Aborting bringup.")
                        return False
        return fine

    async def _one(self, name: str, transition: int, *, wait: bool) -> bool:
        goal = STEPS[transition][1]
        if not await self._is_there(self._state[name], wait) or not await self._is_there(self._change[name], wait):
            return False
        before: Any = await self._state[name].call_async(GetState.Request())
        if before is not None and before.current_state.id == goal:
            return True
        request = ChangeState.Request(transition=Transition(id=transition))
        answer: Any = await self._change[name].call_async(request)
        if answer is None or not answer.success:
            self.get_logger().error(f"Failed to change state for node: {name}")
            return False
        return True

    async def _is_there(self, client: Client, wait: bool) -> bool:
        """Wait until a service is there, and tell each second; without `wait`, look once."""
        looks = 0
        while not client.service_is_ready():
            if not wait:
                self.get_logger().error(f"{client.service_name} is not there")
                return False
            if looks % round(1.0 / LOOK) == 0:
                self.get_logger().info(f"Waiting for service {client.service_name.lstrip('/')}...")
            looks += 1
            await pause(self, LOOK, self._group)
        return True

    async def _is_active(self, name: str) -> bool:
        """Ask a node for its state; return False too if it does not answer."""
        answer: Any = await self._state[name].call_async(GetState.Request())
        return answer is not None and answer.current_state.id == State.PRIMARY_STATE_ACTIVE

    def _now(self) -> int:
        return self.context.time.now()

    async def on_look(self) -> None:
        """Look who is there: reset the others when a node is lost, start them again when it is back."""
        if self._is_busy or not (self.is_active or self._lost_ns is not None):
            return
        now = self._now()
        gone = {name for name in self.names if not self._state[name].service_is_ready()}
        back, self._gone = self._gone - gone, gone
        self._seen_ns.update(dict.fromkeys(set(self.names) - gone, now))
        late = [name for name in self.names if now - self._seen_ns.get(name, now) > self._timeout * 1e9]
        if self._lost_ns is None and back:  # in time; but as the same one, or as a new process that nobody has started?
            late += [name for name in sorted(back) if not await self._is_active(name)]
        if self._lost_ns is None and late and not self._is_busy:  # it may be by now
            lost = ", ".join(late)
            self.get_logger().error(f"CRITICAL FAILURE: SERVER {lost} IS DOWN. Shutting down related nodes.")
            await self.manage(Command.RESET)
            self._lost_ns = self._now()
        elif self._lost_ns is not None and not late:
            self._lost_ns = None
            if self._returns:
                self.get_logger().info(
                    "Successfully re-established connections from server respawns, starting back up."
                )
                await self.manage(Command.STARTUP)
        elif self._lost_ns is not None and now - self._lost_ns > self._patience * 1e9:
            self._lost_ns = None
            self.get_logger().info("Failed to re-establish connection from a server crash after maximum timeout.")


def main(args: list[str] | None = None) -> None:
    """Manage nodes until Ctrl-C."""
    spin_program(lambda words: LifecycleManager(), args)
