"""Certificates for tests, made by the `openssl` command: each in NAME.pem, with its key in NAME.key."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

KEY = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"]


def can_make() -> bool:
    """Whether there is such a command."""
    return shutil.which("openssl") is not None


def make_authority(folder: Path, name: str) -> None:
    """Make the certificate of an authority, signed by itself."""
    made = ["-keyout", f"{name}.key", "-out", f"{name}.pem", "-subj", f"/CN={name}", "-days", "30"]
    _openssl(folder, "req", "-x509", *KEY, *made, "-addext", "basicConstraints=critical,CA:TRUE")


def make_certificate(folder: Path, name: str, authority: str, *addresses: str, days: str = "30") -> None:
    """Make a certificate for 127.0.0.1 and these addresses, signed by an authority that is there."""
    named = ",".join(f"IP:{each}" for each in ("127.0.0.1", *addresses))
    (folder / "names").write_text(f"subjectAltName={named}\n")
    _openssl(folder, "req", *KEY, "-keyout", f"{name}.key", "-out", f"{name}.csr", "-subj", f"/CN={name}")
    signed_by = ["-CA", f"{authority}.pem", "-CAkey", f"{authority}.key", "-CAcreateserial", "-extfile", "names"]
    _openssl(folder, "x509", "-req", "-in", f"{name}.csr", *signed_by, "-out", f"{name}.pem", "-days", days)


def _openssl(folder: Path, *words: str) -> None:
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)
