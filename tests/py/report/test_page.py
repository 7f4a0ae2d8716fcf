# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""report.html and compare.html in a real browser."""

import io
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page

from oort.cli.compare import main as compare
from oort.cli.replay import main as replay
from oort.errors import InputError
from oort.poses import between
from oort.report.arrays import unpack
from oort.report.page import make_report_page, read_page_data
from oort.simulate import Drive, SimulationConfig, simulate_drive
from oort.simulate.writers import write_carmen, write_truth

_HOSTILE = "</script><img src=x onerror=document.title='owned'>"


@pytest.fixture(scope="module")
def run(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a replay of a drive's first minute, with a place whose name is markup."""
    folder = tmp_path_factory.mktemp("page")
    write_carmen(drive, folder / "home.clf")
    begin = float(drive.scan_stamps[0]) * 1e-9
    events = [{"t": begin + 30.0, "call": "graph_loc/create", "args": ["rooms", _HOSTILE]}]
    (folder / "events.json").write_text(json.dumps(events))
    args = [str(folder / "home.clf"), "--events", str(folder / "events.json"), "--until", "60", "--quiet"]
    assert replay([*args, "--out", str(folder / "run")]) == 0
    return folder / "run"


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page that has no network and fails the test for an error in a script."""
    errors: list[str] = []
    context = browser.new_context(offline=True, viewport={"width": 1500, "height": 1000})
    opened = context.new_page()
    opened.on("pageerror", lambda error: errors.append(str(error)))
    opened.on("request", lambda request: errors.append(request.url) if request.url.startswith("http") else None)
    yield opened
    context.close()
    assert errors == []


def _open(page: Page, path: Path) -> None:
    page.goto(path.as_uri())
    page.wait_for_selector("body[data-ready]")


def test_the_report_opens_from_disk_and_shows_the_run(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    report = json.loads((run / "report.json").read_text())
    assert page.locator("#name").inner_text() == "home"
    assert str(report["nodes"]) in page.locator("#figures").inner_text()
    assert page.locator("#map img.grid").count() == 1
    assert page.locator("#charts canvas").count() == 3
    assert (run / "report.html").stat().st_size < 10e6


def test_names_from_outside_are_text(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    assert _HOSTILE in page.locator(".place").all_inner_texts()[0]
    assert page.title() == "Oort: home"


def test_a_closure_shows_its_two_scans_by_keyboard_alone(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    page.locator("#closure-list").focus()
    page.keyboard.press("ArrowDown")
    details = page.locator("#details").inner_text()
    assert "the map has it within" in details
    assert "Inlier ratio" in details
    assert page.locator("#overlay").is_visible()
    drawn = "canvas => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some(v => v > 0)"
    assert page.locator("#overlay").evaluate(drawn)


def test_a_closure_is_told_of_the_newer_scan_on_the_submap_of_the_older(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    data = read_page_data(run / "report.html")
    closures, poses = data["closures"], unpack(data["nodes"]["poses"])
    older, newer = unpack(closures["ends"]).reshape(-1, 2).T
    assert (older < newer).all()
    kept = unpack(closures["verdict"]) == 0
    off = between(unpack(closures["pose"]), between(poses[older], poses[newer]))
    assert np.hypot(*off[kept, :2].T).max() < 0.1
    around = page.evaluate("node => view.around(node).sort((a, b) => a - b)", 10)
    assert around == [3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14, 15, 16, 17]


def test_what_is_wrong_is_said_in_words(page: Page, run: Path, tmp_path: Path) -> None:
    _open(page, run / "report.html")
    assert page.locator("#wrong").is_visible() == bool(read_page_data(run / "report.html")["troubles"])
    trouble = {"text": _HOSTILE, "advice": "check the base's driver"}
    data = {**read_page_data(run / "report.html"), "troubles": [trouble]}
    (tmp_path / "report.html").write_bytes(make_report_page("home", data))
    _open(page, tmp_path / "report.html")
    assert page.locator("#troubles li").all_inner_texts() == [f"{_HOSTILE}: check the base's driver"]
    del data["troubles"]  # as in runs of earlier versions
    (tmp_path / "report.html").write_bytes(make_report_page("home", data))
    _open(page, tmp_path / "report.html")
    assert not page.locator("#wrong").is_visible()


def test_the_page_says_what_the_table_says(drive: Drive, tmp_path: Path) -> None:
    write_carmen(replace(drive, ranges=drive.ranges[:, ::-1]), tmp_path / "mirrored.clf")
    assert replay([str(tmp_path / "mirrored.clf"), "--until", "40", "--quiet", "--out", str(tmp_path / "run")]) == 0
    told = json.loads((tmp_path / "run/report.json").read_text())["troubles"]
    shown = read_page_data(tmp_path / "run/report.html")["troubles"]
    assert shown
    assert [(each["text"], each["advice"]) for each in told] == [(each["text"], each["advice"]) for each in shown]


def test_the_slider_moves_the_robot(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    slider = page.locator("#time")
    slider.focus()
    slider.press("ArrowRight")
    first = page.locator(".robot").bounding_box()
    slider.press("End")
    assert page.locator(".robot").bounding_box() != first
    assert "tracking" in page.locator("#now").inner_text()


def test_a_click_on_the_trajectory_sets_the_time(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    data = read_page_data(run / "report.html")
    poses = unpack(data["samples"]["pose"])
    third = len(poses) // 3  # not at the place in the middle, whose name lies over the line
    place = page.evaluate(
        "at => { const p = view.map.latLngToContainerPoint(at); return [p.x, p.y]; }", poses[third, 1::-1].tolist()
    )
    box = page.locator("#map").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + place[0], box["y"] + place[1])
    shown = int(page.locator("#time").input_value())
    assert abs(poses[shown, :2] - poses[third, :2]).max() < 0.3


def test_a_click_beside_a_closure_shows_its_scans(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    page.get_by_label("closures accepted").check()
    page.get_by_label("trajectory by tracking state").uncheck()
    page.get_by_label("undone").uncheck()
    ends = unpack(read_page_data(run / "report.html")["closures"]["ends"]).reshape(-1, 2)
    poses = unpack(read_page_data(run / "report.html")["nodes"]["poses"])
    lengths = np.hypot(*(poses[ends[:, 0], :2] - poses[ends[:, 1], :2]).T)
    kept = unpack(read_page_data(run / "report.html")["closures"]["verdict"]) == 0
    longest = poses[ends[np.argmax(np.where(kept, lengths, 0.0))], 1::-1]
    script = "ends => ends.map(at => { const p = view.map.latLngToContainerPoint(at); return [p.x, p.y]; })"
    a, b = np.array(page.evaluate(script, longest.tolist()))
    along = (b - a) / np.hypot(*(b - a))
    box = page.locator("#map").bounding_box()
    assert box is not None
    x, y = (a + b) / 2 + 3.0 * np.array([-along[1], along[0]])
    page.mouse.click(box["x"] + x, box["y"] + y)
    assert "Inlier ratio" in page.locator("#details").inner_text()
    assert page.locator("#overlay").is_visible()


def test_what_odometry_is_learned_to_be_is_on_the_timeline(page: Page, run: Path, tmp_path: Path) -> None:
    data = read_page_data(run / "report.html")
    told = json.loads((run / "report.json").read_text())["odometry_scale"]
    for name, key in (("way_scale", "translation"), ("turn_scale", "rotation")):
        assert unpack(data["samples"][name])[-1] == pytest.approx(told[key], abs=0.01)
        del data["samples"][name]  # as in runs of earlier versions
    _open(page, run / "report.html")
    assert "where odometry says 1" in page.locator("#charts").inner_text()
    (tmp_path / "report.html").write_bytes(make_report_page("home", data))
    _open(page, tmp_path / "report.html")
    assert "where odometry says 1" not in page.locator("#charts").inner_text()


def test_the_first_scan_has_nothing_to_be_matched_with(run: Path) -> None:
    ratios = unpack(read_page_data(run / "report.html")["samples"]["inlier_ratio"])
    assert np.isnan(ratios[0]) and ratios[1] > 0.5


def test_paper_shows_what_the_window_shows(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    before = page.locator("#map").bounding_box()
    assert before is not None
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    width = page.evaluate("Math.max(...Array.from(document.querySelectorAll('canvas'), c => c.clientWidth))")
    assert width <= 1500
    paper = page.locator("#map").bounding_box()
    assert paper is not None and paper["width"] == pytest.approx(660, abs=1)
    assert paper["height"] / paper["width"] == pytest.approx(before["height"] / before["width"], rel=0.01)
    page.emulate_media(media="screen")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("#map").bounding_box() == before


@pytest.fixture(scope="module")
def judged(drive: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a replay of the same minute that knows the truth, and one relation."""
    folder = tmp_path_factory.mktemp("judged")
    write_carmen(drive, folder / "home.clf")
    write_truth(drive, folder / "truth.tum")
    times = [line.split()[0] for line in (folder / "truth.tum").read_text().splitlines()]
    x, y, theta = between(drive.T_map_base[50], drive.T_map_base[500]).tolist()
    x += 0.2  # told 20 cm wrong
    (folder / "relations").write_text(f"{times[50]} {times[500]} {x} {y} 0 0 0 {theta}\n")
    args = [str(folder / "home.clf"), "--until", "60", "--quiet", "--out", str(folder / "run")]
    known = ["--truth", str(folder / "truth.tum"), "--relations", str(folder / "relations")]
    assert replay([*args, *known]) == 0
    return folder / "run"


def test_the_truth_is_on_the_timeline_and_on_the_map(page: Page, judged: Path) -> None:
    truth = json.loads((judged / "report.json").read_text())["truth"]
    assert truth["ate"]["position_rmse"] < 0.02
    assert truth["relations"]["translation_mean"] == pytest.approx(0.2, abs=0.03)
    data = read_page_data(judged / "report.html")["truth"]
    off, true = unpack(data["off"]), unpack(data["true"])
    assert float(np.sqrt(np.mean(off**2))) == pytest.approx(truth["ate"]["position_rmse"], rel=1e-3)
    poses = unpack(read_page_data(judged / "report.html")["samples"]["pose"])
    np.testing.assert_allclose(np.hypot(*(true - poses[:, :2]).T), off, atol=1e-5)
    _open(page, judged / "report.html")
    assert page.locator("#charts canvas").count() == 5
    assert "off the truth" in page.locator("#figures").inner_text()
    page.locator("#time").focus()
    page.locator("#time").press("End")
    assert "off the truth" in page.locator("#now").inner_text()
    assert page.get_by_label("true way", exact=True).is_checked()
    before = page.locator("#map").screenshot()
    page.get_by_label("errors, from the true way").check()
    page.get_by_label("relations by error").check()
    assert page.locator("#map").screenshot() != before


def test_a_truth_of_another_drive_costs_no_result(
    drive: Drive, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_carmen(drive, tmp_path / "home.clf")
    (tmp_path / "other.tum").write_text("1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0 1\n")
    args = [str(tmp_path / "home.clf"), "--until", "20", "--quiet", "--out", str(tmp_path / "run")]
    assert replay([*args, "--truth", str(tmp_path / "other.tum")]) == 2
    assert "are the two files of the same recording" in capsys.readouterr().err
    assert (tmp_path / "run/map.map_capnp").is_file()
    assert (tmp_path / "run/report.html").is_file()
    assert replay([*args, "--truth", str(tmp_path / "none.tum")]) == 2
    assert "none.tum cannot be read" in capsys.readouterr().err


@pytest.fixture(scope="module")
def apart(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a replay whose second half was driven in another home, where the robot was carried in a pause."""
    folder = tmp_path_factory.mktemp("apart")
    first, second = (simulate_drive(seed, SimulationConfig(minutes=0.5)) for seed in (3, 4))
    scans, gap = 250, 60 * 10**9
    stamps = np.concatenate([first.scan_stamps[:scans], first.scan_stamps[scans] + gap + second.scan_stamps[:scans]])
    both = replace(
        first,
        scan_stamps=stamps,
        ranges=np.concatenate([first.ranges[:scans], second.ranges[:scans]]),
        T_odom_base_at_scans=np.concatenate([first.T_odom_base_at_scans[:scans], second.T_odom_base_at_scans[:scans]]),
    )
    write_carmen(both, folder / "apart.clf")
    paused = 1e-9 * float(stamps[scans - 1])
    events = [{"t": paused + 1.0, "call": "map/pause"}, {"t": paused + 2.0, "call": "map/resume_from_paused"}]
    (folder / "events.json").write_text(json.dumps(events))
    args = [str(folder / "apart.clf"), "--events", str(folder / "events.json"), "--quiet"]
    assert replay([*args, "--out", str(folder / "run")]) == 0
    return folder / "run"


def test_a_part_that_is_not_tied_is_shown_beside_the_map(page: Page, apart: Path) -> None:
    _open(page, apart / "report.html")
    data = read_page_data(apart / "report.html")
    parts, shifts = unpack(data["beside"]["part"]), unpack(data["beside"]["shift"])
    drawn = unpack(data["nodes"]["poses"])[:, 0] + shifts[:, 0]
    assert (shifts[parts == -1] == 0.0).all()
    assert drawn[parts == 0].min() > drawn[parts == -1].max()
    assert "not tied" in page.locator("#map .label").inner_text()
    lines = page.evaluate("view.runs(view.data.samples.state, 4).flat().map(line => line.map(point => point[1]))")
    assert all(max(line) - min(line) < 20.0 for line in lines), "no line from the one part to the other"
    assert max(max(line) for line in lines) > drawn[parts == -1].max()
    page.locator("#time").press("End")
    loose = page.evaluate("view.robot.getLatLng().lng")
    assert loose == pytest.approx(unpack(data["samples"]["pose"])[-1, 0] + shifts[-1, 0], abs=1e-3)


def test_layers_are_switched_on_and_off(page: Page, run: Path) -> None:
    _open(page, run / "report.html")
    page.get_by_label("walls").uncheck()
    assert page.locator("#map img.grid").count() == 0
    for name in ("nodes", "closures accepted", "chain edges", "trajectory by time"):
        page.get_by_label(name).check()


def test_two_runs_side_by_side_and_over_each_other(page: Page, run: Path, tmp_path: Path) -> None:
    assert compare([str(run), str(run / "report.html"), "--out", str(tmp_path / "both.html")]) == 0
    _open(page, tmp_path / "both.html")
    assert "at most 0.000 m" in page.locator("#apart-text").inner_text()
    assert page.locator("#map-b").is_visible()
    page.get_by_label("over each other").check()
    page.wait_for_function("() => document.querySelectorAll('#map-a img.over').length === 2")
    assert not page.locator("#map-b").is_visible()
    first, second = page.locator("#name").inner_text().split(" and ")
    assert page.locator("#walls").inner_text().split() == ["walls", "of", *first.split(), *second.split(), "both"]
    assert not page.locator("#runs").is_visible()
    page.get_by_label("side by side").check()
    assert page.locator("#map-a img.over").count() == 0
    told = page.locator("#runs").inner_text()
    assert told.startswith(f"left {first}, right {second}: ") and "trajectory by tracking state" in told
    assert page.locator("#runs i").count() >= 3  # what both maps show, in their colours


def test_walls_have_the_colour_of_the_run_that_has_them(page: Page, run: Path, tmp_path: Path) -> None:
    data = read_page_data(run / "report.html")
    grid = data["grid"]
    moved = {**data, "grid": {**grid, "origin": [grid["origin"][0] + 20 * grid["resolution"], grid["origin"][1]]}}
    (tmp_path / "moved.html").write_bytes(make_report_page("moved", moved))
    assert compare([str(run), str(tmp_path / "moved.html"), "--out", str(tmp_path / "both.html")]) == 0
    _open(page, tmp_path / "both.html")
    page.get_by_label("over each other").check()
    page.wait_for_function("() => document.querySelectorAll('#map-a img.over').length === 2")
    shown = Image.open(io.BytesIO(page.locator("#map-a").screenshot())).convert("RGB")
    colours = {colour for count, colour in shown.getcolors(1 << 24) or [] if count > 100}
    assert {(0x00, 0x72, 0xB2), (0xD5, 0x5E, 0x00), (0x00, 0x2A, 0x00)} <= colours
    page.locator("#share").fill("0")
    assert page.locator("#map-a img.over").evaluate_all("all => all.map((one) => one.style.opacity)") == ["1", "0"]


def test_what_is_no_report_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "page.html").write_text("<html></html>")
    with pytest.raises(InputError, match="is no report of a replay"):
        read_page_data(tmp_path / "page.html")
    assert compare([str(tmp_path), str(tmp_path)]) == 2
    assert "report.html cannot be read" in capsys.readouterr().err


def test_a_number_that_json_has_not_becomes_null(tmp_path: Path) -> None:
    (tmp_path / "report.html").write_bytes(make_report_page("x", {"page_version": 1, "value": float("nan")}))
    assert read_page_data(tmp_path / "report.html")["value"] is None
