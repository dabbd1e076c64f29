"""Program of the fuzz: a bag that is played in a loop and paused, steered by rosbag2's services."""

import tempfile
from pathlib import Path

import robolink
from robolink import Node
from robolink.bag.playing import Player, PlaySettings
from robolink.bag.playing.services import PlayerServices
from tests.support.players import counting

robolink.init()
node = Node("rosbag2_player")
bag = counting(Path(tempfile.mkdtemp(dir=Path.cwd()), "bag"))
player = Player(node, [bag], PlaySettings(loop=True, start_paused=True))
player.start()
services = PlayerServices(node, player.playback)
try:
    robolink.spin(node)
finally:
    player.close()
