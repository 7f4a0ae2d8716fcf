# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter that the table calls used does change what comes of a drive."""

import hashlib
from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from oort import Map, Parameters, Session, render_map
from oort._core import Localizer, Mapper, ParameterEntry, ReferenceMap
from oort.errors import ParameterError, StateError
from oort.parameters import parameter_table
from oort.recording import Scan, open_recording
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen

OF_THE_NODE = {"base_frame", "odom_frame", "sensor_frame", "map_frame"}
"""Names for the ROS node alone."""

OF_BAGS = {"motion_compensation", "max_extrapolation", "use_imu", "beam_order"}
"""What a CARMEN log has no occasion for; tests/py/recording/test_motion.py and test_laser.py have the cases."""

RARE = {
    # how wide the matcher searches where odometry is very sure, and where it begins again after a poor match
    "incremental_graph_builder.frsm_matcher.initial_search_range_xy",
    "incremental_graph_builder.frsm_matcher.initial_search_range_theta",
    "incremental_graph_builder.frsm_matcher.stationary_motion_model",
    # tests/cpp/maintenance/test_prune.cpp has the cases: this map has hardly grown, and nothing was moved
    "keep_views",
    # third_party/frsm/tests/test_tracker.cpp has the case: this odometry is never off by so much
    "incremental_graph_builder.frsm_matcher.max_search_range_xy",
    "incremental_graph_builder.frsm_matcher.max_search_range_theta",
    # tests/py/test_laser.py has the case: this robot does not see itself
    "find_body",
    # tests/cpp/test_dock.cpp has the case
    "dock_graph_builder.dock_match_least_size",
    # tests/cpp/test_loop_closure.cpp has the case
    "loop_closure_graph_builder.frsm_matcher.match_filter.match_max_dist_high",
    # tests/cpp/test_relocalizer.cpp has the case: no other place in this home looks like the right one
    "localization.relocalizer.min_lead",
    # tests/cpp/test_grid_loop_matcher.cpp has the cases: what branch and bound finds here is near and fits well
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_max_dist",
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_max_dist_high",
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_hitpct_threshold",
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_hitpct_threshold_high",
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_hitpct_threshold_opposite_dir",
    "loop_closure_graph_builder.branch_and_bound_matcher.match_filter.opposite_dir_threshold",
}
"""What this drive has no occasion for."""

SETTINGS: tuple[dict[str, str | float | bool], ...] = (
    {},
    {
        "incremental_graph_builder.odometry_model": "constant",
        "output_map.speckle_strategy": "morphological",
        "robust_kernel": "huber",
        "loop_closure_graph_builder.candidate_search.closest_allowed_id_threshold_large": 1_000_000,
    },
    {  # odometry goes far between matches, and places many nodes alone
        "incremental_graph_builder.odometry_model": "constant",
        "incremental_graph_builder.match_every_scan": False,
        "incremental_graph_builder.frsm_matcher.match_filtering.min_accept_score": 0.97,
    },
)
"""A parameter need not count in each of these, but in one."""

SECOND_STAGE = "incremental_graph_builder.cartographer_matcher.second_stage_matcher"

CARTOGRAPHER: tuple[dict[str, str | float | bool], ...] = (
    {
        "incremental_graph_builder.scanmatcher": "cartographer_matcher",
        "incremental_graph_builder.cartographer_matcher.use_second_stage_matcher": True,
        "incremental_graph_builder.cartographer_matcher.insert_free_space": True,
        "incremental_graph_builder.cartographer_matcher.ceres_scan_matcher.insert_free_space": True,
        f"{SECOND_STAGE}.ceres_scan_matcher.insert_free_space": True,
        "loop_closure_graph_builder.branch_and_bound_matcher.probability_grid.insert_free_space": True,
        "loop_closure_graph_builder.scanmatcher": "branch_and_bound_matcher",
        "loop_closure_graph_builder.branch_and_bound_matcher.min_score": 0.4,
    },
    {
        "incremental_graph_builder.scanmatcher": "cartographer_matcher",
        "loop_closure_graph_builder.scanmatcher": "branch_and_bound_matcher",
        "loop_closure_graph_builder.candidate_search.closest_allowed_id_threshold_large": 1_000_000,
    },
    {  # two stages on grids of hits alone
        "incremental_graph_builder.scanmatcher": "cartographer_matcher",
        "incremental_graph_builder.cartographer_matcher.use_second_stage_matcher": True,
    },
)
"""The same for the parameters of Cartographer's matchers."""


def of_localization(entry: ParameterEntry) -> bool:
    """Whether it tells of localisation on a saved map, not of mapping."""
    return entry.path.startswith("localization.") or entry.path.endswith(".global_localization_min_score")


USED = [
    entry
    for entry in parameter_table()
    if not entry.path.endswith((".num_threads", ".branch_and_bound_depth"))  # the result is the same
    and entry.status == "used"
    and entry.path not in OF_THE_NODE | OF_BAGS | RARE
    and not of_localization(entry)
    and (not entry.choices or len(entry.choices) > 1)
]


LOCALIZING = [entry for entry in parameter_table() if of_localization(entry) and entry.path not in RARE]


@pytest.fixture(scope="module")
def scans(tmp_path_factory: pytest.TempPathFactory) -> list[Scan]:
    """A drive through a small home and back onto the dock, every third scan."""
    path = tmp_path_factory.mktemp("drive") / "home.clf"
    write_carmen(simulate_drive(2, SimulationConfig(minutes=0.0, odometry_error=1.5)), path)
    return list(open_recording(path).scans())[::3]


def others(entry: ParameterEntry) -> Iterator[bool | int | float | str]:
    """Other values than the default, mild ones first."""
    if isinstance(entry.default, bool):
        yield not entry.default
    elif isinstance(entry.default, str):
        yield from (choice for choice in entry.choices if choice != entry.default)
    elif isinstance(entry.default, int):
        assert entry.min is not None
        assert entry.max is not None
        yield from (entry.default + 2, entry.default // 2, int(entry.min), int(entry.max))
    else:
        assert entry.min is not None
        assert entry.max is not None
        middle = entry.default if entry.default > 0.0 else 0.5
        yield from (0.3 * middle, min(3.0 * middle, entry.max), 0.01 * middle, entry.min, entry.max)


def map_of(parameters: Parameters, scans: Sequence[Scan]) -> Map:
    """A drive with a dock, a pause in the middle, and a second session along the first part."""
    session = Session(parameters, (0.109, 0.0, 0.0))
    session.start()
    for number, scan in enumerate(scans):
        if number == len(scans) // 2:
            session.pause()
            session.resume_from_paused()
        session.add_scan(scan)
        if number == 3:
            session.create_location("dock", "dock")
    session.notify_docked()
    mapper = Mapper(parameters, (0.109, 0.0, 0.0))
    mapper.set_map(session.map)
    mapper.begin_session((0.1, 0.05, 0.05))
    for s in scans[:70]:
        mapper.add_ranges(*s.readings, s.odometry)
    mapper.finish()
    return mapper.map()


def digest(parameters: Parameters, scans: Sequence[Scan]) -> str:
    """Of all that the engine makes of the drive."""
    map_ = map_of(parameters, scans)
    arrays = [map_.node_poses, map_.edges["covariance"], map_.switchable_edges["switch"]]
    for grid in render_map(map_, parameters):
        arrays += [grid.cells, np.array(grid.origin)]
    return hashlib.sha256(b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)).hexdigest()


def settings_for(path: str) -> tuple[dict[str, str | float | bool], ...]:
    own = ("cartographer_matcher." in path) or ("branch_and_bound_matcher." in path)
    return CARTOGRAPHER if own else SETTINGS


@pytest.fixture(scope="module")
def reference(scans: list[Scan]) -> list[tuple[dict[str, str | float | bool], str]]:
    """The digest of each of the settings."""
    return [(settings, digest(with_settings(settings), scans)) for settings in SETTINGS + CARTOGRAPHER]


def with_settings(settings: dict[str, str | float | bool]) -> Parameters:
    parameters = Parameters()
    for path, value in settings.items():
        parameters.set(path, value)
    return parameters


@pytest.mark.slow
@pytest.mark.parametrize("entry", USED, ids=lambda entry: entry.path)
def test_parameter_has_an_effect(
    entry: ParameterEntry,
    scans: list[Scan],
    reference: list[tuple[dict[str, str | float | bool], str]],
) -> None:
    for settings, before in reference:
        if settings not in settings_for(entry.path) or entry.path in settings:
            continue
        for value in others(entry):
            parameters = with_settings(settings)
            try:
                parameters.set(entry.path, value)
                Session(parameters)
            except ParameterError:  # out of its range, or against another one
                continue
            try:
                changed = digest(parameters, scans) != before
            except StateError:  # nothing could be mapped
                changed = True
            if changed:
                return
    pytest.fail(f"{entry.path}: no other value made a difference")


def localized(map_: Map, parameters: Parameters, scans: Sequence[Scan]) -> str:
    """Digest of where a drive is told to be: its odometry is turned away in the middle, and some scans see nothing."""
    localizer = Localizer(ReferenceMap(map_, parameters), parameters, (0.109, 0.0, 0.0))
    told = []
    for number, s in enumerate(scans):
        ranges = s.ranges
        if number % 97 in range(60, 90):  # long enough to be uncertain, and lost
            ranges = np.full_like(ranges, np.inf)
        x, y, theta = s.odometry
        odometry = (x, y, theta) if number < len(scans) // 2 else (-y + 1.0, x, theta + np.pi / 2)
        localizer.add_ranges(s.time, s.angle_min, s.angle_increment, s.range_min, s.range_max, ranges, odometry)
        told.append(f"{localizer.state} {localizer.T_map_sensor} {localizer.covariance.tolist()}")
    return hashlib.sha256("\n".join(told).encode()).hexdigest()


@pytest.fixture(scope="module")
def mapped(scans: list[Scan]) -> tuple[Map, str]:
    """A map of the drive, and where the drive is told to be on it."""
    session = Session(Parameters(), (0.109, 0.0, 0.0))
    session.start()
    for scan in scans:
        session.add_scan(scan)
    session.stop()
    return session.map, localized(session.map, Parameters(), scans)


@pytest.mark.slow
@pytest.mark.parametrize("entry", LOCALIZING, ids=lambda entry: entry.path)
def test_localization_parameter_has_an_effect(
    entry: ParameterEntry, scans: list[Scan], mapped: tuple[Map, str]
) -> None:
    map_, before = mapped
    for value in others(entry):
        parameters = Parameters()
        try:
            parameters.set(entry.path, value)
            parameters.check()
        except ParameterError:
            continue
        if localized(map_, parameters, scans) != before:
            return
    pytest.fail(f"{entry.path}: no other value made a difference")
