# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Reads bags that were cut, not ended properly or written with a wrong index, up to where they are whole."""

import io
import os
import shutil
import sqlite3
import struct
import tempfile
import weakref
from collections import Counter
from collections.abc import Collection, Generator
from contextlib import closing, suppress
from pathlib import Path
from typing import IO

from rosbags.interfaces import Connection
from rosbags.rosbag1 import Reader as Reader1
from rosbags.rosbag1.reader import (
    Chunk,
    ChunkInfo,
    Header,
    IndexData,
    ReaderError,
    RecordType,
    decompressors,
    read_uint32,
)
from rosbags.rosbag2.storage_mcap import McapReader

_MCAP_MAGIC = b"\x89MCAP0\r\n"
_FOOTER, _CHUNK, _DATA_END = 0x02, 0x06, 0x0F  # kinds of records
_MCAP_TAIL = bytes([_FOOTER]) + struct.pack("<QQQI", 20, 0, 0, 0) + _MCAP_MAGIC  # a footer that names no summary


class TemporaryCopy:
    """A file that lasts as long as this object."""

    def __init__(self, suffix: str) -> None:
        """An empty file whose name ends in ``suffix``."""
        descriptor, name = tempfile.mkstemp(suffix, "oort-")
        os.close(descriptor)
        self.path = Path(name)
        weakref.finalize(self, self.path.unlink, missing_ok=True)


class ScanningReader(Reader1):
    """A ROS 1 bag, read through from its beginning: what its index says, if it has one, does not count."""

    end = 0
    """how many bytes of the file could be used, once it was open"""

    def open(self) -> None:
        """Collects the connections and where each message is. What comes after the first damage is left out."""
        self.bio = self.path.open("rb")
        try:
            self.bio.readline()
            with suppress(ReaderError, OSError, EOFError, RuntimeError, KeyError):  # lz4 raises RuntimeError
                while self._take_record():
                    self.end = self.bio.tell()
        except BaseException:
            self.close()
            raise
        for entries in self.indexes.values():
            entries.sort()
        self.connections = [c._replace(msgcount=len(self.indexes.get(c.id, []))) for c in self.connections]
        self.indexes = {connection.id: self.indexes.get(connection.id, []) for connection in self.connections}

    def _take_record(self) -> bool:
        """Takes the record at the current position; whether more may follow."""
        assert self.bio
        position = self.bio.tell()
        header = Header.read(self.bio)
        size = read_uint32(self.bio)
        kind = header.get_uint8("op")
        if kind == RecordType.CHUNK:
            return self._take_chunk(position, header.get_string("compression"), size)
        if kind == RecordType.IDXDATA:
            size = 12 * header.get_uint32("count")  # some writers say another size than they write
        start = self.bio.tell()
        self.bio.seek(size, os.SEEK_CUR)
        return start + size <= os.fstat(self.bio.fileno()).st_size

    def _take_chunk(self, position: int, compression: str, size: int) -> bool:
        assert self.bio
        start = self.bio.tell()
        # A recorder that was killed leaves size 0 in the last chunk, and its messages after it.
        data = self.bio.read(size or -1)
        whole = len(data) == size
        if not whole and compression != "none":
            return False
        unpack = decompressors[compression]
        used, entries = self._take_messages(unpack(data), position)
        if entries:
            self.chunks[position] = Chunk(len(data), start, unpack)
            times = [entry.time for _, entry in entries]
            counts = Counter(connection for connection, _ in entries)
            self.chunk_infos.append(ChunkInfo(position, min(times), max(times) + 1, dict(counts)))
            self.end = start + (len(data) if whole else used)
        for connection, entry in entries:
            self.indexes.setdefault(connection, []).append(entry)
        return whole

    def _take_messages(self, data: bytes, position: int) -> tuple[int, list[tuple[int, IndexData]]]:
        """How many bytes of a chunk its whole messages take, and of each the connection and where it is."""
        entries: list[tuple[int, IndexData]] = []
        outer, self.bio = self.bio, io.BytesIO(data)
        used = 0
        with suppress(ReaderError):
            while used < len(data):
                header = Header.read(self.bio)
                if header.get_uint8("op") == RecordType.CONNECTION:
                    self.bio.seek(used)
                    self._take_connection()
                else:
                    end = read_uint32(self.bio) + self.bio.tell()
                    if end > len(data):
                        break
                    entries.append((header.get_uint32("conn"), IndexData(header.get_time("time"), position, used)))
                    self.bio.seek(end)
                used = self.bio.tell()
        self.bio = outer
        return used, entries

    def _take_connection(self) -> None:
        connection = self.read_connection()
        if all(known.id != connection.id for known in self.connections):
            self.connections.append(connection)


class ScanningMcap(McapReader):
    """An MCAP file without an index: its messages come in the order of the file, nearly that of their times."""

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[tuple[Connection, int, bytes], None, None]:
        """Read messages, see McapReader."""
        return self.messages_scan(connections, start, stop)


class CutMcap:
    """An MCAP file that is cut, as a path: what it opens has the whole records, and ends as a file should."""

    def __init__(self, path: Path) -> None:
        """Finds where the last whole record ends."""
        self.path = path
        records, inner, self.end = _whole_records(path)
        self._records, self._tail = records, inner + _MCAP_TAIL

    def open(self, mode: str = "rb") -> IO[bytes]:
        """The mended file, to read from."""
        return io.BufferedReader(_WithTail(self.path.open(mode, buffering=0), self._records, self._tail))


class _WithTail(io.RawIOBase):
    """The first ``end`` bytes of a file, followed by others."""

    def __init__(self, file: IO[bytes], end: int, tail: bytes) -> None:
        self._file, self._end, self._tail, self._at = file, end, tail, 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        bases = {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self._end + len(self._tail)}
        self._at = bases[whence] + offset
        return self._at

    def readinto(self, buffer: "memoryview | bytearray") -> int:  # type: ignore[override]
        if self._at < self._end:
            self._file.seek(self._at)
            data = self._file.read(min(len(buffer), self._end - self._at))
        else:
            data = self._tail[self._at - self._end :][: len(buffer)]
        buffer[: len(data)] = data
        self._at += len(data)
        return len(data)

    def close(self) -> None:
        self._file.close()
        super().close()


def _whole_records(path: Path) -> tuple[int, bytes, int]:
    """Where the whole records of an MCAP file's data end, those in a chunk that is cut there, and where these end."""
    size = path.stat().st_size
    end = len(_MCAP_MAGIC)
    with path.open("rb") as stream:
        while True:
            stream.seek(end)
            head = stream.read(9)
            # 0 is no kind of record (zeros fill files after a power cut); a footer or the end of the data ends it.
            if len(head) < 9 or head[0] in (0, _FOOTER, _DATA_END):
                return end, b"", end
            after = end + 9 + int(struct.unpack("<Q", head[1:])[0])
            if after > size:
                start, inner = _cut_chunk(stream.read()) if head[0] == _CHUNK else (0, b"")
                return end, inner, end + 9 + start + len(inner) if inner else end
            end = after


def _cut_chunk(data: bytes) -> tuple[int, bytes]:
    """The whole records in a chunk that is cut, and where in it they begin; none of one that is compressed."""
    start = 40  # times, size, checksum, an empty name of the compression, size
    if len(data) < start or data[28:32] != bytes(4):
        return 0, b""
    end = start
    while len(data) >= end + 9:
        after = end + 9 + int(struct.unpack_from("<Q", data, end + 1)[0])
        if after > len(data) or not data[end]:
            break
        end = after
    return start, data[start:end]


def salvage_database(path: Path) -> TemporaryCopy | None:
    """A copy of a cut SQLite bag with the messages that are left; None if there are none."""
    with path.open("rb") as stream:
        header = bytearray(stream.read(100))
    if len(header) < 100:
        return None
    page_size = int.from_bytes(header[16:18], "big")
    page_size = 65536 if page_size == 1 else page_size
    pages = path.stat().st_size // page_size if page_size else 0
    cut, whole = TemporaryCopy(".db3"), TemporaryCopy(".db3")
    with path.open("rb") as source, cut.path.open("r+b") as target:
        shutil.copyfileobj(source, target)
        target.truncate(pages * page_size)  # SQLite would read zeros for the rest of a page
        target.seek(28)
        target.write(pages.to_bytes(4, "big"))  # else it would open nothing
        target.seek(92)
        target.write(header[24:28])  # says that the number of pages is to be believed
    with closing(sqlite3.connect(cut.path)) as source_db, closing(sqlite3.connect(whole.path)) as target_db:
        try:
            _copy_tables(source_db, target_db)
        except sqlite3.Error:
            return None
    return whole


def _copy_tables(source: sqlite3.Connection, target: sqlite3.Connection) -> None:
    """Copies the tables of a bag; of the messages, those before the first damage."""
    tables = source.execute("SELECT name, sql FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%'")
    for name, definition in sorted(tables.fetchall(), key=lambda table: table[0] == "messages"):
        target.execute(definition)
        try:
            for row in source.execute(f'SELECT * FROM "{name}" ORDER BY rowid'):
                target.execute(f'INSERT INTO "{name}" VALUES ({", ".join("?" * len(row))})', row)
        except sqlite3.Error:
            if name in ("topics", "message_definitions", "schema"):
                raise
    target.commit()
