"""Mailbox of a KEEP_LAST subscription on a network with threads: the oldest message is dropped where the new arrives.

Zenoh's thread must run no Python (see `running/inbox.py`), and what a flood drops should not go through the executor's
inbox first. So the sink is a Struct class whose instances append themselves to a deque of the subscription's depth:
making one stores a message and drops the oldest, in C from end to end. One of its fields counts what arrived, by which
gaps are known. Another one puts a notice into the inbox of whoever spins, one for all that waits: a `defaultdict` calls
its factory only for a key that it lacks.

In a flood each message would still wake the thread that spins, and take the core and Python's lock from Zenoh's: half
of the time went to that. Then every few messages share a notice, and Zenoh's thread pauses for a moment after it, so
that whoever spins takes them before they give way to others. The executor looks for what is left when it has nothing
to do, and ends this when few come (`ReadyQueue.gather`, `calm`).
"""

from __future__ import annotations

import functools
import itertools
import time
import weakref
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import msgspec

from robolink.running.ready_queue import NOTHING, ReadyQueue
from robolink.system.sleeps import sleep_exactly
from robolink.transport.history import Mailbox, bounded

if TYPE_CHECKING:
    from robolink.running.entity import Receiver
    from robolink.running.inbox import Inbox

SEVERAL = 8
"""Number of messages that came while others were executed, from which on they are a flood."""

MANY, BRISK = 16, 60e-6
"""Number of messages that woke the thread one by one, and their mean period in seconds, which are a flood as well."""

MOST = 32
"""Largest number of messages of a flood that share a notice."""

PAUSE = 10e-6
"""Pause of Zenoh's thread after a notice in a flood, in seconds.

With less, whoever spins gets the core too late, and receives half as many; with more, the link is held up so long that
its sender drops messages of other topics, too.
"""

_NOTICED = 0
"""Only key of the notices: there while a notice is under way, and while the receiver has a turn to come."""


class KeepLast(Mailbox):
    """Last messages of a subscription: the network stores them, and the executor takes them.

    It refers to its receiver weakly: messages that wait keep their class alive, which no collection of garbage finds,
    since what is made on Zenoh's thread must not start one. So they are cleared when the receiver goes.

    Args:
        depth: Largest number of messages that wait.
        receiver: Receiver whose messages they are.
        inbox: Inbox that gets the notices.
    """

    def __init__(self, depth: int, receiver: Receiver, inbox: Inbox) -> None:
        self.depth = depth
        self.straight = True
        """True if a notice may be taken at once: it stands for all that waits."""
        self.waiting = bounded(depth)
        """Messages that wait, oldest first, each with its `content` and `number`."""
        self.sink = inbox.sink(self)
        """Sink of the notices; an inbox can take it over."""
        waiting = self.waiting
        self.arrives_for = weakref.ref(receiver, lambda _: waiting.clear())
        """Returns the receiver, while there is one."""
        self._taken = 0, 0
        """Number of the last message that was taken, and how many had been dropped before it."""
        self._turns: int | None = None
        """Number of turns to come, where each message has one: in a waitable, or an executor without rounds."""
        self.in_flood = False
        """True while several messages share a notice."""
        self._rests = self._rested = 0
        self._since = 0.0
        self._notify = functools.partial(self.sink.__call__, None)
        self._notices: defaultdict[int, Any] = defaultdict(self._notify)
        self._count = itertools.count(1).__next__
        self._notify_once = functools.partial(self._notices.__getitem__, _NOTICED)
        self._with_one_notice = self._storing(self._notify_once)
        self.entrance: functools.partial[Any] = functools.partial(self._with_one_notice)
        """Sink for the network."""
        self.put = self.entrance
        self._store_silently()

    def _storing(self, notify: Callable[[], object]) -> Any:
        """Return a class whose instances append themselves to what waits, and call `notify` before."""
        number, noticed = (msgspec.field(default_factory=each) for each in (self._count, notify))
        return msgspec.defstruct(
            "Stored",
            [("content", Any), ("number", int, number), ("noticed", Any, noticed)],
            namespace={"__post_init__": self.waiting.append},
            gc=False,
        )

    @functools.cached_property
    def _with_a_notice_each(self) -> Any:
        return self._storing(self._notify)

    @functools.cached_property
    def _with_a_notice_for_several(self) -> Any:
        together = min(self.depth * 4 // 5, MOST)  # some more come until they are taken
        nothing = functools.partial(int)
        actions = [*[nothing] * (together - 2), self._notify, nothing]
        if sleep_exactly():
            # The flood may end during the pause, and the message is not stored before: then it puts a notice, too.
            pause = zip(_calls(functools.partial(time.sleep, PAUSE)), _calls(self._notify_once), strict=True)
            actions[-1] = functools.partial(next, pause)
        return self._storing(_calls(*actions).__next__)

    @property
    def dropped(self) -> int:  # type: ignore[override] # counted when it is read, here
        """Number of messages that gave way to newer ones."""
        receiver = self.arrives_for()
        queue = None if receiver is None else receiver._queue_
        with nullcontext() if queue is None else queue.lock:  # else one that is just being taken would count as dropped
            last, dropped = self._taken
            try:
                oldest: int = self.waiting[0].number
            except IndexError:  # nothing waits
                return dropped
            return dropped + max(oldest - last - 1, 0)

    @property
    def dropped_before_last(self) -> int:
        """Number of messages that had given way when the last one was taken."""
        return self._taken[1]

    def begin(self, queue: ReadyQueue[Any], receiver: Receiver, *, has_turn: bool, has_turns: bool) -> None:
        """Announce what waits, and what comes, to an executor.

        Args:
            queue: Ready queue of the executor, which holds its lock.
            receiver: Receiver whose messages they are.
            has_turn: True if it has a turn in the present round already.
            has_turns: True if each message has a turn of its own.
        """
        self.straight = not has_turns
        if has_turns:
            self._enter(self._with_a_notice_each)
            self._turns = len(self.waiting)
            queue.ready.extend([receiver] * (self._turns - has_turn))
        elif has_turn:
            self.listed = True
        else:
            self._rest()

    def end(self, queue: ReadyQueue[Any]) -> None:
        """Store what arrives, and put no notices: no executor has it any more. `queue` was the one that it had."""
        if self.in_flood:
            queue.flooded.remove(self)
        self._store_silently()

    def _store_silently(self) -> None:
        self._notices[_NOTICED] = self._turns = None
        self.listed = self.in_flood = False
        self._enter(self._with_one_notice)

    def _enter(self, stored: Any) -> None:
        self.entrance.__setstate__((stored, (), {}, None))  # type: ignore[attr-defined]

    # Notices, and what is left without

    def deliver(self, _: None = None) -> None:
        """Take a notice: the receiver is ready. Called under the inbox's lock."""
        receiver = self.arrives_for()
        queue = None if receiver is None else receiver._queue_
        if queue is None:
            return
        if self._turns is not None:
            if self._turns >= len(self.waiting):
                return  # the oldest has been dropped, and its turn is there
            self._turns += 1
        elif self.listed:
            return
        else:
            self.listed = True
        queue.ready.append(receiver)

    def calm(self) -> bool:
        """Let each message put a notice again, if few have come: True if the flood is over."""
        if len(self.waiting) >= SEVERAL // 2:
            return False
        self.in_flood = False
        self._enter(self._with_one_notice)
        if not self.listed:
            self._rest()
        return True

    # Messages

    def take(self) -> Any:
        """Take the oldest. Raises IndexError if there is none."""
        return self.waiting.popleft().content

    def take_next(self, receiver: Receiver, _: None = None) -> Any:
        """Return the oldest of what waits, or NOTHING; what waits behind it has its turn in the next round."""
        waiting, queue = self.waiting, receiver._queue_
        if self._turns:
            self._turns -= 1
        try:
            stored = waiting.popleft()
        except IndexError:
            if self._turns is None:
                self._rest()
            return NOTHING
        number = stored.number
        last, dropped = self._taken
        if number == last + 1:
            self._taken = number, dropped
        else:
            self._note_gap(number, receiver)
        if self._turns is None:
            if waiting and queue is not None:
                self.listed = True
                queue.ready.append(receiver)
            else:  # `_rest` and the usual case of `_look_at_pace` written out: a message of its own comes here
                self._rests += 1
                if number - self._rested >= SEVERAL or not self._rests % MANY:
                    self._look_at_pace(number, queue)
                self._rested = number
                self.listed = False
                if not self.in_flood:
                    self._notices.pop(_NOTICED, None)
                    if waiting:
                        self._notify_once()
        return stored.content

    take_arrived = take_next
    """Return the message that a notice stands for."""

    def _note_gap(self, number: int, receiver: Receiver) -> None:
        last, dropped = self._taken
        if number > last:
            self._taken = number, dropped + number - last - 1
            receiver.overflowed()
        else:  # another of the network's threads has stored a later one before it, which counted it as dropped
            self._taken = last, dropped - 1

    def _look_at_pace(self, number: int, queue: ReadyQueue[Any] | None) -> None:
        """Begin a flood if messages come several at a time, or many one by one."""
        is_flooded = number - self._rested >= SEVERAL
        if not self._rests % MANY:
            now = time.perf_counter()
            is_flooded |= now - self._since < MANY * BRISK
            self._since = now
        if not is_flooded or self.in_flood or self.depth < SEVERAL:
            return
        if queue is not None and queue.is_gathered:
            self.in_flood = True
            self._enter(self._with_a_notice_for_several)
            queue.flooded.append(self)

    def _rest(self) -> None:
        """Let the next message put a notice; put one for what has come meanwhile."""
        self.listed = False
        if not self.in_flood:
            self._notices.pop(_NOTICED, None)
            if self.waiting:
                self._notify_once()


def _calls(*actions: Callable[[], object]) -> Iterator[object]:
    """Return an endless iterator in C that calls the next of these partials in turn."""
    return map(functools.partial.__call__, itertools.cycle(actions))  # type: ignore[arg-type]
