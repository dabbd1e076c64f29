"""robolink bag play: its arguments, in ros2's spelling."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolink.cli.bag import options as shared
from robolink.cli.bag.options import flag, names
from robolink.cli.shared.noun import ListedOptions
from robolink.cli.shared.options import Enclave, choice, seconds

if TYPE_CHECKING:
    from robolink.bag.playing import PlaySettings


Names = list[str] | None


Bags = Annotated[
    Names, typer.Argument(metavar="[BAG]...", help="Bags to play, their messages merged by time.", show_default=False)
]
Inputs = Annotated[Names, names("--input", "-i", metavar="BAG [STORAGE]", help="Bag to play; may be repeated.")]
Rate = Annotated[float, typer.Option("--rate", "-r", metavar="X", help="Rate of the playback, as a factor.")]
Topics = Annotated[Names, names("--topics", help="Topics to play; all by default.")]
Services = Annotated[Names, names("--services", help="Services to play, by their events.")]
Actions = Annotated[Names, names("--actions", help="Actions to play.")]
Regex = Annotated[
    str,
    typer.Option(
        "--regex",
        "-e",
        metavar="REGEX",
        help="Play topics, services and actions whose names match this regular expression.",
    ),
]
ExcludeRegex = Annotated[
    str,
    typer.Option(
        "--exclude-regex", "-x", "--exclude", metavar="REGEX", help="Exclude names that match this regular expression."
    ),
]
ExcludeTopics = Annotated[Names, names("--exclude-topics", help="Topics to exclude.")]
ExcludeServices = Annotated[Names, names("--exclude-services", help="Services to exclude.")]
ExcludeActions = Annotated[Names, names("--exclude-actions", help="Actions to exclude.")]
Loop = Annotated[bool, flag("--loop", "-l", help="Loop: start again at the end.")]
Remap = Annotated[Names, names("--remap", "-m", metavar="OLD:=NEW...", help="Remap topics.")]
ClockRate = Annotated[
    str,
    typer.Option(
        "--clock", metavar="[HZ]", help="Publish the time of the bag to /clock, at this rate in Hz (default: 40)."
    ),
]
ClockTopics = Annotated[Names, names("--clock-topics", help="Publish to /clock before each message of these topics.")]
ClockAll = Annotated[bool, flag("--clock-topics-all", help="Publish to /clock before each message.")]
Delay = Annotated[float, seconds("--delay", "Delay before the playback, in each loop, in seconds.", short="-d")]
Duration = Annotated[
    float,
    typer.Option("--playback-duration", metavar="S", help="Duration to play, in seconds; negative for all of the bag."),
]
UntilSec = Annotated[
    float, typer.Option("--playback-until-sec", metavar="S", help="Time at which to stop, in seconds since the epoch.")
]
UntilNsec = Annotated[
    int,
    typer.Option("--playback-until-nsec", metavar="NS", help="Time at which to stop, in nanoseconds since the epoch."),
]
Paused = Annotated[bool, flag("--start-paused", "-p", help="Start paused.")]
Offset = Annotated[float, seconds("--start-offset", "Offset from the start of the bag, in seconds.")]
Acked = Annotated[
    int, typer.Option("--wait-for-all-acked", metavar="MS", help="Accepted for ros2's sake: nothing is acknowledged.")
]
Loan = Annotated[bool, typer.Option("--disable-loan-message", hidden=True)]
StorageConfig = Annotated[str, typer.Option("--storage-config-file", metavar="FILE", hidden=True)]
Requests = Annotated[
    bool, flag("--publish-service-requests", help="Call the services instead of publishing their events.")
]
Source = Annotated[
    str,
    choice(
        "--service-requests-source",
        ["service_introspection", "client_introspection"],
        "Recorded requests to send, those of the service or of its clients",
    ),
]
Order = Annotated[
    str, choice("--message-order", ["received", "sent"], "Order of the messages, by the time at which they were")
]
UpdateRate = Annotated[
    float,
    typer.Option(
        "--progress-bar-update-rate", metavar="HZ", help="Update rate of the progress line, in Hz; negative for none."
    ),
]
Separation = Annotated[int, typer.Option("--progress-bar-separation-lines", hidden=True)]
ReadAhead = Annotated[
    int,
    typer.Option(
        "--read-ahead-queue-size",
        metavar="N",
        min=1,
        max=2**31,
        help="Number of messages read ahead, for --message-order sent.",
    ),
]
NodeName = Annotated[str, typer.Option("--node-name", metavar="NAME", help="Name of the player node.")]


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
    words: Bags = None,
    inputs: Inputs = None,
    storage: shared.KnownStorage = "",
    rate: Rate = 1.0,
    topics: Topics = None,
    services: Services = None,
    actions: Actions = None,
    regex: Regex = "",
    exclude_regex: ExcludeRegex = "",
    exclude_topics: ExcludeTopics = None,
    exclude_services: ExcludeServices = None,
    exclude_actions: ExcludeActions = None,
    qos_overrides: shared.Overrides = "",
    loop: Loop = False,
    remap: Remap = None,
    clock: ClockRate = "",
    clock_topics: ClockTopics = None,
    clock_topics_all: ClockAll = False,
    delay: Delay = 0.0,
    playback_duration: Duration = -1.0,
    playback_until_sec: UntilSec = -1.0,
    playback_until_nsec: UntilNsec = -1,
    start_paused: Paused = False,
    start_offset: Offset = 0.0,
    wait_for_all_acked: Acked = -1,
    no_keys: shared.NoKeys = False,
    disable_loan_message: Loan = False,
    storage_config: StorageConfig = "",
    publish_service_requests: Requests = False,
    service_requests_source: Source = "service_introspection",
    message_order: Order = "received",
    progress_rate: UpdateRate = 3.0,
    separation: Separation = 3,
    read_ahead: ReadAhead = 1000,
    node_name: NodeName = "rosbag2_player",
    log_level: shared.LogLevel = "info",
    enclave: Enclave = "",
) -> None:
    """Play back a bag: `bag play walk`, `bag play walk -r 2 --topics /scan /odom`.

    Space pauses and resumes, the right arrow or s plays the next message, up and down change the rate.
    """
    from robolink.cli.bag.player import Request, run

    paths = _paths(ctx, words, inputs)
    settings = _settings(ctx)
    request = Request(node_name, log_level, not no_keys, progress_rate, tuple(remap or ()), enclave)
    raise typer.Exit(run(paths, settings, request))


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
