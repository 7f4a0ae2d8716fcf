# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""oort_bag: a replay with the original tool's arguments."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from oort import Session, load_map, read_parameters
from oort.cli.oort_bag import main, start_in
from oort.parameters import packaged_path
from oort.simulate import Drive
from oort.simulate.bag import write_bag


@pytest.fixture(scope="module")
def bag(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first 15 s of a drive, which begins on the dock."""
    path = tmp_path_factory.mktemp("bag") / "undock.bag"
    write_bag(replace(drive, odometry_stamps=drive.odometry_stamps[:751]), path)
    return path


@pytest.fixture(scope="module")
def first(bag: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The working directory after mapping it."""
    cwd = tmp_path_factory.mktemp("first")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(cwd)
        assert main([str(bag), "/scan"]) == 0
    return cwd


def test_the_results_lie_in_a_folder_of_the_bags_name(first: Path) -> None:
    assert [path.name for path in first.iterdir()] == ["oort-out"]
    assert [path.name for path in (first / "oort-out").iterdir()] == ["undock"]
    assert load_map(str(first / "oort-out/undock/map")).node_ids.size > 5


def test_going_on_from_the_origin(
    bag: Path, first: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a dock in the map; the same drive once more fits the first one's nodes."""
    monkeypatch.chdir(tmp_path)
    old = first / "oort-out/undock/map"
    assert main([str(bag), "scan", str(packaged_path()), f"{old}.map_capnp"]) == 0
    assert "the drive is taken to begin at the map's origin" in capsys.readouterr().err
    before, after = load_map(str(old)), load_map("oort-out/undock/map")
    assert after.node_ids.size == 2 * before.node_ids.size
    np.testing.assert_allclose(after.node_poses[before.node_ids.size], before.node_poses[0], atol=0.05)


def test_a_dock_is_where_a_drive_begins(first: Path, tmp_path: Path) -> None:
    session = Session(read_parameters())
    session.load(str(first / "oort-out/undock/map"))
    session.save_to(str(tmp_path / "docked"))
    session.locations.create_at("kitchen", "table", (2.0, 0.0, 0.0))
    session.locations.create_at("dock", "7f", (0.5, -0.25, 1.0))
    session.stop()
    pose, place = start_in(str(tmp_path / "docked"))
    assert pose == pytest.approx((0.5, -0.25, 1.0))
    assert place == "its location dock/7f"


def test_wrong_calls_end_with_2(
    bag: Path, first: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(first)
    params = str(packaged_path())
    for arguments, message in (
        (["no.bag", "/scan"], "no.bag cannot be read"),
        ([str(bag), "/laser"], "no laser scans on /laser; there are scans on: /scan"),
        ([str(bag), "/scan", "no.json"], "no.json"),
        ([str(bag), "/scan", params, str(tmp_path / "none")], "none"),
        ([str(bag), "/scan", params, "oort-out/undock/map"], "would overwrite this map"),
    ):
        assert main(arguments) == 2
        error = capsys.readouterr().err.splitlines()[-1]
        assert error.startswith("oort_bag: ")
        assert message in error
