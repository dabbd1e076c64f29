"""Parameter lists: the pairs of a number and a value in which RTPS announces things and adds things to samples.

Sources: RTPS 2.5, 9.4.2.11 (lists), 9.3.2 (durations, locators) and 10 (the header in front of a list).
"""

from __future__ import annotations

import math
import socket
import struct
from collections.abc import Sequence
from typing import Literal

from robolink.rtps.ids import PID_SENTINEL, RtpsError

Buffer = bytes | bytearray | memoryview
Locator = tuple[str, int]
"""IPv4 address and UDP port."""

MOST_VALUE = 0xFFFC
"""Bytes of a parameter's value."""
SENTINEL = b"\x01\0\0\0"
LIST_HEADER = b"\0\x03\0\0"
"""In front of a list that is a sample: PL_CDR_LE. Another byte order is read too."""

_BIG_LIST, _LITTLE_LIST = 2, 3
_UDP4 = 1
_LOCATOR_BYTES = 24
_FOREVER = 0x7FFFFFFF
_INFINITE = struct.pack("<iI", _FOREVER, 0xFFFFFFFF)
_MUST_UNDERSTAND = 0x4000
_PAIR, _BIG_PAIR = struct.Struct("<HH"), struct.Struct(">HH")


class Parameters:
    """A list that was read: the values by number, in the byte order in which they came."""

    __slots__ = ("_values", "end", "little")

    def __init__(self, raw: Buffer, at: int = 0, *, little: bool = True) -> None:
        """Read a list from a place on.

        Raises:
            RtpsError: if it is cut, or does not end with a sentinel.
        """
        self.little = little
        self._values: dict[int, list[bytes]] = {}
        pair = (_PAIR if little else _BIG_PAIR).unpack_from
        last = len(raw) - 4
        while at <= last:
            pid, size = pair(raw, at)
            at += 4
            if pid == PID_SENTINEL:
                self.end = at
                """Where what follows the list begins."""
                return
            if at + size > len(raw):
                raise RtpsError(f"parameter {pid:#06x} of {size} bytes, of which {len(raw) - at} came")
            # The bit says "without understanding this you must not use the rest". We know those that decide whether
            # endpoints fit; who does not understand us says so himself.
            self._values.setdefault(pid & ~_MUST_UNDERSTAND, []).append(bytes(raw[at : at + size]))
            at += size
        raise RtpsError("a parameter list without its end")

    def __contains__(self, pid: int) -> bool:
        return pid in self._values

    def raw(self, pid: int, size: int = 0) -> bytes | None:
        """Return the first value with this number, cut to a size; None if there is none, or it is shorter."""
        values = self._values.get(pid)
        if values is None or len(values[0]) < size:
            return None
        return values[0][:size] if size else values[0]

    def number(self, pid: int, usual: int, at: int = 0) -> int:
        """Return the unsigned 32 bits at a place of a value, or what is usual where there is none."""
        value = self.raw(pid, at + 4)
        return usual if value is None else int.from_bytes(value[at : at + 4], self._order)

    def seconds(self, pid: int, at: int = 0) -> float | None:
        """Return a duration; None: infinite, which is also what an absent one means.

        Raises:
            RtpsError: if it is negative.
        """
        value = self.raw(pid, at + 8)
        if value is None:
            return None
        whole, fraction = struct.unpack_from("<iI" if self.little else ">iI", value, at)
        if whole == _FOREVER:
            return None
        if whole < 0:
            raise RtpsError(f"parameter {pid:#06x}: a duration of {whole} s")
        return float(whole + fraction / (1 << 32))

    def octets(self, pid: int) -> bytes:
        """Return a sequence of octets, b"" where there is none.

        Raises:
            RtpsError: if it is longer than its value.
        """
        value = self.raw(pid)
        if value is None:
            return b""
        size = int.from_bytes(value[:4], self._order)
        if len(value) < 4 + size:
            raise RtpsError(f"parameter {pid:#06x}: {size} octets, of which {max(len(value) - 4, 0)} came")
        return value[4 : 4 + size]

    def text(self, pid: int) -> str:
        """Return a string, "" where there is none.

        Raises:
            RtpsError: if it is longer than its value, or not UTF-8.
        """
        try:
            return self.octets(pid).removesuffix(b"\0").decode()
        except UnicodeDecodeError:
            raise RtpsError(f"parameter {pid:#06x}: text that is not UTF-8") from None

    def locators(self, pid: int) -> tuple[Locator, ...]:
        """Return the UDP addresses among the locators with this number.

        Others (shared memory, TCP, IPv6, ports that do not exist) are left out: they are of no use here.
        """
        found = []
        for value in self._values.get(pid, ()):
            if len(value) < _LOCATOR_BYTES:
                continue
            kind, port = struct.unpack_from("<iI" if self.little else ">iI", value)
            # The kernel refuses port 0, and Python one above 65535 with an OverflowError, which once ended the thread.
            if kind == _UDP4 and 0 < port <= 0xFFFF:
                found.append((socket.inet_ntoa(value[20:24]), port))
        return tuple(found)

    @property
    def _order(self) -> Literal["little", "big"]:
        return "little" if self.little else "big"


def read_list(payload: Buffer) -> Parameters:
    """Read a sample that is a list: its header says the byte order.

    Raises:
        RtpsError: if it is not a list, or is cut.
    """
    if len(payload) < 4 or payload[0] or payload[1] not in {_BIG_LIST, _LITTLE_LIST}:
        raise RtpsError(f"not a parameter list: it begins with {bytes(payload[:4]).hex() or 'nothing'}")
    return Parameters(payload, 4, little=payload[1] == _LITTLE_LIST)


def parameter(pid: int, value: bytes) -> bytes:
    """Return one parameter; its value is filled up to a multiple of 4 bytes.

    Raises:
        ValueError: if there is no room for it.
    """
    size = len(value)
    filling = -size % 4
    if size + filling > MOST_VALUE:
        raise ValueError(f"parameter {pid:#06x} of {size} bytes: {MOST_VALUE} have room")
    return _PAIR.pack(pid, size + filling) + value + bytes(filling)


def octets(value: bytes) -> bytes:
    """Return the value of a sequence of octets."""
    return len(value).to_bytes(4, "little") + value


def text(value: str) -> bytes:
    """Return the value of a string."""
    return octets(value.encode() + b"\0")


def number(value: int) -> bytes:
    """Return the value of unsigned 32 bits."""
    return value.to_bytes(4, "little")


def seconds(value: float | None) -> bytes:
    """Return the value of a duration; None and what is longer than 68 years is infinite."""
    if value is None or value >= _FOREVER:
        return _INFINITE
    whole = math.floor(max(value, 0.0))
    return struct.pack("<iI", whole, int((max(value, 0.0) - whole) * (1 << 32)))


def locators(pid: int, addresses: Sequence[Locator]) -> bytes:
    """Return a parameter for each address."""
    return b"".join(
        parameter(pid, struct.pack("<iI", _UDP4, port) + bytes(12) + socket.inet_aton(address))
        for address, port in addresses
    )
