"""The system under test: nodes are started, observed, called and disturbed, in one process and in virtual time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.interfaces import find
from robolink.testing.node_names import Named, full
from robolink.testing.stage import Startable, Wanted, startable
from robolink.testing.system_bags import SystemWithBags

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.qos import QoSProfile
    from robolink.task import Future

T = TypeVar("T")

PATIENCE = 5.0
"""Default timeout of everything a test waits for, in seconds of the system's time."""


class System(SystemWithBags):
    """A system of nodes under test, on a network and a clock of their own.

    With `transport` ``memory`` all nodes live in this process, and their time passes only while the test waits: a
    minute takes a fraction of a second, and is the same in every run with the same `seed`. With ``zenoh`` they are
    processes in real time. Relative names are resolved as by a node in ``/``; times are in seconds.

    A program that fails by itself fails the test at its next wait, with a NodeFailure, unless `allow_failures`.
    Every method that lets time pass may raise NodeFailure, and after `close` every method that starts, publishes or
    waits raises ClosedError.
    """

    # Programs

    def start(
        self,
        what: Startable,
        *,
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | None = None,
        remappings: Mapping[str, str] | None = None,
        args: Sequence[str] = (),
    ) -> Any:
        """Start a node in a program of its own, and return the node.

        Args:
            what: A Node class, a name as `robolink run` finds it, a path to a file, or the `main` function of a file.
            name: Name of the node; by default the one that its code gives.
            namespace: Namespace of the node; by default the one that its code gives.
            parameters: Values by parameter name. One that no node of the program declares fails the test.
            remappings: New names by old names, as ``{"scan": "front/scan"}``.
            args: Words of its command line, without the program's name.

        Returns:
            The node; with ``zenoh`` a stand-in that knows its names. A file with a `main` of its own that makes no node
            at once returns its program: it begins when time passes, and then `nodes` lists its nodes.

        Raises:
            TypeError: if `what` is nothing that can be started.
            NotFoundError: if there is no node or file of this name.
            OnlyInMemoryError: with ``zenoh``, for a class inside of a function, which another process cannot import.
            NodeFailure: with ``zenoh``, if the process ends before its node is made. In memory, whatever the node's
                constructor raises is raised as it is.
        """
        __tracebackhide__ = True
        self._check_open()
        wanted = Wanted(startable(what), name, namespace, parameters or {}, remappings or {}, tuple(args))
        started = self._stage.start(wanted)
        self._parameters.note_given(started, wanted.parameters)
        self._begin()
        return started

    def launch(
        self,
        file: str | PathLike[str],
        arguments: Mapping[str, Any] | None = None,
        *,
        set: Mapping[str, Any] | None = None,  # noqa: A002 - as `simulate --set`
        faults: str | PathLike[str] | None = None,
    ) -> None:
        """Start the nodes of a launch file.

        Commands of the file are left out in virtual time, with a warning.

        Args:
            file: Path, or a name as `robolink launch` finds it, or a package and a name: ``my_robot bot.launch.py``.
            arguments: Values of the launch file's own arguments, by name.
            set: Parameter values that go before the file's, as ``{"wall_follower.speed": 0.2}``.
            faults: Path of a file of faults, which hold from the very start of the nodes.

        Raises:
            NotFoundError: if a file, node or argument does not exist.
            DocumentError: if a file has a mistake, with `file:line:column`.
            TypeError: if `faults` is not a path.
        """
        __tracebackhide__ = True
        from robolink.testing.launching import read

        self._check_open()
        self._stage.launch(read(file, arguments or {}, set or {}), faults)
        self._parameters.note_set(set or {})
        self._begin()

    def stop(self, node: str | Named) -> None:
        """End a node's program in order, as Ctrl-C does: its clean-up code runs.

        Args:
            node: The node, or its name (with its namespace, where the name alone is not unique).

        Raises:
            NotFoundError: if no program has such a node, or several have.
        """
        __tracebackhide__ = True
        self._stage.stop(self._stage.program_of(node))
        self._begin()

    def crash(self, node: str | Named) -> None:
        """End a node's program at once, as `kill -9` does. This is no failure of the test.

        Args:
            node: The node, or its name (with its namespace, where the name alone is not unique).

        Raises:
            NotFoundError: if no program has such a node, or several have.
        """
        __tracebackhide__ = True
        self._stage.crash(self._stage.program_of(node))
        self._begin()

    def restart(self, node: str | Named) -> Any:
        """Start a node's program again with all that it was started with; one that still runs is ended first.

        Args:
            node: The node, or its name (with its namespace, where the name alone is not unique).

        Returns:
            The new node, as `start` returns it.

        Raises:
            NotFoundError: if no program has such a node, or several have.
        """
        __tracebackhide__ = True
        self._check_open()
        started = self._stage.restart(self._stage.program_of(node))
        self._begin()
        return started

    # Messages

    def publish(self, topic: str, message: Message, qos: QoSProfile | int = 10) -> None:
        """Publish a message from the test's own node. It arrives when time passes next.

        Args:
            topic: Name of the topic.
            message: The message; its class is the topic's type.
            qos: Profile or depth of the publisher, which is made at the first message of a topic and kept.

        Raises:
            TypeError: if `topic` is not text, or `message` no message.
        """
        __tracebackhide__ = True
        self._check_open()
        self._begin()
        self._conversation.publish(topic, message, qos)

    def messages(self, topic: str, type: type[Message] | None = None) -> list[Any]:  # noqa: A002 - what it is
        """Return a list that fills with the messages of a topic, from now on, whenever time passes.

        Messages that publishers keep for late subscriptions (TRANSIENT_LOCAL) come first.

        Args:
            topic: Name of the topic, which need not exist yet.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Returns:
            The list of messages, oldest first.
        """
        __tracebackhide__ = True
        self._check_open()
        return self._conversation.keep(topic, type)

    def expect(
        self,
        topic: str,
        predicate: Callable[[Any], object] | None = None,
        within: float = PATIENCE,
        *,
        type: type[Message] | None = None,  # noqa: A002 - what it is
    ) -> Any:
        """Wait for a message that meets a condition, and return it.

        A message counts if it was published after the test's last act (publish, call, set, start, end, let time pass)
        and after the message that `expect` found last on the topic. Messages that publishers keep for late
        subscriptions (TRANSIENT_LOCAL) count, too.

        Args:
            topic: Name of the topic.
            predicate: Called with each message; the first for which it returns true is taken. None takes any message.
            within: Timeout in seconds of the system's time.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Returns:
            The message.

        Raises:
            ExpectationError: if no such message came in time; the text has the last messages of the topics concerned.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `within` is negative or not finite.
        """
        __tracebackhide__ = True
        return self._expecting.message(topic, predicate, within, type)

    def expect_none(
        self,
        topic: str,
        predicate: Callable[[Any], object] | None = None,
        during: float = PATIENCE,
        *,
        type: type[Message] | None = None,  # noqa: A002 - what it is
    ) -> None:
        """Let time pass in which no message that meets a condition may come.

        Args:
            topic: Name of the topic.
            predicate: Called with each message; one for which it returns true fails the test. None means any message.
            during: Duration in seconds of the system's time.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Raises:
            ExpectationError: as soon as such a message comes.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `during` is negative or not finite.
        """
        __tracebackhide__ = True
        self._expecting.no_message(topic, predicate, during, type)
        self._begin()

    # Anything else that is waited for

    def wait_until(self, condition: Callable[[], object], within: float = PATIENCE) -> None:
        """Let time pass until a condition holds.

        Args:
            condition: Called after each callback of the system, without arguments, until it returns true.
            within: Timeout in seconds of the system's time.

        Raises:
            ExpectationError: if it did not hold in time.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `within` is negative or not finite.
        """
        __tracebackhide__ = True
        self._expecting.condition(condition, within)
        self._begin()

    def result(self, future: Future[T], within: float = 60.0) -> T:
        """Let time pass until a future is done, and return its result or raise its exception.

        Args:
            future: The future, such as one of `call_async` or `send_goal_async`.
            within: Timeout in seconds of the system's time.

        Raises:
            ExpectationError: if it was not done in time.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `within` is negative or not finite.
        """
        __tracebackhide__ = True
        result = self._expecting.result(future, within)
        self._begin()
        return result

    def expect_log(self, words: str, within: float = PATIENCE) -> Record:
        """Wait for a log line that contains some words, and return it.

        The search begins behind the line that the last `expect_log` found, with lines logged before this call too:
        several calls check an order.

        Args:
            words: Text that the line must contain, in the same case.
            within: Timeout in seconds of the system's time.

        Returns:
            The log record, with `message`, `name`, `severity` and `stamp_ns`.

        Raises:
            ExpectationError: if no such line came in time.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `within` is negative or not finite.
        """
        __tracebackhide__ = True
        return self._expecting.log_line(words, within)

    # Services and parameters

    def call(self, srv_type: type[Any] | str, name: str, request: Any = None, within: float = PATIENCE) -> Any:
        """Call a service and return its response.

        Args:
            srv_type: Service class, or its name such as ``std_srvs/srv/Trigger``.
            name: Name of the service.
            request: The request; None sends one of default values.
            within: Timeout in seconds of the system's time, for the service to appear and again for its response.

        Raises:
            ExpectationError: if there is no such service, or no response in time.
            NodeFailure: if a program failed meanwhile.
            ValueError: if `within` is negative or not finite.
        """
        __tracebackhide__ = True
        self._check_open()
        kind = find(srv_type, "srv") if isinstance(srv_type, str) else srv_type
        self._begin()
        return self._expecting.answer(kind, name, request, within)

    def parameter(self, node: str | Named, name: str, within: float = PATIENCE) -> Any:
        """Return the value of a node's parameter.

        Args:
            node: The node, or its full name.
            name: Name of the parameter.
            within: Timeout in seconds of each service call, if the node lives in another process.

        Raises:
            NotFoundError: if there is no such node.
            ParameterNotDeclaredException: if the node has not declared it, with the nearest name that it has.
            ExpectationError: if the node did not answer in time.
        """
        __tracebackhide__ = True
        return self._parameters.value_of(full(node), name, within)

    def set_parameter(self, node: str | Named, name: str, value: Any, within: float = PATIENCE) -> None:
        """Set a node's parameter.

        Args:
            node: The node, or its full name.
            name: Name of the parameter.
            value: The new value. An integer serves for a parameter that is a double.
            within: Timeout in seconds of each service call, if the node lives in another process.

        Raises:
            NotFoundError: if there is no such node.
            ParameterNotDeclaredException: if the node has not declared it, with the nearest name that it has.
            InvalidParameterValueException: if the node refuses the value, with its reason.
            ExpectationError: if the node did not answer in time.
        """
        __tracebackhide__ = True
        self._begin()
        self._parameters.set_value(full(node), name, value, within)
