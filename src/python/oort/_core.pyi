# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Written by scripts/stubs.sh from the extension.
"""The engine of Oort. Use it through the modules of the package oort."""

import enum
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Error(RuntimeError):
    """What Oort cannot do, and what to do about it."""

class ParameterError(Error):
    """A parameter or an option has a value that it cannot have."""

class MapFileError(Error):
    """A map cannot be read or written: its files are missing, damaged or of another program."""

class InputError(Error):
    """Input cannot be used: a recording, a scan, a pose, a graph."""

class StateError(Error):
    """A call does not fit the state: nothing is being mapped, there is a map already, there is no such place."""

class TrackingState(enum.StrEnum):
    """How well the sensor's place on the map is known: by what scans show, by odometry alone, or not."""

    TRACKING = "tracking"
    UNCERTAIN = "uncertain"
    LOST = "lost"

class ScanOutcome(enum.StrEnum):
    """What a scan became: a node, a pose relative to the last node, or nothing as it has too few returns."""

    NODE = "node"
    LOCATED = "located"
    SKIPPED = "skipped"

class LocalizationState(enum.StrEnum):
    """How well the sensor's place on a saved map is known."""

    SEARCHING = "searching"
    TRACKING = "tracking"
    UNCERTAIN = "uncertain"
    LOST = "lost"

class ParameterEntry:
    """One row of the table of parameters."""
    @property
    def choices(self) -> list[str]: ...
    @property
    def default(self) -> bool | int | float | str: ...
    @property
    def documented(self) -> bool | int | float | str: ...
    @property
    def max(self) -> float | None: ...
    @property
    def meaning(self) -> str: ...
    @property
    def min(self) -> float | None: ...
    @property
    def own(self) -> bool: ...
    @property
    def path(self) -> str: ...
    @property
    def reason(self) -> str: ...
    @property
    def status(self) -> str: ...
    @property
    def type(self) -> str: ...
    @property
    def unit(self) -> str: ...

class Parameters:
    """The parameters of the engine, by their paths in params.json."""
    def __init__(self) -> None:
        """Every value at its default."""
    def check(self) -> None:
        """Checks values against each other. Raises ParameterError."""
    def copy(self) -> Parameters: ...
    def get(self, path: str) -> bool | int | float | str:
        """The value at a path. Raises ParameterError if it is unknown."""
    def set(self, path: str, value: bool | int | float | str) -> None:
        """Sets the value at a path. Raises ParameterError if the path is unknown or the value not allowed."""
    def to_dict(self) -> dict[str, bool | int | float | str]:
        """Every path and its value, in the order of params.json."""

class OccupancyGrid:
    """A map to navigate by: the fields of nav_msgs/OccupancyGrid."""
    @property
    def cells(self) -> NDArray[np.int8]:
        """(height, width) int8, a copy: 0 free, 100 occupied, -1 unknown; row 0 has the least y."""
    @property
    def height(self) -> int:
        """Rows."""
    @property
    def origin(self) -> tuple[float, float]:
        """Lower left corner (x, y) in the map frame [m]."""
    @property
    def resolution(self) -> float:
        """Side of a cell [m]."""
    @property
    def width(self) -> int:
        """Columns."""

class RenderedMap:
    """A map drawn."""
    @property
    def map(self) -> OccupancyGrid:
        """As the scans say, with the robot's way cleared."""
    @property
    def map_cleaned(self) -> OccupancyGrid:
        """The same without speckle noise, for path planning."""

class Map:
    """A map as a map file holds it. All arrays are copies; poses are rows of x, y [m], theta [rad]."""
    def __init__(self) -> None:
        """An empty map."""
    def __len__(self) -> int: ...
    def cloud(self, k: int) -> NDArray[np.float64]:
        """(M, 3) beams of node k in the sensor's frame, in scan order: x, y, 1 for a return; z is nan otherwise, and x
        nan or inf with y the bearing [rad] where the range was. Raises IndexError.
        """
    def locate(self, name_space: str, id: str) -> tuple[float, float, float] | None:
        """A place's pose in the map, or None."""
    def render(self, parameters: Parameters = ...) -> RenderedMap:
        """Draws the map to navigate by; of the parameters output_map counts. Raises ParameterError or InputError."""
    def save(self, path: str) -> None:
        """Writes the map's three files as one, as save_map does. Raises MapFileError."""
    @property
    def cloud_times(self) -> NDArray[np.float64]:
        """(N,) stamp of each cloud [s]."""
    @property
    def clouds(self) -> list[NDArray[np.float64]]:
        """All of them, in the order of the nodes: a list of arrays as cloud()."""
    @property
    def edges(self) -> dict[str, NDArray[Any]]:
        """The links that are always believed, as a dict of arrays: id, i, j, time [s], node (at which it was
        calculated), pose (E, 3: T_i_j), covariance (E, 3, 3), type (0 laser, 1 odometry).
        """
    @property
    def incremental_results(self) -> dict[str, NDArray[Any]]:
        """How each node was linked to the one before it, as a dict of arrays: id, target, local_pose (T_local_id),
        covariance (of local_pose), pose (T_target_id), hit_fraction.
        """
    @property
    def locations(self) -> list[tuple[str, str, int, tuple[float, float, float]]]:
        """Named places: a list of (namespace, id, node_id, (x, y, theta)) with the pose in the node's frame. Assign a
        list to replace them.
        """
    @locations.setter
    def locations(self, value: Sequence[tuple[str, str, int, tuple[float, float, float]]]) -> None: ...
    @property
    def loop_results(self) -> dict[str, NDArray[Any]]:
        """How loops were closed, as a dict of arrays: id, target, pose (T_id_target), covariance, hit_fraction."""
    @property
    def loose_parts(self) -> list[NDArray[np.uint64]]:
        """Nodes that nothing ties to the rest, after a pause, in a session or after a kidnapping: for each such part an
        array of their ids. Where it lies is not known.
        """
    @property
    def node_ids(self) -> NDArray[np.uint64]:
        """(N,) ids of the nodes, 0...N-1."""
    @property
    def node_poses(self) -> NDArray[np.float64]:
        """(N, 3) T_map_sensor of each node."""
    @property
    def switchable_edges(self) -> dict[str, NDArray[Any]]:
        """The links that the optimiser may switch off: as edges, and switch in [0, 1]."""

class Saved:
    """What save_metadata wrote.

    Members:

    MAP

    METADATA
    """

    MAP: ClassVar[Saved]
    METADATA: ClassVar[Saved]
    def __init__(self, value: int) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class MapFormat:
    """Which format a map file has."""
    @property
    def version(self) -> int:
        """0 for a map of the original Oort."""
    @property
    def written_by(self) -> str:
        """The program and its version; empty if it is not known."""

class Whitening:
    """How an error e is weighted by its information L L^T.

    Members:

    CORRECT : L^T e

    ORIGINAL : L e, as Mayfield's Oort did
    """

    CORRECT: ClassVar[Whitening]
    ORIGINAL: ClassVar[Whitening]
    def __init__(self, value: int) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class RobustKernel:
    """How a switchable link that disagrees loses its weight.

    Members:

    SWITCHABLE : by its switch

    HUBER : its cost grows in proportion to its error, no longer its square
    """

    HUBER: ClassVar[RobustKernel]
    SWITCHABLE: ClassVar[RobustKernel]
    def __init__(self, value: int) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class OptimizerOptions:
    """How the pose graph is solved."""

    robust_kernel: RobustKernel
    whitening: Whitening
    def __init__(
        self,
        *,
        switchable_constraint_scale: float = 2.0,
        whitening: Whitening = ...,
        max_iterations: int = 50,
        decide: bool = True,
        first_free_node: int = 0,
        robust_kernel: RobustKernel = ...,
        huber_scale: float = 10.0,
    ) -> None: ...
    @property
    def decide(self) -> bool:
        """Whether links that disagree with the optimum of the switches (at 95 %) are then left out."""
    @decide.setter
    def decide(self, arg0: bool) -> None: ...
    @property
    def first_free_node(self) -> int:
        """Nodes before this one keep their poses."""
    @first_free_node.setter
    def first_free_node(self, arg0: int) -> None: ...
    @property
    def huber_scale(self) -> float:
        """Standard deviations from which on a link's cost is no longer squared, with HUBER."""
    @huber_scale.setter
    def huber_scale(self, arg0: float) -> None: ...
    @property
    def max_iterations(self) -> int: ...
    @max_iterations.setter
    def max_iterations(self, arg0: int) -> None: ...
    @property
    def switchable_constraint_scale(self) -> float:
        """The squared Mahalanobis distance at which a link is half switched off."""
    @switchable_constraint_scale.setter
    def switchable_constraint_scale(self, arg0: float) -> None: ...

class OptimizerSummary:
    """How solving the pose graph went."""
    @property
    def chi_squared(self) -> NDArray[np.float64]:
        """(S,) of each switchable edge, in their order, at the final poses."""
    @property
    def converged(self) -> bool: ...
    @property
    def final_cost(self) -> float: ...
    @property
    def initial_cost(self) -> float:
        """Half the sum of chi^2 over the edges and of scale chi^2 / (scale + chi^2) over the switchable ones, chi^2
        being the squared Mahalanobis distance.
        """
    @property
    def iterations(self) -> int: ...
    @property
    def message(self) -> str:
        """Why the solver stopped."""

class OdometryBuffer:
    """Odometry poses by time, interpolated at a scan's stamp."""
    def __init__(self, horizon: float = 0.0) -> None:
        """Poses older than `horizon` [s] before the newest are dropped; 0 keeps all."""
    def __len__(self) -> int: ...
    def add(self, time: float, x: float, y: float, theta: float) -> None:
        """Adds T_odom_base at a time [s]."""
    def clear(self) -> None: ...
    def lookup(self, time: float, most_ahead: float = 0.0) -> tuple[float, float, float] | None:
        """T_odom_base (x, y, theta) at a time [s]; None outside the times held, but for up to `most_ahead` [s] after
        the newest pose, where the base goes on as the last poses moved.
        """

class GyroOdometry:
    """Odometry whose turns are those of a gyro."""
    def __init__(self) -> None: ...
    def add_gyro(self, time: float, yaw_rate: float) -> None:
        """Adds a yaw rate of the base [rad/s] at a time [s]."""
    def add_odometry(self, time: float, x: float, y: float, theta: float) -> None:
        """Adds T_odom_base at a time [s]."""
    def flush(self) -> None:
        """Settles what is left, as the gyro tells nothing more."""
    def set_back(self, time: float) -> None:
        """Odometry's clock was set back to a time [s]: poses not taken are gone, pose and bias go on."""
    def take(self) -> list[tuple[float, float, float, float]]:
        """The poses that are settled since the last call: time [s], x, y, theta of T_odom_base."""
    @property
    def bias(self) -> float | None:
        """Of the gyro [rad/s]; None until the base stood for a second."""
    @property
    def steps_by_gyro(self) -> int:
        """Steps that have the gyro's turn."""
    @property
    def steps_by_odometry(self) -> int:
        """Steps that have odometry's."""

class ScanResult:
    """What became of a scan."""
    @property
    def T_map_base(self) -> tuple[float, float, float]:
        """The base's pose (x, y, theta) in the map when the scan came."""
    @property
    def T_map_odom(self) -> tuple[float, float, float]:
        """Where odometry's frame was in the map when the scan came."""
    @property
    def T_node_sensor(self) -> tuple[float, float, float]:
        """The sensor's pose (x, y, theta) seen from the node."""
    @property
    def corrected(self) -> bool:
        """Whether closures or a solution took effect with the scan."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """Of the pose as matched (x, y, theta, along the axes of the map), 3x3; zero if it was not matched."""
    @property
    def inlier_ratio(self) -> float:
        """Share of the returns that lie on the local map."""
    @property
    def node_id(self) -> int | None:
        """The node that the pose is relative to, or None."""
    @property
    def outcome(self) -> ScanOutcome:
        """What the scan became."""
    @property
    def rejection(self) -> str | None:
        """Why its match is of no use, for people; None if it is."""
    @property
    def tracking(self) -> TrackingState:
        """How well the sensor's place is known."""
    @property
    def was_tracked(self) -> bool:
        """Whether the scan matcher was asked."""

class Mapper:
    """Turns scans with odometry into a map. Threads may share it: its calls are made one after the other."""
    def __init__(
        self, parameters: Parameters, sensor_on_base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> None: ...
    def add_ranges(
        self,
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        odometry: tuple[float, float, float],
        sweep: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    ) -> ScanResult:
        """Takes the next scan with T_odom_base at its stamp and, for one whose beams were not measured at once, where
        the base was at the first and at the last beam, seen from where it was at the stamp. Raises InputError;
        nothing changes then.
        """
    def add_ranges_of_other(
        self,
        sensor_on_base: tuple[float, float, float],
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        odometry: tuple[float, float, float],
        sweep: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    ) -> None:
        """Takes a scan of another laser, which joins the next one of the main laser. Raises InputError."""
    def begin_session(self, sensor_on_map: tuple[float, float, float]) -> None:
        """The next scan begins a new trajectory segment at about this pose of the map, which is pruned first if it
        shows most places more often than keep_views asks for: see take_renumbering.
        """
    def create_location(self, name_space: str, id: str, pose: tuple[float, float, float]) -> None:
        """Names a pose of the map."""
    def create_points(self, name_spaces: Sequence[str], points: Sequence[Sequence[float]], ids: Sequence[str]) -> None:
        """Names points of the map, relative to the node nearest to their centroid."""
    def delete_location(self, name_space: str, id: str) -> bool: ...
    def finish(self) -> None:
        """Brings the map to its final solution."""
    def keep_closure_attempts(self, capacity: int) -> None:
        """Keeps the latest attempts to close loops, so many at most."""
    def locate(self, name_space: str, id: str) -> tuple[float, float, float] | None:
        """The place's pose in the map now, or None."""
    def map(self) -> Map:
        """A snapshot of the map."""
    def mount_sensor(self, sensor_on_base: tuple[float, float, float]) -> None:
        """Says where the sensor sits on the base, before the first scan."""
    def notify_docked(self) -> bool:
        """Links the current place to the dock, and waits for that. Whether a closure was found."""
    def request_dock_closure(self) -> None:
        """Has the current place linked to the dock, beside the scans to come."""
    def resume_from_paused(self) -> None:
        """The next scan makes a node whose link to the last one is very uncertain."""
    def set_map(self, map: Map) -> None:
        """Replaces everything by a map from elsewhere."""
    def take_renumbering(self) -> tuple[NDArray[np.int64], NDArray[np.float64]] | None:
        """What became of the nodes, if the last scan, session or finish gave them other ids, as the map was reduced to
        the views that it needs: for each node that there was the node that it became or by which its place is known
        now (n,), and where it is seen from there (x, y, theta; n, 3). Else None. Tells it once.
        """
    @property
    def closure_attempts(self) -> list[tuple[int, int, str | None, tuple[float, float, float], float]]:
        """(query node, candidate node, why it was rejected or None, T_candidate_query, inlier ratio) of each kept."""
    @property
    def dock_closure_found(self) -> bool | None:
        """Whether the last request found a closure; None without one, or while it is looked for."""
    @property
    def has_pose(self) -> bool:
        """Whether the sensor's pose in the map is known."""
    @property
    def locations(self) -> list[tuple[str, str, int, tuple[float, float, float]]]:
        """(namespace, id, node id, T_node_location) of each place."""
    @property
    def num_nodes(self) -> int: ...
    @property
    def odom_pose(self) -> tuple[float, float, float]:
        """T_map_odom at the current solution."""
    @property
    def sensor_pose(self) -> tuple[float, float, float]:
        """The latest scan's T_map_sensor at the current solution."""
    @property
    def statistics(self) -> dict[str, Any]:
        """Counts since the mapper was made."""
    @property
    def work_seconds(self) -> dict[str, float]:
        """CPU seconds since the mapper was made, by kind of work; they differ from run to run."""

class PlacedScan:
    """A scan and where odometry saw it."""
    def __init__(
        self,
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        sensor_in_odom: tuple[float, float, float],
        sweep: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    ) -> None:
        """The sweep is the sensor's."""

class ReferenceMap:
    """A saved map made ready to find a robot on it."""
    def __init__(self, map: Map, parameters: Parameters) -> None:
        """Raises InputError if the map is empty or contradicts itself."""

class Hypothesis:
    """A place of the map where scans fit."""
    @property
    def T_map_sensor(self) -> tuple[float, float, float]:
        """Of the newest scan."""
    @property
    def counts(self) -> dict[str, int]:
        """What the support is made of."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """(3, 3) of x, y, theta, along the axes of the map."""
    @property
    def support(self) -> float:
        """Share of the returns that fit, less the share that contradicts."""

class Relocalization:
    """What a search without a guess found."""
    @property
    def best(self) -> Hypothesis | None:
        """The answer, or what was rejected; None if nothing fits."""
    @property
    def found(self) -> bool:
        """Whether there is an answer."""
    @property
    def rejection(self) -> str | None:
        """Why there is none, for people: "too_few_points", "no_match", "low_support", "ambiguous" or "imprecise"; None
        if there is.
        """
    @property
    def second(self) -> Hypothesis | None:
        """The next place apart from it, or None."""

class Relocalizer:
    """Finds the robot on a map without a guess. Thread-safe."""
    def __init__(self, map: ReferenceMap, parameters: Parameters) -> None: ...
    def find(self, scans: Sequence[PlacedScan]) -> Relocalization:
        """Looks for one or a few scans, oldest first, joined by odometry; the answer is the newest one's pose."""

class Localizer:
    """Follows a robot on a map that does not change. Threads may share it: its calls are made one after the other."""
    def __init__(
        self, map: ReferenceMap, parameters: Parameters, sensor_on_base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> None: ...
    def add_ranges(
        self,
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        odometry: tuple[float, float, float],
        sweep: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    ) -> LocalizationState:
        """Takes the next scan with T_odom_base at its stamp and, for one whose beams were not measured at once, where
        the base was at the first and at the last beam, seen from where it was at the stamp. Raises InputError;
        nothing changes then.
        """
    def add_ranges_of_other(
        self,
        sensor_on_base: tuple[float, float, float],
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        odometry: tuple[float, float, float],
        sweep: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None,
    ) -> None:
        """Takes a scan of another laser, which joins the next one of the main laser. Raises InputError."""
    def start_at(self, sensor_on_map: tuple[float, float, float], covariance: ArrayLike) -> None:
        """Says about where the sensor is at the next scan; the covariance is along the axes of the map."""
    def start_searching(self) -> None:
        """Forgets the pose."""
    @property
    def T_map_odom(self) -> tuple[float, float, float] | None:
        """Where odometry's frame is on the map; None while searching."""
    @property
    def T_map_sensor(self) -> tuple[float, float, float] | None:
        """The sensor's pose at the latest scan; None while searching."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """(3, 3) of T_map_sensor, along the axes of the map."""
    @property
    def state(self) -> LocalizationState:
        """How well the sensor's place is known."""
    @property
    def statistics(self) -> dict[str, Any]:
        """Counts since it was made."""
    @property
    def support(self) -> float:
        """How well the latest scan fitted, at most 1."""

class ReferenceScan:
    """A scan that others are laid on by themselves, without a map."""
    def __init__(
        self,
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
    ) -> None: ...
    def align(
        self,
        time: float,
        angle_min: float,
        angle_increment: float,
        range_min: float,
        range_max: float,
        ranges: ArrayLike,
        guesses: Sequence[tuple[float, float, float]],
    ) -> tuple[tuple[float, float, float], float, float, bool]:
        """Lays a scan on this one from some guesses (T_reference_scan): the pose that fits best, the mean squared
        distance of the points that lie on the reference [m^2], their share, and whether a direction is left open.
        """

class Merged:
    """What came of merging two maps."""
    @property
    def T_a_b(self) -> tuple[float, float, float]:
        """Where the second map was found on the first, before anything was solved."""
    @property
    def closures(self) -> dict[str, Any]:
        """From the second map to the first: tried, accepted, and rejected by reason."""
    @property
    def closures_kept(self) -> int:
        """Accepted ones that are on at the last solution."""
    @property
    def dropped(self) -> list[tuple[str, str, float]]:
        """(namespace, id, distance [m]) of each place of the second map that the first has already."""
    @property
    def first_node_b(self) -> int:
        """The nodes of the first map have the ids before it."""
    @property
    def found_by(self) -> str:
        """ "given", "dock" or "search\""""
    @property
    def map(self) -> Map:
        """The map of both; a copy."""
    @property
    def views(self) -> int:
        """Views of one map that were looked for on the other."""
    @property
    def views_that_contradict(self) -> int:
        """Where the map was found."""
    @property
    def views_that_fit(self) -> int:
        """Where the map was found."""

def load_map(path: str, ignore_checksum: bool = False) -> Map:
    """Reads a map given by its base path, one of its files, or X.capnp. Raises MapFileError."""

def map_of_views(poses: Sequence[tuple[float, float, float]], views: Sequence[Sequence[Sequence[float]]]) -> Map:
    """A map without a graph of the returns (x, y, in the sensor frame) seen from each pose (T_map_sensor)."""

def merge_maps(a: Map, b: Map, parameters: Parameters = ..., T_a_b: tuple[float, float, float] | None = None) -> Merged:
    """Joins two maps of the same home into one in the frame of the first. T_a_b is about where the second one's origin
    lies on the first; found if not given. Raises InputError and ParameterError.
    """

def normalise_map_path(path: str) -> str:
    """The absolute base path B of a map given as B, B.map_capnp, B.map_meta_capnp or X.capnp, links followed. Raises
    MapFileError.
    """

def optimize_graph(
    node_poses: ArrayLike,
    i: ArrayLike,
    j: ArrayLike,
    measurements: ArrayLike,
    covariances: ArrayLike,
    switchable: ArrayLike,
    options: OptimizerOptions = ...,
    switches: ArrayLike | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], OptimizerSummary]:
    """Solves a pose graph given as arrays: node_poses (N, 3: x, y [m], theta [rad]) to start from; for each of M edges
    the nodes i and j (M,), the measured T_i_j (M, 3), its covariance (M, 3, 3; along the axes of node i) and whether
    it may be switched off (M,). `switches` (M,) are those of an earlier solution; without them all are new. The
    first node of each connected part keeps its pose. Returns (poses (N, 3), switches (M,) in [0, 1], summary).
    Raises InputError and ParameterError.
    """

def optimize_map(map: Map, options: OptimizerOptions = ...) -> OptimizerSummary:
    """Solves the pose graph of a map in place, from its poses and switches. Dock closures of a Mapper's map are as firm
    as its parameters say (docs/optimiser.md), those of a map that was loaded are like others. Returns the summary.
    Raises InputError and ParameterError; the map is then unchanged.
    """

def optimize_map_with_landmarks(
    map: Map,
    times: ArrayLike,
    landmarks: ArrayLike,
    measurements: ArrayLike,
    covariances: ArrayLike,
    options: OptimizerOptions = ...,
) -> tuple[dict[int, tuple[float, float, float]], OptimizerSummary]:
    """Solves the pose graph of a map in place, always with Huber's loss, together with landmarks that are known again
    when they are seen: for each of M observations the time (M,) [s], which landmark it is (M,), its pose in the
    sensor frame (M, 3), and the covariance of that (M, 3, 3). The sensor is where it was between the two nodes made
    before and after. Returns (pose in the map by landmark, summary). Raises InputError and ParameterError; the map
    is then unchanged.
    """

def parameter_table() -> list[ParameterEntry]:
    """Every parameter once, in the order of params.json."""

def prune_map(map: Map, views: int, always: bool = True) -> Map:
    """The map without the nodes that show no piece of surface that others do not show from the same side so often, and
    without what newer segments contradict. Not always: only if that is a good part of the nodes, and nothing else.
    """

def read_map_format(path: str, ignore_checksum: bool = False) -> MapFormat:
    """In which format a map is, even if it is too new to be loaded. Raises MapFileError."""

def read_parameters(path: str) -> tuple[Parameters, list[str]]:
    """The parameters of a file, and a sentence on each key that it gives twice. Raises ParameterError."""

def render_map(
    map: Map, parameters: Parameters, within: Sequence[float] | None = None, nodes: Sequence[int] | None = None
) -> tuple[OccupancyGrid, OccupancyGrid]:
    """Draws a map without its loose parts, or some nodes of it: (map, map_cleaned), the second without speckle noise.
    Of the parameters output_map counts. Of a box within (x_min, y_min, x_max, y_max) [m] only what lies there.
    Raises ParameterError or InputError.
    """

def save_map(path: str, map: Map, as_original: bool = False) -> None:
    """Writes a map's three files as one, in the newest format or as the original Oort did. Raises MapFileError; the old
    map is then still whole.
    """

def save_metadata(path: str, map: Map) -> Saved:
    """Writes a map's locations, or the whole map where those on disk would not fit them. Raises MapFileError."""

def unknown_parameter(path: str) -> str:
    """The message for a path that is in no table, with the nearest path or section that is."""

AGREEMENT_CHI2: float
FORMAT_VERSION: int
ODOMETRY_EDGE: int
SWITCH_ON: float
