# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Paths, locks, clocks and files that are not what they should be."""

import bz2
import contextlib
import fcntl
import os
import stat
import time
from pathlib import Path

import oort
from hostile.drives import driven, refused, scan_at
from oort import Parameters, Session, load_map, save_map
from oort.cli.main import main as tool
from oort.errors import OortError
from oort.live import Listener, LiveSession
from oort.localization import Localizer
from oort.recording import open_recording
from oort.saved_maps import open_map


def output_is_a_device(inputs: Path) -> str:
    Path("in.g2o").write_text("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n")
    os.mknod("null", 0o666 | stat.S_IFCHR, os.makedev(1, 3))
    tool(["graph", "solve", "in.g2o", "null"])
    assert stat.S_ISCHR(os.lstat("null").st_mode), "the device was replaced"
    return "the device is still one"


def output_is_a_link(inputs: Path) -> str:
    Path("in.g2o").write_text("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n")
    Path("real.g2o").write_text("old")
    os.symlink("real.g2o", "link.g2o")
    assert tool(["graph", "solve", "in.g2o", "link.g2o"]) == 0
    assert os.path.islink("link.g2o"), "the link was replaced"
    assert "VERTEX_SE2" in Path("real.g2o").read_text()
    return "the link was followed"


def lock_held(inputs: Path) -> str:
    save_map("maps", driven(10).map)
    folder = os.open(".", os.O_RDONLY)
    fcntl.flock(folder, fcntl.LOCK_SH)
    assert len(load_map("maps")) > 0, "a shared lock keeps readers out"
    fcntl.flock(folder, fcntl.LOCK_EX)
    said = refused(lambda: load_map("maps"))
    refused(lambda: save_map("maps", driven(10).map))
    return said


def use_map(path: str) -> str:
    """Loads a map and does all that can be done with one; refusing it is right, too."""
    try:
        map_ = open_map(path)
    except OortError as error:
        return f"refused: {error}"
    session = Session(Parameters())
    session.load(path)
    session.resume(os.path.abspath("resumed"), (0.0, 0.0, 0.0))
    for k in range(30):
        session.add_scan(scan_at(k))
    session.call("map/notify_docked")
    session.stop()
    open_map("resumed")
    oort.render_map(map_, Parameters())
    with contextlib.suppress(oort.InputError):  # saying that the two do not fit together is an answer
        oort.merge_maps(map_, map_)
    localizer = Localizer(map_, Parameters())
    for k in range(10):
        scan = scan_at(k)
        localizer.add_scan(scan, scan.odometry)
    return f"{len(map_)} nodes used"


def start_twice_at_a_good_map(inputs: Path) -> str:
    base = os.path.abspath("home")
    save_map(base, driven(200).map)
    nodes = len(load_map(base))
    for _ in range(2):
        live = LiveSession(Parameters(), Listener())
        live.call("map/start", [base])
        live.add_scan(lambda: scan_at(0))
        live.close()
    kept = max(len(load_map(str(path)[: -len(".md5")])) for path in Path().glob("home*.md5"))
    assert kept == nodes, f"of {nodes} nodes {kept} are left"
    return f"the map of {nodes} nodes is still there"


def two_sessions_save_one_base(inputs: Path) -> str:
    base = os.path.abspath("home")
    first, second = (LiveSession(Parameters(), Listener()) for _ in range(2))
    first.call("map/start", [base])
    try:
        said = refused(lambda: second.call("map/start", [base]))
    finally:
        first.close()
        second.close()
    return said


def bz2_of_10_gb(inputs: Path) -> str:
    part = bz2.compress(bytes(200 << 20))
    Path("zeros.clf.bz2").write_bytes(part * 50)
    return refused(lambda: open_recording("zeros.clf.bz2"))


def sparse_map_of_30_gb(inputs: Path) -> str:
    for ending in (".map_capnp", ".map_meta_capnp", ".md5"):
        with open(f"sparse{ending}", "wb") as stream:
            stream.truncate(30 << 30)
    refused(lambda: open_map("sparse", ignore_checksum=True))
    return refused(lambda: open_map("sparse"))


def live_name_too_long(inputs: Path) -> str:
    live = LiveSession(Parameters(), Listener())
    try:
        return refused(lambda: live.call("map/start", [os.path.abspath("n" * 250)]))
    finally:
        live.close()


def clock_stands_still(inputs: Path) -> str:
    live = LiveSession(Parameters(), Listener(), clock=lambda: 0.0)
    live.call("map/start", [os.path.abspath("home")])
    live.add_scan(lambda: scan_at(0))
    time.sleep(1.0)
    for k in range(1, 200):
        live.add_scan(lambda k=k: scan_at(k))  # type: ignore[misc]
    while len(live.inbox):
        time.sleep(0.01)
    nodes = live.snapshot.num_nodes
    deadline = time.monotonic() + 20.0
    while len(load_map("home")) < nodes and time.monotonic() < deadline:
        time.sleep(0.2)
    assert len(load_map("home")) == nodes, f"{len(load_map('home'))} of {nodes} nodes on disk"
    live.close()
    return f"{nodes} nodes on disk"


def resume_home_map_home(inputs: Path) -> str:
    log = str(inputs / "small.clf")
    assert tool(["replay", log, "--quiet", "--map", "home", "--out", "first"]) == 0
    text = (Path(__file__).parents[2] / "docs/usage.md").read_text()
    example = next(line for line in text.splitlines() if "--resume home" in line).split()
    assert tool(["replay", log, "--quiet", *example[3:]]) == 0, f"the documented example is refused: {example}"
    return " ".join(example)


def scans_at_355_hz(inputs: Path) -> str:
    mapper = oort.LiveMapper(on_trouble=lambda text: None)
    started = time.monotonic()
    for k in range(3550):
        scan = scan_at(k // 35)
        object.__setattr__(scan, "time", k / 355)
        mapper.push_odometry(k / 355, scan.odometry)
        mapper.push_scan(scan)
        time.sleep(max(0.0, started + k / 355 - time.monotonic()))
    mapper.map()
    figures = mapper._live.figures
    mapper.close()
    dropped = sum(figures.drops.counts.values())
    assert dropped < 36, f"{dropped} of 3550 dropped: {dict(figures.drops.counts)}"
    return f"{figures.scans_mapped} of 3550 mapped"
