# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Atomic writing, and decimals."""

import os
import tempfile
from pathlib import Path

import pytest

from oort.errors import InputError, OortError
from oort.export.files import decimal, make_folder, write_atomically
from oort.inputs import floats


def test_a_write_replaces_the_file_and_leaves_nothing_behind(tmp_path: Path) -> None:
    path = tmp_path / "map.pgm"
    path.write_bytes(b"old")
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_is_made_or_told_of_before_the_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make_folder(tmp_path / "new" / "maps")
    assert list((tmp_path / "new" / "maps").iterdir()) == []
    (tmp_path / "file").write_text("")
    with pytest.raises(OortError, match="file is no folder; choose another path"):
        make_folder(tmp_path / "file")
    for bad in ("file/maps", "a\0b"):
        with pytest.raises(OortError, match=r"nothing can be written into .*; check who may write there"):
            make_folder(tmp_path / bad)

    def refused(**_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(tempfile, "TemporaryFile", refused)  # who runs the tests may write everywhere
    with pytest.raises(OortError, match=r"into .*maps: Permission denied"):
        make_folder(tmp_path / "new" / "maps")


def test_a_failed_write_keeps_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "map.pgm"
    path.write_bytes(b"old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OortError, match=r"map\.pgm cannot be written: No space left on device"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_missing_directory_is_named(tmp_path: Path) -> None:
    with pytest.raises(OortError, match="none/a cannot be written: No such file or directory"):
        write_atomically(tmp_path / "none" / "a", b"")


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.05, "0.05"), (-0.0, "0.0"), (1.0, "1.0"), (1e-7, "0.0000001"), (1e22, "10000000000000000000000.0"), (2, "2.0")],
)
def test_decimal(value: float, text: str) -> None:
    assert decimal(value) == text
    assert float(text) == value


def test_decimal_reads_back_to_the_same_bits() -> None:
    for value in (0.1 + 0.2, 1 / 3, -2.2010250000000003, 5e-324, 976052857.33753):
        assert float(decimal(value)) == value


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_decimal_refuses_what_is_not_finite(value: float) -> None:
    with pytest.raises(InputError, match="must be finite"):
        decimal(value)


def test_floats_name_the_place() -> None:
    assert floats(["1", "2.5"], "a: line 1") == [1.0, 2.5]
    for field in ("x", "nan"):
        with pytest.raises(InputError, match="a: line 7: expected finite numbers, not"):
            floats(["1", field], "a: line 7")
