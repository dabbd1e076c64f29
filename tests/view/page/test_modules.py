"""Modules of the page in node: cdr.js with messages that robolink encoded, to the same bytes; and pure ones."""

from __future__ import annotations

import base64
import json
import math
import os
import random
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Annotated, Any

import pytest

from robolink.bag.topic import message_definition
from robolink.interfaces import find, names
from robolink.message import AtMost, Message, Sequence, Size, encode, float64, int8, string, to_builtins, uint8, wstring
from tests.support.filled import filled

NODE = shutil.which("node")
HERE = Path(__file__).parent
MESSAGES = 4

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(NODE is None, reason="node is not installed, which runs the page's modules without a browser"),
]


class Nothing(Message):
    """No fields."""


class Bounded(Message):
    """Bounds, wide text, defaults, and messages without fields between numbers."""

    before: uint8 = 7
    wide: wstring
    wides: Annotated[Sequence[wstring], AtMost(2)]
    nothing: Nothing
    number: float64 = 0.5
    short: Annotated[string, AtMost(24)] = 'a "#" and \\ b'
    pair: Annotated[Sequence[string], Size(2)]
    nothings: Annotated[Sequence[Nothing], Size(3)]
    few: Annotated[Sequence[int8], AtMost(3)]
    last: float64


def classes() -> list[Any]:
    """Every standard message, the parts of services, and the one above."""
    services: list[Any] = [find(name, "srv") for name in names("srv")]
    parts = [part for each in services for part in (each.Request, each.Response)]
    return [*(find(name) for name in names("msg")), *parts, Nothing, Bounded]


def case(cls: Any, dice: random.Random) -> dict[str, Any]:
    """A type's text, some messages as bytes and as JSON, and the bytes of its defaults."""
    messages = [filled(cls, dice) for _ in range(MESSAGES)]
    return {
        "name": cls.__ros_type__,
        "schema": message_definition(cls),
        "messages": [[text(encode(each)), None, plain(to_builtins(each))] for each in messages],
        "zero": text(encode(cls())),
    }


def big_endian() -> dict[str, Any]:
    """A message whose big-endian bytes are written here by hand."""
    layout = "HxxI f4xd Iid I5s7x q"
    values = (258, 70_000, 0.5, -2.25, 1, -3, 1e9, 5, b"four\0", -(2**53))
    schema = "uint16 a\nuint32 b\nfloat32 c\nfloat64 d\nint32[] e\nfloat64[1] f\nstring g\nint64 h\n"
    told = [258, 70_000, 0.5, -2.25, [-3], [1e9], "four", str(-(2**53))]
    little, big = (
        bytes((0, flag, 0, 0)) + struct.pack(order + layout, *values) for order, flag in (("<", 1), (">", 0))
    )
    zero = bytes((0, 1, 0, 0)) + struct.pack("<HxxIf4xdI4xdIB3xq", 0, 0, 0, 0, 0, 0, 1, 0, 0)
    value = dict(zip("abcdefgh", told, strict=True))
    return {"name": "x/msg/Ends", "schema": schema, "messages": [[text(little), text(big), value]], "zero": text(zero)}


def text(data: bytes) -> str:
    return base64.b64encode(data).decode()


def plain(value: Any) -> Any:
    """JSON that JavaScript reads exactly: integers beyond 53 bits and numbers that JSON lacks are texts."""
    if isinstance(value, dict):
        return {name: plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, int) and abs(value) >= 2**53:
        return str(value)
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    return value


def test_the_page_s_codec_reads_and_writes_what_robolink_does(tmp_path: Path) -> None:
    dice = random.Random(15)
    cases = tmp_path / "cases.json"
    cases.write_text(json.dumps([big_endian(), *(case(each, dice) for each in classes())]), encoding="utf-8")
    run("cdr.test.mjs", CDR_CASES=str(cases))


def test_the_page_s_pure_modules() -> None:
    run("modules.test.mjs")


def run(name: str, **environment: str) -> None:
    """Run a file of tests in node."""
    assert NODE is not None
    command = [NODE, "--test", str(HERE / name)]
    done = subprocess.run(
        command, env={**os.environ, **environment}, capture_output=True, text=True, timeout=110, check=False
    )
    assert done.returncode == 0, "\n".join(_failures(done.stdout))


def _failures(report: str) -> list[str]:
    """The first failures of node's report."""
    lines = report.splitlines()
    failed = [at for at, line in enumerate(lines) if line.startswith("not ok")]
    return [line for at in failed[:5] for line in lines[at : at + 25]]
