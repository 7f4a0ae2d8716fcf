# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A drive through a made-up home, from the dock through all rooms and back onto the dock, with its ground truth."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from oort.poses import Array, between, compose, wrap_angle
from oort.simulate import person
from oort.simulate.driver import STEP, Driver, Motion
from oort.simulate.home import DOCK_FRONT, Home, make_home
from oort.simulate.odometry import simulate_odometry
from oort.simulate.planar import transform
from oort.simulate.sensor import Sensor, cast_drive, measure
from oort.simulate.tour import Places, find_places, plan_tour

START_STAMP = 1_600_000_000_000_000_000  # ns, of the first scan
STEP_STAMP = round(STEP * 1e9)  # ns between odometry poses
STEPS_PER_SCAN = 5  # 10 scans a second
DOCKED = 2.0  # s on the dock, before and after
AFTER_DOCKING = 1.05  # s from standing on the dock to the call that tells so; falls between two scans
CRUISE = (0.28, 0.45)  # m/s
MEAN_SPEED = 0.4  # m/s of routes' cost, turns and halts included, to guess a tour's length from its duration


@dataclass(frozen=True)
class SimulationConfig:
    """What a simulated drive is like beside its seed, which alone decides home and way (but for ``minutes``)."""

    sensor: Sensor = field(default_factory=Sensor)
    odometry_error: float = 1.0
    """Factor on all odometry errors: 0 none, 1 a good base, 3 three times worse."""
    person: bool = True
    """Whether a person crosses the view now and then."""
    minutes: float = 3.0
    """Least duration, roughly: after a tour of all rooms the drive goes on to random places until then."""

    def __post_init__(self) -> None:
        """Refuse what cannot be simulated."""
        if not 0.0 <= self.odometry_error <= 100.0:
            raise ValueError(f"odometry error factor {self.odometry_error:g}: choose one from 0 to 100")
        if not 0.0 <= self.minutes <= 40.0:
            raise ValueError(f"{self.minutes:g} minutes: choose from 0 to 40")


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
    legs: Array
    """(n, 2, 2) centres of the person's legs in the map frame, NaN while there is none."""
    events: tuple[Event, ...]

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


def simulate_drive(seed: int, config: SimulationConfig | None = None) -> Drive:
    """Simulate the drive of a seed (not negative). The same seed and configuration give the same bytes.

    Home, way, person, odometry and sensor draw from streams of their own, so that, say, another odometry error leaves
    home, way and scans as they are. Raises ValueError for a seed or a configuration that cannot be.
    """
    config = config or SimulationConfig()
    if seed < 0:
        raise ValueError(f"seed {seed}: choose a whole number from 0")
    streams = [np.random.Generator(np.random.PCG64(s)) for s in np.random.SeedSequence(seed).spawn(5)]
    home_rng, way_rng, person_rng, odometry_rng, sensor_rng = streams
    home, plan, grid = make_home(home_rng)
    dock_front = transform(home.dock, [DOCK_FRONT, 0.0])
    places = find_places(plan, grid, dock_front)
    motion = _drive(home, places, config.minutes, way_rng)
    poses = motion.poses[::STEPS_PER_SCAN]
    period = STEP * STEPS_PER_SCAN
    legs = np.full((len(poses), 2, 2), np.nan)
    if config.person:
        legs = person.simulate_person(poses, period, places.path, len(places.cells), person_rng)
    sensor_poses = compose(poses, config.sensor.mount)
    true = cast_drive(config.sensor, sensor_poses, home.segments, home.discs, legs, person.LEG_RADIUS)
    T_plan_map = sensor_poses[0]
    T_map_plan = between(T_plan_map, np.zeros(3))
    T_map_base = between(T_plan_map, motion.poses)
    start = np.array([*odometry_rng.uniform(-2.0, 2.0, 2), odometry_rng.uniform(-np.pi, np.pi)])
    odometry = simulate_odometry(motion.steps, STEP, start, config.odometry_error, odometry_rng)
    odometry[:, 2] = wrap_angle(odometry[:, 2])
    odometry_stamps = START_STAMP + STEP_STAMP * np.arange(len(odometry), dtype=np.int64)
    return Drive(
        seed=seed,
        config=config,
        home=home.moved(T_map_plan),
        scan_stamps=odometry_stamps[::STEPS_PER_SCAN],
        ranges=measure(config.sensor, *true, sensor_rng),
        odometry_stamps=odometry_stamps,
        T_odom_base=odometry,
        T_odom_base_at_scans=odometry[::STEPS_PER_SCAN],
        T_map_base=T_map_base[::STEPS_PER_SCAN],
        T_map_base_at_odometry=T_map_base,
        legs=transform(T_map_plan, legs),
        events=_events(odometry_stamps),
    )


def _drive(home: Home, places: Places, minutes: float, rng: np.random.Generator) -> Motion:
    """From the dock along a tour, with halts and looks around here and there, and backwards onto the dock."""
    driver = Driver(home.dock, places.grid)
    driver.wait(DOCKED)
    driver.follow(_straight(home.dock), float(rng.uniform(*CRUISE)))
    tour = plan_tour(places, 60.0 * minutes * MEAN_SPEED, rng)
    stretch: list[Array] = []
    for start, goal in pairwise(tour):
        stretch.append(places.path(start, goal))
        halt = float(rng.random())
        if goal == tour[-1] or halt < 0.3:
            driver.follow(_joined(stretch), float(rng.uniform(*CRUISE)))
            stretch = []
        if goal != tour[-1] and halt < 0.15:
            driver.turn_by(float(rng.choice([-1.0, 1.0])) * 2.0 * np.pi)
        elif goal != tour[-1] and halt < 0.3:
            driver.wait(float(rng.uniform(0.5, 2.0)))
    driver.turn_to(float(home.dock[2]))
    driver.back_onto(home.dock)
    driver.wait(DOCKED)
    motion = driver.motion()
    whole = len(motion.steps) // STEPS_PER_SCAN * STEPS_PER_SCAN  # the last step is the last scan's
    return Motion(motion.poses[: whole + 1], motion.steps[:whole])


def _straight(dock: Array) -> Array:
    """Points from the dock to the place before it."""
    way = np.linspace(0.0, DOCK_FRONT, 9)
    return transform(dock, np.column_stack([way, np.zeros_like(way)]))


def _joined(paths: Sequence[Array]) -> Array:
    """Paths that begin where the one before ends, as one without doubled points."""
    return np.vstack([paths[0], *(path[1:] for path in paths[1:])])


def _events(stamps: npt.NDArray[np.int64]) -> tuple[Event, ...]:
    """The calls of a client: the dock is marked soon after the start, and found again at the end."""
    marked = int(stamps[0]) + round(AFTER_DOCKING * 1e9)
    docked = int(stamps[-1]) - round((DOCKED - AFTER_DOCKING) * 1e9)
    return (
        Event(marked / 1e9, "graph_loc/create", ("dock", "dock")),
        Event(docked / 1e9, "map/notify_docked", ()),
    )
