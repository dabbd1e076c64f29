"""Messages of any topic as they arrive, decoded as far as they can be, and the filter over them.

A thread of its own empties the queue, so that it does not grow while the terminal is blocked.

    passes = compile_filter("m.linear.x > 0.2 and hypot(m.linear.x, m.linear.y) < 1", Twist)
    if passes(message): ...

The expression of a filter is evaluated by Python, as ros2topic does: it is the user's own text, in the user's own
shell. Names are `m`, Python's builtins, and the functions and constants of `math`. What no message can make right
(syntax, an unknown name, a field that the type has not) is refused before the first message.
"""

from __future__ import annotations

import ast
import builtins
import functools
import math
import queue
import threading
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from robolink.cli.shared.output import tell
from robolink.exceptions import DecodeError, RobolinkError, TransportError, nearest
from robolink.graph.endpoint import ALL_BEST_EFFORT, keys_of, listen, timed_arrival
from robolink.message.annotations import FieldType
from robolink.system import clocks, waits
from robolink.transport.base import Handle
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.node import Node


NAMES = {name: value for name, value in vars(math).items() if not name.startswith("_") and not hasattr(builtins, name)}
"""Functions and constants of `math` by name; a name that Python has, too (`pow`), is Python's."""

_KNOWN = ["m", *NAMES, *(each for each in dir(builtins) if each.islower() and not each.startswith("_"))]


class FilterError(RobolinkError, ValueError):
    """An expression is not valid, names a field that the message lacks, or fails on one message."""

    def __init__(self, text: str, column: int = 0) -> None:
        super().__init__(f"--filter: column {column}: {text}" if column else f"--filter: {text}")


def compile_filter(text: str, kind: type[Any] | FieldType) -> Callable[[Any], bool]:
    """Return the function that returns True for a message that passes; `kind` is `m`'s type, a message or a field.

    Raises FilterError, with the column where that is known, if no message can make the expression right. The function
    raises it for a message on which the expression fails: a division by zero, an index beyond the end.
    """
    line = " ".join(text.splitlines()).strip()
    if not line:
        raise FilterError("expected an expression such as 'm.data > 3', got nothing")
    root = kind if isinstance(kind, FieldType) else FieldType(base=kind.__ros_type__, message=kind)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of escapes that Python does not know
            tree = ast.parse(line, mode="eval")
            _Checker(line, root).check(tree)
            code = compile(tree, "<filter>", "eval")
    except SyntaxError as error:
        problem = " ".join(str(error.msg).split())
        raise FilterError(f"no Python expression: {problem}", error.offset or len(line) + 1) from None  # 0: at the end
    except FilterError:
        raise
    except (ValueError, RecursionError, MemoryError, OverflowError):
        raise FilterError("no Python expression: nested too deeply, or with characters that are none") from None

    def passes(message: Any) -> bool:
        try:
            return bool(eval(code, {**NAMES, "m": message}))  # noqa: S307 - the user's own text, in their own shell
        except Exception as error:  # noqa: BLE001 - whatever the user's expression raises
            problem = " ".join(str(error).split())
            raise FilterError(f"{type(error).__name__}: {problem}" if problem else type(error).__name__) from None

    return passes


class _Checker:
    """Check for unknown names and fields, which Python would find only with the first message."""

    def __init__(self, line: str, root: FieldType) -> None:
        self._line, self._root = line, root

    def check(self, tree: ast.Expression) -> None:
        """Raise FilterError for the first unknown name or field."""
        own = set(_bound_names(tree))
        follows_m = "m" not in own
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id not in own and node.id not in NAMES and node.id != "m":
                if not hasattr(builtins, node.id):
                    there = "there is m, the message, and what Python and its module math have"
                    raise self._refused(node, f"no name '{node.id}'{nearest(node.id, _KNOWN)}; {there}")
            elif isinstance(node, ast.Attribute) and follows_m:
                self._kind(node)

    def _refused(self, node: ast.expr, text: str) -> FilterError:
        before = self._line.encode()[: node.col_offset].decode(errors="replace")  # the tree counts bytes
        return FilterError(text, len(before) + 1)

    def _kind(self, node: ast.expr) -> FieldType | None:
        """Return the type of a field such as ``m.poses[0].x``; None for what is not a field of a message."""
        if isinstance(node, ast.Name):
            return self._root if node.id == "m" else None
        if isinstance(node, ast.Subscript):
            holder = self._kind(node.value)
            if holder is None or holder.shape == "one" or isinstance(node.slice, ast.Slice):
                return holder if isinstance(node.slice, ast.Slice) else None
            return FieldType(base=holder.base, message=holder.message)
        holder = self._kind(node.value) if isinstance(node, ast.Attribute) else None
        if not isinstance(node, ast.Attribute) or holder is None or holder.message is None or holder.shape != "one":
            return None
        fields: dict[str, FieldType] = holder.message.__ros_fields__
        if node.attr not in fields and not hasattr(holder.message, node.attr):
            there = f"{holder.message.__ros_type__} has {', '.join(fields) or 'nothing'}"
            raise self._refused(node, f"no field '{node.attr}'{nearest(node.attr, fields)}; {there}")
        return fields.get(node.attr)


def _bound_names(tree: ast.Expression) -> Iterator[str]:
    """Yield the names that the expression itself gives values to: in a comprehension, a lambda or by ``:=``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


class Leniently:
    """Filter that leaves out messages on which it fails; the first error is printed on standard error."""

    def __init__(self, passes: Callable[[Any], bool]) -> None:
        self._passes = passes
        self._reported = False

    def __call__(self, message: Any) -> bool:
        """Return True if a message passes."""
        try:
            return self._passes(message)
        except FilterError as error:
            self._tell(f"{error} (a message is left out; the next ones are left out silently)")
            return False

    def decoded(self, decode: Callable[[], Any]) -> Any:
        """Return a decoded message; None if it cannot be decoded."""
        try:
            return decode()
        except (DecodeError, TransportError) as error:
            self._tell(f"a message cannot be read: {error} (the next ones are left out silently)")
            return None

    def _tell(self, text: str) -> None:
        if not self._reported:
            self._reported = True
            tell(f"robolink: {text}")


Take = Callable[[Any, int], None]
"""Function of an arrival, for `Transport.read` or `Transport.size`, and its time, in ns of the clock."""


class Arrivals:
    """Listener to topics in all types with which they are published, also by later publishers."""

    def __init__(self, node: Node, clock: Callable[[], int] = clocks.steady) -> None:
        self._node, self._context = node, node.context
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = timed_arrival(self._queue.put, clock)
        self._listeners: dict[str, Callable[[EndpointToken], Take]] = {}
        self._heard: set[str] = set()
        self._declared: list[Handle] = []
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._drain, name="robolink arrivals", daemon=True)
        self._thread.start()

    def listen(self, topic: str, how: Callable[[EndpointToken], Take]) -> None:
        """Listen to a topic, named in full; `how(publisher)` returns the function for messages of its type."""
        self._listeners[topic] = how
        self.follow()

    def follow(self) -> None:
        """Listen also to the types of new publishers. Raises what a Take has raised."""
        if self._error is not None:
            raise self._error
        for publisher in self._unheard():
            keys = keys_of(publisher) - self._heard
            if keys:
                self._heard |= keys
                self._subscribe(publisher, keys, self._listeners[publisher.name](publisher))

    def wait(self, until: float) -> None:
        """Wait until a time of `monotonic`, and follow meanwhile. Raises KeyboardInterrupt if the context ends."""
        graph, context = self._context.graph, self._context

        def stirred() -> bool:
            return self._error is not None or not context.ok() or bool(self._unheard())

        while True:
            left = until - clocks.monotonic()
            if left > 0:
                graph.wait_for(stirred, left)
            if not context.ok():
                raise KeyboardInterrupt
            self.follow()
            if left <= 0:
                return

    def close(self) -> None:
        """Stop listening."""
        for each in self._declared:
            each.close()
        self._queue.put(None)
        waits.join(self._thread, 1.0)

    def _unheard(self) -> list[EndpointToken]:
        graph = self._context.graph
        publishers = (each for name in self._listeners for each in graph.endpoints(EndpointKind.PUBLISHER, name=name))
        return [each for each in publishers if not keys_of(each) <= self._heard]

    def _subscribe(self, publisher: EndpointToken, keys: set[str], take: Take) -> None:
        sink = functools.partial(self._arrival, take)
        self._declared += listen(self._node._owner_, publisher, keys, ALL_BEST_EFFORT, sink)

    def _drain(self) -> None:
        for arrived in iter(self._queue.get, None):
            try:
                arrived.target(arrived.content, arrived.at)
            except RobolinkError as error:  # told by whoever waits in the main thread
                self._error = error
                self._context.graph.wake()
                return
