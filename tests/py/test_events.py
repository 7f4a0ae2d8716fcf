# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import pytest

from oort import InputError
from oort.events import Event, EventLog, read_events


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_reads_in_the_order_of_the_file(tmp_path: Path) -> None:
    path = write(
        tmp_path / "e.json", '[{"t": 2, "call": "map/stop"}, {"t": 1.5, "call": "map/start", "args": ["/a/map"]}]'
    )
    assert read_events(path) == [Event(2.0, "map/stop", []), Event(1.5, "map/start", ["/a/map"])]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("{", "not JSON"),
        ("{}", "a JSON list"),
        ("[1]", "event 0"),
        ('[{"t": 1}]', "event 0"),
        ('[{"t": 1, "call": "x", "arg": []}]', '"args"'),
        ('[{"t": "1", "call": "x"}]', '"t" must be a finite number'),
        ('[{"t": NaN, "call": "x"}]', '"t" must be a finite number'),
        ('[{"t": -Infinity, "call": "x"}]', '"t" must be a finite number'),
        ('[{"t": 1%s, "call": "x"}]' % (400 * "0"), '"t" must be a finite number'),
        ('[{"t": 1, "call": 2}]', '"call" must be a string'),
    ],
)
def test_says_what_is_wrong(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint) as caught:
        read_events(write(tmp_path / "e.json", text))
    assert "e.json" in str(caught.value)


def test_missing_file() -> None:
    with pytest.raises(InputError, match="nowhere\\.json"):
        read_events("nowhere.json")


def test_a_log_keeps_the_one_before(tmp_path: Path) -> None:
    path = tmp_path / "log.json"
    for name in ("map/start", "map/stop"):
        log = EventLog(path)
        log.add(1.0, name, [])
        log.close()
    assert [event.call for event in read_events(path)] == ["map/stop"]
    assert [event.call for event in read_events(f"{path}.1")] == ["map/start"]
