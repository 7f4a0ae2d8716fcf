# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What the ROS tools find of Oort with nothing set but ROS_PACKAGE_PATH."""

import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image

import oort
from helpers.scenes import room_scan
from node.running import Core
from oort.parameters import packaged_path
from oort.session import Session

SHARE = Path(sys.prefix, "share")
SOURCES = Path(__file__).resolve().parents[3] / "ros"

# name: fields as rossrv shows them, and the sum that decides whether two programs understand each other. Where an
# original is public the sum is known from there: std_msgs/String, Bool, UInt64 and nav_msgs/GetMap have the same.
SERVICES = {
    "SetString": ("string data ---", "992ce8a1687cec8c8bd883ec73ca41d1"),
    "GetString": ("--- string data", "992ce8a1687cec8c8bd883ec73ca41d1"),
    "GetBool": ("--- bool data", "8b94c1b53db61fb6aed406028ad6332a"),
    "GetUInt": ("--- uint64 data", "1b2a79973e8bf53d7b53acb71299cb57"),
    "GetStrings": ("--- string[] data", "cce5a364f3a3be12c9722c6dcad2fa94"),
    "GetMap": ("--- nav_msgs/OccupancyGrid map", "6cdd0a18e0aff5b0a3ca2326a89b54ff"),
    "MapResume": ("string new_map_loc geometry_msgs/Pose2D pose ---", "02982077e0258029fef7b1ae15ffcb39"),
    "LocCreate": ("string nspace string id ---", "d52b170fc1b37d075e943959d10d949f"),
    "LocCreatePoints": (
        "string[] nspaces geometry_msgs/Point[] points string[] ids ---",
        "8419743642ecfb033488edaab40e0a31",
    ),
    "LocNamespace": (
        "string nspace bool use_as_prefix --- string[] nspaces string[] ids",
        "5cef3a0f7ab8e8546721d0320cb15004",
    ),
    "LocDelete": ("string nspace string id --- bool success", "1059a8c139517293c6c8aae63129838a"),
    "LocLocate": ("string nspace string id --- geometry_msgs/PoseStamped pose", "4b50a43fd90d24b5918c358a5af33aa9"),
}


@pytest.fixture(scope="module")
def saved_map(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A map of five nodes."""
    base = tmp_path_factory.mktemp("map") / "room"
    session = Session(oort.Parameters())
    session.start(str(base))
    for step in range(5):
        session.add_scan(room_scan(-1.0 + 0.25 * step, 0.0, 0.0, 100.0 + step))
    session.stop()
    return base


def launch_nodes(ros: Core, *arguments: str) -> list[str]:
    done = ros.run("roslaunch", "--nodes", "oort", *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def launch_command(ros: Core, node: str, *arguments: str) -> str:
    done = ros.run("roslaunch", "--args", node, "oort", *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_there_are_these_services_and_no_others(ros: Core) -> None:
    listed = ros.run("rossrv", "package", "oort_msgs").stdout.split()
    assert sorted(listed) == sorted(f"oort_msgs/{name}" for name in SERVICES)


@pytest.mark.parametrize("name", SERVICES)
def test_service_definitions(ros: Core, name: str) -> None:
    fields, md5 = SERVICES[name]
    shown = ros.run("rossrv", "show", f"oort_msgs/{name}").stdout
    own_lines = [line for line in shown.splitlines() if not line.startswith(" ")]  # without fields of fields
    assert " ".join(own_lines).split() == fields.split()
    assert ros.run("rossrv", "md5", f"oort_msgs/{name}").stdout.strip() == md5
    assert getattr(importlib.import_module("oort_msgs.srv"), name)._md5sum == md5


def test_packages_are_found(ros: Core) -> None:
    for package in ("oort", "oort_msgs"):
        assert ros.run("rospack", "find", package).stdout.strip() == str(SHARE / package)
        version = ElementTree.parse(SHARE / package / "package.xml").findtext("version")
        assert version == oort.__version__


def test_the_packages_that_the_manifest_names_are_there(ros: Core) -> None:
    manifest = ElementTree.parse(SOURCES / "oort/package.xml")
    for name in [element.text for element in manifest.iter("exec_depend")]:
        assert name is not None
        assert ros.run("rospack", "find", name).returncode == 0, name


def test_setup_bash(ros: Core, tmp_path: Path) -> None:
    """It may be sourced twice, in a strict shell, from anywhere, and keeps what was there."""
    script = f"set -eu; source {SHARE}/oort/setup.bash; source {SHARE}/oort/setup.bash; rospack find oort; printenv"
    plain = {"PATH": os.environ["PATH"], "HOME": str(tmp_path), "ROS_PACKAGE_PATH": "/other"}
    done = subprocess.run(
        ["bash", "-c", script], env=plain, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=30
    )
    lines = done.stdout.splitlines()
    assert lines[0] == str(SHARE / "oort")
    assert f"ROS_PACKAGE_PATH={SHARE}:/other" in lines
    assert f"VIRTUAL_ENV={sys.prefix}" in lines


def test_oort_conv(ros: Core, saved_map: Path, tmp_path: Path) -> None:
    done = ros.run("rosrun", "oort", "oort_conv", saved_map, tmp_path / "flat", packaged_path(), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for name in ("flat_map", "flat_map_cleaned"):
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert picture.mode == "L"
        assert f"image: {name}.png" in (tmp_path / f"{name}.yaml").read_text()


def test_oort_bag_says_what_is_wrong(ros: Core, tmp_path: Path) -> None:
    done = ros.run("rosrun", "oort", "oort_bag", "no.bag", "/scan", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.strip() == "oort_bag: no.bag cannot be read: No such file or directory; check the path"


@pytest.mark.usefixtures("ros")  # without ROS there is no launcher
def test_a_launcher_away_from_oort(saved_map: Path, tmp_path: Path) -> None:
    """It says what to do, and OORT_PYTHON does it, also where the working directory holds misleading files."""
    launcher = tmp_path / "share/oort/oort_conv"
    launcher.parent.mkdir(parents=True)
    launcher.write_bytes((SHARE / "oort/oort_conv").read_bytes())
    launcher.chmod(0o755)
    (tmp_path / "oort").mkdir()
    (tmp_path / "numpy.py").write_text("raise ImportError('not this one')\n")

    def run(**variables: str) -> subprocess.CompletedProcess[str]:
        plain = {"PATH": "/usr/bin:/bin", **variables}
        command = [str(launcher), str(saved_map), "flat"]
        return subprocess.run(command, env=plain, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=30)

    alone = run()
    assert (alone.returncode, len(alone.stderr.splitlines())) == (127, 1)
    assert alone.stderr.startswith("oort_conv: no Python here has Oort: run scripts/setup.sh --ros")
    assert run(OORT_PYTHON=sys.executable).returncode == 0
    assert "No module named 'oort'" in run(OORT_PYTHON="/usr/bin/python3").stderr


def test_launch_files_name_the_node(ros: Core) -> None:
    assert launch_nodes(ros, "oort.launch") == ["/oort_slam"]
    assert launch_nodes(ros, "oort.launch", "node:=mapper") == ["/mapper"]
    assert launch_nodes(ros, "oort_ros_mapping.launch") == ["/oort_ros_mapping"]
    assert launch_nodes(ros, "localizer.launch", "map:=/maps/7") == ["/oort_localizer"]
    assert launch_nodes(ros, "rviz.launch") == ["/oort_rviz"]


def test_launch_files_run_the_program(ros: Core) -> None:
    program = str(SHARE / "oort/oort_ros")
    assert f"{program} scan:=scan " in launch_command(ros, "/oort_slam", "oort.launch")
    kuri = launch_command(ros, "/oort_ros_mapping", "oort_ros_mapping.launch")
    assert f"nice -n 10 {program} scan:=scan_reduced_mapping " in kuri
    localizer = launch_command(ros, "/oort_localizer", "localizer.launch", "map:=/maps/7", "scan:=near")
    assert f"{SHARE}/oort/oort_localizer scan:=near " in localizer


@pytest.mark.skipif(shutil.which("rviz") is None, reason="rviz is not installed")
def test_launch_file_shows_the_node(ros: Core) -> None:
    rviz = launch_command(ros, "/oort_rviz", "rviz.launch", "scan:=near", "node:=mapper")
    assert f"-d {SHARE}/oort/rviz/oort.rviz /scan:=near /oort_slam/graph:=/mapper/graph" in rviz


def test_launch_files_set_only_the_parameters_that_are_given(ros: Core) -> None:
    def parameters(*arguments: str) -> str:
        return ros.run("roslaunch", "--dump-params", "oort", *arguments).stdout.strip()

    assert parameters("oort.launch") == "{}"
    assert parameters("oort_ros_mapping.launch") == "{}"
    given = parameters("oort.launch", "load:=/maps/7", "params:=12", "events_log:=/log.json")
    assert given.splitlines() == [
        "/oort_slam/events_log: /log.json",
        "/oort_slam/load: /maps/7",
        "/oort_slam/params: '12'",  # a path, whatever it looks like
    ]
    assert parameters("localizer.launch", "map:=7").splitlines() == [
        "/oort_localizer/map: '7'",
        "/oort_localizer/start: auto",
    ]
