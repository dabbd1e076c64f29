"""Watch over how well scans fit to the map: a robot that was carried away is noticed by it.

As in Thrun's augmented MCL (Probabilistic Robotics, table 8.3) a fast average is compared with a slow one. What is
averaged is the share of the beams that end near a wall of the map, as seen from the estimated pose.
"""

from __future__ import annotations

USUAL, POOR = 0.75, 0.5
"""Scans fit badly below these shares: of the usual fit, and of all beams."""
FAST, SLOW = 0.2, 0.01
"""Rates of the averages where none are given."""
FEWEST = 5
"""Least number of scans from which one can tell."""


class FitWatch:
    """Averages of the fit of scans, each a share up to 1.

    Args:
        slow: Rate of the average that stands for the usual fit, for each scan; 0 for `SLOW`.
        fast: Rate of the average of the last scans; 0 for `FAST`.
    """

    def __init__(self, slow: float = 0.0, fast: float = 0.0) -> None:
        self._slow, self._fast, self._scans = slow or SLOW, fast or FAST, 0
        self.usual = self.recent = 0.0

    def note(self, fit: float) -> None:
        """Note the fit of a scan. At first the averages are plain; a bad fit does not make the usual one worse."""
        self._scans += 1
        self.recent += max(self._fast, 1.0 / self._scans) * (fit - self.recent)
        if fit >= USUAL * self.usual:
            self.usual += max(self._slow, 1.0 / self._scans) * (fit - self.usual)

    @property
    def is_bad(self) -> bool:
        """True if scans have fitted badly for a while."""
        return self._scans >= FEWEST and self.recent < max(USUAL * self.usual, POOR)

    def begin_again(self) -> None:
        """Take the last scans as usual ones: the next ones have to fit badly for a while before `is_bad`."""
        self.recent = max(self.usual, POOR)
