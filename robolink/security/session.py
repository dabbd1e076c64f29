"""Security of a session: what the environment asks for, and the settings that Zenoh gets for it."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import SecurityError, nearest
from robolink.security import files, rights
from robolink.security.keystore import CERTIFICATE, KEY, PERMISSIONS, ROUTER, checked_enclave, enclave_of
from robolink.security.rights import Rights, load_rights
from robolink.system import clocks
from robolink.system.files import expanded
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    import zenoh

AUTHORITY = "identity_ca.cert.pem"
"""File of an enclave with the authority's certificate."""

ENABLE, OVERRIDE = "ROS_SECURITY_ENABLE", "ROS_SECURITY_ENCLAVE_OVERRIDE"
"""Variables that switch security on, and that name the enclave in place of `--enclave`."""

STRATEGY = "ROS_SECURITY_STRATEGY"
"""Variable that decides about an enclave without keys: `Enforce` opens no session, `Permissive` an open one."""

_KEYSTORE = "ROS_SECURITY_KEYSTORE"

_HARMLESS = re.compile(
    r"|iface|bind|so_(snd|rcv)buf|retry_period_\w+|exit_on_failure|timeout_ms|tls_handshake_timeout_ms"
)
"""Settings that an endpoint may have after its `#`; others are those of TLS, such as `enable_mtls`."""

KINDS = {
    EndpointKind.PUBLISHER: "publish",
    EndpointKind.SUBSCRIPTION: "subscribe",
    EndpointKind.SERVICE: "reply",
    EndpointKind.CLIENT: "request",
}
"""Rights that endpoints need."""


class Security(NamedTuple):
    """Keys and rights with which a session is opened."""

    enclave: str
    folder: Path
    """Folder of the enclave's files."""
    enclaves: Path
    """Folder of all enclaves."""
    rights: Rights
    everybody: dict[str, Rights]
    """Rights of all enclaves of the keystore."""
    warnings: list[str]
    """Mistakes and open files of the keystore that do not keep this enclave out, one line each."""


def requested(environ: Mapping[str, str], domain: int, enclave: str | None = None) -> Security | None:
    """Return the security that the environment asks for; None where it asks for none.

    Args:
        environ: Environment: ROS_SECURITY_ENABLE, _KEYSTORE, _STRATEGY and _ENCLAVE_OVERRIDE.
        domain: Domain of the session.
        enclave: Enclave of `--enclave`; None is `/`.

    Raises:
        SecurityError: if what is asked for cannot be had; with the strategy Permissive only where files are wrong,
            not where there are none.
    """
    if not is_on(environ):
        return None
    enforces = _flag(environ, STRATEGY, ("enforce", "permissive"), "permissive") == "enforce"
    name = checked_enclave(environ.get(OVERRIDE) or enclave or "/")
    store = environ.get(_KEYSTORE, "")
    if not store:
        if not enforces:
            return None
        raise SecurityError(f"{ENABLE} is true and {_KEYSTORE} names no keystore: make one with 'robolink security'")
    enclaves = expanded(store) / "enclaves"
    folder = enclaves / name.strip("/")
    if not (folder / KEY).is_file():
        if not enforces:
            return None
        if (folder / KEY).is_symlink():
            raise SecurityError(f"the key of enclave '{name}' is a link that leads nowhere: {folder / KEY}")
        known = [enclave_of(each, enclaves) for each in enclaves.rglob(KEY) if each.is_file()]
        raise SecurityError(
            f"enclave '{name}' has no keys in {store}{nearest(name, known)}: make them with "
            f"'robolink security create_enclave KEYSTORE {name}', or name another by {OVERRIDE}"
        )
    return _loaded(name, folder, enclaves, domain)


def is_on(environ: Mapping[str, str]) -> bool:
    """True if ROS_SECURITY_ENABLE is true; raises SecurityError if it is neither true nor false."""
    return _flag(environ, ENABLE, ("true", "false"), "false") == "true"


def _loaded(name: str, folder: Path, enclaves: Path, domain: int) -> Security:
    for each in (KEY, CERTIFICATE, AUTHORITY, PERMISSIONS):
        files.read(folder / each)
    if exposed := files.exposure(folder / KEY):
        raise SecurityError(f"enclave '{name}': {exposed}")
    everybody, mistakes = load_rights(enclaves, domain)
    own = everybody[name]
    if mine := [each for each in mistakes if each.startswith(own.source)]:
        raise SecurityError(f"enclave '{name}': {mine[0]}")
    if own.is_withdrawn:
        raise SecurityError(f"enclave '{name}' has been withdrawn: everything is denied to it ({own.source})")
    warnings = [f"{each}: this enclave has no rights" for each in mistakes]
    return Security(name, folder, enclaves, own, everybody, [*warnings, *_open_to_change(folder, enclaves)])


def _open_to_change(folder: Path, enclaves: Path) -> list[str]:
    """Return a line if others may change what says who gets in, and what each may do: files, or folders of these."""
    rights = sorted(enclaves.rglob(PERMISSIONS))
    files_ = [*rights, *(folder / each for each in (CERTIFICATE, AUTHORITY)), enclaves / "governance.p7s"]
    found = files.changeable(dict.fromkeys([enclaves.parent, enclaves, *files_, *(each.parent for each in rights)]))
    if not found:
        return []
    more = f" and {len(found) - 1} more" if found[1:] else ""
    whose = f"{found[0]}{more} may be changed by other users of this machine"
    return [f"{whose}, and so what each enclave may do: chmod -R go-w {enclaves.parent}"]


def read(security: Security) -> Security:
    """Return the same security as its files are now; raises SecurityError where they allow no session."""
    return _loaded(security.enclave, security.folder, security.enclaves, security.rights.domain)


def fingerprint(security: Security) -> frozenset[tuple[str, int, int]]:
    """Return a value that differs as soon as permissions or keys count otherwise.

    These are names, times and sizes of the files of permissions and of the own key, certificate and authority, and
    for each enclave how many times have come at which permissions begin or end.
    """
    own = (security.folder / each for each in (CERTIFICATE, KEY, AUTHORITY))
    found = set()
    for path in (*own, *security.enclaves.rglob(PERMISSIONS)):
        with contextlib.suppress(OSError):  # gone just now
            status = path.stat()
            found.add((str(path), status.st_mtime_ns, status.st_size))
    now = clocks.time_of_day()
    for each in security.everybody.values():
        found.add((each.enclave, sum(turn <= now for turn in each.turns), 0))
    return frozenset(found)


def settings_for(environ: Mapping[str, str], domain: int, enclave: str | None = None) -> dict[str, Any] | None:
    """Return the settings of Zenoh, by path, that security asks for; None where it is off. As for `requested`."""
    security = requested(environ, domain, enclave)
    return None if security is None else settings(security)


def settings(security: Security, interfaces: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the settings of Zenoh, by path: mutual TLS, access control, and no memory that others could read.

    Args:
        security: Keys and rights of the session.
        interfaces: Network interfaces to which the session is confined; none for no such limit.
    """
    trusted = [ROUTER] if ROUTER in security.everybody else []
    domain = security.rights.domain
    return {
        "transport/link/protocols": ["tls"],
        "transport/link/tls": _tls(security.folder),
        # Memory that is shared would be plain text for every process of the same user.
        "transport/shared_memory/enabled": False,
        "access_control": rights.control(security.everybody, domain, trusted=trusted, interfaces=interfaces),
    }


def secure(config: zenoh.Config, security: Security, interfaces: tuple[str, ...] = ()) -> None:
    """Change a configuration so that nothing is sent in the clear, nor to anybody without rights.

    Raises SecurityError if it names endpoints of another kind than tcp and tls, or with settings of their own.

    Args:
        config: Configuration of a session, complete but for this.
        security: Keys and rights of the session.
        interfaces: Network interfaces to which the session is confined; none for no such limit.
    """
    for path in ("listen/endpoints", "connect/endpoints"):
        config.insert_json5(path, json.dumps(_secured(json.loads(config.get_json(path)))))
    for path, value in settings(security, interfaces).items():
        config.insert_json5(path, json.dumps(value))


def _secured(endpoints: Any) -> Any:
    """Return endpoints, one list or one for each mode, with TLS in place of TCP."""
    if isinstance(endpoints, dict):
        return {mode: _secured(each) for mode, each in endpoints.items()}
    return [_over_tls(each) for each in endpoints or ()]


def _over_tls(endpoint: str) -> str:
    protocol, _, address = endpoint.partition("/")
    if protocol not in ("tcp", "tls"):
        raise SecurityError(f"security is on, and {endpoint} is not secured by certificates: use tls/HOST:PORT")
    for each in endpoint.partition("#")[2].split(";"):
        if not _HARMLESS.fullmatch(name := each.partition("=")[0]):  # Zenoh prefers it to the setting of the same name
            raise SecurityError(f"security is on, and {endpoint} has a setting of its own, '{name}': leave it out")
    return f"tls/{address}"


def _tls(folder: Path) -> dict[str, Any]:
    certificate, key = str(folder / CERTIFICATE), str(folder / KEY)
    return {
        "root_ca_certificate": str(folder / AUTHORITY),
        "enable_mtls": True,
        # Certificates name enclaves, not machines; access control looks at the name of each.
        "verify_name_on_connect": False,
        "close_link_on_expiration": True,
        "listen_certificate": certificate,
        "listen_private_key": key,
        "connect_certificate": certificate,
        "connect_private_key": key,
    }


def _flag(environ: Mapping[str, str], variable: str, known: tuple[str, ...], usual: str) -> str:
    """Return the value of a variable, in small letters; raises SecurityError if it is none of those known."""
    text = environ.get(variable, "").strip()
    if (value := text.lower() or usual) in known:
        return value
    raise SecurityError(f"{variable} is {' or '.join(known)}, got '{text[:40]}'{nearest(value, known)}")
