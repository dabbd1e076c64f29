"""joy: gamepads of Linux, as messages."""

from __future__ import annotations

import functools
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from robolink.counterparts.joy import devices, joy_node
from robolink.counterparts.joy.devices import (
    EVENT,
    ControllerState,
    Event,
    LinuxGamepad,
    State,
    events,
    found_gamepads,
    scaled,
)
from robolink.counterparts.joy.joy_node import GameControllerNode, JoyLinuxNode, JoyNode
from robolink.interfaces.sensor_msgs.msg import Joy
from robolink.testing import System

XBOX_AXES = [0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x10, 0x11]
XBOX_BUTTONS = [0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13A, 0x13B, 0x13C, 0x13D, 0x13E]


class Pad:
    """A gamepad whose sticks a test moves."""

    def __init__(self, name: str = "Xbox 360 Pad") -> None:
        self.name, self.axes, self.buttons = name, list(XBOX_AXES), list(XBOX_BUTTONS)
        self.waiting: list[Event] = []
        self.gone = self.closed = False

    def read(self) -> list[Event]:
        if self.gone:
            raise OSError(19, "No such device")
        found, self.waiting = self.waiting, []
        return found

    def close(self) -> None:
        self.closed = True


def axis(number: int, value: int) -> Event:
    return Event(True, number, value)


def button(number: int, value: int = 1) -> Event:
    return Event(False, number, value)


@pytest.fixture
def pad(monkeypatch: pytest.MonkeyPatch) -> Pad:
    monkeypatch.setattr(joy_node, "found_gamepads", lambda: {0: Path("/dev/input/js0")})
    return Pad()


def started(system: System, pad: Pad, kind: type[JoyNode] = JoyNode, **parameters: Any) -> None:
    made = type(kind.__name__, (kind,), {"__init__": functools.partialmethod(kind.__init__, opener=lambda path: pad)})
    system.start(made, parameters=parameters)


def test_the_state_is_published_at_once_and_again(system: System, pad: Pad) -> None:
    started(system, pad)
    system.expect_log("Opened joystick: Xbox 360 Pad.  deadzone: 0.050000")
    heard = system.messages("/joy", Joy)
    system.run(1.0)
    assert 19 <= len(heard) <= 21
    pad.waiting = [axis(1, -32767), button(5)]
    joy = system.expect("/joy", lambda each: each.buttons[5])
    assert (list(joy.axes)[:2], joy.header.frame_id, len(joy.axes), len(joy.buttons)) == ([0, 1], "joy", 8, 11)


def test_without_repetition_only_changes_are_published(system: System, pad: Pad) -> None:
    started(system, pad, autorepeat_rate=0.0)
    heard = system.messages("/joy", Joy)
    system.run(1.0)
    pad.waiting = [axis(0, 100)]  # within the dead zone
    system.run(1.0)
    assert heard == []
    pad.waiting = [axis(0, 32767), axis(0, 20000), axis(0, 32767)]
    system.run(1.0)
    assert [each.axes[0] for each in heard] == [-1]


def test_sticky_buttons_toggle(system: System, pad: Pad) -> None:
    started(system, pad, sticky_buttons=True)
    pad.waiting = [button(0), button(0, 0)]
    assert system.expect("/joy").buttons[0] == 1
    pad.waiting = [button(0), button(0, 0)]
    assert system.expect("/joy", lambda each: not each.buttons[0])


def test_a_gamepad_may_go_and_come_back(system: System, pad: Pad) -> None:
    started(system, pad)
    system.run(0.5)
    pad.gone = True
    system.expect_log("Xbox 360 Pad is gone: waiting for it")
    assert pad.closed
    pad.gone = False
    system.expect_log("Opened joystick", within=2.0)
    system.expect("/joy")


@pytest.mark.skipif(sys.platform != "linux", reason="gamepads are read on Linux")
def test_without_a_gamepad_it_waits_for_one(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(joy_node, "found_gamepads", dict)
    system.start(JoyNode)
    system.expect_log("there is no gamepad number 0 (/dev/input/js*): waiting for it")
    system.expect_none("/joy", during=3.0, type=Joy)


def test_on_other_systems_it_says_so(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(joy_node, "is_supported", lambda: False)
    system.start(JoyNode)
    system.expect_log("gamepads are read by Linux's joystick interface, and this is ")


def test_a_device_that_may_not_be_read_is_one_line(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path) -> Pad:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(joy_node, "found_gamepads", lambda: {0: Path("/dev/input/js0")})
    made = type("Refused", (JoyNode,), {"__init__": functools.partialmethod(JoyNode.__init__, opener=refuse)})
    system.start(made)
    system.expect_log("/dev/input/js0 cannot be opened: Permission denied; may this user read it?")


def test_the_order_of_game_controllers() -> None:
    state = ControllerState(Pad(), 0.0, sticky=False)
    assert [state.take(each) for each in (axis(3, 32767), axis(2, -32767), axis(5, 32767), axis(7, -32767))]
    assert state.axes == [0, 0, -1, 0, 0, -1]
    assert [number for number, value in enumerate(state.buttons) if value] == [11]
    for each in (axis(7, 0), button(2), button(4), button(8)):
        state.take(each)
    assert [number for number, value in enumerate(state.buttons) if value] == [2, 5, 9]
    other = ControllerState(Pad("Wireless Controller"), 0.0, sticky=False)
    other.take(button(2))
    assert [number for number, value in enumerate(other.buttons) if value] == [3]
    assert (len(other.axes), len(other.buttons)) == (6, 21)


def test_numbers_beyond_what_the_device_told_are_taken_or_left() -> None:
    state, controller = State(Pad(), 0.0, sticky=False), ControllerState(Pad(), 0.0, sticky=False)
    for each in (axis(200, 1), button(255)):
        state.take(each)
        assert not controller.take(each)
    assert (len(state.axes), len(state.buttons)) == (201, 256)


def test_an_axis_is_left_and_ahead_positive_with_a_dead_zone() -> None:
    assert (scaled(-32768, 0.1), scaled(32767, 0.1), scaled(3276, 0.1), scaled(0, 0.0)) == (1, -1, 0, 0)
    assert scaled(-18022, 0.1) == pytest.approx(0.5, abs=1e-4)


def test_events_are_those_of_the_kernel() -> None:
    raw = EVENT.pack(5, -7, 0x82, 3) + EVENT.pack(6, 1, 0x01, 2) + EVENT.pack(6, 1, 0x04, 2)
    assert events(raw + raw[:3]) == ([axis(3, -7), button(2)], raw[:3])


@pytest.mark.skipif(sys.platform != "linux", reason="a FIFO serves as a gamepad")
def test_a_device_is_read_without_waiting(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "js3"
    if sys.platform != "win32":  # for mypy
        os.mkfifo(path)
    assert found_gamepads(tmp_path) == {3: path}
    pad = LinuxGamepad(path)
    end = os.open(path, os.O_WRONLY)
    assert (pad.name, pad.axes, pad.buttons, pad.read()) == (str(path), [], [], [])
    os.write(end, EVENT.pack(1, 1, 0x81, 0)[:5])
    assert pad.read() == []
    os.write(end, EVENT.pack(1, 1, 0x81, 0)[5:] + EVENT.pack(1, 9, 0x02, 1))
    assert pad.read() == [button(0), axis(1, 9)]
    os.close(end)
    pad.close()


def test_gamepads_are_listed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "js0").touch()
    monkeypatch.setattr(joy_node, "found_gamepads", lambda: devices.found_gamepads(tmp_path))
    joy_node.list_devices()
    assert capsys.readouterr().out.splitlines()[2:] == [f"                 0 : {tmp_path / 'js0'}"]


def test_the_names_of_joy_linux(system: System, pad: Pad, tmp_path: Path) -> None:
    (tmp_path / "js7").touch()
    started(system, pad, JoyLinuxNode, dev=str(tmp_path / "js7"))
    heard = system.messages("/joy")
    system.run(1.0)
    assert len(heard) in (19, 20, 21)  # autorepeat_rate 20.0, as its source declares
    pad.waiting = [axis(0, -32767)]
    system.run(0.1)
    assert heard[-1].axes[0] == 1


def test_a_game_controller_node_has_its_name(system: System, pad: Pad) -> None:
    started(system, pad, GameControllerNode)
    assert len(system.expect("/joy").axes) == 6
    assert "game_controller_node" in system.node.get_node_names()
