"""Commands that look, ask or convert, run in the process of the test: each saves the start of a Python.

Everything that goes on, or runs programs of others, is a process of its own, as on a reader's machine.
"""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple
from unittest import mock

from robolink.cli.main import main
from tests.support.commands import Line

VERBS = {
    "bag": {"info", "convert", "reindex"},
    "launch": set[str](),
    "network": set[str](),
    "node": {"list", "info"},
    "param": {"list", "get", "set", "describe"},
    "security": {"create_keystore", "create_enclave", "create_permission", "list_enclaves"},
    "service": {"list", "call", "type"},
    "topic": {"list", "info", "type"},
    "world": {"list", "check", "schema"},
}
"""Nouns, and their verbs that are run here; an empty set stands for what `LOOKS` has."""
LOOKS = {"--validate", "--graph", "--schema", "--show-args", "--list", "limit"}


class Ended(NamedTuple):
    """A command that has ended, and what it has said."""

    code: int
    lines: list[Line]


def is_for_here(words: list[str]) -> bool:
    """Return True if a command's words after `robolink` are of one that can run here."""
    if not words or words[0] not in VERBS:
        return False
    return bool(VERBS[words[0]] & set(words[1:2]) if VERBS[words[0]] else LOOKS & set(words))


def run_here(words: list[str], folder: Path, domain: int, variables: Mapping[str, str]) -> Ended:
    """Run a command of robolink in this process, in a folder, with more variables; its errors are among its lines."""
    said = io.StringIO()
    environ = {**variables, "ROS_DOMAIN_ID": str(domain), "NO_COLOR": "1"}
    outputs = (contextlib.redirect_stdout(said), contextlib.redirect_stderr(said))
    with mock.patch.dict(os.environ, environ), _folder(folder), outputs[0], outputs[1]:
        code = main(words)
    return Ended(code, [Line(0.0, each) for each in said.getvalue().splitlines()])


@contextlib.contextmanager
def _folder(folder: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
