"""Arguments and flags of `robolink topic`, those for the quality of service too, with ros2's spelling."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import typer

from robolink.cli.shared import complete
from robolink.cli.shared.options import choice, seconds


def _flag(*names: str, help: str) -> Any:  # noqa: A002 - typer's word
    return typer.Option(*names, help=help)


def window(default: int, least: int = 1) -> int:
    """Return the option for the number of messages that are evaluated: `default`, and `least` at least."""
    return typer.Option(  # type: ignore[no-any-return]
        default, "--window", "-w", metavar="N", help="So many messages, the last, are looked at.", min=least, max=10**7
    )


def refuse_together(ctx: typer.Context, given: dict[str, object]) -> None:
    """End with a usage error if more than one of these was given."""
    names = [name for name, value in given.items() if value]
    if len(names) > 1:
        ctx.fail(f"{' and '.join(names)} do not go together")


def are_values(text: str) -> bool:
    """True if the word in the place of a type is a message in YAML: no type has these characters."""
    return ":" in text or text.lstrip().startswith("{")


_TOPIC = {"metavar": "TOPIC", "autocompletion": complete.topic_names}

Topic = Annotated[str, typer.Argument(help="Name of the topic, such as /scan.", **_TOPIC)]
Topics = Annotated[list[str], typer.Argument(help="Names of topics, such as /scan.", **_TOPIC)]
Type = Annotated[
    str, typer.Argument(help="A type, such as Twist.", metavar="TYPE", autocompletion=complete.message_types)
]
TypeOfTopic = Annotated[
    str,
    typer.Argument(help="Its type; found out when left out.", metavar="[TYPE]", autocompletion=complete.type_of_topic),
]
TypeOrValues = Annotated[
    str,
    typer.Argument(
        help="Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist; found out when the topic is there.",
        metavar="[TYPE]",
        autocompletion=complete.type_of_topic,
    ),
]
Values = Annotated[str | None, typer.Argument(help="YAML, such as '{linear: {x: 0.3}}'.", metavar="[VALUES]")]

Hidden = Annotated[bool, _flag("--include-hidden-topics", help="Also those that begin with _.")]
Count = Annotated[bool, _flag("--count-topics", "-c", help="Only say how many there are.")]
ShowTypes = Annotated[bool, _flag("--show-types", "-t", help="Also show the types.")]
Verbose = Annotated[bool, _flag("--verbose", "-v", help="All that is known of publishers and subscriptions.")]
AsJson = Annotated[bool, _flag("--json", help="JSON, for programs; of what goes on, a line each.")]
SimTime = Annotated[bool, _flag("--use-sim-time", "-s", help="Take the time from /clock.")]
WallTime = Annotated[bool, _flag("--wall-time", help="This computer's time, even with -s.")]
Filter = Annotated[
    str, typer.Option("--filter", metavar="EXPR", help="Only messages for which this holds: 'm.linear.x > 0.2'.")
]
NodeName = Annotated[str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node that this makes.")]

# topic echo

OneMessage = Annotated[bool, _flag("--once", help="Show one message and end.")]
Timeout = Annotated[float | None, seconds("--timeout", "End after so many seconds.")]
Field = Annotated[str, typer.Option("--field", metavar="A.B", help="Show only this field: linear.x, 'ranges[0]'.")]
Csv = Annotated[bool, _flag("--csv", help="All values of a message in a line, between commas.")]
Raw = Annotated[bool, _flag("--raw", help="The bytes as they came.")]
MessageInfo = Annotated[bool, _flag("--include-message-info", "-i", help="Also when each was sent.")]
FullLength = Annotated[bool, _flag("--full-length", "-f", help="Shorten nothing.")]
Length = Annotated[int, typer.Option("--truncate-length", "-l", metavar="N", help="Shorten what is longer.", min=0)]
NoArr = Annotated[bool, _flag("--no-arr", help="Of sequences, show only type and length.")]
NoStr = Annotated[bool, _flag("--no-str", help="Of texts, show only the length.")]
Flow = Annotated[bool, _flag("--flow-style", help="YAML in one line: {x: 1}.")]
Clear = Annotated[bool, _flag("--clear", "-c", help="Clear the screen before each message.")]
AsImage = Annotated[bool, _flag("--image", help="Draw a sensor_msgs/msg/Image, in a terminal with 24-bit colours.")]
NoLost = Annotated[bool, _flag("--no-lost-messages", help="Tell nothing of lost messages.")]

# topic pub

Stdin = Annotated[bool, _flag("--stdin", help="Read the YAML from standard input.")]
PublishOnce = Annotated[bool, _flag("--once", "-1", help="Publish one message and end.")]
Rate = Annotated[float, typer.Option("--rate", "-r", metavar="HZ", help="Messages a second.")]
Times = Annotated[int, typer.Option("--times", "-t", metavar="N", help="Publish so many and end.", min=0)]
Wait = Annotated[
    int | None,
    typer.Option(
        "--wait-matching-subscriptions",
        "-w",
        metavar="N",
        help="First wait for so many subscriptions; 1 with -1 and -t.",
        min=0,
    ),
]
MaxWait = Annotated[float | None, seconds("--max-wait-time-secs", "Give up after so many seconds.")]
KeepAlive = Annotated[float, seconds("--keep-alive", "Stay so long after the last message.")]
PrintEvery = Annotated[int, typer.Option("--print", "-p", metavar="N", help="Print every Nth message; 0: none.", min=0)]


PROFILES = [
    "unknown",
    "default",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
    "rosout_default",
]
HISTORIES = ["system_default", "keep_last", "keep_all", "unknown"]
RELIABILITIES = ["system_default", "reliable", "best_effort", "unknown", "best_available"]
DURABILITIES = ["system_default", "transient_local", "volatile", "unknown", "best_available"]
LIVELINESSES = ["system_default", "automatic", "manual_by_topic", "unknown", "best_available"]


Profile = Annotated[str, choice("--qos-profile", PROFILES, "Preset to begin with")]
Depth = Annotated[int | None, typer.Option("--qos-depth", metavar="N", help="Size of the queue.", min=0, max=2**31)]
History = Annotated[str, choice("--qos-history", HISTORIES, "History")]
Reliability = Annotated[str, choice("--qos-reliability", RELIABILITIES, "Reliability")]
Durability = Annotated[str, choice("--qos-durability", DURABILITIES, "Durability")]
Liveliness = Annotated[str, choice("--qos-liveliness", LIVELINESSES, "Liveliness")]
Lease = Annotated[float | None, seconds("--qos-liveliness-lease-duration-seconds", "Liveliness lease.")]


class QoSFlags(NamedTuple):
    """QoS options that were given; none by default."""

    profile: str = ""
    depth: int | None = None
    history: str = ""
    reliability: str = ""
    durability: str = ""
    liveliness: str = ""
    lease: float | None = None

    @property
    def given(self) -> bool:
        """True if any option was given."""
        return self != QoSFlags()

    def over(self, preset: str) -> Any:
        """Return the QoSProfile: the preset that was named, else `preset`, with the policies that were given."""
        from robolink import qos
        from robolink.duration import Duration

        profile = qos.QoSPresetProfiles.get_from_short_key(self.profile or preset).get_c_qos_profile()
        if self.history:
            profile.history = qos.HistoryPolicy[self.history.upper()]
        if self.durability:
            profile.durability = qos.DurabilityPolicy[self.durability.upper()]
        if self.reliability:
            profile.reliability = qos.ReliabilityPolicy[self.reliability.upper()]
        if self.liveliness:
            profile.liveliness = qos.LivelinessPolicy[self.liveliness.upper()]
        if self.lease is not None:
            profile.liveliness_lease_duration = Duration(seconds=self.lease)
        if self.depth:
            profile.depth = self.depth
        elif profile.durability is qos.DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
            profile.depth = 1
        return profile


def flags_of(params: dict[str, Any]) -> QoSFlags:
    """Return the QoS options among a command's parameters: `qos_depth` and so on."""
    return QoSFlags(**{name: params[f"qos_{name}"] for name in QoSFlags._fields})
