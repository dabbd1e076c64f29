"""service call and list beside servers in processes of their own."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.domains import free_domain
from tests.support.programs import Program

SERVER = """
import os, time
import robolink as rclpy
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.message import Message, Service, int64

class Add(Service):
    class Request(Message):
        a: int64
        b: int64
    class Response(Message):
        sum: int64

def add(request, response):
    response.sum = request.a + request.b
    return response

def die(request, response):
    print("asked", flush=True)
    time.sleep(60)

rclpy.init()
node = rclpy.create_node("server")
node.create_service(Trigger, "die", die)
node.create_service(Add, "add", add)
print("up", flush=True)
rclpy.spin(node)
"""


@pytest.fixture
def server(tmp_path: Path, domain: int) -> Iterator[Program]:
    with Program(tmp_path, SERVER, domain) as program:
        assert program.line() == "up"
        yield program


@pytest.mark.processes
@pytest.mark.usefixtures("server")
def test_a_type_that_only_the_server_knows_is_called(domain: int) -> None:
    with Command(domain, "service", "call", "/add", "{a: 2, b: 40}", program=BUSY_ROBOLINK) as caller:
        assert caller.end() == 0
    said = [each.text for each in caller.lines]
    assert said[0].endswith(".srv.Add_Request(a=2, b=40)")
    assert (said[1:3], caller.errors) == (["", "response:"], [])
    assert said[3].endswith(".srv.Add_Response(sum=42)")


@pytest.mark.processes
def test_a_server_that_is_killed_during_the_call(server: Program, domain: int) -> None:
    with Command(domain, "service", "call", "/die", "--timeout", "20") as caller:
        assert server.line() == "asked"
        server.kill()
        assert caller.end() == 1
        assert caller.errors[-1].text == "robolink: service /die: nobody serves it, or the server went away"


@pytest.mark.processes
@pytest.mark.parametrize(("words", "line"), [(["/die"], "requester"), (["/nobody"], "waiting for service")])
def test_ctrl_c_ends_a_waiting_process_quietly(server: Program, domain: int, words: list[str], line: str) -> None:
    with Command(domain, "service", "call", *words, "--timeout", "20", program=BUSY_ROBOLINK) as caller:
        caller.wait_for(line)
        caller.interrupt()
        assert (caller.end(), caller.errors) == (130, [])


LOOKS_AT_ONE_DOMAIN = """
import sys
from robolink.cli.shared import graph
from robolink.cli.main import main
from robolink.transport import joining, zenoh_handles

graph.MOST, graph.PORTS_WITHIN = 300, 5.0
zenoh_handles.PATIENCE, zenoh_handles.LONGEST, joining.LINK_WITHIN = 5.0, 30.0, 30.0
met, wanted = graph._met_on_this_machine, int(sys.argv.pop(1))
graph._met_on_this_machine = lambda own: [each for each in met(own) if each == wanted]
sys.exit(main())
"""
"""Other tests have their own domains meanwhile, and only the first few are looked at."""


@pytest.mark.processes
@pytest.mark.usefixtures("server")
def test_another_process_learns_on_which_domain_the_service_is(domain: int) -> None:
    program = (sys.executable, "-c", LOOKS_AT_ONE_DOMAIN, str(domain))
    with free_domain() as other, Command(other, "service", "call", "/die", "--timeout", "3", program=program) as caller:
        assert caller.end() == 1
    reason = f"nobody serves /die on domain {other}; it is on domain {domain}: set ROS_DOMAIN_ID={domain}"
    assert [each.text for each in caller.errors] == [f"waiting: {reason}", f"robolink: gave up after 3 s: {reason}"]
