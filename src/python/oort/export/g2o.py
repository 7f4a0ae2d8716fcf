# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Pose graphs in the g2o format, VERTEX_SE2 and EDGE_SE2; TORO's VERTEX2 and EDGE2 are read too."""

import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oort.errors import InputError
from oort.export.files import decimal, write_atomically
from oort.inputs import floats, quoted, read_text

_UPPER = np.triu_indices(3)
_TORO_UPPER = ([0, 0, 1, 2, 0, 1], [0, 1, 1, 2, 2, 2])  # the order in which TORO writes the information
_VERTICES, _EDGES = {"VERTEX_SE2": 5, "VERTEX2": 5}, {"EDGE_SE2": 12, "EDGE2": 12}
_FIELDS = {**_VERTICES, **_EDGES}
_3D = ("VERTEX_SE3:QUAT", "VERTEX_SE3:EULER", "VERTEX3")


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
    """Reads the planar part of a pose graph in the format of g2o or of TORO. Other lines are left out.

    Raises InputError if the file is missing or holds no vertex, a line is damaged, a vertex is there twice or an edge
    has one that is not there.
    """
    path = Path(path)
    vertices: dict[int, list[float]] = {}
    edges: list[tuple[str, list[int]]] = []  # with the place in the file
    measurements, covariances = [], []
    others: Counter[str] = Counter()
    for number, line in enumerate(read_text(path).splitlines(), 1):
        keyword, *fields = line.split() or [""]
        if keyword not in _FIELDS:
            others[keyword[:20]] += bool(keyword) and not keyword.startswith("#")
            continue
        where = f"{path}: line {number}"
        if len(fields) + 1 != _FIELDS[keyword]:
            raise InputError(f"{where}: {keyword} must have {_FIELDS[keyword]} fields, but has {len(fields) + 1}")
        count = 1 if keyword in _VERTICES else 2
        ids, values = _ids(fields[:count], where), floats(fields[count:], where)
        if keyword in _EDGES:
            edges.append((where, ids))
            measurements.append(values[:3])
            covariances.append(_covariance(values, _TORO_UPPER if keyword == "EDGE2" else _UPPER, where))
        elif ids[0] in vertices:
            raise InputError(f"{where}: there is a vertex {ids[0]} already; give each an id of its own")
        else:
            vertices[ids[0]] = values
    if not vertices:
        raise InputError(_no_vertices(path, others, len(edges)))
    for where, ids in edges:
        unknown = [str(id) for id in ids if id not in vertices]
        if unknown:
            raise InputError(f"{where}: the edge has the vertex {unknown[0]}, which the file does not hold")
        if ids[0] == ids[1]:
            raise InputError(f"{where}: the edge links the vertex {ids[0]} to itself")
    return PoseGraph(
        ids=np.array(list(vertices), dtype=np.int64),
        poses=np.array(list(vertices.values())),
        edges=np.array([ids for _, ids in edges], dtype=np.int64).reshape(-1, 2),
        measurements=np.array(measurements).reshape(-1, 3),
        covariances=np.array(covariances).reshape(-1, 3, 3),
    )


def _no_vertices(path: Path, others: Counter[str], edges: int) -> str:
    """Says what a file holds that has no vertices in the plane."""
    if any(keyword in others for keyword in _3D):
        return (
            f"{path} is a 3D pose graph ({', '.join(sorted(+others)[:4])}); only planar ones (VERTEX_SE2) can be solved"
        )
    if edges:
        return f"{path} holds {edges} edges and no VERTEX_SE2 (or VERTEX2) line: the poses to begin with are missing"
    held = ", ".join(f"{count} {keyword}" for keyword, count in (+others).most_common(6)) or "no line of text"
    return f"{path} holds no VERTEX_SE2 (g2o) or VERTEX2 (TORO) line; it holds {held}"


def _ids(fields: list[str], where: str) -> list[int]:
    """Ids of vertices. Raises InputError, naming the place, for anything that is no whole number of 64 bits."""
    if not all(len(field) < 20 and field.removeprefix("-").isdecimal() and abs(int(field)) < 2**63 for field in fields):
        raise InputError(f"{where}: ids of vertices are whole numbers, not {quoted(' '.join(fields))}")
    return [int(field) for field in fields]


def _covariance(values: list[float], order: tuple[Any, Any], where: str) -> NDArray[np.float64]:
    """Of an edge: x, y, theta and the upper triangle of the information in an order (rows, columns)."""
    information = np.zeros((3, 3))
    information[order] = values[3:]
    information = information + np.triu(information, 1).T
    return _turned(_invert(information, f"{where}: information"), values[2])


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
