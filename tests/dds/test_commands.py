"""Commands on DDS: what others see of them."""

from __future__ import annotations

import pytest

from robolink.rtps import Participant
from tests.dds.peers import until
from tests.support.commands import Command
from tests.support.domains import free_dds_domain

pytestmark = pytest.mark.processes


@pytest.mark.parametrize("words", [("topic", "list"), ("node", "list")])
def test_a_command_that_looks_says_goodbye(words: tuple[str, ...]) -> None:
    """Its node would be shown for 20 s more: that is the lease of who just ends."""
    came: list[bytes] = []
    went: list[bytes] = []
    with free_dds_domain() as domain:
        witness = Participant(domain, on_peer=lambda peer, is_here: (came if is_here else went).append(peer.prefix))
        try:
            with Command(domain, *words, environ={"ROBOLINK_NETWORK": "dds"}) as command:
                assert command.end() == 0, command.errors
            until(lambda: came, "the command is met")
            until(lambda: not witness.peers(), "the command is gone", 3.0)
        finally:
            witness.close()
    assert set(went) == set(came)
