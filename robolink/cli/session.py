"""The short-lived contexts in which commands ask a running system, and the node that they speak through."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robolink.context import Context
from robolink.signals import install_signal_handlers

if TYPE_CHECKING:
    from robolink.node import Node

_left: list[Context] = []
"""Contexts that a look has left behind, still open."""


@contextlib.contextmanager
def opened() -> Iterator[Context]:
    """A context that is ok inside the block, in which Ctrl-C is handled."""
    context = _initialized()
    try:
        yield context
    finally:
        context.try_shutdown()


@contextlib.contextmanager
def looking() -> Iterator[Context]:
    """A context for a command that only looks at what is announced, and ends then.

    It is left open: closing a session that has 30 peers takes 0.3 s, and nothing of it needs a farewell.
    """
    context = _initialized()
    _left.append(context)
    yield context


def close_looks() -> None:
    """Close what looks have left open: for a process that goes on."""
    while _left:
        _left.pop().try_shutdown()


def any_looks() -> bool:
    """Whether looks have left anything open."""
    return bool(_left)


def _initialized() -> Context:
    context = Context()
    context.init(args=[])
    install_signal_handlers()
    return context


def node_of(context: Context, name: str = "", *, describes: bool = False) -> Node:
    """Make the node that a command speaks through: hidden, unless it is given a name.

    It serves nothing, but where it `describes` it says what the types that it uses are made of, as every other node.
    """
    from robolink.node import Node
    from robolink.parameter import Parameter

    return Node(
        name or f"_robolink_cli_{os.getpid()}",
        context=context,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("start_type_description_service", value=describes)],
    )
