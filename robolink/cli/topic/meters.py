"""The verbs hz, bw and delay: rates, bandwidths and ages of the last messages, once a second."""

from __future__ import annotations

import struct
import sys
import threading
from collections import deque
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared.graph import PATIENCE, is_hidden, why_silent
from robolink.cli.shared.layout import Figures, figures_of
from robolink.cli.shared.output import clear, say, say_json, tell
from robolink.cli.shared.session import node_of, opened
from robolink.cli.topic.arrivals import Arrivals, Leniently, Take
from robolink.exceptions import DecodeError, RobolinkError
from robolink.system import clocks
from robolink.time_source import CLOCK_TOPIC
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context


NS = 1e-9


class Window:
    """Sliding window of a topic's last `size` messages: the time of each arrival, in ns, and a number with it."""

    def __init__(self, size: int) -> None:
        self._times: deque[int] = deque(maxlen=size)
        self._values: deque[int] = deque(maxlen=size)
        self._lock = threading.Lock()
        self._new = 0
        self.total = 0
        """Number of messages since the beginning."""

    def add(self, at: int, value: int = 0) -> None:
        """Add a message. A time before the last one means that time was reset: what was before is dropped."""
        with self._lock:
            if self._times and at < self._times[-1]:
                self._times.clear()
                self._values.clear()
            self._times.append(at)
            self._values.append(value)
            self._new += 1
            self.total += 1

    def look(self) -> tuple[list[int], list[int], int]:
        """Return the times, the numbers, and how many messages came since the last look."""
        with self._lock:
            new, self._new = self._new, 0
            return list(self._times), list(self._values), new


def gaps(times: Sequence[int]) -> Figures | None:
    """Return the statistics of the gaps from each message to the next, in seconds."""
    return figures_of([(later - earlier) * NS for earlier, later in pairwise(times)])


def frequency(times: Sequence[int]) -> float | None:
    """Return the rate in Hz; None for fewer than two messages, or if all came at once."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return (len(times) - 1) / spent if spent > 0 else None


def bandwidth(times: Sequence[int], sizes: Sequence[int]) -> float | None:
    """Return bytes a second, without the first message, which came at the beginning of the time measured."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return sum(sizes[1:]) / spent if spent > 0 else None


def as_bytes(number: float, like: float) -> str:
    """Return bytes as text in the unit that suits `like`, as in ros2: B, KB or MB, of a thousand each."""
    if like < 1e3:
        return f"{number:.0f} B"
    return f"{number / 1e3:.2f} KB" if like < 1e6 else f"{number / 1e6:.2f} MB"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return rows under a centred header and a rule, as in ros2, with an empty line at the end."""
    widths = [max(len(each) for each in column) for column in zip(header, *rows, strict=True)]
    head = "   ".join(title.center(width) for title, width in zip(header, widths, strict=True))
    lines = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([head, "=" * (sum(widths) + 3 * (len(widths) - 1)), *lines, ""])


PERIOD = 1.0
"""Interval between two reports, in seconds."""

STAMP = {1: struct.Struct("<iI"), 0: struct.Struct(">iI")}
"""Layouts of a builtin_interfaces/msg/Time at the beginning of a message, by the byte for its byte order."""

NO_NEWS = "no new messages"


class NoHeaderError(RobolinkError, ValueError):
    """The type has no header, which `topic delay` needs."""


class Flags(NamedTuple):
    """Options of all three meters."""

    window: int
    json: bool = False
    sim_time: bool = False
    """True to measure in the time of /clock."""


class Report(NamedTuple):
    """Report of figures: as text for one topic, as cells of a table for several, and as data for JSON."""

    text: str
    cells: list[str]
    data: dict[str, Any]


class Meter(NamedTuple):
    """A kind of measurement: how a message of a publisher's type is recorded, and the report of what is recorded."""

    take: Callable[[EndpointToken, Window], Take]
    header: list[str]
    report: Callable[[list[int], list[int]], Report | None]
    nothing: dict[str, Any]


def hz(topics: list[str], flags: Flags, filter_text: str) -> None:
    """Print the rate of the messages of topics, of all if there are none; only of those that pass a filter."""
    header = ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]
    with opened() as context:
        take = _filtered(context, filter_text) if filter_text else _noted
        _measure(context, topics, flags, Meter(take, header, _rate, _no_figures("rate")), more=1)


def bw(topics: list[str], flags: Flags) -> None:
    """Print the bandwidth of topics, of all if there are none."""
    header = ["topic", "bandwidth", "mean", "min", "max", "messages"]
    nothing = dict.fromkeys(["bytes_per_second", "mean", "min", "max"]) | {"messages": 0}
    with opened() as context:
        size = context.transport.size
        meter = Meter(lambda _, window: lambda content, at: window.add(at, size(content)), header, _bandwidth, nothing)
        _measure(context, topics, flags, meter)


def delay(topic: str, flags: Flags) -> None:
    """Print the delay from the stamp in the header to the arrival of messages."""
    with opened() as context:
        meter = Meter(lambda publisher, window: _delayed(context, publisher, window), [], _delay, _no_figures("delay"))
        _measure(context, [topic], flags, meter, clock=clocks.now)


def _measure(
    context: Context,
    topics: list[str],
    flags: Flags,
    meter: Meter,
    *,
    more: int = 0,
    clock: Callable[[], int] = clocks.steady,
) -> None:
    node = node_of(context)
    names = list(dict.fromkeys(node.resolve_topic_name(each) for each in topics))
    arrivals = Arrivals(node, clock)
    try:
        timed = _sim_time(context, arrivals) if flags.sim_time else _as_it_is
        metering = _Metering(context, arrivals, meter, timed, flags.window + more, every=not topics)
        for name in names:
            metering.add(name)
            if len(names) > 1 and not flags.json:
                say(f"Subscribed to [{name}]")
        _report(metering, flags)
    finally:
        arrivals.close()


class _Metering:
    """Topics that are measured, each with its window; all of them, new ones too, if `every`."""

    def __init__(
        self,
        context: Context,
        arrivals: Arrivals,
        meter: Meter,
        timed: Callable[[Take], Take],
        size: int,
        *,
        every: bool,
    ) -> None:
        self.context, self.arrivals, self.meter, self.every = context, arrivals, meter, every
        self.windows: dict[str, Window] = {}
        self._timed, self._size = timed, size
        self.follow()

    def add(self, name: str) -> None:
        """Measure a topic, named in full."""
        window = self.windows[name] = Window(self._size)
        self.arrivals.listen(name, lambda publisher: self._timed(self.meter.take(publisher, window)))

    def follow(self) -> None:
        """Measure also the topics that are new, if all are wanted; hidden ones are left out, as in `topic list`."""
        if not self.every:
            return
        found = {each.name for each in self.context.graph.endpoints(EndpointKind.PUBLISHER)}
        for name in sorted(found - self.windows.keys()):
            if not is_hidden(name):
                self.add(name)


def _report(metering: _Metering, flags: Flags) -> None:
    begin, rounds = clocks.monotonic(), 0
    explained = metering.every
    while True:
        rounds += 1
        metering.arrivals.wait(begin + rounds * PERIOD)
        meter, windows = metering.meter, metering.windows
        looks = {name: window.look() for name, window in windows.items()}
        reports = {name: meter.report(times, values) if new else None for name, (times, values, new) in looks.items()}
        if flags.json:
            for name, found in reports.items():
                say_json({"topic": name, **(found.data if found else meter.nothing), "new": looks[name][2]})
        else:
            _say_reports(metering, reports)
        if not explained and rounds * PERIOD >= PATIENCE:
            explained = True
            for name in (each for each, window in windows.items() if not window.total):
                tell(why_silent(metering.context, name))
        metering.follow()


def _say_reports(metering: _Metering, reports: dict[str, Report | None]) -> None:
    found = {name: each for name, each in reports.items() if each is not None}
    if metering.every and sys.stdout.isatty():
        clear()
    if metering.every or len(metering.windows) > 1:
        if found:
            say(table(metering.meter.header, [[name, *each.cells] for name, each in found.items()]))
            return
    elif found:
        say(next(iter(found.values())).text)
        return
    if any(window.total for window in metering.windows.values()):
        say(NO_NEWS)


# How messages are noted


def _noted(publisher: EndpointToken, window: Window) -> Take:
    return lambda content, at: window.add(at)


def _filtered(context: Context, text: str) -> Callable[[EndpointToken, Window], Take]:
    from robolink.cli.topic.arrivals import compile_filter
    from robolink.message import decoder
    from robolink.type_lookup import type_of

    def how(publisher: EndpointToken, window: Window) -> Take:
        msg_type = type_of(context, publisher)
        passes, decode, read = Leniently(compile_filter(text, msg_type)), decoder(msg_type), context.transport.read

        def take(content: Any, at: int) -> None:
            message = passes.decoded(lambda: decode(read(content).payload))
            if message is not None and passes(message):
                window.add(at)

        return take

    return how


def _delayed(context: Context, publisher: EndpointToken, window: Window) -> Take:
    from robolink.type_lookup import type_of

    stamp_of, read = stamp_reader(type_of(context, publisher)), context.transport.read
    leniently = Leniently(lambda _: True)

    def take(content: Any, at: int) -> None:
        stamp = leniently.decoded(lambda: stamp_of(read(content).payload))
        if stamp is not None:
            window.add(at, at - stamp)

    return take


def stamp_reader(msg_type: type[Any]) -> Callable[[bytes], int]:
    """Return the function that reads a message's stamp, in ns: from the first bytes if the header is the first field.

    Raises NoHeaderError for a type without one.
    """
    from robolink.message import decoder

    fields = msg_type.__ros_fields__
    header = fields.get("header")
    if header is None or header.base != "std_msgs/msg/Header" or header.shape != "one":
        there = ", ".join(fields) or "nothing"
        raise NoHeaderError(
            f"topic delay needs a std_msgs/msg/Header named header; {msg_type.__ros_type__} has {there}"
        )
    if next(iter(fields)) == "header":
        return first_stamp
    decode = decoder(msg_type)

    def stamp_of(payload: bytes) -> int:
        stamp = decode(payload).header.stamp
        return int(stamp.sec) * 10**9 + int(stamp.nanosec)

    return stamp_of


def first_stamp(payload: bytes) -> int:
    """Return the time with which a message begins, in ns. Raises DecodeError if there is none."""
    try:
        seconds, nanoseconds = STAMP[payload[1]].unpack_from(payload, 4)
    except (KeyError, IndexError, struct.error):
        raise DecodeError(f"{len(payload)} bytes that do not begin with a stamp") from None
    return int(seconds) * 10**9 + int(nanoseconds)


def _as_it_is(take: Take) -> Take:
    return take


def _sim_time(context: Context, arrivals: Arrivals) -> Callable[[Take], Take]:
    """Listen to /clock, which times all arrivals; those before its first message are left out. Runs on one thread."""
    read, now = context.transport.read, [0]
    leniently = Leniently(lambda _: True)

    def on_clock(content: Any, at: int) -> None:
        now[0] = leniently.decoded(lambda: first_stamp(read(content).payload)) or now[0]

    arrivals.listen(CLOCK_TOPIC, lambda _: on_clock)

    def timed(take: Take) -> Take:
        return lambda content, at: take(content, now[0]) if now[0] else None

    return timed


# What is said of them


def _rate(times: list[int], values: list[int]) -> Report | None:
    figures, rate = gaps(times), frequency(times)
    if figures is None or rate is None:
        return None
    low, high, deviation, count = figures[1:]
    return Report(
        f"average rate: {rate:.3f}\n\tmin: {low:.3f}s max: {high:.3f}s std dev: {deviation:.5f}s window: {count}",
        [f"{rate:.3f}", f"{low:.3f}", f"{high:.3f}", f"{deviation:.5f}", str(count)],
        {"rate": rate, "min": low, "max": high, "std_dev": deviation, "window": count},
    )


def _bandwidth(times: list[int], sizes: list[int]) -> Report | None:
    found, figures = bandwidth(times, sizes), figures_of(sizes)
    if found is None or figures is None:
        return None
    speed = as_bytes(found, found) + "/s"
    mean, low, high = (as_bytes(each, found) for each in figures[:3])
    data = {"bytes_per_second": found, "mean": figures.mean, "min": figures.low, "max": figures.high}
    return Report(
        f"{speed} from {figures.number} messages\n\tMessage size mean: {mean} min: {low} max: {high}",
        [speed, mean, low, high, str(figures.number)],
        data | {"messages": figures.number},
    )


def _delay(times: list[int], delays: list[int]) -> Report | None:
    figures = figures_of([each * NS for each in delays])
    if figures is None:
        return None
    mean, low, high, deviation, count = figures
    return Report(
        f"average delay: {mean:.3f}\n\tmin: {low:.3f}s max: {high:.3f}s std dev: {deviation:.5f}s window: {count}",
        [],
        {"delay": mean, "min": low, "max": high, "std_dev": deviation, "window": count},
    )


def _no_figures(name: str) -> dict[str, Any]:
    return dict.fromkeys([name, "min", "max", "std_dev"]) | {"window": 0}
