# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg

__all__ = ["Clock"]

class Clock(robolink.message.Message):
    """The time that nodes with `use_sim_time` live in, as published on /clock."""
    clock: robolink.interfaces.builtin_interfaces.msg.Time
    def __init__(self, *, clock: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
