"""Arguments and flags of `robolink bag play`, with the spelling of `ros2 bag play`."""

from __future__ import annotations

from typing import Annotated

import typer

from robolink.cli.bag.options import flag, names
from robolink.cli.shared.options import choice, seconds

Names = list[str] | None


Bags = Annotated[Names, typer.Argument(metavar="[BAG]...", help="Bags to play, merged by time.", show_default=False)]
Inputs = Annotated[Names, names("--input", "-i", metavar="BAG [STORAGE]", help="A bag to play; as often as needed.")]
Rate = Annotated[float, typer.Option("--rate", "-r", metavar="X", help="Times as fast as recorded.")]
Topics = Annotated[Names, names("--topics", help="Topics to play; all by default.")]
Services = Annotated[Names, names("--services", help="Services whose events to play.")]
Actions = Annotated[Names, names("--actions", help="Actions whose topics to play.")]
Regex = Annotated[str, typer.Option("--regex", "-e", metavar="REGEX", help="Play what has this in its name.")]
ExcludeRegex = Annotated[
    str, typer.Option("--exclude-regex", "-x", "--exclude", metavar="REGEX", help="Leave out such names.")
]
ExcludeTopics = Annotated[Names, names("--exclude-topics", help="Topics to leave out.")]
ExcludeServices = Annotated[Names, names("--exclude-services", help="Services to leave out.")]
ExcludeActions = Annotated[Names, names("--exclude-actions", help="Actions to leave out.")]
Loop = Annotated[bool, flag("--loop", "-l", help="Begin again at the end.")]
Remap = Annotated[Names, names("--remap", "-m", metavar="OLD:=NEW...", help="Other names for topics.")]
ClockRate = Annotated[
    str, typer.Option("--clock", metavar="[HZ]", help="Publish the bag's time on /clock, at 40 Hz by default.")
]
ClockTopics = Annotated[Names, names("--clock-topics", help="Publish /clock before each message of these topics.")]
ClockAll = Annotated[bool, flag("--clock-topics-all", help="Publish /clock before each message.")]
Delay = Annotated[float, seconds("--delay", "Wait before the first message, of each round of a loop.", short="-d")]
Duration = Annotated[float, typer.Option("--playback-duration", metavar="S", help="Seconds of the bag; all below 0.")]
UntilSec = Annotated[
    float, typer.Option("--playback-until-sec", metavar="S", help="End at this time, in seconds since 1970.")
]
UntilNsec = Annotated[
    int, typer.Option("--playback-until-nsec", metavar="NS", help="End at this time, in nanoseconds since 1970.")
]
Paused = Annotated[bool, flag("--start-paused", "-p", help="Start in a pause.")]
Offset = Annotated[float, seconds("--start-offset", "Begin so many seconds after the start of the bag.")]
Acked = Annotated[int, typer.Option("--wait-for-all-acked", metavar="MS", help="Accepted: nothing is acknowledged.")]
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
        "Which recorded requests are sent: those received, or those sent",
    ),
]
Order = Annotated[str, choice("--message-order", ["received", "sent"], "Time that counts")]
UpdateRate = Annotated[
    float, typer.Option("--progress-bar-update-rate", metavar="HZ", help="Of the progress line; none below 0.")
]
Separation = Annotated[int, typer.Option("--progress-bar-separation-lines", hidden=True)]
ReadAhead = Annotated[
    int,
    typer.Option(
        "--read-ahead-queue-size", metavar="N", min=1, max=2**31, help="Messages sorted by --message-order sent."
    ),
]
NodeName = Annotated[str, typer.Option("--node-name", metavar="NAME", help="Name of the player's node.")]
