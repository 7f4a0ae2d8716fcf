# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
import json
import os
import re
import warnings
from pathlib import Path

import pytest

from conftest import ROOT
from helpers.relaxed_json import Section, parse
from oort.cli.parameters import main
from oort.errors import ParameterError
from oort.parameters import Parameters, packaged_parameters, packaged_path, parameter_table, read_parameters

DOCUMENTED = ROOT / "tests/py/data/documented_params.json.txt"
REFERENCE = Path(os.environ.get("OORT_REFERENCE", ROOT.parent / "shared" / "reference" / "oort_ros.md"))
MATCHER = "incremental_graph_builder.frsm_matcher"


def flat(section: Section, prefix: str = "") -> dict[str, object]:
    values: dict[str, object] = {}
    for key, member in section.items():
        if isinstance(member.value, dict):
            values |= flat(member.value, f"{prefix}{key}.")
        else:
            values[prefix + key] = member.value
    return values


def documented() -> dict[str, object]:
    return flat(parse(DOCUMENTED.read_text(encoding="utf-8"), DOCUMENTED.name)[0])


def read(tmp_path: Path, text: str) -> Parameters:
    path = tmp_path / "my.json"
    path.write_text(text, encoding="utf-8")
    return read_parameters(path)


def refusal(tmp_path: Path, text: str) -> str:
    with pytest.raises(ParameterError) as caught:
        read(tmp_path, text)
    return str(caught.value).removeprefix(f"{tmp_path}{os.sep}")


# ---- the shipped files ----

SHIPPED = ["params/params.json", "params/kuri_original.json", "params/cartographer.json", "docs/parameters.md"]


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_files_are_what_the_table_gives(name: str, tmp_path: Path) -> None:
    assert main(["write", str(tmp_path)]) == 0
    assert (ROOT / name).read_bytes() == (tmp_path / name).read_bytes(), "run: python -m oort.parameters write ."


def test_the_table_documents_every_key(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["table"]) == 0
    printed = capsys.readouterr().out
    for entry in parameter_table():
        shown = entry.path.rpartition(".")[2] if entry.status == "used" else entry.path
        assert f"| `{shown}` | `{json.dumps(entry.default)}` |" in printed
        assert (entry.reason in printed) and (entry.meaning in printed)


def test_the_packaged_files_are_strict_json_with_the_values_of_the_table() -> None:
    for name in ("params", "kuri_original", "cartographer"):
        json.loads(packaged_path(name).read_text(encoding="utf-8"))
    assert packaged_parameters().to_dict() == Parameters().to_dict() == read_parameters().to_dict()
    assert packaged_parameters("kuri_original").to_dict() == {e.path: e.documented for e in parameter_table()}


def test_the_cartographer_preset_chooses_its_parts_and_nothing_else() -> None:
    preset = packaged_parameters("cartographer").to_dict()
    differing = {path: preset[path] for path, value in Parameters().to_dict().items() if preset[path] != value}
    assert differing == {
        "incremental_graph_builder.scanmatcher": "cartographer_matcher",
        "loop_closure_graph_builder.scanmatcher": "branch_and_bound_matcher",
        "time_update": 5.0,
    }


def test_kuri_original_has_the_documented_keys_and_values() -> None:
    kuri_original = packaged_parameters("kuri_original").to_dict()
    own = {entry.path for entry in parameter_table() if entry.own}
    assert {path: value for path, value in kuri_original.items() if path not in own} == documented()


def test_unknown_preset() -> None:
    with pytest.raises(ParameterError, match="kuri_original"):
        packaged_path("kuri")


# ---- the documented form ----


def test_the_documented_form_can_be_read() -> None:
    with pytest.warns(UserWarning, match=r"txt:12: switchable_constraint_scale was given in line 10") as caught:
        parameters = read_parameters(DOCUMENTED)
    assert len(caught) == 1
    assert {path: parameters.get(path) for path in documented()} == documented()


@pytest.mark.skipif(not REFERENCE.exists(), reason="the documentation of the original is not here")
def test_the_text_of_the_original_documentation_can_be_read(tmp_path: Path) -> None:
    page = REFERENCE.read_text(encoding="utf-8")
    block = re.search(r"^## Parameters$.*?^```$(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    assert block
    with pytest.warns(UserWarning, match="switchable_constraint_scale"):
        parameters = read(tmp_path, block[1])
    assert flat(parse(block[1], "page")[0]) == documented()
    assert {path: parameters.get(path) for path in documented()} == documented()


@pytest.mark.parametrize(
    "text",
    [
        '{"linear_update": 0.5, "angular_update": 0.25}',
        '\ufeff{"linear_update": 5e-1, "angular_update": 25E-2}',
        '{"linear_update": 0.5 "angular_update": 0.25,}',
        '# a\n{ // "b": 9\n$ it\u2019s \u2018c\u2019 "d\n"linear_update": 0.5 # }\n"angular_update": 0.25 // {\n}\n# e',
    ],
)
def test_liberties(text: str, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parameters = read(tmp_path, text)
    assert (parameters.get("linear_update"), parameters.get("angular_update")) == (0.5, 0.25)


def test_comment_marks_inside_strings_are_text(tmp_path: Path) -> None:
    parameters = read(tmp_path, r'{"map_frame": "a#b//c$d\"e"}')
    assert parameters.get("map_frame") == 'a#b//c$d"e'


def test_missing_keys_have_their_defaults(tmp_path: Path) -> None:
    expected = Parameters().to_dict() | {f"{MATCHER}.max_num_scans": 21}
    text = '{"incremental_graph_builder": {"frsm_matcher": {"max_num_scans": 21}}}'
    assert read(tmp_path, text).to_dict() == expected


def test_the_last_of_two_sections_counts(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="my.json:2: output_map was given in line 1"):
        parameters = read(
            tmp_path, '{"output_map": {"robot_radius": 0.3},\n"output_map": {"speckle_strategy": "median"}}'
        )
    assert parameters.get("output_map.robot_radius") == Parameters().get("output_map.robot_radius")


def test_a_viewer_of_the_original_is_missed(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match=r"frsm_matcher\.debug: the original's viewer is not there.*oort view"):
        read(tmp_path, '{"incremental_graph_builder": {"frsm_matcher": {"debug": true}}}')


# ---- refusals ----


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{\n"linear_updat": 1}', 'my.json:2: unknown parameter "linear_updat"; the nearest known is "linear_update"'),
        ('{"output_mpa": {}}', 'my.json:1: unknown parameter "output_mpa"; the nearest known is "output_map"'),
        ('{"dock_submap_size": 9}', '"dock_graph_builder.dock_submap_size"'),
        ('{"output_map": {\n\n"median": {"itr": 1}}}', 'my.json:3: unknown parameter "output_map.median.itr"'),
        ('{"output_map.robot_radius": 0.2}', 'is written {"output_map": {"robot_radius": ...}}'),
        (
            '{\n\n"linear_update": "far"}',
            'my.json:3: linear_update: "far" is of the wrong type (string)',
        ),
        ('{"min_pointcloud_size": 2.5}', "it takes an integer from 1 to 100000 points"),
        ('{"map_frame": true}', "my.json:1: map_frame: true is of the wrong type (bool)"),
        ('{"linear_update": -1}', "linear_update: -1 is out of range"),
        ('{"linear_update": 1e999}', "linear_update: inf is out of range"),
        ('{"linear_update": 99999999999999999999}', "linear_update: 1e+20 is out of range"),
        ('{"output_map": {"speckle_strategy": "mean"}}', 'it takes "median" or "morphological"'),
        ('{"incremental_graph_builder": {"scanmatcher": "cartographer"}}', "is not allowed"),
        ('{"loop_closure_graph_builder": {"scanmatcher": "cartographer_matcher"}}', "is not allowed"),
        ('{"output_map": 3}', "my.json:1: output_map: is a section"),
        ('{"linear_update": {"m": 1}}', "linear_update: takes one value (number)"),
        ('{"linear_update": null}', "my.json:1: expected the value of linear_update: true, false"),
        ('{"linear_update": [1]}', "expected the value of linear_update"),
        ('{"linear_update": 01}', "expected the value of linear_update"),
        ('{"output_map": {"threshold": {"max_free": 60}}}', "my.json: output_map.threshold: max_free must be less"),
    ],
)
def test_bad_values_and_keys_are_named(text: str, message: str, tmp_path: Path) -> None:
    assert message in refusal(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "my.json:1: expected {, found the end of the file"),
        ("[]", "expected {, found ["),
        ("{", 'expected "key" or }, found the end of the file'),
        ("{}\n{", "my.json:2: expected the end of the file, found {"),
        ('{"a" 1}', "expected :, found 1"),
        ("{,}", 'expected "key" or }, found ,'),
        ('{"linear_update": 1,,}', 'expected "key" or }, found ,'),
        ("{linear_update: 1}", 'expected "key" or }, found linear_update'),
        ('{"linear_update', "found"),
        ('{"map_frame": "\\x"}', "my.json:1: bad string"),
        ("{\u2018a\u2019: 1}", "found \u2018"),
        ('{"a":' * 5000, "expected fewer sections"),
    ],
)
def test_text_that_is_no_json_is_refused(text: str, message: str, tmp_path: Path) -> None:
    assert message in refusal(tmp_path, text)


@pytest.mark.parametrize("name", ["missing.json", ".", "binary.json", "\0"])
def test_files_that_cannot_be_read_are_named(name: str, tmp_path: Path) -> None:
    (tmp_path / "binary.json").write_bytes(b"\xff\xfe{}")
    with pytest.raises(ParameterError, match="cannot read the parameters"):
        read_parameters(tmp_path / name)


# ---- the engine's Parameters ----


def test_copies_are_apart() -> None:
    original = Parameters()
    copy = original.copy()
    copy.set("linear_update", 0.5)
    assert original.get("linear_update") != copy.get("linear_update") == 0.5


def test_values_keep_their_types() -> None:
    types = {"bool": bool, "integer": int, "number": float, "string": str}
    values = Parameters().to_dict()
    assert list(values) == [entry.path for entry in parameter_table()]
    for entry in parameter_table():
        expected = types[entry.type]
        assert type(values[entry.path]) is type(entry.default) is type(entry.documented) is expected


def test_only_values_can_be_set() -> None:
    parameters = Parameters()
    for bad in (None, [1], {}, object()):
        with pytest.raises(TypeError):
            parameters.set(f"{MATCHER}.stationary_motion_model", bad)  # type: ignore[arg-type]


def test_a_path_as_a_key_is_told_how_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "params.json"
    file.write_text('{"output_map.median.iter": 2}')
    with pytest.raises(
        ParameterError,
        match=r'params.json:1: "output_map.median.iter" is written {"output_map": {"median": {"iter": ...}}}$',
    ):
        read_parameters(file)
    file.write_text('{"output_map": {"median": {"iter": 2}}}')
    assert read_parameters(file).get("output_map.median.iter") == 2


def test_a_whole_number_may_have_a_decimal_point(tmp_path: Path) -> None:
    file = tmp_path / "params.json"
    file.write_text('{"min_pointcloud_size": 7.0}')
    assert read_parameters(file).get("min_pointcloud_size") == 7
    file.write_text('{"min_pointcloud_size": 7.5}')
    with pytest.raises(ParameterError):
        read_parameters(file)
