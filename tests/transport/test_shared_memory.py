"""Zenoh's shared memory is used only where it is safe, or where the user says so."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from robolink.exceptions import TransportError
from robolink.transport import network, shared_memory
from robolink.transport.shared_memory import LEAST_FREE, LEAST_LOCKABLE, POOL, Machine, decide, decision, this_machine

ROOMY = Machine(total=2**30, free=2**30)
TIGHT = ROOMY._replace(lockable=8 * 2**20)


def test_a_roomy_linux_machine_shares_memory() -> None:
    assert decide(ROOMY).on
    assert decide(ROOMY._replace(lockable=LEAST_LOCKABLE)).on


@pytest.mark.parametrize(
    ("machine", "reason", "remedy"),
    [
        (TIGHT, "this process may lock 8 MB of memory, and 512 MB are needed", "ulimit -l 524288"),
        (ROOMY._replace(lockable=LEAST_LOCKABLE - 1), "may lock 511 MB", "--ulimit memlock=-1"),
        (Machine(total=2**26, free=2**26), "64 MB of /dev/shm are free, and 128 MB are needed", "--shm-size=256m"),
        (Machine(), "there is no /dev/shm to write to", ""),
        (Machine("darwin"), "it is used on Linux only", ""),
        (Machine("win32"), "it is used on Linux only", ""),
    ],
)
def test_a_machine_without_room_does_not_and_says_why(machine: Machine, reason: str, remedy: str) -> None:
    found = decide(machine)
    assert not found.on
    assert reason in found.reason
    assert remedy in found.remedy
    assert bool(remedy) == bool(found.remedy)


def test_each_session_may_still_take_its_pool_of_what_is_free() -> None:
    full = ROOMY._replace(free=LEAST_FREE + 3 * POOL, sessions=3)
    assert decide(full).on
    assert "182 MB are needed beside 3 sessions" in decide(full._replace(free=full.free - 1)).reason


@pytest.mark.parametrize("machine", [ROOMY, TIGHT])
def test_the_user_has_the_last_word(machine: Machine) -> None:
    for choice in ("on", "off"):
        found = decision({shared_memory.VARIABLE: choice}, machine)
        assert found.on == (choice == "on")
        assert found.forced
    for environ in ({}, {shared_memory.VARIABLE: ""}, {shared_memory.VARIABLE: "auto"}):
        assert decision(environ, machine) == decide(machine)


def test_forced_on_without_room_says_what_is_wrong() -> None:
    found = decision({shared_memory.VARIABLE: "on"}, TIGHT)
    assert found.reason.startswith("ROBOLINK_SHARED_MEMORY=on, although this process may lock 8 MB")
    assert "ulimit" in found.remedy


def test_another_word_is_an_error_in_one_line() -> None:
    with pytest.raises(TransportError) as caught:
        decision({shared_memory.VARIABLE: "yes\n" + "s" * 1000}, ROOMY)
    assert str(caught.value).startswith("ROBOLINK_SHARED_MEMORY must be one of auto, on, off, got 'yes")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 130


def test_the_limits_of_this_machine_can_be_read() -> None:
    found = this_machine()
    assert found.free <= found.total or not found.total
    assert decide(found).reason


def shares(environ: dict[str, str], *, machine: Machine = ROOMY) -> bool:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shared_memory, "this_machine", lambda: machine)
        return bool(json.loads(network.load(None, 0, environ).get_json(network.SHARES_MEMORY)))


def test_a_session_offers_it_only_where_it_is_safe() -> None:
    assert shares({})
    assert not shares({}, machine=TIGHT)
    assert shares({shared_memory.VARIABLE: "on"}, machine=TIGHT)
    assert not shares({shared_memory.VARIABLE: "off"})


def test_zenohs_override_wins() -> None:
    on, off = ({"ZENOH_CONFIG_OVERRIDE": f"{network.SHARES_MEMORY}={word}"} for word in ("true", "false"))
    assert shares(on, machine=TIGHT)
    assert shares({**on, shared_memory.VARIABLE: "off"})
    assert not shares({**off, shared_memory.VARIABLE: "on"})
    assert not shares(
        {"ZENOH_CONFIG_OVERRIDE": "transport/shared_memory={enabled: false}", shared_memory.VARIABLE: "on"}
    )


def test_a_client_shares_no_memory_with_its_router_unless_told_so() -> None:
    client = {"ROBOLINK_NETWORK": "tcp/127.0.0.1:7447"}
    assert not shares(client)
    assert not shares({"ZENOH_CONFIG_OVERRIDE": 'mode="client"'})
    assert shares({"ZENOH_CONFIG_OVERRIDE": 'mode="peer"'})
    assert shares({**client, shared_memory.VARIABLE: "on"})
    assert "a router passes all messages on" in decision({}, ROOMY, mode="client").reason


@pytest.mark.parametrize("in_file", ["true", "false"])
def test_a_file_that_has_it_off_stays_off_and_one_that_has_it_on_needs_room(in_file: str, tmp_path: Path) -> None:
    file = tmp_path / "net.json5"
    file.write_text(f"{{mode: 'peer', transport: {{shared_memory: {{enabled: {in_file}}}}}}}")
    environ = {"ROBOLINK_NETWORK": str(file)}
    assert shares(environ) == (in_file == "true")
    assert not shares(environ, machine=TIGHT)
    assert shares({**environ, shared_memory.VARIABLE: "on"}, machine=TIGHT)


def test_calls_never_use_it() -> None:
    config = network.load(None, 0, {})
    assert json.loads(config.get_json("transport/shared_memory/transport_optimization/messages")) == ["put"]
