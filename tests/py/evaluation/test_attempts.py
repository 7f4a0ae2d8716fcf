# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""What became of attempts to close loops."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from oort.evaluation.attempts import judge_attempts


def test_an_accepted_closure_that_a_reduced_map_lost_is_folded() -> None:
    edges = {"i": np.array([5, 4]), "j": np.array([1, 0]), "switch": np.array([0.9, 0.1])}
    pose = (0.1, 0.0, 0.0)
    told = [(5, 1, None, pose, 0.8), (4, 0, None, pose, 0.8), (6, 2, None, pose, 0.7), (7, 3, "hits", pose, 0.2)]
    map_: Any = SimpleNamespace(switchable_edges=edges)
    judged = judge_attempts(told, map_)
    assert [a.verdict for a in judged] == ["accepted", "contradicted", "folded", "hits"]
    assert [a.switch for a in judged] == [0.9, 0.1, None, None]
