"""teleop_twist_joy: velocity commands from a gamepad."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.interfaces.sensor_msgs.msg import Joy
from robolink.testing import System


def joy(held: int | None = None, **axes: float) -> Joy:
    state = Joy(axes=[0.0] * 6, buttons=[0] * 8)
    for name, value in axes.items():
        state.axes[int(name[1:])] = value
    if held is not None:
        state.buttons[held] = 1
    return state


def started(system: System, **parameters: Any) -> list[Any]:
    system.start("teleop_twist_joy teleop_node", parameters=parameters)
    return system.messages("/cmd_vel", TwistStamped if parameters.get("publish_stamped_twist") else Twist)


def speeds(heard: list[Any]) -> list[tuple[float, float]]:
    return [(each.linear.x, each.angular.z) for each in heard]


def test_it_drives_while_the_button_is_held_and_stops_once(system: System) -> None:
    heard = started(system)
    for state in (joy(a5=1.0), joy(5, a5=1.0, a2=-0.5), joy(5, a5=0.5), joy(a5=0.5), joy(a5=0.5)):
        system.publish("/joy", state)
        system.run(0.1)
    assert speeds(heard) == [(0, 0), (0.5, -0.25), (0.25, 0), (0, 0)]
    system.expect_log("Teleop enable button 5.")
    system.expect_log("Linear axis x on 5 at scale 0.500000.")
    system.expect_log("Angular axis yaw on 2 at scale 0.500000.")


def test_turbo_has_its_own_button_and_scales(system: System) -> None:
    heard = started(system, **{"enable_turbo_button": 7, "axis_linear.x": 1, "scale_linear_turbo.x": 2.0})
    system.publish("/joy", joy(7, a1=1.0))
    system.run(0.1)
    assert speeds(heard) == [(2, 0)]
    system.expect_log("Turbo on button 7.")
    system.expect_log("Turbo for linear axis x is scale 2.000000.")


def test_the_button_may_be_left_out(system: System) -> None:
    heard = started(system, require_enable_button=False, inverted_reverse=True)
    system.publish("/joy", joy(a5=-1.0, a2=1.0))
    system.run(0.1)
    assert speeds(heard) == [(-0.5, -0.5)]


def test_parameters_change_while_it_runs(system: System) -> None:
    heard = started(system)
    system.set_parameter("teleop_twist_joy_node", "scale_linear.x", 0.1)
    system.publish("/joy", joy(5, a5=1.0))
    system.run(0.1)
    assert [each.linear.x for each in heard] == [pytest.approx(0.1)]


def test_commands_may_be_stamped(system: System) -> None:
    heard = started(system, publish_stamped_twist=True, frame="base_link")
    system.publish("/joy", joy(5, a5=1.0))
    system.run(0.1)
    assert (heard[0].header.frame_id, heard[0].twist.linear.x) == ("base_link", 0.5)


def test_a_gamepad_with_fewer_axes_and_buttons_is_no_harm(system: System) -> None:
    heard = started(system)
    system.publish("/joy", Joy(axes=[1.0], buttons=[1]))
    system.run(0.1)
    assert speeds(heard) == [(0, 0)]
