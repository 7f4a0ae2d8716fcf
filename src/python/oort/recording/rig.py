# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a bag's scans and odometry go together: finds the frames, the odometry and the sensor's place on the base."""

from dataclasses import dataclass, field

import numpy as np

from oort._core import OdometryBuffer, Parameters
from oort.errors import InputError
from oort.recording.frames import FrameTree, Link, to_plane
from oort.recording.gyro import GyroRecord, turned_by_gyro
from oort.recording.motion import Placement, place
from oort.recording.types import Pose

_GAP = 1.0  # [s]; a longer silence of the odometry is worth a note


@dataclass(slots=True)
class Survey:
    """What the first pass over a bag finds."""

    scan_topic: str
    tf: FrameTree = field(default_factory=FrameTree)
    odometry: dict[tuple[str, str, str], FrameTree] = field(default_factory=dict)
    """one link each, by topic, frame and child frame"""
    scan_frames: dict[str, None] = field(default_factory=dict)
    scan_times: list[float] = field(default_factory=list)
    """of the scans that have readings"""
    scan_spans: list[tuple[float, float]] = field(default_factory=list)
    """of the same: when their first and last beams were measured, from their stamps [s]"""
    impossible_spans: int = 0
    """scans whose time_increment cannot be"""
    empty_scans: int = 0
    gyro: GyroRecord | None = None
    """None unless it is to be used"""


@dataclass(frozen=True, slots=True)
class Rig:
    """How scans and odometry go together."""

    sensor_on_base: Pose
    upside_down: bool
    odometry: OdometryBuffer
    max_extrapolation: float
    """[s]"""
    notes: tuple[str, ...]

    def place(self, stamp: float, span: tuple[float, float]) -> Placement | None:
        """The odometry of a scan; None outside the time that it covers."""
        return place(lambda time: self.odometry.lookup(time, self.max_extrapolation), stamp, span)


def assemble(survey: Survey, odom_frame: str | None, parameters: Parameters) -> Rig:
    """Finds the frames and puts odometry and mount together. `odom_frame` is None for a frame called "odom".

    Raises InputError, without the bag's name, if something is missing, ambiguous or not as a planar laser needs it.
    """
    if not survey.scan_times:
        raise InputError(f"no scan with readings on {survey.scan_topic} ({survey.empty_scans} without)")
    if len(survey.scan_frames) > 1:
        raise InputError(f"the scans on {survey.scan_topic} are in several frames: {', '.join(survey.scan_frames)}")
    sensor = next(iter(survey.scan_frames))
    notes = []
    odom, base, link, origin = _find_odometry(survey, sensor, odom_frame)
    notes.append(f"scans on {survey.scan_topic} in frame {sensor}; odometry {odom} -> {base} from {origin}")
    for parent, ignored in survey.tf.links.get(odom, {}).items():
        notes.append(f"ignored {parent} -> {odom} of another program ({len(ignored.samples) // 4} transforms)")
    if survey.tf.unusable:
        notes.append(f"{survey.tf.unusable} transforms that are not finite or have no rotation were ignored")
    if sensor == base:
        notes.append(f"the scans are in the base's own frame: the sensor is taken to sit at {base}")
    sensor_on_base, upside_down = to_plane(survey.tf.mount(base, sensor), sensor)
    if upside_down:
        notes.append("the laser hangs upside down: its beams were turned round")
    if survey.impossible_spans:
        notes.append(
            f"{survey.impossible_spans} scans have a time_increment that is no number or makes them last longer than "
            "1 s: their beams are taken as measured at once"
        )
    buffer = OdometryBuffer()
    samples = link.by_time()
    poses = samples.tolist()
    if survey.gyro is not None:
        poses, told = turned_by_gyro(survey.gyro, survey.tf, base, link)
        notes += told
    for time, x, y, theta in poses:
        buffer.add(time, x, y, theta)
    gap = float(np.diff(samples[:, 0]).max(initial=0.0))
    if gap > _GAP:
        notes.append(f"the odometry is silent for up to {gap:.1f} s; poses in between are interpolated")
    return Rig(sensor_on_base, upside_down, buffer, float(parameters.get("max_extrapolation")), tuple(notes))


def _find_odometry(survey: Survey, sensor: str, wanted: str | None) -> tuple[str, str, Link, str]:
    """The odometry frame, the base frame, T_odom_base over time, and where it is from: tf before topics."""
    above = survey.tf.above(sensor)
    names = [frame for frame in above[1:] if (frame == wanted if wanted else frame.split("/")[-1] == "odom")]
    if len(names) > 1:
        raise InputError(
            f"several odometry frames above {sensor}; choose one with odom_frame (--odom-frame): {', '.join(names)}"
        )
    if names:
        base, odom = survey.tf.way_up(sensor, names[0])[-2:]
        return odom, base, survey.tf.links[base][odom], "tf"
    choices = {key: tree for key, tree in survey.odometry.items() if wanted in (None, key[1]) and tree.links}
    if not choices:
        raise InputError(_no_odometry(survey, sensor, wanted, above))
    if len(choices) > 1:
        listed = ", ".join(f"{topic} ({odom} -> {base})" for topic, odom, base in choices)
        raise InputError(f"several odometries; choose one by its frame with odom_frame (--odom-frame): {listed}")
    ((topic, odom, base), tree) = next(iter(choices.items()))
    return odom, base, tree.links[base][odom], topic


def _no_odometry(survey: Survey, sensor: str, wanted: str | None, above: list[str]) -> str:
    frames = ", ".join(above[1:]) or "none"
    topics = ", ".join(f"{topic} ({odom} -> {base})" for topic, odom, base in survey.odometry) or "none"
    return (
        f"no odometry: no frame {wanted or 'odom'} above the laser's frame {sensor}. Frames above it: {frames}; "
        f"odometry topics: {topics}. Name the odometry frame with odom_frame (--odom-frame), or record /tf or /odom"
    )
