"""Options for the quality of service, as `ros2 topic echo` and `pub` have them."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import typer

from robolink.cli.shared.options import choice, seconds

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
