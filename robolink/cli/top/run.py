"""Run of `robolink top`: on a terminal the table stays in its place, elsewhere one is written below the other."""

from __future__ import annotations

import contextlib
import sys

from robolink.cli.shared.output import say, say_json
from robolink.cli.shared.session import node_of, opened
from robolink.cli.shared.terminal import keys
from robolink.cli.top.measuring import Meter
from robolink.cli.top.screen import Screen, show
from robolink.cli.top.table import View, chosen, data, lines
from robolink.system import clocks


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
