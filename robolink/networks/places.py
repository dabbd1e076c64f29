"""Places: what a host, or a name of the file of networks, turns out to be, and Zenoh's settings to go there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from robolink.exceptions import TransportError, nearest
from robolink.networks import hosts, networks_file
from robolink.networks.kinds import OWN
from robolink.networks.port_probe import REFUSES, ROUTER, SILENT, STRANGER, Port
from robolink.networks.refusals import WANTS_KEYS, wants_keys
from robolink.networks.request import ALIASES, FIRST_PORT, NAMES, ROUTER_PORT, NetworkRequest
from robolink.networks.settings import client, settings

KNOWN = (
    f"the networks are {', '.join((*NAMES, *OWN))}, HOST[:PORT] and tls/HOST[:PORT] of a robot or router,"
    " and files of Zenoh's"
)
_OTHERS = {
    STRANGER: "is a program that does not speak Zenoh: is the port right?",
    SILENT: "somebody listens and does not answer: is that process stopped (Ctrl-Z), or no robolink process or router?",
    REFUSES: "is a Zenoh session that refuses this one: it has its most sessions, or is of another version",
}
"""Others that may listen at a port, by their role, for an error."""

_HANGS_UP = "somebody hangs up at once: it starts or ends just now, has too many connections, or is something else"


class Place(NamedTuple):
    """Way to others: as a client of a router, or as a peer of somebody's peers."""

    endpoints: tuple[str, ...]
    """Endpoints to connect to."""
    is_client: bool = False
    lan: bool = False
    """True if it also takes part in the local network, as `lan` does."""
    session: str = ""
    """Id of the session that has answered there; empty if nobody was asked."""

    @property
    def meets(self) -> bool:
        """True if the processes of this machine find each other at the rendezvous port of their domain."""
        return not self.is_client

    def settings(self, domain: int, *, holds_port: bool) -> dict[str, Any]:
        """Return Zenoh's settings; without `holds_port` the rendezvous port is left to another process."""
        if self.is_client:
            return client(*self.endpoints)
        name = "lan" if self.lan else "localhost"
        return settings(name, domain, holds_port=holds_port, peers=self.endpoints)


def find(request: NetworkRequest, domain: int, environ: Mapping[str, str], *, secured: bool = False) -> Place | str:
    """Return the place that is asked for; a text where the file of networks says another network instead.

    Raises TransportError if there is no such place, or if nobody answers there. With `secured` a host is `tls/HOST`:
    nothing is sent there in the clear.
    """
    known = networks_file.read_all(environ, request.origin)
    meant = known.get(request.value)
    if isinstance(meant, networks_file.Peers) and meant.network:
        meant = meant.network
    if isinstance(meant, networks_file.Peers):
        return Place(tuple(_peer(each, domain) for each in meant.peers), lan=meant.lan)
    if meant is not None and not isinstance(found := _of_word(meant), hosts.Host):
        return found
    host = hosts.parse(meant or request.value)
    if host is None or (meant is None and request.value.endswith(networks_file.FILES)):
        raise _unknown(request, known, environ)
    try:
        return _answering(host._replace(tls=host.tls or secured), request, domain)
    except hosts.UnknownHostError:
        if meant is not None:
            raise TransportError(f"{request.origin}: '{request.value}' is {meant}, a host that is not known") from None
        raise _unknown(request, known, environ) from None


def _of_word(meant: str) -> str | hosts.Host:
    """Return a host, or the word itself where it is none: another network's, an endpoint's or a file's."""
    word = ALIASES.get(meant, meant)
    host = (
        None
        if word in NAMES or word.startswith(("tcp/", "/", "~")) or word.endswith(networks_file.FILES)
        else hosts.parse(word)
    )
    return host or word


def _peer(text: str, domain: int) -> str:
    host = hosts.parse(text)
    assert host is not None  # checked when the file was read
    return host.endpoint(host.port or FIRST_PORT + domain)


def _answering(host: hosts.Host, request: NetworkRequest, domain: int) -> Place:
    """Ask a host what listens there: it is joined as a peer if it is one, else as a client.

    A router forwards between a client and a peer, not between two peers. With TLS the answer cannot be read without a
    certificate: there a client is right with both, since peers forward what their clients send.
    """
    port = hosts.seek(host, domain)
    if port is None or not (port.speaks_zenoh or host.tls):
        if not host.tls and (keyed := next((each for each in host.ports(domain) if wants_keys(host.name, each)), 0)):
            raise TransportError(f"{request.origin}: at {host.name}, port {keyed}, is a process {WANTS_KEYS}")
        if port is not None:
            raise TransportError(f"{request.origin}: at {host.name}, port {port.number}, {_other(port)}")
        raise TransportError(f"{request.origin}: nobody answers at {host.name}{_what_to_do(host, domain)}")
    endpoint = host.endpoint(port.number)
    return Place((endpoint,), host.tls or port.role == ROUTER, session=port.session)


def _other(port: Port) -> str:
    return _HANGS_UP if port.hung_up else _OTHERS[port.role]


def _what_to_do(host: hosts.Host, domain: int) -> str:
    if host.port:
        return f", port {host.port}: is it on, is the port right, and does its firewall let it through?"
    return (
        f", no robolink process (port {FIRST_PORT + domain}, domain {domain}) and no router (port {ROUTER_PORT}): "
        "start its nodes with --network lan there, or a router (robolink router --listen lan), and open its firewall"
    )


def _unknown(request: NetworkRequest, known: Mapping[str, object], environ: Mapping[str, str]) -> TransportError:
    value = request.value[:200]
    names = [*NAMES, *ALIASES, *OWN, *known]
    wrong = hosts.mistake(value)
    if not wrong:
        more = f", {', '.join(sorted(known)[:8])} of {networks_file.FILE}" if known else ""
        wrong = f"{KNOWN}{more}"
        if path := networks_file.passed_over(environ):
            wrong += f"; {path} is not read, since others may write it or its folder"
    return TransportError(f"{request.origin}: no network, host or file '{value}'{nearest(value, names)}; {wrong}")
