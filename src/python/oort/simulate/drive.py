# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A drive, by default through a made-up home from the dock through all rooms and back, with its ground truth."""

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from oort.poses import Array, between, compose, wrap_angle
from oort.simulate import faults, person
from oort.simulate.alike import make_alike_home
from oort.simulate.course import DOCKED, Course, drive_corridor, tour_home
from oort.simulate.driver import STEP
from oort.simulate.gyro import simulate_gyro
from oort.simulate.home import Home, furnish_home, make_home
from oort.simulate.odometry import simulate_odometry
from oort.simulate.plan import Plan, furnish_plan
from oort.simulate.planar import transform
from oort.simulate.sensor import Sensor, cast_drive, measure

Rng = np.random.Generator

SCENES = ("home", "alike", "corridor", "corridor-return")
FAULTS = ("none", "freeze", "bump", "carried")
START_STAMP = 1_600_000_000_000_000_000  # ns, of the first scan
STEP_STAMP = round(STEP * 1e9)  # ns between odometry poses
STEPS_PER_SCAN = 5  # 10 scans a second
REAR_STEPS = 2  # from a scan to that of the sensor that looks back
_MOVING = 1  # tells the stream of an arrangement from those of a way
AFTER_DOCKING = 1.05  # s from standing on the dock to the call that tells so; falls between two scans


@dataclass(frozen=True)
class SimulationConfig:
    """What a simulated drive is like beside its seed, which decides home and way of a scene (but for ``minutes``)."""

    sensor: Sensor = field(default_factory=Sensor)
    odometry_error: float = 1.0
    """Factor on all odometry errors: 0 none, 1 a good base, 3 three times worse."""
    person: bool = True
    """Whether a person crosses the view now and then."""
    minutes: float = 3.0
    """Least duration, roughly: after a tour of all rooms the drive goes on to random places until then."""
    scene: str = "home"
    """One of SCENES: a home, a home of rooms that are all alike, or 30 m of bare corridor, there or there and back,
    where nobody walks and ``minutes`` count for nothing."""
    fault: str = "none"
    """One of FAULTS, which happens once: odometry freezes for 2 s and then jumps to where it would be, a bump makes it
    slip by 0.2 m and 20 degrees, or somebody carries the robot 1 m while the wheels stand still."""
    way: int = 0
    """Another drive through the same home: beyond 0 the robot visits other places in a random order, and people,
    odometry and sensor err anew. The map frames of a home's drives are the same, since all begin on the dock."""
    moved: int = 0
    """Up to so many pieces of furniture stand elsewhere in their rooms than on drives where it is 0; which ones follows
    from ``way``, or from ``arrangement`` if that is above 0."""
    arrangement: int = 0
    """Beyond 0 what stands elsewhere, and how far doors stand open, follows from it: the same on several ways."""
    doors: bool = False
    """Whether doors stand open at other angles than on drives where it is False."""
    gyro: bool = False
    """Whether the robot has a gyro."""
    turn_error: float = 1.0
    """One more factor on the errors of odometry's turns."""
    rear: bool = False
    """Whether a second sensor of the same kind looks back, from as far behind the base's middle; it takes its scans
    two fifths of a period after the first."""

    def __post_init__(self) -> None:
        """Refuse what cannot be simulated."""
        if not 0.0 <= self.odometry_error <= 100.0:
            raise ValueError(f"odometry error factor {self.odometry_error:g}: choose one from 0 to 100")
        if not 0.0 <= self.turn_error <= 100.0:
            raise ValueError(f"turn error factor {self.turn_error:g}: choose one from 0 to 100")
        if not 0.0 <= self.minutes <= 40.0:
            raise ValueError(f"{self.minutes:g} minutes: choose from 0 to 40")
        if self.scene not in SCENES:
            raise ValueError(f"scene {self.scene!r}: choose one of {', '.join(SCENES)}")
        if self.fault not in FAULTS:
            raise ValueError(f"fault {self.fault!r}: choose one of {', '.join(FAULTS)}")
        if self.fault == "carried" and self.in_corridor:
            raise ValueError("nobody carries the robot in the corridor: choose another fault or scene")
        if self.way < 0 or self.moved < 0:
            raise ValueError(f"way {self.way}, {self.moved} pieces moved: choose whole numbers from 0")
        if self.arrangement < 0:
            raise ValueError(f"arrangement {self.arrangement}: choose a whole number from 0")
        if self.scene != "home" and (self.moved > 0 or self.doors):
            raise ValueError(f"scene {self.scene!r}: furniture and doors are moved in scene 'home' only")

    @property
    def in_corridor(self) -> bool:
        """Whether the scene is a bare corridor."""
        return self.scene.startswith("corridor")


@dataclass(frozen=True)
class Event:
    """A service call of the drive: when [s], which, with what."""

    t: float
    call: str
    args: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Drive:
    """A drive with all that its robot measured and all that is true.

    n scans, m odometry poses. The map frame's origin is the first sensor pose, the odometry frame's some other place.
    Poses are x [m], y [m], heading [rad] in [-pi, pi); `T_a_b` takes points of frame b to frame a.
    """

    seed: int
    config: SimulationConfig
    home: Home
    """In the map frame."""
    scan_stamps: npt.NDArray[np.int64]
    """(n,) [ns]; every one is the stamp of an odometry pose too."""
    ranges: npt.NDArray[np.float32]
    """(n, beams) [m] in whole millimetres, infinite for no return."""
    rear_ranges: npt.NDArray[np.float32]
    """(n - 1, beams) of a sensor that looks back, at the odometry poses REAR_STEPS after the scans; (0, beams) if there
    is none."""
    odometry_stamps: npt.NDArray[np.int64]
    """(m,) [ns]"""
    T_odom_base: Array
    """(m, 3)"""
    T_odom_base_at_scans: Array
    """(n, 3)"""
    T_map_base: Array
    """(n, 3), true, at the scans."""
    T_map_base_at_odometry: Array
    """(m, 3), true, at the odometry poses."""
    gyro: Array
    """(m,) yaw rates [rad/s] of the robot's gyro at the odometry poses; empty if it has none."""
    legs: Array
    """(n, 2, 2) centres of the person's legs in the map frame, NaN while there is none."""
    events: tuple[Event, ...]
    fault_times: tuple[float, float] | None
    """From when to when [s] the odometry told something else than the motion, beyond its usual errors."""

    @property
    def scan_times(self) -> Array:
        """(n,) [s]."""
        return np.asarray(self.scan_stamps / 1e9)

    @property
    def odometry_times(self) -> Array:
        """(m,) [s]."""
        return np.asarray(self.odometry_stamps / 1e9)

    @property
    def T_base_sensor(self) -> Array:  # noqa: N802
        """(3,)."""
        return np.array(self.config.sensor.mount)

    @property
    def angle_min(self) -> float:
        """Bearing of the first beam [rad]."""
        return self.config.sensor.angle_min

    @property
    def angle_increment(self) -> float:
        """Between neighbouring beams [rad]."""
        return self.config.sensor.angle_increment

    @property
    def range_min(self) -> float:
        """[m]; closer things give no return."""
        return self.config.sensor.range_min

    @property
    def range_max(self) -> float:
        """[m]; farther things give no return."""
        return self.config.sensor.range_max

    @property
    def length(self) -> float:
        """Way driven [m]."""
        return float(np.hypot(*np.diff(self.T_map_base_at_odometry[:, :2], axis=0).T).sum())

    @property
    def duration(self) -> float:
        """From the first scan to the last [s]."""
        return float(self.scan_stamps[-1] - self.scan_stamps[0]) / 1e9

    @property
    def odometry_error_at_end(self) -> tuple[float, float]:
        """How far [m] and how much turned [rad] the odometry sees the last scan's base from its true place."""
        by_odometry = between(self.T_odom_base[0], self.T_odom_base[-1])
        truly = between(self.T_map_base_at_odometry[0], self.T_map_base_at_odometry[-1])
        x, y, heading = between(truly, by_odometry).tolist()
        return float(np.hypot(x, y)), float(heading)


def simulate_drive(seed: int, config: SimulationConfig | None = None, plan: Plan | None = None) -> Drive:
    """Simulate the drive of a seed (not negative). The same seed and configuration give the same bytes.

    With a ``plan`` it leads through that home instead of one that is made up.

    Home, way, person, odometry and sensor draw from streams of their own, so that, say, another odometry error leaves
    home, way and scans as they are. Raises ValueError for a seed or a configuration that cannot be, and InputError for
    a plan that no robot can drive through.
    """
    config = config or SimulationConfig()
    if seed < 0:
        raise ValueError(f"seed {seed}: choose a whole number from 0")
    home_rng, way_rng, person_rng, odometry_rng, sensor_rng, fault_rng, gyro_rng = _streams(seed, config.way)
    course = _make_course(seed, config, plan, home_rng, way_rng, fault_rng)
    whole = course.motion.steps.shape[0] // STEPS_PER_SCAN * STEPS_PER_SCAN  # the last step is the last scan's
    all_poses, steps = course.motion.poses[: whole + 1], course.motion.steps[:whole]
    poses = all_poses[::STEPS_PER_SCAN]
    legs = np.full((len(poses), 2, 2), np.nan)
    if config.person and course.places is not None:
        places = course.places
        legs = person.simulate_person(poses, STEP * STEPS_PER_SCAN, places.path, len(places.cells), person_rng)
    sensor_poses = compose(poses, config.sensor.mount)
    eyes = sensor_poses if config.sensor.sweep_seconds == 0.0 else _sweeping(config.sensor, all_poses)
    true = cast_drive(config.sensor, eyes, course.home.segments, course.home.discs, legs, person.LEG_RADIUS)
    T_plan_map = sensor_poses[0]
    T_map_plan = between(T_plan_map, np.zeros(3))
    T_map_base = between(T_plan_map, all_poses)
    start = np.array([*odometry_rng.uniform(-2.0, 2.0, 2), odometry_rng.uniform(-np.pi, np.pi)])
    odometry = simulate_odometry(steps, STEP, start, config.odometry_error, odometry_rng, config.turn_error)
    odometry[:, 2] = wrap_angle(odometry[:, 2])
    faulty = course.carried
    if config.fault in _ODOMETRY_FAULTS:
        odometry, faulty = _ODOMETRY_FAULTS[config.fault](odometry, steps, STEP, fault_rng)
    odometry_stamps = START_STAMP + STEP_STAMP * np.arange(len(odometry), dtype=np.int64)
    return Drive(
        seed=seed,
        config=config,
        home=course.home.moved(T_map_plan),
        scan_stamps=odometry_stamps[::STEPS_PER_SCAN],
        ranges=measure(config.sensor, *true, sensor_rng),
        rear_ranges=_measure_behind(config, all_poses, course.home, legs, sensor_rng),
        odometry_stamps=odometry_stamps,
        T_odom_base=odometry,
        T_odom_base_at_scans=odometry[::STEPS_PER_SCAN],
        T_map_base=T_map_base[::STEPS_PER_SCAN],
        T_map_base_at_odometry=T_map_base,
        gyro=simulate_gyro(steps[:, 1], STEP, gyro_rng) if config.gyro else np.empty(0),
        legs=transform(T_map_plan, legs),
        events=() if config.in_corridor else _events(odometry_stamps),
        fault_times=None if faulty is None else _seconds(odometry_stamps, faulty),
    )


def first_seconds(drive: Drive, seconds: float) -> Drive:
    """The beginning of a drive, with the calls that were made in it."""
    scans = min(len(drive.scan_stamps), 1 + int(seconds / (STEP * STEPS_PER_SCAN)))
    steps = (scans - 1) * STEPS_PER_SCAN + 1
    return replace(
        drive,
        scan_stamps=drive.scan_stamps[:scans],
        ranges=drive.ranges[:scans],
        rear_ranges=drive.rear_ranges[: scans - 1],
        odometry_stamps=drive.odometry_stamps[:steps],
        T_odom_base=drive.T_odom_base[:steps],
        T_odom_base_at_scans=drive.T_odom_base_at_scans[:scans],
        T_map_base=drive.T_map_base[:scans],
        T_map_base_at_odometry=drive.T_map_base_at_odometry[:steps],
        gyro=drive.gyro[:steps],
        legs=drive.legs[:scans],
        events=tuple(event for event in drive.events if event.t <= drive.scan_stamps[scans - 1] / 1e9),
    )


def rear_mount(sensor: Sensor) -> tuple[float, float, float]:
    """T_base_sensor of a sensor that looks back."""
    x, y, heading = sensor.mount
    return -x, y, heading + np.pi


def _measure_behind(
    config: SimulationConfig, all_poses: Array, home: Home, legs: Array, rng: Rng
) -> npt.NDArray[np.float32]:
    if not config.rear:
        return np.empty((0, config.sensor.beams), dtype=np.float32)
    sensor = replace(config.sensor, mount=rear_mount(config.sensor))
    poses = all_poses[REAR_STEPS:]
    eyes = compose(poses[::STEPS_PER_SCAN], sensor.mount) if sensor.sweep_seconds == 0.0 else _sweeping(sensor, poses)
    true = cast_drive(sensor, eyes, home.segments, home.discs, legs[: len(eyes)], person.LEG_RADIUS)
    return measure(sensor, *true, rng)


def _sweeping(sensor: Sensor, poses: Array) -> Array:
    """The sensor's poses (n, beams, 3) at the beams of each scan from the base's at each step; at the end it stands."""
    order = np.arange(sensor.beams)[:: -1 if sensor.driver == "turned-round" else 1]
    steps = order * sensor.time_increment / STEP
    at = np.arange(0, len(poses), STEPS_PER_SCAN)[:, None] + steps
    before = np.minimum(at.astype(np.int64), len(poses) - 1)
    after = np.minimum(before + 1, len(poses) - 1)
    base = poses[before] + (at - before)[..., None] * (poses[after] - poses[before])  # headings are not wrapped
    return compose(base, sensor.mount)


def _streams(seed: int, way: int) -> list[Rng]:
    """The random streams of a drive: the home's is the seed's, the others are the seed's and the way's."""
    sequences = np.random.SeedSequence(seed).spawn(7)
    if way > 0:
        sequences[1:] = np.random.SeedSequence([seed, way]).spawn(6)
    return [np.random.Generator(np.random.PCG64(sequence)) for sequence in sequences]


def _seconds(stamps: npt.NDArray[np.int64], steps: tuple[int, int]) -> tuple[float, float]:
    return float(stamps[steps[0]] / 1e9), float(stamps[steps[1]] / 1e9)


_ODOMETRY_FAULTS = {"freeze": faults.freeze, "bump": faults.bump}


def _make_course(
    seed: int, config: SimulationConfig, plan: Plan | None, home_rng: Rng, way_rng: Rng, fault_rng: Rng
) -> Course:
    if plan is not None and (config.scene != "home" or config.moved > 0 or config.doors):
        raise ValueError("a floor plan is taken as it is: choose no scene, and move no furniture or doors")
    if config.in_corridor:
        return drive_corridor(config.scene == "corridor-return", way_rng)
    if plan is not None:
        made = furnish_plan(plan, home_rng)
    elif config.moved > 0 or config.doors:
        furnisher = furnish_home(home_rng)
        moving = way_rng.spawn(1)[0]
        if config.arrangement > 0:
            moving = np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, config.arrangement, _MOVING])))
        furnisher.rearrange(config.moved, moving)
        if config.doors:
            furnisher.swing_doors(moving)
        made = furnisher.home(), furnisher.plan, furnisher.grid
    else:
        made = (make_alike_home if config.scene == "alike" else make_home)(home_rng)
    carrying = fault_rng if config.fault == "carried" else None
    course = tour_home(*made, config.minutes, way_rng, carrying, roam=config.way > 0)
    if config.fault == "carried" and course.carried is None:
        raise ValueError("the robot comes to no place that it could be carried from: choose another seed")
    return course


def _events(stamps: npt.NDArray[np.int64]) -> tuple[Event, ...]:
    """The calls of a client: the dock is marked soon after the start, and found again at the end."""
    marked = int(stamps[0]) + round(AFTER_DOCKING * 1e9)
    docked = int(stamps[-1]) - round((DOCKED - AFTER_DOCKING) * 1e9)
    return (
        Event(marked / 1e9, "graph_loc/create", ("dock", "dock")),
        Event(docked / 1e9, "map/notify_docked", ()),
    )
