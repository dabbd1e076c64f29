"""The screen that shows the table of `top`, with its keys, and the loop that renews it.

The lines are written by ANSI control sequences, in one call an update: that takes 0.1 ms, where a library for terminals
takes 17 to 56.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Sequence

from robolink.cli.shared.output import say, say_json
from robolink.cli.shared.session import node_of, opened
from robolink.cli.shared.terminal import Read, keys
from robolink.cli.top.measuring import Meter
from robolink.cli.top.table import (
    NODE_HEADER,
    ORDERS,
    TOPIC_HEADER,
    Shown,
    View,
    chosen,
    data,
    laid_out,
    lines,
    node_cells,
    summary,
    topic_cells,
)
from robolink.system import clocks
from robolink.system.terminal import fit

ENTER, LEAVE = "\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l"
"""Control sequences: to the alternate screen without a cursor, and back."""
HOME, END_OF_LINE, REST = "\x1b[H", "\x1b[K", "\x1b[J"
BOLD, DIM, PLAIN = "\x1b[1m", "\x1b[2m", "\x1b[0m"

HELP = "q quit  s sort  r reverse  / filter  a hidden names  space pause  up/down scroll"
SLICE = 0.1
"""Longest wait for a key, in seconds: no signal ends one."""
LEAST_TOPICS = 5
"""Lines that topics have at least, however many nodes there are."""


class Screen:
    """State of the table, and what keys do to it.

    Args:
        view: Order and filter at the beginning.
        domain: Domain that the first line names.
    """

    def __init__(self, view: View, domain: int) -> None:
        self.view, self.domain = view, domain
        self.is_paused = self.is_done = False
        self._typed: str | None = None
        self._scrolled = 0

    def press(self, key: str) -> None:
        """Do what a key stands for."""
        if self._typed is not None:
            self._type(key)
        elif key in ("q", "escape"):
            self.is_done = True
        elif key == "s":
            names = list(ORDERS)
            self.view = self.view._replace(order=names[(names.index(self.view.order) + 1) % len(names)])
        elif key == "r":
            self.view = self.view._replace(is_reversed=not self.view.is_reversed)
        elif key == "a":
            self.view = self.view._replace(hidden=not self.view.hidden)
        elif key == " ":
            self.is_paused = not self.is_paused
        elif key == "/":
            self._typed = ""
        else:
            step = {"up": -1, "down": 1, "pageup": -10, "pagedown": 10, "home": -(10**6)}.get(key, 0)
            self._scrolled = max(0, self._scrolled + step)

    def _type(self, key: str) -> None:
        typed = self._typed or ""
        if key in ("enter", "escape"):
            self._typed = None
            if key == "escape":
                self.view = self.view._replace(filter="")
            return
        self._typed = typed[:-1] if key == "backspace" else typed + key if len(key) == 1 else typed
        self.view = self.view._replace(filter=self._typed)

    def text(self, shown: Shown, columns: int, rows: int) -> str:
        """Return the text of the whole screen, control sequences included."""
        seen = chosen(shown, self.view)
        nodes = laid_out(NODE_HEADER, (node_cells(each) for each in seen.nodes), columns=columns)
        topics = laid_out(TOPIC_HEADER, (topic_cells(each) for each in seen.topics), columns=columns)
        room = max(0, rows - 3)  # the first line, an empty one between, and the last one
        for_topics = max(min(len(topics), LEAST_TOPICS), room - len(nodes))
        nodes = _cut(nodes, max(0, room - for_topics), 0)
        self._scrolled = min(self._scrolled, max(0, len(topics) - for_topics))
        topics = _cut(topics, room - len(nodes), self._scrolled)
        body = [(BOLD, summary(seen, self.domain)), *_table(nodes), ("", ""), *_table(topics), (DIM, self._status())]
        lines = (
            f"{style}{fit(line[:columns], lines=False)}{PLAIN if style else ''}{END_OF_LINE}" for style, line in body
        )
        return HOME + "\n".join(lines) + REST

    def _status(self) -> str:
        if self._typed is not None:
            return f"filter: {self._typed}_   (Enter keeps it, Escape clears it)"
        state = [f"sorted by {self.view.order}{' reversed' if self.view.is_reversed else ''}"]
        state += [f"filter '{self.view.filter}'"] * bool(self.view.filter) + ["PAUSED"] * self.is_paused
        return f"[{', '.join(state)}]   {HELP}"


def _table(lines: Sequence[str]) -> list[tuple[str, str]]:
    return [(DIM if number == 0 else "", line) for number, line in enumerate(lines)]


def _cut(lines: Sequence[str], room: int, scrolled: int) -> list[str]:
    """Return the header and as many rows as there is room for; the last line says how many more there are."""
    if room < 2 or (len(lines) <= room and not scrolled):
        return list(lines[: max(0, room)])
    rows = lines[1 + scrolled :]
    left = len(rows) - (room - 1)
    return [lines[0], *rows[: room - 1]] if left <= 0 else [lines[0], *rows[: room - 2], f"... {left + 1} more"]


def show(screen: Screen, look: Callable[[], Shown], every: float, read: Read, is_over: Callable[[], bool]) -> None:
    """Show a system on the whole terminal until the user has enough.

    Args:
        screen: State, steered by keys.
        look: Function that measures.
        every: Interval between two looks, in seconds; the second comes sooner.
        read: Function that waits for a key.
        is_over: Function that returns True when the network session has ended.
    """
    if sys.platform == "win32":
        os.system("")  # switches the console to ANSI control sequences
    sys.stdout.write(ENTER)
    try:
        shown, due, before = look(), clocks.monotonic() + min(0.3, every), ""
        while not screen.is_done and not is_over():
            columns, rows = shutil.get_terminal_size()
            text = screen.text(shown, columns, rows)
            if text != before:
                sys.stdout.write(text)
                sys.stdout.flush()
                before = text
            if key := read(min(SLICE, max(0.0, due - clocks.monotonic()))):
                screen.press(key)
            elif clocks.monotonic() >= due:
                due = clocks.monotonic() + every
                shown = shown if screen.is_paused else look()
    finally:
        sys.stdout.write(LEAVE)
        sys.stdout.flush()


def top(view: View, every: float, *, once: bool, json: bool, with_traffic: bool) -> None:
    """Show nodes and topics with their figures.

    Args:
        view: Order, filter, and whether hidden names are shown.
        every: Interval between two looks, in seconds.
        once: True to measure for one interval, print that, and return.
        json: True for a JSON object a look: `at` in seconds since the epoch, `nodes` and `topics`.
        with_traffic: False to subscribe to nothing.
    """
    with opened() as context, contextlib.closing(Meter(node_of(context), with_traffic=with_traffic)) as meter:
        domain, condition = context.get_domain_id(), context.graph.wait_for
        if not once and not json and sys.stdout.isatty():
            with keys() as read:
                show(Screen(view, domain), meter.look, every, read, lambda: not context.ok())
            return
        meter.look()
        due = clocks.monotonic()
        while True:
            due += every
            condition(lambda: not context.ok(), max(0.0, due - clocks.monotonic()))
            if not context.ok():
                return
            shown = chosen(meter.look(), view)
            if json:
                say_json({"at": clocks.time_of_day(), "domain": domain, **data(shown)})
            else:
                say("\n".join(lines(shown, domain)))
            if once:
                return
