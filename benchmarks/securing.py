"""Benchmark of security: start of a launched system over TLS, each node an enclave, against one without keys.

    python benchmarks/securing.py [--rounds 3] [--nodes 20]

They take turns, so that whatever disturbs the machine disturbs both; the ratio carries over to other machines. A system
is up when every node has announced itself and its publisher to a session that watches. Needs the extra `security`.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

from launching import DOMAIN, ENVIRONMENT, NODE, PATIENCE, Watcher  # type: ignore[import-not-found]

from robolink.security.keystore import Keystore
from robolink.transport import connect

MOST = 1.5
"""Goal: the start over TLS takes at most so many times that without keys."""
KINDS = ("open", "keys")


def write_workspace(folder: Path, nodes: int) -> None:
    """Write the node, a launch file with and one without enclaves, and a keystore with an enclave for each node."""
    for name in ("nodes", "configs"):
        (folder / name).mkdir()
    (folder / "nodes" / "member.py").write_text(NODE)
    for kind, enclave in zip(KINDS, ("", ', enclave: "/member_{i}"'), strict=True):
        entry = f'{{node: member, name: "member_{{i}}", count: {nodes}{enclave}}}'
        (folder / "configs" / f"{kind}.yaml").write_text(f"nodes:\n  - {entry}\n")
    store = Keystore(folder / "keys", DOMAIN)
    store.create()
    for number in range(nodes):
        store.create_enclave(f"/member_{number}")
    store.create_enclave("/watcher")


def seconds_to_start(kind: str, folder: Path, nodes: int) -> float:
    """Start a system, wait until it is up, and stop it."""
    own = {"ENABLE": str(kind == "keys").lower(), "STRATEGY": "Enforce", "KEYSTORE": str(folder / "keys")}
    variables = {f"ROS_SECURITY_{name}": value for name, value in own.items()}
    os.environ.update(variables)
    environment = ENVIRONMENT | variables | {"ROBOLINK_LOG_DIR": str(folder / "logs")}
    command = [sys.executable, "-m", "robolink", "launch", f"configs/{kind}.yaml"]
    with closing(connect(domain=DOMAIN, enclave="/watcher")) as transport:
        watcher = Watcher(transport)
        started = time.perf_counter()
        with subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL) as process:
            try:
                watcher.wait(nodes)
                return time.perf_counter() - started
            finally:
                process.send_signal(signal.SIGINT)
                process.wait(PATIENCE)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--nodes", type=int, default=20)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        write_workspace(Path(name), options.nodes)
        taken = [[seconds_to_start(kind, Path(name), options.nodes) for kind in KINDS] for _ in range(options.rounds)]
    without, over = (statistics.median(each) for each in zip(*taken, strict=True))
    ratio = statistics.median(keys / plain for plain, keys in taken)
    print(
        f"{options.nodes} nodes up: {without:.2f} s without keys, {over:.2f} s over TLS; {ratio:.2f} times (<= {MOST})"
    )
    raise SystemExit(0 if ratio <= MOST else 1)


if __name__ == "__main__":
    main()
