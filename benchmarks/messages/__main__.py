"""One process of a benchmark: an end of a ping-pong, of a flood, or both; `benchmarks/messages/running.py` starts it.

    python benchmarks/messages CONTENDER ROLE KIND [--seconds 0.5] [--core 0] [--variant NAME]

It writes "ready" once it can be talked to, then its figures as JSON.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from pathlib import Path

# This package is found beside this file, and robolink as Python finds it: perhaps in another checkout (PYTHONPATH).
sys.path[0] = str(Path(__file__).resolve().parents[2])
import benchmarks.messages  # noqa: E402, F401 - found only now, and for good

del sys.path[0]

from benchmarks.messages.games import Task  # noqa: E402


def pin(core: int) -> None:
    """Stay on one core, where the system can do that; below zero is any core."""
    if core >= 0 and hasattr(os, "sched_setaffinity") and (os.cpu_count() or 1) > 1:
        os.sched_setaffinity(0, {core})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("contender")
    parser.add_argument("role")
    parser.add_argument("kind")
    parser.add_argument("--seconds", type=float, default=0.5)
    parser.add_argument("--core", type=int, default=0)
    parser.add_argument("--variant", default="")
    parser.add_argument("--size", type=int, default=0)
    options = parser.parse_args()
    pin(options.core)
    module = importlib.import_module(f"benchmarks.messages.{options.contender}")
    getattr(module, options.role)(Task(options.kind, options.seconds, options.variant, options.size))


if __name__ == "__main__":
    main()
