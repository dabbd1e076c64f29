"""Keys and rights with which a session or a router runs at present; those of files that have changed replace them."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from robolink.exceptions import SecurityError
from robolink.security import session
from robolink.security.keystore import CERTIFICATE, KEY
from robolink.security.session import Security
from robolink.system import clocks
from robolink.transport import certificates, secure_config

if TYPE_CHECKING:
    import zenoh


class Keys:
    """Keys and rights of a session. They do not refer to it, so that it is freed when nobody holds it.

    Raises SecurityError where nobody would let a session with these keys in.
    """

    def __init__(self, security: Security) -> None:
        self.take(security)

    def take(self, security: Security) -> None:
        """Use others from now on; raises SecurityError, and changes nothing, where nobody would let a session in."""
        files = (str(security.folder / each) for each in (CERTIFICATE, KEY, session.AUTHORITY))
        try:
            self.valid = certificates.validity_of(*files)
        except SecurityError as error:
            raise SecurityError(f"enclave '{security.enclave}': {error}") from None
        self.security = security
        self.refusal = functools.lru_cache(maxsize=1024)(security.rights.refusal)

    def secure(self, config: zenoh.Config) -> None:
        """Close a configuration to whoever has no keys, and to everybody once the certificate has ended."""
        secure_config.secure(self.security, config)
        if clocks.time_of_day() >= self.valid.end:
            secure_config.isolate(config)
