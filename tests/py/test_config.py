# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters by keyword and attribute."""

import copy
from pathlib import Path

import numpy as np
import pytest

from oort import Config, ParameterError, Parameters, Session, read_parameters
from oort.parameters import parameter_table


def test_a_config_begins_with_the_defaults() -> None:
    assert Config() == Parameters()
    assert repr(Config()) == "Config()"


def test_values_are_set_by_keyword_and_attribute() -> None:
    config = Config(linear_update=0.3, output_map={"robot_radius": 0.2, "median": {"iter": 2}})
    config.loop_closure_graph_builder.frsm_matcher.search_window_xy = 2.0
    config.output_map.median = {"kernel_size": 5}
    config.angular_update = np.float64(0.25)
    changed = {path: value for path, value in config.to_dict().items() if value != Parameters().get(path)}
    assert changed == {
        path: value
        for path, value in {
            "linear_update": 0.3,
            "angular_update": 0.25,
            "output_map.robot_radius": 0.2,
            "output_map.median.iter": 2,
            "output_map.median.kernel_size": 5,
            "loop_closure_graph_builder.frsm_matcher.search_window_xy": 2.0,
        }.items()
        if value != Parameters().get(path)
    }
    assert config.linear_update == 0.3
    assert config.output_map.median.kernel_size == 5
    assert "linear_update=0.3" in repr(config)
    assert "kernel_size=5" in repr(config.output_map.median)


def test_every_parameter_can_be_reached_by_attributes() -> None:
    config = Config()
    for entry in parameter_table():
        section = config
        *sections, key = entry.path.split(".")
        for name in sections:
            assert name in dir(section)
            section = getattr(section, name)
        assert key in dir(section)
        assert getattr(section, key) == entry.default
        setattr(section, key, entry.default)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"linear_updat": 1.0}, 'unknown parameter "linear_updat"; the nearest known is "linear_update"'),
        ({"output_map": {"robot_radus": 1.0}}, 'the nearest known is "output_map.robot_radius"'),
        ({"output_map": {"resolution": 0.1}}, 'nearest known is "output_map.probability_grid.resolution"'),
        ({"linear_update": -1.0}, r"linear_update: -1 is out of range; it takes a number from 0.001 to 100 m"),
        ({"linear_update": "far"}, "linear_update: .* wrong type"),
        ({"linear_update": [1.0]}, r"linear_update: takes one value \(number\), not \[1.0\]"),
        ({"output_map": 3}, "output_map: is a section"),
        ({"output_map": {"median": {"kernel_size": 4}}}, "kernel_size must be odd"),
    ],
)
def test_errors_name_the_key_and_what_it_takes(values: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        Config(**values)


def test_unknown_attributes_are_refused() -> None:
    config = Config()
    with pytest.raises(ParameterError, match=r'nearest known is "output_map\.median"'):
        config.output_map.medan.iter = 1
    with pytest.raises(ParameterError, match='nearest known is "linear_update"'):
        config.linear_updte = 1.0
    assert not hasattr(config, "_repr_html_")


def test_copies_are_apart() -> None:
    config = Config(linear_update=0.3)
    for other in (config.copy(), Config.of(config), copy.copy(config), copy.deepcopy(config)):
        other.linear_update = 0.4
        assert isinstance(other, Config)
        assert config.linear_update == 0.3
    with pytest.raises(TypeError):
        hash(config)


def test_a_file_becomes_a_config(tmp_path: Path) -> None:
    path = tmp_path / "my.json"
    path.write_text('{"linear_update": 0.5 // m\n}', encoding="utf-8")
    assert Config.read(path) == read_parameters(path)


def test_a_config_is_taken_wherever_parameters_are() -> None:
    session = Session(Config(linear_update=0.5))
    session.start()
