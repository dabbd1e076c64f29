"""The services of a player: one call never keeps the others waiting."""

from __future__ import annotations

from pathlib import Path

from robolink.bag.playing import Player, PlaySettings
from robolink.bag.playing.services import PlayerServices
from robolink.interfaces.rosbag2_interfaces.srv import Burst, GetRate, Resume
from robolink.testing import System
from tests.support.players import counting


def test_a_burst_of_a_loop_that_never_ends_leaves_other_services_their_turn(system: System, tmp_path: Path) -> None:
    player = Player(system.node, [counting(tmp_path / "bag")], PlaySettings(loop=True, start_paused=True))
    services = PlayerServices(system.node, player.playback)
    player.start()
    bursting = system.node.create_client(Burst, "/test/burst").call_async(Burst.Request(num_messages=10**9))
    assert system.call(GetRate, "/test/get_rate").rate == 1.0
    assert not bursting.done()
    system.call(Resume, "/test/resume")
    assert 0 < system.result(bursting).actually_burst < 10**9
    services.destroy()
    player.close()


def test_a_burst_of_zero_ends_with_the_round(system: System, tmp_path: Path) -> None:
    player = Player(system.node, [counting(tmp_path / "bag")], PlaySettings(loop=True, start_paused=True))
    services = PlayerServices(system.node, player.playback)
    player.start()
    assert system.call(Burst, "/test/burst").actually_burst == 5
    assert system.call(Burst, "/test/burst", Burst.Request(num_messages=12)).actually_burst == 12
    services.destroy()
    player.close()
