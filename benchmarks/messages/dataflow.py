"""Games of dora's nodes: `dora run` starts both ends, and their lines are read from files."""

from __future__ import annotations

import json
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from benchmarks.messages.running import Contender, Flood, GameError, environment, flooded, words

FLOW = """
nodes:
  - id: first
    path: "{python}"
    args: "{first}"
    inputs: {{ball: {{source: second/ball, queue_size: {depth}}}}}
    outputs: [ball]
    env: {{BENCH_LINES: "{folder}/first"}}
  - id: second
    path: "{python}"
    args: "{second}"
    inputs: {{ball: {{source: first/ball, queue_size: {depth}}}, tick: dora/timer/millis/10}}
    outputs: [ball]
    env: {{BENCH_LINES: "{folder}/second"}}
"""
"""`first` answers or counts, `second` measures or sends."""
PATIENCE = 30.0
DEPTH = 10


@contextmanager
def dataflow(contender: Contender, first: str, second: str, kind: str, seconds: float) -> Iterator[Path]:
    """Run a dataflow until the block has been left; gives the folder of its lines."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        ends = {
            end: " ".join(word or "-" for word in words(contender, role, kind, seconds, core))
            for end, role, core in (("first", first, 1), ("second", second, 0))
        }
        depth = int(contender.variant.removeprefix("depth-") or DEPTH)
        text = FLOW.format(python=contender.python, folder=folder, depth=depth, **ends)
        if second != "beat":
            text = text.replace(", tick: dora/timer/millis/10", "")
        (folder / "flow.yaml").write_text(text, encoding="utf-8")
        with (folder / "log").open("w") as log:
            command = [str(Path(contender.python).with_name("dora")), "run", str(folder / "flow.yaml")]
            started = subprocess.Popen(
                command,
                cwd=folder,
                env=environment(contender, first=False),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )
        try:
            yield folder
            started.wait(PATIENCE)  # its nodes end with it only if it ends by itself
        finally:
            started.kill()
            started.wait()


def line(file: Path) -> Any:
    """Wait for the line of an end, and return it. Raises GameError if none comes."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        text = file.read_text(encoding="utf-8") if file.exists() else ""
        if text.endswith("\n"):
            return json.loads(text)
        time.sleep(0.02)
    raise GameError(f"dora's {file.name} node did not say a word")


def trips(contender: Contender, kind: str, seconds: float) -> list[float]:
    """Return a game's round trips in microseconds."""
    with dataflow(contender, "pong", "ping", kind, seconds) as folder:
        return list(line(folder / "second"))


def flood(contender: Contender, kind: str, seconds: float) -> Flood:
    """One node sends for so long as fast as it goes, and another counts."""
    with dataflow(contender, "sink", "source", kind, seconds) as folder:
        return flooded(line(folder / "second"), line(folder / "first"))


def beat(contender: Contender, kind: str, seconds: float) -> float:
    """Return the share of a core that a node takes which sends a hundred messages a second to another."""
    with dataflow(contender, "sink", "beat", kind, seconds) as folder:
        return float(line(folder / "second"))
