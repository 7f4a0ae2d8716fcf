# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How a bag's scans and odometry go together: finds the frames, the odometry and the sensor's place on the base."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from oort._core import OdometryBuffer, Parameters
from oort.errors import InputError
from oort.recording.frames import FrameTree, Link, to_plane
from oort.recording.gyro import GyroRecord, turned_by_gyro
from oort.recording.motion import Placement, place
from oort.recording.scan_fields import ScanFields
from oort.recording.types import Pose

_PARKED = 10.0  # [s]; odometry that stays the same for as long, bit by bit, is none: a robot at rest maps without, too
_BASES = ("base_footprint", "base_link")
_GAP = 1.0  # [s]; a longer silence of the odometry is worth a note


@dataclass(slots=True)
class Survey:
    """What the first pass over a bag finds."""

    fields: dict[str, ScanFields]
    """of each topic whose scans count"""
    scan_frame: str | None
    """the only frame whose scans count; None for all"""
    compensates: bool
    """whether motion within a scan counts"""
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
    other_scans: int = 0
    """scans in a frame that does not count"""
    gyro: GyroRecord | None = None
    """None unless it is to be used"""

    @property
    def scan_topic(self) -> str:
        """The topics whose scans count, for messages."""
        return " and ".join(self.fields)

    def is_wanted(self, frame: str) -> bool:
        """Whether the scans in a frame count."""
        return self.scan_frame in (None, frame)


@dataclass(frozen=True, slots=True)
class Rig:
    """How scans and odometry go together."""

    lasers: dict[str, tuple[Pose, bool]]
    """by frame, the main one first: where each sits on the base, and whether it hangs upside down"""
    odometry: OdometryBuffer | None
    """None: the scans have none"""
    max_extrapolation: float
    """[s]"""
    notes: tuple[str, ...]
    without_odometry: str = ""
    """see Recording"""

    @property
    def sensor_on_base(self) -> Pose:
        """T_base_sensor of the main laser."""
        return next(iter(self.lasers.values()))[0]

    def place(self, stamp: float, span: tuple[float, float]) -> Placement | None:
        """The odometry of a scan; None outside the time that it covers."""
        if (odometry := self.odometry) is None:
            return Placement((0.0, 0.0, 0.0))
        return place(lambda time: odometry.lookup(time, self.max_extrapolation), stamp, span)


class _NoOdometryError(InputError):
    """There is none, and nothing that a person could mean by it."""


def assemble(survey: Survey, odom_frame: str | None, mount: Pose | None, parameters: Parameters) -> Rig:
    """Finds the frames and puts odometry and mount together. `odom_frame` is None for a frame called "odom".

    `mount` is T_base_sensor where a person gives it, whatever transforms say. Raises InputError, without the bag's
    name, if something is missing, ambiguous or not as a planar laser needs it.
    """
    frames = _scan_frames(survey)
    sensor = frames[0]
    if mount is not None and len(frames) > 1:
        raise InputError(
            f"the scans on {survey.scan_topic} are in several frames: {', '.join(frames)}; mount (--mount) says where "
            "one laser sits: choose it with scan_frame (--scan-frame)"
        )
    if not parameters.get("use_odometry"):
        return _without_odometry(survey, frames, mount, parameters, "use_odometry is off (--no-odometry)")
    notes = []
    try:
        odom, base, link, origin = _find_odometry(survey, sensor, odom_frame, anywhere=mount is not None)
    except _NoOdometryError as error:
        return _without_odometry(survey, frames, mount, parameters, str(error))
    if is_parked(link.by_time()):
        reason = f"odometry {odom} -> {base or 'the base'} from {origin} never changes"
        return _without_odometry(survey, frames, mount, parameters, reason)
    notes.append(
        f"scans on {survey.scan_topic} in frame {sensor}; odometry {odom} -> {base or 'the base'} from {origin}"
    )
    for parent, ignored in survey.tf.links.get(odom, {}).items():
        notes.append(f"ignored {parent} -> {odom} of another program ({len(ignored.samples) // 4} transforms)")
    if survey.tf.unusable:
        notes.append(f"{survey.tf.unusable} transforms that are not finite or have no rotation were ignored")
    lasers, told = _mounts(survey, frames, base, origin, mount)
    notes += told
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
    return Rig(lasers, buffer, float(parameters.get("max_extrapolation")), tuple(notes))


def _mounts(
    survey: Survey, frames: list[str], base: str, origin: str, mount: Pose | None
) -> tuple[dict[str, tuple[Pose, bool]], list[str]]:
    """Where the laser of each frame sits on the base that odometry tells of, and what to note."""
    sensor = frames[0]
    if mount is not None:
        return {sensor: (mount, False)}, [
            "the laser sits on the base where --mount says, upright, whatever transforms tell"
        ]
    if not base:
        raise InputError(
            f"{origin} has no child_frame_id, so whose odometry it is, and where the laser sits there, is not "
            "known; say where the laser sits with mount (--mount X Y THETA)"
        )
    notes = []
    if sensor == base:
        notes.append(f"the scans are in the base's own frame: the sensor is taken to sit at {base}")
    lasers = {frame: to_plane(survey.tf.mount(base, frame), frame) for frame in frames}
    if len(frames) > 1:
        notes.append(
            f"scans in {len(frames)} frames: {', '.join(frames)}; all lasers are used, each with its own mount, "
            f"{sensor} first; --scan-frame chooses one"
        )
    for frame, (_, upside_down) in lasers.items():
        if upside_down:
            which = f"{frame} " if len(frames) > 1 else ""
            notes.append(f"the laser {which}hangs upside down: its beams were turned round")
    return lasers, notes


def is_parked(samples: NDArray[np.float64]) -> bool:
    """Whether odometry, (n, 4) of time and pose, stays exactly the same for so long that it is none."""
    return float(np.ptp(samples[:, 0])) >= _PARKED and bool((samples[:, 1:] == samples[0, 1:]).all())


def _without_odometry(survey: Survey, frames: list[str], mount: Pose | None, parameters: Parameters, why: str) -> Rig:
    """The rig of lasers alone, or on a base that only transforms tell of."""
    notes = [f"no odometry: {why}; the scans alone say how the base moves"]
    above = survey.tf.above(frames[0])
    base = next((frame for frame in (parameters.get("base_frame"), *_BASES) if frame in above), frames[0])
    if mount is not None:
        lasers = {frames[0]: (mount, False)}
    else:
        lasers = {frame: to_plane(survey.tf.mount(base, frame), frame) for frame in frames}
        notes.append(f"scans on {survey.scan_topic} in frame {frames[0]}, on the base {base}")
    notes += [
        f"the laser {frame} hangs upside down: its beams were turned round" for frame in lasers if lasers[frame][1]
    ]
    if survey.gyro is not None:
        notes.append("the gyro is not used: it corrects odometry's turns, and there is no odometry")
    return Rig(lasers, None, 0.0, tuple(notes), why)


def _scan_frames(survey: Survey) -> list[str]:
    """The frames that the scans are in, in the order of their first scans. Raises InputError if there are none."""
    if survey.scan_frame is not None and survey.scan_frame not in survey.scan_frames:
        frames = ", ".join(survey.scan_frames) or "none"
        raise InputError(f"no scan on {survey.scan_topic} is in frame {survey.scan_frame}; frames there: {frames}")
    if not survey.scan_times:
        raise InputError(f"no scan with readings on {survey.scan_topic} ({survey.empty_scans} without)")
    return [survey.scan_frame] if survey.scan_frame is not None else list(survey.scan_frames)


def _find_odometry(survey: Survey, sensor: str, wanted: str | None, *, anywhere: bool) -> tuple[str, str, Link, str]:
    """The odometry frame, the base frame, T_odom_base over time, and where it is from: tf before topics.

    `anywhere`: whether the frames need not be above the sensor's, as that sits on the base by a person's word.
    """
    above = survey.tf.above(sensor)
    names = _named(above[1:], wanted)
    if not names and anywhere:
        parents = {parent: None for links in survey.tf.links.values() for parent in links}
        names = _named(list(parents), wanted)
    if len(names) > 1:
        raise InputError(
            f"several odometry frames above {sensor}; choose one with odom_frame (--odom-frame): {', '.join(names)}"
        )
    static = ""
    if names:
        base, odom = _base_and_odom(survey, sensor, names[0])
        link = survey.tf.links[base][odom]
        if not all(topic.split("/")[-1] == "tf_static" for topic in link.by_topic):
            return odom, base, link, "tf"
        static = f"{odom} -> {base} is a static transform, told once on /tf_static: that is no odometry"
    choices = {key: tree for key, tree in survey.odometry.items() if wanted in (None, key[1]) and tree.links}
    if not choices:
        if wanted is None and (static or not (_gap(survey, wanted) or _moves(survey.tf, above))):
            raise _NoOdometryError(static or f"there is no frame odom above {sensor}, and no odometry topic")
        raise InputError(static or _no_odometry(survey, sensor, wanted, above))
    if len(choices) > 1:
        listed = ", ".join(f"{topic} ({odom} -> {base})" for topic, odom, base in choices)
        raise InputError(f"several odometries; choose one by its frame with odom_frame (--odom-frame): {listed}")
    ((topic, odom, base), tree) = next(iter(choices.items()))
    return odom, base, tree.links[base][odom], topic


def _moves(tree: FrameTree, above: list[str]) -> bool:
    """Whether a frame moves that carries the laser: then there is odometry, by another name."""
    links = (link for frame in above for link in tree.links.get(frame, {}).values())
    return any(bool((np.ptp(link.by_time()[:, 1:], axis=0) > 0.0).any()) for link in links)


def _named(frames: list[str], wanted: str | None) -> list[str]:
    """The frames that are called so or, if nothing is wanted, "odom"."""
    return [frame for frame in frames if (frame == wanted if wanted else frame.split("/")[-1] == "odom")]


def _base_and_odom(survey: Survey, sensor: str, odom: str) -> tuple[str, str]:
    """The frame under the odometry frame, and that one. Raises InputError if the sensor is under none of several."""
    way = survey.tf.way_up(sensor, odom)
    if way:
        return way[-2], way[-1]
    children = [child for child, parents in survey.tf.links.items() if odom in parents]
    if len(children) > 1:
        raise InputError(f"several frames move in {odom}: {', '.join(children)}; which is the base is not known")
    return children[0], odom


def _no_odometry(survey: Survey, sensor: str, wanted: str | None, above: list[str]) -> str:
    frames = ", ".join(above[1:]) or "none"
    topics = ", ".join(f"{topic} ({odom} -> {base})" for topic, odom, base in survey.odometry) or "none"
    return (
        f"no odometry: no frame {wanted or 'odom'} above the laser's frame {sensor}. Frames above it: {frames}; "
        f"odometry topics: {topics}. Name the odometry frame with odom_frame (--odom-frame), or record /tf or /odom"
        + _gap(survey, wanted)
    )


def _gap(survey: Survey, wanted: str | None) -> str:
    """What to do where tf has an odometry frame, but not above the laser."""
    links = [(odom, base) for base, parents in survey.tf.links.items() for odom in _named(list(parents), wanted)]
    listed = ", ".join(f"{odom} -> {base}" for odom, base in links)
    return (
        f". There is {listed}, from which no transform leads to the laser: say where it sits on the base with mount "
        "(--mount X Y THETA)"
        if links
        else ""
    )
