"""Service calls of clients: in CDR and JSON, and the reason where there is no answer."""

from __future__ import annotations

import json

import pytest

from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.serialization import deserialize_message, serialize_message
from tests.support.view_clients import shown


def set_light(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success, response.message = request.data, "lit" if request.data else "dark"
    return response


@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_a_call_is_answered(subprotocol: str) -> None:
    with shown() as system, system.spinning() as node, system.client(subprotocol) as client:
        node.create_service(SetBool, "light", set_light)
        raw = client.call("/light", serialize_message(SetBool.Request(data=True)))
        assert deserialize_message(raw, SetBool.Response).message == "lit"
        assert json.loads(client.call("/light", b'{"data": false}', "json")) == {"success": False, "message": "dark"}
        told = client.service("/light")
        assert told["type"] == "std_srvs/srv/SetBool"
        assert told["request"]["schemaName"] == "std_srvs/srv/SetBool_Request"
        assert "bool data" in told["request"]["schema"]
        assert ("requestSchema" in told) is (subprotocol == "foxglove.websocket.v1")


def test_a_service_that_goes_is_taken_back_and_calls_to_it_fail_with_a_reason() -> None:
    with shown() as system, system.spinning() as node, system.client() as client:
        service = node.create_service(Trigger, "once", lambda request, response: response)
        number = client.service("/once")["id"]
        service.destroy()
        assert client.wait_for("unadvertiseServices")["serviceIds"] == [number]
        with pytest.raises(RuntimeError, match="there is no service"):
            client.call("/once", serialize_message(Trigger.Request()))


@pytest.mark.parametrize(
    ("payload", "encoding"), [(b"", "cdr"), (b"\x00\x01", "cdr"), (b"{", "json"), (b'{"x":1}', "json")]
)
def test_a_request_that_is_none_is_refused(payload: bytes, encoding: str) -> None:
    with shown() as system, system.spinning() as node, system.client() as client:
        node.create_service(SetBool, "light", set_light)
        with pytest.raises(RuntimeError, match="/light"):
            client.call("/light", payload, encoding)
