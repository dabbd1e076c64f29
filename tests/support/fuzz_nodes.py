"""Fuzz of every shipped program by hand, each in a process of its own, whose memory is measured.

    python -m tests.support.fuzz_nodes --messages 100000

It ends with 1 if a program ended, hung, drove with NaN or grew by more than 10 MB.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import gc
import io
import json
import os
import subprocess
import sys
from typing import Any

from robolink.host import Host
from tests.support.fuzzed_programs import Fuzzed, programs
from tests.support.fuzzing import Attack, apart

WITHIN = 300.0
"""Seconds within which a program's fuzz by hand must end."""
ALLOWED_MB = 10.0


def memory() -> float:
    """Return the memory of this process in MB, after all garbage has gone."""
    import psutil

    gc.collect()
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
    return float(psutil.Process().memory_info().rss) / 1e6


def measured(fuzzed: Fuzzed, messages: int, seed: int) -> dict[str, Any]:
    """Fuzz one program, and return what came of it with the growth of memory over its last three quarters."""
    attack = Attack(fuzzed, seed)
    with apart(), Host(seed=seed) as host:
        attack.begin(host)
        attack.go_on(messages // 4)
        before = memory()
        attack.go_on(messages - messages // 4)
        grown = memory() - before
    return {"name": fuzzed.name, **attack.outcome._asdict(), "grown": round(grown, 1)}


def _say(text: str) -> None:
    print(text, flush=True)  # noqa: T201 - that is what the command is for


def _started(name: str, messages: int, seed: int) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "tests.support.fuzz_nodes", "--one", name, "--seed", str(seed)]
    command += ["--messages", str(messages)]
    # Freed memory that glibc keeps in an arena for each thread is not a leak.
    environment = {**os.environ, "MALLOC_ARENA_MAX": "1"}
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def _read(process: subprocess.Popen[str], name: str) -> dict[str, Any]:
    try:
        out, errors = process.communicate(timeout=WITHIN)
        return dict(json.loads(out.splitlines()[-1]))
    except subprocess.TimeoutExpired:
        process.kill()
        out, errors = process.communicate()
        last = f"it hung: no end within {WITHIN:g} s\n{errors[-2000:]}"
    except (ValueError, IndexError):
        last = f"the process ended with {process.returncode}\n{errors[-2000:]}"
    return {"name": name, "sent": 0, "calls": 0, "grown": 0.0, "slowest": 0.0, "starts": 0, "ended": [[last, []]]}


def _shown(told: dict[str, Any]) -> bool:
    """Print the line of a program; return whether all is well."""
    bad = bool(told["ended"]) or told["grown"] > ALLOWED_MB
    numbers = " ".join(f"{key}={told[key]}" for key in told if key not in ("name", "ended"))
    _say(f"{'FAIL' if bad else 'ok':4} {told['name']}: {numbers}")
    for error, last in told["ended"]:
        _say("    " + error.replace("\n", "\n    "))
        for each in last:
            _say(f"      after {each[:400]}")
    return not bad


def main() -> int:
    """Fuzz all programs, or some; return 1 if one ended, hung or grew."""
    parser = argparse.ArgumentParser("fuzz_nodes", description="Fuzz every shipped program in virtual time.")
    parser.add_argument("names", nargs="*", help="programs; all by default")
    parser.add_argument("--messages", type=int, default=100_000, help="messages and calls over all of them")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--one", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    known = {each.name: each for each in programs()}
    if chosen.one:
        with contextlib.redirect_stdout(io.StringIO()):
            told = measured(known[chosen.one], chosen.messages, chosen.seed)
        _say(json.dumps(told))
        return 0
    names = chosen.names or list(known)
    each = -(-chosen.messages // len(names))
    results = []
    good = []
    for name in names:
        results.append(_read(_started(name, each, chosen.seed), name))
        good.append(_shown(results[-1]))
    total = sum(told["sent"] + told["calls"] for told in results)
    _say(f"{total} messages and calls to {len(names)} programs, {good.count(False)} of them ended, hung or grew")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
