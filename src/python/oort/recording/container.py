# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The files that a bag is kept in: one or several, a folder, packed, cut or whole; all are opened the same way."""

import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag2 import Reader as Reader2
from rosbags.rosbag2.storage_mcap import McapReader
from rosbags.typesys import Stores, get_typestore

from oort.errors import InputError, OortError
from oort.recording.packed import DAMAGED, PACKED
from oort.recording.salvage import CutMcap, ScanningMcap, ScanningReader, TemporaryCopy, salvage_database

BAG_MAGIC = {  # first bytes -> the suffix that the bag library knows this kind by, and its name
    b"#ROSBAG V2.0\n": (".bag", "ROS 1 bag"),
    b"\x89MCAP0\r\n": (".mcap", "ROS 2 bag"),
    b"SQLite format 3\0": (".db3", "ROS 2 bag"),
}
_ADVICE = {
    ".bag": "'rosbag reindex' may repair it",
    ".mcap": "'mcap recover' may repair it",
    ".db3": "the sqlite3 tool's '.recover' may repair it",
}


@dataclass(frozen=True)
class _Part:
    """How one file of a bag, or the folder, is opened."""

    path: Path
    open: Callable[[], Reader1 | Reader2]
    keep: object = None
    """what must last as long as this: temporary files"""
    end: Callable[[Reader1 | Reader2], int] = lambda _: 0
    """how many bytes of a salvaged file are used; 0 if that is not known"""


@dataclass(frozen=True)
class Container:
    """A bag that can be opened any number of times."""

    path: Path
    """what the user named, for messages"""
    kind: str
    """"ROS 1 bag" or "ROS 2 bag" """
    parts: tuple[_Part, ...]
    notes: tuple[str, ...] = ()

    @contextmanager
    def opened(self) -> Iterator[AnyReader]:
        """A reader of the bag; whatever goes wrong in reading a damaged one becomes an InputError."""
        try:
            reader = AnyReader([part.path for part in self.parts], default_typestore=get_typestore(Stores.LATEST))
            reader.is2 = self.kind == "ROS 2 bag"
            reader.readers = [part.open() for part in self.parts]  # type: ignore[assignment]
            with reader:
                yield reader
        except OortError:
            raise
        except Exception as error:  # the bag library's errors have no common root, and damage shows in many ways
            raise _unreadable(self.path, error) from error


def find_container(paths: Sequence[Path]) -> Container | None:
    """The bag that is kept in the files or the folder, or None if these are no bag.

    Raises InputError for a bag that cannot be read at all, and for several files that are not bags of one kind.
    """
    found = [_one(path.parent if path.name == "metadata.yaml" else path) for path in paths]
    containers = [container for container in found if container is not None]
    if len(containers) < len(found) and len(paths) > 1:
        other = next(path for path, container in zip(paths, found, strict=True) if container is None)
        raise InputError(f"{other} is no bag: only the parts of a bag that was split can be given together")
    if not containers:
        return None
    if len({container.kind for container in containers}) > 1:
        raise InputError(f"{paths[0]} and the others are bags of ROS 1 and of ROS 2: give the parts of one recording")
    notes = [note for container in containers for note in container.notes]
    if len(containers) > 1:
        notes.insert(0, f"read as one recording: {', '.join(path.name for path in paths)}")
    parts = tuple(part for container in containers for part in container.parts)
    return Container(containers[0].path, containers[0].kind, parts, tuple(notes))


def _one(path: Path) -> Container | None:
    if path.is_dir():
        return _folder(path)
    with path.open("rb") as stream:
        head = stream.read(16)
    for magic, open_packed in PACKED.items():
        if head.startswith(magic):
            return _packed(path, open_packed)
    for magic, (suffix, kind) in BAG_MAGIC.items():
        if head.startswith(magic):
            if path.suffix != suffix:
                raise InputError(f"{path} is a {kind}, but not named so; rename it to end in {suffix}")
            part, note = _file(path)
            return Container(path, kind, (part,), (note,) if note else ())
    return None


def _packed(path: Path, open_packed: Callable[..., Any]) -> Container | None:
    """What is packed, unpacked into a file that lasts as long as the container; None for what is no bag."""
    cut = ""
    try:
        with open_packed(path) as stream:
            head = stream.read(16)
            magic = next((magic for magic in BAG_MAGIC if head.startswith(magic)), None)
            if magic is None:
                return None
            suffix, kind = BAG_MAGIC[magic]
            copy = TemporaryCopy(suffix)
            with copy.path.open("wb") as target:
                target.write(head)
                try:
                    shutil.copyfileobj(stream, target)
                except DAMAGED as error:
                    cut = f"{path.name} cannot be unpacked to its end ({error})"
    except DAMAGED:
        return None
    part, note = _file(copy.path, path)
    notes = (f"{path.name} was unpacked to be read", cut, note)
    return Container(path, kind, (replace(part, keep=(copy, part.keep)),), tuple(filter(None, notes)))


def _folder(path: Path) -> Container | None:
    """A ROS 2 bag: as its metadata.yaml says or, where that is missing or cannot be used, the files that are there."""
    metadata = path / "metadata.yaml"
    why = "there is no metadata.yaml"
    if metadata.is_file():
        try:
            for database in path.glob("*.db3"):
                _check_database_size(database)
            with Reader2(path):
                return Container(path, "ROS 2 bag", (_Part(path, lambda: Reader2(path)),))
        except Exception as error:  # see Container.opened()
            why, damage = f"it cannot be read as metadata.yaml says ({error})", error
        if re.search("compression_mode: *['\"]?(file|message)", metadata.read_text(errors="replace"), re.IGNORECASE):
            raise _unreadable(path, damage) from damage
    files = sorted((f for f in path.iterdir() if f.suffix in (".mcap", ".db3")), key=lambda f: _natural(f.name))
    if not files:
        raise InputError(_no_bag(path, metadata.is_file()))
    containers = [container for container in map(_one, files) if container is not None]
    if len(containers) < len(files):
        raise InputError(f"{path} holds files that are no bags though they are named so; give those that are")
    names = ", ".join(file.name for file in files)
    notes = [f"{path.name}: {why}{_listed(metadata)}; what is there is read: {names}"]
    notes += [note for container in containers for note in container.notes]
    parts = tuple(part for container in containers for part in container.parts)
    return Container(path, "ROS 2 bag", parts, tuple(notes))


def _listed(metadata: Path) -> str:
    """How many messages a metadata.yaml lists, as a phrase."""
    text = metadata.read_text(errors="replace") if metadata.is_file() else ""
    counts = [int(count) for count in re.findall(r"message_count: *(\d{1,18})\b", text)]
    return f" with {max(counts)} messages" if counts else ""


def _no_bag(path: Path, has_metadata: bool) -> str:
    bags = sorted((file.name for file in path.glob("*.bag*")), key=_natural)
    if bags:
        return f"{path} is a folder of ROS 1 bags: give the bag, or all the parts of one that was split: {bags[:9]}"
    if maps := sorted(file.stem for file in path.glob("*.map_capnp")):
        return f"{path} is a folder with a saved map, {path / maps[0]}, not a recording"
    if has_metadata:
        return f"{path} holds a metadata.yaml, but no .mcap or .db3 file: the files that it lists are gone"
    return f"{path} is a directory without metadata.yaml and without a .mcap or .db3 file, so not a ROS 2 bag"


def _natural(name: str) -> list[tuple[int, str]]:
    """A key that sorts a_10 after a_9."""
    return [(int(word), "") if word.isdecimal() else (-1, word) for word in re.split(r"(\d+)", name)]


def _file(path: Path, named: Path | None = None) -> tuple["_Part", str]:
    """How to read one file, which the user knows as ``named``, and a note if it is not as it should be."""
    named = named or path
    kind: type[Reader1] | type[Reader2] = Reader1 if path.suffix == ".bag" else Reader2
    try:
        _check_database_size(path)
        with kind(path) as reader:
            if isinstance(reader, Reader2) and isinstance(reader.storage, McapReader) and not reader.storage.chunks:
                return _Part(path, lambda: _scanning_mcap(path, path)), ""
            return _Part(path, lambda: kind(path)), ""
    except Exception as error:  # see Container.opened()
        damage = error
    part = _salvaged(path)
    count = 0
    if part is not None:
        with suppress(Exception), part.open() as reader:
            count, seconds = reader.message_count, reader.duration / 1e9
            end = part.end(reader)
    if part is None or not count:
        raise _unreadable(named, damage) from damage
    size = path.stat().st_size
    if end == size:
        return part, f"the index of {named.name} is missing or damaged: it was read without it, {count} messages"
    where = f" in {end} of {size} bytes" if end else ""
    return part, (
        f"{named.name} is cut short or was not ended properly: read up to there, {count} messages over "
        f"{seconds:.1f} s{where}"
    )


def _salvaged(path: Path) -> "_Part | None":
    """How to read what is whole of a damaged file."""
    if path.suffix == ".bag":
        return _Part(path, lambda: ScanningReader(path), end=lambda reader: int(getattr(reader, "end", 0)))
    if path.suffix == ".mcap":
        cut = CutMcap(path)
        return _Part(path, lambda: _scanning_mcap(path, cut), end=lambda _: cut.end)
    copy = salvage_database(path)
    return _Part(copy.path, lambda: Reader2(copy.path), keep=copy) if copy else None


def _scanning_mcap(path: Path, file: Path | CutMcap) -> Reader2:
    reader = Reader2(path)
    reader.storage = ScanningMcap(file)  # type: ignore[arg-type]  # it opens the path and nothing else
    return reader


def _unreadable(path: Path, error: Exception) -> InputError:
    if isinstance(error, InputError):
        return error
    advice = next((advice for suffix, advice in _ADVICE.items() if suffix in path.suffixes), "")
    return InputError(
        f"{path} cannot be read ({type(error).__name__}: {error}): it is damaged or cut short. Copy it again"
        + (f"; {advice}" if advice else "")
    )


def _check_database_size(path: Path) -> None:
    """Refuses a cut SQLite file: SQLite itself would read zeros for the missing part of the last page."""
    with path.open("rb") as stream:
        header = stream.read(100)
    if not header.startswith(b"SQLite format 3\0") or len(header) < 100:
        return
    page_size = int.from_bytes(header[16:18], "big")
    pages = int.from_bytes(header[28:32], "big")
    expected = (65536 if page_size == 1 else page_size) * pages
    if header[24:28] == header[92:96] and path.stat().st_size < expected:  # else the count of pages is not kept
        raise InputError(f"{path} is cut short: it has {path.stat().st_size} of {expected} bytes; copy it again")
