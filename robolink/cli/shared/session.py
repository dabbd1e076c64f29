"""Short-lived contexts in which commands look at a running system, and the node that they speak through."""

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
"""Contexts that `looking` has left open."""


@contextlib.contextmanager
def opened(enclave: str = "") -> Iterator[Context]:
    """Open a context for the block, with a handler for Ctrl-C, and shut it down at the end.

    Args:
        enclave: Enclave whose keys and rights it has, where security is on; '' for `/`.
    """
    context = _initialized(enclave)
    try:
        yield context
    finally:
        context.try_shutdown()


@contextlib.contextmanager
def looking() -> Iterator[Context]:
    """Open a context for a command that only looks at what is announced, and then ends.

    It is left open: closing a session that has 30 peers takes 0.3 s, and nothing of it needs a farewell.
    """
    context = _initialized()
    _left.append(context)
    yield context


def close_looks() -> None:
    """Shut down the contexts that `looking` has left open: for a process that goes on."""
    while _left:
        _left.pop().try_shutdown()


def any_looks() -> bool:
    """True if `looking` has left a context open."""
    return bool(_left)


def _initialized(enclave: str = "") -> Context:
    context = Context()
    context.init(args=["--ros-args", "--enclave", enclave] if enclave else [])
    install_signal_handlers()
    return context


def node_of(context: Context, name: str = "", *, describes: bool = False) -> Node:
    """Make the node that a command speaks through: with a hidden name, unless it is given one.

    It has no services, but for that of type descriptions if it `describes` the types that it uses.
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
