"""Ctrl-C, a closed terminal, the end of a batch job: one sentence, exit code 130, nothing half-written.

While the program loads nothing is begun yet, and it ends at once. Then a signal becomes a KeyboardInterrupt, and what
is open is closed in order. Where that is not heard in time, for compiled code or a library holds the main thread, a
thread that waits beside it takes the unfinished files away and ends the process.
"""

import os
import signal
import sys
import time

TYPE_CHECKING: bool = False  # the module typing takes as long to load as all that is needed here
if TYPE_CHECKING:
    from threading import Event

_HEARD_WITHIN = 1.0
"""Seconds in which the main thread must take notice of a signal."""
_DONE_WITHIN = 15.0
"""Seconds in which it must then have come to an end; a study that writes its table takes longer, and says so."""
_CODE = 130
_SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if hasattr(signal, name))


class _State:
    """How far the process is: `heard` and `raised` are events of the thread beside the main one, once it runs."""

    heard: "Event | None" = None
    raised: "Event | None" = None
    since = 0.0
    ended = False
    code = _CODE


def catch_signals() -> None:
    """From now on a signal ends the process with a sentence. What the parent said to ignore (`nohup`) stays ignored."""
    for number in _SIGNALS:
        if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, _end_at_once)


def close_in_order() -> None:
    """From now on a signal becomes a KeyboardInterrupt, for files may be open; in the process of a command alone."""
    if signal.getsignal(signal.SIGINT) is not _end_at_once and signal.getsignal(signal.SIGTERM) is not _end_at_once:
        return
    import threading

    _State.heard, _State.raised = threading.Event(), threading.Event()
    if os.name == "posix":
        ear, mouth = os.pipe()
        os.set_blocking(mouth, False)
        signal.set_wakeup_fd(mouth, warn_on_full_buffer=False)
        threading.Thread(target=_watch, args=(ear,), daemon=True, name="signals").start()
    sys.unraisablehook = _lost
    for number in _SIGNALS:
        if signal.getsignal(number) is _end_at_once:
            signal.signal(number, _interrupt)


def note_heard() -> None:
    """The main thread knows of the signal and brings its work to an end in its own time."""
    if _State.heard is not None:
        _State.heard.set()


def end_with(code: int) -> None:
    """All is told: a signal from now on changes nothing about the exit code."""
    _State.code, _State.ended = int(code), True


def _interrupt(number: int, frame: object) -> None:
    note_heard()
    if _State.ended:
        _end_at_once(number, frame)
    if _State.raised is None or not _State.raised.is_set():
        _State.since = time.monotonic()
        if _State.raised is not None:
            _State.raised.set()
        raise KeyboardInterrupt
    if time.monotonic() - _State.since > _HEARD_WITHIN:  # the same key struck twice would disturb the closing
        _end_at_once(number, frame)


def _end_at_once(_number: int, _frame: object) -> None:
    files = sys.modules.get("slosh_cli.results.files")
    if files is not None:
        files.remove_unfinished()
    if not _State.ended:
        _tell()
    os._exit(_State.code)


def _tell() -> None:
    """Say it past the buffers of Python, which another thread may hold."""
    try:
        if "--json" in sys.argv:
            os.write(1, b'{"error": {"code": "interrupted", "message": "interrupted", "where": ""}}\n')
        os.write(2, b"interrupted\n")
    except OSError:  # nobody can be told
        return


def _watch(ear: int) -> None:
    """End the process where the main thread does not hear of a signal, or does not come to its end.

    A batch of signals counts as one.
    """
    heard, raised = _State.heard, _State.raised
    assert heard is not None
    assert raised is not None
    while True:
        number = os.read(ear, 1)[0]
        if number not in _SIGNALS or signal.getsignal(number) in (signal.SIG_IGN, signal.SIG_DFL):
            continue
        if not heard.wait(_HEARD_WITHIN):
            _end_at_once(number, None)
        heard.clear()
        if raised.is_set():
            time.sleep(_DONE_WITHIN)
            _end_at_once(number, None)


def _lost(report: "sys.UnraisableHookArgs") -> None:
    """A KeyboardInterrupt that came up inside a finaliser or a callback goes no further by itself: raise it again."""
    if not issubclass(report.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(report)
        return
    import threading

    if _State.raised is not None:
        _State.raised.clear()
    threading.Timer(0.05, signal.raise_signal, (signal.SIGINT,)).start()
