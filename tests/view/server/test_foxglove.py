"""Foxglove's own client library, in node, on both of its subprotocols."""

from __future__ import annotations

import json
import subprocess
import threading
from pathlib import Path

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Float64
from robolink.interfaces.std_srvs.srv import SetBool
from tests.support import node_modules
from tests.support.view_clients import shown

SCRIPT = Path(__file__).with_name("foxglove.mjs")


def switch(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success, response.message = request.data, "lit"
    return response


@pytest.mark.processes
@pytest.mark.parametrize("subprotocol", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_foxgloves_client_subscribes_publishes_calls_and_sets(subprotocol: str) -> None:
    node_modules.need("@foxglove/ws-protocol", "@foxglove/rosmsg", "@foxglove/rosmsg2-serialization", "ws")
    with shown() as system:
        node = system.node
        scans = node.create_publisher(LaserScan, "scan", 10)
        echo = node.create_publisher(Float64, "echo", 10)
        node.create_subscription(Twist, "order", lambda twist: echoes.append(twist.linear.x), 10)
        echoes: list[float] = []
        node.create_service(SetBool, "light", switch)
        node.declare_parameter("speed", 0.5)
        scan = LaserScan(ranges=[1.5] * 360)
        scan.header.frame_id = "laser"
        ended = threading.Event()

        def publish() -> None:
            while not ended.wait(0.05):
                scans.publish(scan)
                if echoes:
                    echo.publish(Float64(data=echoes[0]))

        publishing = threading.Thread(target=publish)
        with system.spinning():
            publishing.start()
            try:
                address = f"ws://127.0.0.1:{system.view.port}/?token={system.view.token}"
                command = node_modules.command(SCRIPT, address, subprotocol)
                ran = subprocess.run(
                    command, env=node_modules.environment(), capture_output=True, text=True, timeout=60, check=False
                )
            finally:
                ended.set()
                publishing.join()
    assert ran.returncode == 0, ran.stderr
    found = json.loads(ran.stdout)
    assert found["errors"] == []
    assert found["subprotocol"] == subprotocol
    assert {"clientPublish", "services", "parameters", "connectionGraph"} <= set(found["info"]["capabilities"])
    assert found["scan"] == {"frame": "laser", "beams": 360, "first": 1.5}
    assert found["echo"] == 0.25
    assert found["answer"] == {"call": 7, "success": True, "message": "lit"}
    assert (found["parameter"], found["set"]) == (0.5, 2)
    assert found["graph"]["/scan"] == ["/robot"]


def test_a_read_only_client_is_not_offered_what_would_be_refused() -> None:
    with shown() as system:
        system.node.create_service(SetBool, "/robot/switch", lambda request, response: response)
        with system.spinning():
            with system.client("foxglove.sdk.v1") as client:
                assert {"clientPublish", "services", "parameters"} <= set(client.wait_for("serverInfo")["capabilities"])
                client.service("/robot/switch")
            with system.client("foxglove.sdk.v1", token=False) as client:
                offered = set(client.wait_for("serverInfo")["capabilities"])
                assert {"clientPublish", "services"} & offered == set()
                assert {"parameters", "parametersSubscribe"} <= offered  # to read them
                client.settle()
                assert all(each["op"] != "advertiseServices" for each in client.heard)
