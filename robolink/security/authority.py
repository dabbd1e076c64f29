"""Keys, certificates and signatures, as SROS2 makes them: EC P-256, S/MIME; `cryptography` is imported when needed."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any, NamedTuple

from robolink.exceptions import SecurityError
from robolink.security import files

AUTHORITY = "sros2CA"
"""Common name of the authority of a keystore, as in SROS2."""

DAYS = 3650
"""Days for which a certificate is valid, as in SROS2."""


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
    """
    _needed()
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    signer, authority = _private_key(issuer), x509.load_pem_x509_certificate(issuer.certificate)
    issued_by = authority.subject.get_attributes_for_oid(x509.NameOID.COMMON_NAME)[0].value
    return _pair(_certificate(name, str(issued_by), key, signer, days, authority=False), key)


def signed(content: bytes, signer: Pair) -> bytes:
    """Return a text with its signature, as an S/MIME message (.p7s) that ROS 2 reads."""
    _needed()
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.serialization import pkcs7

    certificate = x509.load_pem_x509_certificate(signer.certificate)
    builder = pkcs7.PKCS7SignatureBuilder().set_data(content)
    builder = builder.add_signer(certificate, _private_key(signer), hashes.SHA256())
    options = [pkcs7.PKCS7Options.Text, pkcs7.PKCS7Options.DetachedSignature]
    text: bytes = builder.sign(serialization.Encoding.SMIME, options)
    return text


def validity(certificate: bytes) -> tuple[datetime.datetime, datetime.datetime]:
    """Return the times, in UTC, from which and until which a certificate is valid."""
    _needed()
    from cryptography import x509

    read = x509.load_pem_x509_certificate(certificate)
    span: tuple[datetime.datetime, datetime.datetime] = (read.not_valid_before_utc, read.not_valid_after_utc)
    return span


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
        raise SecurityError("the authority's key is no private key in PEM, or has a password") from None


def _certificate(name: str, issuer: str, key: Any, signer: Any, days: float, *, authority: bool) -> Any:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes

    now = datetime.datetime.now(datetime.timezone.utc)
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
