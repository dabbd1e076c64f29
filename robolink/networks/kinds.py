"""Networks that are not Zenoh's, by name: those that come with robolink, and those of other packages.

[project.entry-points."robolink.networks"]
can = "my_package.can:NETWORK"  # a Kind: --network can
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from robolink.extensions import Registry, optional
from robolink.networks.request import ALIASES, NAMES, NetworkRequest, requested
from robolink.system.patterns import late

OWN = {"dds": "robolink.dds.network:NETWORK"}
"""Networks that come with robolink: where the Kind of each is, which is imported when it is requested."""

_WORD = late(r"[a-z][a-z0-9_]*")
"""Pattern of their names; a host may be called so, too, and goes last."""


class Kind(NamedTuple):
    """Network of another kind."""

    open: Callable[[int, Mapping[str, str], str | None], Any]
    """Function of the ROS domain id, the environment and the enclave (None for none) that opens a session: a
    `robolink.transport.Transport`. Raises TransportError for settings that are wrong."""
    meets: Callable[[Mapping[str, str]], str]
    """Function of the environment that says in words whom a session meets. Raises TransportError as `open` does."""


def _own() -> dict[str, Kind]:
    return {name: _late(name) for name, target in OWN.items() if optional.is_here(target)}


def _late(name: str) -> Kind:
    def kind() -> Kind:
        found: Kind = optional.part(OWN[name], _in_words(name))
        return found

    return Kind(lambda *given: kind().open(*given), lambda environ: kind().meets(environ))


def _in_words(name: str) -> str:
    return f"the network '{name}'"


NETWORKS: Registry[Kind] = Registry("robolink.networks", _own)
"""All networks of other kinds."""


def requested_kind(network: str | None, environ: Mapping[str, str]) -> Kind | None:
    """Return the kind of the requested network; None where it is one of Zenoh's.

    Args:
        network: As in `robolink.networks.request.requested`; None asks the environment.
        environ: Variables that may ask for a network.

    Raises:
        TransportError: for variables that are wrong.
        ExtensionError: if another package has this network, and it cannot be used.
    """
    return kind_of(requested(network, environ))


def kind_of(request: NetworkRequest) -> Kind | None:
    """Return the kind of a network; None where it is one of Zenoh's.

    Raises:
        MissingPartError: if this installation lacks one that comes with robolink.
        ExtensionError: as `requested_kind` does.
    """
    name = request.value
    if name in NAMES or name in ALIASES or not _WORD.fullmatch(name):
        return None  # without a look at what is installed, which takes 10 ms
    if name in OWN:
        optional.check(OWN[name], _in_words(name))
    return NETWORKS.get(name)
