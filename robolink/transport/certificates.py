"""TLS certificate checks of a Zenoh configuration: validates its files, and finds why another session refuses them.

Zenoh itself reports "Timeout!" or nothing at all. Python's `ssl` makes the same handshake, and has the reason.
"""

from __future__ import annotations

import contextlib
import datetime
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import SecurityError
from robolink.system.patterns import late
from robolink.transport.reach import SECURED, address_of, host_of, mode_of, port_of, reach, read

if TYPE_CHECKING:
    import ssl

    import zenoh

ANSWER_WITHIN = 1.0
"""Timeout of a TLS handshake, in seconds; over the slowest links it takes a tenth."""

SILENT_FOR = 0.3
"""Silence after which a certificate counts as accepted, in s: with TLS 1.3 a refusal comes after the handshake."""

MOST_CHECKED = 4
"""Most endpoints that are checked for their reason to refuse."""

_NOT_YET, _EXPIRED = 9, 10
"""OpenSSL's error numbers of certificates that are not valid yet, or no longer."""
_OUT_OF_DATE = {_EXPIRED: "has expired", _NOT_YET: "is not valid yet (is this machine's clock right?)"}
_WRONG_NAME = (62, 64)
_CERTIFICATE = late("-----BEGIN CERTIFICATE-----[^-]*-----END CERTIFICATE-----")
_MONTHS = "JanFebMarAprMayJunJulAugSepOctNovDec"
_SAID = {
    "UNKNOWN_CA": "it does not trust the authority that signed {}",
    "CERTIFICATE_EXPIRED": "it says that {} has expired",
    "CERTIFICATE_REQUIRED": "it asks for a certificate: set enable_mtls, connect_certificate and connect_private_key",
    "HANDSHAKE_FAILURE": "it asks for a certificate, or for another kind of TLS",
    "WRONG_VERSION_NUMBER": "it does not speak TLS",
}
"""Meaning of the peer's TLS alerts."""


class Own(NamedTuple):
    """A certificate of this configuration, and its private key."""

    used_to: str
    """`listen` or `connect`: the prefix of the settings' names."""
    certificate: str
    key: str


class Validity(NamedTuple):
    """Time in which a certificate counts, in seconds since 1970."""

    begin: float
    end: float
    """Its end, or that of its authority if it is earlier."""
    file: str
    """File of the certificate that ends first."""


def faults(config: zenoh.Config) -> list[str]:
    """Return the errors in a configuration's own files that keep everybody out; none where no TLS is used.

    These are missing or wrong files, a key of another certificate, and expired certificates.
    """
    if not reach(config).secured:
        return []
    authority = _settings(config)["root_ca_certificate"]
    return [*_faults_of_authority(authority), *(fault for own in _own(config) for fault in _faults_of(own))]


def doubts(config: zenoh.Config) -> list[str]:
    """Return warnings about own certificates that the own authority has not signed.

    Such a certificate is right only where the other side trusts another authority.
    """
    authority = _settings(config)["root_ca_certificate"]
    if not reach(config).secured or not authority or faults(config):
        return []
    return [doubt for own in _own(config) for doubt in _doubts_of(own, authority)]


def validity_of(certificate: str, key: str, authority: str) -> Validity:
    """Return when a session's certificate ends, or the certificate of its authority if that is earlier.

    Args:
        certificate: Its file; the session uses it to listen and to connect.
        key: File of its private key.
        authority: File with the certificates of those that all trust.

    Raises:
        SecurityError: with the reason why nobody would let the session in.
    """
    uses = [Own(use, certificate, key) for use in ("listen", "connect")]
    with contextlib.suppress(OSError, ValueError):  # of which SSLError is one
        for each in _in_pem(authority):
            if valid := _valid_under(uses[0], each, authority):
                return valid
    raise SecurityError(_why_refused(uses, authority))


def refusals(config: zenoh.Config, endpoints: list[str] | None = None) -> list[str]:
    """Try the TLS handshake at the endpoints of the configuration, and return the reasons of those that refuse.

    `endpoints` are tried in their place if given. Endpoints where nobody listens are left out.
    """
    given = endpoints if endpoints is not None else read(config, "connect/endpoints") or ()
    secured = [address_of(each) for each in given if each.startswith("tls/")][:MOST_CHECKED]
    answers = ((each, _refusal(config, each)) for each in secured)
    return [f"{endpoint}: {answer}" for endpoint, answer in answers if answer]


def _settings(config: zenoh.Config) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(config.get_json("transport/link/tls"))
    return found


def _own(config: zenoh.Config) -> Iterator[Own]:
    """Yield the certificates that a session with this configuration uses, as far as they are files."""
    tls = _settings(config)
    listens = mode_of(config) != "client" and any(
        each.startswith(SECURED) for each in read(config, "listen/endpoints") or ()
    )
    for used_to, is_used in (("listen", listens), ("connect", tls["enable_mtls"])):
        certificate, key = tls[f"{used_to}_certificate"], tls[f"{used_to}_private_key"]
        if is_used and certificate and key:
            yield Own(used_to, certificate, key)


def _faults_of_authority(path: str) -> list[str]:
    if not path:
        return []
    fault = _unreadable(path) or ("" if _holds_certificates(path) else "holds no certificate in PEM")
    return [f"root_ca_certificate {path} {fault}"] if fault else []


def _faults_of(own: Own) -> list[str]:
    files = {f"{own.used_to}_certificate": own.certificate, f"{own.used_to}_private_key": own.key}
    unreadable = [f"{name} {path} {fault}" for name, path in files.items() if (fault := _unreadable(path))]
    if unreadable:
        return unreadable
    certificate, key = (" ".join(each) for each in files.items())
    if not _holds_certificates(own.certificate):
        return [f"{certificate} holds no certificate in PEM"]
    import ssl

    try:
        _load(ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), own)
    except ssl.SSLError as error:
        is_others = error.reason == "KEY_VALUES_MISMATCH"
        return [f"{key} {'is not the key of' if is_others else 'holds no private key in PEM for'} {own.certificate}"]
    code = _verified(own, "\n".join(_in_pem(own.certificate)))
    return [f"{certificate} {_OUT_OF_DATE[code]}"] if code in _OUT_OF_DATE else []


def _doubts_of(own: Own, authority: str) -> list[str]:
    if {0, _NOT_YET, _EXPIRED} & {_verified(own, each) for each in _in_pem(authority)}:
        return []
    doubt = f"{own.used_to}_certificate {own.certificate} is not signed by root_ca_certificate {authority}"
    return [f"{doubt}: whoever has the same one refuses it"]


def _why_refused(uses: Sequence[Own], authority: str) -> str:
    """Return why whoever trusts an authority refuses a certificate, for any of its uses."""
    wrong = [*_faults_of_authority(authority), *(fault for own in uses for fault in _faults_of(own))]
    wrong = wrong or [doubt for own in uses for doubt in _doubts_of(own, authority)]
    if wrong:
        return wrong[0]
    codes = [_verified(uses[0], each) for each in _in_pem(authority)]
    why = next((_OUT_OF_DATE[each] for each in codes if each in _OUT_OF_DATE), "was just being changed: try again")
    return f"root_ca_certificate {authority} {why}"


def _valid_under(own: Own, authority: str, file: str) -> Validity | None:
    """Return the validity of a certificate if an authority, which is from this file, has signed it; else None."""
    import ssl

    server, client = _sides(own)
    for side in (server, client):  # a handshake that judges it for both uses
        _trust(side, authority)
    try:
        shown: Mapping[str, Any] = _shake_hands(server, client).getpeercert() or {}
    except ssl.SSLError:
        return None
    begin, end = _time(shown["notBefore"]), _time(shown["notAfter"])
    last = min((_time(each["notAfter"]) for each in client.get_ca_certs()), default=end)
    return Validity(begin, end, own.certificate) if end <= last else Validity(begin, last, file)


def _time(text: Any) -> float:
    """Return the time of `Jan  5 09:34:43 2036 GMT`; `ssl.cert_time_to_seconds` imports strptime and locales, 10 ms."""
    month, day, clock, year, _ = text.split()
    midnight = datetime.datetime(int(year), _MONTHS.index(month) // 3 + 1, int(day), tzinfo=datetime.timezone.utc)
    hours, minutes, seconds = map(int, clock.split(":"))
    return midnight.timestamp() + 3600 * hours + 60 * minutes + seconds


def _unreadable(path: str) -> str:
    try:
        with Path(path).open("rb") as file:
            file.read(1)
    except FileNotFoundError:
        return "is not there"
    except (OSError, ValueError) as error:
        return f"cannot be read: {getattr(error, 'strerror', None) or error}"
    return ""


def _holds_certificates(path: str) -> bool:
    import ssl

    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT).load_verify_locations(path)
    except (ssl.SSLError, OSError):
        return False
    return True


def _load(context: ssl.SSLContext, own: Own) -> None:
    context.load_cert_chain(own.certificate, own.key, password=lambda: "")  # else it asks for one on the terminal


def _verified(own: Own, authority: str) -> int:
    """Try a handshake with oneself; return OpenSSL's error number where one trusts `authority` (PEM), 0 if valid."""
    import ssl

    server, client = _sides(own)
    _trust(client if own.used_to == "listen" else server, authority)
    try:
        _shake_hands(server, client)
    except ssl.SSLCertVerificationError as error:
        return error.verify_code
    except ssl.SSLError:
        return -1
    return 0


def _in_pem(path: str) -> list[str]:
    """Return the certificates of a file one by one: of two authorities with one name OpenSSL tries the first alone."""
    return _CERTIFICATE.findall(Path(path).read_text("ascii", "replace"))


def _sides(own: Own) -> tuple[ssl.SSLContext, ssl.SSLContext]:
    """Return a server and a client that show a certificate, and trust everybody."""
    import ssl

    server, client = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER), ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    client.check_hostname = False
    client.verify_mode = ssl.CERT_NONE
    for side in (server, client):
        _load(side, own)
    return server, client


def _trust(side: ssl.SSLContext, authority: str) -> None:
    """Let a side demand a certificate that an authority has signed."""
    import ssl

    side.verify_mode = ssl.CERT_REQUIRED
    side.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN  # so that a certificate can stand for its own authority
    side.load_verify_locations(cadata=authority)


def _shake_hands(server: ssl.SSLContext, client: ssl.SSLContext) -> ssl.SSLObject:
    """Let two sides meet in memory, and return the client's end; raises ssl.SSLError where one refuses the other."""
    import ssl

    there, back = ssl.MemoryBIO(), ssl.MemoryBIO()
    sides = (client.wrap_bio(back, there), server.wrap_bio(there, back, server_side=True))
    for end in sides * 4:
        _step(end)
    return sides[0]


def _step(end: ssl.SSLObject) -> None:
    import ssl

    with contextlib.suppress(ssl.SSLWantReadError):
        end.do_handshake()


def _refusal(config: zenoh.Config, endpoint: str) -> str:
    """Try a handshake at an endpoint; return why it fails, or ''."""
    import socket
    import ssl

    tls, host = _settings(config), host_of(endpoint)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = tls["verify_name_on_connect"] is not False
    try:
        if tls["root_ca_certificate"]:
            context.load_verify_locations(tls["root_ca_certificate"])
        else:
            context.load_default_certs()
        for own in _own(config):
            if own.used_to == "connect":
                _load(context, own)
        connection = socket.create_connection((host, port_of(endpoint)), ANSWER_WITHIN)
    except (OSError, UnicodeError):  # nobody is there, or `faults` has told of it
        return ""
    with connection:
        return _handshake(context, connection, host, tls)


def _handshake(context: ssl.SSLContext, connection: Any, host: str, tls: dict[str, Any]) -> str:
    import ssl

    try:
        with context.wrap_socket(connection, server_hostname=host) as secured:
            secured.settimeout(SILENT_FOR)
            secured.recv(1)
    except ssl.SSLCertVerificationError as error:
        return _why_not_trusted(error, host, tls)
    except ssl.SSLEOFError:  # it has gone, and did not say why
        return ""
    except ssl.SSLError as error:
        refused = tls["connect_certificate"] or "this side"
        meant = next((said for part, said in _SAID.items() if part in (error.reason or "")), "")
        return meant.format(refused) or f"it refuses {refused} ({error.reason or error})"
    except OSError:  # silent, as who is content is; or it has gone
        return ""
    return ""


def _why_not_trusted(error: ssl.SSLCertVerificationError, host: str, tls: dict[str, Any]) -> str:
    if error.verify_code in _WRONG_NAME:
        return f"its certificate is not for {host}: connect by a name that it has, or set verify_name_on_connect: false"
    if error.verify_code == _EXPIRED:
        return "its certificate has expired"
    if error.verify_code == _NOT_YET:
        return "its certificate is not valid yet (is this machine's clock right?)"
    return f"its certificate is not signed by {tls['root_ca_certificate'] or 'an authority that this system trusts'}"
