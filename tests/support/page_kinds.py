"""Kinds of blocks that are no commands: a program or test that is run, a file that robolink reads, or text."""

from __future__ import annotations

import ast
import json
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import yaml
import zenoh

from tests.support.commands import ROBOLINK
from tests.support.page_shell import PROGRAMS
from tools.docs_site.markdown import Block

LAUNCH, WORLD, FAULTS = (
    {"nodes", "include", "groups"},
    {"robots", "walls", "obstacles", "paint"},
    {"messages", "crashes"},
)


def program_for(block: Block, folder: Path) -> tuple[str, ...]:
    """Return the program that runs or checks a block, which may be written to a file for it; () if there is none."""
    if block.language == "python":
        if "\ndef test_" in f"\n{block.text}":
            return (*PROGRAMS["pytest"], str(_written(block, folder / f"test_line_{block.line}.py")))
        if imports_ros(block.text):
            return (*ROBOLINK, "run", str(_written(block, folder / f"line_{block.line}.py")))
        return (sys.executable, "-c", block.text)
    if block.language != "yaml":
        return ()
    keys = set(yaml.safe_load(block.text))
    file = folder / f"line_{block.line}.yaml"
    if keys & LAUNCH:
        return (*ROBOLINK, "launch", str(_written(block, file)), "--validate")
    if keys & WORLD:
        return (*ROBOLINK, "world", "check", str(_written(block, file)))
    if keys & FAULTS:
        return (*ROBOLINK, "simulate", "follow", "--duration", "0.1", "--faults", str(_written(block, file)))
    return ()


def imports_ros(text: str) -> bool:
    """Return True if a program imports what Python has not got, such as rclpy: `robolink run` has it."""
    names: set[str] = set()
    for each in ast.walk(ast.parse(text)):
        if isinstance(each, ast.Import):
            names |= {alias.name for alias in each.names}
        elif isinstance(each, ast.ImportFrom) and each.module:
            names.add(each.module)
    tops = {each.partition(".")[0] for each in names} - sys.stdlib_module_names
    return "robolink.compat" not in names and any(PathFinder.find_spec(each) is None for each in tops)


def _written(block: Block, file: Path) -> Path:
    file.write_text(block.text, encoding="utf-8")
    return file


def read(block: Block) -> Any:
    """Read a block as its language has it."""
    match block.language:
        case "python":
            return ast.parse(block.text)
        case "yaml":
            return list(yaml.safe_load_all(block.text))
        case "json":
            return json.loads(block.text)
        case "json5":
            return zenoh.Config.from_json5(block.text)
        case "xml":
            return ElementTree.fromstring(block.text)
        case language:
            assert language in ("text", ""), f"nobody knows how to run '{language}'"
            return block.text
