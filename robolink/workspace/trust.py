"""Ownership and permissions: whether a workspace that was merely found may be used, much as git asks of repositories.

A workspace that nobody named is taken only if it and the folders above it belong to the user or to root, and if
nobody else may write there. So no other user's `/tmp/nodes/world.py` runs because somebody stands below `/tmp`.
"""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Collection, Iterator
from pathlib import Path

from robolink.system.files import expanded
from robolink.system.terminal import shown

SAFE = "ROBOLINK_SAFE_WORKSPACES"
"""Environment variable with folders that are used whoever owns them, separated as in PATH; `*` means all."""
REFUSED = "ROBOLINK_REFUSED_WORKSPACE"
"""Environment variable with the folder of the last warning, so that no process started from here repeats it."""
PARTS = ("", "nodes", "configs", "interfaces", "src")
"""Folders of a workspace whose owners are checked."""
_LONGEST = 300


def is_trusted(folder: Path) -> bool:
    """Return whether a workspace may be used that was only found; if not, a warning says so, once, with what to do."""
    reason = "" if _is_named_safe(folder) else why_not(folder)
    if reason and os.environ.get(REFUSED) != str(folder):
        os.environ[REFUSED] = str(folder)
        name = shown(str(folder), _LONGEST)
        _warn(f"the workspace {name} is not used: {reason}; {SAFE}={name} has it used all the same")
    return not reason


def why_not(folder: Path, trusted: Collection[int] | None = None) -> str:
    """Return the reason why a folder is not to be trusted, '' if there is none.

    `trusted` are the user ids whose folders are: by default those of the user, of root, and of whoever owns `/`.
    Windows has no such ids: there the owner must be the user, the system or the administrators, as for git.
    """
    if sys.platform == "win32":
        return "" if _is_own_on_windows(folder) else "it belongs to another user"
    ids = _trusted_ids() if trusted is None else trusted
    return next(_objections(folder, ids), "")


def _is_named_safe(folder: Path) -> bool:
    named = [each for each in os.environ.get(SAFE, "").split(os.pathsep) if each]
    return any(each == "*" or expanded(each).resolve() == folder for each in named)


def _warn(text: str) -> None:
    from robolink.logging import get_logger  # late: hardly ever needed

    get_logger("robolink.workspace").warning(text)


def _objections(folder: Path, trusted: Collection[int]) -> Iterator[str]:
    for part in PARTS:
        yield from _objections_to(folder / part, trusted, is_above=False)
    for above in folder.parents:
        yield from _objections_to(above, trusted, is_above=True)


def _objections_to(folder: Path, trusted: Collection[int], *, is_above: bool) -> Iterator[str]:
    """Yield the faults of one folder. What stands in a sticky one, as /tmp, is only its owner's to replace."""
    try:
        found = folder.stat()
    except OSError:  # a part that is not there
        return
    name = shown(str(folder), _LONGEST)
    if found.st_uid not in trusted:
        yield f"{name} belongs to {_spelled(found.st_uid)}, neither to you nor to root"
    is_sticky = is_above and found.st_mode & stat.S_ISVTX
    if found.st_mode & stat.S_IWOTH and not is_sticky and not _has_windows_modes(folder):
        yield f"everybody may write to {name} (chmod o-w)"


def _spelled(owner: int) -> str:
    if sys.platform != "win32":
        import pwd

        try:
            return f"'{pwd.getpwuid(owner).pw_name}'"
        except KeyError:
            pass
    return f"user {owner}"


def _trusted_ids() -> set[int]:
    """Return the user, root, who owns `/` (root has another number in a container's eyes), and who called sudo."""
    if sys.platform == "win32":
        return set()
    ids = {os.geteuid(), 0, Path("/").stat().st_uid}
    behind_sudo = os.environ.get("SUDO_UID", "")
    if os.geteuid() == 0 and behind_sudo.isdecimal():
        ids.add(int(behind_sudo))
    return ids


def _has_windows_modes(folder: Path) -> bool:
    """True if this is a drive of Windows within WSL, which shows all as writable by everybody."""
    is_drive = folder.parts[1:2] == ("mnt",) and len(folder.parts) > 2 and len(folder.parts[2]) == 1
    return is_drive and sys.platform != "win32" and "microsoft" in os.uname().release.lower()


if sys.platform == "win32":

    def _is_own_on_windows(folder: Path) -> bool:
        """Return whether a folder's owner is the user (or a group of theirs), the administrators or the system."""
        import ctypes
        from ctypes import wintypes

        security = ctypes.WinDLL("advapi32")
        owner, described, is_member = ctypes.c_void_p(), ctypes.c_void_p(), wintypes.BOOL()
        file_object, owner_only, administrators, system = 1, 1, 26, 22  # SE_FILE_OBJECT, OWNER_..., Win...Sid
        failed = security.GetNamedSecurityInfoW(
            ctypes.c_wchar_p(str(folder)), file_object, owner_only, ctypes.byref(owner), None, None, None,
            ctypes.byref(described),
        )  # fmt: skip
        if failed:
            return False
        try:
            if any(security.IsWellKnownSid(owner, each) for each in (administrators, system)):
                return True
            return bool(security.CheckTokenMembership(None, owner, ctypes.byref(is_member)) and is_member.value)
        finally:
            free = ctypes.WinDLL("kernel32").LocalFree
            free.argtypes = [ctypes.c_void_p]
            free(described)
