# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Searching parameters over recordings."""

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from oort import Parameters, read_parameters
from oort.cli.tune import main
from oort.errors import ParameterError
from oort.offline.scoring import Trial, score
from oort.offline.search_space import Axis, parse_axis
from oort.parameters.writer import to_json
from oort.simulate import SimulationConfig, simulate_drive
from oort.simulate.writers import write_drive

_GRID = "incremental_graph_builder.frsm_matcher.meters_per_pixel"
_BAD = {_GRID: 0.3, "incremental_graph_builder.frsm_matcher.max_search_range_xy": 0.01}
_CANDIDATES = "loop_closure_graph_builder.candidate_search.knearest_neighbors"
_SEARCH = ["--search", f"{_GRID}=0.01..0.3", "--trials", "6", "--seed", "3"]


@pytest.fixture(scope="module")
def homes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two short drives with their truth, and bad parameters."""
    folder = tmp_path_factory.mktemp("homes")
    for seed in (1, 2):
        write_drive(simulate_drive(seed, SimulationConfig(minutes=0.0)), folder, f"home{seed}", picture=False)
    (folder / "bad.json").write_text(to_json(_BAD))
    return folder


def _arguments(homes: Path, out: Path) -> list[str]:
    recordings = [str(homes / f"home{seed}.clf") for seed in (1, 2)]
    return [*recordings, "--params", str(homes / "bad.json"), "--out", str(out), *_SEARCH]


@pytest.fixture(scope="module")
def tuned(homes: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("tuned")
    assert main(_arguments(homes, out)) == 0
    return out


def test_a_bad_value_is_mended_and_the_file_says_on_what(tuned: Path) -> None:
    found = read_parameters(tuned / "params.json")
    assert float(found.get(_GRID)) < 0.1
    assert found.get("incremental_graph_builder.frsm_matcher.max_search_range_xy") == 0.01  # was not searched
    text = (tuned / "params.json").read_text()
    assert "in 6 trials" in text
    assert text.count("m off the truth before") == 2
    told = json.loads((tuned / "tune.json").read_text())
    assert told["best"]["error"] == min(trial["error"] for trial in told["trials"]) < 1.0
    for row in told["recordings"]:
        assert row["after"]["error"] < row["before"]["error"]


def test_a_search_that_is_killed_ends_as_one_that_was_not(homes: Path, tuned: Path, tmp_path: Path) -> None:
    code = "import sys; from oort.cli.tune import main; sys.exit(main(sys.argv[1:]))"
    search = subprocess.Popen([sys.executable, "-c", code, *_arguments(homes, tmp_path)], stdout=subprocess.DEVNULL)
    for _ in range(1200):
        if len(list(tmp_path.glob("scores/*.json"))) >= 5:  # in the second trial, or after it
            break
        time.sleep(0.05)
    search.kill()
    search.wait()
    kept = {path: path.stat().st_mtime_ns for path in tmp_path.glob("scores/*.json")}
    assert len(kept) >= 5
    assert main(_arguments(homes, tmp_path)) == 0
    assert {path: path.stat().st_mtime_ns for path in kept} == kept
    for name in ("params.json", "tune.json"):
        assert (tmp_path / name).read_bytes() == (tuned / name).read_bytes()


def test_another_search_is_not_mixed_in(homes: Path, tuned: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*_arguments(homes, tuned), "--search", "linear_update"]) == 2
    assert "choose another --out" in capsys.readouterr().err


def test_without_a_truth_the_map_is_judged_by_itself(homes: Path, tmp_path: Path) -> None:
    shutil.copy(homes / "home1.clf", tmp_path)
    careless = {**_BAD, _GRID: 0.5, _CANDIDATES: 0, "final_refinement": False}
    good, bad = (score(Trial(str(tmp_path / "home1.clf"), to_json(values))) for values in ({}, careless))
    assert good.kind == bad.kind == "agreement"
    assert good.error < bad.error


def test_a_recording_that_cannot_be_mapped_says_why(tmp_path: Path) -> None:
    (tmp_path / "notes.clf").write_text("no scans\n")
    told = score(Trial(str(tmp_path / "notes.clf"), "{}"))
    assert told.kind == "failed"
    assert "no laser scans" in told.why


def test_a_search_that_is_damaged_or_has_no_trials_is_refused(
    homes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for damage in (b"\xff\xfe\n", b"{\n", b"[1]\n", b"{}\n"):
        (tmp_path / "study.log").write_bytes(damage)
        assert main(_arguments(homes, tmp_path)) == 2
        assert "choose another --out" in capsys.readouterr().err
    assert main([*_arguments(homes, tmp_path), "--trials", "0"]) == 2
    assert "one trial or more" in capsys.readouterr().err


def test_axes() -> None:
    start = Parameters()
    assert parse_axis("linear_update", start) == Axis("linear_update", 0.05, 0.8, logarithmic=True)
    assert parse_axis("huber_scale=1..3", start) == Axis("huber_scale", 1.0, 3.0)
    assert parse_axis("final_refinement", start).choices == (True, False)
    for text, why in {
        "linear_updat": "linear_update",
        "linear_update=1": "LOW..HIGH",
        "linear_update=3..1": "must grow",
        "linear_update=nan..1": "must grow",
        "keep_views=1.2..1.8": "no whole number",
        "linear_updat\udcff": "unknown parameter",
        "aé" + "é" * 300: "unknown parameter",
        "linear_update=0..1": "lie within 0.001 to 100",
        "time_update": "say between which values",
        "robust_kernel=huber": "two or more of switchable, huber",
    }.items():
        with pytest.raises(ParameterError, match=why):
            parse_axis(text, start)
