"""Keys, certificates and signatures, as SROS2 makes them: EC P-256, S/MIME; `cryptography` is imported when needed."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any, NamedTuple

from robolink.exceptions import SecurityError
from robolink.security import files
from robolink.system import clocks

AUTHORITY = "sros2CA"
"""Common name of the authority of a keystore, as in SROS2."""

DAYS = 3650
"""Days for which a certificate is valid, as in SROS2."""

MOST_DAYS = 1_000_000
"""Most days for which a certificate may be valid; X.509 ends in the year 9999."""

LONGEST_NAME = 64
"""Longest common name of a certificate (X.509), in characters."""


class Pair(NamedTuple):
    """A certificate and its private key, in PEM."""

    certificate: bytes
    key: bytes


def make_authority() -> Pair:
    """Make the certificate of an authority, signed by itself."""
    _needed()
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    return _pair(_certificate(AUTHORITY, AUTHORITY, key, key, DAYS, authority=True), key)


def make_certificate(name: str, issuer: Pair, days: float = DAYS) -> Pair:
    """Make a key, and its certificate for an enclave.

    Args:
        name: Enclave, which becomes the common name.
        issuer: Authority that signs it.
        days: Days from now on for which it is valid; a negative number makes one that has ended.

    Raises SecurityError for a name that is too long, and for days that are not a possible number.
    """
    _needed()
    if len(name) > LONGEST_NAME:
        raise SecurityError(
            f"'{name[:80]}' has {len(name)} letters: the name in a certificate has at most {LONGEST_NAME}"
        )
    if not abs(days) <= MOST_DAYS:  # also for a number that is none
        raise SecurityError(f"a certificate is valid for some days, at most {MOST_DAYS}, got {days}")
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    signer, authority = _private_key(issuer), _certificate_of(issuer.certificate)
    issued_by = authority.subject.get_attributes_for_oid(x509.NameOID.COMMON_NAME)[0].value
    return _pair(_certificate(name, str(issued_by), key, signer, days, authority=False), key)


def signed(content: bytes, signer: Pair) -> bytes:
    """Return a text with its signature, as an S/MIME message (.p7s) that ROS 2 reads."""
    _needed()
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.serialization import pkcs7

    certificate = _certificate_of(signer.certificate)
    builder = pkcs7.PKCS7SignatureBuilder().set_data(content)
    builder = builder.add_signer(certificate, _private_key(signer), hashes.SHA256())
    options = [pkcs7.PKCS7Options.Text, pkcs7.PKCS7Options.DetachedSignature]
    text: bytes = builder.sign(serialization.Encoding.SMIME, options)
    return text


def validity(certificate: bytes) -> tuple[datetime.datetime, datetime.datetime]:
    """Return the times, in UTC, from which and until which a certificate is valid; raises SecurityError for no PEM."""
    _needed()
    read = _certificate_of(certificate)
    span: tuple[datetime.datetime, datetime.datetime] = (read.not_valid_before_utc, read.not_valid_after_utc)
    return span


def is_pair(pair: Pair) -> bool:
    """True if a key is that of its certificate; False also where either is none."""
    _needed()
    try:
        same: bool = _private_key(pair).public_key() == _certificate_of(pair.certificate).public_key()
    except SecurityError:
        return False
    return same


def load(certificate: Path, key: Path) -> Pair:
    """Read a certificate and its key."""
    return Pair(files.read(certificate), files.read(key))


def _needed() -> None:
    try:
        import cryptography  # noqa: F401
    except ModuleNotFoundError:
        raise SecurityError("keys need the package cryptography: pip install cryptography") from None


def _private_key(pair: Pair) -> Any:
    from cryptography.hazmat.primitives import serialization

    try:
        return serialization.load_pem_private_key(pair.key, None)
    except (ValueError, TypeError):
        raise SecurityError("the authority's key is not a private key in PEM, or has a password") from None


def _certificate_of(text: bytes) -> Any:
    from cryptography import x509

    try:
        return x509.load_pem_x509_certificate(text)
    except ValueError:
        raise SecurityError("the certificate of the authority, or of the enclave, is none in PEM") from None


def _certificate(name: str, issuer: str, key: Any, signer: Any, days: float, *, authority: bool) -> Any:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    now = datetime.datetime.fromtimestamp(clocks.time_of_day(), datetime.timezone.utc)
    begin = now - datetime.timedelta(days=1 + max(0.0, -days))  # a day early, for clocks that are behind
    limits = x509.BasicConstraints(ca=authority, path_length=1 if authority else None)
    builder = (
        x509.CertificateBuilder()
        .subject_name(x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, name)]))
        .issuer_name(x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, issuer)]))
        .serial_number(x509.random_serial_number())
        .not_valid_before(begin)
        .not_valid_after(now + datetime.timedelta(days=days))
        .public_key(key.public_key())
        .add_extension(limits, critical=authority)
    )
    return builder.sign(signer, hashes.SHA256())


def _pair(certificate: Any, key: Any) -> Pair:
    from cryptography.hazmat.primitives import serialization as to

    private: bytes = key.private_bytes(to.Encoding.PEM, to.PrivateFormat.PKCS8, to.NoEncryption())
    public: bytes = certificate.public_bytes(to.Encoding.PEM)
    return Pair(public, private)
