"""Definitions of the recorded types: of what is installed, or as the publisher's node describes it.

Looking them up takes time, seconds where a node has to be asked, so it has threads of its own: nothing else waits.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.bag.definition import message_definition
from robolink.bag.recording.topics import RecordedTopic
from robolink.exceptions import RobolinkError
from robolink.system import waits
from robolink.type_lookup import installed_type, type_of

if TYPE_CHECKING:
    from robolink.context import Context

Found = Callable[[RecordedTopic, str], object]
"""Function of a topic and the text of its type, '' if nobody knows it."""


class Definitions:
    """Looks up the types of topics, one after the other; those that nodes are asked for, side by side.

    Args:
        context: Context whose network is asked.
        found: Called once for each topic, on one of the threads.
        warn: Called with one line for each type that nobody describes.
    """

    def __init__(self, context: Context, found: Found, warn: Callable[[str], object]) -> None:
        self._context, self._found, self._warn = context, found, warn
        self._asked: queue.SimpleQueue[RecordedTopic | None] = queue.SimpleQueue()
        self._known: dict[tuple[str, str], str] = {}
        self._unknown: dict[tuple[str, str], list[RecordedTopic]] = {}
        """Topics that wait for the type that is being asked for."""
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._run, name="robolink bag types", daemon=True)

    def start(self) -> None:
        """Start to look up."""
        self._thread.start()

    def look_up(self, topic: RecordedTopic) -> None:
        """Look up the type of a topic, in its turn."""
        self._asked.put(topic)

    def close(self) -> None:
        """Look up nothing more; what waits for a node's answer is told of as unknown."""
        self._asked.put(None)
        if self._thread.ident is not None:  # it was started
            waits.join(self._thread)
        with self._lock:
            waiting = [topic for topics in self._unknown.values() for topic in topics]
            self._unknown.clear()
        for topic in waiting:
            self._found(topic, "")

    def _run(self) -> None:
        for topic in iter(self._asked.get, None):
            text = self._installed(topic)
            if text is None:
                self._ask(topic)
            else:
                self._found(topic, text)

    def _installed(self, topic: RecordedTopic) -> str | None:
        kind = (topic.type_name, topic.token.type_hash)
        if kind not in self._known:
            try:
                installed = installed_type(topic.token)
                if installed is None:
                    return None
                self._known[kind] = message_definition(installed)
            except RobolinkError:  # a file of the workspace is wrong: the publisher may tell
                return None
        return self._known[kind]

    def _ask(self, topic: RecordedTopic) -> None:
        kind = (topic.type_name, topic.token.type_hash)
        with self._lock:
            waiting = self._unknown.setdefault(kind, [])
            waiting.append(topic)
            is_first = len(waiting) == 1
        if is_first:
            threading.Thread(target=self._ask_nodes, args=(topic, kind), name="robolink bag type", daemon=True).start()

    def _ask_nodes(self, topic: RecordedTopic, kind: tuple[str, str]) -> None:
        text = ""
        try:
            text = message_definition(type_of(self._context, topic.token))
        except RobolinkError as error:
            if self._context.ok():
                self._warn(f"{error} (it is recorded without its definition)")
        with self._lock:
            self._known[kind] = text
            waiting = self._unknown.pop(kind, [])
        for each in waiting:
            self._found(each, text)
