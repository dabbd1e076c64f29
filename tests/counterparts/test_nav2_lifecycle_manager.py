"""nav2_lifecycle_manager: managed nodes are started in order, ended, and watched."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.interfaces.nav2_msgs.srv import ManageLifecycleNodes
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from robolink.testing import System

Command = ManageLifecycleNodes.Request


class Obedient(LifecycleNode):
    """A managed node, which is named by the test."""

    def __init__(self, **options: Any) -> None:
        super().__init__("obedient", **options)


class Stubborn(Obedient):
    """A managed node that cannot be activated."""

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.FAILURE


def state(system: System, node: str) -> str:
    return str(system.call(GetState, f"/{node}/get_state").current_state.label)


def manage(system: System, command: int) -> bool:
    request = Command(command=command)
    return bool(system.call(ManageLifecycleNodes, "/lifecycle_manager/manage_nodes", request).success)


def is_active(system: System) -> bool:
    return bool(system.call(Trigger, "/lifecycle_manager/is_active").success)


def started(system: System, names: str = "one two", **parameters: Any) -> None:
    parameters["node_names"] = names.split()
    system.start("nav2_lifecycle_manager lifecycle_manager", parameters=parameters)


def test_nodes_are_started_in_order(system: System) -> None:
    started(system, autostart=True)
    system.expect_log("Starting managed nodes bringup...")
    system.expect_log("Configuring one")
    system.expect_log("Waiting for service one/get_state...")
    system.run(3.0)
    system.start(Obedient, name="two")
    system.start(Obedient, name="one")
    for line in ("Configuring two", "Activating one", "Activating two", "Managed nodes are active"):
        system.expect_log(line)
    assert (state(system, "one"), state(system, "two"), is_active(system)) == ("active", "active", True)


def test_commands_lead_through_the_states(system: System) -> None:
    for name in ("one", "two"):
        system.start(Obedient, name=name)
    started(system)
    system.run(1.0)
    assert (state(system, "one"), is_active(system)) == ("unconfigured", False)
    for command, label in (
        (Command.STARTUP, "active"),
        (Command.PAUSE, "inactive"),
        (Command.RESUME, "active"),
        (Command.RESET, "unconfigured"),
        (Command.CONFIGURE, "inactive"),
        (Command.CLEANUP, "unconfigured"),
        (Command.STARTUP, "active"),
        (Command.SHUTDOWN, "finalized"),
    ):
        assert manage(system, command)
        assert {state(system, "one"), state(system, "two")} == {label}
        assert is_active(system) == (label == "active")
    assert not manage(system, 9)
    system.expect_log("Command 9 is refused: expected 0 to 6")


def test_downwards_it_goes_in_the_reverse_order(system: System) -> None:
    for name in ("one", "two"):
        system.start(Obedient, name=name)
    started(system, autostart=True)
    system.expect_log("Managed nodes are active")
    assert manage(system, Command.RESET)
    for line in ("Deactivating two", "Deactivating one", "Cleaning up two", "Cleaning up one", "have been reset"):
        system.expect_log(line, within=0.0)


def test_a_node_that_refuses_ends_the_bringup(system: System) -> None:
    system.start(Obedient, name="one")
    system.start(Stubborn, name="two")
    started(system)
    assert not manage(system, Command.STARTUP)
    system.expect_log("Failed to change state for node: two")
    system.expect_log("Failed to bring up all requested nodes. Aborting bringup.")
    assert not is_active(system)


def test_a_node_that_is_lost_has_the_others_reset_and_started_again_with_it(system: System) -> None:
    for name in ("one", "two"):
        system.start(Obedient, name=name)
    started(system, autostart=True)
    system.expect_log("Managed nodes are active")
    system.crash("two")
    system.run(3.0)
    assert is_active(system)
    system.expect_log("CRITICAL FAILURE: SERVER two IS DOWN. Shutting down related nodes.", within=2.0)
    system.run(0.5)
    assert (state(system, "one"), is_active(system)) == ("unconfigured", False)
    system.restart("two")
    system.expect_log("Successfully re-established connections from server respawns, starting back up.")
    system.expect_log("Managed nodes are active")
    assert (state(system, "two"), is_active(system)) == ("active", True)


def test_a_node_that_is_lost_and_back_before_anybody_misses_it_is_started_as_well(system: System) -> None:
    for name in ("one", "two"):
        system.start(Obedient, name=name)
    started(system, autostart=True)
    system.expect_log("Managed nodes are active")
    system.crash("two")
    system.run(2.0)  # a launch file's respawn_delay, below bond_timeout
    system.restart("two")
    system.expect_log("CRITICAL FAILURE: SERVER two IS DOWN. Shutting down related nodes.", within=1.0)
    system.expect_log("Managed nodes are active", within=2.0)
    assert (state(system, "one"), state(system, "two"), is_active(system)) == ("active", "active", True)


def test_without_bonds_nobody_is_watched(system: System) -> None:
    for name in ("one", "two"):
        system.start(Obedient, name=name)
    started(system, autostart=True, bond_timeout=0.0)
    system.expect_log("Managed nodes are active")
    system.crash("two")
    system.run(20.0)
    assert state(system, "one") == "active"
