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
        default,
        "--window",
        "-w",
        metavar="N",
        help="Window size: number of the latest messages to evaluate.",
        min=least,
        max=10**7,
    )


def refuse_together(ctx: typer.Context, given: dict[str, object]) -> None:
    """End with a usage error if more than one of these was given."""
    names = [name for name, value in given.items() if value]
    if len(names) > 1:
        ctx.fail(f"{' and '.join(names)} do not go together")


def topics_or_all(ctx: typer.Context, topics: list[str] | None, every: bool) -> list[str]:
    """Return the topics that were named, none for all; end with a usage error unless it is one of both."""
    if bool(topics) == every:
        ctx.fail("TOPIC and --all do not go together" if every else "Missing argument 'TOPIC', or --all")
    return topics or []


def are_values(text: str) -> bool:
    """True if the word in the place of a type is a message in YAML: no type has these characters."""
    return ":" in text or text.lstrip().startswith("{")


_TOPIC = {"metavar": "TOPIC", "autocompletion": complete.topic_names}

Topic = Annotated[str, typer.Argument(help="Name of the topic, such as /scan.", **_TOPIC)]
TopicsOrAll = Annotated[
    list[str] | None, typer.Argument(help="Names of topics, such as /scan; none with --all.", **_TOPIC)
]
AllTopics = Annotated[
    bool, _flag("--all", "-a", help="Measure all topics, new ones too; the screen is cleared each time.")
]
Type = Annotated[
    str,
    typer.Argument(
        help="Message type, such as geometry_msgs/msg/Twist or Twist.",
        metavar="TYPE",
        autocompletion=complete.message_types,
    ),
]
TypeOfTopic = Annotated[
    str,
    typer.Argument(
        help="Its type; looked up on the network by default.", metavar="[TYPE]", autocompletion=complete.type_of_topic
    ),
]
TypeOrValues = Annotated[
    str,
    typer.Argument(
        help="Message type: Twist, geometry_msgs/Twist or geometry_msgs/msg/Twist; that of the topic by default.",
        metavar="[TYPE]",
        autocompletion=complete.type_of_topic,
    ),
]
Values = Annotated[
    str | None, typer.Argument(help="Values of the message in YAML, such as '{linear: {x: 0.3}}'.", metavar="[VALUES]")
]

Hidden = Annotated[bool, _flag("--include-hidden-topics", help="Include hidden names, which begin with _.")]
Count = Annotated[bool, _flag("--count-topics", "-c", help="Print only the number.")]
ShowTypes = Annotated[bool, _flag("--show-types", "-t", help="Print the types too.")]
Verbose = Annotated[
    bool, _flag("--verbose", "-v", help="Print details of each publisher and subscription: node, type hash, GID, QoS.")
]
AsJson = Annotated[bool, _flag("--json", help="Print JSON; for messages and rates, one object a line.")]
SimTime = Annotated[bool, _flag("--use-sim-time", "-s", help="Use simulation time, from /clock.")]
WallTime = Annotated[bool, _flag("--wall-time", help="Measure with the system clock, even with -s.")]
Filter = Annotated[
    str,
    typer.Option(
        "--filter",
        metavar="EXPR",
        help="Use only messages m that match this Python expression, such as 'm.linear.x > 0.2'.",
    ),
]
NodeName = Annotated[str, typer.Option("--node-name", "-n", metavar="NAME", help="Name of the node of this command.")]

# topic echo

OneMessage = Annotated[bool, _flag("--once", help="Print one message and exit.")]
Timeout = Annotated[float | None, seconds("--timeout", "Exit after this number of seconds.")]
Field = Annotated[
    str, typer.Option("--field", metavar="A.B", help="Print only this field, such as linear.x or 'ranges[0]'.")
]
Csv = Annotated[bool, _flag("--csv", help="Print the fields of a message in one line, separated by commas.")]
Raw = Annotated[bool, _flag("--raw", help="Print the serialized bytes.")]
MessageInfo = Annotated[
    bool,
    _flag("--include-message-info", "-i", help="Print the source timestamp and other information of each message."),
]
Clear = Annotated[bool, _flag("--clear", "-c", help="Clear the screen before each message.")]
AsImage = Annotated[bool, _flag("--image", help="Draw a sensor_msgs/msg/Image, in a terminal with 24-bit colours.")]
NoLost = Annotated[bool, _flag("--no-lost-messages", help="Do not report lost messages.")]

# topic pub

Stdin = Annotated[bool, _flag("--stdin", help="Read the values from standard input.")]
YamlFile = Annotated[
    str,
    typer.Option(
        "--yaml-file", metavar="FILE", help="Read the messages from this YAML file, such as the output of topic echo."
    ),
]
PublishOnce = Annotated[bool, _flag("--once", "-1", help="Publish one message and exit.")]
Rate = Annotated[float, typer.Option("--rate", "-r", metavar="HZ", help="Publishing rate in Hz.")]
Times = Annotated[
    int, typer.Option("--times", "-t", metavar="N", help="Publish this number of messages and exit.", min=0)
]
Wait = Annotated[
    int | None,
    typer.Option(
        "--wait-matching-subscriptions",
        "-w",
        metavar="N",
        help="Number of matching subscriptions to wait for first; 1 with --once and --times.",
        min=0,
    ),
]
MaxWait = Annotated[
    float | None, seconds("--max-wait-time-secs", "Longest time to wait for subscriptions, in seconds.")
]
KeepAlive = Annotated[float, seconds("--keep-alive", "Seconds to keep the node alive after the last message.")]
PrintEvery = Annotated[
    int, typer.Option("--print", "-p", metavar="N", help="Print every Nth message; 0 prints none.", min=0)
]


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


Profile = Annotated[str, choice("--qos-profile", PROFILES, "QoS preset, which the other QoS options change")]
Depth = Annotated[
    int | None,
    typer.Option("--qos-depth", metavar="N", help="QoS depth: number of messages in the queue.", min=0, max=2**31),
]
History = Annotated[str, choice("--qos-history", HISTORIES, "QoS history")]
Reliability = Annotated[str, choice("--qos-reliability", RELIABILITIES, "QoS reliability")]
Durability = Annotated[str, choice("--qos-durability", DURABILITIES, "QoS durability")]
Liveliness = Annotated[str, choice("--qos-liveliness", LIVELINESSES, "QoS liveliness")]
Lease = Annotated[
    float | None, seconds("--qos-liveliness-lease-duration-seconds", "QoS liveliness lease duration in seconds.")
]


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
