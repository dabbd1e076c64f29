"""The functions that programs call: init, spin and their sisters, on the default context and a shared executor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.context import Context
from robolink.defaults import get_defaults
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
from robolink.task import Future
from robolink.utilities import get_default_context
from robolink.utilities import shutdown as shut_context_down
from robolink.utilities import try_shutdown as try_to_shut_context_down


class InitContextManager:
    """What `init` returns: ``with rclpy.init():`` shuts down at its end, and gives back the signals that it took."""

    def __init__(
        self,
        args: list[str] | None,
        context: Context | None,
        domain_id: int | None,
        signal_handler_options: SignalHandlerOptions | None,
    ) -> None:
        self.context = get_default_context() if context is None else context
        if signal_handler_options is None:
            is_default = self.context is get_default_context()
            signal_handler_options = SignalHandlerOptions.ALL if is_default else SignalHandlerOptions.NO
        self.installed_signal_handlers = bool(signal_handler_options)
        self.context.init(args, domain_id=domain_id)
        install_signal_handlers(signal_handler_options)

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(self, *_: object) -> None:
        context = None if self.context is get_default_context() else self.context
        try_shutdown(context=context, uninstall_handlers=self.installed_signal_handlers)


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
    return InitContextManager(args, context, domain_id, signal_handler_options)


def get_global_executor() -> Executor:
    """Give the executor that `spin` uses when it is given none; it lasts as long as the default context."""
    defaults = get_defaults()
    if defaults.executor is None or defaults.executor.context is not get_default_context():
        _forget_executor()
        defaults.executor = SingleThreadedExecutor()
    return defaults.executor


def _forget_executor() -> None:
    executor, get_defaults().executor = get_defaults().executor, None
    if executor is not None:
        executor.shutdown(timeout_sec=0)  # a callback may be in the midst of something: rclpy does not wait either


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context, by default the default one. Raises RuntimeError when there is none to end.

    The signals are given back if `uninstall_handlers`, by default if the context is the default one.
    """
    is_default = _forget_if_default(context)
    shut_context_down(context=context)
    if is_default if uninstall_handlers is None else uninstall_handlers:
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context as `shutdown` does, unless it has ended."""
    is_default = _forget_if_default(context)
    try_to_shut_context_down(context=context)
    if is_default if uninstall_handlers is None else uninstall_handlers:
        uninstall_signal_handlers()


def _forget_if_default(context: Context | None) -> bool:
    """Let go of the shared executor when the default context is to end; whether it is."""
    is_default = context is None or context is get_default_context()
    if is_default:
        _forget_executor()
    return is_default


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
    _check_node(node)
    if executor is None and node.context is not get_default_context():
        with SingleThreadedExecutor(context=node.context) as own:
            _with_node(node, own, act)
        return
    chosen = executor or get_global_executor()
    before = node.executor
    added = chosen.add_node(node)
    try:
        with chosen._beside_(before):
            act(chosen)
    finally:
        if added:
            _give_back(node, chosen, before)


def _check_node(given: object) -> None:
    if not isinstance(given, Node):
        hint = f": call it, {given.__name__}()" if isinstance(given, type) else ""
        raise TypeError(f"expected a Node to spin, got {given!r:.80}{hint}")


def _give_back(node: Node, executor: Executor, before: Executor | None) -> None:
    """Undo `add_node`: rclpy takes a node from the executor that it had, for good, and that one hangs then."""
    if node.executor is not executor:
        return  # a callback moved or destroyed it
    executor.remove_node(node)
    if before is not None and before is not executor:
        before.add_node(node)
