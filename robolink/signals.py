"""Signal handlers for Ctrl-C and SIGTERM: they end every context and the spinning, without a traceback."""

from __future__ import annotations

import signal
import sys
import threading
import weakref
from enum import IntFlag
from types import FrameType, TracebackType
from typing import Any, Protocol

from robolink.exceptions import ExternalShutdownException, InterruptedByUser
from robolink.system import exit_code


class Interruptible(Protocol):
    """Context as seen by a signal handler."""

    def ok(self) -> bool:
        """True from its beginning to its end."""

    def interrupt(self, *, by_sigterm: bool = False) -> None:
        """End the spinning, as Ctrl-C does.

        Args:
            by_sigterm: True if SIGTERM came instead.
        """


class SignalHandlerOptions(IntFlag):
    """Signals to handle; the numbers are rclpy's."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_contexts: weakref.WeakSet[Interruptible] = weakref.WeakSet()
_before: dict[int, Any] = {}
_received = 0
_quiet = False

_NUMBERS = {SignalHandlerOptions.SIGINT: [signal.SIGINT], SignalHandlerOptions.SIGTERM: [signal.SIGTERM]}
if sys.platform == "win32":
    _NUMBERS[SignalHandlerOptions.SIGINT].append(signal.SIGBREAK)  # what a launcher can send to a process of its own

_ENDS = (KeyboardInterrupt, ExternalShutdownException)
"""Exceptions by which a program is told to end; InterruptedByUser is both."""


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Handle the signals `options` from now on. Only Python's main thread can: elsewhere nothing happens."""
    if threading.current_thread() is not threading.main_thread():
        return
    for flag, numbers in _NUMBERS.items():
        for number in numbers:
            if flag in options and number not in _before:
                _before[number] = signal.getsignal(number)  # first: the handler needs it from the moment it is set
                signal.signal(number, _on_signal)
    if options:
        _end_quietly()


def uninstall_signal_handlers() -> None:
    """Restore the handlers of before. Only Python's main thread can: elsewhere nothing happens."""
    if threading.current_thread() is not threading.main_thread():
        return
    for number, handler in list(_before.items()):
        signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        _before.pop(number, None)  # last: the handler needs it until the moment it is replaced


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals that are handled now."""
    found = SignalHandlerOptions.NO
    if signal.SIGINT in _before:
        found |= SignalHandlerOptions.SIGINT
    if signal.SIGTERM in _before:
        found |= SignalHandlerOptions.SIGTERM
    return found


def watch(context: Interruptible) -> None:
    """Interrupt this `context` when a signal comes."""
    _contexts.add(context)


def _on_signal(number: int, frame: FrameType | None) -> None:
    """End the contexts, and break into what the main thread does, as Ctrl-C does in any Python program."""
    global _received
    _received = number
    running = [context for context in list(_contexts) if context.ok()]
    for context in running:
        context.interrupt(by_sigterm=number == signal.SIGTERM)
    before = _before.get(number)
    if before in (signal.default_int_handler, signal.SIG_DFL):
        # Ctrl-C is not an Exception, as everywhere in Python: event loops (tornado's) log every Exception and go on. So
        # is SIGTERM where nobody spins; who does makes an ExternalShutdownException of it, as rclpy has it.
        raise InterruptedByUser if running and number == signal.SIGTERM else KeyboardInterrupt
    if callable(before):
        before(number, frame)


def _end_quietly() -> None:
    """Let programs and threads end without a traceback that do not catch what ends them.

    The exit code is the shell's for a program that a signal ended: 130 for Ctrl-C, 143 for SIGTERM.
    """
    global _quiet
    if _quiet:
        return
    _quiet = True
    show, show_in_thread = sys.excepthook, threading.excepthook

    def on_error(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if _received and issubclass(kind, _ENDS):
            code = 128 + (signal.SIGTERM if _received == signal.SIGTERM else signal.SIGINT)
            exit_code.note(code)
            exit_code.write_files()
            raise SystemExit(code)
        from robolink.text.tracebacks import misspelt_field  # late: few programs end by such an error

        field = misspelt_field(error)
        if field:
            error.args = (f"{error}{field}",)
        show(kind, error, trace)

    def on_error_in_thread(args: threading.ExceptHookArgs) -> None:
        if not issubclass(args.exc_type, _ENDS):
            show_in_thread(args)

    sys.excepthook, threading.excepthook = on_error, on_error_in_thread
