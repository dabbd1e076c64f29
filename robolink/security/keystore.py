"""Keystores in SROS2's layout: an authority, and for each enclave a key, a certificate and its permissions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import AbstractContextManager
from pathlib import Path

from robolink.documents.xmltext import read
from robolink.exceptions import DocumentError, SecurityError, nearest
from robolink.security import authority, files, permissions, policy
from robolink.security.policy import Profile, Rule
from robolink.text.names import FULL_NAME_RULES, MAX_NAMESPACE, find_problem

KEY, CERTIFICATE, PERMISSIONS = "key.pem", "cert.pem", "permissions.xml"
"""Files of an enclave."""

ROUTER = "/router"
"""Enclave of routers: to whoever has its key everything may be sent, since a router passes everything on."""

_REQUIRED = (
    *("public/permissions_ca.cert.pem", "public/identity_ca.cert.pem"),
    *("private/permissions_ca.key.pem", "private/identity_ca.key.pem", "enclaves/governance.p7s"),
)
EVERYTHING = [Rule(kind, True, "/*") for kind in ("publish", "subscribe", "reply", "request")]
"""Rules that allow everything, which a new enclave has until it gets a policy, as in SROS2."""

_GOVERNANCE = """<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains>
        <id>{domain}</id>
      </domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>SIGN</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>ENCRYPT</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
"""


class Keystore:
    """A keystore in a folder.

    Args:
        path: Its folder, which need not be there yet.
        domain: ROS domain for which permissions are written.
    """

    def __init__(self, path: Path, domain: int = 0) -> None:
        self.path, self.domain = path, domain
        self.enclaves = path / "enclaves"
        """Folder with one folder for each enclave."""

    def written_domain(self) -> int:
        """Return the domain for which it was made, which its governance file names; its own where that names none."""
        try:
            found = [*read(self.enclaves / "governance.xml").all("domain_access_rules", "domain_rule", "domains", "id")]
        except DocumentError:
            return self.domain
        text = found[0].text if len(found) == 1 else ""
        return int(text) if re.fullmatch("[0-9]{1,3}", text, re.ASCII) else self.domain

    @property
    def is_valid(self) -> bool:
        """True if it is complete: keys can be made in it."""
        return all((self.path / name).is_file() for name in _REQUIRED)

    def create(self) -> None:
        """Make the folders, the authority and the governance file; raises SecurityError where it is complete."""
        if self.is_valid:
            raise SecurityError(f"keystore '{self.path}' already exists")
        for folder, mode in ((self.path, 0o755), (self._public, 0o755), (self._private, 0o700), (self.enclaves, 0o755)):
            files.make_folder(folder, mode)
        with self._alone():
            if self.is_valid:  # by another command, meanwhile
                raise SecurityError(f"keystore '{self.path}' already exists")
            self._complete()

    def _complete(self) -> None:
        missing = [name for name in _REQUIRED[:4] if not (self.path / name).is_file()]
        key, certificate = self._private / "ca.key.pem", self._public / "ca.cert.pem"
        if missing and not (
            key.is_file() and certificate.is_file() and authority.is_pair(authority.load(certificate, key))
        ):
            if any(self.enclaves.rglob(KEY)):  # whose keys would be of no use with another authority
                raise SecurityError(
                    f"keystore '{self.path}' has enclaves, and {missing[0]} is not there: "
                    "bring it back, or begin in another folder"
                )
            made = authority.make_authority()
            files.write(key, made.key, files.PRIVATE)
            files.write(certificate, made.certificate)
        for use in ("permissions_ca", "identity_ca") if missing else ():
            files.link(certificate, self._public / f"{use}.cert.pem")
            files.link(key, self._private / f"{use}.key.pem")
        governance = _GOVERNANCE.format(domain=self.domain).encode()
        files.write(self.enclaves / "governance.xml", governance)
        files.write(self.enclaves / "governance.p7s", authority.signed(governance, self._authority("permissions_ca")))

    def create_enclave(self, name: str, *, days: float = authority.DAYS, renew: bool = False) -> Path:
        """Make the key, the certificate and the permissions of an enclave, as far as they are not there yet.

        Args:
            name: Enclave, such as `/robot/driver`.
            days: Days for which a new certificate is valid.
            renew: True makes a new key and certificate, also where there are some; permissions stay.

        Returns:
            Its folder.
        """
        self.check()
        with self._alone():
            return self._create_enclave(name, days, renew)

    def _create_enclave(self, name: str, days: float, renew: bool) -> Path:
        folder = self.folder(name)
        pair = (folder / CERTIFICATE, folder / KEY)
        is_there = all(each.is_file() for each in pair) and authority.is_pair(authority.load(*pair))
        made = (
            None if is_there and not renew else authority.make_certificate(name, self._authority("identity_ca"), days)
        )
        files.make_folder(folder)
        for use in ("identity_ca.cert.pem", "permissions_ca.cert.pem"):
            files.link(self._public / use, folder / use)
        files.link(self.enclaves / "governance.p7s", folder / "governance.p7s")
        if made:
            files.write(folder / KEY, made.key, files.PRIVATE)
            files.write(folder / CERTIFICATE, made.certificate)
        if not (folder / PERMISSIONS).is_file():
            self._permit(name, EVERYTHING)
        return folder

    def permit(self, name: str, rules: Iterable[Rule]) -> None:
        """Write and sign the permissions of an enclave that is there, from rules without actions (`expanded`)."""
        self.check()
        with self._alone():
            self._permit(name, rules)

    def _permit(self, name: str, rules: Iterable[Rule]) -> None:
        folder = self.folder(name)
        if not (folder / CERTIFICATE).is_file():
            known = [each for each in self.names() if each != name]
            raise SecurityError(f"there is no enclave '{name}' in '{self.path}'{nearest(name, known)}")
        signer = self._authority("permissions_ca")
        # As long as the authority: a renewed certificate needs no new permissions, which would concern all sessions.
        text = permissions.write(name, rules, self.domain, authority.validity(signer.certificate))
        if len(text) > files.LARGEST:  # which no session would read
            raise SecurityError(f"the permissions of '{name}' have {len(text):,} bytes, more than {files.LARGEST:,}")
        signature = authority.signed(text, signer)
        files.write(folder / "permissions.p7s", signature)
        files.write(folder / PERMISSIONS, text)

    def permit_profiles(self, name: str, profiles: Iterable[Profile]) -> None:
        """Write and sign the permissions of an enclave from the profiles of a policy."""
        self.permit(name, permissions.expanded(profiles))

    def withdraw(self, name: str) -> None:
        """Deny an enclave everything; its key stays, and is of no use from then on."""
        self.permit(name, [rule._replace(allows=False) for rule in EVERYTHING])

    def is_withdrawn(self, name: str) -> bool:
        """True if everything is denied to an enclave, in whatever domain."""
        given = permissions.load(self.folder(name) / PERMISSIONS)
        denied = {each.kind for each in given if not each.allows and each.name == "/*"}
        return denied == {rule.kind for rule in EVERYTHING}

    def names(self) -> list[str]:
        """Return the enclaves that have a key, sorted; raises SecurityError where it is not a keystore."""
        self.check()
        return sorted(enclave_of(each, self.enclaves) for each in self.enclaves.rglob(KEY) if each.is_file())

    def check(self) -> None:
        """Raise SecurityError if it is not complete."""
        if not self.is_valid:
            raise SecurityError(f"'{self.path}' is not a valid keystore")

    def folder(self, name: str) -> Path:
        """Return the folder of an enclave; raises SecurityError for a name that is none."""
        return self.enclaves / checked_enclave(name).strip("/")

    def _alone(self) -> AbstractContextManager[None]:
        """Keep other commands out: two at once would mix their keys and certificates."""
        return files.alone(self.path)

    @property
    def _public(self) -> Path:
        return self.path / "public"

    @property
    def _private(self) -> Path:
        return self.path / "private"

    def _authority(self, use: str) -> authority.Pair:
        return authority.load(self._public / f"{use}.cert.pem", self._private / f"{use}.key.pem")


def enclave_of(path: Path, enclaves: Path) -> str:
    """Return the enclave that a file below the folder `enclaves` belongs to."""
    return "/" + path.parent.relative_to(enclaves).as_posix().removeprefix(".")


def checked_enclave(name: str) -> str:
    """Return the name of an enclave, which follows the rules of namespaces; raises SecurityError for any other."""
    problem = None if name == "/" else find_problem(name, FULL_NAME_RULES, MAX_NAMESPACE)
    if problem is None:
        return name
    raise SecurityError(f"'{name[:200]}' is not a valid enclave name: {problem[0]} (at index {problem[1]})")


def generate(store: Keystore, enclaves: Iterable[str], policies: Iterable[Path]) -> None:
    """Make enclaves, and those of policies with their permissions, in a keystore, which is made if need be."""
    read = [(path, policy.load(path)) for path in policies]  # first, so that a mistake leaves nothing half made
    if not store.is_valid:
        store.create()
    for name in enclaves:
        store.create_enclave(name)
    for _, found in read:
        for name, profiles in found.items():
            store.create_enclave(name)
            store.permit_profiles(name, profiles)


def profiles_of(path: Path, enclave: str) -> list[Profile]:
    """Return the profiles of an enclave in a policy file; raises DocumentError where it has none."""
    found = policy.load(path)
    if enclave not in found:
        raise DocumentError(f'unable to find enclave "{enclave}"{nearest(enclave, found)}', str(path))
    return found[enclave]
