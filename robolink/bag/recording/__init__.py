"""Recorder of bags: what topics publish, into a bag that is valid at every moment."""

from robolink.bag.recording.recording import Figures, News, Recording, RecordingError
from robolink.bag.recording.topics import RecordSettings
from robolink.bag.selection import Selection, SelectionError

__all__ = ["Figures", "News", "RecordSettings", "Recording", "RecordingError", "Selection", "SelectionError"]
