# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Disks that fail while a map is saved: what is on them afterwards is the old map or the new one, whole."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from helpers.scenes import room_scan
from oort import Map, MapFileError, Parameters, Session, load_map, save_map

HELPERS = Path(__file__).parents[1] / "helpers"


def mapped(scans: int) -> Map:
    session = Session(Parameters())
    session.start()
    for k in range(scans):
        session.add_scan(room_scan(0.02 * k, 0.0, 0.02 * k, 0.1 * k))
    return session.map


def test_whichever_file_call_fails_a_whole_map_is_left(tmp_path: Path) -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    layer = tmp_path / "layer.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-o", layer, HELPERS / "faulty_files.c", "-ldl"], check=True)
    save_map(str(tmp_path / "old"), mapped(40))
    save_map(str(tmp_path / "new"), mapped(80))
    (tmp_path / "maps").mkdir()
    base = tmp_path / "maps" / "home"
    done = subprocess.run(
        [sys.executable, HELPERS / "saving_under_faults.py", base, tmp_path / "old", tmp_path / "new"],
        env={**os.environ, "LD_PRELOAD": str(layer), "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    counts: dict[str, int] = json.loads(done.stdout)
    assert counts["EIO"] >= 12 and counts["short"] >= 3, counts


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small disk")
def test_a_disk_that_is_full_keeps_the_old_map(tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=96k", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True).returncode != 0:
        pytest.skip("nothing can be mounted here")
    try:
        small, base = mapped(20), str(disk / "home")
        save_map(base, small)
        with pytest.raises(MapFileError, match="No space left"):
            save_map(base, mapped(2000))
        assert len(load_map(base)) == len(small)
        save_map(base, small)
        assert sorted(path.name for path in disk.iterdir()) == ["home.map_capnp", "home.map_meta_capnp", "home.md5"]
    finally:
        subprocess.run(["umount", disk], check=True)
