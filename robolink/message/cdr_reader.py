"""Code generator of decoders: one `struct` call a run, one copy for each array."""

from __future__ import annotations

import codecs
import struct
import sys
from array import array
from collections.abc import Callable
from typing import Any

from robolink.exceptions import MessageError
from robolink.message.annotations import FieldType
from robolink.message.base import Message, maker
from robolink.message.cdr_layout import CODES, SIZES, Lines, padded, phases
from robolink.message.numbers import DTYPES, VIEW_FROM


class ReaderSource:
    """Source text of ``run(data) -> message``. ``i`` is the index in the data; the body's phase is ``i - 4``."""

    def __init__(self, cls: type[Message], order: str) -> None:
        self.out = Lines()
        self.makers: dict[type[Message], Callable[..., Any]] = {}
        self.constants: dict[str, Any] = self.out.constants
        self.constants.update(MessageError=MessageError)
        self.order = order
        self.swap = (order == "<") != (sys.byteorder == "little")
        self.at: int | None = 4
        self.headed = False
        """True once the first run of primitives has read the encapsulation header along with it."""
        self.run: list[tuple[str, str]] = []
        made = self._message(cls)
        self._flush()
        self.out.add(f"return {made}")

    def text(self) -> str:
        """Return the source text of the function."""
        start = ["def run(data):", "    try:"]
        if not self.headed:
            start.append(f"        if data[0] or data[1] != {int(self.order == '<')}: return other(data)")
        end = ["    except Exception as error:", "        raise fail(data, error) from None"]
        return "\n".join([*start, *self.out.lines, *end])

    def _message(self, cls: type[Message]) -> str:
        """Read all fields; return the expression that makes the message of them."""
        if not cls.__ros_fields__:
            self.run.append(("B", self.out.fresh("_")))
        parts = [self._field(kind) for kind in cls.__ros_fields__.values()]  # by position: twice as fast as by name
        return f"{self.out.constant('C', self._maker(cls))}({', '.join(parts)})"

    def _maker(self, cls: type[Message]) -> Callable[..., Any]:
        """Return the function that makes such a message, the same one each time."""
        return self.makers.setdefault(cls, maker(cls))

    def _field(self, kind: FieldType) -> str:
        if kind.shape != "one":
            return self._sequence(kind)
        if kind.message is not None:
            return self._message(kind.message)
        if kind.base in ("string", "wstring"):
            return self._string(kind)
        name = self.out.fresh("x")
        self.run.append((CODES[kind.base], name))
        return name

    def _string(self, kind: FieldType) -> str:
        count, name = self.out.fresh("k"), self.out.fresh("s")
        self.run.append(("I", count))
        self._flush()
        self._here()
        wide = kind.base == "wstring"
        self._span(f"{count} * 4" if wide else count)
        if wide:
            codecs.lookup("utf-16-le")  # a module, which a callback would import otherwise
            self.constants["narrow"] = narrow
            self.out.add(f"{name} = narrow(data[i:j], {self.order!r}); i = j")
        else:  # as rclpy: what is not UTF-8 is replaced, a NUL ends the text, and the last one may be missing
            text = f"{name} = data[i:j].decode({{}}).partition('\\0')[0]"
            self.out.add(f"try: {text.format('')}")
            self.out.add(f"except UnicodeDecodeError: {text.format(repr('utf-8') + ', ' + repr('replace'))}")
            self.out.add("i = j")
        return name  # of any length: ROS 2 checks the bound of a string neither when it writes nor when it reads

    def _sequence(self, kind: FieldType) -> str:
        count = str(kind.size)
        if kind.shape != "array":
            count = self.out.fresh("k")
            self.run.append(("I", count))
        self._flush()
        self._here()
        if kind.shape == "bounded":
            self.out.add(f"if {count} > {kind.size}: raise MessageError('over the bound')")
        if kind.code:
            return self._numbers(kind, count)
        return self._bools(count) if kind.base == "bool" else self._elements(kind, count)

    def _numbers(self, kind: FieldType, count: str) -> str:
        name, code = self.out.fresh("v"), kind.code or "d"
        size = SIZES[code]
        if kind.shape == "array":
            self._align(size, known_to=1)
            self._span(f"{size} * {count}")
            self._fixed(name, code, count)
            return name
        empty = self.out.constant("E", array(code))  # to copy an empty array is four times as fast as to make one
        self.out.add(f"{name} = {empty}[:]")
        self.out.add(f"if {count}:")
        self.out.depth += 1
        self._align(size, known_to=4)
        self._span(f"{size} * {count}" if size > 1 else count)
        if self.swap and size > 1:
            self.out.add(f"{name}.frombytes(data[i:j]); {name}.byteswap()")
        else:
            view = "memoryview(data)[i:j]" if code == "B" else f"memoryview(data)[i:j].cast({code!r})"
            self.out.add(f"if {count} >= {VIEW_FROM // size}: {name} = {view}")
            self.out.add(f"else: {name}.frombytes(data[i:j])")
        self.out.add("i = j")
        self.out.depth -= 1
        return name

    def _align(self, size: int, known_to: int) -> None:
        if size > known_to:
            self.out.add(f"i += 4 - i & {size - 1}")

    def _span(self, length: str) -> None:
        """Find the end, ``j``, of what begins at ``i``."""
        self.out.add(f"j = i + {length}")
        self.out.add("if j > end: raise MessageError('cut off')")

    def _fixed(self, name: str, code: str, count: str) -> None:
        import numpy as np

        native = np.dtype(DTYPES[code])
        wire = self.out.constant("D", native.newbyteorder() if self.swap else native)
        self.constants["frombuffer"] = np.frombuffer
        copied = f"astype({self.out.constant('D', native)})" if self.swap else "copy()"
        self.out.add(f"{name} = frombuffer(data, {wire}, {count}, i).{copied}; i = j")

    def _bools(self, count: str) -> str:
        name = self.out.fresh("v")
        self._span(count)
        self.out.add(f"{name} = [b != 0 for b in data[i:j]]; i = j")
        return name

    def _elements(self, kind: FieldType, count: str) -> str:
        """Read the elements one by one; each takes a byte at least, so a count beyond the data is refused at once."""
        name = self.out.fresh("v")
        self.out.add(f"if {count} > end - i: raise MessageError('cut off')")
        self.out.add(f"{name} = []")
        self.out.add(f"for _ in range({count}):")
        self.out.depth += 1
        one = FieldType(base=kind.base, message=kind.message, string_bound=kind.string_bound)
        made = self._field(one)
        self._flush()
        self._here()
        self.out.add(f"{name}.append({made})")
        self.out.depth -= 1
        return name

    def _first(self, codes: list[str], names: str) -> None:
        """Read the header and the first run at once, which is all of a message of fixed size."""
        body = padded(codes, 0, self.order)
        reader = struct.Struct(f"{self.order}H2x{body.format[1:]}")
        self.headed, self.at = True, reader.size
        self.out.add(f"head, {names}, = {self.out.constant('U', reader.unpack_from)}(data)")
        self.out.add(f"if head != {256 if self.order == '<' else 0}: return other(data)")

    def _here(self) -> None:
        """From here the index is only known at run time, in ``i``."""
        if self.at is not None:
            self.out.add(f"i = {self.at}; end = len(data)")
            self.at = None

    def _flush(self) -> None:
        if not self.run:
            return
        codes, names = [code for code, _ in self.run], ", ".join(name for _, name in self.run)
        self.run = []
        if self.at == 4:
            self._first(codes, names)
        elif self.at is not None:
            reader = padded(codes, (self.at - 4) % 8, self.order)
            self.out.add(f"{names}, = {self.out.constant('U', reader.unpack_from)}(data, {self.at})")
            self.at += reader.size
        else:
            structs = phases(codes, self.order, shift=4)
            table = self.out.constant("T", tuple((each.unpack_from, each.size) for each in structs))
            self.out.add(f"unpack, n = {table}[i & 7]; {names}, = unpack(data, i); i += n")


def narrow(units: bytes, order: str) -> str:
    """Read a wstring's characters; see `wide`. Raises MessageError for one beyond 16 bits, as ROS 2 does."""
    codes = struct.unpack(f"{order}{len(units) // 4}I", units)
    try:
        utf16 = struct.pack(f"<{len(codes)}H", *codes)
    except struct.error:
        raise MessageError("a wide character beyond 16 bits") from None
    return utf16.decode("utf-16-le", "replace")
