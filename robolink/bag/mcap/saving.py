"""Thread that forces a file to the disk now and then, while its writer goes on: a slow disk holds nobody up."""

from __future__ import annotations

import threading
from collections.abc import Callable

from robolink.system import waits


class BackgroundSave:
    """Runs of a function on a thread, one at a time.

    Args:
        save: Function that forces the file to the disk; it raises OSError.
    """

    def __init__(self, save: Callable[[], None]) -> None:
        self._save = save
        self._thread: threading.Thread | None = None
        self._error: OSError | None = None

    def is_free(self) -> bool:
        """True if no run goes on. Raises the OSError of the one before, if that failed."""
        if self._thread is not None and self._thread.is_alive():
            return False
        self.wait()
        return True

    def start(self) -> None:
        """Start a run. There must be none."""
        self._thread = threading.Thread(target=self._run, name="bag-save", daemon=True)
        self._thread.start()

    def wait(self) -> None:
        """Wait for the run that goes on. Raises its OSError if it failed."""
        thread, self._thread = self._thread, None
        if thread is not None:
            waits.join(thread)
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _run(self) -> None:
        try:
            self._save()
        except OSError as error:
            self._error = error
