"""robolink bag play: its arguments and their checks."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from robolink.cli.bag import options as shared
from robolink.cli.bag import play_options as opt
from robolink.cli.shared.noun import ListedOptions
from robolink.cli.shared.options import Enclave

if TYPE_CHECKING:
    from robolink.bag.playing import PlaySettings

CLOCK, CLOCK_RATE = "--clock", "40"
FAR = 1e12
"""Seconds beyond every time of a bag."""
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


class PlayCommand(ListedOptions):
    """Command with options that take several values, and `--clock`, whose value may be left out."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments."""
        return super().parse_args(ctx, with_clock_rate(args))


def with_clock_rate(args: Sequence[str]) -> list[str]:
    """Return the arguments with 40 Hz behind a `--clock` that no number follows.

    >>> with_clock_rate(["walk", "--clock", "-l"])
    ['walk', '--clock', '40', '-l']
    """
    found: list[str] = []
    for index, (each, following) in enumerate(zip(args, [*args, ""][1:], strict=True)):
        if each == "--":
            return [*found, *args[index:]]
        found.append(each)
        if each == CLOCK and not _NUMBER.fullmatch(following):
            found.append(CLOCK_RATE)
    return found


def play(
    ctx: typer.Context,
    words: opt.Bags = None,
    inputs: opt.Inputs = None,
    storage: shared.KnownStorage = "",
    rate: opt.Rate = 1.0,
    topics: opt.Topics = None,
    services: opt.Services = None,
    actions: opt.Actions = None,
    regex: opt.Regex = "",
    exclude_regex: opt.ExcludeRegex = "",
    exclude_topics: opt.ExcludeTopics = None,
    exclude_services: opt.ExcludeServices = None,
    exclude_actions: opt.ExcludeActions = None,
    qos_overrides: shared.Overrides = "",
    loop: opt.Loop = False,
    remap: opt.Remap = None,
    clock: opt.ClockRate = "",
    clock_topics: opt.ClockTopics = None,
    clock_topics_all: opt.ClockAll = False,
    delay: opt.Delay = 0.0,
    playback_duration: opt.Duration = -1.0,
    playback_until_sec: opt.UntilSec = -1.0,
    playback_until_nsec: opt.UntilNsec = -1,
    start_paused: opt.Paused = False,
    start_offset: opt.Offset = 0.0,
    wait_for_all_acked: opt.Acked = -1,
    no_keys: shared.NoKeys = False,
    disable_loan_message: opt.Loan = False,
    storage_config: opt.StorageConfig = "",
    publish_service_requests: opt.Requests = False,
    service_requests_source: opt.Source = "service_introspection",
    message_order: opt.Order = "received",
    progress_rate: opt.UpdateRate = 3.0,
    separation: opt.Separation = 3,
    read_ahead: opt.ReadAhead = 1000,
    node_name: opt.NodeName = "rosbag2_player",
    log_level: shared.LogLevel = "info",
    enclave: Enclave = "",
) -> None:
    """Publish what a bag has recorded: `bag play walk`, `bag play walk -r 2 --topics /scan /odom`.

    Space pauses it, the right arrow or s plays the next message, up and down change the rate.
    """
    from robolink.cli.bag.player import Wish, run

    paths = _paths(ctx, words, inputs)
    settings = _settings(ctx)
    wish = Wish(node_name, log_level, not no_keys, progress_rate, tuple(remap or ()), enclave)
    raise typer.Exit(run(paths, settings, wish))


def _paths(ctx: typer.Context, words: Sequence[str] | None, inputs: Sequence[str] | None) -> list[str]:
    """Return the bags; a storage behind one, as in `-i BAG mcap`, is left out: the files tell it."""
    given = [*(words or ()), *(inputs or ())]
    found = [each for each in given if each not in shared.STORAGES or Path(each).exists()]
    if not found:
        ctx.fail("play what? name a bag: a folder, or one .mcap or .db3 file")
    return found


def _settings(ctx: typer.Context) -> PlaySettings:
    from robolink.bag.playing import PlaySettings

    given = ctx.params
    clock = given["clock"]
    if clock and not (_NUMBER.fullmatch(clock) and 0 < float(clock) <= 1e6):
        ctx.fail(f"--clock: expected a number of Hz above 0, got '{clock[:100]}'")
    if not math.isfinite(given["playback_duration"]) or not math.isfinite(given["playback_until_sec"]):
        ctx.fail("--playback-duration and --playback-until-sec take numbers of seconds")
    return PlaySettings(
        rate=given["rate"],
        loop=given["loop"],
        delay=given["delay"],
        start_offset=given["start_offset"],
        duration=given["playback_duration"] if given["playback_duration"] >= 0 else None,
        until=_until(ctx),
        start_paused=given["start_paused"],
        selection=shared.selection_of(given),
        qos_overrides=shared.overrides(given["qos_overrides"]),
        clock_rate=float(clock or 0),
        clock_topics=None if given["clock_topics_all"] else frozenset(map(shared.full, given["clock_topics"] or ())),
        order=given["message_order"],
        read_ahead=given["read_ahead"],
        service_requests=given["service_requests_source"] if given["publish_service_requests"] else "",
    ).checked()


def _until(ctx: typer.Context) -> int | None:
    seconds, nanoseconds = ctx.params["playback_until_sec"], ctx.params["playback_until_nsec"]
    if seconds >= 0 and nanoseconds >= 0:
        ctx.fail("--playback-until-sec and --playback-until-nsec do not go together")
    if nanoseconds >= 0:
        return int(nanoseconds)
    return round(min(seconds, FAR) * 1e9) if seconds >= 0 else None
