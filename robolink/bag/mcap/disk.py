"""The file on disk, and a thread that has the system save it."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Callable, Iterable
from io import FileIO
from pathlib import Path

from robolink.bag.mcap.records import Buffer
from robolink.system import waits
from robolink.system.files import put_in_place

NEW = ".new"
"""Suffix of a file that is being made, until it is whole and gets its name."""


class DiskFile:
    """A file that is open for writing at any place.

    Args:
        path: Path of the file, which must be there.
    """

    def __init__(self, path: Path) -> None:
        self._file = FileIO(path, "r+")
        mark_as_written(self._file)

    @classmethod
    def create(cls, path: Path, pieces: Iterable[tuple[int, Buffer]], durable: bool) -> DiskFile:
        """Make a file of pieces, each at its place, and open it; it has all of them from its first moment on.

        If `durable`, a power cut right after does not undo that.
        """
        new = path.with_name(path.name + NEW)
        try:
            with FileIO(new, "w") as file:
                make_sparse(file)
                for at, data in pieces:
                    put(file, data, at)
                if durable:
                    force(file)
            put_in_place(new, path)  # closed before: an open file cannot be replaced on Windows
        except OSError:
            with contextlib.suppress(OSError):
                new.unlink()
            raise
        if durable:
            force_name(path)
        return cls(path)

    def put(self, data: Buffer, at: int) -> None:
        """Write bytes at a place. Raises OSError; then any number of them may have been written."""
        put(self._file, data, at)

    def save(self) -> None:
        """Force all that was written to the disk. Raises OSError."""
        force(self._file)

    def cut(self, size: int) -> None:
        """Make the file this size. Raises OSError."""
        self._file.truncate(size)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


if sys.platform == "win32":

    def put(file: FileIO, data: Buffer, at: int) -> None:
        """Write bytes at a place of a file."""
        view = memoryview(data)
        file.seek(at)
        while view:
            view = view[file.write(view) :]

    def force(file: FileIO) -> None:
        """Force a file's data to the disk."""
        os.fsync(file.fileno())

    def force_name(path: Path) -> None:
        """Force a file's name to the disk: NTFS does by itself."""

    def mark_as_written(file: FileIO) -> None:
        """Let others know that a file is being written: an open file cannot be replaced here anyway."""

    def is_being_written(path: Path) -> bool:
        """True if a writer has the file open; not known here."""
        return False

    def make_sparse(file: FileIO) -> None:
        """Let holes take no room on the disk; where that cannot be had, they are filled with zeros."""
        import ctypes
        import msvcrt

        set_sparse, returned = 0x900C4, ctypes.c_ulong()
        handle = ctypes.c_void_p(msvcrt.get_osfhandle(file.fileno()))
        ctypes.windll.kernel32.DeviceIoControl(handle, set_sparse, None, 0, None, 0, ctypes.byref(returned), None)

else:
    import fcntl

    def put(file: FileIO, data: Buffer, at: int) -> None:
        """Write bytes at a place of a file."""
        view = memoryview(data)
        while view:
            count = os.pwrite(file.fileno(), view, at)
            view, at = view[count:], at + count

    def force(file: FileIO) -> None:
        """Force a file's data to the disk."""
        if sys.platform == "darwin":  # its fsync leaves data in the drive's cache
            fcntl.fcntl(file.fileno(), fcntl.F_FULLFSYNC)
        else:
            os.fdatasync(file.fileno())

    def force_name(path: Path) -> None:
        """Force a file's name to the disk, which its folder holds."""
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)

    def mark_as_written(file: FileIO) -> None:
        """Let others know that a file is being written; not all file systems can."""
        with contextlib.suppress(OSError):
            fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)

    def is_being_written(path: Path) -> bool:
        """True if a writer has the file open."""
        with FileIO(path) as file:
            try:
                fcntl.flock(file.fileno(), fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                return True
            except OSError:
                return False
        return False

    def make_sparse(file: FileIO) -> None:
        """Let holes take no room on the disk: they do by themselves here."""


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
