# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Histograms of matches and residuals, and their picture."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from conftest import ROOT
from oort import Map, load_map
from oort.errors import InputError
from oort.evaluation.histograms import CHI2_EDGES, INLIER_EDGES, make_histograms, panels
from oort.export.chart import Panel, write_chart

GOLDEN = ROOT / "tests/py/data/maps/format_1/home"


def test_hits_are_counted_from_the_lower_limit_on() -> None:
    values = [0.0, 0.0499, 0.05, 0.949, 0.95, 1.0]
    hits = make_histograms(Map(), values, values)["inlier_ratio"]
    counts = hits["scans"]
    assert hits["rejected"] == counts
    assert (counts[0], counts[1], counts[18], counts[19], sum(counts)) == (2, 1, 1, 2, 6)


def test_every_link_is_counted_once() -> None:
    map_ = load_map(str(GOLDEN))
    histograms = make_histograms(map_, [])
    odometry = int((map_.edges["type"] == 1).sum())
    off = int((map_.switchable_edges["switch"] < 0.5).sum())
    assert {kind: sum(counts) for kind, counts in histograms["chi2"].items() if kind != "edges"} == {
        "laser": len(map_.edges["id"]) - odometry,
        "odometry": odometry,
        "closures": len(map_.switchable_edges["id"]) - off,
        "switched_off": off,
    }
    assert sum(histograms["inlier_ratio"]["closures"]) == len(map_.loop_results["id"])
    assert sum(histograms["inlier_ratio"]["scans"]) == 0


def test_chi_squared_by_hand() -> None:
    map_ = load_map(str(GOLDEN))
    edges, poses = map_.switchable_edges, map_.node_poses
    expected = np.zeros(len(CHI2_EDGES), dtype=int)
    for i, j, z, covariance, switch in zip(
        *(edges[name] for name in ("i", "j", "pose", "covariance", "switch")), strict=True
    ):
        a, b = poses[i], poses[j]
        c, s = np.cos(a[2]), np.sin(a[2])
        error = np.append(np.array([[c, s], [-s, c]]) @ (b - a)[:2] - z[:2], b[2] - a[2] - z[2])
        error[2] = np.arctan2(np.sin(error[2]), np.cos(error[2]))
        chi2 = error @ np.linalg.inv(covariance) @ error
        expected[max(k for k, edge in enumerate(CHI2_EDGES) if chi2 >= edge)] += switch >= 0.5
    assert make_histograms(map_, [])["chi2"]["closures"] == expected.tolist()


def test_an_empty_map_has_nothing_to_draw() -> None:
    assert panels(make_histograms(Map(), [])) == []
    with pytest.raises(InputError, match="at least one"):
        write_chart("unused.png", [])


def test_picture(tmp_path: Path) -> None:
    drawn = panels(make_histograms(load_map(str(GOLDEN)), [0.9, 0.8]))
    assert [panel.title for panel in drawn][:2] == ["inlier ratio of tracked scans", "inlier ratio of closures"]
    for name in ("a.png", "b.png"):
        write_chart(tmp_path / name, drawn)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (760, 190 * 3)


def test_a_bar_is_as_tall_as_its_count(tmp_path: Path) -> None:
    write_chart(tmp_path / "a.png", [Panel("three bins", [0.0, 1.0, 2.0], [100, 50, 0])])
    with Image.open(tmp_path / "a.png") as picture:
        blue = np.all(np.asarray(picture) == (40, 90, 200), axis=2)
    heights = [int(blue[:, 16 + int((k + 0.5) * 348 / 3)].sum()) for k in range(3)]
    assert heights[1] == pytest.approx(heights[0] / 2, abs=1.5)
    assert (heights[0] > 100, heights[2]) == (True, 0)
    with pytest.raises(InputError, match="2 counts do not fit 1 bins"):
        write_chart(tmp_path / "b.png", [Panel("odd", INLIER_EDGES[:1], [1, 2])])
