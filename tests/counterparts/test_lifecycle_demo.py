"""The package lifecycle: a managed node, its listener, and a client that leads it through its states."""

from __future__ import annotations

from robolink.interfaces.std_msgs.msg import String
from robolink.testing import System


def test_the_demo_goes_through_all_states(system: System) -> None:
    system.start("lifecycle lifecycle_talker")
    system.start("lifecycle lifecycle_listener")
    heard = system.messages("/lifecycle_chatter", String)
    system.start("lifecycle lifecycle_service_client")
    for line in (
        "on_configure() is called.",
        "Transition 1 successfully triggered.",
        "Node lc_talker has current state inactive.",
        "Lifecycle publisher is currently inactive. Messages are not published.",
        "on_activate() is called.",
        "Node lc_talker has current state active.",
        "data_callback: Lifecycle HelloWorld #",
        "on_deactivate() is called.",
        "on_activate() is called.",
        "on_deactivate() is called.",
        "on cleanup is called.",
        "on shutdown is called from state unconfigured.",
        "Node lc_talker has current state finalized.",
    ):
        system.expect_log(line, within=12.0)
    assert 18 <= len(heard) <= 22


def test_transitions_are_heard(system: System) -> None:
    system.start("lifecycle lifecycle_listener")
    system.start("lifecycle lifecycle_talker")
    system.start("lifecycle lifecycle_service_client")
    system.expect_log("notify callback: Transition from state unconfigured to configuring")
    system.expect_log("notify callback: Transition from state configuring to inactive")


def test_without_the_talker_the_client_ends(system: System) -> None:
    system.start("lifecycle lifecycle_service_client")
    system.expect_log("Service /lc_talker/change_state is not available.")
