"""Playing of bags: their messages are published again, as fast as they were recorded, in real or virtual time."""

from robolink.bag.playing.player import Player
from robolink.bag.playing.settings import PlayError, PlaySettings

__all__ = ["PlayError", "PlaySettings", "Player"]
