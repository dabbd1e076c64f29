"""Benchmark of messages: round trips, throughput and codec, each beside bare zenoh-python and other peers, by turns.

    python benchmarks/messaging.py                            # all rows, without peers: some five minutes
    python benchmarks/messaging.py --only twist               # one row: twenty seconds
    python benchmarks/messaging.py --only 1mb --seconds 0.3 --with bare,same,spin
    python benchmarks/messaging.py --only scan --beside ../other/checkout    # two versions of robolink by turns
    python benchmarks/messaging.py --all                      # with every variant, and the peers that are installed

Rows: `twist`, `scan`, `1mb` and `6mb` are round trips; `flood-stamped`, `flood-scan`, `flood-1mb` and `flood-6mb` are
what is received in a second; `inside` is 6.2 MB within one process; `call` is a service's answer, by a querier of bare
Zenoh, by `call_async` and `spin_until_future_complete`, and by `client.call`; `codec` is the time to encode and decode.

Two fresh processes play, one pinned to each of two cores (but for `--free`), and contenders take turns: figures of one
machine at one moment mean little, ratios of such turns carry over. `bare` does the least that a program can do with a
message: it takes its bytes and sends some; large ones are made anew each time (`same` sends the same object again,
`echo` what has come; `handed` has each handed to its main thread by a queue). Its session has robolink's settings.
`spin` and `once` are robolink's nodes by `spin`, and by `spin_once` in a loop, `threads` by a MultiThreadedExecutor; in
`loop` one of them sends between two calls of `spin_once`. All look at an image's pixels. What ends in `-` has shared
memory switched off, which ROBOLINK_SHARED_MEMORY=off does for all. ROBOLINK_NETWORK=tcp/HOST:PORT plays by a router.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import json
import os
import statistics
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parent.parent))

from benchmarks.messages import running
from benchmarks.messages.running import Contender, Flood, GameError, flood, inside, round_trips

BARE = Contender("bare", "bare")
SAME = Contender("same", "bare", "same")
HANDED = Contender("handed", "bare", "handed")
SPIN = Contender("spin", "nodes", "spin")
ONCE = Contender("once", "nodes", "once")
THREADS = Contender("threads", "nodes", "threads")
LOOP = Contender("loop", "nodes", "loop")
VARIANTS = (
    Contender("echo", "bare", "echo"),
    Contender("bare-", "bare", shared_memory=False),
    Contender("spin-", "nodes", "spin", shared_memory=False),
)
PEERS = (
    Contender("sdk", "ros2_sdk", needs="zenoh_ros2_sdk"),
    Contender("zeromq", "zeromq", needs="zmq"),
)

TRIPS = ("twist", "scan", "1mb", "6mb")
FLOODS = ("flood-stamped", "flood-scan", "flood-1mb", "flood-6mb")
ROWS = (*TRIPS, *FLOODS, "inside", "call", "codec")
LARGE = ("1mb", "6mb")
CALLS = (
    Contender("querier", "calls", "querier"),
    Contender("future", "calls", "future"),
    Contender("call", "calls", "call"),
)
INSIDE = (
    Contender("copy", "nodes"),
    Contender("memory", "nodes", "memory"),
    Contender("zenoh", "nodes", "zenoh"),
)
"""In one process: a copy of the bytes alone, and a message by each transport."""


def contenders(row: str, chosen: argparse.Namespace) -> list[Contender]:
    """Contenders of a row; the first is what the others are compared with."""
    is_flood, kind = row.startswith("flood-"), row.removeprefix("flood-")
    found = [BARE, *([SAME] if kind in LARGE else []), SPIN, *([] if is_flood else [ONCE])]
    if chosen.all:
        found += [THREADS, *([] if is_flood else [LOOP]), *([] if is_flood or row in LARGE else [HANDED])]
        found += [each for each in VARIANTS if kind in LARGE and not (is_flood and each.variant == "echo")]
        found += [each for each in PEERS if importlib.util.find_spec(each.needs)]
    if chosen.names:
        known = {each.name: each for each in (BARE, SAME, HANDED, SPIN, ONCE, THREADS, LOOP, *VARIANTS, *PEERS)}
        found = [known[name] for name in chosen.names]
    return found + beside([each for each in found if each.module == "nodes"], chosen)


def beside(players: Sequence[Contender], chosen: argparse.Namespace) -> list[Contender]:
    """The same contenders with the robolink of `--beside`; none without that."""
    path = chosen.beside and str(Path(chosen.beside).resolve())
    return [each._replace(name=f"{each.name}*", path=path) for each in players] if path else []


def rounds_of(players: Sequence[Contender], rounds: int, play: Callable[[Contender], Any]) -> dict[str, list[Any]]:
    """Run all contenders by turns; a contender that fails is left out from then on, with a line."""
    figures: dict[str, list[Any]] = {each.name: [] for each in players}
    failed = set()
    for _ in range(rounds):
        for each in players:
            if each.name in failed:
                continue
            try:
                figures[each.name].append(play(each))
            except GameError as error:
                print(f"  {each.name}: {error}")
                failed.add(each.name)
    return {name: found for name, found in figures.items() if found and name not in failed}


def spread(figures: Sequence[float]) -> str:
    return f"{min(figures):,.0f}-{max(figures):,.0f}"


def show_trips(row: str, chosen: argparse.Namespace) -> dict[str, Any]:
    """Print round trips in microseconds, and how many times those of the first each takes."""
    found = rounds_of(contenders(row, chosen), chosen.rounds, lambda each: round_trips(each, row, chosen.seconds))
    print(f"{row}: round trip, us, median of {chosen.rounds} rounds (least and most), and ratio to the first")
    return show(found)


def show(found: dict[str, list[float]]) -> dict[str, Any]:
    """Print medians, their spread, and their ratio to the first."""
    medians = {name: statistics.median(each) for name, each in found.items()}
    first = next(iter(medians.values()), 0.0)
    for name, median in medians.items():
        print(f"  {name:10} {median:12,.1f}  ({spread(found[name])})  {median / first:6.2f}")
    return {name: {"median": medians[name], "rounds": found[name]} for name in found}


def show_flood(row: str, chosen: argparse.Namespace) -> dict[str, Any]:
    """Print the messages received in a second and lost, and the share of the first."""
    kind = row.removeprefix("flood-")
    found: dict[str, list[Flood]] = rounds_of(
        contenders(row, chosen), chosen.rounds, lambda each: flood(each, kind, chosen.seconds)
    )
    print(
        f"{row}: received a second, median of {chosen.rounds} rounds (least and most), share of the first's, and lost"
    )
    rates = {name: [each.rate for each in rounds] for name, rounds in found.items()}
    lost = {name: statistics.median(each.lost for each in rounds) for name, rounds in found.items()}
    medians = {name: statistics.median(each) for name, each in rates.items()}
    first = next(iter(medians.values()), 0.0)
    for name, median in medians.items():
        share = median / first if first else 0.0
        print(f"  {name:10} {median:12,.0f}  ({spread(rates[name])})  {share:6.2f}   {lost[name]:6.1%} lost")
    return {name: {"median": medians[name], "rounds": rates[name], "lost": lost[name]} for name in found}


def show_inside(_: str, chosen: argparse.Namespace) -> dict[str, Any]:
    """Print how long 6.2 MB take from `publish` to the callback of the same process."""

    def play(each: Contender) -> float:
        return inside(each, "inside" if each.variant else "copies", "6mb", chosen.seconds)

    print(f"inside: 6.2 MB in one process, publish to callback, us, median of {chosen.rounds} rounds")
    return show(rounds_of([*INSIDE, *beside(INSIDE[1:], chosen)], chosen.rounds, play))


def show_calls(_: str, chosen: argparse.Namespace) -> dict[str, Any]:
    """Print how long a service call takes, and how many times that of Zenoh's querier."""
    players = [*CALLS, *beside(CALLS[1:], chosen)]
    print(f"call: a service's answer, us, median of {chosen.rounds} rounds (least and most), and ratio to the first")
    return show(rounds_of(players, chosen.rounds, lambda each: round_trips(each, "twist", chosen.seconds)))


def show_codec(_: str, chosen: argparse.Namespace) -> dict[str, Any]:
    """Print microseconds out and in."""
    from benchmarks.messages.codec import codec

    print("codec, us              out      in     out + in, against msgspec")
    figures = {kind: codec(kind) for kind in ("twist", "scan")}
    for kind, found in figures.items():
        base = sum(found["msgspec"])
        for peer, (out, back) in found.items():
            print(f"  {kind:10} {peer:9} {out:6.2f}  {back:6.2f}     {(out + back) / base:.2f}")
    return figures


def conditions() -> str:
    """Use of shared memory by Zenoh, on which the speed of large messages depends, and why it is used or not."""
    enabled = json.loads(running.prepared()["first"])["transport"]["shared_memory"]["enabled"]
    with contextlib.suppress(ImportError):  # a robolink that leaves it to Zenoh
        from robolink.transport import shared_memory

        return f"shared memory {'on' if enabled else 'off'}: {shared_memory.decision(os.environ).reason}"
    return f"shared memory {'asked for' if enabled else 'off'}"


def options(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", choices=ROWS, help="a row; may be given several times")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=0.5, help="length of a game, of which there are many")
    parser.add_argument("--with", dest="names", type=lambda text: text.split(","), help="contenders, by name")
    parser.add_argument("--all", action="store_true", help="every variant, and the peers that are installed")
    parser.add_argument("--free", action="store_true", help="do not keep each end on its own core")
    parser.add_argument("--beside", help="folder of another robolink that plays too; its names end in *")
    parser.add_argument("--json", type=Path, help="file to which all figures are written as well")
    return parser.parse_args(arguments)


def main() -> None:
    chosen, figures = options(), {}
    running.PIN = not chosen.free
    print(conditions())
    for row in chosen.only or ROWS:
        show_row: Callable[[str, argparse.Namespace], dict[str, Any]]
        special = {"inside": show_inside, "call": show_calls, "codec": show_codec}
        show_row = special.get(row, show_flood if row in FLOODS else show_trips)
        figures[row] = show_row(row, chosen)
        sys.stdout.flush()
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
