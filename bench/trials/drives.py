# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated drives of the table: each is made once and kept."""

import gzip
import hashlib
import math
import os
import pickle
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import oort.simulate
from oort.events import Event
from oort.recording import Pose, Recording, Scan
from oort.simulate import Drive, Sensor, SimulationConfig, simulate_drive


@dataclass(frozen=True)
class Recipe:
    """What makes a simulated drive."""

    seed: int
    scene: str = "home"
    odometry_error: float = 3.0
    """three times worse than a good base, as the table of the rows says"""
    field_of_view: int = 180
    """[deg], with one beam per degree"""
    fault: str = "none"
    way: int = 0
    moved: int = 0

    @property
    def name(self) -> str:
        """A name for people and files that tells one recipe from another."""
        view = f"-fov{self.field_of_view}" if self.field_of_view != 180 else ""
        fault = f"-{self.fault}" if self.fault != "none" else ""
        other = f"-way{self.way}-moved{self.moved}" if self.way or self.moved else ""
        return f"{self.scene}-{self.seed}-odo{self.odometry_error:g}{view}{fault}{other}"

    def config(self) -> SimulationConfig:
        """Drives last from 3 to 7 minutes, by seed."""
        sensor = Sensor(field_of_view=math.radians(self.field_of_view), beams=self.field_of_view)
        minutes = 2.8 + 0.7 * (self.seed % 5)
        return SimulationConfig(
            sensor,
            self.odometry_error,
            minutes=minutes,
            scene=self.scene,
            fault=self.fault,
            way=self.way,
            moved=self.moved,
        )


class DriveStore:
    """Keeps simulated drives in a folder that belongs to the present state of the simulator."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / f"drives-{simulator_state()}"
        self._folder.mkdir(parents=True, exist_ok=True)

    def has(self, recipe: Recipe) -> bool:
        return self._path(recipe).is_file()

    def make(self, recipe: Recipe) -> None:
        """Simulates the drive and keeps it."""
        partial = self._path(recipe).with_suffix(".partial")
        with gzip.open(partial, "wb", compresslevel=1) as stream:
            pickle.dump(simulate_drive(recipe.seed, recipe.config()), stream)
        os.replace(partial, self._path(recipe))

    def load(self, recipe: Recipe) -> Drive:
        with gzip.open(self._path(recipe), "rb") as stream:
            drive = pickle.load(stream)
        assert isinstance(drive, Drive)
        return drive

    def _path(self, recipe: Recipe) -> Path:
        return self._folder / f"{recipe.name}.pickle.gz"


def simulator_state() -> str:
    """A short hash of the simulator's sources and of how recipes are read."""
    digest = hashlib.sha256(Path(__file__).read_bytes())
    assert oort.simulate.__file__
    for source in sorted(Path(oort.simulate.__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:12]


def recording_of(drive: Drive, name: str) -> Recording:
    """The drive as what a reader of recordings delivers."""
    x, y, theta = drive.T_base_sensor.tolist()
    return Recording(name, "simulated drive", (x, y, theta), len(drive.scan_stamps), (), lambda: _scans(drive))


def _scans(drive: Drive) -> Iterator[Scan]:
    for index, (time, odometry) in enumerate(
        zip(drive.scan_times.tolist(), drive.T_odom_base_at_scans.tolist(), strict=True)
    ):
        yield scan_at(drive, time, drive.ranges[index], (odometry[0], odometry[1], odometry[2]))


def scan_at(drive: Drive, time: float, ranges: NDArray[np.float32], odometry: Pose) -> Scan:
    """A scan of the drive's sensor."""
    return Scan(
        time=time,
        stamp=f"{time:.6f}",
        angle_min=drive.angle_min,
        angle_increment=drive.angle_increment,
        range_min=drive.range_min,
        range_max=drive.range_max,
        ranges=ranges,
        odometry=odometry,
    )


def events_of(drive: Drive) -> list[Event]:
    """The drive's calls."""
    return [Event(event.t, event.call, list(event.args)) for event in drive.events]
