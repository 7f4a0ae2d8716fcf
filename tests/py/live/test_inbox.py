# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The queue of a live session stands whatever ends its callers."""

import inspect
import sys
from types import FrameType
from typing import Any

import pytest

from oort.live.inbox import CallItem, Inbox

_LINES, _FIRST = inspect.getsourcelines(Inbox.add_call)
# Those at which a queue is half changed: what is within the lock.
_HELD = [_FIRST + k for k, line in enumerate(_LINES) if line.startswith(" " * 12)]


@pytest.mark.parametrize("line", _HELD)
def test_a_call_that_ctrl_c_ends_at_any_line_does_not_end_the_queue(line: int) -> None:
    inbox = Inbox()

    def interrupt(frame: FrameType, event: str, argument: Any) -> Any:
        if frame.f_code is Inbox.add_call.__code__:
            if event == "line" and frame.f_lineno == line:
                raise KeyboardInterrupt
            return interrupt
        return None

    before = sys.gettrace()
    sys.settrace(interrupt)
    try:
        inbox.add_call("first", ())
    except KeyboardInterrupt:
        pass
    finally:
        sys.settrace(before)
    inbox.add_call("second", ())
    names = []
    while isinstance(item := inbox.head(False, 0.0), CallItem):
        names.append(item.name)
        inbox.pop()
    assert names in (["second"], ["first", "second"])
