"""The functions that programs call: init, spin and their sisters, on the default context and a shared executor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.context import Context
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
from robolink.task import Future
from robolink.utilities import get_default_context
from robolink.utilities import shutdown as shut_context_down
from robolink.utilities import try_shutdown as try_to_shut_context_down

_executor: Executor | None = None


class InitContextManager:
    """What `init` returns: ``with rclpy.init():`` shuts down at its end."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(self, *_: object) -> None:
        try_shutdown(context=None if self.context is get_default_context() else self.context)


def init(
    *,
    args: list[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Make a context ok: the default one, in which Ctrl-C and SIGTERM are then handled, unless one is given.

    Raises RuntimeError the second time, ValueError for arguments that cannot be read.
    """
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    initialized = get_default_context() if context is None else context
    initialized.init(args, domain_id=domain_id)
    install_signal_handlers(signal_handler_options)
    return InitContextManager(initialized)


def get_global_executor() -> Executor:
    """Give the executor that `spin` uses when it is given none; it lasts as long as the default context."""
    global _executor
    if _executor is None or _executor.context is not get_default_context():
        _forget_executor()
        _executor = SingleThreadedExecutor()
    return _executor


def _forget_executor() -> None:
    global _executor
    if _executor is not None:
        _executor.shutdown()
        _executor = None


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context, by default the default one. Raises RuntimeError when there is none to end."""
    _forget_if_default(context)
    shut_context_down(context=context)
    _uninstall(context, uninstall_handlers)


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context, by default the default one, unless it has ended."""
    _forget_if_default(context)
    try_to_shut_context_down(context=context)
    _uninstall(context, uninstall_handlers)


def _forget_if_default(context: Context | None) -> None:
    if context is None:
        _forget_executor()


def _uninstall(context: Context | None, wanted: bool | None) -> None:
    if wanted or (wanted is None and context is None):
        uninstall_signal_handlers()


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: list[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    start_parameter_services: bool = True,
    parameter_overrides: list[Parameter[Any]] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Make a node; see `Node`."""
    return Node(
        node_name,
        context=context,
        cli_args=cli_args,
        namespace=namespace,
        use_global_arguments=use_global_arguments,
        enable_rosout=enable_rosout,
        start_parameter_services=start_parameter_services,
        parameter_overrides=parameter_overrides,
        allow_undeclared_parameters=allow_undeclared_parameters,
        automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        enable_logger_service=enable_logger_service,
    )


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run a node's callbacks until the context ends."""
    _with_node(node, executor, lambda chosen: chosen.spin())


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node; wait for it at most `timeout_sec` seconds, for ever when None or negative."""
    _with_node(node, executor, lambda chosen: chosen.spin_once(timeout_sec=timeout_sec))


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run a node's callbacks until a future is done, or `timeout_sec` seconds have passed."""
    _with_node(node, executor, lambda chosen: chosen.spin_until_future_complete(future=future, timeout_sec=timeout_sec))


def _with_node(node: Node, executor: Executor | None, act: Callable[[Executor], None]) -> None:
    if executor is None and node.context is not get_default_context():
        with SingleThreadedExecutor(context=node.context) as own:
            _with_node(node, own, act)
        return
    chosen = executor or get_global_executor()
    before = node.executor
    added = chosen.add_node(node)
    try:
        act(chosen)
    finally:
        if added:
            _give_back(node, chosen, before)


def _give_back(node: Node, executor: Executor, before: Executor | None) -> None:
    """Undo `add_node`: rclpy takes a node from the executor that it had, for good, and that one hangs then."""
    if node.executor is not executor:
        return  # a callback moved or destroyed it
    executor.remove_node(node)
    if before is not None and before is not executor:
        before.add_node(node)
