"""Code generator of encoders: one `struct` call a run, one buffer for each array."""

from __future__ import annotations

import codecs
import keyword
import struct
from array import array
from collections import Counter
from typing import Any

from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.cdr_layout import CODES, SIZES, Lines, padded, phases
from robolink.message.convert import bools, fixed, instance

PADS = tuple(bytes(n) for n in range(8))


class WriterSource:
    """Source text of ``run(m) -> bytes``; `phase` is the offset mod 8 where it is known, else None and in ``o``.

    With `apart` it returns a tuple or list of buffers instead, which follow each other.
    """

    def __init__(self, cls: type[Message], *, apart: bool = False) -> None:
        self.apart = apart
        self.out = Lines()
        self.constants: dict[str, Any] = self.out.constants
        self.constants.update(PADS=PADS, array=array, bools=bools, fixed=fixed, instance=instance)
        self.phase: int | None = 0
        self.run: list[tuple[str, str]] = []
        self.chunks = 0
        self.joined: list[str] | None = None if _has_loops(cls) else []
        self.loops: list[str] = []
        """Lines of the functions that write sequences of messages which the type has several times."""
        self._loop_of: dict[type[Message], str] = {}
        self._several = {each for each, count in Counter(_elements_of(cls)).items() if count > 1}
        self._fields(cls, "m")  # whoever encodes has chosen the function by the message's class

    def text(self) -> str:
        """Return the source text of the function."""
        if not self.chunks and self.phase == 0:  # all of it has a fixed size: one call, no list of parts
            codes, values = [code for code, _ in self.run], ", ".join(value for _, value in self.run)
            packer = self.out.constant("S", padded_with_head(codes))
            made = f"{packer}(HEAD, {values})"
            self.out.add(f"return ({made},)" if self.apart else f"return {made}")
        else:
            self._flush()
            parts = "parts" if self.joined is None else f"(HEAD, {', '.join(self.joined)})"
            self.out.add(f"return {parts}" if self.apart else f"return b''.join({parts})")
        start = ["def run(m):", "    try:"]
        if self.chunks and self.joined is None:
            start.append("        parts = [HEAD]; p = parts.append")
        end = ["    except Exception as error:", "        raise fail(m, error) from None"]
        return "\n".join([*self.loops, *start, *self.out.lines, *end])

    def _message(self, cls: type[Message], path: str) -> None:
        made = self.out.constant("C", cls)
        self.out.add(f"if {path}.__class__ is not {made}: instance({path}, {made})")
        self._fields(cls, path)

    def _fields(self, cls: type[Message], path: str) -> None:
        if not cls.__ros_fields__:
            self.run.append(("B", "0"))
        for name, kind in cls.__ros_fields__.items():
            if kind.code and kind.shape != "one":
                self._numbers(kind, cls.__dict__[name], path)
            else:
                # rosidl allows a field `from` or `class`; rclpy cannot read such messages.
                self._field(kind, f"getattr({path}, {name!r})" if keyword.iskeyword(name) else f"{path}.{name}")

    def _field(self, kind: FieldType, value: str) -> None:
        if kind.shape != "one":
            self._sequence(kind, value)
        elif kind.message is not None:
            self._nested(kind.message, value)
        elif kind.base in ("string", "wstring"):
            self._string(kind, value)
        else:
            self._primitive(kind.base, value)

    def _nested(self, cls: type[Message], value: str) -> None:
        name = value
        if not value.isidentifier():
            name = self.out.fresh("n")
            self.out.add(f"{name} = {value}")
        self._message(cls, name)

    def _primitive(self, base: str, value: str) -> None:
        if base == "bool":  # struct packs any object's truth; only bools (0 and 1, numpy's) are meant
            name = self.out.fresh("b")
            self.out.add(f"{name} = {value}")
            value = f"({name} if {name} is True or {name} is False else bools(({name},))[0])"
        self.run.append((CODES[base], value))

    def _string(self, kind: FieldType, value: str) -> None:
        name, text = self.out.fresh("s"), self.out.fresh("t")
        self.out.add(f"{text} = {value}")
        self._bounded(f"len({text})", kind.string_bound)
        if kind.base == "wstring":
            codecs.lookup("utf-16-le")  # a module, which a callback would import otherwise
            self.out.add(f"{name} = wide({text})")
            self.constants["wide"] = wide
            self.run.append(("I", f"len({name}) >> 2"))
        else:  # in ROS 2 a NUL ends the text
            self.out.add(f"if '\\0' in {text}: {text} = {text}.partition('\\0')[0]")
            self.out.add(f"{name} = {text}.encode() + b'\\0'")
            self.run.append(("I", f"len({name})"))
        self._flush()
        self._chunk(name, f"len({name})")

    def _bounded(self, length: str, bound: int) -> None:
        if bound:
            self.out.add(f"if {length} > {bound}: raise ValueError('over the bound')")

    def _sequence(self, kind: FieldType, value: str) -> None:
        name = self.out.fresh("v")
        self.out.add(f"{name} = {value}")
        self.out.add(f"if isinstance({name}, str): raise TypeError('a string is not a sequence')")
        if kind.shape == "array":
            self.out.add(f"fixed({name}, {kind.size})")
        else:
            self._bounded(f"len({name})", kind.size)
            self.run.append(("I", f"len({name})"))
        self._flush()
        if kind.base == "bool":
            self._chunk(f"bools({name})", f"len({name})")
        else:
            self._elements(kind, name)

    def _numbers(self, kind: FieldType, field: Any, path: str) -> None:
        """Write a buffer as it is. Behind a count everything is aligned to 4; only wider elements may need padding."""
        name, size = self.out.fresh("v"), SIZES[field.code]
        stored, converted = self.out.constant("G", field.stored), self.out.constant("F", field.packable)
        if kind.shape == "array":
            self.out.add(f"{name} = {converted}({path})")
            self._flush()
            self._align(size, "", known_to=1)
            self._chunk(name, size * kind.size)
            return
        self.out.add(f"{name} = {stored}({path})")
        self.out.add(f"if type({name}) is not array or {name}.typecode != {field.code!r}: {name} = {converted}({path})")
        self._bounded(f"len({name})", kind.size)
        self.run.append(("I", f"len({name})"))
        self._flush()
        self._align(size, f" if {name} else 0", known_to=4)
        self._chunk(name, f"{size} * len({name})")

    def _align(self, size: int, condition: str, known_to: int) -> None:
        if size <= known_to:
            return
        if self.phase is not None and not condition:
            pad = -self.phase % size
            if pad:
                self._part(f"PADS[{pad}]")
            self.phase = (self.phase + pad) % 8
            return
        self._at_run_time()
        self.out.add(f"n = -o & {size - 1}{condition}; o += n")
        self._part("PADS[n]")

    def _elements(self, kind: FieldType, name: str) -> None:
        """Write one element after the other: messages, strings, bytes."""
        self._at_run_time()
        if kind.message in self._several:
            self.out.add(f"o = {self._loop(kind, kind.message)}(p, o, {name})")
        else:
            self._in_a_loop(kind, name)

    def _loop(self, kind: FieldType, cls: type[Message]) -> str:
        """Return the function that writes messages of a class: compiling it at each place took a node's start 2 ms."""
        if cls not in self._loop_of:
            function = self._loop_of[cls] = self.out.fresh("w")
            lines, depth, self.out.lines, self.out.depth = self.out.lines, self.out.depth, [], 1
            self._in_a_loop(kind, "v")
            self.loops += [f"def {function}(p, o, v):", *self.out.lines, "    return o"]
            self.out.lines, self.out.depth = lines, depth
        return self._loop_of[cls]

    def _in_a_loop(self, kind: FieldType, name: str) -> None:
        element = self.out.fresh("e")
        self.out.add(f"for {element} in {name}:")
        self.out.depth += 1
        one = FieldType(base=kind.base, message=kind.message, string_bound=kind.string_bound)
        self._field(one, element)
        self._flush()
        self._at_run_time()
        self.out.depth -= 1

    def _at_run_time(self) -> None:
        """From here the phase is only known at run time."""
        self.chunks += 1
        if self.phase is not None:
            self.out.add(f"o = {self.phase}")
            self.phase = None

    def _chunk(self, value: str, length: str | int) -> None:
        self._part(value)
        if self.phase is not None and isinstance(length, int):
            self.phase = (self.phase + length) % 8
        elif self.phase is not None:
            self.out.add(f"o = {self.phase} + {length} & 7")
            self.phase = None
        else:
            self.out.add(f"o = o + {length} & 7")

    def _part(self, value: str) -> None:
        """Add bytes to the result: to the list of parts, or by name to what is joined in the end."""
        self.chunks += 1
        if self.joined is None:
            self.out.add(f"p({value})")
        elif value.isidentifier():
            self.joined.append(value)
        else:
            self.joined.append(self.out.fresh("c"))
            self.out.add(f"{self.joined[-1]} = {value}")

    def _flush(self) -> None:
        if not self.run:
            return
        codes, values = [code for code, _ in self.run], ", ".join(value for _, value in self.run)
        self.run = []
        if self.phase is not None:
            packer = padded(codes, self.phase, "<")
            self._part(f"{self.out.constant('S', packer.pack)}({values})")
            self.phase = (self.phase + packer.size) % 8
            return
        packers = phases(codes, "<")
        ends = {(at + packer.size) % 8 for at, packer in enumerate(packers)}
        if len(ends) == 1:  # behind eight bytes that are aligned, wherever they began
            self._part(f"{self.out.constant('T', tuple(each.pack for each in packers))}[o]({values})")
            self.phase = ends.pop()
            return
        table = self.out.constant("T", tuple((each.pack, each.size) for each in packers))
        self.out.add(f"pack, n = {table}[o]; o = o + n & 7")
        self._part(f"pack({values})")


def _has_loops(cls: type[Message]) -> bool:
    """True if there are sequences whose elements are packed one by one."""
    return any(
        (kind.shape != "one" and not kind.code and kind.base != "bool")
        or (kind.message is not None and _has_loops(kind.message))
        for kind in cls.__ros_fields__.values()
    )


def _elements_of(cls: type[Message]) -> list[type[Message]]:
    """Return the classes of the messages in sequences, once for each sequence."""
    found = []
    for kind in cls.__ros_fields__.values():
        if kind.message is not None:
            found += [*([kind.message] if kind.shape != "one" else []), *_elements_of(kind.message)]
    return found


def padded_with_head(codes: list[str]) -> Any:
    """Return the function that packs the header and a whole message of fixed size in one call."""
    body = padded(codes, 0, "<")
    return struct.Struct("<4s" + body.format[1:]).pack


def wide(text: str) -> bytes:
    """Encode a wstring: UTF-16 code units, each in four bytes, and no NUL behind them.

    So ROS 2 writes it (rosidl_typesupport_fastrtps_cpp's serialization_helpers.hpp in Jazzy; Fast-CDR 1.0 itself in
    Humble), though DDS-XTypes now has two bytes for each.
    """
    units = text.encode("utf-16-le")
    count = len(units) // 2
    return struct.pack(f"<{count}I", *struct.unpack(f"<{count}H", units))
