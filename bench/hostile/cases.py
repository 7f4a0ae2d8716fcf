# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The table of cases: tools with hostile arguments and files, and programs of hostile/programs.py."""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

_PROGRAMS = Path(__file__).with_name("programs.py")


@dataclass(frozen=True)
class Case:
    """One hostile input."""

    row: str
    """of the table of faults"""
    name: str
    tool: Sequence[str] = ()
    """arguments of the command oort, IN for the folder of inputs; empty: the program of this name is run"""
    shell: str = ""
    """instead of ``tool``: a line of bash in which OORT is the tool"""
    expected: str = ""
    """what it must say"""
    statuses: Sequence[int] = (0, 2)
    seconds: float = 30.0
    """[CPU s] it must not use more"""
    megabytes: float = 1000.0
    """it must not use more"""
    address_space: int = 24_000
    """[MB] it is given"""
    environment: Mapping[str, str] = field(default_factory=dict)

    def command(self, inputs: Path, folder: Path) -> list[str]:
        """The command line, to be run in the folder."""
        oort = str(Path(sys.executable).with_name("oort"))
        if self.shell:
            return ["bash", "-c", self.shell.replace("OORT", oort).replace("IN/", f"{inputs}/")]
        if self.tool:
            return [oort, *(word.replace("IN/", f"{inputs}/") for word in self.tool)]
        return [sys.executable, str(_PROGRAMS), self.name, str(inputs), str(folder)]


_MAPS = (
    "map_cov_1e300",
    "map_cov_asymmetric",
    "map_cov_not_pd",
    "map_cov_not_symmetric",
    "map_cov_zero",
    "map_prior_not_pd",
    "map_drawn_area",
    "map_resume_hang",
    "ubsan_table_draw",
    "map_far_point_merge_hang",
)
_REPLAY = ("replay", "IN/small.clf", "--out", "out", "--quiet")
_REFUSED = (2,)

CASES = [
    Case("1", "nul_in_map_path"),
    Case("2", "far_reading_localiser"),
    Case("2", "merge_far_point", ("merge", "IN/map_far_point_merge_hang/x", "IN/map_far_point_merge_hang/x", "out")),
    Case("3", "far_reading_mapped"),
    Case("3", "readings_of_5_km"),
    Case("3", "odometry_99999_m_off"),
    Case("5", "map_over_1_gib", megabytes=8000, seconds=60),
    Case("6", "output_is_a_device"),
    Case("6", "output_is_a_link"),
    Case("7", "denormal_turn", ("replay", "IN/denormal_turn", "--out", "out", "--quiet"), statuses=(0,)),
    Case("8", "lock_held", seconds=60),
    *(Case("9", f"use_{name}", seconds=60) for name in _MAPS),
    Case("10", "start_twice_at_a_good_map"),
    Case("10", "two_sessions_save_one_base"),
    Case("11", "recording_through_a_pipe", shell="OORT replay <(cat IN/small.clf) --out out --quiet",
         statuses=_REFUSED),
    Case("12", "bz2_of_10_gb", seconds=120),
    Case("12", "sparse_map_of_30_gb", seconds=60),
    Case("12", "params_memory", (*_REPLAY, "--params", "IN/params_memory.json"), megabytes=2000),
    Case("13", "path_not_utf8", shell="OORT replay IN/small.clf --quiet --out $'o\\xff'"),
    Case("13", "map_path_not_utf8", shell="OORT replay IN/small.clf --quiet --out out --map $'o\\xff'"),
    Case("13", "name_too_long", shell="OORT replay IN/small.clf --quiet --map $(printf 'n%.0s' {1..300})",
         statuses=_REFUSED),
    Case("13", "folder_of_map_missing", (*_REPLAY, "--map", "no/such/folder/map"), statuses=_REFUSED),
    Case("13", "live_name_too_long"),
    Case("14", "clock_stands_still"),
    Case("15", "resume_home_map_home"),
    Case("16", "scans_at_355_hz"),
    Case("low", "digits_clf", ("replay", "IN/digits.clf", "--out", "out"), statuses=_REFUSED),
    Case("low", "events_deep", (*_REPLAY, "--events", "IN/events_deep.json"), statuses=_REFUSED),
    Case("low", "events_surrogate", (*_REPLAY, "--events", "IN/events_surrogate.json"), statuses=_REFUSED),
    Case("low", "place_far", (*_REPLAY, "--events", "IN/place_far.json")),
    Case("low", "linear_update_a_list", shell="""echo '{"linear_update": [1, 2]}' > p.json;
        OORT replay IN/small.clf --quiet --params p.json""", statuses=_REFUSED),
    Case("low", "last_pose_damaged"),
    Case("low", "ascii_terminal", shell="OORT replay IN/small.clf --out $'\\xc3\\xa9'", environment={
        "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0", "LC_ALL": "C"}),
    Case("low", "closed_pipe", shell="""OORT replay IN/small.clf --quiet --out out;
        OORT evaluate ate out/trajectory.tum out/trajectory.tum | true; exit ${PIPESTATUS[0]}""", statuses=(0, 2, 141)),
    Case("low", "bad_pgm"),
    Case("low", "params_is_a_fifo", shell="mkfifo f; OORT replay IN/small.clf --quiet --params f", statuses=_REFUSED),
    Case("low", "params_is_dev_zero", (*_REPLAY, "--params", "/dev/zero"), statuses=_REFUSED),
    Case("low", "events_is_a_fifo", shell="mkfifo f; OORT replay IN/small.clf --quiet --events f", statuses=_REFUSED),
    Case("low", "events_is_dev_zero", (*_REPLAY, "--events", "/dev/zero"), statuses=_REFUSED),
    Case("low", "input_is_a_fifo", shell="mkfifo f; OORT replay f --quiet", statuses=_REFUSED),
    Case("low", "input_is_dev_zero", ("replay", "/dev/zero", "--quiet"), statuses=_REFUSED),
    Case("low", "g2o_is_dev_zero", ("graph", "solve", "/dev/zero", "out.g2o"), statuses=_REFUSED),
    Case("low", "tum_is_a_fifo", shell="mkfifo f; OORT evaluate ate f f", statuses=_REFUSED),
    Case("low", "events_log_is_a_fifo"),
    Case("low", "angle_increment_0"),
    Case("low", "angle_increment_1e300"),
    Case("low", "underscore_number"),
    Case("low", "mount_1e308", (*_REPLAY, "--mount", "1e308", "0", "0"), statuses=_REFUSED),
    Case("low", "evaluate_json_nan"),
    Case("low", "carmen_angles_1e308"),
    Case("low", "nul_in_place_name"),
    Case("low", "two_threads_in_one_mapper", seconds=60),
    Case("low", "errors_that_echo_megabytes"),
    Case("low", "branch_and_bound_depth_16", seconds=60),
    Case("low", "cartographer_resolution_5_mm", seconds=60),
    Case("low", "temporary_name_is_a_link"),
]  # fmt: skip
