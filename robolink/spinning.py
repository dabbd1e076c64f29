"""Functions that programs call: init, spin, shutdown and their like, on the default context and a shared executor."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.context import Context
from robolink.executors import RUNS_ITSELF, Executor, SingleThreadedExecutor
from robolink.node import BaseNode, Node
from robolink.parameter import Parameter
from robolink.qos import QoSProfile, qos_profile_rosout_default
from robolink.running.defaults import get_defaults
from robolink.signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
from robolink.task import Future
from robolink.utilities import get_default_context
from robolink.utilities import shutdown as shut_context_down
from robolink.utilities import try_shutdown as try_to_shut_context_down


class InitContextManager:
    """Context manager that `init` returns: `with rclpy.init():` shuts the context down at its end.

    The signal handlers that `init` installed are then uninstalled. See `init` for `args`, `context`, `domain_id` and
    `signal_handler_options`.
    """

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
    """Initialize a context: read the command line and make nodes possible.

    Args:
        args: Command line, of which what stands between `--ros-args` and `--` counts; None is `sys.argv`.
        context: Context to initialize; None is the default one.
        domain_id: ROS domain, 0 to 232: only nodes of one domain see each other. None is the environment variable
            ROS_DOMAIN_ID, or 0.
        signal_handler_options: Signals that end the context. None means SIGINT (Ctrl-C) and SIGTERM for the default
            context and none for another one.

    Returns:
        A context manager, which shuts the context down at the end of a `with` block. It may be ignored.

    Raises:
        ContextError: (a RuntimeError) if the context was initialized before, or the domain is impossible.
        InvalidROSArgsError: (a ValueError) if `args` cannot be read; UnknownROSArgsError for flags that do not exist.
        TypeError: if `args` is not a list of texts.
    """
    if isinstance(args, str) or not all(isinstance(each, str) for each in args or ()):
        raise TypeError(f"args: expected a list of str, got {args!r}")
    return InitContextManager(args, context, domain_id, signal_handler_options)


def get_global_executor() -> Executor:
    """Return the executor that `spin` uses when it is given none; it lasts as long as the default context."""
    defaults = get_defaults()
    executor: Executor | None = defaults.executor
    if executor is None or executor.context is not defaults.context:
        _forget_executor()
        executor = defaults.executor = SingleThreadedExecutor()
    return executor


def _forget_executor() -> None:
    executor, get_defaults().executor = get_defaults().executor, None
    if executor is not None:
        executor.shutdown(timeout_sec=0)  # a callback may be in the midst of something: rclpy does not wait either


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context: spinning stops, its nodes are destroyed, the network is left.

    Args:
        context: Context to end; None is the default one.
        uninstall_handlers: True uninstalls the signal handlers; None does so for the default context.

    Raises:
        ContextError: (a RuntimeError) if the context is not initialized or has been shut down.
    """
    is_default = _forget_if_default(context)
    shut_context_down(context=context)
    if is_default if uninstall_handlers is None else uninstall_handlers:
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End a context as `shutdown` does, unless it has been shut down before, or never been initialized.

    Args:
        context: Context to end; None is the default one.
        uninstall_handlers: True uninstalls the signal handlers; None does so for the default context.
    """
    is_default = _forget_if_default(context)
    try_to_shut_context_down(context=context)
    if is_default if uninstall_handlers is None else uninstall_handlers:
        uninstall_signal_handlers()


def _forget_if_default(context: Context | None) -> bool:
    """Forget the shared executor if the default context is to end; return whether it is."""
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
    rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
) -> Node:
    """Return a new node.

    Args:
        node_name: Name without namespace: letters, digits and underscores.
        context: Context to live in; None is the default one.
        cli_args: Command line for this node alone; it goes before the context's arguments.
        namespace: Prefix of the node's name and of its relative topics; None is the root.
        use_global_arguments: False ignores the ROS arguments of the program's command line.
        enable_rosout: True publishes what the node logs on /rosout.
        start_parameter_services: True starts the services by which others read and set parameters.
        parameter_overrides: Values that go before the defaults with which the node declares its parameters.
        allow_undeclared_parameters: True lets parameters be set that were never declared.
        automatically_declare_parameters_from_overrides: True declares every override at once.
        enable_logger_service: True starts the services that read and set the levels of loggers.
        rosout_qos_profile: Quality of service of what it logs on /rosout; a number is a depth.

    Raises:
        NotInitializedException: (a RuntimeError) if the context is not initialized, or has ended; and all else that
            `Node` raises.
    """
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
        rosout_qos_profile=rosout_qos_profile,
    )


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run a node's callbacks until the context ends.

    Args:
        node: Node to spin. It is added to the executor meanwhile, and given back to the one that it had.
        executor: Executor that runs the callbacks; None is the global one, which is single-threaded.

    Raises:
        ExternalShutdownException: if the context ends while this waits. After Ctrl-C it is, in the
            main thread, an InterruptedByUser, which is a KeyboardInterrupt too.
        TypeError: if `node` is not a Node.
        Exception: what a callback raises.
    """
    _with_node(node, executor, lambda chosen: chosen.spin())


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node; wait until one is ready.

    Args:
        node: Node to spin.
        executor: Executor that runs the callback; None is the global one, which is single-threaded.
        timeout_sec: Longest wait in seconds, after which none is run; None or less waits for ever, 0 does not wait.

    Raises:
        ExternalShutdownException: if the context has ended.
        TypeError: if `node` is not a Node.
        Exception: what the callback raises.
    """
    chosen = _resumed(node, executor)
    if chosen is None:
        _with_node(node, executor, lambda chosen: chosen.spin_once(timeout_sec=timeout_sec))
        return
    try:  # as `_with_node` does, without its calls: most programs spin in a loop of this
        chosen.spin_once(timeout_sec)
    finally:
        chosen._park_(node)


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run a node's callbacks until a future is done, the timeout has passed, or the context has ended.

    Args:
        node: Node to spin.
        future: Future to wait for; `future.done()` says whether it came.
        executor: Executor that runs the callbacks; None is the global one, which is single-threaded.
        timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.

    Raises:
        ExternalShutdownException: if the context ends while this waits. After Ctrl-C it is, in the
            main thread, an InterruptedByUser, which is a KeyboardInterrupt too.
        TypeError: if `node` is not a Node.
        Exception: what a callback raises.
    """
    _with_node(node, executor, lambda chosen: chosen.spin_until_future_complete(future, timeout_sec))


def _resumed(node: Node, executor: Executor | None) -> Executor | None:
    """Return the executor, by default the shared one, if the last spin parked this node there: it has it again."""
    chosen: Executor | None = executor or get_defaults().executor
    return chosen if chosen is not None and chosen._nodes_.resume(node) else None


def _with_node(node: Node, executor: Executor | None, act: Callable[[Executor], None]) -> None:
    """Add the node to the executor, the shared one or that of its context by default, for as long as `act` spins it."""
    resumed = _resumed(node, executor)
    if resumed is not None:
        try:
            act(resumed)
        finally:
            resumed._park_(node)
        return
    _check_node(node)
    if executor is None and node.context is not get_default_context():
        with SingleThreadedExecutor(context=node.context) as own:
            _with_node(node, own, act)
        return
    chosen = executor or get_global_executor()
    before = node.executor
    added = chosen.add_node(node)
    try:
        if before is None:
            act(chosen)
        else:
            with chosen._beside_(before):
                act(chosen)
    finally:
        if added:
            _give_back(node, chosen, before)


def _check_node(given: object) -> None:
    if getattr(given, "_runs_itself_", False) and isinstance(given, BaseNode):
        raise TypeError(RUNS_ITSELF.format(given.get_fully_qualified_name()))
    if not isinstance(given, Node):
        hint = f": call it, {given.__name__}()" if isinstance(given, type) else ""
        raise TypeError(f"expected a Node to spin, got {given!r:.80}{hint}")


_TAKEN = (
    "this node is spun though it belongs to another executor, which gets it back here; with ROS 2 it would then be"
    " in no executor any more, and none of its callbacks run: spin that executor instead (executor.spin_once())"
)


def _give_back(node: Node, executor: Executor, before: Executor | None) -> None:
    """Undo `add_node`: rclpy takes a node from the executor that it had, for good, and that one hangs then."""
    if node.executor is not executor:
        return  # a callback moved or destroyed it
    if before is None or before is executor:
        executor._park_(node)
        return
    before.add_node(node)
    if not node._was_taken_:
        node._was_taken_ = True
        node.get_logger().warning(_TAKEN)
