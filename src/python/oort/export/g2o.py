# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Pose graphs in the g2o format: VERTEX_SE2 and EDGE_SE2."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oort.errors import InputError
from oort.export.files import decimal, floats, read_text, write_atomically

_UPPER = np.triu_indices(3)
_FIELDS = {"VERTEX_SE2": 5, "EDGE_SE2": 12}


@dataclass(frozen=True, slots=True, eq=False)
class PoseGraph:
    """Nodes and what was measured between them."""

    ids: NDArray[np.int64]
    """(n,)"""
    poses: NDArray[np.float64]
    """(n, 3) T_map_node"""
    edges: NDArray[np.int64]
    """(m, 2) ids of the nodes i and j"""
    measurements: NDArray[np.float64]
    """(m, 3) T_i_j"""
    covariances: NDArray[np.float64]
    """(m, 3, 3) of T_i_j, with x and y along the axes of node i"""


def write_g2o(path: str | os.PathLike[str], graph: PoseGraph) -> None:
    """Writes a pose graph with its first node fixed.

    Raises InputError if arrays do not fit, an edge names an unknown node, a number is not finite or a covariance is
    not positive definite, and OortError if the file cannot be written.
    """
    ids, poses = np.asarray(graph.ids), np.asarray(graph.poses)
    edges, measurements = np.asarray(graph.edges), np.asarray(graph.measurements)
    if not len(ids) or poses.shape != (len(ids), 3) or len(set(ids.tolist())) != len(ids):
        raise InputError(f"a pose graph needs nodes with ids of their own; {len(ids)} ids, poses {poses.shape}")
    if not len(edges) == len(measurements) == len(graph.covariances):
        raise InputError(f"{len(edges)} edges, {len(measurements)} measurements, {len(graph.covariances)} covariances")
    unknown = set(edges.ravel().tolist()) - set(ids.tolist())
    if unknown:
        raise InputError(f"edges name nodes that do not exist: {sorted(unknown)[:5]}")
    lines = [f"VERTEX_SE2 {i} {_join(pose)}\n" for i, pose in zip(ids.tolist(), poses, strict=True)]
    lines.append(f"FIX {int(ids[0])}\n")
    for (i, j), measured, covariance in zip(edges.tolist(), measurements, graph.covariances, strict=True):
        information = _invert(_turned(covariance, -measured[2]), f"edge {i} -> {j}: covariance")
        lines.append(f"EDGE_SE2 {i} {j} {_join(measured)} {_join(information[_UPPER])}\n")
    write_atomically(Path(path), "".join(lines).encode())


def read_g2o(path: str | os.PathLike[str]) -> PoseGraph:
    """Reads the planar part of a pose graph. Lines other than VERTEX_SE2 and EDGE_SE2 are left out.

    Raises InputError if the file is missing or holds no vertex, or a line is damaged.
    """
    path = Path(path)
    found: dict[str, list[list[float]]] = {keyword: [] for keyword in _FIELDS}
    covariances = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        keyword, *fields = line.split() or [""]
        if keyword not in _FIELDS:
            continue
        where = f"{path}: line {number}"
        if len(fields) + 1 != _FIELDS[keyword]:
            raise InputError(f"{where}: {keyword} must have {_FIELDS[keyword]} fields, but has {len(fields) + 1}")
        values = floats(fields, where)
        found[keyword].append(values)
        if keyword == "EDGE_SE2":
            information = np.zeros((3, 3))
            information[_UPPER] = values[5:]
            information = information + np.triu(information, 1).T
            covariances.append(_turned(_invert(information, f"{where}: information"), values[4]))
    vertices = np.array(found["VERTEX_SE2"]).reshape(-1, 4)
    edges = np.array(found["EDGE_SE2"]).reshape(-1, 11)
    if not len(vertices):
        raise InputError(f"{path} holds no VERTEX_SE2")
    return PoseGraph(
        ids=vertices[:, 0].astype(np.int64),
        poses=vertices[:, 1:],
        edges=edges[:, :2].astype(np.int64),
        measurements=edges[:, 2:5],
        covariances=np.array(covariances).reshape(-1, 3, 3),
    )


def _turned(covariance: NDArray[np.float64], theta: float) -> NDArray[np.float64]:
    """R S R^T with R the rotation by theta in x and y.

    g2o's error is inverse(T_i_j) * inverse(T_map_i) * T_map_j, so its information lies along the axes of node j,
    turned by the measurement's theta from those of node i.
    """
    c, s = np.cos(theta), np.sin(theta)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(R @ covariance @ R.T, dtype=np.float64)


def _invert(matrix: NDArray[np.float64], what: str) -> NDArray[np.float64]:
    """The inverse of a symmetric positive definite matrix."""
    try:
        if not np.isfinite(matrix).all():
            raise np.linalg.LinAlgError
        np.linalg.cholesky(matrix)
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        raise InputError(f"{what} must be finite and positive definite, not {matrix.tolist()}") from None
    return np.asarray((inverse + inverse.T) / 2.0, dtype=np.float64)


def _join(values: NDArray[np.float64]) -> str:
    return " ".join(decimal(value) for value in values.tolist())
