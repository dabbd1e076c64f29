"""Rights of an enclave in a domain: whether it may publish, subscribe, request or reply, and by which rule."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from robolink.exceptions import DocumentError, SecurityError, WireError
from robolink.security import permissions
from robolink.security.keystore import PERMISSIONS, enclave_of
from robolink.security.patterns import fits
from robolink.security.permissions import Permission
from robolink.system import clocks
from robolink.wire import parse_key

VERBS = {"publish": "publish", "subscribe": "subscribe to", "request": "call", "reply": "serve"}
"""Kinds of rights, each as a verb for people."""


class Rights:
    """Set of rights of one enclave in one domain: what is not allowed is denied, and a denial beats what is allowed.

    Args:
        enclave: Enclave whose rights they are.
        given: Its permissions, in any order.
        domain: Domain in which they are asked for.
        source: File that they come from, to name in errors.
        moment: Time at which they are asked for, in seconds since 1970; None is now.
    """

    def __init__(
        self,
        enclave: str,
        given: Iterable[Permission],
        domain: int,
        source: str = "",
        moment: float | None = None,
    ) -> None:
        self.enclave, self.domain, self.source = enclave, domain, source
        own = list(given)
        here = [each for each in own if each.holds_in(domain)]
        elsewhere = {first for each in own for first, _ in each.domains}
        self._made_for = "" if here else ", ".join(map(str, sorted(elsewhere)[:5]))
        """Domains of permissions that hold in others alone."""
        self.turns = {each.begin for each in here if each.allows} | {each.end for each in here if each.allows}
        """Times at which a permission begins or ends to hold."""
        now = clocks.time_of_day() if moment is None else moment
        held = [each for each in here if each.holds_at(now)]
        self.allowed = [each for each in held if each.allows]
        self.denied = [each for each in held if not each.allows]

    def allows(self, kind: str, key: str) -> bool:
        """True if a right is there.

        Args:
            kind: `publish`, `subscribe`, `request` or `reply`.
            key: Key of the topic or service (`robolink.wire.format_key`), or its full name.
        """
        return not self.refusal(kind, key)

    def refusal(self, kind: str, key: str) -> str:
        """Return why a right is not there, with enclave, name and rule; '' if it is. Arguments as for `allows`."""
        name = _name(key, self.domain)
        asked = f"enclave '{self.enclave}' may not {VERBS[kind]} {name or key}"
        if not name:
            return f"{asked}: it is of another domain than {self.domain}"
        for each in self.denied:
            if each.kind == kind and fits(each.name, name):
                return f"{asked}: '{each.name}' is denied ({each.place})"
        if any(each.kind == kind and fits(each.name, name) for each in self.allowed):
            return ""
        domain = f" in domain {self.domain}" if self.domain or self._made_for else ""
        if self._made_for:
            domain += (
                f", its permissions were made for domain {self._made_for}: go there, "
                f"or make them anew with ROS_DOMAIN_ID={self.domain}"
            )
        return f"{asked}: no rule allows it{domain} ({self.source})"

    def require(self, kind: str, key: str) -> None:
        """Raise SecurityError if a right is not there. Arguments as for `allows`."""
        if why := self.refusal(kind, key):
            raise SecurityError(why)

    @property
    def is_withdrawn(self) -> bool:
        """True if everything is denied."""
        return {each.kind for each in self.denied if each.name == "/*"} == set(VERBS)


def load_rights(enclaves: Path, domain: int) -> tuple[dict[str, Rights], list[str]]:
    """Return the rights of all enclaves below a folder, by name, and what is wrong with their files.

    An enclave whose file has a mistake has no rights, nor has one whose permissions have ended or not begun.
    """
    now = clocks.time_of_day()
    found: dict[str, Rights] = {}
    mistakes: list[str] = []
    for path in sorted(enclaves.rglob(PERMISSIONS)):
        name = enclave_of(path, enclaves)
        try:
            given = permissions.load(path)
        except DocumentError as error:
            mistakes.append(str(error))
            given = []
        if why := permissions.outside((each for each in given if each.holds_in(domain)), now):
            mistakes.append(why)
        found[name] = Rights(name, given, domain, str(path), now)
    return found, mistakes


def _name(key: str, domain: int) -> str:
    """Return the name of a topic or service from its key; '' for one of another domain."""
    if key.startswith("/"):
        return key
    try:
        parsed = parse_key(key)
    except WireError:
        return ""
    return parsed.name if parsed.domain == domain else ""
