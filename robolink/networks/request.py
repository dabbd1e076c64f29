"""Requested network and domain: what the argument, the variables or else the default ask for."""

from __future__ import annotations

import re
from collections.abc import Mapping, MutableMapping
from typing import NamedTuple

from robolink.constants import LAST_DOMAIN
from robolink.exceptions import TransportError
from robolink.system.patterns import late

FIRST_PORT = 17447
"""Rendezvous port of domain 0; that of domain d is FIRST_PORT + d."""

ROS_ROUTER = "tcp/127.0.0.1:7447"
"""Endpoint of `rmw_zenohd`, the router of ROS 2."""

ROUTER_PORT = 7447
"""Port of Zenoh's routers, robolink's and ROS 2's."""

NAMES = ("localhost", "lan", "off")
"""Names of networks that are always there."""

ALIASES = {"subnet": "lan"}
"""Other names of these: `subnet` is ROS 2's word."""

ENDPOINT = late(r"(tcp|tls|quic|ws)/\S+:\d+")
"""Pattern of Zenoh's endpoints, `tcp/HOST:PORT`."""

NETWORK = "ROBOLINK_NETWORK"
"""Variable that names a network."""

ORIGIN = "ROBOLINK_NETWORK_ASKED_BY"
"""Variable beside it, `WORD=VALUE`, with the word that a person used for this value: errors name that one."""

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
"""ROS 2's variable for how far nodes look for others; it counts where no network is named."""

OVERRIDE = "ZENOH_CONFIG_OVERRIDE"
"""Variable with Zenoh's settings, `path=json5;path=json5`, that have the last word."""

_RANGES = {"": "localhost", "SYSTEM_DEFAULT": "localhost", "LOCALHOST": "localhost", "SUBNET": "lan", "OFF": "off"}
_NAMES_A_NETWORK = late(r"mode|(connect|listen)(/endpoints.*)?")


class NetworkRequest(NamedTuple):
    """A requested network."""

    origin: str
    """Option or variable to name in an error."""
    value: str
    """One of NAMES, a host, an endpoint, a name or path of a file, or overrides that name a network of their own."""


def domain_id(environ: Mapping[str, str]) -> int:
    """Return ROS_DOMAIN_ID, 0 when unset; raises TransportError for an invalid one."""
    text = environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not re.fullmatch(r"[0-9]{1,3}", text):
        raise TransportError(f"ROS_DOMAIN_ID must be a number from 0 to {LAST_DOMAIN}, got {text[:40]!r}")
    return checked_domain(int(text), "ROS_DOMAIN_ID")


def checked_domain(domain: int, origin: str = "the domain id") -> int:
    """Return `domain`; raises TransportError unless it is one of ROS 2's, 0 to 232."""
    if not 0 <= domain <= LAST_DOMAIN:
        raise TransportError(f"{origin} must be a number from 0 to {LAST_DOMAIN}, got {domain}")
    return domain


def requested(network: str | None, environ: Mapping[str, str]) -> NetworkRequest:
    """Return the requested network: by argument, by variable, or else this machine's own.

    The variables are ROBOLINK_NETWORK, ZENOH_SESSION_CONFIG_URI and ROS_AUTOMATIC_DISCOVERY_RANGE, in this order.
    Endpoints or a mode in ZENOH_CONFIG_OVERRIDE name a network too, in place of this machine's own.
    """
    found = _named_by(network, environ)
    found = found._replace(value=ALIASES.get(found.value, found.value))
    named = network_of_overrides(environ)
    return NetworkRequest(OVERRIDE, named) if named and found.value == "localhost" else found


def _named_by(network: str | None, environ: Mapping[str, str]) -> NetworkRequest:
    if network:
        return NetworkRequest("network", network)
    if value := environ.get(NETWORK):
        return NetworkRequest(_word_for(value, environ), value)
    if value := environ.get("ZENOH_SESSION_CONFIG_URI"):
        return NetworkRequest("ZENOH_SESSION_CONFIG_URI", value)
    reach = environ.get(RANGE, "")
    if reach.upper() not in _RANGES:
        known = ", ".join(filter(None, _RANGES))
        raise TransportError(f"{RANGE} must be one of {known}, got {reach[:40]!r}")
    return NetworkRequest(RANGE, _RANGES[reach.upper()])


def ask(environ: MutableMapping[str, str], value: str, origin: str) -> None:
    """Set the variables of a network, for this process and those that it starts.

    Args:
        environ: Variables, which are changed.
        value: The network.
        origin: Word by which a person asked for it, such as an option of the command line, to name in an error.
    """
    environ[NETWORK], environ[ORIGIN] = value, f"{origin}={value}"


def _word_for(value: str, environ: Mapping[str, str]) -> str:
    word = environ.get(ORIGIN, "").removesuffix(f"={value}")
    return word if word and word != environ[ORIGIN] else NETWORK  # else somebody has set another one since


def overrides(environ: Mapping[str, str]) -> list[tuple[str, str]]:
    """Split ZENOH_CONFIG_OVERRIDE, `path=json5;path=json5`, into paths and values."""
    parts = (each.partition("=") for each in environ.get(OVERRIDE, "").split(";") if each.strip())
    return [(path.strip(), value.strip()) for path, _, value in parts]


def network_of_overrides(environ: Mapping[str, str]) -> str:
    """Return the overrides that name endpoints or a mode, in one line; empty where none does."""
    named = (f"{path}={value}" for path, value in overrides(environ) if _NAMES_A_NETWORK.fullmatch(path))
    return ";".join(" ".join(each.split()) for each in named)
