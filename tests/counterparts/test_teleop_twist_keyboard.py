"""teleop_twist_keyboard: what its keys mean."""

from __future__ import annotations

import functools
from typing import Any

import pytest

from robolink.control.keyboard import NoTerminalError
from robolink.counterparts.teleop_twist_keyboard import TeleopTwistKeyboard
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.testing import System


class Keys:
    """A keyboard on which a test types."""

    def __init__(self) -> None:
        self.typed, self.closed = "", False

    def read(self) -> str:
        found, self.typed = self.typed, ""
        return found

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def keys(system: System) -> Keys:
    return Keys()


def started(system: System, keys: Keys, **parameters: Any) -> TeleopTwistKeyboard:
    class Teleop(TeleopTwistKeyboard):
        __init__ = functools.partialmethod(TeleopTwistKeyboard.__init__, keys)

    node: TeleopTwistKeyboard = system.start(Teleop, parameters=parameters)
    return node


def typed(system: System, keys: Keys, text: str) -> tuple[float, ...]:
    """The command after some keys: along x, y and z, and about z."""
    keys.typed += text
    found = system.expect("/cmd_vel")
    twist = found.twist if isinstance(found, TwistStamped) else found
    return (twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z)


def test_keys_drive_and_any_other_stops(system: System, keys: Keys) -> None:
    started(system, keys)
    assert typed(system, keys, "i") == (0.5, 0, 0, 0)
    assert typed(system, keys, "u") == (0.5, 0, 0, 1)
    assert typed(system, keys, ".") == (-0.5, 0, 0, 1)
    assert typed(system, keys, "O") == (0.5, -0.5, 0, 0)
    assert typed(system, keys, "t") == (0, 0, 0.5, 0)
    assert typed(system, keys, "k") == (0, 0, 0, 0)
    assert typed(system, keys, "l") == (0, 0, 0, -1)
    assert typed(system, keys, "\x1b") == (0, 0, 0, 0)


def test_speeds_change_by_a_tenth(system: System, keys: Keys, capsys: pytest.CaptureFixture[str]) -> None:
    started(system, keys, speed=1.0, turn=2.0)
    keys.typed = "i"
    system.run(0.1)
    assert typed(system, keys, "q") == pytest.approx((1.1, 0, 0, 0))
    assert typed(system, keys, "x") == pytest.approx((0.99, 0, 0, 0))
    assert typed(system, keys, "c") == pytest.approx((0.99, 0, 0, 0))
    assert typed(system, keys, "j") == pytest.approx((0, 0, 0, 1.98))
    out = capsys.readouterr().out
    assert "currently:\tspeed 1.0\tturn 2.0 \n" in out
    assert "currently:\tspeed 1.1\tturn 2.2 \n" in out
    keys.typed = "ez" * 7
    system.run(0.1)
    assert capsys.readouterr().out.count("CTRL-C ends") == 1


def test_a_command_holds_without_being_repeated(system: System, keys: Keys) -> None:
    started(system, keys)
    heard = system.messages("/cmd_vel", Twist)
    keys.typed = "i"
    system.run(5.0)
    assert len(heard) == 1


def test_it_repeats_and_stops_if_asked(system: System, keys: Keys) -> None:
    started(system, keys, repeat_rate=10.0, key_timeout=1.0)
    heard = system.messages("/cmd_vel", Twist)
    keys.typed = "i"
    system.run(3.0)
    assert 10 <= len(heard) <= 13
    assert [each.linear.x for each in heard[-2:]] == [0.5, 0]


def test_stamped_commands_have_a_frame(system: System, keys: Keys) -> None:
    started(system, keys, stamped=True, frame_id="base_link")
    system.run(1.0)
    keys.typed = "i"
    found = system.expect("/cmd_vel", type=TwistStamped)
    assert (found.header.frame_id, found.twist.linear.x, found.header.stamp.sec > 0) == ("base_link", 0.5, True)


def test_a_frame_needs_stamps(system: System, keys: Keys) -> None:
    with pytest.raises(InvalidParameterValueException, match="it can only be set when 'stamped' is True"):
        started(system, keys, frame_id="base_link")


def test_its_end_stops_the_robot_and_restores_the_terminal(system: System, keys: Keys) -> None:
    node = started(system, keys)
    heard = system.messages("/cmd_vel", Twist)
    keys.typed = "i"
    system.run(1.0)
    system.stop(node)
    system.run(0.1)
    assert [each.linear.x for each in heard] == [0.5, 0]
    assert keys.closed


def test_without_a_terminal_it_is_one_line(system: System) -> None:
    with pytest.raises(NoTerminalError, match="teleop_twist_keyboard reads keys from a terminal"):
        system.start(TeleopTwistKeyboard)
