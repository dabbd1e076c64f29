"""Limits of slow links, and Zenoh's settings for them: which topics leave this machine first, how often, how large.

control: [/cmd_vel]              # goes first, before all that waits
rate: {/camera/*: 2}             # messages a second at most
size: {/map: 8000}               # larger messages stay here, in bytes
interfaces: [wlan0]              # without it: all but loopback
buffer: 8192                     # of the system, for each TCP link, in bytes
"""

from __future__ import annotations

import json
import math
import os
import re
import socket
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import msgspec

from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import Document, read, spell
from robolink.exceptions import DocumentError, TransportError
from robolink.security.patterns import keys, problem
from robolink.system.files import expanded

if TYPE_CHECKING:
    import zenoh

VARIABLE = "ROBOLINK_LIMITS"
"""Variable with the limits of a process: `{...}` as in a launch file, or the path of a file."""

MOST_TOPICS = 1000
"""Upper bound of the topics that one key lists."""

FASTEST, SLOWEST = 1e6, 1e-3
"""Bounds of a rate, in messages a second."""

LARGEST = 1 << 30
"""Upper bound of a size, in bytes."""

SMALLEST_BUFFER = 1024
"""Lower bound of the buffer, in bytes; Linux takes twice as much, and never less than 4608."""

CLOCK = "/clock"
"""Topic that goes first without being named: a late clock stops all who use it."""

_INTERFACE = re.compile(r"[\w.:@ -]{1,64}")
_LOOPBACKS = ("lo", "lo0")
_UNCONFINED = {"flows": ["egress"], "messages": ["put"]}


# No patterns in `rate`: Zenoh keeps one clock for each rule, so that of two cameras one got nothing at all (measured).
class Limits(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Limits of what leaves this machine; topics are full names, in which `*` stands for any text, but not in `rate`.

    `control` topics and services go before all that waits, and so does /clock. `rate` has the most messages a second of
    a topic, `size` the largest message in bytes; what is above is not sent. `interfaces` are those of the network to
    which all this applies, all but loopback if None. `buffer` is the size of the system's buffer of each link, 0 for
    the system's own choice.
    """

    control: list[str] = []
    rate: dict[str, float] = {}
    size: dict[str, int] = {}
    interfaces: list[str] | None = None
    buffer: int = 0

    @property
    def topics(self) -> list[tuple[tuple[Step, ...], str]]:
        """Return all names and patterns, each with the steps to its place."""
        listed: list[tuple[tuple[Step, ...], str]] = [(("control", at), name) for at, name in enumerate(self.control)]
        return [
            *listed,
            *((("rate", name), name) for name in self.rate),
            *((("size", name), name) for name in self.size),
        ]


def mistakes(limits: Limits) -> Iterator[tuple[tuple[Step, ...], str, bool]]:
    """Yield mistakes that types cannot express: the steps to it, what is wrong, and True if it is about the key."""
    for key in ("control", "rate", "size"):
        if len(getattr(limits, key)) > MOST_TOPICS:
            yield (key,), f"more than {MOST_TOPICS:,} topics", False
            return
    for steps, name in limits.topics:
        if wrong := problem(name):
            yield steps, f"'{name[:80]}' is not a full name of a topic: {wrong}", steps[0] != "control"
        elif steps[0] == "rate" and "*" in name:
            yield steps, f"'{name}': name each topic: all that fit a pattern would share one rate, and one starve", True
    for name, rate in limits.rate.items():
        if not (math.isfinite(rate) and SLOWEST <= rate <= FASTEST):
            yield ("rate", name), f"expected messages a second, {SLOWEST} to {FASTEST:,.0f}, got {rate}", False
    for name, size in limits.size.items():
        if not 1 <= size <= LARGEST:
            yield ("size", name), f"expected bytes, 1 to {LARGEST:,}, got {size}", False
    yield from _mistakes_of_links(limits)


def _mistakes_of_links(limits: Limits) -> Iterator[tuple[tuple[Step, ...], str, bool]]:
    if limits.interfaces == []:
        yield ("interfaces",), "name at least one, such as wlan0, or leave `interfaces` out", False
    for at, each in enumerate(limits.interfaces or ()):
        if not _INTERFACE.fullmatch(each):
            yield ("interfaces", at), f"'{each[:80]}' is not a name of an interface, such as wlan0", False
    if limits.buffer and not SMALLEST_BUFFER <= limits.buffer <= LARGEST:
        reason = (
            f"expected bytes, {SMALLEST_BUFFER:,} to {LARGEST:,}, or 0 for the system's choice, got {limits.buffer}"
        )
        yield ("buffer",), reason, False


def requested(environ: Mapping[str, str]) -> Limits | None:
    """Return the limits that ROBOLINK_LIMITS has; None if it is not set. Raises TransportError for a mistake in it."""
    text = environ.get(VARIABLE, "").strip()
    if not text:
        return None
    try:
        return parsed(text).value if text.startswith("{") else parsed(None, os.fspath(expanded(text))).value
    except DocumentError as error:
        raise TransportError(str(error) if text.startswith("{") else f"{VARIABLE}: {error}") from None


def parsed(text: str | None, name: str = VARIABLE) -> Document[Limits]:
    """Return the limits of a text, or of the file `name` if it is None; raises DocumentError with its place."""
    document = read(name, Limits, text=text)
    for steps, message, is_key in mistakes(document.value):
        raise document.error(steps, message, key=is_key)
    return document


def written(limits: Limits) -> str:
    """Return limits as the text of ROBOLINK_LIMITS."""
    return spell({key: value for key, value in msgspec.to_builtins(limits).items() if value})


def settings(limits: Limits, domain: int, interfaces: list[str] | None = None) -> dict[str, Any]:
    """Return Zenoh's settings by path, as JSON data, for the topics of one domain.

    Args:
        limits: What is asked for.
        domain: ROS domain id.
        interfaces: Network interfaces of this machine beyond loopback, if `limits` name none; None stands for all, and
            then other processes of this machine get no more than other machines do.
    """
    named = limits.interfaces or interfaces
    where: dict[str, Any] = {"interfaces": named} if named else {}
    first = {key: None for name in (*limits.control, CLOCK) for key in keys(name, domain)}
    rates = [{"key_expr": key, "freq": rate} for name, rate in limits.rate.items() for key in keys(name, domain)]
    found: dict[str, Any] = {
        "qos/network": [
            {
                **where,
                "id": "robolink control",
                "flows": ["egress"],
                "messages": ["put", "delete", "query"],  # what answers a query has the query's priority
                "key_exprs": [*first],
                "overwrite": {"priority": "real_time"},
            }
        ]
    }
    if rates:
        found["downsampling"] = [{**where, **_UNCONFINED, "id": "robolink rate", "rules": rates}]
    if limits.size:
        found["low_pass_filter"] = [
            {**where, **_UNCONFINED, "id": f"robolink size {at}", "key_exprs": keys(name, domain), "size_limit": size}
            for at, (name, size) in enumerate(limits.size.items())
        ]
    return found | ({"transport/link/tcp/so_sndbuf": limits.buffer} if limits.buffer else {})


def thinned(limits: Limits, domain: int) -> list[str]:
    """Return the key expressions of the topics of one domain of which not every message is sent."""
    return [key for name in (*limits.rate, *limits.size) for key in keys(name, domain)]


def apply(config: zenoh.Config, limits: Limits, domain: int) -> None:
    """Change a session's configuration: `limits` take the place of settings of this kind that it has."""
    for path, value in settings(limits, domain, beyond_loopback()).items():
        config.insert_json5(path, json.dumps(value))


def beyond_loopback() -> list[str] | None:
    """Return the network interfaces of this machine that are not loopback; None where they cannot be known."""
    if os.name == "nt":  # Zenoh knows them by other names there
        return None
    try:
        return [name for _, name in socket.if_nameindex() if name not in _LOOPBACKS] or None
    except OSError:
        return None
