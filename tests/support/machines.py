"""Two machines that a cable joins, in network namespaces: programs there, and commands of robolink here."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import ExitStack
from typing import Any

from tests.support import stalls
from tests.support.domains import free_domain

HERE, THERE = "10.77.0.1", "10.78.0.1"

ROUTER = """
import json, sys, zenoh
listen = {"mode": "router", "listen": {"endpoints": ["tcp/0.0.0.0:7447"]}}
session = zenoh.open(zenoh.Config.from_json5(json.dumps(listen | {"scouting": {"multicast": {"enabled": False}}})))
"""
NODE = """
import os, sys
from robolink.transport import open_zenoh
domain = int(os.environ["ROS_DOMAIN_ID"])
session = open_zenoh(domain)
token = session.announce(f"@ros2_lv/{domain}/{session.session_id}/0/0/NN/%/%/" + sys.argv[1])
"""
WAIT = "\nprint('ready', flush=True)\nsys.stdin.read()\n"


class Machines:
    """Two machines that a cable joins; `here` is the one on which commands are tried."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self.here, self.there = stack.enter_context(stalls.two_routed_hosts())
        self.domain = stack.enter_context(free_domain())

    def start(self, host: str, code: str, *arguments: str, **environ: str) -> subprocess.Popen[str]:
        """Run a program there until the test ends; it is ready."""
        command = ["ip", "netns", "exec", host, sys.executable, "-c", code + WAIT, *arguments]
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        child = self._stack.enter_context(subprocess.Popen(command, env=self.environ(environ), **pipes))
        self._stack.callback(child.kill)
        assert child.stdout
        assert child.stdout.readline() == "ready\n"
        return child

    def command(self, host: str, *words: str, **environ: str) -> None:
        """Run a command of robolink there until the test ends; it has printed its first line."""
        command = ["ip", "netns", "exec", host, sys.executable, "-m", "robolink", *words]
        process = subprocess.Popen(command, env=self.environ(environ), stdout=subprocess.PIPE, text=True)
        self._stack.enter_context(process)
        self._stack.callback(process.kill)
        assert process.stdout
        assert process.stdout.readline().startswith("robolink ")

    def doctor(self, **environ: str) -> dict[str, Any]:
        """Run `robolink doctor --json --report` here; give it, with the checks by name."""
        done = self.run_here([sys.executable, "-m", "robolink", "doctor", "--json", "--report"], **environ)
        assert done.stderr == ""
        found: dict[str, Any] = json.loads(done.stdout)
        return found | {"checks": {each["name"]: each for each in found["checks"]}}

    def run_here(self, command: list[str], **environ: str) -> subprocess.CompletedProcess[str]:
        """Run a command here until it ends."""
        whole = ["ip", "netns", "exec", self.here, *command]
        environ_ = self.environ(environ)
        return subprocess.run(whole, env=environ_, capture_output=True, text=True, check=False, timeout=120)

    def environ(self, given: dict[str, str]) -> dict[str, str]:
        """The variables of a program: none of this shell's own that concern robolink, but these."""
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        return clean | {"ROS_DOMAIN_ID": str(self.domain)} | given


def nodes(found: dict[str, Any]) -> list[str]:
    """The nodes that a doctor has seen."""
    return sorted(value.split()[0] for _, value in found["report"]["NODE LIST"])
