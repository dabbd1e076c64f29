"""Log lines on /rosout: each node publishes those of its own logger and of that logger's children."""

from __future__ import annotations

import weakref

from robolink import logging
from robolink.exceptions import RobolinkError
from robolink.impl.log_output import Record
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.publisher import Publisher

_publishers: weakref.WeakValueDictionary[str, Publisher[Log]] = weakref.WeakValueDictionary()
_send = Publisher.publish  # as it is now: who replaces it, to see what a program publishes, means no log lines


def publish_logs_of(logger_name: str, publisher: Publisher[Log]) -> None:
    """Publish this logger's lines with `publisher`, for as long as that lives."""
    if not _publishers:
        logging.remove_handler(_publish)
        logging.add_handler(_publish)
    _publishers[logger_name] = publisher


def keep_to_itself(logger_name: str) -> None:
    """Publish this logger's lines no more."""
    _publishers.pop(logger_name, None)


def _publish(record: Record) -> None:
    publisher = _publisher_for(record.name)
    if publisher is None:
        return
    seconds, nanoseconds = divmod(record.stamp_ns, 10**9)
    line = Log(
        stamp=Time(sec=seconds, nanosec=nanoseconds),
        level=int(record.severity),
        name=record.name,
        msg=record.message,
        file=record.file,
        function=record.function,
        line=record.line,
    )
    try:
        _send(publisher, line)
    except RobolinkError:  # after shutdown the console is all there is
        keep_to_itself(record.name)


def _publisher_for(name: str) -> Publisher[Log] | None:
    while name:
        found = _publishers.get(name)
        if found is not None:
            return found
        name = name.rpartition(".")[0]
    return None
