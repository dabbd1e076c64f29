"""Requests over HTTP: which Host, Origin, token and cookie one may come with, and the files of the page."""

from __future__ import annotations

import hmac
import ipaddress
import socket
from pathlib import Path
from typing import NamedTuple
from urllib.parse import parse_qs, unquote, urlsplit

from robolink.view.server.lean import lean

PAGE = Path(__file__).parents[1] / "page"

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".json": "application/json",
    ".webmanifest": "application/manifest+json",
}
"""Content types by suffix; other files are not served."""

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob: data:;"
        " frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Connection": "close",
}
"""Headers of every answer."""


class Verdict(NamedTuple):
    """Decision about a request: a reason to refuse it (""), and whether it may change anything."""

    refusal: str = ""
    trusted: bool = False
    by_address: bool = False
    """True if the token is in the address."""


class Access(NamedTuple):
    """Rules of one server.

    Args:
        host: Address that the server listens at, as it was given.
        port: Its port.
        token: Secret that opens what changes something; where the server is reached from outside, everything.
        read_only: True if nobody may change anything.
    """

    host: str
    port: int
    token: str
    read_only: bool = False

    @property
    def exposed(self) -> bool:
        """True if others than this machine may reach the server."""
        return not is_loopback(self.host)

    @property
    def cookie(self) -> str:
        """Name of the cookie, which differs by port: browsers send cookies to all ports of a host."""
        return f"robolink_view_{self.port}"

    def judge(self, path: str, host: str, origin: str | None, cookies: str) -> Verdict:
        """Decide about a request by its path with the query, and its headers Host, Origin (None: none) and Cookie."""
        if not self._is_own_name(host):
            return Verdict(f"Host {host[:100]!r} is not this server: open http://{self._shown_host}:{self.port}/")
        given = parse_qs(urlsplit(path).query).get("token", [""])[-1]
        if given and not self._is_token(given):
            return Verdict("this token is not that of this server, which makes a new one at each start")
        if origin is not None and not _is_same(origin, host) and not given:
            return Verdict(
                f"Origin {origin[:100]!r} is another site: it needs the token in the address (ws://.../?token=...)"
            )
        known = bool(given) or self._is_token(_cookie(cookies, self.cookie))
        if self.exposed and not known:
            return Verdict("this server is open to others, and asks for its token: open the address that it printed")
        return Verdict("", known and not self.read_only, bool(given))

    @property
    def _shown_host(self) -> str:
        return "localhost" if not self.exposed or is_any(self.host) else bracketed(self.host)

    def _is_token(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(errors="replace"), self.token.encode())

    def _is_own_name(self, header: str) -> bool:
        """Return whether a Host header names this server: by rebinding of DNS any site can have a name that leads here.

        Numbers cannot be rebound, so where others reach it, any address will do.
        """
        name = _without_port(header)
        if is_loopback(name):
            return True
        if not self.exposed:
            return False
        own = socket.gethostname().lower()
        return _is_address(name) or name in (self.host.lower(), own, f"{own}.local", own.partition(".")[0])


def is_loopback(host: str) -> bool:
    """True if a host name or address is this machine's own, which nobody else reaches."""
    name = host.strip("[]").lower()
    if name == "localhost" or name.endswith(".localhost"):
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def is_any(host: str) -> bool:
    """True for an address that means all of the machine's."""
    try:
        return host == "" or ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return False


def bracketed(host: str) -> str:
    """Return a host as addresses of pages have it: that of IPv6 in brackets."""
    return f"[{host}]" if ":" in host else host


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _without_port(header: str) -> str:
    """Return the name in a Host header, lower-case; '' if it is none."""
    try:
        return (urlsplit(f"//{header}").hostname or "").lower()
    except ValueError:
        return ""


def _is_same(origin: str, host: str) -> bool:
    """Return whether an Origin is the page of this very Host; behind a proxy that adds TLS, it is https."""
    return origin.lower() in (f"http://{host.lower()}", f"https://{host.lower()}")


def _cookie(header: str, name: str) -> str:
    """Return the value of a cookie; other programs of this machine may have set any beside it, also malformed ones."""
    for each in header.split(";"):
        key, _, value = each.strip().partition("=")
        if key == name:
            return unquote(value)
    return ""


class File(NamedTuple):
    """A file of the page."""

    content_type: str
    body: bytes


def find(path: str, folder: Path = PAGE) -> File | None:
    """Return a file by its path in an address, `/` for the page itself; None if the page has no such file.

    The path is looked up among those that are there, so no path leads out of the folder.
    """
    name = "index.html" if path == "/" else path.removeprefix("/")
    for each in folder.rglob("*"):
        if each.relative_to(folder).as_posix() == name and each.suffix in TYPES and each.is_file():
            return File(TYPES[each.suffix], lean(each.read_bytes(), each.suffix))
    return None
