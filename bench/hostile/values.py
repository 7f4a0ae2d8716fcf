# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Small faults: values, files and calls."""

import json
import os
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import oort
from hostile.drives import driven, refused, scan_at
from oort import Parameters, Session, load_map, save_map
from oort.cli.main import main as tool
from oort.errors import OortError
from oort.events import EventLog
from oort.export.files import write_atomically
from oort.export.map_server import read_map_server
from oort.localization import Localizer
from oort.mapper import Mapper
from oort.recording import Scan, open_recording


def last_pose_damaged(inputs: Path) -> str:
    from oort.node.last_pose import LastPose

    file = LastPose("home")
    for text in (b"[]", b"5", b"{", b"\xff\xfe", b'{"T_map_sensor": "123"}', b'{"T_map_sensor": [NaN, 0, 0]}', b"null"):
        file.path.write_bytes(text)
        assert file.read() is None, text
    file.path.write_text('{"T_map_sensor": ' + "[" * 100_000)
    assert file.read() is None
    file.path.write_text('{"T_map_sensor": [1, 2, 3]}')
    assert file.read() == (1.0, 2.0, 3.0)
    return "left out"


def bad_pgm(inputs: Path) -> str:
    Path("m.yaml").write_text(
        "image: m.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    said = ""
    sizes = (b"", b"-3 4\n255\n", b"9 9\n255\nx", b"999999 999999\n255\n", b"1 1 99999999 \0")
    for data in (b"", *(b"P5\n" + size for size in sizes)):
        Path("m.pgm").write_bytes(data)
        said = refused(lambda: read_map_server("m.yaml"))
    return said


def events_log_is_a_fifo(inputs: Path) -> str:
    os.mkfifo("log")
    return refused(lambda: EventLog("log"))


def _refuses_scan(scan: Scan) -> str:
    return refused(lambda: Mapper(Parameters()).add_scan(scan, scan.odometry))


def angle_increment_0(inputs: Path) -> str:
    scan = scan_at(0)
    object.__setattr__(scan, "angle_increment", 0.0)
    return _refuses_scan(scan)


def angle_increment_1e300(inputs: Path) -> str:
    scan = scan_at(0)
    object.__setattr__(scan, "angle_increment", 1e300)
    return _refuses_scan(scan)


def underscore_number(inputs: Path) -> str:
    lines = Path(inputs, "small.clf").read_text().splitlines(keepends=True)
    k = next(k for k, line in enumerate(lines) if line.startswith("FLASER"))
    fields = lines[k].split()
    fields[5] = "1_0"
    lines[k] = " ".join(fields) + "\n"
    Path("log.clf").write_text("".join(lines))
    return refused(lambda: open_recording("log.clf"))


def evaluate_json_nan(inputs: Path) -> str:
    Path("t.tum").write_text("".join(f"{k} {k} 0 0 0 0 0 1\n" for k in range(3)))
    Path("far.tum").write_text("".join(f"{k} {k}e300 0 0 0 0 0 1\n" for k in range(3)))
    done = subprocess.run(
        [sys.executable, "-m", "oort.evaluate", "ate", "far.tum", "t.tum", "--json"], capture_output=True, text=True
    )
    assert "Traceback" not in done.stderr, done.stderr
    if done.returncode == 0:
        json.loads(done.stdout, parse_constant=lambda word: (_ for _ in ()).throw(AssertionError(word)))
    return (done.stderr or done.stdout).strip()


def carmen_angles_1e308(inputs: Path) -> str:
    ranges = " ".join(["2.0"] * 180)
    Path("log.clf").write_text(
        "".join(f"FLASER 180 {ranges} {k} 0 1e308 {k} 0 1e308 {k}.0 host {k}.0\n" for k in range(20))
    )
    return refused(lambda: tool_raising(["replay", "log.clf", "--quiet"]))


def tool_raising(arguments: list[str]) -> None:
    """Runs a tool; an exit status of 2 is an error."""
    if tool(arguments) == 2:
        raise OortError("status 2")


def nul_in_place_name(inputs: Path) -> str:
    mapper = driven(10).mapper
    said = refused(lambda: mapper.create_location("rooms", "kit\0chen", (0.0, 0.0, 0.0)))
    map_ = mapper.map()
    map_.locations = [("rooms", "kit\0chen", 0, (0.0, 0.0, 0.0))]
    refused(lambda: save_map("named", map_))
    return said


def two_threads_in_one_mapper(inputs: Path) -> str:
    mapper, said = Mapper(Parameters()), []
    localizer = Localizer(driven().map, Parameters())

    def storm() -> None:
        for k in range(150):
            scan = scan_at(k)
            for work in (
                lambda scan=scan: mapper.add_scan(scan, scan.odometry),
                lambda scan=scan: localizer.add_scan(scan, scan.odometry),
                mapper.map,
                lambda: mapper.statistics,
                lambda k=k: mapper.create_location("a", str(k), (0.0, 0.0, 0.0)),
                mapper.finish if k % 50 == 49 else (lambda: mapper.num_nodes),
            ):
                try:
                    work()
                except OortError as error:
                    said.append(str(error))

    threads = [threading.Thread(target=storm) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    save_map("shared", mapper.map())
    load_map("shared")
    return f"{mapper.num_nodes} nodes, refused: {sorted(set(said))}"


def errors_that_echo_megabytes(inputs: Path) -> str:
    Path("events.json").write_text(json.dumps([{"t": "x" * 3_000_000, "call": "map/start"}]))
    Path("events2.json").write_text(json.dumps([{"t": 0, "call": "y" * 3_000_000}]))
    Path("p.json").write_text('{"' + "k" * 3_000_000 + '": 1}')
    Path("p2.json").write_text('{"linear_update": "' + "k" * 3_000_000 + '"}')
    Path("log.clf").write_text("FLASER 1 " + "9" * 3_000_000 + "z 0 0 0 0 0 0 0 h 0\n")
    Path("g.g2o").write_text("VERTEX_SE2 " + "9" * 3_000_000 + " 0 0 0\n")
    Path("t.tum").write_text("0 " + "x" * 3_000_000 + " 0 0 0 0 0 1\n")
    log = str(inputs / "small.clf")
    for arguments in (
        ["replay", log, "--events", "events.json"],
        ["replay", log, "--events", "events2.json"],
        ["replay", log, "--params", "p.json"],
        ["replay", log, "--params", "p2.json"],
        ["replay", "log.clf"],
        ["graph", "solve", "g.g2o", "out"],
        ["evaluate", "ate", "t.tum", "t.tum"],
        ["replay", log, "--scan-topic", "s" * 100_000],
    ):
        done = subprocess.run([Path(sys.executable).with_name("oort"), *arguments], capture_output=True)
        assert done.returncode == 2, (arguments[:3], done.returncode)
        assert len(done.stderr) < 4096, (arguments[:3], len(done.stderr))
    return "short"


def _costly(path: str, value: Any, inputs: Path) -> str:
    parameters = Parameters()
    try:
        parameters.set("loop_closure_graph_builder.scanmatcher", "branch_and_bound_matcher")
        parameters.set("incremental_graph_builder.scanmatcher", "cartographer_matcher")
        parameters.set(path, value)
        parameters.check()
    except OortError as error:
        return str(error)
    session = Session(parameters)
    session.start()
    started = time.monotonic()
    for k in range(120):
        session.add_scan(scan_at(k))
    session.stop()
    assert time.monotonic() - started < 30.0, f"{time.monotonic() - started:.0f} s for 120 scans"
    return f"{time.monotonic() - started:.0f} s for 120 scans"


def branch_and_bound_depth_16(inputs: Path) -> str:
    path = next(e.path for e in oort._core.parameter_table() if e.path.endswith("branch_and_bound_depth"))
    return _costly(path, 16, inputs)


def cartographer_resolution_5_mm(inputs: Path) -> str:
    path = next(e.path for e in oort._core.parameter_table() if e.path.endswith("cartographer_matcher.resolution"))
    return _costly(path, 0.005, inputs)


def temporary_name_is_a_link(inputs: Path) -> str:
    Path("precious").write_text("precious")
    for thread in range(1):
        os.symlink("precious", f".out.json.{os.getpid()}.{threading.get_ident() + thread}.tmp")
    write_atomically(Path("out.json"), b"{}")
    assert Path("precious").read_text() == "precious", "the link was followed"
    assert stat.S_IMODE(os.stat("out.json").st_mode) == 0o666 & ~_umask()
    return "not followed"


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
